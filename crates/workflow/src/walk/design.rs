//! From a gait file to a scenario that walks.

use crate::error::{Cause, Error};
use crate::files::Files;
use crate::mistaken::FileKind;
use denavit_codegen::effect;
use denavit_codegen::model::json as file;
use denavit_plants::trajectory::Reference;
use denavit_plants::{Plant, PlantModel, plant_of, shipped};
use denavit_simulate::scenario::Scenario;
use denavit_walk::gait_file::{FORMAT, GaitFile, GaitKind, read_gait};
use denavit_walk::gait_plan::{
    GaitPlan, Knot, plan_divergent_component, plan_inverted_pendulum, plan_primitives,
};
use denavit_walk::optimal::{LimitCycle, design, scenario_text};
use denavit_walk::{ScenarioHead, read_scenario};
use std::borrow::Cow;
use std::path::Path;

/// A gait file that was read.
#[derive(Debug)]
pub struct Gait {
    name: String,
    file: GaitFile,
}

impl Gait {
    /// Whether references alone walk it: a limit cycle has torques and gains of its own.
    pub fn has_trajectory(&self) -> bool {
        !matches!(self.file.kind, GaitKind::LimitCycle(_))
    }
}

impl Files {
    /// The gait of a path or of a shipped name.
    ///
    /// # Errors
    /// All that is wrong with it, or why it is not read.
    pub fn gait(&self, path: &Path) -> Result<Gait, Error> {
        let name = path.display().to_string();
        let bytes = self.bytes_or_shipped(path, "gait", shipped::GAITS, FileKind::Gait)?;
        let file = read_gait(&name, &bytes).map_err(Cause::Scenario)?;
        Ok(Gait { name, file })
    }

    /// A scenario, or that of a gait, which is designed for it.
    ///
    /// # Errors
    /// All that is wrong with it, why it is not read, or why the gait cannot be.
    pub fn scenario_or_gait(&self, path: &Path) -> Result<Scenario, Error> {
        if !is_gait(self, path) {
            return self.scenario(path);
        }
        let gait = self.gait(path)?;
        let designed = design_gait(self, &gait, path, None)?;
        let load = |model: &str| self.beside(path, model);
        let read = read_scenario(&gait.name, designed.scenario.as_bytes(), &load);
        Ok(read.map_err(Cause::Scenario)?)
    }
}

const MODEL: &str = "`model` is a shipped model, or a file from the gait file's directory";

fn refused(name: &str, why: impl std::fmt::Display) -> Error {
    Cause::Walk(name.to_owned(), why.to_string()).into()
}

/// Designs a gait. The path of its file, and `output`, where its scenario goes, say how the
/// scenario calls its model.
///
/// # Errors
/// Why the gait cannot be, with posture, time and residual.
pub fn design_gait(
    files: &Files,
    gait: &Gait,
    gait_file: &Path,
    output: Option<&Path>,
) -> Result<Designed, Error> {
    designed(files, gait_file, output, &gait.name, &gait.file)
}

/// A gait that was designed.
#[derive(Debug)]
pub struct Designed {
    /// The gait.
    pub name: String,
    /// What kind of gait it is.
    pub kind: &'static str,
    /// Its robot.
    pub model: PlantModel,
    /// The scenario that walks, as its file.
    pub scenario: String,
    /// The joint references alone, as a trajectory file; none where these alone do not walk.
    pub trajectory: Option<String>,
    /// Quantities in their order.
    pub rows: Vec<GaitQuantity>,
    /// Postures.
    pub knots: Vec<Knot>,
    /// Joint angles over a step.
    pub curves: GaitCurves,
}

/// A quantity of a gait: for people a name, its value, and where; for JSON a key.
#[derive(Clone, Debug)]
pub struct GaitQuantity {
    /// The key of JSON.
    pub key: &'static str,
    /// The name.
    pub name: &'static str,
    /// The value.
    pub number: f64,
    /// The value with its unit.
    pub shown: String,
    /// Where and when it is so, if that matters.
    pub place: String,
}

impl GaitQuantity {
    fn new(key: &'static str, name: &'static str, number: f64, shown: String) -> Self {
        Self { key, name, number, shown, place: String::new() }
    }

    fn at(self, knot: &Knot) -> Self {
        Self { place: format!("{} at {:.3} s", knot.name, knot.t_s), ..self }
    }
}

/// Joint angles over a step.
#[derive(Clone, Debug)]
pub struct GaitCurves {
    /// Times \[s\].
    pub times_s: Vec<f64>,
    /// Joints with their positions \[rad, m\] at these times.
    pub joints: Vec<(String, Vec<f64>)>,
    /// Which of the times are those of postures.
    pub postures: Vec<usize>,
}

