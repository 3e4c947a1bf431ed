//! Eigenvalues and eigenvectors of a return map's linearisation.

use nalgebra::{Complex, DMatrix, DVector, Schur};

/// A Floquet multiplier with its direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Multiplier {
    /// Real and imaginary part.
    pub value: [f64; 2],
    /// Its eigenvector in the coordinates of the matrix, of length 1.
    pub direction: Vec<[f64; 2]>,
}

impl Multiplier {
    /// Its modulus.
    pub fn modulus(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }
}

/// Multipliers are known to about this; a modulus nearer to 1 says neither that deviations die nor
/// that they grow.
const NEUTRAL: f64 = 1e-5;

/// What becomes of deviations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fate {
    /// All multipliers are inside the unit circle.
    Die,
    /// The largest is on it, as far as is known: such deviations stay as they are.
    Stay,
    /// The largest is outside.
    Grow,
}

impl Fate {
    /// Of deviations whose largest multiplier has this modulus.
    pub fn of(largest: f64) -> Self {
        match largest {
            modulus if modulus < 1.0 - NEUTRAL => Self::Die,
            modulus if modulus <= 1.0 + NEUTRAL => Self::Stay,
            _ => Self::Grow,
        }
    }
}

/// More QR iterations for one matrix are no convergence.
const ITERATIONS: usize = 10_000;

/// All multipliers by falling modulus; of a pair that with the positive imaginary part first.
/// None where the matrix is not finite or the iteration does not converge.
pub fn multipliers(matrix: &DMatrix<f64>) -> Option<Vec<Multiplier>> {
    if matrix.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let schur = Schur::try_new(matrix.clone(), f64::EPSILON, ITERATIONS)?;
    let mut found: Vec<Multiplier> = schur
        .complex_eigenvalues()
        .iter()
        .map(|value| Multiplier {
            value: [value.re, value.im],
            direction: eigenvector(matrix, *value).iter().map(|z| [z.re, z.im]).collect(),
        })
        .collect();
    let order = |a: &Multiplier, b: &Multiplier| {
        let near = (a.modulus() - b.modulus()).abs() <= 1e-12 * a.modulus().max(1e-300);
        let modulus =
            if near { std::cmp::Ordering::Equal } else { b.modulus().total_cmp(&a.modulus()) };
        modulus.then(b.value[1].total_cmp(&a.value[1])).then(b.value[0].total_cmp(&a.value[0]))
    };
    found.sort_by(order);
    Some(found)
}

/// The right singular vector of the least singular value of (matrix - value).
fn eigenvector(matrix: &DMatrix<f64>, value: Complex<f64>) -> DVector<Complex<f64>> {
    let n = matrix.nrows();
    let shifted = DMatrix::from_fn(n, n, |row, column| {
        let entry = Complex::new(matrix[(row, column)], 0.0);
        if row == column { entry - value } else { entry }
    });
    let svd = shifted.svd(false, true);
    let least = svd.singular_values.imin();
    match svd.v_t {
        Some(v_t) => v_t.row(least).adjoint(),
        None => DVector::zeros(n),
    }
}
