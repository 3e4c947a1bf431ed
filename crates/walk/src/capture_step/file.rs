//! The law as scenario files have it, under the key `gait`.

use super::law::{CaptureStep, capture_step};
use denavit_codegen::model::Node;
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;
use denavit_simulate::Planning;
use denavit_simulate::scenario::{FieldsNumbers, PlannedGait, Range, Report};

const KEYS: &[&str] = &[
    "center_of_mass_height_m",
    "step_s",
    "longest_step_m",
    "lift_m",
    "margin_m",
    "period_s",
    "kp",
    "kd",
];

const HEIGHT_M: Range = Range::new(1e-2, 10.0);
const STEP_S: Range = Range::new(1e-2, 10.0);
const LENGTH_M: Range = Range::new(0.0, 10.0);
const PERIOD_S: Range = Range::new(1e-4, 1.0);

/// Reads the law, and prepares it for the robot.
pub(crate) fn read(
    node: Node<'_>,
    plant: &mut dyn Plant,
    report: &mut Report,
) -> Option<PlannedGait> {
    let given = node.fields(KEYS, report)?;
    let before = report.count();
    let absent = CaptureStep::default();
    let height_m = given.required_number("center_of_mass_height_m", HEIGHT_M, report);
    let mut number =
        |key: &str, range: Range, absent: f64| given.number(key, range, absent, report);
    let numbers = CaptureStep {
        height_m,
        step_s: number("step_s", STEP_S, absent.step_s),
        longest_m: number("longest_step_m", LENGTH_M, absent.longest_m),
        lift_m: number("lift_m", LENGTH_M, absent.lift_m),
        margin_m: number("margin_m", LENGTH_M, absent.margin_m),
        period_s: number("period_s", PERIOD_S, absent.period_s),
    };
    let stiffness = number("kp", Range::GAIN, 2000.0);
    let damping = number("kd", Range::GAIN, 40.0);
    if report.count() > before {
        return None;
    }
    let prepared = match capture_step(plant, &numbers) {
        Ok(prepared) => prepared,
        Err(error) => {
            report.push(node.at(), error.of_gait());
            return None;
        }
    };
    let mut references = vec![None; prepared.start.len()];
    for joint in prepared.law.driven() {
        references[*joint] = Some(Reference::Constant(prepared.start[*joint]));
    }
    Some(PlannedGait {
        torques: vec![None; references.len()],
        references,
        stiffness,
        damping,
        start: Some(prepared.start),
        planning: Some(Planning::new(prepared.law)),
    })
}
