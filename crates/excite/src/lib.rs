//! Trajectories that excite what is to be identified (thesis 3.2.3).
//!
//! - [`excite`]: trajectories within the limits of a robot that make the condition number of the
//!   stacked base regressor small, or its determinant large
//! - [`check_trajectory`]: a trajectory against the limits
//! - [`Feasible`]: trajectories within the limits, for who judges them otherwise
//! - [`Family`], [`Ends`]: samples, Fourier series, polynomials, and what is asked of their ends
//! - [`Objective`], [`Check`]: what is made small, and what a trajectory is judged by
//! - [`Error`]: all that is wrong with model and options
//!
//! Several starts are made from a seed, each on its own, in as many threads as there are; the
//! result does not depend on their number. A start is solved twice, the second time with sharper
//! limits, and judged by its own references on a finer grid; if a limit is exceeded there, the
//! motion is made smaller about the middle posture until it holds.

mod check;
mod error;
mod fault;
mod feasible;
mod model;
mod objective;
mod options;
mod policy;
mod problem;
mod solve;
mod space;
mod stack;

use crate::policy::excite::{FIRST_SHARE, RESERVE, SAFE, SHARPNESS};
pub use check::{Check, Extremes, JointUse, LimitUse};
pub use error::{Error, ErrorKind};
pub use fault::LimitKind;
pub use feasible::Feasible;
pub use model::{Columns, ExcitedModel, JointLimits};
pub use objective::{Excitation, Objective};
pub use options::ExciteOptions;
pub use solve::{Iterate, SolverStop};
pub use space::{Ends, Family, Space};
pub use stack::Stack;

use check::{Lap, check, limit_use};
use denavit_codegen::model::Robot;
use denavit_numerics::Random;
use denavit_plants::trajectory::Reference;
use denavit_simulate::scenario::{TRAJECTORY_FORMAT, Trajectory};
use fault::ExciteFault;
use model::Evaluators;
use problem::Problem;
use serde_json::{Map, Value, json};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// What a start came to.
#[derive(Clone, Debug)]
pub struct StartReport {
    /// Where it began.
    pub began: Check,
    /// Where it ended.
    pub ended: Check,
    /// The objective there, of the references on the finer grid.
    pub objective: f64,
    /// Why the solver stopped, the second time.
    pub stop: SolverStop,
    /// Evaluations of objective and limits.
    pub evaluations: usize,
    /// Factor by which the motion was made smaller after the solver, 1 if it was not.
    pub shrunk: f64,
    /// Where the solver went.
    pub iterates: Vec<Iterate>,
    /// Coordinates in the space of trajectories, joint by joint.
    pub coordinates: Vec<f64>,
}

impl StartReport {
    fn rank(&self) -> Rank {
        Rank::new(&self.ended, self.objective)
    }
}

/// What trajectories are chosen by: within the limits, or by how much not, then the objective.
#[derive(Clone, Copy, Debug)]
struct Rank {
    excess: f64,
    objective: f64,
}

impl Rank {
    fn new(check: &Check, objective: f64) -> Self {
        Self { excess: if check.is_feasible() { 0.0 } else { check.limits.worst() }, objective }
    }

    /// Whether it is better than another; what is no number is worse than all that is.
    fn is_below(self, other: Self) -> bool {
        let by_limits = self.excess.total_cmp(&other.excess);
        by_limits.then(self.objective.total_cmp(&other.objective)).is_lt()
    }
}

impl Candidate {
    fn rank(&self) -> Rank {
        Rank::new(&self.check, self.objective)
    }
}

/// A trajectory that a start came by, made to keep the limits.
struct Candidate {
    x: Vec<f64>,
    shrunk: f64,
    check: Check,
    objective: f64,
}

/// The trajectories that were found.
#[derive(Clone, Debug)]
pub struct Excited {
    /// The robot with its limits.
    pub model: ExcitedModel,
    /// Which columns are excited.
    pub stack: Stack,
    /// The space of trajectories.
    pub space: Space,
    /// The starts, in order.
    pub starts: Vec<StartReport>,
    /// The best of them: feasible if any is.
    pub best: usize,
}

/// What a start does, for who waits.
#[derive(Clone, Copy, Debug)]
pub struct Progress {
    /// The start, from 0.
    pub start: usize,
    /// Evaluations so far.
    pub evaluations: usize,
    /// Where it is.
    pub iterate: Iterate,
}

