//! `denavit schema`: the JSON Schema of a file format.

use super::Answer;
use super::failure::Failure;
use clap::{Args, ValueEnum};
use std::io::Write;

/// Print the JSON Schema of a file format
///
/// An editor that knows it completes and checks model files while they are written.
#[derive(Debug, Args)]
#[command(after_help = "Example:\n  denavit schema model")]
pub(crate) struct Arguments {
    /// The format
    #[arg(value_name = "FORMAT")]
    format: Format,
    /// Accepted as everywhere; a schema is JSON already
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Format {
    /// A robot
    #[value(alias = denavit::model::FORMAT)]
    Model,
    /// Missing physics
    #[value(alias = denavit::effect::FORMAT)]
    Effect,
    /// Equations as text
    #[value(alias = denavit::model::equations::FORMAT)]
    Equations,
    /// A proof of base parameters
    #[value(alias = denavit::regressor::certificate::FORMAT)]
    Certificate,
    /// A simulation
    #[value(alias = denavit::simulate::scenario::FORMAT)]
    Scenario,
    /// A gait to be designed
    #[value(alias = denavit::walk::gait_file::FORMAT)]
    Gait,
    /// What joints follow
    #[value(alias = denavit::simulate::scenario::TRAJECTORY_FORMAT)]
    Trajectory,
    /// What drives a robot
    #[value(alias = denavit::simulate::scenario::CONTROLLER_FORMAT)]
    Controller,
    /// Weighings and held postures
    #[value(alias = denavit::workflow::STATICS_FORMAT)]
    Statics,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let trajectory = denavit::simulate::scenario::trajectory_schema();
    let controller = denavit::simulate::scenario::controller_schema();
    let statics = denavit::workflow::statics_schema();
    let schema = match arguments.format {
        Format::Model => denavit::model::schema(),
        Format::Effect => denavit::effect::schema(),
        Format::Equations => denavit::model::equations::schema(),
        Format::Certificate => denavit::regressor::certificate::schema(),
        Format::Scenario => denavit::simulate::scenario::schema(),
        Format::Gait => denavit::walk::gait_file::schema(),
        Format::Trajectory => &trajectory,
        Format::Controller => &controller,
        Format::Statics => &statics,
    };
    writeln!(out, "{}", schema.trim_end())?;
    Ok(Answer::Done)
}
