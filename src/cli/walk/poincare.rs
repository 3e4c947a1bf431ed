//! `denavit walk poincare`: the cycle of a gait, and whether deviations from it die.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::json::{Ordered, write_json};
use super::super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::super::progress::Progress;
use super::design::open_or_design;
use clap::Args;
use denavit::report::{Align, ReturnMapPicture, Table, UnitCircle, short};
use denavit::simulate::scenario::Scenario;
use denavit::walk::poincare::{
    Convergence, Fate, Multiplier, PoincareAnalysis, PoincareOptions, Section, Share,
    WantedSection, analyse, shares,
};
use serde_json::{Value, json as value};
use std::io::Write;
use std::path::PathBuf;

/// Find the cycle of a gait and its Floquet multipliers (thesis 4.2.2, 4.4.5)
///
/// The state that comes back to itself is found by Newton's method. The multipliers are those of
/// the linearised return map inside the manifold of the contacts, from the variational equation
/// with saltation at events; central differences and other sections check them. Deviations die
/// where all are inside the unit circle: else, and where the checks contradict each other, the
/// command exits with 1.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit walk poincare planar_biped_limit_cycle_gait --unchecked --svg circle.svg
  denavit walk poincare compass_gait --section strike --json")]
pub(crate) struct Arguments {
    /// A scenario or a gait, which is designed first: the path of its file, or a shipped name
    #[arg(value_name = "SCENARIO|GAIT")]
    scenario: PathBuf,
    /// Where the cycle is looked at: strike, or a share of the cycle from 0 to 1 [default: the
    /// middle of the longest time without an event]
    #[arg(long, value_name = "SECTION", value_parser = section)]
    section: Option<WantedSection>,
    /// Steps from the start on before the cycle is looked for
    #[arg(
        long,
        value_name = "STEPS",
        default_value_t = 4,
        value_parser = clap::value_parser!(u32).range(0..=1000)
    )]
    approach: u32,
    /// Leave out the comparison with central differences and with other sections
    #[arg(long)]
    unchecked: bool,
    /// How far two velocities are off the cycle at the start of the way back to it
    #[arg(long, value_name = "RATE", default_value_t = 0.1, value_parser = off)]
    off: f64,
    /// Cycles for which the way back is followed
    #[arg(
        long,
        value_name = "CYCLES",
        default_value_t = 12,
        value_parser = clap::value_parser!(u32).range(1..=1000)
    )]
    returns: u32,
    /// Draw the way back on the section (thesis figure 4.8); - is standard output
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Draw the multipliers in the unit circle (thesis figure 4.9); - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

fn off(text: &str) -> Result<f64, String> {
    let off: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-6..=10.0).contains(&off) { Ok(off) } else { Err("not from 1e-6 to 10 rad/s".into()) }
}

