//! Onto the manifold of the contacts: what closed contacts forbid is taken out of positions and
//! rates.

use super::Motion;
use crate::simulate::breakdown::Breakdown;
use crate::simulate::contact::minimum_norm::MinimumNorm;

impl Motion<'_> {
    /// Adds the rates that impulses of the projected rows make: v+ = v- + D^-1 W P.
    pub(in crate::simulate) fn apply_impulses(&mut self, impulse: &[f64], y: &mut [f64]) {
        let rates = self.layout.joint_rates();
        self.delassus.respond(impulse, &mut y[rates], &mut self.work.scratch);
    }

    /// Moves the positions in `y` until the listed contacts are on the ground, by as little as the
    /// masses allow.
    pub(in crate::simulate) fn set_down(
        &mut self,
        contacts: &[usize],
        y: &mut [f64],
    ) -> Result<(), Breakdown> {
        let (n, rows) = (self.layout.joints, self.ground.rows());
        let normals: Vec<usize> = (0..contacts.len()).map(|i| i * rows + rows - 1).collect();
        // the second pass takes out what the first bends
        self.factored_for.clear();
        for _ in 0..2 {
            self.plant.mass_matrix(&y[..n], &mut self.work.mass);
            self.delassus
                .factor(&self.work.mass, n)
                .map_err(|error| Breakdown::Singular { coordinate: error.coordinate })?;
            self.project(y, contacts);
            for (&contact, &row) in contacts.iter().zip(&normals) {
                self.work.velocity[row] = self.gap(contact);
            }
            if let Some(moves) = self.cancel(&normals) {
                self.delassus.respond(&moves, &mut y[..n], &mut self.work.scratch);
            }
        }
        Ok(())
    }

    /// Takes the velocities of the listed rows of the projected contacts out of `y`: what is left
    /// after the last of infinitely many bounces, and of rounding. Returns the impulses of all rows
    /// that this takes, none if there is nothing to take out.
    pub(in crate::simulate) fn still(&mut self, held: &[usize], y: &mut [f64]) -> Option<Vec<f64>> {
        let impulses = self.cancel(held)?;
        self.apply_impulses(&impulses, y);
        Some(impulses)
    }

    /// Impulses of all rows that take out `work.velocity` of those that are held; none if there is
    /// nothing to take out.
    fn cancel(&self, held: &[usize]) -> Option<Vec<f64>> {
        let largest = held.iter().fold(0.0_f64, |sum, row| sum.max(self.work.velocity[*row].abs()));
        if largest <= 1e-14 {
            return None;
        }
        let (total, size) = (self.delassus.rows(), held.len());
        let matrix = self.delassus.matrix();
        let mut system = MinimumNorm::default();
        let block: Vec<f64> = held
            .iter()
            .flat_map(|row| held.iter().map(move |column| matrix[row * total + column]))
            .collect();
        system.factor(&block, size, 1e-10);
        let right: Vec<f64> = held.iter().map(|row| -self.work.velocity[*row]).collect();
        let mut impulse = vec![0.0; size];
        system.solve(&right, &mut impulse);
        let mut all = vec![0.0; total];
        held.iter().zip(impulse).for_each(|(row, p)| all[*row] = p);
        Some(all)
    }
}
