//! Newton's cradle: equal balls in a row that collide with each other, not with a ground.

use super::{GroundModel, JointModel, Plant, PlantModel, PointModel};

/// Balls of 1 kg on a line, without gravity. Coordinate i is how far ball i has moved along x from
/// where all touch; "contact point" i is the distance between balls i and i + 1, as a height.
#[derive(Clone, Debug)]
pub struct Cradle {
    model: PlantModel,
}

impl Cradle {
    /// A cradle of so many balls.
    pub fn new(balls: usize) -> Self {
        let joint = |ball: usize| JointModel::ideal(&format!("ball{}", ball + 1), true);
        let point = |pair: usize| PointModel {
            name: format!("balls{}_{}", pair + 1, pair + 2),
            link: pair,
            position: [0.0; 3],
        };
        let model = PlantModel {
            name: "cradle".to_owned(),
            hash: 0,
            planar: true,
            mass_kg: balls as f64,
            gravity: [0.0; 3],
            joints: (0..balls).map(joint).collect(),
            links: (0..balls).map(|ball| format!("ball{}", ball + 1)).collect(),
            parents: vec![None; balls],
            contacts: (1..balls).map(|ball| point(ball - 1)).collect(),
            fall_points: Vec::new(),
            fall_radii_m: Vec::new(),
            ground: GroundModel::default(),
        };
        Self { model }
    }
}

impl Plant for Cradle {
    fn model(&self) -> &PlantModel {
        &self.model
    }

    fn mass_matrix(&mut self, q: &[f64], mass: &mut [f64]) {
        mass.fill(0.0);
        (0..q.len()).for_each(|ball| mass[ball * (q.len() + 1)] = 1.0);
    }

    fn bias(&mut self, _q: &[f64], _qd: &[f64], bias: &mut [f64]) {
        bias.fill(0.0);
    }

    fn contact_positions(&mut self, q: &[f64], positions: &mut [f64]) {
        positions.fill(0.0);
        for (pair, balls) in q.windows(2).enumerate() {
            positions[3 * pair + 2] = balls[1] - balls[0];
        }
    }

    fn contact_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
        jacobian.fill(0.0);
        let n = q.len();
        for pair in 1..n {
            let row = &mut jacobian[(3 * pair - 1) * n..3 * pair * n];
            row[pair - 1] = -1.0;
            row[pair] = 1.0;
        }
    }

    fn contact_bias(&mut self, _q: &[f64], _qd: &[f64], bias: &mut [f64]) {
        bias.fill(0.0);
    }

    fn kinetic_energy(&mut self, _q: &[f64], qd: &[f64]) -> f64 {
        0.5 * qd.iter().map(|rate| rate * rate).sum::<f64>()
    }

    fn potential_energy(&mut self, _q: &[f64]) -> f64 {
        0.0
    }

    fn center_of_mass(&mut self, q: &[f64]) -> [f64; 3] {
        [q.iter().sum::<f64>() / q.len() as f64, 0.0, 0.0]
    }

    fn momentum(&mut self, _q: &[f64], qd: &[f64]) -> [f64; 6] {
        [qd.iter().sum(), 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    fn link_transforms(&mut self, q: &[f64], transforms: &mut [f64]) {
        for (ball, rows) in transforms.chunks_exact_mut(12).enumerate() {
            let x = q[ball] + 0.1 * ball as f64;
            rows.copy_from_slice(&[1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        }
    }
}
