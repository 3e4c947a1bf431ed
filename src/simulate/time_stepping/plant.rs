//! A plant under control, as a model of time stepping.

use super::{Instant, Terms, TimeSteppingModel};
use crate::plants::{JointModel, Plant};
use crate::simulate::contact::Space;
use crate::simulate::control::{Compensation, Control, ControlMemory, JointControl};
use crate::simulate::ground::Ground;

/// A plant on its ground under continuous control, with ideal drives: commands reach the joints.
///
/// Damping of the controller and viscous friction are implicit.
pub struct ControlledPlant<'a> {
    plant: &'a mut dyn Plant,
    control: &'a Control,
    ground: Ground,
    memory: ControlMemory,
    /// Viscous friction, and damping of the feedback, of each joint.
    viscous: Vec<f64>,
    feedback: Vec<f64>,
    command: Vec<f64>,
    positions: Vec<f64>,
    jacobian: Vec<f64>,
    rows: Vec<f64>,
}

impl<'a> ControlledPlant<'a> {
    /// The plant under this law of control, which has an entry for each of its joints.
    pub fn new(plant: &'a mut dyn Plant, control: &'a Control) -> Self {
        let model = plant.model();
        let (n, points) = (model.joints.len(), model.contacts.len());
        assert_eq!(control.joints.len(), n, "control of every joint");
        // Gains of computed torque are accelerations.
        let are_gains = control.compensation != Compensation::ComputedTorque;
        let feedback = |(joint, law): (&JointModel, &JointControl)| {
            let follows = law.reference.is_some() && joint.drivable && are_gains;
            if follows { law.damping } else { 0.0 }
        };
        Self {
            ground: Ground::new(model),
            viscous: model.joints.iter().map(|joint| joint.viscous).collect(),
            feedback: model.joints.iter().zip(&control.joints).map(feedback).collect(),
            plant,
            control,
            memory: ControlMemory::default(),
            command: vec![0.0; n],
            positions: vec![0.0; 3 * points],
            jacobian: vec![0.0; 3 * points * n],
            rows: Vec::new(),
        }
    }

    /// The plant.
    pub fn plant(&mut self) -> &mut dyn Plant {
        self.plant
    }
}

impl TimeSteppingModel for ControlledPlant<'_> {
    fn dof(&self) -> usize {
        self.command.len()
    }

    fn contacts(&self) -> usize {
        self.positions.len() / 3
    }

    fn space(&self) -> Space {
        self.ground.space
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        self.plant.contact_positions(q, &mut self.positions);
        for (gap, position) in gaps.iter_mut().zip(self.positions.chunks_exact(3)) {
            *gap = self.ground.gap(position);
        }
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        let n = self.command.len();
        self.plant.mass_matrix(at.q, &mut terms.mass);
        self.plant.bias(at.q, at.qd, &mut terms.force);
        let command = &mut self.command;
        self.control.command(self.plant, at.t_s, at.q, at.qd, &mut self.memory, command);
        for (force, command) in terms.force.iter_mut().zip(command) {
            *force = *command - *force;
        }
        for joint in 0..n {
            let factor = self.control.joints[joint].gain_factor.as_ref();
            let factor = factor.map_or(1.0, |factor| factor.at(at.t_s).position);
            terms.damping[joint * n + joint] = self.viscous[joint] + factor * self.feedback[joint];
        }
        if closed.is_empty() {
            return;
        }
        self.plant.contact_jacobian(at.q, &mut self.jacobian);
        self.rows.clear();
        for &contact in closed {
            let world = &self.jacobian[3 * contact * n..3 * (contact + 1) * n];
            self.ground.append_rows(world, n, &mut self.rows);
        }
        terms.jacobian.copy_from_slice(&self.rows);
    }
}
