//! What small changes of the state become along a run: the variational equation of the smooth
//! motion between events, and a saltation matrix at each event (Aizerman, Gantmakher 1958).
//!
//! The derivatives of the equations of motion are central differences of the very right-hand side
//! that is integrated, so that every control, drive and law is followed. The variational equation
//! is linear; it is solved on the steps of the run by Radau's method of order 5.

use super::breakdown::{Breakdown, Stop};
use super::event::{Fired, Watch};
use super::integrate::{Rates, Stepper};
use super::motion::{Closed, Motion};
use super::settle::{Onset, Settler, Touching};
use super::state::{INTEGRALS, Layout, State};
use nalgebra::DMatrix;
use std::fmt;

/// Why changes cannot be followed along a run.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum VariationError {
    /// The run stops before its end.
    Stopped(Stop, f64),
    /// A sampled controller holds torques between samples, or plans references at them.
    Sampled,
    /// The plant has jumps of its own, which may change it.
    Jumps,
    /// An impulse from outside.
    Pushed,
    /// The crossing at this time is not transversal: a change of the state has no first-order
    /// effect on its time \[s\].
    Grazing(f64),
    /// A small change of the state makes other contacts close at this time \[s\].
    Decision(f64),
}

impl fmt::Display for VariationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Stopped(stop, t_s) => write!(f, "at {t_s} s the run {stop}"),
            Self::Sampled => write!(f, "a sampled controller has no variational equation here"),
            Self::Jumps => write!(f, "the plant jumps by a rule of its own"),
            Self::Pushed => write!(f, "an impulse pushes the robot"),
            Self::Grazing(t_s) => write!(f, "the event at {t_s} s is only grazed"),
            Self::Decision(t_s) => {
                write!(f, "at {t_s} s other contacts close after the smallest change")
            }
        }
    }
}

/// Changes of positions and velocities, relative to entries of size 1, that differences are taken
/// with: the error of order 2 and rounding are both about 1e-10 then.
const CHANGE: f64 = 1e-5;
/// A watched value that changes more slowly than by this share of what its parts do is grazed.
const GRAZING: f64 = 1e-9;

/// Radau IIA of order 5.
struct Radau {
    nodes: [f64; 3],
    weights: [[f64; 3]; 3],
}

impl Radau {
    fn new() -> Self {
        let r = 6.0_f64.sqrt();
        Self {
            nodes: [(4.0 - r) / 10.0, (4.0 + r) / 10.0, 1.0],
            weights: [
                [(88.0 - 7.0 * r) / 360.0, (296.0 - 169.0 * r) / 1800.0, (3.0 * r - 2.0) / 225.0],
                [(296.0 + 169.0 * r) / 1800.0, (88.0 + 7.0 * r) / 360.0, (-2.0 - 3.0 * r) / 225.0],
                [(16.0 - r) / 36.0, (16.0 + r) / 36.0, 1.0 / 9.0],
            ],
        }
    }
}

/// Changes of the state along a run.
pub(super) struct Variation {
    /// A change in each column, without the integrals.
    columns: DMatrix<f64>,
    pub(super) failure: Option<VariationError>,
}

/// What is known of an event before it is dealt with.
pub(super) struct Crossing {
    t_s: f64,
    /// The state just before the event, with the contacts that were closed.
    y: Vec<f64>,
    closed: Vec<Closed>,
    /// dy/dt just before it.
    rates: Vec<f64>,
    /// For each column by how much later the event happens per unit of change \[s\].
    delays_s: Vec<f64>,
}

impl Variation {
    pub(super) fn new(layout: Layout, changes: &[State]) -> Self {
        let size = layout.len() - INTEGRALS;
        let mut columns = DMatrix::zeros(size, changes.len());
        for (mut column, change) in columns.column_iter_mut().zip(changes) {
            column.copy_from_slice(&layout.pack(change)[..size]);
        }
        Self { columns, failure: None }
    }