/// A robot with its limits, the space of its trajectories and the columns that these excite.
fn prepared(
    robot: &Robot,
    options: &ExciteOptions,
) -> Result<(ExcitedModel, Space, Stack, Evaluators), Error> {
    let mut faults = Vec::new();
    let space = options.space(&mut faults);
    let model = options.model(robot, &mut faults);
    Error::of(&robot.name, faults)?;
    let (Some(space), Some(model)) = (space, model) else {
        unreachable!("what is missing has been reported")
    };
    let (stack, evaluators) = stacked(robot, &model)?;
    Ok((model, space, stack, evaluators))
}

/// The columns that motions of a robot excite, if there are any.
fn stacked(robot: &Robot, model: &ExcitedModel) -> Result<(Stack, Evaluators), Error> {
    let mut evaluators = model.evaluators();
    let stack = Stack::new(model, &mut evaluators);
    if stack.names.is_empty() {
        Error::of(&robot.name, vec![ExciteFault::NothingExcited])?;
    }
    Ok((stack, evaluators))
}

/// Looks for a trajectory that excites the base parameters of `robot`; `tell` hears what each
/// start does, from several threads, and says whether to go on. If not, each start ends where it
/// is.
pub fn excite(
    robot: &Robot,
    options: &ExciteOptions,
    tell: &(dyn Fn(&Progress) -> bool + Sync),
) -> Result<Excited, Error> {
    let (model, space, stack, _) = prepared(robot, options)?;
    let search = Search { options, model: &model, space: &space, stack: &stack };
    let starts = search.run(tell);
    let mut best = 0;
    for (index, start) in starts.iter().enumerate() {
        if start.rank().is_below(starts[best].rank()) {
            best = index;
        }
    }
    Ok(Excited { model, stack, space, starts, best })
}

/// Checks a trajectory that is given: joints that it does not move are held.
pub fn check_trajectory(
    robot: &Robot,
    options: &ExciteOptions,
    trajectory: &Trajectory,
) -> Result<(Check, Stack), Error> {
    let joints: Vec<&String> = robot.joints().map(|(link, _)| &robot.links[link].name).collect();
    let unknown = |(name, _): &(String, Reference)| {
        let nearest = denavit_codegen::expr::text::nearest(name, joints.iter().map(|j| j.as_str()));
        let (option, nearest) = ("the trajectory", nearest.map(str::to_owned));
        let is_unknown = !joints.contains(&name);
        is_unknown.then(|| ExciteFault::UnknownJoint { option, name: name.clone(), nearest })
    };
    Error::of(&robot.name, trajectory.joints.iter().filter_map(unknown).collect())?;
    let mut options = options.clone();
    options.duration_s = trajectory.duration_s;
    for &joint in &joints {
        let is_held = options.hold.iter().any(|(held, _)| held == joint);
        if trajectory.find(joint).is_none() && !is_held {
            options.hold.push((joint.clone(), 0.0));
        }
    }
    let mut faults = Vec::new();
    let model = options.model(robot, &mut faults);
    Error::of(&robot.name, faults)?;
    let Some(model) = model else { unreachable!("what is missing has been reported") };
    let (stack, mut evaluators) = stacked(robot, &model)?;
    let reference = |joint: &JointLimits| match (trajectory.find(&joint.name), joint.held) {
        (Some(reference), None) => reference.clone(),
        (_, held) => Reference::Constant(held.unwrap_or(0.0)),
    };
    let references: Vec<Reference> = model.joints.iter().map(reference).collect();
    let lap = Lap {
        duration_s: trajectory.duration_s,
        steps: CHECKED_STEPS,
        clearance_m: options.clearance_m.unwrap_or(f64::NEG_INFINITY),
    };
    Ok((check(&model, &stack, &mut evaluators, &references, lap), stack))
}

/// Steps of the grid on which trajectories are checked.
const CHECKED_STEPS: usize = 2_000;

impl Excited {
    /// The best start.
    pub fn found(&self) -> &StartReport {
        &self.starts[self.best]
    }

    /// The references of all joints, in the order of q.
    pub fn references(&self) -> Vec<Reference> {
        references(&self.model, &self.space, &self.found().coordinates)
    }

