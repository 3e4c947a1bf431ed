//! From what a walk is to be to a gait that walks: plan, gains, and a plan that costs less.

use super::cost::{CostKind, CostSettings};
use super::following::{Gains, Walk};
use super::gains::{Found, Outcome, search};
use super::guess::Guess;
use super::layout::Layout;
use super::legs::Legs;
use super::limits::StepLimits;
use super::phases::{Aspects, Axis, Phase, check, phases_of};
use super::planned::PlannedStep;
use super::program::{Program, violation};
use super::section::Cycle;
use super::sqp::{Ending, Optimum, Settings, minimise};
use super::step::Step;
use crate::error::{DesignError, Error, Violated};
use denavit_plants::Plant;

/// What a limit cycle is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCycleProblem {
    /// Speed, length, margins.
    pub limits: StepLimits,
    /// What is minimised.
    pub cost: CostKind,
    /// The phases of a step; none takes those of the aspects.
    pub phases: Option<Vec<Phase>>,
    /// What the gait may do.
    pub aspects: Aspects,
    /// The largest modulus of a Floquet multiplier.
    pub largest_multiplier: f64,
    /// Steps that have to be walked in the simulation.
    pub steps: usize,
    /// Intervals of the collocation over a step.
    pub intervals: usize,
    /// Where the search begins.
    pub guess: Guess,
}

impl Default for LimitCycleProblem {
    fn default() -> Self {
        Self {
            limits: StepLimits::default(),
            cost: CostKind::default(),
            phases: None,
            aspects: Aspects::default(),
            largest_multiplier: 0.8,
            steps: 50,
            intervals: 24,
            guess: Guess::default(),
        }
    }
}

/// A gait that walks.
#[derive(Clone, Debug, PartialEq)]
pub struct LimitCycle {
    /// The planned step.
    pub step: PlannedStep,
    /// The gains of the joints that follow it.
    pub gains: Gains,
    /// The cycle in closed loop.
    pub cycle: Cycle,
    /// The walk that was simulated from it.
    pub walk: Walk,
    /// Cost of transport of the plan, of the absolute power of joints.
    pub planned_cost_of_transport: f64,
    /// Squared torques of the plan over the distance [N^2 m s].
    pub planned_torque_squared: f64,
    /// How it was found, stage by stage.
    pub stages: Vec<Stage>,
}

/// A plan on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Stage {
    /// What was minimised.
    pub cost: CostKind,
    /// Weight of squared torques beside the cost of transport.
    pub torque_weight: f64,
    /// Least normal force of closed contacts, in weights.
    pub contact_force: f64,
    /// Intervals of the collocation over a step.
    pub intervals: usize,
    /// Subproblems solved.
    pub iterations: usize,
    /// The largest violation of a constraint, in its unit of the walker.
    pub violation: f64,
    /// The least of the largest multipliers over the gains that were tried; none if no cycle was
    /// found.
    pub largest_multiplier: Option<f64>,
    /// Cost of transport in the simulation, if it walks.
    pub cost_of_transport: Option<f64>,
}

/// Weights of squared torques beside the cost of transport, one stage after the other: the pure
/// cost alone makes walks that hardly use their joints, and fall at the least push.
const TORQUE_WEIGHTS: [f64; 2] = [0.3, 0.1];
/// By how much more feet press the ground at least, and impulses cost, where no gains are good.
const FIRMER: [[f64; 2]; 3] = [[1.0, 1.0], [1.5, 4.0], [2.0, 16.0]];
/// Violations below this are none, in units of the walker.
const FEASIBLE: f64 = 1e-4;
/// Closed contacts of a plan drift by less than this between the points, in legs.
const DRIFT: f64 = 5e-3;
/// Powers below this share of weight times speed cost less than their absolute value.
const ROUNDING: f64 = 0.01;

/// Designs a limit cycle; deterministic.
pub fn design(plant: &mut dyn Plant, problem: &LimitCycleProblem) -> Result<LimitCycle, Error> {
    let legs = Legs::of(plant)?;
    let phases = problem.phases.clone().unwrap_or_else(|| phases_of(problem.aspects));
    check(&phases).map_err(DesignError::NoStep)?;
    if !has_derivatives(plant) {
        return Err(DesignError::NoDerivatives.into());
    }
    let intervals = problem.intervals;
    let mut designer = Designer { plant, problem, legs, phases, intervals, stages: Vec::new() };
    let mut unstable = None;
    for firmness in FIRMER {
        let (x, plan) = designer.plan(CostKind::TorqueSquared, 1.0, firmness, None)?;
        match designer.gains(plan)? {
            Ok(gait) => return designer.refine(gait, x, firmness),
            Err(least) => unstable = least.or(unstable),
        }
    }
    Err(DesignError::Unstable(unstable).into())
}