    /// The changes at the end of the run; their time is 0.
    pub(super) fn finish(self, layout: Layout) -> Result<Vec<State>, VariationError> {
        let whole = |column: nalgebra::DVectorView<'_, f64>| {
            let mut y = column.as_slice().to_vec();
            y.resize(layout.len(), 0.0);
            layout.unpack(0.0, &y)
        };
        match self.failure {
            Some(failure) => Err(failure),
            None => Ok(self.columns.column_iter().map(whole).collect()),
        }
    }

    /// Along the last step of the stepper, up to `end_s` inside it.
    pub(super) fn follow(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        end_s: f64,
    ) -> Result<(), Breakdown> {
        if motion.held.is_some() || motion.control.planning.is_some() {
            self.failure.get_or_insert(VariationError::Sampled);
        }
        let (start_s, size) = (stepper.start_time(), self.columns.nrows());
        let length = end_s - start_s;
        if self.failure.is_some() || length <= 0.0 {
            return Ok(());
        }
        let Radau { nodes, weights } = Radau::new();
        let mut y = vec![0.0; size + INTEGRALS];
        let mut system = DMatrix::identity(3 * size, 3 * size);
        for (stage, node) in nodes.into_iter().enumerate() {
            let t_s = if stage == 2 { end_s } else { start_s + node * length };
            stepper.restep(motion, t_s, &mut y)?;
            motion.holds_places = false;
            let jacobian = jacobian(motion, t_s, &y);
            motion.holds_places = true;
            let jacobian = jacobian?;
            for (row, weights) in weights.iter().enumerate() {
                let mut block = system.view_mut((row * size, stage * size), (size, size));
                block -= length * weights[stage] * &jacobian;
            }
        }
        let mut stages = DMatrix::zeros(3 * size, self.columns.ncols());
        for stage in 0..3 {
            stages.view_mut((stage * size, 0), self.columns.shape()).copy_from(&self.columns);
        }
        if !system.lu().solve_mut(&mut stages) {
            return Err(Breakdown::NotFinite);
        }
        self.columns.copy_from(&stages.rows(2 * size, size));
        Ok(())
    }

    /// When each change makes the event happen that has fired at the state `y`.
    pub(super) fn cross(
        &mut self,
        motion: &mut Motion<'_>,
        watch: &mut Watch,
        fired: Fired,
        y: &[f64],
    ) -> Result<Crossing, Breakdown> {
        let t_s = fired.t_s;
        let mut rates = vec![0.0; y.len()];
        motion.rates(t_s, y, &mut rates)?;
        motion.holds_places = false;
        let found = self.delays(motion, watch, fired, y, &rates);
        motion.holds_places = true;
        let delays_s = found?;
        Ok(Crossing { t_s, y: y.to_vec(), closed: motion.closed.clone(), rates, delays_s })
    }

    /// By how much later an event happens per unit of each change \[s\].
    fn delays(
        &mut self,
        motion: &mut Motion<'_>,
        watch: &mut Watch,
        fired: Fired,
        y: &[f64],
        rates: &[f64],
    ) -> Result<Vec<f64>, Breakdown> {
        let (t_s, size) = (fired.t_s, self.columns.nrows());
        let mut along = |direction: &[f64], time: f64| -> Result<(f64, f64), Breakdown> {
            let largest = direction.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
            let share = CHANGE / largest.max(1e-3);
            let mut at = |share: f64| {
                let moved = moved(y, direction, share);
                watch.measure(motion, fired.watched, t_s + share * time, &moved)
            };
            Ok(((at(share)? - at(-share)?) / (2.0 * share), largest))
        };
        let (fall, speed) = along(&rates[..size], 1.0)?;
        if fall.abs() <= GRAZING * speed {
            self.failure.get_or_insert(VariationError::Grazing(t_s));
        }
        let mut delays_s = Vec::new();
        for column in self.columns.column_iter() {
            delays_s.push(-along(column.as_slice(), 0.0)?.0 / fall);
        }
        Ok(delays_s)
    }

    /// Past an event after which the state is `after`. `hit` are the contacts that collided in it.
    pub(super) fn jump(
        &mut self,
        motion: &mut Motion<'_>,
        crossing: &Crossing,
        law: &Touching,
        hit: Option<&[usize]>,
        after: &[f64],
    ) -> Result<(), Breakdown> {
        let size = self.columns.nrows();
        let mut rates = vec![0.0; after.len()];
        motion.rates(crossing.t_s, after, &mut rates)?;
        for index in 0..self.columns.ncols() {
            let delay_s = crossing.delays_s[index];
            let mut change: Vec<f64> = self.columns.column(index).as_slice().to_vec();
            change.iter_mut().zip(&crossing.rates).for_each(|(x, f)| *x += delay_s * f);
            if let Some(hit) = hit {
                change = self.collided(motion, crossing, law, hit, &change)?;
            }
            change.iter_mut().zip(&rates).for_each(|(x, f)| *x -= delay_s * f);
            self.columns.column_mut(index).copy_from_slice(&change[..size]);
        }
        Ok(())
    }

    /// The derivative of the impact along a change that keeps what collides on the ground.
    fn collided(
        &mut self,
        motion: &mut Motion<'_>,
        crossing: &Crossing,
        law: &Touching,
        hit: &[usize],
        change: &[f64],
    ) -> Result<Vec<f64>, Breakdown> {
        let nominal = motion.closed.clone();
        let largest = change.iter().fold(0.0_f64, |most, entry| most.max(entry.abs()));
        let share = CHANGE / largest.max(1e-3);
        let mut ends = [Vec::new(), Vec::new()];
        for (end, share) in ends.iter_mut().zip([share, -share]) {
            *end = moved(&crossing.y, change, share);
            motion.closed.clone_from(&crossing.closed);
            let settled =
                Settler::default().settle(motion, law, Onset::Touch(hit), crossing.t_s, end);
            let same = motion.closed.len() == nominal.len()
                && motion.closed.iter().zip(&nominal).all(|(a, b)| a.does_as(b));
            if settled.is_err() || !same {
                self.failure.get_or_insert(VariationError::Decision(crossing.t_s));
                end.copy_from_slice(&crossing.y);
            }
        }
        motion.closed = nominal;
        let [ahead, behind] = &ends;
        let difference = |(a, b): (&f64, &f64)| (a - b) / (2.0 * share);
        Ok(ahead.iter().zip(behind).take(change.len()).map(difference).collect())
    }
}

fn moved(y: &[f64], direction: &[f64], share: f64) -> Vec<f64> {
    let mut moved = y.to_vec();
    moved.iter_mut().zip(direction).for_each(|(entry, change)| *entry += share * change);
    moved
}

/// d(dy/dt)/dy without the integrals, by central differences.
fn jacobian(motion: &mut Motion<'_>, t_s: f64, y: &[f64]) -> Result<DMatrix<f64>, Breakdown> {
    let size = y.len() - INTEGRALS;
    let mut matrix = DMatrix::zeros(size, size);
    let mut ends = [vec![0.0; y.len()], vec![0.0; y.len()]];
    let mut moved = y.to_vec();
    for column in 0..size {
        let change = CHANGE * y[column].abs().max(0.1);
        for (end, change) in ends.iter_mut().zip([change, -change]) {
            moved[column] = y[column] + change;
            motion.rates(t_s, &moved, end)?;
        }
        moved[column] = y[column];
        let [ahead, behind] = &ends;
        for row in 0..size {
            matrix[(row, column)] = (ahead[row] - behind[row]) / (2.0 * change);
        }
    }
    Ok(matrix)
}
