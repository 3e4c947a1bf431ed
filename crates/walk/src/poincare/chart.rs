//! Coordinates of the states near one on a section, inside the manifold of its contacts.
//!
//! Deviations that move closed contacts are none that a walking robot can have: with them
//! multipliers would depend on the section. Positions keep closed contacts on the ground,
//! velocities keep them still, also where the positions deviate. Directions of symmetries are left
//! out.

use super::symmetry::Symmetry;
use denavit_plants::{GroundModel, Plant};
use denavit_simulate::State;
use nalgebra::{DMatrix, DVector};

/// Coordinates about a state.
#[derive(Clone, Debug)]
pub struct Chart {
    /// The state with all coordinates 0.
    pub base: State,
    touching: Vec<usize>,
    closed: Vec<usize>,
    /// Directions of positions, orthonormal, and the change of velocity that goes with each.
    positions: DMatrix<f64>,
    lifts: DMatrix<f64>,
    /// Directions of velocities, orthonormal.
    velocities: DMatrix<f64>,
    /// Whether the last coordinate is the time.
    has_time: bool,
}

/// Contacts this near to the ground touch it \[m\].
const TOUCHES_M: f64 = 1e-6;
/// Closed contacts that are faster slip [m/s].
const SLIPS_M_S: f64 = 1e-6;
/// A direction this short is none.
const NONE: f64 = 1e-9;
/// Half the distance of differences [rad].
const DIFFERENCE: f64 = 1e-5;

