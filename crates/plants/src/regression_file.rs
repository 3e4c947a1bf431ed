//! Values for the numbers of a model file, from those of the standard parameters.
//!
//! Base parameters are fewer than the numbers of a file: what is written are those of bodies.

use crate::regression::{ModelParameter, RegressionModel, StandardParameter};
use denavit_codegen::model::{BodyEntry, Role};

impl RegressionModel {
    /// Values in the order of [`RegressionModel::parameters`] that follow from theta0; `own` are
    /// values of some by their places, and others stay as they are. `is_about_com` says of a link's
    /// name whether its file gives inertias about the centre of mass.
    pub fn file_values(
        &self,
        standard: &[f64],
        own: &[(usize, f64)],
        is_about_com: &dyn Fn(&str) -> bool,
    ) -> Vec<f64> {
        let value = |(place, parameter): (usize, &ModelParameter)| {
            let own = own.iter().find(|(own, _)| *own == place).map(|&(_, value)| value);
            let value = own.or_else(|| self.direct(standard, parameter, is_about_com));
            value.unwrap_or(parameter.value)
        };
        self.parameters.iter().enumerate().map(value).collect()
    }

    /// The value of a number that follows from theta0 by itself.
    fn direct(
        &self,
        standard: &[f64],
        parameter: &ModelParameter,
        is_about_com: &dyn Fn(&str) -> bool,
    ) -> Option<f64> {
        let link = parameter.link.as_deref()?;
        let of = |prefix: &str| {
            let owner = |one: &StandardParameter| {
                one.owner.as_ref().is_some_and(|(name, own)| name == link && *own == prefix)
            };
            self.standard.iter().position(owner).map(|place| standard[place])
        };
        let Some(Role::Body(_, entry)) = parameter.role else {
            return of(parameter.name.split('_').next()?);
        };
        let m = of("m")?;
        let com = [of("mx")?, of("my")?, of("mz")?].map(|moment| moment / m);
        let [x, y, z] = com;
        let about = if is_about_com(link) { m } else { 0.0 };
        Some(match entry {
            BodyEntry::Mass => m,
            BodyEntry::ComX => x,
            BodyEntry::ComY => y,
            BodyEntry::ComZ => z,
            BodyEntry::InertiaXx => of("Ixx")? - about * (y * y + z * z),
            BodyEntry::InertiaYy => of("Iyy")? - about * (x * x + z * z),
            BodyEntry::InertiaZz => of("Izz")? - about * (x * x + y * y),
            BodyEntry::InertiaXy => of("Ixy")? + about * x * y,
            BodyEntry::InertiaXz => of("Ixz")? + about * x * z,
            BodyEntry::InertiaYz => of("Iyz")? + about * y * z,
        })
    }

    /// Which numbers of the file any base parameter depends on, near given values of all of them.
    pub fn file_values_with_effect(&self, values: &[f64]) -> Vec<bool> {
        let of = |values: &[f64]| self.axes_of_standard(&self.standard_values(values));
        let here = of(values);
        let mut moved = values.to_vec();
        let mut depends = |place: usize| {
            let value = values[place];
            moved[place] = value + 0.1 * value.abs() + 0.01;
            let there = of(&moved);
            moved[place] = value;
            let is_other = |(a, b): (&f64, &f64)| (a - b).abs() > 1e-12 * a.abs().max(1e-9);
            here.iter().zip(&there).any(is_other)
        };
        (0..values.len()).map(&mut depends).collect()
    }
}
