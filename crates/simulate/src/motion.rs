//! The equations of motion between two events (thesis 2.43 and 2.50): the set of closed contacts
//! and what each of them does stay as they are.

mod manifold;
mod moved;
mod slipping;

use self::moved::MovedMemory;
pub(super) use self::slipping::SlipMemory;
use super::breakdown::Breakdown;
use super::contact::delassus::Delassus;
use super::contact::solver::ContactSolver;
use super::contact::{Contact, ContactFailure, ContactProblem, Friction, Mode, Tolerance};
use super::control::{Control, ControlMemory};
use super::drive::{DriveOutput, Drives};
use super::ground::Ground;
use super::integrate::Rates;
use super::laws::{Driven, LawForces};
use super::planner::JointPlan;
use super::push::{self, Push};
use super::state::{INTEGRALS, Layout};
use denavit_plants::Plant;
use std::borrow::Cow;

/// A contact that carries force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Closed {
    /// Which contact point.
    pub(super) contact: usize,
    /// Sticks or slips; never open.
    pub(super) mode: Mode,
    /// Its law of friction: that of the contact, or what stands in for it.
    pub(super) law: Friction,
    /// Where it stands along the tangents, if it sticks \[m\].
    pub(super) anchor: [f64; 2],
    /// Whether it has slipped faster than what counts as rest, and so may come to rest.
    pub(super) runs: bool,
}

impl Closed {
    /// The same contact in the same mode, whatever its direction.
    pub(super) fn does_as(&self, other: &Self) -> bool {
        self.contact == other.contact && (self.mode == Mode::Stick) == (other.mode == Mode::Stick)
    }
}

/// How contacts are held together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Holding {
    /// Errors of position and velocity of a closed contact decay at this rate (Baumgarte) [1/s].
    pub(super) drift_rate: f64,
    pub(super) tolerance: Tolerance,
    pub(super) slips: SlipMemory,
}

/// The smooth motion of a plant under control, with the contacts as they are.
pub(super) struct Motion<'a> {
    pub(super) plant: &'a mut dyn Plant,
    /// Borrowed until references are planned anew.
    pub(super) control: Cow<'a, Control>,
    /// The model that the controller computes with, if it is not the plant itself.
    pub(super) believed: Option<&'a mut (dyn Plant + 'static)>,
    pub(super) drives: Drives,
    pub(super) ground: Ground,
    /// Law of each contact point.
    pub(super) friction: Vec<Friction>,
    pub(super) holding: Holding,
    pub(super) layout: Layout,
    pub(super) closed: Vec<Closed>,
    /// Torque held by a sampled controller; none controls continuously.
    pub(super) held: Option<Vec<f64>>,
    /// What pushes from outside.
    pub(super) pushes: &'a [Push],
    /// Whether contacts that stick are held where they stand, not only still. Each of the motions
    /// near one has its own places.
    pub(super) holds_places: bool,
    /// References are those before this time: at it they may jump.
    pub(super) segment_end: f64,
    measured: [Vec<f64>; 2],
    pub(super) solver: ContactSolver,
    pub(super) delassus: Delassus,
    memory: ControlMemory,
    moved: MovedMemory,
    /// Joint positions of which the mass matrix is factored, the contact points are placed, and
    /// their Jacobian is known; the contacts whose rows are those of `work`. Most states come again
    /// with other rates, or another question.
    factored_for: Vec<f64>,
    placed_for: Vec<f64>,
    followed_for: Vec<f64>,
    followed: Vec<usize>,
    pub(super) work: Work,
}

/// Values of the last evaluation.
#[derive(Clone, Debug, Default)]
pub(super) struct Work {
    pub(super) mass: Vec<f64>,
    pub(super) bias: Vec<f64>,
    pub(super) command: Vec<f64>,
    pub(super) drive: DriveOutput,
    pub(super) acceleration: Vec<f64>,
    pub(super) positions: Vec<f64>,
    pub(super) jacobian: Vec<f64>,
    pub(super) contact_bias: Vec<f64>,
    /// Rows of the contacts of the problem, along the ground's directions.
    pub(super) rows: Vec<f64>,
    /// Their velocities.
    pub(super) velocity: Vec<f64>,
    /// Their accelerations without contact forces.
    pub(super) free: Vec<f64>,
    /// Forces of the closed contacts, rows of each in turn.
    pub(super) force: Vec<f64>,
    /// Torques of what pushes, if anything does.
    pub(super) push: Option<Vec<f64>>,
    pub(super) contacts: Vec<Contact>,
    pub(super) modes: Vec<Mode>,
    scratch: Vec<f64>,
    laws: LawForces,
}

