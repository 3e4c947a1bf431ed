//! Effects that stand for something without a name.
//!
//! What is in no catalogue is like a few effects together: sin(3 q) qd^2 is like an eccentric
//! encoder with an offset. And it moves numbers of the model that act at its joint, so that effects
//! of other joints put right what these numbers spoil. So effects are held against functions
//! without a name: where the logs ask for one beside all effects, those that nothing asks for
//! beside it stand for it.

use super::data::{Data, RowResponse};
use super::effects_found::FoundEffect;
use super::hypothesis::Hypothesis;
use super::leftover::Leftover;
use super::search::Search;
use super::signals::Signals;
use super::weighing::{Weighing, range};
use denavit_evidence::{Terms, policy};
use denavit_measure::JointIndex;
use std::f64::consts::PI;

impl Search<'_> {
    /// Says of each effect at which joint a function without a name does what it is there for, if
    /// there is one: at its own joint, or at one that has more left than noise.
    pub(super) fn tell_stand_ins(
        &self,
        found: &Hypothesis,
        leftovers: &[Leftover],
        effects: &mut [FoundEffect],
    ) {
        let nominal = self.weighing.sets[0].nominal;
        let at = |place: usize| self.candidate(found, place).joint;
        for joint in (0..nominal.model.joints.len()).map(JointIndex) {
            let is_left = leftovers[joint.0].share > policy::LEFT;
            let is_asked = |place: &usize| is_left || at(*place) == Some(joint);
            let places: Vec<usize> = (0..found.parts.len()).filter(is_asked).collect();
            let unnamed = if places.is_empty() { Vec::new() } else { self.weighing.unnamed(joint) };
            for one in &unnamed {
                for &place in &self.stand_ins(found, one, &places) {
                    effects[place].stands_for = Some(nominal.equation_name(joint.0));
                }
            }
        }
    }

    /// Those of some effects that nothing asks for beside a function without a name, if the logs
    /// ask for that: the one that is asked for least, then of the others, and so on.
    fn stand_ins(&self, found: &Hypothesis, unnamed: &Terms, places: &[usize]) -> Vec<usize> {
        let evidence = |without: &[usize]| {
            let kept = (0..found.parts.len()).filter(|place| !without.contains(place));
            let terms = kept.map(|place| &found.parts[place].terms).chain([unnamed]);
            let start = Some(found.weighed.variances.as_slice());
            let terms: Vec<&Terms> = terms.collect();
            self.weighing.base.weigh(&terms, start, policy::ROUNDS[1]).log_evidence
        };
        let (mut all, mut without) = (evidence(&[]), Vec::new());
        if all - found.weighed.log_evidence + policy::RARE < policy::NAMED {
            return without;
        }
        loop {
            let rest = places.iter().copied().filter(|place| !without.contains(place));
            let less = rest.map(|place| (evidence(&[&without[..], &[place]].concat()), place));
            let odds = |(evidence, place): &(f64, usize)| {
                all - evidence + self.log_prior(&found.parts[*place])
            };
            let least = less.min_by(|a, b| odds(a).total_cmp(&odds(b)));
            let Some(least) = least.filter(|one| odds(one) < policy::NAMED) else { return without };
            all = least.0;
            without.push(least.1);
        }
    }
}

impl Weighing<'_> {
    /// Functions of a joint's motion that have no name: of its position, times powers of its
    /// velocity; of its position and that of another joint; and of its motion and of time. What
    /// every drive has is in none of them.
    fn unnamed(&self, joint: JointIndex) -> Vec<Terms> {
        let along = |log: &Signals, of: JointIndex| -> Vec<f64> {
            let [low, high] = range(&self.sets, of);
            let width = (high - low).max(f64::MIN_POSITIVE);
            log.q[of.0].iter().map(|q| PI * (q - low) / width).collect()
        };
        let of_position = OF_VELOCITY.iter().map(|(least, factor)| {
            self.free(joint, &|log| {
                let [velocity, _] = log.of_drive(joint);
                let both = || along(log, joint).into_iter().zip(velocity);
                let wave = |k: usize| both().map(move |(x, v)| (k as f64 * x).cos() * factor(*v));
                (*least..WAVES[0]).map(|k| wave(k).collect()).collect()
            })
        });
        let others = (0..self.sets[0].nominal.model.joints.len()).filter(|one| *one != joint.0);
        let of_two = others.map(|other| {
            self.free(joint, &|log| {
                let [own, other] = [joint, JointIndex(other)].map(|of| along(log, of));
                let waves = (1..WAVES[1] * WAVES[1]).map(|k| [k / WAVES[1], k % WAVES[1]]);
                let wave = |[a, b]: [usize; 2]| {
                    let both = own.iter().zip(&other);
                    both.map(|(x, y)| (a as f64 * x).cos() * (b as f64 * y).cos()).collect()
                };
                waves.map(wave).collect()
            })
        });
        let of_time = self.free(joint, &|log| in_time(log, joint));
        of_position.chain(of_two).chain([of_time]).collect()
    }

    /// Columns of a joint, each as large as effects are believed to be.
    fn free(&self, joint: JointIndex, columns: &dyn Fn(&Signals) -> Vec<Vec<f64>>) -> Terms {
        let of_set = |data: &&Data<'_>| {
            let mut response = RowResponse::default();
            for stretch in data.stretches.iter().filter(|one| one.equation == joint.0) {
                let log = &data.signals[stretch.log.0];
                let columns = columns(log);
                let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
                response.stretches.push(*stretch);
                response.torque.push(vec![0.0; stretch.rows]);
                response.gradient.push(log.all_rows_of(&columns));
            }
            response
        };
        let responses: Vec<RowResponse> = self.sets.iter().map(of_set).collect();
        let (_, mut columns) = self.spectra.of_response(&self.sets, &responses, f64::INFINITY);
        for column in &mut columns {
            let share = self.spectra.largest_share(column);
            let factor = if share > 0.0 { policy::SIZE / share } else { 0.0 };
            column.iter_mut().flatten().for_each(|row| *row *= factor);
        }
        Terms::free(columns)
    }
}

/// Waves of one position, and of each of two.
const WAVES: [usize; 2] = [12, 4];

/// What functions of the position are multiplied by, and their first wave: the constant is what
/// every drive has, if it is 1.
const OF_VELOCITY: [(usize, fn(f64) -> f64); 5] =
    [(1, |_| 1.0), (1, |v| v), (1, f64::signum), (0, |v| v * v), (0, |v| v * v.abs())];

/// The degree of the polynomials of position and velocity.
const DEGREE: i32 = 3;

/// Products of powers of position and velocity, and the same times a line in time.
fn in_time(log: &Signals, joint: JointIndex) -> Vec<Vec<f64>> {
    let [velocity, _] = log.of_drive(joint);
    let both = || log.q[joint.0].iter().zip(velocity);
    let last = both().len().saturating_sub(1).max(1) as f64;
    let mut all = Vec::new();
    for of_q in 0..=DEGREE {
        for of_v in 0..=DEGREE - of_q {
            let column: Vec<f64> = both().map(|(q, v)| q.powi(of_q) * v.powi(of_v)).collect();
            let along = |(k, value): (usize, &f64)| value * (2.0 * k as f64 / last - 1.0);
            all.push(column.iter().enumerate().map(along).collect());
            all.push(column);
        }
    }
    all
}
