//! What a robot on feet can do: its height, its sole, how fast and how far it steps.

use crate::error::Error;

/// The linear inverted pendulum of a robot, and its steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimits {
    /// Acceleration of free fall [m/s^2].
    pub gravity_m_s2: f64,
    /// Height of the centre of mass above the ground \[m\].
    pub height_m: f64,
    /// From the ankle backward to the end of the sole \[m\].
    pub heel_m: f64,
    /// From the ankle forward to the end of the sole \[m\].
    pub toe_m: f64,
    /// The least time from the landing of a foot, or the push, to the next landing \[s\].
    pub step_s: f64,
    /// The longest step, from ankle to ankle: backward, forward \[m\].
    pub longest_m: [f64; 2],
}

impl StepLimits {
    /// Checks that all are finite, height, gravity and step time positive, lengths not negative.
    ///
    /// # Errors
    /// The first that is not.
    pub fn check(&self) -> Result<(), Error> {
        let [back, forward] = self.longest_m;
        let positive = [
            ("acceleration of free fall", self.gravity_m_s2),
            ("height of the centre of mass", self.height_m),
            ("least step time", self.step_s),
        ];
        let lengths = [
            ("length of the heel", self.heel_m),
            ("length of the toe", self.toe_m),
            ("longest step backward", back),
            ("longest step forward", forward),
        ];
        for (name, value) in positive {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::limit(name, value));
            }
        }
        for (name, value) in lengths {
            if !(value >= 0.0 && value.is_finite()) {
                return Err(Error::limit(name, value));
            }
        }
        Ok(())
    }

    /// w = sqrt(g / z) \[1/s\].
    pub fn omega(&self) -> f64 {
        (self.gravity_m_s2 / self.height_m).sqrt()
    }

    /// The share of a distance that was there a step time earlier: e^(-w T).
    pub fn decay(&self) -> f64 {
        (-self.omega() * self.step_s).exp()
    }

    /// The sole, forward from the ankle \[m\].
    pub fn sole_m(&self) -> [f64; 2] {
        [-self.heel_m, self.toe_m]
    }
}
