//! Logs with the nominal model's rows: all that is asked of them, weighted and stacked.

use super::beside::Beside;
use super::known::weights;
use super::law::{Motion, Response};
use super::load_slopes::LoadSlopes;
use super::nominal::{Nominal, Phi};
use super::rows::{LogRows, PerJoint, behind_springs, of_axes, torques};
use super::signals::Signals;
use super::state::Effects;
use super::turning::{PER_JOINT, settle, unnamed};
pub(super) use crate::policy::data::SPRING_ZERO;
use denavit_evidence::policy;
use denavit_measure::{JointIndex, LogIndex};
use denavit_numerics::derivative;
use denavit_plants::effect::Drive;
use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

/// A stretch of rows: those of one equation in one log.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    /// The log.
    pub(super) log: LogIndex,
    /// The joint.
    pub(super) joint: JointIndex,
    /// The equation: of the torque of that joint, or after all joints that of its spring.
    pub(super) equation: usize,
    /// The first of its rows.
    pub(super) first: usize,
    /// Their number.
    pub(super) rows: usize,
}

impl Stretch {
    /// Its rows among all.
    pub(super) fn range(&self) -> Range<usize> {
        self.first..self.first + self.rows
    }
}

/// Logs with the columns of everything that the nominal model is not sure of.
#[derive(Clone, Debug)]
pub(super) struct Data<'a> {
    /// The nominal model.
    pub(super) nominal: &'a Nominal<'a>,
    /// The logs.
    pub(super) signals: Vec<Signals>,
    /// All rows: joint by joint, then spring by spring, log by log.
    pub(super) stretches: Vec<Stretch>,
    /// Torque less what the model gives with z = 0, per row; of a spring what it passes on less
    /// what its joint takes [N m, N].
    pub(super) residual: Vec<f64>,
    /// For each entry of z its column: the numbers of the model, the time between torque and
    /// motion, for each joint what is too small for a name, and for each spring its stiffness and
    /// the zero of its deflection.
    pub(super) columns: Vec<Vec<f64>>,
    /// The torque of every row, filtered: measured, or by the deflection of a spring [N m, N].
    pub(super) torque: Vec<f64>,
    /// What every row counts, from 0 to 1.
    pub(super) weights: Vec<f64>,
}

/// Torques of the model at the samples of one log.
#[derive(Clone, Debug)]
pub struct ModelTorques {
    /// phi of the model's present parameters.
    pub phi: Phi,
    /// The present values of the numbers of the model file, in the order of the regression's.
    pub numbers: Vec<f64>,
    /// Torques of rigid bodies, without friction, with what effects add to them [N m, N].
    pub load: PerJoint,
    /// Their derivatives by time [N m/s, N/s].
    pub load_rate: PerJoint,
    /// All without effects; then, for each spring, what its joint takes less what it passes on.
    pub total: PerJoint,
    /// The numbers of each joint's drive.
    pub drives: Vec<Drive>,
    /// What laws are beside.
    pub(super) beside: Beside,
    /// The slopes that were asked for last: laws of one joint are looked at one after the other.
    pub(super) slopes: RefCell<Option<Rc<LoadSlopes>>>,
}

