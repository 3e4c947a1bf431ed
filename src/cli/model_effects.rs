//! A model with its effects apart, and what a command makes of each.

use super::failure::Failure;
use super::files::{effects_beside, read_model_bytes};
use super::remarks::print_remarks;
use denavit::effect::{self, Effect};
use denavit::model::Robot;
use denavit::plants::effect::{ApartEffects, apart};
use serde::Serialize;
use std::fmt;
use std::path::Path;

/// A model whose effects are taken apart.
pub(crate) struct ModelApart {
    /// The robot with all of its effects.
    pub(crate) whole: Robot,
    /// Its equations, and the laws beside them.
    pub(crate) apart: ApartEffects,
    /// The definitions of the user's own effects.
    pub(crate) own: Vec<Effect>,
    /// The text of the file.
    pub(crate) source: String,
}

/// What becomes of an effect that a model has.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct EffectUse {
    effect: String,
    at: String,
    /// `known` or what a command makes of laws beside the equations.
    treatment: &'static str,
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
    pub(crate) fn is_of(&self, effect: &str, at: &str) -> bool {
        self.effect == effect && self.at == at
    }
}

impl ModelApart {
    /// The model of a path, of a shipped model's name, or of standard input; its own effects are
    /// those of `folder`, or of the folder `effects` beside the file.
    pub(crate) fn read(place: &Path, folder: Option<&Path>) -> Result<Self, Failure> {
        let (name, bytes) = read_model_bytes(place)?;
        Self::of(place, folder, (&name, &bytes))
    }

    /// The same of a file that has been read.
    pub(crate) fn of(
        place: &Path,
        folder: Option<&Path>,
        (name, bytes): (&str, &[u8]),
    ) -> Result<Self, Failure> {
        let own = effects_beside(place, folder)?;
        let whole = effect::read_model(name, bytes, &own).map_err(Failure::Model)?;
        print_remarks(name, &whole, bytes);
        let apart =
            apart(&whole, &own).map_err(|error| Failure::Apart(whole.name.clone(), error))?;
        // a model that was read is UTF-8
        Ok(Self { whole, apart, own, source: String::from_utf8_lossy(bytes).into_owned() })
    }

    /// The equations alone, for a command that has no place for laws beside them.
    pub(crate) fn without_laws(self) -> Result<(Robot, String), Failure> {
        match self.apart.laws.first() {
            Some(law) => Err(Failure::Effect(self.whole.name, law.law.name.clone())),
            None => Ok((self.apart.robot, self.source)),
        }
    }

    /// What becomes of each effect where laws beside the equations are left out.
    pub(crate) fn left_out(&self) -> Vec<EffectUse> {
        let words = "left out, since it is a law beside the equations of the bodies; `denavit \
                     identify` takes it out of logs";
        self.uses(("left_out", words))
    }

    /// What becomes of each effect where laws are treated in this way.
    pub(crate) fn uses(&self, (treatment, words): (&'static str, &'static str)) -> Vec<EffectUse> {
        let known = "part of what is known, with the values of the model";
        let of = |[effect, at]: [String; 2], treatment, words| EffectUse {
            effect,
            at,
            treatment,
            words,
        };
        let taken_up = self.apart.taken_up.iter().cloned().map(|one| of(one, "known", known));
        let laws = self.apart.laws.iter().map(|one| [one.law.name.clone(), one.at.clone()]);
        taken_up.chain(laws.map(|one| of(one, treatment, words))).collect()
    }
}
