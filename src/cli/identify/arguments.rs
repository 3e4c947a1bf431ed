//! The arguments of `denavit identify`, and what they ask the library for.

use crate::cli::base::{With, regressor_options};
use crate::cli::failure::Failure;
use crate::cli::files::{self, FILES, mapping};
use crate::cli::logs::{log_source, note_logs};
use crate::cli::options::EffectsOption;
use clap::{Args, ValueEnum, ValueHint};
use denavit::identify::estimate::{Errors, Loss, Method, SlowRows};
use denavit::measure::condition::{Averaging, Derivatives, Filter};
use denavit::plants::regression::CoulombLaw;
use denavit::simulate::STICTION_RATE;
use denavit::workflow::{
    Conditions, Controlled, FilterChoice, IdentifyOptions, LogSource, Logs, RobotFile,
};
use std::path::PathBuf;

/// Identify parameters: base parameters with standard errors, from logs of motion and torque
///
/// A log is CSV with the columns t, q_JOINT, tau_JOINT (qd_, qdd_, ref_, f_CONTACT_x|y|z if there
/// are any), or MCAP or the folder of a ROS 2 bag with sensor_msgs/JointState
/// (docs/reference/logs.md); --columns maps those of other logs. Positions and torques pass one
/// zero-phase filter, torques and regressor one decimator. Base parameters are exact; what the
/// motion does not show keeps its nominal value, and is marked. Exits with 1 if what is found
/// explains nothing of the torques, or hardly anything of the torque of a joint that moves, or if
/// a third of such a torque is a residual that is no noise, or if a log of --validate says the
/// same as one of --train.
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
    pub(super) model: PathBuf,
    #[command(flatten)]
    pub(super) effects: EffectsOption,
    /// Logs to estimate from
    #[arg(long, value_name = "LOG", num_args = 1.., value_parser = log_source(),
        value_hint = ValueHint::AnyPath, required_unless_present = "statics")]
    pub(super) train: Vec<LogSource>,
    /// Logs to judge the estimate with
    #[arg(long, value_name = "LOG", num_args = 1.., value_parser = log_source(),
        value_hint = ValueHint::AnyPath)]
    pub(super) validate: Vec<LogSource>,
    /// Logs of the same motion without its noise, for --method iv: simulated, sample by sample.
    /// With --controller they are simulated with what least squares finds
    #[arg(long, value_name = "LOG", num_args = 1.., value_parser = log_source(),
        value_hint = ValueHint::AnyPath)]
    pub(super) instruments: Vec<LogSource>,
    /// What drove the robot, as a controller file or the name of a shipped one: simulate the logs
    /// for validation (or, without any, those of the estimate) again in closed loop
    #[arg(long, value_name = "FILE")]
    pub(super) controller: Option<PathBuf>,
    /// Without a controller, logs for validation are simulated again in windows of this length
    #[arg(long, value_name = "SECONDS", default_value = "0.2", value_parser = window,
        conflicts_with = "controller")]
    pub(super) window: f64,
    /// Springs and motors of series elastic drives first, from one log with motor_JOINT and
    /// tau_cmd_JOINT, then the load with what the springs pass on
    #[arg(long, conflicts_with_all = ["method", "controller", "prior", "motion_svg", "statics"])]
    pub(super) two_stage: bool,
    /// Weighings and held postures: say which parameters, or sums of them, follow from these,
    /// joined with the logs for the estimate if there are any
    #[arg(long = "static", value_name = "FILE", conflicts_with_all = ["svg", "html", "motion_svg",
        "output", "validate"])]
    pub(super) statics: Option<PathBuf>,
    /// Coulomb friction as the sign of a joint's velocity, or as tanh(velocity / SLOW), with which
    /// logs are then simulated too [rad/s, m/s]; 0.01 if no SLOW is given
    #[arg(long, value_name = "sign|tanh[:SLOW]", value_parser = friction, default_value = "sign")]
    pub(super) friction: CoulombLaw,
    /// Leave out the rows of a joint near reversals, within the filter's time, where they bias its
    /// Coulomb friction (biasing), or none (off), or those in which it is slower than a velocity
    /// [rad/s, m/s] or reverses; noise is three times what the steps of its encoder make of one
    #[arg(long, value_name = "biasing|off|VELOCITY|noise", value_parser = slow,
        default_value = "biasing")]
    pub(super) skip_slow: SlowRows,
    /// How parameters are estimated
    #[arg(long, value_enum, default_value_t)]
    pub(super) method: MethodName,
    /// How standard errors are found
    #[arg(long, value_enum, default_value_t)]
    pub(super) errors: ErrorsName,
    /// What random drawings begin with
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub(super) seed: u64,
    /// Joint parameters to find, separated by commas
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        value_enum,
        default_value = "modelled"
    )]
    pub(super) with: Vec<With>,
    /// Parameters to keep before others, as for `denavit base`
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(super) keep: Vec<String>,
    /// Which columns of the logs are ours: {"q_knee": {"column": "a", "scale": 1, "offset": 0},
    /// "q_{joint}": "/joint_states/{joint}/position"}
    #[arg(long, value_name = "MAP.json")]
    pub(super) columns: Option<PathBuf>,
    #[command(flatten)]
    pub(super) conditions: ConditionArguments,
    /// Take the standard deviations that the model states as knowledge
    #[arg(long)]
    pub(super) prior: bool,
    /// The step of the encoders [rad, m], for --method ml where it cannot be seen in the log
    #[arg(long, value_name = "STEP", value_parser = resolution)]
    pub(super) resolution: Option<f64>,
    /// Take logs as they are, however wrong they look
    #[arg(long)]
    pub(super) accept_suspicious: bool,
    /// Of a log that is cut or corrupt, take what is before the damage
    #[arg(long)]
    pub(super) accept_cut: bool,
    /// Read the log piece by piece, so that it may be larger than the memory: one table of samples
    /// at equal distances. Its head is identified as any log is, and says how the rest is read
    #[arg(long, conflicts_with_all = ["two_stage", "statics", "controller", "motion_svg"])]
    pub(super) long: bool,
    /// Rows of the head of a log that is read piece by piece; 524288 by default
    #[arg(long, value_name = "ROWS", value_parser = clap::value_parser!(u32).range(1000..))]
    pub(super) head: Option<u32>,
    /// Write the model with the identified values; - is standard output
    #[arg(short, long, value_name = "MODEL")]
    pub(super) output: Option<PathBuf>,
    /// Draw measured and computed torques; - is standard output
    #[arg(long, value_name = "FILE")]
    pub(super) svg: Option<PathBuf>,
    /// Draw measured and simulated positions; - is standard output
    #[arg(long, value_name = "FILE")]
    pub(super) motion_svg: Option<PathBuf>,
    /// Write all of it as one page of HTML; - is standard output
    #[arg(long, value_name = "FILE")]
    pub(super) html: Option<PathBuf>,
    /// Print JSON
    #[arg(long)]
    pub(super) json: bool,
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
                "a velocity from 1e-9 to 1000 rad/s or m/s, `biasing`, `noise`, or `off`".to_owned()
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
        _ => Err(
            "`sign`, `tanh`, or `tanh:SLOW` with a velocity SLOW from 1e-9 to 1000 rad/s or m/s"
                .to_owned(),
        ),
    }
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum MethodName {
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
pub(super) enum ErrorsName {
    /// Residuals may be correlated over a part of the log
    #[default]
    Correlated,
    /// As if residuals were independent
    Classical,
    /// From logs put together of parts drawn at random
    Bootstrap,
}

/// How logs are conditioned.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(super) struct ConditionArguments {
    /// Cutoff of the zero-phase Butterworth filter [Hz], with the order of one pass if it is not 4;
    /// or none. By default, a tenth of the sampling rate, halved as long as noise of the
    /// positions biases parameters
    #[arg(long, value_name = "HZ[:ORDER]", value_parser = filter, allow_negative_numbers = true)]
    filter: Option<FilterChoice>,
    /// Leave one sample in so many; by default, as the filter allows and 1200 remain
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    decimate: Option<u32>,
    /// Average laps of this period [s], or of the one that is found
    #[arg(long, value_name = "PERIOD|found", value_parser = averaging)]
    average: Option<Averaging>,
    /// Where velocities and accelerations come from
    #[arg(long, value_enum, default_value_t)]
    derivatives: DerivativesName,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
enum DerivativesName {
    /// Differences of the filtered positions
    #[default]
    Differences,
    /// The columns qd_ and qdd_ of the log
    Logged,
}

fn filter(text: &str) -> Result<FilterChoice, String> {
    if text == "none" {
        return Ok(FilterChoice::None);
    }
    let (cutoff, order) = text.split_once(':').unwrap_or((text, "4"));
    match (cutoff.parse::<f64>(), order.parse::<usize>()) {
        (Ok(cutoff_hz), Ok(order)) if cutoff_hz > 0.0 && (1..=10).contains(&order) => {
            Ok(FilterChoice::Given(Filter { order, cutoff_hz }))
        }
        _ => Err("a cutoff in Hz, with an order from 1 to 10 perhaps, as 100:4; or none".into()),
    }
}

fn averaging(text: &str) -> Result<Averaging, String> {
    match text.parse::<f64>() {
        _ if text == "found" => Ok(Averaging::Found),
        Ok(period) if period > 0.0 && period.is_finite() => Ok(Averaging::Period(period)),
        _ => Err("a period in seconds, or `found`".to_owned()),
    }
}

impl Arguments {
    /// The robot.
    pub(crate) fn robot(&self) -> Result<RobotFile, Failure> {
        files::read_robot(&self.model, self.effects.effects.as_deref())
    }

    /// The logs of an option.
    pub(crate) fn logs_of(&mut self, option: &str) -> Option<&mut Vec<LogSource>> {
        match option {
            "train" => Some(&mut self.train),
            "validate" => Some(&mut self.validate),
            "instruments" => Some(&mut self.instruments),
            _ => None,
        }
    }

    /// The logs.
    pub(crate) fn logs(&self) -> Result<Logs, Failure> {
        note_logs([&self.train, &self.validate, &self.instruments].into_iter().flatten());
        Ok(Logs {
            train: self.train.clone(),
            held_out: self.validate.clone(),
            columns: mapping(self.columns.as_deref())?,
            accepts_suspicious: self.accept_suspicious,
            accepts_cut: self.accept_cut,
        })
    }

    /// Everything else that the library is asked for.
    pub(crate) fn options(&self, robot: &RobotFile) -> Result<IdentifyOptions, Failure> {
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
        let controller = self.controller.as_deref();
        let controller =
            controller.map(|path| Controlled::read(&FILES, path, &robot.whole)).transpose()?;
        Ok(IdentifyOptions {
            with: Some(regressor_options(&robot.apart.robot, &self.with)?),
            keep: self.keep.clone(),
            method,
            errors,
            slow: self.skip_slow,
            friction: self.friction,
            conditions: self.conditions.conditions(),
            instruments: self.instruments.clone(),
            controller,
            window_s: self.window,
            uses_prior: self.prior,
            resolution: self.resolution,
        })
    }
}

impl ConditionArguments {
    fn conditions(&self) -> Conditions {
        Conditions {
            filter: self.filter.unwrap_or_default(),
            decimation: self.decimate.map(|one_in| one_in as usize),
            averaging: self.average.unwrap_or_default(),
            derivatives: match self.derivatives {
                DerivativesName::Differences => Derivatives::Central,
                DerivativesName::Logged => Derivatives::Logged,
            },
        }
    }
}
