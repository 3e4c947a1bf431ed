//! Logs that are wrong get a message, or a repair that is said; never a silent wrong answer.

use super::robot;
use denavit_codegen::regressor::functions::modelled;
use denavit_measure::log::{
    ColumnMapping, LogFault, LogOf, LogRemark, MeasuredLog, Suspicion, read_log,
};
use denavit_measure::log::{FileFault, Place};
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use std::f64::consts::TAU;

const STEP_S: f64 = 0.002;

/// A log of two joints as text, row by row from what a test makes of it.
struct Made {
    names: Vec<String>,
    header: Vec<String>,
    rows: Vec<Vec<f64>>,
}

fn joints() -> (Vec<RegressionJoint>, Vec<String>) {
    let robot = robot("planar_2r");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model");
    let names = model.joints.iter().map(|joint| joint.name.clone()).collect();
    (model.joints, names)
}

impl Made {
    fn new() -> Self {
        let (_, names) = joints();
        let columns = ["q", "qd", "tau"];
        let mut header = vec!["t".to_owned()];
        for prefix in columns {
            header.extend(names.iter().map(|name| format!("{prefix}_{name}")));
        }
        let row = |k: usize| {
            let t = STEP_S * k as f64;
            let [u, v] = [TAU * 0.7 * t, TAU * 1.1 * t];
            let (a, b) = (0.6 * u.sin(), 0.8 * v.cos() + 0.1 * u.sin());
            let (ad, bd) =
                (0.6 * TAU * 0.7 * u.cos(), -0.8 * TAU * 1.1 * v.sin() + 0.1 * TAU * 0.7 * u.cos());
            vec![t, a, b, ad, bd, 2.0 * a - 0.3 * ad, b + 0.2 * bd]
        };
        Self { names, header, rows: (0..1500).map(row).collect() }
    }

    fn text(&self) -> String {
        let mut text = self.header.join(",") + "\n";
        for row in &self.rows {
            let cells: Vec<String> = row.iter().map(|cell| format!("{cell}")).collect();
            text += &(cells.join(",") + "\n");
        }
        text
    }

    fn read_as(&self, text: &str, map: &str) -> Result<MeasuredLog, Vec<LogFault>> {
        let (joints, _) = joints();
        let of =
            LogOf { model: "planar_2r", joints: &joints, contacts: &[], accepts_suspicious: false };
        let mapping = ColumnMapping::from_json("map.json", map.as_bytes()).expect("a mapping");
        read_log("log.csv", text.as_bytes(), of, &mapping).map_err(|faults| {
            assert!(faults.to_string().starts_with("log.csv"), "{faults}");
            faults.log_faults().expect("faults of the log").faults.clone()
        })
    }

    fn read(&self) -> Result<MeasuredLog, Vec<LogFault>> {
        self.read_as(&self.text(), "{}")
    }

    fn each(mut self, change: impl Fn(usize, &mut Vec<f64>)) -> Self {
        self.rows.iter_mut().enumerate().for_each(|(k, row)| change(k, row));
        self
    }
}

fn suspicion(faults: Vec<LogFault>) -> Suspicion {
    let found = faults.into_iter().find_map(|fault| match fault {
        LogFault::Suspicion(suspicion) => Some(suspicion),
        _ => None,
    });
    found.expect("a suspicion")
}

#[test]
fn a_sound_log_is_read_as_it_is() {
    let made = Made::new();
    let log = made.read().expect("nothing is wrong");
    assert!(log.remarks.is_empty(), "{:?}", log.remarks);
    assert_eq!(log.samples(), 1500);
    assert!((log.step_s - STEP_S).abs() < 1e-12);
    assert_eq!(log.joints[1].q[700], made.rows[700][2]);
    assert_eq!(log.joints[0].tau.as_ref().expect("measured")[3], made.rows[3][5]);
}

