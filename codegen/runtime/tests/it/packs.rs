//! Packs against single numbers, lane by lane and bit by bit.

use denavit_runtime::wide::{f64x4, f64x8};
use denavit_runtime::{ColumnFault, FUSES, Scalar, for_each_pack, map_packs};
use proptest::prelude::*;

/// Numbers of every kind: angles, large ones, zeros of both signs, and what is no number.
const NUMBERS: [f64; 16] = [
    0.3,
    -2.5,
    1e4,
    0.0,
    -0.0,
    1e5,
    100_000.000_1,
    -7e22,
    f64::INFINITY,
    f64::NEG_INFINITY,
    f64::NAN,
    5e-324,
    -1e-300,
    std::f64::consts::FRAC_PI_2,
    -std::f64::consts::PI,
    1.797e308,
];

/// NaN is one value here: its bits are no promise.
fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

/// Everything a scalar can do, of three numbers.
fn everything<S: Scalar>(a: S, b: S, c: S) -> [S; 17] {
    let ((sine, cosine), (sines, cosines)) = (a.sincos(), S::sincos_all([a, b, c, a, b]));
    [
        a + b,
        a - b,
        a * b,
        a / b,
        -a,
        sine,
        cosine,
        sines[4],
        cosines[1],
        a.abs(),
        a.sign(),
        a.lesser(b),
        a.greater(b),
        S::select_less(a, b, c, a),
        S::select_less_equal(a, b, c, a),
        S::select_equal(a, b, c, a),
        a.product_plus(b, c) + a.product_minus(b, c) + a.minus_product(b, c),
    ]
}

macro_rules! lanes_are_numbers {
    ($name:ident, $pack:ident, $lanes:literal) => {
        #[test]
        fn $name() {
            for shift in 0..NUMBERS.len() * NUMBERS.len() {
                let at = |lane: usize, stride: usize| NUMBERS[(lane + shift * stride) % 16];
                let given: [[f64; 3]; $lanes] = std::array::from_fn(|lane| {
                    [at(lane, 1), NUMBERS[(lane + shift / 16) % 16], at(lane, 5)]
                });
                let pack = |row: usize| $pack::new(std::array::from_fn(|lane| given[lane][row]));
                let packed = everything(pack(0), pack(1), pack(2)).map(|pack| pack.to_array());
                for (lane, &[a, b, c]) in given.iter().enumerate() {
                    let single = everything(a, b, c);
                    for (row, single) in single.into_iter().enumerate() {
                        let found = packed[row][lane];
                        assert!(same(found, single), "{row}: {a} {b} {c}: {found} {single}");
                    }
                }
            }
        }
    };
}

lanes_are_numbers!(four_lanes_are_four_numbers, f64x4, 4);
lanes_are_numbers!(eight_lanes_are_eight_numbers, f64x8, 8);

proptest! {
    #[test]
    fn packs_of_angles_are_angles(angles in proptest::array::uniform7(-1e6..1e6_f64)) {
        let (sines, cosines) = f64::sincos_all(angles);
        for (row, angle) in angles.into_iter().enumerate() {
            let (sine, cosine) = angle.sincos();
            prop_assert!(same(sine, sines[row]) && same(cosine, cosines[row]));
        }
    }

    #[test]
    fn products_are_rounded_once_where_they_fuse(a in -2.0..2.0_f64, b in -2.0..2.0_f64) {
        // What rounding the product loses is a number of its own, which only one rounding shows.
        let lost = a.product_minus(b, a * b);
        let exact = a.mul_add(b, -(a * b));
        prop_assert_eq!(lost, if FUSES { exact } else { 0.0 });
        prop_assert_eq!((a * b).minus_product(a, b), -lost);
        let sum = if FUSES { a.mul_add(b, 1.0) } else { a * b + 1.0 };
        prop_assert_eq!(a.product_plus(b, 1.0), sum);
    }
}

/// Every row of a batch has the bits of a call.
#[test]
fn every_remainder_is_computed() {
    let function = |q: [f64; 2], qd: [f64; 2]| [q[0] * qd[1], q[1].sincos().0, q[0] / qd[0]];
    for samples in 0..20_usize {
        let column = |a: f64, b: f64| (0..samples).map(|k| a + b * k as f64).collect::<Vec<_>>();
        let q = [column(0.1, 1.0), column(-3.0, 0.7)];
        let qd = [column(2.0, -0.3), column(0.5, 0.01)];
        let mut outputs = [0; 3].map(|_| vec![f64::NAN; samples]);
        let packed =
            |[q, qd]: [&[f64x4; 2]; 2]| ([q[0] * qd[1], q[1].sincos().0], [[q[0] / qd[0]]]);
        let inputs = [&q, &qd].map(|columns| columns.each_ref().map(|column| &column[..]));
        let mut columns = outputs.each_mut().map(|column| &mut column[..]);
        map_packs([&inputs[0], &inputs[1]], &mut columns, packed).unwrap();
        for row in 0..samples {
            let at = |columns: &[Vec<f64>; 2]| columns.each_ref().map(|column| column[row]);
            let found = outputs.each_ref().map(|column| column[row]);
            assert_eq!(found, function(at(&q), at(&qd)), "row {row} of {samples}");
        }
    }
}

#[test]
fn columns_that_do_not_fit_are_refused_and_nothing_is_computed() {
    let (long, short) = ([1.0; 6], [1.0; 5]);
    let (q, mixed): ([&[f64]; 2], [&[f64]; 2]) = ([&long, &long], [&long, &short]);
    let (mut first, mut second) = ([f64::NAN; 6], [f64::NAN; 6]);
    let sum = |[q, other]: [&[f64x4; 2]; 2]| [q[0] + other[0], q[1] + other[1]];
    let error = map_packs([&q, &mixed], &mut [&mut first, &mut second], sum).unwrap_err();
    let fault = ColumnFault::Samples { input: Some(1), column: 1, expected: 6, found: 5 };
    assert_eq!(error, fault);
    assert_eq!(error.to_string(), "input 1: column 1 has 5 samples instead of 6");
    let error = map_packs([&q, &q[..1]], &mut [&mut first, &mut second], sum).unwrap_err();
    assert_eq!(error, ColumnFault::Columns { input: Some(1), expected: 2, found: 1 });
    let error = map_packs([&q, &q], &mut [&mut first], sum).unwrap_err();
    assert_eq!(error.to_string(), "outputs: 1 columns instead of 2");
    let error = map_packs([&q, &q], &mut [&mut first, &mut second[..4]], sum).unwrap_err();
    assert_eq!(error, ColumnFault::Samples { input: None, column: 1, expected: 6, found: 4 });
    assert!(first.iter().chain(&second).all(|output| output.is_nan()));
    let mut rows = Vec::new();
    for_each_pack([&q], 6, |row, [_]: [&[f64x4; 2]; 1]| rows.push(row)).unwrap();
    assert_eq!(rows, [0, 4]);
}
