//! Which scheme makes a run, and how the steps of time stepping are made.

use super::RunScheme;
use super::fault::Cause;
use super::options::tolerances;
use super::ranges;
use super::reader::{FieldsNumbers, NodeNumbers, Report};
use crate::audit::Tolerances;
use crate::contact::gauss_seidel::SweepLimits;
use crate::time_stepping::{Scheme, StepSolver, Stepping};
use denavit_codegen::model::Fields;

const KEYS: &[&str] = &[
    "method",
    "step_s",
    "implicit_damping",
    "corrections",
    "reach_m",
    "solver",
    "sweeps",
    "response_m_s",
    "facets",
    "no_slip_friction",
    "tolerances",
];

pub(super) fn scheme(fields: &Fields<'_>, report: &mut Report) -> RunScheme {
    let meanings = [RunScheme::Event, RunScheme::TimeStepping];
    let word = fields.get("scheme").and_then(|n| n.choice(&RunScheme::WORDS, &meanings, report));
    word.unwrap_or_default()
}

/// The steps, and what their audits may miss.
pub(super) fn stepping(fields: &Fields<'_>, report: &mut Report) -> (Stepping, Tolerances) {
    let mut stepping = Stepping::default();
    let Some(given) = fields.get("time_stepping").and_then(|node| node.fields(KEYS, report)) else {
        return (stepping, Tolerances::of_steps(stepping.step_s));
    };
    stepping.step_s = given.number("step_s", ranges::STEP_S, stepping.step_s, report);
    stepping.implicitness =
        given.number("implicit_damping", ranges::SHARE, stepping.implicitness, report);
    stepping.corrections = given.count("corrections", ranges::CORRECTIONS, 0, report);
    let (range, absent) = (ranges::SOME_FRICTION, stepping.no_slip_friction);
    stepping.no_slip_friction = given.number("no_slip_friction", range, absent, report);
    let reach_m = given.number("reach_m", ranges::REACH_M, 0.01, report);
    let meanings = [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m }];
    let word =
        given.get("method").and_then(|n| n.choice(&["moreau", "anitescu"], &meanings, report));
    stepping.scheme = word.unwrap_or(stepping.scheme);
    let absent = SweepLimits::default();
    let limits = SweepLimits {
        sweeps: given.count("sweeps", ranges::SWEEPS, absent.sweeps, report),
        response: given.number("response_m_s", ranges::RESPONSE_M_S, absent.response, report),
    };
    let facets = given.count("facets", ranges::FACETS, 16, report);
    if !facets.is_multiple_of(2) {
        report.push(given.place("facets"), Cause::Odd);
    }
    let meanings = [StepSolver::Sweeps(limits), StepSolver::Pivots { facets }];
    let word = given.get("solver").and_then(|n| n.choice(&["sweeps", "pivots"], &meanings, report));
    stepping.solver = word.unwrap_or(StepSolver::Sweeps(limits));
    let tolerances = tolerances(&given, Tolerances::of_steps(stepping.step_s), report);
    (stepping, tolerances)
}
