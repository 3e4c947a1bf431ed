//! A model with the effects that it has so far, fitted to the logs for training and judged with
//! others.

use super::candidate::Candidate;
use super::data::{Data, ModelTorques};
use super::evidence::{block_costs, paired};
use super::floor::{NoiseFloor, rms};
use super::held::hold;
use super::problem::{Fitted, Found, Problem};
use super::signals::Signals;
use super::simulated::{MotionGap, Moved, NotMoved};
use super::turning::{Unsure, turning};

/// An effect that was taken into the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Taken {
    /// Its number among the candidates.
    pub candidate: usize,
    /// The values of its parameters.
    pub values: Vec<f64>,
}

/// Logs, candidates and floors: what does not change during a search.
pub struct Setting<'a> {
    /// Logs to fit.
    pub train: &'a Data<'a>,
    /// Logs to judge with.
    pub held_out: &'a Data<'a>,
    /// What may be missing.
    pub candidates: &'a [Candidate],
    /// What the model has of them: the first effects of every state.
    pub given: Vec<Taken>,
    /// The model as a file, to be moved along the logs, with the filter of these \[Hz\].
    pub moved: Option<(&'a Moved<'a>, f64)>,
    /// Coarse views of the logs to fit; none if their filter leaves nothing to save.
    pub coarse: Option<Vec<Signals>>,
    /// Floors of the logs to fit.
    pub train_floor: &'a [NoiseFloor],
    /// Floors of the logs to judge with.
    pub held_out_floor: &'a [NoiseFloor],
}

/// A model with effects, fitted.
#[derive(Clone)]
pub struct State {
    /// The effects.
    pub taken: Vec<Taken>,
    /// The nominal model's own parameters, in their deviations.
    pub z: Vec<f64>,
    /// The entries of z that are at a bound: beyond it the logs, but not the model's uncertainty,
    /// would have them.
    pub held: Vec<Option<f64>>,
    /// The deviation by which each row is weighted [N m, N]: of the logs that are fitted, and of
    /// the others.
    pub deviation: [Vec<f64>; 2],
    /// What of it is friction that is not known while joints turn around.
    pub turning: [Vec<f64>; 2],
    /// What is left of the logs that were fitted [N m, N].
    pub residual: Vec<f64>,
    /// What is left of the others.
    pub held_out_residual: Vec<f64>,
    /// Torques that the model gives the motion of the logs.
    pub torques: [Vec<ModelTorques>; 2],
    /// Those of coarse views of the first.
    pub coarse: Vec<ModelTorques>,
}

/// A tried set of effects.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The effects with their values.
    pub taken: Vec<Taken>,
    /// What the fit found.
    pub found: Found,
    /// What it leaves of the other logs.
    pub held_out_residual: Vec<f64>,
    /// Weighted squares of what is left of blocks of both, trained first.
    pub blocks: [Vec<f64>; 2],
}

impl State {
    /// For each row how far it counts in a gap.
    pub fn trust(&self) -> [Vec<f64>; 2] {
        [0, 1].map(|set| {
            let both = self.turning[set].iter().zip(&self.deviation[set]);
            both.map(|(turning, deviation)| 1.0 - (turning / deviation).powi(2)).collect()
        })
    }

    /// The values of all effects.
    pub(super) fn values(&self) -> Vec<f64> {
        self.taken.iter().flat_map(|taken| taken.values.clone()).collect()
    }

    /// The numbers of the effects' candidates, in order.
    pub fn candidates(&self) -> Vec<usize> {
        let mut all: Vec<usize> = self.taken.iter().map(|one| one.candidate).collect();
        all.sort_unstable();
        all
    }
}

impl Trial {
    /// Weighted squares of what is left of all logs.
    pub fn cost(&self) -> f64 {
        self.blocks.iter().flatten().sum()
    }

    /// Number of parameters of all effects, of those that change anything independently.
    pub fn parameters(&self) -> usize {
        self.found.rank
    }

    /// Number of parameters as they are written.
    pub fn numbers(&self) -> usize {
        self.taken.iter().map(|taken| taken.values.len()).sum()
    }

    /// What is left of the logs that were fitted, and of the others [N m, N].
    pub(super) fn residuals(&self) -> [&[f64]; 2] {
        [&self.found.residual, &self.held_out_residual]
    }

    /// Weighted squares of what is left of held-out logs.
    pub fn held_out_cost(&self) -> f64 {
        self.blocks[1].iter().sum()
    }

    /// The cost of all logs, for the number of parameters that it took (Schwarz 1978); `samples`
    /// are those that are independent.
    pub fn score(&self, samples: f64) -> f64 {
        samples * self.cost().ln() + self.parameters() as f64 * samples.ln()
    }
}

