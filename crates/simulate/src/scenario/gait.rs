//! The gait that a scenario asks for. It is planned above this package, before anything is
//! simulated; here its references complete the control.

use super::fault::Cause;
use super::reader::Report;
use crate::control::{Compensation, Control};
use crate::planner::Planning;
use denavit_codegen::model::{Fields, Node};
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;

/// What a planner made of the key `gait`.
#[derive(Clone, Debug)]
pub struct PlannedGait {
    /// What each joint follows; none where no drive is to follow.
    pub references: Vec<Option<Reference>>,
    /// Planned torques of each joint [N m, N]; none where none are planned.
    pub torques: Vec<Option<Reference>>,
    /// Stiffness of the joints' laws [N m/rad, N/m].
    pub stiffness: f64,
    /// Damping of the joints' laws [N m s/rad, N s/m].
    pub damping: f64,
    /// Where all coordinates are at the beginning [rad, m].
    pub start: Option<Vec<f64>>,
    /// What plans references during the run.
    pub planning: Option<Planning>,
}

/// Plans what stands under the key `gait` for a plant; faults go into the report.
pub type GaitPlanner<'a> =
    dyn Fn(Node<'_>, &mut dyn Plant, &mut Report) -> Option<PlannedGait> + 'a;

/// Has the gait of a scenario planned, if it asks for one: completes the control, and gives the
/// first posture.
pub(super) fn gait(
    fields: &Fields<'_>,
    plant: &mut dyn Plant,
    planner: Option<&GaitPlanner<'_>>,
    control: &mut Control,
    report: &mut Report,
) -> Option<Vec<f64>> {
    let node = fields.get("gait")?;
    let Some(planner) = planner else {
        report.push(node.at(), Cause::NoPlanner);
        return None;
    };
    let gait = planner(node, plant, report)?;
    let is_sampled = control.period_s.is_some();
    if gait.planning.is_some() && (is_sampled || control.compensation != Compensation::None) {
        let why = "torques are planned during the run, and `control` adds others".to_owned();
        report.push(node.at(), Cause::Gait(why, "leave `compensation` and `period_s` out"));
    }
    let planned = gait.references.into_iter().zip(gait.torques);
    for (index, (law, (reference, torque))) in control.joints.iter_mut().zip(planned).enumerate() {
        let has_own = law.reference.is_some() || law.feed_forward.is_some();
        if gait.planning.is_some() && reference.is_some() && has_own {
            let joint = &plant.model().joints[index].name;
            let why = format!("`{joint}` is planned during the run, and `control` says otherwise");
            report.push(node.at(), Cause::Gait(why, "leave it out of `control`, but for gains"));
        }
        // what the scenario says of a joint itself goes before
        if law.reference.is_some() || reference.is_none() {
            continue;
        }
        law.reference = reference;
        law.feed_forward = law.feed_forward.take().or(torque);
        if law.stiffness == 0.0 && law.damping == 0.0 {
            (law.stiffness, law.damping) = (gait.stiffness, gait.damping);
        }
    }
    control.planning = gait.planning;
    gait.start
}
