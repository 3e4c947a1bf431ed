//! Signs, choices and constants, for both widths.

use core::fmt::Debug;

use denavit_runtime::Scalar;

/// Equality that tells the two zeros apart and takes NaN for equal to NaN.
fn same<S: Scalar>(left: S, right: S) -> bool {
    let nan = |x: S| S::select_equal(x, x, S::ZERO, S::ONE) == S::ONE;
    (nan(left) && nan(right)) || (left == right && S::ONE / left == S::ONE / right)
}

#[track_caller]
fn assert_same<S: Scalar + Debug>(computed: S, expected: f64) {
    let expected = S::from_f64(expected);
    assert!(same(computed, expected), "{computed:?} is not {expected:?}");
}

/// Runs a check on both widths.
macro_rules! for_both_widths {
    ($($check:ident),* $(,)?) => {
        $(
            mod $check {
                #[test]
                fn f64() {
                    super::$check::<f64>();
                }

                #[test]
                fn f32() {
                    super::$check::<f32>();
                }
            }
        )*
    };
}

for_both_widths!(
    constants_are_themselves,
    sign_keeps_zero_and_nan,
    absolute_value_clears_the_sign,
    lesser_and_greater_choose,
    lesser_and_greater_propagate_nan,
    lesser_and_greater_prefer_the_left_of_equals,
    selection_follows_the_order,
    no_comparison_with_nan_holds,
);

fn constants_are_themselves<S: Scalar>() {
    assert_same(S::ZERO, 0.0);
    assert_same(S::default(), 0.0);
    assert_same(S::ONE, 1.0);
    assert_same(S::ONE / (S::ONE + S::ONE), 0.5);
}

fn sign_keeps_zero_and_nan<S: Scalar>() {
    for (value, sign) in [
        (2.5, 1.0),
        (-1e-30, -1.0),
        (f64::INFINITY, 1.0),
        (f64::NEG_INFINITY, -1.0),
        (0.0, 0.0),
        (-0.0, -0.0),
        (f64::NAN, f64::NAN),
    ] {
        assert_same(S::from_f64(value).sign(), sign);
    }
}

fn absolute_value_clears_the_sign<S: Scalar>() {
    for (value, magnitude) in [(-2.5, 2.5), (2.5, 2.5), (-0.0, 0.0), (f64::NAN, f64::NAN)] {
        assert_same(S::from_f64(value).abs(), magnitude);
    }
}

fn lesser_and_greater_choose<S: Scalar>() {
    let ascending = [f64::NEG_INFINITY, -3.0, -0.5, 0.0, 0.25, 7.0, f64::INFINITY];
    for (i, &low) in ascending.iter().enumerate() {
        for &high in &ascending[i..] {
            let (small, large) = (S::from_f64(low), S::from_f64(high));
            assert_same(small.lesser(large), low);
            assert_same(large.lesser(small), low);
            assert_same(small.greater(large), high);
            assert_same(large.greater(small), high);
        }
    }
}

fn lesser_and_greater_propagate_nan<S: Scalar>() {
    let (one, nan) = (S::ONE, S::from_f64(f64::NAN));
    for chosen in [one.lesser(nan), nan.lesser(one), one.greater(nan), nan.greater(one)] {
        assert_same(chosen, f64::NAN);
    }
}

fn lesser_and_greater_prefer_the_left_of_equals<S: Scalar>() {
    let (positive, negative) = (S::from_f64(0.0), S::from_f64(-0.0));
    assert_same(positive.lesser(negative), 0.0);
    assert_same(negative.lesser(positive), -0.0);
    assert_same(positive.greater(negative), 0.0);
    assert_same(negative.greater(positive), -0.0);
}

/// What the three selections choose for a pair: less, less or equal, equal.
fn selections<S: Scalar>(left: f64, right: f64) -> [bool; 3] {
    let (left, right) = (S::from_f64(left), S::from_f64(right));
    [S::select_less, S::select_less_equal, S::select_equal]
        .map(|select| select(left, right, S::ONE, S::ZERO) == S::ONE)
}

fn selection_follows_the_order<S: Scalar>() {
    assert_eq!(selections::<S>(1.0, 2.0), [true, true, false]);
    assert_eq!(selections::<S>(2.0, 2.0), [false, true, true]);
    assert_eq!(selections::<S>(-0.0, 0.0), [false, true, true]);
    assert_eq!(selections::<S>(3.0, 2.0), [false, false, false]);
    assert_eq!(selections::<S>(f64::NEG_INFINITY, f64::INFINITY), [true, true, false]);
}

fn no_comparison_with_nan_holds<S: Scalar>() {
    for (left, right) in [(f64::NAN, 1.0), (1.0, f64::NAN), (f64::NAN, f64::NAN)] {
        assert_eq!(selections::<S>(left, right), [false; 3]);
    }
}

/// 1e-50 is below the least `f32`, 0.1 is rounded to the nearest one.
#[test]
fn constants_are_rounded_to_single_precision() {
    assert_eq!(<f32 as Scalar>::from_f64(1e-50), 0.0);
    assert_eq!(<f32 as Scalar>::from_f64(0.1).to_bits(), 0x3dcc_cccd);
}
