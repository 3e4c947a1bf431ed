//! The model in motion against a log: closed forms, and logs of our own simulation.

use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::functions::modelled;
use denavit_measure::condition::Filter;
use denavit_measure::log::{ColumnMapping, JointSignals, LogOf, MeasuredLog, read_log};
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_plants::{Override, Plant, plant_of};
use denavit_replay::{
    ErrorKind, Forward, ForwardKind, MotionLog, Windows, closed_loop, in_windows, simulated_log,
};
use denavit_simulate::scenario::{self, Controller, read_controller};

const STEP_S: f64 = 1e-3;

fn robot(name: &str) -> Robot {
    let shipped = shipped::find(name).expect("a shipped model");
    model::read(name, shipped.text.as_bytes()).expect("shipped models are sound")
}

fn load(name: &str) -> Result<Vec<u8>, String> {
    let found = shipped::find_referred(name).ok_or("no such file")?;
    Ok(found.text.as_bytes().to_vec())
}

fn plant(name: &str, overrides: &[(&str, f64)]) -> Box<dyn Plant> {
    let one = |&(parameter, value): &(&str, f64)| {
        let parameter = parameter.to_owned();
        Override { parameter, value }
    };
    let overrides: Vec<Override> = overrides.iter().map(one).collect();
    plant_of(&robot(name), &overrides).unwrap_or_else(|error| panic!("{error}"))
}

/// The carriage of EMPS under a constant force, from rest: m v' = F - b v.
fn pushed(mass: f64, viscous: f64, force: f64) -> MeasuredLog {
    let rate = viscous / mass;
    let q = (0..600).map(|k| {
        let t = STEP_S * f64::from(k);
        force / viscous * (t - (1.0 - (-rate * t).exp()) / rate)
    });
    let tau = Some(vec![force; 600]);
    let joint = JointSignals { q: q.collect(), tau, ..JointSignals::default() };
    MeasuredLog { step_s: STEP_S, joints: vec![joint], ..MeasuredLog::default() }
}

fn motion(log: &MeasuredLog, filter: Option<Filter>) -> MotionLog {
    let names = vec![String::new(); log.joints.len()];
    MotionLog::new(log, &names, filter).expect("long enough")
}

#[test]
fn windows_of_a_pushed_carriage_are_those_of_the_closed_form() {
    let frictionless = [("fc_carriage", 0.0), ("off_carriage", 0.0)];
    let log = motion(&pushed(95.1089, 203.5034, 20.0), None);
    let windows = Windows { length_s: 0.1, most: 5 };
    let mut right = plant("emps", &frictionless);
    let found = in_windows(right.as_mut(), &log, windows).expect("a comparison");
    let Forward { kind: ForwardKind::Windows { count, length_s }, .. } = found else {
        panic!("windows")
    };
    assert_eq!((count, length_s), (5, 0.1));
    // rates are differences of sixth order, exact to 1e-12; the integrator has 1e-6
    assert!(found.relative() < 1e-6, "{}", found.relative());
    assert_eq!(found.t_s.len(), 500);

    // With half the mass the carriage gains twice the acceleration that is left: from the rate v0
    // its motion is v = F/b + (v0 - F/b) exp(-b t / m).
    let mut light = plant("emps", &[frictionless[0], frictionless[1], ("m_carriage", 47.55445)]);
    let found = in_windows(light.as_mut(), &log, windows).expect("a comparison");
    let (terminal, rate) = (20.0 / 203.5034, 203.5034 / 95.1089);
    let position = &found.joints[0].position;
    for (k, residual) in position.residual().enumerate() {
        let t = found.t_s[k];
        let begin = t - STEP_S * (k % 100 + 1) as f64;
        let v0 = terminal * (1.0 - (-rate * begin).exp());
        let after = |rate: f64| {
            let s = t - begin;
            terminal * s + (v0 - terminal) * (1.0 - (-rate * s).exp()) / rate
        };
        let expected = after(2.0 * rate) - after(rate);
        assert!((residual - expected).abs() < 1e-8, "{t}: {residual} {expected}");
    }
    assert!(found.relative() > 0.01);
}

