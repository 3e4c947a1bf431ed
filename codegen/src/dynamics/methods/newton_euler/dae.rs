//! The equations before elimination: differential equations of free bodies with algebraic
//! constraints, in coordinates that know nothing of the joints.
//!
//! Integrated as they stand, the constraints hold at acceleration level only and their residuals
//! drift (thesis 2.2.1); [`Dae::constraints`] measures how far.

use super::super::frames::{central_tensor, free_fall};
use super::super::linear::{apply, identity, jacobian, multiply, rate};
use crate::arena::Handle;
use crate::expr::{Dag, ExprId, SymbolClass};
use crate::model::{Convention, Joint, JointKind, Link, Robot};
use crate::spatial::{Matrix, Vector, add, cross, dot, scale, subtract, transpose, zero};

/// The coordinates of a free link, as symbols. World coordinates in SI units; the reference point
/// is the centre of mass, for a link without body its origin. Kinematics: `d/dt position =
/// velocity` and `d/dt rotation = angular_velocity x (each column)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BodySymbols {
    /// Position of the reference point, `p1_LINK` ..
    pub position: Vector,
    /// Link coordinates to world coordinates, `r11_LINK` ..
    pub rotation: Matrix,
    /// Velocity of the reference point [m/s], `v1_LINK` ..
    pub velocity: Vector,
    /// Angular velocity [rad/s], `w1_LINK` ..
    pub angular_velocity: Vector,
}

/// `M a = F + A^T lambda` with `A a = gamma`, where a lists for each link the acceleration of its
/// reference point and its angular acceleration (6 entries a link, in link order).
///
/// The effort of a moving joint is its symbol `tau_LINK`, in F: what is left of the drive's torque
/// after friction, springs and rotor. A massless link makes M singular, not the whole system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Dae {
    /// By link.
    pub bodies: Vec<BodySymbols>,
    /// M, by rows: blocks m 1 and R I R^T.
    pub mass_matrix: Vec<Vec<ExprId>>,
    /// F: weight, joint efforts, and the gyroscopic moment -w x R I R^T w.
    pub forces: Vec<ExprId>,
    /// Residuals of the joints at position level [m, or a cosine]: 5 for each moving joint, 6 for
    /// each fixed one.
    pub constraints: Vec<ExprId>,
    /// A, by rows: the residuals' rates are A (v, w).
    pub constraint_jacobian: Vec<Vec<ExprId>>,
    /// gamma: the part of the residuals' second derivatives that velocities alone make, negated.
    pub constraint_bias: Vec<ExprId>,
}

/// Writes the equations of free links and of the joints that hold them together. The symbols of
/// the links' coordinates are made in `dag`, which must know the robot's symbols.
pub fn dae(dag: &mut Dag, robot: &Robot) -> Dae {
    let links: Vec<&Link> = robot.links.values().collect();
    let bodies: Vec<_> = links.iter().map(|link| symbols(dag, &link.name)).collect();
    let ground = resting(dag);
    let mut constraints = Vec::new();
    for (link, body) in links.iter().zip(&bodies) {
        let parent = link.parent.map_or(&ground, |parent| &bodies[parent.index()]);
        let parent_center = match link.parent {
            Some(parent) => center(dag, &robot.links[parent]),
            None => zero(dag),
        };
        let attachment = Attachment::new(dag, robot.convention, link, parent_center);
        constraints.extend(attachment.residuals(dag, link.joint.kind, parent, body));
    }
    let (positions, rates, velocities) = motion(dag, &bodies);
    let residual_rates = rate(dag, &constraints, &positions, &rates);
    let constraint_jacobian = jacobian(dag, &residual_rates, &velocities);
    let convective = rate(dag, &residual_rates, &positions, &rates);
    let constraint_bias = convective.iter().map(|&entry| dag.neg(entry)).collect();
    let (mass_matrix, mut forces) = balances(dag, robot, &bodies);
    add_efforts(dag, robot, &bodies, &mut forces);
    Dae { bodies, mass_matrix, forces, constraints, constraint_jacobian, constraint_bias }
}

