//! Robots on the ground: what contact forces do to each equation (thesis 3.3, 5.2.1).
//!
//! D qdd + C qd + G = tau + W lambda: the right side is what is regressed. The virtual joints of a
//! floating base have no torque of their own, so their rows are the wrench that contacts put on it.

use denavit_codegen::model::Robot;
use denavit_measure::log::MeasuredLog;
use denavit_plants::regression::RegressionModel;
use denavit_plants::{Plant, PlantError, plant_of};

/// The ground under a robot on a floating base, as its logs know it.
pub struct Ground {
    plant: Box<dyn Plant>,
    is_base: Vec<bool>,
}

impl Ground {
    /// The ground under a robot; none under one that is fixed.
    ///
    /// # Errors
    /// If the robot's contacts cannot be derived.
    pub fn under(robot: &Robot, model: &RegressionModel) -> Result<Option<Self>, PlantError> {
        let is_base: Vec<bool> = model.joints.iter().map(|joint| joint.is_base).collect();
        if !is_base.contains(&true) {
            return Ok(None);
        }
        Ok(Some(Self { plant: plant_of(robot, &[])?, is_base }))
    }

    /// Puts the forces that a log has on its joints: [`add_contact_forces`].
    pub fn load(&mut self, log: &mut MeasuredLog) {
        add_contact_forces(log, self.plant.as_mut(), &self.is_base);
    }
}

/// Adds W lambda to the torques of a log, and gives the virtual joints of a floating base their
/// rows. `is_base` says which joints these are.
///
/// A log of time stepping has means of forces over the interval that a row ends, half an interval
/// late: there the mean of a row and the next one counts.
pub fn add_contact_forces(log: &mut MeasuredLog, plant: &mut dyn Plant, is_base: &[bool]) {
    let samples = log.samples();
    let n = log.joints.len();
    for (joint, is_base) in log.joints.iter_mut().zip(is_base) {
        if *is_base && joint.tau.is_none() {
            joint.tau = Some(vec![0.0; samples]);
        }
    }
    let names: Vec<String> = plant.model().contacts.iter().map(|one| one.name.clone()).collect();
    let places: Vec<usize> = log
        .contacts
        .iter()
        .filter_map(|(name, _)| names.iter().position(|known| known == name))
        .collect();
    if places.is_empty() {
        return;
    }
    let is_late =
        log.header.iter().any(|(name, value)| name == "scheme" && value == "time_stepping");
    let at = |force: &[f64], sample: usize| {
        let here = force.get(sample).copied().unwrap_or(0.0);
        let next = force.get(sample + 1).copied().filter(|_| is_late);
        next.map_or(here, |next| 0.5 * (here + next))
    };
    let mut jacobian = vec![0.0; 3 * names.len() * n];
    let mut q = vec![0.0; n];
    for sample in 0..samples {
        for (q, joint) in q.iter_mut().zip(&log.joints) {
            *q = joint.q[sample];
        }
        plant.contact_jacobian(&q, &mut jacobian);
        for ((_, force), &place) in log.contacts.iter().zip(&places) {
            for (axis, force) in force.iter().enumerate() {
                let force = at(force, sample);
                let row = &jacobian[(3 * place + axis) * n..(3 * place + axis + 1) * n];
                for (entry, joint) in row.iter().zip(&mut log.joints) {
                    if let Some(tau) = &mut joint.tau {
                        tau[sample] += entry * force;
                    }
                }
            }
        }
    }
}
