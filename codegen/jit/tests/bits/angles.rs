//! Sine and cosine: of ordinary angles by steps of wide code, of others by calls.

use crate::compare::{compare_routine, number};
use denavit_codegen::arena::PrimaryMap;
use denavit_codegen::function::{Form, FunctionName};
use denavit_codegen::program::{
    ArgumentShape, BinaryOperation, Code, Instruction, Leaf, Operation, OutputShape, Routine, Slot,
};
use denavit_runtime::Scalar;
use std::f64::consts::FRAC_PI_2;

/// Sines and cosines of `angles` numbers, and of the sum of the first two.
fn turns(angles: usize) -> Routine {
    let mut leaves = PrimaryMap::new();
    let mut slots: Vec<Slot> =
        (0..angles).map(|entry| leaves.push(Leaf::Argument { argument: 0, entry })).collect();
    let mut instructions = Vec::new();
    let mut outputs = Vec::new();
    let mut next = angles;
    let mut slot = || {
        next += 1;
        denavit_codegen::arena::Handle::from_index(next - 1)
    };
    let sum = slot();
    let operation = Operation::Binary(BinaryOperation::Add, slots[0], slots[1]);
    instructions.push(Instruction::Value { result: sum, operation });
    slots.push(sum);
    for angle in slots {
        let (sine, cosine) = (slot(), slot());
        instructions.push(Instruction::SinCos { sine, cosine, angle });
        outputs.extend([sine, cosine]);
    }
    let shape = OutputShape {
        name: "all",
        shape: vec![outputs.len()],
        doc: String::new(),
        details: vec![],
    };
    Routine {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![ArgumentShape { name: "q", len: angles }],
        outputs: vec![shape],
        form: Form::Plain,
        code: Code { leaves, instructions, outputs, slots: next },
    }
}

/// Compares the code, and the interpreter with the runtime.
fn compare_turns(angles: &[Vec<f64>]) {
    let rows = compare_routine(&turns(angles.len()), &[], angles);
    for (sample, row) in rows.iter().enumerate() {
        for (column, pair) in angles.iter().zip(row.chunks(2)) {
            let (sine, cosine) = column[sample].sincos();
            assert!(pair[0].to_bits() == sine.to_bits() || sine.is_nan(), "{}", column[sample]);
            assert!(pair[1].to_bits() == cosine.to_bits() || cosine.is_nan(), "{}", column[sample]);
        }
    }
}

/// Angles that rounding, signs or the end of a range make special.
fn special() -> Vec<f64> {
    let mut angles = vec![
        0.0,
        5e-324,
        2.2e-308,
        1e-200,
        1e-160,
        1e-30,
        0.5,
        1.0,
        1e5,
        1e5_f64.next_up(),
        1e22,
        1.5e300,
        f64::MAX,
        f64::INFINITY,
        f64::NAN,
        99_999.999,
        1e5_f64.next_down(),
        2e5,
    ];
    for quarters in [1.0, 2.0, 3.0, 4.0, 5.0, 101.0, 4097.0, 63_661.0, 63_662.0] {
        let angle = quarters * FRAC_PI_2;
        angles.extend([angle, angle.next_up(), angle.next_down(), angle + FRAC_PI_2 / 2.0]);
    }
    angles.iter().flat_map(|&angle| [angle, -angle]).collect()
}

#[test]
fn special_angles_are_computed_beside_each_other() {
    let kinds = special();
    let column =
        |step: usize| (0..2 * kinds.len()).map(|k| kinds[step * k % kinds.len()]).collect();
    let columns: Vec<Vec<f64>> = [1, 5, 7, 11, 13, 17].map(column).to_vec();
    compare_turns(&columns);
}

/// Angles of all sizes, in each lane others.
#[test]
fn many_angles_have_the_bits_of_the_runtime() {
    let angle = |k: usize, column: usize| {
        let size = [1.0, 3.0, 50.0, 5e4, 1e-7, 2e5][(k + column) % 6];
        size * number(k, column)
    };
    for angles in 2..8 {
        let columns: Vec<Vec<f64>> = (0..angles)
            .map(|column| (0..5000).map(|k| angle(k, 10 * angles + column)).collect())
            .collect();
        compare_turns(&columns);
    }
}

/// One large angle, in every block and lane: blocks before and after it are computed as ever.
#[test]
fn a_large_angle_disturbs_no_other_sample() {
    for at in 0..40 {
        let mut columns: Vec<Vec<f64>> =
            (0..3).map(|column| (0..40).map(|k| number(k, column)).collect()).collect();
        columns[at % 3][at] = 1e22;
        compare_turns(&columns);
    }
}
