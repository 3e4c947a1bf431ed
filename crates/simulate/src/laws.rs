//! Laws of added effects at the coordinates of a simulation: the joints, then the motors before
//! series springs.
//!
//! A law on the side of the motor moves with the motor and brakes it; a law beside a spring passes
//! on to the link what it takes from the motor. Where a drive counts as stiff, motor and link are
//! one: both sides act on the joint, and what is between them does nothing.

use super::breakdown::Breakdown;
use super::drive::Drives;
use super::state::Parts;
use denavit_plants::{DriveMoment, LawMoment, LawResponse, Plant, PlantModel};
use nalgebra::{DMatrix, DVector};

/// Steps of Newton's method: laws are linear in accelerations but for kinks.
const MAX_STEPS: usize = 60;

/// A joint with a series spring.
#[derive(Clone, Copy, Debug)]
struct Sprung {
    joint: usize,
    /// Its motor, and the joint's rate over the motor's; none where the drive counts as stiff.
    motor: Option<(usize, f64)>,
}

/// The laws of a plant, and what they answered last.
#[derive(Clone, Debug, Default)]
pub(super) struct LawForces {
    joints: usize,
    sprung: Vec<Sprung>,
    /// On the joint's side: rates, accelerations and deflections of the drives before springs.
    drives: [Vec<f64>; 3],
    rest: Vec<f64>,
    /// The rate below which signs of rates are lines [rad/s, m/s].
    pub(super) stiction_rate: f64,
    response: LawResponse,
    /// What each coordinate needs besides, motors on the side of their joints [N m, N].
    pub(super) torque: Vec<f64>,
    /// Derivatives of that by the accelerations of the coordinates, row by row; empty if there are
    /// none.
    slopes: Vec<f64>,
}

/// Accelerations of joints and of motors, all on the side of the joints [rad/s^2, m/s^2].
pub(super) type Accelerations<'a> = [&'a [f64]; 2];

/// What the joints accelerate by without the laws: D qdd = torque.
pub(super) struct Driven<'a> {
    /// D, row by row.
    pub(super) mass: &'a [f64],
    /// Of each joint [N m, N].
    pub(super) torque: &'a [f64],
}

impl LawForces {
    pub(super) fn new(model: &PlantModel, drives: &Drives) -> Self {
        let of = |joint| Sprung { joint, motor: drives.motor_of(model, joint) };
        let sprung: Vec<Sprung> = model.sprung_joints().map(of).collect();
        let joints = model.joints.len();
        let stiction_rate = drives.stiction_rate;
        Self { joints, sprung, rest: vec![0.0; joints], stiction_rate, ..Self::default() }
    }

    /// The states that laws begin with.
    pub(super) fn start(&mut self, plant: &mut dyn Plant, t_s: f64, parts: Parts<'_>) -> Vec<f64> {
        self.follow(parts, None);
        plant.law_start(&self.moment(t_s, parts, None))
    }

    /// Asks the laws; without accelerations these are zero. False if there are no laws.
    pub(super) fn respond(
        &mut self,
        plant: &mut dyn Plant,
        t_s: f64,
        parts: Parts<'_>,
        accelerations: Option<Accelerations<'_>>,
    ) -> bool {
        self.follow(parts, accelerations);
        let mut response = std::mem::take(&mut self.response);
        let is_there = plant.laws(&self.moment(t_s, parts, accelerations), &mut response);
        self.response = response;
        if is_there {
            self.gather(parts.motor.len());
        }
        is_there
    }

