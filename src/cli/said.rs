//! What is said on standard error beside an answer: why a run stops, notes, how long stages took.
//! Colours are for terminals; elsewhere the bytes are those of the text.

use super::embedded;
use super::flags::by_flag;
use super::printed::{shown, standard_error};
use super::progress;
use anstream::{AutoStream, ColorChoice};
use anstyle::{AnsiColor, Style};
use clap::Args;
use std::cell::Cell;
use std::fmt::Display;
use std::io::{self, IsTerminal, Write};
use std::time::Duration;

/// How much is reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Args)]
pub(super) struct Loudness {
    /// Show no progress and no notes: standard error has what is wrong, and nothing else
    #[arg(short, long, global = true, display_order = 900)]
    quiet: bool,
    /// Say how long each stage of long work took, and the whole
    #[arg(short, long, global = true, display_order = 901)]
    verbose: bool,
}

thread_local! {
    /// That of this thread's run: other threads compute, and say nothing.
    static LOUDNESS: Cell<Loudness> = const { Cell::new(Loudness::USUAL) };
}

impl Loudness {
    /// Notes, and no times.
    const USUAL: Self = Self { quiet: false, verbose: false };

    /// Whether both were asked for, which nobody can mean.
    pub(super) fn contradicts_itself(self) -> bool {
        self.quiet && self.verbose
    }

    /// Whether nothing is reported but what is wrong.
    pub(super) fn is_quiet(self) -> bool {
        self.quiet
    }

    /// Whether times are reported.
    pub(super) fn is_verbose(self) -> bool {
        self.verbose
    }
}

/// Says this much from now on, in this thread.
pub(super) fn set_loudness(loudness: Loudness) {
    LOUDNESS.set(loudness);
}

/// How much this thread's run says.
pub(super) fn loudness() -> Loudness {
    LOUDNESS.get()
}

/// Says on standard error why a run stops.
pub(super) fn say_error(said: &impl Display) {
    say(&said.to_string(), AnsiColor::Red);
}

/// Says on standard error what a reader of the answer should know, unless nobody wants to.
pub(super) fn say_note(said: &impl Display) {
    if !loudness().is_quiet() {
        say(&said.to_string(), AnsiColor::Yellow);
    }
}

/// Says on standard error what is no answer and no fault: progress, and times.
pub(super) fn say_aside(said: &str) {
    say(said, AnsiColor::BrightBlack);
}

/// How long something took, for those who ask for that.
pub(super) fn say_time(what: &str, took: Duration) {
    say_aside(&format!("time: {what}: {:.3} s", took.as_secs_f64()));
}

fn say(said: &str, colour: AnsiColor) {
    let said = &*by_flag(said);
    if let Some(observed) = embedded::observed() {
        return observed.note(said);
    }
    progress::above(|| {
        // what cannot be said is no reason to stop
        let _ = match is_coloured() {
            true => write_coloured(said, colour),
            false => {
                let mut errors = standard_error();
                writeln!(errors, "{said}").and_then(|()| errors.flush())
            }
        };
    });
}

/// Whether standard error is a terminal of somebody who wants colours (`NO_COLOR`, `TERM`).
fn is_coloured() -> bool {
    let errors = io::stderr();
    errors.is_terminal() && AutoStream::choice(&errors) != ColorChoice::Never
}

fn write_coloured(said: &str, colour: AnsiColor) -> io::Result<()> {
    // what files and flags bring along is shown before colours come
    let text = coloured(&shown(said), colour);
    let mut errors = AutoStream::auto(io::stderr().lock());
    writeln!(errors, "{text}")?;
    errors.flush()
}

/// The text with the words that say what a line is in colour: the place of a fault or the kind of a
/// note, and `hint:`.
fn coloured(text: &str, colour: AnsiColor) -> String {
    let head = Style::new().bold().fg_color(Some(colour.into()));
    let hint = Style::new().fg_color(Some(AnsiColor::Green.into()));
    let painted = |style: Style, word: &str| format!("{style}{word}{style:#}");
    let line = |line: &str| match (line.strip_prefix("  hint:"), line.split_once(": ")) {
        (Some(rest), _) => format!("  {}{rest}", painted(hint, "hint:")),
        // what goes on below a line belongs to it
        (None, _) if line.starts_with(' ') => line.to_owned(),
        (None, Some((place, cause))) => {
            format!("{} {cause}", painted(head, &format!("{place}:")))
        }
        (None, None) => painted(head, line),
    };
    text.lines().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plain(text: &str) -> String {
        anstream::adapter::strip_str(text).to_string()
    }

    #[test]
    fn colours_change_no_letter() {
        let texts = [
            "puma650: there is no such file\n  hint: `puma560` is a shipped model",
            "standard output would hold two documents",
            "a.json:2:20: /x: nothing\n  hint: declare it:\n  more",
        ];
        for text in texts {
            let painted = coloured(text, AnsiColor::Red);
            assert_eq!(plain(&painted), text);
            assert_ne!(painted, text);
        }
    }

    #[test]
    fn place_and_hint_are_coloured_and_nothing_else() {
        let text = coloured("arm.json: no\n  hint: see: this", AnsiColor::Red);
        assert_eq!(
            text,
            "\u{1b}[1m\u{1b}[31marm.json:\u{1b}[0m no\n  \u{1b}[32mhint:\u{1b}[0m see: this"
        );
    }
}