impl<'a> Motion<'a> {
    pub(super) fn new(
        plant: &'a mut dyn Plant,
        control: &'a Control,
        drives: Drives,
        friction: Vec<Friction>,
        holding: Holding,
    ) -> Self {
        let model = plant.model();
        let (n, points) = (model.joints.len(), model.contacts.len());
        let ground = Ground::new(model);
        let zeros = |len: usize| vec![0.0; len];
        let work = Work {
            mass: zeros(n * n),
            bias: zeros(n),
            command: zeros(n),
            acceleration: zeros(n),
            positions: zeros(3 * points),
            jacobian: zeros(3 * points * n),
            contact_bias: zeros(3 * points),
            scratch: zeros(n),
            laws: LawForces::new(model, &drives),
            ..Work::default()
        };
        let laws = plant.law_states();
        let layout = Layout { joints: n, motors: drives.elastic.len(), laws };
        Self {
            plant,
            control: Cow::Borrowed(control),
            believed: None,
            drives,
            ground,
            friction,
            holding,
            layout,
            closed: Vec::new(),
            held: None,
            pushes: &[],
            holds_places: true,
            segment_end: f64::INFINITY,
            measured: [Vec::new(), Vec::new()],
            solver: ContactSolver::new(),
            delassus: Delassus::new(),
            memory: ControlMemory::default(),
            moved: MovedMemory::default(),
            factored_for: Vec::new(),
            placed_for: Vec::new(),
            followed_for: Vec::new(),
            followed: Vec::new(),
            work,
        }
    }

    /// A time at which references are still those of this segment.
    pub(super) fn reference_time(&self, t_s: f64) -> f64 {
        t_s.min(self.segment_end - 4e-12)
    }

    /// Commanded torques at a time, from what is measured.
    pub(super) fn command(&mut self, t_s: f64, q: &[f64], qd: &[f64], command: &mut [f64]) {
        let plant: &mut dyn Plant = match &mut self.believed {
            Some(believed) => &mut **believed,
            None => &mut *self.plant,
        };
        self.control.command(plant, t_s, q, qd, &mut self.memory, command);
    }

    /// Joints follow new plans from now on.
    pub(super) fn follow(&mut self, plans: Vec<JointPlan>) {
        self.control.to_mut().follow(plans);
        self.memory = ControlMemory::default();
    }

    /// Accelerations without contact forces, into `work.acceleration`; factors the mass matrix.
    pub(super) fn free_motion(&mut self, t_s: f64, y: &[f64]) -> Result<(), Breakdown> {
        let parts = self.layout.parts(y);
        let time = self.reference_time(t_s);
        match &self.held {
            Some(held) => self.work.command.copy_from_slice(held),
            None => {
                let [q, qd] = &mut self.measured;
                self.drives.measured(self.plant.model(), self.control.feedback, parts, q, qd);
                let command = &mut self.work.command;
                let plant: &mut dyn Plant = match &mut self.believed {
                    Some(believed) => &mut **believed,
                    None => &mut *self.plant,
                };
                self.control.command(plant, time, q, qd, &mut self.memory, command);
            }
        }
        self.factor_mass(y)?;
        let parts = self.layout.parts(y);
        let Work { mass, bias, acceleration, drive, command, laws, push, .. } = &mut self.work;
        self.drives.respond(self.plant.model(), command, parts, drive);
        self.plant.bias(parts.q, parts.qd, bias);
        for (entry, (torque, bias)) in acceleration.iter_mut().zip(drive.torque.iter().zip(bias)) {
            *entry = torque - *bias;
        }
        if !self.pushes.is_empty() {
            *push = push::torques(self.pushes, self.plant, time, parts.q);
            for (entry, torque) in acceleration.iter_mut().zip(push.iter().flatten()) {
                *entry += torque;
            }
        }
        if !laws.respond(self.plant, t_s, parts, None) {
            self.delassus.solve_mass(acceleration);
        } else if laws.is_accelerated() {
            let driving = acceleration.clone();
            self.delassus.solve_mass(acceleration);
            let motors = &mut drive.motor_acceleration;
            let driven = Driven { mass, torque: &driving };
            let found = [acceleration.as_mut_slice(), motors];
            laws.solve(self.plant, &self.drives, t_s, parts, driven, found)?;
            laws.pass_on(&mut drive.torque);
        } else {
            acceleration.iter_mut().zip(&laws.torque).for_each(|(entry, law)| *entry -= law);
            self.delassus.solve_mass(acceleration);
            let model = self.plant.model();
            laws.brake_motors(model, &self.drives, &mut drive.motor_acceleration);
            laws.pass_on(&mut drive.torque);
        }
        match acceleration.iter().all(|entry| entry.is_finite()) {
            true => Ok(()),
            false => Err(Breakdown::NotFinite),
        }
    }

