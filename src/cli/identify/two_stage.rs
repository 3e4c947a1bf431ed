//! `denavit identify --two-stage`: springs and motors first, then the load (thesis 3.3.2).

use super::{Arguments, page};
use crate::cli::Answer;
use crate::cli::failure::{Failure, Misuse};
use crate::cli::flags::by_flag;
use crate::cli::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use crate::cli::progress::Progress;
use denavit::report::answer::{two_stage_json, two_stage_text};
use denavit::report::{TorquePicture, TwoStagePage, torque_picture};
use denavit::workflow::{Logs, TwoStageFound, identify_two_stage};
use std::io::Write;

pub(super) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref(), arguments.svg.as_ref(), arguments.html.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    check_outputs(&outputs)?;
    let robot = arguments.robot()?;
    let (logs, options) = (arguments.logs()?, arguments.options(&robot)?);
    let progress = Progress::new();
    let found = identify_two_stage(robot, &logs, &options, &mut progress.observer())?;
    progress.clear();
    if let Some(path) = &arguments.output {
        write_whole(path, found.updated()?.as_bytes())?;
    }
    write_given(&arguments.svg, || picture(&found))?;
    if let Some(path) = &arguments.html {
        write_whole(path, html(arguments, &logs, &found)?.as_bytes())?;
    }
    let shown = (is_answered, arguments.json);
    print_answer(
        out,
        shown,
        || two_stage_json(&found),
        || by_flag(&two_stage_text(&found)).into_owned(),
        &outputs,
    )?;
    Ok(if found.is_good() { Answer::Done } else { Answer::Negative })
}

fn picture(found: &TwoStageFound) -> String {
    let picture = TorquePicture {
        title: &found.model.model.replace('_', " "),
        subtitle: match found.validate {
            Some(_) => "torques on the loads, of the logs for validation",
            None => "torques on the loads, of the log that the estimate is from",
        },
        validation: found.validate.as_ref().unwrap_or(&found.train),
    };
    torque_picture(&picture)
}

fn html(arguments: &Arguments, logs: &Logs, found: &TwoStageFound) -> Result<String, Failure> {
    let page = TwoStagePage {
        model: &found.robot.name,
        facts: &page::facts(&found.robot, logs, page::words(arguments)),
        remarks: &found.remarks,
        springs: &found.stages.springs,
        parameters: &found.parameters,
        train: &found.train,
        validate: found.validate.as_ref(),
        distance: found.bodies.distance,
    };
    Ok(page.page().map_err(Misuse::Formula)?.render())
}
