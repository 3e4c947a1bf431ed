//! The base parameters of given equations.

use super::markdown::escaped;
use super::{Answer, Arguments, CertificateJson, Failure, ListedBasis};
use crate::cli::elimination::{Elimination, columns};
use crate::cli::json::write_json;
use crate::cli::outputs::write_whole;
use crate::cli::progress::Progress;
use denavit::emit::latex::equations_decomposition;
use denavit::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion};
use denavit::model::equations::Equations;
use denavit::number::Residue;
use denavit::regressor::equations::equations_regressor;
use serde::Serialize;
use std::io::Write;

#[derive(Serialize)]
struct GivenJson<'a> {
    model: &'a str,
    columns: Vec<String>,
    #[serde(flatten)]
    elimination: Elimination,
    certificate: CertificateJson,
}

/// B of the equations is eliminated, and what comes out is compared with the equations.
pub(super) fn run(
    arguments: &Arguments,
    equations: &Equations,
    is_answered: bool,
    out: &mut dyn Write,
) -> Result<Answer, Failure> {
    let is_of_models = !arguments.with.is_empty()
        || arguments.terms.is_some()
        || arguments.numeric
        || arguments.basis == ListedBasis::Joints
        || arguments.certificate.is_some();
    if is_of_models {
        return Err(Failure::NotOfEquations(equations.name.clone()));
    }
    let progress = Progress::new();
    let mut show = |_| progress.show("writing the equations out");
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut show };
    let mut found = equations_regressor(equations, Basis::Product, &mut expansion)
        .map_err(Failure::Equations)?;
    let theta = found.theta(&arguments.keep).map_err(Failure::Equations)?;
    let verified = found.holds(&theta).map_err(Failure::Equations)?;
    progress.clear();
    let named = columns(&found.dag, &found.parameters, found.units.clone());
    let elimination = Elimination::new(&mut found.dag, &theta, &named);
    let answer = if verified { Answer::Done } else { Answer::Negative };
    let columns: Vec<String> = named.into_iter().map(|column| column.name).collect();
    if let Some(path) = &arguments.latex {
        let document = equations_decomposition(equations, &found, Some(&theta))
            .expect("our template has a place for each value");
        write_whole(path, document.as_bytes())?;
    }
    if let Some(path) = &arguments.markdown {
        let mut document = format!(
            "# Base parameters of {}\n\n{} base parameters of {} columns.\n\n",
            escaped(&equations.name),
            theta.rank(),
            columns.len()
        );
        document.push_str(&elimination.markdown());
        write_whole(path, document.as_bytes())?;
    }
    if is_answered {
        return Ok(answer);
    }
    if arguments.json {
        let (model, prime) = (equations.name.as_str(), Residue::MODULUS);
        let certificate = CertificateJson { verified, prime };
        write_json(out, &GivenJson { model, columns, elimination, certificate })?;
        return Ok(answer);
    }
    let (rank, count) = (theta.rank(), columns.len());
    writeln!(out, "{}: {rank} base parameters of {count} columns\n", equations.name)?;
    elimination.write(out)?;
    let verdict = if verified { "checked" } else { "do NOT agree" };
    writeln!(out, "\nexact; with the equations {verdict} modulo {}", Residue::MODULUS)?;
    Ok(answer)
}
