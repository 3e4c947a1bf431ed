//! D, C and G out of torques: which term is which is decided by what it depends on.

use super::frames::Coordinates;
use super::linear::{add_lists, jacobian};
use super::{Method, MethodResult, joint_terms};
use crate::expr::{Dag, ExprId, substitute};
use crate::model::{Robot, Terms};
use crate::number::ratio;
use rustc_hash::FxHashMap;

/// The rigid-body part of the equations, all terms of it.
pub(super) struct RigidBody {
    /// D without rotors.
    pub(super) mass_matrix: Vec<Vec<ExprId>>,
    /// C.
    pub(super) coriolis_matrix: Vec<Vec<ExprId>>,
    /// G.
    pub(super) gravity: Vec<ExprId>,
    /// D qdd + C qd + G, as the method arrives at it.
    pub(super) torque: Vec<ExprId>,
}

impl RigidBody {
    /// Splits torques: D = d tau / d qdd, G = tau at rest, and C from the rest.
    pub(super) fn from_torque(dag: &mut Dag, at: &Coordinates, torque: Vec<ExprId>) -> Self {
        let mass_matrix = jacobian(dag, &torque, &at.qdd);
        let unaccelerated = without(dag, &torque, &at.qdd);
        let gravity = without(dag, &unaccelerated, &at.qd);
        let coriolis_matrix = coriolis_matrix(dag, at, &unaccelerated);
        Self { mass_matrix, coriolis_matrix, gravity, torque }
    }

    /// The terms that the model has, with rotors and joint torques by their laws of force.
    pub(super) fn with_joint_terms(
        self,
        dag: &mut Dag,
        robot: &Robot,
        method: Method,
    ) -> MethodResult {
        let at = Coordinates::of(robot);
        let Self { mut mass_matrix, coriolis_matrix, gravity, torque } =
            self.restricted(dag, &at, robot.terms);
        let drive_torque = joint_terms::drive_torques(dag, robot);
        let mut inverse_dynamics = add_lists(dag, &torque, &drive_torque);
        let rotors = joint_terms::reflected_inertias(dag, robot);
        for (j, rotor) in rotors.into_iter().enumerate() {
            mass_matrix[j][j] = dag.add(mass_matrix[j][j], rotor);
            let accelerated = dag.mul(rotor, at.qdd[j]);
            inverse_dynamics[j] = dag.add(inverse_dynamics[j], accelerated);
        }
        MethodResult {
            method,
            mass_matrix,
            coriolis_matrix,
            gravity,
            drive_torque,
            inverse_dynamics,
        }
    }

    /// The same without the terms that the model does not have; gravity the methods leave out
    /// themselves.
    pub(super) fn restricted(mut self, dag: &mut Dag, at: &Coordinates, terms: Terms) -> Self {
        let zero = dag.zero();
        if !terms.coriolis {
            self.torque = without(dag, &self.torque, &at.qd);
            self.coriolis_matrix.iter_mut().for_each(|row| row.fill(zero));
        }
        if !terms.inertia {
            self.torque = without(dag, &self.torque, &at.qdd);
            self.mass_matrix.iter_mut().for_each(|row| row.fill(zero));
        }
        self
    }
}

/// C out of torques at qdd = 0. They are h(q, qd) + G with h_i = c_ijk qd_j qd_k and Christoffel
/// symbols c_ijk, which are symmetric in j and k: so C_ij = c_ijk qd_k is half of dh_i / d qd_j.
pub(super) fn coriolis_matrix(
    dag: &mut Dag,
    at: &Coordinates,
    unaccelerated: &[ExprId],
) -> Vec<Vec<ExprId>> {
    let half = dag.constant(ratio(1, 2));
    let mut matrix = jacobian(dag, unaccelerated, &at.qd);
    matrix.iter_mut().flatten().for_each(|entry| *entry = dag.mul(half, *entry));
    matrix
}

/// The expressions with the symbols set to 0.
pub(super) fn without(dag: &mut Dag, outputs: &[ExprId], symbols: &[ExprId]) -> Vec<ExprId> {
    let zero = dag.zero();
    let zeros: FxHashMap<_, _> = symbols.iter().map(|&symbol| (symbol, zero)).collect();
    substitute(dag, outputs, &zeros)
}
