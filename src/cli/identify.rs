//! `denavit identify`: parameters from logs.

mod arguments;
mod page;
mod statics;
mod two_stage;

use super::Answer;
use super::failure::{Failure, Misuse};
use super::files::read_robot;
use super::flags::by_flag;
use super::json::write_json;
use super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::progress::Progress;
use super::said::say_note;
pub(crate) use arguments::Arguments;
use arguments::MethodName;
use denavit::identify::Identification;
use denavit::report::answer::{identified_doubts, identified_json, identified_text};
use denavit::report::{TorquePicture, motion_picture, torque_picture};
use denavit::workflow::{
    Conditions, Identified, IdentifyOptions, Logs, LongLog, RobotFile, identify, identify_long,
};
use std::io::Write;
use std::path::{Path, PathBuf};

/// What is found in one log below a frequency \[Hz\], and its page.
pub(crate) fn of_log(
    model: &str,
    log: PathBuf,
    cutoff_hz: f64,
    progress: &Progress,
) -> Result<(Identification, String), Failure> {
    let robot = read_robot(Path::new(model), None)?;
    let logs = Logs::new([log], []);
    let options =
        IdentifyOptions { conditions: Conditions::filtered(cutoff_hz), ..Default::default() };
    let identified = identify(&robot, &logs, &options, &mut progress.observer())?;
    let facts = page::facts(&robot.whole, &logs, page::default_words());
    let page = page::of(&facts, &identified, identified.is_good(false))?;
    Ok((identified.found, page))
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    if !arguments.instruments.is_empty() && arguments.method != MethodName::Iv {
        return Err(Misuse::UnusedInstruments.into());
    }
    if arguments.two_stage {
        return two_stage::run(arguments, out);
    }
    if let Some(path) = &arguments.statics {
        return statics::run(arguments, path, out);
    }
    answer(arguments, out, |robot, logs, options, progress| {
        let observer = &mut progress.observer();
        Ok(match arguments.long {
            true => identify_long(long_log(arguments, robot, logs, options), observer)?,
            false => identify(robot, logs, options, observer)?,
        })
    })
}

/// The log of the arguments, as one that is read piece by piece.
pub(crate) fn long_log<'a>(
    arguments: &Arguments,
    file: &'a RobotFile,
    logs: &'a Logs,
    options: &'a IdentifyOptions,
) -> LongLog<'a> {
    let head_rows = arguments.head.map_or(LongLog::USUAL_HEAD, |rows| rows as usize);
    LongLog { file, logs, options, head_rows }
}

/// Reads the inputs, identifies, and writes all that is asked for.
pub(crate) fn answer(
    arguments: &Arguments,
    out: &mut dyn Write,
    identified: impl FnOnce(
        &RobotFile,
        &Logs,
        &IdentifyOptions,
        &Progress,
    ) -> Result<Identified, Failure>,
) -> Result<Answer, Failure> {
    let outputs = [
        arguments.output.as_ref(),
        arguments.svg.as_ref(),
        arguments.motion_svg.as_ref(),
        arguments.html.as_ref(),
    ];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    check_outputs(&outputs)?;
    let progress = Progress::new();
    let robot = arguments.robot()?;
    let (logs, options) = (arguments.logs()?, arguments.options(&robot)?);
    // now that all inputs are known
    check_outputs(&outputs)?;
    let identified = identified(&robot, &logs, &options, &progress)?;
    progress.clear();
    write_files(arguments, &logs, &identified)?;
    match (is_answered, arguments.json) {
        // the document has no place for it
        (true, _) => say_doubts(&identified),
        (_, true) => write_json(out, &identified_json(&identified))?,
        (_, false) => {
            write!(out, "{}", by_flag(&identified_text(&identified)))?;
            say_written(out, &outputs)?;
        }
    }
    let is_good = identified.is_good(arguments.accept_suspicious);
    Ok(if is_good { Answer::Done } else { Answer::Negative })
}

/// Says on standard error what speaks against an answer that went into a document.
fn say_doubts(identified: &Identified) {
    let doubts = identified_doubts(identified);
    if !doubts.is_empty() {
        say_note(&doubts.trim_end_matches('\n'));
    }
}

/// Writes what was asked for beside the answer; nothing, if one of the files cannot be made.
fn write_files(arguments: &Arguments, logs: &Logs, identified: &Identified) -> Result<(), Failure> {
    let Identified { model, found, updated, simulated, .. } = identified;
    let title = model.model.replace('_', " ");
    let mut files = Vec::new();
    if let Some(path) = &arguments.svg {
        let picture = TorquePicture {
            title: &title,
            subtitle: if found.validate.is_some() {
                "torques of the logs for validation"
            } else {
                "torques of the logs that the estimate is from"
            },
            validation: found.validate.as_ref().unwrap_or(&found.train),
        };
        files.push((path, torque_picture(&picture)));
    }
    if let Some(path) = &arguments.output {
        let updated = updated.as_ref().map_err(|error| Misuse::NoModel(error.clone()))?;
        files.push((path, updated.text.clone()));
    }
    if let Some(path) = &arguments.motion_svg {
        let moved = simulated.as_ref().and_then(|gap| Some((gap, gap.after.as_ref().ok()?)));
        let (gap, forward) = moved.ok_or(Misuse::NotSimulated)?;
        files.push((path, motion_picture(&title, &gap.method(), forward)));
    }
    if let Some(path) = &arguments.html {
        let facts = page::facts(&identified.robot, logs, page::words(arguments));
        let is_good = identified.is_good(arguments.accept_suspicious);
        files.push((path, page::of(&facts, identified, is_good)?));
    }
    files.iter().try_for_each(|(path, text)| write_whole(path, text.as_bytes()))
}