/// Entries of z beyond which the model's own parameters are not moved.
pub(super) const MOST_Z: f64 = 3.0;

/// Rounds in which a joint's deviation is found from rows that are weighted by it.
const ROUNDS_OF_SPREAD: usize = 5;

/// A drive sticks for longer than a filter blurs: most of what is left there, in squares, of what
/// is not known.
const MOST_TURNING: f64 = 2.0;

/// Rounds in which effects are computed from the torques of the last one, and the step of z from
/// which on that changes nothing.
const MOST_ROUNDS: usize = 6;
const SETTLED: f64 = 0.05;

/// Rounds in which entries of z are held.
const MOST_HELD: usize = 8;

impl<'a> Setting<'a> {
    /// The laws of effects with their values.
    pub fn fitted(&self, taken: &[Taken]) -> Vec<Fitted<'a>> {
        let of = |one: &Taken| Fitted {
            law: self.candidates[one.candidate].law.as_ref(),
            values: one.values.clone(),
        };
        taken.iter().map(of).collect()
    }

    /// The model with effects, whose values are searched from those given.
    pub fn state(&self, taken: &[Taken]) -> State {
        let floor = self.floor_of_equations();
        let mut z = vec![0.0; self.train.columns.len()];
        let mut taken = taken.to_vec();
        let (mut spreads, mut found) = (Vec::new(), None);
        let mut held = vec![None; z.len()];
        let mut residual = self.train.residual.clone();
        for _ in 0..2 {
            let torques = self.train.model_torques(&z);
            let unsure = turning(self.train, &torques, &self.fitted(&taken));
            spreads = self.spreads(&residual, &floor, &unsure);
            held.fill(None);
            for _ in 0..MOST_HELD {
                let [_, deviation] = of_rows(self.train, &spreads, &unsure);
                let problem = Problem::new(self.train, &deviation, &[]).holding(&held);
                let best = problem.fit(&self.fitted(&taken), &torques);
                taken.iter_mut().zip(&best.values).for_each(|(t, v)| t.values.clone_from(v));
                residual.clone_from(&best.residual);
                spreads = self.spreads(&residual, &floor, &unsure);
                z.clone_from(&best.z);
                found = Some(best);
                if !hold(&mut held, &z, MOST_Z) {
                    break;
                }
            }
        }
        let found = found.expect("two rounds were made");
        let torques = [self.train.model_torques(&z), self.held_out.model_torques(&z)];
        let held_out_residual = self.left(&taken, &z, &torques[1]);
        let [train, held_out] =
            [(self.train, &torques[0]), (self.held_out, &torques[1])].map(|(data, torques)| {
                of_rows(data, &spreads, &turning(data, torques, &self.fitted(&taken)))
            });
        State {
            coarse: self.coarse_torques(&torques[0]),
            residual: found.residual,
            taken,
            z,
            held,
            turning: [train[0].clone(), held_out[0].clone()],
            deviation: [train, held_out].map(|[_, deviation]| deviation),
            held_out_residual,
            torques,
        }
    }

    /// The state with its weights, fitted on until laws of the model's own torques have those of
    /// its numbers as they are estimated.
    pub(super) fn settled(&self, mut state: State) -> State {
        let problem = Problem::new(self.train, &state.deviation[0], &[]);
        for _ in 0..MOST_ROUNDS {
            let found = within(&problem, &mut self.fitted(&state.taken), &state.torques[0]);
            let steps = found.z.iter().zip(&state.z).map(|(a, b)| (a - b).abs());
            let moved = steps.fold(0.0, f64::max);
            state.taken.iter_mut().zip(found.values).for_each(|(t, v)| t.values = v);
            state.held = found.z.iter().map(|z| (z.abs() >= MOST_Z).then_some(*z)).collect();
            (state.z, state.residual) = (found.z, found.residual);
            state.torques = [self.train, self.held_out].map(|data| data.model_torques(&state.z));
            if moved < SETTLED {
                break;
            }
        }
        state.held_out_residual = self.left(&state.taken, &state.z, &state.torques[1]);
        state.coarse = self.coarse_torques(&state.torques[0]);
        state
    }

    /// What torques of the logs to fit are in their coarse views.
    fn coarse_torques(&self, torques: &[ModelTorques]) -> Vec<ModelTorques> {
        let coarse = self.coarse.iter().flatten().enumerate();
        coarse.map(|(log, own)| torques[log].thinned(&self.train.signals[log], own)).collect()
    }

    /// Fits a set of effects as they would stand in a state, whose weights and torques it keeps.
    pub fn trial(&self, problem: &Problem<'_>, state: &State, taken: &[Taken]) -> Trial {
        let found = within(problem, &mut self.fitted(taken), &state.torques[0]);
        self.judge(state, taken, found)
    }

    /// The same with values as they are.
    pub fn judged(&self, problem: &Problem<'_>, state: &State, taken: &[Taken]) -> Trial {
        let laws = self.fitted(taken);
        let found = bounded(problem, |problem| problem.at(&laws, &state.torques[0]));
        self.judge(state, taken, found)
    }

    fn judge(&self, state: &State, taken: &[Taken], found: Found) -> Trial {
        let mut taken = taken.to_vec();
        taken.iter_mut().zip(&found.values).for_each(|(t, v)| t.values.clone_from(v));
        let held_out_residual = self.left(&taken, &found.z, &state.torques[1]);
        let blocks = [
            block_costs(self.train, &found.residual, &state.deviation[0]),
            block_costs(self.held_out, &held_out_residual, &state.deviation[1]),
        ];
        Trial { taken, found, held_out_residual, blocks }
    }

    /// Searches the values of effects on coarse views, where there are any.
    pub fn roughly(&self, problem: &Problem<'_>, state: &State, taken: &[Taken]) -> Vec<Taken> {
        let Some(coarse) = &self.coarse else { return taken.to_vec() };
        let found = within(&problem.coarse(coarse), &mut self.fitted(taken), &state.coarse);
        let both = taken.iter().zip(found.values);
        both.map(|(one, values)| Taken { candidate: one.candidate, values }).collect()
    }

    /// What a model leaves of the logs that it was not fitted to.
    fn left(&self, taken: &[Taken], z: &[f64], torques: &[ModelTorques]) -> Vec<f64> {
        self.left_by(&self.fitted(taken), z, torques)
    }

    /// The same of laws, whatever they are.
    pub(super) fn left_by(
        &self,
        laws: &[Fitted<'_>],
        z: &[f64],
        torques: &[ModelTorques],
    ) -> Vec<f64> {
        let mut residual = self.held_out.residual_of(z);
        for fitted in laws {
            for (log, torques) in torques.iter().enumerate() {
                let signals = &self.held_out.signals[log];
                let motion = torques.motion(self.held_out.nominal, signals);
                let response = fitted.law.response(motion, &fitted.values);
                self.held_out.in_rows(log, signals, &response).subtract_from(&mut residual);
            }
        }
        residual
    }

    /// The gap of the model in motion along a set of logs: those fitted, or the others.
    pub(super) fn motion_gap(
        &self,
        set: usize,
        (taken, z): (&[Taken], &[f64]),
    ) -> Result<MotionGap, NotMoved> {
        let Some((moved, cutoff_hz)) = self.moved else { return Ok(MotionGap::default()) };
        moved.gap((set, cutoff_hz), (self.train.nominal, z), (self.candidates, taken))
    }

    /// Standard errors by which effects in place of others lessen the gap of the model in motion
    /// along held-out logs, from its windows. None where that cannot be told, and of laws with
    /// states, with which windows take long.
    pub(super) fn in_motion(
        &self,
        than: (&[Taken], &[f64]),
        now: (&[Taken], &[f64]),
    ) -> Option<f64> {
        self.moved?;
        // Windows of drives before springs are shown, and judge nothing.
        if !self.train.nominal.springs.is_empty() {
            return None;
        }
        let gap = |one| self.motion_gap(1, one).ok().filter(|gap| !gap.has_states);
        let (mut before, mut after) = (gap(than)?, gap(now)?);
        // Numbers of the file against estimated ones would say more than the effects do.
        if before.is_estimated != after.is_estimated {
            let as_they_were = vec![0.0; now.1.len()];
            before = gap((than.0, &as_they_were))?;
            after = gap((now.0, &as_they_were))?;
        }
        Some(paired(&before.windows, &after.windows))
    }

    /// Weighted squares of what is `left` of held-out logs, for each joint and then for each
    /// spring, and those of noise alone.
    pub fn held_out_squares(&self, state: &State, left: &[f64]) -> Vec<[f64; 2]> {
        self.squares(1, state, left)
    }

    /// The same of a set of logs: those fitted, or the others.
    pub(super) fn squares(&self, set: usize, state: &State, left: &[f64]) -> Vec<[f64; 2]> {
        let (data, floors) =
            [(self.train, self.train_floor), (self.held_out, self.held_out_floor)][set];
        let mut squares = vec![[0.0; 2]; self.train.nominal.equations()];
        for stretch in &data.stretches {
            let floor = floors[stretch.log].deviation[stretch.equation];
            for row in stretch.first..stretch.first + stretch.rows {
                let weight = state.deviation[set][row].powi(-2);
                squares[stretch.equation][0] += weight * left[row].powi(2);
                squares[stretch.equation][1] += weight * floor.powi(2);
            }
        }
        squares
    }

    /// The rows of each joint, then of each spring, in a set of logs.
    pub(super) fn rows(&self, set: usize) -> Vec<f64> {
        let mut rows = vec![0.0; self.train.nominal.equations()];
        let data = [self.train, self.held_out][set];
        data.stretches.iter().for_each(|own| rows[own.equation] += own.rows as f64);
        rows
    }

    fn floor_of_equations(&self) -> Vec<f64> {
        let of = |equation: usize| {
            let all = self.train_floor.iter().map(|log| log.deviation[equation]);
            rms(&all.collect::<Vec<f64>>())
        };
        (0..self.train.nominal.equations()).map(of).collect()
    }

    /// How far each joint or spring is off where it does not turn around, at least the floor, and
    /// the share of what is not known where it does. A joint that misses something counts less, and
    /// does not bend the model elsewhere.
    fn spreads(&self, residual: &[f64], floor: &[f64], unsure: &[Unsure]) -> Vec<Spread> {
        let of = |(equation, floor): (usize, &f64)| {
            let own = self.train.stretches.iter().filter(|stretch| stretch.equation == equation);
            let rows: Vec<usize> =
                own.flat_map(|stretch| stretch.first..stretch.first + stretch.rows).collect();
            let all: Vec<f64> = rows.iter().map(|&row| residual[row]).collect();
            let mut spread = Spread { level: rms(&all).max(*floor), turning: 1.0 };
            for _ in 0..ROUNDS_OF_SPREAD {
                let Spread { level, turning } = spread;
                let weight =
                    |row: usize| 1.0 / (1.0 + (unsure[row].deviation(turning) / level).powi(2));
                let sum: f64 = rows.iter().map(|&row| weight(row)).sum();
                let squares = rows.iter().map(|&row| weight(row) * residual[row].powi(2));
                let level = (squares.sum::<f64>() / sum.max(f64::MIN_POSITIVE)).sqrt().max(*floor);
                let of_corner = |row: usize| unsure[row].corner > level.max(unsure[row].rest);
                let near = || rows.iter().filter(|&&row| of_corner(row));
                let most: f64 = near().map(|&row| unsure[row].corner.powi(2)).sum();
                let more: f64 = near().map(|&row| residual[row].powi(2) - level.powi(2)).sum();
                // Where a drive rests at all its reversals they say nothing of its corners.
                let rests = rows.iter().any(|&row| unsure[row].rest > level);
                let share =
                    if most == 0.0 && rests { 1.0 } else { more / most.max(f64::MIN_POSITIVE) };
                let turning = share.clamp(0.0, MOST_TURNING).sqrt();
                spread = Spread { level, turning };
            }
            spread
        };
        floor.iter().enumerate().map(of).collect()
    }
}

