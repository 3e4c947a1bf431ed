//! The base parameters of given equations.

use super::markdown::escaped;
use super::{CertificateJson, text_of};
use crate::symbolic::elimination::{Elimination, columns};
use denavit_codegen::emit::latex::equations_decomposition;
use denavit_codegen::model::equations::Equations;
use denavit_codegen::number::Residue;
use denavit_codegen::regressor::EquationsBase;
use serde::Serialize;
use std::fmt::{self, Write};

/// The base parameters of given equations with all that is shown of them.
#[derive(Debug)]
pub struct GivenBaseReport<'a> {
    equations: &'a Equations,
    found: &'a EquationsBase,
    columns: Vec<String>,
    elimination: Elimination,
}

#[derive(Serialize)]
struct GivenJson<'a> {
    model: &'a str,
    columns: &'a [String],
    #[serde(flatten)]
    elimination: &'a Elimination,
    certificate: CertificateJson,
}

impl<'a> GivenBaseReport<'a> {
    /// Of equations and what was found of them.
    pub fn new(equations: &'a Equations, found: &'a EquationsBase) -> Self {
        let regressor = &found.regressor;
        let mut dag = regressor.dag.clone();
        let named = columns(&dag, &regressor.parameters, regressor.units.clone());
        let elimination = Elimination::new(&mut dag, &found.theta, &named);
        let columns = named.into_iter().map(|column| column.name).collect();
        Self { equations, found, columns, elimination }
    }

    /// For people.
    pub fn text(&self) -> String {
        text_of(|out| self.write(out))
    }

    /// A JSON document.
    pub fn json(&self) -> impl Serialize {
        GivenJson {
            model: &self.equations.name,
            columns: &self.columns,
            elimination: &self.elimination,
            certificate: CertificateJson::new(self.found.verified),
        }
    }

    /// A document of Markdown.
    pub fn markdown(&self) -> String {
        let (name, columns) = (escaped(&self.equations.name), self.columns.len());
        let rank = self.elimination.rank();
        let head = format!("# Base parameters of {name}\n\n");
        let size = format!("{rank} base parameters of {columns} columns.\n\n");
        head + &size + &self.elimination.markdown()
    }

    /// A LaTeX document.
    pub fn latex(&self) -> String {
        equations_decomposition(self.equations, &self.found.regressor, Some(&self.found.theta))
            .expect("our template has a place for each value")
    }

    fn write(&self, out: &mut dyn Write) -> fmt::Result {
        let (rank, count) = (self.elimination.rank(), self.columns.len());
        writeln!(out, "{}: {rank} base parameters of {count} columns\n", self.equations.name)?;
        self.elimination.write(out)?;
        let verdict = if self.found.verified { "checked" } else { "do NOT agree" };
        writeln!(out, "\nexact; with the equations {verdict} modulo {}", Residue::MODULUS)
    }
}
