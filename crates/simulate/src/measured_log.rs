//! What instruments would have written down of a run.

use super::log::Log;
use super::measure::Measurement;
use denavit_numerics::Random;

/// The log as instruments give it: positions of joints and motors quantised and noisy, torques of
/// motors with their noise, and nothing that nobody measures (rates, energies).
///
/// A stiff drive's torque is that of its motor, `tau_cmd_`, which friction has still to be taken
/// off; it becomes `tau_`. Of a series elastic drive `tau_` is left out: the spring's torque is
/// known through both angles alone. Where rows are the samples of a controller (`is_sampled`), a
/// command jumps at every row, which has the torque after the jump, as the row before it has that
/// before it: an instrument reads their mean. Either one alone is half a period early or late,
/// which an estimate takes for viscous friction. `seed` is of the noise; the controller has its
/// own.
pub(crate) fn measured_log(
    log: &Log,
    measurement: &Measurement,
    torque_noise: f64,
    is_sampled: bool,
    seed: u64,
) -> Log {
    let has_motor =
        |joint: &str| log.columns.iter().any(|column| *column == format!("motor_{joint}"));
    let mut kept: Vec<(usize, String, Instrument)> = Vec::new();
    for (at, column) in log.columns.iter().enumerate() {
        let kind = match column.split_once('_') {
            Some(("q" | "motor", _)) => Instrument::Angle,
            Some(("tau", rest)) => match rest.strip_prefix("cmd_") {
                Some(joint) if !has_motor(joint) => {
                    kept.push((at, format!("tau_{joint}"), Instrument::Torque));
                    continue;
                }
                Some(_) => Instrument::Torque,
                None => continue,
            },
            Some(("ref" | "f" | "w", _)) => Instrument::Exact,
            _ if column == "t" => Instrument::Exact,
            _ => continue,
        };
        kept.push((at, column.clone(), kind));
    }
    // another stream than that of the controller's instruments
    let mut random = Random::new(seed ^ 0x6d65_6173_7572_6564);
    let mut values = Vec::with_capacity(log.len() * kept.len());
    let mut before: Option<&[f64]> = None;
    for row in log.rows() {
        let last = before.filter(|_| is_sampled).unwrap_or(row);
        for (at, _, kind) in &kept {
            let value = match kind {
                Instrument::Torque => 0.5 * (last[*at] + row[*at]),
                _ => row[*at],
            };
            values.push(kind.measured(value, measurement, torque_noise, &mut random));
        }
        before = Some(row);
    }
    let columns = kept.into_iter().map(|(_, name, _)| name).collect();
    Log { header: log.header.clone(), columns, values }
}

#[derive(Clone, Copy, Debug)]
enum Instrument {
    Exact,
    Angle,
    Torque,
}

impl Instrument {
    fn measured(
        self,
        value: f64,
        measurement: &Measurement,
        torque_noise: f64,
        random: &mut Random,
    ) -> f64 {
        match self {
            Self::Exact => value,
            Self::Torque => value + torque_noise * random.normal(),
            Self::Angle => {
                let Measurement { resolution, position_noise, .. } = *measurement;
                let mut angle = value;
                if position_noise > 0.0 {
                    angle += position_noise * random.normal();
                }
                if resolution > 0.0 { (angle / resolution).round() * resolution } else { angle }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_measured_log_has_what_instruments_give() {
        let columns = ["t", "q_a", "q_b", "qd_a", "ref_a", "tau_a", "tau_b", "tau_cmd_a"];
        let more = ["tau_cmd_b", "motor_b", "f_toe_z", "energy"];
        let log = Log {
            header: Vec::new(),
            columns: columns.iter().chain(&more).map(|name| (*name).to_owned()).collect(),
            values: (0..12 * 500).map(|at| (at % 12) as f64 + 0.26).collect(),
        };
        let measurement = Measurement { resolution: 0.1, ..Measurement::default() };
        let measured = measured_log(&log, &measurement, 0.5, true, 1);
        let names = ["t", "q_a", "q_b", "ref_a", "tau_a", "tau_cmd_b", "motor_b", "f_toe_z"];
        assert_eq!(measured.columns, names);
        let column = |name: &str| measured.column(name).expect("a column");
        assert!(column("t").iter().all(|t| *t == 0.26));
        assert!(column("q_a").iter().all(|q| (q - 1.3).abs() < 1e-12));
        let torque = column("tau_a");
        // noise and nothing else: the command does not change in this log
        let mean = torque.iter().sum::<f64>() / 500.0;
        let spread = torque.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / 499.0;
        // of tau_cmd_a; five standard errors
        assert!((mean - 7.26).abs() < 0.12, "{mean}");
        assert!((spread.sqrt() - 0.5).abs() < 0.08, "{spread}");
    }
}
