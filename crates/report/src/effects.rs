//! The catalogue of effects as a page: what each one says, from its file.

use super::paragraph::paragraph;
use denavit_codegen::effect::{
    Channel, Effect, EffectKind, EffectParameter, EffectSite, Law, Measured, Property, SpringSide,
    Transmission,
};
use denavit_codegen::emit::latex::{Notation, write_expression};
use denavit_codegen::expr::{Dag, ExprId, derivative, substitute};
use denavit_codegen::model::JointKind;
use denavit_codegen::number::Rational;
use rustc_hash::FxHashMap;
use std::fmt::Write;

/// Values from which a parameter is searched that are listed; of more the ends are.
const MOST_STARTS: usize = 12;

/// The effects as Markdown, one section for each: law, parameters, what it looks like where it is
/// small, and what it is taken for.
pub fn effects_page(effects: &[Effect]) -> String {
    let mut page = String::new();
    for kind in EffectKind::ALL {
        let own: Vec<&Effect> = effects.iter().filter(|effect| effect.kind == kind).collect();
        if own.is_empty() {
            continue;
        }
        let (title, text) = chapter(kind);
        let _ = write!(page, "## {title}\n\n{text}\n\n");
        own.iter().for_each(|effect| section(&mut page, effect));
    }
    page
}

fn chapter(kind: EffectKind) -> (&'static str, &'static str) {
    match kind {
        EffectKind::Torque => ("Torques", "Each adds to the torque that its joint needs."),
        EffectKind::State => ("Torques with states", "What they add depends on the past."),
        EffectKind::Measurement => {
            ("Measurements", "Each stands between a true quantity and what is logged of it.")
        }
        EffectKind::Parameter => ("Parameters", "Each moves what the model says of its place."),
        EffectKind::Term => ("Terms", "Each is a term that the model's equations left out."),
        EffectKind::Mode => ("Modes", "Their laws change with the state of the motion."),
    }
}

fn section(page: &mut String, effect: &Effect) {
    let place = match effect.at {
        EffectSite::Joint => "a joint",
        EffectSite::Spring => "the series spring of a joint",
        EffectSite::JointPair => "a joint, with a second one",
        EffectSite::Link => "a link",
        EffectSite::Contact => "a contact",
        EffectSite::Model => "the whole model",
    };
    let _ = write!(page, "### `{}`: {}\n\n", effect.name, effect.title);
    let side = match effect.side {
        SpringSide::Motor => "",
        SpringSide::Link => ", behind a series spring on the side of the link",
    };
    page.push_str(&paragraph("", "", &format!("{} Acts on {place}{side}.", effect.description)));
    page.push_str("\n\n");
    for formula in formulas(effect) {
        let _ = write!(page, "$${formula}$$\n\n");
    }
    if !effect.parameters.is_empty() {
        page.push_str("| parameter | unit | bounds | none at | start | meaning |\n");
        page.push_str("|---|---|---|---|---|---|\n");
        effect.parameters.iter().for_each(|parameter| row(page, parameter));
        page.push('\n');
    }
    for signature in signatures(effect) {
        let _ = write!(page, "Where it is small: $${signature}$$\n\n");
    }
    if !effect.refines.is_empty() {
        let names: Vec<String> = effect.refines.iter().map(|name| format!("`{name}`")).collect();
        let _ = write!(page, "A finer form of: {}.\n\n", names.join(", "));
    }
    if !effect.confused_with.is_empty() {
        page.push_str("Taken for:\n\n");
        for confusion in &effect.confused_with {
            let _ = writeln!(page, "- `{}`: {}", confusion.effect, confusion.reason);
        }
        page.push('\n');
    }
    page.push_str(&paragraph("", "", &format!("Source: {}.", effect.source)));
    page.push_str("\n\n");
}

fn row(page: &mut String, parameter: &EffectParameter) {
    let decimal = |value: &Rational| denavit_codegen::number::to_f64(value).to_string();
    let end = |end: &Option<Rational>, open: &str| end.as_ref().map_or(open.to_owned(), decimal);
    let [low, high] = &parameter.bounds;
    let bounds = match (low, high) {
        (None, None) => "any".to_owned(),
        (Some(low), None) => format!("from {}", decimal(low)),
        _ => format!("{} to {}", end(low, ""), end(high, "")),
    };
    let [turning, sliding] =
        [JointKind::Revolute, JointKind::Prismatic].map(|kind| parameter.unit.of(kind).text());
    let unit = match turning == sliding {
        true => turning.to_owned(),
        false => format!("{turning} or {sliding}"),
    };
    let nominal = parameter.nominal.as_ref().map_or(String::new(), decimal);
    let start: Vec<String> = parameter.start.iter().map(decimal).collect();
    let start = match start.as_slice() {
        [first, second, .., last] if start.len() > MOST_STARTS => {
            format!("{first}, {second} .. {last} ({})", start.len())
        }
        all => all.join(", "),
    };
    let (name, linear) = (&parameter.name, parameter.linear);
    let linear = if linear { " (linear)" } else { "" };
    let meaning = &parameter.description;
    let _ = writeln!(
        page,
        "| `{name}` | {unit} | {bounds} | {nominal} | {start} | {meaning}{linear} |"
    );
}