impl Chart {
    /// About a state in which these contacts are closed.
    pub fn new(
        plant: &mut dyn Plant,
        base: &State,
        closed: &[usize],
        symmetries: &[Symmetry],
        has_time: bool,
    ) -> Self {
        let n = base.q.len();
        let gaps = gaps(plant, &base.q);
        let near = |contact: &usize| closed.contains(contact) || gaps[*contact].abs() < TOUCHES_M;
        let touching: Vec<usize> = (0..gaps.len()).filter(near).collect();
        let heights = Rows::Heights.of(plant, &base.q, &touching);
        let held = Rows::All.of(plant, &base.q, closed);
        let speeds = &held * DVector::from_column_slice(&base.qd);
        let slips = speeds.iter().any(|speed| speed.abs() > SLIPS_M_S);
        let rows = if slips { Rows::Heights } else { Rows::All };
        let held = rows.of(plant, &base.q, closed);
        let along = |free_alone: bool| {
            let kept = symmetries.iter().filter(move |symmetry| symmetry.is_free || !free_alone);
            kept.map(|symmetry| DVector::from_column_slice(&symmetry.direction))
        };
        let positions = complement(n, rows_of(&heights).chain(along(false)));
        let velocities = complement(n, rows_of(&held).chain(along(true)));
        let lift = |direction: nalgebra::DVectorView<'_, f64>| {
            let at = |share: f64| {
                let moved: Vec<f64> =
                    base.q.iter().zip(direction.iter()).map(|(q, z)| q + share * z).collect();
                moved
            };
            let qd = DVector::from_column_slice(&base.qd);
            let ahead = rows.of(plant, &at(DIFFERENCE), closed) * &qd;
            let behind = rows.of(plant, &at(-DIFFERENCE), closed) * &qd;
            least(&held, &((behind - ahead) / (2.0 * DIFFERENCE)))
        };
        let columns: Vec<DVector<f64>> = positions.column_iter().map(lift).collect();
        let lifts = from_columns(n, &columns);
        let (base, closed) = (base.clone(), closed.to_vec());
        Self { base, touching, closed, positions, lifts, velocities, has_time }
    }

    /// Number of coordinates.
    pub fn len(&self) -> usize {
        let hidden = self.base.motor.len() + self.base.motor_rate.len() + self.base.laws.len();
        let own = self.positions.ncols() + self.velocities.ncols();
        own + hidden + usize::from(self.has_time)
    }

    /// Whether there is no coordinate.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The state of some coordinates, on the manifold of the contacts.
    pub fn state(&self, plant: &mut dyn Plant, coordinates: &[f64]) -> State {
        let (a, b) = (self.positions.ncols(), self.velocities.ncols());
        let of_positions = DVector::from_column_slice(&coordinates[..a]);
        let of_velocities = DVector::from_column_slice(&coordinates[a..a + b]);
        let mut q = DVector::from_column_slice(&self.base.q) + &self.positions * &of_positions;
        let gaps_before = gaps(plant, &self.base.q);
        for _ in 0..4 {
            let gaps = gaps(plant, q.as_slice());
            let missed = self.touching.iter().map(|c| gaps_before[*c] - gaps[*c]);
            let missed = DVector::from_iterator(self.touching.len(), missed);
            let rows = Rows::Heights.of(plant, q.as_slice(), &self.touching);
            q += least(&rows, &missed);
        }
        let mut qd = DVector::from_column_slice(&self.base.qd)
            + &self.lifts * &of_positions
            + &self.velocities * &of_velocities;
        let before = Rows::All.of(plant, &self.base.q, &self.closed)
            * DVector::from_column_slice(&self.base.qd);
        let held = Rows::All.of(plant, q.as_slice(), &self.closed);
        // what slips has its own velocity
        let slips = before.iter().any(|speed| speed.abs() > SLIPS_M_S);
        let held = if slips { Rows::Heights.of(plant, q.as_slice(), &self.closed) } else { held };
        qd -= least(&held, &(&held * &qd));
        let mut hidden = coordinates[a + b..].iter();
        let mut add = |values: &[f64]| -> Vec<f64> {
            values.iter().map(|value| value + hidden.next().unwrap_or(&0.0)).collect()
        };
        let [motor, motor_rate, laws] =
            [&self.base.motor, &self.base.motor_rate, &self.base.laws].map(|values| add(values));
        let later = if self.has_time { *hidden.next().unwrap_or(&0.0) } else { 0.0 };
        let (q, qd) = (q.as_slice().to_vec(), qd.as_slice().to_vec());
        State { t_s: self.base.t_s + later, q, qd, motor, motor_rate, laws }
    }

    /// By how much later on the clock a state of these coordinates is \[s\].
    pub(super) fn later_s(&self, coordinates: &[f64]) -> f64 {
        coordinates.last().copied().filter(|_| self.has_time).unwrap_or(0.0)
    }

    /// The coordinates of a state near by, to first order.
    pub fn coordinates(&self, state: &State) -> Vec<f64> {
        let mut coordinates = self.coordinates_of_change(&State {
            t_s: state.t_s - self.base.t_s,
            q: difference(&state.q, &self.base.q),
            qd: difference(&state.qd, &self.base.qd),
            motor: difference(&state.motor, &self.base.motor),
            motor_rate: difference(&state.motor_rate, &self.base.motor_rate),
            laws: difference(&state.laws, &self.base.laws),
        });
        if self.has_time {
            coordinates.push(state.t_s - self.base.t_s);
        }
        coordinates
    }

    /// The coordinates of a change of the state, but for the time.
    pub fn coordinates_of_change(&self, change: &State) -> Vec<f64> {
        let dq = DVector::from_column_slice(&change.q);
        let a = self.positions.tr_mul(&dq);
        let dqd = DVector::from_column_slice(&change.qd) - &self.lifts * &a;
        let b = self.velocities.tr_mul(&dqd);
        let parts = [a.as_slice(), b.as_slice(), &change.motor, &change.motor_rate, &change.laws];
        parts.concat()
    }

    /// The change of the state that goes with coordinates, to first order.
    pub fn change(&self, coordinates: &[f64]) -> State {
        let (a, b) = (self.positions.ncols(), self.velocities.ncols());
        let of_positions = DVector::from_column_slice(&coordinates[..a]);
        let of_velocities = DVector::from_column_slice(&coordinates[a..a + b]);
        let dq = &self.positions * &of_positions;
        let dqd = &self.lifts * &of_positions + &self.velocities * &of_velocities;
        let mut hidden = coordinates[a + b..].iter().copied();
        let mut take = |count: usize| hidden.by_ref().take(count).collect();
        State {
            t_s: 0.0,
            q: dq.as_slice().to_vec(),
            qd: dqd.as_slice().to_vec(),
            motor: take(self.base.motor.len()),
            motor_rate: take(self.base.motor_rate.len()),
            laws: take(self.base.laws.len()),
        }
    }
}