    /// Factors the mass matrix, which rows are projected by.
    pub(super) fn factor_mass(&mut self, y: &[f64]) -> Result<(), Breakdown> {
        let q = self.layout.parts(y).q;
        if self.factored_for != q {
            self.plant.mass_matrix(q, &mut self.work.mass);
            self.factored_for.clear();
            self.delassus
                .factor(&self.work.mass, self.layout.joints)
                .map_err(|error| Breakdown::Singular { coordinate: error.coordinate })?;
            self.factored_for.extend_from_slice(q);
        }
        Ok(())
    }

    /// Rows, velocities and G of the listed contact points; positions of all points.
    pub(super) fn project(&mut self, y: &[f64], contacts: &[usize]) {
        self.follow_points(y, contacts);
        self.delassus.project(&self.work.rows);
    }

    /// Rows and velocities of the listed contact points; positions of all points.
    pub(super) fn follow_points(&mut self, y: &[f64], contacts: &[usize]) {
        let (n, parts) = (self.layout.joints, self.layout.parts(y));
        let Work { positions, jacobian, rows, velocity, .. } = &mut self.work;
        let stays = self.followed_for == parts.q;
        if !stays {
            self.plant.contact_jacobian(parts.q, jacobian);
            self.followed_for.clear();
            self.followed_for.extend_from_slice(parts.q);
        }
        if self.placed_for != parts.q {
            self.plant.contact_positions(parts.q, positions);
            self.placed_for.clear();
            self.placed_for.extend_from_slice(parts.q);
        }
        if !stays || self.followed != contacts {
            rows.clear();
            for &contact in contacts {
                let world = &jacobian[3 * contact * n..3 * (contact + 1) * n];
                self.ground.append_rows(world, n, rows);
            }
            self.followed.clear();
            self.followed.extend_from_slice(contacts);
        }
        velocity.clear();
        let speed = |row: &[f64]| row.iter().zip(parts.qd).map(|(w, v)| w * v).sum::<f64>();
        velocity.extend(rows.chunks_exact(n).map(speed));
    }

    /// Accelerations of the listed contact points without contact forces, after `free_motion` and
    /// `project`.
    pub(super) fn free_response(&mut self, y: &[f64], contacts: &[usize]) {
        let (n, parts) = (self.layout.joints, self.layout.parts(y));
        let Work { contact_bias, rows, free, acceleration, .. } = &mut self.work;
        self.plant.contact_bias(parts.q, parts.qd, contact_bias);
        free.clear();
        for &contact in contacts {
            self.ground.append(&contact_bias[3 * contact..3 * contact + 3], free);
        }
        for (entry, row) in free.iter_mut().zip(rows.chunks_exact(n)) {
            *entry += row.iter().zip(&*acceleration).map(|(w, a)| w * a).sum::<f64>();
        }
    }

    /// Poses the problem of the closed contacts: `work.free`, `work.contacts`, `work.modes`.
    pub(super) fn pose(&mut self, t_s: f64, y: &[f64]) -> Result<(), Breakdown> {
        self.free_motion(t_s, y)?;
        let listed: Vec<usize> = self.closed.iter().map(|closed| closed.contact).collect();
        self.project(y, &listed);
        self.free_response(y, &listed);
        self.hold();
        Ok(())
    }

    /// Accelerations with contact forces: `work.acceleration`, `work.force`.
    pub(super) fn constrained_motion(&mut self, t_s: f64, y: &[f64]) -> Result<(), Breakdown> {
        self.respond(t_s, y, |solver, problem, modes, force| {
            solver.forces(problem, modes, force).map(|_| ())
        })
    }

    fn respond(
        &mut self,
        t_s: f64,
        y: &[f64],
        solve: impl FnOnce(
            &mut ContactSolver,
            &ContactProblem<'_>,
            &[Mode],
            &mut [f64],
        ) -> Result<(), ContactFailure>,
    ) -> Result<(), Breakdown> {
        self.work.force.clear();
        if self.closed.is_empty() {
            return self.free_motion(t_s, y);
        }
        self.pose(t_s, y)?;
        let Work { free, force, contacts, modes, acceleration, scratch, .. } = &mut self.work;
        force.resize(free.len(), 0.0);
        let problem = ContactProblem {
            space: self.ground.space,
            contacts,
            delassus: self.delassus.matrix(),
            free,
            tolerance: self.holding.tolerance,
        };
        solve(&mut self.solver, &problem, modes, force).map_err(|failure| match failure {
            ContactFailure::NotFinite => Breakdown::NotFinite,
            failure => Breakdown::Contact(failure),
        })?;
        self.delassus.respond(force, acceleration, scratch);
        Ok(())
    }

