//! The blind diagnosis of the demo.

use super::super::diagnose;
use super::super::failure::Failure;
use super::super::progress::Progress;
use super::write;
use denavit::demo::{DiagnosedOutcome, Hidden, Written};
use denavit::report::verdict_paragraph;
use std::path::Path;

/// Draws an effect, simulates two motions, and diagnoses from their logs.
pub(super) fn diagnosed(
    seed: u64,
    directory: &Path,
    progress: &Progress,
) -> Result<DiagnosedOutcome, Failure> {
    progress.show("simulating a leg with something hidden");
    let hidden = Hidden::drawn(seed);
    let robot = hidden.robot();
    let (mut files, mut logs) = (Vec::new(), Vec::new());
    for motion in [0, 1] {
        let log = Hidden::log(&robot.text, seed, motion)?;
        logs.push(directory.join(&log.name));
        files.push(write(directory, log)?);
    }
    progress.show("diagnosing it");
    let folder = directory.join("blind");
    let (shown, folder) = diagnose::of_motions(Hidden::MODEL, &logs, &folder, progress)?;
    for (path, what) in folder.files(&shown) {
        let bytes = std::fs::metadata(&path).map_or(0, |file| file.len() as usize);
        files.push(Written::new(&path, bytes, what));
    }
    // Only now: nothing has read it.
    files.push(write(directory, robot)?);
    let gaps = &shown.found.held_out;
    let gap = [gaps.before.all, gaps.after.all, gaps.floor.all];
    let paragraph = verdict_paragraph(&shown.found, &shown.candidates);
    let verdict = shown.found.verdict.word();
    Ok(hidden.revealed(verdict, paragraph, shown.named(), gap, files))
}
