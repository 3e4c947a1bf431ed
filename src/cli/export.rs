//! `denavit export`: a model as URDF or MJCF, or its values in the URDF that it was made of.

use super::Answer;
use super::failure::Failure;
use super::files::{read_file, read_model_with_effects};
use super::options::{EffectsOption, ModelArgument};
use super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::said::say_note;
use clap::{Args, ValueEnum};
use denavit::import::{Format, export, export_into};
use std::io::Write;
use std::path::PathBuf;

/// Write a model as URDF or MJCF, or its values into the URDF that it was made of
///
/// With `--into`, masses, centres of mass, inertias and joint friction become those of the model,
/// and every other byte of the file stays. Without it the whole robot is written: a link for each
/// row of the table.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit export panda -o panda.urdf
  denavit export panda -o panda.xml
  denavit export panda --into panda.urdf -o panda_updated.urdf")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: ModelArgument,
    #[command(flatten)]
    effects: EffectsOption,
    /// The URDF whose values change
    #[arg(long, value_name = "ROBOT")]
    into: Option<PathBuf>,
    /// The format; without it MJCF for a file that ends in .xml, URDF for all others
    #[arg(long, value_enum, value_name = "FORMAT", conflicts_with = "into")]
    format: Option<FormatName>,
    /// Write the description to this file; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum FormatName {
    /// That of ROS
    Urdf,
    /// That of MuJoCo
    Mjcf,
}

impl Arguments {
    fn format(&self) -> Format {
        let is_xml = self.out.extension().is_some_and(|ending| ending == "xml");
        match self.format {
            Some(FormatName::Mjcf) => Format::Mjcf,
            None if is_xml => Format::Mjcf,
            _ => Format::Urdf,
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [Some(&arguments.out)];
    on_stdout(&outputs, false)?;
    check_outputs(&outputs)?;
    let effects = arguments.effects.effects.as_deref();
    let robot = read_model_with_effects(&arguments.model.model, effects)?;
    let exported = match &arguments.into {
        None => export(&robot, arguments.format()),
        Some(file) => export_into(&robot, &file.display().to_string(), &read_file(file)?),
    };
    let exported = exported.map_err(|error| Failure::Export(robot.name.clone(), error))?;
    for note in &exported.notes {
        say_note(&format_args!("note: {note}"));
    }
    write_whole(&arguments.out, exported.text.as_bytes())?;
    if arguments.out.as_os_str() != "-" {
        say_written(out, &outputs)?;
    }
    Ok(Answer::Done)
}
