//! `denavit identify --static`: weighings and held postures (thesis 3.2.1), joined with logs.

use super::Arguments;
use crate::cli::Answer;
use crate::cli::failure::Failure;
use crate::cli::files::FILES;
use crate::cli::flags::by_flag;
use crate::cli::json::write_json;
use crate::cli::progress::Progress;
use denavit::report::answer::{statics_json, statics_text};
use denavit::workflow::{FileKind, identify_statics};
use std::io::Write;
use std::path::Path;

pub(super) fn run(
    arguments: &Arguments,
    path: &Path,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let robot = arguments.robot()?;
    let (logs, options) = (arguments.logs()?, arguments.options(&robot)?);
    let (name, bytes) = (path.display().to_string(), FILES.wanted(path, FileKind::Statics)?);
    let progress = Progress::new();
    let found = identify_statics(&robot, &name, &bytes, &logs, &options, &mut progress.observer())?;
    progress.clear();
    match arguments.json {
        true => write_json(out, &statics_json(&found))?,
        false => write!(out, "{}", by_flag(&statics_text(&found)))?,
    }
    Ok(if found.is_good() { Answer::Done } else { Answer::Negative })
}
