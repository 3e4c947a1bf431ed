//! Derivatives of contact points' motions against symbolic derivatives of other functions.

use crate::laws::{Derived, SEEDS, for_each_robot};
use crate::robots::load;
use denavit_codegen::expr::{ExprId, Operations};
use denavit_codegen::function::FunctionName::*;
use denavit_codegen::model::JointVariables;

/// A output against the gradient of a function's entries: `matrix[i][j]` is d entry_i / d by_j.
fn same_gradient(robot: &mut Derived, output: &str, entries: &[ExprId], by: &[ExprId]) {
    let n = by.len();
    let matrix = robot.entries(ContactDerivatives, output);
    assert_eq!(matrix.len(), n * entries.len(), "{}: {output}", robot.name);
    let columns = robot.gradient(entries, by);
    for seed in SEEDS {
        let matrix = robot.values(&matrix, seed);
        for (j, column) in columns.iter().enumerate() {
            let own: Vec<_> = (0..entries.len()).map(|row| matrix[row * n + j]).collect();
            assert_eq!(own, robot.values(column, seed), "{}: {output}, column {j}", robot.name);
        }
    }
}

#[test]
fn contact_derivatives_are_symbolic_derivatives() {
    for_each_robot(&[ContactDerivatives, ContactPositions, ContactJacobian], |robot| {
        if robot.derivation.functions.is_empty() {
            return;
        }
        let [q, qd]: [Vec<ExprId>; 2] = [
            robot.symbols(|joint: &JointVariables| joint.q),
            robot.symbols(|joint: &JointVariables| joint.qd),
        ];
        let h = robot.entries(ContactPositions, "contact_positions");
        let velocity = robot.time_derivative(&h);
        let acceleration = robot.time_derivative(&velocity);
        same_gradient(robot, "contact_velocity_dq", &velocity, &q);
        same_gradient(robot, "contact_acceleration_dq", &acceleration, &q);
        same_gradient(robot, "contact_acceleration_dqd", &acceleration, &qd);

        let made = &robot.derivation.functions;
        let function = made.iter().find(|function| function.name == ContactDerivatives).unwrap();
        assert_eq!(function.arguments[3].name, "f");
        let forces = function.arguments[3].symbols.clone();
        let jacobian = robot.entries(ContactJacobian, "contact_jacobian");
        let n = q.len();
        let dag = &mut robot.derivation.dag;
        let torques: Vec<ExprId> = (0..n)
            .map(|j| {
                forces.iter().enumerate().fold(dag.zero(), |sum, (row, &force)| {
                    let part = dag.mul(jacobian[row * n + j], force);
                    dag.add(sum, part)
                })
            })
            .collect();
        same_gradient(robot, "contact_torque_dq", &torques, &q);
    });
}

/// Symbolic differentiation of the accelerations alone takes more than all four outputs do.
#[test]
fn contact_derivatives_take_fewer_operations_than_differentiating() {
    for name in ["planar_biped", "tulip"] {
        let mut robot =
            Derived::new(&load(name), &[ContactDerivatives, ContactJacobian, ContactBias]);
        let jacobian = robot.entries(ContactJacobian, "contact_jacobian");
        let bias = robot.entries(ContactBias, "contact_bias");
        let (q, qdd) = (robot.symbols(|joint| joint.q), robot.symbols(|joint| joint.qdd));
        let dag = &mut robot.derivation.dag;
        let accelerations: Vec<ExprId> = jacobian
            .chunks(q.len())
            .zip(bias)
            .map(|(row, bias)| {
                row.iter().zip(&qdd).fold(bias, |sum, (&entry, &qdd)| {
                    let part = dag.mul(entry, qdd);
                    dag.add(sum, part)
                })
            })
            .collect();
        let slopes = robot.gradient(&accelerations, &q).concat();
        let plain = Operations::count(&robot.derivation.dag, &slopes);
        let own = robot.derivation.functions[0].entries();
        let own = Operations::count(&robot.derivation.dag, &own);
        assert!(own.mul + own.add < plain.mul + plain.add, "{name}: {own:?}, {plain:?}");
    }
}
