//! How samples are in memory, for the code that reads and writes them.

use super::machine::Line;
use denavit_codegen::program::{OutputShape, Routine};

/// How samples are in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    /// A column for each number of a sample.
    Columns,
    /// The numbers of a sample side by side: of each argument, and of each output.
    Rows {
        /// Numbers of a sample, by argument.
        arguments: Vec<usize>,
        /// Numbers of a sample, by output.
        outputs: Vec<usize>,
    },
}

impl Layout {
    /// The rows of a routine.
    pub(crate) fn rows(routine: &Routine) -> Self {
        Self::Rows {
            arguments: routine.arguments.iter().map(|argument| argument.len).collect(),
            outputs: routine.outputs.iter().map(OutputShape::len).collect(),
        }
    }
}

/// A number of a sample in rows.
#[derive(Clone, Copy, Debug)]
pub(super) struct Entry {
    /// The array, by its address in the list.
    pub(super) array: u32,
    /// Bytes before the number in a row.
    pub(super) offset: i64,
    /// Bytes of a row.
    pub(super) stride: i64,
    /// The line of the table with the distances of the samples of a block, in numbers.
    pub(super) distances: u32,
}

/// Rows as code needs them; empty for columns.
#[derive(Debug, Default)]
pub(super) struct Memory {
    pub(super) is_rows: bool,
    /// By column.
    pub(super) inputs: Vec<Entry>,
    pub(super) outputs: Vec<Entry>,
    /// Bytes of the rows of all arguments and of all outputs.
    pub(super) strides: [Vec<i64>; 2],
}

impl Memory {
    /// Appends distances to the table, a line for each length of a row.
    pub(super) fn new(layout: &Layout, table: &mut Vec<Line>) -> Self {
        let Layout::Rows { arguments, outputs } = layout else { return Self::default() };
        let mut lengths: Vec<usize> = Vec::new();
        let first = table.len();
        let mut entries = |widths: &[usize]| -> Vec<Entry> {
            let mut entries = Vec::new();
            for (array, &width) in (0..).zip(widths) {
                let known = lengths.iter().position(|&length| length == width);
                let line = known.unwrap_or_else(|| {
                    lengths.push(width);
                    // integers, as the processor reads them
                    table.push(Line(std::array::from_fn(|k| f64::from_bits((k * width) as u64))));
                    lengths.len() - 1
                });
                let distances = u32::try_from(first + line).expect("a table is in memory");
                let stride = bytes(width);
                let entry = |entry| Entry { array, offset: bytes(entry), stride, distances };
                entries.extend((0..width).map(entry));
            }
            entries
        };
        let (inputs, results) = (entries(arguments), entries(outputs));
        let strides = [arguments, outputs].map(|widths| widths.iter().map(|&w| bytes(w)).collect());
        Self { is_rows: true, inputs, outputs: results, strides }
    }
}

/// Bytes of some numbers.
fn bytes(numbers: usize) -> i64 {
    i64::try_from(8 * numbers).expect("rows are in memory")
}
