//! A plant under control, as a model of time stepping.

use super::{Instant, Terms, TimeSteppingModel};
use crate::plants::Plant;
use crate::simulate::contact::Space;
use crate::simulate::control::{Compensation, Control, ControlMemory};
use crate::simulate::ground::Ground;

/// A plant on its ground under continuous control, with ideal drives: commands reach the joints.
///
/// Damping of the controller and viscous friction are implicit.
pub struct ControlledPlant<'a> {
    plant: &'a mut dyn Plant,
    control: &'a Control,
    ground: Ground,
    memory: ControlMemory,
    /// Diagonal of the damping matrix.
    damping: Vec<f64>,
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
        let damping = |(joint, law): (&crate::plants::JointModel, _)| {
            let law: &crate::simulate::JointControl = law;
            // Gains of computed torque are accelerations.
            let feedback = law.reference.is_some()
                && joint.drivable
                && control.compensation != Compensation::ComputedTorque;
            joint.viscous + if feedback { law.damping } else { 0.0 }
        };
        Self {
            ground: Ground::new(model),
            damping: model.joints.iter().zip(&control.joints).map(damping).collect(),
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
        for (joint, damping) in self.damping.iter().enumerate() {
            terms.damping[joint * n + joint] = *damping;
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
