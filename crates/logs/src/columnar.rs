//! Parquet and Arrow: tables of columns, of which only those that are wanted are read.

use super::fault::{FileFault, of_io};
use super::source::{self, Column, Log, Rows};
use super::table::{Places, Table};
use arrow_array::cast::AsArray;
use arrow_array::types::{
    ArrowPrimitiveType, Float32Type, Float64Type, Int8Type, Int16Type, Int32Type, Int64Type,
    TimestampMicrosecondType, TimestampMillisecondType, TimestampNanosecondType,
    TimestampSecondType, UInt8Type, UInt16Type, UInt32Type, UInt64Type,
};
use arrow_array::{Array, RecordBatch};
use arrow_ipc::reader::{FileReader, StreamReader};
use arrow_schema::{ArrowError, DataType, Schema, TimeUnit};
use parquet::arrow::ProjectionMask;
use parquet::arrow::arrow_reader::ParquetRecordBatchReaderBuilder;
use parquet::file::metadata::ParquetMetaData;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Batches, one after the other.
type Batches = Box<dyn Iterator<Item = Result<RecordBatch, ArrowError>>>;

/// Opens the batches with the columns of these places, in the order of the file.
type Open = Box<dyn FnOnce(&[usize]) -> Result<Batches, String>>;

struct Columnar {
    schema: Schema,
    open: Open,
}

fn unreadable(why: impl std::fmt::Display) -> Vec<FileFault> {
    vec![FileFault::Unreadable(why.to_string())]
}

/// Runs what reads a file. The libraries assert that its parts fit each other: where they do not,
/// one in some thousand corrupt files ends in a panic of theirs, which is a fault of the file.
fn guarded<T>(read: impl FnOnce() -> Result<T, Vec<FileFault>>) -> Result<T, Vec<FileFault>> {
    catch_unwind(AssertUnwindSafe(read))
        .unwrap_or_else(|_| Err(unreadable("its parts do not fit each other")))
}

/// Opens a Parquet file.
pub(crate) fn open_parquet(source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    guarded(|| parquet_log(source))
}

/// Opens an Arrow file, of the kind with a footer or as a stream.
pub(crate) fn open_arrow(source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    guarded(|| arrow_log(source))
}

fn parquet_log(source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    let file = source.into_inner();
    let length = file.metadata().map_err(|error| vec![of_io(&error)])?.len();
    let builder = ParquetRecordBatchReaderBuilder::try_new(file).map_err(unreadable)?;
    check_places(builder.metadata(), length)?;
    let schema = (**builder.schema()).clone();
    let metadata = builder.metadata().file_metadata().key_value_metadata().cloned();
    let header = metadata.unwrap_or_default().into_iter().filter_map(|one| {
        // the schema in a form of its own
        let value = one.value.filter(|_| !one.key.starts_with("ARROW:"))?;
        Some((one.key, value))
    });
    let header: Vec<(String, String)> = header.collect();
    let open = move |places: &[usize]| {
        let mask = ProjectionMask::roots(builder.parquet_schema(), places.iter().copied());
        let reader = builder.with_projection(mask).build().map_err(|error| error.to_string())?;
        Ok(Box::new(reader) as Batches)
    };
    log(header, schema, Box::new(open))
}

/// Sees to it that parts of a file are where it says: the reader takes that for granted.
fn check_places(metadata: &ParquetMetaData, length: u64) -> Result<(), Vec<FileFault>> {
    for (at, group) in metadata.row_groups().iter().enumerate() {
        let wrong = || unreadable(format!("row group {} is not where the file says", at + 1));
        let is_row_count = |count: i64| (0..=i64::from(u32::MAX) << 8).contains(&count);
        if !is_row_count(group.num_rows()) {
            return Err(wrong());
        }
        for column in group.columns() {
            let start = column.dictionary_page_offset().unwrap_or(column.data_page_offset());
            let place = |value: i64| u64::try_from(value).ok();
            let end = place(start).zip(place(column.compressed_size()));
            let end = end.and_then(|(start, size)| start.checked_add(size));
            let is_sound = end.is_some_and(|end| end <= length)
                && column.data_page_offset() >= 0
                && column.uncompressed_size() >= 0
                && is_row_count(column.num_values());
            if !is_sound {
                return Err(wrong());
            }
        }
    }
    Ok(())
}

