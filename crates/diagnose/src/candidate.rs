//! What may be missing: an effect of the catalogue in one place of the robot.

use super::law::Law;
use denavit_plants::effect::LawParameter;

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
    /// Whether it adds to the inertial parameters of a body, as the model's numbers may be off.
    pub is_body: bool,
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
const MOST_STARTS: usize = 48;

/// Where a position that may be anywhere is looked for first, as shares of a joint's range.
const PLACES: [f64; 7] = [0.03, 0.2, 0.35, 0.5, 0.65, 0.8, 0.97];

/// Where a limit of torques is looked for first, as shares of the largest.
const LIMITS: [f64; 4] = [0.97, 0.85, 0.7, 0.5];

/// Where searches of a law's parameters begin: what it is linear in and what switches it off, where
/// it is off; every combination of the values that the other parameters begin with. Positions
/// without bounds begin within `range`, what the joint covers; one over a limit of torques at
/// limits below the `largest`.
pub fn starts(
    parameters: &[LawParameter],
    range: Option<[f64; 2]>,
    largest: Option<f64>,
) -> Vec<Vec<f64>> {
    let values_of = |parameter: &LawParameter| -> Vec<f64> {
        let is_anywhere = parameter.bounds.iter().all(|end| end.is_infinite())
            && ["rad", "m"].contains(&parameter.unit.as_str());
        let is_limit = !parameter.linear && ["1/(N m)", "1/N"].contains(&parameter.unit.as_str());
        match (parameter.nominal, range) {
            (Some(off), _) if parameter.linear => vec![off],
            _ if is_limit && largest.is_some_and(|largest| largest > 0.0) => {
                LIMITS.iter().map(|share| 1.0 / (share * largest.unwrap_or(1.0))).collect()
            }
            (None, Some([low, high])) if is_anywhere => {
                PLACES.iter().map(|share| low + share * (high - low)).collect()
            }
            (nominal, _) if parameter.start.is_empty() => vec![nominal.unwrap_or(0.0)],
            _ => parameter.start.clone(),
        }
    };
    let mut all = vec![Vec::new()];
    for parameter in parameters {
        let values = values_of(parameter);
        let longer = |start: &Vec<f64>| -> Vec<Vec<f64>> {
            values.iter().map(|&value| [start.as_slice(), &[value]].concat()).collect()
        };
        all = all.iter().flat_map(longer).collect();
    }
    // Thinned evenly, so that the same ones are left for the same law.
    let stride = all.len().div_ceil(MOST_STARTS).max(1);
    all.into_iter().step_by(stride).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_position_that_may_be_anywhere_is_looked_for_where_the_joint_moves() {
        let of = |unit: &str, nominal, bounds, linear| LawParameter {
            name: String::new(),
            unit: unit.to_owned(),
            nominal,
            bounds,
            start: vec![5.0],
            linear,
        };
        let open = [f64::NEG_INFINITY, f64::INFINITY];
        let stiffness = of("N m/rad", Some(0.0), [0.0, f64::INFINITY], true);
        let place = of("rad", None, open, false);
        let within = starts(&[stiffness.clone(), place.clone()], Some([1.0, 3.0]), None);
        assert_eq!(within.len(), PLACES.len());
        assert!(within.iter().all(|start| start[0] == 0.0 && 1.0 < start[1] && start[1] < 3.0));
        assert_eq!(starts(&[stiffness.clone(), place], None, None), [[0.0, 5.0]]);
        let bounded = of("rad", None, [0.0, 9.0], false);
        assert_eq!(starts(&[stiffness, bounded], Some([1.0, 3.0]), None), [[0.0, 5.0]]);
    }
}
