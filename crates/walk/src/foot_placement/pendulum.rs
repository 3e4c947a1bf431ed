//! The linear inverted pendulum along x and y, by its divergent component.

/// Centre of mass, and divergent component: centre of mass plus velocity over w \[m\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Pendulum {
    pub(super) center_m: [f64; 2],
    pub(super) divergent_m: [f64; 2],
}

impl Pendulum {
    /// After a time in which the centre of pressure stays at a place [1/s, s, m].
    pub(super) fn after(&self, omega: f64, time_s: f64, pressure_m: [f64; 2]) -> Self {
        let growth = (omega * time_s).exp();
        let mut after = Self::default();
        for axis in 0..2 {
            let place = pressure_m[axis];
            // x - p = growing e^(wt) + decaying e^(-wt), of which the component has twice the first
            let growing = 0.5 * (self.divergent_m[axis] - place);
            let decaying = self.center_m[axis] - place - growing;
            after.divergent_m[axis] = place + 2.0 * growing * growth;
            after.center_m[axis] = place + growing * growth + decaying / growth;
        }
        after
    }

    /// A share of the way to another one.
    pub(super) fn towards(&self, other: &Self, share: f64) -> Self {
        let between = |from: [f64; 2], to: [f64; 2]| {
            [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
        };
        Self {
            center_m: between(self.center_m, other.center_m),
            divergent_m: between(self.divergent_m, other.divergent_m),
        }
    }
}
