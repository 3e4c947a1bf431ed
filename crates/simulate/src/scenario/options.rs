//! How a scenario is simulated: everything but the robot, its start and its control.

use super::fault::Cause;
use super::ranges;
use super::reader::{FieldsNumbers, NodeNumbers, Report};
use crate::audit::Tolerances;
use crate::contact::Friction;
use crate::drive::DriveModelling;
use crate::integrate::{Accuracy, Method};
use crate::measure::Measurement;
use crate::settle::Scuffing;
use crate::simulation::Simulation;
use denavit_codegen::model::Fields;

/// A log with more rows would not fit into memory.
const MAX_ROWS: f64 = 1e6;

pub(super) fn simulation(fields: &Fields<'_>, report: &mut Report) -> Simulation {
    let mut simulation = Simulation::default();
    times(fields, &mut simulation, report);
    simulation.seed = fields.count("seed", ranges::SEED, 0, report) as u64;
    if let Some(drives) = fields.get("drives") {
        let meanings = [DriveModelling::Ideal, DriveModelling::Model];
        simulation.drives =
            drives.choice(&["ideal", "model"], &meanings, report).unwrap_or_default();
    }
    let (range, absent) = (ranges::STICTION_RATE, simulation.stiction_rate);
    simulation.stiction_rate = fields.number("stiction_rate", range, absent, report);
    simulation.measurement = measurement(fields, report);
    simulation.method = method(fields, report);
    contact(fields, &mut simulation, report);
    let limits = fields.get("limits").and_then(|n| n.fields(&["events", "evaluations"], report));
    if let Some(limits) = limits {
        simulation.max_events =
            limits.count("events", ranges::EVENTS, simulation.max_events, report);
        simulation.max_evaluations =
            limits.count("evaluations", ranges::EVALUATIONS, simulation.max_evaluations, report);
    }
    simulation
}

/// How long the run is, and how often a row of the log is written. Rows are counted only if both
/// numbers are right: what stands in for a fault is nobody's.
fn times(fields: &Fields<'_>, simulation: &mut Simulation, report: &mut Report) {
    let faults = report.count();
    simulation.end_s = fields.required_number("duration_s", ranges::DURATION_S, report);
    let absent = simulation.log_period_s;
    simulation.log_period_s = fields.number("log_period_s", ranges::LOG_PERIOD_S, absent, report);
    if report.count() == faults && simulation.end_s / simulation.log_period_s > MAX_ROWS {
        let blamed = fields.get("log_period_s").or(fields.get("duration_s"));
        report.push(blamed.map_or(fields.at(), |node| node.at()), Cause::TooManyRows(MAX_ROWS));
    }
}

const MEASUREMENT: &[&str] = &[
    "resolution",
    "position_noise",
    "rate_noise",
    "delay_samples",
    "differentiates",
    "logged",
    "torque_noise",
];

/// The noise of torques, if the log is to be what instruments write.
pub(super) fn logged_torque_noise(fields: &Fields<'_>, report: &mut Report) -> Option<f64> {
    let given = fields.get("measurement")?;
    // what is wrong with the object has been noted already
    let given = given.fields(MEASUREMENT, &mut Report::default())?;
    let noise = given.number("torque_noise", ranges::NOISE, 0.0, report);
    given.flag("logged", report).then_some(noise)
}

fn measurement(fields: &Fields<'_>, report: &mut Report) -> Measurement {
    let known = MEASUREMENT;
    let Some(given) = fields.get("measurement").and_then(|node| node.fields(known, report)) else {
        return Measurement::default();
    };
    Measurement {
        resolution: given.number("resolution", ranges::RESOLUTION, 0.0, report),
        position_noise: given.number("position_noise", ranges::NOISE, 0.0, report),
        rate_noise: given.number("rate_noise", ranges::NOISE, 0.0, report),
        delay_samples: given.count("delay_samples", ranges::DELAY_SAMPLES, 0, report),
        differentiates: given.flag("differentiates", report),
    }
}

#[derive(Clone, Copy)]
enum Kind {
    Explicit,
    Implicit,
    Fixed,
}

