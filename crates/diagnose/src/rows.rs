//! The rows that a diagnosis regresses: for each joint and log what the torques are linear in, and
//! what was measured.

use super::nominal::{Nominal, Phi};
use super::signals::Signals;
use denavit_measure::JointIndex;
use denavit_plants::regression::{RegressionEvaluator, RegressionRows};

/// Samples that are evaluated at once.
const BLOCK: usize = 512;

/// A signal of every joint at the samples of a log's motion.
pub type PerJoint = Vec<Vec<f64>>;

/// The columns of one log, filtered, in the rows.
#[derive(Clone, Debug)]
pub(super) struct LogRows {
    /// For each joint its columns of phi, as its pattern lists them.
    columns: Vec<Vec<Vec<f64>>>,
    /// For each joint the torque that was measured less what is known; none where none was.
    pub(super) target: Vec<Option<Vec<f64>>>,
    /// For each joint what is known; none where that is nothing.
    known: Vec<Option<Vec<f64>>>,
}

impl LogRows {
    /// The rows of a log.
    pub(super) fn new(nominal: &Nominal<'_>, signals: &Signals) -> Self {
        let model = nominal.model;
        let joints = model.joints.len();
        let widths: Vec<usize> = model.pattern().iter().map(Vec::len).collect();
        let mut columns: Vec<Vec<Vec<f64>>> =
            widths.iter().map(|&width| vec![Vec::new(); width]).collect();
        let mut known: Vec<Option<Vec<f64>>> = vec![None; joints];
        for_each_block(&mut model.evaluator(), signals, |rows| {
            for joint in 0..joints {
                for (place, column) in columns[joint].iter_mut().enumerate() {
                    column.extend_from_slice(rows.column(joint, place));
                }
                if let Some(part) = rows.known(joint) {
                    known[joint].get_or_insert_default().extend_from_slice(part);
                }
            }
        });
        for column in columns.iter_mut().flatten() {
            *column = signals.rows_of(column);
        }
        let known: Vec<Option<Vec<f64>>> =
            known.into_iter().map(|known| Some(signals.rows_of(&known?))).collect();
        let mut rows = Self { columns, target: Vec::new(), known };
        let target = |(joint, torque): (usize, &Option<Vec<f64>>)| {
            torque.clone().map(|torque| rows.unknown(JointIndex(joint), torque))
        };
        rows.target = signals.torque.iter().enumerate().map(target).collect();
        rows
    }

    /// A torque of a joint less what is known of it.
    pub(super) fn unknown(&self, joint: JointIndex, mut torque: Vec<f64>) -> Vec<f64> {
        let known = self.known[joint.0].iter().flatten();
        torque.iter_mut().zip(known).for_each(|(torque, known)| *torque -= known);
        torque
    }

    /// The torque of a joint that phi adds on the joint axes, in the rows; drives move with their
    /// joints.
    pub(super) fn torque(
        &self,
        nominal: &Nominal<'_>,
        joint: JointIndex,
        axes: &[f64],
    ) -> Vec<f64> {
        // A joint that carries nothing has no columns.
        let samples = self.target[joint.0].as_ref().map_or(0, Vec::len);
        let mut torque = vec![0.0; samples];
        for (column, &place) in self.columns[joint.0].iter().zip(&nominal.model.pattern()[joint.0])
        {
            let factor = axes[place];
            if factor != 0.0 {
                torque.iter_mut().zip(column).for_each(|(sum, entry)| *sum += factor * entry);
            }
        }
        torque
    }
}

/// The torque of every joint by phi and by what is known, at the samples of the motion; then, for
/// each spring, what its joint takes less what it passes on.
pub(super) fn torques(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    if signals.motor.iter().all(Option::is_none) {
        return of_axes(nominal, signals, &phi.axes, true);
    }
    let loads = of_axes(nominal, signals, &phi.loads, true);
    let mut torques = drives(nominal, signals, phi);
    let all = torques.iter_mut().flatten().zip(loads.iter().flatten());
    all.for_each(|(torque, load)| *torque += load);
    for (spring, stiffness) in nominal.springs.iter().zip(&phi.springs) {
        let mut missed = loads[spring.joint.0].clone();
        if let Some([deflection, _]) = signals.deflection(spring.joint) {
            let both = missed.iter_mut().zip(deflection);
            both.for_each(|(missed, deflection)| *missed -= stiffness * deflection);
        }
        torques.push(missed);
    }
    torques
}

/// What rotors, friction and offsets take, those before springs with the motion of their motors.
fn drives(nominal: &Nominal<'_>, signals: &Signals, phi: &Phi) -> PerJoint {
    let mut moved = signals.clone();
    for (joint, motor) in signals.motor.iter().enumerate() {
        if let Some([_, rates, accelerations]) = motor {
            (moved.qd[joint], moved.qdd[joint]) = (rates.clone(), accelerations.clone());
        }
    }
    of_axes(nominal, &moved, &phi.drives, false)
}

/// What rotors and friction before springs take more than they would with the motion of their
/// joints, for each joint that has a motion of its motor.
pub(super) fn behind_springs(
    nominal: &Nominal<'_>,
    signals: &Signals,
    phi: &Phi,
) -> Vec<(JointIndex, Vec<f64>)> {
    let sprung: Vec<usize> =
        (0..signals.joints()).filter(|&joint| signals.motor[joint].is_some()).collect();
    if sprung.is_empty() || phi.drives.iter().all(|value| *value == 0.0) {
        return Vec::new();
    }
    let there = drives(nominal, signals, phi);
    let here = of_axes(nominal, signals, &phi.drives, false);
    let more = |joint: usize| there[joint].iter().zip(&here[joint]).map(|(a, b)| a - b).collect();
    sprung.into_iter().map(|joint| (JointIndex(joint), more(joint))).collect()
}

/// The torque of every joint by phi on the joint axes, and by what is known if that is asked for.
pub(super) fn of_axes(
    nominal: &Nominal<'_>,
    signals: &Signals,
    phi: &[f64],
    with_known: bool,
) -> PerJoint {
    let joints = nominal.model.joints.len();
    let of_joint = (0..joints).map(|joint| nominal.model.of_joint(joint, phi));
    let of_joint: Vec<Vec<f64>> = of_joint.collect();
    let mut torques = vec![Vec::with_capacity(signals.samples()); joints];
    let mut part = Vec::new();
    for_each_block(&mut nominal.model.evaluator(), signals, |rows| {
        part.resize(rows.samples(), 0.0);
        for joint in 0..joints {
            rows.torque(joint, &of_joint[joint], &mut part);
            if let Some(known) = rows.known(joint).filter(|_| !with_known) {
                part.iter_mut().zip(known).for_each(|(torque, known)| *torque -= known);
            }
            torques[joint].extend_from_slice(&part);
        }
    });
    torques
}

fn for_each_block(
    evaluator: &mut RegressionEvaluator,
    signals: &Signals,
    mut visit: impl FnMut(&RegressionRows),
) {
    let mut rows = RegressionRows::default();
    for first in (0..signals.samples()).step_by(BLOCK) {
        let range = first..(first + BLOCK).min(signals.samples());
        let motion = [&signals.q, &signals.qd, &signals.qdd].into_iter().flatten();
        let motion: Vec<&[f64]> = motion.map(|column| &column[range.clone()]).collect();
        evaluator.evaluate(&motion, &mut rows).expect("signals have a column for each joint");
        visit(&rows);
    }
}
