//! Exact division and greatest common divisors of Laurent polynomials over the rationals.
//!
//! Monomials and numbers are units here: a divisor is found without them. The gcd runs by primitive
//! remainder sequences in one atom at a time; a gcd of images modulo 2^61 - 1 first finds out, and
//! proves, that there is nothing to find, which is by far the most frequent case.

use super::{Monomial, Polynomial, TooManyTerms, Work};
use crate::arena::Handle;
use crate::expr::ExprId;
use crate::number::{Rational, Residue, integer};
use num_traits::One;
use std::collections::BTreeMap;

/// Products on the way may have this many terms.
const MAX_PRODUCT: usize = 20_000;

/// A polynomial in one atom with polynomials in the others as coefficients, by exponent.
type Univariate = BTreeMap<i32, Polynomial>;

fn minus_one() -> Rational {
    integer(-1)
}

/// The atoms of a polynomial, in order.
fn atoms(polynomial: &Polynomial) -> Vec<ExprId> {
    let mut atoms: Vec<ExprId> = polynomial
        .terms()
        .flat_map(|(monomial, _)| monomial.powers().iter().map(|&(atom, _)| atom))
        .collect();
    atoms.sort_unstable();
    atoms.dedup();
    atoms
}

/// The product of the lowest powers of all atoms: the largest monomial that divides all terms.
fn monomial_content(polynomial: &Polynomial) -> Monomial {
    let mut content = Monomial::default();
    for atom in atoms(polynomial) {
        let lowest = polynomial.terms().map(|(monomial, _)| monomial.exponent(atom)).min();
        let power = lowest.and_then(|exponent| Monomial::atom(atom).power(exponent));
        if let Some(product) = power.and_then(|power| content.times(&power)) {
            content = product;
        }
    }
    content
}

/// `factor polynomial` for a monomial.
pub(super) fn times_monomial(
    polynomial: &Polynomial,
    factor: &Monomial,
) -> Result<Polynomial, TooManyTerms> {
    let mut product = Polynomial::zero();
    for (monomial, coefficient) in polynomial.terms() {
        product.add_term(monomial.times(factor).ok_or(TooManyTerms)?, coefficient.clone());
    }
    Ok(product)
}

/// (unit, rest) with `polynomial = unit rest`, where rest has no monomial factor and 1 as the
/// coefficient of its last term. The polynomial must not be 0.
pub(super) fn without_unit(
    polynomial: &Polynomial,
) -> Result<(Polynomial, Polynomial), TooManyTerms> {
    let content = monomial_content(polynomial);
    let inverse = content.power(-1).ok_or(TooManyTerms)?;
    let rest = times_monomial(polynomial, &inverse)?;
    let (_, last) = rest.terms().last().expect("the polynomial is not 0");
    let last = last.clone();
    Ok((Polynomial::term(content, last.clone()), rest.scaled(&last.recip())))
}

fn univariate(polynomial: &Polynomial, atom: ExprId) -> Univariate {
    let mut parts = Univariate::new();
    for (monomial, coefficient) in polynomial.terms() {
        parts
            .entry(monomial.exponent(atom))
            .or_default()
            .add_term(monomial.without(atom), coefficient.clone());
    }
    parts
}

fn multivariate(parts: &Univariate, atom: ExprId) -> Result<Polynomial, TooManyTerms> {
    let mut sum = Polynomial::zero();
    for (&exponent, part) in parts {
        let power = Monomial::atom(atom).power(exponent).ok_or(TooManyTerms)?;
        sum = sum.plus(&times_monomial(part, &power)?, &Rational::one());
    }
    Ok(sum)
}

fn leading(parts: &Univariate) -> (i32, &Polynomial) {
    let (&degree, coefficient) = parts.last_key_value().expect("the polynomial is not 0");
    (degree, coefficient)
}

/// `parts -= factor x^shift other`.
fn subtract(
    work: &Work,
    parts: &mut Univariate,
    factor: &Polynomial,
    shift: i32,
    other: &Univariate,
) -> Result<(), TooManyTerms> {
    for (&exponent, coefficient) in other {
        let product = work.times(coefficient, factor, MAX_PRODUCT)?;
        let place = parts.entry(exponent + shift).or_default();
        *place = std::mem::take(place).plus(&product, &minus_one());
    }
    parts.retain(|_, part| !part.is_zero());
    Ok(())
}

