//! A diagnosis as JSON (the keys that others rely on stand in docs/reference/diagnosis.md).

use super::diagnosis_folder::{DiagnosisFolder, MODEL, REPORT, experiment_file};
use denavit_diagnose::{
    Alternative, Candidate, EffectValue, FoundEffect, Gaps, GivenEffect, MotionGap, MotionGaps,
    Step, Visible, Where,
};
use denavit_workflow::{Diagnosed, EffectUse};
use serde::Serialize;
use serde_json::{Value, json};
use std::collections::BTreeMap;

#[derive(Serialize)]
struct DiagnosisJson<'a> {
    model: &'a str,
    verdict: &'static str,
    reasons: &'a [String],
    r#where: Vec<WhereJson<'a>>,
    /// The effects that the model has.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    given: Vec<GivenJson<'a>>,
    effects: Vec<EffectJson<'a>>,
    /// Effects that are only near to what has no name.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    nearest: Vec<EffectJson<'a>>,
    visible: Vec<VisibleJson<'a>>,
    unnamed: Vec<StructureJson<'a>>,
    rounds: Vec<RoundJson<'a>>,
    /// What joints and springs have left in the bands in which the robot moves.
    leftover: Vec<LeftoverJson<'a>>,
    /// The cutoff of the filter of torques [Hz].
    filter_hz: f64,
    noise_floor: f64,
    gap: GapJson,
    #[serde(skip_serializing_if = "Option::is_none")]
    simulation_gap: Option<Value>,
    share_closed: Option<f64>,
    driven: [&'a [String]; 2],
    remarks: Vec<String>,
    /// Files in the folder, and why the model is none of them.
    model_file: Option<&'static str>,
    model_refused: Option<&'a str>,
    report: Option<&'static str>,
}

#[derive(Serialize)]
struct WhereJson<'a> {
    joint: &'a str,
    share: f64,
    regime: Option<String>,
    regime_share: Option<f64>,
    window: [f64; 2],
    over_noise: f64,
}

#[derive(Serialize)]
struct EffectJson<'a> {
    effect: &'a str,
    at: &'a str,
    /// Of the joint's series spring, where it is not that of the motor.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<&'static str>,
    /// The log of the odds that it is there.
    log_odds: f64,
    log_predicted: f64,
    /// What it does, as a share of the torque of its joint.
    size: f64,
    share: f64,
    parameters: BTreeMap<&'a str, ValueJson<'a>>,
    indistinguishable: Vec<OtherJson<'a>>,
    /// Finer forms of it that the logs do not ask for.
    finer: Vec<OtherJson<'a>>,
    /// Parameters of the model that do exactly the same, whatever the motion.
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    exact_alias: &'a [String],
    /// A motion that would tell these apart.
    #[serde(skip_serializing_if = "Option::is_none")]
    separating_experiment: Option<Value>,
}

/// An effect that the model has; what its equations took up has no parameters here.
#[derive(Serialize)]
struct GivenJson<'a> {
    #[serde(flatten)]
    becomes: &'a EffectUse,
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    parameters: BTreeMap<&'a str, ValueJson<'a>>,
}

#[derive(Serialize)]
struct ValueJson<'a> {
    value: f64,
    std: Option<f64>,
    unit: &'a str,
}

#[derive(Serialize)]
struct OtherJson<'a> {
    effect: &'a str,
    at: &'a str,
    /// Of the joint's series spring, where it is not that of the motor.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<&'static str>,
    /// The log of the odds of the effect that was found against it.
    log_odds: f64,
    /// Whether no motion tells the two apart.
    exact: bool,
}

/// How small an effect that was not found would have been seen.
#[derive(Serialize)]
struct VisibleJson<'a> {
    effect: &'a str,
    at: &'a str,
    /// Of the joint's series spring, where it is not that of the motor.
    #[serde(skip_serializing_if = "Option::is_none")]
    side: Option<&'static str>,
    /// The least value of its parameter; none where no value would be seen.
    least: Option<f64>,
    unit: &'a str,
    /// What such an effect is of the joint's torque.
    share: Option<f64>,
}

#[derive(Serialize)]
struct StructureJson<'a> {
    joint: &'a str,
    formula: String,
    share: f64,
}

