//! Why there is no answer about a walk.

mod balance;
mod cycle;
mod design;
mod plan;
mod posture;

pub(crate) use balance::BalanceError;
pub(crate) use cycle::CycleError;
pub use design::Violated;
pub(crate) use design::{DesignError, NoStep};
pub(crate) use plan::PlanError;
pub(crate) use posture::PostureError;

use denavit_simulate::LogFaults;
use std::fmt;

/// Why there is no answer. [`Error::hint`] says what may help.
#[derive(Clone, Debug, PartialEq)]
pub struct Error(Box<Cause>);

/// What kind of reason it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The robot is none that walks so: what it lacks is said.
    Robot,
    /// A log is wrong; [`Error::log_faults`] has all that is.
    Log,
    /// What is asked for does not go together, or is more than is done.
    Options,
    /// A place of feet and body has no joint positions; [`Error::residual`] is what is left.
    OutOfReach,
    /// A joint would be beyond its limit; [`Error::joint`] has it.
    Limit,
    /// A foot or a body would touch, or slide along, what it must not.
    Collision,
    /// A point is not inside the support polygon by the margin that is asked for.
    Margin,
    /// The last posture is none that the first can follow.
    NotClosed,
    /// No step meets all constraints; [`Error::violated`] is the one that is violated most.
    Infeasible,
    /// No gains make the walk stable.
    Unstable,
    /// A reference does not repeat itself, or the run does not come back.
    NoCycle,
    /// An iteration does not settle, or first-order changes say nothing.
    NotSettled,
    /// A run does not begin.
    NotStarted,
    /// A run stopped before its end.
    Stopped,
}

/// What is wrong.
#[derive(Clone, Debug, PartialEq)]
enum Cause {
    Plan(PlanError),
    Design(DesignError),
    Cycle(CycleError),
    Balance(BalanceError),
    Posture(PostureError),
    /// A limit that is not usable; holds its name and value.
    Limit(&'static str, f64),
}

impl Error {
    /// A limit of a robot that is not usable: its name and value.
    pub(crate) fn limit(name: &'static str, value: f64) -> Self {
        Self(Box::new(Cause::Limit(name, value)))
    }

    /// What kind of reason it is.
    pub fn kind(&self) -> ErrorKind {
        match &*self.0 {
            Cause::Plan(error) => of_plan(error),
            Cause::Design(error) => of_design(error),
            Cause::Cycle(error) => of_cycle(error),
            Cause::Balance(error) => of_balance(error),
            Cause::Posture(PostureError::Count { .. }) | Cause::Limit(..) => ErrorKind::Options,
            Cause::Posture(PostureError::OutOfReach { .. }) => ErrorKind::OutOfReach,
        }
    }

    /// What may help with a plan of a gait.
    pub fn hint(&self) -> Option<&'static str> {
        match &*self.0 {
            Cause::Plan(error) => Some(error.hint()),
            _ => None,
        }
    }

    /// What is wrong with the gait of a scenario.
    pub(crate) fn of_gait(&self) -> denavit_simulate::scenario::Cause {
        let hint = self.hint().expect("what is wrong with a plan has a hint");
        denavit_simulate::scenario::Cause::Gait(self.to_string(), hint)
    }

    /// The posture, or the phase, of a plan that is at fault, with its time \[s\].
    pub fn posture(&self) -> Option<(&str, f64)> {
        match &*self.0 {
            Cause::Plan(error) => error.posture(),
            _ => None,
        }
    }

    /// The joint that is at fault.
    pub fn joint(&self) -> Option<&str> {
        match &*self.0 {
            Cause::Plan(PlanError::Limit { joint, .. })
            | Cause::Cycle(CycleError::NotPeriodic(joint)) => Some(joint),
            _ => None,
        }
    }

    /// The largest error that is left of conditions [m, rad].
    pub fn residual(&self) -> Option<f64> {
        match &*self.0 {
            Cause::Plan(
                PlanError::OutOfReach { residual, .. } | PlanError::Between { residual, .. },
            )
            | Cause::Posture(PostureError::OutOfReach { residual })
            | Cause::Cycle(CycleError::NotFound(residual)) => Some(*residual),
            _ => None,
        }
    }

