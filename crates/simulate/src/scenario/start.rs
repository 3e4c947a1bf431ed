//! What is wrong with a start shows only when the robot is put there.

use super::Scenario;
use super::fault::{Cause, ScenarioError};
use super::reader::Report;
use crate::breakdown::Breakdown;
use crate::contact::delassus::Delassus;
use crate::control::ControlMemory;
use crate::error::Error;
use crate::start::{StartError, check_gaps, quarter_turn_left};
use denavit_codegen::model::json::{self, Json};

/// Notes what keeps a scenario, whose numbers are sound one by one, from beginning: a contact below
/// the ground, parts without mass, torques that no number holds.
pub(super) fn find_start_faults(scenario: &mut Scenario, root: &Json<'_>, report: &mut Report) {
    let (plant, state) = (scenario.plant.as_mut(), &scenario.initial);
    let n = state.q.len();
    if let Err(error) = check_gaps(plant, &state.q) {
        report.push(root.offset(["initial"]), Cause::Start(error.into()));
    }
    let mut mass = vec![0.0; n * n];
    plant.mass_matrix(&state.q, &mut mass);
    let roll = plant.model().singular_base_joint().map(|joint| state.q[joint]);
    if roll.is_some_and(|roll| quarter_turn_left(roll) <= 0.0) {
        // rounding decides whether that shows in the masses
        let pose = StartError::Breakdown(Breakdown::SingularPose);
        report.push(root.offset(["initial"]), Cause::Start(pose.into()));
    } else if let Err(error) = Delassus::new().factor(&mass, n) {
        let joint = plant.model().joints[error.coordinate].name.clone();
        report.push(root.offset(["model"]), Cause::Singular(joint));
    }
    let mut command = vec![0.0; n];
    let mut memory = ControlMemory::default();
    let control = &scenario.control;
    control.command(plant, state.t_s, &state.q, &state.qd, &mut memory, &mut command);
    for (joint, torque) in plant.model().joints.iter().zip(command) {
        if !torque.is_finite() {
            let place = root.offset(["control", "joints", &joint.name]);
            report.push(place, Cause::TorqueNotFinite(joint.name.clone()));
        }
    }
}

/// The file that a scenario was read from.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    pub(super) file: String,
    pub(super) source: Vec<u8>,
}

impl Origin {
    /// What keeps the run from beginning, at the place in the file that is to blame.
    pub(super) fn place(&self, error: Error) -> ScenarioError {
        let path: &[&str] = match error.start() {
            Some(StartError::EventSchemeOnly(_)) => &["contact", "scuffing"],
            Some(StartError::MoreauOnly(_)) => &["contact", "restitution"],
            Some(StartError::Penetration(..) | StartError::Breakdown(_)) => &["initial"],
            Some(StartError::Steps(part, ..)) => &[part],
            Some(StartError::Length(..) | StartError::Number(_)) | None => &[],
        };
        let root = json::parse(&self.source).ok();
        let at = root.as_ref().map_or(0, |root| root.offset(path.iter().copied()));
        let mut report = Report::default();
        report.push(at, Cause::Start(error));
        report.into_error(&self.file, &self.source, root.as_ref())
    }
}