fn arrow_log(mut source: BufReader<File>) -> Result<Log<'static>, Vec<FileFault>> {
    let first = source.fill_buf().map_err(|error| vec![of_io(&error)])?;
    let (schema, batches): (Schema, Batches) = match first.starts_with(b"ARROW1") {
        true => {
            let reader = FileReader::try_new(source, None).map_err(unreadable)?;
            ((*reader.schema()).clone(), Box::new(reader))
        }
        false => {
            let reader = StreamReader::try_new(source, None).map_err(unreadable)?;
            ((*reader.schema()).clone(), Box::new(reader))
        }
    };
    let open = move |places: &[usize]| {
        let places = places.to_vec();
        let of = move |batch: Result<RecordBatch, ArrowError>| batch?.project(&places);
        Ok(Box::new(batches.map(of)) as Batches)
    };
    let header: Vec<(String, String)> = schema.metadata().clone().into_iter().collect();
    log(header, schema, Box::new(open))
}

/// A log of a schema.
fn log(
    mut header: Vec<(String, String)>,
    schema: Schema,
    open: Open,
) -> Result<Log<'static>, Vec<FileFault>> {
    // maps have no order
    header.sort();
    let mut columns: Vec<Column> = Vec::new();
    let mut faults = Vec::new();
    for field in schema.fields() {
        let name = field.name().clone();
        if columns.iter().any(|known| known.name == name) {
            faults.push(FileFault::RepeatedColumn { column: name.clone() });
        }
        columns.push(Column { name, known: None });
    }
    match faults.is_empty() {
        true => Ok(Log { header, columns, rows: Box::new(Columnar { schema, open }) }),
        false => Err(faults),
    }
}

impl Columnar {
    /// The columns of places that are used, in the order of the file, each once, and what reads
    /// them.
    fn used(self, places: &[usize]) -> Result<(Vec<usize>, Open), Vec<FileFault>> {
        let Self { schema, open } = self;
        let mut used = places.to_vec();
        used.sort_unstable();
        used.dedup();
        let kind = |place: &usize| schema.field(*place).data_type();
        let no_numbers = used.iter().filter(|place| !is_number(kind(place))).map(|place| {
            let column = schema.field(*place).name().clone();
            FileFault::NoNumbers { column, kind: kind(place).to_string() }
        });
        let faults: Vec<FileFault> = no_numbers.collect();
        if faults.is_empty() { Ok((used, open)) } else { Err(faults) }
    }
}

/// Columns that were read once each, as they were asked for.
fn table(read: &[Reading], used: &[usize], places: &[usize]) -> Table {
    let of = |place: &usize| read[used.partition_point(|one| one < place)].values.clone();
    let columns = places.iter().map(of).collect();
    Table { columns, places: Places::Rows, ..Table::default() }
}

impl Rows for Columnar {
    fn read(self: Box<Self>, places: &[usize], _: &[usize]) -> Result<Table, Vec<FileFault>> {
        let (used, open) = self.used(places)?;
        let read = guarded(|| all_batches(open, &used))?;
        Ok(table(&read, &used, places))
    }

    fn batches<'a>(self: Box<Self>, places: &[usize]) -> Result<source::Tables<'a>, Vec<FileFault>>
    where
        Self: 'a,
    {
        let places = places.to_vec();
        let (used, open) = self.used(&places)?;
        let mut batches = guarded(|| open(&used).map_err(unreadable))?;
        let mut read = vec![Reading::default(); used.len()];
        let mut row = 0;
        Ok(Box::new(std::iter::from_fn(move || {
            let next = guarded(|| Ok(batches.next()));
            let batch = match next {
                Ok(batch) => batch?,
                Err(faults) => return Some(Err(faults)),
            };
            Some(batch.map_err(|error| of_row(row, &error)).map(|batch| {
                row += batch.num_rows();
                for (reading, column) in read.iter_mut().zip(batch.columns()) {
                    reading.values.clear();
                    reading.push(column.as_ref());
                }
                table(&read, &used, &places)
            }))
        })))
    }
}

