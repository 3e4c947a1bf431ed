//! Units that nothing but the model shows: time that runs ten times too fast, torques in mN m,
//! angles in degrees. The model's own values make of the motion what is in the log when the unit is
//! another one.

use super::exchanged::{Window, windows};
use crate::identify::condition::Conditioned;
use crate::plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};
use std::fmt;

/// Factors that are tried of time and torques.
const FACTORS: [f64; 6] = [1e-3, 1e-2, 0.1, 10.0, 100.0, 1e3];

/// Those of angles: degrees that were taken for radians, and radians for degrees.
const OF_ANGLES: [f64; 2] = [std::f64::consts::PI / 180.0, 180.0 / std::f64::consts::PI];

/// What is left must fall to this share of what was left before, and to less than this share of
/// the squares of torques: of those of all joints, or, where one column alone is in question, which
/// other faults of a model's values resemble more, of that.
const BETTER: f64 = 0.25;
const LEFT: f64 = 0.4;
const LEFT_OF_ONE: f64 = 0.1;

/// What is in another unit.
#[derive(Clone, Debug, PartialEq)]
pub enum MistakenQuantity {
    /// The time.
    Time,
    /// All torques.
    Torques,
    /// The torque of one joint.
    TorqueOf(String),
    /// The positions of all joints that turn.
    Angles,
    /// The position of one joint that turns.
    AngleOf(String),
}

/// A unit that seems to be another one.
#[derive(Clone, Debug, PartialEq)]
pub struct MistakenUnits {
    /// Of what.
    pub of: MistakenQuantity,
    /// What the columns are to be multiplied with.
    pub factor: f64,
    /// The share of the squares of torques (of that torque, if it is one joint's) that the model's
    /// values leave, as the logs are and with the factor.
    pub left: [f64; 2],
}

impl fmt::Display for MistakenUnits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        use MistakenQuantity::{AngleOf, Angles, Time, TorqueOf, Torques};
        let Self { of, factor, left: [before, after] } = self;
        let (what, column) = match of {
            Time => ("the time".to_owned(), "t".to_owned()),
            Torques => ("torques".to_owned(), "tau_JOINT".to_owned()),
            TorqueOf(joint) => (format!("the torque of {joint}"), format!("tau_{joint}")),
            Angles => ("positions".to_owned(), "q_JOINT".to_owned()),
            AngleOf(joint) => (format!("the position of {joint}"), format!("q_{joint}")),
        };
        let verb = if matches!(of, Torques | Angles) { "seem" } else { "seems" };
        write!(
            f,
            "{what} {verb} to be in another unit: of the squares of torques the model's own values \
             leave {:.0} %, and {:.0} % with {factor} times {what}\n  hint: --columns with \
             {{\"{column}\": {{\"scale\": {factor}}}}} mends that",
            100.0 * before,
            100.0 * after
        )
    }
}

/// What the columns of a log are multiplied with.
#[derive(Clone)]
struct Scales {
    time: f64,
    positions: Vec<f64>,
    torques: Vec<f64>,
}

impl Scales {
    fn straight(n: usize) -> Self {
        Self { time: 1.0, positions: vec![1.0; n], torques: vec![1.0; n] }
    }
}

/// The unit with which the model's values make far more of the torques, if there is one; none if
/// the model lacks a value. Single columns are looked at only where `is_misfit`: where the estimate
/// explains the torques, its parameters are what differs from the model's.
/// Where the log `is_noisy`,
/// a slower time and smaller angles are not tried: they fit since they have less noise.
pub fn mistaken_units(
    model: &RegressionModel,
    logs: &[Conditioned],
    [is_misfit, is_noisy]: [bool; 2],
) -> Option<MistakenUnits> {
    use MistakenQuantity::{AngleOf, TorqueOf};
    let phi = model.model_axes()?;
    let own = |places: &Vec<usize>| places.iter().map(|&at| phi[at]).collect();
    let mut balance = Balance {
        evaluator: model.evaluator(),
        own: model.pattern().iter().map(own).collect(),
        windows: windows(logs),
    };
    let before = balance.left(&Scales::straight(model.joints.len()));
    let tried = candidates(model, is_misfit, is_noisy);
    let mut best: Option<(f64, MistakenUnits)> = None;
    for Candidate { of, factor, one, scales } in tried {
        let after = balance.left(&scales);
        let share = |left: &[Option<f64>]| match one {
            Some(joint) => left[joint],
            None => Some(mean(&measured(left))),
        };
        let (Some(was), Some(is)) = (share(&before), share(&after)) else { continue };
        let is_of_one = matches!(of, TorqueOf(_) | AngleOf(_));
        let most = if is_of_one { LEFT_OF_ONE } else { LEFT };
        let all = mean(&measured(&after));
        let is_better = is < most.min(BETTER * was);
        if is_better && best.as_ref().is_none_or(|(least, _)| all < *least) {
            best = Some((all, MistakenUnits { of, factor, left: [was, is] }));
        }
    }
    best.map(|(_, units)| units)
}

