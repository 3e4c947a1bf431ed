//! The linear inverted pendulum with a centre of pressure that follows its capture point.

/// Centre of mass and capture point along x \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pendulum {
    pub(super) center_m: f64,
    pub(super) capture_m: f64,
}

/// How the centre of pressure is chosen: p = c + (c - target), so that c' = -w (c - target), inside
/// a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pressure {
    pub(super) omega: f64,
    pub(super) target_m: f64,
    pub(super) range_m: [f64; 2],
}

impl Pressure {
    /// Where the centre of pressure is for a capture point \[m\].
    fn place_m(&self, capture_m: f64) -> f64 {
        let [low, high] = self.range_m;
        (2.0 * capture_m - self.target_m).max(low).min(high)
    }
}

/// The centre of pressure stays for so long at most \[s\].
const HELD_S: f64 = 2e-3;

impl Pendulum {
    /// After a time \[s\], by exact steps in which the centre of pressure stays.
    pub(super) fn after(mut self, pressure: &Pressure, time_s: f64) -> Self {
        let count = (time_s / HELD_S).ceil().max(0.0);
        let growth = (pressure.omega * time_s / count.max(1.0)).exp();
        for _ in 0..count as usize {
            let place = pressure.place_m(self.capture_m);
            // x - p = growing e^(wt) + decaying e^(-wt), of which c - p is twice the first
            let growing = 0.5 * (self.capture_m - place);
            let decaying = self.center_m - place - growing;
            self.capture_m = place + 2.0 * growing * growth;
            self.center_m = place + growing * growth + decaying / growth;
        }
        self
    }
}
