//! References: what they pass through, and that rates are derivatives.

use super::assert_near;
use denavit_plants::trajectory::{
    Bezier, CosineProfile, CubicSpline, EndCondition, Fourier, Part, Polynomial, QuinticSpline,
    Reference, Sequence,
};
use denavit_plants::{Error, ErrorKind};

fn all() -> Vec<Reference> {
    let times = vec![0.0, 0.3, 0.5, 1.0];
    let values = vec![0.1, -0.4, 0.3, 0.2];
    let ends = [EndCondition::Rate(0.3), EndCondition::Natural];
    vec![
        Reference::Cubic(CubicSpline::new(times.clone(), values.clone(), ends).unwrap()),
        Reference::Quintic(
            QuinticSpline::new(times, values, &[0.0, 1.0, -1.0, 0.0], &[0.0, 2.0, 0.0, 1.0])
                .unwrap(),
        ),
        Reference::Cosine(CosineProfile::new([0.0, 1.0], [0.2, 0.9]).unwrap()),
        Reference::Bezier(Bezier::new([0.0, 1.0], vec![0.0, 0.5, -0.5, 1.0, 0.2]).unwrap()),
        Reference::Fourier(Fourier::new(3.0, 0.1, vec![0.2, 0.1], vec![0.3, -0.2]).unwrap()),
        Reference::Polynomial(Polynomial::new(vec![1.0, -2.0, 0.5, 3.0]).unwrap()),
    ]
}

#[test]
fn rates_are_derivatives() {
    let h = 1e-5;
    for reference in all() {
        for t in [0.1, 0.42, 0.77] {
            let [before, here, after] = [t - h, t, t + h].map(|t| reference.at(t));
            assert_near(here.rate, (after.position - before.position) / (2.0 * h), 1e-7);
            assert_near(here.acceleration, (after.rate - before.rate) / (2.0 * h), 1e-6);
        }
    }
}

/// The clamped cubic spline of a cubic is that cubic.
#[test]
fn a_cubic_spline_reproduces_a_cubic() {
    let cubic = |t: f64| 2.0 - t + 3.0 * t * t - 0.5 * t * t * t;
    let rate = |t: f64| -1.0 + 6.0 * t - 1.5 * t * t;
    let times: Vec<f64> = [0.0, 0.4, 0.5, 1.3, 2.0].to_vec();
    let values = times.iter().map(|t| cubic(*t)).collect();
    let ends = [EndCondition::Rate(rate(0.0)), EndCondition::Rate(rate(2.0))];
    let spline = Reference::Cubic(CubicSpline::new(times, values, ends).unwrap());
    for t in [0.0, 0.2, 0.45, 0.9, 1.7, 2.0] {
        assert_near(spline.at(t).position, cubic(t), 1e-13);
        assert_near(spline.at(t).rate, rate(t), 1e-13);
    }
    assert_eq!(spline.at(2.5).rate, 0.0, "it rests after its end");
}

#[test]
fn a_sequence_repeats_and_says_where_it_jumps() {
    let part = |value| Part {
        duration_s: 0.5,
        reference: Reference::Polynomial(Polynomial::new(vec![value, 1.0]).unwrap()),
    };
    let sequence = Reference::Sequence(Sequence::new(vec![part(0.0), part(5.0)], true).unwrap());
    assert_near(sequence.at(0.2).position, 0.2, 1e-15);
    assert_near(sequence.at(0.5).position, 5.0, 1e-15);
    assert_near(sequence.at(3.75).position, 5.25, 1e-15);
    assert_eq!(sequence.next_break(0.2), Some(0.5));
    assert_eq!(sequence.next_break(0.5), Some(1.0));
    assert_near(sequence.next_break(7.1).unwrap(), 7.5, 1e-12);
}

#[test]
fn impossible_references_are_refused() {
    let natural = [EndCondition::Natural; 2];
    fn refused<T: std::fmt::Debug>(made: Result<T, Error>, said: &str) {
        let error = made.expect_err(said);
        assert_eq!(error.kind(), ErrorKind::Reference);
        assert_eq!(error.to_string(), said);
    }
    let times = |last| CubicSpline::new(vec![0.0, 1.0, last], vec![0.0; 3], natural);
    refused(times(1.0), "time number 3 is not after the one before it");
    refused(times(f64::NAN), "a number of the reference is not finite");
    let backward = CosineProfile::new([1.0, 0.0], [0.0; 2]);
    refused(backward, "time number 2 is not after the one before it");
    let still = Fourier::new(0.0, 0.0, Vec::new(), Vec::new());
    refused(still, "a frequency or duration is not positive");
}
