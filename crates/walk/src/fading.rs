//! What is measured beside a plan, and how it fades: plans made during a run begin where the robot
//! is, and go over into what was planned without a jump.

/// A value with its velocity [m, m/s; rad, rad/s].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Moving {
    pub(crate) value: f64,
    pub(crate) rate: f64,
}

/// What is measured beside the plan fades so fast \[1/s\].
pub(crate) const FADES_PER_S: f64 = 15.0;

impl Moving {
    /// What is left of it after a time: it fades at a rate \[1/s\] with critical damping, so that a
    /// plan made on the way goes on alike.
    pub(crate) fn left(self, rate: f64, t_s: f64) -> f64 {
        (self.value + (self.rate + rate * self.value) * t_s) * (-rate * t_s).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is left after two times is what is left of what was left.
    #[test]
    fn plans_made_on_the_way_go_on_alike() {
        let (apart, rate) = (Moving { value: 0.3, rate: -1.7 }, 9.0);
        let h = 1e-5;
        let slope = (apart.left(rate, 0.2 + h) - apart.left(rate, 0.2 - h)) / (2.0 * h);
        let later = Moving { value: apart.left(rate, 0.2), rate: slope };
        assert!((later.left(rate, 0.1) - apart.left(rate, 0.3)).abs() < 1e-9);
        assert_eq!(apart.left(rate, 0.0), 0.3);
    }
}
