//! `denavit walk design`: from a gait file to a scenario that walks.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::{load_beside, read_file, read_or_shipped};
use super::super::json::{Ordered, write_json};
use super::super::mistaken::Wanted;
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::super::simulate::open;
use clap::Args;
use denavit::effect;
use denavit::model::json as file;
use denavit::plants::trajectory::Reference;
use denavit::plants::{Plant, PlantModel, plant_of};
use denavit::report::{Align, GaitCurve, GaitPicture, Table};
use denavit::shipped;
use denavit::simulate::scenario::Scenario;
use denavit::walk::gait_file::{FORMAT, GaitFile, GaitKind, read_gait};
use denavit::walk::gait_plan::{
    GaitPlan, Knot, PlanError, plan_divergent_component, plan_inverted_pendulum, plan_primitives,
};
use denavit::walk::optimal::{LimitCycle, design, scenario_text};
use denavit::walk::{ScenarioHead, read_scenario};
use serde_json::{Map, Value, json as value};
use std::borrow::Cow;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Design a gait: from a file of a few lines to a scenario that walks (thesis 4.4.2, 4.4.3)
///
/// Gaits are walking primitives, walks by the linear inverted pendulum, walks in space on planned
/// footsteps, and limit cycles; docs/reference/gait.md describes their files. Residuals of inverse
/// kinematics and margins are reported at every posture and between. A gait that cannot be exits
/// with 2, and is named with posture, time and residual.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk design planar_biped_primitives -o primitives.json --svg joints.svg
  denavit walk design planar_biped_inverted_pendulum -o pendulum.json
  denavit walk design tulip_walk -o walk.json")]
pub(crate) struct Arguments {
    /// The path of a gait file, or the name of a shipped gait
    #[arg(value_name = "GAIT")]
    gait: PathBuf,
    /// Where the scenario goes, complete, for `denavit simulate`; - is standard output
    #[arg(short, long, value_name = "SCENARIO")]
    output: Option<PathBuf>,
    /// Where the joint references alone go (denavit-trajectory/1); - is standard output
    #[arg(long, value_name = "FILE")]
    trajectory: Option<PathBuf>,
    /// Draw joint angles over a step with the postures marked (thesis figure 4.2); - is standard
    /// output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

/// A gait that was designed.
struct Designed {
    name: String,
    kind: &'static str,
    model: PlantModel,
    scenario: String,
    /// None where references alone do not walk.
    trajectory: Option<String>,
    /// Quantities in their order: for people a name, its value, and where; for JSON a key.
    rows: Vec<Row>,
    knots: Vec<Knot>,
    curves: Curves,
}

struct Row {
    key: &'static str,
    name: &'static str,
    number: f64,
    shown: String,
    place: String,
}

impl Row {
    fn new(key: &'static str, name: &'static str, number: f64, shown: String) -> Self {
        Self { key, name, number, shown, place: String::new() }
    }

