//! `denavit excite`: trajectories that excite what is to be identified.

use super::Answer;
use super::base::{With, regressor_options};
use super::failure::Failure;
use super::files::{FILES, read_robot};
use super::outputs::{check_outputs, on_stdout, print_answer, write_given, write_whole};
use super::progress::Progress;
use clap::{Args, ValueEnum};
use denavit::excite::{Check, Columns, Ends, ExciteOptions, Family, Objective};
use denavit::model::Robot;
use denavit::report::answer::{
    ExcitationAnswer, drawn_excitation, excited_json, excited_text, excited_trajectory,
};
use denavit::workflow::{check_excitation, excite};
use std::io::Write;
use std::path::PathBuf;

/// Find a trajectory that excites what is to be identified
///
/// Within the limits of position, velocity, acceleration and torque that the model gives each
/// joint, and with its contact points clear of the ground, the trajectory makes the condition
/// number of the stacked base regressor small. Where the model has no limit of velocity or
/// acceleration, that of one sine a lap over the whole range of positions is taken, and said.
/// Exits with 1, and writes no trajectory, if none keeps the limits or excites all parameters.
#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  denavit excite tulip_leg_table34 --harmonics 3 --starts 2 --evaluations 60 -o leg.json
  denavit excite tulip_leg_table34 --check leg.json
  denavit excite tulip_leg_table34 --basis polynomial --degree 9 --starts 1 --json")]
