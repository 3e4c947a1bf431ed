//! Short windows from measured states, under measured torques.
//!
//! Where the motors before springs were measured, windows begin with their angles and rates as well
//! and the torques are those of the motors: springs pass on what the model makes of them.

use super::error::Error;
use super::{
    ACCURACY, Compared, Forward, ForwardJoint, ForwardKind, MotionLog, broken_off, column, names,
    rms, simulation, too_short,
};
use denavit_measure::SampleIndex;
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference};
use denavit_simulate::integrate::Method;
use denavit_simulate::{Control, DriveModelling, JointControl, Simulation, simulate};

/// Which windows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windows {
    /// The length of each \[s\].
    pub length_s: f64,
    /// At most so many, spread evenly over the log.
    pub most: usize,
}

impl Default for Windows {
    fn default() -> Self {
        Self { length_s: 0.2, most: 50 }
    }
}

/// Simulates windows of a log from the states at which they begin, under the torques that were
/// measured, and compares. Positions are compared with how far joints went in their windows.
pub fn in_windows(
    plant: &mut dyn Plant,
    log: &MotionLog,
    windows: Windows,
) -> Result<Forward, Error> {
    let model = plant.model().clone();
    names(&model)?;
    let torques = given(plant, log)?;
    // a window has its first and its last sample
    let steps = ((windows.length_s / log.step_s).round() as usize).max(1);
    let length_s = steps as f64 * log.step_s;
    let whole = log.range.len().saturating_sub(1) / steps;
    let count = whole.min(windows.most);
    if count == 0 {
        return Err(too_short(length_s));
    }
    let spare = log.range.len() - 1 - count * steps;
    let begin = |k: usize| log.range.start + k * steps + spare * k / (count - 1).max(1);
    let n = model.joints.len();
    let has_motors = log.drives.iter().any(Option::is_some);
    let drives = if has_motors { DriveModelling::Model } else { DriveModelling::Required };
    let mut signals = vec![[const { Vec::new() }; 4]; n];
    let mut went = vec![Vec::new(); n];
    let mut t_s = Vec::new();
    for from in (0..count).map(begin) {
        let initial = log.state(&model, SampleIndex(from), has_motors);
        let how = simulation(drives, log.time_s(SampleIndex(from + steps)), log);
        // Friction that is a steep line at rest makes explicit steps short, with light links most.
        let how = Simulation { method: Method::Radau(ACCURACY), ..how };
        let run = simulate(plant, &torques, &initial, &how)?;
        broken_off(&run)?;
        let samples = from + 1..from + steps + 1;
        t_s.extend(samples.clone().map(|sample| log.time_s(SampleIndex(sample))));
        for (index, joint) in model.joints.iter().enumerate() {
            let [q, simulated_q, qd, simulated_qd] = &mut signals[index];
            q.extend_from_slice(&log.q[index][samples.clone()]);
            qd.extend_from_slice(&log.qd[index][samples.clone()]);
            simulated_q.extend_from_slice(&column(&run.log, "q", &joint.name, steps + 1)[1..]);
            simulated_qd.extend_from_slice(&column(&run.log, "qd", &joint.name, steps + 1)[1..]);
            let start = log.q[index][from];
            went[index].extend(log.q[index][samples.clone()].iter().map(|q| q - start));
        }
    }
    let mut joints = Vec::new();
    for ((joint, [q, simulated_q, qd, simulated_qd]), went) in
        model.joints.iter().zip(signals).zip(went)
    {
        let [travel, turning] = [&went, &qd].map(|values| rms(values.iter().copied()));
        if travel > 0.0 {
            joints.push(ForwardJoint {
                name: joint.name.clone(),
                position: Compared::new(q, simulated_q, travel),
                rate: Compared::new(qd, simulated_qd, turning),
                torque: None,
            });
        }
    }
    let kind = ForwardKind::Windows { count, length_s };
    Ok(Forward { file: log.file.clone(), kind, t_s, joints })
}

/// The measured torques, to be fed forward.
fn given(plant: &dyn Plant, log: &MotionLog) -> Result<Control, Error> {
    let mut control = Control::passive(plant.model().joints.len());
    let times: Vec<f64> = log.range.clone().map(|sample| log.time_s(SampleIndex(sample))).collect();
    for (index, joint) in plant.model().joints.iter().enumerate() {
        let missing = || {
            let text = format!(
                "the torque of `{}` was not measured\n  hint: `options.controller` simulates \
                 without",
                joint.name
            );
            Error::missing(format!("tau_{}", joint.name), text)
        };
        let torque = log.torque[index].as_ref().ok_or_else(missing)?;
        let torque = torque[log.range.clone()].to_vec();
        let spline = CubicSpline::new(times.clone(), torque, [EndCondition::Natural; 2]);
        let feed_forward = Some(Reference::Cubic(spline.map_err(|_| missing())?));
        control.joints[index] = JointControl { feed_forward, ..JointControl::default() };
    }
    Ok(control)
}
