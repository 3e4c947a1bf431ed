//! What was identified, as JSON.

use crate::identification::warnings;
use denavit_identify::estimate::{Consistent, IdentifiedParameter, JointResidual, Status};
use denavit_plants::regression::{RegressionModel, StandardParameter};
use denavit_replay::{Compared, Forward, ForwardJoint, ForwardKind};
use denavit_workflow::{EffectUse, Identified, SimulationGap};
use serde::Serialize;

#[derive(Serialize)]
struct IdentifyJson<'a> {
    model: &'a str,
    parameters: Vec<ParameterJson<'a>>,
    residual: ResidualJson<'a>,
    condition: Option<f64>,
    scaled_condition: Option<f64>,
    rank: usize,
    excited: usize,
    samples: usize,
    /// The largest share of noise of the positions in what the motion shows of the parameters.
    noise_share: f64,
    /// Samples that do not count, since a joint turns round or is slow there.
    left_out: Vec<LeftOutJson<'a>>,
    /// Joints of whose torque something is left that is no noise, and its share.
    lacking: Vec<LackingJson<'a>>,
    /// theta0 of the nearest bodies that exist, and how far they are.
    consistent: ConsistentJson<'a>,
    convergence: Vec<ConvergenceJson<'a>>,
    /// Logs simulated again.
    simulation: Option<SimulationJson<'a>>,
    remarks: Vec<String>,
    /// What became of the model's effects.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    effects: &'a [EffectUse],
}

#[derive(Serialize)]
pub(super) struct ParameterJson<'a> {
    name: &'a str,
    expression: &'a str,
    latex: &'a str,
    value: f64,
    std: Option<f64>,
    interval: Option<[f64; 2]>,
    /// Of the standard error.
    degrees_of_freedom: f64,
    /// In standard errors.
    noise_bias: Option<f64>,
    /// Change with half the cutoff of the filter, and its deviation by chance.
    half_cutoff: Option<[f64; 2]>,
    unit: &'a str,
    identifiable: bool,
    status: &'static str,
    model_value: Option<f64>,
}

impl<'a> ParameterJson<'a> {
    pub(super) fn new(one: &'a IdentifiedParameter) -> Self {
        Self {
            name: &one.name,
            expression: &one.expression,
            latex: &one.latex,
            value: one.value,
            std: one.std,
            interval: one.interval.map(|half| [one.value - half, one.value + half]),
            degrees_of_freedom: one.degrees_of_freedom,
            noise_bias: one.noise_bias,
            half_cutoff: one.half_cutoff.map(|one| [one.change, one.deviation]),
            unit: &one.unit,
            identifiable: one.status != Status::NotExcited,
            status: one.status.word(),
            model_value: one.model_value,
        }
    }
}

#[derive(Serialize)]
struct ResidualJson<'a> {
    train: f64,
    validate: Option<f64>,
    /// With the values that the model had, on the logs for validation; without any, the others.
    before: Option<f64>,
    per_joint: Vec<JointJson<'a>>,
}

#[derive(Serialize)]
struct JointJson<'a> {
    joint: &'a str,
    train: f64,
    validate: Option<f64>,
    torque_rms: f64,
    residual_rms: f64,
    autocorrelation: &'a [f64],
}

#[derive(Serialize)]
struct LackingJson<'a> {
    joint: &'a str,
    left: f64,
}

#[derive(Serialize)]
struct LeftOutJson<'a> {
    joint: &'a str,
    samples: usize,
    of: usize,
    /// The share of the torque that is left of the others.
    left: f64,
}

#[derive(Serialize)]
pub(super) struct ConsistentJson<'a> {
    distance: f64,
    parameters: Vec<StandardJson<'a>>,
}

impl<'a> ConsistentJson<'a> {
    pub(super) fn new(model: &'a RegressionModel, found: &Consistent) -> Self {
        let standard = model.standard.iter().zip(&found.standard);
        let one = |(one, &value): (&'a StandardParameter, &f64)| StandardJson {
            name: &one.name,
            unit: &one.unit,
            value,
        };
        Self { distance: found.distance, parameters: standard.map(one).collect() }
    }
}

#[derive(Serialize)]
struct StandardJson<'a> {
    name: &'a str,
    unit: &'a str,
    value: f64,
}

#[derive(Serialize)]
struct ConvergenceJson<'a> {
    time_s: f64,
    values: &'a [f64],
    condition: Option<f64>,
}

