//! Topics with clocks of their own on one.

use crate::made::{Cdr, Mcap, columns, joint_state, opened, read};
use denavit_logs::{FileFault, FileRemark, Found, Opening};

const WRENCH: &str = "std_msgs/Header header\nWrench wrench\n\
    ===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
    ===\nMSG: geometry_msgs/Wrench\nVector3 force\nVector3 torque\n\
    ===\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n";

/// The first time: of a clock that counts from long ago.
const START_NS: u64 = 1_700_000_000_123_456_789;

fn wrench(time_ns: u64, force: f64) -> Vec<u8> {
    let start = Cdr::new(false).header(time_ns);
    (0..6).fold(start, |cdr, part| cdr.number(if part == 2 { force } else { 0.0 })).bytes()
}

fn signal(time_s: f64) -> f64 {
    (3.0 * time_s).sin()
}

/// Joints at 500 Hz for 2 s, a force at `hz` from 0.1 s on, apart from messages in a pause.
fn two_topics(hz: f64, pause_s: [f64; 2]) -> Mcap {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    let kind = "geometry_msgs/msg/WrenchStamped";
    let force = file.topic("/contacts/toe", kind, WRENCH);
    let at = |time_s: f64| START_NS + (time_s * 1e9).round() as u64;
    for row in 0..1000_u64 {
        let time_s = 0.002 * row as f64;
        let data = joint_state(at(time_s), &["a"], [&[signal(time_s)], &[], &[]]);
        file.message(joints, at(time_s), &data);
    }
    for row in 0.. {
        let time_s = 0.1 + f64::from(row) / hz;
        if time_s > 1.95 {
            break;
        }
        if !(pause_s[0]..pause_s[1]).contains(&time_s) {
            file.message(force, at(time_s), &wrench(at(time_s), signal(time_s)));
        }
    }
    file
}

#[test]
fn topics_of_other_rates_are_interpolated_and_reported() {
    for hz in [170.0, 1000.0, 1234.5] {
        let table = read(&two_topics(hz, [0.0; 2]).plain(), &["t", "q_a", "f_toe_z"]);
        let [t, q, f] = &table.columns[..] else { panic!("three columns") };
        // from the first time on that both have
        assert!((t.len() as f64 - 925.0).abs() < 2.0, "{}", t.len());
        assert!(t[0].abs() < 1e-9 && (t[1] - 0.002).abs() < 1e-12, "{:?}", &t[..2]);
        for (q, f) in q.iter().zip(f) {
            assert!((q - f).abs() < 1e-6, "{hz}: {q} {f}");
        }
        let told: Vec<String> = table.remarks.iter().map(ToString::to_string).collect();
        assert!(told[0].contains("0.1") && told[0].contains("`/joint_states`"), "{told:?}");
        let rate = format!("`/contacts/toe` ({hz:.1} Hz)");
        let is_exact = hz == 1000.0;
        assert_eq!(told.len(), if is_exact { 1 } else { 2 }, "{told:?}");
        assert!(is_exact || told[1].contains(&rate) && told[1].contains("500.0 Hz"), "{told:?}");
    }
}

#[test]
fn a_pause_is_refused_and_topics_apart_are() {
    let log = opened(&two_topics(170.0, [0.8, 1.1]).plain(), &Opening::default()).expect("a log");
    let faults = columns(log, &["t", "q_a", "f_toe_z"]).unwrap_err();
    assert!(matches!(&faults[..], [FileFault::Pause { longest_s, .. }] if *longest_s > 0.29));
    // without the topic there is no fault
    let table = read(&two_topics(170.0, [0.8, 1.1]).plain(), &["t", "q_a"]);
    assert_eq!((table.rows(), table.remarks.len()), (1000, 0));
    let log = opened(&two_topics(170.0, [0.0, 1.94]).plain(), &Opening::default()).expect("a log");
    let faults = columns(log, &["t", "q_a", "f_toe_z"]).unwrap_err();
    assert!(matches!(&faults[..], [FileFault::Apart { .. }]), "{faults:?}");
}

#[test]
fn times_of_recording_stand_in_for_all() {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    for row in 0..10_u64 {
        file.message(joints, 5_000_000 * row, &joint_state(0, &["a"], [&[1.0], &[], &[]]));
    }
    let table = read(&file.plain(), &["t", "q_a"]);
    assert_eq!(table.columns[0][3], 0.015);
    assert!(matches!(&table.remarks[..], [FileRemark::RecordingTimes { .. }]));
}

/// Joints in another order are the same; joints of another publisher are a clock of their own.
#[test]
fn names_count_and_not_their_order() {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    for row in 1..=20_u64 {
        let time = row * 1_000_000;
        let data = match row % 2 {
            0 => joint_state(time, &["a", "b"], [&[1.0, 2.0], &[], &[]]),
            _ => joint_state(time, &["b", "a"], [&[2.0, 1.0], &[], &[]]),
        };
        file.message(joints, time, &data);
        file.message(joints, time, &joint_state(time, &["grip-per"], [&[5.0], &[], &[f64::NAN]]));
    }
    let bytes = file.plain();
    let table = read(&bytes, &["t", "q_a", "q_b", "q_grip_per"]);
    assert_eq!(table.columns[1..], [vec![1.0; 20], vec![2.0; 20], vec![5.0; 20]]);
    let log = opened(&bytes, &Opening::default()).expect("a log");
    // nobody says anything of this effort
    assert_eq!(log.find("tau_grip_per"), Found::Nowhere);
}

/// Two topics with one signal: neither is taken.
#[test]
fn two_topics_with_one_signal_are_told_apart_by_names_alone() {
    let mut file = Mcap::default();
    for topic in ["/joint_states", "/other/joint_states"] {
        let joints = file.joints(topic);
        (1..=4_u64).for_each(|row| {
            file.message(joints, row, &joint_state(row, &["a"], [&[1.0], &[], &[]]));
        });
    }
    let log = opened(&file.plain(), &Opening::default()).expect("a log");
    let Found::Several(names) = log.find("q_a") else { panic!("{:?}", log.columns) };
    assert_eq!(names, ["/joint_states/a/position", "/other/joint_states/a/position"]);
    assert!(matches!(log.find("/joint_states/a/position"), Found::At(_)));
}
