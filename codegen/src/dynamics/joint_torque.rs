//! What a joint needs besides the rigid bodies: friction, springs, the inertia of its rotor.
//!
//! All on the joint side. With a gear ratio N, rotor inertia and viscous friction of the motor
//! shaft count N^2 fold and Coulomb friction |N| fold (thesis 3.14-3.17). A series-elastic joint
//! feels its spring instead: rotor and motor friction are then the motor's own equation (3.22).
//! Laws of added effects join them.

use crate::expr::{Dag, ExprId, Relation, SymbolClass, UnaryFunction, substitute};
use crate::model::{JointLaw, LinkId, Robot, Side};
use rustc_hash::FxHashMap;

/// The terms of one joint.
#[derive(Clone, Copy, Debug)]
pub(super) struct JointTerms {
    /// Reflected rotor inertia, which adds to the diagonal of D [kg m^2, kg].
    pub(super) rotor: ExprId,
    /// Friction, damping, springs and offset: what the drive must give besides [N m, N].
    pub(super) torque: ExprId,
    /// Elastic energy of the joint's springs \[J\].
    pub(super) energy: ExprId,
    /// Laws of added effects that depend on the load or, in other ways than a rotor, on
    /// accelerations: inverse dynamics alone can have them [N m, N].
    pub(super) implicit: ExprId,
}

/// The terms of every joint, in joint order.
pub(super) fn joint_terms(dag: &mut Dag, robot: &Robot) -> Vec<JointTerms> {
    robot.joints().map(|(link, _)| terms_of(dag, robot, link)).collect()
}

fn terms_of(dag: &mut Dag, robot: &Robot, id: LinkId) -> JointTerms {
    let link = &robot.links[id];
    let joint = &link.joint;
    let variables = joint.variables.expect("joints() lists moving joints");
    let drive = link.drive.unwrap_or_default();
    let stiff = drive.series_elastic.is_none();
    let gear = drive.gear_ratio.unwrap_or_else(|| dag.one());
    let square = dag.mul(gear, gear);
    let mut rotor = dag.zero();
    if let Some(inertia) = drive.rotor_inertia.filter(|_| stiff && robot.terms.rotor) {
        rotor = dag.mul(square, inertia);
    }
    let mut torque = dag.zero();
    if robot.terms.friction {
        if let Some(viscous) = drive.viscous.filter(|_| stiff) {
            let reflected = dag.mul(square, viscous);
            torque = add_product(dag, torque, reflected, variables.qd);
        }
        if let Some(coulomb) = drive.coulomb.filter(|_| stiff) {
            let size = dag.unary(UnaryFunction::Abs, gear);
            let reflected = dag.mul(size, coulomb);
            let sign = dag.unary(UnaryFunction::Sign, variables.qd);
            torque = add_product(dag, torque, reflected, sign);
        }
        if let Some(damping) = joint.damping {
            torque = add_product(dag, torque, damping, variables.qd);
        }
    }
    let (springs, energy) = spring_torque(dag, robot, id);
    torque = dag.add(torque, springs);
    if let Some(offset) = drive.offset {
        torque = dag.add(torque, offset);
    }
    let implicit = dag.zero();
    add_laws(dag, robot, id, JointTerms { rotor, torque, energy, implicit })
}

/// The terms with the laws of added effects, each where it belongs.
fn add_laws(dag: &mut Dag, robot: &Robot, id: LinkId, mut terms: JointTerms) -> JointTerms {
    for law in robot.laws.iter().filter(|law| law.joint == id) {
        match explicit_parts(dag, robot, law) {
            Some([inertia, rest]) => {
                terms.rotor = dag.add(terms.rotor, inertia);
                terms.torque = dag.add(terms.torque, rest);
            }
            None => terms.implicit = dag.add(terms.implicit, law.torque),
        }
    }
    terms
}

