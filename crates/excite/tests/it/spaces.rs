//! Spaces of trajectories have the ends that are asked for, and are what their references say.

use denavit_excite::{Ends, Family, Space};
use denavit_plants::trajectory::Reference;
use denavit_simulate::scenario::read_trajectory;
use proptest::prelude::*;

const FAMILIES: [Family; 4] = [
    Family::Fourier { harmonics: 4 },
    Family::FreeFourier { terms: 3 },
    Family::Polynomial { degree: 9 },
    Family::Samples { knots: 9 },
];

const ALL: Ends = Ends { at_rest: true, unaccelerated: true, closed: true };

fn all_ends() -> impl Iterator<Item = Ends> {
    (0..8).map(|choice: u8| Ends {
        at_rest: choice & 1 != 0,
        unaccelerated: choice & 2 != 0,
        closed: choice & 4 != 0,
    })
}

/// Coordinates of every size that a random start may have.
fn coordinates(space: &Space, seed: u64) -> Vec<f64> {
    let mut random = denavit_numerics::Random::new(seed);
    space.random(|| random.uniform())
}

#[test]
fn ends_are_as_asked_for_in_every_family() {
    for family in FAMILIES {
        for ends in all_ends() {
            let space = Space::new(family, 3.0, ends, 50);
            let x = coordinates(&space, 3);
            let reference = space.reference(&x, 0.3, 0.7).expect("a reference");
            let (start, end) = (reference.at(0.0), reference.at(3.0));
            let what = format!("{family:?} {ends:?}: {start:?} {end:?}");
            let free = |value: f64| value.abs() > 1e-6;
            for point in [start, end] {
                assert!(!ends.at_rest || point.rate.abs() < 1e-9, "{what}");
                assert!(!ends.unaccelerated || point.acceleration.abs() < 1e-8, "{what}");
            }
            if ends.closed {
                assert!((start.position - end.position).abs() < 1e-9, "{what}");
            }
            // and it still moves
            let middle = reference.at(1.3);
            assert!(free(middle.rate) && free(middle.position - start.position), "{what}");
        }
    }
}

#[test]
fn the_number_of_coordinates_is_that_of_functions_less_conditions() {
    let count = |family, ends| Space::new(family, 2.0, ends, 40).coordinates();
    let free = Ends { at_rest: false, unaccelerated: false, closed: false };
    // a polynomial of degree 9: ten coefficients, five conditions
    assert_eq!(count(Family::Polynomial { degree: 9 }, free), 10);
    assert_eq!(count(Family::Polynomial { degree: 9 }, ALL), 5);
    // multiples of one frequency begin as they end: one condition for rates, one for accelerations
    assert_eq!(count(Family::Fourier { harmonics: 4 }, free), 9);
    assert_eq!(count(Family::Fourier { harmonics: 4 }, ALL), 7);
    // a natural spline has no acceleration at its ends
    assert_eq!(count(Family::Samples { knots: 9 }, ALL), 6);
}

#[test]
fn a_file_says_what_the_reference_is() {
    for family in FAMILIES {
        let space = Space::new(family, 3.0, ALL, 50);
        let x = coordinates(&space, 5);
        let reference = space.reference(&x, 0.3, 0.7).expect("a reference");
        let file = serde_json::json!({
            "format": "denavit-trajectory/1",
            "duration_s": 3.0,
            "joints": { "knee": space.written(&x, 0.3, 0.7) },
        });
        let none = |_: &str| Err("there is no other file".to_owned());
        let read = read_trajectory("a.json", file.to_string().as_bytes(), &none).expect("sound");
        let again = read.find("knee").expect("the joint");
        for k in 0..=30 {
            let t_s = 0.1 * f64::from(k);
            let (one, other) = (reference.at(t_s), again.at(t_s));
            assert!((one.position - other.position).abs() < 1e-12, "{family:?}");
            assert!((one.acceleration - other.acceleration).abs() < 1e-9, "{family:?}");
        }
    }
}

#[test]
fn positions_of_a_space_are_found_again() {
    for family in FAMILIES {
        let space = Space::new(family, 3.0, ALL, 60);
        let mut x = coordinates(&space, 7);
        if let Family::FreeFourier { terms } = family {
            // the nearest trajectory is looked for at the multiples
            let linear = x.len() - terms;
            x[linear..].iter_mut().enumerate().for_each(|(k, w)| *w = (k + 1) as f64);
        }
        let positions = |x: &[f64]| -> Vec<f64> {
            let reference = space.reference(x, 0.0, 1.0).expect("a reference");
            space.times().iter().map(|t_s| reference.at(*t_s).position).collect()
        };
        let wanted = positions(&x);
        let found = positions(&space.nearest(&wanted));
        let apart = wanted.iter().zip(&found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-9, "{family:?}: {apart}");
    }
}

proptest! {
    /// Rates and accelerations are the derivatives of positions.
    #[test]
    fn rates_are_derivatives(seed in any::<u64>(), family in 0usize..4, at in 0.05..0.95f64) {
        let space = Space::new(FAMILIES[family], 3.0, ALL, 40);
        let x = coordinates(&space, seed);
        let reference: Reference = space.reference(&x, 0.1, 0.5).expect("a reference");
        let (t_s, step) = (3.0 * at, 1e-5);
        let [before, here, after] = [-step, 0.0, step].map(|step| reference.at(t_s + step));
        let rate = (after.position - before.position) / (2.0 * step);
        let acceleration = (after.rate - before.rate) / (2.0 * step);
        prop_assert!((here.rate - rate).abs() < 1e-5 * (1.0 + here.rate.abs()));
        // the acceleration of a cubic spline has kinks
        let scale = 1.0 + here.acceleration.abs();
        prop_assert!((here.acceleration - acceleration).abs() < 1e-2 * scale);
    }
}
