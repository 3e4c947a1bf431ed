//! Why a motion cannot go on, and how a run ended.

use super::contact::{ContactFailure, Friction};
use std::fmt;

/// Why the equations of motion have no answer at some time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Breakdown {
    /// The mass matrix is not positive definite: a massless part, or a singular base pose.
    Singular {
        /// The coordinate at which its factorisation failed.
        coordinate: usize,
    },
    /// A floating base stands where its coordinates are singular: its roll is a quarter turn.
    SingularPose,
    /// A torque, a state or a rate is not finite.
    NotFinite,
    /// The contacts have no forces, or no impulses.
    Contact(ContactFailure),
    /// A slipping contact has no force that obeys Coulomb's law (Painleve 1895).
    Painleve,
    /// The step that the accuracy asks for is below what time resolves.
    StepTooSmall,
}

impl fmt::Display for Breakdown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Singular { coordinate } => {
                write!(f, "the mass matrix is singular at coordinate {}", coordinate + 1)
            }
            Self::SingularPose => {
                write!(
                    f,
                    "the base has rolled by a quarter turn, where its coordinates are singular"
                )
            }
            Self::NotFinite => write!(f, "a torque or a velocity is not finite"),
            Self::Contact(failure) => write!(f, "{failure}"),
            Self::Painleve => {
                write!(f, "a slipping contact jams: no force obeys Coulomb's law (Painleve)")
            }
            Self::StepTooSmall => write!(f, "the steps became shorter than time resolves"),
        }
    }
}

impl std::error::Error for Breakdown {}

/// Why a run ended.
#[derive(Clone, Debug, PartialEq)]
pub enum Stop {
    /// The end time is reached.
    End,
    /// A point that must not touch the ground did; holds its name.
    Fall(String),
    /// As many events happened as are allowed.
    EventLimit,
    /// As many evaluations were made as are allowed.
    EvaluationLimit,
    /// Events follow each other without end.
    Zeno,
    /// Who watched asked for no more.
    Watcher,
    /// The equations have no answer.
    Breakdown(Breakdown),
}

impl Stop {
    /// One word for logs and JSON.
    pub fn word(&self) -> &'static str {
        match self {
            Self::End => "end",
            Self::Fall(_) => "fall",
            Self::EventLimit => "event_limit",
            Self::EvaluationLimit => "evaluation_limit",
            Self::Zeno => "zeno",
            Self::Watcher => "watcher",
            Self::Breakdown(breakdown) => match breakdown {
                Breakdown::Singular { .. } | Breakdown::SingularPose => "singular",
                Breakdown::NotFinite => "not_finite",
                Breakdown::Contact(_) => "no_solution",
                Breakdown::Painleve => "painleve",
                Breakdown::StepTooSmall => "step_too_small",
            },
        }
    }
}

impl Stop {
    /// What may help where the equations have no answer, with this law of friction.
    pub fn hint(&self, friction: Friction) -> Option<&'static str> {
        let Self::Breakdown(breakdown) = self else { return None };
        Some(match (breakdown, friction) {
            (Breakdown::Contact(_), Friction::NoSlip) => {
                "a finite `friction`, or a `fallback_friction`, lets contacts slip"
            }
            (Breakdown::Painleve | Breakdown::Contact(_), _) => {
                "less `friction`, or the scheme `time_stepping`, which jams with an impulse"
            }
            (Breakdown::SingularPose, _) => {
                "lay the base frame into the robot so that it rolls less"
            }
            (Breakdown::StepTooSmall, _) => {
                "the scheme `time_stepping` resolves no such transients"
            }
            (Breakdown::Singular { .. } | Breakdown::NotFinite, _) => return None,
        })
    }
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::End => write!(f, "reached the end"),
            Self::Fall(point) => write!(f, "fell: `{point}` touched the ground"),
            Self::EventLimit => write!(f, "stopped at the limit of events"),
            Self::EvaluationLimit => write!(f, "stopped at the limit of evaluations"),
            Self::Zeno => write!(f, "stopped: events follow each other without end"),
            Self::Watcher => write!(f, "stopped: who watched asked for no more"),
            Self::Breakdown(breakdown) => write!(f, "stopped: {breakdown}"),
        }
    }
}