/// Inertia and rest of a law that is inertia(q) qdd + rest(q, qd, t, states); none of one that is
/// not, so that accelerations cannot be solved for.
fn explicit_parts(dag: &mut Dag, robot: &Robot, law: &JointLaw) -> Option<[ExprId; 2]> {
    use SymbolClass::{Acceleration, Effort, Rate, State, Time};
    if !law.loads.is_empty() {
        return None;
    }
    let has = |dag: &Dag, expr, class| dag.classes(expr).contains(class);
    if !has(dag, law.torque, Acceleration) {
        return Some([dag.zero(), law.torque]);
    }
    let qdd = robot.links[law.joint].joint.variables?.qdd;
    let inertia = slope(dag, law.torque, qdd);
    let rest: FxHashMap<ExprId, ExprId> = [(qdd, dag.zero())].into_iter().collect();
    let rest = substitute(dag, &[law.torque], &rest)[0];
    let of_position =
        [Acceleration, Effort, Rate, State, Time].iter().all(|&class| !has(dag, inertia, class));
    (of_position && !has(dag, rest, Acceleration)).then_some([inertia, rest])
}

/// The added effects whose laws only inverse dynamics can have: those that depend on loads, or on
/// accelerations in other ways than a rotor. Bias, forward dynamics and derivatives are not derived
/// for a robot with one of them.
pub fn implicit_effects(robot: &Robot) -> Vec<String> {
    let mut dag = robot.dag.clone();
    let implicit = robot.laws.iter().filter(|law| explicit_parts(&mut dag, robot, law).is_none());
    implicit.map(|law| law.effect.clone()).collect()
}

/// Torque and elastic energy of the springs across one moving joint [N m, N; J].
pub(crate) fn spring_torque(dag: &mut Dag, robot: &Robot, id: LinkId) -> (ExprId, ExprId) {
    let link = &robot.links[id];
    let joint = &link.joint;
    let variables = joint.variables.expect("the joint moves");
    let drive = link.drive.unwrap_or_default();
    let (mut torque, mut energy) = (dag.zero(), dag.zero());
    if let Some(spring) = joint.spring.filter(|_| robot.terms.spring) {
        let stretch = dag.sub(variables.q, spring.angle);
        (torque, energy) = add_spring(dag, torque, energy, spring.stiffness, stretch);
    }
    if let Some(spring) = drive.return_spring.filter(|_| robot.terms.spring) {
        let zero = dag.zero();
        let stretch = dag.sub(variables.q, spring.angle);
        let (left, right) = match spring.side {
            Side::Above => (spring.angle, variables.q),
            Side::Below => (variables.q, spring.angle),
        };
        let active = dag.select(Relation::Less, left, right, stretch, zero);
        (torque, energy) = add_spring(dag, torque, energy, spring.stiffness, active);
    }
    (torque, energy)
}

fn add_product(dag: &mut Dag, sum: ExprId, a: ExprId, b: ExprId) -> ExprId {
    let product = dag.mul(a, b);
    dag.add(sum, product)
}

/// Torque k x and energy k x^2 / 2 (thesis 2.8) of a linear spring.
fn add_spring(
    dag: &mut Dag,
    torque: ExprId,
    energy: ExprId,
    stiffness: ExprId,
    stretch: ExprId,
) -> (ExprId, ExprId) {
    let torque = add_product(dag, torque, stiffness, stretch);
    let square = dag.mul(stretch, stretch);
    let half = dag.constant(crate::number::ratio(1, 2));
    let half_stiffness = dag.mul(half, stiffness);
    (torque, add_product(dag, energy, half_stiffness, square))
}

/// The derivative of a joint's own torque by one of its own variables.
pub(super) fn slope(dag: &mut Dag, torque: ExprId, variable: ExprId) -> ExprId {
    let mut seeds = FxHashMap::default();
    seeds.insert(variable, dag.one());
    crate::expr::derivative(dag, &[torque], &seeds)[0]
}
