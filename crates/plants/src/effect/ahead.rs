//! A drive ahead of its joint, where the position of the joint is logged.
//!
//! What the joint takes its motion tells, and that the sides of a transmission pass on. While they
//! touch, the drive is ahead by what that asks of them:
//!
//! ```text
//! s = half the play, to the side that pushes, + x,   k x + d x' = passed.
//! ```
//!
//! Where nothing passes it is alone, between two touches whose times are known:
//!
//! ```text
//! I (q + s)'' = tau - off - fv (q + s)' - fc sgn((q + s)') - c s' + I a,
//! ```
//!
//! with a constant a that brings it where it touches next, so that errors of friction do not add
//! up.

use super::transmission::SHORTEST_S;
use super::{Drive, GivesWay};

/// What a drive ahead of its joint goes by, at equal distances.
#[derive(Clone, Copy, Debug)]
pub struct Passing<'s> {
    /// The distance of samples \[s\].
    pub step_s: f64,
    /// Velocities of the joint [rad/s, m/s].
    pub qd: &'s [f64],
    /// The torque of the drive [N m, N].
    pub tau: &'s [f64],
    /// What the joint takes [N m, N]: what is fast, for the sides, and what bends them.
    pub passed: [&'s [f64]; 2],
    /// The least of it that is told from nothing [N m, N].
    pub least: f64,
    /// The share of an impact that the filter of the positions may ring with beside it.
    pub ringing: f64,
    /// How long it does \[s\].
    pub ringing_s: f64,
}

/// Steps in time of a drive that is alone, to a sample, and times that its end is looked at.
const STEPS: usize = 4;
const ROUNDS: usize = 2;

impl GivesWay {
    /// How far a drive is ahead of its joint at each sample [rad, m].
    pub fn ahead(&self, drive: Drive, passing: &Passing<'_>) -> Vec<f64> {
        let swing_s = self.swing_s.max(SHORTEST_S);
        let stiffness = drive.inertia / (swing_s * swing_s);
        let lag = 2.0 * self.damping * swing_s / passing.step_s;
        if self.play <= 0.0 {
            return deflections(passing.passed[1], stiffness, lag);
        }
        let mut ahead = deflections(&passing.bending(), stiffness, lag);
        let sides = passing.sides();
        let both = ahead.iter_mut().zip(&sides);
        both.for_each(|(ahead, side)| *ahead += 0.5 * self.play * side);
        let mut touch = None;
        for next in (0..sides.len()).filter(|&k| sides[k] != 0.0) {
            match touch {
                None => {
                    let stays = ahead[next];
                    ahead[..next].fill(stays);
                }
                Some(last) if last + 1 < next => {
                    passing.fly((drive, self.drag), &mut ahead, [last, next])
                }
                Some(_) => {}
            }
            touch = Some(next);
        }
        if let Some(last) = touch {
            let stays = ahead[last];
            ahead[last + 1..].fill(stays);
        }
        ahead
    }
}

impl Passing<'_> {
    /// What bends the sides: what is slow, and of the rest what is no noise.
    fn bending(&self) -> Vec<f64> {
        let ([passed, slow], least) = (self.passed, self.least);
        let both = passed.iter().zip(slow).map(|(passed, slow)| (slow, passed - slow));
        both.map(|(slow, fast)| slow + fast - fast.clamp(-least, least)).collect()
    }

    /// The side on which a drive pushes at each sample; 0 where nothing passes: too little, or no
    /// more than an impact nearby makes the filter ring, unless it pushes on before and after.
    fn sides(&self) -> Vec<f64> {
        let ([passed, _], least) = (self.passed, self.least);
        let reach = (self.ringing_s / self.step_s).round() as usize;
        let side = |(k, torque): (usize, &f64)| {
            let near = &passed[k.saturating_sub(reach)..(k + reach + 1).min(passed.len())];
            let most = near.iter().fold(0.0, |most: f64, torque| most.max(torque.abs()));
            if torque.abs() > least.max(self.ringing * most) { torque.signum() } else { 0.0 }
        };
        let mut sides: Vec<f64> = passed.iter().enumerate().map(side).collect();
        let mut last = 0;
        for next in 1..sides.len() {
            if sides[next] == 0.0 {
                continue;
            }
            let pushes = |torque: &f64| torque * sides[next] > least;
            if sides[last] == sides[next] && passed[last + 1..next].iter().all(pushes) {
                let side = sides[next];
                sides[last..next].fill(side);
            }
            last = next;
        }
        sides
    }

    /// Moves a drive that is alone between two touches.
    fn fly(&self, drive: (Drive, f64), ahead: &mut [f64], [from, to]: [usize; 2]) {
        let (start, end) = (ahead[from], ahead[to]);
        let faster = start - ahead[from.saturating_sub(1)];
        let count = (to - from) as f64;
        let mut way = vec![start; to - from + 1];
        let mut pull = 0.0;
        for _ in 0..ROUNDS {
            self.alone(drive, [faster / self.step_s, pull], &mut way, from);
            pull += 2.0 * (end - way[to - from]) / (count * self.step_s).powi(2);
        }
        let miss = end - way[to - from];
        for (k, (ahead, way)) in ahead[from..=to].iter_mut().zip(way).enumerate() {
            *ahead = way + miss * (k as f64 / count).powi(2);
        }
    }

    /// The way of a drive with a drag that is alone from a sample on, with how much faster it is
    /// there than its joint and a further acceleration: by steps, with friction that holds it where
    /// it stops.
    fn alone(
        &self,
        (drive, drag): (Drive, f64),
        [faster, pull]: [f64; 2],
        way: &mut [f64],
        first: usize,
    ) {
        let h = self.step_s / STEPS as f64;
        let gained = h / drive.inertia;
        // an estimate may be below 0, and friction pushes nothing
        let most = (gained * drive.coulomb).max(0.0);
        let (mut ahead, mut faster) = (way[0], faster);
        for (k, place) in (first..).zip(&mut way[1..]) {
            for step in 0..STEPS {
                let at = |signal: &[f64], u: f64| signal[k] + u * (signal[k + 1] - signal[k]);
                let [u, next] = [step, step + 1].map(|step| step as f64 / STEPS as f64);
                let rate = at(self.qd, u) + faster;
                let torque = at(self.tau, u) - drive.offset - drive.viscous * rate;
                let free = rate + gained * torque - h * drag * faster;
                faster = free - free.clamp(-most, most) + h * pull - at(self.qd, next);
                ahead += h * faster;
            }
            *place = ahead;
        }
    }
}

