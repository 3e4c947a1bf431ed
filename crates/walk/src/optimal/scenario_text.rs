//! A designed limit cycle as a scenario file.

use super::design::LimitCycle;
use super::following::joint_gains;
use super::planned::PlannedPhase;
use crate::robustness::FALLBACK_FRICTION;
use crate::scenario_file::{
    ContactFriction, JointLaw, ScenarioHead, ScenarioRun, list, number, scenario_file, sequence,
};
use denavit_plants::PlantModel;

/// The scenario file of a gait; the same gait gives the same bytes.
pub fn scenario_text(gait: &LimitCycle, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
    let driven = gait.step.legs.driven.iter();
    let laws: Vec<JointLaw> = driven.map(|joint| joint_law(gait, *joint)).collect();
    let run = ScenarioRun {
        duration_s: head.steps as f64 * gait.step.period_s,
        start: &gait.cycle.start,
        laws: &laws,
        friction: ContactFriction::Fallback(FALLBACK_FRICTION),
    };
    scenario_file(model, head, &run)
}

fn joint_law(gait: &LimitCycle, joint: usize) -> JointLaw {
    let law = joint_gains(&gait.step, &gait.gains, joint);
    let factors = two_steps(gait, |phase, step| number(law.factors[step][phase]));
    let reference = two_steps(gait, |phase, step| {
        quintic(&gait.step.phases[phase], gait.step.role_of(joint, step))
    });
    let feed_forward = two_steps(gait, |phase, step| {
        let coordinate = gait.step.role_of(joint, step);
        let drive = gait.step.legs.driven.iter().position(|driven| *driven == coordinate);
        cubic(&gait.step.phases[phase], drive.unwrap_or(0))
    });
    JointLaw {
        joint,
        stiffness: law.stiffness,
        damping: law.damping,
        functions: vec![
            ("gain_factor", factors),
            ("reference", reference),
            ("feed_forward", feed_forward),
        ],
    }
}

/// A function of time over two steps, again and again.
fn two_steps(gait: &LimitCycle, reference: impl Fn(usize, usize) -> String) -> String {
    let phases = &gait.step.phases;
    let parts = [0, 1].into_iter().flat_map(|step| {
        let reference = &reference;
        let phases = phases.iter().enumerate();
        phases.map(move |(phase, planned)| (planned.duration_s, reference(phase, step)))
    });
    sequence(parts, true)
}

fn quintic(phase: &PlannedPhase, coordinate: usize) -> String {
    let column = |rows: &[Vec<f64>]| list(rows.iter().map(|row| row[coordinate]));
    format!(
        "{{\"quintic\": {{\n            \"times\": {},\n            \"values\": {},\n            \
         \"rates\": {},\n            \"accelerations\": {}}}}}",
        list(phase.times_s.iter().copied()),
        column(&phase.q),
        column(&phase.qd),
        column(&phase.qdd)
    )
}

fn cubic(phase: &PlannedPhase, drive: usize) -> String {
    let values: Vec<f64> = phase.torques_nm.iter().map(|row| row[drive]).collect();
    let ends = phase.torque_rates(&values);
    format!(
        "{{\"cubic\": {{\n            \"times\": {},\n            \"values\": {},\n            \
         \"end_rates\": {}}}}}",
        list(phase.times_s.iter().copied()),
        list(values.into_iter()),
        list(ends.into_iter())
    )
}