fn has_derivatives(plant: &mut dyn Plant) -> bool {
    let n = plant.model().joints.len();
    let (zero, mut a, mut b) = (vec![0.0; n], vec![0.0; n * n], vec![0.0; n * n]);
    let mut contacts = denavit_plants::ContactDerivatives::new(plant.model());
    let forces = vec![0.0; 3 * plant.model().contacts.len()];
    plant.inverse_dynamics_derivatives(&zero, &zero, &zero, &mut a, &mut b)
        && plant.contact_derivatives(&zero, &zero, &zero, &forces, &mut contacts)
}

/// A plan with its gains.
struct Gait {
    plan: Plan,
    found: Found,
}

/// A planned step and its costs.
struct Plan {
    step: PlannedStep,
    cost_of_transport: f64,
    torque_squared: f64,
}

struct Designer<'a> {
    plant: &'a mut dyn Plant,
    problem: &'a LimitCycleProblem,
    legs: Legs,
    phases: Vec<Phase>,
    /// Intervals of the collocation over a step.
    intervals: usize,
    stages: Vec<Stage>,
}

impl Designer<'_> {
    /// Plans a step, from the guess or from another plan; with twice the intervals, from the guess,
    /// where closed contacts drift between the points.
    fn plan(
        &mut self,
        kind: CostKind,
        torque: f64,
        [firmness, softness]: [f64; 2],
        start: Option<&[f64]>,
    ) -> Result<(Vec<f64>, Plan), Error> {
        let problem = self.problem;
        let contact_force = firmness * problem.limits.contact_force;
        let limits = StepLimits { contact_force, ..limits_of(problem) };
        let costs = CostSettings {
            kind,
            rounding: ROUNDING,
            torque,
            torque_rate: 1e-3,
            acceleration: 1e-5,
            impulse: 2.0 * softness,
        };
        let mut start = start.map(<[f64]>::to_vec);
        loop {
            let shared = Layout::shared_out(&self.phases, self.intervals);
            let (phases, legs) = (&self.phases, &self.legs);
            let mut step = Step::new(self.plant, legs, phases, &shared, limits, costs);
            let guess = start.take().unwrap_or_else(|| step.guess(problem.guess));
            let found = search_plan(&mut step, &guess);
            self.stages.push(Stage {
                cost: kind,
                torque_weight: torque,
                contact_force,
                intervals: self.intervals,
                iterations: found.iterations,
                violation: found.violation,
                largest_multiplier: None,
                cost_of_transport: None,
            });
            if found.violation > FEASIBLE {
                return Err(DesignError::Infeasible(most_violated(&step, &found)).into());
            }
            let drift = step.drift(&found.x);
            if drift.residual <= DRIFT * step.units.length_m {
                let [cost_of_transport, torque_squared] = step.plain_costs(&found.x);
                let planned = PlannedStep::of(&step, &found.x);
                return Ok((found.x, Plan { step: planned, cost_of_transport, torque_squared }));
            }
            if self.intervals > problem.intervals {
                return Err(DesignError::Infeasible(drift).into());
            }
            self.intervals *= 2;
        }
    }

    /// Searches gains for a plan; the least of the largest multipliers if there are none.
    fn gains(&mut self, plan: Plan) -> Result<Result<Gait, Option<f64>>, Error> {
        let (bound, steps) = (self.problem.largest_multiplier, self.problem.steps);
        let outcome = search(self.plant, &plan.step, bound, steps)?;
        let stage = self.stages.last_mut();
        Ok(match outcome {
            Outcome::Found(found) => {
                if let Some(stage) = stage {
                    stage.largest_multiplier = Some(found.cycle.largest_multiplier());
                    stage.cost_of_transport = Some(found.walk.cost_of_transport);
                }
                Ok(Gait { plan, found: *found })
            }
            Outcome::None(least) => {
                if let Some(stage) = stage {
                    stage.largest_multiplier = least;
                }
                Err(least)
            }
        })
    }

    /// From a gait of little torque to one of little cost, as far as gains can be found.
    fn refine(
        mut self,
        mut gait: Gait,
        mut x: Vec<f64>,
        firmness: [f64; 2],
    ) -> Result<LimitCycle, Error> {
        let weights: &[f64] = match self.problem.cost {
            CostKind::CostOfTransport => &TORQUE_WEIGHTS,
            CostKind::TorqueSquared => &[],
        };
        for weight in weights {
            let planned = self.plan(CostKind::CostOfTransport, *weight, firmness, Some(&x));
            let Ok((next, plan)) = planned else { break };
            let Ok(better) = self.gains(plan)? else { break };
            x = next;
            if better.found.walk.cost_of_transport < gait.found.walk.cost_of_transport {
                gait = better;
            }
        }
        let Gait { plan, found } = gait;
        Ok(LimitCycle {
            step: plan.step,
            gains: found.gains,
            cycle: found.cycle,
            walk: found.walk,
            planned_cost_of_transport: plan.cost_of_transport,
            planned_torque_squared: plan.torque_squared,
            stages: self.stages,
        })
    }
}

