//! The return map of a walk from mid-swing to mid-swing, its fixed point and its multipliers.
//!
//! The section is an instant on the clock while the stance foot stands flat. States on it are told
//! by joint positions and velocities alone: the base follows kinematically from the foot that
//! stands, so that every perturbation stays inside the contact manifold.

use super::following::{Gains, control, simulation};
use super::planned::PlannedStep;
use super::stance_foot::StanceFoot;
use crate::error::{DesignError, Error};
use denavit_plants::Plant;
use denavit_simulate::{Control, State, Stop, simulate};
use nalgebra::{Complex, DMatrix, DVector};

/// The section of a walk, and the map from one step to the next.
pub(super) struct Section<'a> {
    pub(super) plant: &'a mut dyn Plant,
    pub(super) step: &'a PlannedStep,
    control: Control,
    /// Time since the beginning of the step \[s\].
    pub(super) t_s: f64,
    foot: StanceFoot,
}

/// A walk that repeats itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Cycle {
    /// State at mid-swing of the right leg's stance.
    pub start: State,
    /// By how much the state after a step differs from it at most [rad, rad/s].
    pub residual: f64,
    /// Floquet multipliers, real and imaginary part, the largest first.
    pub multipliers: Vec<[f64; 2]>,
}

impl Cycle {
    /// The largest modulus of a multiplier.
    pub fn largest_multiplier(&self) -> f64 {
        self.multipliers.first().map_or(0.0, |[re, im]| re.hypot(*im))
    }
}

/// A state that comes back as exactly as this is on the cycle [rad, rad/s].
const EXACT: f64 = 1e-7;
/// Perturbation of the central differences [rad, rad/s].
const PERTURBATION: f64 = 1e-5;

impl<'a> Section<'a> {
    pub(super) fn new(
        plant: &'a mut dyn Plant,
        step: &'a PlannedStep,
        gains: &Gains,
    ) -> Result<Self, Error> {
        let control = control(plant, step, gains).map_err(DesignError::Reference)?;
        let (foot, t_s) = (StanceFoot::at_mid_swing(step), step.mid_swing().1);
        Ok(Self { plant, step, control, t_s, foot })
    }

    /// Joint positions and velocities of the plan.
    pub(super) fn planned(&self) -> Result<Vec<f64>, Error> {
        let [q, qd, _] = self.step.motion(self.t_s).map_err(DesignError::Reference)?;
        let driven = &self.step.legs.driven;
        Ok(driven.iter().map(|j| q[*j]).chain(driven.iter().map(|j| qd[*j])).collect())
    }

    /// The state of these joint positions and velocities with the stance foot flat at x = 0.
    pub(super) fn state(&mut self, z: &[f64]) -> State {
        let legs = &self.step.legs;
        let (mut q, mut qd) = (vec![0.0; legs.coordinates], vec![0.0; legs.coordinates]);
        let half = legs.driven.len();
        for (index, joint) in legs.driven.iter().enumerate() {
            q[*joint] = z[index];
            qd[*joint] = z[half + index];
        }
        self.foot.hold_positions(self.plant, &mut q);
        self.foot.hold_velocities(self.plant, &q, &mut qd);
        State { t_s: self.t_s, q, qd, ..State::default() }
    }

    /// Joint positions and velocities one step later, with the legs swapped; none if the walk
    /// ended before, or stands on other contacts.
    pub(super) fn map(&mut self, z: &[f64]) -> Result<Option<Vec<f64>>, Error> {
        self.repeat(z, 1)
    }

    /// As `map`, so many steps later.
    pub(super) fn repeat(&mut self, z: &[f64], steps: usize) -> Result<Option<Vec<f64>>, Error> {
        let state = self.state(z);
        let end_s = self.t_s + steps as f64 * self.step.period_s;
        let run = simulate(self.plant, &self.control, &state, &simulation(end_s, end_s));
        // a perturbation that begins below the ground is no walk
        let Ok(run) = run else { return Ok(None) };
        let legs = &self.step.legs;
        let is_swapped = steps % 2 == 1;
        let closed = &self.step.phases[self.step.mid_swing().0].closed;
        let expected = closed.iter().map(|role| if is_swapped { role.swapped() } else { *role });
        let mut expected: Vec<usize> = expected.map(|role| legs.contact(role)).collect();
        expected.sort_unstable();
        if run.stop != Stop::End || run.closed != expected {
            return Ok(None);
        }
        let part = |values: &[f64]| if is_swapped { legs.swap(values) } else { values.to_vec() };
        let (q, qd) = (part(&run.end.q), part(&run.end.qd));
        let positions = legs.driven.iter().map(|joint| q[*joint]);
        Ok(Some(positions.chain(legs.driven.iter().map(|joint| qd[*joint])).collect()))
    }

    /// The derivative of the map, by central differences; none if a walk ended before.
    fn derivative(&mut self, z: &[f64]) -> Result<Option<DMatrix<f64>>, Error> {
        let mut matrix = DMatrix::zeros(z.len(), z.len());
        for column in 0..z.len() {
            let mut sides = Vec::new();
            for sign in [1.0, -1.0] {
                let mut moved = z.to_vec();
                moved[column] += sign * PERTURBATION;
                match self.map(&moved)? {
                    Some(after) => sides.push(after),
                    None => return Ok(None),
                }
            }
            for row in 0..z.len() {
                matrix[(row, column)] = (sides[0][row] - sides[1][row]) / (2.0 * PERTURBATION);
            }
        }
        Ok(Some(matrix))
    }

    /// The cycle near a state, by Newton's method with the derivative of the map there; none if
    /// there is none nearby.
    pub(super) fn cycle(
        &mut self,
        mut z: Vec<f64>,
        iterations: usize,
    ) -> Result<Option<Cycle>, Error> {
        let size = z.len();
        let Some(matrix) = self.derivative(&z)? else { return Ok(None) };
        let mut residual = f64::INFINITY;
        for _ in 0..=iterations {
            let Some(after) = self.map(&z)? else { return Ok(None) };
            let error = DVector::from_fn(size, |row, _| after[row] - z[row]);
            residual = error.amax();
            if residual < EXACT {
                break;
            }
            let system = DMatrix::identity(size, size) - &matrix;
            let Some(change) = system.lu().solve(&error) else { return Ok(None) };
            z.iter_mut().zip(change.iter()).for_each(|(z, change)| *z += change);
        }
        let start = self.state(&z);
        Ok(Some(Cycle { start, residual, multipliers: eigenvalues(&matrix) }))
    }
}

/// Eigenvalues, the largest first.
fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<[f64; 2]> {
    let found = matrix.complex_eigenvalues();
    let mut values: Vec<[f64; 2]> = found.iter().map(|v: &Complex<f64>| [v.re, v.im]).collect();
    values.sort_by(|a, b| {
        let (x, y) = (a[0].hypot(a[1]), b[0].hypot(b[1]));
        y.total_cmp(&x).then(b[1].total_cmp(&a[1]))
    });
    values
}
