//! The range of every number of a scenario: beyond these a run would not end, would not fit into
//! memory, or would mean nothing. The schema states the same.

use std::fmt;

/// From the least value to the largest, both allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// The least.
    pub least: f64,
    /// The largest.
    pub most: f64,
}

impl Range {
    /// Of the gains of a joint's law.
    pub const GAIN: Self = Self::new(0.0, 1e12);

    /// From the least to the largest.
    pub const fn new(least: f64, most: f64) -> Self {
        Self { least, most }
    }

    /// Whether a value is in it; NaN is not.
    pub fn contains(self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "from {} to {}", short(self.least), short(self.most))
    }
}

/// A number with an exponent where that is shorter to read.
pub(super) fn short(value: f64) -> String {
    let plain = value == 0.0 || (1e-3..1e5).contains(&value.abs());
    if plain { value.to_string() } else { format!("{value:e}") }
}

/// Times of a run: at 10^5 s a number resolves 10^-11 s.
pub(super) const START_S: Range = Range::new(-1e5, 1e5);
pub(super) const DURATION_S: Range = Range::new(0.0, 1e5);
pub(super) const LOG_PERIOD_S: Range = Range::new(1e-9, 1e5);
pub(super) const SAMPLE_PERIOD_S: Range = Range::new(1e-8, 1e3);
pub(super) const STEP_S: Range = Range::new(1e-9, 1.0);
/// Positions and rates at the start, by joint.
pub(super) const COORDINATE: Range = Range::new(-1e9, 1e9);
pub(super) const CRADLE_BALLS: Range = Range::new(2.0, 8.0);

/// Of drives.
pub(super) const STICTION_RATE: Range = Range::new(1e-9, 1e3);

/// Of the measurement.
pub(super) const RESOLUTION: Range = Range::new(0.0, 1e3);
pub(super) const NOISE: Range = Range::new(0.0, 1e6);
pub(super) const DELAY_SAMPLES: Range = Range::new(0.0, 1e4);

/// Of contacts.
pub(super) const FRICTION: Range = Range::new(0.0, 1e3);
pub(super) const SOME_FRICTION: Range = Range::new(1e-6, 1e3);
pub(super) const RESTITUTION: Range = Range::new(0.0, 1.0);
pub(super) const REST_SPEED_M_S: Range = Range::new(0.0, 1e3);
pub(super) const DRIFT_RATE_PER_S: Range = Range::new(0.0, 1e4);

/// Of pushes.
pub(super) const PLACE_M: Range = Range::new(-1e3, 1e3);
pub(super) const SHOVE: Range = Range::new(-1e9, 1e9);
pub(super) const SHOVE_S: Range = Range::new(1e-6, 1e5);

/// Of the integrator.
pub(super) const RELATIVE: Range = Range::new(1e-14, 0.1);
pub(super) const ABSOLUTE: Range = Range::new(1e-18, 1.0);

/// Of time stepping.
pub(super) const SHARE: Range = Range::new(0.0, 1.0);
pub(super) const CORRECTIONS: Range = Range::new(0.0, 10.0);
pub(super) const REACH_M: Range = Range::new(0.0, 1e3);
pub(super) const SWEEPS: Range = Range::new(1.0, 1e5);
pub(super) const RESPONSE_M_S: Range = Range::new(1e-14, 1.0);
pub(super) const FACETS: Range = Range::new(4.0, 64.0);

/// Limits of a run, and what audits tolerate.
pub(super) const EVENTS: Range = Range::new(0.0, 1e6);
pub(super) const EVALUATIONS: Range = Range::new(0.0, 1e10);
pub(super) const TOLERANCE: Range = Range::new(1e-18, 1e18);
/// A seed is any number that a computer counts to.
pub(super) const SEED: Range = Range::new(0.0, u64::MAX as f64);

/// Of references.
pub(super) const PART_S: Range = Range::new(1e-6, 1e5);
pub(super) const FREQUENCY_RAD_S: Range = Range::new(1e-6, 1e6);
