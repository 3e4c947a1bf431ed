//! The linear systems of a Newton iteration: (s 1 - J) x = r, J = df/dy, s real or complex.
//!
//! Positions change at the rates, which are part of the state, and integrals act on nothing: both
//! are eliminated, and what is factored has one row for each rate.

use super::Rates;
use crate::breakdown::Breakdown;
use nalgebra::{ComplexField, DMatrix, DVector, Dyn, LU};

/// How a state is ordered: positions, their rates and what else there is, integrals.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Shape {
    positions: usize,
    integrals: usize,
    len: usize,
}

impl Shape {
    pub(super) fn of(system: &dyn Rates, len: usize) -> Self {
        Self { positions: system.positions(), integrals: system.integrals(), len }
    }

    /// Entries that are neither positions nor integrals.
    fn free(self) -> usize {
        self.len - self.positions - self.integrals
    }
}

/// df/dy but for the rows of positions and the columns of integrals.
#[derive(Clone, Debug)]
pub(super) struct Jacobian {
    shape: Shape,
    /// Rows of free entries and integrals, columns of positions and free entries.
    matrix: DMatrix<f64>,
}

impl Jacobian {
    /// By differences about a state whose rates `f` are known.
    pub(super) fn by_differences(
        system: &mut dyn Rates,
        t_s: f64,
        y: &[f64],
        f: &[f64],
    ) -> Result<Self, Breakdown> {
        let shape = Shape::of(system, y.len());
        let (rows, columns) = (shape.len - shape.positions, shape.len - shape.integrals);
        let mut matrix = DMatrix::zeros(rows, columns);
        let mut moved = y.to_vec();
        let mut rates = vec![0.0; y.len()];
        for column in 0..columns {
            // forces that redundant contacts share have an accuracy of their own: not too small
            let change = 1e-6 * y[column].abs().max(0.1);
            moved[column] = y[column] + change;
            let change = moved[column] - y[column];
            system.rates(t_s, &moved, &mut rates)?;
            moved[column] = y[column];
            for row in 0..rows {
                let at = row + shape.positions;
                matrix[(row, column)] = (rates[at] - f[at]) / change;
            }
        }
        Ok(Self { shape, matrix })
    }

    /// How many evaluations its differences took.
    pub(super) fn evaluations(&self) -> usize {
        self.matrix.ncols()
    }
}

/// s 1 - J, factored.
#[derive(Clone, Debug)]
pub(super) struct Factored<T: ComplexField> {
    s: T,
    lu: LU<T, Dyn, Dyn>,
    right: DVector<T>,
}

impl<T: ComplexField<RealField = f64> + Copy> Factored<T> {
    pub(super) fn new(jacobian: &Jacobian, s: T) -> Self {
        let Shape { positions, .. } = jacobian.shape;
        let free = jacobian.shape.free();
        let entry = |row: usize, column: usize| {
            let value = T::from_real(-jacobian.matrix[(row, positions + column)]);
            // a position is that at the start plus its rate over s
            match column < positions {
                true => value - T::from_real(jacobian.matrix[(row, column)]) / s,
                false => value,
            }
        };
        let mut matrix = DMatrix::from_fn(free, free, entry);
        for i in 0..free {
            matrix[(i, i)] += s;
        }
        Self { s, lu: matrix.lu(), right: DVector::from_element(free, T::zero()) }
    }

    /// x := (s 1 - J)^-1 x; false if the matrix is singular.
    pub(super) fn solve(&mut self, jacobian: &Jacobian, x: &mut [T]) -> bool {
        let Shape { positions, len, .. } = jacobian.shape;
        let free = jacobian.shape.free();
        for (row, entry) in self.right.iter_mut().enumerate() {
            *entry = x[positions + row];
        }
        for (column, entry) in x[..positions].iter().enumerate() {
            let share = *entry / self.s;
            for (right, slope) in self.right.iter_mut().zip(jacobian.matrix.column(column).iter()) {
                *right += share * T::from_real(*slope);
            }
        }
        if !self.lu.solve_mut(&mut self.right) {
            return false;
        }
        x[positions..positions + free].copy_from_slice(self.right.as_slice());
        for position in 0..positions {
            x[position] = (x[position] + x[positions + position]) / self.s;
        }
        for integral in positions + free..len {
            let row = jacobian.matrix.row(integral - positions);
            let slopes = row.iter().zip(&*x);
            let sum = slopes.fold(T::zero(), |sum, (slope, x)| sum + *x * T::from_real(*slope));
            x[integral] = (x[integral] + sum) / self.s;
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    /// y = (q, v, integral): q' = v, v' = -3 q - 2 v q, integral' = q v.
    struct Oscillator;

    impl Rates for Oscillator {
        fn rates(&mut self, _t: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Breakdown> {
            dy.copy_from_slice(&[y[1], -3.0 * y[0] - 2.0 * y[1] * y[0], y[0] * y[1]]);
            Ok(())
        }

        fn positions(&self) -> usize {
            1
        }

        fn integrals(&self) -> usize {
            1
        }
    }

    #[test]
    fn the_eliminated_system_is_the_whole_one() {
        let y = [0.3, -0.7, 1.0];
        let mut f = [0.0; 3];
        Oscillator.rates(0.0, &y, &mut f).unwrap();
        let jacobian = Jacobian::by_differences(&mut Oscillator, 0.0, &y, &f).unwrap();
        let s = Complex::new(2.0, -1.5);
        let right = [Complex::new(1.0, 0.5), Complex::new(-2.0, 0.0), Complex::new(0.3, 4.0)];
        let mut x = right;
        assert!(Factored::new(&jacobian, s).solve(&jacobian, &mut x));
        let exact = [[0.0, 1.0, 0.0], [-3.0 - 2.0 * y[1], -2.0 * y[0], 0.0], [y[1], y[0], 0.0]];
        for row in 0..3 {
            let product: Complex<f64> = (0..3).map(|k| x[k] * exact[row][k]).sum();
            assert!((s * x[row] - product - right[row]).norm() < 1e-6, "{row}");
        }
    }
}
