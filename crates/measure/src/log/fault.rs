//! What is wrong with a log, or looks wrong.

use crate::policy::fault::LONGER_PARTS;
use denavit_logs::{FileFault, FileRemark, Place};
use denavit_numerics::short;
use std::fmt;

/// All that is wrong with a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LogFaults {
    /// The file, as it was given.
    pub file: String,
    /// The faults, those that keep it from being read first.
    pub faults: Vec<LogFault>,
}

/// What keeps a log from being used.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages name
pub enum LogFault {
    /// The file itself is wrong.
    File(FileFault),
    /// A column that is needed is not there.
    MissingColumn { column: String, nearest: Option<String> },
    /// A joint has no torque, and others have; holds its column and the one that is meant, perhaps.
    MissingTorque { column: String, nearest: Option<String> },
    /// A robot on a floating base lacks forces of its contacts; holds their columns.
    MissingForces { columns: Vec<String> },
    /// Several of our columns are taken from one of the log.
    SharedColumn { column: String, ours: Vec<String> },
    /// A number that nothing of a robot can be.
    Impossible { column: String, value: f64, at: Place },
    /// A name that is mapped is none of the model's columns.
    UnknownName { name: String, nearest: Option<String> },
    /// The log says that it is of another model.
    OtherModel { log: String, model: String },
    /// Cells without a number, more than are filled in.
    Undefined { column: String, count: usize, at: Place },
    /// A time that is before the one of the row above.
    TimeNotIncreasing { at: Place },
    /// Samples are missing, more than are filled in.
    Gaps { missing: usize, samples: usize, longest: usize, at: Place },
    /// Something else, in words.
    Other { text: String, at: Option<Place> },
    /// The log says something else than it seems to.
    Suspicion(Suspicion),
    /// No joint moves.
    NothingMoves,
}

/// What looks wrong: it may be accepted by whoever knows better.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages name
pub enum Suspicion {
    /// The time seems to count milliseconds or microseconds; holds what a mapping says already.
    TimeUnit { step: f64, factor: f64, mapped: String },
    /// A position seems to be in degrees; holds what brings the column to radians.
    Degrees { column: String, largest: f64, factor: f64, mapped: String },
    /// A logged rate is another multiple of the derivative of its position.
    RateScale { column: String, ratio: f64 },
    /// A logged rate is not the derivative of its position.
    NotTheRate { column: String, correlation: f64 },
    /// A joint's position fits another joint's rate or reference.
    Swapped { joint: String, other: String },
    /// A torque never changes while its joint moves.
    ConstantTorque { column: String },
    /// A torque is far beyond what the model says the joint can have.
    BeyondTorque { column: String, value: f64, limit: f64, samples: usize },
    /// The torque that was commanded to a motor is all that there is of a joint behind a spring.
    CommandOfSpring { joint: String },
    /// A position jumps from one row to the next; holds the line and how many other jumps there
    /// are.
    Jump { column: String, at: Place, from: f64, to: f64, others: usize },
    /// A position is beyond its limits.
    BeyondLimits { column: String, value: f64, limits: [f64; 2] },
}

impl Suspicion {
    /// With factors of what stands in the log, whose columns have been scaled already, and where
    /// it stands.
    pub(super) fn of_log(mut self, of: impl Fn(&str) -> (f64, String)) -> Self {
        let (column, factor, mapped) = match &mut self {
            Self::TimeUnit { factor, mapped, .. } => ("t", factor, mapped),
            Self::Degrees { column, factor, mapped, .. } => (column.as_str(), factor, mapped),
            _ => return self,
        };
        let (scale, given) = of(column);
        (*factor, *mapped) = (*factor * scale, given);
        self
    }

    /// Whether a single sample can raise it, and not how a log goes on alone.
    pub fn is_of_samples(&self) -> bool {
        use Suspicion::{BeyondLimits, BeyondTorque, Degrees, Jump};
        matches!(self, Degrees { .. } | BeyondTorque { .. } | Jump { .. } | BeyondLimits { .. })
    }
}

/// What was found and needs no answer: repairs that were made, properties that matter.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)] // the fields are what the messages name
pub enum LogRemark {
    /// Of the file itself.
    File(FileRemark),
    /// Rows that said the same twice were dropped.
    DroppedRepeats { count: usize },
    /// Missing samples were filled in by cubic interpolation.
    FilledGaps { missing: usize, samples: usize, longest: usize },
    /// Cells without a number were filled in.
    FilledCells { column: String, count: usize },
    /// Samples were brought to equal distances.
    Resampled { jitter: f64 },
    /// A joint that does not move.
    Resting { joint: String },
    /// The torque stands at its extreme value.
    Saturated { column: String, share: f64, value: f64 },
    /// Positions have steps of these sizes, as of encoders.
    Steps { columns: Vec<(String, f64)> },
    /// Torques of motors were multiplied by the gear ratios.
    MotorTorques { joints: Vec<String> },
    /// There are wrenches of a link that the model does not have: they count for nothing.
    NoSuchLink { link: String },
    /// The log says the same as another one, which the estimate is from.
    SameAs { other: String },
    /// A suspicion that was accepted.
    Accepted(Suspicion),
    /// Something else, in words.
    Other(String),
}

