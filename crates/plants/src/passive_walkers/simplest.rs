//! The simplest walker.

use crate::{GroundModel, JointModel, Plant, PlantModel};

/// The walker of Garcia, Chatterjee, Ruina, Coleman 1998: a hip and two legs of length 1, with feet
/// without mass, so that D is the unit matrix of the scaled equations and the heel strike is a
/// guard. Scuffing is ignored by a declared rule: the guard looks only while the stance leg leans
/// forward.
#[derive(Clone, Debug)]
pub struct SimplestWalker {
    model: PlantModel,
    slope: f64,
}

impl SimplestWalker {
    /// On a slope of so many radians.
    pub fn new(slope: f64) -> Self {
        let joint = |name: &str| JointModel::ideal(name, false);
        let model = PlantModel {
            name: "simplest_walker".to_owned(),
            hash: 0,
            planar: true,
            mass_kg: 1.0,
            gravity: [0.0, 0.0, -1.0],
            joints: vec![joint("stance"), joint("hip")],
            links: Vec::new(),
            parents: Vec::new(),
            contacts: Vec::new(),
            fall_points: Vec::new(),
            fall_radii_m: Vec::new(),
            ground: GroundModel::default(),
        };
        Self { model, slope }
    }
}

impl Plant for SimplestWalker {
    fn model(&self) -> &PlantModel {
        &self.model
    }
    fn mass_matrix(&mut self, _q: &[f64], mass: &mut [f64]) {
        mass.copy_from_slice(&[1.0, 0.0, 0.0, 1.0]);
    }
    fn bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
        let fall = (q[0] - self.slope).sin();
        let swing = qd[0] * qd[0] * q[1].sin() - (q[0] - self.slope).cos() * q[1].sin();
        bias.copy_from_slice(&[-fall, -fall - swing]);
    }
    fn contact_positions(&mut self, _q: &[f64], _positions: &mut [f64]) {}
    fn contact_jacobian(&mut self, _q: &[f64], _jacobian: &mut [f64]) {}
    fn contact_bias(&mut self, _q: &[f64], _qd: &[f64], _bias: &mut [f64]) {}
    fn kinetic_energy(&mut self, _q: &[f64], _qd: &[f64]) -> f64 {
        0.0
    }
    fn potential_energy(&mut self, _q: &[f64]) -> f64 {
        0.0
    }
    fn center_of_mass(&mut self, _q: &[f64]) -> [f64; 3] {
        [0.0; 3]
    }
    fn momentum(&mut self, _q: &[f64], _qd: &[f64]) -> [f64; 6] {
        [0.0; 6]
    }
    fn link_transforms(&mut self, _q: &[f64], _transforms: &mut [f64]) {}
    fn guards(&self) -> usize {
        1
    }
    fn guard(&mut self, _guard: usize, q: &[f64], _qd: &[f64]) -> f64 {
        if q[0] < -0.1 { 2.0 * q[0] - q[1] } else { 1.0 }
    }
    fn jump(&mut self, _guard: usize, q: &mut [f64], qd: &mut [f64]) {
        let cosine = (2.0 * q[0]).cos();
        let rate = cosine * qd[0];
        (q[1], qd[1]) = (-2.0 * q[0], rate * (1.0 - cosine));
        (q[0], qd[0]) = (-q[0], rate);
    }
}
