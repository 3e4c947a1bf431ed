//! Files that are cut or corrupt: what is whole is offered, and nothing panics.

use crate::made::{Mcap, chunk, columns, joint_state, opened};
use denavit_logs::{FileFault, FileRemark, Opening, Place};

const ROWS: u64 = 60;

fn message(file: &mut Mcap, joints: u16, row: u64) {
    let value = row as f64;
    let data = joint_state(1 + row, &["hip", "knee"], [&[value, 1.0], &[], &[value, value]]);
    file.message(joints, row, &data);
}

fn made() -> Mcap {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    (0..ROWS).for_each(|row| message(&mut file, joints, row));
    file
}

/// Rows that are read with and without damage being accepted.
fn rows(bytes: &[u8], accepts_cut: bool) -> Result<usize, Vec<FileFault>> {
    let how = Opening { accepts_cut, ..Opening::default() };
    let table = columns(opened(bytes, &how)?, &["t", "q_hip", "tau_knee"])?;
    Ok(table.rows())
}

#[test]
fn a_cut_file_offers_its_whole_messages() {
    let bytes = made().plain();
    assert_eq!(rows(&bytes, false), Ok(ROWS as usize));
    let mut offered = Vec::new();
    for end in (0..bytes.len() - 40).step_by(97) {
        let cut = &bytes[..end];
        let Err(faults) = rows(cut, false) else { panic!("cut at {end} and taken as whole") };
        let [FileFault::Damaged { at: Place::Message(at), whole, .. }] = faults[..] else {
            continue;
        };
        assert_eq!(at, whole + 1);
        if whole >= 4 {
            assert_eq!(rows(cut, true), Ok(whole));
            offered.push(whole);
        }
    }
    assert!(offered.is_sorted() && offered.len() > 50, "{offered:?}");
    let how = Opening { accepts_cut: true, ..Opening::default() };
    let log = opened(&bytes[..bytes.len() / 2], &how).expect("a part");
    let table = columns(log, &["t", "q_hip"]).expect("rows");
    assert!(matches!(&table.remarks[..], [FileRemark::Damaged { .. }]), "{:?}", table.remarks);
}

#[test]
fn a_corrupt_chunk_offers_those_before() {
    let mut file = made();
    let first = chunk(&[&file.described[..], &file.messages].concat(), "", <[u8]>::to_vec);
    file.messages.clear();
    (ROWS..2 * ROWS).for_each(|row| message(&mut file, 1, row));
    let mut second = chunk(&file.messages, "", <[u8]>::to_vec);
    let whole = Mcap::around(&[&first[..], &second].concat());
    assert_eq!(rows(&whole, false), Ok(2 * ROWS as usize));
    let middle = second.len() / 2;
    second[middle] ^= 4;
    let bytes = Mcap::around(&[&first[..], &second].concat());
    let faults = rows(&bytes, false).unwrap_err();
    let text = faults[0].to_string();
    assert!(text.contains("corrupt") && text.contains("60 messages before"), "{text}");
    assert_eq!(rows(&bytes, true), Ok(ROWS as usize));
}

/// Numbers that look random, the same each time.
struct Sequence(u64);

impl Sequence {
    fn below(&mut self, limit: usize) -> usize {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % limit.max(1)
    }
}

/// Changes bytes, takes some out, puts some in again elsewhere, cuts.
fn mutated(bytes: &[u8], sequence: &mut Sequence) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=sequence.below(4) {
        let (at, length) = (sequence.below(bytes.len()), 1 + sequence.below(16));
        let end = (at + length).min(bytes.len());
        match sequence.below(6) {
            0 => bytes[at] = sequence.below(256) as u8,
            1 => bytes[at] ^= 1 << sequence.below(8),
            2 => drop(bytes.drain(at..end)),
            3 => {
                let part = bytes[at..end].to_vec();
                let to = sequence.below(bytes.len());
                bytes.splice(to..to, part);
            }
            4 => bytes[at..end].fill([0, 0x7f, 0xff][sequence.below(3)]),
            _ => bytes.truncate(at.max(8)),
        }
    }
    bytes
}

fn try_mutations(count: usize) {
    let file = made();
    let lz4 = |bytes: &[u8]| {
        use std::io::Write;
        let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
        encoder.write_all(bytes).expect("packed");
        encoder.finish().expect("packed")
    };
    let zstd = |bytes: &[u8]| {
        ruzstd::encoding::compress_to_vec(bytes, ruzstd::encoding::CompressionLevel::Fastest)
    };
    let plain = file.plain();
    let packed =
        [file.chunked("", <[u8]>::to_vec), file.chunked("zstd", zstd), file.chunked("lz4", lz4)];
    let mut sequence = Sequence(29);
    let mut outcomes = [0; 2];
    for round in 0..count {
        // chunks have sums, so that most of their mutations end at once
        let bytes = if round % 3 == 0 { &packed[round / 3 % 3] } else { &plain };
        let bytes = mutated(bytes, &mut sequence);
        for accepts_cut in [false, true] {
            let how = Opening { accepts_cut, ..Opening::default() };
            match opened(&bytes, &how) {
                Ok(log) => {
                    let places: Vec<usize> = (0..log.columns.len()).collect();
                    let clock = [1];
                    if let Err(faults) = log.read(&places, &clock) {
                        assert!(faults.faults().iter().all(|fault| !fault.to_string().is_empty()));
                    }
                    outcomes[0] += 1;
                }
                Err(faults) => {
                    assert!(!faults.is_empty());
                    assert!(faults.iter().all(|fault| !fault.to_string().is_empty()));
                    outcomes[1] += 1;
                }
            }
        }
    }
    assert!(outcomes.iter().all(|count| *count > 0), "{outcomes:?}");
}

#[test]
fn mutations_are_read_or_refused() {
    try_mutations(400);
}

#[test]
#[ignore = "5000 mutations take longer than the suite may"]
fn many_mutations_of_mcap_are_read_or_refused() {
    try_mutations(5000);
}
