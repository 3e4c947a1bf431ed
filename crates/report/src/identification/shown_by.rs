//! Which motion would show a parameter that logs do not: found by the regressor itself, at motions
//! of one kind after the other, the plainest first.
//!
//! A kind shows a parameter where its column is more than a sum of those of the other parameters
//! that are not known.

use denavit_numerics::Random;
use denavit_plants::regression::{RegressionModel, RegressionRows};
use std::f64::consts::FRAC_PI_2;

/// Samples of each kind of motion.
const SAMPLES: usize = 60;

/// What a column must have beyond the others, per its length.
const OWN: f64 = 1e-6;

/// A kind of motion.
#[derive(Clone, Debug)]
enum Kind {
    /// All joints at rest, in many postures.
    Rest,
    /// One joint at many velocities.
    Velocity(usize),
    /// One joint at many accelerations and velocities.
    Acceleration(usize),
    /// Two joints at many accelerations and velocities.
    Both(usize, usize),
    /// All joints together.
    All,
}

/// For each of these parameters, by their names, the motion that shows it.
pub(super) fn motions(model: &RegressionModel, hidden: &[&str]) -> Vec<String> {
    let places: Vec<Option<usize>> =
        hidden.iter().map(|name| model.listed.iter().position(|one| one.name == *name)).collect();
    let known: Vec<usize> = places.iter().copied().flatten().collect();
    let mut found: Vec<Option<String>> = vec![None; hidden.len()];
    let ways = |kinds: Vec<Kind>, word: &dyn Fn(&Kind) -> String, found: &mut [Option<String>]| {
        let mut shown: Vec<Vec<String>> = vec![Vec::new(); hidden.len()];
        for kind in &kinds {
            let columns = columns(model, kind, &known);
            let mut own = (0..known.len()).map(|at| is_own(&columns, at));
            for (parameter, place) in places.iter().enumerate() {
                let is_shown = place.is_some() && own.next().unwrap_or(false);
                if is_shown && found[parameter].is_none() {
                    shown[parameter].push(word(kind));
                }
            }
        }
        for (found, shown) in found.iter_mut().zip(shown).filter(|(_, shown)| !shown.is_empty()) {
            let listed = shown.into_iter().take(3).collect::<Vec<_>>().join(", or ");
            *found = Some(listed);
        }
    };
    let joints = 0..model.joints.len();
    let name = |joint: usize| model.joints[joint].name.as_str();
    let word = |kind: &Kind| match *kind {
        Kind::Rest => "all joints are held still, in several postures".to_owned(),
        Kind::Velocity(joint) => {
            format!("{} moves at several velocities, both ways", name(joint))
        }
        Kind::Acceleration(joint) => {
            format!("{} speeds up and slows down, in several postures", name(joint))
        }
        Kind::Both(a, b) => format!("{} and {} move at the same time", name(a), name(b)),
        Kind::All => "all joints move at the same time".to_owned(),
    };
    ways(vec![Kind::Rest], &word, &mut found);
    ways(joints.clone().map(Kind::Velocity).collect(), &word, &mut found);
    ways(joints.clone().map(Kind::Acceleration).collect(), &word, &mut found);
    let pairs = joints.clone().flat_map(|a| joints.clone().skip(a + 1).map(move |b| (a, b)));
    ways(pairs.map(|(a, b)| Kind::Both(a, b)).collect(), &word, &mut found);
    ways(vec![Kind::All], &word, &mut found);
    let none = || "no motion that was tried shows it apart from the others".to_owned();
    found.into_iter().map(|one| one.unwrap_or_else(none)).collect()
}

/// The columns of listed parameters at motions of a kind: torques of all joints, one below the
/// other.
fn columns(model: &RegressionModel, kind: &Kind, listed: &[usize]) -> Vec<Vec<f64>> {
    let joints = model.joints.len();
    let mut random = Random::new(1);
    let mut motion = vec![Vec::with_capacity(SAMPLES); 3 * joints];
    for _ in 0..SAMPLES {
        for joint in 0..joints {
            let [low, high] =
                model.joints[joint].position_limits.unwrap_or([-FRAC_PI_2, FRAC_PI_2]);
            let mut within = |reach: f64| reach * (2.0 * random.uniform() - 1.0);
            let (velocity, acceleration) = (within(1.0), within(3.0));
            let [moves, speeds_up] = match *kind {
                Kind::Rest => [false, false],
                Kind::Velocity(one) => [one == joint, false],
                Kind::Acceleration(one) => [one == joint, one == joint],
                Kind::Both(a, b) => [a == joint || b == joint; 2],
                Kind::All => [true, true],
            };
            motion[joint].push(low + (high - low) * random.uniform());
            motion[joints + joint].push(if moves { velocity } else { 0.0 });
            motion[2 * joints + joint].push(if speeds_up { acceleration } else { 0.0 });
        }
    }
    let motion: Vec<&[f64]> = motion.iter().map(Vec::as_slice).collect();
    let mut rows = RegressionRows::default();
    let evaluated = model.evaluator().evaluate(&motion, &mut rows);
    evaluated.expect("a column of each joint");
    let (to_axes, pattern) = (model.to_axes(), model.pattern());
    let of = |&place: &usize| -> Vec<f64> {
        let joint = |joint: usize| {
            let factors: Vec<f64> =
                pattern[joint].iter().map(|&axis| to_axes[(axis, place)]).collect();
            let mut torque = vec![0.0; rows.samples()];
            for (column, factor) in factors.iter().enumerate() {
                let entries = rows.column(joint, column);
                torque.iter_mut().zip(entries).for_each(|(sum, entry)| *sum += factor * entry);
            }
            torque
        };
        (0..joints).flat_map(joint).collect()
    };
    listed.iter().map(of).collect()
}

/// Whether a column is more than a sum of the others (Gram and Schmidt, twice).
fn is_own(columns: &[Vec<f64>], at: usize) -> bool {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let size = |column: &[f64]| dot(column, column).sqrt();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let left_of = |basis: &[Vec<f64>], column: &[f64]| {
        let mut left = column.to_vec();
        for one in basis.iter().chain(basis) {
            let along = dot(one, &left);
            left.iter_mut().zip(one).for_each(|(entry, one)| *entry -= along * one);
        }
        left
    };
    for (_, column) in columns.iter().enumerate().filter(|(place, _)| *place != at) {
        let left = left_of(&basis, column);
        let length = size(&left);
        if length > OWN * size(column) && length > 0.0 {
            basis.push(left.iter().map(|entry| entry / length).collect());
        }
    }
    let whole = size(&columns[at]);
    whole > OWN && size(&left_of(&basis, &columns[at])) > OWN * whole
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_codegen::regressor::functions::modelled;
    use denavit_plants::shipped;

    #[test]
    fn friction_is_shown_by_motion_and_gravity_by_rest() {
        let text = shipped::find("puma560").expect("shipped").text;
        let robot = denavit_codegen::model::read("puma560", text.as_bytes()).expect("a model");
        let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a regressor");
        let names: Vec<&str> = model.listed.iter().map(|one| one.name.as_str()).collect();
        let found = motions(&model, &names);
        let of = |start: &str| {
            let at = names.iter().position(|name| name.starts_with(start)).expect(start);
            found[at].as_str()
        };
        assert_eq!(of("fv_waist"), "waist moves at several velocities, both ways");
        assert!(of("fc_elbow").starts_with("elbow moves at several velocities"));
        assert!(found.iter().any(|one| one.starts_with("all joints are held still")));
        assert!(found.iter().all(|one| !one.starts_with("no motion")), "{found:?}");
    }
}
