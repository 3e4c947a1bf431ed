//! `denavit long`: a log that is larger than the memory, condensed by many processes.

use super::Answer;
use super::failure::Failure;
use super::files::{FILES, read_file};
use super::identify::{self, answer, long_log};
use super::json::write_json;
use super::progress::Progress;
use clap::{Args, Subcommand};
use denavit::workflow::{IdentifyOptions, LogSource, LongPlan, PieceRows};
use std::io::Write;
use std::path::{Path, PathBuf};

/// Identify parameters from a log that is larger than the memory, in many processes
///
/// `denavit identify --long` does all of it in one. Here its head says how the log is read (plan),
/// pieces of it become rows (condense), anywhere and in any order, and these are added (estimate):
/// the same numbers to the last bit. Options of all three are those of identify, and the same.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit simulate tulip_leg_identification -o leg.csv
  denavit long plan tulip_leg_table34 --train leg.csv --head 2000 >p.json
  denavit long condense tulip_leg_table34 --train leg.csv --plan p.json --pieces 0:1 >r.json
  denavit long estimate tulip_leg_table34 --train leg.csv --head 2000 --plan p.json --rows r.json")]
pub(crate) struct Arguments {
    #[command(subcommand)]
    work: Work,
}

#[derive(Debug, Subcommand)]
enum Work {
    Plan(Plan),
    Condense(Condense),
    Estimate(Estimate),
}

/// Identify the head of a log, and print as JSON how the rest is read
#[derive(Debug, Args)]
struct Plan {
    #[command(flatten)]
    identify: identify::Arguments,
    /// The log of --train is the head of one with so many rows
    #[arg(long, value_name = "ROWS", requires = "end")]
    rows: Option<usize>,
    /// The time of the last row, as its column has it
    #[arg(long, value_name = "TIME", requires = "rows", allow_negative_numbers = true)]
    end: Option<f64>,
}

/// Print the rows of pieces of a log as lines of JSON
#[derive(Debug, Args)]
struct Condense {
    #[command(flatten)]
    identify: identify::Arguments,
    /// The plan
    #[arg(long, value_name = "PLAN.json")]
    plan: PathBuf,
    /// Pieces from A to before B, read from the log
    #[arg(long, value_name = "A:B", value_parser = range, required_unless_present = "stretch")]
    pieces: Option<(usize, usize)>,
    /// The log of --train is the rows of this stretch alone
    #[arg(long, value_name = "N", conflicts_with = "pieces")]
    stretch: Option<usize>,
    /// Rows of the stretches of its piece that come before
    #[arg(long, value_name = "ROWS.jsonl", requires = "stretch")]
    onto: Option<PathBuf>,
}

/// Estimate parameters from the rows of all pieces
#[derive(Debug, Args)]
struct Estimate {
    #[command(flatten)]
    identify: identify::Arguments,
    /// The plan
    #[arg(long, value_name = "PLAN.json")]
    plan: PathBuf,
    /// Rows of pieces, in their order
    #[arg(long, value_name = "ROWS.jsonl", num_args = 1.., required = true)]
    rows: Vec<PathBuf>,
}

fn range(text: &str) -> Result<(usize, usize), String> {
    let ends = text.split_once(':').and_then(|(a, b)| Some((a.parse().ok()?, b.parse().ok()?)));
    ends.filter(|(a, b)| a < b)
        .ok_or_else(|| "two numbers, the first below the second, as 0:4".into())
}

impl Arguments {
    /// The logs of an option.
    pub(super) fn logs_of(&mut self, option: &str) -> Option<&mut Vec<LogSource>> {
        match &mut self.work {
            Work::Plan(one) => one.identify.logs_of(option),
            Work::Condense(one) => one.identify.logs_of(option),
            Work::Estimate(one) => one.identify.logs_of(option),
        }
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    match &arguments.work {
        Work::Plan(plan) => plan.run(out),
        Work::Condense(condense) => condense.run(out),
        Work::Estimate(estimate) => estimate.run(out),
    }
}

impl Plan {
    fn run(&self, out: &mut dyn Write) -> Result<Answer, Failure> {
        let progress = Progress::new();
        let robot = self.identify.robot()?;
        let (logs, options) = (self.identify.logs()?, self.identify.options(&robot)?);
        let long = long_log(&self.identify, &robot, &logs, &options);
        let plan = long.plan(self.rows.zip(self.end), &mut progress.observer())?;
        progress.clear();
        write_json(out, &plan.to_json())?;
        Ok(Answer::Done)
    }
}

impl Condense {
    fn run(&self, out: &mut dyn Write) -> Result<Answer, Failure> {
        let progress = Progress::new();
        let robot = self.identify.robot()?;
        let (logs, options) = (self.identify.logs()?, self.identify.options(&robot)?);
        let long = long_log(&self.identify, &robot, &logs, &options);
        let plan = read_plan(&self.plan, &options)?;
        let mut observer = progress.observer();
        let pieces = match (self.pieces, self.stretch) {
            (Some((first, end)), _) => long.condense_pieces(&plan, first..end, &mut observer)?,
            (None, stretch) => {
                let stretch = stretch.unwrap_or_default();
                let before = self.onto.as_deref();
                let before = before.map(|path| long.pieces_of_file(&FILES, path)).transpose()?;
                let before = before.and_then(|mut lines| lines.next()).transpose()?;
                vec![long.condense(&plan, stretch, before, &mut observer)?]
            }
        };
        progress.clear();
        for piece in pieces.iter().map(PieceRows::to_json) {
            writeln!(out, "{piece}")?;
        }
        Ok(Answer::Done)
    }
}

impl Estimate {
    fn run(&self, out: &mut dyn Write) -> Result<Answer, Failure> {
        answer(&self.identify, out, |robot, logs, options, progress| {
            let long = long_log(&self.identify, robot, logs, options);
            let plan = read_plan(&self.plan, options)?;
            let files = self.rows.iter().map(|path| long.pieces_of_file(&FILES, path));
            let files = files.collect::<Result<Vec<_>, _>>()?;
            let pieces = files.into_iter().flatten();
            Ok(long.identified(&plan, pieces, &mut progress.observer())?)
        })
    }
}

fn read_plan(path: &Path, options: &IdentifyOptions) -> Result<LongPlan, Failure> {
    let bytes = read_file(path)?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(LongPlan::of_json(&path.display().to_string(), &text, options)?)
}
