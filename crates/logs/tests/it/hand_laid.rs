//! Bytes laid by hand are read as the numbers that they hold.

use crate::made::{Cdr, Mcap, columns, joint_state, opened, read};
use denavit_logs::{FileFault, FileRemark, Opening};

/// The bytes of a message written out, as the rules have them: the time, an empty text with its
/// end, names, then numbers at multiples of eight bytes after the four that say the order of bytes.
#[test]
fn a_message_is_read_from_its_bytes() {
    #[rustfmt::skip]
    let data = [
        0, 1, 0, 0,                      // the lowest byte first
        2, 0, 0, 0, 0, 0x65, 0xcd, 0x1d, // 2 s and 500000000 ns
        1, 0, 0, 0, 0, 0, 0, 0,          // an empty text, filled up to four
        2, 0, 0, 0,                      // two names
        2, 0, 0, 0, b'a', 0, 0, 0,
        2, 0, 0, 0, b'b', 0, 0, 0,
        2, 0, 0, 0,                      // two positions, at 40
        0, 0, 0, 0, 0, 0, 0xf8, 0x3f,    // 1.5
        0, 0, 0, 0, 0, 0, 0, 0xc0,       // -2
        0, 0, 0, 0,                      // no velocities
        1, 0, 0, 0,                      // one effort, of two joints: refused below
    ];
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    let whole = [&data[..data.len() - 4], &[0; 4]].concat();
    assert_eq!(whole, joint_state(2_500_000_000, &["a", "b"], [&[1.5, -2.0], &[], &[]]));
    (0..4).for_each(|_| file.message(joints, 7, &whole));
    let table = read(&file.plain(), &["t", "q_a", "q_b"]);
    assert_eq!(table.columns, [vec![2.5; 4], vec![1.5; 4], vec![-2.0; 4]]);
    let wrong = [&data[..], &1.0_f64.to_le_bytes()].concat();
    file.message(joints, 8, &wrong);
    let faults = opened(&file.plain(), &Opening::default()).unwrap_err();
    let text = faults[0].to_string();
    assert!(text.contains("1 numbers in `effort`, and 2 joints"), "{text}");
    assert!(text.contains("4 messages before are whole: `logs.accepts_cut`"), "{text}");
}

#[test]
fn the_highest_byte_may_come_first() {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    for row in 1..=4 {
        let value = f64::from(row);
        let data = Cdr::new(true).header(row as u64 * 1_000_000).names(&["a", "long name"]);
        let data = data.numbers(&[value, -value]).numbers(&[]).numbers(&[0.5 * value, 7.0]).bytes();
        file.message(joints, 0, &data);
    }
    let table = read(&file.plain(), &["t", "q_a", "q_long_name", "tau_a"]);
    assert_eq!(table.columns[0], [0.001, 0.002, 0.003, 0.004]);
    assert_eq!(table.columns[2], [-1.0, -2.0, -3.0, -4.0]);
    assert_eq!(table.columns[3], [0.5, 1.0, 1.5, 2.0]);
}

/// Old and new names of what a controller says, by the definition that the file has.
#[test]
fn states_of_controllers_are_read_by_their_definition() {
    let point = "trajectory_msgs/JointTrajectoryPoint";
    let definition = |fields: &[&str]| {
        let fields: String = fields.iter().map(|name| format!("{point} {name}\n")).collect();
        format!(
            "std_msgs/Header header\nstring[] joint_names\n{fields}float64 speed\n\
             ===\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
             ===\nMSG: {point}\nfloat64[] positions\nfloat64[] velocities\n\
             float64[] accelerations\nfloat64[] effort\nbuiltin_interfaces/Duration \
             time_from_start\n"
        )
    };
    let kind = "control_msgs/msg/JointTrajectoryControllerState";
    let points = |cdr: Cdr, values: &[[f64; 2]]| {
        values.iter().fold(cdr, |cdr, [position, effort]| {
            cdr.numbers(&[*position]).numbers(&[]).numbers(&[]).numbers(&[*effort]).word(0).word(0)
        })
    };
    for (fields, names) in [
        (&["reference", "feedback", "error", "output"][..], &["ref_a", "q_a", "tau_cmd_a"][..]),
        (&["desired", "actual", "error"][..], &["ref_a", "q_a"][..]),
    ] {
        let mut file = Mcap::default();
        let topic = file.topic("/arm/state", kind, &definition(fields));
        for row in 1..=4_u64 {
            let start = Cdr::new(false).header(row * 1000).names(&["a"]);
            let all = [[1.0, 2.0], [3.0, 4.0], [5.0, 6.0], [7.0, 8.0]];
            file.message(topic, 0, &points(start, &all[..fields.len()]).number(0.25).bytes());
        }
        let names: Vec<&str> = ["t"].iter().chain(names).copied().collect();
        let table = read(&file.plain(), &names);
        let found: Vec<f64> = table.columns[1..].iter().map(|column| column[2]).collect();
        assert_eq!(found, [1.0, 3.0, 8.0][..names.len() - 1]);
        let log = opened(&file.plain(), &Opening::default()).expect("a log");
        let speed = columns(log, &["t", "/arm/state/speed"]).expect("rows");
        assert_eq!(speed.columns[1], [0.25; 4]);
    }
}

/// Without a definition in the file the usual one that the bytes fit is taken, and reported.
#[test]
fn usual_definitions_stand_in() {
    let mut file = Mcap::default();
    let kind = "sensor_msgs/msg/JointState";
    let topic = file.topic_as("/joint_states", kind, "", "", "cdr");
    for row in 1..=4_u64 {
        file.message(topic, 0, &joint_state(row * 1000, &["a"], [&[1.0], &[], &[]]));
    }
    let table = read(&file.plain(), &["t", "q_a"]);
    assert!(matches!(&table.remarks[..], [FileRemark::OwnDefinition { .. }]), "{table:?}");
}

#[test]
fn what_is_no_joint_state_in_cdr_is_named() {
    let mut file = Mcap::default();
    file.topic("/image", "sensor_msgs/msg/Image", "uint8[] data\n");
    file.topic_as("/joint_states", "sensor_msgs/JointState", "ros1msg", "x", "ros1");
    let faults = opened(&file.plain(), &Opening::default()).unwrap_err();
    assert!(matches!(&faults[..], [FileFault::NoMessages { topics }] if topics.len() == 2));
    let text = faults[0].to_string();
    assert!(text.contains("/image (sensor_msgs/msg/Image)"), "{text}");
    assert!(text.contains("written as `ros1`"), "{text}");
}
