//! `denavit identify`: parameters from logs.

mod estimation;
mod failure;
mod forward;
mod json;
mod logs;
mod page;
mod statics;
mod text;
mod two_stage;

use super::Answer;
use super::base::{With, regressor_options};
use super::failure::Failure;
use super::model_effects::{EffectUse, ModelApart};
use super::options::EffectsOption;
use super::outputs::{check_outputs, on_stdout, say_written, write_whole};
use super::progress::Progress;
use super::said::say_note;
use clap::{Args, ValueEnum};
use denavit::identify::estimate::{Errors, Loss, Method, Options, PriorRow, SlowRows};
use denavit::identify::{Identification, UpdateError, UpdatedModel};
use denavit::measure::log::LogRemark;
use denavit::model::Robot;
use denavit::plants::regression::{CoulombLaw, RegressionModel};
use denavit::report::{TorquePicture, torque_picture};
use denavit::simulate::STICTION_RATE;
use estimation::Estimation;
pub(crate) use failure::IdentifyFailure;
use forward::{Controlled, SimulationGap};
use logs::Conditions;
use std::io::Write;
use std::path::PathBuf;

/// Identify parameters: base parameters with standard errors, from logs of motion and torque
///
/// A log is CSV with the columns t, q_JOINT, tau_JOINT (qd_, qdd_, ref_, f_CONTACT_x|y|z if there
/// are any), or MCAP or the folder of a ROS 2 bag with sensor_msgs/JointState
/// (docs/reference/logs.md); --columns maps those of other logs. Positions and torques pass one
/// zero-phase filter, torques and regressor one decimator. Base parameters are exact; what the
/// motion does not show keeps the model's value and is said to. Exits with 1 if what is found
/// leaves as much of the torques as nothing would, or, of the torque of a joint that moves, nearly
/// all, or a third that is no noise; or if a log of --validate says the same as one of --train.
#[derive(Debug, Default, Args)]
#[command(after_help = "\
Examples:
  denavit simulate tulip_leg_identification -o leg.csv
  denavit identify tulip_leg_table34 --train leg.csv --keep e6,c6x*m6,m6,e5,c5x*m5,e4
  denavit identify tulip_leg_table34 --train leg.csv --svg torques.svg --html leg.html
  denavit identify tulip_leg_table34 --train leg.csv --method huber -o identified.json --json
  denavit simulate tulip_leg_tracking -o tracking.csv
  denavit identify tulip_leg --train tracking.csv --filter 20 --controller tulip_leg
  denavit simulate tulip_leg_elastic_identification -o springs.csv
  denavit identify tulip_leg --train springs.csv --two-stage --friction tanh --accept-suspicious")]