    fn moment<'a>(
        &'a self,
        t_s: f64,
        parts: Parts<'a>,
        accelerations: Option<Accelerations<'a>>,
    ) -> LawMoment<'a> {
        let Parts { q, qd, laws: states, .. } = parts;
        let [rates, own, deflection] = &self.drives;
        let drives = DriveMoment { qd: rates, qdd: own, deflection };
        LawMoment {
            t_s,
            q,
            qd,
            qdd: accelerations.map_or(&self.rest, |all| all[0]),
            drives,
            states,
            stiction_rate: self.stiction_rate,
        }
    }

    /// What the drives before springs do.
    fn follow(&mut self, parts: Parts<'_>, accelerations: Option<Accelerations<'_>>) {
        self.drives.iter_mut().for_each(Vec::clear);
        let [rates, own, deflections] = &mut self.drives;
        for &Sprung { joint, motor } in &self.sprung {
            let (rate, ahead) = match motor {
                Some((motor, ratio)) => {
                    (ratio * parts.motor_rate[motor], ratio * parts.motor[motor] - parts.q[joint])
                }
                None => (parts.qd[joint], 0.0),
            };
            rates.push(rate);
            deflections.push(ahead);
            own.push(accelerations.map_or(0.0, |[joints, motors]| match motor {
                Some((motor, _)) => motors[motor],
                None => joints[joint],
            }));
        }
    }

    /// Torques and slopes of the coordinates.
    fn gather(&mut self, motors: usize) {
        let (n, count) = (self.joints, self.joints + motors);
        let LawResponse { torque, drive, passed, slopes, .. } = &self.response;
        self.torque.clear();
        self.torque.extend_from_slice(torque);
        self.torque.resize(count, 0.0);
        let place = |own: &Sprung| own.motor.map_or(own.joint, |(motor, _)| n + motor);
        for ((own, drive), passed) in self.sprung.iter().zip(drive).zip(passed) {
            self.torque[place(own)] += drive;
            if let Some((motor, _)) = own.motor {
                self.torque[n + motor] += passed;
                self.torque[own.joint] -= passed;
            }
        }
        self.slopes.clear();
        if slopes.is_empty() {
            return;
        }
        self.slopes.resize(count * count, 0.0);
        let places: Vec<usize> = (0..n).chain(self.sprung.iter().map(place)).collect();
        for (line, &row) in slopes.chunks_exact(places.len()).zip(&places) {
            for (slope, &column) in line.iter().zip(&places) {
                self.slopes[row * count + column] += slope;
            }
        }
    }

    /// Rates of the laws' states.
    pub(super) fn rates(&self) -> &[f64] {
        &self.response.rates
    }

    /// Whether torques depend on accelerations.
    pub(super) fn is_accelerated(&self) -> bool {
        !self.slopes.is_empty()
    }

    /// Adds what is passed on beside springs to the torques that springs pass on.
    pub(super) fn pass_on(&self, torque: &mut [f64]) {
        let motors = self.sprung.iter().zip(&self.response.passed);
        for (own, passed) in motors.filter(|(own, _)| own.motor.is_some()) {
            torque[own.joint] += passed;
        }
    }

    /// Takes the laws away from the accelerations of motors, on their own side \[rad/s^2\].
    pub(super) fn brake_motors(
        &self,
        model: &PlantModel,
        drives: &Drives,
        accelerations: &mut [f64],
    ) {
        for (motor, ratio) in self.sprung.iter().filter_map(|own| own.motor) {
            let torque = ratio * self.torque[self.joints + motor];
            accelerations[motor] -= torque / drives.rotor_inertia(model, motor);
        }
    }

    /// Power that the laws take \[W\].
    pub(super) fn power(&self, parts: Parts<'_>) -> f64 {
        let of_joints = self.torque.iter().zip(parts.qd).map(|(torque, rate)| torque * rate);
        let motors = self.sprung.iter().filter_map(|own| own.motor);
        let of_motors = motors.map(|(motor, ratio)| {
            ratio * parts.motor_rate[motor] * self.torque[self.joints + motor]
        });
        of_joints.chain(of_motors).sum()
    }

    /// Solves D qdd + law = `torque` for the accelerations of the joints, and those of the motors
    /// with it, by Newton's method from those without the laws. The laws' response is that at the
    /// end.
    pub(super) fn solve(
        &mut self,
        plant: &mut dyn Plant,
        drives: &Drives,
        t_s: f64,
        parts: Parts<'_>,
        driven: Driven<'_>,
        [joints, motors]: [&mut [f64]; 2],
    ) -> Result<(), Breakdown> {
        let (n, count) = (joints.len(), joints.len() + motors.len());
        let mut inertia = DMatrix::zeros(count, count);
        let Driven { mass, torque } = driven;
        for (row, line) in mass.chunks_exact(n).enumerate() {
            line.iter().enumerate().for_each(|(column, entry)| inertia[(row, column)] = *entry);
        }
        let ratios = self.ratios(motors.len());
        let mut found = DVector::zeros(count);
        found.rows_mut(0, n).copy_from_slice(joints);
        for (motor, ratio) in ratios.iter().enumerate() {
            let rotor = drives.rotor_inertia(plant.model(), motor);
            inertia[(n + motor, n + motor)] = rotor / (ratio * ratio);
            found[n + motor] = ratio * motors[motor];
        }
        let mut driving = &inertia * &found;
        driving.rows_mut(0, n).copy_from_slice(torque);
        for step in 0..MAX_STEPS {
            let (of_joints, of_motors) = found.as_slice().split_at(n);
            self.respond(plant, t_s, parts, Some([of_joints, of_motors]));
            let law = DVector::from_column_slice(&self.torque);
            let slopes = DMatrix::from_row_slice(count, count, &self.slopes);
            let residual = &driving - law - &inertia * &found;
            let change = (&inertia + slopes).lu().solve(&residual);
            let change = change.ok_or(Breakdown::Singular { coordinate: 0 })?;
            // at a kink whole steps may jump to and fro
            found += if step < MAX_STEPS / 2 { 1.0 } else { 0.5 } * &change;
            let shares = found.iter().zip(change.iter());
            let largest = shares.map(|(a, change)| change.abs() / (1.0 + a.abs()));
            if largest.fold(0.0, f64::max) < 1e-12 {
                joints.copy_from_slice(&found.as_slice()[..n]);
                let motors = motors.iter_mut().zip(&found.as_slice()[n..]).zip(&ratios);
                motors.for_each(|((own, found), ratio)| *own = found / ratio);
                return Ok(());
            }
        }
        Err(Breakdown::NotFinite)
    }

    /// For each motor its joint's rate over its own.
    fn ratios(&self, motors: usize) -> Vec<f64> {
        let mut ratios = vec![1.0; motors];
        self.sprung.iter().filter_map(|own| own.motor).for_each(|(motor, r)| ratios[motor] = r);
        ratios
    }

    /// Accelerations of motors on the side of their joints.
    pub(super) fn on_joint_side(&self, motors: &[f64]) -> Vec<f64> {
        self.ratios(motors.len()).iter().zip(motors).map(|(ratio, own)| ratio * own).collect()
    }
}