#[test]
fn missing_columns_are_all_named_at_once() {
    let mut made = Made::new();
    let names = made.names.clone();
    made.header[1] = format!("p_{}", names[0]);
    made.header[2] = format!("p_{}", names[1]);
    let faults = made.read().unwrap_err();
    let missing = faults.iter().filter(|one| matches!(one, LogFault::MissingColumn { .. }));
    assert_eq!(missing.count(), 2);
    // what is something else of the robot is not what was meant
    let mut other = Made::new();
    other.header[1] = format!("ref_{}", names[0]);
    let column = format!("q_{}", names[0]);
    let missing = LogFault::MissingColumn { column, nearest: None };
    assert_eq!(other.read().unwrap_err()[0], missing);
    // A mapping brings them back, scaled.
    let (a, b) = (&names[0], &names[1]);
    let map =
        format!(r#"{{"q_{a}": {{"column": "p_{a}", "scale": 1, "offset": 0}}, "q_{b}": "p_{b}"}}"#);
    assert!(made.read_as(&made.text(), &map).is_ok());
}

/// A name with `{joint}` in it is meant for each joint; one that is given itself counts before.
#[test]
fn a_name_for_all_joints_maps_each_of_them() {
    let sound = Made::new().read().expect("nothing is wrong");
    let mut made = Made::new();
    for cell in &mut made.header {
        if let Some(joint) = cell.strip_prefix("q_") {
            *cell = format!("at/{joint}/deg");
        }
    }
    let read = |map: &str| made.read_as(&made.text(), map);
    let log = read(r#"{"q_{joint}": "at/{joint}/deg"}"#).expect("all joints are mapped");
    assert_eq!(log.joints, sound.joints);
    let name = &made.names[0];
    let map =
        format!(r#"{{"q_{{joint}}": "at/{{joint}}/deg", "q_{name}": "at/{}/deg"}}"#, made.names[1]);
    let faults = read(&map).unwrap_err();
    assert!(matches!(&faults[..], [LogFault::SharedColumn { .. }]), "{faults:?}");
    let unknown = read(r#"{"q_{joint}": "at/{joint}/deg", "speed_{joint}": "x"}"#).unwrap_err();
    assert!(matches!(&unknown[..], [LogFault::UnknownName { .. }]), "{unknown:?}");
    let nowhere = read(r#"{"q_{joint}": "at/{joint}/deg", "ref_{joint}": "r/{joint}"}"#);
    let nowhere = nowhere.unwrap_err();
    assert!(matches!(&nowhere[..], [LogFault::MissingColumn { .. }]), "{nowhere:?}");
}

#[test]
fn another_robot_is_noticed() {
    let made = Made::new();
    let text = format!("# model: puma560\n{}", made.text());
    let faults = made.read_as(&text, "{}").unwrap_err();
    assert!(matches!(&faults[..], [LogFault::OtherModel { .. }]), "{faults:?}");
}

#[test]
fn cells_that_are_no_numbers_have_their_line_and_column() {
    let made = Made::new();
    let text = made.text().replacen("0.004,", "0.004x,", 1);
    let faults = made.read_as(&text, "{}").unwrap_err();
    let expected = ("t".to_owned(), "0.004x".to_owned());
    assert!(
        matches!(&faults[..], [LogFault::File(FileFault::NotANumber { line: 4, column, cell })]
            if (column, cell) == (&expected.0, &expected.1)),
        "{faults:?}"
    );
}

#[test]
fn time_that_goes_back_or_repeats_is_noticed() {
    let back = Made::new().each(|k, row| row[0] -= if k == 40 { 0.01 } else { 0.0 });
    assert!(matches!(
        back.read().unwrap_err()[..],
        [LogFault::TimeNotIncreasing { at: Place::Line(42) }]
    ));
    let mut twice = Made::new();
    let row = twice.rows[10].clone();
    twice.rows.insert(11, row);
    let log = twice.read().expect("the same row twice is dropped");
    assert_eq!(log.remarks, [LogRemark::DroppedRepeats { count: 1 }]);
    assert_eq!(log.samples(), 1500);
}

#[test]
fn one_sample_in_a_hundred_is_filled_in_and_said() {
    let mut made = Made::new();
    let whole = made.rows.clone();
    let mut k = 0;
    made.rows.retain(|_| {
        k += 1;
        k % 100 != 50
    });
    let log = made.read().expect("it is repaired");
    assert!(matches!(log.remarks[..], [LogRemark::FilledGaps { missing: 15, .. }]));
    for (k, row) in whole.iter().enumerate() {
        assert!((log.joints[0].q[k] - row[1]).abs() < 1e-8, "{k}");
    }
    let mut cut = Made::new();
    cut.rows.drain(300..400);
    assert!(matches!(cut.read().unwrap_err()[..], [LogFault::Gaps { missing: 100, .. }]));
}

#[test]
fn undefined_cells_are_filled_in_or_refused() {
    let made = Made::new();
    let holes = |every: usize| {
        let mut lines: Vec<String> = made.text().lines().map(str::to_owned).collect();
        for k in (20..1400).step_by(every) {
            let mut cells: Vec<&str> = lines[k].split(',').collect();
            cells[5] = "nan";
            lines[k] = cells.join(",");
        }
        lines.join("\n") + "\n"
    };
    let log = made.read_as(&holes(100), "{}").expect("few");
    assert!(matches!(log.remarks[..], [LogRemark::FilledCells { count: 14, .. }]));
    let many = made.read_as(&holes(10), "{}").unwrap_err();
    assert!(matches!(many[..], [LogFault::Undefined { count: 138, .. }]));
}

#[test]
fn milliseconds_are_no_seconds() {
    let faults = Made::new().each(|_, row| row[0] *= 1e3).read().unwrap_err();
    let found = suspicion(faults);
    assert!(matches!(found, Suspicion::TimeUnit { factor: 1e-3, .. }), "{found:?}");
    assert!(!found.to_string().contains("0.01}"), "{found}");
    let hundredths = Made::new().each(|_, row| row[0] *= 100.0).read().unwrap_err();
    let found = suspicion(hundredths).to_string();
    assert!(found.contains(r#"{"scale": 0.001}"#) && found.contains(r#"{"scale": 0.01}"#));
    for (scale, factor) in [(1e6, 1e-6), (1e9, 1e-9)] {
        let found = suspicion(Made::new().each(|_, row| row[0] *= scale).read().unwrap_err());
        let is_told = matches!(found, Suspicion::TimeUnit { factor: told, .. } if told == factor);
        assert!(is_told, "{scale}: {found:?}");
    }
    // Slower sampling hides it from the step, not from the rates.
    let mut slow = Made::new().each(|_, row| row[0] *= 10.0);
    slow.rows.truncate(1200);
    let found = suspicion(slow.read().unwrap_err());
    assert!(matches!(found, Suspicion::RateScale { ratio, .. } if (ratio - 10.0).abs() < 0.2));
}

#[test]
fn days_and_picoseconds_are_no_seconds() {
    for scale in [1.0 / 86_400.0, 1e-9] {
        let faults = Made::new().each(|_, row| row[0] *= scale).read().unwrap_err();
        let found = suspicion(faults);
        assert!(matches!(found, Suspicion::TimeUnit { factor: 3600.0, .. }), "{found:?}");
        assert!(found.to_string().contains("86400"), "{found}");
    }
}

/// Torques of a joint that moves are never as small: what changes by 1e-40 N m does not.
#[test]
fn torques_that_vanish_are_refused() {
    for scale in [1e-40, 1e-160, 1e-300] {
        let tiny = Made::new().each(|_, row| row[5..].iter_mut().for_each(|tau| *tau *= scale));
        let found = suspicion(tiny.read().unwrap_err());
        assert!(matches!(found, Suspicion::ConstantTorque { .. }), "{found:?}");
    }
}

#[test]
fn degrees_are_no_radians() {
    let faults = Made::new().each(|_, row| row[1] = row[1].to_degrees()).read().unwrap_err();
    let says = faults.iter().any(|fault| {
        matches!(
            fault,
            LogFault::Suspicion(Suspicion::Degrees { .. } | Suspicion::RateScale { .. })
        )
    });
    assert!(says, "{faults:?}");
}

/// Derivatives of such positions are mostly noise; that is no fault of the rates.
#[test]
fn noisy_positions_and_coarse_encoders_are_no_suspicion() {
    let noisy = Made::new().each(|k, row| row[1] += 0.01 * (k as f64 * 12.9898).sin());
    assert!(noisy.read().is_ok());
    let coarse = Made::new().each(|_, row| row[1] = (row[1] / 0.02).round() * 0.02);
    assert!(coarse.read().is_ok());
}

#[test]
fn swapped_joints_are_named() {
    let faults = Made::new().each(|_, row| row.swap(3, 4)).read().unwrap_err();
    let found =
        faults.iter().any(|fault| matches!(fault, LogFault::Suspicion(Suspicion::Swapped { .. })));
    assert!(found, "{faults:?}");
}

#[test]
fn constant_torque_and_resting_joints_are_told_apart() {
    let constant = Made::new().each(|_, row| row[5] = 1.5).read().unwrap_err();
    assert!(matches!(suspicion(constant), Suspicion::ConstantTorque { .. }));
    let resting = Made::new().each(|_, row| (row[2], row[4]) = (0.25, 0.0));
    let log = resting.read().expect("a joint may rest");
    assert!(matches!(&log.remarks[..], [LogRemark::Resting { .. }]), "{:?}", log.remarks);
    let still = Made::new().each(|_, row| row[1..5].fill(0.0)).read().unwrap_err();
    assert!(still.contains(&LogFault::NothingMoves));
}

#[test]
fn saturation_and_encoder_steps_are_remarked() {
    let clipped = Made::new().each(|_, row| row[5] = row[5].clamp(-0.8, 0.8));
    let log = clipped.read().expect("a remark is no fault");
    let saturated =
        log.remarks.iter().filter(|one| matches!(one, LogRemark::Saturated { .. })).count();
    assert_eq!(saturated, 2, "{:?}", log.remarks);
    let step = TAU / 4000.0;
    let stepped = Made::new().each(|_, row| row[1] = (row[1] / step).round() * step);
    let log = stepped.read().expect("encoders have steps");
    let found = log.joints[0].step.expect("steps are seen");
    assert!((found / step - 1.0).abs() < 1e-6, "{found}");
    assert_eq!(log.joints[1].step, None);
}

/// Whatever a log is mapped and repaired by: degrees with five digits, single precision, a row
/// that is missing, times that scatter, a cell without a number.
#[test]
fn steps_are_those_of_the_log_before_any_repair() {
    let step_deg = 360.0 / 262_144.0;
    let stepped = |q: f64| (q.to_degrees() / step_deg).round() * step_deg;
    let printed = |q: f64| (q * 1e5).round() / 1e5;
    let scatter = |k: usize| 0.05 * STEP_S * (1.7 * k as f64).sin();
    let mut made = Made::new().each(|k, row| {
        row[0] += scatter(k);
        row[1] = printed(stepped(row[1]));
        row[2] = f64::from(stepped(row[2]) as f32);
    });
    made.rows.remove(700);
    made.rows[300][1] = f64::NAN;
    let scaled = |name: &String| format!(r#""q_{name}": {{"scale": {}}}"#, 1f64.to_radians());
    let map: Vec<String> = made.names.iter().map(scaled).collect();
    let log = made.read_as(&made.text(), &format!("{{{}}}", map.join(", "))).expect("mended");
    assert!(log.remarks.iter().any(|remark| matches!(remark, LogRemark::Resampled { .. })));
    for joint in &log.joints {
        let found = joint.step.expect("steps are seen").to_degrees();
        assert!((found / step_deg - 1.0).abs() < 1e-4, "{found}");
    }
}

/// A geared model whose file says that logs have torques of motors: 50 motor turns a joint turn.
#[test]
fn one_side_of_the_gears_is_decided_in_one_place() {
    let shipped = denavit_plants::shipped::find("planar_2r").expect("shipped");
    let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    let names = joints().1;
    text["torque_side"] = "motor".into();
    text["drives"] = serde_json::json!({});
    text["drives"][&names[0]] = serde_json::json!({"gear_ratio": 50, "viscous": 1e-4});
    let robot = denavit_codegen::model::read("m", text.to_string().as_bytes()).expect("sound");
    let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model");
    let of = LogOf {
        model: "planar_2r",
        joints: &model.joints,
        contacts: &[],
        accepts_suspicious: false,
    };
    let read = |header: &str| {
        let text = format!("{header}{}", Made::new().text());
        read_log("log.csv", text.as_bytes(), of, &ColumnMapping::default())
    };
    let torque = |header: &str, joint: usize| {
        read(header).expect("sound").joints[joint].tau.as_ref().expect("measured")[3]
    };
    let own = [5, 6].map(|column| Made::new().rows[3][column]);
    for (header, factor) in
        [("", 50.0), ("# torque_side: joint\n", 1.0), ("# torque_side: motor\n", 50.0)]
    {
        assert_eq!(torque(header, 0), factor * own[0], "{header}");
        // no gear: both sides are one
        assert_eq!(torque(header, 1), own[1], "{header}");
        let remarks = read(header).expect("sound").remarks;
        let said = remarks
            .iter()
            .any(|r| *r == LogRemark::MotorTorques { joints: vec![names[0].clone()] });
        assert_eq!(said, factor != 1.0, "{remarks:?}");
    }
    let faults = read("# torque_side: load\n").unwrap_err();
    assert!(faults.to_string().contains("`joint` and `motor`"), "{faults}");
}

/// A mistake in the name of a torque would silently take its joint out of the estimate.
#[test]
fn a_torque_that_is_missing_beside_others_is_a_fault() {
    let mut made = Made::new();
    let name = made.names[1].clone();
    made.header[6] = format!("taw_{name}");
    let faults = made.read().unwrap_err();
    let expected = LogFault::MissingTorque {
        column: format!("tau_{name}"),
        nearest: Some(format!("taw_{name}")),
    };
    assert_eq!(faults, [expected]);
    let log = made.read_as(&made.text(), &format!(r#"{{"tau_{name}": "taw_{name}"}}"#));
    assert!(log.expect("it is named").joints[1].tau.is_some());
    let log = made.read_as(&made.text(), &format!(r#"{{"tau_{name}": null}}"#));
    assert!(log.expect("left out on purpose").joints[1].tau.is_none());
    // what every log must have cannot be left out
    let faults = made.read_as(&made.text(), &format!(r#"{{"q_{name}": null}}"#)).unwrap_err();
    assert!(matches!(faults[0], LogFault::MissingColumn { .. }), "{faults:?}");
}

#[test]
fn one_column_is_not_two_of_ours() {
    let made = Made::new();
    let (a, b) = (&made.names[0], &made.names[1]);
    let twice = format!(r#"{{"tau_{a}": "tau_{b}"}}"#);
    let faults = made.read_as(&made.text(), &twice).unwrap_err();
    let ours = vec![format!("tau_{a}"), format!("tau_{b}")];
    assert_eq!(faults, [LogFault::SharedColumn { column: ours[1].clone(), ours }]);
    let exchanged = format!(r#"{{"tau_{a}": "tau_{b}", "tau_{b}": "tau_{a}"}}"#);
    let log = made.read_as(&made.text(), &exchanged).expect("each has its own");
    assert_eq!(log.joints[0].tau.as_ref().expect("measured")[3], made.rows[3][6]);
}

#[test]
fn numbers_that_nothing_of_a_robot_can_be_have_their_line() {
    for (column, value) in [(5, 1e308), (1, -1e20), (0, 1e300)] {
        let made = Made::new().each(|k, row| {
            if k == 500 {
                row[column] = value;
            }
        });
        let faults = made.read().unwrap_err();
        let expected = LogFault::Impossible {
            column: made.header[column].clone(),
            value,
            at: Place::Line(502),
        };
        assert_eq!(faults, [expected]);
    }
}

#[test]
fn one_torque_far_beyond_its_limit_is_a_suspicion() {
    let mut joints = joints().0;
    joints[0].torque_limits = Some([-2.0, 2.0]);
    let of =
        LogOf { model: "planar_2r", joints: &joints, contacts: &[], accepts_suspicious: false };
    let read = |value: f64| {
        let made = Made::new().each(|k, row| row[5] = if k == 900 { value } else { row[5] });
        let text = made.text();
        read_log("log.csv", text.as_bytes(), of, &ColumnMapping::default())
    };
    assert!(read(1.9).is_ok());
    let found = suspicion(read(-40.0).unwrap_err().log_faults().expect("faults").faults.clone());
    assert!(matches!(found, Suspicion::BeyondTorque { samples: 1, .. }), "{found:?}");
}

/// An encoder that slips, and laps joined end to end, are named with their line; noise, rest and
/// coarse steps are not.
#[test]
fn positions_that_jump_have_their_line() {
    let slipped = Made::new().each(|k, row| row[2] += if k >= 700 { 0.05 } else { 0.0 });
    match suspicion(slipped.read().unwrap_err()) {
        Suspicion::Jump { column, at, from, to, others } => {
            // one line of names, and rows from 0
            assert_eq!((column.as_str(), at, others), ("q_link2", Place::Line(702), 0));
            assert!((to - from - 0.05).abs() < 0.02, "{from} {to}");
        }
        other => panic!("{other:?}"),
    }
    let mut twice = Made::new();
    let again: Vec<Vec<f64>> = twice.rows[..1200].to_vec();
    twice.rows.extend(again);
    let joined = twice.each(|k, row| row[0] = STEP_S * k as f64);
    match suspicion(joined.read().unwrap_err()) {
        Suspicion::Jump { at, .. } => assert_eq!(at, Place::Line(1502)),
        other => panic!("{other:?}"),
    }
    let mut random = denavit_numerics::Random::new(4);
    let noise: Vec<f64> = (0..1500).map(|_| 1e-3 * random.normal()).collect();
    Made::new().each(|k, row| row[1] += noise[k]).read().expect("noise is no jump");
    let coarse = Made::new().each(|_, row| row[1] = (row[1] / 0.01).round() * 0.01);
    coarse.read().expect("a coarse encoder");
    // samples that are missing are a gap, over which a joint goes on
    let mut gap = Made::new();
    gap.rows.drain(600..604);
    gap.read().expect("a short gap");
}

#[test]
fn a_line_without_end_is_refused_before_it_fills_the_memory() {
    let made = Made::new();
    let text = made.text() + &"1".repeat(3 << 20);
    let faults = made.read_as(&text, "{}").unwrap_err();
    assert_eq!(faults, [LogFault::File(FileFault::LongLine { line: 1502 })]);
}
