//! Base parameters as JSON.

use super::{BaseReport, CertificateJson};
use crate::Ordered;
use denavit_codegen::emit::latex::{base_notation, base_sum};
use denavit_codegen::expr::ExprId;
use serde::Serialize;

#[derive(Serialize)]
struct BaseJson<'a, E: Serialize> {
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
    effects: &'a [E],
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

pub(super) fn document<'a, E: Serialize>(
    found: &BaseReport<'a>,
    effects: &'a [E],
) -> impl Serialize + use<'a, E> {
    let base = found.base();
    let robot = &found.found.robot;
    let notation = base_notation(robot, base);
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
    BaseJson {
        model: &robot.name,
        basis: if found.found.joints.is_some() { "joints" } else { "kept" },
        columns: base.regressor.columns.iter().map(|column| column.name.as_str()).collect(),
        rank: base.rank(),
        zero: found.names(base.zero()),
        dependent: dependent.collect(),
        alone: found.names(base.alone()),
        parameters: parameters.collect(),
        effects,
        certificate: CertificateJson::new(found.found.verified),
    }
}