    /// Modes and laws of the closed contacts, and the drift terms of their held directions.
    fn hold(&mut self) {
        let (rows, rate) = (self.ground.rows(), self.holding.drift_rate);
        let tangents = rows - 1;
        let Work { positions, velocity, free, contacts, modes, .. } = &mut self.work;
        contacts.clear();
        modes.clear();
        let mut along = Vec::with_capacity(rows);
        for (index, closed) in self.closed.iter().enumerate() {
            let position = &positions[3 * closed.contact..3 * closed.contact + 3];
            let block = index * rows..(index + 1) * rows;
            let (speed, free) = (&velocity[block.clone()], &mut free[block]);
            free[tangents] += rate * (2.0 * speed[tangents] + rate * self.ground.gap(position));
            let mut contact = Contact::resting(closed.law);
            let mut mode = closed.mode;
            match &mut mode {
                Mode::Stick => {
                    along.clear();
                    self.ground.append(position, &mut along);
                    for axis in 0..tangents {
                        let error = along[axis] - closed.anchor[axis];
                        let error = if self.holds_places { error } else { 0.0 };
                        free[axis] += rate * (2.0 * speed[axis] + rate * error);
                    }
                }
                Mode::Slip(direction) => {
                    *direction = self.holding.slips.direction(&speed[..tangents], *direction);
                    contact.slipping = Some(*direction);
                }
                Mode::Open => {}
            }
            contacts.push(contact);
            modes.push(mode);
        }
    }

    /// Gaps of all contact points \[m\], after `positions` of `work` are those of `y`.
    pub(super) fn place(&mut self, y: &[f64]) {
        let parts = self.layout.parts(y);
        if self.placed_for != parts.q {
            self.plant.contact_positions(parts.q, &mut self.work.positions);
            self.placed_for.clear();
            self.placed_for.extend_from_slice(parts.q);
        }
    }

    /// The plant has changed: what is known of its last position is so no longer.
    pub(super) fn forget_position(&mut self) {
        self.factored_for.clear();
        self.placed_for.clear();
        self.followed_for.clear();
    }

    /// Height of a contact point, where `place` or `project` last saw it \[m\].
    pub(super) fn gap(&self, contact: usize) -> f64 {
        self.ground.gap(&self.work.positions[3 * contact..3 * contact + 3])
    }

    /// Total energy, drives included \[J\].
    pub(super) fn energy(&mut self, y: &[f64]) -> f64 {
        let parts = self.layout.parts(y);
        let drives = self.drives.energy(self.plant.model(), parts);
        let kinetic = self.plant.kinetic_energy(parts.q, parts.qd);
        kinetic + self.plant.potential_energy(parts.q) + drives
    }
}

impl Rates for Motion<'_> {
    fn rates(&mut self, t_s: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Breakdown> {
        self.moved(t_s, y)?;
        let (positions, rates) = (self.layout.positions(), self.layout.joint_rates());
        dy[..positions].copy_from_slice(&y[positions..2 * positions]);
        dy[rates.clone()].copy_from_slice(&self.work.acceleration);
        dy[rates.end..2 * positions].copy_from_slice(&self.work.drive.motor_acceleration);
        let rows = self.ground.rows();
        let mut rubbed = 0.0;
        for (index, closed) in self.closed.iter().enumerate() {
            if matches!(closed.mode, Mode::Slip(_)) {
                for row in index * rows..(index + 1) * rows - 1 {
                    rubbed -= self.work.force[row] * self.work.velocity[row];
                }
            }
        }
        let [put_in, lost] = self.work.drive.power;
        let parts = self.layout.parts(y);
        let Work { laws, acceleration, drive, .. } = &mut self.work;
        let motors = laws.on_joint_side(&drive.motor_acceleration);
        let mut by_laws = 0.0;
        if laws.respond(self.plant, t_s, parts, Some([acceleration, &motors])) {
            by_laws = laws.power(parts);
            dy[2 * positions..2 * positions + self.layout.laws].copy_from_slice(laws.rates());
        }
        let by_push = self.work.push.as_ref().map_or(0.0, |push| {
            push.iter().zip(parts.qd).map(|(torque, velocity)| torque * velocity).sum()
        });
        let integrals = 2 * positions + self.layout.laws;
        dy[integrals] = put_in + by_push;
        dy[integrals + 1] = lost + rubbed + by_laws;
        match dy.iter().all(|entry| entry.is_finite()) {
            true => Ok(()),
            false => Err(Breakdown::NotFinite),
        }
    }

    fn positions(&self) -> usize {
        self.layout.positions()
    }

    fn integrals(&self) -> usize {
        INTEGRALS
    }
}
