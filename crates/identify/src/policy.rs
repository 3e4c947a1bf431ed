//! The numbers that decide estimates and what is said of them, each with its unit and where it is
//! from: those of each module. Doubts have a table of their own.

/// Of `estimate/comparison.rs`.
pub(crate) mod comparison {
    /// An estimate is that of some logs if no parameter is further from what they say, in their
    /// standard errors.
    pub(crate) const APART: f64 = 3.0;
}

/// Of `estimate/consistent.rs`.
pub(crate) mod consistent {
    /// What a unit of change of a body's coordinates costs, in squared standard errors of the
    /// estimate: little, so that it decides only what the data leave open.
    pub(crate) const STAY: f64 = 1e-8;

    /// Weights of what entries of bodies fall short of, one after the other until nothing does.
    pub(crate) const BOUND_WEIGHTS: [f64; 4] = [1e2, 1e4, 1e6, 1e8];

    /// From so many standard errors on the search goes along the way from the nominal parameters to
    /// the estimate, in so many stages: where columns are products, what fits lies in valleys that
    /// are narrow and bent, and each stage begins at the bottom of one.
    pub(crate) const FAR: f64 = 2.0;
}

/// Of `estimate/contradiction.rs`.
pub(crate) mod contradiction {
    /// What own parameters explain must be this share of a joint's torque, as root of mean square,
    /// and so many times what they leave, which noise may have made them follow; where parts of
    /// the log do not say for how long that is alike, so many times,
    pub(crate) const OF_TORQUE: f64 = 0.03;

    /// See [`OF_TORQUE`].
    pub(crate) const OF_OWN: f64 = 0.5;

    /// See [`OF_TORQUE`].
    pub(crate) const OF_OWN_ALONE: f64 = 1.5;

    /// and this many times what chance explains with as many parameters, in variance.
    pub(crate) const OF_CHANCE: f64 = 25.0;

    /// and what noise of the positions makes of it, in variance: to follow that, parameters of a
    /// log's own are biased. That noise is known to a few times, since steps of an encoder may
    /// beat with the samples.
    pub(crate) const OF_BEATS: f64 = 10.0;

    /// What a constant or a factor leaves of the squares of what it is reported for, at most.
    pub(crate) const ALIKE: f64 = 0.25;
}

/// Of `estimate/errors.rs`.
pub(crate) mod errors {
    /// Sums of scores with neighbours counted half say as much as so many times fewer that are
    /// independent: 1 + 2 (1/2)^2.
    pub(crate) const NEIGHBOURS: f64 = 1.5;

    /// A larger share of what is known of a direction is taken for this one.
    pub(crate) const MOST_LEVERAGE: f64 = 0.95;
}

/// Of `estimate/held_out.rs`.
pub(crate) mod held_out {
    /// What is left must be this share of a joint's torque, as root of mean square,
    pub(crate) const OF_TORQUE: f64 = 0.05;

    /// so many times what all that is known explains, of which noise of the positions is known to
    /// a few times, in variance,
    pub(crate) const MANY: f64 = 5.0;

    /// See [`MANY`].
    pub(crate) const OF_NOISE: f64 = 4.0;

    /// and behind half the cutoff still so many times what that takes away of it, in variance:
    /// half of white noise is left there, and of noise whose band ends at a tenth of the cutoff
    /// twelve times what is taken.
    pub(crate) const OF_BAND: f64 = 25.0;
}

/// Of `estimate/half_cutoff.rs`.
pub(crate) mod half_cutoff {
    /// What a bias is, at most, of its change with half the cutoff: it grows with the 1.5th power
    /// of the cutoff or faster, 1 / (1 - 2^-1.5).
    pub(crate) const OF_CHANGE: f64 = 1.5;
}

/// Of `estimate/instruments.rs`.
pub(crate) mod instruments {
    /// The share of a joint's variance by which the positions of instruments differ, of those of
    /// another motion; and the least variance that says something, of the largest one.
    pub(crate) const OTHER: f64 = 0.25;

    /// See [`OTHER`].
    pub(crate) const MOVES: f64 = 1e-4;
}

/// Of `estimate/least_squares.rs`.
pub(crate) mod least_squares {
    /// The change of phi, in standard errors, that robust weights which creep may make at last.
    pub(crate) const MOVES_LITTLE: f64 = 0.1;

    /// Degrees of freedom of an error that is found from parts of logs, below which it says
    /// little: it is at least what the filter's correlation makes.
    pub(crate) const FEWEST_DEGREES: f64 = 3.0;
}

/// Of `estimate/left_out.rs`.
pub(crate) mod left_out {
    /// Deviations of a velocity's noise that are slow.
    pub(crate) const NOISE: f64 = 3.0;

    /// The bias of friction, in its standard errors, from which on rows are left out: an interval
    /// of 95 % that is off by so much holds in 92 %.
    pub(crate) const BIAS: f64 = 0.5;

    /// The least share of its rows that a joint keeps, or none near reversals are left out.
    pub(crate) const LEAST: f64 = 0.1;
}

/// Of `estimate/left_over.rs`.
pub(crate) mod left_over {
    /// Noise is another one after half a period of the filter's cutoff: the residual is still
    /// correlated with itself by so much if it is none.
    pub(crate) const NO_NOISE: f64 = 0.5;

