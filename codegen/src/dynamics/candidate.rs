//! The outputs of every function in one formulation.

use super::articulated;
use super::composite::{composites, gravity_vector, mass_matrix};
use super::coriolis::{coriolis_matrix, inverse_derivatives};
use super::energy;
use super::forward::Factors;
use super::inverse::inverse_dynamics;
use super::joint_torque::{JointTerms, slope};
use super::motion::{Terms, motion, multiply};
use crate::expr::{Dag, ExprId, substitute};
use crate::kinematics::{Frames, Mechanism, World, center_of_mass_column};
use crate::model::{LinkId, Robot};
use crate::spatial::add;
use rustc_hash::FxHashMap;

/// One formulation of a robot: everything that its functions are made of.
pub(super) struct Candidate<'a> {
    pub(super) robot: &'a Robot,
    pub(super) mechanism: &'a Mechanism,
    pub(super) frames: &'a Frames,
    pub(super) joints: &'a [JointTerms],
}

/// How D x = b is solved.
#[derive(Clone, Copy)]
pub(super) enum Solver {
    /// Factorise D.
    Factorise,
    /// Articulated bodies.
    Articulated,
}

impl Candidate<'_> {
    pub(super) fn terms(&self) -> Terms {
        let terms = self.robot.terms;
        Terms { rates: terms.coriolis, accelerations: terms.inertia, gravity: terms.gravity }
    }

    /// The frames with the matter of the bodies themselves, which regrouping gives in part to the
    /// bodies that carry them.
    pub(super) fn with_own_matter(&self, dag: &mut Dag) -> Frames {
        let bodies = Mechanism::new(dag, self.robot).bodies;
        let mut own = self.frames.clone();
        for (frame, body) in own.frames.iter_mut().zip(bodies) {
            frame.inertia = match frame.attachment {
                Some(turn) => body.inertia.turned(dag, &turn),
                None => body.inertia,
            };
        }
        own
    }

    pub(super) fn inverse_dynamics(&self, dag: &mut Dag) -> Vec<ExprId> {
        let rigid = inverse_dynamics(dag, self.frames, self.terms());
        let mut torques = rigid.clone();
        for (i, joint) in self.joints.iter().enumerate() {
            let qdd = self.frames.frames[i].variables.qdd;
            let rotor = dag.mul(joint.rotor, qdd);
            let own = dag.add(torques[i], rotor);
            torques[i] = dag.add(own, joint.torque);
        }
        let implicit: Vec<ExprId> = self.joints.iter().map(|joint| joint.implicit).collect();
        let implicit = self.with_loads(dag, &implicit, &rigid);
        torques.iter().zip(implicit).map(|(&torque, implicit)| dag.add(torque, implicit)).collect()
    }

    /// Rates of the states of added effects.
    pub(super) fn state_rates(&self, dag: &mut Dag) -> Vec<ExprId> {
        let rates: Vec<ExprId> = self.robot.law_states().map(|state| state.rate).collect();
        let rigid = inverse_dynamics(dag, self.frames, self.terms());
        self.with_loads(dag, &rates, &rigid)
    }

    /// Expressions of laws with the rigid-body torques in place of the symbols of loads.
    fn with_loads(&self, dag: &mut Dag, exprs: &[ExprId], rigid: &[ExprId]) -> Vec<ExprId> {
        let mut loads = FxHashMap::default();
        for &(joint, symbol) in self.robot.laws.iter().flat_map(|law| &law.loads) {
            let row = self.robot.joints().position(|(link, _)| link == joint);
            loads.insert(symbol, rigid[row.expect("loads are those of moving joints")]);
        }
        if loads.is_empty() { exprs.to_vec() } else { substitute(dag, exprs, &loads) }
    }

    /// Everything but D qdd.
    pub(super) fn bias(&self, dag: &mut Dag) -> Vec<ExprId> {
        let mut torques = self.rigid_bias(dag);
        for (i, joint) in self.joints.iter().enumerate() {
            torques[i] = dag.add(torques[i], joint.torque);
        }
        torques
    }

    fn rigid_bias(&self, dag: &mut Dag) -> Vec<ExprId> {
        inverse_dynamics(dag, self.frames, Terms { accelerations: false, ..self.terms() })
    }

    pub(super) fn mass_matrix(&self, dag: &mut Dag) -> Vec<Vec<ExprId>> {
        let n = self.frames.len();
        let mut d = if self.robot.terms.inertia {
            let composites = composites(dag, self.frames);
            mass_matrix(dag, self.frames, &composites)
        } else {
            vec![vec![dag.zero(); n]; n]
        };
        for (i, joint) in self.joints.iter().enumerate() {
            d[i][i] = dag.add(d[i][i], joint.rotor);
        }
        d
    }

    pub(super) fn coriolis_matrix(&self, dag: &mut Dag) -> Vec<Vec<ExprId>> {
        let n = self.frames.len();
        if self.robot.terms.coriolis {
            coriolis_matrix(dag, self.frames)
        } else {
            vec![vec![dag.zero(); n]; n]
        }
    }

    /// G from composites, or by inverse dynamics at rest.
    pub(super) fn gravity_vector(&self, dag: &mut Dag, by_composites: bool) -> Vec<ExprId> {
        if !self.robot.terms.gravity {
            return vec![dag.zero(); self.frames.len()];
        }
        if by_composites {
            let composites = composites(dag, self.frames);
            return gravity_vector(dag, self.frames, &composites);
        }
        let rest = Terms { rates: false, accelerations: false, gravity: true };
        inverse_dynamics(dag, self.frames, rest)
    }

    pub(super) fn solve(&self, dag: &mut Dag, right: &[ExprId]) -> Vec<ExprId> {
        let d = self.mass_matrix(dag);
        Factors::new(dag, self.frames, &d).solve(dag, right)
    }

    pub(super) fn forward_dynamics(
        &self,
        dag: &mut Dag,
        torques: &[ExprId],
        solver: Solver,
    ) -> Vec<ExprId> {
        let driving: Vec<_> =
            torques.iter().zip(self.joints).map(|(&tau, own)| dag.sub(tau, own.torque)).collect();
        match solver {
            Solver::Factorise => {
                let bias = self.rigid_bias(dag);
                let right: Vec<_> =
                    driving.iter().zip(bias).map(|(&tau, bias)| dag.sub(tau, bias)).collect();
                self.solve(dag, &right)
            }
            Solver::Articulated => {
                let rotors: Vec<_> = self.joints.iter().map(|joint| joint.rotor).collect();
                articulated::forward_dynamics(dag, self.frames, &driving, &rotors)
            }
        }
    }

    /// dtau/dq and dtau/dqd at the given accelerations (none: the symbols qdd).
    pub(super) fn inverse_derivatives(
        &self,
        dag: &mut Dag,
        accelerations: Option<&[ExprId]>,
    ) -> [Vec<Vec<ExprId>>; 2] {
        let derivatives = inverse_derivatives(dag, self.frames, self.terms(), accelerations);
        let (mut by_position, mut by_rate) = (derivatives.by_position, derivatives.by_rate);
        for (i, joint) in self.joints.iter().enumerate() {
            let variables = self.frames.frames[i].variables;
            let stiffness = slope(dag, joint.torque, variables.q);
            by_position[i][i] = dag.add(by_position[i][i], stiffness);
            let damping = slope(dag, joint.torque, variables.qd);
            by_rate[i][i] = dag.add(by_rate[i][i], damping);
            if self.robot.laws.is_empty() {
                continue;
            }
            // a law of a pair of joints
            for k in (0..self.frames.len()).filter(|&k| k != i) {
                let variables = self.frames.frames[k].variables;
                let stiffness = slope(dag, joint.torque, variables.q);
                by_position[i][k] = dag.add(by_position[i][k], stiffness);
                let damping = slope(dag, joint.torque, variables.qd);
                by_rate[i][k] = dag.add(by_rate[i][k], damping);
            }
            // an inertia that a law varies with positions
            let own = self.frames.frames[i].variables.qdd;
            let qdd = accelerations.map_or(own, |given| given[i]);
            for k in 0..self.frames.len() {
                let change = slope(dag, joint.rotor, self.frames.frames[k].variables.q);
                let change = dag.mul(change, qdd);
                by_position[i][k] = dag.add(by_position[i][k], change);
            }
        }
        [by_position, by_rate]
    }

    /// dqdd/dq, dqdd/dqd, dqdd/dtau, where `accelerations` is qdd of the torques.
    pub(super) fn forward_derivatives(
        &self,
        dag: &mut Dag,
        accelerations: &[ExprId],
    ) -> [Vec<Vec<ExprId>>; 3] {
        let n = self.frames.len();
        let d = self.mass_matrix(dag);
        let factors = Factors::new(dag, self.frames, &d);
        let solve_columns = |dag: &mut Dag, columns: Vec<Vec<ExprId>>| {
            let solved: Vec<_> = columns.iter().map(|right| factors.solve(dag, right)).collect();
            (0..n).map(|i| (0..n).map(|j| solved[j][i]).collect()).collect::<Vec<Vec<_>>>()
        };
        let [by_position, by_rate] = self.inverse_derivatives(dag, Some(accelerations));
        let [by_position, by_rate] = [by_position, by_rate].map(|matrix| {
            let columns = (0..n)
                .map(|j| (0..n).map(|i| dag.neg(matrix[i][j])).collect())
                .collect::<Vec<Vec<_>>>();
            solve_columns(dag, columns)
        });
        let units = (0..n)
            .map(|j| (0..n).map(|i| if i == j { dag.one() } else { dag.zero() }).collect())
            .collect();
        let inverse: Vec<Vec<ExprId>> = solve_columns(dag, units);
        // D^-1 is symmetric: one triangle serves both.
        let inverse = (0..n).map(|i| (0..n).map(|j| inverse[i.max(j)][i.min(j)]).collect());
        [by_position, by_rate, inverse.collect()]
    }

    /// Rows of [R | o] of every link frame, link by link.
    pub(super) fn link_transforms(&self, dag: &mut Dag) -> Vec<ExprId> {
        let world = World::new(dag, self.frames);
        let mut entries = Vec::new();
        for link in self.robot.links.keys() {
            let (axes, origin) = world.placement(dag, &self.mechanism.placements[link]);
            for row in 0..3 {
                entries.extend([axes[0][row], axes[1][row], axes[2][row], origin[row]]);
            }
        }
        entries
    }

    /// The 6 x n geometric Jacobian of a link frame: three linear rows, three angular ones.
    pub(super) fn link_jacobian(&self, dag: &mut Dag, link: LinkId) -> Vec<ExprId> {
        let n = self.frames.len();
        let world = World::new(dag, self.frames);
        let placement = &self.mechanism.placements[link];
        let (_, origin) = world.placement(dag, placement);
        let mut rows = vec![vec![dag.zero(); n]; 6];
        for j in world.chain(placement.body) {
            let linear = world.linear_column(dag, j, origin);
            let angular = world.angular_column(dag, j);
            for k in 0..3 {
                rows[k][j] = linear[k];
                rows[3 + k][j] = angular[k];
            }
        }
        rows.concat()
    }

    /// World positions of the contact points, point by point.
    pub(super) fn contact_positions(&self, dag: &mut Dag) -> Vec<ExprId> {
        let world = World::new(dag, self.frames);
        let contacts = self.robot.contacts.values();
        contacts
            .flat_map(|contact| {
                let placement = &self.mechanism.placements[contact.link];
                let local = world.in_carrier(dag, placement, contact.position);
                world.point(dag, placement.body, local)
            })
            .collect()
    }

    /// W^T: three rows x, y, z for each contact point.
    pub(super) fn contact_jacobian(&self, dag: &mut Dag) -> Vec<ExprId> {
        let n = self.frames.len();
        let world = World::new(dag, self.frames);
        let mut entries = Vec::new();
        for contact in self.robot.contacts.values() {
            let placement = &self.mechanism.placements[contact.link];
            let local = world.in_carrier(dag, placement, contact.position);
            let point = world.point(dag, placement.body, local);
            let mut rows = vec![vec![dag.zero(); n]; 3];
            for j in world.chain(placement.body) {
                let column = world.linear_column(dag, j, point);
                (0..3).for_each(|k| rows[k][j] = column[k]);
            }
            entries.extend(rows.concat());
        }
        entries
    }

    /// (d/dt W^T) qd: the accelerations of the contact points at qdd = 0.
    pub(super) fn contact_bias(&self, dag: &mut Dag) -> Vec<ExprId> {
        let world = World::new(dag, self.frames);
        let terms = Terms { rates: true, accelerations: false, gravity: false };
        let motion = motion(dag, self.frames, terms, None);
        let mut entries = Vec::new();
        for contact in self.robot.contacts.values() {
            let placement = &self.mechanism.placements[contact.link];
            let Some(body) = placement.body else {
                entries.extend([dag.zero(); 3]);
                continue;
            };
            let local = world.in_carrier(dag, placement, contact.position);
            let spread = multiply(dag, motion.spread[body], local);
            let acceleration = add(dag, motion.linear[body], spread);
            entries.extend(world.vector(dag, Some(body), acceleration));
        }
        entries
    }

    pub(super) fn center_of_mass(&self, dag: &mut Dag) -> Vec<ExprId> {
        energy::center_of_mass(dag, self.frames).to_vec()
    }

    /// 3 x n.
    pub(super) fn center_of_mass_jacobian(&self, dag: &mut Dag) -> Vec<ExprId> {
        let n = self.frames.len();
        let fractions = energy::per_total_mass(dag, self.frames);
        let composites = composites(dag, &fractions);
        let world = World::new(dag, self.frames);
        let columns: Vec<_> =
            (0..n).map(|j| center_of_mass_column(dag, &world, j, &composites[j])).collect();
        (0..3).flat_map(|k| columns.iter().map(move |column| column[k])).collect()
    }

    /// Linear and angular momentum.
    pub(super) fn momentum(&self, dag: &mut Dag) -> [Vec<ExprId>; 2] {
        energy::momentum(dag, self.frames).map(|momentum| momentum.to_vec())
    }

    /// Bodies and rotors.
    pub(super) fn kinetic_energy(&self, dag: &mut Dag) -> ExprId {
        let half = dag.constant(crate::number::ratio(1, 2));
        let mut energy = energy::kinetic_energy(dag, self.frames);
        for (i, joint) in self.joints.iter().enumerate() {
            let qd = self.frames.frames[i].variables.qd;
            let square = dag.mul(qd, qd);
            let half_rotor = dag.mul(half, joint.rotor);
            let rotor = dag.mul(half_rotor, square);
            energy = dag.add(energy, rotor);
        }
        energy
    }

    /// Gravity and springs.
    pub(super) fn potential_energy(&self, dag: &mut Dag) -> ExprId {
        let composites = composites(dag, self.frames);
        let gravity = energy::potential_energy(dag, self.frames, &composites);
        self.joints.iter().fold(gravity, |energy, joint| dag.add(energy, joint.energy))
    }
}
