//! Where a drive rests between two motions.
//!
//! A drive that sticks is seen by its encoder as it is, and by a filter of positions as if it never
//! stopped. While it rests its friction is what the other torques leave to it. What they are goes
//! on when the drive stops, and its inertia needs no more of them: friction falls by that. Then it
//! grows to where the drive leaves, and is on no side for long. Rates of a rest therefore change
//! their sign all the time, so that a law of the sign has in the mean a torque that does the same.
//! What the drive does below a step of its encoder is not seen: for laws of sticking it creeps by a
//! step to where it moves next, as friction before sliding has it (Canudas de Wit, Olsson, Åström,
//! Lischinsky 1995).

use super::signals::Signals;
use std::ops::Range;

/// Samples of the shortest rest.
const LEAST: usize = 6;

/// Steps that a drive moves in the time of its rest, before and after it: a parabola moves by 8.
const LEAVES: f64 = 30.0;

/// What two readings of one place may differ by, in steps.
const SAME: f64 = 1.01;

/// The deviation of friction from the straight line between its sides in the middle of a rest, over
/// that of sliding.
const UNSURE: f64 = 0.4;

/// The power of time with which a drive leaves: 3 if its inertia is all that matters, 2 if what
/// opposes its rate is, or if friction falls when it leaves.
const POWER: f64 = 2.5;

/// Steps that a drive moves before a reading of it changes, in the mean.
const UNSEEN: f64 = 0.25;

/// A rest of a drive.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Rest {
    /// When it began and ended \[s\].
    pub(super) time_s: Range<f64>,
    /// The directions in which the drive came and leaves, 1 or -1.
    directions: [f64; 2],
    /// How much it was slowed down when it stopped [rad/s^2, m/s^2].
    slowed: f64,
    /// On which side its friction is when it has stopped, from -1 to 1.
    stopped: f64,
    /// How fast it would cover a step of its encoder meanwhile [rad/s, m/s].
    pub(super) creep: f64,
}

impl Rest {
    /// A rest that readings are the same in so many samples of, by the steps that the drive moves
    /// in as long before and after it, and how far from its rest the first and the last of them
    /// are.
    fn new(
        samples: Range<usize>,
        [moves, off]: [[f64; 2]; 2],
        step: f64,
        [start_s, step_s]: [f64; 2],
    ) -> Self {
        let count = samples.len() as f64;
        let [before, after] = moves.map(f64::abs);
        let [came, left] = off.map(|off| off.abs() + UNSEEN);
        let start = samples.start as f64 + count * (came / before).sqrt();
        let end = (samples.end - 1) as f64 - count * (left / after).powf(1.0 / POWER);
        let time_s = start_s + step_s * start..start_s + step_s * end.max(start + 1.0);
        let slowed = 2.0 * before * step / (count * step_s).powi(2);
        let creep = step / (time_s.end - time_s.start);
        Self { time_s, directions: moves.map(f64::signum), slowed, stopped: 0.0, creep }
    }

    /// Tells the inertia of the drive \[kg m^2, kg\] and its friction while it slides [N m, N].
    pub(super) fn settle(&mut self, inertia: f64, friction: f64) {
        let lost = inertia * self.slowed / friction;
        let stopped = self.directions[0] * (1.0 - lost);
        self.stopped = if friction > 0.0 { stopped.clamp(-1.0, 1.0) } else { 0.0 };
    }

    /// Its first among so many times.
    pub(super) fn first(&self, t: &[f64]) -> usize {
        within(t, &self.time_s).start
    }
}

/// The rests in positions as an encoder of a step gives them, the first at a time, and the others
/// at equal distances \[s\].
pub(super) fn rests(positions: &[f64], step: f64, times: [f64; 2]) -> Vec<Rest> {
    let mut found = Vec::new();
    let mut first = 0;
    while first < positions.len() {
        let is_same = |q: &&f64| (**q - positions[first]).abs() <= SAME * step;
        let count = positions[first..].iter().take_while(is_same).count();
        let end = first + count;
        let beside = first.checked_sub(count).zip(positions.get(end - 1 + count));
        if let (true, Some((before, after))) = (count >= LEAST, beside) {
            let moves = [positions[first] - positions[before], after - positions[end - 1]];
            let rest = positions[first + count / 2];
            let off = [positions[first] - rest, positions[end - 1] - rest];
            let [moves, off] = [moves, off].map(|both| both.map(|by| by / step));
            if moves.iter().all(|by| by.abs() > LEAVES) {
                found.push(Rest::new(first..end, [moves, off], step, times));
            }
        }
        first = if count >= LEAST { end } else { first + 1 };
    }
    found
}

impl Signals {
    /// Has the drive of a joint rest where it does.
    pub(super) fn rest(&mut self, joint: usize) {
        self.bend_rests(joint, 0.0);
    }

    /// The motion with other friction of drives at rest, by so many deviations; none where there
    /// are no rests.
    pub(super) fn with_rests_bent(&self, by: f64) -> Option<Self> {
        self.rests.iter().any(|rests| !rests.is_empty()).then(|| {
            let mut other = self.clone();
            (0..self.joints()).for_each(|joint| other.bend_rests(joint, by));
            other
        })
    }

    fn bend_rests(&mut self, joint: usize, by: f64) {
        let (t, rests) = (self.t.clone(), self.rests[joint].clone());
        alternate(self.drive_mut(joint)[0], &t, &rests, by);
    }

    /// The rests of a joint's drive.
    pub(super) fn rests_mut(&mut self, joint: usize) -> &mut [Rest] {
        &mut self.rests[joint]
    }

