//! The noise floor: what no model can explain, because it does not repeat.

use super::nominal::Nominal;
use super::rows::torques;
use super::signals::Signals;
use crate::policy::floor::{LEAST, UNREPEATABLE};
use denavit_measure::condition::{Butterworth, Laps};

/// The floor of one log, after the filter of the rows.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseFloor {
    /// Deviation of each joint's torque, then of each spring's [N m, N]; of white noise above the
    /// motion's frequencies and of steps of encoders, unless laps show more.
    pub deviation: Vec<f64>,
    /// From white noise alone.
    pub white: Vec<f64>,
    /// From the steps of the encoders, through the model, where joints do not turn around.
    pub positions: Vec<f64>,
    /// From laps, where the motion repeats.
    pub laps: Option<Vec<f64>>,
    /// The period of the laps \[s\].
    pub period_s: Option<f64>,
}

impl NoiseFloor {
    /// The floors of logs, with the torques of the nominal model.
    pub fn of_logs(nominal: &Nominal<'_>, logs: &[Signals]) -> Vec<Self> {
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
            Self::new(signals, &torque, &computed, &disturbed)
        };
        logs.iter().map(of).collect()
    }

    /// The floor of a log, given the torque of its rows, what the model makes of its motion, and of
    /// the same with another error of its encoders: for each joint, then for each spring.
    pub fn new(
        signals: &Signals,
        torque: &[Option<Vec<f64>>],
        computed: &[Vec<f64>],
        disturbed: &[Vec<f64>],
    ) -> Self {
        let gain = signals.noise_gain();
        let mut white: Vec<f64> = signals
            .measured
            .iter()
            .map(|torque| torque.as_ref().map_or(0.0, |torque| gain * white_noise(torque)))
            .collect();
        // No torque is measured of springs.
        white.resize(computed.len(), 0.0);
        let both = computed.iter().zip(disturbed);
        let positions: Vec<f64> = both
            .map(|(a, b)| {
                usual(signals.rows_of(&a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>()))
            })
            .collect();
        let q: Vec<Vec<f64>> = signals.q.iter().map(|q| signals.cell_means(q)).collect();
        let end = q.first().map_or(0, Vec::len);
        let laps = Laps::find(&q, signals.log_step_s, 0..end).ok();
        let of_laps = laps.map(|laps| {
            let of = |(equation, computed): (usize, &Vec<f64>)| {
                let computed = signals.cell_means(computed);
                let left = match signals.measured.get(equation) {
                    Some(None) => return 0.0,
                    Some(Some(measured)) => {
                        measured.iter().zip(computed).map(|(a, b)| a - b).collect()
                    }
                    None => computed,
                };
                lap_noise(&signals.filtered(left), laps)
            };
            computed.iter().enumerate().map(of).collect::<Vec<f64>>()
        });
        let deviation = (0..white.len()).map(|equation| {
            let of_log = white[equation].hypot(positions[equation]);
            // What differs much more from lap to lap than it shakes is not noise.
            let laps = of_laps.as_ref().map(|laps| laps[equation]);
            let laps = laps.filter(|laps| *laps < UNREPEATABLE * of_log);
            let seen = laps.map_or(of_log, |laps| laps.max(of_log));
            let rms = torque[equation].as_ref().map_or(0.0, |torque| rms(torque));
            seen.max(LEAST * rms).max(f64::MIN_POSITIVE)
        });
        Self {
            deviation: deviation.collect(),
            white,
            positions,
            period_s: laps.map(|laps| laps.period * signals.log_step_s),
            laps: of_laps,
        }
    }
}

/// Deviation of white noise in a signal, from what it has above a quarter of its rate; steps and
/// spikes do not count.
pub(super) fn white_noise(signal: &[f64]) -> f64 {
    let Some(filter) = Butterworth::new(4, 0.25, 1.0) else { return 0.0 };
    let mut smooth = signal.to_vec();
    filter.zero_phase(&mut smooth);
    let rough = usual(signal.iter().zip(&smooth).map(|(a, b)| a - b).collect());
    let mut impulse = vec![0.0; 129];
    impulse[64] = 1.0;
    filter.zero_phase(&mut impulse);
    impulse[64] -= 1.0;
    let gain = impulse.iter().map(|x| x * x).sum::<f64>().sqrt();
    rough / gain
}

/// The deviation of a normal variable whose largest values may be something else: the median of its
/// absolute value is 0.6745 of that.
fn usual(values: Vec<f64>) -> f64 {
    let mut sizes: Vec<f64> = values.into_iter().map(f64::abs).collect();
    sizes.sort_by(f64::total_cmp);
    sizes.get(sizes.len() / 2).copied().unwrap_or(0.0) / 0.6745
}

/// Usual deviation of a signal, from the differences of laps that follow each other.
fn lap_noise(signal: &[f64], laps: Laps) -> f64 {
    let Laps { start, samples, count, .. } = laps;
    let end = (start + (count - 1) * samples).min(signal.len().saturating_sub(samples));
    let pairs = start..end;
    usual(pairs.map(|k| signal[k + samples] - signal[k]).collect()) / 2.0_f64.sqrt()
}

/// Root of the mean square.
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}
