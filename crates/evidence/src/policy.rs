//! The numbers that decide a verdict, each with its unit and where it is from.

/// Shape of the inverse gamma prior of a cell's variance: one row's worth of belief, so that a
/// cell of many rows says its variance itself.
pub const NOISE_SHAPE: f64 = 1.0;

/// The level of that prior, as a share of the joint's torque (root mean squares): between the
/// resolution of good torque sensors (0.05 %) and the hysteresis of usual ones (1 %).
pub const NOISE_LEVEL: f64 = 2e-3;

/// The least share of the expected variance with which the search for variances begins.
pub const LEAST_OF_LEVEL: f64 = 0.1;

/// Nats by which the evidence may still change where the search for variances ends.
pub const SETTLED: f64 = 1e-2;

/// Ends of the bands of a joint's cells, as shares of the cutoff frequency: finer where the motion
/// is, wide enough that the lowest has tens of lines in a log of 15 s.
pub const BANDS: [f64; 8] =
    [0.0, 1.0 / 30.0, 1.0 / 15.0, 0.1, 1.0 / 6.0, 4.0 / 15.0, 7.0 / 15.0, 2.0 / 3.0];

/// The share of the power of velocities that is driven by references, and how much further than
/// that frequency a motion is taken to be driven: what is beyond answers disturbances, and columns
/// made of accelerations have the same noise there as the torque that answers them.
pub const DRIVEN_SHARE: f64 = 0.995;
/// See [`DRIVEN_SHARE`].
pub const DRIVEN_REACH: f64 = 2.0;

/// The cutoff of torques over the driven frequency, which leaves bands above the motion that tell
/// noise, and its bounds \[Hz\] and as a share of the sampling rate.
pub const CUTOFF_OVER_DRIVEN: f64 = 5.0;
/// See [`CUTOFF_OVER_DRIVEN`].
pub const CUTOFF_HZ: [f64; 2] = [4.0, 15.0];
/// See [`CUTOFF_OVER_DRIVEN`].
pub const CUTOFF_OF_RATE: f64 = 0.05;

/// The prior of the size of an effect, as a share of its joint's torque.
pub const SIZE: f64 = 0.3;

/// The same of angles that are off [rad, m], and of lengths that start at 0 \[m\].
pub const ANGLE: f64 = 0.1;
/// See [`ANGLE`].
pub const LENGTH: f64 = 0.1;

/// Errors of every model that are too small for a name, as shares of the torque: offset, viscous
/// and Coulomb friction.
pub const UNNAMED: f64 = 1e-3;

/// Friction that a model may lack, as a share of the torque: a drive that rests has any of it, as
/// of what the model has.
pub const STEP: f64 = 0.05;

/// By which time each reversal is late \[s\], and all of a joint together: control loops and logs
/// have periods of 1 to 5 ms, and a drive sticks as long unseen.
pub const LATE_S: f64 = 1.5e-3;

/// The share of a sample of the log by which torque and motion may be of different times.
pub const TIME: f64 = 0.1;

/// Log odds of an effect that is met less often than the common ones, and of one that is hardly
/// ever met: 1 to 20 and 1 to 400.
pub const UNCOMMON: f64 = -3.0;
/// See [`UNCOMMON`].
pub const RARE: f64 = -6.0;

/// Log odds that one more effect is missing where one was found: 1 to 20.
pub const ONE_MORE: f64 = -3.0;

/// Log odds from which on an effect is named rather than not: 100 to 1.
pub const NAMED: f64 = 4.6;

/// The least share of its joint's torque that is worth a name.
pub const WORTH: f64 = 3e-3;

/// Two laws of one place that differ by less than this share of what all effects do there are one
/// to a user: the one met more often is named. Laws of friction are not better, so a further effect
/// that is smaller than this share of its joint's largest one has no name, unless every drive has
/// it.
pub const SAME: f64 = 0.1;

/// A rival within these log odds of what is named is reported beside it: less than what a name asks
/// for.
pub const RIVAL: f64 = 4.6;

/// Combinations of the model's own parameters that do less are left out: the sum of squares of what
/// one deviation does, over the level of noise. Data can have a hundredth of that level, and then
/// such a combination changes the evidence by 1e-3.
pub const LEAST_SHOWN: f64 = 1e-5;

/// Starts of an effect without amplitude whose slopes are looked at, the best ones.
pub const STARTS: usize = 8;

/// Candidates that are weighed whole after the first look, some more than ever were asked for, and
/// the nats below the best from which on none is.
pub const WEIGHED: usize = 16;
/// See [`WEIGHED`].
pub const FAR: f64 = 60.0;
/// The share of its gain that a law may lose in the first look, where it stands at one of its
/// starts and not at its best. Where that is more than [`FAR`], it counts. A spring lost a twelfth
/// in the case that showed it (foreign seed 709, spent); three times that is taken.
pub const FAR_SHARE: f64 = 0.25;

/// What a row beyond a limit costs for its side: where the model predicts the limit, 1 - log 2, and
/// where it says nothing, -log Phi(-1) - log 2.
pub const SIDE: [f64; 2] = [0.306_852_819_440_054_7, 1.147_874_464_449_318_4];

/// How far from all of it the share of what is left may be that was measured: a sensor's noise is
/// in what was measured alone, and a disturbance as far as a controller answers it, all or nothing.
pub const ANSWERED: f64 = 1.0;

/// What remains of the belief in small factors in a second first look: large effects are seen
/// beside the noise that they leave.
pub const UNBELIEVED: f64 = 1e-3;

/// Rounds in which variances are found, of candidates and of what is reported.
pub const ROUNDS: [usize; 2] = [8, 25];

/// Rounds in which curved parameters are linearised anew.
pub const LINEARISED: usize = 8;

/// The residual in slow bands beyond this many times the level of the faster ones has structure;
/// it is missing physics or a disturbance if more than a share of the torque, and than a share of
/// what was explained.
pub const FLAT: f64 = 1.5;
/// See [`FLAT`].
pub const LEFT: f64 = 8e-3;
/// See [`FLAT`]. A plain law may leave that share of what a finer one does.
pub const LEFT_OF_EXPLAINED: f64 = 0.35;

/// The least share of torque that an effect must do at one deviation to be looked at.
pub const LEAST_FELT: f64 = 1e-7;

/// Above this share of the torque, the residual says that model and logs are not of one robot.
pub const NOTHING_LIKE: f64 = 0.6;

/// Periods of a law that repeats along a joint, of what the logs cover of it, at least: less of one
/// is like any smooth law of the position. Laws that a torque takes part in are not asked.
pub const PERIODS: f64 = 1.5;

/// Above this share of the torque, and this many times the noise that sensors have, the residual is
/// no noise, however even its spectrum is.
pub const BROAD: f64 = 0.04;
/// See [`BROAD`].
pub const BROAD_OF_NOISE: f64 = 4.0;
