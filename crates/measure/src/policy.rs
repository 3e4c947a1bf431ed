//! The numbers that decide what is said of logs, each with its unit and where it is from: those of
//! each module.

/// Of `condition/derivatives.rs`.
pub(crate) mod derivatives {
    /// By how much a factor may differ from 1,
    pub(crate) const FACTOR: f64 = 0.1;

    /// and by which share of its size what a delay makes of a column.
    pub(crate) const DELAY: f64 = 0.1;

    /// Noise of positions that is a larger share of a derivative's variance leaves nothing to
    /// compare.
    pub(crate) const NOISE: f64 = 0.1;
}

/// Of `condition/laps.rs`.
pub(crate) mod laps {
    /// The share of a signal's variance by which laps may differ.
    pub(crate) const REPEATS: f64 = 0.02;

    /// The fewest samples of a lap.
    pub(crate) const FEWEST: f64 = 8.0;

    /// Change of a period, in samples, that is none.
    pub(crate) const SETTLED: f64 = 1e-9;

    /// Samples that a period may lack in digits.
    pub(crate) const DIGITS: f64 = 0.99;

    /// Joints whose variance is a smaller share of the largest one do not say whether laps repeat.
    pub(crate) const MOVES: f64 = 1e-4;

    /// The misfit of laps, over that of unrelated ones, above which a motion has left where it
    /// was.
    pub(crate) const LEFT_BY_LAP: f64 = 0.2;

    /// The share of a log that is compared with itself, at most.
    pub(crate) const COMPARED: f64 = 0.9;
}

/// Of `condition/noise.rs`.
pub(crate) mod noise {
    /// Variances of differences of white noise of variance 1: of this order, and of the one below.
    pub(crate) const GAINS: [f64; 2] = [924.0, 252.0];

    /// What white noise has of the ratio of these, at least: differences of a smooth signal become
    /// smaller with each order.
    pub(crate) const WHITE: f64 = 0.9;

    /// A joint moves if its velocity is more than so many times what noise makes of one,
    pub(crate) const VELOCITY: f64 = 2.0;

    /// or its position goes further from its mean than so many times its noise.
    pub(crate) const POSITION: f64 = 3.0;

    /// What rounding makes of a position.
    pub(crate) const ROUNDING: f64 = 1e-10;
}

/// Of `condition/overlap.rs`.
pub(crate) mod overlap {
    /// What two readings of one measurement differ by, of the spread of positions and the size of
    /// torques: digits. Torques that were measured twice differ by their noise.
    pub(crate) const SAME: f64 = 1e-3;

    /// The least overlap of logs that say little more than one, of the samples of the shorter log,
    pub(crate) const OVERLAP: f64 = 0.3;

    /// and of a log that does not judge the other one.
    pub(crate) const PART: f64 = 0.05;

    /// The spread of a position in the overlap, of that in the log, that at least one joint has.
    pub(crate) const MOVES: f64 = 0.1;
}

/// Of `condition/stretch.rs`.
pub(crate) mod stretch {
    /// What the rest of a log may change in a stretch, as a share of its signals: some hundred
    /// roundings, so that pieces have the numbers of the whole.
    pub(crate) const FORGOTTEN: f64 = 1e-13;
}

/// Of `condition/reversals.rs`.
pub(crate) mod reversals {
    /// Samples that are left within which a decimated one has nearly all of its weight.
    pub(crate) const WEIGHED: f64 = 2.5;

    /// Deviations of a velocity's noise below which its sign is not known, and steps of its encoder
    /// in a period of the filter's cutoff.
    pub(crate) const NOISE: f64 = 3.0;

    /// See [`NOISE`].
    pub(crate) const STEPS: f64 = 2.0;

    /// The share of its usual velocity, root of mean square, below which a joint stands still.
    pub(crate) const STILL: f64 = 1e-4;
}

/// Of `log/check.rs`.
pub(crate) mod check {
    /// A step of the time from which on it hardly counts seconds.
    pub(crate) const SLOWEST_STEP_S: f64 = 0.1;

    /// A step of the time below which it hardly counts seconds: a millisecond in days is 1e-8, and
    /// no loop of a drive has a sampling rate of a megahertz.
    pub(crate) const FASTEST_STEP_S: f64 = 1e-6;

    /// Seconds in an hour.
    pub(crate) const HOUR_S: f64 = 3600.0;

    /// A turning joint without limits hardly goes further \[rad\]: ten turns. In degrees most
    /// motions do. Of less the torques tell the unit.
    pub(crate) const LARGEST_ANGLE_RAD: f64 = 63.0;

    /// Changes of a torque below this are rounding [N m, N].
    pub(crate) const ROUNDING: f64 = 1e-12;

    /// Times its limit that a torque goes to if the limits of a trajectory are the model's.
    pub(crate) const FAR_BEYOND: f64 = 3.0;

    /// Two signals that are one.
    pub(crate) const SAME: f64 = 0.98;

    /// Two signals that are not one.
    pub(crate) const OTHER: f64 = 0.7;

    /// The share of its samples in which a torque has its extreme value to be reported as one that
    /// saturates.
    pub(crate) const SATURATED: f64 = 2e-3;

    /// By how much a difference of positions may be off whole steps of an encoder, in steps, and
    /// of so many steps at most: digits of the log make more of more.
    pub(crate) const WHOLE: f64 = 0.02;

    /// See [`WHOLE`].
    pub(crate) const MOST_STEPS: f64 = 1e5;

    /// Steps of an encoder are larger than rounding of the log by this much, and so many
    /// differences are multiples of them.
    pub(crate) const ABOVE_ROUNDING: f64 = 20.0;

    /// See [`ABOVE_ROUNDING`].
    pub(crate) const IN_STEPS: f64 = 0.995;

    /// The last printed digit over a step of an encoder, at most: two of five differences of that
    /// size are near a multiple by chance, and not nearly all.
    pub(crate) const DIGIT: f64 = 0.2;

    /// By how much whole digits and positions may be off, for rounding,
    pub(crate) const ROUNDED: f64 = 1e-9;

    /// and positions in single precision: half of their last binary digit.
    pub(crate) const SINGLE: f64 = 6e-8;
}

/// Of `log/fault.rs`.
pub(crate) mod fault {
    /// The step of a time below which it may count longer parts of a second than milliseconds.
    pub(crate) const LONGER_PARTS: f64 = 1.0;
}

/// Of `log/jumps.rs`.
pub(crate) mod jumps {
    /// The least jump, over the range of the position, over its smallest step, and over the steps
    /// of the samples about it.
    pub(crate) const OF_RANGE: f64 = 2e-3;

    /// See [`OF_RANGE`].
    pub(crate) const OF_STEP: f64 = 10.0;

    /// See [`OF_RANGE`].
    pub(crate) const OF_NEIGHBOURS: f64 = 5.0;
}

/// Of `log/mod.rs`.
pub(crate) mod log {
    /// What no position, velocity, torque or force of a robot reaches, in its SI unit.
    pub(crate) const LARGEST: f64 = 1e12;

    /// The same of times \[s\], which may count from any beginning, in any unit.
    pub(crate) const LARGEST_TIME: f64 = 1e20;
}

/// Of `log/repair.rs`.
pub(crate) mod repair {
    /// The share of samples that may be missing.
    pub(crate) const MAX_MISSING: f64 = 0.02;

    /// Scatter of sample distances, over their median, from which on samples are interpolated.
    pub(crate) const RESAMPLED_JITTER: f64 = 0.01;

    /// Scatter from which on derivatives mean nothing.
    pub(crate) const MAX_JITTER: f64 = 0.3;
}
