//! The pushes of a scenario.

use super::fault::Cause;
use super::ranges;
use super::reader::{FieldsNumbers, Report};
use crate::push::{Push, Shove};
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::{Fields, Node};
use denavit_plants::{PlantModel, PointModel};

const KEYS: &[&str] = &["link", "position_m", "at_s", "impulse_ns", "force_n", "duration_s"];

/// All pushes, in the order of their times; of a robot whose run begins and ends at these times
/// \[s\].
pub(super) fn pushes(
    fields: &Fields<'_>,
    model: &PlantModel,
    run_s: [f64; 2],
    report: &mut Report,
) -> Vec<Push> {
    let nodes = fields.get("pushes").map_or_else(Vec::new, |node| node.items(report));
    let mut pushes = Vec::new();
    for node in nodes {
        let Some(push) = push(node, model, report) else { continue };
        if let Some(missing) = idle(&push, model.planar, run_s) {
            report.push(node.at(), Cause::NoEffect(missing));
        }
        pushes.push(push);
    }
    pushes.sort_by(|a, b| a.at_s.total_cmp(&b.at_s));
    pushes
}

/// What a push lacks to have an effect.
fn idle(push: &Push, is_planar: bool, [start_s, end_s]: [f64; 2]) -> Option<&'static str> {
    let (vector, over_s) = match push.shove {
        Shove::Impulse(vector) => (vector, push.at_s),
        Shove::Force(vector, duration_s) => (vector, push.at_s + duration_s),
    };
    if push.at_s >= end_s || over_s < start_s {
        return Some("a run that lasts until then");
    }
    let [x, y, z] = vector;
    match (x == 0.0 && z == 0.0, y == 0.0) {
        (true, true) => Some("a strength"),
        (true, false) if is_planar => Some("a part along x or z, where the robot moves"),
        _ => None,
    }
}

fn push(node: Node<'_>, model: &PlantModel, report: &mut Report) -> Option<Push> {
    let given = node.fields(KEYS, report)?;
    let link = given.require("link", report).and_then(|node| {
        let name = node.text(report)?;
        let found = model.links.iter().position(|link| link == name);
        if found.is_none() {
            let meant = nearest(name, model.links.iter().map(String::as_str)).map(str::to_owned);
            report.push(node.at(), Cause::UnknownLink(name.to_owned(), meant));
        }
        found
    });
    let position = given.array("position_m", ranges::PLACE_M, [0.0; 3], report);
    let at_s = given.required_number("at_s", ranges::START_S, report);
    let shove = match (given.get("impulse_ns"), given.get("force_n")) {
        (Some(_), Some(force)) => {
            report.push(force.at(), Cause::TwoShoves);
            return None;
        }
        (Some(_), None) => {
            if let Some(duration) = given.get("duration_s") {
                report.push(duration.at(), Cause::NoEffect("`force_n` in place of `impulse_ns`"));
            }
            Shove::Impulse(given.array("impulse_ns", ranges::SHOVE, [0.0; 3], report))
        }
        (None, Some(_)) => Shove::Force(
            given.array("force_n", ranges::SHOVE, [0.0; 3], report),
            given.required_number("duration_s", ranges::SHOVE_S, report),
        ),
        (None, None) => {
            let _ = given.require("impulse_ns", report);
            return None;
        }
    };
    let link = link?;
    let name = format!("{} pushed", model.links[link]);
    Some(Push { point: PointModel { name, link, position }, at_s, shove })
}
