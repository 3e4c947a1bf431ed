//! An added effect whose inertia varies with positions is part of the derivatives.

use crate::laws::{Derived, SEEDS};
use crate::robots::load;
use denavit_codegen::expr::ExprId;
use denavit_codegen::function::FunctionName::*;
use denavit_codegen::model::{JointLaw, SpringSide};

#[test]
fn inertia_that_varies_with_positions_is_part_of_the_derivatives() {
    let mut model = load("planar_2r");
    let (links, joints): (Vec<_>, Vec<_>) = model.joints().map(|(link, own)| (link, *own)).unzip();
    let dag = &mut model.dag;
    let square = dag.mul(joints[1].q, joints[1].q);
    let product = dag.mul(square, joints[0].q);
    let torque = dag.mul(product, joints[0].qdd);
    model.laws.push(JointLaw {
        effect: "varying".to_owned(),
        title: "an inertia that varies".to_owned(),
        joint: links[0],
        side: SpringSide::Link,
        torque,
        states: Vec::new(),
        loads: Vec::new(),
        time: None,
    });
    let mut robot = Derived::new(&model, &[InverseDynamics, InverseDynamicsDerivatives]);
    let tau = robot.entries(InverseDynamics, "tau");
    let q = robot.symbols(|joint| joint.q);
    let columns = robot.gradient(&tau, &q).concat();
    let ours = robot.entries(InverseDynamicsDerivatives, "dtau_dq");
    let transposed: Vec<ExprId> = [0, 2, 1, 3].map(|k| ours[k]).to_vec();
    for seed in SEEDS {
        assert_eq!(robot.values(&transposed, seed), robot.values(&columns, seed));
    }
}
