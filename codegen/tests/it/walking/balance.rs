//! Points of the ground plane against derivatives of momenta, exactly.

use crate::laws::{Derived, SEEDS, dot, total_mass};
use crate::robots::load;
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName::{self, *};
use denavit_codegen::model::{Robot, bake};
use denavit_codegen::number::{Residue, ratio};

pub(super) type Triple = [Residue; 3];

/// Robots that walk, on level ground and on slopes; one on a plane that no axis is along.
pub(super) fn walkers() -> Vec<Robot> {
    let names = ["tulip", "planar_biped", "bodies/compass", "bodies/rimless_wheel", "bodies/slope"];
    let mut robots: Vec<Robot> = names.iter().map(|name| load(name)).collect();
    robots.push(on_a_skew_plane(load("tulip")));
    robots
}

pub(super) fn on_a_skew_plane(mut robot: Robot) -> Robot {
    let dag = &mut robot.dag;
    let mut number = |over, under| dag.constant(ratio(over, under));
    robot.ground.normal = [number(1, 5), number(-2, 7), number(3, 2)];
    robot.ground.point = [number(1, 3), number(1, 10), number(-1, 4)];
    robot.name += " on a skew plane";
    robot
}

pub(super) fn minus(a: Triple, b: Triple) -> Triple {
    [0, 1, 2].map(|k| a[k] - b[k])
}

pub(super) fn cross(a: Triple, b: Triple) -> Triple {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i] * b[j] - a[j] * b[i])
}

pub(super) fn triple(robot: &Derived, entries: &[ExprId], seed: u64) -> Triple {
    robot.values(entries, seed).try_into().unwrap()
}

/// `a x b` as expressions.
pub(super) fn cross_product(dag: &mut Dag, a: &[ExprId], b: &[ExprId]) -> Vec<ExprId> {
    let entry = |(i, j): (usize, usize)| {
        let (left, right) = (dag.mul(a[i], b[j]), dag.mul(a[j], b[i]));
        dag.sub(left, right)
    };
    [(1, 2), (2, 0), (0, 1)].into_iter().map(entry).collect()
}

/// The force and the moment about the origin that the ground must give, from derivatives of the
/// momenta: dp/dt - m g, and d/dt (L + c x p) - c x m g.
pub(super) fn ground_wrench(robot: &mut Derived) -> [Vec<ExprId>; 2] {
    let linear = robot.entries(Momentum, "linear_momentum");
    let spin = robot.entries(Momentum, "angular_momentum");
    let center = robot.entries(CenterOfMass, "center_of_mass");
    let gravity = robot.derivation.robot.gravity;
    let mass = total_mass(robot);
    let dag = &mut robot.derivation.dag;
    let orbital = cross_product(dag, &center, &linear);
    let angular: Vec<ExprId> = (0..3).map(|k| dag.add(spin[k], orbital[k])).collect();
    let weight: Vec<ExprId> = gravity.iter().map(|&g| dag.mul(mass, g)).collect();
    let pulled = cross_product(dag, &center, &weight);
    let force = robot.time_derivative(&linear);
    let moment = robot.time_derivative(&angular);
    let dag = &mut robot.derivation.dag;
    let less = |dag: &mut Dag, a: &[ExprId], b: &[ExprId]| {
        a.iter().zip(b).map(|(&a, &b)| dag.sub(a, b)).collect::<Vec<ExprId>>()
    };
    [less(dag, &force, &weight), less(dag, &moment, &pulled)]
}

/// That a wrench has no moment about `point` but along the normal, and that the point is on the
/// plane.
#[track_caller]
pub(super) fn acts_at(robot: &Derived, point: Triple, [force, moment]: [Triple; 2], seed: u64) {
    let ground = robot.derivation.robot.ground;
    let normal = triple(robot, &ground.normal, seed);
    let about = minus(moment, cross(point, force));
    assert_eq!(cross(normal, about), [Residue::ZERO; 3], "{}", robot.name);
    let above = minus(point, triple(robot, &ground.point, seed));
    assert_eq!(dot(&normal, &above), Residue::ZERO, "{}: on the plane", robot.name);
}

#[test]
fn the_zero_moment_point_is_where_the_momentum_asks_the_ground_to_act() {
    for model in walkers() {
        let mut robot = Derived::new(&model, &[ZeroMomentPoint, Momentum, CenterOfMass]);
        let point = robot.entries(ZeroMomentPoint, "zero_moment_point");
        let wrench = ground_wrench(&mut robot);
        for seed in SEEDS {
            let wrench = wrench.each_ref().map(|vector| triple(&robot, vector, seed));
            acts_at(&robot, triple(&robot, &point, seed), wrench, seed);
        }
    }
}

