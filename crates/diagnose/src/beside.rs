//! What effects that were found change for other laws: a body hangs otherwise on a base that is
//! tilted, and what a drive gives is logged through its gain.
//!
//! Laws that move the model stand one behind the other (`RobotEffect::torques`), so that together
//! they add what they do at once. What is scaled in a log is scaled of every law, and the gain
//! itself is of the model alone.

use super::candidate::Candidate;
use super::data::{ModelTorques, rates};
use super::law::Response;
use super::nominal::Nominal;
use super::rows::PerJoint;
use super::signals::Signals;
use super::state::Effects;
use denavit_measure::JointIndex;
use denavit_plants::effect::Moves;

/// What a law is beside.
#[derive(Clone, Debug)]
pub(super) struct Beside {
    /// Gravity and zeros of joints.
    pub(super) moves: Moves,
    /// What effects add to the torques of rigid bodies; none where nothing does [N m, N].
    pub(super) loads: PerJoint,
    /// For each joint what its torque is multiplied by in its log; none where it is not.
    pub(super) factors: Vec<Option<Vec<f64>>>,
}

impl Beside {
    /// Nothing.
    pub(super) fn nothing(joints: usize) -> Self {
        Self { moves: Moves::none(joints), loads: Vec::new(), factors: vec![None; joints] }
    }

    /// Whether it changes nothing of what a function of the motion does.
    pub(super) fn is_nothing_to(&self, candidate: &Candidate) -> bool {
        let is_turned = self.moves != Moves::none(self.factors.len());
        self.factors.iter().all(Option::is_none) && !(candidate.is_body && is_turned)
    }

    /// What a law adds as it is logged.
    pub(super) fn logged(&self, response: &mut Response) {
        for (place, equation) in response.equations.iter().enumerate() {
            let Some(Some(factor)) = self.factors.get(*equation) else { continue };
            let columns = response.gradient.iter_mut().map(|all| &mut all[place]);
            for column in columns.chain([&mut response.torque[place]]) {
                column.iter_mut().zip(factor).for_each(|(row, factor)| *row *= factor);
            }
        }
    }
}

impl ModelTorques {
    /// The same beside effects.
    pub(super) fn beside(
        mut self,
        nominal: &Nominal<'_>,
        signals: &Signals,
        Effects { candidates, taken }: Effects<'_>,
    ) -> Self {
        let laws = || taken.iter().map(|one| (&candidates[one.candidate].law, &one.values));
        let moves: Vec<Moves> =
            laws().filter_map(|(law, values)| law.moves(values, &self.numbers)).collect();
        for own in &moves {
            let all = self.beside.moves.gravity.iter_mut().chain(&mut self.beside.moves.zeros);
            all.zip(own.gravity.iter().chain(&own.zeros)).for_each(|(sum, more)| *sum += more);
        }
        let motion = self.motion(nominal, signals);
        let loads =
            laws().filter(|(law, values)| law.moves(values, &motion.torques.numbers).is_some());
        let loads: Vec<PerJoint> =
            loads.map(|(law, values)| law.torque(motion, values).torque).collect();
        let factors: Vec<(JointIndex, Vec<f64>)> =
            laws().filter_map(|(law, values)| law.factor(motion, values)).collect();
        for more in loads {
            self.beside.loads.resize(self.load.len(), vec![0.0; signals.samples()]);
            let all = self.beside.loads.iter_mut().zip(&mut self.load).zip(more);
            for ((sum, load), more) in all {
                let both = sum.iter_mut().zip(load).zip(more);
                both.for_each(|((sum, load), more)| (*sum, *load) = (*sum + more, *load + more));
            }
        }
        if !self.beside.loads.is_empty() {
            self.load_rate = rates(&self.load, signals);
        }
        for (joint, own) in factors {
            let all = self.beside.factors[joint.0].get_or_insert_with(|| vec![1.0; own.len()]);
            all.iter_mut().zip(own).for_each(|(all, own)| *all *= own);
        }
        self
    }
}