/// The coordinates that move, their rates, and the velocities (v, w) of each link.
fn motion(dag: &mut Dag, bodies: &[BodySymbols]) -> (Vec<ExprId>, Vec<ExprId>, Vec<ExprId>) {
    let (mut positions, mut rates, mut velocities) = (Vec::new(), Vec::new(), Vec::new());
    for body in bodies {
        positions.extend(body.position);
        rates.extend(body.velocity);
        for column in transpose(body.rotation) {
            positions.extend(column);
            rates.extend(cross(dag, body.angular_velocity, column));
        }
        velocities.extend(body.velocity);
        velocities.extend(body.angular_velocity);
    }
    (positions, rates, velocities)
}

/// M, and F without efforts.
fn balances(
    dag: &mut Dag,
    robot: &Robot,
    bodies: &[BodySymbols],
) -> (Vec<Vec<ExprId>>, Vec<ExprId>) {
    let (size, zero) = (6 * bodies.len(), dag.zero());
    let mut mass_matrix = vec![vec![zero; size]; size];
    let mut forces = vec![zero; size];
    let free_fall = free_fall(dag, robot);
    for (id, link) in robot.links.iter() {
        let Some(body) = &link.body else { continue };
        let (state, first) = (&bodies[id.index()], 6 * id.index());
        let central = central_tensor(dag, body);
        let turned = multiply(dag, state.rotation, central);
        let tensor = multiply(dag, turned, transpose(state.rotation));
        let momentum = apply(dag, tensor, state.angular_velocity);
        let gyroscopic = cross(dag, momentum, state.angular_velocity);
        let weight = scale(dag, body.mass, free_fall);
        for k in 0..3 {
            mass_matrix[first + k][first + k] = body.mass;
            mass_matrix[first + 3 + k][first + 3..first + 6].copy_from_slice(&tensor[k]);
            forces[first + k] = weight[k];
            forces[first + 3 + k] = gyroscopic[k];
        }
    }
    (mass_matrix, forces)
}

/// Adds each joint's effort to its link, and its reaction to the carrying link.
fn add_efforts(dag: &mut Dag, robot: &Robot, bodies: &[BodySymbols], forces: &mut [ExprId]) {
    let ground = resting(dag);
    for (id, link) in robot.links.iter() {
        let Some(variables) = link.joint.variables else { continue };
        let parent = link.parent.map_or(&ground, |parent| &bodies[parent.index()]);
        let attachment = Attachment::new(dag, robot.convention, link, zero(dag));
        let axis = apply(dag, parent.rotation, attachment.axes[2]);
        let effort = scale(dag, variables.tau, axis);
        let body = &bodies[id.index()];
        let arm = apply(dag, body.rotation, attachment.own_point);
        let point = add(dag, body.position, arm);
        let reaction = effort.map(|entry| dag.neg(entry));
        let mut apply_effort = |index: usize, position: Vector, effort: Vector| {
            let (offset, sum) = match link.joint.kind {
                JointKind::Prismatic => {
                    let arm = subtract(dag, point, position);
                    (0, [effort, cross(dag, arm, effort)].concat())
                }
                JointKind::Revolute | JointKind::Fixed => (3, effort.to_vec()),
            };
            for (k, entry) in sum.into_iter().enumerate() {
                let slot = &mut forces[6 * index + offset + k];
                *slot = dag.add(*slot, entry);
            }
        };
        apply_effort(id.index(), body.position, effort);
        if let Some(carrier) = link.parent {
            apply_effort(carrier.index(), parent.position, reaction);
        }
    }
}

/// How a joint sits in its two links, in their own coordinates.
struct Attachment {
    /// The point of the joint in the parent, from its reference point; of a sliding joint where
    /// q = 0.
    parent_point: Vector,
    /// The point of the joint in the link, from its reference point.
    own_point: Vector,
    /// Directions fixed in the parent: two across the joint axis, then the axis.
    axes: [Vector; 3],
    /// The joint axis in the link.
    own_axis: Vector,
    /// The link's axes in the parent, for a joint that does not turn: by columns.
    columns: Matrix,
}

