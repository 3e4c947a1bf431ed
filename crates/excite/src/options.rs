//! What an excitation is asked for, compared with what the model can do.

use super::fault::{ExciteFault, LimitKind};
use super::model::{Columns, ExcitedModel, JointLimits};
use super::objective::Objective;
use super::space::{Ends, Family, Space};
pub(crate) use crate::policy::options::DURATIONS_S;
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::RegressorOptions;
use denavit_plants::regression::{RegressionJoint, RegressionModel};

/// What is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct ExciteOptions {
    /// The functions of time.
    pub family: Family,
    /// Length of a lap \[s\].
    pub duration_s: f64,
    /// What is asked of start and end.
    pub ends: Ends,
    /// What is made small.
    pub objective: Objective,
    /// Which parameters are excited.
    pub columns: Columns,
    /// The joint parameters among them.
    pub with: RegressorOptions,
    /// Columns that are kept before others.
    pub keep: Vec<String>,
    /// Joints that do not move, and where they are [rad, m].
    pub hold: Vec<(String, f64)>,
    /// Weights of joints' rows: 1 over the noise of a torque. Absent: 1, and 0 of the virtual
    /// joints of a floating base.
    pub weights: Vec<(String, f64)>,
    /// Height that contact points and points that must not touch keep \[m\]; none lets them touch.
    pub clearance_m: Option<f64>,
    /// Of the starts.
    pub seed: u64,
    /// How many starts.
    pub starts: usize,
    /// The largest use of a limit of the motion that starts make: above 1 they are infeasible.
    pub reach: f64,
    /// Evaluations of a start, at most.
    pub evaluations: usize,
    /// Steps of the grid of times that the solver sees; none chooses by the family.
    pub steps: Option<usize>,
    /// Threads; none takes as many as the machine has. The result does not depend on it.
    pub threads: Option<usize>,
}

impl Default for ExciteOptions {
    fn default() -> Self {
        Self {
            family: Family::Fourier { harmonics: 5 },
            duration_s: 10.0,
            ends: Ends { at_rest: true, unaccelerated: true, closed: true },
            objective: Objective::CONDITION,
            columns: Columns::Axes,
            with: RegressorOptions::default(),
            keep: Vec::new(),
            hold: Vec::new(),
            weights: Vec::new(),
            clearance_m: Some(0.01),
            seed: 1,
            starts: 4,
            reach: 1.0,
            evaluations: 400,
            steps: None,
            threads: None,
        }
    }
}

/// More cannot be optimised in reasonable time.
const MOST_FUNCTIONS: usize = 101;
const MOST_STEPS: usize = 5_000;
const MOST_STARTS: usize = 10_000;
const MOST_EVALUATIONS: usize = 100_000;

impl ExciteOptions {
    /// Steps of the solver's grid.
    fn grid(&self) -> usize {
        let harmonics = match self.family {
            Family::Fourier { harmonics } => harmonics,
            Family::FreeFourier { terms } => 2 * terms,
            Family::Polynomial { degree } => degree.div_ceil(2),
            Family::Samples { knots } => knots.div_ceil(2),
        };
        self.steps.unwrap_or(40.max(12 * harmonics).min(MOST_STEPS))
    }

    /// The space of trajectories, or nothing with what is wrong noted.
    pub(super) fn space(&self, faults: &mut Vec<ExciteFault>) -> Option<Space> {
        let before = faults.len();
        if !DURATIONS_S.contains(&self.duration_s) {
            faults.push(ExciteFault::Duration(self.duration_s));
        }
        let (what, least, count) = match self.family {
            Family::Fourier { harmonics } => ("harmonics", 1, harmonics),
            Family::FreeFourier { terms } => ("harmonics", 1, terms),
            Family::Polynomial { degree } => ("degrees", 1, degree),
            Family::Samples { knots } => ("samples", 3, knots),
        };
        if count > MOST_FUNCTIONS {
            faults.push(ExciteFault::TooMany(what, MOST_FUNCTIONS));
        }
        if count < least {
            faults.push(ExciteFault::TooFewOf(what, least));
        }
        if self.grid() > MOST_STEPS {
            faults.push(ExciteFault::TooMany("steps of the grid", MOST_STEPS));
        }
        if self.grid() < 4 {
            faults.push(ExciteFault::TooFewOf("steps of the grid", 4));
        }
        if self.starts == 0 {
            faults.push(ExciteFault::TooFewOf("starts", 1));
        }
        if self.evaluations == 0 {
            faults.push(ExciteFault::TooFewOf("evaluations", 1));
        }
        if self.evaluations > MOST_EVALUATIONS {
            faults.push(ExciteFault::TooMany("evaluations", MOST_EVALUATIONS));
        }
        if self.starts > MOST_STARTS {
            faults.push(ExciteFault::TooMany("starts", MOST_STARTS));
        }
        if !(self.reach > 0.0 && self.reach.is_finite()) {
            faults.push(ExciteFault::Reach(self.reach));
        }
        let Objective { condition, determinant, .. } = self.objective;
        if !(condition >= 0.0 && determinant >= 0.0 && condition + determinant > 0.0) {
            faults.push(ExciteFault::NoObjective);
        }
        if faults.len() > before {
            return None;
        }
        let space = Space::new(self.family, self.duration_s, self.ends, self.grid());
        if !space.moves() {
            faults.push(ExciteFault::TooFewFunctions);
            return None;
        }
        Some(space)
    }