/// How far a spring gives way under a load, with a damper that lags by so many samples.
fn deflections(load: &[f64], stiffness: f64, lag: f64) -> Vec<f64> {
    let kept = if lag > 0.0 { (-lag.recip()).exp() } else { 0.0 };
    let mut ahead = load.first().map_or(0.0, |load| load / stiffness);
    let mut before = ahead;
    let of = |load: &f64| {
        let now = load / stiffness;
        // The load is straight between samples.
        let slope = now - before;
        ahead = now - lag * slope + kept * (ahead - before + lag * slope);
        before = now;
        ahead
    };
    load.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP_S: f64 = 0.001;
    const INERTIA: f64 = 0.05;
    const GAP: f64 = 0.02;

    /// Samples in which a drive crosses the gap from rest by a torque of 1: sqrt(2 gap I).
    fn crosses() -> usize {
        ((2.0 * GAP * INERTIA).sqrt() / STEP_S).round() as usize
    }

    /// Where a drive is whose joint stands, and whose torque of 1 turns around after 0.2 s: all of
    /// it passes, but for the time in which it crosses the gap.
    fn crossed(drive: Drive) -> Vec<f64> {
        let tau: Vec<f64> = (0..500).map(|k| if k < 200 { 1.0 } else { -1.0 }).collect();
        let mut passed = tau.clone();
        passed[200..200 + crosses()].fill(0.0);
        // the filter rings before the impact
        passed[195 + crosses()] = 0.2;
        ahead(drive, &passed, &tau)
    }

    fn ahead(drive: Drive, passed: &[f64], tau: &[f64]) -> Vec<f64> {
        let (qd, passed) = (vec![0.0; tau.len()], [passed, tau]);
        let (step_s, least) = (STEP_S, 0.05);
        let (ringing, ringing_s) = (0.3, 0.01);
        let passing = Passing { step_s, qd: &qd, tau, passed, least, ringing, ringing_s };
        let way =
            GivesWay { swing_s: 0.0, play: GAP, damping: 0.0, drag: 0.0, joint_friction: 0.0 };
        way.ahead(drive, &passing)
    }

    #[test]
    fn a_drive_is_at_one_side_then_falls_to_the_other() {
        let found = crossed(Drive { inertia: INERTIA, ..Drive::default() });
        let touches = 0.5 * GAP + SHORTEST_S * SHORTEST_S / INERTIA;
        assert!((found[100] - touches).abs() < 1e-9 && (found[400] + touches).abs() < 1e-9);
        for (k, found) in found[200..200 + crosses()].iter().enumerate() {
            let t = STEP_S * (k + 1) as f64;
            let exact = touches - 0.5 * t * t / INERTIA;
            // a step of time is 0.045 of the gap where it touches
            assert!((found - exact).abs() < 0.05 * GAP, "{t}: {found} is not {exact}");
        }
    }

    #[test]
    fn what_is_wrong_of_a_drive_does_not_move_its_touches() {
        let right = Drive { inertia: INERTIA, ..Drive::default() };
        let wrong = Drive { inertia: 1.1 * INERTIA, coulomb: 0.2, offset: 0.1, ..right };
        let [right, wrong] = [right, wrong].map(crossed);
        for (k, (right, wrong)) in right.iter().zip(&wrong).enumerate() {
            assert!((right - wrong).abs() < 0.05 * GAP, "{k}: {right} {wrong}");
        }
    }

    #[test]
    fn a_side_that_pushes_before_and_after_an_impact_pushes_beside_it() {
        let mut tau = vec![1.0; 200];
        tau[100] = 10.0;
        let drive = Drive { inertia: INERTIA, ..Drive::default() };
        for (k, ahead) in ahead(drive, &tau, &tau).iter().enumerate() {
            let exact = 0.5 * GAP + tau[k] * SHORTEST_S * SHORTEST_S / INERTIA;
            assert!((ahead - exact).abs() < 1e-9, "{k}: {ahead} is not {exact}");
        }
    }

    #[test]
    fn a_spring_with_a_damper_follows_a_straight_load_late() {
        let load: Vec<f64> = (0..200).map(f64::from).collect();
        let ahead = deflections(&load, 50.0, 4.0);
        // k s + d s' = load: late by d / k, after that is forgotten.
        assert!((ahead[199] - (199.0 - 4.0) / 50.0).abs() < 1e-12, "{}", ahead[199]);
        assert_eq!(deflections(&load, 50.0, 0.0)[199], 199.0 / 50.0);
    }
}