/// Whether this names a gait and no scenario: a file that says so, or a shipped gait.
fn is_gait(files: &Files, path: &Path) -> bool {
    if path.exists() || path == Path::new("-") {
        let bytes = files.bytes(path).unwrap_or_default();
        let is_tag = |(key, tag): &(Cow<'_, str>, file::Json<'_>)| {
            key == "format" && matches!(&tag.value, file::Value::Text(tag) if tag == FORMAT)
        };
        return file::parse(&bytes).is_ok_and(|root| root.entries().iter().any(is_tag));
    }
    let is_in = |list: &[shipped::ShippedModel]| list.iter().any(|one| Path::new(one.name) == path);
    is_in(shipped::GAITS) && !is_in(shipped::SCENARIOS)
}

/// Designs a gait; its file, and where the scenario goes, say how the scenario calls its model.
fn designed(
    files: &Files,
    gait_file: &Path,
    output: Option<&Path>,
    name: &str,
    gait: &GaitFile,
) -> Result<Designed, Error> {
    let bytes = files
        .beside(gait_file, &gait.model)
        .map_err(|why| refused(name, format_args!("{}: {why}\n  hint: {MODEL}", gait.model)))?;
    let robot = effect::read_model(&gait.model, &bytes, &[]).map_err(Cause::Model)?;
    let mut plant = plant_of(&robot, &gait.parameters).map_err(|error| refused(name, error))?;
    let stem = gait_file.file_stem().unwrap_or_default().to_string_lossy();
    let own = if gait.name.is_empty() { stem.into_owned() } else { gait.name.clone() };
    let model = model_from(gait_file, output, &gait.model);
    let source = format!("`denavit walk design` from the gait {own}");
    let head = ScenarioHead {
        name: &own,
        description: &gait.description,
        source: &source,
        model: &model,
        parameters: &gait.parameters,
        steps: 0,
    };
    let refuse = |error: denavit_walk::Error| match error.hint() {
        Some(hint) => refused(name, format_args!("{error}\n  hint: {hint}")),
        None => refused(name, error),
    };
    let plant = plant.as_mut();
    match &gait.kind {
        GaitKind::Primitives(problem) => {
            let plan = plan_primitives(plant, problem).map_err(refuse)?;
            Ok(planned("walking primitives", plan, plant, &head).map_err(refuse)?)
        }
        GaitKind::InvertedPendulum(problem) => {
            let plan = plan_inverted_pendulum(plant, problem).map_err(refuse)?;
            Ok(planned("linear inverted pendulum", plan, plant, &head).map_err(refuse)?)
        }
        GaitKind::DivergentComponent(problem) => {
            let plan = plan_divergent_component(plant, problem).map_err(refuse)?;
            Ok(planned("divergent component of motion", plan, plant, &head).map_err(refuse)?)
        }
        GaitKind::LimitCycle(problem) => {
            let found = design(plant, problem).map_err(refuse)?;
            let head = ScenarioHead { steps: problem.steps, ..head };
            limit_cycle(found, plant, &head).map_err(|error| refused(name, error))
        }
    }
}

/// What the scenario calls its model: paths are taken from the scenario's directory.
fn model_from(gait: &Path, output: Option<&Path>, model: &str) -> String {
    if shipped::find_referred(model).is_some() {
        return model.to_owned();
    }
    let directory = |path: &Path| {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        parent.unwrap_or(Path::new(".")).canonicalize().ok()
    };
    let from = directory(gait);
    let file = output.filter(|path| path.as_os_str() != "-");
    if file.is_none_or(|path| directory(path) == from) {
        return model.to_owned();
    }
    let place = from.map(|from| from.join(model)).and_then(|path| path.canonicalize().ok());
    place.map_or_else(|| model.to_owned(), |path| path.display().to_string())
}

/// Times at which the picture shows joint angles.
const SHOWN: usize = 400;

fn curves(
    model: &PlantModel,
    references: &[Option<Reference>],
    end_s: f64,
    marked_s: impl Iterator<Item = f64>,
) -> GaitCurves {
    let mut times_s: Vec<f64> = (0..=SHOWN).map(|k| end_s * k as f64 / SHOWN as f64).collect();
    let marked_s: Vec<f64> = marked_s.collect();
    times_s.extend(&marked_s);
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    let joints = model.joints.iter().zip(references).filter_map(|(joint, reference)| {
        let reference = reference.as_ref()?;
        let values = times_s.iter().map(|t_s| reference.at(*t_s).position).collect();
        Some((joint.name.clone(), values))
    });
    let joints = joints.collect();
    let place = |marked: &f64| times_s.iter().position(|t_s| t_s == marked);
    let postures = marked_s.iter().filter_map(place).collect();
    GaitCurves { times_s, joints, postures }
}

