//! Capturability of the linear inverted pendulum, against dynamic programming on a grid that knows
//! nothing of its closed forms: the smallest controlled invariant set of the discretised pendulum
//! without steps, and from there one step back after the other.

use super::assert_near;
use denavit_walk::capturability::{Capturability, StepLimits, Steps};

const LIMITS: StepLimits = StepLimits {
    gravity_m_s2: 9.81,
    height_m: 0.65,
    heel_m: 0.06,
    toe_m: 0.15,
    step_s: 0.3,
    longest_m: [0.2, 0.3],
};

/// Distance of capture points on the grid \[m\].
const CELL_M: f64 = 5e-4;
/// The grid reaches so far either way \[m\].
const SPAN_M: f64 = 0.6;

/// Sets of capture points, forward from the ankle that stands, as marks on a grid.
struct Grid {
    count: usize,
}

impl Grid {
    fn new() -> Self {
        Self { count: (2.0 * SPAN_M / CELL_M).round() as usize + 1 }
    }

    fn place_m(&self, index: usize) -> f64 {
        -SPAN_M + CELL_M * index as f64
    }

    fn holds(&self, set: &[bool], place_m: f64) -> bool {
        let index = ((place_m + SPAN_M) / CELL_M).round();
        index >= 0.0 && (index as usize) < self.count && set[index as usize]
    }

    fn ends_m(&self, set: &[bool]) -> [f64; 2] {
        let first = set.iter().position(|mark| *mark).unwrap();
        let last = set.iter().rposition(|mark| *mark).unwrap();
        assert!(set[first..=last].iter().all(|mark| *mark), "one interval");
        [self.place_m(first), self.place_m(last)]
    }

    /// Where the capture point is after a time with the centre of pressure at a place.
    fn after(capture_m: f64, pressure_m: f64, time_s: f64) -> f64 {
        let omega = (LIMITS.gravity_m_s2 / LIMITS.height_m).sqrt();
        pressure_m + (capture_m - pressure_m) * (omega * time_s).exp()
    }

    fn pressures() -> impl Iterator<Item = f64> {
        let length = LIMITS.heel_m + LIMITS.toe_m;
        (0..=42).map(move |index| -LIMITS.heel_m + length * f64::from(index) / 42.0)
    }

    /// The largest set that some centre of pressure keeps a capture point in for ever.
    fn held(&self) -> Vec<bool> {
        let mut set = vec![true; self.count];
        loop {
            let stays = |index: usize| {
                let at = self.place_m(index);
                Self::pressures().any(|p| self.holds(&set, Self::after(at, p, 0.05)))
            };
            let next: Vec<bool> = (0..self.count).map(|i| set[i] && stays(i)).collect();
            if next == set {
                return set;
            }
            set = next;
        }
    }

    /// From where one step leads into a set, or none is needed.
    fn stepped(&self, set: &[bool]) -> Vec<bool> {
        let [back, forward] = LIMITS.longest_m;
        let places = || (0..=250).map(|i| -back + (back + forward) * f64::from(i) / 250.0);
        let times = || (0..3).map(|i| LIMITS.step_s + 0.1 * f64::from(i));
        let leads = |index: usize| {
            let at = self.place_m(index);
            times().any(|time_s| {
                Self::pressures().any(|p| {
                    let landed = Self::after(at, p, time_s);
                    places().any(|place| self.holds(set, landed - place))
                })
            })
        };
        (0..self.count).map(|index| set[index] || leads(index)).collect()
    }
}

#[test]
fn reaches_are_those_of_dynamic_programming() {
    let (grid, found) = (Grid::new(), Capturability::new(LIMITS).unwrap());
    let mut set = grid.held();
    for steps in 0..5 {
        let expected = grid.ends_m(&set);
        for (found, expected) in found.reach_m(steps).into_iter().zip(expected) {
            // a cell, and what cells before have added
            assert_near(found, expected, 3.0 * CELL_M);
        }
        set = grid.stepped(&set);
    }
}

/// The best policy, simulated: just inside it comes to rest in N steps, just outside not.
#[test]
fn a_little_more_than_the_reach_is_one_step_more() {
    let found = Capturability::new(LIMITS).unwrap();
    for steps in 0..6 {
        let [low, high] = found.reach_m(steps);
        for (inside, outside) in [(high - 1e-9, high + 1e-9), (low + 1e-9, low - 1e-9)] {
            assert_eq!(found.steps(inside), Steps::Least(steps));
            assert_eq!(found.steps(outside), Steps::Least(steps + 1));
            assert_eq!(steps_walked(inside), steps);
            assert_eq!(steps_walked(outside), steps + 1);
        }
    }
}

