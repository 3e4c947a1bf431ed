//! The model with the effects that were found, as a file; and what was found, by name.

use super::Diagnosed;
use crate::error::{Cause, Error};
use crate::files::Files;
use denavit_codegen::effect;
use denavit_plants::model_text::{EffectValues, NewEffect, with_effects};
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What became of the model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Completed {
    /// Nothing was found that could be added.
    NothingFound,
    /// The text of its file with the effects.
    Text(String),
    /// The reason why a model has no place for an effect.
    Refused(String),
}

/// An effect in its place, as it was named.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedEffect {
    /// The effect; `unnamed` where it is only the nearest to something without a name.
    pub effect: String,
    /// Its place.
    pub at: String,
    /// Values of its parameters.
    pub parameters: BTreeMap<String, f64>,
    /// Effects with their places that would do as well.
    pub or: Vec<[String; 2]>,
}

impl Diagnosed {
    /// What was found, in order.
    pub fn named(&self) -> Vec<NamedEffect> {
        let name = |candidate: usize| {
            let own = &self.candidates[candidate];
            [own.effect.clone(), own.at.clone()]
        };
        let named = self.found.effects.iter().map(|one| {
            let [mut effect, at] = name(one.candidate);
            if !one.is_named {
                effect = "unnamed".to_owned();
            }
            let values = one.parameters.iter().map(|value| (value.name.clone(), value.value));
            let or = one.alternatives.iter().map(|other| name(other.candidate)).collect();
            NamedEffect { effect, at, parameters: values.collect(), or }
        });
        named.collect()
    }

    /// Whether an effect is among those that were found, or that the model has.
    fn has_effect(&self, name: &str) -> bool {
        let found = self.found.effects.iter().map(|one| one.candidate);
        let given = self.found.given.iter().map(|one| one.candidate);
        found.chain(given).any(|candidate| self.candidates[candidate].effect == name)
    }

    /// The definitions of a user's own effects, of the folder `own`, that were found: as files of
    /// the folder `beside`, where commands look for them. None if that is the same folder.
    ///
    /// # Errors
    /// A definition that is wrong, or not read.
    pub fn definitions(
        &self,
        files: &Files,
        own: &Path,
        beside: &Path,
    ) -> Result<Vec<(PathBuf, Vec<u8>)>, Error> {
        let place = own.canonicalize();
        if place.is_ok_and(|own| beside.canonicalize().is_ok_and(|beside| own == beside)) {
            return Ok(Vec::new());
        }
        let mut found = Vec::new();
        for path in effect::files(own).map_err(|error| Error::read(own, error))? {
            let bytes = files.bytes(&path)?;
            let known = effect::read(&path.display().to_string(), &bytes).map_err(Cause::Model)?;
            if self.has_effect(&known.name) {
                found.push((beside.join(format!("{}.json", known.name)), bytes));
            }
        }
        Ok(found)
    }

    /// The model's file with what was found. Numbers that it has stay as they are: those of the
    /// effects were estimated with the others free within their uncertainty. Laws that are only
    /// the nearest to something without a name are no part of it.
    pub fn completed(&self) -> Completed {
        let named = || self.found.effects.iter().filter(|one| one.is_named);
        if named().next().is_none() {
            return Completed::NothingFound;
        }
        let finite = |std: f64| Some(std).filter(|std| std.is_finite());
        let added: Vec<NewEffect<'_>> = named()
            .map(|one| {
                let candidate = &self.candidates[one.candidate];
                let at = candidate.place(&self.effects);
                let values = one.parameters.iter();
                let values =
                    values.map(|value| (value.name.as_str(), value.value, finite(value.std)));
                NewEffect { effect: &candidate.effect, at, parameters: values.collect() }
            })
            .collect();
        // What the model has of effects was estimated together with what was found.
        let given = self.found.given.iter().zip(&self.numbers).map(|(one, &number)| {
            let values = one.parameters.iter();
            let values = values.map(|value| (value.name.as_str(), value.value, finite(value.std)));
            (number, values.collect())
        });
        let given: Vec<(usize, EffectValues<'_>)> = given.collect();
        let Some(text) = with_effects(&self.source, &added, &given) else {
            return Completed::Refused("its file is no object of JSON".to_owned());
        };
        match effect::read_model("model.json", text.as_bytes(), &self.effects) {
            Ok(_) => Completed::Text(text),
            Err(error) => Completed::Refused(error.to_string()),
        }
    }
}
