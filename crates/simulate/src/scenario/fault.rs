//! What can be wrong with a scenario: why, and what to do about it. Faults of form are those that
//! model files have too.

use super::ranges::{Range, short};
use crate::breakdown::Breakdown;
use crate::error::Error;
use crate::log_fault::PlacedLogFault;
use crate::start::StartError;
use denavit_codegen::model::{self, Explained, FileError};
use std::fmt;

/// Everything that is wrong with a scenario, in the order of the file.
pub type ScenarioError = FileError<Cause>;

/// What is wrong at a place.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// A fault of form: of JSON, of keys, of kinds of values.
    Form(model::Cause),
    /// The key `format` is missing; holds what it is to say.
    NoFormat(&'static str),
    /// A number outside its range.
    OutsideRange(f64, Range),
    /// A number that must be even.
    Odd,
    /// Something that would do nothing: what is missing for it.
    NoEffect(&'static str),
    /// A model and a cradle.
    TwoRobots,
    /// No joint has this name; holds it and the one that was meant, perhaps.
    UnknownJoint(String, Option<String>),
    /// No link has this name; holds it and the one that was meant, perhaps.
    UnknownLink(String, Option<String>),
    /// A push that is an impulse and a force.
    TwoShoves,
    /// A posture has no position of this joint.
    NoPosition(String),
    /// A joint of the floating base, which nothing drives.
    Undrivable(String),
    /// More rows of the log than there may be; holds the most.
    TooManyRows(f64),
    /// A log is wrong.
    Log(PlacedLogFault),
    /// Rows of a log are nearer in time than any that is written; holds their distance \[s\].
    RowsTooNear(f64),
    /// A log has no such column; holds it and the one that was meant, perhaps.
    UnknownColumn(String, Option<String>),
    /// A column of a log has an empty cell; holds it and the line.
    EmptyCell(String, usize),
    /// The gait cannot be planned; holds the reason and what may help.
    Gait(String, &'static str),
    /// A gait, where nothing plans gaits.
    NoPlanner,
    /// The run cannot begin.
    Start(Error),
    /// The mass matrix is singular at the start, at this joint.
    Singular(String),
    /// The torque on this joint is not finite at the start.
    TorqueNotFinite(String),
    /// A file that cannot be read; holds its name and the reason.
    File(String, String),
    /// The numbers make no reference.
    Reference(denavit_plants::Error),
    /// The model makes no plant.
    Plant(denavit_plants::Error),
    /// The model file is wrong; holds what its reader says.
    Model(String),
    /// The trajectory file is wrong; holds what its reader says.
    Trajectory(String),
    /// The controller file is wrong; holds what its reader says.
    Controller(String),
    /// A trajectory without joints.
    NoJoints,
    /// The robot cannot be put on the ground: it has no `base_z`, or no contact.
    NoPlacing,
}

impl From<model::Cause> for Cause {
    fn from(cause: model::Cause) -> Self {
        Self::Form(cause)
    }
}

impl Cause {
    pub(super) fn wrong_length(expected: usize, found: usize) -> Self {
        Self::Form(model::Cause::WrongLength { expected, found })
    }
}

impl fmt::Display for Cause {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(cause) => write!(f, "{cause}"),
            Self::NoFormat(_) => write!(f, "the key `format` is missing"),
            Self::OutsideRange(value, range) => {
                write!(f, "the number must be {range}; it is {}", short(*value))
            }
            Self::Odd => write!(f, "the number must be even"),
            Self::NoEffect(missing) => write!(f, "this has no effect without {missing}"),
            Self::TwoRobots => write!(f, "`model` and `cradle_balls` are two robots"),
            Self::UnknownLink(name, _) => write!(f, "no link is called `{name}`"),
            Self::TwoShoves => write!(f, "a push is an impulse or a force, not both"),
            Self::UnknownJoint(name, _) => write!(f, "no joint is called `{name}`"),
            Self::NoPosition(name) => write!(f, "the position of `{name}` is missing"),
            Self::Undrivable(name) => {
                write!(f, "`{name}` moves the floating base: no drive is there")
            }
            Self::TooManyRows(most) => {
                write!(f, "the log would have more than {most} rows")
            }
            Self::Log(error) => write!(f, "{error}"),
            Self::RowsTooNear(distance_s) => {
                write!(f, "the rows of the log are {} s apart, in the mean", short(*distance_s))
            }
            Self::UnknownColumn(name, _) => write!(f, "the log has no column `{name}`"),
            Self::EmptyCell(column, line) => {
                write!(f, "the column `{column}` has no number in line {line} of the log")
            }
            Self::Gait(reason, _) => write!(f, "{reason}"),
            Self::NoPlanner => write!(f, "this reader plans no gaits"),
            Self::Start(error) => write!(f, "{error}"),
            Self::Singular(joint) => {
                write!(f, "the mass matrix is singular at `{joint}`: it moves no mass")
            }
            Self::TorqueNotFinite(joint) => {
                write!(f, "the torque on `{joint}` is not a finite number at the start")
            }
            Self::File(file, reason) => write!(f, "{file}: cannot be read: {reason}"),
            Self::Reference(error) => write!(f, "{error}"),
            Self::Plant(error) => write!(f, "{error}"),
            Self::Model(said) => write!(f, "the model is wrong:\n{said}"),
            Self::Trajectory(said) => write!(f, "the trajectory is wrong:\n{said}"),
            Self::Controller(said) => write!(f, "the controller is wrong:\n{said}"),
            Self::NoJoints => write!(f, "the trajectory moves no joint"),
            Self::NoPlacing => write!(f, "a robot is put on the ground by `base_z` and contacts"),
        }
    }
}

