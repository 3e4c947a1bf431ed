//! Onto the manifold of the contacts: what closed contacts forbid is taken out of positions and
//! rates.

use super::Motion;
use crate::breakdown::Breakdown;
use crate::contact::lemke::Lemke;
use crate::ground::TOUCH_M;
use denavit_numerics::MinimumNorm;

/// Setting contacts down moves no point farther than this times their height.
const LEVERAGE: f64 = 10.0;
/// Slower is still [m/s].
const STILL: f64 = 1e-14;

impl Motion<'_> {
    /// Adds the rates that impulses of the projected rows make: v+ = v- + D^-1 W P.
    pub(crate) fn apply_impulses(&mut self, impulse: &[f64], y: &mut [f64]) {
        let rates = self.layout.joint_rates();
        self.delassus.respond(impulse, &mut y[rates], &mut self.work.scratch);
    }

    /// Moves the positions in `y` until the listed contacts are on the ground, by as little as the
    /// masses allow; returns which are.
    ///
    /// From the lowest on, contacts are set down together as far as that moves no point by much
    /// more than their heights: those of an uneven foot, or beside an edge that a body stands on
    /// tilted, stay where they are.
    pub(crate) fn set_down(
        &mut self,
        contacts: &[usize],
        y: &mut [f64],
    ) -> Result<Vec<usize>, Breakdown> {
        self.place(y);
        let (before, start) = (self.work.positions.clone(), y.to_vec());
        let gaps: Vec<f64> = (0..self.friction.len()).map(|contact| self.gap(contact)).collect();
        let mut from_lowest = contacts.to_vec();
        from_lowest.sort_by(|a, b| gaps[*a].total_cmp(&gaps[*b]));
        let mut down: Vec<usize> = Vec::new();
        for contact in from_lowest {
            let mut trial = start.clone();
            let all = [&down[..], &[contact]].concat();
            self.lower(&all, &mut trial)?;
            self.place(&trial);
            let moved = |(new, old): (&f64, &f64)| (new - old).abs();
            let farthest = self.work.positions.iter().zip(&before).map(moved).fold(0.0, f64::max);
            let stand = all.iter().all(|contact| self.gap(*contact).abs() <= TOUCH_M);
            let sink = contacts.iter().any(|contact| self.gap(*contact) < -TOUCH_M);
            if stand && !sink && farthest <= LEVERAGE * gaps[contact].abs().max(TOUCH_M) {
                down = all;
                y.copy_from_slice(&trial);
            }
        }
        down.sort_unstable();
        Ok(down)
    }

    /// Moves the positions in `y` by what puts the listed contacts on the ground, as far as these
    /// do not contradict each other.
    fn lower(&mut self, contacts: &[usize], y: &mut [f64]) -> Result<(), Breakdown> {
        let (n, rows) = (self.layout.joints, self.ground.rows());
        let normals: Vec<usize> = (0..contacts.len()).map(|i| i * rows + rows - 1).collect();
        // the second pass takes out what the first bends
        for _ in 0..2 {
            self.factor_mass(y)?;
            self.project(y, contacts);
            for (&contact, &row) in contacts.iter().zip(&normals) {
                self.work.velocity[row] = self.gap(contact);
            }
            if let Some(moves) = self.cancel(&normals, &[]) {
                self.delassus.respond(&moves, &mut y[..n], &mut self.work.scratch);
            }
        }
        Ok(())
    }

    /// Takes the velocities of the rows `held` of the projected contacts out of `y`, what is left
    /// after the last of infinitely many bounces and of rounding, so that none of the rows `open`
    /// is negative after it. Returns the impulses of all rows that this takes, none if there is
    /// nothing to take out.
    pub(crate) fn still(
        &mut self,
        held: &[usize],
        open: &[usize],
        y: &mut [f64],
    ) -> Option<Vec<f64>> {
        let impulses = self.cancel(held, open)?;
        self.apply_impulses(&impulses, y);
        Some(impulses)
    }

    /// Impulses P of all rows that take out `work.velocity` v of those that are held, and in those
    /// that are open push as little as they must: with
    ///
    /// > v_h + G_hh P_h + G_ho P_o = 0,  0 <= P_o _|_ v_o + G_oh P_h + G_oo P_o >= 0.
    ///
    /// None if there is nothing to take out.
    fn cancel(&self, held: &[usize], open: &[usize]) -> Option<Vec<f64>> {
        let velocity = &self.work.velocity;
        let largest = held.iter().fold(0.0_f64, |sum, row| sum.max(velocity[*row].abs()));
        if largest <= STILL {
            return None;
        }
        let (total, matrix) = (self.delassus.rows(), self.delassus.matrix());
        let entry = |row: usize, column: usize| matrix[row * total + column];
        let mut system = MinimumNorm::default();
        let block: Vec<f64> = held
            .iter()
            .flat_map(|row| held.iter().map(move |column| entry(*row, *column)))
            .collect();
        system.factor(&block, held.len(), 1e-10);
        // what the held rows do against a velocity of theirs
        let mut against = |rates: &dyn Fn(usize) -> f64| {
            let right: Vec<f64> = held.iter().map(|row| -rates(*row)).collect();
            let mut impulse = vec![0.0; held.len()];
            system.solve(&right, &mut impulse);
            impulse
        };
        let of_velocity = against(&|row| velocity[row]);
        let of_open: Vec<_> =
            open.iter().map(|column| against(&|row| entry(row, *column))).collect();
        let along = |row: usize, impulse: &[f64]| -> f64 {
            held.iter().zip(impulse).map(|(column, p)| entry(row, *column) * p).sum()
        };
        let left = open.iter().map(|row| velocity[*row] + along(*row, &of_velocity));
        let left: Vec<f64> =
            left.map(|v| if v > -1e-9 * largest { v.max(0.0) } else { v }).collect();
        let mut pushes = Lemke::new();
        let mut responses = Vec::with_capacity(open.len() * open.len());
        for row in open {
            let response =
                |(column, held): (&usize, &Vec<f64>)| entry(*row, *column) + along(*row, held);
            responses.extend(open.iter().zip(&of_open).map(response));
        }
        pushes.solve(&responses, &left, 50 * (open.len() + 1));
        let mut all = vec![0.0; total];
        held.iter().zip(of_velocity).for_each(|(row, p)| all[*row] = p);
        for ((row, by_held), push) in open.iter().zip(&of_open).zip(pushes.solution()) {
            all[*row] = *push;
            held.iter().zip(by_held).for_each(|(row, p)| all[*row] += p * push);
        }
        Some(all)
    }
}
