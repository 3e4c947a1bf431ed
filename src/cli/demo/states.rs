//! Random states from a seed, the same on every machine.

/// Steele, Lea, Flood (2014), SplitMix64: enough for points at which equations are compared.
pub(super) struct Random {
    state: u64,
}

impl Random {
    pub(super) fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    fn next(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut bits = self.state;
        bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        bits ^ (bits >> 31)
    }

    /// Numbers between -`bound` and `bound`.
    pub(super) fn vector(&mut self, len: usize, bound: f64) -> Vec<f64> {
        let unit = |bits: u64| (bits >> 11) as f64 / (1u64 << 53) as f64;
        (0..len).map(|_| bound * (2.0 * unit(self.next()) - 1.0)).collect()
    }
}

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
        let q = random.vector(len, 1.2);
        let qd = random.vector(len, 2.0);
        let qdd = random.vector(len, 5.0);
        Self { q, qd, qdd }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// First numbers of the reference implementation in C for the seed 1234567.
    #[test]
    fn the_generator_is_splitmix64() {
        let mut random = Random::new(1_234_567);
        assert_eq!(random.next(), 6_457_827_717_110_365_317);
        assert_eq!(random.next(), 3_203_168_211_198_807_973);
    }

    #[test]
    fn numbers_stay_within_their_bound_and_depend_on_the_seed() {
        let [a, b] = [1, 2].map(|seed| Random::new(seed).vector(100, 1.2));
        assert!(a.iter().chain(&b).all(|x| x.abs() <= 1.2) && a.iter().any(|x| *x < -0.6));
        assert_ne!(a, b);
    }
}
