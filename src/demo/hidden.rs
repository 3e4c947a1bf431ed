//! A blind diagnosis: a leg with an effect that is drawn by a seed, told from model and logs
//! alone, then revealed beside the answer.

use super::{Document, Written, referred};
use denavit::numerics::Random;
use denavit::plants::model_text::{NewEffect, NewPlace, with_effects};
use denavit::report::{paragraph, short};
use denavit::shipped;
use denavit::simulate::scenario::ScenarioError;
use denavit::walk;
use denavit::workflow::NamedEffect;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt;

const SCENARIO: &str = "tulip_leg_identification";
const MODEL: &str = "tulip_leg_table34";
const TRAJECTORY: &str = "tulip_leg_excitation";

/// What can be hidden, with values that are large beside the torques of the leg.
const HIDDEN: [(&str, &[(&str, f64)]); 10] = [
    ("quadratic_drag", &[("c", 1.5)]),
    ("asymmetric_viscous", &[("d", 1.5)]),
    ("viscous", &[("fv", 2.0)]),
    ("posture_viscous", &[("k", 2.0)]),
    ("posture_friction", &[("k", 2.0)]),
    ("torque_drift", &[("c", 0.3)]),
    ("cogging", &[("a", 0.8), ("b", 0.6), ("n", 12.0)]),
    ("dahl", &[("fc", 1.5), ("slip", 0.02)]),
    ("rotor_inertia", &[("ia", 0.3)]),
    ("load_friction", &[("mu", 0.25)]),
];

/// Joints of the leg.
const JOINTS: [&str; 5] = ["hip_z", "hip_x", "hip_y", "knee", "ankle_y"];

/// The second motion is the first one backwards, and smaller by this: within all its limits.
const SMALLER: f64 = 0.8;

/// An effect that is hidden: what, where, with which values.
#[derive(Clone, Debug, Serialize)]
pub struct Hidden {
    effect: &'static str,
    at: &'static str,
    parameters: BTreeMap<&'static str, f64>,
}

/// What became of a blind diagnosis.
#[derive(Serialize)]
pub struct DiagnosedOutcome {
    model: &'static str,
    hidden: Hidden,
    verdict: &'static str,
    answer: Vec<NamedEffect>,
    outcome: Outcome,
    /// Gaps of held-out torques: before, after, noise.
    gap: [f64; 3],
    files: Vec<Written>,
    #[serde(skip)]
    told: String,
}

/// How the answer compares with the truth.
#[derive(Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
enum Outcome {
    /// Effect and joint, and nothing else.
    Right,
    /// Effect and joint, and something that was not there.
    RightAndMore,
    /// It is one of those that the logs do not tell apart, as the answer says.
    AmongOthers,
    /// Something else.
    Wrong,
}

impl Hidden {
    /// The model that it is hidden in.
    pub const MODEL: &str = MODEL;

    /// Effect, joint and values of a seed: those of the list, up to a fifth more or less.
    pub fn drawn(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let mut draw = |count: usize| (random.bits() % count as u64) as usize;
        let (effect, values) = HIDDEN[draw(HIDDEN.len())];
        let at = JOINTS[draw(JOINTS.len())];
        let mut scaled = |value: f64| {
            // in three digits, so that it can be read
            let exact = value * (0.8 + 0.4 * random.uniform());
            format!("{exact:.2e}").parse().unwrap_or(exact)
        };
        let parameters = values.iter().map(|&(name, value)| (name, scaled(value))).collect();
        Self { effect, at, parameters }
    }

    /// The model with what is hidden in it.
    pub fn robot(&self) -> Document {
        let values = self.parameters.iter().map(|(name, value)| (*name, *value, None)).collect();
        let at = NewPlace::Link(self.at);
        let new = NewEffect { effect: self.effect, at, parameters: values };
        let shipped = shipped::find(MODEL).expect("it is shipped");
        let text = with_effects(shipped.text, &[new], &[]).expect("shipped models are JSON");
        let what = "the leg with what was hidden in it".to_owned();
        Document { name: "blind_truth.json".to_owned(), text, what }
    }

    /// The log of one of the two motions of that robot, to train (0) or to validate (1).
    pub fn log(robot: &str, seed: u64, motion: usize) -> Result<Document, ScenarioError> {
        let shipped = shipped::find_scenario(SCENARIO).expect("it is shipped");
        let load = |name: &str| match name {
            MODEL => Ok(robot.as_bytes().to_vec()),
            TRAJECTORY if motion > 0 => Ok(backwards()),
            _ => referred(name),
        };
        let mut scenario = walk::read_scenario(SCENARIO, shipped.text.as_bytes(), &load)?;
        scenario.simulation.seed = seed.wrapping_mul(2).wrapping_add(motion as u64);
        let text = scenario.run()?.log.to_csv();
        let set = if motion > 0 { "validate" } else { "train" };
        let what = "log of a leg with something hidden".to_owned();
        Ok(Document { name: format!("blind_{set}.csv"), text, what })
    }

