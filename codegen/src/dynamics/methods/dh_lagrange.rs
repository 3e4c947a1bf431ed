//! Lagrange-Euler on Denavit-Hartenberg frames (thesis 2.2.4, equations 2.18-2.43).
//!
//! A tree is taken apart into its chains from frame 0 to each tip, as the thesis takes a humanoid
//! into two legs on one virtual chain. Each chain gives its transforms and geometric Jacobians by
//! itself; the Jacobians are merged into the columns of the whole robot (2.30-2.35), and a body
//! that several chains share is counted once.
//!
//! Corrected on the way: the factor 1/2 that (2.39) omits, the sign of (2.40) for a gravity vector
//! that points down, and (2.42), whose factor of qd_j is a C but not the Christoffel one.

use super::extract::RigidBody;
use super::frames::{Coordinates, central_tensor, free_fall, row_variables};
use super::linear::{add_lists, apply, apply_rows, inner, multiply, partial};
use super::{Method, MethodResult};
use crate::arena::SecondaryMap;
use crate::expr::{Dag, ExprId};
use crate::model::{Body, Convention, Joint, JointKind, LinkId, Robot};
use crate::number::ratio;
use crate::spatial::{Matrix, Vector, add, cross, dot, scale, subtract, transpose, zero};

/// A homogeneous transform by rows.
pub type Transform = [[ExprId; 4]; 4];

/// Which C is taken out of the velocity terms of (2.42).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CoriolisForm {
    /// `1/2 sum_k (dd_ij/dq_k + dd_ik/dq_j - dd_jk/dq_i) qd_k`: dD/dt - 2 C is skew.
    Christoffel,
    /// `sum_k (dd_ij/dq_k - 1/2 dd_kj/dq_i) qd_k`, what (2.42) shows: the same C qd, but in general
    /// neither A.18 nor skew. For comparison with the thesis only.
    AsPrinted,
}

/// Derives the equations of motion by (2.18)-(2.43), with the Christoffel C.
pub fn derive(dag: &mut Dag, robot: &Robot) -> MethodResult {
    derive_with(dag, robot, CoriolisForm::Christoffel)
}

/// Derives the equations of motion by (2.18)-(2.43).
pub fn derive_with(dag: &mut Dag, robot: &Robot, form: CoriolisForm) -> MethodResult {
    let at = Coordinates::of(robot);
    let (mass_matrix, potential) = mass_and_potential(dag, robot, &at);
    let slopes = mass_slopes(dag, &mass_matrix, &at);
    let coriolis_matrix = coriolis(dag, &slopes, &at, form);
    let gravity: Vec<_> = at.q.iter().map(|&q| partial(dag, &[potential], q)[0]).collect();
    // (2.43)
    let accelerated = apply_rows(dag, &mass_matrix, &at.qdd);
    let moving = apply_rows(dag, &coriolis_matrix, &at.qd);
    let inertial = add_lists(dag, &accelerated, &moving);
    let torque = add_lists(dag, &inertial, &gravity);
    RigidBody { mass_matrix, coriolis_matrix, gravity, torque }.with_joint_terms(
        dag,
        robot,
        Method::DhLagrange,
    )
}

/// A_i of (2.18), or its like for the modified convention: frame i seen from frame i-1.
pub fn row_transform(dag: &mut Dag, convention: Convention, joint: &Joint) -> Transform {
    let (theta, d) = row_variables(dag, joint);
    let (ct, st) = (dag.cos(theta), dag.sin(theta));
    let (ca, sa) = (dag.cos(joint.alpha), dag.sin(joint.alpha));
    let (zero, one, a) = (dag.zero(), dag.one(), joint.a);
    let (minus_st, minus_sa) = (dag.neg(st), dag.neg(sa));
    let mut mul = |x, y| dag.mul(x, y);
    match convention {
        Convention::Standard => [
            [ct, mul(minus_st, ca), mul(st, sa), mul(a, ct)],
            [st, mul(ct, ca), mul(ct, minus_sa), mul(a, st)],
            [zero, sa, ca, d],
            [zero, zero, zero, one],
        ],
        Convention::Modified => [
            [ct, minus_st, zero, a],
            [mul(st, ca), mul(ct, ca), minus_sa, mul(minus_sa, d)],
            [mul(st, sa), mul(ct, sa), ca, mul(ca, d)],
            [zero, zero, zero, one],
        ],
    }
}

/// The chain from frame 0 to one tip.
struct Chain {
    links: Vec<LinkId>,
    /// T of (2.19): frame 0 first, then one for each link.
    transforms: Vec<Transform>,
}

impl Chain {
    fn new(dag: &mut Dag, robot: &Robot, links: Vec<LinkId>) -> Self {
        let (zero, one) = (dag.zero(), dag.one());
        let mut last = [[zero; 4]; 4];
        (0..4).for_each(|k| last[k][k] = one);
        let mut transforms = vec![last];
        for &link in &links {
            let row = row_transform(dag, robot.convention, &robot.links[link].joint);
            last = product(dag, &last, &row);
            transforms.push(last);
        }
        Self { links, transforms }
    }

