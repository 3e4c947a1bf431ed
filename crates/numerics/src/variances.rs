//! What chance makes of variances, and of errors whose variances are known by chance.

/// The normal deviate below which one of twenty lies.
const ONE_OF_TWENTY: f64 = -1.644_853_626_951;

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

#[cfg(test)]
mod tests {
    use super::*;

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