    fn at(self, knot: &Knot) -> Self {
        Self { place: format!("{} at {:.3} s", knot.name, knot.t_s), ..self }
    }
}

/// Joint angles over a step.
struct Curves {
    times_s: Vec<f64>,
    joints: Vec<GaitCurve>,
    postures: Vec<usize>,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs =
        [arguments.output.as_ref(), arguments.trajectory.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let name = arguments.gait.display().to_string();
    let bytes = read_or_shipped(&arguments.gait, ("gait", shipped::GAITS), Wanted::Gait)?;
    let gait = read_gait(&name, &bytes).map_err(Failure::Scenario)?;
    if arguments.trajectory.is_some() && matches!(gait.kind, GaitKind::LimitCycle(_)) {
        return Err(refused(&name, NO_TRAJECTORY));
    }
    check_outputs(&outputs)?;
    let progress = Progress::new();
    progress.show(&format!("designing {name}"));
    let designed = designed((&arguments.gait, arguments.output.as_deref()), &name, &gait)?;
    progress.clear();
    if let Some(path) = &arguments.output {
        write_whole(path, designed.scenario.as_bytes())?;
    }
    if let Some(path) = &arguments.trajectory {
        let Some(text) = &designed.trajectory else {
            return Err(refused(&name, NO_TRAJECTORY));
        };
        write_whole(path, text.as_bytes())?;
    }
    if let Some(path) = &arguments.svg {
        write_whole(path, draw(&designed).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &answer(&designed))?,
        (_, false) => {
            print(out, &designed)?;
            say_written(out, &outputs)?;
        }
    }
    Ok(Answer::Done)
}

const NO_TRAJECTORY: &str = "references alone do not walk a limit cycle, which has torques and \
                             gains of its own\n  hint: leave out --trajectory, and take -o";

const MODEL: &str = "`model` is a shipped model, or a file from the gait file's directory";

fn refused(name: &str, why: impl std::fmt::Display) -> Failure {
    Failure::Walk(name.to_owned(), why.to_string())
}

/// Whether this names a gait and no scenario: a file that says so, or a shipped gait.
fn is_gait(path: &Path) -> bool {
    if path.exists() || path == Path::new("-") {
        let bytes = read_file(path).unwrap_or_default();
        let is_tag = |(key, tag): &(Cow<'_, str>, file::Json<'_>)| {
            key == "format" && matches!(&tag.value, file::Value::Text(tag) if tag == FORMAT)
        };
        return file::parse(&bytes).is_ok_and(|root| root.entries().iter().any(is_tag));
    }
    let is_in = |list: &[shipped::ShippedModel]| list.iter().any(|one| Path::new(one.name) == path);
    is_in(shipped::GAITS) && !is_in(shipped::SCENARIOS)
}

/// A scenario, or that of a gait, which is designed for it.
pub(super) fn open_or_design(path: &Path) -> Result<Scenario, Failure> {
    if !is_gait(path) {
        return open(path);
    }
    let name = path.display().to_string();
    let bytes = read_or_shipped(path, ("gait", shipped::GAITS), Wanted::Gait)?;
    let gait = read_gait(&name, &bytes).map_err(Failure::Scenario)?;
    let progress = Progress::new();
    progress.show(&format!("designing {name}"));
    let designed = designed((path, None), &name, &gait)?;
    drop(progress);
    let load = |model: &str| load_beside(path, model);
    read_scenario(&name, designed.scenario.as_bytes(), &load).map_err(Failure::Scenario)
}

/// Designs a gait; its file, and where the scenario goes, say how the scenario calls its model.
fn designed(
    files: (&Path, Option<&Path>),
    name: &str,
    gait: &GaitFile,
) -> Result<Designed, Failure> {
    let (gait_file, _) = files;
    let bytes = load_beside(gait_file, &gait.model)
        .map_err(|why| refused(name, format_args!("{}: {why}\n  hint: {MODEL}", gait.model)))?;
    let robot = effect::read_model(&gait.model, &bytes, &[]).map_err(Failure::Model)?;
    let mut plant = plant_of(&robot, &gait.parameters).map_err(|error| refused(name, error))?;
    let stem = gait_file.file_stem().unwrap_or_default().to_string_lossy();
    let own = if gait.name.is_empty() { stem.into_owned() } else { gait.name.clone() };
    let model = model_from(files, &gait.model);
    let source = format!("`denavit walk design` from the gait {own}");
    let head = ScenarioHead {
        name: &own,
        description: &gait.description,
        source: &source,
        model: &model,
        parameters: &gait.parameters,
        steps: 0,
    };
    let refuse =
        |error: PlanError| refused(name, format_args!("{error}\n  hint: {}", error.hint()));
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
            let found = design(plant, problem).map_err(|error| refused(name, error))?;
            let head = ScenarioHead { steps: problem.steps, ..head };
            limit_cycle(found, plant, &head).map_err(|error| refused(name, error))
        }
    }
}

/// What the scenario calls its model: paths are taken from the scenario's directory.
fn model_from((gait, output): (&Path, Option<&Path>), model: &str) -> String {
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
) -> Curves {
    let mut times_s: Vec<f64> = (0..=SHOWN).map(|k| end_s * k as f64 / SHOWN as f64).collect();
    let marked_s: Vec<f64> = marked_s.collect();
    times_s.extend(&marked_s);
    times_s.sort_by(f64::total_cmp);
    times_s.dedup();
    let joints = model.joints.iter().zip(references).filter_map(|(joint, reference)| {
        let reference = reference.as_ref()?;
        let values = times_s.iter().map(|t_s| reference.at(*t_s).position).collect();
        Some(GaitCurve { name: joint.name.clone(), values })
    });
    let joints = joints.collect();
    let place = |marked: &f64| times_s.iter().position(|t_s| t_s == marked);
    let postures = marked_s.iter().filter_map(place).collect();
    Curves { times_s, joints, postures }
}

