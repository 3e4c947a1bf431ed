//! A bound on exact arithmetic, which can take longer than anybody waits although its results, or
//! the lack of them, are small: the same input stops at the same place on every machine.

use super::{Polynomial, TooManyTerms};
use std::cell::Cell;

/// Products of terms with small coefficients: some seconds. TUlip's base parameters take a
/// thousandth of it.
const MAX_PRODUCTS: u64 = 20_000_000;

/// What is left of the work that may be done.
#[derive(Clone, Debug)]
pub struct Work(Cell<u64>);

impl Default for Work {
    fn default() -> Self {
        Self(Cell::new(MAX_PRODUCTS))
    }
}

impl Work {
    /// Looks at all terms of two polynomials.
    pub(super) fn look(&self, a: &Polynomial, b: &Polynomial) -> Result<(), TooManyTerms> {
        self.spend(a.len().saturating_add(b.len()), a, b)
    }

    /// A product of at most `limit` terms.
    pub(super) fn times(
        &self,
        a: &Polynomial,
        b: &Polynomial,
        limit: usize,
    ) -> Result<Polynomial, TooManyTerms> {
        self.spend(a.len().saturating_mul(b.len()), a, b)?;
        a.times(b, limit)
    }

    /// Does so many products of coefficients. Long ones cost the square of their length, since
    /// fractions are reduced.
    fn spend(&self, products: usize, a: &Polynomial, b: &Polynomial) -> Result<(), TooManyTerms> {
        let words = (longest(a) + longest(b)) / 64;
        let each = 1 + words.saturating_mul(words) / 3;
        let cost = (products as u64).saturating_mul(each);
        let left = self.0.get().checked_sub(cost).ok_or(TooManyTerms)?;
        self.0.set(left);
        Ok(())
    }
}

/// The bits of the longest coefficient.
fn longest(polynomial: &Polynomial) -> u64 {
    let bits = polynomial.terms().map(|(_, value)| value.numer().bits() + value.denom().bits());
    bits.max().unwrap_or(0)
}
