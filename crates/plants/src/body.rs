//! Coordinates of bodies that exist.
//!
//! The pseudo-inertia of a body is J = L L^T with L lower triangular and of positive diagonal
//! (log-Cholesky; Rucker, Wensing 2022): ten numbers, whatever they are, make a body. The ten
//! parameters of a body are m, m c, and Ixx, Iyy, Izz, Ixy, Ixz, Iyz about the origin.

use nalgebra::Matrix4;

/// The smallest eigenvalue of a pseudo-inertia that has coordinates as it is, over its trace.
const LEAST_SHARE: f64 = 1e-4;

/// The coordinates of ten parameters, moved into the bodies that exist: the logarithms of the
/// diagonal of L, then what is below, row by row.
pub fn log_cholesky(ten: &[f64]) -> impl Iterator<Item = f64> {
    let l = cholesky_of_near(&pseudo_inertia(ten));
    let below = (0..4).flat_map(|row| (0..row).map(move |column| (row, column)));
    (0..4).map(move |row| l[(row, row)].ln()).chain(below.map(move |place| l[place]))
}

/// The ten parameters of coordinates, and how they change with each of these.
pub fn of_log_cholesky(eta: &[f64]) -> ([f64; 10], [[f64; 10]; 10]) {
    let l = lower(eta);
    let mut slopes = [[0.0; 10]; 10];
    let mut next = 4;
    for row in 0..4 {
        for column in 0..=row {
            // d(L L^T) = dL L^T + L dL^T
            let mut change = Matrix4::zeros();
            let is_diagonal = row == column;
            change[(row, column)] = if is_diagonal { l[(row, row)] } else { 1.0 };
            let moved = change * l.transpose() + l * change.transpose();
            slopes[if is_diagonal { row } else { next }] = ten_parameters(&moved);
            next += usize::from(!is_diagonal);
        }
    }
    (ten_parameters(&(l * l.transpose())), slopes)
}

/// The pseudo-inertia [[integral of x x^T dm, integral of x dm], [.., m]] of ten parameters.
fn pseudo_inertia(ten: &[f64]) -> Matrix4<f64> {
    let &[m, x, y, z, xx, yy, zz, xy, xz, yz] = ten else {
        unreachable!("a body has ten parameters")
    };
    let half = 0.5 * (xx + yy + zz);
    Matrix4::new(
        half - xx,
        -xy,
        -xz,
        x, //
        -xy,
        half - yy,
        -yz,
        y, //
        -xz,
        -yz,
        half - zz,
        z, //
        x,
        y,
        z,
        m,
    )
}

fn ten_parameters(j: &Matrix4<f64>) -> [f64; 10] {
    let trace = j[(0, 0)] + j[(1, 1)] + j[(2, 2)];
    let moment = |axis: usize| trace - j[(axis, axis)];
    let (m, h) = (j[(3, 3)], [j[(0, 3)], j[(1, 3)], j[(2, 3)]]);
    let products = [-j[(0, 1)], -j[(0, 2)], -j[(1, 2)]];
    let [x, y, z] = h;
    let [xy, xz, yz] = products;
    [m, x, y, z, moment(0), moment(1), moment(2), xy, xz, yz]
}

/// L of coordinates: the logarithms of its diagonal, then what is below, row by row.
fn lower(eta: &[f64]) -> Matrix4<f64> {
    let mut l = Matrix4::zeros();
    let mut next = 4;
    for row in 0..4 {
        l[(row, row)] = eta[row].exp();
        for column in 0..row {
            l[(row, column)] = eta[next];
            next += 1;
        }
    }
    l
}

/// The Cholesky factor of a pseudo-inertia, its eigenvalues raised where they are too small.
fn cholesky_of_near(j: &Matrix4<f64>) -> Matrix4<f64> {
    // A body that is nothing yet: 10 g of the size of a fist.
    let nothing = Matrix4::from_diagonal(&nalgebra::Vector4::new(1e-5, 1e-5, 1e-5, 1e-2));
    let trace = j.trace();
    let j = if trace > 1e-9 { *j } else { nothing };
    let least = LEAST_SHARE * j.trace().abs();
    // Masses and moments have sizes of their own: the block of moments is measured by itself.
    let mut eigen = j.symmetric_eigen();
    let moments = 1e-3 * (j[(0, 0)] + j[(1, 1)] + j[(2, 2)]).abs().max(1e-6);
    let floor = least.min(moments).max(1e-9);
    eigen.eigenvalues.iter_mut().for_each(|value| *value = value.max(floor));
    let raised = eigen.recompose();
    let raised = (raised + raised.transpose()) * 0.5;
    raised.cholesky().map_or_else(|| cholesky_of_near(&nothing), |cholesky| cholesky.l())
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: [f64; 10] = [2.0, 0.3, -0.1, 0.2, 0.30, 0.35, 0.25, 0.02, -0.03, 0.01];

    /// A body that exists has its own parameters again, which change with coordinates as central
    /// differences say.
    #[test]
    fn coordinates_of_a_body_are_those_of_its_parameters() {
        let eta: Vec<f64> = log_cholesky(&BODY).collect();
        let (ten, slopes) = of_log_cholesky(&eta);
        for (found, given) in ten.iter().zip(BODY) {
            assert!((found - given).abs() < 1e-12, "{found} {given}");
        }
        for (place, slope) in slopes.iter().enumerate() {
            let [above, below] = [1e-6, -1e-6].map(|by| {
                let mut moved = eta.clone();
                moved[place] += by;
                of_log_cholesky(&moved).0
            });
            for ((above, below), slope) in above.iter().zip(below).zip(slope) {
                assert!(((above - below) / 2e-6 - slope).abs() < 1e-8, "{place}");
            }
        }
    }
}
