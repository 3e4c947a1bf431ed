//! TMT in three dimensions (thesis 2.12-2.17, and what 5.2.1 leaves open).
//!
//! The accelerations of the dependent coordinates are written by the independent ones, d'Alembert's
//! principle is applied, and the constraint forces drop out: with the transposes that the thesis
//! omits, `T^T M T qdd = T^T F - T^T M Tdot qd`.
//!
//! The thesis stops in the plane, where each body has one angle. In space three angles have no
//! derivative that is an angular velocity, so the rows of T that belong to a body's orientation are
//! those of its *geometric* Jacobian: T = (dx/dq; Jw) with w = Jw qd. The rows of positions stay
//! what they are. The Euler equation then brings what the plane has not: the mass matrix
//! `diag(m 1, R I R^T)` turns with the body, and the gyroscopic moment `w x R I R^T w` joins F.

use super::extract::{RigidBody, coriolis_matrix};
use super::frames::{Coordinates, Placement, central_tensor, free_fall, placements};
use super::linear::{add_lists, apply, apply_rows, inner, jacobian, multiply, rate};
use super::{Method, MethodResult};
use crate::arena::Handle;
use crate::expr::{Dag, ExprId};
use crate::model::{Body, JointKind, LinkId, Robot};
use crate::spatial::{Matrix, Vector, add, cross, scale, transpose, zero};

/// Derives the equations of motion by TMT.
pub fn derive(dag: &mut Dag, robot: &Robot) -> MethodResult {
    let at = Coordinates::of(robot);
    let n = at.q.len();
    let placements = placements(dag, robot);
    let zero = dag.zero();
    let mut mass_matrix = vec![vec![zero; n]; n];
    let mut bias = vec![zero; n];
    let mut gravity = vec![zero; n];
    let free_fall = free_fall(dag, robot);
    for (link, body) in robot.links.iter().filter_map(|(id, link)| Some((id, link.body?))) {
        let block = Block::new(dag, robot, &at, &placements, link, &body);
        block.add_mass(dag, &mut mass_matrix);
        let inertial = block.velocity_forces(dag, &at);
        bias = block.add_projected(dag, &bias, &inertial);
        let weight = scale(dag, body.mass, free_fall).map(|force| dag.neg(force));
        gravity = block.add_projected(dag, &gravity, &[weight, [zero; 3]].concat());
    }
    let coriolis_matrix = coriolis_matrix(dag, &at, &bias);
    let accelerated = apply_rows(dag, &mass_matrix, &at.qdd);
    let moving = add_lists(dag, &accelerated, &bias);
    let torque = add_lists(dag, &moving, &gravity);
    RigidBody { mass_matrix, coriolis_matrix, gravity, torque }.with_joint_terms(
        dag,
        robot,
        Method::Tmt,
    )
}

/// The six rows of T and the block of M that belong to one body.
struct Block {
    /// Rows x, y, z, wx, wy, wz; one column for each joint.
    rows: Vec<Vec<ExprId>>,
    mass: ExprId,
    /// R I R^T about the centre of mass, in world axes.
    tensor: Matrix,
}

impl Block {
    fn new(
        dag: &mut Dag,
        robot: &Robot,
        at: &Coordinates,
        placements: &[Placement],
        link: LinkId,
        body: &Body,
    ) -> Self {
        let frame = &placements[link.index()].frame;
        let position = frame.point(dag, body.com);
        let mut rows = jacobian(dag, &position, &at.q);
        rows.extend(geometric_rows(dag, robot, at, placements, link));
        let central = central_tensor(dag, body);
        let turned = multiply(dag, frame.rotation, central);
        let tensor = multiply(dag, turned, transpose(frame.rotation));
        Self { rows, mass: body.mass, tensor }
    }

    /// Adds T^T M T of this body; symmetric, so that only one half is computed.
    fn add_mass(&self, dag: &mut Dag, mass_matrix: &mut [Vec<ExprId>]) {
        let n = mass_matrix.len();
        let columns: Vec<_> = (0..n).map(|j| self.column(j)).collect();
        for j in 0..n {
            let momentum = self.weighted(dag, &columns[j]);
            for i in 0..=j {
                let entry = inner(dag, &columns[i], &momentum);
                mass_matrix[i][j] = dag.add(mass_matrix[i][j], entry);
                mass_matrix[j][i] = mass_matrix[i][j];
            }
        }
    }

    /// M Tdot qd and the gyroscopic moment: the forces of motion without acceleration of q.
    fn velocity_forces(&self, dag: &mut Dag, at: &Coordinates) -> Vec<ExprId> {
        let velocity = apply_rows(dag, &self.rows, &at.qd);
        // d/dq (T qd) qd of (2.12): qd rests while q moves at it
        let convective = rate(dag, &velocity, &at.q, &at.qd);
        let force = self.weighted(dag, &convective);
        let spin: Vector = [velocity[3], velocity[4], velocity[5]];
        let angular_momentum = apply(dag, self.tensor, spin);
        let gyroscopic = cross(dag, spin, angular_momentum);
        let moment = add(dag, [force[3], force[4], force[5]], gyroscopic);
        [&force[..3], &moment[..]].concat()
    }

    /// `sum + T^T force`.
    fn add_projected(&self, dag: &mut Dag, sum: &[ExprId], force: &[ExprId]) -> Vec<ExprId> {
        let projected: Vec<_> =
            (0..sum.len()).map(|j| inner(dag, &self.column(j), force)).collect();
        add_lists(dag, sum, &projected)
    }

    /// The body's block of M times a column.
    fn weighted(&self, dag: &mut Dag, column: &[ExprId]) -> Vec<ExprId> {
        let linear = scale(dag, self.mass, [column[0], column[1], column[2]]);
        let angular = apply(dag, self.tensor, [column[3], column[4], column[5]]);
        [linear, angular].concat()
    }

    fn column(&self, j: usize) -> Vec<ExprId> {
        self.rows.iter().map(|row| row[j]).collect()
    }
}

/// The orientation rows of T: the axes of the turning joints that carry the link.
fn geometric_rows(
    dag: &Dag,
    robot: &Robot,
    at: &Coordinates,
    placements: &[Placement],
    link: LinkId,
) -> [Vec<ExprId>; 3] {
    let path = robot.tree.path(link);
    let columns: Vec<Vector> = at
        .links
        .iter()
        .map(|joint| {
            let turns = robot.links[*joint].joint.kind == JointKind::Revolute;
            let carries = turns && path.contains(joint);
            if carries { placements[joint.index()].axis } else { zero(dag) }
        })
        .collect();
    [0, 1, 2].map(|row| columns.iter().map(|column| column[row]).collect())
}
