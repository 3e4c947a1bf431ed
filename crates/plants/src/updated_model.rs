//! The model with the identified values, as text that every command reads and as a robot.

use super::error::Error;
use super::model_text::{NewValue, with_values, without};
use super::regression::{ModelParameter, RegressionModel, RegressionParameter};
use denavit_codegen::model::{self, About, BodyEntry, Robot, Role};
use std::collections::BTreeMap;

/// A model with new values.
#[derive(Clone, Debug)]
pub struct UpdatedModel {
    /// The file, which is as it was but for the values.
    pub text: String,
    /// What it says.
    pub robot: Robot,
    /// Standard errors of its numbers by name: of those that the logs determine by themselves, and
    /// that are as they were estimated.
    pub errors: BTreeMap<String, f64>,
}

/// Values that were found of a model.
#[derive(Clone, Copy, Debug)]
pub struct FoundValues<'a> {
    /// theta0, in the order of [`RegressionModel::standard`].
    pub standard: &'a [f64],
    /// Of the model's own numbers, where columns are products of them: their places in
    /// [`RegressionModel::parameters`].
    pub own: &'a [(usize, f64)],
    /// Of each listed parameter the estimate with its standard error; none where it has none.
    pub estimates: &'a [Option<[f64; 2]>],
}

/// Writes values that were found into a model's file, `source`, and reads it again. Parameters that
/// stand alone get their standard error, if they have one and the file means the same by them: a
/// moment of inertia about the centre of mass is not the one about the origin of the link that was
/// estimated.
///
/// # Errors
/// The file has no place for values, or they make no model.
pub fn updated_model(
    robot: &Robot,
    model: &RegressionModel,
    found: FoundValues<'_>,
    source: &str,
) -> Result<UpdatedModel, Error> {
    let is_about_com = |link: &str| {
        let body = robot.find_link(link).and_then(|link| robot.links[link].body);
        body.is_some_and(|body| body.about == About::Com)
    };
    let values = model.file_values(found.standard, found.own, &is_about_com);
    let estimate_of = |parameter: &ModelParameter| {
        if is_moved(parameter, &is_about_com) {
            return None;
        }
        let is_it = |one: &RegressionParameter| one.is_alone && one.name == parameter.name;
        let place = model.listed.iter().position(is_it)?;
        found.estimates[place].filter(|[_, std]| *std > 0.0 && std.is_finite())
    };
    // a deviation is that of the estimate: what was moved further to exist has none
    let std_of = |parameter: &ModelParameter, value: f64| {
        let [estimate, std] = estimate_of(parameter)?;
        ((value - estimate).abs() <= std).then_some(std)
    };
    let effects = model.file_values_with_effect(&values);
    let text = |is_written: &dyn Fn(usize) -> bool| {
        let all = model.parameters.iter().zip(&values).enumerate();
        let new: Vec<NewValue<'_>> = all
            .filter(|(place, (parameter, value))| {
                is_written(*place)
                    && (moved(parameter.value, **value) || std_of(parameter, **value).is_some())
            })
            .map(|(_, (parameter, &value))| NewValue {
                parameter,
                value: snapped(value, std_of(parameter, value)),
                std: std_of(parameter, value),
            })
            .collect();
        with_values(source, &new).ok_or_else(|| Error::no_place(&model.model))
    };
    let with_error = |(parameter, value): (&ModelParameter, &f64)| {
        Some((parameter.name.clone(), std_of(parameter, *value)?))
    };
    let errors: BTreeMap<String, f64> =
        model.parameters.iter().zip(&values).filter_map(with_error).collect();
    let read = |text: String| {
        let text = with_what_is_to_accept(text);
        let robot = model::read(NAME, text.as_bytes());
        robot.map(|robot| UpdatedModel { text, robot, errors: errors.clone() })
    };
    // What moves nothing stays as it is written, unless no body has it beside the rest.
    match read(text(&|place| effects[place])?) {
        Ok(updated) => Ok(updated),
        Err(_) => read(text(&|_| true)?).map_err(Error::from),
    }
}

/// What messages call the model's file.
const NAME: &str = "the identified model";

/// A model's text where moments that no body has are accepted of those bodies alone that have them:
/// the estimate may be that of a real one.
fn with_what_is_to_accept(text: String) -> String {
    let Err(error) = model::read(NAME, text.as_bytes()) else { return text };
    let stale = error.faults.iter().filter(|fault| fault.cause == model::Cause::NothingToAccept);
    let pointers: Vec<&str> = stale.map(|fault| fault.pointer.as_str()).collect();
    without(&text, &pointers).unwrap_or(text)
}

/// A value without what is far below its error, or below what any number of a robot has.
fn snapped(value: f64, std: Option<f64>) -> f64 {
    let nothing = std.map_or(0.0, |std| 1e-6 * std).max(1e-15);
    if value.abs() < nothing { 0.0 } else { value }
}

/// Whether a value is another one, and not the same after some rounding.
fn moved(before: f64, after: f64) -> bool {
    (after - before).abs() > 1e-12 * before.abs().max(after.abs()).max(1e-3)
}

/// Whether the file has a moment of inertia about another point than the estimate.
fn is_moved(parameter: &ModelParameter, is_about_com: &dyn Fn(&str) -> bool) -> bool {
    use BodyEntry::{ComX, ComY, ComZ, Mass};
    let Some(Role::Body(_, entry)) = parameter.role else { return false };
    let is_moment = !matches!(entry, Mass | ComX | ComY | ComZ);
    is_moment && parameter.link.as_deref().is_some_and(is_about_com)
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_codegen::regressor::functions::modelled;

    const DISC: &str = r#"{
  "format": "denavit-model/1", "name": "disc", "convention": "standard", "gravity": [0, 0, -9.81],
  "links": [{
    "name": "disc", "joint": {"type": "revolute"},
    "body": {
      "mass": 1, "com": [0, 0, 0], "about": "com",
      "inertia": {"xx": 0.1, "yy": 0.1, "zz": 0.4, "xy": 0, "xz": 0, "yz": 0},
      "accept_triangle_violation": "As printed."
    }
  }]
}"#;

    /// The text of the disc with other moments about its axes.
    fn with_moments(moments: [f64; 3]) -> String {
        let robot = model::read("disc", DISC.as_bytes()).expect("a model");
        let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect("a regression");
        let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
        let mut standard = model.standard_values(&values);
        for (name, moment) in ["Ixx_disc", "Iyy_disc", "Izz_disc"].into_iter().zip(moments) {
            let place = model.standard.iter().position(|one| one.name == name);
            standard[place.expect("a parameter")] = moment;
        }
        let estimates = vec![None; model.listed.len()];
        let found = FoundValues { standard: &standard, own: &[], estimates: &estimates };
        updated_model(&robot, &model, found, DISC).expect("a model").text
    }

    #[test]
    fn a_violation_is_accepted_of_bodies_that_have_one() {
        let is_accepted = |text: &str| text.contains("accept_triangle_violation");
        assert!(is_accepted(&with_moments([0.1, 0.1, 0.3])));
        let text = with_moments([0.1, 0.1, 0.2]);
        assert!(!is_accepted(&text) && text.contains(r#""zz": 0.2"#), "{text}");
    }
}