/// `a / b` if it is a Laurent polynomial; b must not be 0.
pub fn divide(
    work: &Work,
    a: &Polynomial,
    b: &Polynomial,
) -> Result<Option<Polynomial>, TooManyTerms> {
    work.look(a, b)?;
    if a.is_zero() {
        return Ok(Some(Polynomial::zero()));
    }
    if let Some((monomial, coefficient)) = b.as_term() {
        let inverse = monomial.power(-1).ok_or(TooManyTerms)?;
        return Ok(Some(times_monomial(a, &inverse)?.scaled(&coefficient.recip())));
    }
    let ((unit_a, a), (unit_b, b)) = (without_unit(a)?, without_unit(b)?);
    let atom = *atoms(&b).last().expect("a polynomial of several terms has atoms");
    let (mut rest, divisor) = (univariate(&a, atom), univariate(&b, atom));
    let (degree, lead) = leading(&divisor);
    let mut quotient = Univariate::new();
    while !rest.is_empty() {
        let (rest_degree, rest_lead) = leading(&rest);
        if rest_degree < degree {
            return Ok(None);
        }
        let Some(factor) = divide(work, rest_lead, lead)? else { return Ok(None) };
        let shift = rest_degree - degree;
        subtract(work, &mut rest, &factor, shift, &divisor)?;
        if quotient.insert(shift, factor).is_some() {
            return Ok(None);
        }
    }
    let quotient = multivariate(&quotient, atom)?;
    let unit = divide(work, &unit_a, &unit_b)?.expect("units divide");
    // A factor with negative powers would make the quotient of stripped parts wrong.
    let quotient = work.times(&quotient, &unit, MAX_PRODUCT)?;
    Ok(Some(quotient))
}

/// The greatest common divisor without units: no monomial factor, last coefficient 1; 0 if both
/// are 0.
pub fn gcd(work: &Work, a: &Polynomial, b: &Polynomial) -> Result<Polynomial, TooManyTerms> {
    work.look(a, b)?;
    let one = || Polynomial::constant(Rational::one());
    match (a.is_zero(), b.is_zero()) {
        (true, true) => return Ok(Polynomial::zero()),
        (true, false) => return Ok(without_unit(b)?.1),
        (false, true) => return Ok(without_unit(a)?.1),
        (false, false) => {}
    }
    let ((_, a), (_, b)) = (without_unit(a)?, without_unit(b)?);
    if a.len() == 1 || b.len() == 1 {
        return Ok(one());
    }
    if a == b {
        return Ok(a);
    }
    let (of_a, of_b) = (atoms(&a), atoms(&b));
    // An atom of one alone is not in the divisor: neither are its powers apart.
    if let Some(&atom) = of_a.iter().find(|atom| !of_b.contains(atom)) {
        return content_with(work, &a, atom, b);
    }
    if let Some(&atom) = of_b.iter().find(|atom| !of_a.contains(atom)) {
        return content_with(work, &b, atom, a);
    }
    if of_a.iter().all(|&atom| is_free_of(&a, &b, atom)) {
        return Ok(one());
    }
    let atom = of_a
        .iter()
        .copied()
        .find(|&atom| !is_free_of(&a, &b, atom))
        .expect("some atom may be in the divisor");
    by_remainders(work, &a, &b, atom)
}

/// gcd(coefficients of a in `atom`, b).
fn content_with(
    work: &Work,
    a: &Polynomial,
    atom: ExprId,
    b: Polynomial,
) -> Result<Polynomial, TooManyTerms> {
    let mut divisor = b;
    for part in univariate(a, atom).values() {
        divisor = gcd(work, &divisor, part)?;
        if divisor.len() == 1 {
            break;
        }
    }
    Ok(divisor)
}