impl<'a> Data<'a> {
    /// The rows of logs. Friction while a drive rests or turns around is that by z.
    pub(super) fn new(nominal: &'a Nominal<'a>, mut signals: Vec<Signals>, z: &[f64]) -> Self {
        let joints = nominal.model.joints.len();
        let (given, directions) = (nominal.phi(&vec![0.0; nominal.len()]), nominal.directions());
        let near = nominal.phi(z);
        signals.iter_mut().for_each(|signals| settle(nominal, signals, &near));
        let rows: Vec<LogRows> = signals.iter().map(|log| LogRows::new(nominal, log)).collect();
        let mut data = Self {
            nominal,
            stretches: Vec::new(),
            residual: Vec::new(),
            columns: vec![Vec::new(); nominal.place_of_spring(nominal.springs.len())],
            torque: Vec::new(),
            weights: Vec::new(),
            signals,
        };
        // Channels of a log are not read at once.
        let of_time = |signals: &Signals| -> PerJoint {
            let shift_s = -policy::TIME * signals.log_step_s;
            let shifted = |torque: &Vec<f64>| -> Vec<f64> {
                let rate = derivative(torque, signals.step_s);
                signals.rows_of(&rate.iter().map(|rate| shift_s * rate).collect::<Vec<f64>>())
            };
            torques(nominal, signals, &given).iter().map(shifted).collect()
        };
        let time: Vec<PerJoint> = data.signals.iter().map(of_time).collect();
        let unnamed: Vec<Vec<PerJoint>> =
            data.signals.iter().map(|signals| unnamed(nominal, signals, &near)).collect();
        let weights: Vec<PerJoint> =
            data.signals.iter().map(|signals| weights(nominal, signals, &near)).collect();
        for at in (0..joints).map(JointIndex) {
            let joint = at.0;
            for (log, own) in rows.iter().enumerate() {
                let Some(target) = &own.target[joint] else { continue };
                let (first, rows) = (data.residual.len(), target.len());
                data.stretches.push(Stretch {
                    log: LogIndex(log),
                    joint: at,
                    equation: joint,
                    first,
                    rows,
                });
                let computed = own.torque(nominal, at, &given.axes);
                data.residual.extend(target.iter().zip(computed).map(|(a, b)| a - b));
                data.torque.extend(data.signals[log].torque[joint].iter().flatten());
                data.weights.extend(&weights[log][joint]);
                for (column, direction) in data.columns.iter_mut().zip(&directions) {
                    column.extend(own.torque(nominal, at, &direction.axes));
                }
                data.columns[directions.len()].extend(&time[log][joint]);
                // What is too small for a name is that of one joint each.
                data.columns.iter_mut().for_each(|column| column.resize(first + rows, 0.0));
                let columns = data.columns[directions.len() + 1 + PER_JOINT * joint..].iter_mut();
                for (column, unnamed) in columns.zip(&unnamed[log][joint]) {
                    column[first..].copy_from_slice(&data.signals[log].rows_of(unnamed));
                }
            }
        }
        data.move_drives(&given, &directions);
        data.add_springs(&rows, &given, &directions);
        data
    }

    /// The balance of springs: what they pass on is what their joints take, without friction and
    /// rotors of the drives.
    fn add_springs(&mut self, rows: &[LogRows], given: &Phi, directions: &[Phi]) {
        let nominal = self.nominal;
        for (place, spring) in nominal.springs.iter().enumerate() {
            let (joint, equation) = (spring.joint, nominal.model.joints.len() + place);
            for (log, rows) in rows.iter().enumerate() {
                let Some([deflection, _]) = self.signals[log].deflection(joint) else { continue };
                let deflection = self.signals[log].rows_of(&deflection);
                let (first, count) = (self.residual.len(), deflection.len());
                let log = LogIndex(log);
                self.stretches.push(Stretch { log, joint, equation, first, rows: count });
                let passed: Vec<f64> = deflection.iter().map(|d| spring.stiffness * d).collect();
                let computed = rows.torque(nominal, joint, &given.loads);
                let left = rows.unknown(joint, passed.clone());
                self.residual.extend(left.iter().zip(computed).map(|(a, b)| a - b));
                self.torque.extend(passed);
                self.weights.resize(first + count, 1.0);
                for (column, direction) in self.columns.iter_mut().zip(directions) {
                    column.extend(rows.torque(nominal, joint, &direction.loads));
                }
                let whole = first + count;
                let own = nominal.place_of_spring(place);
                self.columns[own].resize(first, 0.0);
                self.columns[own].extend(deflection.iter().map(|d| -spring.std * d));
                self.columns[own + 1].resize(first, 0.0);
                self.columns[own + 1].resize(whole, SPRING_ZERO * spring.stiffness);
                self.columns.iter_mut().for_each(|column| column.resize(whole, 0.0));
            }
        }
    }

    /// Lets drives before springs move with their motors.
    fn move_drives(&mut self, given: &Phi, directions: &[Phi]) {
        for stretch in self.stretches.clone() {
            let signals = &self.signals[stretch.log.0];
            if signals.motor[stretch.joint.0].is_none() {
                continue;
            }
            let more = |phi: &Phi| -> Option<Vec<f64>> {
                let all = behind_springs(self.nominal, signals, phi);
                let (_, own) = all.iter().find(|(joint, _)| *joint == stretch.joint)?;
                Some(signals.rows_of(own))
            };
            let rows = stretch.range();
            if let Some(more) = more(given) {
                self.residual[rows.clone()].iter_mut().zip(more).for_each(|(row, m)| *row -= m);
            }
            for (column, direction) in self.columns.iter_mut().zip(directions) {
                if let Some(more) = more(direction) {
                    column[rows.clone()].iter_mut().zip(more).for_each(|(row, m)| *row += m);
                }
            }
        }
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.residual.len()
    }

