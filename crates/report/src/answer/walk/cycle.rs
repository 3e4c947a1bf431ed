//! The cycle of a gait and its Floquet multipliers, as text, JSON and pictures.

use crate::html::{Grade, VerdictLine};
use crate::walk::{ReturnMapPicture, UnitCircle};
use crate::{Align, Ordered, Table, short};
use denavit_simulate::Stop;
use denavit_simulate::scenario::Scenario;
use denavit_walk::balance::Course;
use denavit_walk::poincare::{
    Convergence, Fate, Multiplier, PoincareAnalysis, Section, Share, shares,
};
use serde_json::{Value, json as value};
use std::fmt::{self, Write};

fn largest(found: &PoincareAnalysis) -> f64 {
    found.multipliers.first().map_or(0.0, Multiplier::modulus)
}

/// Whether deviations from the cycle die.
pub fn is_stable(found: &PoincareAnalysis) -> bool {
    Fate::of(largest(found)) == Fate::Die
}

/// What becomes of deviations, in words.
fn fate(found: &PoincareAnalysis) -> &'static str {
    match (found.contradiction(), Fate::of(largest(found))) {
        (Some(_), _) => "not confirmed",
        (None, Fate::Die) => "stable: deviations die",
        (None, Fate::Stay) => "neither stable nor unstable: some deviations stay as they are",
        (None, Fate::Grow) => "not stable: a deviation grows",
    }
}

/// Whether a gait repeats itself and deviations die, in one sentence.
pub(super) fn gait_verdict(
    course: &Course,
    cycle: &Result<PoincareAnalysis, String>,
) -> VerdictLine {
    let end = course.run.as_ref().map(|run| &run.stop).filter(|stop| **stop != Stop::End);
    match (end, cycle) {
        (_, Ok(found)) => {
            let is_good = found.contradiction().is_none() && is_stable(found);
            let modulus = short(largest(found));
            let text = format!("A cycle, {} (largest multiplier {modulus}).", fate(found));
            VerdictLine { grade: if is_good { Grade::Good } else { Grade::Bad }, text }
        }
        (None, Err(_)) => {
            let text = "The gait comes to its end, and is no cycle.".to_owned();
            VerdictLine { grade: Grade::Fair, text }
        }
        (Some(stop), Err(_)) => {
            let text = format!("The gait does not come to its end: {stop}.");
            VerdictLine { grade: Grade::Bad, text }
        }
    }
}

/// Floquet multipliers in the unit circle.
pub fn multipliers_picture(scenario: &Scenario, found: &PoincareAnalysis) -> String {
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

/// The way back to the cycle on the section.
pub fn returns_picture(
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

/// A cycle and its multipliers as JSON.
pub fn cycle_json(scenario: &Scenario, found: &PoincareAnalysis) -> Value {
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

/// The same as text.
pub fn cycle_text(scenario: &Scenario, found: &PoincareAnalysis) -> String {
    let mut out = String::new();
    write(&mut out, scenario, found).expect("text has room");
    out
}

fn write(out: &mut String, scenario: &Scenario, found: &PoincareAnalysis) -> fmt::Result {
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
    let verdict = fate(found);
    writeln!(out, "{verdict} (largest multiplier {})", short(largest(found)))?;
    Ok(())
}

/// How far the robot is off its cycle at the start and after each cycle.
fn print_returns(out: &mut String, scenario: &Scenario, returns: &Convergence) -> fmt::Result {
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
