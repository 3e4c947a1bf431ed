//! A biped that steps onto its capture point: as many steps as the linear inverted pendulum needs,
//! none, one and several, forward and backward, and a fall where there is no help.

use super::{assert_near, scenario};
use denavit_simulate::Stop;
use denavit_walk::capturability::{Capturability, Steps};
use denavit_walk::capture_step::step_limits;
use denavit_walk::robustness::{CapturePush, CapturePushOptions, capture_pushes};

const NAME: &str = "planar_biped_capture_step";

fn capturability() -> Capturability {
    Capturability::new(step_limits(&mut scenario(NAME)).unwrap()).unwrap()
}

fn pushed(impulses_ns: &[f64]) -> Vec<CapturePush> {
    let push = scenario(NAME).simulation.pushes[0].clone();
    let options = CapturePushOptions {
        point: push.point,
        at_s: push.at_s,
        impulses_ns: impulses_ns.to_vec(),
        after_s: 4.0,
    };
    capture_pushes(&|| Some(scenario(NAME)), &capturability(), &options, &|_, _| true)
}

#[test]
fn no_step_one_and_several_occur_as_predicted_and_a_fall() {
    let pushes = pushed(&[-28.0, -12.0, -6.0, 6.0, 14.0, 20.0, 28.0]);
    for push in &pushes {
        assert!(push.agrees(), "{push:?}");
    }
    let steps: Vec<usize> = pushes.iter().filter(|p| p.stands()).map(|push| push.steps).collect();
    assert_eq!(steps, [1, 0, 0, 1, 2]);
    assert_eq!(pushes[0].predicted, Some(Steps::Falls));
    assert_eq!(pushes[6].predicted, Some(Steps::Falls));
    // the same on any number of processors
    assert_eq!(pushed(&[14.0])[0], pushes[4]);
}

/// The laws of motion hold while references change: energy, forces, contacts.
#[test]
fn a_run_with_plans_obeys_its_audits() {
    let mut scenario = scenario(NAME);
    let run = scenario.run().unwrap();
    assert_eq!(run.stop, Stop::End);
    assert_eq!(scenario.broken(&run), []);
    // it stands: two feet, apart, no speed
    let fastest = run.end.qd.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
    assert!(fastest < 0.02, "{:?}", run.end.qd);
    // references are logged as they are followed
    let followed = run.log.column("ref_left_hip").unwrap();
    let joint = run.log.column("q_left_hip").unwrap();
    let swung = followed.iter().fold(0.0_f64, |most, q| most.max((q - followed[0]).abs()));
    assert!(swung > 0.3, "the left leg has made the step");
    assert_near(*followed.last().unwrap(), *joint.last().unwrap(), 0.02);
}

/// Between looks references are functions of time: shorter steps of integration change nothing.
#[test]
fn a_run_does_not_depend_on_the_accuracy_of_the_integration() {
    let ends = [1e-7, 1e-9].map(|relative| {
        let mut scenario = scenario(NAME);
        // up to the landing: contacts that stick and slip after it decide by less
        scenario.simulation.end_s = 0.7;
        if let denavit_simulate::integrate::Method::Radau(accuracy) =
            &mut scenario.simulation.method
        {
            accuracy.relative = relative;
            accuracy.absolute = 0.1 * relative;
        }
        scenario.run().unwrap().end.q
    });
    let apart = ends[0].iter().zip(&ends[1]).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-5, "{apart:e}");
}

#[test]
fn time_stepping_says_that_it_has_no_plans() {
    let mut scenario = scenario(NAME);
    scenario.simulation.pushes.clear();
    scenario.scheme = denavit_simulate::scenario::RunScheme::TimeStepping;
    let error = scenario.run().unwrap_err().to_string();
    let expected =
        "references that are planned during a run: only the event-driven scheme has them";
    assert!(error.contains(expected), "{error}");
}
