//! Dynamics and contacts of a plant at one moment, with their derivatives.

use denavit_plants::Plant;

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
    /// d velocity / dq, 3 c x n.
    pub(super) velocity_q: Vec<f64>,
    /// d acceleration / dq, 3 c x n.
    pub(super) acceleration_q: Vec<f64>,
    /// d acceleration / dqd, 3 c x n.
    pub(super) acceleration_qd: Vec<f64>,
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

    /// The functions and their derivatives.
    pub(super) fn differentiate(&mut self, plant: &mut dyn Plant, moment: Moment<'_>) {
        let n = moment.q.len();
        let rows = moment.forces.len();
        let h = 1e-6;
        for m in [&mut self.residual_q, &mut self.residual_qd] {
            m.resize(n * n, 0.0);
        }
        for m in [&mut self.velocity_q, &mut self.acceleration_q, &mut self.acceleration_qd] {
            m.resize(rows * n, 0.0);
        }
        for k in 0..n {
            let mut sides = Vec::new();
            for s in [h, -h] {
                let mut q = moment.q.to_vec();
                q[k] += s;
                self.evaluate(plant, Moment { q: &q, ..moment });
                sides.push((self.residual.clone(), self.velocity.clone(), self.acceleration.clone()));
            }
            for i in 0..n {
                self.residual_q[i * n + k] = (sides[0].0[i] - sides[1].0[i]) / (2.0 * h);
            }
            for i in 0..rows {
                self.velocity_q[i * n + k] = (sides[0].1[i] - sides[1].1[i]) / (2.0 * h);
                self.acceleration_q[i * n + k] = (sides[0].2[i] - sides[1].2[i]) / (2.0 * h);
            }
            let mut sides = Vec::new();
            for s in [h, -h] {
                let mut qd = moment.qd.to_vec();
                qd[k] += s;
                self.evaluate(plant, Moment { qd: &qd, ..moment });
                sides.push((self.residual.clone(), self.acceleration.clone()));
            }
            for i in 0..n {
                self.residual_qd[i * n + k] = (sides[0].0[i] - sides[1].0[i]) / (2.0 * h);
            }
            for i in 0..rows {
                self.acceleration_qd[i * n + k] = (sides[0].1[i] - sides[1].1[i]) / (2.0 * h);
            }
        }
        self.evaluate(plant, moment);
    }
}
