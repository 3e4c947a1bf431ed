//! Base parameters as JSON.

use super::{CertificateJson, Found};
use crate::cli::failure::Failure;
use crate::cli::json::{Ordered, write_json};
use denavit::emit::latex::{base_notation, base_sum};
use denavit::expr::ExprId;
use denavit::number::Residue;
use denavit::workflow::EffectUse;
use serde::Serialize;
use std::io::Write;

#[derive(Serialize)]
struct BaseJson<'a> {
    model: &'a str,
    basis: &'static str,
    columns: Vec<&'a str>,
    rank: usize,
    zero: Vec<&'a str>,
    dependent: Vec<DependentJson<'a>>,
    /// The columns that are in no relation: what can be identified by itself.
    alone: Vec<&'a str>,
    parameters: Vec<ParameterJson<'a>>,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    effects: &'a [EffectUse],
    certificate: CertificateJson,
}

#[derive(Serialize)]
struct DependentJson<'a> {
    name: &'a str,
    relation: String,
}

#[derive(Serialize)]
struct ParameterJson<'a> {
    name: &'a str,
    expression: String,
    latex: String,
    unit: &'a str,
    members: Ordered<String>,
    /// The factors of base parameters of kept columns, by these.
    #[serde(skip_serializing_if = "Option::is_none")]
    of_kept: Option<Ordered<String>>,
    alone: bool,
    value: Option<f64>,
}

pub(super) fn write(out: &mut dyn Write, found: &Found<'_>) -> Result<(), Failure> {
    let base = found.base;
    let notation = base_notation(found.robot, base);
    let listed = found.listed();
    let parameters = listed.iter().zip(&found.values).map(|(parameter, &value)| {
        let factors = |members: &[(usize, ExprId)], column: &dyn Fn(usize) -> usize| {
            let factor = |&(member, factor): &(usize, ExprId)| {
                (base.name(column(member)).to_owned(), base.text(factor))
            };
            Ordered(members.iter().map(factor).collect())
        };
        let kept = |place: usize| base.parameters[place].column;
        ParameterJson {
            name: parameter.name,
            expression: base.sum_text(parameter.parts),
            latex: base_sum(base, parameter.parts, &notation),
            unit: parameter.unit,
            members: factors(parameter.members, &|column| column),
            of_kept: parameter.of_kept.as_ref().map(|sum| factors(sum.members, &kept)),
            alone: parameter.members.len() == 1,
            value,
        }
    });
    let dependent = found.sums();
    let dependent =
        dependent.map(|(name, sum)| DependentJson { name, relation: base.sum_text(sum) });
    let json = BaseJson {
        model: &found.robot.name,
        basis: if found.joints.is_some() { "joints" } else { "kept" },
        columns: base.regressor.columns.iter().map(|column| column.name.as_str()).collect(),
        rank: base.rank(),
        zero: found.names(base.zero()),
        dependent: dependent.collect(),
        alone: found.names(base.alone()),
        parameters: parameters.collect(),
        effects: &found.effects,
        certificate: CertificateJson { verified: found.verified, prime: Residue::MODULUS },
    };
    write_json(out, &json)
}
