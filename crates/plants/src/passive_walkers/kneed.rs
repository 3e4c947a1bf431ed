//! A walker with knees.

use crate::{GroundModel, JointModel, Plant, PlantModel};

/// Hsu's walker: thighs and shanks of 0.5 m, a knee that locks when it is straight, until the leg
/// is the swing leg again. The parameters are those of Hsu 2007.
///
/// Coordinates: stance leg and swing thigh from the vertical, and by how much the swing shank is
/// bent behind its thigh. Point masses at A u(th), u = (-sin, cos), from the stance foot.
#[derive(Clone, Debug)]
pub struct KneedWalker {
    model: PlantModel,
    slope: f64,
    locked: bool,
}

/// Mass and row of A: stance shank, stance thigh, hip, swing thigh, swing shank.
const KNEED: [(f64, [f64; 3]); 5] = [
    (0.05, [0.35, 0.0, 0.0]),
    (0.5, [0.7, 0.0, 0.0]),
    (0.5, [1.0, 0.0, 0.0]),
    (0.5, [1.0, -0.3, 0.0]),
    (0.05, [1.0, -0.5, -0.15]),
];
const KNEED_GRAVITY: f64 = 9.8;

impl KneedWalker {
    /// The guard that fires when the knee is straight.
    pub const KNEE_STRIKE: usize = 0;
    /// The guard that fires when the swing foot strikes the ground; the legs are exchanged.
    pub const HEEL_STRIKE: usize = 1;

    /// On a slope of so many radians.
    pub fn new(slope: f64) -> Self {
        let joint = |name: &str| JointModel::ideal(name, false);
        let model = PlantModel {
            name: "kneed_walker".to_owned(),
            hash: 0,
            planar: true,
            mass_kg: 1.6,
            gravity: [0.0, 0.0, -KNEED_GRAVITY],
            joints: ["stance", "thigh", "knee"].map(joint).to_vec(),
            links: Vec::new(),
            parents: Vec::new(),
            contacts: Vec::new(),
            fall_points: Vec::new(),
            fall_radii_m: Vec::new(),
            ground: GroundModel::default(),
        };
        Self { model, slope, locked: false }
    }

    /// Mass matrix and bias in the absolute angles of stance leg, swing thigh and swing shank.
    fn absolute(angle: [f64; 3], rate: [f64; 3]) -> ([[f64; 3]; 3], [f64; 3]) {
        let (mut mass, mut bias) = ([[0.0; 3]; 3], [0.0; 3]);
        for (weight, a) in KNEED {
            for i in 0..3 {
                for j in 0..3 {
                    let (sine, cosine) = (angle[i] - angle[j]).sin_cos();
                    mass[i][j] += weight * a[i] * a[j] * cosine;
                    bias[i] += weight * a[i] * a[j] * sine * rate[j] * rate[j];
                }
                bias[i] -= weight * a[i] * KNEED_GRAVITY * angle[i].sin();
            }
        }
        (mass, bias)
    }

    /// (stance, thigh, knee) to absolute angles; rates alike.
    fn absolutes(q: &[f64]) -> [f64; 3] {
        [q[0], q[1], q[1] + q[2]]
    }

    /// Inelastic strike of a swing leg that is straight, in the plane with a base that is free
    /// before it: D (v+ - v-) = W P, W^T v+ = 0.
    fn strike(stance: f64, swing: f64, rates: [f64; 2]) -> [f64; 2] {
        let (m, _) = Self::absolute([stance, swing, swing], [0.0; 3]);
        // leg, leg, then the foot of the stance leg: x, y
        let mut d = nalgebra::Matrix4::zeros();
        d[(0, 0)] = m[0][0];
        d[(0, 1)] = m[0][1] + m[0][2];
        d[(1, 0)] = d[(0, 1)];
        d[(1, 1)] = m[1][1] + 2.0 * m[1][2] + m[2][2];
        for (weight, a) in KNEED {
            for (leg, (length, angle)) in
                [(a[0], stance), (a[1] + a[2], swing)].into_iter().enumerate()
            {
                for (axis, along) in [-angle.cos(), -angle.sin()].into_iter().enumerate() {
                    d[(leg, 2 + axis)] += weight * length * along;
                    d[(2 + axis, leg)] += weight * length * along;
                }
            }
            d[(2, 2)] += weight;
            d[(3, 3)] += weight;
        }
        let w = nalgebra::Matrix4x2::from_columns(&[
            nalgebra::Vector4::new(-stance.cos(), swing.cos(), 1.0, 0.0),
            nalgebra::Vector4::new(-stance.sin(), swing.sin(), 0.0, 1.0),
        ]);
        let before = nalgebra::Vector4::new(rates[0], rates[1], 0.0, 0.0);
        let response = d.try_inverse().expect("masses are positive") * w;
        let impulse = (w.transpose() * response).try_inverse().expect("masses are positive")
            * (w.transpose() * before);
        let after = before - response * impulse;
        [after[0], after[1]]
    }
}

impl Plant for KneedWalker {
    fn model(&self) -> &PlantModel {
        &self.model
    }
    fn mass_matrix(&mut self, q: &[f64], mass: &mut [f64]) {
        let (m, _) = Self::absolute(Self::absolutes(q), [0.0; 3]);
        let thigh = [m[0][1] + m[0][2], m[1][1] + 2.0 * m[1][2] + m[2][2]];
        // what is locked moves by itself, and does not move
        let knee = match self.locked {
            true => [0.0, 0.0, 1.0],
            false => [m[0][2], m[1][2] + m[2][2], m[2][2]],
        };
        mass.copy_from_slice(&[
            m[0][0], thigh[0], knee[0], thigh[0], thigh[1], knee[1], knee[0], knee[1], knee[2],
        ]);
    }
    fn bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
        let (_, b) = Self::absolute(Self::absolutes(q), Self::absolutes(qd));
        let knee = if self.locked { 0.0 } else { b[2] };
        bias.copy_from_slice(&[b[0], b[1] + b[2], knee]);
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
    fn begin(&mut self) {
        self.locked = false;
    }
    fn guards(&self) -> usize {
        2
    }
    fn guard(&mut self, guard: usize, q: &[f64], _qd: &[f64]) -> f64 {
        match (guard, self.locked) {
            (Self::KNEE_STRIKE, false) => -q[2],
            (Self::HEEL_STRIKE, true) => q[0] + q[1] + 2.0 * self.slope,
            _ => 1.0,
        }
    }
    fn jump(&mut self, guard: usize, q: &mut [f64], qd: &mut [f64]) {
        if guard == Self::KNEE_STRIKE {
            let (m, _) = Self::absolute(Self::absolutes(q), [0.0; 3]);
            let legs = nalgebra::Matrix2::new(
                m[0][0],
                m[0][1] + m[0][2],
                m[0][1] + m[0][2],
                m[1][1] + 2.0 * m[1][2] + m[2][2],
            );
            let knee = nalgebra::Vector2::new(m[0][2], m[1][2] + m[2][2]);
            // the impulse acts between thigh and shank alone
            let change = legs.try_inverse().expect("masses are positive") * knee * qd[2];
            (qd[0], qd[1], qd[2]) = (qd[0] + change[0], qd[1] + change[1], 0.0);
            (q[2], self.locked) = (0.0, true);
        } else {
            let [stance, swing] = Self::strike(q[0], q[1], [qd[0], qd[1]]);
            q.swap(0, 1);
            (qd[0], qd[1], qd[2]) = (swing, stance, 0.0);
            self.locked = false;
        }
    }
}
