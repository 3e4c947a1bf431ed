//! `denavit man`: manual pages, made of the help texts.

use super::failure::Failure;
use super::outputs::{NewDirectory, say_written, write_together};
use super::{Answer, Cli};
use clap::builder::Resettable;
use clap::{Args, CommandFactory};
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};
use std::io::{self, Write};
use std::path::PathBuf;

/// Print the manual page of the command, or write those of all subcommands
///
/// With --out there is one page for each subcommand, named as manuals are: denavit-inspect.1,
/// denavit-walk-zmp.1. Pages are made of the help texts.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit man
  denavit man --out man/man1")]
pub(crate) struct Arguments {
    /// Write all pages into this folder, which is made if it is not there
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    // there is no page of `help`
    let mut command = Cli::command()
        .disable_help_subcommand(true)
        .mut_subcommands(|command| command.disable_help_subcommand(true));
    // names of subcommands are then those of the whole command line
    command.build();
    let Some(folder) = &arguments.out else {
        out.write_all(&page(&command)?)?;
        return Ok(Answer::Done);
    };
    let _made = NewDirectory::make(folder)?;
    let mut files = Vec::new();
    for command in all(&command) {
        files.push((folder.join(format!("{}.1", name(command))), page(command)?));
    }
    write_together(&files)?;
    let paths: Vec<_> = files.iter().map(|(path, _)| Some(path)).collect();
    say_written(out, &paths)?;
    Ok(Answer::Done)
}

/// A command with its subcommands and theirs.
fn all(command: &clap::Command) -> Vec<&clap::Command> {
    [command].into_iter().chain(command.get_subcommands().flat_map(all)).collect()
}

/// The name of a page.
fn name(command: &clap::Command) -> &str {
    command.get_display_name().unwrap_or(command.get_name())
}

/// The page of a command. Its examples stand in lines of their own: clap_mangen would fill a
/// paragraph with them.
fn page(command: &clap::Command) -> io::Result<Vec<u8>> {
    let below = command.get_after_help().map(ToString::to_string).unwrap_or_default();
    let mut page = Vec::new();
    Man::new(command.clone().after_help(Resettable::Reset))
        .source(concat!("denavit ", env!("CARGO_PKG_VERSION")))
        .render(&mut page)?;
    let (notes, examples) = below.split_at(below.find("Example").unwrap_or(below.len()));
    let mut roff = Roff::new();
    if !notes.trim().is_empty() {
        roff.control("SH", ["NOTES"]);
        lines(&mut roff, notes);
    }
    // the line that says so is the heading
    if let Some((_, examples)) = examples.split_once('\n') {
        roff.control("SH", ["EXAMPLES"]);
        lines(&mut roff, examples);
    }
    page.extend(roff.to_roff().into_bytes());
    Ok(page)
}

fn lines(roff: &mut Roff, text: &str) {
    roff.control("nf", []);
    for line in text.trim_end().lines() {
        roff.text([roman(line)]);
    }
    roff.control("fi", []);
}
