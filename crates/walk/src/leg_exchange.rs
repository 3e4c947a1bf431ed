//! The exchange of the legs: after a step the left leg does what the right one did.
//!
//! A wheel of spokes turns by the angle between two of them instead: each coordinate may have an
//! offset, too.

use denavit_numerics::Random;
use denavit_plants::Plant;

/// A mirror image of a robot in its own coordinates: coordinate `i` becomes
/// `signs[i] * q[coordinates[i]] + offsets[i]`.
#[derive(Clone, Debug, PartialEq)]
pub struct LegExchange {
    /// Which coordinate takes the place of each.
    pub coordinates: Vec<usize>,
    /// Its sign there.
    pub signs: Vec<f64>,
    /// What is added to each position [rad, m].
    pub offsets: Vec<f64>,
    /// The contact point whose place each takes.
    pub contacts: Vec<usize>,
}

/// Names of the two sides.
const SIDES: [[&str; 2]; 2] = [["right", "left"], ["first", "second"]];
/// Positions of mirrored postures, and entries of their mass matrices, are alike to this [m, kg].
const ALIKE: f64 = 1e-9;

impl LegExchange {
    /// The exchange of a robot whose joints and contact points are named by their side, if it is
    /// its own mirror image: contact points and mass matrix of mirrored postures are compared.
    pub fn find(plant: &mut dyn Plant) -> Option<Self> {
        let model = plant.model();
        let joints: Vec<&str> = model.joints.iter().map(|joint| joint.name.as_str()).collect();
        let points: Vec<&str> = model.contacts.iter().map(|point| point.name.as_str()).collect();
        let (coordinates, contacts) = (permutation(&joints)?, permutation(&points)?);
        let is_exchange = coordinates.iter().enumerate().any(|(index, other)| index != *other);
        let (signs, offsets) = (vec![1.0; joints.len()], vec![0.0; joints.len()]);
        let mut exchange = Self { coordinates, signs, offsets, contacts };
        if !is_exchange || exchange.contacts.is_empty() {
            return None;
        }
        if !plant.model().planar {
            exchange.find_signs(plant)?;
        }
        exchange.is_mirror(plant).then_some(exchange)
    }

    /// The mirror image of positions.
    pub fn positions(&self, q: &[f64]) -> Vec<f64> {
        let mirrored = self.velocities(q);
        mirrored.into_iter().zip(&self.offsets).map(|(entry, offset)| entry + offset).collect()
    }

    /// The mirror image of velocities, or of changes of positions.
    pub fn velocities(&self, values: &[f64]) -> Vec<f64> {
        self.coordinates.iter().zip(&self.signs).map(|(&of, sign)| sign * values[of]).collect()
    }

    /// In space the plane y = 0 is the mirror: each joint keeps its sign or changes it.
    fn find_signs(&mut self, plant: &mut dyn Plant) -> Option<()> {
        for joint in 0..self.coordinates.len() {
            let mut moved = vec![0.0; self.coordinates.len()];
            moved[self.coordinates[joint]] = 0.3;
            let expected = mirrored(&positions(plant, &moved), &self.contacts);
            let sign = [1.0, -1.0].into_iter().find(|sign| {
                let mut image = vec![0.0; moved.len()];
                image[joint] = 0.3 * sign;
                are_alike(&positions(plant, &image), &expected)
            });
            self.signs[joint] = sign?;
        }
        Some(())
    }

    fn is_mirror(&self, plant: &mut dyn Plant) -> bool {
        let n = self.coordinates.len();
        let mut random = Random::new(1);
        let q: Vec<f64> = (0..n).map(|_| random.uniform() - 0.5).collect();
        let image = self.positions(&q);
        let is_planar = plant.model().planar;
        let (here, there) = (positions(plant, &q), positions(plant, &image));
        let expected = if is_planar {
            self.contacts.iter().flat_map(|&of| here[3 * of..3 * of + 3].to_vec()).collect()
        } else {
            mirrored(&here, &self.contacts)
        };
        let [mut mass, mut other] = [vec![0.0; n * n], vec![0.0; n * n]];
        plant.mass_matrix(&q, &mut mass);
        plant.mass_matrix(&image, &mut other);
        let exchanged = (0..n * n).map(|entry| {
            let (row, column) = (entry / n, entry % n);
            let from = self.coordinates[row] * n + self.coordinates[column];
            self.signs[row] * self.signs[column] * mass[from]
        });
        are_alike(&there, &expected) && are_alike(&other, &exchanged.collect::<Vec<_>>())
    }
}

/// For each name the place of that with the other side's name; of those without a side, their own.
fn permutation(names: &[&str]) -> Option<Vec<usize>> {
    let other = |name: &str| {
        for [a, b] in SIDES {
            for (from, to) in [(a, b), (b, a)] {
                if let Some(rest) = name.strip_prefix(from) {
                    return format!("{to}{rest}");
                }
            }
        }
        name.to_owned()
    };
    names.iter().map(|name| names.iter().position(|known| *known == other(name))).collect()
}

fn positions(plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
    let mut positions = vec![0.0; 3 * plant.model().contacts.len()];
    plant.contact_positions(q, &mut positions);
    positions
}

fn mirrored(positions: &[f64], contacts: &[usize]) -> Vec<f64> {
    let mirror = |&of: &usize| [positions[3 * of], -positions[3 * of + 1], positions[3 * of + 2]];
    contacts.iter().flat_map(mirror).collect()
}

fn are_alike(a: &[f64], b: &[f64]) -> bool {
    a.iter().zip(b).all(|(a, b)| (a - b).abs() <= ALIKE)
}