fn section(text: &str) -> Result<WantedSection, String> {
    if text == "strike" {
        return Ok(WantedSection::Strike);
    }
    match text.parse::<f64>() {
        Ok(share) if (0.0..=1.0).contains(&share) => Ok(WantedSection::Phase(share)),
        _ => Err("`strike`, or a share of the cycle from 0 to 1".to_owned()),
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.svg.as_ref(), arguments.map.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let mut scenario = open_or_design(&arguments.scenario)?;
    check_outputs(&outputs)?;
    let options = PoincareOptions {
        section: arguments.section.unwrap_or_default(),
        approach_steps: arguments.approach as usize,
        checks: !arguments.unchecked,
        returns: (arguments.off, arguments.returns as usize),
        ..PoincareOptions::default()
    };
    let progress = Progress::new();
    progress.show("following the cycle");
    let found = analyse(&mut scenario, &options).map_err(|error| {
        let hint = match options.section {
            WantedSection::Strike => "\n  hint: leave out --section: the clock says when to look",
            _ => "",
        };
        Failure::Walk(scenario.name.clone(), format!("{error}{hint}"))
    })?;
    progress.clear();
    if let Some(path) = &arguments.svg {
        write_whole(path, picture(&scenario, &found).as_bytes())?;
    }
    if let (Some(path), Some(convergence)) = (&arguments.map, &found.convergence) {
        write_whole(path, return_map(&scenario, &found, convergence).as_bytes())?;
    }
    match (is_answered, arguments.json) {
        (true, _) => {}
        (_, true) => write_json(out, &answer(&scenario, &found))?,
        (_, false) => {
            print(out, &scenario, &found)?;
            say_written(out, &outputs)?;
        }
    }
    let good = is_stable(&found) && found.contradiction().is_none();
    Ok(if good { Answer::Done } else { Answer::Negative })
}

fn largest(found: &PoincareAnalysis) -> f64 {
    found.multipliers.first().map_or(0.0, Multiplier::modulus)
}

fn is_stable(found: &PoincareAnalysis) -> bool {
    Fate::of(largest(found)) == Fate::Die
}

pub(super) fn picture(scenario: &Scenario, found: &PoincareAnalysis) -> String {
    let subtitle = format!(
        "{}: largest multiplier {} after {} s",
        scenario.plant.model().name,
        short(largest(found)),
        short(found.cycle.period_s)
    );
    let values: Vec<[f64; 2]> = found.multipliers.iter().map(|one| one.value).collect();
    let title = scenario.name.replace('_', " ");
    UnitCircle { title: &title, subtitle: &subtitle, multipliers: &values }.draw()
}

pub(super) fn return_map(
    scenario: &Scenario,
    found: &PoincareAnalysis,
    convergence: &Convergence,
) -> String {
    let model = scenario.plant.model();
    let title = format!("{}: returns from off the cycle", scenario.name.replace('_', " "));
    let name = |index: usize| -> String {
        let joint = convergence.joints.get(index).map(|joint| &model.joints[*joint]);
        joint.map_or_else(String::new, |joint| {
            let unit = if joint.slides { "m/s" } else { "rad/s" };
            format!("velocity of {} off its cycle [{unit}]", joint.name)
        })
    };
    let factor = convergence.factor().map_or_else(|| "-".to_owned(), short);
    let subtitle = format!(
        "a cycle makes {factor} of a deviation in the mean; largest multiplier {}",
        short(largest(found))
    );
    let points: Vec<[f64; 2]> = convergence
        .deviations
        .iter()
        .map(|all| [0, 1].map(|axis| all.get(axis).copied().unwrap_or(0.0)))
        .collect();
    let [right, up] = [name(0), name(1)];
    ReturnMapPicture { title: &title, subtitle: &subtitle, axes: [&right, &up], points: &points }
        .draw()
}

fn section_text(scenario: &Scenario, found: &PoincareAnalysis) -> String {
    match found.section {
        Section::Clock { at_s, .. } => format!("clock at {at_s:.6} s"),
        Section::Touch(contact) => {
            format!("just after {} strikes", scenario.plant.model().contacts[contact].name)
        }
        Section::Jump(guard) => format!("just after guard {}", guard + 1),
    }
}

/// The multipliers, those that the contacts make 0 included.
fn all_values(found: &PoincareAnalysis) -> Vec<[f64; 2]> {
    let own = found.multipliers.iter().map(|multiplier| multiplier.value);
    own.chain(std::iter::repeat_n([0.0; 2], found.forbidden)).collect()
}

/// Coordinates with a smaller share are not named.
const NAMED: f64 = 0.1;

fn dominant(scenario: &Scenario, found: &PoincareAnalysis, index: usize) -> Vec<Share> {
    let multiplier = &found.multipliers[index];
    let mut all = shares(scenario.plant.model(), &found.cycle.chart, multiplier);
    all.retain(|share| share.weight >= NAMED);
    all
}

fn answer(scenario: &Scenario, found: &PoincareAnalysis) -> Value {
    let model = scenario.plant.model();
    let named = |values: &[f64]| -> Value {
        let named = model.joints.iter().zip(values).map(|(joint, v)| (joint.name.clone(), *v));
        serde_json::to_value(Ordered(named.collect())).unwrap_or_default()
    };
    let state = &found.cycle.chart.base;
    let words = |index: usize| -> Vec<Value> {
        let shares = dominant(scenario, found, index).into_iter();
        shares.map(|s| value!({ "coordinate": s.coordinate, "weight": s.weight })).collect()
    };
    let dominant = if found.multipliers.is_empty() { Vec::new() } else { words(0) };
    value!({
        "scenario": scenario.name,
        "model": model.name,
        "period_s": found.cycle.period_s,
        "cycle": if found.cycle.exchange.is_some() { "step" } else { "stride" },
        "travel_m": found.cycle.travel_m,
        "section": section_text(scenario, found),
        "closed": found.cycle.closed.iter().map(|c| &model.contacts[*c].name).collect::<Vec<_>>(),
        "multipliers": all_values(found),
        "largest": largest(found),
        "stable": is_stable(found),
        "contradiction": found.contradiction(),
        "dominant": dominant,
        "forbidden": found.forbidden,
        "fixed_point": {
            "t_s": state.t_s,
            "q": named(&state.q),
            "qd": named(&state.qd),
            "residual": found.cycle.residual,
        },
        "section_spread": found.section_spread.map(|(apart, _)| apart),
        "sections": found.section_spread.map_or(1, |(_, count)| count),
        "differences_apart": found.methods_apart,
        "returns": found.convergence.as_ref().map(|returns| value!({
            "velocities": returns.joints.iter().map(|j| &model.joints[*j].name).collect::<Vec<_>>(),
            "deviations": returns.deviations,
            "lengths": returns.lengths,
            "factor": returns.factor(),
            "stopped": returns.stopped.as_ref().map(ToString::to_string),
        })),
    })
}

fn print(
    out: &mut dyn Write,
    scenario: &Scenario,
    found: &PoincareAnalysis,
) -> Result<(), Failure> {
    let cycle = &found.cycle;
    let name = if found.cycle.exchange.is_some() { "step, legs exchanged" } else { "stride" };
    writeln!(
        out,
        "{}: a cycle of {:.6} s ({name}), {:.4} m",
        scenario.name, cycle.period_s, cycle.travel_m[0]
    )?;
    writeln!(
        out,
        "section: {}; the fixed point returns to {:.1e}\n",
        section_text(scenario, found),
        cycle.residual
    )?;
    let columns = [
        ("", Align::Right),
        ("multiplier", Align::Left),
        ("modulus", Align::Right),
        ("largest in", Align::Left),
    ];
    let mut table = Table::new(&columns);
    for (index, multiplier) in found.multipliers.iter().enumerate() {
        let shares = dominant(scenario, found, index);
        let words: Vec<String> =
            shares.iter().take(3).map(|s| format!("{} {:.2}", s.coordinate, s.weight)).collect();
        table.push(vec![
            (index + 1).to_string(),
            complex(multiplier.value),
            size(multiplier.modulus()),
            words.join(", "),
        ]);
    }
    write!(out, "{table}")?;
    if found.forbidden > 0 {
        writeln!(out, "and {} that are 0: the contacts forbid deviations", found.forbidden)?;
    }
    writeln!(out)?;
    if let Some(apart) = found.methods_apart {
        writeln!(out, "central differences of the return map: apart by {apart:.1e} at most")?;
    }
    if let Some((apart, count)) = found.section_spread {
        writeln!(out, "{count} sections: multipliers above 0.01 apart by {apart:.1e} at most")?;
    }
    if let Some(returns) = &found.convergence {
        print_returns(out, scenario, returns)?;
    }
    if let Some(apart) = found.contradiction() {
        writeln!(
            out,
            "the checks contradict each other by {apart:.1e}: events are so near that deviations \
             meet others; the multipliers are not confirmed"
        )?;
    }
    let verdict = match (found.contradiction(), Fate::of(largest(found))) {
        (Some(_), _) => "not confirmed",
        (None, Fate::Die) => "stable: deviations die",
        (None, Fate::Stay) => "neither stable nor unstable: some deviations stay as they are",
        (None, Fate::Grow) => "not stable: a deviation grows",
    };
    writeln!(out, "{verdict} (largest multiplier {})", short(largest(found)))?;
    Ok(())
}

/// How far the robot is off its cycle at the start and after each cycle.
fn print_returns(
    out: &mut dyn Write,
    scenario: &Scenario,
    returns: &Convergence,
) -> Result<(), Failure> {
    let joints = &scenario.plant.model().joints;
    let names: Vec<String> =
        returns.joints.iter().map(|joint| format!("qd_{}", joints[*joint].name)).collect();
    let lengths: Vec<String> =
        returns.lengths.iter().map(|length| format!("{length:.1e}")).collect();
    writeln!(out, "off the cycle in {}: {}", names.join(", "), lengths.join(" "))?;
    match (&returns.stopped, returns.factor()) {
        (Some(error), _) => writeln!(out, "from there it does not come back: {error}")?,
        (None, Some(factor)) => writeln!(out, "a cycle makes {factor:.3} of it in the mean")?,
        (None, None) => {}
    }
    Ok(())
}

fn complex([re, im]: [f64; 2]) -> String {
    let sign = if im < 0.0 { '-' } else { '+' };
    if im == 0.0 { size(re) } else { format!("{} {sign} {}i", size(re), size(im.abs())) }
}

pub(super) fn size(value: f64) -> String {
    if value.abs() >= 1e-4 { format!("{value:.6}") } else { format!("{value:.1e}") }
}
