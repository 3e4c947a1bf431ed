//! Which scheme makes a run, and how the steps of time stepping are made.

use super::RunScheme;
use super::options::tolerances;
use super::reader::{Fields, Report};
use crate::simulate::audit::Tolerances;
use crate::simulate::contact::gauss_seidel::SweepLimits;
use crate::simulate::time_stepping::{Scheme, StepSolver, Stepping};

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
    let word = fields.get("scheme").and_then(|n| n.word(&RunScheme::WORDS, &meanings, report));
    word.unwrap_or_default()
}

/// The steps, and what their audits may miss.
pub(super) fn stepping(fields: &Fields<'_>, report: &mut Report) -> (Stepping, Tolerances) {
    let mut stepping = Stepping::default();
    let Some(given) = fields.get("time_stepping").and_then(|node| node.fields(KEYS, report)) else {
        return (stepping, Tolerances::of_steps(stepping.step_s));
    };
    // shorter steps than time resolves would never end
    stepping.step_s = given.positive("step_s", stepping.step_s, report).max(1e-9);
    stepping.implicitness = given.share("implicit_damping", stepping.implicitness, report);
    stepping.corrections = given.count("corrections", 0, report).min(10);
    stepping.no_slip_friction =
        given.positive("no_slip_friction", stepping.no_slip_friction, report);
    let reach_m = given.not_negative("reach_m", 0.01, report);
    let meanings = [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m }];
    let word = given.get("method").and_then(|n| n.word(&["moreau", "anitescu"], &meanings, report));
    stepping.scheme = word.unwrap_or(stepping.scheme);
    let absent = SweepLimits::default();
    let limits = SweepLimits {
        sweeps: given.count("sweeps", absent.sweeps, report).max(1),
        response: given.positive("response_m_s", absent.response, report),
    };
    let facets = given.count("facets", 16, report).clamp(2, 64).next_multiple_of(2).max(4);
    let meanings = [StepSolver::Sweeps(limits), StepSolver::Pivots { facets }];
    let word = given.get("solver").and_then(|n| n.word(&["sweeps", "pivots"], &meanings, report));
    stepping.solver = word.unwrap_or(StepSolver::Sweeps(limits));
    let tolerances = tolerances(&given, Tolerances::of_steps(stepping.step_s), report);
    (stepping, tolerances)
}