fn method(fields: &Fields<'_>, report: &mut Report) -> Method {
    let known = &["method", "relative", "absolute", "max_step_s", "step_s"];
    let Some(given) = fields.get("integrator").and_then(|node| node.fields(known, report)) else {
        return Method::default();
    };
    let words = &["dormand_prince", "radau", "runge_kutta"];
    let meanings = [Kind::Explicit, Kind::Implicit, Kind::Fixed];
    let word = given.get("method").and_then(|node| node.choice(words, &meanings, report));
    let absent = Accuracy::default();
    let accuracy = Accuracy {
        relative: given.number("relative", ranges::RELATIVE, absent.relative, report),
        absolute: given.number("absolute", ranges::ABSOLUTE, absent.absolute, report),
        max_step_s: given.number("max_step_s", ranges::STEP_S, absent.max_step_s, report),
    };
    let step_s = given.number("step_s", ranges::STEP_S, 1e-3, report);
    match word.unwrap_or(Kind::Explicit) {
        Kind::Explicit => Method::DormandPrince(accuracy),
        Kind::Implicit => Method::Radau(accuracy),
        Kind::Fixed => Method::RungeKutta { step_s },
    }
}

fn contact(fields: &Fields<'_>, simulation: &mut Simulation, report: &mut Report) {
    let known = &[
        "friction",
        "restitution",
        "rest_speed_m_s",
        "fallback_friction",
        "scuffing",
        "drift_rate_per_s",
    ];
    let Some(given) = fields.get("contact").and_then(|node| node.fields(known, report)) else {
        return;
    };
    let touching = &mut simulation.touching;
    if let Some(friction) = given.get("friction") {
        simulation.friction = if friction.any_number().is_some() {
            Friction::Coulomb(given.number("friction", ranges::FRICTION, 0.0, report))
        } else {
            let word = friction.choice(&["no_slip"], &[Friction::NoSlip], report);
            word.unwrap_or(Friction::NoSlip)
        };
    }
    touching.restitution = given.number("restitution", ranges::RESTITUTION, 0.0, report);
    touching.rest_speed =
        given.number("rest_speed_m_s", ranges::REST_SPEED_M_S, touching.rest_speed, report);
    if given.get("fallback_friction").is_some() {
        let range = ranges::SOME_FRICTION;
        touching.fallback_friction = Some(given.number("fallback_friction", range, 1.0, report));
    }
    if let Some(word) = given.get("scuffing") {
        let meanings = [Scuffing::Counts, Scuffing::IgnoredBehind];
        touching.scuffing =
            word.choice(&["counts", "ignored_behind"], &meanings, report).unwrap_or_default();
    }
    simulation.drift_rate =
        given.number("drift_rate_per_s", ranges::DRIFT_RATE_PER_S, simulation.drift_rate, report);
}

/// What audits may miss, by the object under `tolerances`.
pub(super) fn tolerances(
    fields: &Fields<'_>,
    absent: Tolerances,
    report: &mut Report,
) -> Tolerances {
    let mut tolerances = absent;
    let known = &[
        "energy_j",
        "momentum_ns",
        "penetration_m",
        "complementarity_nm",
        "adhesion_n",
        "separation_m_s",
        "zmp_m",
        "force_n",
        "cone_n",
        "friction_angle_rad",
    ];
    let Some(given) = fields.get("tolerances").and_then(|node| node.fields(known, report)) else {
        return tolerances;
    };
    let t = &mut tolerances;
    let entries: [&mut f64; 10] = [
        &mut t.energy_j,
        &mut t.momentum_ns,
        &mut t.penetration_m,
        &mut t.complementarity_nm,
        &mut t.adhesion_n,
        &mut t.separation_m_s,
        &mut t.zmp_m,
        &mut t.force_n,
        &mut t.cone_n,
        &mut t.friction_angle_rad,
    ];
    for (key, entry) in known.iter().zip(entries) {
        *entry = given.number(key, ranges::TOLERANCE, *entry, report);
    }
    tolerances
}
