//! The files of a diagnosis: the answer, the model with its effects, motions that separate names,
//! and a page.

use super::diagnosed_json::diagnosed_json;
use denavit_workflow::{Completed, Diagnosed};
use std::path::PathBuf;

const DIAGNOSIS: &str = "diagnosis.json";
pub(super) const MODEL: &str = "model.json";
pub(super) const REPORT: &str = "report.html";

/// The files of a folder.
pub const DIAGNOSIS_FILES: [&str; 3] = [DIAGNOSIS, MODEL, REPORT];

/// Motions that a folder can have: one of each effect.
const MOST_MOTIONS: usize = u8::MAX as usize;

/// The file of the experiment that separates an effect from what would do as well.
pub(super) fn experiment_file(number: usize) -> String {
    format!("separating_{}.json", number + 1)
}

/// A folder of a diagnosis.
#[derive(Clone, Debug)]
pub struct DiagnosisFolder {
    folder: PathBuf,
    completed: Completed,
}

impl DiagnosisFolder {
    /// What becomes of this folder.
    pub fn new(folder: impl Into<PathBuf>, shown: &Diagnosed) -> Self {
        Self { folder: folder.into(), completed: shown.completed() }
    }

    /// Whether the model with its effects is there.
    pub fn has_model(&self) -> bool {
        matches!(self.completed, Completed::Text(_))
    }

    /// Why a model has no place for an effect.
    pub(super) fn refused(&self) -> Option<&str> {
        match &self.completed {
            Completed::Refused(reason) => Some(reason),
            _ => None,
        }
    }

    /// Why the folder has no model, if it has none.
    pub fn about_model(&self) -> Option<String> {
        match &self.completed {
            Completed::Text(_) => None,
            Completed::NothingFound => {
                Some(format!("no {MODEL}: no effect was named that could be added"))
            }
            Completed::Refused(reason) => Some(format!("no {MODEL}: {reason}")),
        }
    }

    /// The files, each with what it is.
    pub fn files(&self, shown: &Diagnosed) -> Vec<(PathBuf, &'static str)> {
        let all = [
            (DIAGNOSIS, "the diagnosis as JSON"),
            (MODEL, "the model with the effects that were found"),
            (REPORT, "the diagnosis as a page"),
        ];
        let there = all.into_iter().filter(|(name, _)| self.has_model() || *name != MODEL);
        let there = there.map(|(name, what)| (self.folder.join(name), what));
        let what = "a motion that separates names";
        let motions = shown.experiments();
        let motions = motions.map(|(at, _)| (self.folder.join(experiment_file(at)), what));
        there.chain(motions).collect()
    }

    /// Files of a diagnosis that the folder has already, and that this one does not write: of
    /// another answer. A folder without a diagnosis has none, and what is read stays.
    pub fn outdated(
        &self,
        written: &[(PathBuf, Vec<u8>)],
        is_read: &dyn Fn(&PathBuf) -> bool,
    ) -> Vec<PathBuf> {
        if !self.folder.join(DIAGNOSIS).is_file() {
            return Vec::new();
        }
        let motions = (0..MOST_MOTIONS).map(experiment_file);
        let all = motions.chain([MODEL.to_owned()]).map(|name| self.folder.join(name));
        let is_old = |path: &PathBuf| {
            let is_written = written.iter().any(|(new, _)| new == path);
            !is_written && path.canonicalize().is_ok_and(|path| !is_read(&path))
        };
        all.filter(is_old).collect()
    }

    /// The files with what is in them; `page` is the page.
    ///
    /// # Errors
    /// If an answer is no JSON.
    pub fn contents(
        &self,
        shown: &Diagnosed,
        page: String,
    ) -> serde_json::Result<Vec<(PathBuf, Vec<u8>)>> {
        let mut files = Vec::new();
        if let Completed::Text(text) = &self.completed {
            files.push((self.folder.join(MODEL), text.clone().into_bytes()));
        }
        let json = |value: &dyn Fn() -> serde_json::Result<Vec<u8>>| {
            let mut bytes = value()?;
            bytes.push(b'\n');
            Ok::<_, serde_json::Error>(bytes)
        };
        for (number, experiment) in shown.experiments() {
            let bytes = json(&|| serde_json::to_vec_pretty(&experiment.file))?;
            files.push((self.folder.join(experiment_file(number)), bytes));
        }
        files.push((self.folder.join(REPORT), page.into_bytes()));
        let bytes = json(&|| serde_json::to_vec_pretty(&diagnosed_json(shown, Some(self))))?;
        files.push((self.folder.join(DIAGNOSIS), bytes));
        Ok(files)
    }
}
