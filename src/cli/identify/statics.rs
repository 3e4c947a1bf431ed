//! `denavit identify --static`: weighings and held postures (thesis 3.2.1), joined with logs.

use super::{Answered, Arguments, IdentifyFailure};
use crate::cli::Answer;
use crate::cli::base::regressor_options;
use crate::cli::failure::Failure;
use crate::cli::files::read_wanted;
use crate::cli::json::write_json;
use crate::cli::mistaken::Wanted;
use crate::cli::progress::Progress;
use denavit::identify::knowledge::{Consequences, Determined, Knowledge};
use denavit::identify::read_statics;
use denavit::identify::statics::{static_knowledge, suspicious_units};
use denavit::plants::regression::RegressionModel;
use denavit::report::{Align, Table, paragraph, short};
use serde_json::json;
use std::io::Write;
use std::path::Path;

pub(super) fn run(
    arguments: &Arguments,
    path: &Path,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let (robot, _) = arguments.model_apart()?.without_laws()?;
    let options = regressor_options(&robot, &arguments.with)?;
    let model = RegressionModel::new(&robot, options, &arguments.keep)
        .map_err(|error| IdentifyFailure::Regression(Box::new(error)))?;
    let file = path.display().to_string();
    let measured = read_statics(&file, &read_wanted(path, Wanted::Statics)?, &model)
        .map_err(Failure::Scenario)?;
    let suspicious = suspicious_units(&model, &measured);
    if !(suspicious.is_empty() || arguments.accept_suspicious) {
        return Err(IdentifyFailure::Statics(file, suspicious).into());
    }
    let mut knowledge = static_knowledge(&model, &measured)
        .map_err(|faults| IdentifyFailure::Statics(file, faults))?;
    let mut remarks = Vec::new();
    if !arguments.train.is_empty() {
        let progress = Progress::new();
        let answered = Answered::new(arguments, &progress)?;
        progress.clear();
        remarks.extend(answered.remarks.iter().map(|(file, one)| format!("{file}: {one}")));
        remarks.extend(answered.found.warnings());
        if let Some(remark) = join(&model, &answered, &mut knowledge) {
            remarks.push(remark);
        }
    }
    let found = knowledge.consequences();
    remarks.extend(nothing_follows(&knowledge, &found).map(str::to_owned));
    match arguments.json {
        true => write_json(out, &as_json(&model, &knowledge, &found, &remarks))?,
        false => write(out, &model, (&knowledge, &found), &remarks)?,
    }
    let is_answer = !found.combinations.is_empty() && !found.contradicts();
    Ok(if is_answer { Answer::Done } else { Answer::Negative })
}

/// Why nothing follows, if nothing does.
fn nothing_follows(knowledge: &Knowledge, found: &Consequences) -> Option<&'static str> {
    match (knowledge.equations(), found.combinations.len()) {
        (0, _) => Some(
            "Nothing follows: the file has neither weighings nor torques of postures, and no log \
             says more. `denavit schema statics` prints what it may have.",
        ),
        (_, 0) => Some(
            "Nothing follows: no equation has an unknown parameter in it. What is on the scale, or \
             weighs on the joints, is known, or the joints that were held carry nothing.",
        ),
        _ => None,
    }
}

/// Adds what logs say; a remark if only a part of it can be added.
fn join(model: &RegressionModel, answered: &Answered, knowledge: &mut Knowledge) -> Option<String> {
    let estimate = &answered.found.estimate;
    let phi = estimate.solution.phi.as_slice();
    if knowledge.add_estimate(model, phi, &estimate.covariance) {
        return None;
    }
    Some(
        "The logs leave directions of the parameters open: they are not joined with the \
         measurements at rest."
            .to_owned(),
    )
}

/// What is said of equations that cannot all be true.
const CONTRADICTION: &str = " They contradict each other: a measurement, its sign, its unit or its \
                             deviation is wrong, and what follows is not to be used.";

/// A combination as a sum.
fn sum(model: &RegressionModel, one: &Determined) -> String {
    let mut text = String::new();
    for &(at, factor) in &one.members {
        let sign = match (text.is_empty(), factor < 0.0) {
            (true, true) => "-",
            (true, false) => "",
            (false, true) => " - ",
            (false, false) => " + ",
        };
        let size = factor.abs();
        let times =
            if (size - 1.0).abs() < 1e-12 { String::new() } else { format!("{} ", short(size)) };
        text += &format!("{sign}{times}{}", model.standard[at].name);
    }
    text
}

fn write(
    out: &mut dyn Write,
    model: &RegressionModel,
    (knowledge, found): (&Knowledge, &Consequences),
    remarks: &[String],
) -> Result<(), Failure> {
    for remark in remarks {
        writeln!(out, "{}\n", paragraph("", "", remark))?;
    }
    let alone = found.parameters.iter().flatten().count();
    writeln!(
        out,
        "{}: {} equations determine {} combinations of {} parameters, of which {alone} stand \
         alone\n",
        model.model,
        knowledge.equations(),
        found.combinations.len(),
        model.standard.len(),
    )?;
    let mut table = Table::new(&[
        ("what follows", Align::Left),
        ("value", Align::Right),
        ("std", Align::Right),
        ("model", Align::Right),
        ("unit", Align::Left),
    ]);
    for one in &found.combinations {
        let of_model = one
            .members
            .iter()
            .map(|&(at, factor)| model.standard[at].value.map(|value| factor * value));
        let of_model = of_model.sum::<Option<f64>>();
        table.push(vec![
            sum(model, one),
            short(one.value),
            format!("{:.1e}", one.std),
            of_model.map_or(String::new(), short),
            one.members.first().map_or(String::new(), |m| model.standard[m.0].unit.clone()),
        ]);
    }
    write!(out, "{}", table.without_empty_columns())?;
    if found.degrees_of_freedom > 0 {
        let missed = (found.chi_squared / found.degrees_of_freedom as f64).sqrt();
        let missed = if missed < 0.01 { "less than 0.01".to_owned() } else { short(missed) };
        let text = format!(
            "The equations miss each other by {} standard deviations ({} more than are needed): \
             about 1 is what the stated deviations lead one to expect.{}",
            missed,
            found.degrees_of_freedom,
            if found.contradicts() { CONTRADICTION } else { "" }
        );
        writeln!(out, "\n{}", paragraph("", "", &text))?;
    }
    Ok(())
}

fn as_json(
    model: &RegressionModel,
    knowledge: &Knowledge,
    found: &Consequences,
    remarks: &[String],
) -> serde_json::Value {
    let parameters = model.standard.iter().zip(&found.parameters);
    let parameters = parameters.map(|(one, follows)| {
        json!({
            "name": one.name,
            "unit": one.unit,
            "value": follows.map(|(value, _)| value),
            "std": follows.map(|(_, std)| std),
            "model_value": one.value,
            "identifiable": follows.is_some(),
        })
    });
    let combinations = found.combinations.iter().map(|one| {
        let members = one.members.iter();
        let members: serde_json::Map<String, serde_json::Value> =
            members.map(|&(at, factor)| (model.standard[at].name.clone(), factor.into())).collect();
        json!({"members": members, "value": one.value, "std": one.std})
    });
    json!({
        "model": model.model,
        "equations": knowledge.equations(),
        "parameters": parameters.collect::<Vec<_>>(),
        "combinations": combinations.collect::<Vec<_>>(),
        "chi_squared": found.chi_squared,
        "degrees_of_freedom": found.degrees_of_freedom,
        "contradicts": found.contradicts(),
        "remarks": remarks,
    })
}
