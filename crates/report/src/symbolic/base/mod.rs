//! The base parameters of a model, or of given equations, as documents.

mod given;
mod json;
mod markdown;
mod text;

pub use given::GivenBaseReport;

use super::text_of;
use crate::Values;
use denavit_codegen::emit::latex;
use denavit_codegen::expr::ExprId;
use denavit_codegen::number::Residue;
use denavit_codegen::regressor::{BaseParameter, BaseParameters, JointParameter, Part, ProvenBase};
use denavit_numerics::short;
use serde::Serialize;
use std::fmt::Display;

/// What was checked, and modulo which prime.
#[derive(Serialize)]
struct CertificateJson {
    verified: bool,
    prime: u64,
}

impl CertificateJson {
    fn new(verified: bool) -> Self {
        Self { verified, prime: Residue::MODULUS }
    }
}

/// Base parameters with all that is shown of them.
#[derive(Clone, Debug)]
pub struct BaseReport<'a> {
    found: &'a ProvenBase,
    /// The values of what is listed; none where the model gives none.
    values: Vec<Option<f64>>,
}

/// A base parameter as it is listed.
struct Listed<'a> {
    name: &'a str,
    unit: &'a str,
    members: &'a [(usize, ExprId)],
    parts: &'a [Part],
    /// What it is of the base parameters of kept columns, where it is none of them.
    of_kept: Option<OfKept<'a>>,
}

/// A sum of base parameters of kept columns.
struct OfKept<'a> {
    /// Their places, with factors.
    members: &'a [(usize, ExprId)],
    parts: &'a [Part],
}

impl<'a> BaseReport<'a> {
    /// Those of the joint axes are listed if they were found.
    pub fn new(found: &'a ProvenBase) -> Self {
        let base = &found.base;
        let listed: Vec<ExprId> = match &found.joints {
            Some(joints) => joints.iter().map(|parameter| parameter.value).collect(),
            None => base.parameters.iter().map(|parameter| parameter.value).collect(),
        };
        let mut values = Values::in_graph(&base.regressor.dag, &found.robot);
        let values = listed.into_iter().map(|value| values.number(value));
        Self { found, values: values.collect() }
    }

    /// For people, with what becomes of each of the model's effects.
    pub fn text(&self, effects: &[impl Display]) -> String {
        text_of(|out| text::write(out, self, effects))
    }

    /// A JSON document, with what becomes of each of the model's effects.
    pub fn json<E: Serialize>(&self, effects: &'a [E]) -> impl Serialize + use<'_, 'a, E> {
        json::document(self, effects)
    }

    /// A document of Markdown.
    pub fn markdown(&self) -> String {
        markdown::document(self)
    }

    /// A LaTeX document.
    pub fn latex(&self) -> String {
        let ProvenBase { robot, base, joints, .. } = self.found;
        latex::base_document(robot, base, joints.as_deref(), &self.shown_values())
            .expect("our template has a place for each value")
    }

    fn base(&self) -> &'a BaseParameters {
        &self.found.base
    }

    /// What is listed, in order.
    fn listed(&self) -> Vec<Listed<'a>> {
        let base = self.base();
        let of_kept_column = |parameter: &'a BaseParameter| Listed {
            name: base.name(parameter.column),
            unit: &base.regressor.columns[parameter.column].unit,
            members: &parameter.members,
            parts: &parameter.parts,
            of_kept: None,
        };
        let on_axis = |parameter: &'a JointParameter| Listed {
            name: &parameter.name,
            unit: &parameter.unit,
            members: &parameter.members,
            parts: &parameter.parts,
            of_kept: Some(OfKept { members: &parameter.of_kept, parts: &parameter.parts_of_kept }),
        };
        match &self.found.joints {
            Some(joints) => joints.iter().map(on_axis).collect(),
            None => base.parameters.iter().map(of_kept_column).collect(),
        }
    }

    /// What is said of the list in its title.
    fn place(&self) -> &'static str {
        if self.found.joints.is_some() { ", on the joint axes" } else { "" }
    }

    /// What the names of the list are called.
    fn head(&self) -> &'static str {
        if self.found.joints.is_some() { "name" } else { "kept" }
    }

    /// The values as a person writes them; none at all if the model gives only zeros.
    fn shown_values(&self) -> Vec<String> {
        let says = |value: &Option<f64>| value.is_some_and(|value| value != 0.0);
        match self.values.iter().any(says) {
            true => self.values.iter().map(|value| value.map_or(String::new(), short)).collect(),
            false => Vec::new(),
        }
    }

    fn names(&self, columns: Vec<usize>) -> Vec<&'a str> {
        columns.into_iter().map(|column| self.base().name(column)).collect()
    }

    /// What is listed in the base parameters of kept columns; none of these.
    fn in_kept(&self) -> Vec<(&'a str, &'a [Part])> {
        let listed = self.listed().into_iter();
        listed.filter_map(|one| one.of_kept.map(|sum| (one.name, sum.parts))).collect()
    }

    /// The columns that are sums of others, with their relations.
    fn sums(&self) -> impl Iterator<Item = (&'a str, &'a [Part])> {
        let base = self.base();
        let sums = base.dependent.iter().filter(|one| !one.relation.is_empty());
        sums.map(|one| (base.name(one.column), &one.parts[..]))
    }
}
