//! Why there is no limit cycle.

use std::fmt;

/// The constraint that is violated most.
#[derive(Clone, Debug, PartialEq)]
pub struct Violated {
    /// What it says.
    pub what: String,
    /// The phase.
    pub phase: String,
    /// Time since the beginning of the step \[s\].
    pub t_s: f64,
    /// By how much.
    pub residual: f64,
    /// In which unit.
    pub unit: &'static str,
}

/// Why a list of phases is no step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum NoStep {
    /// There are no phases.
    Empty,
    /// The robot flies in this phase: no contact is closed.
    Flight(usize),
    /// No contact of the swing foot closes.
    NoTouchdown,
    /// The stance foot never stands flat, so that nothing can be said of its stability.
    NeverFlat,
}

impl std::fmt::Display for NoStep {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Empty => write!(f, "a step has at least one phase"),
            Self::Flight(phase) => write!(f, "no contact is closed in phase {}", phase + 1),
            Self::NoTouchdown => write!(f, "the swing foot never touches the ground"),
            Self::NeverFlat => {
                write!(f, "in no phase the stance foot alone stands on heel and toe")
            }
        }
    }
}

/// Why there is no gait.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum DesignError {
    /// The plant is no planar walker; holds what it lacks.
    NoWalker(String),
    /// The phases are no step.
    NoStep(NoStep),
    /// The plant has no derivatives.
    NoDerivatives,
    /// No step meets all constraints.
    Infeasible(Violated),
    /// No gains keep the largest multiplier below its bound; holds the least that was found.
    Unstable(Option<f64>),
    /// The plan makes no references.
    Reference(denavit_plants::Error),
    /// The run of a plan cannot begin.
    Start(denavit_simulate::Error),
}

impl fmt::Display for DesignError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoWalker(lacks) => {
                write!(f, "the gait is one of planar walkers with two legs: there is no {lacks}")
            }
            Self::NoStep(error) => write!(f, "{error}"),
            Self::NoDerivatives => write!(f, "the plant has no derivatives of its dynamics"),
            Self::Infeasible(Violated { what, phase, t_s, residual, unit }) => write!(
                f,
                "no step meets all constraints: {what} is violated most, in phase `{phase}` at \
                 {t_s:.3} s, by {residual:.2e} {unit}"
            ),
            Self::Unstable(Some(least)) => write!(
                f,
                "no gains that were tried keep the largest multiplier below its bound; the least \
                 found is {least:.3}"
            ),
            Self::Unstable(None) => {
                write!(f, "with none of the gains that were tried the walk comes to a cycle")
            }
            Self::Reference(error) => write!(f, "{error}"),
            Self::Start(error) => write!(f, "{error}"),
        }
    }
}