fn planned(
    kind: &'static str,
    plan: GaitPlan,
    plant: &mut dyn Plant,
    head: &ScenarioHead<'_>,
) -> Result<Designed, denavit_walk::Error> {
    let model = plant.model().clone();
    let references = plan.references(&model)?;
    // of a step where one is like the other
    let end_s = if plan.repeats { plan.step_s } else { plan.duration_s };
    let marked = plan.knots.iter().filter(|knot| plan.repeats && knot.is_solved);
    let curves = curves(&model, &references, end_s, marked.map(|knot| knot.t_s));
    Ok(Designed {
        name: head.name.to_owned(),
        kind,
        scenario: plan.scenario_text(&model, head),
        trajectory: Some(plan.trajectory_text(&model, head)),
        rows: rows(&plan),
        knots: plan.knots,
        curves,
        model,
    })
}

fn rows(plan: &GaitPlan) -> Vec<GaitQuantity> {
    let millimetres = |length_m: f64| format!("{:.1} mm", 1e3 * length_m);
    let (length, step_s, speed) = (plan.step_length_m, plan.step_s, plan.speed_m_s());
    let mut rows = vec![
        GaitQuantity::new("step_length_m", "step length", length, format!("{length:.4} m")),
        GaitQuantity::new("step_s", "step time", step_s, format!("{step_s:.4} s")),
        GaitQuantity::new("steps", "steps", plan.steps as f64, plan.steps.to_string()),
        GaitQuantity::new("speed_m_s", "mean speed", speed, format!("{speed:.4} m/s")),
    ];
    let residuals = [
        ("residual", "largest residual of inverse kinematics", plan.worst(true)),
        ("residual_between", "largest residual between knots", plan.worst(false)),
    ];
    for (key, name, knot) in residuals {
        rows.extend(knot.map(|knot| {
            GaitQuantity::new(key, name, knot.residual, format!("{:.1e}", knot.residual)).at(knot)
        }));
    }
    rows.extend(plan.least_static().map(|knot| {
        let margin = knot.static_margin_m;
        GaitQuantity::new("static_margin_m", "least static margin", margin, millimetres(margin))
            .at(knot)
    }));
    rows.extend(plan.least_pressure().and_then(|knot| {
        let (margin, name) = (knot.pressure_margin_m?, "least margin of the planned ZMP");
        Some(GaitQuantity::new("zmp_margin_m", name, margin, millimetres(margin)).at(knot))
    }));
    rows
}

fn limit_cycle(
    found: LimitCycle,
    plant: &mut dyn Plant,
    head: &ScenarioHead<'_>,
) -> Result<Designed, denavit_plants::Error> {
    let model = plant.model().clone();
    let step = &found.step;
    let mut references = vec![None; model.joints.len()];
    for joint in &step.legs.driven {
        references[*joint] = Some(step.reference(*joint)?);
    }
    let ends = step.phases.iter().scan(0.0, |end_s, phase| {
        let start_s = *end_s;
        *end_s += phase.duration_s;
        Some(start_s)
    });
    let curves = curves(&model, &references, step.period_s, ends);
    let (length, period, speed) = (step.length_m, step.period_s, step.length_m / step.period_s);
    let (largest, cost) = (found.cycle.largest_multiplier(), found.planned_cost_of_transport);
    let rows = vec![
        GaitQuantity::new("step_length_m", "step length", length, format!("{length:.4} m")),
        GaitQuantity::new("step_s", "step time", period, format!("{period:.4} s")),
        GaitQuantity::new("steps", "steps", head.steps as f64, head.steps.to_string()),
        GaitQuantity::new("speed_m_s", "mean speed", speed, format!("{speed:.4} m/s")),
        GaitQuantity::new(
            "largest_multiplier",
            "largest multiplier",
            largest,
            format!("{largest:.4}"),
        ),
        GaitQuantity::new(
            "cost_of_transport",
            "planned cost of transport",
            cost,
            format!("{cost:.4}"),
        ),
    ];
    Ok(Designed {
        name: head.name.to_owned(),
        kind: "limit cycle",
        scenario: scenario_text(&found, &model, head),
        trajectory: None,
        rows,
        knots: Vec::new(),
        curves,
        model,
    })
}
