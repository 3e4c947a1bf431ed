//! What chance makes of variances, and of errors whose variances are known by chance; variances of
//! sums, and samples that count, where neighbours are alike.

use nalgebra::{DMatrix, DVector};
use std::borrow::Borrow;

/// The normal deviate below which one of twenty lies.
const ONE_OF_TWENTY: f64 = -1.644_853_626_951;

/// The root of the mean square; 0 of nothing.
pub fn rms(values: impl IntoIterator<Item = impl Borrow<f64>>) -> f64 {
    let squares = values.into_iter().map(|value| value.borrow().powi(2));
    let (sum, count) = squares.fold((0.0, 0_usize), |(sum, count), one| (sum + one, count + 1));
    (sum / count.max(1) as f64).sqrt()
}

/// The least and the largest of values; of none infinity and -infinity.
pub fn least_and_most(values: impl IntoIterator<Item = impl Borrow<f64>>) -> [f64; 2] {
    values.into_iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(*value.borrow()), high.max(*value.borrow())]
    })
}

/// The mean; 0 of nothing.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// The mean square of what values differ from their mean by; 0 of nothing.
pub fn variance(values: &[f64]) -> f64 {
    products(values, values)[1] / values.len().max(1) as f64
}

/// The middle one of values by size, of two the larger; 0 of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    values.sort_unstable_by(f64::total_cmp);
    values.get(middle).copied().unwrap_or(0.0)
}

/// The sums of the products of two signals without their means, and of the squares of both: a b,
/// a^2, b^2.
pub fn products(a: &[f64], b: &[f64]) -> [f64; 3] {
    let (at, bt) = (mean(a), mean(b));
    let apart = a.iter().zip(b).map(|(a, b)| (a - at, b - bt));
    apart.fold([0.0; 3], |[ab, aa, bb], (a, b)| [ab + a * b, aa + a * a, bb + b * b])
}

/// What chance leaves of a variance with so many degrees of freedom, less in one of twenty cases
/// (Wilson and Hilferty 1931).
pub fn least_by_chance(degrees_of_freedom: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees_of_freedom.max(1.0));
    (1.0 - spread + ONE_OF_TWENTY * spread.sqrt()).max(0.0).powi(3)
}

/// The factor of a standard error that makes a 95 % interval, by Student's distribution (Cornish
/// and Fisher's series; better than 1 % from 2 degrees of freedom on).
pub fn interval_factor(degrees_of_freedom: f64) -> f64 {
    let z: f64 = 1.959_963_984_540_054;
    let nu = degrees_of_freedom.max(2.0);
    let first = (z.powi(3) + z) / (4.0 * nu);
    let second = (5.0 * z.powi(5) + 16.0 * z.powi(3) + 3.0 * z) / (96.0 * nu * nu);
    let third =
        (3.0 * z.powi(7) + 19.0 * z.powi(5) + 17.0 * z.powi(3) - 15.0 * z) / (384.0 * nu.powi(3));
    let fourth = (79.0 * z.powi(9) + 776.0 * z.powi(7) + 1482.0 * z.powi(5)
        - 1920.0 * z.powi(3)
        - 945.0 * z)
        / (92160.0 * nu.powi(4));
    z + first + second + third + fourth
}

/// The variance of a sum of terms, so many of which in a row are alike: what sums of these vary by,
/// wherever they begin (Newey, West 1987).
pub fn variance_of_sum(terms: &[f64], together: usize) -> f64 {
    let mut sums = vec![0.0];
    sums.extend(terms.iter().scan(0.0, |sum, term| {
        *sum += term;
        Some(*sum)
    }));
    let part = |end: usize| sums[end.min(terms.len())] - sums[end.saturating_sub(together)];
    let parts = (1..terms.len() + together).map(|end| part(end).powi(2));
    parts.sum::<f64>() / together as f64
}

/// Neighbouring parts are taken to be no more alike than this.
const MOST_ALIKE: f64 = 0.8;

/// The covariance of a sum over parts, of which neighbours of the same group are correlated:
/// counted half where they are hardly, and where they are more, as much again as a process of first
/// order has at larger distances, whose sums are 1 / (1 - r) times those of its neighbours.
pub fn long_run<G: PartialEq>(parts: &[DVector<f64>], group_of_part: &[G]) -> DMatrix<f64> {
    let size = parts.first().map_or(0, DVector::len);
    let (mut sum, mut beside) = (DMatrix::zeros(size, size), DMatrix::zeros(size, size));
    for (at, part) in parts.iter().enumerate() {
        sum += part * part.transpose();
        if let Some(next) = parts.get(at + 1).filter(|_| group_of_part[at + 1] == group_of_part[at])
        {
            let cross = part * next.transpose();
            beside += (&cross + cross.transpose()) * 0.5;
        }
    }
    let alike = (0..size).filter(|&at| sum[(at, at)] > 0.0);
    let alike: Vec<f64> = alike.map(|at| beside[(at, at)] / sum[(at, at)]).collect();
    let alike = alike.iter().sum::<f64>() / alike.len().max(1) as f64;
    (sum + beside) / (1.0 - alike.clamp(0.0, MOST_ALIKE))
}

