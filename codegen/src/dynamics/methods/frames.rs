//! Where the links, their joints and their centres of mass are in the world.

use super::linear::{apply, identity, multiply};
use crate::arena::Handle;
use crate::expr::{Dag, ExprId};
use crate::model::{About, Body, Convention, Joint, JointKind, JointVariables, LinkId, Robot};
use crate::spatial::{Matrix, Vector, add, zero};

/// A frame seen from another one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Coordinates in this frame to coordinates in the other one.
    pub(super) rotation: Matrix,
    /// Origin in the other frame \[m\].
    pub(super) origin: Vector,
}

impl Frame {
    /// The other frame itself.
    pub(super) fn identity(dag: &Dag) -> Self {
        Self { rotation: identity(dag), origin: zero(dag) }
    }

    /// A frame seen from this one, as the other frame sees it.
    fn then(&self, dag: &mut Dag, next: &Self) -> Self {
        let origin = self.point(dag, next.origin);
        Self { rotation: multiply(dag, self.rotation, next.rotation), origin }
    }

    /// A point of this frame, as the other frame sees it.
    pub(super) fn point(&self, dag: &mut Dag, point: Vector) -> Vector {
        let turned = apply(dag, self.rotation, point);
        add(dag, self.origin, turned)
    }

    /// The z axis.
    pub(super) fn axis(&self) -> Vector {
        [0, 1, 2].map(|row| self.rotation[row][2])
    }
}

/// A link in the world, and the joint that carries it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placement {
    /// The link frame.
    pub(super) frame: Frame,
    /// Direction of the joint axis: z of frame i-1 (standard) or of frame i (modified).
    pub(super) axis: Vector,
    /// A point of the joint axis \[m\].
    pub(super) joint_origin: Vector,
}

/// The placements of all links, in link order.
pub(super) fn placements(dag: &mut Dag, robot: &Robot) -> Vec<Placement> {
    let mut placements: Vec<Placement> = Vec::with_capacity(robot.links.len());
    for link in robot.links.values() {
        let parent = match link.parent {
            Some(parent) => placements[parent.index()].frame,
            None => Frame::identity(dag),
        };
        let row = row_frame(dag, robot.convention, &link.joint);
        let frame = parent.then(dag, &row);
        let carrier = match robot.convention {
            Convention::Standard => parent,
            Convention::Modified => frame,
        };
        let (axis, joint_origin) = (carrier.axis(), carrier.origin);
        placements.push(Placement { frame, axis, joint_origin });
    }
    placements
}

/// Frame i seen from frame i-1: a row of the table with its joint variable.
fn row_frame(dag: &mut Dag, convention: Convention, joint: &Joint) -> Frame {
    let (theta, d) = row_variables(dag, joint);
    let (ct, st) = (dag.cos(theta), dag.sin(theta));
    let (ca, sa) = (dag.cos(joint.alpha), dag.sin(joint.alpha));
    let (zero, one) = (dag.zero(), dag.one());
    let about_x = |dag: &mut Dag| [[one, zero, zero], [zero, ca, dag.neg(sa)], [zero, sa, ca]];
    let about_z = |dag: &mut Dag| [[ct, dag.neg(st), zero], [st, ct, zero], [zero, zero, one]];
    let (x, z) = (about_x(dag), about_z(dag));
    match convention {
        Convention::Standard => {
            let rotation = multiply(dag, z, x);
            let origin = [dag.mul(joint.a, ct), dag.mul(joint.a, st), d];
            Frame { rotation, origin }
        }
        Convention::Modified => {
            let rotation = multiply(dag, x, z);
            let origin = apply(dag, x, [joint.a, zero, d]);
            Frame { rotation, origin }
        }
    }
}

/// theta and d of a row, with the joint variable in one of them.
pub(super) fn row_variables(dag: &mut Dag, joint: &Joint) -> (ExprId, ExprId) {
    match (joint.kind, joint.variables) {
        (JointKind::Revolute, Some(variables)) => (dag.add(joint.theta, variables.q), joint.d),
        (JointKind::Prismatic, Some(variables)) => (joint.theta, dag.add(joint.d, variables.q)),
        _ => (joint.theta, joint.d),
    }
}

/// The acceleration of free fall, zero in a model without gravity.
pub(super) fn free_fall(dag: &Dag, robot: &Robot) -> Vector {
    if robot.terms.gravity { robot.gravity } else { zero(dag) }
}

/// The symbols of the moving joints, as lists in joint order.
#[derive(Clone, Debug)]
pub(super) struct Coordinates {
    /// The links of the joints.
    pub(super) links: Vec<LinkId>,
    /// Positions.
    pub(super) q: Vec<ExprId>,
    /// Rates.
    pub(super) qd: Vec<ExprId>,
    /// Accelerations.
    pub(super) qdd: Vec<ExprId>,
}

impl Coordinates {
    /// Those of a robot.
    pub(super) fn of(robot: &Robot) -> Self {
        let list = |pick: fn(&JointVariables) -> ExprId| {
            robot.joints().map(|(_, variables)| pick(variables)).collect()
        };
        Self {
            links: robot.joints().map(|(link, _)| link).collect(),
            q: list(|variables| variables.q),
            qd: list(|variables| variables.qd),
            qdd: list(|variables| variables.qdd),
        }
    }
}

/// The inertia tensor about the centre of mass, in link coordinates: the parallel-axis theorem
/// where the model gives it about the origin.
pub(super) fn central_tensor(dag: &mut Dag, body: &Body) -> Matrix {
    let [xx, yy, zz, xy, xz, yz] = body.inertia;
    let mut tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    if body.about == About::Com {
        return tensor;
    }
    let c = body.com;
    let square = crate::spatial::dot(dag, c, c);
    for (i, row) in tensor.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            // I_com = I_origin - m (c.c 1 - c c^T)
            let product = dag.mul(c[i], c[j]);
            let shift = if i == j { dag.sub(square, product) } else { dag.neg(product) };
            let moved = dag.mul(body.mass, shift);
            *entry = dag.sub(*entry, moved);
        }
    }
    tensor
}
