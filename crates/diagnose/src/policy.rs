//! The numbers that decide what is reported of what was found, each with its unit and where it is
//! from: those of each module.

/// `columns.rs`: Columns that are other ones than they are taken for.
pub(crate) mod columns {
    /// The range of a position below which its joint rests [rad, m]: steps of the finest encoders.
    pub(crate) const AT_REST: f64 = 1e-6;
}

/// `candidate.rs`: What may be missing: an effect of the catalogue in one place of the robot.
pub(crate) mod candidate {
    /// Where a position that may be anywhere is looked for first, as shares of a joint's range.
    pub(crate) const PLACES: [f64; 13] =
        [0.02, 0.06, 0.12, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.88, 0.94, 0.98];

    /// Where a limit of torques is looked for first, as shares of the largest.
    pub(crate) const LIMITS: [f64; 20] = [
        0.99, 0.97, 0.94, 0.9, 0.85, 0.8, 0.74, 0.68, 0.61, 0.54, 0.46, 0.38, 0.31, 0.25, 0.2,
        0.16, 0.13, 0.1, 0.07, 0.05,
    ];
}

/// `data.rs`: Logs with the nominal model's rows: all that is asked of them, weighted and stacked.
pub(crate) mod data {
    /// How far the zero of a spring's deflection may be off: where none is stated the logs say it
    /// [rad, m].
    pub(crate) const SPRING_ZERO: f64 = 1.0;
}

/// `drive_law.rs`: What is between a drive, whose torque is logged, and its joint, whose position
/// is.
pub(crate) mod drive_law {
    /// The share of a drive's torque that must be load: what a drive takes for itself a rotor that
    /// moves otherwise would explain, and noise tells the sides of a smaller one.
    pub(crate) const LEAST_LOAD: f64 = 0.2;

    /// The share of the load (root mean square) below which the sides of a play do not touch.
    pub(crate) const TOUCHES: f64 = 0.05;

    /// Deviations of the load's noise that must be less than that.
    pub(crate) const OF_NOISE: f64 = 4.0;

    /// The share that must be passed on of what a transmission that hardly gives way would: one
    /// that passes nothing on leaves nothing to compare, which explains nothing.
    pub(crate) const LEAST_PASSED: f64 = 0.7;

    /// By which share of its size a parameter is moved for a difference: the side of friction
    /// changes in steps.
    pub(crate) const DIFFERENCE: f64 = 0.02;
}

/// `excitation.rs`: What logs would have shown: an answer that nothing is missing says no more
/// than that.
pub(crate) mod excitation {
    /// An effect that is more of the torque than this should be seen.
    pub(crate) const LARGE: f64 = 0.5;

    /// A joint that covers less of its limits is at rest: what grows with position or speed is
    /// small.
    pub(crate) const LEAST_RANGE: f64 = 0.05;

    /// Errors of this share of a torque say that nothing is seen.
    pub(crate) const NEVER: f64 = 1e3;
}

/// `floor.rs`: The noise floor: what no model can explain, because it does not repeat.
pub(crate) mod floor {
    /// Laps that differ by so many times their noise do not repeat.
    pub(crate) const UNREPEATABLE: f64 = 3.0;

    /// The least share of a torque that its floor is taken to be: logs without noise have digits.
    pub(crate) const LEAST: f64 = 1e-6;
}

/// `followed.rs`: What motors before springs do where joints follow a motion: they are ahead by
/// what springs must pass on.
pub(crate) mod followed {
    /// What of the largest deflection may still change where laws beside a spring are settled.
    pub(crate) const SETTLED: f64 = 1e-6;
}

/// `joint_law.rs`: Effects of the catalogue as laws on the torques of a robot's joints.
pub(crate) mod joint_law {
    /// A drive that lacks more than this share of what was demanded does not give what was
    /// demanded.
    pub(crate) const ALL_GIVEN: f64 = 0.02;

    /// What a drive lacks is more than so many times the noise of the torque: a clip of noise
    /// would make a log look better, whatever is demanded.
    pub(crate) const OF_NOISE: f64 = 4.0;

    /// By which share of a parameter's size it is moved for a difference.
    pub(crate) const DIFFERENCE: f64 = 1e-4;
}

/// `known.rs`: What the rows of a joint tell of its torque at velocity reversals and rests of its
/// drive.
pub(crate) mod known {
    /// A velocity that is none but for its sign [rad/s, m/s].
    pub(crate) const CREEP: f64 = 1e-9;

    /// The share of an event that the filter rings with beside it.
    pub(crate) const RINGING: f64 = 0.3;
}