    /// Torque less what the model gives with z, per row.
    pub(super) fn residual_of(&self, z: &[f64]) -> Vec<f64> {
        let mut residual = self.residual.clone();
        for (column, factor) in self.columns.iter().zip(z).filter(|(_, factor)| **factor != 0.0) {
            residual.iter_mut().zip(column).for_each(|(sum, entry)| *sum -= factor * entry);
        }
        residual
    }

    /// The torques that the model gives the motion of each log with z, beside effects.
    pub(super) fn model_torques(&self, z: &[f64], effects: Effects<'_>) -> Vec<ModelTorques> {
        let of = |signals| {
            ModelTorques::new(self.nominal, signals, z).beside(self.nominal, signals, effects)
        };
        self.signals.iter().map(of).collect()
    }

    /// What is given for the motion of each log, in the rows: of the equations that have rows.
    pub(super) fn in_rows(
        &self,
        of: &dyn Fn(Motion<'_>) -> Response,
        torques: &[ModelTorques],
    ) -> RowResponse {
        let mut found = RowResponse::default();
        for (log, (signals, torques)) in self.signals.iter().zip(torques).enumerate() {
            let response = of(torques.motion(self.nominal, signals));
            let stretch_of = |(place, equation): (usize, &usize)| {
                let is_own = |one: &&Stretch| one.log.0 == log && one.equation == *equation;
                Some((place, *self.stretches.iter().find(is_own)?))
            };
            let all: Vec<(usize, Stretch)> =
                response.equations.iter().enumerate().filter_map(stretch_of).collect();
            let columns = |&(place, _): &(usize, Stretch)| {
                let gradient = response.gradient.iter().map(move |all| all[place].as_slice());
                std::iter::once(response.torque[place].as_slice()).chain(gradient)
            };
            let columns: Vec<&[f64]> = all.iter().flat_map(columns).collect();
            let mut rows = signals.all_rows_of(&columns).into_iter();
            for (_, stretch) in all {
                found.stretches.push(stretch);
                found.torque.extend(rows.next());
                found.gradient.push(rows.by_ref().take(response.gradient.len()).collect());
            }
        }
        found
    }
}

/// Derivatives of torques by time at the samples of a log [N m/s, N/s].
pub(super) fn rates(torques: &PerJoint, signals: &Signals) -> PerJoint {
    torques.iter().map(|torque| derivative(torque, signals.step_s)).collect()
}

/// A response in the rows: for each stretch the torque, and its derivatives by each parameter.
#[derive(Clone, Debug, Default)]
pub(super) struct RowResponse {
    /// The rows it acts on.
    pub(super) stretches: Vec<Stretch>,
    /// For each stretch the torque.
    pub(super) torque: Vec<Vec<f64>>,
    /// For each stretch and parameter the derivative.
    pub(super) gradient: Vec<Vec<Vec<f64>>>,
}

impl RowResponse {
    /// Takes the torque away from rows.
    pub(super) fn subtract_from(&self, rows: &mut [f64]) {
        for (stretch, torque) in self.stretches.iter().zip(&self.torque) {
            let rows = rows[stretch.range()].iter_mut();
            rows.zip(torque).for_each(|(row, torque)| *row -= torque);
        }
    }
}

impl ModelTorques {
    /// The torques that the model gives a motion with z.
    pub(super) fn new(nominal: &Nominal<'_>, signals: &Signals, z: &[f64]) -> Self {
        let (phi, numbers) = (nominal.phi(z), nominal.numbers(z));
        let drives = Drive::all(nominal.model, &phi.drives);
        let load = of_axes(nominal, signals, &phi.loads, true);
        let load_rate = rates(&load, signals);
        let total = torques(nominal, signals, &phi);
        let (beside, slopes) = (Beside::nothing(drives.len()), RefCell::default());
        Self { phi, numbers, load, load_rate, total, drives, beside, slopes }
    }

    /// The motion of a log with these torques.
    pub(super) fn motion<'m>(
        &'m self,
        nominal: &'m Nominal<'m>,
        signals: &'m Signals,
    ) -> Motion<'m> {
        Motion { nominal, signals, torques: self, total: &self.total }
    }
}
