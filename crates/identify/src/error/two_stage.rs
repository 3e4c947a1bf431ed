//! Why a log does not give springs and load.

use std::fmt;

/// Why a log does not give the parameters.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum TwoStageError {
    /// No joint is behind a spring.
    NoSprings,
    /// The log has no such column.
    MissingColumn(String),
    /// The log cannot be conditioned.
    Condition(denavit_measure::Error),
    /// The motion does not tell these parameters apart; holds a joint, or the load.
    NotExcited(String),
    /// The gear ratio of an elastic drive is 0; holds the joint.
    NoDrive(String),
    /// A motor does not turn as its gear and its joint say.
    MotorAngle {
        /// The joint.
        joint: String,
        /// How far the motor turns, of how far it should.
        ratio: f64,
        /// The correlation of both.
        correlation: f64,
        /// What the column is to be multiplied with, and why, if a known mistake explains it.
        scale: Option<(f64, &'static str)>,
    },
    /// The torque of a motor is what a known mistake makes of the one that its inertia and the
    /// model's spring need.
    MotorTorque {
        /// The joint.
        joint: String,
        /// How large it is, of how large it should be.
        ratio: f64,
        /// What the column is to be multiplied with, and why.
        scale: (f64, &'static str),
    },
    /// The stiffness is not clearly above 0.
    NoStiffness {
        /// The joint.
        joint: String,
        /// What comes out, and its standard deviation [N/m].
        stiffness: [f64; 2],
    },
}

impl fmt::Display for TwoStageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::MissingColumn(column) => write!(f, "the log has no column `{column}`"),
            Self::NoSprings => write!(f, "the model has no series elastic drive"),
            Self::Condition(error) => write!(f, "{error}"),
            Self::NotExcited(what) => {
                write!(f, "the motion does not tell the parameters of {what} apart")
            }
            Self::NoDrive(joint) => write!(f, "the drive of `{joint}` has no gear ratio"),
            Self::MotorAngle { joint, ratio, correlation, scale } => {
                write!(
                    f,
                    "`motor_{joint}` turns {ratio:.4} times as far as gear and `q_{joint}` say \
                     (correlation {correlation:.2})"
                )?;
                match scale {
                    Some((scale, why)) => write!(
                        f,
                        "\n  hint: {why}? `logs.columns` with {{\"motor_{joint}\": {{\"scale\": \
                         {scale}}}}} mends that"
                    ),
                    None => write!(
                        f,
                        "\n  hint: it is the motor's angle before the gear [rad]; gear ratio and \
                         radii are those of the model"
                    ),
                }
            }
            Self::MotorTorque { joint, ratio, scale: (scale, why) } => write!(
                f,
                "`tau_cmd_{joint}` is {ratio:.4} times what the inertia of the motor and the \
                 spring of the model need\n  hint: {why}? `logs.columns` with \
                 {{\"tau_cmd_{joint}\": \
                 {{\"scale\": {scale}}}}} mends that; or write a stiffness \
                 near the true one into the model"
            ),
            Self::NoStiffness { joint, stiffness: [value, std] } => write!(
                f,
                "the spring of `{joint}` comes out as {value:.5e} +- {std:.1e} N/m: no spring \
                 is seen\n  hint: its elongation must be large against the steps of the encoders \
                 `motor_{joint}` and `q_{joint}`"
            ),
        }
    }
}
