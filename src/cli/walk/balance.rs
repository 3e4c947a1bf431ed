//! `denavit walk zmp|fri|capture|momentum`: balance along a run or a log.

use super::super::Answer;
use super::super::failure::Failure;
use super::super::files::{FILES, read_model_with_effects};
use super::super::flags::by_flag;
use super::super::outputs::{check_outputs, on_stdout, print_answer, write_given};
use super::super::progress::Progress;
use clap::Args;
use denavit::report::answer::{
    BalanceCriterion, balance_events, balance_json, balance_picture, balance_series, balance_text,
};
use denavit::workflow::{JudgeOptions, Judged, judge_log, judge_run};
use std::io::Write;
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A scenario (path or shipped name), or the path of a log with --model
    #[arg(value_name = "SCENARIO|LOG")]
    input: PathBuf,
    /// The model of the robot in a log
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
    /// Judge the whole run, not one cycle of the gait
    #[arg(long, conflicts_with = "model")]
    whole: bool,
    /// Distance of the instants that are looked at [default: 0.0005, more of runs over 100 s]
    #[arg(long, value_name = "SECONDS", value_parser = period, conflicts_with = "model")]
    period: Option<f64>,
    /// Where the criteria go, row by row, as CSV; - is standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Where the events go, as CSV: impulses, and velocities before and after; - is standard output
    #[arg(long, value_name = "FILE", conflicts_with = "model")]
    events: Option<PathBuf>,
    /// Draw the point with the edges of the support polygon over time; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn period(text: &str) -> Result<f64, String> {
    let period: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
    if (1e-6..=1.0).contains(&period) { Ok(period) } else { Err("not from 1e-6 to 1 s".into()) }
}

pub(crate) fn run(
    what: BalanceCriterion,
    arguments: &Arguments,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let outputs = [arguments.output.as_ref(), arguments.events.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    let judged = judge(arguments)?;
    check_outputs(&outputs)?;
    write_given(&arguments.output, || balance_series(&judged).to_csv())?;
    write_given(&arguments.events, || balance_events(&judged).to_csv())?;
    write_given(&arguments.svg, || balance_picture(what, &judged))?;
    let shown = (is_answered, arguments.json);
    print_answer(
        out,
        shown,
        || balance_json(what, &judged),
        || by_flag(&balance_text(what, &judged)).into_owned(),
        &outputs,
    )?;
    // a criterion that is not met is no fall: only a run that ends is
    let stopped = judged.course.run.as_ref().is_some_and(|run| run.stop.word() != "end");
    Ok(if stopped { Answer::Negative } else { Answer::Done })
}

fn judge(arguments: &Arguments) -> Result<Judged, Failure> {
    if let Some(model) = &arguments.model {
        let robot = read_model_with_effects(model, None)?;
        return Ok(judge_log(&robot, &arguments.input, &FILES)?);
    }
    if arguments.input.extension().is_some_and(|extension| extension == "csv") {
        let name = arguments.input.display().to_string();
        let why = "a log says nothing of its robot\n  hint: name the robot's model: --model MODEL";
        return Err(Failure::Walk(name, why.to_owned()));
    }
    let mut scenario = FILES.scenario(&arguments.input)?;
    let options = JudgeOptions { period_s: arguments.period, whole: arguments.whole };
    let progress = Progress::new();
    progress.show(&format!("simulating {}", scenario.name));
    let judged = judge_run(&mut scenario, &options)?;
    drop(progress);
    Ok(judged)
}
