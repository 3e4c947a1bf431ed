//! What an effect adds to measured torques, over the quantity that it depends on most: to be looked
//! at, never to decide.

use super::state::{Setting, State, Taken};
use denavit_numerics::variance;

/// What a law is drawn over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Velocity of the joint.
    Velocity,
    /// Position of the joint.
    Position,
    /// The torque of rigid bodies at the joint.
    Load,
    /// Acceleration of the joint.
    Acceleration,
    /// Time of the log.
    Time,
}

impl Quantity {
    /// All of them, the first of several that do as well first.
    const ALL: [Self; 5] =
        [Self::Velocity, Self::Position, Self::Load, Self::Acceleration, Self::Time];
}

/// An effect over what it depends on, in the rows of held-out logs: where it acts most.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCurve {
    /// The joint, or its spring.
    pub at: String,
    /// Whether the joint slides.
    pub slides: bool,
    /// What it is drawn over.
    pub over: Quantity,
    /// The share of the squares of the law that a function of this quantity alone has.
    pub explained: f64,
    /// The quantity, in SI units.
    pub x: Vec<f64>,
    /// What the law adds [N m, N].
    pub law: Vec<f64>,
    /// What was measured, less all other terms [N m, N].
    pub measured: Vec<f64>,
}

/// Groups of rows of equal count, in which a function is as good as constant.
const GROUPS: usize = 24;

/// The rows of one equation.
#[derive(Default)]
struct Rows {
    quantities: [Vec<f64>; Quantity::ALL.len()],
    law: Vec<f64>,
    measured: Vec<f64>,
}

impl LawCurve {
    /// The curve of an effect of a state; none where it acts on nothing that was measured.
    pub(super) fn of(setting: &Setting<'_>, state: &State, taken: &Taken) -> Option<Self> {
        let data = setting.data.held_out;
        let law = setting.candidates[taken.candidate].law.as_ref();
        let mut equations: Vec<Rows> =
            (0..data.nominal.equations()).map(|_| Rows::default()).collect();
        let response =
            data.in_rows(&|motion| law.response(motion, &taken.values), &state.torques.held_out);
        for (stretch, torque) in response.stretches.iter().zip(&response.torque) {
            let signals = &data.signals[stretch.log.0];
            let load = &state.torques.held_out[stretch.log.0].load;
            let rows = &mut equations[stretch.equation];
            let joint = stretch.joint.0;
            let [q, qd, qdd] =
                [&signals.q, &signals.qd, &signals.qdd].map(|all| all[joint].as_slice());
            let of = [qd, q, &load[joint], qdd, &signals.t];
            for (all, signal) in rows.quantities.iter_mut().zip(of) {
                all.extend(signals.at_rows(signal));
            }
            let left = state.residual.held_out[stretch.range()].iter();
            rows.measured.extend(left.zip(torque).map(|(left, torque)| left + torque));
            rows.law.extend(torque);
        }
        let squares = |rows: &Rows| rows.law.iter().map(|torque| torque * torque).sum::<f64>();
        let all = equations.into_iter().enumerate();
        let (equation, rows) = all.max_by(|a, b| squares(&a.1).total_cmp(&squares(&b.1)))?;
        if squares(&rows) == 0.0 {
            return None;
        }
        let (mut best, mut explained) = (0, 0.0);
        for (place, values) in rows.quantities.iter().enumerate() {
            let share = explained_by(values, &rows.law);
            // one that comes before does as well where no more than a group tells them apart
            if share > explained + (GROUPS as f64).recip() {
                (best, explained) = (place, share);
            }
        }
        let joint = data.nominal.joint_of(equation);
        let Rows { mut quantities, law, measured } = rows;
        Some(Self {
            at: data.nominal.equation_name(equation),
            slides: data.nominal.model.joints[joint.0].slides,
            over: Quantity::ALL[best],
            explained,
            x: quantities[best].drain(..).collect(),
            law,
            measured,
        })
    }
}

/// The share of the squares of `law` that a function of the values has: one that is constant in
/// groups of as many values.
fn explained_by(values: &[f64], law: &[f64]) -> f64 {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let squares: f64 = law.iter().map(|torque| torque * torque).sum();
    let left: f64 = order
        .chunks(values.len().div_ceil(GROUPS).max(1))
        .map(|group| {
            let group: Vec<f64> = group.iter().map(|&row| law[row]).collect();
            variance(&group) * group.len() as f64
        })
        .sum();
    if squares > 0.0 { 1.0 - left / squares } else { 0.0 }
}

#[cfg(test)]
#[path = "../tests/unit/law_curve.rs"]
mod tests;
