//! Effects that stand for something without a name.
//!
//! What is in no catalogue is like a few effects together: sin(3 q) qd^2 is like an eccentric
//! encoder with an offset. And it moves numbers of the model that act at its joint, so that effects
//! of other joints put right what these numbers spoil. So effects are held against functions
//! without a name: where the logs ask for one beside all effects, those that nothing asks for
//! beside it stand for it.

use super::effects_found::FoundEffect;
use super::hypothesis::Hypothesis;
use super::leftover::Leftover;
use super::search::Search;
use denavit_evidence::{Terms, policy};
use denavit_measure::JointIndex;

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
