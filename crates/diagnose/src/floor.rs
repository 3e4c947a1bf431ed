//! The noise floor: what no model can explain, because it does not repeat.

use super::nominal::Nominal;
use super::rows::torques;
use super::signals::Signals;
use crate::policy::floor::{LEAST, UNREPEATABLE};
use denavit_measure::condition::{Butterworth, Laps};
use denavit_numerics::median;
pub(super) use denavit_numerics::rms;

/// The floor of one log, after the filter of the rows: the deviation of each joint's torque, then
/// of each spring's [N m, N]; of white noise above the motion's frequencies and of steps of
/// encoders, unless laps show more.
pub(super) type NoiseFloor = Vec<f64>;

/// The floors of logs, with the torques of the nominal model.
pub(super) fn floors(nominal: &Nominal<'_>, logs: &[Signals]) -> Vec<NoiseFloor> {
    let phi = nominal.phi(&vec![0.0; nominal.len()]);
    let of = |signals: &Signals| {
        let computed = torques(nominal, signals, &phi);
        let disturbed = torques(nominal, &signals.disturbed(), &phi);
        let passed = nominal.springs.iter().zip(&phi.springs).map(|(spring, stiffness)| {
            let [deflection, _] = signals.deflection(spring.joint)?;
            let rows = signals.rows_of(&deflection);
            Some(rows.iter().map(|deflection| stiffness * deflection).collect())
        });
        let torque = signals.torque.iter().cloned().chain(passed).collect::<Vec<_>>();
        floor(signals, &torque, &computed, &disturbed)
    };
    logs.iter().map(of).collect()
}

/// The floor of a log, given the torque of its rows, what the model makes of its motion, and of the
/// same with another error of its encoders: for each joint, then for each spring.
fn floor(
    signals: &Signals,
    torque: &[Option<Vec<f64>>],
    computed: &[Vec<f64>],
    disturbed: &[Vec<f64>],
) -> NoiseFloor {
    let gain = signals.noise_gain();
    let laps = signals.laps;
    let of = |equation: usize| {
        // No torque is measured of springs.
        let measured = signals.measured.get(equation);
        let white = measured.and_then(Option::as_ref).map_or(0.0, |own| gain * white_noise(own));
        let (own, moved) = (&computed[equation], &disturbed[equation]);
        let apart: Vec<f64> = own.iter().zip(moved).map(|(a, b)| a - b).collect();
        let of_log = white.hypot(usual(signals.rows_of(&apart)));
        let of_laps = laps.map(|laps| {
            let own = signals.cell_means(own);
            let left = match measured {
                Some(None) => return 0.0,
                Some(Some(measured)) => measured.iter().zip(own).map(|(a, b)| a - b).collect(),
                None => own,
            };
            lap_noise(&signals.filtered(left), laps)
        });
        // What differs much more from lap to lap than it shakes is not noise.
        let of_laps = of_laps.filter(|laps| *laps < UNREPEATABLE * of_log);
        let seen = of_laps.map_or(of_log, |laps| laps.max(of_log));
        let rms = torque[equation].as_ref().map_or(0.0, rms);
        seen.max(LEAST * rms).max(f64::MIN_POSITIVE)
    };
    (0..computed.len()).map(of).collect()
}

/// Deviation of white noise in a signal, from what it has above a quarter of its rate; steps and
/// spikes do not count.
pub(super) fn white_noise(signal: &[f64]) -> f64 {
    let Some(filter) = Butterworth::new(4, 0.25, 1.0) else { return 0.0 };
    let mut smooth = signal.to_vec();
    filter.zero_phase(&mut smooth);
    let rough = usual(signal.iter().zip(&smooth).map(|(a, b)| a - b).collect());
    let mut impulse = filter.zero_phase_impulse(64);
    impulse[64] -= 1.0;
    let gain = impulse.iter().map(|x| x * x).sum::<f64>().sqrt();
    rough / gain
}

/// The deviation of a normal variable whose largest values may be something else: the median of its
/// absolute value is 0.6745 of that.
fn usual(values: Vec<f64>) -> f64 {
    median(values.into_iter().map(f64::abs).collect()) / 0.6745
}

/// Usual deviation of a signal, from the differences of laps that follow each other.
fn lap_noise(signal: &[f64], laps: Laps) -> f64 {
    let Laps { start, samples, count, .. } = laps;
    let end = (start + (count - 1) * samples).min(signal.len().saturating_sub(samples));
    let pairs = start..end;
    usual(pairs.map(|k| signal[k + samples] - signal[k]).collect()) / 2.0_f64.sqrt()
}