fn planned(
    kind: &'static str,
    plan: GaitPlan,
    plant: &mut dyn Plant,
    head: &ScenarioHead<'_>,
) -> Result<Designed, PlanError> {
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

fn rows(plan: &GaitPlan) -> Vec<Row> {
    let millimetres = |length_m: f64| format!("{:.1} mm", 1e3 * length_m);
    let (length, step_s, speed) = (plan.step_length_m, plan.step_s, plan.speed_m_s());
    let mut rows = vec![
        Row::new("step_length_m", "step length", length, format!("{length:.4} m")),
        Row::new("step_s", "step time", step_s, format!("{step_s:.4} s")),
        Row::new("steps", "steps", plan.steps as f64, plan.steps.to_string()),
        Row::new("speed_m_s", "mean speed", speed, format!("{speed:.4} m/s")),
    ];
    let residuals = [
        ("residual", "largest residual of inverse kinematics", plan.worst(true)),
        ("residual_between", "largest residual between knots", plan.worst(false)),
    ];
    for (key, name, knot) in residuals {
        rows.extend(knot.map(|knot| {
            Row::new(key, name, knot.residual, format!("{:.1e}", knot.residual)).at(knot)
        }));
    }
    rows.extend(plan.least_static().map(|knot| {
        let margin = knot.static_margin_m;
        Row::new("static_margin_m", "least static margin", margin, millimetres(margin)).at(knot)
    }));
    rows.extend(plan.least_pressure().and_then(|knot| {
        let (margin, name) = (knot.pressure_margin_m?, "least margin of the planned ZMP");
        Some(Row::new("zmp_margin_m", name, margin, millimetres(margin)).at(knot))
    }));
    rows
}

fn limit_cycle(
    found: LimitCycle,
    plant: &mut dyn Plant,
    head: &ScenarioHead<'_>,
) -> Result<Designed, denavit::plants::trajectory::TrajectoryError> {
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
        Row::new("step_length_m", "step length", length, format!("{length:.4} m")),
        Row::new("step_s", "step time", period, format!("{period:.4} s")),
        Row::new("steps", "steps", head.steps as f64, head.steps.to_string()),
        Row::new("speed_m_s", "mean speed", speed, format!("{speed:.4} m/s")),
        Row::new("largest_multiplier", "largest multiplier", largest, format!("{largest:.4}")),
        Row::new("cost_of_transport", "planned cost of transport", cost, format!("{cost:.4}")),
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

fn draw(designed: &Designed) -> String {
    let title = format!("{}: joint angles", designed.name.replace('_', " "));
    let over = if designed.curves.postures.is_empty() { "the walk" } else { "one step" };
    let subtitle = format!("{}, {}, over {over}", designed.model.name, designed.kind);
    GaitPicture {
        title: &title,
        subtitle: &subtitle,
        times_s: &designed.curves.times_s,
        curves: &designed.curves.joints,
        postures: &designed.curves.postures,
    }
    .draw()
}

fn answer(designed: &Designed) -> Value {
    let mut answer = Map::new();
    answer.insert("gait".to_owned(), value!(designed.name));
    answer.insert("kind".to_owned(), value!(designed.kind));
    answer.insert("model".to_owned(), value!(designed.model.name));
    for row in &designed.rows {
        answer.insert(row.key.to_owned(), value!(row.number));
        if !row.place.is_empty() {
            answer.insert(format!("{}_at", row.key), value!(row.place));
        }
    }
    let knot = |knot: &Knot| {
        let joints = designed.model.joints.iter().zip(&knot.q);
        let q = Ordered(joints.map(|(joint, q)| (joint.name.clone(), *q)).collect());
        value!({
            "t_s": knot.t_s,
            "name": knot.name,
            "solved": knot.is_solved,
            "residual": knot.residual,
            "static_margin_m": knot.static_margin_m,
            "zmp_margin_m": knot.pressure_margin_m,
            "q": serde_json::to_value(q).unwrap_or_default(),
        })
    };
    answer.insert("knots".to_owned(), designed.knots.iter().map(knot).collect());
    Value::Object(answer)
}

fn print(out: &mut dyn Write, designed: &Designed) -> Result<(), Failure> {
    let (name, kind, model) = (&designed.name, designed.kind, &designed.model.name);
    writeln!(out, "{name}: {kind} for {model}\n")?;
    let columns = [("", Align::Left), ("", Align::Right), ("where", Align::Left)];
    let mut table = Table::new(&columns);
    for row in &designed.rows {
        table.push(vec![row.name.to_owned(), row.shown.clone(), row.place.clone()]);
    }
    write!(out, "{table}")?;
    Ok(())
}
