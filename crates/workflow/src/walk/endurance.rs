//! What gaits endure: starts off their cycle, pushes, and steps onto the capture point.

use crate::error::{Cause, Error};
use crate::files::Files;
use crate::observer::{Observer, Progress, Stage, Watched};
use denavit_plants::{PlantModel, PointModel};
use denavit_simulate::scenario::Scenario;
use denavit_walk::capturability::Capturability;
use denavit_walk::capture_step::{law_of, step_limits};
use denavit_walk::comparison::{Compared, compare};
use denavit_walk::poincare::{PoincareAnalysis, PoincareOptions, analyse};
use denavit_walk::robustness::{
    BasinOptions, BasinStart, CapturePush, CapturePushOptions, FALLBACK_FRICTION, LeastPush,
    PushOptions, basin, capture_pushes, grid, least_pushes, noise,
};
use denavit_walk::{Error as WalkError, balance::check_walker};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc;
use std::thread;

/// From where a gait is walked.
#[derive(Clone, Debug, PartialEq)]
pub enum Starts {
    /// Two coordinates, `q_JOINT` or `qd_JOINT`, are varied on a grid: from minus to plus their
    /// reach [rad, rad/s, m, m/s], with `count` values each.
    Grid {
        /// The coordinates.
        vary: [String; 2],
        /// How far each is varied.
        reach: [f64; 2],
        /// Values of each.
        count: usize,
    },
    /// All joint velocities are normal, with this standard deviation [rad/s].
    Noise {
        /// The standard deviation.
        deviation: f64,
        /// How many starts.
        count: usize,
        /// Of the random numbers.
        seed: u64,
    },
}

/// Starts off the cycle of a gait, and what became of them.
#[derive(Debug)]
pub struct GaitBasin {
    /// The scenario.
    pub name: String,
    /// The robot.
    pub model: PlantModel,
    /// The starts; fewer than were asked for if the work was stopped.
    pub starts: Vec<BasinStart>,
    /// Whether the observer stopped the work.
    pub is_stopped: bool,
}

/// How a gait is pushed.
#[derive(Clone, Debug, PartialEq)]
pub struct PushQuestion {
    /// The link that is pushed, at the origin of its frame; the last of the base without it.
    pub link: Option<String>,
    /// How many times in the cycle.
    pub times: usize,
    /// The one of them that is tried, from 0; all without it.
    pub only: Option<usize>,
    /// The strongest impulse that is tried [N s].
    pub most_ns: f64,
    /// The least impulse is found to this [N s]; the strongest over 256 without it.
    pub resolution_ns: Option<f64>,
    /// How long the robot must walk on \[s\].
    pub after_s: f64,
}

/// A gait that was pushed.
#[derive(Debug)]
pub struct PushedGait {
    /// The scenario.
    pub name: String,
    /// The robot.
    pub model: PlantModel,
    /// The pushes that were tried.
    pub options: PushOptions,
    /// The least that fell it; fewer than times and directions if the work was stopped.
    pub found: Vec<LeastPush>,
    /// Whether the observer stopped the work.
    pub is_stopped: bool,
}

/// Walks from starts around the cycle of a gait. `cycles` are those that each start is to walk.
///
/// # Errors
/// Coordinates that there are not, a gait without a cycle, all that is wrong with the scenario.
pub fn gait_basin(
    files: &Files,
    path: &Path,
    starts: &Starts,
    cycles: usize,
    observer: &mut dyn Observer,
) -> Result<GaitBasin, Error> {
    let mut scenario = disturbed(files, path)?;
    let (name, model) = (scenario.name.clone(), scenario.plant.model().clone());
    let deviations = match starts {
        Starts::Noise { deviation, count, seed } => {
            noise(scenario.plant.as_ref(), *deviation, *count, *seed)
        }
        Starts::Grid { vary, reach, count } => {
            let entries = [coordinate(&model, &vary[0])?, coordinate(&model, &vary[1])?];
            if entries[0] == entries[1] {
                let why = format!("`{}` twice\n  hint: name two coordinates", vary[0]);
                return Err(Cause::Walk("`options.vary`".to_owned(), why).into());
            }
            grid(model.joints.len(), entries, *reach, *count)
        }
    };
    let mut watched = Watched::new(observer);
    if !watched.begins(Stage::FollowingCycle) {
        return Err(Cause::Stopped.into());
    }
    let found = cycle(&mut scenario).map_err(|error| of_walk(&name, &error))?;
    let open = || disturbed(files, path).ok();
    let starts = counted(&mut watched, Stage::Starts, &|tell| {
        basin(&open, &found.cycle, &deviations, &BasinOptions { cycles }, tell)
    });
    Ok(GaitBasin { name, model, starts, is_stopped: watched.is_stopped })
}