    /// The constraint that is violated most.
    pub fn violated(&self) -> Option<&Violated> {
        match &*self.0 {
            Cause::Design(DesignError::Infeasible(violated)) => Some(violated),
            _ => None,
        }
    }

    /// All that is wrong with a log.
    pub fn log_faults(&self) -> Option<&LogFaults> {
        match &*self.0 {
            Cause::Balance(BalanceError::Log(faults)) => Some(faults),
            _ => None,
        }
    }
}

fn of_plan(error: &PlanError) -> ErrorKind {
    match error {
        PlanError::NoWalker(_) | PlanError::NoBiped(_) => ErrorKind::Robot,
        PlanError::Undetermined { .. }
        | PlanError::Overlap { .. }
        | PlanError::TooManyKnots(_)
        | PlanError::Curve(_) => ErrorKind::Options,
        PlanError::Collision { .. } | PlanError::Fallen { .. } | PlanError::Slides { .. } => {
            ErrorKind::Collision
        }
        PlanError::OutOfReach { .. } | PlanError::Between { .. } => ErrorKind::OutOfReach,
        PlanError::Limit { .. } => ErrorKind::Limit,
        PlanError::Margin { .. } => ErrorKind::Margin,
        PlanError::NotClosed { .. } => ErrorKind::NotClosed,
    }
}

fn of_design(error: &DesignError) -> ErrorKind {
    match error {
        DesignError::NoWalker(_) | DesignError::NoDerivatives => ErrorKind::Robot,
        DesignError::NoStep(_) | DesignError::Reference(_) => ErrorKind::Options,
        DesignError::Infeasible(_) => ErrorKind::Infeasible,
        DesignError::Unstable(_) => ErrorKind::Unstable,
        DesignError::Start(_) => ErrorKind::NotStarted,
    }
}

fn of_cycle(error: &CycleError) -> ErrorKind {
    match error {
        CycleError::Start(_) => ErrorKind::NotStarted,
        CycleError::Stopped(..) => ErrorKind::Stopped,
        CycleError::HiddenStates | CycleError::Pushed | CycleError::NoClock => ErrorKind::Options,
        CycleError::NoEvent(_)
        | CycleError::NotFound(_)
        | CycleError::NotPeriodic(_)
        | CycleError::NoStrike(_) => ErrorKind::NoCycle,
        CycleError::Variation(_) | CycleError::Multipliers => ErrorKind::NotSettled,
    }
}

fn of_balance(error: &BalanceError) -> ErrorKind {
    match error {
        BalanceError::Log(_) => ErrorKind::Log,
        BalanceError::TooMany(..) => ErrorKind::Options,
        BalanceError::NotWalking | BalanceError::Singular(_) => ErrorKind::Robot,
        BalanceError::Start(_) => ErrorKind::NotStarted,
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &*self.0 {
            Cause::Plan(error) => write!(f, "{error}"),
            Cause::Design(error) => write!(f, "{error}"),
            Cause::Cycle(error) => write!(f, "{error}"),
            Cause::Balance(error) => write!(f, "{error}"),
            Cause::Posture(error) => write!(f, "{error}"),
            Cause::Limit(name, value) => write!(f, "the {name} cannot be {value}"),
        }
    }
}

impl std::error::Error for Error {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match &*self.0 {
            Cause::Plan(PlanError::Curve(error)) => Some(error),
            Cause::Design(DesignError::Reference(error)) => Some(error),
            Cause::Design(DesignError::Start(error))
            | Cause::Cycle(CycleError::Start(error))
            | Cause::Balance(BalanceError::Start(error)) => Some(error),
            Cause::Cycle(CycleError::Variation(error)) => Some(error),
            _ => None,
        }
    }
}

macro_rules! causes {
    ($($error:ident: $cause:ident),*) => {
        $(impl From<$error> for Error {
            fn from(error: $error) -> Self {
                Self(Box::new(Cause::$cause(error)))
            }
        })*
    };
}

causes!(
    PlanError: Plan,
    DesignError: Design,
    CycleError: Cycle,
    BalanceError: Balance,
    PostureError: Posture
);

/// The knots of a plan make no curve.
impl From<denavit_plants::Error> for Error {
    fn from(error: denavit_plants::Error) -> Self {
        PlanError::Curve(error).into()
    }
}