/// The centre of pressure at the edge, the foot under the capture point or as far as it goes.
fn steps_walked(mut capture_m: f64) -> usize {
    for steps in 0..100 {
        if (-LIMITS.heel_m..=LIMITS.toe_m).contains(&capture_m) {
            return steps;
        }
        let edge = capture_m.clamp(-LIMITS.heel_m, LIMITS.toe_m);
        let landed = Grid::after(capture_m, edge, LIMITS.step_s);
        capture_m = landed - landed.clamp(-LIMITS.longest_m[0], LIMITS.longest_m[1]);
    }
    usize::MAX
}

#[test]
fn reaches_grow_to_a_limit_from_which_every_step_leads_back_to_itself() {
    let found = Capturability::new(LIMITS).unwrap();
    let [low, high] = found.limit_m();
    let [most_low, most_high] = found.reach_m(60);
    assert_near(most_low, low, 1e-12);
    assert_near(most_high, high, 1e-12);
    let again = |end: f64, edge: f64, step: f64| Grid::after(end, edge, LIMITS.step_s) - step;
    assert_near(again(high, LIMITS.toe_m, LIMITS.longest_m[1]), high, 1e-12);
    assert_near(again(low, -LIMITS.heel_m, -LIMITS.longest_m[0]), low, 1e-12);
    assert_eq!(found.steps(high + 1e-9), Steps::Falls);
    assert_eq!(found.steps(low - 1e-9), Steps::Falls);
    assert_eq!(steps_walked(high + 1e-9), usize::MAX);
}

/// What Koolen and others print for a symmetric foot, in their units: d_N = (l - r + d_(N-1))
/// e^(-T) + r, from d_0 = r.
#[test]
fn symmetric_feet_have_the_recursion_of_the_paper() {
    let (radius, longest, time) = (0.1, 0.5, 0.8);
    let limits = StepLimits {
        gravity_m_s2: 1.0,
        height_m: 1.0,
        heel_m: radius,
        toe_m: radius,
        step_s: time,
        longest_m: [longest; 2],
    };
    let found = Capturability::new(limits).unwrap();
    let mut reach = radius;
    for steps in 0..10 {
        assert_near(found.reach_m(steps)[1], reach, 1e-14);
        assert_near(found.reach_m(steps)[0], -reach, 1e-14);
        reach = (longest - radius + reach) * f64::exp(-time) + radius;
    }
}

/// A landing in the region leaves a capture point that one step fewer captures, one beside it does
/// not.
#[test]
fn a_landing_in_the_region_needs_one_step_fewer() {
    let found = Capturability::new(LIMITS).unwrap();
    let capture_m = 0.5 * (found.reach_m(1)[1] + found.reach_m(2)[1]);
    assert!(found.region(capture_m, LIMITS.step_s, 1).is_none(), "one step is not enough");
    assert!(found.region(capture_m, 0.9 * LIMITS.step_s, 2).is_none(), "too early");
    let region = found.region(capture_m, LIMITS.step_s, 2).unwrap();
    let [low, high] = region.places_m;
    let best = |place: f64| {
        let landed = Grid::pressures().map(|p| Grid::after(capture_m, p, LIMITS.step_s) - place);
        landed.map(steps_walked).min().unwrap()
    };
    assert_eq!(best(low + 1e-9), 1);
    assert_eq!(best(high - 1e-9), 1);
    assert_eq!(best(low - 1e-9), 2);
    assert_near(high, LIMITS.longest_m[1], 1e-15);
}

#[test]
fn limits_that_mean_nothing_are_refused() {
    let wrong = [
        StepLimits { height_m: 0.0, ..LIMITS },
        StepLimits { step_s: -0.1, ..LIMITS },
        StepLimits { toe_m: f64::NAN, ..LIMITS },
        StepLimits { longest_m: [0.1, f64::INFINITY], ..LIMITS },
    ];
    for limits in wrong {
        assert!(Capturability::new(limits).is_err(), "{limits:?}");
    }
}