    /// Rates of a joint's drive that creeps where it rests, for laws of sticking [rad/s, m/s].
    pub(super) fn creeping(&self, joint: usize) -> Vec<f64> {
        let mut rates = self.of_drive(joint)[0].clone();
        for rest in &self.rests[joint] {
            rates[within(&self.t, &rest.time_s)].fill(rest.directions[1] * rest.creep);
        }
        rates
    }
}

/// Gives rates at times \[s\] of a drive that rests another sign at each sample, so that their mean
/// goes from where friction is when the drive has stopped to where it is when it leaves: straight,
/// or bent by so many deviations. As long before and after it the drive moves as it is seen to,
/// which a filter blurs.
fn alternate(rates: &mut [f64], t: &[f64], rests: &[Rest], bent: f64) {
    for rest in rests {
        let Rest { time_s: Range { start, end }, directions, stopped, creep, .. } = rest;
        let [came, leaves] = directions;
        let (bent, long) = (bent * UNSURE, end - start);
        for (from, to, direction) in [(start - long, *start, came), (*end, end + long, leaves)] {
            let moves = rates[within(t, &(from..to))].iter_mut();
            moves.for_each(|rate| *rate = direction * (direction * *rate).max(*creep));
        }
        let samples = within(t, &rest.time_s);
        let mut sum = 0.0;
        for (rate, t) in rates[samples.clone()].iter_mut().zip(&t[samples]) {
            let part = (t - start) / (end - start);
            let straight = stopped + (leaves - stopped) * part;
            sum += (straight + bent * 4.0 * part * (1.0 - part)).clamp(-1.0, 1.0);
            let sign = if sum < 0.0 { -1.0 } else { 1.0 };
            sum -= sign;
            *rate = sign * creep;
        }
    }
}

fn within(t: &[f64], time_s: &Range<f64>) -> Range<usize> {
    let at = |time_s: f64| t.partition_point(|t| *t < time_s);
    at(time_s.start)..at(time_s.end)
}

#[cfg(test)]
mod tests {
    use super::*;

    const STEP: f64 = 2e-5;

    fn read(position: impl Fn(f64) -> f64) -> Vec<f64> {
        (0..400).map(|k| (position(0.002 * f64::from(k)) / STEP).round() * STEP).collect()
    }

    /// It is slowed down until 0.3 s, rests until 0.4 s, and is moved back.
    fn back(t: f64) -> f64 {
        0.15 - (0.3 - t).max(0.0).powi(2) - 3.0 * (t - 0.4).max(0.0).powf(2.5)
    }

    #[test]
    fn a_drive_that_stops_rests_and_one_that_turns_around_does_not() {
        let [rest] = &rests(&read(back), STEP, [0.0, 0.002])[..] else { panic!("one rest") };
        assert!((rest.time_s.start - 0.3).abs() < 0.003 && (rest.time_s.end - 0.4).abs() < 0.003);
        assert!((rest.creep - STEP / 0.1).abs() < 0.1 * STEP / 0.1, "{rest:?}");
        assert_eq!(rest.directions, [1.0, -1.0]);
        assert_eq!(rests(&read(|t| 4.0 * (t - 0.4).powi(2)), STEP, [0.0, 0.002]), []);
        assert_eq!(rests(&read(|_| 0.2), STEP, [0.0, 0.002]), [], "it never moved");
    }

    /// A mass with friction that a controller moves back and forth: what its encoder reads every
    /// 2 ms, and its friction in steps of 10 us.
    fn controlled(mass: f64) -> (Vec<f64>, Vec<f64>) {
        let (mut position, mut rate, h) = (0.0_f64, 0.0_f64, 1e-5);
        let damping = 1.4 * (400.0 * mass).sqrt();
        let (mut read, mut frictions) = (Vec::new(), Vec::new());
        for k in 0..400_000 {
            let phase = 3.0 * h * f64::from(k);
            let ahead = 0.5 * phase.sin() - position;
            let push = 400.0 * ahead + damping * (1.5 * phase.cos() - rate);
            let side = if rate == 0.0 { push.signum() } else { rate.signum() };
            let friction = if rate == 0.0 && push.abs() <= 1.0 { push } else { side };
            let next = rate + h * (push - friction) / mass;
            rate = if next * rate < 0.0 { 0.0 } else { next };
            position += h * rate;
            frictions.push(friction);
            if k % 200 == 0 {
                read.push((position / STEP).round() * STEP);
            }
        }
        (read, frictions)
    }

    #[test]
    fn friction_at_rest_falls_by_what_slowed_the_drive_and_grows_to_the_other_side() {
        for mass in [0.02, 0.1] {
            let (read, frictions) = controlled(mass);
            let mut found = rests(&read, STEP, [0.0, 0.002]);
            assert!(found.len() >= 3, "{mass}: {}", found.len());
            found.iter_mut().for_each(|rest| rest.settle(mass, 1.0));
            let t: Vec<f64> = (0..40_000).map(|k| 1e-4 * f64::from(k)).collect();
            let mut rates = vec![0.0; t.len()];
            alternate(&mut rates, &t, &found, 0.0);
            for rest in &found {
                let Range { start, end } = rest.time_s;
                let mean = |from: f64, of: &dyn Fn(usize) -> f64, h: f64| {
                    let at = |part: f64| ((start + (end - start) * part) / h) as usize;
                    let all = at(from)..at(from + 0.1);
                    all.clone().map(of).sum::<f64>() / all.len() as f64
                };
                for part in [0.05, 0.25, 0.45, 0.65, 0.85] {
                    let seen = mean(part, &|k| rates[k].signum(), 1e-4);
                    let truth = mean(part, &|k| frictions[k], 1e-5);
                    assert!(
                        (seen - truth).abs() < UNSURE,
                        "{mass} {rest:?} {part}: {seen} {truth}"
                    );
                }
            }
        }
    }
}
