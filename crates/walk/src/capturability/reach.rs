//! The capture points from which N steps are enough.
//!
//! Without a step the capture point must be over the sole, [-heel, toe]. With a step at the time T,
//! the centre of pressure at the toe, where it slows the fall most, and the foot as far forward as
//! it goes, a capture point c ahead of the toe becomes
//!
//! > toe + (c - toe) e^(w T) - l,
//!
//! which has to be no more than d_(N-1). So, forward, and backward with heel and the longest step
//! backward in the places of toe and l,
//!
//! > d_0 = toe,  d_N = toe + (l + d_(N-1) - toe) e^(-w T),
//! > d_oo = toe + l e^(-w T) / (1 - e^(-w T)).
//!
//! With heel = toe these are Koolen's d_N, whose lengths are in units of z and times of 1/w.

use super::limits::StepLimits;
use crate::error::Error;

/// How many steps a capture point needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Steps {
    /// So many, and no fewer.
    Least(usize),
    /// It cannot be captured, however many.
    Falls,
}

/// The capture points from which N steps are enough, for every N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capturability {
    limits: StepLimits,
}

/// More steps are as good as any number: the last ones gain less than rounding.
const MOST_STEPS: usize = 10_000;

impl Capturability {
    /// Of a robot.
    ///
    /// # Errors
    /// Limits that are not usable.
    pub fn new(limits: StepLimits) -> Result<Self, Error> {
        limits.check()?;
        Ok(Self { limits })
    }

    /// What the robot can do.
    pub fn limits(&self) -> &StepLimits {
        &self.limits
    }

    /// The capture points from which at most N steps are enough, forward from the ankle that
    /// stands: from -d_N backward to d_N forward \[m\].
    pub fn reach_m(&self, steps: usize) -> [f64; 2] {
        let decay = self.limits.decay();
        // the geometric sum of N terms
        let sum = decay * (1.0 - decay.powf(steps as f64)) / (1.0 - decay);
        self.ends_m(sum)
    }

    /// The same for any number of steps: the limit, which no number reaches \[m\].
    pub fn limit_m(&self) -> [f64; 2] {
        let decay = self.limits.decay();
        self.ends_m(decay / (1.0 - decay))
    }

    fn ends_m(&self, sum: f64) -> [f64; 2] {
        let [heel, toe] = self.limits.sole_m();
        let [back, forward] = self.limits.longest_m;
        [heel - back * sum, toe + forward * sum]
    }

    /// The least number of steps from a capture point, forward from the ankle that stands \[m\].
    pub fn steps(&self, capture_m: f64) -> Steps {
        let holds = |[low, high]: [f64; 2]| (low..=high).contains(&capture_m);
        if !holds(self.limit_m()) {
            return Steps::Falls;
        }
        let found = (0..MOST_STEPS).find(|steps| holds(self.reach_m(*steps)));
        found.map_or(Steps::Falls, Steps::Least)
    }
}
