//! What a model's standard deviations say of base parameters.

use denavit_numerics::least_squares::PriorRow;
use denavit_plants::regression::{RegressionModel, RegressionParameter};

/// What the model's standard deviations say of base parameters: those that depend on no number
/// without one, to first order.
pub(super) fn prior(model: &RegressionModel) -> Vec<PriorRow> {
    let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
    let listed = |values: &[f64]| -> Vec<f64> {
        let standard = model.standard_values(values);
        let sum = |one: &RegressionParameter| {
            one.members.iter().map(|&(at, factor)| factor * standard[at]).sum()
        };
        model.listed.iter().map(sum).collect()
    };
    let here = listed(&values);
    let mut variances = vec![Some(0.0); here.len()];
    let mut moved = values.clone();
    for (place, parameter) in model.parameters.iter().enumerate() {
        let step = 1e-4 * parameter.value.abs().max(1e-2);
        moved[place] = parameter.value + step;
        let above = listed(&moved);
        moved[place] = parameter.value - step;
        let below = listed(&moved);
        moved[place] = parameter.value;
        for (variance, (above, below)) in variances.iter_mut().zip(above.iter().zip(&below)) {
            let slope = (above - below) / (2.0 * step);
            if slope.abs() > 1e-12 {
                let own = parameter.std.map(|std| (slope * std).powi(2));
                *variance = variance.and_then(|sum: f64| Some(sum + own?));
            }
        }
    }
    let of = |(row, variance): (usize, &Option<f64>)| {
        let std = variance.filter(|variance| *variance > 0.0)?.sqrt();
        let value = model.listed[row].value?;
        let factors = model.to_listed().row(row).iter().copied().collect();
        Some(PriorRow { factors, value, std })
    };
    variances.iter().enumerate().filter_map(of).collect()
}
