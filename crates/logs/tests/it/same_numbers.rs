//! The same numbers whatever the format.

use crate::made::{Mcap, columns, joint_state, opened, read};
use denavit_logs::{McapRows, Opening, open_csv, write_mcap};
use lz4_flex::frame::FrameEncoder;
use std::fmt::Write as _;
use std::io::Write as _;

const NAMES: [&str; 15] = [
    "t",
    "q_hip",
    "q_knee",
    "qd_hip",
    "qd_knee",
    "qdd_hip",
    "tau_hip",
    "tau_knee",
    "ref_hip",
    "tau_cmd_hip",
    "motor_knee",
    "tau_cmd_knee",
    "f_toe_x",
    "f_toe_z",
    "energy",
];

fn values(rows: usize) -> Vec<f64> {
    let value = |row: usize, column: usize| match column {
        0 => 0.001 * row as f64,
        // contacts have no force where there is none
        12 | 13 if row.is_multiple_of(3) => f64::NAN,
        _ => (0.37 * (row * 15 + column) as f64).sin() / 3.0,
    };
    (0..rows).flat_map(|row| (0..15).map(move |column| value(row, column))).collect()
}

fn csv(values: &[f64]) -> String {
    let mut text = format!("# model: leg\n# scheme: event\n{}\n", NAMES.join(","));
    for row in values.chunks(15) {
        let cells = row.iter().map(|value| match value.is_nan() {
            true => String::new(),
            false => value.to_string(),
        });
        let _ = writeln!(text, "{}", cells.collect::<Vec<_>>().join(","));
    }
    text
}

fn mcap(values: &[f64]) -> Vec<u8> {
    let header = [("model", "leg"), ("scheme", "event")];
    let header = header.map(|(name, value)| (name.to_owned(), value.to_owned()));
    let columns = NAMES.map(str::to_owned);
    write_mcap(&McapRows { header: &header, columns: &columns, values }).expect("written")
}

/// Bits of a column; what is undefined is one of them.
fn bits(column: &[f64]) -> Vec<u64> {
    column.iter().map(|value| if value.is_nan() { u64::MAX } else { value.to_bits() }).collect()
}

#[test]
fn a_run_has_the_same_numbers_as_csv_and_as_mcap() {
    let values = values(500);
    let text = csv(&values);
    let wanted = &NAMES[..14];
    let from_csv = open_csv(text.as_bytes()).expect("a log");
    let bytes = mcap(&values);
    let from_mcap = opened(&bytes, &Opening::default()).expect("a log");
    assert_eq!(from_csv.header, from_mcap.header);
    let from_csv = columns(from_csv, wanted).expect("rows");
    let from_mcap = columns(from_mcap, wanted).expect("rows");
    // times of messages are whole nanoseconds
    let times = from_csv.columns[0].iter().zip(&from_mcap.columns[0]);
    assert!(times.clone().all(|(one, other)| (one - other).abs() < 1e-15 + 1e-15 * one));
    for (at, name) in wanted.iter().enumerate().skip(1) {
        assert!(bits(&from_csv.columns[at]) == bits(&from_mcap.columns[at]), "{name}");
    }
    assert!(from_mcap.remarks.is_empty(), "{:?}", from_mcap.remarks);
    assert_eq!(bytes, mcap(&values), "the same run gives the same bytes");
    // what is no signal of a joint is there where it is asked for
    let how = Opening { named: vec!["/run/energy/data".to_owned()], ..Opening::default() };
    let log = opened(&bytes, &how).expect("a log");
    let energy = columns(log, &["t", "/run/energy/data"]).expect("rows");
    let expected: Vec<f64> = values.chunks(15).map(|row| row[14]).collect();
    assert_eq!(energy.columns[1], expected);
}

#[test]
fn packed_chunks_have_the_same_numbers() {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    for row in 0..2000_u64 {
        let value = 0.01 * row as f64;
        let data = joint_state(1 + row * 1_000_000, &["a"], [&[value], &[], &[value * value]]);
        file.message(joints, row, &data);
    }
    let plain = read(&file.plain(), &["t", "q_a", "tau_a"]);
    assert_eq!(plain.rows(), 2000);
    let zstd = |bytes: &[u8]| {
        ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest)
    };
    let lz4 = |bytes: &[u8]| {
        let mut encoder = FrameEncoder::new(Vec::new());
        encoder.write_all(bytes).expect("packed");
        encoder.finish().expect("packed")
    };
    for (name, bytes) in [
        ("", file.chunked("", <[u8]>::to_vec)),
        ("zstd", file.chunked("zstd", zstd)),
        ("lz4", file.chunked("lz4", lz4)),
    ] {
        assert_eq!(read(&bytes, &["t", "q_a", "tau_a"]), plain, "{name}");
    }
    let faults = opened(&file.chunked("bz2", <[u8]>::to_vec), &Opening::default()).unwrap_err();
    assert!(faults[0].to_string().contains("bz2"), "{faults:?}");
}
