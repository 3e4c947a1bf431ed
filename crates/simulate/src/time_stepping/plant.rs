//! A plant under control, as a model of time stepping.

use super::{Instant, Terms, TimeSteppingModel};
use crate::contact::Space;
use crate::control::{Control, ControlMemory};
use crate::drive::{DriveModelling, DriveOutput, Drives};
use crate::ground::Ground;
use crate::laws::LawForces;
use crate::measure::Instrument;
use crate::state::Parts;
use denavit_plants::Plant;

/// A plant on its ground with its drives and its controller.
///
/// Coordinates are those of the plant, then the angles of series elastic motors. Friction of the
/// drives is implicit, and so is the damping of continuous feedback; a sampled controller holds its
/// command over the step.
pub struct ControlledPlant<'a> {
    plant: &'a mut dyn Plant,
    control: &'a Control,
    drives: Drives,
    ground: Ground,
    memory: ControlMemory,
    /// Torque held by a sampled controller.
    held: Option<Vec<f64>>,
    /// Torques that the step may not exceed, found by the step itself.
    limited: Vec<Option<f64>>,
    /// Of the last step.
    pub(super) step: DriveTerms,
    measured: [Vec<f64>; 2],
    motors: Vec<Option<(usize, f64)>>,
    mass: Vec<f64>,
    positions: Vec<f64>,
    jacobian: Vec<f64>,
    rows: Vec<f64>,
}

/// What drives did in a step.
#[derive(Clone, Debug, Default)]
pub(super) struct DriveTerms {
    /// Command of each joint, then with the implicit part of the feedback [N m, N].
    pub(super) command: Vec<f64>,
    /// Implicit damping of the feedback of each joint, by measured rate.
    gain: Vec<f64>,
    /// Friction of each coordinate over its rate.
    friction: Vec<f64>,
    output: DriveOutput,
    /// Torque on each joint from its drive, Coulomb friction taken off [N m, N].
    pub(super) torque: Vec<f64>,
    laws: LawForces,
    /// What laws of added effects take from each joint [N m, N].
    law_torque: Vec<f64>,
    /// Power that they take \[W\].
    law_power: f64,
}

impl<'a> ControlledPlant<'a> {
    /// The plant under this law of control, which has an entry for each of its joints; drives are
    /// ideal: commands reach the joints.
    pub fn new(plant: &'a mut dyn Plant, control: &'a Control) -> Self {
        Self::with_drives(plant, control, DriveModelling::Ideal)
    }

    /// The same with drives as the plant's model has them, or ideal ones.
    pub fn with_drives(
        plant: &'a mut dyn Plant,
        control: &'a Control,
        modelling: DriveModelling,
    ) -> Self {
        let model = plant.model();
        let (n, points) = (model.joints.len(), model.contacts.len());
        assert_eq!(control.joints.len(), n, "control of every joint");
        let drives = Drives::new(model, modelling);
        let motors = (0..n).map(|joint| drives.motor_of(model, joint)).collect();
        let laws = LawForces::new(model, &drives);
        Self {
            ground: Ground::new(model),
            plant,
            control,
            memory: ControlMemory::default(),
            held: None,
            limited: vec![None; n],
            step: DriveTerms {
                command: vec![0.0; n],
                law_torque: vec![0.0; n],
                laws,
                ..DriveTerms::default()
            },
            drives,
            measured: [Vec::new(), Vec::new()],
            motors,
            mass: vec![0.0; n * n],
            positions: vec![0.0; 3 * points],
            jacobian: vec![0.0; 3 * points * n],
            rows: Vec::new(),
        }
    }

    /// Below this rate Coulomb friction is a steep line through 0 [rad/s, m/s].
    pub(super) fn set_stiction_rate(&mut self, rate: f64) {
        self.drives.stiction_rate = rate;
        self.step.laws.stiction_rate = rate;
    }

    /// The plant.
    pub fn plant(&mut self) -> &mut dyn Plant {
        self.plant
    }

    /// Joint of each series elastic motor.
    pub(super) fn elastic(&self) -> &[usize] {
        &self.drives.elastic
    }

    /// Number of joints.
    fn joints(&self) -> usize {
        self.step.command.len()
    }

    /// Contact points where gaps were last asked for, three entries each \[m\].
    pub(super) fn positions(&self) -> &[f64] {
        &self.positions
    }

