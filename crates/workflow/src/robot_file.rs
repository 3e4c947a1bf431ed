//! A robot from a file, its effects apart, and what becomes of each.

use crate::error::{Cause, Error};
use crate::files::{Files, ModelText};
use denavit_codegen::effect::{self, Effect, SpringSide};
use denavit_codegen::model::{Robot, remarks};
use denavit_diagnose::Candidate;
use denavit_plants::effect::{AddedLaw, ApartEffects, apart};
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// A robot as its file describes it, with its effects.
#[derive(Debug)]
pub struct WholeRobot {
    /// The robot.
    pub robot: Robot,
    /// The text of the model file: of a URDF or MJCF that of the model that it becomes.
    pub source: String,
    /// What importing it had to decide, and faults of the model that pass.
    pub notes: Vec<String>,
}

impl WholeRobot {
    /// The robot of a file that was read, with a user's own effects.
    ///
    /// # Errors
    /// All that is wrong with the file.
    pub fn new(read: ModelText, own: &[Effect]) -> Result<Self, Error> {
        let ModelText { name, text, mut notes } = read;
        let robot = effect::read_model(&name, &text, own).map_err(Cause::Model)?;
        let said = remarks(&robot, &text);
        notes.extend(said.iter().map(|one| format!("remark: {}", one.message(&name))));
        // a model that was read is UTF-8
        let source = String::from_utf8_lossy(&text).into_owned();
        Ok(Self { robot, source, notes })
    }
}

/// A robot whose effects are taken apart.
#[derive(Debug)]
pub struct RobotFile {
    /// The robot with all of its effects.
    pub whole: Robot,
    /// Its equations, and the laws beside them.
    pub apart: ApartEffects,
    /// The definitions of the user's own effects.
    pub own: Vec<Effect>,
    /// The text of the model file.
    pub source: String,
    /// What importing it had to decide, and faults of the model that pass.
    pub notes: Vec<String>,
}

/// What is made of laws beside the equations of the bodies.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Treatment {
    /// As answers call it.
    pub(crate) name: &'static str,
    /// The same as part of a sentence.
    pub(crate) words: &'static str,
}

/// What becomes of an effect that a model has.
#[derive(Clone, Debug, Serialize)]
pub struct EffectUse {
    /// The effect.
    pub effect: String,
    /// Its place.
    pub at: String,
    /// The side of the joint's series spring, if the model says that it is the link's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub side: Option<&'static str>,
    /// `known`, or what is made of laws beside the equations.
    pub treatment: &'static str,
    #[serde(skip)]
    words: &'static str,
}

impl fmt::Display for EffectUse {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "effect `{}` at {}: {}", self.effect, self.at, self.words)
    }
}

impl EffectUse {
    /// Whether it is this effect in this place.
    pub fn is_of(&self, own: &Candidate) -> bool {
        let is_behind_spring = self.side.is_some();
        self.effect == own.effect && self.at == own.at && is_behind_spring == own.is_behind_spring
    }
}

impl RobotFile {
    /// The robot of a file, or of a shipped model's name; its own effects are those of the folder
    /// `effects` beside the file. URDF and MJCF become models.
    ///
    /// # Errors
    /// All that is wrong with the file, or why it is not read.
    pub fn open(place: impl AsRef<Path>) -> Result<Self, Error> {
        Files::new().robot(place.as_ref(), None)
    }

    /// The robot of a file that was read, with a user's own effects.
    ///
    /// # Errors
    /// All that is wrong with the file, or why its effects are not taken apart.
    pub fn new(read: ModelText, own: Vec<Effect>) -> Result<Self, Error> {
        let WholeRobot { robot: whole, source, notes } = WholeRobot::new(read, &own)?;
        let apart = apart(&whole, &own).map_err(|error| Cause::Apart(whole.name.clone(), error))?;
        Ok(Self { whole, apart, own, source, notes })
    }

    /// The equations alone, for work that has no place for laws beside them.
    ///
    /// # Errors
    /// If there is such a law.
    pub fn without_laws(self) -> Result<(Robot, String), Error> {
        match self.apart.laws.first() {
            Some(law) => Err(Cause::Effect(self.whole.name, law.law.name.clone()).into()),
            None => Ok((self.apart.robot, self.source)),
        }
    }

    /// What becomes of each effect where laws beside the equations are left out.
    pub fn left_out(&self) -> Vec<EffectUse> {
        let words = "left out, since it is a law beside the equations of the bodies; `denavit \
                     identify` takes it out of logs";
        self.uses(Treatment { name: "left_out", words })
    }

    /// What becomes of each effect where laws are treated in this way.
    pub(crate) fn uses(&self, treatment: Treatment) -> Vec<EffectUse> {
        let words = "part of what is known, with the values of the model";
        let known = Treatment { name: "known", words };
        let of = |[effect, at]: [String; 2], treatment: Treatment| EffectUse {
            effect,
            at,
            side: None,
            treatment: treatment.name,
            words: treatment.words,
        };
        let taken_up = self.apart.taken_up.iter().cloned().map(|one| of(one, known));
        let law = |one: &AddedLaw| EffectUse {
            side: (one.side == Some(SpringSide::Link)).then_some("link"),
            ..of([one.law.name.clone(), one.at.clone()], treatment)
        };
        taken_up.chain(self.apart.laws.iter().map(law)).collect()
    }
}