impl fmt::Display for LogFaults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, fault) in self.faults.iter().enumerate() {
            if index > 0 {
                writeln!(f)?;
            }
            match fault.place() {
                Some(Place::Line(line)) => write!(f, "{}:{line}: {fault}", self.file)?,
                Some(place) => write!(f, "{}: {place}: {fault}", self.file)?,
                None => write!(f, "{}: {fault}", self.file)?,
            }
        }
        Ok(())
    }
}

impl LogFault {
    /// What is wrong, in words.
    pub fn other(text: impl Into<String>) -> Self {
        Self::Other { text: text.into(), at: None }
    }

    /// The place that it is about.
    pub fn place(&self) -> Option<Place> {
        match *self {
            Self::File(ref fault) => fault.place(),
            Self::Other { at, .. } => at,
            Self::Undefined { at, .. }
            | Self::TimeNotIncreasing { at }
            | Self::Impossible { at, .. }
            | Self::Gaps { at, .. } => Some(at),
            _ => None,
        }
    }
}

fn meant(f: &mut fmt::Formatter<'_>, nearest: &Option<String>, other: &str) -> fmt::Result {
    match nearest {
        Some(name) => write!(f, "\n  hint: the log has `{name}`; `logs.columns` can name it"),
        None => write!(f, "\n  hint: {other}"),
    }
}

fn missing_torque(
    f: &mut fmt::Formatter<'_>,
    column: &str,
    nearest: &Option<String>,
) -> fmt::Result {
    write!(f, "there is no column `{column}`, and other joints have torques")?;
    meant(f, nearest, "`logs.columns` says which column of the log it is")?;
    write!(f, "; {{\"{column}\": null}} there leaves it out")
}

fn missing_forces(f: &mut fmt::Formatter<'_>, columns: &[String]) -> fmt::Result {
    let (first, count) = (&columns[0], columns.len());
    write!(f, "there is no column `{first}`")?;
    if count > 1 {
        write!(f, ", nor {} more with forces of contacts", count - 1)?;
    }
    write!(
        f,
        ", and the base floats: its weight would rest on nothing\n  hint: `logs.columns` says \
         which column of the log it is; {{\"{first}\": null}} there is for what never touches"
    )
}

fn shared_column(f: &mut fmt::Formatter<'_>, column: &str, ours: &[String]) -> fmt::Result {
    let ours: Vec<String> = ours.iter().map(|one| format!("`{one}`")).collect();
    write!(
        f,
        "column `{column}` is taken for {}\n  hint: `logs.columns` gives each its own; null \
         leaves one out",
        ours.join(" and ")
    )
}

impl fmt::Display for LogFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(fault) => write!(f, "{fault}"),
            Self::MissingColumn { column, nearest } => {
                write!(f, "there is no column `{column}`")?;
                meant(f, nearest, "`logs.columns` says which column of the log it is")
            }
            Self::MissingTorque { column, nearest } => missing_torque(f, column, nearest),
            Self::MissingForces { columns } => missing_forces(f, columns),
            Self::SharedColumn { column, ours } => shared_column(f, column, ours),
            Self::Impossible { column, value, .. } => {
                write!(f, "{value:e} in column `{column}`: nothing of a robot is so large")
            }
            Self::UnknownName { name, nearest } => {
                write!(f, "`logs.columns` maps `{name}`, which is no column of this model")?;
                match nearest {
                    Some(name) => write!(f, "\n  hint: did you mean `{name}`?"),
                    None => Ok(()),
                }
            }
            Self::OtherModel { log, model } => {
                write!(f, "is a log of `{log}`, and the model is `{model}`")
            }
            Self::Undefined { column, count, .. } => write!(
                f,
                "{count} cells of column `{column}` have no number, more than can be filled in"
            ),
            Self::TimeNotIncreasing { .. } => write!(f, "the time is before that of the row above"),
            Self::Gaps { missing, samples, longest, .. } => write!(
                f,
                "{missing} of {samples} samples are missing, up to {longest} at once: more than \
                 can be filled in\n  hint: cut the log at its gaps"
            ),
            Self::Suspicion(suspicion) => write!(f, "{suspicion}"),
            Self::NothingMoves => write!(f, "no joint moves"),
            Self::Other { text, .. } => write!(f, "{text}"),
        }
    }
}

