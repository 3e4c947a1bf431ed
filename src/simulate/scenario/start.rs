//! What is wrong with a start shows only when the robot is put there.

use super::Scenario;
use super::fault::Cause;
use super::reader::Report;
use crate::simulate::contact::delassus::Delassus;
use crate::simulate::control::ControlMemory;
use crate::simulate::start::check_gaps;

/// Notes what keeps a scenario, whose numbers are sound one by one, from beginning: a contact below
/// the ground, parts without mass, torques that no number holds.
pub(super) fn find_start_faults(scenario: &mut Scenario, report: &mut Report) {
    let (plant, state) = (scenario.plant.as_mut(), &scenario.initial);
    let n = state.q.len();
    if let Err(error) = check_gaps(plant, &state.q) {
        report.push("/initial", Cause::Start(error));
    }
    let mut mass = vec![0.0; n * n];
    plant.mass_matrix(&state.q, &mut mass);
    if let Err(error) = Delassus::new().factor(&mass, n) {
        let joint = plant.model().joints[error.coordinate].name.clone();
        report.push("/model", Cause::Singular(joint));
    }
    let mut command = vec![0.0; n];
    let mut memory = ControlMemory::default();
    let control = &scenario.control;
    control.command(plant, state.t_s, &state.q, &state.qd, &mut memory, &mut command);
    for (joint, torque) in plant.model().joints.iter().zip(command) {
        if !torque.is_finite() {
            let pointer = format!("/control/joints/{}", joint.name);
            report.push(&pointer, Cause::TorqueNotFinite(joint.name.clone()));
        }
    }
}
