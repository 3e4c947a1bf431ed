//! Why there is no plan of a gait.

use std::fmt;

/// Why there is no plan; what is named is at fault.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum PlanError {
    /// The plant is no planar walker with two legs that are alike; holds what it lacks.
    NoWalker(String),
    /// The plant is no robot in space with two legs; holds what it lacks.
    NoBiped(String),
    /// Feet, weight and torso do not say where all coordinates are.
    Undetermined {
        /// Number of conditions.
        conditions: usize,
        /// Number of coordinates.
        coordinates: usize,
    },
    /// A foot would be on the other one.
    Collision {
        /// The phase.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
    },
    /// A posture has no joint positions.
    OutOfReach {
        /// The posture, or the phase.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
        /// The largest error of a condition at the best joint positions found [m, rad].
        residual: f64,
    },
    /// A posture needs a joint beyond its limit.
    Limit {
        /// The posture, or the phase.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
        /// The joint.
        joint: String,
        /// Where it would be [rad, m].
        value: f64,
        /// Its limits [rad, m].
        limits: [f64; 2],
    },
    /// A posture has a body in the ground that must not touch it.
    Fallen {
        /// The posture, or the phase.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
        /// The body.
        body: String,
        /// Its height above the ground \[m\].
        height_m: f64,
    },
    /// Between two knots the joined curves leave what is asked for.
    Between {
        /// The phase.
        posture: String,
        /// The time \[s\].
        t_s: f64,
        /// The largest error of a condition [m, rad].
        residual: f64,
    },
    /// The centre of mass, or the planned centre of pressure, is not inside the support polygon by
    /// the margin that is asked for.
    Margin {
        /// The point.
        point: &'static str,
        /// The posture, or the phase.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
        /// The margin; negative outside \[m\].
        margin_m: f64,
        /// What is asked for \[m\].
        least_m: f64,
    },
    /// The last posture is not one after which the first can follow with the legs swapped.
    NotClosed {
        /// The last posture.
        posture: String,
        /// Where the swing foot is there, from the stance ankle: forward, up \[m\].
        foot_m: [f64; 2],
        /// Where it has to be \[m\].
        expected_m: [f64; 2],
    },
    /// A foot moves along the ground from a posture to the next.
    Slides {
        /// The second of the two.
        posture: String,
        /// Its time \[s\].
        t_s: f64,
        /// By how much \[m\].
        distance_m: f64,
    },
    /// Phases that overlap: double support takes at least the whole step.
    Overlap {
        /// \[s\].
        double_support_s: f64,
        /// \[s\].
        step_s: f64,
    },
    /// The plan would have more knots than this.
    TooManyKnots(usize),
    /// The knots make no curve.
    Curve(denavit_plants::Error),
}

impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoWalker(lacks) => {
                write!(f, "the gait is one of planar robots with two legs: there is no {lacks}")
            }
            Self::NoBiped(lacks) => {
                write!(f, "the gait is one of robots in space with two legs: there is no {lacks}")
            }
            Self::Undetermined { conditions, coordinates } => write!(
                f,
                "{conditions} conditions, of feet, weight and torso, do not determine \
                 {coordinates} coordinates"
            ),
            Self::Collision { posture, t_s } => {
                write!(f, "`{posture}` at {t_s:.3} s: a foot is on the other one")
            }
            Self::OutOfReach { posture, t_s, residual } => write!(
                f,
                "`{posture}` at {t_s:.3} s is out of reach: inverse kinematics leaves a residual \
                 of {residual:.2e}"
            ),
            Self::Limit { posture, t_s, joint, value, limits: [low, high] } => write!(
                f,
                "`{posture}` at {t_s:.3} s needs `{joint}` at {value:.4}; its limits are {low} \
                 and {high}"
            ),
            Self::Fallen { posture, t_s, body, height_m } => write!(
                f,
                "`{posture}` at {t_s:.3} s has `{body}`, which must not touch the ground, \
                 {:.1} mm below it",
                -1e3 * height_m
            ),
            Self::Between { posture, t_s, residual } => write!(
                f,
                "`{posture}` at {t_s:.3} s: curves between two knots leave a residual of \
                 {residual:.2e}"
            ),
            Self::Margin { point, posture, t_s, margin_m, least_m } => {
                let millimetres = 1e3 * margin_m.abs();
                let side = if *margin_m < 0.0 { "outside" } else { "inside" };
                write!(
                    f,
                    "`{posture}` at {t_s:.3} s: the {point} is {millimetres:.1} mm {side} the \
                     support polygon, where a margin of {:.1} mm is asked for",
                    1e3 * least_m
                )
            }
            Self::NotClosed { posture, foot_m: [x, z], expected_m: [ahead, up] } => write!(
                f,
                "the last posture, `{posture}`, has its swing foot at [{x}, {z}] m from the \
                 stance ankle; for the first to follow with the legs swapped it has to be at \
                 [{ahead}, {up}] m"
            ),
            Self::Slides { posture, t_s, distance_m } => write!(
                f,
                "to `{posture}` at {t_s:.3} s the swing foot slides by {distance_m} m along the \
                 ground"
            ),
            Self::Overlap { double_support_s, step_s } => write!(
                f,
                "phases overlap: {double_support_s} s of double support in a step of {step_s} s"
            ),
            Self::TooManyKnots(most) => write!(f, "the plan would have more than {most} knots"),
            Self::Curve(error) => write!(f, "{error}"),
        }
    }
}

impl PlanError {
    /// The posture, or the phase, with its time \[s\].
    pub(crate) fn posture(&self) -> Option<(&str, f64)> {
        match self {
            Self::Collision { posture, t_s }
            | Self::OutOfReach { posture, t_s, .. }
            | Self::Limit { posture, t_s, .. }
            | Self::Fallen { posture, t_s, .. }
            | Self::Between { posture, t_s, .. }
            | Self::Margin { posture, t_s, .. }
            | Self::Slides { posture, t_s, .. } => Some((posture, *t_s)),
            Self::NoWalker(_)
            | Self::NoBiped(_)
            | Self::Undetermined { .. }
            | Self::NotClosed { .. }
            | Self::Overlap { .. }
            | Self::TooManyKnots(_)
            | Self::Curve(_) => None,
        }
    }

    /// What may help.
    pub(crate) fn hint(&self) -> &'static str {
        match self {
            Self::NoWalker(_) => {
                "joints and contact points are named right_.. and left_.., the base base_x, \
                 base_z, base_pitch"
            }
            Self::NoBiped(_) => {
                "joints and contact points are named right_.. and left_.., the base floats; at \
                 zero of all joints soles are level"
            }
            Self::Undetermined { .. } => "in space, two legs of six joints each are meant",
            Self::Collision { .. } => "place the feet farther apart, or turn by less in a step",
            Self::OutOfReach { .. } => "lower the hip, or shorten or lower the step",
            Self::Fallen { .. } => "a higher hip or centre of mass",
            Self::Between { .. } => "a smaller `interval_s`, a longer swing, or a lower step",
            Self::Limit { .. } => "another height of the hip, or a shorter or lower step",
            Self::Margin { .. } => "move the point over the foot that stands, or lower `margin_m`",
            Self::NotClosed { .. } => {
                "the swing foot is as far ahead in the last posture as it is behind in the first"
            }
            Self::Slides { .. } => "lift the foot in a posture between these",
            Self::Overlap { .. } => "a longer `step_s`, or a shorter `double_support_s`",
            Self::TooManyKnots(_) => "fewer steps, or a longer `interval_s`",
            Self::Curve(_) => "durations are positive",
        }
    }
}