#[derive(Serialize)]
struct LeftoverJson<'a> {
    joint: &'a str,
    share: f64,
}

#[derive(Serialize)]
struct RoundJson<'a> {
    effect: &'a str,
    at: &'a str,
    is_taken: bool,
    log_odds: f64,
    size: f64,
    runners_up: Vec<RunnerUpJson<'a>>,
}

#[derive(Serialize)]
struct RunnerUpJson<'a> {
    effect: &'a str,
    at: &'a str,
    log_odds: f64,
}

#[derive(Serialize)]
struct GapJson {
    train: OneGapJson,
    validate: OneGapJson,
}

#[derive(Serialize)]
struct OneGapJson {
    before: f64,
    after: f64,
    floor: f64,
    per_joint_before: Vec<Option<f64>>,
    per_joint_after: Vec<Option<f64>>,
}

impl From<&Gaps> for OneGapJson {
    fn from(gaps: &Gaps) -> Self {
        Self {
            before: gaps.before.all,
            after: gaps.after.all,
            floor: gaps.floor.all,
            per_joint_before: gaps.before.per_joint.clone(),
            per_joint_after: gaps.after.per_joint.clone(),
        }
    }
}

/// A diagnosis as JSON, with the files of its folder if there is one.
pub fn diagnosed_json<'a>(
    shown: &'a Diagnosed,
    folder: Option<&'a DiagnosisFolder>,
) -> impl Serialize + 'a {
    let Diagnosed { robot, found, remarks, .. } = shown;
    let of_joint = |one: &'_ Where| -> (Option<String>, Option<f64>) {
        let part = one.parts.first();
        (part.map(|part| part.regime.to_string()), part.map(|part| part.share))
    };
    let places = found.before.iter().map(|one| {
        let (regime, regime_share) = of_joint(one);
        WhereJson {
            joint: &one.joint,
            share: one.share,
            regime,
            regime_share,
            window: one.window_s.0,
            over_noise: one.over_noise,
        }
    });
    let sorted = |is_named: bool| {
        let all = found.effects.iter().enumerate();
        let own = all.filter(|(_, one)| one.is_named == is_named);
        own.map(|(number, one)| effect(shown, folder, number, one)).collect()
    };
    let structures = found.structures.iter().map(|one| StructureJson {
        joint: &one.at,
        formula: one.formula(),
        share: one.share,
    });
    let leftover = found
        .leftovers
        .iter()
        .map(|one| LeftoverJson { joint: &found.places[one.equation], share: one.share });
    let has_model = folder.is_some_and(DiagnosisFolder::has_model);
    DiagnosisJson {
        model: &robot.name,
        verdict: found.verdict.word(),
        reasons: &found.reasons,
        r#where: places.collect(),
        given: shown.model_effects.iter().map(|becomes| given(shown, becomes)).collect(),
        effects: sorted(true),
        nearest: sorted(false),
        visible: visible(shown),
        unnamed: structures.collect(),
        rounds: found.steps.iter().map(|step| round(shown, step)).collect(),
        leftover: leftover.collect(),
        filter_hz: found.filters.torque_hz,
        noise_floor: found.held_out.floor.all,
        gap: GapJson { train: (&found.train).into(), validate: (&found.held_out).into() },
        simulation_gap: motion(shown),
        share_closed: found.held_out.closed,
        driven: [&found.driven[0], &found.driven[1]],
        remarks: remarks.iter().map(|(file, remark)| format!("{file}: {remark}")).collect(),
        model_file: has_model.then_some(MODEL),
        model_refused: folder.and_then(DiagnosisFolder::refused),
        report: folder.map(|_| REPORT),
    }
}

fn effect<'a>(
    shown: &'a Diagnosed,
    folder: Option<&DiagnosisFolder>,
    number: usize,
    one: &'a FoundEffect,
) -> EffectJson<'a> {
    let candidates = &shown.candidates;
    let own = &candidates[one.candidate];
    let other = |other: &Alternative| OtherJson {
        effect: &candidates[other.candidate].effect,
        at: &candidates[other.candidate].at,
        side: side(&candidates[other.candidate]),
        log_odds: other.log_odds,
        exact: other.is_exact,
    };
    EffectJson {
        effect: &own.effect,
        at: &own.at,
        side: side(own),
        log_odds: one.log_odds,
        log_predicted: one.log_predicted,
        size: one.size,
        share: one.share,
        parameters: values(&one.parameters),
        indistinguishable: one.alternatives.iter().map(other).collect(),
        finer: one.finer.iter().map(other).collect(),
        exact_alias: &one.exact,
        separating_experiment: experiment(shown, folder, number, one),
    }
}

