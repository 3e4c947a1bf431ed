//! The law as scenario files have it, beside the walk under the key `gait`.

use super::law::{FootPlacement, FootPlacementLaw};
use crate::gait_plan::{AnkleRolls, SpaceWalk};
use denavit_codegen::model::Node;
use denavit_simulate::Planning;
use denavit_simulate::scenario::{Cause, FieldsNumbers, Range, Report};
use std::sync::Arc;

const KEYS: &[&str] = &["period_s", "tolerance_m", "gain", "margin_m", "farthest_m"];
const PERIOD_S: Range = Range::new(1e-3, 1.0);
const TOLERANCE_M: Range = Range::new(1e-4, 1.0);
const GAIN: Range = Range::new(0.0, 100.0);
const MARGIN_M: Range = Range::new(0.0, 1.0);
const LENGTH_M: Range = Range::new(0.0, 10.0);

/// Reads the numbers of the law.
pub(crate) fn read(node: Node<'_>, report: &mut Report) -> Option<FootPlacement> {
    let given = node.fields(KEYS, report)?;
    let before = report.count();
    let absent = FootPlacement::default();
    let mut number =
        |key: &str, range: Range, absent: f64| given.number(key, range, absent, report);
    let numbers = FootPlacement {
        period_s: number("period_s", PERIOD_S, absent.period_s),
        tolerance_m: number("tolerance_m", TOLERANCE_M, absent.tolerance_m),
        gain: number("gain", GAIN, absent.gain),
        margin_m: number("margin_m", MARGIN_M, absent.margin_m),
        farthest_m: number("farthest_m", LENGTH_M, absent.farthest_m),
    };
    (report.count() == before).then_some(numbers)
}

impl FootPlacement {
    /// The law for a walk; at fault where its robot has no motors for it.
    pub(crate) fn planning(
        self,
        walk: SpaceWalk,
        node: Node<'_>,
        report: &mut Report,
    ) -> Option<Planning> {
        if walk.problem.ankle_rolls == AnkleRolls::Passive {
            let hint = "leave out `foot_placement`, or take driven ankle rolls";
            report.push(node.at(), Cause::Gait(UNDRIVEN.to_owned(), hint));
            return None;
        }
        Some(Planning::new(FootPlacementLaw { numbers: self, walk: Arc::new(walk) }))
    }
}

const UNDRIVEN: &str = "the centre of pressure is moved by ankles, whose rolls are passive";
