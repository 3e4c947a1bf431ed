//! Bodies whose contact problems can be written down by hand.

use denavit_simulate::contact::delassus::Delassus;
use denavit_simulate::contact::{Contact, ContactProblem, Friction, Space, Tolerance};

pub(crate) const GRAVITY: f64 = 9.81;

/// A number in [-1, 1) that depends on the seed and the key only.
pub(crate) fn number(seed: u64, key: u64) -> f64 {
    let mut x = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ key.wrapping_mul(0xD1B5_4A32_D192_ED03);
    for _ in 0..3 {
        x ^= x >> 32;
        x = x.wrapping_mul(0xD6E8_FEB8_6659_FD93);
    }
    (x >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Mass matrix and contact rows of a system at one configuration.
pub(crate) struct System {
    pub(crate) space: Space,
    pub(crate) dof: usize,
    pub(crate) mass: Vec<f64>,
    pub(crate) jacobian: Vec<f64>,
    pub(crate) delassus: Delassus,
}

impl System {
    pub(crate) fn new(space: Space, mass: Vec<f64>, jacobian: Vec<f64>) -> Self {
        let dof = (mass.len() as f64).sqrt() as usize;
        let mut delassus = Delassus::new();
        delassus.factor(&mass, dof).expect("a positive definite mass matrix");
        delassus.project(&jacobian);
        Self { space, dof, mass, jacobian, delassus }
    }

    /// J v.
    pub(crate) fn contact_velocity(&self, v: &[f64]) -> Vec<f64> {
        self.jacobian
            .chunks(self.dof)
            .map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
            .collect()
    }

    /// v + M^-1 J^T P.
    pub(crate) fn after(&self, v: &[f64], impulse: &[f64]) -> Vec<f64> {
        let (mut after, mut scratch) = (v.to_vec(), vec![0.0; self.dof]);
        self.delassus.respond(impulse, &mut after, &mut scratch);
        after
    }

    pub(crate) fn kinetic_energy(&self, v: &[f64]) -> f64 {
        let n = self.dof;
        (0..n * n).map(|k| 0.5 * v[k / n] * self.mass[k] * v[k % n]).sum()
    }

    pub(crate) fn problem<'a>(
        &'a self,
        contacts: &'a [Contact],
        free: &'a [f64],
    ) -> ContactProblem<'a> {
        let (space, tolerance) = (self.space, Tolerance::default());
        ContactProblem { space, contacts, delassus: self.delassus.matrix(), free, tolerance }
    }
}

pub(crate) fn diagonal(entries: &[f64]) -> Vec<f64> {
    let n = entries.len();
    (0..n * n).map(|k| if k / n == k % n { entries[k / n] } else { 0.0 }).collect()
}

pub(crate) fn resting(count: usize, friction: Friction) -> Vec<Contact> {
    vec![Contact::resting(friction); count]
}

/// A plane body (x, z, angle counterclockwise) that touches at points (x, z) from its centre.
pub(crate) fn plane_body(mass: f64, inertia: f64, points: &[[f64; 2]]) -> System {
    let rows = points.iter().flat_map(|[x, z]| [1.0, 0.0, -z, 0.0, 1.0, *x]).collect();
    System::new(Space::Planar, diagonal(&[mass, mass, inertia]), rows)
}

/// A body in space (velocity, angular velocity) that touches at points from its centre.
pub(crate) fn body(mass: f64, inertia: [f64; 3], points: &[[f64; 3]]) -> System {
    let rows = points
        .iter()
        .flat_map(|[x, y, z]| {
            let turned = [[0.0, *z, -y], [-z, 0.0, *x], [*y, -x, 0.0]];
            (0..3).flat_map(move |axis| {
                let unit = std::array::from_fn::<f64, 3, _>(|k| f64::from(u8::from(k == axis)));
                unit.into_iter().chain(turned[axis])
            })
        })
        .collect();
    let [x, y, z] = inertia;
    System::new(Space::Spatial, diagonal(&[mass, mass, mass, x, y, z]), rows)
}

/// The corners of a flat foot, 2a long and 2b wide, h below the centre.
pub(crate) fn corners(a: f64, b: f64, h: f64) -> [[f64; 3]; 4] {
    [[a, b, -h], [a, -b, -h], [-a, b, -h], [-a, -b, -h]]
}

pub(crate) fn assert_close(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (index, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance, "entry {index}: {a} instead of {b}");
    }
}