impl fmt::Display for Suspicion {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TimeUnit { step, factor, mapped } => write!(
                f,
                "a step of `t` is {}, as if it did not count seconds\n  hint: map it: {{\"t\": \
                 {{{mapped}\"scale\": {factor}}}}}{}",
                short(*step),
                match step {
                    _ if *factor > 1.0 =>
                        " if it counts hours, {\"t\": {\"scale\": 86400}} if days",
                    step if *step < LONGER_PARTS => {
                        ", or {\"t\": {\"scale\": 0.01}} if it counts hundredths of a second, \
                         {\"t\": {\"scale\": 0.016666666666666666}} if sixtieths"
                    }
                    _ => "",
                }
            )?,
            Self::Degrees { column, largest, factor, mapped } => write!(
                f,
                "`{column}` goes to {largest:.4}, as if it were in degrees\n  hint: map it: \
                 {{\"{column}\": {{{mapped}\"scale\": {factor}}}}}"
            )?,
            Self::RateScale { column, ratio } => write!(
                f,
                "`{column}` is {ratio:.4} times the derivative of its position\n  hint: time, \
                 position or velocity is in another unit; `logs.columns` can scale each"
            )?,
            Self::NotTheRate { column, correlation } => write!(
                f,
                "`{column}` does not follow the derivative of its position (correlation \
                 {correlation:.2})"
            )?,
            Self::Swapped { joint, other } => write!(
                f,
                "the position of `{joint}` fits the velocity of `{other}`: are the two swapped?\n  \
                 hint: `logs.columns` can name them the other way round"
            )?,
            Self::ConstantTorque { column } => {
                write!(f, "`{column}` never changes while its joint moves")?;
            }
            Self::CommandOfSpring { joint } => write!(
                f,
                "`{joint}` has a spring behind its motor, and the log has the torque of the motor, \
                 `tau_cmd_{joint}`, alone: the joint gets another one\n  hint: \
                 `identify_two_stage` finds \
                 the springs first; or give the joint's own torque as `tau_{joint}`"
            )?,
            Self::BeyondTorque { column, value, limit, samples } => write!(
                f,
                "`{column}` goes to {value:.4} in {samples} samples, and the model's limit is \
                 {limit:.4}"
            )?,
            Self::Jump { column, at, from, to, others } => {
                write!(f, "`{column}` jumps from {from:.6} to {to:.6} in {at}")?;
                if *others > 0 {
                    write!(f, ", and in {others} other places")?;
                }
                write!(
                    f,
                    "\n  hint: did its encoder slip, or were logs joined end to end? cut it"
                )?;
            }
            Self::BeyondLimits { column, value, limits: [low, high] } => write!(
                f,
                "`{column}` goes to {value:.4}, and the model's limits are {low:.4} to {high:.4}"
            )?,
        }
        write!(f, "\n  hint: `logs.accepts_suspicious` takes the log as it is")
    }
}

/// Names the positions that have steps, and how large these are.
fn write_steps(f: &mut fmt::Formatter<'_>, columns: &[(String, f64)]) -> fmt::Result {
    const NAMED: usize = 4;
    let names: Vec<String> =
        columns.iter().take(NAMED).map(|(column, _)| format!("`{column}`")).collect();
    write!(f, "{}", names.join(", "))?;
    match columns.len().saturating_sub(NAMED) {
        0 => {}
        1 => write!(f, " and another position")?,
        more => write!(f, " and {more} other positions")?,
    }
    let steps = columns.iter().map(|(_, step)| *step);
    let least = steps.clone().fold(f64::INFINITY, f64::min);
    let largest = steps.fold(0.0, f64::max);
    let verb = if columns.len() > 1 { "have" } else { "has" };
    write!(f, " {verb} steps of {least:.3e}")?;
    if largest > 1.01 * least {
        write!(f, " to {largest:.3e}")?;
    }
    write!(f, ", as of an encoder")
}

impl fmt::Display for LogRemark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::File(remark) => write!(f, "{remark}"),
            Self::DroppedRepeats { count } => write!(f, "{count} repeated rows dropped"),
            Self::FilledGaps { missing, samples, longest } => write!(
                f,
                "{missing} of {samples} samples were missing, up to {longest} at once: filled in \
                 by cubic interpolation"
            ),
            Self::FilledCells { column, count } => {
                write!(f, "{count} cells of `{column}` without a number: filled in")
            }
            Self::Resampled { jitter } => write!(
                f,
                "distances of samples scatter by {:.1} %: interpolated at equal distances",
                100.0 * jitter
            ),
            Self::Resting { joint } => {
                write!(
                    f,
                    "`{joint}` never moves, or no further than its noise: what only its motion \
                     shows is not identified, and stiction may hide in its torque"
                )
            }
            Self::Saturated { column, share, value } => write!(
                f,
                "`{column}` stands at {value:.6} in {:.1} % of the samples: saturated?",
                100.0 * share
            ),
            Self::Steps { columns } => write_steps(f, columns),
            Self::MotorTorques { joints } => {
                write!(f, "torques of motors, multiplied by the gear ratios: {}", joints.join(", "))
            }
            Self::NoSuchLink { link } => {
                write!(f, "wrenches on `{link}`, which is no link of the model: left out")
            }
            Self::SameAs { other } => {
                write!(f, "says the same as {other}, all of it or a part: it validates nothing")
            }
            Self::Other(text) => write!(f, "{text}"),
            Self::Accepted(suspicion) => {
                let text = suspicion.to_string();
                write!(f, "accepted: {}", text.lines().next().unwrap_or_default())
            }
        }
    }
}