impl Attachment {
    fn new(dag: &mut Dag, convention: Convention, link: &Link, parent_center: Vector) -> Self {
        let Joint { kind, a, alpha, d, theta, .. } = link.joint;
        let (zero, one) = (dag.zero(), dag.one());
        let (ca, sa) = (dag.cos(alpha), dag.sin(alpha));
        let (ct, st) = (dag.cos(theta), dag.sin(theta));
        let about_x = [[one, zero, zero], [zero, ca, dag.neg(sa)], [zero, sa, ca]];
        let about_z = [[ct, dag.neg(st), zero], [st, ct, zero], [zero, zero, one]];
        let (turn, axes, own_axis) = match convention {
            // z of the parent; R_row^T z does not depend on theta
            Convention::Standard => {
                (multiply(dag, about_z, about_x), identity(dag), [zero, sa, ca])
            }
            Convention::Modified => {
                let unit_z = [zero, zero, one];
                (multiply(dag, about_x, about_z), transpose(about_x), unit_z)
            }
        };
        // The point is o_(i-1) for a standard revolute joint, o_i for every other.
        let (in_parent, in_link) = match (convention, kind) {
            (Convention::Standard, JointKind::Revolute) => {
                let origin = [a, dag.mul(d, sa), dag.mul(d, ca)];
                ([zero; 3], origin.map(|entry| dag.neg(entry)))
            }
            (Convention::Standard, _) => ([dag.mul(a, ct), dag.mul(a, st), d], [zero; 3]),
            (Convention::Modified, _) => (apply(dag, about_x, [a, zero, d]), [zero; 3]),
        };
        let own_center = center(dag, link);
        Self {
            parent_point: subtract(dag, in_parent, parent_center),
            own_point: subtract(dag, in_link, own_center),
            axes,
            own_axis,
            columns: transpose(turn),
        }
    }

    /// What must vanish for the two links to be joined.
    fn residuals(
        &self,
        dag: &mut Dag,
        kind: JointKind,
        parent: &BodySymbols,
        link: &BodySymbols,
    ) -> Vec<ExprId> {
        let across = [0, 1].map(|k| apply(dag, parent.rotation, self.axes[k]));
        let in_parent = point(dag, parent, self.parent_point);
        let in_link = point(dag, link, self.own_point);
        let gap = subtract(dag, in_link, in_parent);
        let mut residuals = match kind {
            JointKind::Prismatic => across.map(|direction| dot(dag, direction, gap)).to_vec(),
            JointKind::Revolute | JointKind::Fixed => gap.to_vec(),
        };
        if kind == JointKind::Revolute {
            let axis = apply(dag, link.rotation, self.own_axis);
            residuals.extend(across.map(|direction| dot(dag, direction, axis)));
        } else {
            let own = transpose(link.rotation);
            let expected = self.columns.map(|column| apply(dag, parent.rotation, column));
            residuals.extend([(0, 1), (1, 2), (2, 0)].map(|(i, j)| dot(dag, own[i], expected[j])));
        }
        residuals
    }
}

/// A point of a link, given from its reference point in link coordinates.
fn point(dag: &mut Dag, body: &BodySymbols, offset: Vector) -> Vector {
    let turned = apply(dag, body.rotation, offset);
    add(dag, body.position, turned)
}

fn center(dag: &Dag, link: &Link) -> Vector {
    link.body.map_or(zero(dag), |body| body.com)
}

/// Frame 0 as a link that rests.
fn resting(dag: &Dag) -> BodySymbols {
    let rest = zero(dag);
    let rotation = identity(dag);
    BodySymbols { position: rest, rotation, velocity: rest, angular_velocity: rest }
}

fn symbols(dag: &mut Dag, link: &str) -> BodySymbols {
    use SymbolClass::{Configuration, Rate};
    let mut vector = |letter: &str, class| {
        [1, 2, 3].map(|k| fresh_symbol(dag, format!("{letter}{k}_{link}"), class))
    };
    let position = vector("p", Configuration);
    let rotation = ["r1", "r2", "r3"].map(|row| vector(row, Configuration));
    let velocity = vector("v", Rate);
    BodySymbols { position, rotation, velocity, angular_velocity: vector("w", Rate) }
}

/// The symbol, under a longer name where the model has taken this one for something else.
fn fresh_symbol(dag: &mut Dag, mut name: String, class: SymbolClass) -> ExprId {
    while dag.find_symbol(&name).is_some_and(|id| dag.symbols()[id].class != class) {
        name.push('_');
    }
    dag.symbol(&name, class)
}