/// Fits laws with every entry of z free until it is at a bound.
pub(super) fn within(
    problem: &Problem<'_>,
    laws: &mut [Fitted<'_>],
    torques: &[ModelTorques],
) -> Found {
    bounded(problem, |problem| {
        let found = problem.fit(laws, torques);
        laws.iter_mut().zip(&found.values).for_each(|(law, values)| law.values.clone_from(values));
        found
    })
}

/// What is found with every entry of z free until it is at a bound.
fn bounded<'a>(problem: &Problem<'a>, mut find: impl FnMut(&Problem<'a>) -> Found) -> Found {
    let mut held = vec![None; problem.data.columns.len()];
    let mut found = find(problem);
    for _ in 0..MOST_HELD {
        if !hold(&mut held, &found.z, MOST_Z) {
            break;
        }
        found = find(&problem.holding(&held));
    }
    found
}

/// How far a joint is off.
#[derive(Clone, Copy, Debug)]
struct Spread {
    /// Where it does not turn around [N m, N].
    level: f64,
    /// The share of what is not known where it does.
    turning: f64,
}

/// What is not known of each row, and its deviation with that.
fn of_rows(data: &Data<'_>, spreads: &[Spread], unsure: &[Unsure]) -> [Vec<f64>; 2] {
    let (mut turning, mut deviation) = (vec![0.0; unsure.len()], vec![0.0; unsure.len()]);
    for stretch in &data.stretches {
        let Spread { level, turning: share } = spreads[stretch.equation];
        for row in stretch.first..stretch.first + stretch.rows {
            turning[row] = unsure[row].deviation(share);
            deviation[row] = turning[row].hypot(level);
        }
    }
    [turning, deviation]
}