impl Explained for Cause {
    fn hint(&self) -> Option<String> {
        Some(match self {
            Self::Form(model::Cause::WrongFormat { found, expected })
                if found == "denavit-gait/1" && *expected == "denavit-scenario/1" =>
            {
                "a gait is designed first: `denavit walk design GAIT -o SCENARIO`".to_owned()
            }
            Self::Form(model::Cause::WrongFormat { expected, .. }) => {
                format!("such a file has `\"format\": \"{expected}\"`")
            }
            Self::NoFormat(expected) => format!("add `\"format\": \"{expected}\"`"),
            Self::Form(model::Cause::MissingKey(key)) => format!("add `\"{key}\": ..`"),
            Self::Form(cause) => {
                return cause.hint().or_else(|| {
                    Some(
                        "docs/reference/scenario.md says what is right, docs/reference/gait.md of \
                         gaits"
                            .into(),
                    )
                });
            }
            Self::UnknownLink(_, Some(near))
            | Self::UnknownJoint(_, Some(near))
            | Self::UnknownColumn(_, Some(near)) => {
                format!("`{near}` is meant, perhaps")
            }
            other => return other.fixed_hint().map(str::to_owned),
        })
    }
}

impl Cause {
    fn fixed_hint(&self) -> Option<&'static str> {
        Some(match self {
            Self::OutsideRange(..) | Self::Odd => {
                "`denavit schema` has the ranges of all numbers, by format"
            }
            Self::NoEffect(_) => "add that, or leave this out",
            Self::TwoRobots => "keep one of them",
            Self::UnknownLink(..) | Self::UnknownJoint(..) => {
                "`denavit inspect MODEL` lists the joints"
            }
            Self::UnknownColumn(..) => "columns are named in the first line of the log",
            Self::NoPosition(_) => "a posture has the position of every joint",
            Self::Undrivable(_) => "control the joints between links",
            Self::TooManyRows(_) => "write a row less often: `log_period_s`",
            Self::Log(_) => {
                "a log is a table with a column `t` that increases (docs/reference/scenario.md)"
            }
            Self::RowsTooNear(_) => {
                "`t` is in seconds; no log has rows that are less than 1e-9 s apart"
            }
            Self::EmptyCell(..) => "fill the gap, or cut the log before it",
            Self::Gait(_, hint) => hint,
            Self::NoPlanner => "`denavit_walk::read_scenario` reads scenarios with gaits",
            Self::Start(error) => start_hint(error.start()?),
            Self::Singular(_) => "give the link a mass and inertia, or start in another position",
            Self::TorqueNotFinite(_) => {
                "gains times errors, or a reference, exceed what a number holds"
            }
            Self::File(..) => "paths are taken from the scenario's directory",
            Self::Reference(error) | Self::Plant(error) => return error.hint(),
            Self::NoPlacing => "give the position itself, without `on_ground`",
            Self::NoJoints => "give a reference for each joint that moves",
            // what the readers of these say has its hint
            _ => return None,
        })
    }
}

fn start_hint(error: &StartError) -> &'static str {
    match error {
        StartError::Penetration(..) => "raise the robot, or give `on_ground` in `initial`",
        StartError::EventSchemeOnly(_) => "take the scheme `event`, or leave this out",
        StartError::MoreauOnly(_) => "take the method `moreau`, or leave this out",
        StartError::Steps(..) => {
            "take longer steps (`max_step_s`, `step_s`), or allow more `evaluations` in `limits`"
        }
        StartError::Breakdown(Breakdown::SingularPose) => {
            "start in another pose, or let the file's base frame stand otherwise in the robot"
        }
        StartError::Breakdown(Breakdown::Painleve) => {
            "less friction, or the scheme `time_stepping`, which jams with an impulse"
        }
        StartError::Breakdown(_) => {
            "start in the air or at rest, or give `contact` a finite friction"
        }
        StartError::Length(..) | StartError::Number(_) => {
            "docs/reference/scenario.md says what is right"
        }
    }
}
