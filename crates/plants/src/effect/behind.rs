//! A joint behind its drive, whose position is logged: where it is then.
//!
//! ```text
//! M s'' = load - c s' - k (s beyond the play),   logged = q + s
//! ```
//!
//! The joint is behind by s. M is the inertia of the bodies about it; k and c are over that inertia
//! where all joints are at 0, so that they do not change with the posture. Steps in time are
//! implicit, which damps what swings faster than they are.

use super::GivesWay;

impl GivesWay {
    /// How far a joint is behind its drive at each sample [rad, m]: at times `t` \[s\], under the
    /// load of its bodies [N m, N], with their inertia about it there and where all joints are at 0
    /// [kg m^2, kg]. None where nothing gives way.
    pub fn behind(
        &self,
        inertia_at_zero: f64,
        t: &[f64],
        load: &[f64],
        inertia: &[f64],
    ) -> Option<Vec<f64>> {
        Some(Gap::new(self, inertia_at_zero)?.along(t, load, inertia))
    }
}

/// What is between a drive and its joint.
struct Gap {
    /// Half the play [rad, m].
    half: f64,
    /// Of the sides [N m/rad, N/m].
    stiffness: f64,
    /// Between the sides [N m s/rad, N s/m].
    drag: f64,
}

/// The swing of sides that hardly give way \[s\]: faster than any filter of logs passes.
const SHORTEST_S: f64 = 1e-3;

impl Gap {
    /// None where nothing gives way.
    fn new(way: &GivesWay, inertia: f64) -> Option<Self> {
        let swing_s = way.swing_s.max(SHORTEST_S);
        let stiffness = inertia / (swing_s * swing_s);
        let gap = Self { half: 0.5 * way.play, stiffness, drag: way.drag * inertia };
        (way.play > 0.0 || way.swing_s > SHORTEST_S).then_some(gap)
    }

    /// How far the joint is behind its drive along loads, by implicit steps of first order [rad,
    /// m].
    fn along(&self, t: &[f64], load: &[f64], inertia: &[f64]) -> Vec<f64> {
        let mut before = load.first().map_or(0.0, |load| self.behind(*load, 0.0));
        let (mut velocity, mut time) = (0.0, t.first().copied().unwrap_or(0.0));
        let of = |((t, load), inertia): ((&f64, &f64), &f64)| {
            let step_s = t - time;
            if step_s <= 0.0 {
                return before;
            }
            let hz = step_s.recip();
            // all forces that grow with s alone, and their sum where s is 0
            let slope = (inertia * hz + self.drag) * hz;
            let sum = load + slope * before + inertia * hz * velocity;
            let now = self.behind(sum, slope);
            velocity = (now - before) * hz;
            (before, time) = (now, *t);
            now
        };
        t.iter().zip(load).zip(inertia).map(of).collect()
    }

    /// The deflection s of slope s + k (s beyond the play) = sum.
    fn behind(&self, sum: f64, slope: f64) -> f64 {
        let reached = slope * self.half;
        let beyond = (sum.abs() - reached).max(0.0) / (slope + self.stiffness);
        let within = if sum.abs() < reached { sum.abs() / slope } else { self.half };
        (within + beyond).copysign(sum)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const INERTIA: f64 = 0.08;

    fn gap(play: f64, swing_s: f64, drag: f64) -> Gap {
        let way = GivesWay { swing_s, play, damping: 0.0, drag, joint_friction: 0.0 };
        Gap::new(&way, INERTIA).expect("it gives way")
    }

    fn along(gap: &Gap, load: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let t: Vec<f64> = (0..600).map(|k| f64::from(k) * 1e-3 - 0.3).collect();
        let load: Vec<f64> = t.iter().map(|t| load(*t)).collect();
        let found = gap.along(&t, &load, &vec![INERTIA; t.len()]);
        t.into_iter().zip(found).collect()
    }

    #[test]
    fn a_joint_falls_through_its_gap() {
        let (half, slope) = (0.02, 5.0);
        let found = along(&gap(2.0 * half, 0.0, 0.0), |t| slope * t);
        // nothing is passed on in the gap: M s'' = slope t, from one side to the other
        let crosses_s = f64::cbrt(12.0 * INERTIA * half / slope);
        for (t, found) in found.iter().filter(|(t, _)| *t < crosses_s - 0.01) {
            let exact = -half + slope * t.max(0.0).powi(3) / (6.0 * INERTIA);
            // of first order: a step of time is 0.035 of half the play there
            assert!((found - exact).abs() < 0.04 * half, "{t}: {found}, not {exact}");
        }
        let (_, caught) = found.last().expect("samples");
        assert!((caught - half).abs() < 0.01 * half, "{caught}");
    }

    #[test]
    fn grease_lets_a_joint_sink_through_its_gap() {
        // M s'' + c s' = load from rest: after the start s' = load / c
        let (half, drag, load) = (0.5, 40.0, 2.0_f64);
        let found = along(&gap(2.0 * half, 0.0, drag), |t| f64::copysign(load, t));
        let speed = load / (drag * INERTIA);
        for (t, found) in found.iter().filter(|(t, s)| *t > 0.0 && *s < half - 0.01) {
            let start = (1.0 - (-drag * t).exp()) / drag;
            let exact = -half + speed * (t - start);
            assert!((found - exact).abs() < 0.01 * half, "{t}: {found}, not {exact}");
        }
    }

    #[test]
    fn a_side_gives_way_in_proportion_to_a_slow_load() {
        let (half, swing_s) = (0.01, 0.02);
        let drag = 100.0;
        let gap = gap(2.0 * half, swing_s, drag);
        let compliance = swing_s * swing_s / INERTIA;
        let (_, found) = *along(&gap, |t| 3.0 + t).last().expect("samples");
        // late by c / k
        let load = 3.299 - drag * swing_s * swing_s;
        assert!((found - half - compliance * load).abs() < 0.01 * compliance, "{found}");
    }
}
