//! Scenarios with gaits: the key `gait` is planned here, then the simulation sees references.

use crate::capture_step::read as read_capture_step;
use crate::error::Error;
use crate::foot_placement::{self, FootPlacement};
use crate::gait_file::divergent_component;
use crate::gait_plan::{DivergentComponentProblem, SpaceWalk, plan_space_walk};
use denavit_codegen::model::Node;
use denavit_plants::Plant;
use denavit_simulate::scenario::{
    Cause, Loader, PlannedGait, Report, Scenario, ScenarioError, read_planned,
};

/// Reads a scenario file from its bytes, and plans the gait that it asks for. `file` is its name,
/// for messages alone.
///
/// # Errors
/// All faults of the file; where the gait cannot be planned, the posture and time at which.
pub fn read_scenario(
    file: &str,
    source: &[u8],
    load: &Loader<'_>,
) -> Result<Scenario, ScenarioError> {
    read_planned(file, source, load, Some(&planned))
}

/// Plans what stands under the key `gait`.
fn planned(gait: Node<'_>, plant: &mut dyn Plant, report: &mut Report) -> Option<PlannedGait> {
    let kinds = gait.fields(&["divergent_component", "foot_placement", "capture_step"], report)?;
    let placement = kinds.get("foot_placement");
    let placement = placement.map(|node| (node, foot_placement::read(node, report)));
    match (kinds.get("divergent_component"), kinds.get("capture_step")) {
        (Some(node), None) => planned_walk(node, placement, plant, report),
        (None, Some(node)) => {
            if let Some((other, _)) = placement {
                let hint = "it belongs to a walk in space: `divergent_component`";
                report.push(other.at(), Cause::Gait("no walk to place feet of".to_owned(), hint));
            }
            read_capture_step(node, plant, report)
        }
        (Some(_), Some(other)) => other.wrong_kind("one kind of gait, not two", report),
        (None, None) => gait.wrong_kind("`divergent_component` or `capture_step`", report),
    }
}

/// Plans a walk in space, and the law that places its feet if there is one.
fn planned_walk(
    node: Node<'_>,
    placement: Option<(Node<'_>, Option<FootPlacement>)>,
    plant: &mut dyn Plant,
    report: &mut Report,
) -> Option<PlannedGait> {
    let fields = node.members(report)?;
    if let Some(friction) = fields.get("friction") {
        let hint = "the ground of a scenario is under `contact`";
        report.push(friction.at(), Cause::Gait("no effect here".to_owned(), hint));
    }
    let problem = divergent_component::read(node, report)?;
    let (gait, walk) = match followed(plant, &problem) {
        Ok(planned) => planned,
        Err(error) => {
            report.push(node.at(), error.of_gait());
            return None;
        }
    };
    let Some((node, law)) = placement else { return Some(gait) };
    let planning = Some(law?.planning(walk, node, report)?);
    Some(PlannedGait { planning, ..gait })
}

/// What each joint follows, and the torque that is planned for it.
fn followed(
    plant: &mut dyn Plant,
    problem: &DivergentComponentProblem,
) -> Result<(PlannedGait, SpaceWalk), Error> {
    let (plan, walk) = plan_space_walk(plant, problem)?;
    let references = plan.references(plant.model())?;
    let mut torques = vec![None; references.len()];
    for path in &plan.paths {
        let torque = path.feed_forward.as_ref().map(|curve| curve.reference());
        torques[path.joint] = torque.transpose()?;
    }
    let gait = PlannedGait {
        references,
        torques,
        stiffness: plan.gains.kp,
        damping: plan.gains.kd,
        start: Some(plan.start),
        planning: None,
    };
    Ok((gait, walk))
}