/// The samples over which a signal is like itself, from the sums of its products with itself so
/// many samples later: those of the initial positive sequence (Geyer 1992).
pub fn time_alike(alike: &[f64]) -> f64 {
    if alike[0] <= 0.0 {
        return 1.0;
    }
    let pairs = alike[1..].chunks_exact(2).map(|pair| (pair[0] + pair[1]) / alike[0]);
    1.0 + 2.0 * pairs.take_while(|pair| *pair > 0.0).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Random;

    /// Sums over 64 parts of a process of first order, whose variance is known: white, and one
    /// whose neighbours are correlated by a half, of which neighbours alone would show half.
    #[test]
    fn sums_of_parts_that_are_alike_have_their_variance() {
        const PARTS: usize = 64;
        let group_of_part = [0; PARTS];
        let mut random = Random::new(3);
        for alike in [0.0_f64, 0.5] {
            let fresh = (1.0 - alike * alike).sqrt();
            let mut mean = 0.0;
            for _ in 0..400 {
                let mut last = random.normal();
                let parts: Vec<DVector<f64>> = (0..PARTS)
                    .map(|_| {
                        last = alike * last + fresh * random.normal();
                        DVector::from_element(1, last)
                    })
                    .collect();
                mean += long_run(&parts, &group_of_part)[(0, 0)] / 400.0;
            }
            let distances = (1..PARTS).map(|d| (PARTS - d) as f64 * alike.powi(d as i32));
            let variance = PARTS as f64 + 2.0 * distances.sum::<f64>();
            assert!((mean / variance - 1.0).abs() < 0.12, "{alike}: {mean} {variance}");
        }
    }

    /// Of independent terms the variance is the sum of squares, and of terms that come in equal
    /// pairs nearly twice that, wherever the pairs begin.
    #[test]
    fn sums_of_terms_that_are_alike_vary_more() {
        let mut random = Random::new(5);
        let white: Vec<f64> = (0..20_000).map(|_| random.normal()).collect();
        let pairs: Vec<f64> = white.iter().flat_map(|term| [*term, *term]).collect();
        let squares = |terms: &[f64]| terms.iter().map(|term| term * term).sum::<f64>();
        for (terms, alike) in [(&white[..], 1.0), (&pairs, 1.9), (&pairs[1..], 1.9)] {
            let found = variance_of_sum(terms, 10) / squares(terms);
            assert!((found - alike).abs() < 0.1, "{found} {alike}");
        }
    }

    /// An autoregressive signal of the first order with factor 0.8 is like itself over
    /// (1 + 0.8) / (1 - 0.8) = 9 samples.
    #[test]
    fn signals_are_like_themselves_as_long_as_theory_says() {
        let mut random = Random::new(3);
        let mut last = 0.0;
        let signal: Vec<f64> = (0..200_000)
            .map(|_| {
                last = 0.8 * last + random.normal();
                last
            })
            .collect();
        let of_lag = |lag: usize| signal.iter().zip(&signal[lag..]).map(|(a, b)| a * b).sum();
        let alike: Vec<f64> = (0..256).map(of_lag).collect();
        let time = time_alike(&alike);
        assert!((time - 9.0).abs() < 0.7, "{time}");
    }

    /// Tables of the distribution of squares, 5 %.
    #[test]
    fn what_chance_leaves_is_that_of_tables() {
        for (nu, printed) in [(5.0, 1.145), (10.0, 3.940), (30.0, 18.493)] {
            assert!((least_by_chance(nu) * nu / printed - 1.0).abs() < 0.02, "{nu}");
        }
    }

    /// Tables of Student's distribution, 97.5 %.
    #[test]
    fn interval_factors_are_those_of_tables() {
        for (nu, printed) in
            [(2.0, 4.303), (4.0, 2.776), (10.0, 2.228), (30.0, 2.042), (1e6, 1.960)]
        {
            assert!((interval_factor(nu) - printed).abs() < 0.01 * printed, "{nu}");
        }
    }
}
