//! Columns of a log that are other ones than they are taken for: said, and no effect in their
//! place.

use super::search::{puma, puma_log};
use denavit_diagnose::{Diagnosis, Request, Verdict, diagnose};
use denavit_measure::log::MeasuredLog;

/// What a model without candidates says of two logs that are misread alike.
fn diagnosed(misread: impl Fn(&mut MeasuredLog)) -> Diagnosis {
    let model = puma();
    let phi = model.model_axes().expect("it has all values");
    let logs = || {
        let mut log = puma_log(&model, &phi);
        misread(&mut log);
        vec![log]
    };
    let request = Request {
        model: &model,
        springs: &[],
        train: logs(),
        held_out: logs(),
        candidates: &[],
        given: Vec::new(),
        aliases: None,
        experiment: None,
        moved: None,
        most_effects: 6,
        filters: None,
    };
    diagnose(request, &mut |_| true).expect("a diagnosis")
}

#[test]
fn wrong_columns_are_said() {
    let scaled = |log: &mut MeasuredLog, joint: usize, factor: f64| {
        let torque = log.joints[joint].tau.as_mut().expect("measured");
        torque.iter_mut().for_each(|torque| *torque *= factor);
    };
    let sign = diagnosed(|log| scaled(log, 2, -1.0));
    let unit = diagnosed(|log| (0..6).for_each(|joint| scaled(log, joint, 1e3)));
    let exchanged = diagnosed(|log| {
        let torque = log.joints[1].tau.take();
        log.joints[1].tau = std::mem::replace(&mut log.joints[2].tau, torque);
    });
    for (found, said) in [
        (sign, "the torque of elbow seems to have the wrong sign"),
        (unit, "torques seem to be in another unit"),
        (exchanged, "the torques of shoulder and elbow seem to be exchanged"),
    ] {
        assert_eq!(found.verdict, Verdict::CannotTell);
        assert!(found.reasons[0].starts_with(said), "{said}: {:?}", found.reasons);
    }
}

#[test]
fn nothing_is_said_of_good_columns() {
    let found = diagnosed(|_| {});
    assert_eq!(found.verdict, Verdict::NothingMissing, "{:?}", found.reasons);
}
