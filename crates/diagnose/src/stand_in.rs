//! Effects that stand for something without a name at another joint.
//!
//! What acts at one joint and is in no catalogue moves numbers of the model that act there, too,
//! and effects of other joints put right what these numbers spoil. So where more than noise is left
//! at a joint, effects of the others are held against a function without a name: a polynomial of
//! third degree of its position and velocity, which may change in time. What is not asked for
//! beside that stands for it.

use super::data::{Data, RowResponse};
use super::effects_found::FoundEffect;
use super::hypothesis::Hypothesis;
use super::leftover::Leftover;
use super::search::Search;
use super::signals::Signals;
use super::weighing::Weighing;
use denavit_evidence::{Terms, policy};
use denavit_measure::JointIndex;

impl Search<'_> {
    /// Says of each effect at which joint a function without a name does what it is there for, if
    /// there is one.
    pub(super) fn tell_stand_ins(
        &self,
        found: &Hypothesis,
        leftovers: &[Leftover],
        effects: &mut [FoundEffect],
    ) {
        let nominal = self.weighing.sets[0].nominal;
        let joints = nominal.model.joints.len();
        let is_left = |one: &&Leftover| one.share > policy::LEFT && one.equation < joints;
        for joint in leftovers.iter().filter(is_left).map(|one| JointIndex(one.equation)) {
            let unnamed = self.weighing.unnamed(joint);
            let evidence = |without: Option<usize>| {
                let kept = (0..found.parts.len()).filter(|place| Some(*place) != without);
                let terms = kept.map(|place| &found.parts[place].terms).chain([&unnamed]);
                let start = Some(found.weighed.variances.as_slice());
                let terms: Vec<&Terms> = terms.collect();
                self.weighing.base.weigh(&terms, start, policy::ROUNDS[1]).log_evidence
            };
            let all = evidence(None);
            if all - found.weighed.log_evidence + policy::RARE < policy::NAMED {
                continue;
            }
            for (place, part) in found.parts.iter().enumerate() {
                let is_elsewhere = self.candidate(found, place).joint != Some(joint);
                let odds = || all - evidence(Some(place)) + self.log_prior(part);
                if is_elsewhere && odds() < policy::NAMED {
                    effects[place].stands_for = Some(nominal.equation_name(joint.0));
                }
            }
        }
    }
}

impl Weighing<'_> {
    /// A function of a joint's motion and of time: each of its terms as large as effects are
    /// believed to be.
    fn unnamed(&self, joint: JointIndex) -> Terms {
        let all = || self.sets.iter().flat_map(|data| &data.signals);
        let largest =
            |of: &dyn Fn(&Signals) -> f64| all().map(of).fold(f64::MIN_POSITIVE, f64::max);
        let most = |values: &[f64]| values.iter().fold(0.0, |most: f64, one| most.max(one.abs()));
        let scale =
            [largest(&|log| most(&log.q[joint.0])), largest(&|log| most(log.of_drive(joint)[0]))];
        let of_set = |data: &&Data<'_>| {
            let mut response = RowResponse::default();
            for stretch in data.stretches.iter().filter(|one| one.equation == joint.0) {
                let columns = columns(&data.signals[stretch.log.0], joint, scale);
                response.stretches.push(*stretch);
                response.torque.push(vec![0.0; stretch.rows]);
                response.gradient.push(columns);
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

/// The degree of the polynomials of position and velocity.
const DEGREE: i32 = 3;

/// Products of powers of position and velocity, over what is largest of both, and the same times a
/// line in time: in the rows of a log.
fn columns(signals: &Signals, joint: JointIndex, scale: [f64; 2]) -> Vec<Vec<f64>> {
    let [velocity, _] = signals.of_drive(joint);
    let both = signals.q[joint.0].iter().zip(velocity);
    let both: Vec<[f64; 2]> = both.map(|(q, v)| [q / scale[0], v / scale[1]]).collect();
    let last = both.len().saturating_sub(1).max(1) as f64;
    let mut all = Vec::new();
    for of_q in 0..=DEGREE {
        for of_v in 0..=DEGREE - of_q {
            let product = |[q, v]: &[f64; 2]| q.powi(of_q) * v.powi(of_v);
            let column: Vec<f64> = both.iter().map(product).collect();
            let along = |(k, value): (usize, &f64)| value * (2.0 * k as f64 / last - 1.0);
            all.push(signals.rows_of(&column.iter().enumerate().map(along).collect::<Vec<_>>()));
            all.push(signals.rows_of(&column));
        }
    }
    all
}
