//! One routine by the interpreter, as code for one sample, and as code for many.

use denavit_codegen::number::Residue;
use denavit_codegen::program::{Evaluate, EvaluateBatch, Evaluator, OutputShape, Program, Routine};
use denavit_jit::{Compiled, CompiledBatch, CompiledRows, Lanes};

/// A number in [-2, 2), from a written seed.
pub(crate) fn number(seed: usize, key: usize) -> f64 {
    let bits = Residue::scrambled(seed as u64, key as u64).value() >> 8;
    4.0 * bits as f64 / (1_u64 << 53) as f64 - 2.0
}

/// Equal bits, but NaN is one value: its bits are no promise.
pub(crate) fn same(left: &[f64], right: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    left.len() == right.len() && left.iter().zip(right).all(equal)
}

/// Samples of a comparison: of no block a multiple.
const SAMPLES: usize = 43;

/// All routines of a program on samples of `value(sample, column)`.
pub(crate) fn compare(program: &Program, prelude: &[f64], value: impl Fn(usize, usize) -> f64) {
    for routine in &program.routines {
        let columns: usize = routine.arguments.iter().map(|argument| argument.len).sum();
        let inputs: Vec<Vec<f64>> =
            (0..columns).map(|c| (0..SAMPLES).map(|k| value(k, c)).collect()).collect();
        compare_routine(routine, prelude, &inputs);
    }
}

/// One routine on columns of samples; the results of all samples.
pub(crate) fn compare_routine(
    routine: &Routine,
    prelude: &[f64],
    inputs: &[Vec<f64>],
) -> Vec<Vec<f64>> {
    let mut compiled = Compiled::new(routine, prelude).unwrap();
    let mut interpreted = Evaluator::new(routine, prelude);
    let samples = inputs.first().map_or(SAMPLES, Vec::len);
    let mut rows = Vec::new();
    for sample in 0..samples {
        let mut next = 0;
        let take = |len: usize| {
            next += len;
            inputs[next - len..next].iter().map(|column| column[sample]).collect()
        };
        let arguments: Vec<Vec<f64>> =
            routine.arguments.iter().map(|argument| argument.len).map(take).collect();
        let arguments: Vec<&[f64]> = arguments.iter().map(|a| &a[..]).collect();
        let mut found = vec![f64::NAN; Evaluate::outputs(&compiled)];
        let mut expected = found.clone();
        compiled.evaluate(&arguments, &mut found).unwrap();
        interpreted.evaluate(&arguments, &mut expected).unwrap();
        let name = routine.full_name();
        assert!(same(&found, &expected), "{name}: {found:?} {expected:?}");
        rows.push(expected);
    }
    for lanes in lanes() {
        let mut batch = CompiledBatch::with_lanes(routine, prelude, lanes).unwrap();
        assert_eq!(batch.lanes(), lanes);
        for count in (0..18).chain([samples]).filter(|&count| count <= samples) {
            compare_batch(&mut batch, routine, inputs, &rows[..count]);
        }
        if lanes != Lanes::Two {
            let mut code = CompiledRows::with_lanes(routine, prelude, lanes).unwrap();
            assert_eq!(code.lanes(), lanes);
            for count in (0..18).chain([samples]).filter(|&count| count <= samples) {
                compare_rows(&mut code, routine, inputs, &rows[..count]);
            }
        }
    }
    rows
}

/// All numbers of lanes that this processor has.
pub(crate) fn lanes() -> Vec<Lanes> {
    let (there, missing): (Vec<Lanes>, Vec<Lanes>) =
        Lanes::ALL.into_iter().partition(|lanes| lanes.is_available());
    if !missing.is_empty() {
        eprintln!("not tested, as this processor does not have them: {missing:?}");
    }
    there
}

/// What stands beside results, and must stay.
const BESIDE: f64 = 77.0;

/// Slices of this length that are not aligned, with something on both sides.
fn rooms(lengths: impl Iterator<Item = usize>) -> Vec<Vec<f64>> {
    let room = |(at, len): (usize, usize)| {
        let mut room = vec![BESIDE; 2 + at % 2 + len];
        room[1 + at % 2..][..len].fill(f64::NAN);
        room
    };
    lengths.enumerate().map(room).collect()
}

fn slices(rooms: &mut [Vec<f64>]) -> Vec<&mut [f64]> {
    let inner = |(at, room)| -> &mut [f64] {
        let room: &mut Vec<f64> = room;
        let end = room.len() - 1;
        &mut room[1 + at % 2..end]
    };
    rooms.iter_mut().enumerate().map(inner).collect()
}

fn compare_batch(
    batch: &mut CompiledBatch,
    routine: &Routine,
    inputs: &[Vec<f64>],
    rows: &[Vec<f64>],
) {
    let samples = rows.len();
    let place = format!("{}, {:?}, {samples} samples", routine.full_name(), batch.lanes());
    // The first number apart, so that columns are not aligned.
    let shifted: Vec<Vec<f64>> =
        inputs.iter().map(|column| [&[BESIDE], &column[..samples]].concat()).collect();
    let given: Vec<&[f64]> = shifted.iter().map(|column| &column[1..]).collect();
    let mut outputs = rooms(std::iter::repeat_n(samples, EvaluateBatch::outputs(batch)));
    batch.evaluate(&given, &mut slices(&mut outputs)).unwrap();
    for (at, room) in outputs.iter().enumerate() {
        assert!(room[0] == BESIDE && room[room.len() - 1] == BESIDE, "{place}: beside {at}");
    }
    let outputs = slices(&mut outputs);
    for (sample, expected) in rows.iter().enumerate() {
        let found: Vec<f64> = outputs.iter().map(|column| column[sample]).collect();
        assert!(same(&found, expected), "{place}, sample {sample}: {found:?} {expected:?}");
    }
}

fn compare_rows(
    code: &mut CompiledRows,
    routine: &Routine,
    inputs: &[Vec<f64>],
    rows: &[Vec<f64>],
) {
    let samples = rows.len();
    let place = format!("{}, rows, {:?}, {samples} samples", routine.full_name(), code.lanes());
    let mut columns = inputs.iter();
    let mut arguments: Vec<Vec<f64>> = Vec::new();
    for argument in &routine.arguments {
        let own: Vec<&Vec<f64>> = columns.by_ref().take(argument.len).collect();
        let numbers = (0..samples).flat_map(|k| own.iter().map(move |column| column[k]));
        arguments.push([BESIDE].into_iter().chain(numbers).collect());
    }
    let arguments: Vec<&[f64]> = arguments.iter().map(|rows| &rows[1..]).collect();
    let widths: Vec<usize> = routine.outputs.iter().map(OutputShape::len).collect();
    let mut outputs = rooms(widths.iter().map(|width| samples * width));
    code.evaluate(samples, &arguments, &mut slices(&mut outputs)).unwrap();
    for (at, room) in outputs.iter().enumerate() {
        assert!(room[0] == BESIDE && room[room.len() - 1] == BESIDE, "{place}: beside {at}");
    }
    let outputs = slices(&mut outputs);
    for (sample, expected) in rows.iter().enumerate() {
        let parts = outputs.iter().zip(&widths);
        let found: Vec<f64> = parts
            .flat_map(|(rows, width)| rows[sample * width..(sample + 1) * width].to_vec())
            .collect();
        assert!(same(&found, expected), "{place}, sample {sample}: {found:?} {expected:?}");
    }
}