/// Finds the least pushes that fell a robot, over the time in its cycle and the direction; without
/// a cycle, after the start of the scenario. Pushes of the scenario itself are left out.
///
/// # Errors
/// A robot that cannot fall, a link that there is not, all that is wrong with the scenario.
pub fn push_gait(
    files: &Files,
    path: &Path,
    question: &PushQuestion,
    observer: &mut dyn Observer,
) -> Result<PushedGait, Error> {
    let mut scenario = pushable(files, path)?;
    let name = scenario.name.clone();
    check_walker(scenario.plant.as_mut()).map_err(|error| of_walk(&name, &error))?;
    let model = scenario.plant.model().clone();
    let link = pushed_link(&model, question.link.as_deref())?;
    let (start, period_s) = match cycle(&mut scenario) {
        Ok(found) => (found.cycle.chart.base, found.cycle.period_s),
        Err(_) => {
            let length_s = scenario.simulation.end_s - scenario.initial.t_s;
            (scenario.initial.clone(), length_s)
        }
    };
    let (count, only) = (question.times, question.only);
    if let Some(only) = only.filter(|only| *only >= count) {
        let why = format!("there are times 0 to {}, and no {only}", count - 1);
        return Err(Cause::Walk("`options.only`".to_owned(), why).into());
    }
    let tried = only.map_or(0..count, |only| only..only + 1);
    let directions = if model.planar {
        vec![[1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]]
    } else {
        vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]
    };
    let options = PushOptions {
        point: PointModel { name: "pushed".to_owned(), link, position: [0.0; 3] },
        times_s: tried.map(|k| period_s * k as f64 / count as f64).collect(),
        directions,
        most_ns: question.most_ns,
        coarse: 8,
        resolution_ns: question.resolution_ns.unwrap_or(question.most_ns / 256.0),
        after_s: question.after_s,
    };
    let mut watched = Watched::new(observer);
    let open = || pushable(files, path).ok();
    let found =
        counted(&mut watched, Stage::Pushes, &|tell| least_pushes(&open, &start, &options, tell));
    Ok(PushedGait { name, model, options, found, is_stopped: watched.is_stopped })
}

/// Pushes a robot that steps onto its capture point by each of these impulses [N s], in place of
/// the push of its scenario, and predicts its steps. Holds the scenario's name and the pushes.
///
/// # Errors
/// A scenario without such a controller or without a push, and all that is wrong with it.
pub fn push_stepping_robot(
    files: &Files,
    path: &Path,
    impulses_ns: &[f64],
    after_s: f64,
    observer: &mut dyn Observer,
) -> Result<(String, Vec<CapturePush>), Error> {
    let mut scenario = files.scenario(path)?;
    let name = scenario.name.clone();
    let lacks = |what: &str| Error::from(Cause::Walk(name.clone(), what.to_owned()));
    if law_of(&scenario).is_none() {
        return Err(lacks("no controller that steps: `\"gait\": {\"capture_step\": {..}}`"));
    }
    let push = scenario.simulation.pushes.first();
    let push = push.ok_or_else(|| lacks("no push, whose point and time are taken: `pushes`"))?;
    let options = CapturePushOptions {
        point: push.point.clone(),
        at_s: push.at_s - scenario.initial.t_s,
        impulses_ns: impulses_ns.to_vec(),
        after_s,
    };
    let limits = step_limits(&mut scenario).map_err(|error| of_walk(&name, &error))?;
    let found = Capturability::new(limits).map_err(|error| of_walk(&name, &error))?;
    let open = || files.scenario(path).ok();
    let pushes = counted(&mut Watched::new(observer), Stage::Pushes, &|tell| {
        capture_pushes(&open, &found, &options, tell)
    });
    Ok((name, pushes))
}