/// A shipped scenario's log with everything in it, its control as a controller, its joints' names.
fn experiment(name: &str, duration_s: f64) -> (MeasuredLog, String) {
    let shipped = shipped::find_scenario(name).expect("a shipped scenario");
    let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    text["duration_s"] = duration_s.into();
    text["log_period_s"] = STEP_S.into();
    text["measurement"] = serde_json::json!({});
    text["control"]["format"] = scenario::CONTROLLER_FORMAT.into();
    let control = text["control"].to_string();
    let read = scenario::read(name, text.to_string().as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    let run = scenario.run().unwrap_or_else(|error| panic!("{error}"));
    let robot = robot(&scenario.plant.model().name);
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model");
    let of = LogOf {
        model: &model.model,
        joints: &model.joints,
        contacts: &[],
        accepts_suspicious: false,
    };
    let csv = run.log.to_csv();
    let log = read_log("log.csv", csv.as_bytes(), of, &ColumnMapping::default());
    (log.unwrap_or_else(|faults| panic!("{faults}")), control)
}

fn controller(text: &str, plant: &dyn Plant) -> Controller {
    let read = read_controller("controller.json", text.as_bytes(), plant.model(), &load);
    read.unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn the_elastic_leg_under_its_own_controller_repeats_its_log() {
    let (log, control) = experiment("tulip_leg_tracking", 1.2);
    let filter = Some(Filter { order: 4, cutoff_hz: 40.0 });
    let log = motion(&log, filter);
    let mut right = plant("tulip_leg", &[]);
    let controller = controller(&control, right.as_ref());
    let after = closed_loop(right.as_mut(), None, &controller, &log).expect("a comparison");
    assert_eq!(after.kind, ForwardKind::ClosedLoop);
    // what is left is how the run begins: rates of filtered positions, springs of filtered torques
    assert!(after.relative() < 2e-3, "{}", after.relative());
    for joint in &after.joints {
        let torque = joint.torque.as_ref().expect("logged");
        assert!(torque.relative < 0.02, "{} {}", joint.name, torque.relative);
    }

    let mut heavy = plant("tulip_leg", &[("m4", 6.0), ("m5", 2.0)]);
    let mut believed = plant("tulip_leg", &[]);
    let before = closed_loop(heavy.as_mut(), Some(believed.as_mut()), &controller, &log);
    let before = before.expect("a comparison");
    assert!(before.relative() > 5.0 * after.relative(), "{}", before.relative());

    let in_short = in_windows(right.as_mut(), &log, Windows::default()).expect("a comparison");
    let apart = in_windows(heavy.as_mut(), &log, Windows::default()).expect("a comparison");
    println!("windows {} {}", in_short.relative(), apart.relative());
    assert!(in_short.relative() < 0.05 && apart.relative() > 3.0 * in_short.relative());
}

#[test]
fn references_are_those_of_the_log_where_a_controller_has_none() {
    let (log, control) = experiment("tulip_leg_tracking", 0.8);
    let mut text: serde_json::Value = serde_json::from_str(&control).expect("JSON");
    for (_, joint) in text["joints"].as_object_mut().expect("joints") {
        joint.as_object_mut().expect("an object").remove("reference");
    }
    let mut own = plant("tulip_leg", &[]);
    let follows = controller(&text.to_string(), own.as_ref());
    assert!(follows.controlled.iter().all(|controlled| *controlled));
    assert!(follows.control.joints.iter().all(|joint| joint.reference.is_none()));
    let simulated =
        simulated_log(own.as_mut(), None, &follows, &motion(&log, None)).expect("a log");
    assert_eq!(simulated.samples(), log.samples());
    for (ours, logged) in simulated.joints.iter().zip(&log.joints) {
        for (a, b) in ours.q.iter().zip(&logged.q) {
            assert!((a - b).abs() < 2e-6, "{a} {b}");
        }
    }
    let mut silent = log;
    silent.joints[2].reference = None;
    let refused = closed_loop(own.as_mut(), None, &follows, &motion(&silent, None));
    let error = refused.expect_err("nothing to follow");
    assert_eq!(error.kind(), ErrorKind::MissingColumn);
    assert_eq!(error.column(), Some("ref_hip_y"));
}

#[test]
fn what_cannot_be_simulated_again_is_refused() {
    let log = motion(&pushed(95.0, 200.0, 20.0), None);
    let mut own = plant("emps", &[]);
    let long = Windows { length_s: 2.0, most: 5 };
    let short = in_windows(own.as_mut(), &log, long).expect_err("a window of 2 s");
    assert_eq!(short.kind(), ErrorKind::TooShort);
    assert!(short.to_string().ends_with("a window of 2 s"), "{short}");
    let mut untold = pushed(95.0, 200.0, 20.0);
    untold.joints[0].tau = None;
    let refused = in_windows(own.as_mut(), &motion(&untold, None), Windows::default());
    let untold = refused.expect_err("no torque");
    assert_eq!(untold.kind(), ErrorKind::MissingColumn);
    assert_eq!(untold.column(), Some("tau_carriage"));
    let mut walker = plant("planar_biped", &[]);
    let n = walker.model().joints.len();
    let mut log = pushed(95.0, 200.0, 20.0);
    log.joints = vec![log.joints[0].clone(); n];
    let refused = in_windows(walker.as_mut(), &motion(&log, None), Windows::default());
    assert_eq!(refused.expect_err("its base floats").kind(), ErrorKind::Unsuitable);
}
