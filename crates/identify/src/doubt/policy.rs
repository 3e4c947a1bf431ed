//! The numbers that decide which doubts are said, each with its unit and where it is from.

/// By how much values of a model may be off, as a share of them, with the log odds that they are:
/// what a drawing says, and what another load makes of it.
pub(super) const VALUES_OFF: [(f64, f64); 2] = [(0.1, 0.0), (1.0, -3.0)];

/// How many of its standard errors an estimate from other logs may be off: these count noise, and
/// little of what a model lacks.
pub(super) const ERRORS_HOLD: f64 = 3.0;

/// Log odds that they say nothing: 1 to 400.
pub(super) const VALUES_IDLE: f64 = -6.0;

/// What counts as little of a parameter, as a share of the largest one in the same unit: sums of
/// what cancels have errors of their terms, and what is symmetric is so to a few millimetres.
pub(super) const LITTLE: f64 = 0.02;

/// Rounds in which the noise of joints is found, of each reading.
pub(super) const WEIGHING_ROUNDS: usize = 8;

/// Log odds that a column is another one than it is taken for, before the log is looked at: 1 to
/// 400, as of what is hardly ever met.
pub(super) const MISLABELLED: f64 = -6.0;

/// How late signals are that are late \[s\]: a few periods of the loops that write them.
pub(super) const LATE_S: f64 = 0.02;

/// By how much zeros are off that are [rad, m]: those of a joint that was put together anew.
pub(super) const ZERO: f64 = 0.3;

/// The same of constants in torques, as a share of the torque, and of the logarithm of gains.
pub(super) const OFFSET: f64 = 0.3;
/// See [`OFFSET`].
pub(super) const GAIN: f64 = 0.3;

/// Half the difference of sizes that slopes are found with [rad, m, N m, N, 1].
pub(super) const SLOPE_STEP: f64 = 1e-3;

/// The share of what values leave of a torque that noise of the positions must make to explain it.
pub(super) const NOISE_OF_LEFT: f64 = 0.5;

/// Readings of columns that are weighed whole: those that values like best.
pub(super) const ESTIMATED: usize = 80;

/// Mistakes of some size that are followed from where a first look leaves them, each way that
/// values may be believed, steps along each, and the standard errors below which a step is none.
pub(super) const FOLLOWED: usize = 4;
/// See [`FOLLOWED`].
pub(super) const LINEARISED: usize = 12;
/// See [`FOLLOWED`].
pub(super) const STEPS_SETTLED: f64 = 0.05;

/// How late signals are at most \[s\].
pub(super) const LATEST_S: f64 = 0.2;

/// Samples of logs that are looked at, after decimation, at least and at most: so many in all
/// readings together, of which robots with many joints have many.
pub(super) const SAMPLES: [usize; 2] = [1024, 8192];
/// See [`SAMPLES`].
pub(super) const SAMPLES_READ: usize = 600_000;

/// The least share of its samples in which the sign of a joint's velocity must be known for the
/// others to be left out.
pub(super) const SIGNED: f64 = 0.1;