/// Which rows of the contact Jacobian.
#[derive(Clone, Copy)]
enum Rows {
    /// Along the normal of the ground.
    Heights,
    /// In all directions of the world that the plant moves in.
    All,
}

impl Rows {
    fn of(self, plant: &mut dyn Plant, q: &[f64], contacts: &[usize]) -> DMatrix<f64> {
        let (n, points) = (q.len(), plant.model().contacts.len());
        let (normal, is_planar) = (plant.model().ground.normal, plant.model().planar);
        let mut jacobian = vec![0.0; 3 * points * n];
        plant.contact_jacobian(q, &mut jacobian);
        let mut rows: Vec<f64> = Vec::new();
        for &contact in contacts {
            let point = &jacobian[3 * contact * n..3 * (contact + 1) * n];
            match self {
                Self::Heights => {
                    rows.extend((0..n).map(|j| {
                        (0..3).map(|axis| normal[axis] * point[axis * n + j]).sum::<f64>()
                    }))
                }
                Self::All => {
                    let axes: &[usize] = if is_planar { &[0, 2] } else { &[0, 1, 2] };
                    axes.iter().for_each(|axis| rows.extend(&point[axis * n..(axis + 1) * n]));
                }
            }
        }
        DMatrix::from_row_slice(rows.len() / n.max(1), n, &rows)
    }
}

/// Heights of all contact points \[m\].
fn gaps(plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
    let mut positions = vec![0.0; 3 * plant.model().contacts.len()];
    plant.contact_positions(q, &mut positions);
    let GroundModel { point, normal } = plant.model().ground;
    let height = |at: &[f64]| (0..3).map(|axis| normal[axis] * (at[axis] - point[axis])).sum();
    positions.chunks_exact(3).map(height).collect()
}

fn difference(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a - b).collect()
}

fn rows_of(matrix: &DMatrix<f64>) -> impl Iterator<Item = DVector<f64>> {
    matrix.row_iter().map(|row| row.transpose().into_owned())
}

fn from_columns(rows: usize, columns: &[DVector<f64>]) -> DMatrix<f64> {
    match columns {
        [] => DMatrix::zeros(rows, 0),
        columns => DMatrix::from_columns(columns),
    }
}

/// The shortest x with `rows` x = `right`, where that is possible.
fn least(rows: &DMatrix<f64>, right: &DVector<f64>) -> DVector<f64> {
    if rows.nrows() == 0 {
        return DVector::zeros(rows.ncols());
    }
    let svd = rows.clone().svd(true, true);
    svd.solve(right, NONE).unwrap_or_else(|_| DVector::zeros(rows.ncols()))
}

/// An orthonormal basis of what is orthogonal to some vectors, from the unit vectors in turn.
fn complement(n: usize, vectors: impl Iterator<Item = DVector<f64>>) -> DMatrix<f64> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let remainder = |mut vector: DVector<f64>, basis: &[DVector<f64>]| {
        // twice is enough
        for _ in 0..2 {
            for known in basis {
                vector -= known * known.dot(&vector);
            }
        }
        vector
    };
    for vector in vectors {
        let length = vector.norm();
        let left = remainder(vector, &basis);
        if left.norm() > NONE * length.max(1.0) {
            basis.push(left.normalize());
        }
    }
    let taken = basis.len();
    // from the last unit vector on: the coordinates of joints before those of the base
    let mut own = Vec::new();
    while own.len() + taken < n {
        let candidates = (0..n).rev().map(|index| {
            let mut unit = DVector::zeros(n);
            unit[index] = 1.0;
            remainder(unit, &basis)
        });
        let best = candidates.reduce(|a, b| if b.norm() > a.norm() + NONE { b } else { a });
        let Some(best) = best else { break };
        basis.push(best.normalize());
        own.push(basis[basis.len() - 1].clone());
    }
    from_columns(n, &own)
}