/// The law, line by line, as LaTeX.
pub(super) fn formulas(effect: &Effect) -> Vec<String> {
    let dag = &effect.dag;
    let notation = Notation::of_names(dag);
    let text = |expr: ExprId| write_expression(dag, expr, &notation);
    let mut formulas = match &effect.law {
        Law::Torque(torque) => {
            let second = effect.torque_2.map(|torque| format!(r"\tau_2 = {}", text(torque)));
            std::iter::once(format!(r"\tau = {}", text(*torque))).chain(second).collect()
        }
        Law::Measured(measured) => measured_formulas(dag, measured, &text),
        Law::Moves(moves) => moves
            .iter()
            .map(|(property, by)| format!("{} = {}", property_text(*property), text(*by)))
            .collect(),
        Law::Term(term) => {
            vec![format!(r"\tau = \tau_{{\mathrm{{{}}}}}", term.as_str().replace('_', r"\ "))]
        }
    };
    for state in &effect.states {
        let (symbol, rate, initial) = (text(state.symbol), text(state.rate), text(state.initial));
        formulas.push(format!(
            r"\frac{{\mathrm d}}{{\mathrm d t}} {symbol} = {rate}, \quad {symbol}(0) = {initial}"
        ));
    }
    formulas
}

fn measured_formulas(
    dag: &Dag,
    measured: &Measured,
    text: &dyn Fn(ExprId) -> String,
) -> Vec<String> {
    let letter = match measured.channel.as_str() {
        "tau" => r"\tau",
        "q" => "q",
        _ => r"\dot{q}",
    };
    let logged = format!(r"{letter}_{{\mathrm{{log}}}}");
    if let Some(transmission) = measured.transmission {
        return transmission_formulas(dag, transmission, measured.channel, &logged, text);
    }
    let given = if measured.is_inverse { format!(r"{letter}_{{\mathrm{{true}}}}") } else { logged };
    if measured.lag_s != dag.zero() {
        let lag = text(measured.lag_s);
        return vec![format!(
            r"{lag}\, \frac{{\mathrm d}}{{\mathrm d t}} {given} = {} - {given}",
            text(measured.value)
        )];
    }
    if measured.delay_s != dag.zero() {
        return vec![format!("{given}(t) = {letter}(t - {})", text(measured.delay_s))];
    }
    vec![format!("{given} = {}", text(measured.value))]
}

/// What moves behind a transmission: the rotor where the torque is the drive's, or else the joint.
fn transmission_formulas(
    dag: &Dag,
    transmission: Transmission,
    channel: Channel,
    logged: &str,
    text: &dyn Fn(ExprId) -> String,
) -> Vec<String> {
    let Transmission { swing_s, damping, play, drag, .. } = transmission;
    let is_torque = channel == Channel::Torque;
    let inertia = if is_torque { "I_a" } else { "I_0" };
    let beyond = match play == dag.zero() {
        true => String::new(),
        false => format!(r" \mp \tfrac{{1}}{{2}} {} \text{{ beyond the play}}", text(play)),
    };
    let mut passed = vec![format!(r"\frac{{{inertia}}}{{{}^2}} s", text(swing_s))];
    if damping != dag.zero() {
        let swing = text(swing_s);
        passed.push(format!(r"\frac{{2 {} {inertia}}}{{{swing}}} \dot{{s}}", text(damping)));
    }
    if drag != dag.zero() {
        let rate = r"(\dot{\theta} - \dot{q})";
        passed.push(format!(r"{} {inertia} {rate}", text(drag)));
    }
    let passed = passed.join(" + ");
    match is_torque {
        true => {
            let friction = r"f_v \dot{\theta} + f_c \operatorname{sgn} \dot{\theta}";
            vec![
                format!(r"I_a \ddot{{\theta}} + {friction} + \tau_{{\mathrm{{load}}}} = {logged}"),
                format!(r"\tau_{{\mathrm{{load}}}} = {passed}, \quad s = \theta - q{beyond}"),
            ]
        }
        false => vec![
            format!(r"\tau_{{\mathrm{{load}}}} = {passed}, \quad s = \theta - q{beyond}"),
            format!(r"{logged} = \theta"),
        ],
    }
}

fn property_text(property: Property) -> String {
    let axis = |axis: usize| ["x", "y", "z"][axis];
    match property {
        Property::Mass => r"\Delta m".to_owned(),
        Property::FirstMoment(at) => format!(r"\Delta (m c_{})", axis(at)),
        Property::Inertia(entry) => {
            format!(r"\Delta I_{{{}}}", ["xx", "yy", "zz", "xy", "xz", "yz"][entry])
        }
        Property::Gravity(at) => format!(r"\Delta g_{}", axis(at)),
        Property::Zero => r"\Delta q".to_owned(),
        Property::SeriesStiffness => r"\Delta k".to_owned(),
    }
}

/// The derivatives of a law of torque by what switches it off, where it is off: one line for each.
fn signatures(effect: &Effect) -> Vec<String> {
    let Law::Torque(torque) = effect.law else { return Vec::new() };
    let mut dag = effect.dag.clone();
    let mut nominal: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for parameter in &effect.parameters {
        if let Some(value) = &parameter.nominal {
            nominal.insert(parameter.symbol, dag.constant(value.clone()));
        }
    }
    let switches = effect.parameters.iter().filter(|parameter| parameter.nominal.is_some());
    // the slope of a linear law is read off the law itself
    let mut lines = Vec::new();
    for parameter in switches.filter(|parameter| !parameter.linear) {
        let seeds: FxHashMap<ExprId, ExprId> =
            [(parameter.symbol, dag.one())].into_iter().collect();
        let slope = derivative(&mut dag, &[torque], &seeds);
        let slope = substitute(&mut dag, &slope, &nominal)[0];
        let notation = Notation::of_names(&dag);
        let [symbol, slope] =
            [parameter.symbol, slope].map(|expr| write_expression(&dag, expr, &notation));
        lines.push(format!(r"\frac{{\partial \tau}}{{\partial {symbol}}} = {slope}"));
    }
    lines
}