/// Subproblems of a search, and of each that goes on where it ended while a constraint is violated.
const ITERATIONS: [usize; 2] = [40, 20];
/// Searches at most.
const SEARCHES: usize = 5;

/// Minimises until all constraints are met.
fn search_plan(step: &mut Step<'_>, start: &[f64]) -> Optimum {
    let settings = |iterations| Settings { iterations, ..Settings::default() };
    let mut found = minimise(step, start, settings(ITERATIONS[0]));
    for _ in 1..SEARCHES {
        if found.violation <= FEASIBLE || found.ending == Ending::Infeasible {
            break;
        }
        let before = found.iterations;
        found = minimise(step, &found.x, settings(ITERATIONS[1]));
        found.iterations += before;
    }
    found
}

/// The torso of a gait that does not lean stays within this \[rad\].
const UPRIGHT_RAD: f64 = 0.02;
/// A stance knee that does not bend stays within this of the guess \[rad\].
const STIFF_RAD: f64 = 0.1;

/// The limits of a problem with those of its aspects.
fn limits_of(problem: &LimitCycleProblem) -> StepLimits {
    let (aspects, mut limits) = (problem.aspects, problem.limits);
    if !aspects.lean {
        limits.lean_rad = limits.lean_rad.min(UPRIGHT_RAD);
    }
    if !aspects.knee_flexion {
        limits.stance_knee_rad = limits.stance_knee_rad.min(problem.guess.knee_rad + STIFF_RAD);
    }
    if !aspects.retraction {
        limits.thigh_rad_s = limits.thigh_rad_s.max(0.0);
    }
    limits
}

impl Step<'_> {
    /// How far closed contacts leave the ground between the instants at which they close.
    fn drift(&mut self, x: &[f64]) -> Violated {
        let mut worst = Violated {
            what: "drift of a closed contact".to_owned(),
            phase: String::new(),
            t_s: 0.0,
            residual: 0.0,
            unit: "m",
        };
        let mut places = vec![0.0; 3 * self.contacts];
        let mut before = 0.0;
        for phase in 0..self.layout.phases.len() {
            let duration_s = x[self.layout.durations + phase];
            for point in self.layout.points_of(phase) {
                let first = self.layout.motion(point, 0);
                self.plant.contact_positions(&x[first..first + self.layout.n], &mut places);
                for (contact, axis) in &self.layout.held[phase] {
                    let height = (places[3 * contact + 2] - self.legs.ground_m).abs();
                    if *axis == Axis::Up && height > worst.residual {
                        worst.residual = height;
                        worst.phase.clone_from(&self.layout.phases[phase].name);
                        worst.t_s = before + point.fraction * duration_s;
                    }
                }
            }
            before += duration_s;
        }
        worst
    }
}

fn most_violated(step: &Step<'_>, found: &Optimum) -> Violated {
    let each = found.constraints.iter().zip(step.ranges()).map(|(v, range)| violation(*v, *range));
    let worst =
        each.enumerate().fold(
            (0, 0.0),
            |worst, (index, amount)| {
                if amount > worst.1 { (index, amount) } else { worst }
            },
        );
    let label = &step.labels()[worst.0];
    let durations = &found.x[step.layout.durations..];
    let before: f64 = durations[..label.phase].iter().sum();
    let what = match label.part.is_empty() {
        true => label.what.to_owned(),
        false => format!("{} of `{}`", label.what, label.part),
    };
    Violated {
        what,
        phase: step.layout.phases[label.phase].name.clone(),
        t_s: before + label.fraction * durations[label.phase],
        residual: worst.1 * label.size,
        unit: label.unit,
    }
}