pub(crate) struct Arguments {
    /// Path of a model, name of a shipped one, or - for standard input
    #[arg(value_name = "MODEL")]
    model: PathBuf,
    #[command(flatten)]
    effects: EffectsOption,
    /// Logs to estimate from
    #[arg(long, value_name = "LOG", num_args = 1.., required_unless_present = "statics")]
    train: Vec<PathBuf>,
    /// Logs to judge the estimate with
    #[arg(long, value_name = "LOG", num_args = 1..)]
    validate: Vec<PathBuf>,
    /// Logs of the same motion without its noise, for --method iv: simulated, sample by sample.
    /// With --controller they are simulated with what least squares finds
    #[arg(long, value_name = "LOG", num_args = 1..)]
    instruments: Vec<PathBuf>,
    /// What drove the robot, as a controller file or the name of a shipped one: simulate the logs
    /// for validation (or, without any, those of the estimate) again in closed loop
    #[arg(long, value_name = "FILE")]
    controller: Option<PathBuf>,
    /// Without a controller, logs for validation are simulated again in windows of this length
    #[arg(long, value_name = "SECONDS", default_value = "0.2", value_parser = window,
        conflicts_with = "controller")]
    window: f64,
    /// Springs and motors of series elastic drives first, from one log with motor_JOINT and
    /// tau_cmd_JOINT, then the load with what the springs pass on
    #[arg(long, conflicts_with_all = ["method", "controller", "prior", "motion_svg", "statics"])]
    two_stage: bool,
    /// Weighings and held postures: say which parameters, or sums of them, follow from these,
    /// joined with the logs for the estimate if there are any
    #[arg(long = "static", value_name = "FILE", conflicts_with_all = ["svg", "html", "motion_svg",
        "output", "validate"])]
    statics: Option<PathBuf>,
    /// Coulomb friction as the sign of the rate of a joint, or as tanh(rate / RATE), with which
    /// logs are then simulated too [rad/s, m/s]; 0.01 if no RATE is given
    #[arg(long, value_name = "sign|tanh[:RATE]", value_parser = friction, default_value = "sign")]
    friction: CoulombLaw,
    /// Leave out the rows of a joint near reversals, within the filter's time, where they bias its
    /// Coulomb friction (biasing), or none (off), or those in which it is slower than a rate
    /// [rad/s, m/s] or turns round; noise is three times what the steps of its encoder make of one
    #[arg(long, value_name = "biasing|off|RATE|noise", value_parser = slow,
        default_value = "biasing")]
    skip_slow: SlowRows,
    /// How parameters are estimated
    #[arg(long, value_enum, default_value_t)]
    method: MethodName,
    /// How standard errors are found
    #[arg(long, value_enum, default_value_t)]
    errors: ErrorsName,
    /// What random drawings begin with
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Joint parameters to find, separated by commas
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_enum,
        default_value = "modelled"
    )]
    with: Vec<With>,
    /// Parameters to keep before others, as for `denavit base`
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    keep: Vec<String>,
    /// Which columns of the logs are ours: {"q_knee": {"column": "a", "scale": 1, "offset": 0},
    /// "q_{joint}": "/joint_states/{joint}/position"}
    #[arg(long, value_name = "MAP.json")]
    columns: Option<PathBuf>,
    #[command(flatten)]
    conditions: Conditions,
    /// Take the standard deviations that the model states as knowledge
    #[arg(long)]
    prior: bool,
    /// The step of the encoders [rad, m], for --method ml where it cannot be seen in the log
    #[arg(long, value_name = "STEP", value_parser = resolution)]
    resolution: Option<f64>,
    /// Take logs as they are, however wrong they look
    #[arg(long)]
    accept_suspicious: bool,
    /// Of a log that is cut or corrupt, take what is before the damage
    #[arg(long)]
    accept_cut: bool,
    /// Write the model with the identified values; - is standard output
    #[arg(short, long, value_name = "MODEL")]
    output: Option<PathBuf>,
    /// Draw measured and computed torques; - is standard output
    #[arg(long, value_name = "FILE")]
    svg: Option<PathBuf>,
    /// Draw measured and simulated positions; - is standard output
    #[arg(long, value_name = "FILE")]
    motion_svg: Option<PathBuf>,
    /// Write all of it as one page of HTML; - is standard output
    #[arg(long, value_name = "FILE")]
    html: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    json: bool,
}

fn window(text: &str) -> Result<f64, String> {
    let length = text.parse::<f64>().ok().filter(|length| (1e-4..=100.0).contains(length));
    length.ok_or_else(|| "a time from 0.0001 to 100 s".to_owned())
}

fn resolution(text: &str) -> Result<f64, String> {
    let step = text.parse::<f64>().ok().filter(|step| *step > 0.0 && *step <= 1.0);
    step.ok_or_else(|| "a step above 0 and up to 1 rad or m".to_owned())
}

fn rate(text: &str) -> Option<f64> {
    text.parse::<f64>().ok().filter(|rate| (1e-9..=1e3).contains(rate))
}