    /// The trajectory file.
    pub fn to_json(&self, name: &str, remarks: &Value) -> Value {
        let coordinates = &self.found().coordinates;
        trajectory_file(&self.model, &self.space, coordinates, name, remarks)
    }
}

/// A trajectory as a file, with its name and how it was found.
fn trajectory_file(
    model: &ExcitedModel,
    space: &Space,
    coordinates: &[f64],
    name: &str,
    remarks: &Value,
) -> Value {
    let count = space.coordinates();
    let mut joints = Map::new();
    for (place, joint) in model.moving().into_iter().enumerate() {
        let limits = &model.joints[joint];
        let own = &coordinates[place * count..(place + 1) * count];
        let written = space.written(own, limits.middle(), limits.half());
        joints.insert(limits.name.clone(), written);
    }
    for limits in &model.joints {
        if let Some(held) = limits.held.filter(|_| !limits.name.starts_with("base_")) {
            joints.insert(limits.name.clone(), json!(held));
        }
    }
    json!({
        "format": TRAJECTORY_FORMAT,
        "name": name,
        "model": model.regression.model,
        "duration_s": space.duration_s(),
        "periodic": space.is_periodic(),
        "joints": joints,
        "excitation": remarks,
    })
}

fn references(model: &ExcitedModel, space: &Space, coordinates: &[f64]) -> Vec<Reference> {
    let count = space.coordinates();
    let held = |joint: &JointLimits| Reference::Constant(joint.middle());
    let mut references: Vec<Reference> = model.joints.iter().map(held).collect();
    for (place, joint) in model.moving().into_iter().enumerate() {
        let limits = &model.joints[joint];
        let own = &coordinates[place * count..(place + 1) * count];
        if let Ok(reference) = space.reference(own, limits.middle(), limits.half()) {
            references[joint] = reference;
        }
    }
    references
}

/// The search, shared by all threads.
struct Search<'a> {
    options: &'a ExciteOptions,
    model: &'a ExcitedModel,
    space: &'a Space,
    stack: &'a Stack,
}

