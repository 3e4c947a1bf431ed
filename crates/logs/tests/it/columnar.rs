//! Parquet and Arrow.

use crate::made::{columns, opened};
use arrow_array::types::{Float32Type, TimestampNanosecondType};
use arrow_array::{ArrayRef, Float64Array, Int32Array, PrimitiveArray, RecordBatch, StringArray};
use arrow_ipc::writer::{FileWriter, StreamWriter};
use arrow_schema::{DataType, Field, Schema, TimeUnit};
use denavit_logs::{FileFault, Opening, open_csv};
use parquet::arrow::ArrowWriter;
use parquet::basic::{Compression, ZstdLevel};
use parquet::file::properties::WriterProperties;
use std::collections::HashMap;
use std::fmt::Write as _;
use std::sync::Arc;

const ROWS: usize = 3000;
const START_NS: i64 = 1_700_000_000_000_000_000;

fn batch() -> RecordBatch {
    let fields = [
        ("time", DataType::Timestamp(TimeUnit::Nanosecond, None)),
        ("t", DataType::Float64),
        ("note", DataType::Utf8),
        ("q_a", DataType::Float64),
        ("tau_a", DataType::Float32),
        ("count", DataType::Int32),
    ];
    let fields: Vec<Field> =
        fields.into_iter().map(|(name, kind)| Field::new(name, kind, true)).collect();
    let metadata = HashMap::from([("model".to_owned(), "leg".to_owned())]);
    let schema = Schema::new(fields).with_metadata(metadata);
    let value = |row: usize| (0.01 * row as f64).sin() / 3.0;
    let stamps = (0..ROWS as i64).map(|row| START_NS + row * 1_000_000);
    let all: Vec<ArrayRef> = vec![
        Arc::new(PrimitiveArray::<TimestampNanosecondType>::from_iter_values(stamps)),
        Arc::new(Float64Array::from_iter_values((0..ROWS).map(|row| row as f64 / 1000.0))),
        Arc::new(StringArray::from_iter_values((0..ROWS).map(|_| "x"))),
        Arc::new((0..ROWS).map(|row| (row != 7).then(|| value(row))).collect::<Float64Array>()),
        Arc::new(PrimitiveArray::<Float32Type>::from_iter_values((0..ROWS).map(|r| r as f32))),
        Arc::new(Int32Array::from_iter_values((0..ROWS).map(|row| row as i32))),
    ];
    RecordBatch::try_new(Arc::new(schema), all).expect("a batch")
}

fn parquet(compression: Compression) -> Vec<u8> {
    let batch = batch();
    let properties = WriterProperties::builder()
        .set_compression(compression)
        .set_max_row_group_row_count(Some(700))
        .build();
    let mut bytes = Vec::new();
    let mut writer =
        ArrowWriter::try_new(&mut bytes, batch.schema(), Some(properties)).expect("a writer");
    writer.write(&batch).expect("written");
    writer.append_key_value_metadata(parquet::file::metadata::KeyValue::new(
        "model".to_owned(),
        "leg".to_owned(),
    ));
    writer.close().expect("closed");
    bytes
}

fn arrow(is_stream: bool) -> Vec<u8> {
    let batch = batch();
    let mut bytes = Vec::new();
    if is_stream {
        let mut writer = StreamWriter::try_new(&mut bytes, &batch.schema()).expect("a writer");
        writer.write(&batch).expect("written");
        writer.finish().expect("finished");
    } else {
        let mut writer = FileWriter::try_new(&mut bytes, &batch.schema()).expect("a writer");
        writer.write(&batch).expect("written");
        writer.finish().expect("finished");
    }
    bytes
}

fn all() -> [(&'static str, Vec<u8>); 5] {
    let zstd = Compression::ZSTD(ZstdLevel::default());
    [
        ("plain", parquet(Compression::UNCOMPRESSED)),
        ("snappy", parquet(Compression::SNAPPY)),
        ("zstd", parquet(zstd)),
        ("file", arrow(false)),
        ("stream", arrow(true)),
    ]
}

#[test]
fn tables_have_the_numbers_of_csv() {
    let mut text = "# model: leg\nt,q_a,tau_a\n".to_owned();
    for row in 0..ROWS {
        let value = (0.01 * row as f64).sin() / 3.0;
        let cell = if row == 7 { String::new() } else { value.to_string() };
        let _ = writeln!(text, "{},{cell},{row}", row as f64 / 1000.0);
    }
    let csv = open_csv(text.as_bytes()).expect("a log");
    let header = csv.header.clone();
    let csv = columns(csv, &["t", "q_a", "tau_a"]).expect("rows");
    let bits = |columns: &[Vec<f64>]| -> Vec<u64> {
        let bits = |value: &f64| if value.is_nan() { u64::MAX } else { value.to_bits() };
        columns.iter().flatten().map(bits).collect()
    };
    for (name, bytes) in all() {
        let log = opened(&bytes, &Opening::default()).expect("a log");
        assert_eq!(log.header, header, "{name}");
        let table = columns(log, &["t", "q_a", "tau_a"]).expect("rows");
        assert!(bits(&table.columns) == bits(&csv.columns), "{name}");
        // in another order, and a time that is one
        let log = opened(&bytes, &Opening::default()).expect("a log");
        let table = columns(log, &["count", "time", "q_a", "time"]).expect("rows");
        assert_eq!((table.columns[0][5], table.columns[1][5]), (5.0, 0.005), "{name}");
        assert_eq!(table.columns[1], table.columns[3]);
    }
}

#[test]
fn columns_without_numbers_are_refused_where_they_are_wanted() {
    for (name, bytes) in all() {
        let log = opened(&bytes, &Opening::default()).expect("a log");
        let faults = columns(log, &["t", "note"]).unwrap_err();
        assert!(matches!(&faults[..], [FileFault::NoNumbers { .. }]), "{name}: {faults:?}");
    }
}

/// Whatever is cut off or changed, there is an answer.
#[test]
fn damaged_tables_are_read_or_refused() {
    let mut seed = 7_u64;
    let mut next = |limit: usize| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as usize % limit.max(1)
    };
    let (mut right, mut wrong) = (0, 0);
    for (_, bytes) in all() {
        for round in 0..80 {
            let mut bytes = bytes.clone();
            if round % 4 == 0 {
                bytes.truncate(8 + next(bytes.len() - 8));
            }
            for _ in 0..=next(3) {
                // the ends have the structure
                let near = next(bytes.len().min(2000));
                let at = if round % 2 == 0 { bytes.len() - 1 - near } else { next(bytes.len()) };
                let at = at.max(8).min(bytes.len() - 1);
                bytes[at] = next(256) as u8;
            }
            let read = opened(&bytes, &Opening::default()).and_then(|log| {
                let places: Vec<usize> =
                    (0..log.columns.len()).filter(|at| log.columns[*at].name != "note").collect();
                log.read(&places, &[]).map_err(denavit_logs::Error::into_faults)
            });
            match read {
                Ok(_) => right += 1,
                Err(faults) => {
                    assert!(faults.iter().all(|fault| !fault.to_string().is_empty()));
                    wrong += 1;
                }
            }
        }
    }
    assert!(right > 0 && wrong > 0, "{right} {wrong}");
}
