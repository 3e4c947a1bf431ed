//! Derivatives of what contact points do.

use super::PlantModel;

/// Derivatives of the motion of c contact points of a robot with n joints, and of the torques of
/// forces on them. Rows x, y, z of each point in turn, row-major, world frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactDerivatives {
    /// d(W^T qd)/dq, 3 c x n.
    pub velocity_dq: Vec<f64>,
    /// d(W^T qdd + (d/dt W^T) qd)/dq, 3 c x n.
    pub acceleration_dq: Vec<f64>,
    /// The derivative of the same accelerations by qd, 3 c x n: twice `velocity_dq`.
    pub acceleration_dqd: Vec<f64>,
    /// d(W f)/dq at constant forces, n x n, symmetric.
    pub torque_dq: Vec<f64>,
}

impl ContactDerivatives {
    /// Zeros, in the sizes of a plant.
    pub fn new(model: &PlantModel) -> Self {
        let n = model.joints.len();
        let rows = vec![0.0; 3 * model.contacts.len() * n];
        Self {
            velocity_dq: rows.clone(),
            acceleration_dq: rows.clone(),
            acceleration_dqd: rows,
            torque_dq: vec![0.0; n * n],
        }
    }

    /// The arrays in the order of the compiler's outputs.
    pub(crate) fn arrays(&mut self) -> [&mut [f64]; 4] {
        [
            &mut self.velocity_dq,
            &mut self.acceleration_dq,
            &mut self.acceleration_dqd,
            &mut self.torque_dq,
        ]
    }
}