    /// The model with its limits, or nothing with what is wrong noted.
    pub(super) fn model(
        &self,
        robot: &Robot,
        faults: &mut Vec<ExciteFault>,
    ) -> Option<ExcitedModel> {
        let regression = match RegressionModel::new(robot, self.with, &self.keep) {
            Ok(regression) => regression,
            Err(error) => {
                faults.push(ExciteFault::Regression(error));
                return None;
            }
        };
        let before = faults.len();
        self.check_names(&regression, faults);
        let joints: Vec<JointLimits> =
            regression.joints.iter().map(|joint| self.limits(joint, faults)).collect();
        let weights: Vec<f64> =
            regression.joints.iter().map(|joint| self.weight(joint, faults)).collect();
        if joints.iter().all(|joint| joint.held.is_some()) {
            faults.push(ExciteFault::NothingMoves);
        }
        if weights.iter().all(|weight| *weight <= 0.0) {
            faults.push(ExciteFault::NothingExcited);
        }
        if faults.len() > before {
            return None;
        }
        let keeps_clear = self.clearance_m.is_some();
        let made = ExcitedModel::new(robot, regression, joints, weights, self.columns, keeps_clear);
        made.map_err(|fault| faults.push(fault)).ok()
    }

    fn check_names(&self, regression: &RegressionModel, faults: &mut Vec<ExciteFault>) {
        let names: Vec<&str> = regression.joints.iter().map(|joint| joint.name.as_str()).collect();
        for (option, given) in
            [("`options.hold`", &self.hold), ("`options.weights`", &self.weights)]
        {
            for (name, _) in given.iter().filter(|(name, _)| !names.contains(&name.as_str())) {
                let nearest = nearest(name, names.iter().copied()).map(str::to_owned);
                faults.push(ExciteFault::UnknownJoint { option, name: name.clone(), nearest });
            }
        }
    }

    fn weight(&self, joint: &RegressionJoint, faults: &mut Vec<ExciteFault>) -> f64 {
        let given = self.weights.iter().rev().find(|(name, _)| *name == joint.name);
        let weight = given.map_or(if joint.is_base { 0.0 } else { 1.0 }, |(_, weight)| *weight);
        if !(weight >= 0.0 && weight.is_finite()) {
            faults.push(ExciteFault::Weight { joint: joint.name.clone(), weight });
        }
        weight
    }

    fn limits(&self, joint: &RegressionJoint, faults: &mut Vec<ExciteFault>) -> JointLimits {
        let name = &joint.name;
        let held = self.hold.iter().rev().find(|(held, _)| held == name).map(|(_, at)| *at);
        // nothing drives the virtual joints of a floating base
        let held = held.or(joint.is_base.then_some(0.0));
        let mut limits = JointLimits {
            name: name.clone(),
            slides: joint.slides,
            position: joint.position_limits.unwrap_or([0.0; 2]),
            velocity: joint.velocity_limit.unwrap_or(0.0),
            acceleration: joint.acceleration_limit.unwrap_or(0.0),
            torque: joint.torque_limits,
            held,
            assumed: Vec::new(),
        };
        if let Some(position) = held {
            let inside =
                joint.position_limits.is_none_or(|[low, high]| (low..=high).contains(&position));
            if !inside || !position.is_finite() {
                faults.push(ExciteFault::HeldOutside { joint: name.clone(), position });
            }
            (limits.velocity, limits.acceleration) = (0.0, 0.0);
            return limits;
        }
        // what the model does not say: one sine a lap over the whole range
        let turn = std::f64::consts::TAU / self.duration_s;
        if joint.velocity_limit.is_none() {
            limits.velocity = limits.half() * turn;
            limits.assumed.push(LimitKind::Velocity);
        }
        if joint.acceleration_limit.is_none() {
            limits.acceleration = limits.half() * turn * turn;
            limits.assumed.push(LimitKind::Acceleration);
        }
        let room = match joint.position_limits {
            None => {
                let (joint, limit) = (name.clone(), LimitKind::Position);
                faults.push(ExciteFault::MissingLimit { joint, limit });
                return limits;
            }
            Some([low, high]) => high - low,
        };
        let given = [
            (LimitKind::Position, Some(room)),
            (LimitKind::Velocity, joint.velocity_limit),
            (LimitKind::Acceleration, joint.acceleration_limit),
        ];
        for (limit, room) in given {
            if room.is_some_and(|room| !(room > 0.0 && room.is_finite())) {
                faults.push(ExciteFault::NoRoom { joint: name.clone(), limit });
            }
        }
        if joint.torque_limits.is_some_and(|[low, high]| low >= high || !(high - low).is_finite()) {
            let limit = LimitKind::Torque;
            faults.push(ExciteFault::NoRoom { joint: name.clone(), limit });
        }
        limits
    }
}
