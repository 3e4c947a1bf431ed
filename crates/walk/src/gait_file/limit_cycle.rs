//! The kind `limit_cycle` of gait files.

use crate::error::NoStep;
use crate::optimal::{
    Aspects, CostKind, Guess, LimitCycleProblem, Phase, Role, StepLimits, check_phases,
};
use denavit_codegen::model::{Fields, Node};
use denavit_simulate::scenario::{Cause, FieldsNumbers, NodeNumbers, Range, Report};

const KEYS: &[&str] = &[
    "speed_m_s",
    "step_length_m",
    "cost",
    "phases",
    "aspects",
    "friction",
    "clearance_m",
    "torque_limit_nm",
    "contact_force",
    "touchdown_m_s",
    "least_phase_s",
    "largest_multiplier",
    "steps",
    "intervals",
    "guess",
];

const SPEED_M_S: Range = Range::new(1e-3, 10.0);
const LENGTH_M: Range = Range::new(1e-3, 10.0);
const FRICTION: Range = Range::new(1e-3, 10.0);
const CLEARANCE_M: Range = Range::new(0.0, 1.0);
const TORQUE_NM: Range = Range::new(1e-3, 1e6);
/// Two contacts of a foot that carries the body share its weight.
const CONTACT_FORCE: Range = Range::new(0.0, 0.45);
const TOUCHDOWN_M_S: Range = Range::new(0.0, 10.0);
const PHASE_S: Range = Range::new(1e-3, 10.0);
const MULTIPLIER: Range = Range::new(1e-3, 1.0);
const STEPS: Range = Range::new(1.0, 1e4);
const INTERVALS: Range = Range::new(4.0, 200.0);
const KNEE_RAD: Range = Range::new(0.0, 2.0);
const SHARE: Range = Range::new(1e-3, 1e3);

/// Reads what a limit cycle is to be.
pub(super) fn read(node: Node<'_>, report: &mut Report) -> Option<LimitCycleProblem> {
    let given = &node.fields(KEYS, report)?;
    let absent = LimitCycleProblem::default();
    let optional = |key: &str, range: Range, report: &mut Report| {
        given.get(key).and_then(|node| node.number_in(range, report))
    };
    let cost = given.get("cost").and_then(|node| {
        let meanings = [CostKind::CostOfTransport, CostKind::TorqueSquared];
        node.choice(&["cost_of_transport", "torque_squared"], &meanings, report)
    });
    let limits = StepLimits {
        speed_m_s: given.required_number("speed_m_s", SPEED_M_S, report),
        step_length_m: optional("step_length_m", LENGTH_M, report),
        friction: given.number("friction", FRICTION, absent.limits.friction, report),
        clearance_m: given.number("clearance_m", CLEARANCE_M, absent.limits.clearance_m, report),
        torque_nm: optional("torque_limit_nm", TORQUE_NM, report),
        contact_force: given.number(
            "contact_force",
            CONTACT_FORCE,
            absent.limits.contact_force,
            report,
        ),
        touchdown_m_s: given.number(
            "touchdown_m_s",
            TOUCHDOWN_M_S,
            absent.limits.touchdown_m_s,
            report,
        ),
        phase_s: given.number("least_phase_s", PHASE_S, absent.limits.phase_s, report),
        ..absent.limits
    };
    Some(LimitCycleProblem {
        limits,
        cost: cost.unwrap_or_default(),
        phases: given.get("phases").and_then(|node| phases(node, report)),
        aspects: aspects(given, report),
        largest_multiplier: given.number(
            "largest_multiplier",
            MULTIPLIER,
            absent.largest_multiplier,
            report,
        ),
        steps: given.count("steps", STEPS, absent.steps, report),
        intervals: given.count("intervals", INTERVALS, absent.intervals, report),
        guess: guess(given, report),
    })
}

fn guess(given: &Fields<'_>, report: &mut Report) -> Guess {
    let absent = Guess::default();
    let fields = given.get("guess").and_then(|node| node.fields(&["knee_rad"], report));
    fields.map_or(absent, |fields| Guess {
        knee_rad: fields.number("knee_rad", KNEE_RAD, absent.knee_rad, report),
        ..absent
    })
}

/// Aspects that the file does not name are there.
fn aspects(given: &Fields<'_>, report: &mut Report) -> Aspects {
    const KEYS: &[&str] = &["retraction", "heel_strike", "push_off", "lean", "knee_flexion"];
    let Some(fields) = given.get("aspects").and_then(|node| node.fields(KEYS, report)) else {
        return Aspects::default();
    };
    let mut has = |key: &str| fields.get(key).is_none() || fields.flag(key, report);
    Aspects {
        retraction: has("retraction"),
        heel_strike: has("heel_strike"),
        push_off: has("push_off"),
        lean: has("lean"),
        knee_flexion: has("knee_flexion"),
    }
}

fn phases(node: Node<'_>, report: &mut Report) -> Option<Vec<Phase>> {
    let before = report.count();
    let items = node.items(report);
    let phases: Vec<Phase> = items.into_iter().filter_map(|item| phase(item, report)).collect();
    if report.count() > before {
        return None;
    }
    if let Err(error) = check_phases(&phases) {
        report.push(node.at(), Cause::Gait(error.to_string(), hint(error)));
        return None;
    }
    Some(phases)
}

fn phase(node: Node<'_>, report: &mut Report) -> Option<Phase> {
    let fields = node.fields(&["name", "closed", "share"], report)?;
    let name = fields.require("name", report).and_then(|node| node.text(report));
    let closed = fields.require("closed", report).map(|node| node.items(report));
    let words = closed.unwrap_or_default().into_iter();
    let closed: Vec<Role> =
        words.filter_map(|node| node.choice(&Role::WORDS, &Role::ALL, report)).collect();
    let share = fields.number("share", SHARE, 1.0, report);
    Some(Phase::new(name?, &closed, share))
}

fn hint(error: NoStep) -> &'static str {
    match error {
        NoStep::Empty => "list the phases of a step, or leave `phases` out",
        NoStep::Flight(_) => "runs are no walks: some contact is closed in every phase",
        NoStep::NoTouchdown => "after the last phase the legs swap: `stance` was `swing` before",
        NoStep::NeverFlat => "add a phase that is `[\"stance_heel\", \"stance_toe\"]`",
    }
}