    /// The share of a joint's torque from which on a residual that is no noise is reported.
    pub(crate) const SAID: f64 = 0.005;
}

/// Of `estimate/likelihood.rs`.
pub(crate) mod likelihood {
    /// The least share of the residual's variance that is taken for noise of the torque itself.
    pub(crate) const LEAST_TORQUE_SHARE: f64 = 0.05;
}

/// Of `estimate/report.rs`.
pub(crate) mod report {
    /// How much of a parameter may lie in directions that are not excited.
    pub(crate) const DEAD_SHARE: f64 = 1e-6;

    /// The bias from noise of the positions, in standard errors, from which on it is reported: an
    /// interval of 95 % that is off by so much holds in 92 %.
    pub(crate) const BIASING: f64 = 0.5;

    /// Deviations of a change that are hardly chance: a lower filter is tried.
    pub(crate) const LIKELY: f64 = 2.5;

    /// Those of one that is none, of any of dozens of parameters: it is reported.
    pub(crate) const SURE: f64 = 3.5;
}

/// Of `estimate/robust.rs`.
pub(crate) mod robust {
    /// The least mean of psi' over that of the weights: most residuals count at all.
    pub(crate) const LEAST_SLOPE: f64 = 0.1;

    /// Deviations beyond which a row counts less (Huber), or not at all (bisquare): 95 % of the
    /// efficiency of least squares with normal noise (Holland and Welsch 1977).
    pub(crate) const HUBER: f64 = 1.345;

    /// See [`HUBER`].
    pub(crate) const BISQUARE: f64 = 4.685;
}

/// Of `estimate/long/text.rs`.
pub(crate) mod long {
    /// What entries of a triangle are below: their squares are numbers.
    pub(crate) const LARGEST: f64 = 1e150;
}

/// Of `estimate/unexplained.rs`.
pub(crate) mod unexplained {
    /// The share of a joint's torque, as root of mean square, that must be left.
    pub(crate) const LEFT: f64 = 0.9;

    /// The share that must be left where it is no noise: noise is another one after half a period
    /// of the filter's cutoff, and the residual is still correlated with itself by so much.
    pub(crate) const LEFT_ALIKE: f64 = 0.3;

    /// See [`LEFT_ALIKE`].
    pub(crate) const ALIKE: f64 = 0.5;

    /// A joint that moves less than this share of the one of its kind that moves most is at rest:
    /// nothing but noise may be in its torque, and what stiction holds: at most so many times its
    /// Coulomb friction. Of what is no noise after a whole period this share must be left.
    pub(crate) const AT_REST: f64 = 0.01;

    /// See [`AT_REST`].
    pub(crate) const STICTION: f64 = 2.0;

    /// See [`AT_REST`].
    pub(crate) const LEFT_AT_REST: f64 = 0.03;
}

/// Of `estimate/weights.rs`.
pub(crate) mod weights {
    /// Change of phi, in standard errors, below which weights have settled.
    pub(crate) const SETTLED: f64 = 1e-3;

    /// The least share of its independent residuals that a log keeps.
    pub(crate) const LEAST_FREE: f64 = 1e-3;
}

/// Of `estimate/widening.rs`.
pub(crate) mod widening {
    /// Standard errors of a change that are no chance.
    pub(crate) const SURE: f64 = 2.0;

    /// The least share of its variance that a friction's change is taken to have.
    pub(crate) const LEAST: f64 = 1.0 / 16.0;
}

/// Of `identification.rs`.
pub(crate) mod identification {
    /// Periods of the filter's cutoff below which logs are short.
    pub(crate) const SHORT: f64 = 80.0;

    /// The share of a joint's torque in a log for validation that noise of its positions makes,
    /// from which on it needs a lower filter: more would hide a contradiction, or pass for one.
    pub(crate) const NOISY: f64 = 0.01;

    /// The share of a torque from which on it is reported what the filter makes of a motion that is
    /// too fast for it, if it is also this share of the residual.
    pub(crate) const SMEARED: [f64; 2] = [0.01, 0.3];

    /// The residual with the nominal parameters, over the torques, from which on the robot is
    /// another.
    pub(crate) const OTHER: f64 = 10.0;

    /// Standard errors between an estimate and the nearest physically consistent parameters from
    /// which on the log is doubted: good logs have next to none, mislabelled ones any number.
    pub(crate) const FAR: f64 = 20.0;
}

/// Of `idle.rs`.
pub(crate) mod idle {
    /// The deviation of a torque over that of the load, below which it does not follow it, if it
    /// is less like it than this: a torque in another unit follows all the same.
    pub(crate) const FOLLOWS: f64 = 0.1;

    /// See [`FOLLOWS`].
    pub(crate) const ALIKE: f64 = 0.7;

    /// The share of the squares of a torque below which its variance is rounding: a constant is
    /// like nothing.
    pub(crate) const ROUNDING: f64 = 1e-9;
}

/// Of `noisy_logs.rs`.
pub(crate) mod noisy_logs {
    /// The share of noise in what the motion shows of a direction of the parameters, from which on
    /// nothing is believed.
    pub(crate) const MOST: f64 = 0.5;

    /// What a log makes of a bias, of its part if all made the same, to be asked for a lower
    /// filter.
    pub(crate) const SHARE: f64 = 0.99;
}