    /// The Jacobian columns (2.25-2.28) of the centre of mass of the chain's link number `i`: for
    /// each moving joint up to it, linear and angular.
    fn columns(
        &self,
        dag: &mut Dag,
        robot: &Robot,
        i: usize,
        center: Vector,
    ) -> Vec<(LinkId, [Vector; 2])> {
        let moving = |joint: &Joint| joint.variables.is_some();
        let mut columns = Vec::new();
        for (j, &link) in self.links[..=i].iter().enumerate() {
            let joint = &robot.links[link].joint;
            // z and o of frame j-1 carry the joint of link j; of frame j in the modified convention
            let carrier = match robot.convention {
                Convention::Standard => &self.transforms[j],
                Convention::Modified => &self.transforms[j + 1],
            };
            let axis = [carrier[0][2], carrier[1][2], carrier[2][2]];
            let column = match joint.kind {
                JointKind::Prismatic => [axis, zero(dag)],
                JointKind::Revolute => {
                    let arm = subtract(dag, center, origin(carrier));
                    [cross(dag, axis, arm), axis]
                }
                JointKind::Fixed => continue,
            };
            if moving(joint) {
                columns.push((link, column));
            }
        }
        columns
    }
}

/// D of (2.37) and P of (2.40).
fn mass_and_potential(
    dag: &mut Dag,
    robot: &Robot,
    at: &Coordinates,
) -> (Vec<Vec<ExprId>>, ExprId) {
    let (n, zero) = (at.q.len(), dag.zero());
    let mut mass_matrix = vec![vec![zero; n]; n];
    let mut potential = zero;
    let free_fall = free_fall(dag, robot);
    let mut counted = SecondaryMap::filled(false, robot.links.len());
    for tip in robot.tree.tips() {
        let chain = Chain::new(dag, robot, robot.tree.path(tip));
        for (i, &link) in chain.links.iter().enumerate() {
            let Some(body) = robot.links[link].body.filter(|_| !counted[link]) else { continue };
            counted.set(link, true);
            let transform = &chain.transforms[i + 1];
            // (2.20)
            let turned = apply(dag, rotation(transform), body.com);
            let center = add(dag, origin(transform), turned);
            let columns = chain.columns(dag, robot, i, center);
            let jacobian = merged(dag, at, &columns);
            add_body_mass(dag, &mut mass_matrix, &body, transform, &jacobian);
            // P = -sum m g . o_c: g is the acceleration of free fall
            let height = dot(dag, free_fall, center);
            let weight = dag.mul(body.mass, height);
            potential = dag.sub(potential, weight);
        }
    }
    (mass_matrix, potential)
}

/// The columns of one chain in their places among those of all joints (2.30-2.35).
fn merged(dag: &Dag, at: &Coordinates, columns: &[(LinkId, [Vector; 2])]) -> Vec<[Vector; 2]> {
    let nothing = [zero(dag); 2];
    let of_joint = |joint: &LinkId| {
        columns.iter().find(|(link, _)| link == joint).map_or(nothing, |&(_, column)| column)
    };
    at.links.iter().map(of_joint).collect()
}

/// Adds `m Jv^T Jv + Jw^T R I R^T Jw` (2.37).
fn add_body_mass(
    dag: &mut Dag,
    mass_matrix: &mut [Vec<ExprId>],
    body: &Body,
    transform: &Transform,
    jacobian: &[[Vector; 2]],
) {
    let central = central_tensor(dag, body);
    let turned = multiply(dag, rotation(transform), central);
    let tensor = multiply(dag, turned, transpose(rotation(transform)));
    for (j, &[linear, angular]) in jacobian.iter().enumerate() {
        let momentum = scale(dag, body.mass, linear);
        let spin = apply(dag, tensor, angular);
        for (i, &[linear, angular]) in jacobian[..=j].iter().enumerate() {
            let (along, about) = (dot(dag, linear, momentum), dot(dag, angular, spin));
            let entry = dag.add(along, about);
            mass_matrix[i][j] = dag.add(mass_matrix[i][j], entry);
            mass_matrix[j][i] = mass_matrix[i][j];
        }
    }
}

/// dd_ij / dq_k, as `slopes[k][i][j]`.
fn mass_slopes(
    dag: &mut Dag,
    mass_matrix: &[Vec<ExprId>],
    at: &Coordinates,
) -> Vec<Vec<Vec<ExprId>>> {
    let n = at.q.len();
    let entries = mass_matrix.concat();
    at.q.iter()
        .map(|&q| partial(dag, &entries, q).chunks(n).map(<[ExprId]>::to_vec).collect())
        .collect()
}

/// C from the slopes of D.
fn coriolis(
    dag: &mut Dag,
    slopes: &[Vec<Vec<ExprId>>],
    at: &Coordinates,
    form: CoriolisForm,
) -> Vec<Vec<ExprId>> {
    let n = at.q.len();
    let half = dag.constant(ratio(1, 2));
    let entry = |dag: &mut Dag, i: usize, j: usize| {
        let symbols: Vec<_> = (0..n)
            .map(|k| match form {
                CoriolisForm::Christoffel => {
                    let sum = dag.add(slopes[k][i][j], slopes[j][i][k]);
                    let doubled = dag.sub(sum, slopes[i][j][k]);
                    dag.mul(half, doubled)
                }
                CoriolisForm::AsPrinted => {
                    let halved = dag.mul(half, slopes[i][k][j]);
                    dag.sub(slopes[k][i][j], halved)
                }
            })
            .collect();
        inner(dag, &symbols, &at.qd)
    };
    (0..n).map(|i| (0..n).map(|j| entry(dag, i, j)).collect()).collect()
}

fn product(dag: &mut Dag, a: &Transform, b: &Transform) -> Transform {
    [0, 1, 2, 3].map(|row| {
        [0, 1, 2, 3].map(|column| {
            let entries = [0, 1, 2, 3].map(|k| b[k][column]);
            inner(dag, &a[row], &entries)
        })
    })
}

fn rotation(transform: &Transform) -> Matrix {
    [0, 1, 2].map(|row| [0, 1, 2].map(|column| transform[row][column]))
}

fn origin(transform: &Transform) -> Vector {
    [0, 1, 2].map(|row| transform[row][3])
}
