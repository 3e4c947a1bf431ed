//! Robots that are pushed from outside: what contact forces, and wrenches on links, do to each
//! equation (thesis 3.3, 5.2.1).
//!
//! D qdd + C qd + G = tau + W lambda: the right side is what is regressed. The virtual joints of a
//! floating base have no torque of their own, so their rows are the wrench that contacts put on it.

use denavit_codegen::model::Robot;
use denavit_measure::log::{LogRemark, MeasuredLog};
use denavit_plants::regression::RegressionModel;
use denavit_plants::{Plant, plant_of};

/// Half the distance of differences [rad, m]: of order 4, so that rounding and the rest of
/// the Taylor series are both about 1e-13.
const DIFFERENCE: f64 = 1e-3;

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
    pub fn under(
        robot: &Robot,
        model: &RegressionModel,
    ) -> Result<Option<Self>, denavit_plants::Error> {
        let floats = model.joints.iter().any(|joint| joint.is_base);
        floats.then(|| Self::around(robot, model)).transpose()
    }

    /// What is around any robot, fixed ones too, which something may push.
    ///
    /// # Errors
    /// If the robot's contacts cannot be derived.
    pub fn around(robot: &Robot, model: &RegressionModel) -> Result<Self, denavit_plants::Error> {
        let is_base = model.joints.iter().map(|joint| joint.is_base).collect();
        Ok(Self { plant: plant_of(robot, &[])?, is_base })
    }

    /// Puts the forces and wrenches that a log has on its joints: [`add_contact_forces`],
    /// [`add_wrenches`].
    pub fn load(&mut self, log: &mut MeasuredLog) {
        add_contact_forces(log, self.plant.as_mut(), &self.is_base);
        add_wrenches(log, self.plant.as_mut());
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

/// Adds what wrenches on links do to the torques of a log: of a joint f . dp/dq + m . w, with p the
/// origin of the link's frame and w the angular velocity of a unit velocity of the joint.
pub fn add_wrenches(log: &mut MeasuredLog, plant: &mut dyn Plant) {
    let names = plant.model().links.clone();
    let wrenches = std::mem::take(&mut log.wrenches);
    let mut placed = Vec::new();
    for (link, parts) in &wrenches {
        match names.iter().position(|known| known == link) {
            Some(place) => placed.push((place, parts)),
            None => log.remarks.push(LogRemark::NoSuchLink { link: link.clone() }),
        }
    }
    let n = log.joints.len();
    let mut q = vec![0.0; n];
    let mut at = vec![vec![0.0; 12 * names.len()]; 5];
    for sample in 0..if placed.is_empty() { 0 } else { log.samples() } {
        for (q, joint) in q.iter_mut().zip(&log.joints) {
            *q = joint.q[sample];
        }
        plant.link_transforms(&q, &mut at[4]);
        for joint in 0..n {
            let Some(mut torque) = log.joints[joint].tau.as_ref().map(|tau| tau[sample]) else {
                continue;
            };
            let here = q[joint];
            for (steps, transforms) in [2.0, 1.0, -1.0, -2.0].into_iter().zip(&mut at) {
                q[joint] = here + steps * DIFFERENCE;
                plant.link_transforms(&q, transforms);
            }
            q[joint] = here;
            for (link, parts) in &placed {
                let part = |part: usize| parts[part].get(sample).copied().unwrap_or(0.0);
                torque += power(&at, 12 * link, std::array::from_fn(part));
            }
            if let Some(tau) = &mut log.joints[joint].tau {
                tau[sample] = torque;
            }
        }
    }
    log.wrenches = wrenches;
}

/// The power of a wrench at a unit velocity of a joint, of transforms at two steps and one ahead,
/// one and two behind, and where the joint is; `first` is the place of the link's.
fn power(at: &[Vec<f64>], first: usize, wrench: [f64; 6]) -> f64 {
    let slope = |row: usize, column: usize| {
        let entry = |place: usize| at[place][first + 4 * row + column];
        (8.0 * (entry(1) - entry(2)) - (entry(0) - entry(3))) / (12.0 * DIFFERENCE)
    };
    // R' R^T is the cross product with the angular velocity
    let turn = |row: usize, column: usize| -> f64 {
        (0..3).map(|k| slope(row, k) * at[4][first + 4 * column + k]).sum()
    };
    let angular = [turn(2, 1), turn(0, 2), turn(1, 0)];
    (0..3).map(|axis| wrench[axis] * slope(axis, 3) + wrench[3 + axis] * angular[axis]).sum()
}
