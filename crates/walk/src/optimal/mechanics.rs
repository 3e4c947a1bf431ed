//! Dynamics and contacts of a plant at one moment, with their derivatives.

use denavit_plants::{ContactDerivatives, Plant};

/// Where a plant is, how it moves, and what the ground does to it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moment<'a> {
    pub(super) q: &'a [f64],
    pub(super) qd: &'a [f64],
    pub(super) qdd: &'a [f64],
    /// Forces on all contact points, world frame, three entries each \[N\].
    pub(super) forces: &'a [f64],
}

/// Functions of a plant at a moment, into memory that stays. Matrices are row-major.
#[derive(Clone, Debug, Default)]
pub(super) struct Mechanics {
    /// D qdd + bias - W f, n entries [N m, N].
    pub(super) residual: Vec<f64>,
    /// D, n x n.
    pub(super) mass: Vec<f64>,
    /// Contact points, 3 c entries \[m\].
    pub(super) positions: Vec<f64>,
    /// W^T, 3 c x n.
    pub(super) jacobian: Vec<f64>,
    /// W^T qd [m/s].
    pub(super) velocity: Vec<f64>,
    /// Accelerations of the contact points [m/s^2].
    pub(super) acceleration: Vec<f64>,
    /// d residual / dq, n x n.
    pub(super) residual_q: Vec<f64>,
    /// d residual / dqd, n x n.
    pub(super) residual_qd: Vec<f64>,
    contacts: Option<ContactDerivatives>,
    scratch: Vec<f64>,
}

/// The product of a row-major matrix with a vector.
pub(super) fn product(matrix: &[f64], x: &[f64], result: &mut Vec<f64>) {
    result.clear();
    let rows = matrix.chunks_exact(x.len());
    result.extend(rows.map(|row| row.iter().zip(x).map(|(m, x)| m * x).sum::<f64>()));
}

impl Mechanics {
    /// The functions themselves.
    pub(super) fn evaluate(&mut self, plant: &mut dyn Plant, moment: Moment<'_>) {
        let (n, rows) = (moment.q.len(), moment.forces.len());
        self.mass.resize(n * n, 0.0);
        self.scratch.resize(n.max(rows), 0.0);
        self.positions.resize(rows, 0.0);
        self.jacobian.resize(rows * n, 0.0);
        plant.mass_matrix(moment.q, &mut self.mass);
        plant.contact_positions(moment.q, &mut self.positions);
        plant.contact_jacobian(moment.q, &mut self.jacobian);
        product(&self.jacobian, moment.qd, &mut self.velocity);
        product(&self.jacobian, moment.qdd, &mut self.acceleration);
        plant.contact_bias(moment.q, moment.qd, &mut self.scratch[..rows]);
        self.acceleration.iter_mut().zip(&self.scratch).for_each(|(a, bias)| *a += bias);
        product(&self.mass, moment.qdd, &mut self.residual);
        plant.bias(moment.q, moment.qd, &mut self.scratch[..n]);
        self.residual.iter_mut().zip(&self.scratch).for_each(|(r, bias)| *r += bias);
        for (row, force) in self.jacobian.chunks_exact(n).zip(moment.forces) {
            if *force != 0.0 {
                self.residual.iter_mut().zip(row).for_each(|(r, w)| *r -= w * force);
            }
        }
    }

    /// The functions and their derivatives; all zeros for a plant without derivatives, of which no
    /// step is made.
    pub(super) fn differentiate(&mut self, plant: &mut dyn Plant, moment: Moment<'_>) {
        let n = moment.q.len();
        self.evaluate(plant, moment);
        self.residual_q.resize(n * n, 0.0);
        self.residual_qd.resize(n * n, 0.0);
        let Moment { q, qd, qdd, forces } = moment;
        let (by_q, by_qd) = (&mut self.residual_q, &mut self.residual_qd);
        plant.inverse_dynamics_derivatives(q, qd, qdd, by_q, by_qd);
        let contacts = self.contacts.get_or_insert_with(|| ContactDerivatives::new(plant.model()));
        plant.contact_derivatives(q, qd, qdd, forces, contacts);
        self.residual_q.iter_mut().zip(&contacts.torque_dq).for_each(|(r, w)| *r -= w);
    }

    /// Derivatives of the contact points by the last call of `differentiate`.
    pub(super) fn contacts(&self) -> &ContactDerivatives {
        self.contacts.as_ref().expect("derivatives were asked for")
    }
}