/// What is tried.
struct Candidate {
    of: MistakenQuantity,
    factor: f64,
    /// The joint whose torque alone it changes.
    one: Option<usize>,
    scales: Scales,
}

/// All that is tried.
fn candidates(model: &RegressionModel, is_misfit: bool, is_noisy: bool) -> Vec<Candidate> {
    use MistakenQuantity::{AngleOf, Angles, Time, TorqueOf, Torques};
    let n = model.joints.len();
    let straight = Scales::straight(n);
    let is_angle = |joint: &usize| !model.joints[*joint].slides && !model.joints[*joint].is_base;
    let turns: Vec<usize> = (0..n).filter(is_angle).collect();
    let mut tried = Vec::new();
    for factor in FACTORS {
        if !(is_noisy && factor > 1.0) {
            tried.push(Candidate {
                of: Time,
                factor,
                one: None,
                scales: Scales { time: factor, ..straight.clone() },
            });
        }
        let torques = vec![factor; n];
        tried.push(Candidate {
            of: Torques,
            factor,
            one: None,
            scales: Scales { torques, ..straight.clone() },
        });
    }
    for factor in OF_ANGLES.into_iter().filter(|factor| !(is_noisy && *factor < 1.0)) {
        let scaled = |joints: &[usize]| {
            let mut scales = straight.clone();
            joints.iter().for_each(|&joint| scales.positions[joint] = factor);
            scales
        };
        if !turns.is_empty() {
            tried.push(Candidate { of: Angles, factor, one: None, scales: scaled(&turns) });
        }
        for &joint in turns.iter().filter(|_| is_misfit && turns.len() > 1) {
            let of = AngleOf(model.joints[joint].name.clone());
            tried.push(Candidate { of: of, factor, one: None, scales: scaled(&[joint]) });
        }
    }
    for (joint, one) in model.joints.iter().enumerate().filter(|_| is_misfit && n > 1) {
        let ratio = one.gear_ratio;
        let gears = [ratio, 1.0 / ratio].into_iter().filter(|gear| gear.is_finite());
        for factor in FACTORS.into_iter().chain(gears.filter(|gear| (gear - 1.0).abs() > 0.5)) {
            let mut scales = straight.clone();
            scales.torques[joint] = factor;
            tried.push(Candidate {
                of: TorqueOf(one.name.clone()),
                factor,
                one: Some(joint),
                scales: scales,
            });
        }
    }
    tried
}

/// The shares of joints whose torque was measured.
fn measured(left: &[Option<f64>]) -> Vec<f64> {
    left.iter().copied().flatten().collect()
}

fn mean(shares: &[f64]) -> f64 {
    shares.iter().sum::<f64>() / shares.len().max(1) as f64
}

struct Balance {
    evaluator: RegressionEvaluator,
    /// The model's values of each joint's columns.
    own: Vec<Vec<f64>>,
    windows: Vec<Window>,
}

impl Balance {
    /// The share of squares of each joint's torque that is left, with columns multiplied; none
    /// where no torque was measured.
    fn left(&mut self, scales: &Scales) -> Vec<Option<f64>> {
        let n = self.own.len();
        let (mut missed, mut sizes) = (vec![0.0; n], vec![0.0; n]);
        let mut rows = RegressionRows::default();
        for Window { motion, torque } in &self.windows {
            let scaled = |(at, column): (usize, &Vec<f64>)| -> Vec<f64> {
                let scale = scales.positions[at % n] * scales.time.powi(-((at / n) as i32));
                column.iter().map(|value| scale * value).collect()
            };
            let motion: Vec<Vec<f64>> = motion.iter().enumerate().map(scaled).collect();
            let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
            self.evaluator.evaluate(&motion, &mut rows).expect("every joint has its columns");
            for joint in 0..n {
                let Some(measured) = &torque[joint] else { continue };
                let factor = scales.torques[joint];
                let mut computed = vec![0.0; measured.len()];
                rows.torque(joint, &self.own[joint], &mut computed);
                for (measured, computed) in measured.iter().zip(&computed) {
                    missed[joint] += (factor * measured - computed).powi(2);
                    sizes[joint] += (factor * measured).powi(2);
                }
            }
        }
        let share = |(missed, size): (f64, f64)| (size > 0.0).then(|| missed / size);
        missed.into_iter().zip(sizes).map(share).collect()
    }
}