    /// Takes a sample of a sampled controller, whose command is held until the next.
    pub(super) fn sample(&mut self, t_s: f64, q: &[f64], qd: &[f64], instrument: &mut Instrument) {
        let Some(period_s) = self.control.period_s else { return };
        let (n, model) = (self.joints(), self.plant.model());
        let [angles, rates] = &mut self.measured;
        let parts = split(n, q, qd);
        self.drives.measured(model, self.control.feedback, parts, angles, rates);
        let (angles, rates) = instrument.sample(angles, rates, period_s);
        let mut command = vec![0.0; n];
        self.control.command(self.plant, t_s, angles, rates, &mut self.memory, &mut command);
        self.held = Some(command);
    }

    /// Commands, friction and forces of the drives; torques and accelerations of motors.
    pub(super) fn drive(&mut self, t_s: f64, q: &[f64], qd: &[f64]) {
        let parts = split(self.joints(), q, qd);
        let DriveTerms { command, gain, friction, output, torque, laws, law_torque, law_power } =
            &mut self.step;
        gain.clear();
        if let Some(held) = &self.held {
            command.copy_from_slice(held);
            gain.resize(command.len(), 0.0);
        } else {
            let [angles, rates] = &mut self.measured;
            self.drives.measured(self.plant.model(), self.control.feedback, parts, angles, rates);
            self.control.command(self.plant, t_s, angles, rates, &mut self.memory, command);
            let model = self.plant.model();
            let sees_motors = self.control.feedback == crate::Feedback::Motor;
            for (joint, command) in command.iter_mut().enumerate() {
                *command = self.limited[joint].unwrap_or(*command);
                // through a spring the rate of another coordinate is measured
                let is_own = self.motors[joint].is_none() || sees_motors;
                let free = is_own && self.limited[joint].is_none();
                let own = || self.control.rate_gain(model, joint, t_s, *command);
                gain.push(if free { own() } else { 0.0 });
            }
        }
        let model = self.plant.model();
        self.drives.friction_factors(model, parts, friction);
        self.drives.respond(model, command, parts, output);
        torque.clone_from(&output.torque);
        // explicitly: a run with laws of states or accelerations is refused
        if laws.respond(self.plant, t_s, parts, None) {
            law_torque.copy_from_slice(&laws.torque[..parts.q.len()]);
            *law_power = laws.power(parts);
            let model = self.plant.model();
            laws.brake_motors(model, &self.drives, &mut output.motor_acceleration);
            laws.pass_on(torque);
        }
    }

    /// The torque that each joint needs of its drive, friction included [N m, N].
    pub(super) fn required_torque(&self) -> impl Iterator<Item = f64> + '_ {
        self.drives.required(&self.step.command, &self.step.torque)
    }

    /// Work that the drives put into a step of length `step_s`, and what their friction took \[J\].
    /// Completes commands and torques by what the step took implicitly.
    pub(super) fn finish_step(
        &mut self,
        before: &[f64],
        after: &[f64],
        step_s: f64,
        implicitness: f64,
    ) -> [f64; 2] {
        let (n, model) = (self.joints(), self.plant.model());
        let DriveTerms { command, gain, friction, torque, law_power, .. } = &mut self.step;
        let change = |coordinate: usize| implicitness * (after[coordinate] - before[coordinate]);
        let middle = |coordinate: usize| 0.5 * (after[coordinate] + before[coordinate]);
        let [mut put_in, mut lost] = [0.0, *law_power];
        for joint in 0..n {
            let (own, ratio) = match self.motors[joint] {
                Some((motor, ratio)) => (n + motor, ratio),
                None => (joint, 1.0),
            };
            command[joint] -= gain[joint] * ratio * change(own);
            put_in += command[joint] * ratio * middle(own);
            if own == joint {
                // of friction, the viscous part stands in the plant's bias
                let rubs = friction[joint] - model.joints[joint].viscous;
                torque[joint] -= (gain[joint] + rubs) * change(joint);
            }
            lost += model.joints[joint].offset * middle(joint);
        }
        for (coordinate, factor) in friction.iter().enumerate() {
            lost += factor * (before[coordinate] + change(coordinate)) * middle(coordinate);
        }
        [put_in * step_s, lost * step_s]
    }

    /// Total energy, drives included \[J\].
    pub(super) fn energy(&mut self, q: &[f64], qd: &[f64]) -> f64 {
        let parts = split(self.joints(), q, qd);
        let drives = self.drives.energy(self.plant.model(), parts);
        let kinetic = self.plant.kinetic_energy(parts.q, parts.qd);
        kinetic + self.plant.potential_energy(parts.q) + drives
    }
}

