//! The whole log again, under the controller that the robot had.

use super::error::{Error, ErrorKind};
use super::{
    Compared, Controller, Forward, ForwardJoint, ForwardKind, LONGEST_S, MotionLog, broken_off,
    column, names, rms, simulation, too_short,
};
use denavit_measure::SampleIndex;
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference};
use denavit_simulate::{Control, DriveModelling, Log, simulate_believing};

/// Simulates a log again under a controller and compares, for its first minute at most. What is
/// simulated passes the filter of the log. A controller that compensates does so with `believed`,
/// the model that it had, else with the plant's own.
pub fn closed_loop(
    plant: &mut dyn Plant,
    believed: Option<&mut (dyn Plant + 'static)>,
    controller: &Controller,
    log: &MotionLog,
) -> Result<Forward, Error> {
    let settling = log.filter.as_ref().map_or(0, |filter| filter.settling());
    let most = (LONGEST_S / log.step_s) as usize;
    let from = log.range.start;
    let rows = (log.range.end - from).min(most.max(1));
    if rows <= 2 * settling + 1 {
        let needed_s = (2 * settling + 1) as f64 * log.step_s;
        return Err(too_short(needed_s));
    }
    let run = run(plant, believed, controller, log, from, rows)?;
    let kept = settling..rows - settling;
    let filtered = |prefix: &str, name: &str| {
        let mut values = column(&run, prefix, name, rows);
        if let Some(filter) = &log.filter {
            filter.zero_phase(&mut values);
        }
        values[kept.clone()].to_vec()
    };
    let measured = |values: &[f64]| values[from..][kept.clone()].to_vec();
    let mut joints = Vec::new();
    for (index, joint) in plant.model().joints.iter().enumerate() {
        let (q, qd) = (measured(&log.q[index]), measured(&log.qd[index]));
        let mean = q.iter().sum::<f64>() / q.len() as f64;
        let travel = rms(q.iter().map(|q| q - mean));
        if travel == 0.0 {
            continue;
        }
        let [turning, torque_rms] =
            [&qd[..], &log.torque[index].as_deref().map_or(Vec::new(), &measured)]
                .map(|values| rms(values.iter().copied()));
        let torque = log.torque[index].as_deref().map(|torque| {
            Compared::new(measured(torque), filtered("tau", &joint.name), torque_rms)
        });
        joints.push(ForwardJoint {
            name: joint.name.clone(),
            position: Compared::new(q, filtered("q", &joint.name), travel),
            rate: Compared::new(qd, filtered("qd", &joint.name), turning),
            torque,
        });
    }
    let (file, kind) = (log.file.clone(), ForwardKind::ClosedLoop);
    let t_s = kept.map(|sample| log.time_s(SampleIndex(from + sample))).collect();
    Ok(Forward { file, kind, t_s, joints })
}

/// The log that a model would have given under a controller: its samples, without noise.
pub fn simulated_log(
    plant: &mut dyn Plant,
    believed: Option<&mut (dyn Plant + 'static)>,
    controller: &Controller,
    log: &MotionLog,
) -> Result<MeasuredLog, Error> {
    let rows = log.samples();
    let run = run(plant, believed, controller, log, 0, rows)?;
    let signals = |name: &str| JointSignals {
        q: column(&run, "q", name, rows),
        qd: Some(column(&run, "qd", name, rows)),
        tau: Some(column(&run, "tau", name, rows)),
        ..JointSignals::default()
    };
    Ok(MeasuredLog {
        file: format!("{}, simulated", log.file),
        start_s: log.start_s,
        step_s: log.step_s,
        joints: plant.model().joints.iter().map(|joint| signals(&joint.name)).collect(),
        ..MeasuredLog::default()
    })
}

/// So many samples of a log from one of them on, simulated.
fn run(
    plant: &mut dyn Plant,
    believed: Option<&mut (dyn Plant + 'static)>,
    controller: &Controller,
    log: &MotionLog,
    from: usize,
    rows: usize,
) -> Result<Log, Error> {
    names(plant.model())?;
    let control = following(plant, controller, log)?;
    let initial = log.state(plant.model(), SampleIndex(from), true);
    let end_s = log.time_s(SampleIndex(from + rows - 1));
    let how = simulation(DriveModelling::Model, end_s, log);
    let run = simulate_believing(plant, believed, &control, &initial, &how)?;
    broken_off(&run)?;
    Ok(run.log)
}

/// The controller with the references of a log where it has none of its own.
fn following(
    plant: &dyn Plant,
    controller: &Controller,
    log: &MotionLog,
) -> Result<Control, Error> {
    let mut control = controller.control.clone();
    let joints = control.joints.iter_mut().zip(&plant.model().joints).enumerate();
    for (index, (own, joint)) in joints {
        let needs = controller.controlled[index]
            && own.reference.is_none()
            && (own.stiffness > 0.0 || own.damping > 0.0);
        if !needs {
            continue;
        }
        let missing = || {
            let (joint, column) = (&joint.name, format!("ref_{}", joint.name));
            let text = format!(
                "`{joint}` is controlled and follows nothing\n  hint: give it a `reference`, or \
                 the log a column `{column}`"
            );
            Error::missing(column, text)
        };
        let logged = log.reference[index].clone().ok_or_else(missing)?;
        let times = (0..logged.len()).map(|sample| log.time_s(SampleIndex(sample))).collect();
        let spline = CubicSpline::new(times, logged, [EndCondition::Natural; 2]);
        let spline = spline.map_err(|_| {
            let text = format!("`ref_{}` is no motion to follow", joint.name);
            Error::new(ErrorKind::Unsuitable, text)
        })?;
        own.reference = Some(Reference::Cubic(spline));
    }
    Ok(control)
}