impl Search<'_> {
    /// The starts in order; each thread takes the next that nobody has taken.
    fn run(&self, tell: &(dyn Fn(&Progress) -> bool + Sync)) -> Vec<StartReport> {
        let count = self.options.starts;
        let machine = thread::available_parallelism().map_or(1, usize::from);
        let threads = self.options.threads.unwrap_or(machine).clamp(1, count);
        let next = AtomicUsize::new(0);
        let done: Mutex<Vec<(usize, StartReport)>> = Mutex::new(Vec::new());
        thread::scope(|scope| {
            for _ in 0..threads {
                scope.spawn(|| {
                    let mut evaluators = self.model.evaluators();
                    loop {
                        let start = next.fetch_add(1, Ordering::Relaxed);
                        if start >= count {
                            return;
                        }
                        let report = self.start(start, &mut evaluators, tell);
                        let mut done = done.lock().expect("no thread panics while it holds this");
                        done.push((start, report));
                    }
                });
            }
        });
        let mut done = done.into_inner().expect("all threads have ended well");
        done.sort_by_key(|(start, _)| *start);
        done.into_iter().map(|(_, report)| report).collect()
    }

    fn start(
        &self,
        start: usize,
        evaluators: &mut Evaluators,
        tell: &(dyn Fn(&Progress) -> bool + Sync),
    ) -> StartReport {
        let mut problem = Problem {
            model: self.model,
            space: self.space,
            stack: self.stack,
            objective: self.options.objective,
            clearance_m: self.clearance_m(),
            reserve: RESERVE,
            sharpness: SHARPNESS[0],
        };
        let mut x = self.beginning(start);
        let began = self.judged(&x, evaluators);
        let mut best = self.candidate(x.clone(), evaluators);
        let (mut evaluations, mut iterates) = (0, Vec::new());
        let mut stop = SolverStop::Stuck;
        let first = (FIRST_SHARE * self.options.evaluations as f64) as usize;
        for (sharpness, most) in SHARPNESS.into_iter().zip([first, usize::MAX]) {
            // what the first solution does not need is for the second
            let most = most.min(self.options.evaluations.saturating_sub(evaluations));
            problem.sharpness = sharpness;
            let before = evaluations;
            let tell_start = |iterate: &Iterate, evaluations: usize| {
                let evaluations = before + evaluations;
                tell(&Progress { start, evaluations, iterate: *iterate })
            };
            let solved = solve::solve(&problem, evaluators, &x, most, &tell_start);
            x = solved.x;
            // few evaluations may end where it is worse than on the way
            let candidate = self.candidate(x.clone(), evaluators);
            if !best.rank().is_below(candidate.rank()) {
                best = candidate;
            }
            stop = solved.stop;
            evaluations += solved.evaluations;
            iterates.extend(solved.iterates);
            if stop == SolverStop::Watcher {
                break;
            }
        }
        let Candidate { x: coordinates, shrunk, check: ended, objective } = best;
        StartReport { began, ended, objective, stop, evaluations, shrunk, iterates, coordinates }
    }

    fn candidate(&self, x: Vec<f64>, evaluators: &mut Evaluators) -> Candidate {
        let (x, shrunk) = self.within_limits(x, evaluators);
        let check = self.judged(&x, evaluators);
        let objective = objective(&self.options.objective, &check, self.stack.names.len());
        Candidate { x, shrunk, check, objective }
    }

    fn clearance_m(&self) -> f64 {
        self.options.clearance_m.unwrap_or(f64::NEG_INFINITY)
    }

    /// Coordinates at random whose motion uses the limits of position, rate and acceleration by as
    /// much as asked for.
    fn beginning(&self, start: usize) -> Vec<f64> {
        let mut random = Random::new(self.options.seed);
        let mut random = Random::new(random.bits().wrapping_add(start as u64));
        let mut x = Vec::new();
        for joint in self.model.moving() {
            let limits = &self.model.joints[joint];
            let own = self.space.random(|| random.uniform());
            let curve = self.space.curve(&own);
            let ranges =
                [1.0, limits.velocity / limits.half(), limits.acceleration / limits.half()];
            let uses = curve
                .iter()
                .zip(ranges)
                .flat_map(|(values, range)| values.iter().map(move |value| value.abs() / range));
            let most = uses.fold(0.0, f64::max);
            let factor = if most > 0.0 { self.options.reach / most } else { 1.0 };
            x.extend(self.space.scaled(&own, factor));
        }
        x
    }

    fn judged(&self, x: &[f64], evaluators: &mut Evaluators) -> Check {
        let references = references(self.model, self.space, x);
        check(self.model, self.stack, evaluators, &references, self.lap())
    }

    fn is_safe(&self, x: &[f64], evaluators: &mut Evaluators) -> bool {
        let references = references(self.model, self.space, x);
        limit_use(self.model, evaluators, &references, self.lap()).worst() <= SAFE
    }

    fn lap(&self) -> Lap {
        let (duration_s, clearance_m) = (self.space.duration_s(), self.clearance_m());
        Lap { duration_s, steps: CHECKED_STEPS, clearance_m }
    }

    /// The motion made smaller about its middle by the least factor that keeps all limits; as it
    /// is if none does.
    fn within_limits(&self, x: Vec<f64>, evaluators: &mut Evaluators) -> (Vec<f64>, f64) {
        if self.is_safe(&x, evaluators) {
            return (x, 1.0);
        }
        let count = self.space.coordinates();
        let smaller = |factor: f64| -> Vec<f64> {
            x.chunks_exact(count).flat_map(|own| self.space.scaled(own, factor)).collect()
        };
        let (mut good, mut bad) = (0.0, 1.0);
        if !self.is_safe(&smaller(good), evaluators) {
            return (x, 1.0);
        }
        for _ in 0..30 {
            let middle = 0.5 * (good + bad);
            match self.is_safe(&smaller(middle), evaluators) {
                true => good = middle,
                false => bad = middle,
            }
        }
        (smaller(good), good)
    }
}

/// The objective of what was found on the finer grid.
fn objective(objective: &Objective, check: &Check, columns: usize) -> f64 {
    let Excitation { condition, condition_scaled, log_determinant } = check.excitation;
    let condition = if objective.is_scaled { condition_scaled } else { condition };
    let mut value = 0.0;
    if objective.condition > 0.0 {
        value += objective.condition * condition.ln();
    }
    if objective.determinant > 0.0 {
        value -= objective.determinant * log_determinant / columns.max(1) as f64;
    }
    value
}