/// Joints and motors of coordinates and rates.
pub(super) fn split<'a>(joints: usize, q: &'a [f64], qd: &'a [f64]) -> Parts<'a> {
    let ((q, motor), (qd, motor_rate)) = (q.split_at(joints), qd.split_at(joints));
    Parts { q, qd, motor, motor_rate, laws: &[], work_in: 0.0, lost: 0.0 }
}

impl TimeSteppingModel for ControlledPlant<'_> {
    fn dof(&self) -> usize {
        self.joints() + self.drives.elastic.len()
    }

    fn contacts(&self) -> usize {
        self.positions.len() / 3
    }

    fn space(&self) -> Space {
        self.ground.space
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        self.plant.contact_positions(&q[..self.joints()], &mut self.positions);
        for (gap, position) in gaps.iter_mut().zip(self.positions.chunks_exact(3)) {
            *gap = self.ground.gap(position);
        }
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        let (n, all) = (self.joints(), at.q.len());
        let (q, qd) = (&at.q[..n], &at.qd[..n]);
        self.drive(at.t_s, at.q, at.qd);
        if all == n {
            self.plant.mass_matrix(q, &mut terms.mass);
        } else {
            self.plant.mass_matrix(q, &mut self.mass);
            for (row, entries) in self.mass.chunks_exact(n).enumerate() {
                terms.mass[row * all..row * all + n].copy_from_slice(entries);
            }
        }
        let smooth = &at.smooth_qd[..n];
        self.plant.bias(q, smooth, &mut terms.force[..n]);
        let laws = &self.step.law_torque;
        for ((force, torque), law) in terms.force.iter_mut().zip(&self.step.output.torque).zip(laws)
        {
            *force = *torque - law - *force;
        }
        // friction, a part of the bias, is that of the rates before the step
        for (joint, model) in self.plant.model().joints.iter().enumerate() {
            terms.force[joint] += model.viscous * (smooth[joint] - qd[joint]);
        }
        for (motor, acceleration) in self.step.output.motor_acceleration.iter().enumerate() {
            let inertia = self.drives.rotor_inertia(self.plant.model(), motor);
            terms.mass[(n + motor) * (all + 1)] = inertia;
            terms.force[n + motor] = inertia * acceleration;
        }
        for (coordinate, friction) in self.step.friction.iter().enumerate() {
            terms.damping[coordinate * (all + 1)] = *friction;
        }
        for (joint, gain) in self.step.gain.iter().enumerate() {
            match self.motors[joint] {
                Some((motor, ratio)) => {
                    terms.damping[(n + motor) * (all + 1)] += gain * ratio * ratio;
                }
                None => terms.damping[joint * (all + 1)] += gain,
            }
        }
        if closed.is_empty() {
            return;
        }
        self.plant.contact_jacobian(q, &mut self.jacobian);
        self.rows.clear();
        for &contact in closed {
            let world = &self.jacobian[3 * contact * n..3 * (contact + 1) * n];
            self.ground.append_rows(world, n, &mut self.rows);
        }
        for (own, row) in terms.jacobian.chunks_exact_mut(all).zip(self.rows.chunks_exact(n)) {
            own[..n].copy_from_slice(row);
        }
    }

    fn accept(&mut self, before: &[f64], after: &[f64], implicitness: f64) -> bool {
        let (n, model) = (self.joints(), self.plant.model());
        let mut agrees = true;
        for (joint, gain) in self.step.gain.iter().enumerate().filter(|(_, gain)| **gain > 0.0) {
            let Some([low, high]) = self.control.limits(model, joint) else { continue };
            let (own, ratio) = match self.motors[joint] {
                Some((motor, ratio)) => (n + motor, ratio),
                None => (joint, 1.0),
            };
            let change = ratio * implicitness * (after[own] - before[own]);
            let command = self.step.command[joint] - gain * change;
            if command < low || command > high {
                self.limited[joint] = Some(command.clamp(low, high));
                agrees = false;
            }
        }
        if agrees {
            self.limited.fill(None);
        }
        agrees
    }
}