/// A force at the point and a moment along the normal do on the joints of the base what inverse
/// dynamics asks there of nobody.
#[test]
fn a_force_at_the_zero_moment_point_carries_the_base() {
    for model in walkers() {
        let planar = !model.name.starts_with("tulip");
        let wanted = [ZeroMomentPoint, Momentum, CenterOfMass, InverseDynamics, LinkJacobian];
        let mut robot = Derived::new(&model, &[&wanted[..], &[LinkTransforms]].concat());
        let base = if planar { 3 } else { 6 };
        let link = model.links.keys().nth(base - 1).unwrap();
        assert_eq!(model.links[link].name, "base_pitch");
        let made = robot.derivation.functions.iter();
        let mut jacobians = made.filter(|function| function.name == LinkJacobian);
        let jacobian = jacobians.nth(base - 1).unwrap().entries();
        let transforms = robot.entries(LinkTransforms, "link_transforms");
        let row = |row: usize| transforms[12 * (base - 1) + 4 * row + 3];
        let origin = [row(0), row(1), row(2)];
        let torques = robot.entries(InverseDynamics, "tau");
        let point = robot.entries(ZeroMomentPoint, "zero_moment_point");
        let [force, _] = ground_wrench(&mut robot);
        let n = robot.joints.len();
        for seed in SEEDS {
            let jacobian = robot.values(&jacobian, seed);
            let torques = robot.values(&torques, seed);
            let force = triple(&robot, &force, seed);
            let lever = minus(triple(&robot, &point, seed), triple(&robot, &origin, seed));
            let moment = cross(lever, force);
            let normal = triple(&robot, &robot.derivation.robot.ground.normal, seed);
            let column = |first: usize, j: usize| [0, 1, 2].map(|k| jacobian[(first + k) * n + j]);
            // What is left is the moment along the normal, the same for every joint.
            let left: Vec<[Residue; 2]> = (0..base)
                .map(|j| {
                    let pushed = dot(&column(0, j), &force) + dot(&column(3, j), &moment);
                    [torques[j] - pushed, dot(&column(3, j), &normal)]
                })
                .collect();
            for [own, along] in &left {
                if *along == Residue::ZERO {
                    assert_eq!(*own, Residue::ZERO, "{}", robot.name);
                }
                for [other, across] in &left {
                    assert_eq!(*own * *across, *other * *along, "{}", robot.name);
                }
            }
        }
    }
}

/// A point mass that slides along the ground, up or down, keeps its height: nothing is left out.
#[test]
fn the_cart_table_is_exact_for_a_point_mass_at_constant_height() {
    let mut model = bake(&load("bodies/slope")).unwrap();
    let zero = model.dag.zero();
    for body in model.links.values_mut().filter_map(|link| link.body.as_mut()) {
        body.inertia = [zero; 6];
    }
    let robot = Derived::new(&model, &[ZeroMomentPoint, CartTableZmp]);
    let dag = &robot.derivation.dag;
    let normal = model.ground.normal;
    for seed in SEEDS {
        // base_z and base_x accelerate along the plane.
        let along = robot.values(&normal, seed);
        let point =
            || Residues::new(seed).with("qdd_base_x", along[2]).with("qdd_base_z", -along[0]);
        let value = |name: FunctionName, output: &str| {
            evaluate(dag, &robot.entries(name, output), &mut point()).unwrap()
        };
        let exact = value(ZeroMomentPoint, "zero_moment_point");
        assert_eq!(value(CartTableZmp, "cart_table_zmp"), exact);
        let anywhere = robot.values(&robot.entries(CartTableZmp, "cart_table_zmp"), seed);
        let exact = robot.values(&robot.entries(ZeroMomentPoint, "zero_moment_point"), seed);
        assert_ne!(anywhere, exact, "not while it rises");
    }
}

#[test]
fn the_cart_table_is_height_times_acceleration_over_gravity() {
    for model in walkers() {
        let mut robot = Derived::new(&model, &[CartTableZmp, CenterOfMass]);
        let center = robot.entries(CenterOfMass, "center_of_mass");
        let velocity = robot.time_derivative(&center);
        let acceleration = robot.time_derivative(&velocity);
        let point = robot.entries(CartTableZmp, "cart_table_zmp");
        for seed in SEEDS {
            let ground = robot.derivation.robot.ground;
            let [normal, origin, gravity] =
                [ground.normal, ground.point, robot.derivation.robot.gravity]
                    .map(|vector| triple(&robot, &vector, seed));
            let [center, acceleration, point] =
                [&center, &acceleration, &point].map(|vector| triple(&robot, vector, seed));
            let height = dot(&normal, &minus(center, origin));
            let falling = dot(&normal, &gravity);
            // Along every direction of the plane: gn (p - c) = -h (a - g).
            let moved = minus(point, center);
            let speeding = minus(acceleration, gravity);
            let [moved, speeding] = [moved, speeding].map(|vector| cross(normal, vector));
            for k in 0..3 {
                assert_eq!(falling * moved[k], height * speeding[k], "{}", robot.name);
            }
            assert_eq!(dot(&normal, &minus(point, origin)), Residue::ZERO, "{}", robot.name);
        }
    }
}

#[test]
fn robots_that_stand_on_nothing_have_no_points_of_the_ground() {
    let wanted = [ZeroMomentPoint, CartTableZmp, FootRotationIndicator, CapturePoint];
    for name in ["puma560", "tulip_leg6"] {
        assert!(Derived::new(&load(name), &wanted).derivation.functions.is_empty(), "{name}");
    }
    let tulip = Derived::new(&load("tulip"), &wanted);
    let links: Vec<Option<&str>> =
        tulip.derivation.functions.iter().map(|function| function.link.as_deref()).collect();
    assert_eq!(links.len(), 5);
    assert_eq!(links.iter().flatten().count(), 2, "one for each foot");
}
