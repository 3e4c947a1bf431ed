//! What is read of a log: its columns by what they are, and what its cells must not be.

use denavit_plants::{PlantModel, PointModel};
use denavit_simulate::{LinkWrench, Log, LogFault, LogFaults, LogFile};

/// Columns of a log by what they are.
pub(super) struct Columns {
    pub(super) time: usize,
    pub(super) positions: Vec<usize>,
    pub(super) velocities: Vec<usize>,
    pub(super) accelerations: Option<Vec<usize>>,
    pub(super) torques: Vec<Option<usize>>,
    pub(super) forces: Vec<[usize; 3]>,
    /// Digits of the contacts, where a number holds as many.
    modes: Option<usize>,
    /// The links that are pushed, with their forces and moments.
    wrenches: Vec<(usize, [usize; 6])>,
}

/// A number holds the digits of so many contacts.
const DIGITS: usize = 15;

impl Columns {
    /// Finds them.
    ///
    /// # Errors
    /// The names of all that are missing.
    pub(super) fn of(model: &PlantModel, log: &Log) -> Result<Self, Vec<String>> {
        let mut missing = Vec::new();
        let find = |name: &str| log.columns.iter().position(|column| column == name);
        let mut need = |name: String| {
            find(&name).unwrap_or_else(|| {
                missing.push(name);
                0
            })
        };
        let names = |prefix: &str| -> Vec<String> {
            model.joints.iter().map(|joint| format!("{prefix}_{}", joint.name)).collect()
        };
        let time = need("t".to_owned());
        let positions = names("q").into_iter().map(&mut need).collect();
        let velocities = names("qd").into_iter().map(&mut need).collect();
        let force = |contact: &PointModel| {
            ["x", "y", "z"].map(|axis| need(format!("f_{}_{axis}", contact.name)))
        };
        let forces = model.contacts.iter().map(force).collect();
        let mut wrenches = Vec::new();
        for (link, name) in model.links.iter().enumerate() {
            let parts = ["fx", "fy", "fz", "mx", "my", "mz"].map(|part| format!("w_{name}_{part}"));
            if parts.iter().any(|part| find(part).is_some()) {
                wrenches.push((link, parts.map(&mut need)));
            }
        }
        if !missing.is_empty() {
            return Err(missing);
        }
        let modes = find("contact_modes").filter(|_| model.contacts.len() <= DIGITS);
        Ok(Self {
            time,
            positions,
            velocities,
            accelerations: names("qdd").iter().map(|name| find(name)).collect(),
            torques: names("tau").iter().map(|name| find(name)).collect(),
            forces,
            modes,
            wrenches,
        })
    }

    /// The columns of a file, whose cells are sound.
    ///
    /// # Errors
    /// All columns that are missing, or all cells that are wrong.
    pub(super) fn of_file(model: &PlantModel, file: &LogFile) -> Result<Self, LogFaults> {
        let columns = Self::of(model, &file.log).map_err(|missing| {
            let mut faults = LogFaults::default();
            for name in missing {
                faults.push(file.fault_of_columns(LogFault::NoColumn(name)));
            }
            faults
        })?;
        let mut faults = LogFaults::default();
        for (row, values) in file.log.rows().enumerate() {
            columns.check_row(file, row, values, &mut faults);
        }
        faults.or(columns)
    }

    fn check_row(&self, file: &LogFile, row: usize, values: &[f64], faults: &mut LogFaults) {
        let contacts = self.forces.len();
        let name = |column: usize| file.log.columns[column].clone();
        let mut found = Vec::new();
        let mut empty = |column: usize| {
            if values[column].is_nan() {
                found.push((column, LogFault::Empty(name(column))));
            }
        };
        self.positions.iter().chain(&self.velocities).for_each(|column| empty(*column));
        if self.has_forces(values) {
            match &self.accelerations {
                Some(columns) => columns.iter().for_each(|column| empty(*column)),
                None => self.torques.iter().flatten().for_each(|column| empty(*column)),
            }
            let pushes = self.wrenches.iter().flat_map(|(_, parts)| parts);
            pushes.for_each(|column| empty(*column));
            let forces = self.forces.as_flattened().iter();
            for column in forces.filter(|column| values[**column].is_nan()) {
                found.push((*column, LogFault::EmptyForce(name(*column))));
            }
        }
        let cell = self.modes.filter(|column| {
            let modes = values[*column];
            modes.is_finite() && digits(modes, contacts).is_none()
        });
        found.extend(
            cell.map(|column| (column, LogFault::Modes(values[column].to_string(), contacts))),
        );
        for (column, cause) in found {
            faults.push(file.fault_of_cell(row, column, cause));
        }
    }

    /// Whether a row has a force.
    pub(super) fn has_forces(&self, row: &[f64]) -> bool {
        self.forces.as_flattened().iter().any(|column| row[*column].is_finite())
    }

    /// Which contacts are closed by their digits in a row, if it has them.
    pub(super) fn closed(&self, row: &[f64]) -> Option<Vec<bool>> {
        let modes = self.modes.map(|column| row[column]).filter(|modes| modes.is_finite())?;
        digits(modes, self.forces.len())
    }

    /// What pushes in a row.
    pub(super) fn wrenches(&self, row: &[f64]) -> Vec<LinkWrench> {
        let wrench = |(link, columns): &(usize, [usize; 6])| {
            let [fx, fy, fz, mx, my, mz] = columns.map(|column| row[column]);
            LinkWrench { link: *link, force: [fx, fy, fz], moment: [mx, my, mz] }
        };
        self.wrenches.iter().map(wrench).filter(|wrench| !wrench.is_zero()).collect()
    }
}

/// Whether each contact's decimal digit, of 0, 1 and 2, says that it is closed; none of numbers
/// that are no such digits.
fn digits(modes: f64, contacts: usize) -> Option<Vec<bool>> {
    if modes < 0.0 || modes.fract() != 0.0 || modes >= 10.0_f64.powi(contacts as i32) {
        return None;
    }
    let mut left = modes as u64;
    let digit = |_| {
        let digit = left % 10;
        left /= 10;
        (digit <= 2).then_some(digit > 0)
    };
    (0..contacts).map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modes_are_digits_of_0_to_2() {
        assert_eq!(digits(201.0, 4), Some(vec![true, false, true, false]));
        assert_eq!(digits(0.0, 2), Some(vec![false, false]));
        for wrong in [-1.0, 1.5, 3.0, 9999.0, 10_000.0, 1e30] {
            assert_eq!(digits(wrong, 4), None, "{wrong}");
        }
    }
}
