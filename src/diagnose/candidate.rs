//! What may be missing: an effect of the catalogue in one place of the robot.

use super::law::Law;
use crate::plants::effect::LawParameter;

/// An effect in one place.
pub struct Candidate {
    /// The effect's name in the catalogue.
    pub effect: String,
    /// What it is, in words.
    pub title: String,
    /// The joint, link or pair of joints where it acts, or `model`.
    pub at: String,
    /// The joint that it acts on; none for what acts on the whole robot.
    pub joint: Option<usize>,
    /// What it does.
    pub law: Box<dyn Law>,
}

impl Candidate {
    /// How it is written: `stribeck at knee`.
    pub fn name(&self) -> String {
        format!("{} at {}", self.effect, self.at)
    }
}

/// Most points from which one law's parameters are searched.
const MOST_STARTS: usize = 12;

/// Where searches of a law's parameters begin: what it is linear in and what switches it off, where
/// it is off; every combination of the values that the other parameters begin with.
pub fn starts(parameters: &[LawParameter]) -> Vec<Vec<f64>> {
    let is_off = |parameter: &LawParameter| parameter.nominal.filter(|_| parameter.linear);
    let mut all = vec![Vec::new()];
    for parameter in parameters {
        let values = match is_off(parameter) {
            Some(off) => vec![off],
            None if parameter.start.is_empty() => vec![parameter.nominal.unwrap_or(0.0)],
            None => parameter.start.clone(),
        };
        let longer = |start: &Vec<f64>| -> Vec<Vec<f64>> {
            values.iter().map(|&value| [start.as_slice(), &[value]].concat()).collect()
        };
        all = all.iter().flat_map(longer).collect();
    }
    // Thinned evenly, so that the same ones are left for the same law.
    let stride = all.len().div_ceil(MOST_STARTS).max(1);
    all.into_iter().step_by(stride).collect()
}