pub(crate) struct Arguments {
    #[command(flatten)]
    model: super::options::ModelArgument,
    #[command(flatten)]
    effects: super::options::EffectsOption,
    /// Where the trajectory goes, as a trajectory file; - is standard output
    #[arg(short, long, value_name = "TRAJECTORY")]
    output: Option<PathBuf>,
    /// The functions of time
    #[arg(long, value_enum, default_value_t)]
    basis: Basis,
    /// Frequencies of a Fourier series
    #[arg(long, value_name = "N", default_value_t = 5)]
    harmonics: usize,
    /// Degree of polynomials
    #[arg(long, value_name = "N", default_value_t = 12)]
    degree: usize,
    /// Samples joined by a spline, both ends included
    #[arg(long, value_name = "N", default_value_t = 15)]
    samples: usize,
    /// Length of a lap
    #[arg(long, value_name = "SECONDS", default_value_t = 10.0, allow_negative_numbers = true)]
    duration_s: f64,
    /// What is asked of start and end, separated by commas
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_enum,
          default_values_t = [End::Rest, End::Unaccelerated, End::Closed])]
    ends: Vec<End>,
    /// What is made good
    #[arg(long, value_enum, default_value_t)]
    objective: ObjectiveName,
    /// Columns of the regressor count by their length: the condition number of scaled columns
    #[arg(long)]
    scaled: bool,
    /// Joint parameters to add to those of the bodies, separated by commas: as `denavit identify`
    /// does, those that the model has
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_enum,
        default_value = "modelled"
    )]
    with: Vec<With>,
    /// The base parameters whose columns are meant
    #[arg(long, value_enum, default_value_t)]
    parameters: Parameters,
    /// Columns to keep before others, as for `denavit base`
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    keep: Vec<String>,
    /// Joints that do not move, separated by commas: knee=0.5
    #[arg(long, value_name = "JOINT=POSITION", value_delimiter = ',', value_parser = named)]
    hold: Vec<(String, f64)>,
    /// Weights of joints, 1 over the noise of their torque; 1 by default, and 0 for
    /// the wrench on a floating base
    #[arg(long, value_name = "JOINT=WEIGHT", value_delimiter = ',', value_parser = named)]
    weights: Vec<(String, f64)>,
    /// Height that contact points, and points that must not touch, keep; or none
    #[arg(long, value_name = "METRES", default_value = "0.01", value_parser = clearance)]
    clearance_m: Clearance,
    /// Of the starts
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// How many starts
    #[arg(long, value_name = "N", default_value_t = 4)]
    starts: usize,
    /// The largest use of a limit that starts make; above 1 they are infeasible
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true)]
    reach: f64,
    /// Evaluations of a start, at most: of the regressor on the whole grid, with derivatives (1 to
    /// 100000; a few hundred settle, more than 2000 hardly change anything)
    #[arg(long, value_name = "N", default_value_t = 400)]
    evaluations: usize,
    /// Steps of the grid of times that the solver sees
    #[arg(long, value_name = "N")]
    grid: Option<usize>,
    /// Threads; by default as many as the machine has. They do not change the result
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Draw the trajectory with its limits, and the condition number over the iterations; - is
    /// standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Check this trajectory instead of looking for one
    #[arg(long, value_name = "TRAJECTORY", conflicts_with_all = ["output", "svg"])]
    check: Option<PathBuf>,
    /// The answer as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Basis {
    /// Multiples of one frequency: sines and cosines
    #[default]
    Fourier,
    /// Frequencies of each joint's own, chosen too
    FreeFourier,
    /// Polynomials in time
    Polynomial,
    /// Positions at even times, joined by a cubic spline
    Samples,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum End {
    /// No velocity
    Rest,
    /// No acceleration
    Unaccelerated,
    /// The same position: laps can follow each other
    Closed,
    /// Nothing
    Free,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ObjectiveName {
    /// The condition number
    #[default]
    Condition,
    /// The determinant of W^T W: the volume of the confidence region
    DOptimal,
    /// Both: e-folds of the condition number, and mean e-folds of the determinant
    Both,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum Parameters {
    /// Those on the joint axes, in which estimates are computed
    #[default]
    Joints,
    /// Those of kept columns, which are reported
    Kept,
}

/// A height, or none.
#[derive(Clone, Copy, Debug)]
struct Clearance(Option<f64>);

fn clearance(text: &str) -> Result<Clearance, String> {
    if text == "none" {
        return Ok(Clearance(None));
    }
    match text.parse::<f64>() {
        Ok(height) if height.is_finite() => Ok(Clearance(Some(height))),
        _ => Err("a height in metres, or none".to_owned()),
    }
}

fn named(text: &str) -> Result<(String, f64), String> {
    let parts = text.split_once('=').and_then(|(name, number)| {
        let number = number.trim().parse::<f64>().ok().filter(|number| number.is_finite())?;
        Some((name.trim().to_owned(), number))
    });
    parts.ok_or_else(|| "a joint and a number, as knee=0.5".to_owned())
}

impl Arguments {
    fn options(&self, robot: &Robot) -> Result<ExciteOptions, Failure> {
        let has = |end| self.ends.contains(&end);
        let objective = match self.objective {
            ObjectiveName::Condition => Objective::CONDITION,
            ObjectiveName::DOptimal => Objective::D_OPTIMAL,
            ObjectiveName::Both => Objective::BOTH,
        };
        Ok(ExciteOptions {
            family: match self.basis {
                Basis::Fourier => Family::Fourier { harmonics: self.harmonics },
                Basis::FreeFourier => Family::FreeFourier { terms: self.harmonics },
                Basis::Polynomial => Family::Polynomial { degree: self.degree },
                Basis::Samples => Family::Samples { knots: self.samples },
            },
            duration_s: self.duration_s,
            ends: Ends {
                at_rest: has(End::Rest),
                unaccelerated: has(End::Unaccelerated),
                closed: has(End::Closed),
            },
            objective: Objective { is_scaled: self.scaled, ..objective },
            columns: match self.parameters {
                Parameters::Joints => Columns::Axes,
                Parameters::Kept => Columns::Kept,
            },
            with: regressor_options(robot, &self.with)?,
            keep: self.keep.clone(),
            hold: self.hold.clone(),
            weights: self.weights.clone(),
            clearance_m: self.clearance_m.0,
            seed: self.seed,
            starts: self.starts,
            reach: self.reach,
            evaluations: self.evaluations,
            steps: self.grid,
            threads: self.threads,
        })
    }
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    let files = [arguments.output.as_ref(), arguments.svg.as_ref()];
    let is_answered = on_stdout(&files, arguments.json)?;
    check_outputs(&files)?;
    let folder = arguments.effects.effects.as_deref();
    let model = read_robot(&arguments.model.model, folder)?;
    let (effects, robot) = (model.left_out(), model.apart.robot);
    let options = arguments.options(&robot)?;
    if let Some(path) = &arguments.check {
        let (check, stack) = check_excitation(&FILES, &robot, &options, path)?;
        let (stack, check) = (&stack, &check);
        let shown =
            ExcitationAnswer { robot: &robot, effects: &effects, stack, check, excited: None };
        let json = arguments.json;
        print_answer(out, (false, json), || excited_json(&shown), || excited_text(&shown), &[])?;
        return Ok(verdict(check));
    }
    let progress = Progress::new();
    let found = excite(&robot, &options, &mut progress.observer())?;
    progress.clear();
    let answer = verdict(&found.found().ended);
    // what a robot cannot run, or what shows nothing, is no trajectory to be run by mistake
    if let (Some(path), Answer::Done) = (&arguments.output, answer) {
        write_whole(path, excited_trajectory(&found, &options).as_bytes())?;
    }
    write_given(&arguments.svg, || drawn_excitation(&found))?;
    let (stack, check) = (&found.stack, &found.found().ended);
    let excited = Some(&found);
    let shown = ExcitationAnswer { robot: &robot, effects: &effects, stack, check, excited };
    let is_withheld = answer == Answer::Negative
        && arguments.output.as_ref().is_some_and(|path| path.as_os_str() == "-");
    let output = arguments.output.as_ref().filter(|_| answer == Answer::Done);
    let (written, how) =
        ([output, arguments.svg.as_ref()], (is_answered && !is_withheld, arguments.json));
    print_answer(out, how, || excited_json(&shown), || excited_text(&shown), &written)?;
    Ok(answer)
}

/// Negative beyond limits, and where directions of the parameters are not excited at all.
fn verdict(check: &Check) -> Answer {
    match check.is_feasible() && check.excites() {
        true => Answer::Done,
        false => Answer::Negative,
    }
}