/// `nominal.rs`: What the model says, and how sure it is of it.
pub(crate) mod nominal {
    /// How far numbers of bodies may be off where the model says nothing of that, as a share of
    /// their value.
    pub(crate) const BODY: f64 = 0.05;

    /// The same of friction, rotors, offsets and springs, which are known from measurements alone.
    pub(crate) const JOINT: f64 = 1.0;
}

/// `signals.rs`: Logs as the diagnosis looks at them: motion at the full sampling rate, torques
/// through one filter.
pub(crate) mod signals {
    /// Rows in a period of the cutoff: what the filter passes is below half their sampling rate.
    pub(crate) const ROWS_PER_PERIOD: f64 = 2.5;

    /// Rows of a log, at least: some for each band of frequencies.
    pub(crate) const LEAST_ROWS: usize = 32;

    /// Rows on either side of a log's middle beyond which rows at its ends are spared.
    pub(crate) const ENOUGH_ROWS: usize = 32;

    /// The sampling rate of laws \[Hz\], at least: a step of friction is not at a sample, and the
    /// mean of a cell knows where it is.
    pub(crate) const LEAST_RATE_HZ: f64 = 1000.0;
}

/// `standstill.rs`: Where a drive rests between two motions.
pub(crate) mod standstill {
    /// Steps that a drive may creep by while it rests: its encoder turns between two readings, and
    /// friction gives way before it slides.
    pub(crate) const CREEPS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

    /// What a drive moves in the time of its rest, before and after it, over what it creeps by: a
    /// parabola moves by 8.
    pub(crate) const LEAVES: f64 = 30.0;

    /// Steps from which on a reading is another one.
    pub(crate) const ANOTHER: f64 = 0.5;

    /// What is one step of readings, for rounding.
    pub(crate) const SAME: f64 = 1.01;

    /// The share of friction while it slides from which on a drive at rest may slide.
    pub(crate) const SLIDES: f64 = 0.9;

    /// The power of time with which a drive leaves: 3 if its inertia is all that matters, 2 if
    /// what opposes its velocity is, or if friction falls when it leaves.
    pub(crate) const POWER: f64 = 2.5;

    /// Steps that a drive moves before a reading of it changes, in the mean.
    pub(crate) const UNSEEN: f64 = 0.25;
}

/// `state.rs`: A model with the effects that it has so far, fitted to the logs for training and
/// judged with others.
pub(crate) mod state {
    /// Entries of z that are further from 0 say that the model's own numbers are off by more than
    /// it states. Experiments, and parameters of effects that the model has, do not go beyond.
    pub(crate) const MOST_Z: f64 = 3.0;

    /// Periods of the cutoff of torques in which what is left is like itself: the filter makes one.
    pub(crate) const ALIKE_PERIODS: f64 = 2.0;
}

/// `structure.rs`: What no effect explains, as a formula without a name: a few terms of a general
/// library that explain most of what a joint leaves, judged by held-out logs.
pub(crate) mod structure {
    /// The least share of squares of held-out logs that a term must explain.
    pub(crate) const LEAST_SHARE: f64 = 0.05;
}

/// `verdict.rs`: The answer in one word, and why.
pub(crate) mod verdict {
    /// The share of squares that are left which counts, below which most of it tells nothing.
    pub(crate) const UNTOLD: f64 = 0.5;

    /// Weight and inertia over the torque, from where on it is a small difference: errors of a
    /// tenth are a third of it. It is put between pendulums of 2.2 and of 4 to 6; arms have 1.
    pub(crate) const CANCELLED: f64 = 3.0;
}

/// `span.rs`: What effects can do, whatever their factors are.
pub(crate) mod span {
    /// Columns that are independent have at least this share of the largest singular value.
    pub(crate) const RANK: f64 = 1e-6;
}

/// `regime.rs`: Where in the motion torques disagree.
pub(crate) mod regime {
    /// By how much the share of the squared residual in a regime must exceed that of the time to be
    /// reported.
    pub(crate) const TOLD: f64 = 0.15;

    /// From this share of the largest torque on, a torque is at its limit if it does not change:
    /// by less than the other one.
    pub(crate) const AT_EXTREME: f64 = 0.97;

    /// See [`AT_EXTREME`].
    pub(crate) const AT_REST: f64 = 0.01;

    /// Shares of the largest velocity, acceleration or load below which a motion is slow in words,
    /// and above which it is fast, hard or heavy.
    pub(crate) const SLOW: f64 = 0.1;

    /// See [`SLOW`].
    pub(crate) const MUCH: f64 = 0.6;
}
