//! `denavit import`: a robot that URDF or MJCF describes, as a model file.

use super::Answer;
use super::failure::Failure;
use super::files::FILES;
use super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::said::say_note;
use clap::{Args, ValueEnum};
use denavit::import::{BaseChoice, Beside, Mimic, Options, import};
use std::io::Write;
use std::path::PathBuf;

/// Make a model file of a URDF or MJCF
///
/// Origins become rows of the table exactly, decimals stay decimals; angles within rounding of a
/// quarter turn become quarter turns. Joints keep their names; the frame of a link is the row that
/// is called like it or, without one, that of its joint. All faults are reported at once, each
/// with place, cause and hint, and exit code 2. Every command also reads such a file as MODEL.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit import panda.urdf -o panda_of_urdf.json
  denavit import panda.urdf --base floating
  denavit import panda.urdf --tip joint5")]
pub(crate) struct Arguments {
    /// Path of a URDF or MJCF file, or - for standard input
    #[arg(value_name = "ROBOT")]
    robot: PathBuf,
    /// What the first link stands on; without it what the file says, which is the world for URDF
    #[arg(long, value_enum, value_name = "BASE")]
    base: Option<Base>,
    /// Take the chain to this link alone, with what is fixed to it
    #[arg(long, value_name = "LINK")]
    tip: Option<String>,
    /// Make contact points of the collision shapes of this link; may be repeated
    #[arg(long, value_name = "LINK")]
    contacts: Vec<String>,
    /// The folder of meshes (STL, OBJ), or of the package of `package://`; without it that of ROBOT
    #[arg(long, value_name = "DIR", requires = "contacts")]
    meshes: Option<PathBuf>,
    /// What becomes of joints that follow others, which a model file has not
    #[arg(long, value_enum, value_name = "WAY", default_value = "refuse")]
    mimic: Way,
    /// Write the model to this file; - is standard output
    #[arg(short, long, value_name = "FILE", default_value = "-")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Base {
    /// The world
    Fixed,
    /// Nothing: six joints are generated
    Floating,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Way {
    /// They are a fault
    Refuse,
    /// They are fixed where they are when the other joint is at 0
    Lock,
    /// They are joints of their own
    Free,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [Some(&arguments.out)];
    on_stdout(&outputs, false)?;
    check_outputs(&outputs)?;
    let (name, bytes) = FILES.description(&arguments.robot)?;
    let options = Options {
        base: match arguments.base {
            None => BaseChoice::AsDescribed,
            Some(Base::Fixed) => BaseChoice::Fixed,
            Some(Base::Floating) => BaseChoice::Floating,
        },
        tip: arguments.tip.clone(),
        contacts: arguments.contacts.clone(),
        mimic: match arguments.mimic {
            Way::Refuse => Mimic::Refuse,
            Way::Lock => Mimic::Lock,
            Way::Free => Mimic::Free,
        },
    };
    let meshes = arguments.meshes.as_deref();
    let mut include = |named: Beside<'_>| FILES.of_description(&arguments.robot, meshes, named);
    let imported = import(&name, &bytes, &options, &mut include).map_err(Failure::Import)?;
    for note in &imported.notes {
        say_note(&format_args!("note: {note}"));
    }
    write_whole(&arguments.out, imported.model.as_bytes())?;
    if arguments.out.as_os_str() != "-" {
        say_written(out, &outputs)?;
    }
    Ok(Answer::Done)
}
