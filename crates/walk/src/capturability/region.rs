//! Where the other foot may land, so that so many steps are enough.

use super::reach::Capturability;

/// Places of the other ankle at one time of landing, forward from the ankle that stands \[m\].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CaptureRegion {
    /// When the foot lands, after the push or the last landing \[s\].
    pub landing_s: f64,
    /// The steps that are enough in all, this one with them.
    pub steps: usize,
    /// From the rearmost place to the foremost \[m\].
    pub places_m: [f64; 2],
}

impl Capturability {
    /// Where the other foot may land at a time, so that `steps` are enough, this one with them;
    /// none if there is no such place, before the least step time, or for no steps.
    ///
    /// The centre of pressure takes the capture point at that time anywhere between
    /// toe + (c - toe) e^(wt) and -heel + (c + heel) e^(wt). From the foot that has landed, which
    /// is no farther than the longest step, N - 1 steps must be enough.
    pub fn region(&self, capture_m: f64, landing_s: f64, steps: usize) -> Option<CaptureRegion> {
        let limits = self.limits();
        let after = steps.checked_sub(1)?;
        if landing_s < limits.step_s {
            return None;
        }
        let growth = (limits.omega() * landing_s).exp();
        let [heel, toe] = limits.sole_m();
        let [back, forward] = self.reach_m(after);
        let low = toe + (capture_m - toe) * growth - forward;
        let high = heel + (capture_m - heel) * growth - back;
        let [longest_back, longest_forward] = limits.longest_m;
        let places_m = [low.max(-longest_back), high.min(longest_forward)];
        let [low, high] = places_m;
        (low <= high).then_some(CaptureRegion { landing_s, steps, places_m })
    }
}
