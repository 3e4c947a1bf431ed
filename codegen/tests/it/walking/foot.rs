//! The foot rotation indicator: against the foot's own momentum, and where the foot is still.

use super::balance::{acts_at, cross_product, ground_wrench, minus, on_a_skew_plane, triple};
use crate::laws::{Derived, SEEDS};
use crate::robots::load;
use denavit_codegen::arena::Handle;
use denavit_codegen::expr::{ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName::*;
use denavit_codegen::model::{About, LinkId, Robot};
use denavit_codegen::number::Residue;

const WANTED: [denavit_codegen::function::FunctionName; 6] =
    [FootRotationIndicator, ZeroMomentPoint, Momentum, CenterOfMass, LinkTransforms, LinkJacobian];

/// The links of the rigid body of a link: those on the same last moving joint.
fn rigid_body(robot: &Robot, link: LinkId) -> Vec<LinkId> {
    let joint = |link: LinkId| {
        let path = robot.tree.path(link);
        path.into_iter().rfind(|&on| robot.links[on].joint.variables.is_some())
    };
    robot.links.keys().filter(|&other| joint(other) == joint(link)).collect()
}

/// Mass times gravity and acceleration of a body: m (a - g), and its moment about the origin with
/// the derivative of the spin. From the transforms and Jacobians of links alone.
struct Foot {
    /// dp/dt.
    force: Vec<ExprId>,
    /// dL/dt about the origin of frame 0.
    moment: Vec<ExprId>,
}

fn foot_motion(robot: &mut Derived, link: LinkId) -> Foot {
    let model = robot.derivation.robot.clone();
    let n = robot.joints.len();
    let transforms = robot.entries(LinkTransforms, "link_transforms");
    let rates = robot.symbols(|joint| joint.qd);
    let zero = robot.derivation.dag.zero();
    let (mut linear, mut angular) = (vec![zero; 3], vec![zero; 3]);
    for own in rigid_body(&model, link) {
        let Some(body) = model.links[own].body else { continue };
        assert_eq!(body.about, About::Com, "the test knows central tensors");
        let entry = |row: usize, column: usize| transforms[12 * own.index() + 4 * row + column];
        let jacobians =
            robot.derivation.functions.iter().filter(|function| function.name == LinkJacobian);
        let jacobian = jacobians.into_iter().nth(own.index()).unwrap().entries();
        let dag = &mut robot.derivation.dag;
        let mut sum = |terms: Vec<(ExprId, ExprId)>| {
            terms.into_iter().fold(dag.zero(), |sum, (a, b)| {
                let product = dag.mul(a, b);
                dag.add(sum, product)
            })
        };
        let turned = |sum: &mut dyn FnMut(Vec<(ExprId, ExprId)>) -> ExprId, v: &[ExprId]| {
            (0..3).map(|r| sum((0..3).map(|k| (entry(r, k), v[k])).collect())).collect::<Vec<_>>()
        };
        let arm = turned(&mut sum, &body.com);
        let spin: Vec<ExprId> = (0..3)
            .map(|k| sum((0..n).map(|j| (jacobian[(3 + k) * n + j], rates[j])).collect()))
            .collect();
        // The spin in the link's frame, times the tensor, back in the world.
        let local: Vec<ExprId> =
            (0..3).map(|k| sum((0..3).map(|r| (entry(r, k), spin[r])).collect())).collect();
        let [xx, yy, zz, xy, xz, yz] = body.inertia;
        let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let local: Vec<ExprId> =
            tensor.iter().map(|row| sum((0..3).map(|k| (row[k], local[k])).collect())).collect();
        let own_spin = turned(&mut sum, &local);
        let center: Vec<ExprId> = (0..3).map(|k| dag.add(entry(k, 3), arm[k])).collect();
        let velocity = robot.time_derivative(&center);
        let dag = &mut robot.derivation.dag;
        let momentum: Vec<ExprId> = velocity.iter().map(|&v| dag.mul(body.mass, v)).collect();
        let orbital = cross_product(dag, &center, &momentum);
        for k in 0..3 {
            linear[k] = dag.add(linear[k], momentum[k]);
            let whole = dag.add(own_spin[k], orbital[k]);
            angular[k] = dag.add(angular[k], whole);
        }
    }
    Foot { force: robot.time_derivative(&linear), moment: robot.time_derivative(&angular) }
}

/// The ground need not do what accelerates the foot: what is left acts at the indicator.
#[test]
fn the_foot_rotation_indicator_leaves_the_foots_own_momentum_out() {
    let skew = on_a_skew_plane(load("tulip"));
    for model in [load("tulip"), load("planar_biped"), skew, load("bodies/compass")] {
        let mut robot = Derived::new(&model, &WANTED);
        let [force, moment] = ground_wrench(&mut robot);
        let feet: Vec<(String, Vec<ExprId>)> = robot
            .derivation
            .functions
            .iter()
            .filter(|function| function.name == FootRotationIndicator)
            .map(|function| (function.link.clone().unwrap(), function.entries()))
            .collect();
        assert_eq!(feet.len(), 2, "{}", model.name);
        for (name, point) in feet {
            let link = model.links.iter().find(|(_, link)| link.name == name).unwrap().0;
            let foot = foot_motion(&mut robot, link);
            for seed in SEEDS {
                let [force, moment, own_force, own_moment, point] =
                    [&force, &moment, &foot.force, &foot.moment, &point]
                        .map(|vector| triple(&robot, vector, seed));
                let left = [minus(force, own_force), minus(moment, own_moment)];
                acts_at(&robot, point, left, seed);
            }
        }
    }
}

/// While nothing between the world and the foot moves.
#[test]
fn the_indicator_of_a_still_foot_is_the_zero_moment_point() {
    for model in [load("tulip"), load("planar_biped"), on_a_skew_plane(load("tulip"))] {
        let robot = Derived::new(&model, &[FootRotationIndicator, ZeroMomentPoint]);
        let dag = &robot.derivation.dag;
        let foot = &robot.derivation.functions[0];
        let name = foot.link.clone().unwrap();
        let link = model.links.iter().find(|(_, link)| link.name == name).unwrap().0;
        for seed in SEEDS {
            let still = || {
                model.tree.path(link).into_iter().fold(Residues::new(seed), |point, on| {
                    let Some(joint) = model.links[on].joint.variables else { return point };
                    [joint.qd, joint.qdd].into_iter().fold(point, |point, symbol| {
                        point.with(&dag.as_symbol(symbol).unwrap().name, Residue::ZERO)
                    })
                })
            };
            let value = |entries: &[ExprId]| evaluate(dag, entries, &mut still()).unwrap();
            let zmp = value(&robot.entries(ZeroMomentPoint, "zero_moment_point"));
            assert_eq!(value(&foot.entries()), zmp, "{}: {name}", model.name);
            let other = &robot.derivation.functions[1];
            assert_eq!(other.name, FootRotationIndicator);
            assert_ne!(value(&other.entries()), zmp, "{}: the other foot moves", model.name);
        }
    }
}
