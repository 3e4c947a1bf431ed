//! `Scalar::sincos` of `f64` and `f32`.

use denavit_runtime::Scalar;
use proptest::prelude::*;

use crate::reference::Reference;

/// The error that the documentation of `sincos` states as the largest measured.
const STATED_ERROR_ULP: f64 = 0.82;

/// The larger of the two errors at `x`, in ulp of `f64`.
fn error_ulp(reference: &Reference, x: f64) -> f64 {
    let (sine, cosine) = Scalar::sincos(x);
    let (exact_sine, exact_cosine) = reference.sincos(x);
    exact_sine.error_ulp(sine, 53).max(exact_cosine.error_ulp(cosine, 53))
}

#[track_caller]
fn assert_within_stated_error(arguments: impl IntoIterator<Item = f64>) {
    let reference = Reference::new();
    for x in arguments {
        let error = error_ulp(&reference, x);
        assert!(error <= STATED_ERROR_ULP, "{error} ulp at {x:e}");
    }
}

/// A fixed sequence in [0, 1): the bits of a linear congruential generator.
fn random_unit(seed: u64) -> impl Iterator<Item = f64> {
    let mut state = seed;
    core::iter::from_fn(move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        Some((state >> 11) as f64 * 2_f64.powi(-53))
    })
}

#[test]
fn first_eighth_turn_is_within_stated_error() {
    assert_within_stated_error(random_unit(1).take(5000).map(|u| u * core::f64::consts::FRAC_PI_4));
}

#[test]
fn joint_angles_are_within_stated_error() {
    assert_within_stated_error(random_unit(2).take(5000).map(|u| (u - 0.5) * 20.0));
}

/// Where the errors are greatest: the reduced argument is large and its excess is too.
#[test]
fn neighbours_of_odd_eighth_turns_are_within_stated_error() {
    let turns = random_unit(7).map(|u| (u * 60_000.0).floor() + 0.5);
    let offsets = random_unit(8).map(|u| (u - 0.5) * 0.1);
    let near = turns.zip(offsets).map(|(n, offset)| n * core::f64::consts::FRAC_PI_2 + offset);
    assert_within_stated_error(near.take(20_000));
}

#[test]
fn ordinary_range_is_within_stated_error() {
    assert_within_stated_error(random_unit(3).take(5000).map(|u| (u - 0.5) * 2e5));
}

#[test]
fn both_sides_of_the_ordinary_range_are_within_stated_error() {
    assert_within_stated_error(random_unit(4).take(2000).map(|u| 99_990.0 + 20.0 * u));
}

#[test]
fn every_binade_is_within_stated_error() {
    let per_binade = |exponent: i32| {
        let scale = 2_f64.powi(exponent);
        random_unit(exponent.unsigned_abs().into()).take(4).map(move |u| scale * (1.0 + u))
    };
    assert_within_stated_error((-60..1024).flat_map(per_binade));
}

#[test]
fn neighbours_of_quarter_turns_are_within_stated_error() {
    let reference = Reference::new();
    let neighbours = (1..66_000).step_by(13).flat_map(|turns| {
        let x = reference.quarter_turns(turns);
        [x.next_down(), x, x.next_up()]
    });
    assert_within_stated_error(neighbours);
}

#[test]
fn arguments_of_greatest_cancellation_are_within_stated_error() {
    let reference = Reference::new();
    assert_within_stated_error((-53..=971).flat_map(|exponent| reference.hardest(exponent)));
}

/// The `f64` closest of all to a multiple of pi/2 (Muller, Elementary Functions, on range
/// reduction).
const CLOSEST_SIGNIFICAND: f64 = 6_381_956_970_095_103.0;
const CLOSEST_EXPONENT: i32 = 797;

#[test]
fn reference_finds_the_published_argument_of_greatest_cancellation() {
    let closest = CLOSEST_SIGNIFICAND * 2_f64.powi(CLOSEST_EXPONENT);
    assert!(Reference::new().hardest(CLOSEST_EXPONENT).contains(&closest));
}

#[test]
fn published_values_are_met() {
    assert_eq!(1e22.sincos(), (-0.852_200_849_767_188_8, 0.523_214_785_395_139));
    assert_eq!(f64::MAX.sincos(), (0.004_961_954_789_184_062, -0.999_987_689_426_559_9));
    let closest = CLOSEST_SIGNIFICAND * 2_f64.powi(CLOSEST_EXPONENT);
    assert_eq!(closest.sincos(), (1.0, -4.687_165_924_254_628e-19));
}

/// |x - sin x| < |x|^3 / 6 and 1 - cos x < x^2 / 2 are below half an ulp here.
#[test]
fn tiny_angles_are_their_own_sine() {
    for exponent in 27..=1074 {
        let x = 2_f64.powi(-exponent);
        for x in [x, -x, x * 0.75] {
            let (sine, cosine) = x.sincos();
            assert_eq!((sine.to_bits(), cosine), (x.to_bits(), 1.0), "at {x:e}");
        }
    }
}

#[test]
fn zero_keeps_its_sign() {
    let (sine, cosine) = Scalar::sincos(0.0_f64);
    assert_eq!((sine.to_bits(), cosine), (0, 1.0));
    let (sine, cosine) = Scalar::sincos(-0.0_f64);
    assert_eq!((sine.to_bits(), cosine), ((-0.0_f64).to_bits(), 1.0));
    let (sine, cosine) = Scalar::sincos(-0.0_f32);
    assert_eq!((sine.to_bits(), cosine), ((-0.0_f32).to_bits(), 1.0));
}

#[test]
fn angles_that_are_not_finite_give_nan() {
    for x in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
        let (sine, cosine) = x.sincos();
        assert!(sine.is_nan() && cosine.is_nan(), "at {x}");
        let (sine, cosine) = (x as f32).sincos();
        assert!(sine.is_nan() && cosine.is_nan(), "at {x} as f32");
    }
}

#[test]
fn single_precision_is_rounded_once_more() {
    let reference = Reference::new();
    let moderate = random_unit(5).take(4000).map(|u| (u - 0.5) * 100.0);
    let any = random_unit(6).take(2000).map(|u| 2_f64.powf(u * 140.0 - 20.0));
    for x in moderate.chain(any).map(|x| x as f32).filter(|x| x.is_finite()) {
        let (sine, cosine) = Scalar::sincos(x);
        let (exact_sine, exact_cosine) = reference.sincos(x.into());
        let error = exact_sine.error_ulp(sine.into(), 24);
        let error = error.max(exact_cosine.error_ulp(cosine.into(), 24));
        assert!(error < 0.500_001, "{error} ulp at {x:e}");
    }
}

proptest! {
    #[test]
    fn sine_is_odd_and_cosine_is_even(x in prop_oneof![any::<f64>(), -20.0..20.0, -1e5..1e5]) {
        prop_assume!(x.is_finite());
        let (sine, cosine) = x.sincos();
        let (sine_of_negative, cosine_of_negative) = (-x).sincos();
        prop_assert_eq!(sine_of_negative.to_bits(), (-sine).to_bits());
        prop_assert_eq!(cosine_of_negative.to_bits(), cosine.to_bits());
    }

    #[test]
    fn the_point_lies_on_the_unit_circle(x in prop_oneof![any::<f64>(), -20.0..20.0, -1e5..1e5]) {
        prop_assume!(x.is_finite());
        let (sine, cosine) = x.sincos();
        prop_assert!(sine.abs() <= 1.0 && cosine.abs() <= 1.0);
        prop_assert!((sine * sine + cosine * cosine - 1.0).abs() <= 2.0 * f64::EPSILON);
    }
}
