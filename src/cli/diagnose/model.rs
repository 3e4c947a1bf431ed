//! The model with the effects that were found, as a file.

use super::{Failure, Shown};
use crate::cli::files::read_file;
use denavit::effect::{self, Effect, EffectSite};
use denavit::identify::{EffectValues, NewEffect, NewPlace, with_effects};
use std::path::{Path, PathBuf};

/// What became of the model.
pub(super) enum Completed {
    /// Nothing was found that could be added.
    NothingFound,
    /// Its file with the effects.
    Text(String),
    /// The reason why a model has no place for an effect.
    Refused(String),
}

/// The model's file, `source`, with what was found. Numbers that it has stay as they are: those of
/// the effects were estimated with the others free within their uncertainty. Laws that are only
/// the nearest to something without a name are no part of it.
pub(super) fn complete(source: &str, shown: &Shown, effects: &[Effect]) -> Completed {
    let named = || shown.found.effects.iter().filter(|one| one.is_named);
    if named().next().is_none() {
        return Completed::NothingFound;
    }
    let finite = |std: f64| Some(std).filter(|std| std.is_finite());
    let added: Vec<NewEffect<'_>> = named()
        .map(|one| {
            let candidate = &shown.candidates[one.candidate];
            let known = effects.iter().find(|effect| effect.name == candidate.effect);
            let at = match (known.map(|effect| effect.at), candidate.at.split_once(" with ")) {
                (Some(EffectSite::Model), _) => NewPlace::Model,
                (_, Some((joint, second))) => NewPlace::Pair(joint, second),
                _ => NewPlace::Link(&candidate.at),
            };
            let values = one.parameters.iter();
            let values = values.map(|value| (value.name.as_str(), value.value, finite(value.std)));
            NewEffect { effect: &candidate.effect, at, parameters: values.collect() }
        })
        .collect();
    // What the model has of effects was estimated together with what was found.
    let given = shown.found.given.iter().zip(&shown.numbers).map(|(one, &number)| {
        let values = one.parameters.iter();
        let values = values.map(|value| (value.name.as_str(), value.value, finite(value.std)));
        (number, values.collect())
    });
    let given: Vec<(usize, EffectValues<'_>)> = given.collect();
    let Some(text) = with_effects(source, &added, &given) else {
        return Completed::Refused("its file is no object of JSON".to_owned());
    };
    match effect::read_model("model.json", text.as_bytes(), effects) {
        Ok(_) => Completed::Text(text),
        Err(error) => Completed::Refused(error.to_string()),
    }
}

/// The definitions of the user's own effects that were found, as files of a folder `effects` beside
/// the model, where commands look for them.
pub(super) fn definitions(
    own: &Path,
    folder: &Path,
    shown: &Shown,
) -> Result<Vec<(PathBuf, Vec<u8>)>, Failure> {
    let beside = folder.join("effects");
    let mut files = Vec::new();
    if beside.canonicalize().is_ok_and(|beside| own.canonicalize().is_ok_and(|own| own == beside)) {
        return Ok(files);
    }
    let failure = |error| Failure::Read { file: own.display().to_string(), error };
    for path in effect::files(own).map_err(failure)? {
        let bytes = read_file(&path)?;
        let known = effect::read(&path.display().to_string(), &bytes).map_err(Failure::Model)?;
        let is_found = |candidate: usize| shown.candidates[candidate].effect == known.name;
        let found = shown.found.effects.iter().map(|one| one.candidate);
        let given = shown.found.given.iter().map(|one| one.candidate);
        if found.chain(given).any(is_found) {
            files.push((beside.join(format!("{}.json", known.name)), bytes));
        }
    }
    Ok(files)
}