    /// Whether the answer of a diagnosis is right: its verdict in one word and in a paragraph, what
    /// it names, and its gaps of held-out torques before, after and of noise.
    pub fn revealed(
        self,
        verdict: &'static str,
        told: String,
        answer: Vec<NamedEffect>,
        gap: [f64; 3],
        files: Vec<Written>,
    ) -> DiagnosedOutcome {
        let outcome = self.compare(&answer);
        DiagnosedOutcome { model: MODEL, hidden: self, verdict, answer, outcome, gap, files, told }
    }

    fn compare(&self, answer: &[NamedEffect]) -> Outcome {
        let is_it = |effect: &str, at: &str| effect == self.effect && at == self.at;
        let is_named = answer.iter().any(|one| is_it(&one.effect, &one.at));
        let mut others = answer.iter().flat_map(|one| &one.or);
        match (is_named, answer.len()) {
            (true, 1) => Outcome::Right,
            (true, _) => Outcome::RightAndMore,
            _ if others.any(|[effect, at]| is_it(effect, at)) => Outcome::AmongOthers,
            _ => Outcome::Wrong,
        }
    }
}

impl fmt::Display for DiagnosedOutcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(
            f,
            "\nblind diagnosis: {} is simulated with an effect that the seed draws, and diagnosed \
             from\nthe model without it and the logs of two motions\n",
            self.model
        )?;
        writeln!(f, "{}", paragraph("  ", "  ", &self.told))?;
        let values = |all: &BTreeMap<String, f64>| -> String {
            let each = all.iter().map(|(name, value)| format!(", {name} = {}", short(*value)));
            each.collect()
        };
        for one in &self.answer {
            writeln!(f, "  answer: {} at {}{}", one.effect, one.at, values(&one.parameters))?;
        }
        if self.answer.is_empty() {
            writeln!(f, "  answer: none")?;
        }
        let truth = self.hidden.parameters.iter().map(|(name, value)| ((*name).to_owned(), *value));
        let truth = values(&truth.collect());
        writeln!(f, "  truth:  {} at {}{truth}", self.hidden.effect, self.hidden.at)?;
        let outcome = match self.outcome {
            Outcome::Right => "right: effect and joint",
            Outcome::RightAndMore => "right, but it names more than there is",
            Outcome::AmongOthers => "the truth is among those that it does not tell apart",
            Outcome::Wrong => "WRONG: the truth is not in the answer",
        };
        writeln!(f, "  {outcome}\n")?;
        self.files.iter().try_for_each(|file| writeln!(f, "{file}"))
    }
}

/// The shipped trajectory backwards in time and smaller.
fn backwards() -> Vec<u8> {
    let shipped = shipped::TRAJECTORIES.iter().find(|one| one.name == TRAJECTORY);
    let text = shipped.map_or("", |one| one.text);
    let mut file: serde_json::Value = serde_json::from_str(text).unwrap_or_default();
    for joint in JOINTS {
        for (list, factor) in [("cosines", SMALLER), ("sines", -SMALLER)] {
            let list = file["joints"][joint]["fourier"][list].as_array_mut();
            for entry in list.into_iter().flatten() {
                *entry = entry.as_f64().map_or(0.0, |value| factor * value).into();
            }
        }
    }
    file.to_string().into_bytes()
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit::effect;

    #[test]
    fn what_can_be_hidden_is_in_the_catalogue_with_all_its_parameters() {
        for (name, values) in HIDDEN {
            let known = effect::find(name).unwrap_or_else(|| panic!("{name}"));
            let names: Vec<&str> = known.parameters.iter().map(|one| one.name.as_str()).collect();
            let given: Vec<&str> = values.iter().map(|(name, _)| *name).collect();
            assert_eq!(names, given, "{name}");
        }
    }

    #[test]
    fn seeds_draw_different_effects_and_joints() {
        let drawn: std::collections::BTreeSet<(&str, &str)> =
            (0..200).map(Hidden::drawn).map(|hidden| (hidden.effect, hidden.at)).collect();
        assert!(drawn.len() > 40, "{drawn:?}");
    }
}