/// What is wrong behind so many rows.
fn of_row(rows: usize, error: &ArrowError) -> Vec<FileFault> {
    unreadable(format!("from row {} on: {error}", rows + 1))
}

/// The columns of these places, batch after batch.
fn all_batches(open: Open, places: &[usize]) -> Result<Vec<Reading>, Vec<FileFault>> {
    let mut read = vec![Reading::default(); places.len()];
    for batch in open(places).map_err(unreadable)? {
        let rows = read.first().map_or(0, |column| column.values.len());
        let batch = batch.map_err(|error| of_row(rows, &error))?;
        for (reading, column) in read.iter_mut().zip(batch.columns()) {
            reading.push(column.as_ref());
        }
    }
    Ok(read)
}

/// Whether values of a kind are numbers here.
fn is_number(kind: &DataType) -> bool {
    kind.is_floating() && *kind != DataType::Float16
        || kind.is_integer()
        || matches!(kind, DataType::Timestamp(..))
}

/// Times from which on a clock counts from long ago \[ns\]: they are told from the first one on.
const EPOCH_NS: i128 = 1_000_000_000_000_000;

/// A column as far as it is read.
#[derive(Clone, Debug, Default)]
struct Reading {
    values: Vec<f64>,
    /// The first time \[ns\], of a column of times.
    first_ns: Option<i128>,
}

impl Reading {
    /// Appends the values of an array; what is null is undefined.
    fn push(&mut self, array: &dyn Array) {
        match array.data_type() {
            DataType::Float64 => self.all::<Float64Type>(array, |value| value),
            DataType::Float32 => self.all::<Float32Type>(array, f64::from),
            DataType::Int8 => self.all::<Int8Type>(array, f64::from),
            DataType::Int16 => self.all::<Int16Type>(array, f64::from),
            DataType::Int32 => self.all::<Int32Type>(array, f64::from),
            DataType::Int64 => self.all::<Int64Type>(array, |value| value as f64),
            DataType::UInt8 => self.all::<UInt8Type>(array, f64::from),
            DataType::UInt16 => self.all::<UInt16Type>(array, f64::from),
            DataType::UInt32 => self.all::<UInt32Type>(array, f64::from),
            DataType::UInt64 => self.all::<UInt64Type>(array, |value| value as f64),
            DataType::Timestamp(TimeUnit::Second, _) => {
                self.times::<TimestampSecondType>(array, 1_000_000_000);
            }
            DataType::Timestamp(TimeUnit::Millisecond, _) => {
                self.times::<TimestampMillisecondType>(array, 1_000_000);
            }
            DataType::Timestamp(TimeUnit::Microsecond, _) => {
                self.times::<TimestampMicrosecondType>(array, 1000);
            }
            DataType::Timestamp(TimeUnit::Nanosecond, _) => {
                self.times::<TimestampNanosecondType>(array, 1);
            }
            _ => self.values.extend(std::iter::repeat_n(f64::NAN, array.len())),
        }
    }

    fn all<T: ArrowPrimitiveType>(&mut self, array: &dyn Array, of: impl Fn(T::Native) -> f64) {
        let values = array.as_primitive::<T>().iter();
        self.values.extend(values.map(|value| value.map_or(f64::NAN, &of)));
    }

    /// Times as seconds.
    fn times<T: ArrowPrimitiveType<Native = i64>>(&mut self, array: &dyn Array, unit_ns: i128) {
        for value in array.as_primitive::<T>() {
            let Some(time) = value.map(|value| i128::from(value) * unit_ns) else {
                self.values.push(f64::NAN);
                continue;
            };
            let first = *self.first_ns.get_or_insert(time);
            let start = if first.abs() >= EPOCH_NS { first } else { 0 };
            self.values.push((time - start) as f64 / 1e9);
        }
    }
}
