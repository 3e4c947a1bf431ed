//! The functions from `libm`, against closed forms.

use core::f64::consts::{E, FRAC_PI_4, LN_2, PI, SQRT_2};

use denavit_runtime::Transcendental;

/// Within two units in the last place, relative to the expected value.
#[track_caller]
fn assert_close<S: Transcendental + Into<f64>>(computed: S, expected: f64, epsilon: f64) {
    let computed: f64 = computed.into();
    let error = (computed - expected).abs();
    assert!(error <= 2.0 * epsilon * expected.abs(), "{computed} is not {expected}");
}

fn functions_meet_closed_forms<S: Transcendental + Into<f64>>(epsilon: f64) {
    let close = |computed: S, expected: f64| assert_close(computed, expected, epsilon);
    let half = S::from_f64(0.5);
    let two = S::ONE + S::ONE;
    close(two.sqrt(), SQRT_2);
    close(S::ONE.exponential(), E);
    close((-two).exponential(), 1.0 / (E * E));
    close(two.logarithm(), LN_2);
    close(half.logarithm(), -LN_2);
    close(half.hyperbolic_tangent(), (E - 1.0) / (E + 1.0));
    close((-half).hyperbolic_tangent(), (1.0 - E) / (E + 1.0));
    close(S::ONE.arctangent2(S::ONE), FRAC_PI_4);
    close(S::ONE.arctangent2(-S::ONE), 3.0 * FRAC_PI_4);
    close((-S::ONE).arctangent2(-S::ONE), -3.0 * FRAC_PI_4);
    close((-S::ONE).arctangent2(S::ONE), -FRAC_PI_4);
    close(S::ZERO.arctangent2(-S::ONE), PI);
    // tan(pi/8) = sqrt 2 - 1; the argument's own rounding is within the tolerance.
    close(S::from_f64(PI / 8.0).tangent(), SQRT_2 - 1.0);
}

#[test]
fn double_precision_meets_closed_forms() {
    functions_meet_closed_forms::<f64>(f64::EPSILON);
}

#[test]
fn single_precision_meets_closed_forms() {
    functions_meet_closed_forms::<f32>(f32::EPSILON.into());
}

#[test]
fn square_root_is_exact_on_squares() {
    for n in 0..3000_u32 {
        let n = f64::from(n) * 1.25;
        assert_eq!(Transcendental::sqrt(n * n), n);
    }
    assert!(Transcendental::sqrt(-1.0_f64).is_nan());
}

#[test]
fn limits_and_poles() {
    assert_eq!(0.0_f64.logarithm(), f64::NEG_INFINITY);
    assert!((-1.0_f64).logarithm().is_nan());
    assert_eq!(f64::NEG_INFINITY.exponential(), 0.0);
    assert_eq!(1e3_f64.exponential(), f64::INFINITY);
    assert_eq!(f64::INFINITY.hyperbolic_tangent(), 1.0);
    assert!(f64::NAN.hyperbolic_tangent().is_nan());
}
