//! Joint positions for given places of contact points and of the centre of mass.
//!
//! As many conditions as coordinates, solved by Newton's method.

use crate::error::{Error, PostureError};
use denavit_numerics::MinimumNorm;
use denavit_plants::Plant;

/// One condition on a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Condition {
    /// A coordinate has this value [rad, m].
    Coordinate(usize, f64),
    /// Two coordinates, weighted, have this value together: (1 - share) of the first and share of
    /// the second [rad, m].
    Blend {
        /// The two.
        coordinates: [usize; 2],
        /// 0 to 1.
        share: f64,
        /// [rad, m].
        value: f64,
    },
    /// A contact point has this place along a direction of the world \[m\].
    Point {
        /// Number of the contact point.
        contact: usize,
        /// A unit vector.
        along: [f64; 3],
        /// \[m\].
        value: f64,
    },
    /// The centre of mass has this world coordinate \[m\].
    CenterOfMass {
        /// 0 to 2.
        axis: usize,
        /// \[m\].
        value: f64,
    },
}

impl Condition {
    /// A contact point has this world coordinate (axis 0 to 2) \[m\].
    pub fn point(contact: usize, axis: usize, value: f64) -> Self {
        let along = [0, 1, 2].map(|of| f64::from(u8::from(of == axis)));
        Self::Point { contact, along, value }
    }
}

/// Errors below this are none [m, rad].
const EXACT: f64 = 1e-11;
const ITERATIONS: usize = 60;
/// The largest change of a coordinate in one iteration [rad, m].
const STRIDE: f64 = 0.2;

/// Moves `q` to the posture near it that meets all conditions.
///
/// # Errors
/// Conditions that cannot be met, or that are not as many as there are coordinates.
pub fn solve(plant: &mut dyn Plant, conditions: &[Condition], q: &mut [f64]) -> Result<(), Error> {
    Ok(place(plant, conditions, q)?)
}

/// The same, with what a plan of a gait says of it in its own words.
pub(crate) fn place(
    plant: &mut dyn Plant,
    conditions: &[Condition],
    q: &mut [f64],
) -> Result<(), PostureError> {
    let n = q.len();
    if conditions.len() != n {
        return Err(PostureError::Count { conditions: conditions.len(), coordinates: n });
    }
    let mut system = MinimumNorm::new();
    let mut best = f64::INFINITY;
    for _ in 0..ITERATIONS {
        let (matrix, errors) = linearise(plant, conditions, q);
        let residual = largest(&errors);
        best = best.min(residual);
        if residual <= EXACT {
            return Ok(());
        }
        system.factor(&matrix, n, 1e-12);
        let mut change = vec![0.0; n];
        system.solve(&errors, &mut change);
        let stride = largest(&change);
        if !stride.is_finite() {
            break;
        }
        let share = (STRIDE / stride).min(1.0);
        q.iter_mut().zip(&change).for_each(|(q, change)| *q += share * change);
    }
    Err(PostureError::OutOfReach { residual: best })
}

/// The largest error of conditions at a position, by forward kinematics [m, rad].
pub fn largest_error(plant: &mut dyn Plant, conditions: &[Condition], q: &[f64]) -> f64 {
    let (_, errors) = linearise(plant, conditions, q);
    largest(&errors)
}

fn largest(entries: &[f64]) -> f64 {
    entries.iter().fold(0.0, |sum: f64, entry| sum.max(entry.abs()))
}

/// Derivatives of the conditions, row-major, and what is missing.
fn linearise(plant: &mut dyn Plant, conditions: &[Condition], q: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let (n, points) = (q.len(), plant.model().contacts.len());
    let (mut positions, mut rows) = (vec![0.0; 3 * points], vec![0.0; 3 * points * n]);
    plant.contact_positions(q, &mut positions);
    plant.contact_jacobian(q, &mut rows);
    let center = plant.center_of_mass(q);
    let mut center_rows = vec![0.0; 3 * n];
    plant.center_of_mass_jacobian(q, &mut center_rows);
    let (mut matrix, mut errors) = (Vec::with_capacity(n * n), Vec::with_capacity(n));
    for condition in conditions {
        match *condition {
            Condition::Coordinate(index, value) => {
                matrix.extend((0..n).map(|column| f64::from(u8::from(column == index))));
                errors.push(value - q[index]);
            }
            Condition::Blend { coordinates: [a, b], share, value } => {
                let weight = |column: usize| {
                    let of = |own: usize, weight: f64| if column == own { weight } else { 0.0 };
                    of(a, 1.0 - share) + of(b, share)
                };
                matrix.extend((0..n).map(weight));
                errors.push(value - (1.0 - share) * q[a] - share * q[b]);
            }
            Condition::Point { contact, along, value } => {
                let part = |axis: usize, column: usize| {
                    along[axis] * rows[(3 * contact + axis) * n + column]
                };
                let entry = |column| (0..3).map(|axis| part(axis, column)).sum::<f64>();
                matrix.extend((0..n).map(entry));
                let place: f64 =
                    (0..3).map(|axis| along[axis] * positions[3 * contact + axis]).sum();
                errors.push(value - place);
            }
            Condition::CenterOfMass { axis, value } => {
                matrix.extend_from_slice(&center_rows[axis * n..(axis + 1) * n]);
                errors.push(value - center[axis]);
            }
        }
    }
    (matrix, errors)
}