fn content(work: &Work, parts: &Univariate) -> Result<Polynomial, TooManyTerms> {
    let mut divisor = Polynomial::zero();
    for part in parts.values() {
        divisor = gcd(work, &divisor, part)?;
        if divisor.len() == 1 {
            break;
        }
    }
    Ok(divisor)
}

fn primitive(work: &Work, parts: &Univariate) -> Result<Univariate, TooManyTerms> {
    let content = content(work, parts)?;
    let mut result = Univariate::new();
    for (&exponent, part) in parts {
        result.insert(exponent, divide(work, part, &content)?.expect("the content divides"));
    }
    Ok(result)
}

fn by_remainders(
    work: &Work,
    a: &Polynomial,
    b: &Polynomial,
    atom: ExprId,
) -> Result<Polynomial, TooManyTerms> {
    let (parts_a, parts_b) = (univariate(a, atom), univariate(b, atom));
    let common = gcd(work, &content(work, &parts_a)?, &content(work, &parts_b)?)?;
    let (mut large, mut small) = (primitive(work, &parts_a)?, primitive(work, &parts_b)?);
    if leading(&large).0 < leading(&small).0 {
        std::mem::swap(&mut large, &mut small);
    }
    loop {
        let mut rest = large;
        while !rest.is_empty() && leading(&rest).0 >= leading(&small).0 {
            let (rest_degree, rest_lead) = leading(&rest);
            let (degree, lead) = leading(&small);
            let (rest_lead, lead) = (rest_lead.clone(), lead.clone());
            // lead(small) rest - lead(rest) x^k small
            for part in rest.values_mut() {
                *part = work.times(part, &lead, MAX_PRODUCT)?;
            }
            subtract(work, &mut rest, &rest_lead, rest_degree - degree, &small)?;
        }
        if rest.is_empty() {
            break;
        }
        let is_constant = leading(&rest).0 == 0;
        large = small;
        small = primitive(work, &rest)?;
        if is_constant {
            small = BTreeMap::from([(0, Polynomial::constant(Rational::one()))]);
            break;
        }
    }
    let divisor = work.times(&multivariate(&small, atom)?, &common, MAX_PRODUCT)?;
    Ok(without_unit(&divisor)?.1)
}

/// Whether the gcd certainly has no power of `atom`: that of the images at a random point of the
/// other atoms has none, and the leading coefficients do not vanish there.
fn is_free_of(a: &Polynomial, b: &Polynomial, atom: ExprId) -> bool {
    let images = [a, b].map(|polynomial| image(polynomial, atom));
    let [Some(mut a), Some(mut b)] = images else { return false };
    // Euclid's algorithm on dense residues, highest power last.
    while b.len() > 1 {
        let lead = b.last().and_then(|lead| lead.inverse()).expect("leading terms are not 0");
        while a.len() >= b.len() {
            let factor = *a.last().expect("it is longer than b") * lead;
            let shift = a.len() - b.len();
            for (index, &value) in b.iter().enumerate() {
                a[index + shift] = a[index + shift] - factor * value;
            }
            while a.last() == Some(&Residue::ZERO) {
                a.pop();
            }
        }
        if a.is_empty() {
            return false;
        }
        std::mem::swap(&mut a, &mut b);
    }
    !b.is_empty()
}

/// The polynomial in `atom` at a random point of the others; none if a leading coefficient or a
/// denominator vanishes there.
fn image(polynomial: &Polynomial, atom: ExprId) -> Option<Vec<Residue>> {
    let mut dense: Vec<Residue> = Vec::new();
    for (monomial, coefficient) in polynomial.terms() {
        let mut value = Residue::from_rational(coefficient)?;
        for &(other, exponent) in monomial.powers().iter().filter(|&&(other, _)| other != atom) {
            let base = Residue::scrambled(0x6763_6400, other.index() as u64);
            value = value * base.power(u64::try_from(exponent).ok()?);
        }
        let degree = usize::try_from(monomial.exponent(atom)).ok()?;
        if dense.len() <= degree {
            dense.resize(degree + 1, Residue::ZERO);
        }
        dense[degree] = dense[degree] + value;
    }
    (dense.last() != Some(&Residue::ZERO)).then_some(dense)
}