fn slow(text: &str) -> Result<SlowRows, String> {
    match text {
        "biasing" => Ok(SlowRows::Biasing),
        "off" => Ok(SlowRows::Kept),
        "noise" => Ok(SlowRows::Noise),
        text => {
            let below = rate(text).map(SlowRows::Below);
            below.ok_or_else(|| {
                "a rate from 1e-9 to 1000 rad/s or m/s, `biasing`, `noise`, or `off`".to_owned()
            })
        }
    }
}

fn friction(text: &str) -> Result<CoulombLaw, String> {
    match text.split_once(':') {
        None if text == "sign" => Ok(CoulombLaw::Sign),
        None if text == "tanh" => Ok(CoulombLaw::Tanh(STICTION_RATE)),
        Some(("tanh", width)) if rate(width).is_some() => {
            Ok(CoulombLaw::Tanh(rate(width).unwrap_or(STICTION_RATE)))
        }
        _ => {
            Err("`sign`, `tanh`, or `tanh:RATE` with a rate from 1e-9 to 1000 rad/s or m/s"
                .to_owned())
        }
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum MethodName {
    /// Least squares, all torques alike
    Ols,
    /// Least squares, each joint weighted by its noise
    #[default]
    Wls,
    /// Outliers count by their size, not its square
    Huber,
    /// Outliers do not count
    Bisquare,
    /// Total least squares
    Tls,
    /// Instrumental variables
    Iv,
    /// Maximum likelihood with noise of positions and torques
    Ml,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum ErrorsName {
    /// Residuals may be correlated over a part of the log
    #[default]
    Correlated,
    /// As if residuals were independent
    Classical,
    /// From logs put together of parts drawn at random
    Bootstrap,
}

impl Arguments {
    /// The model, its effects apart.
    fn model_apart(&self) -> Result<ModelApart, Failure> {
        ModelApart::read(&self.model, self.effects.effects.as_deref())
    }

    fn options(&self, model: &RegressionModel, noise: Vec<f64>) -> Result<Options, Failure> {
        let method = match self.method {
            MethodName::Ols => Method::Ordinary,
            MethodName::Wls => Method::Weighted,
            MethodName::Huber => Method::Robust(Loss::Huber),
            MethodName::Bisquare => Method::Robust(Loss::Bisquare),
            MethodName::Tls => Method::Total,
            MethodName::Iv => Method::Instrumental,
            MethodName::Ml => Method::Likelihood,
        };
        let errors = match self.errors {
            ErrorsName::Correlated => Errors::Correlated,
            ErrorsName::Classical => Errors::Classical,
            ErrorsName::Bootstrap => Errors::Bootstrap { draws: 200, seed: self.seed },
        };
        let prior = if self.prior { prior(model) } else { Vec::new() };
        if self.prior && prior.is_empty() {
            return Err(IdentifyFailure::NoPrior(model.model.clone()).into());
        }
        Ok(Options { method, errors, prior, position_noise: noise, slow: self.skip_slow })
    }
}

/// What the model's standard deviations say of base parameters: those that depend on no number
/// without one, to first order.
fn prior(model: &RegressionModel) -> Vec<PriorRow> {
    let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
    let listed = |values: &[f64]| -> Vec<f64> {
        let standard = model.standard_values(values);
        let sum = |one: &denavit::plants::regression::RegressionParameter| {
            one.members.iter().map(|&(at, factor)| factor * standard[at]).sum()
        };
        model.listed.iter().map(sum).collect()
    };
    let here = listed(&values);
    let mut variances = vec![Some(0.0); here.len()];
    let mut moved = values.clone();
    for (place, parameter) in model.parameters.iter().enumerate() {
        let step = 1e-4 * parameter.value.abs().max(1e-2);
        moved[place] = parameter.value + step;
        let above = listed(&moved);
        moved[place] = parameter.value - step;
        let below = listed(&moved);
        moved[place] = parameter.value;
        for (variance, (above, below)) in variances.iter_mut().zip(above.iter().zip(&below)) {
            let slope = (above - below) / (2.0 * step);
            if slope.abs() > 1e-12 {
                let own = parameter.std.map(|std| (slope * std).powi(2));
                *variance = variance.and_then(|sum: f64| Some(sum + own?));
            }
        }
    }
    let of = |(row, variance): (usize, &Option<f64>)| {
        let std = variance.filter(|variance| *variance > 0.0)?.sqrt();
        let value = model.listed[row].value?;
        let factors = model.to_listed().row(row).iter().copied().collect();
        Some(PriorRow { factors, value, std })
    };
    variances.iter().enumerate().filter_map(of).collect()
}

/// Everything that is shown.
struct Shown<'a> {
    robot: &'a Robot,
    model: &'a RegressionModel,
    found: &'a Identification,
    remarks: &'a [(String, LogRemark)],
    /// What became of the model's effects.
    effects: &'a [EffectUse],
    simulated: Option<&'a SimulationGap>,
}

/// All that the arguments lead to.
struct Answered {
    robot: Robot,
    model: RegressionModel,
    found: Identification,
    /// The model with what was found.
    updated: Result<UpdatedModel, UpdateError>,
    remarks: Vec<(String, LogRemark)>,
    effects: Vec<EffectUse>,
    simulated: Option<SimulationGap>,
}

/// What becomes of laws beside the equations.
const TAKEN_OUT: (&str, &str) = (
    "taken_out",
    "a law beside the equations of the bodies: taken out of the logs with the values of the model",
);

impl Answered {
    fn new(arguments: &Arguments, progress: &Progress) -> Result<Self, Failure> {
        let given = arguments.model_apart()?;
        let effects = given.uses(TAKEN_OUT);
        let ModelApart { whole, apart, own, source } = given;
        let (robot, laws) = (apart.robot, &apart.laws[..]);
        let options = regressor_options(&robot, &arguments.with)?;
        let mut model = RegressionModel::new(&robot, options, &arguments.keep)
            .map_err(|error| IdentifyFailure::Regression(Box::new(error)))?;
        model.law = arguments.friction;
        progress.show("reading logs");
        let (own, source) = (&own[..], &source);
        let estimation =
            Estimation { arguments, robot: &robot, laws, model: &model, own, source, progress };
        let mut read = estimation.read(&[])?;
        let controller = arguments.controller.as_deref();
        let controller = controller.map(|path| Controlled::read(path, &whole)).transpose()?;
        let options = arguments.options(&model, read.position_noise.clone())?;
        if options.method == Method::Instrumental && read.instruments.is_empty() {
            let controller = controller.as_ref().ok_or(IdentifyFailure::NoInstruments)?;
            let first = Options { method: Method::Weighted, ..options.clone() };
            let updated = estimation.found(&read, &first)?.1.map_err(IdentifyFailure::Update)?;
            progress.show("simulating instruments");
            read.instruments = controller.instruments(&updated.robot, &read, arguments)?;
        }
        let (read, (found, updated)) = estimation.unbiased(read, &options)?;
        let is_sure = found.misread.iter().any(|one| one.is_sure);
        if is_sure && !arguments.accept_suspicious {
            return Err(IdentifyFailure::Misread(found.misread).into());
        }
        progress.show("simulating the logs again");
        let simulated = match (&controller, read.motions.is_empty()) {
            (_, true) => None,
            (controller, false) => Some(SimulationGap::new(
                (&whole, &updated),
                controller.as_ref(),
                (&read.motions, arguments.window),
            )),
        };
        if let (Some(gap), true) = (&simulated, controller.is_some()) {
            gap.check()?;
        }
        let remarks = read.into_remarks();
        Ok(Self { robot, model, found, updated, remarks, effects, simulated })
    }

    fn shown(&self) -> Shown<'_> {
        let Self { robot, model, found, remarks, effects, simulated, .. } = self;
        Shown { robot, model, found, remarks, effects, simulated: simulated.as_ref() }
    }
}

/// What is found in one log below a frequency \[Hz\], and its page.
pub(crate) fn of_log(
    model: &str,
    (log, cutoff_hz): (PathBuf, f64),
    progress: &Progress,
) -> Result<(Identification, String), Failure> {
    let arguments = Arguments {
        model: PathBuf::from(model),
        train: vec![log],
        seed: 1,
        with: vec![With::Modelled],
        conditions: Conditions::filtered(cutoff_hz),
        ..Arguments::default()
    };
    let answered = Answered::new(&arguments, progress)?;
    let page = page::of(&arguments, &answered.shown())?;
    Ok((answered.found, page))
}

/// Says on standard error what speaks against an answer that went into a document.
fn say_doubts(shown: &Shown<'_>) -> Result<(), Failure> {
    let mut doubts = Vec::new();
    text::write_doubts(&mut doubts, shown)?;
    if !doubts.is_empty() {
        say_note(&String::from_utf8_lossy(&doubts).trim_end_matches('\n'));
    }
    Ok(())
}

pub(crate) fn run(arguments: &Arguments, out: &mut dyn Write) -> Result<Answer, Failure> {
    if !arguments.instruments.is_empty() && arguments.method != MethodName::Iv {
        return Err(IdentifyFailure::UnusedInstruments.into());
    }
    if arguments.two_stage {
        return two_stage::run(arguments, out);
    }
    if let Some(path) = &arguments.statics {
        return statics::run(arguments, path, out);
    }
    let outputs = [
        arguments.output.as_ref(),
        arguments.svg.as_ref(),
        arguments.motion_svg.as_ref(),
        arguments.html.as_ref(),
    ];
    let is_answered = on_stdout(&outputs, arguments.json)?;
    check_outputs(&outputs)?;
    let progress = Progress::new();
    let answered = Answered::new(arguments, &progress)?;
    progress.clear();
    let Answered { model, found, updated, .. } = &answered;
    if let Some(path) = &arguments.svg {
        let picture = TorquePicture {
            title: &model.model.replace('_', " "),
            subtitle: if found.validate.is_some() {
                "torques of the logs for validation"
            } else {
                "torques of the logs that the estimate is from"
            },
            validation: found.validate.as_ref().unwrap_or(&found.train),
        };
        write_whole(path, torque_picture(&picture).as_bytes())?;
    }
    if let Some(path) = &arguments.output {
        let updated = updated.as_ref().map_err(|error| IdentifyFailure::Update(error.clone()))?;
        write_whole(path, updated.text.as_bytes())?;
    }
    let shown = answered.shown();
    if let Some(path) = &arguments.motion_svg {
        let drawn = shown.simulated.and_then(|gap| forward::picture(&model.model, gap));
        let drawn = drawn.ok_or(IdentifyFailure::NotSimulated)?;
        write_whole(path, drawn.as_bytes())?;
    }
    if let Some(path) = &arguments.html {
        write_whole(path, page::of(arguments, &shown)?.as_bytes())?;
    }
    match (is_answered, arguments.json) {
        // the document has no place for it
        (true, _) => say_doubts(&shown)?,
        (_, true) => json::write(out, &shown)?,
        (_, false) => {
            text::write(out, &shown)?;
            say_written(out, &outputs)?;
        }
    }
    let judged = found.validate.as_ref().unwrap_or(&found.train);
    let is_doubted = found.is_noise() || !found.misread.is_empty() || found.is_of_other_robot();
    let is_doubted = is_doubted && !arguments.accept_suspicious || found.no_bodies().is_some();
    let is_same = |(_, remark): &(String, LogRemark)| matches!(remark, LogRemark::SameAs { .. });
    let explains = !answered.remarks.iter().any(is_same)
        && judged.relative < 1.0
        && found.unexplained.is_empty()
        && found.contradicting_logs.is_empty();
    Ok(if explains && !is_doubted { Answer::Done } else { Answer::Negative })
}