#[derive(Serialize)]
struct SimulationJson<'a> {
    kind: Option<&'static str>,
    window_s: Option<f64>,
    windows: Option<usize>,
    /// sqrt(mean over joints of (rms error of position / its size)^2).
    before: Option<f64>,
    after: Option<f64>,
    per_joint: Vec<MotionJson<'a>>,
    reasons: Vec<String>,
}

/// Relative errors of a joint with the model's values and with those that were found.
#[derive(Serialize)]
struct MotionJson<'a> {
    joint: &'a str,
    position: GapJson,
    rate: GapJson,
    torque: Option<GapJson>,
}

#[derive(Serialize)]
struct GapJson {
    before: Option<f64>,
    after: Option<f64>,
    /// Root of the mean square of the error, after [rad, m; per s; N m, N].
    rms: Option<f64>,
}

impl<'a> SimulationJson<'a> {
    fn new(gap: &'a SimulationGap) -> Self {
        let [before, after] = [&gap.before, &gap.after].map(|made| made.as_ref().ok());
        let (window_s, windows) = match gap.kind() {
            Some(ForwardKind::Windows { count, length_s }) => (Some(length_s), Some(count)),
            _ => (None, None),
        };
        let joint = |joint: &'a ForwardJoint| {
            let of = |made: Option<&'a Forward>| {
                made?.joints.iter().find(|other| other.name == joint.name)
            };
            let (before, after) = (of(before), of(after));
            let compared = |signal: fn(&ForwardJoint) -> Option<&Compared>| {
                let [before, after] = [before, after].map(|joint| joint.and_then(signal));
                (before.is_some() || after.is_some()).then(|| GapJson {
                    before: before.map(|one| one.relative),
                    after: after.map(|one| one.relative),
                    rms: after.map(|one| one.rms),
                })
            };
            let none = || GapJson { before: None, after: None, rms: None };
            MotionJson {
                joint: &joint.name,
                position: compared(|one| Some(&one.position)).unwrap_or_else(none),
                rate: compared(|one| Some(&one.rate)).unwrap_or_else(none),
                torque: compared(|one| one.torque.as_ref()),
            }
        };
        Self {
            kind: gap.kind().map(|kind| match kind {
                ForwardKind::ClosedLoop => "closed_loop",
                ForwardKind::Windows { .. } => "windows",
            }),
            window_s,
            windows,
            before: before.map(Forward::relative),
            after: after.map(Forward::relative),
            per_joint: after
                .or(before)
                .map_or(&[][..], |made| &made.joints)
                .iter()
                .map(joint)
                .collect(),
            reasons: gap.reasons(),
        }
    }
}

/// JSON has no infinity.
fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// What was identified, as JSON (docs/reference/identification.md).
pub fn identified_json(shown: &Identified) -> impl Serialize + '_ {
    let Identified { robot, model, found, remarks, effects, simulated, .. } = shown;
    let parameters = found.parameters.iter().map(ParameterJson::new);
    let held_out = |joint: &JointResidual| {
        found.validate.as_ref()?.joint(&joint.name).map(|other| other.relative)
    };
    let joints = found.train.joints.iter().map(|joint| JointJson {
        joint: &joint.name,
        train: joint.relative,
        validate: held_out(joint),
        torque_rms: joint.torque_rms,
        residual_rms: joint.residual_rms,
        autocorrelation: &joint.autocorrelation,
    });
    let solution = &found.estimate.solution;
    let convergence = found.convergence.iter().map(|point| ConvergenceJson {
        time_s: point.time_s,
        values: &point.values,
        condition: finite(point.condition),
    });
    IdentifyJson {
        model: &robot.name,
        parameters: parameters.collect(),
        residual: ResidualJson {
            train: found.train.relative,
            validate: found.validate.as_ref().map(|all| all.relative),
            before: found.before,
            per_joint: joints.collect(),
        },
        condition: finite(solution.condition),
        scaled_condition: finite(solution.scaled_condition),
        rank: model.rank(),
        excited: solution.excited(),
        samples: found.train.samples,
        noise_share: found.estimate.noise_share,
        left_out: found
            .left_out
            .iter()
            .map(|one| LeftOutJson {
                joint: &one.joint,
                samples: one.samples,
                of: one.of,
                left: one.left,
            })
            .collect(),
        lacking: found
            .lacking
            .iter()
            .map(|(joint, left)| LackingJson { joint, left: *left })
            .collect(),
        consistent: ConsistentJson::new(model, &found.consistent),
        convergence: convergence.collect(),
        simulation: simulated.as_ref().map(SimulationJson::new),
        effects,
        remarks: remarks
            .iter()
            .map(|(file, remark)| format!("{file}: {remark}"))
            .chain(warnings(found))
            .collect(),
    }
}
