//! Entries of z that have values: those that the logs would drive beyond what the model allows.

use nalgebra::{DMatrix, DVector};

/// Entries of z that have values: in the coordinates u of Q, where z = R^-1 u, they are W' u = w.
#[derive(Clone)]
pub(super) struct Held {
    /// For each entry of z its value, if it is held.
    pub(super) values: Vec<Option<f64>>,
    /// W, orthonormal.
    pub(super) across: DMatrix<f64>,
    /// The shortest u with these values, W w.
    pub(super) offset: DVector<f64>,
}

impl Held {
    pub(super) fn new(r: &DMatrix<f64>, values: &[Option<f64>]) -> Self {
        let width = r.ncols();
        let (places, given): (Vec<usize>, Vec<f64>) =
            values.iter().enumerate().filter_map(|(k, value)| Some((k, (*value)?))).unzip();
        let mut rows = DMatrix::zeros(width, places.len());
        places.iter().enumerate().for_each(|(column, &place)| rows[(place, column)] = 1.0);
        let rows = r.tr_solve_upper_triangular(&rows).unwrap_or(rows);
        let (across, triangle) = rows.qr().unpack();
        let given = DVector::from_vec(given);
        let along = triangle.tr_solve_upper_triangular(&given).unwrap_or(given);
        let offset = &across * along;
        Self { values: values.to_vec(), across, offset }
    }

    /// The part of coordinates that is free.
    pub(super) fn free(&self, coordinates: &mut DMatrix<f64>) {
        *coordinates -= &self.across * self.across.tr_mul(coordinates);
    }
}

/// Holds what is beyond a bound at it; whether anything was.
pub(super) fn hold(held: &mut [Option<f64>], z: &[f64], bound: f64) -> bool {
    let mut is_more = false;
    for (held, z) in held.iter_mut().zip(z).filter(|(_, z)| z.abs() > bound) {
        *held = Some(bound.copysign(*z));
        is_more = true;
    }
    is_more
}