fn side(own: &Candidate) -> Option<&'static str> {
    own.is_behind_spring.then_some("link")
}

/// How small effects would have been seen.
fn visible(shown: &Diagnosed) -> Vec<VisibleJson<'_>> {
    let known = |value: f64| Some(value).filter(|value| value.is_finite());
    let of = |one: &Visible| {
        let own = &shown.candidates[one.candidate];
        VisibleJson {
            effect: &own.effect,
            at: &own.at,
            side: side(own),
            least: known(one.least),
            unit: &own.law.parameters()[0].unit,
            share: known(one.share),
        }
    };
    shown.found.visible.iter().map(of).collect()
}

/// The motion that tells an effect from what would do as well, or why there is none.
fn experiment(
    shown: &Diagnosed,
    folder: Option<&DiagnosisFolder>,
    number: usize,
    one: &FoundEffect,
) -> Option<Value> {
    let name = |&rival: &usize| {
        let Candidate { effect, at, .. } = &shown.candidates[rival];
        json!({"effect": effect, "at": at})
    };
    Some(match one.experiment.as_ref()? {
        Ok(found) => json!({
            "from": found.rivals.iter().map(name).collect::<Vec<Value>>(),
            "file": folder.map(|_| experiment_file(number)),
            "duration_s": found.duration_s,
            "separation": found.separation,
            "separation_before": found.separation_before,
            "power": found.power,
            "draws": found.draws,
        }),
        Err(reason) => json!({"refused": reason.to_string()}),
    })
}

/// The gap of the models in motion, or why they are not moved.
fn motion(shown: &Diagnosed) -> Option<Value> {
    let of = |[before, after]: &[MotionGap; 2]| {
        json!({
            "before": before.all,
            "after": after.all,
            "per_joint_before": before.per_joint,
            "per_joint_after": after.per_joint,
        })
    };
    Some(match shown.found.motion.as_ref()? {
        Ok(MotionGaps { train, held_out }) => json!({
            "before": held_out[0].all,
            "after": held_out[1].all,
            "train": of(train),
            "validate": of(held_out),
        }),
        Err(reason) => json!({"refused": reason.to_string()}),
    })
}

fn values(parameters: &[EffectValue]) -> BTreeMap<&str, ValueJson<'_>> {
    let entry = |value: &'_ EffectValue| {
        let std = Some(value.std).filter(|std| std.is_finite());
        (value.value, std)
    };
    let named = parameters.iter().map(|one| {
        let (value, std) = entry(one);
        (one.name.as_str(), ValueJson { value, std, unit: &one.unit })
    });
    named.collect()
}

fn given<'a>(shown: &'a Diagnosed, becomes: &'a EffectUse) -> GivenJson<'a> {
    let is_it = |one: &&GivenEffect| becomes.is_of(&shown.candidates[one.candidate]);
    let found = shown.found.given.iter().find(is_it);
    let parameters = found.map_or_else(BTreeMap::new, |one| values(&one.parameters));
    GivenJson { becomes, parameters }
}

fn round<'a>(shown: &'a Diagnosed, step: &Step) -> RoundJson<'a> {
    let added = &shown.candidates[step.added];
    let others = step.runners_up.iter();
    RoundJson {
        effect: &added.effect,
        at: &added.at,
        is_taken: step.is_taken,
        log_odds: step.log_odds,
        size: step.size,
        runners_up: others.map(|&(other, log_odds)| runner_up(shown, other, log_odds)).collect(),
    }
}

fn runner_up<'a>(shown: &'a Diagnosed, candidate: usize, log_odds: f64) -> RunnerUpJson<'a> {
    let other = &shown.candidates[candidate];
    RunnerUpJson { effect: &other.effect, at: &other.at, log_odds }
}
