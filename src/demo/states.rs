//! Random states from a seed, the same on every machine.

use denavit::numerics::Random;

/// A state of motion.
pub(super) struct State {
    pub(super) q: Vec<f64>,
    pub(super) qd: Vec<f64>,
    pub(super) qdd: Vec<f64>,
}

impl State {
    /// Positions within 1.2 rad (short of the singular base roll of 90 degrees), rates within
    /// 2 rad/s, accelerations within 5 rad/s^2; in metres for sliding joints.
    pub(super) fn random(random: &mut Random, len: usize) -> Self {
        let [q, qd, qdd] = [1.2, 2.0, 5.0].map(|bound| vector(random, len, bound));
        Self { q, qd, qdd }
    }
}

/// Numbers between -`bound` and `bound`.
fn vector(random: &mut Random, len: usize, bound: f64) -> Vec<f64> {
    let unit = |bits: u64| (bits >> 11) as f64 / (1u64 << 53) as f64;
    (0..len).map(|_| bound * (2.0 * unit(random.bits()) - 1.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First numbers of the reference implementation in C for the seed 1234567.
    #[test]
    fn the_generator_is_splitmix64() {
        let mut random = Random::new(1_234_567);
        assert_eq!(random.bits(), 6_457_827_717_110_365_317);
        assert_eq!(random.bits(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn numbers_stay_within_their_bound_and_depend_on_the_seed() {
        let [a, b] = [1, 2].map(|seed| vector(&mut Random::new(seed), 100, 1.2));
        assert!(a.iter().chain(&b).all(|x| x.abs() <= 1.2) && a.iter().any(|x| *x < -0.6));
        assert_ne!(a, b);
    }
}