/// What each criterion of stability says of the run of a scenario, at instants of this distance
/// \[s\], and what comes out.
///
/// # Errors
/// A robot that does not walk, and all that is wrong with the scenario.
pub fn compare_criteria(files: &Files, path: &Path, period_s: f64) -> Result<Compared, Error> {
    let mut scenario = disturbed(files, path)?;
    let found = compare(&mut scenario, period_s);
    found.map_err(|error| of_walk(&path.display().to_string(), &error))
}

/// Work of many parts in threads of its own, whose count the observer hears in this one.
fn counted<T: Send>(
    watched: &mut Watched<'_>,
    stage: Stage,
    work: &(dyn Fn(&denavit_walk::robustness::Observer<'_>) -> T + Sync),
) -> T {
    let is_stopped = AtomicBool::new(false);
    let (sender, heard) = mpsc::channel::<f64>();
    let done = thread::scope(|scope| {
        let is_stopped = &is_stopped;
        let working = scope.spawn(move || {
            let tell = |done: usize, all: usize| {
                let share = done as f64 / all.max(1) as f64;
                sender.send(share).is_ok() && !is_stopped.load(Ordering::Relaxed)
            };
            work(&tell)
        });
        for share in heard {
            let at = Progress { stage, share: Some(share), ..Progress::default() };
            if !watched.progress(&at) {
                is_stopped.store(true, Ordering::Relaxed);
            }
        }
        working.join()
    });
    done.unwrap_or_else(|panicked| std::panic::resume_unwind(panicked))
}

fn of_walk(name: &str, error: &WalkError) -> Error {
    Cause::Walk(name.to_owned(), error.to_string()).into()
}

/// The scenario as it is pushed: its own pushes are others.
fn pushable(files: &Files, path: &Path) -> Result<Scenario, Error> {
    let mut scenario = disturbed(files, path)?;
    scenario.simulation.pushes.clear();
    Ok(scenario)
}

/// The scenario as disturbed runs need it.
fn disturbed(files: &Files, path: &Path) -> Result<Scenario, Error> {
    let mut scenario = files.scenario(path)?;
    scenario.simulation.touching.fallback_friction.get_or_insert(FALLBACK_FRICTION);
    Ok(scenario)
}

/// The cycle of a gait.
fn cycle(scenario: &mut Scenario) -> Result<PoincareAnalysis, WalkError> {
    analyse(scenario, &PoincareOptions { checks: false, ..PoincareOptions::default() })
}

/// The number of a coordinate: of q, or beyond these of qd.
fn coordinate(model: &PlantModel, name: &str) -> Result<usize, Error> {
    let n = model.joints.len();
    let of = |prefix: &str, first: usize| {
        let joint = name.strip_prefix(prefix)?;
        model.find_joint(joint).map(|joint| first + joint)
    };
    of("qd_", n).or_else(|| of("q_", 0)).ok_or_else(|| {
        let why = format!("`options.vary`: `{name}` is no q_JOINT or qd_JOINT of {}", model.name);
        Cause::Walk(model.name.clone(), why).into()
    })
}

fn pushed_link(model: &PlantModel, name: Option<&str>) -> Result<usize, Error> {
    let Some(name) = name else {
        // the frame of the base's last generated joint is that of its body
        let base = model.joints.iter().rposition(|joint| !joint.drivable);
        let is_base = |link: &String| base.is_some_and(|base| *link == model.joints[base].name);
        return Ok(model.links.iter().position(is_base).unwrap_or(0));
    };
    let found = model.links.iter().position(|link| link == name);
    found.ok_or_else(|| {
        let why = format!("`options.link`: no link is called `{name}`");
        Cause::Walk(model.name.clone(), why).into()
    })
}
