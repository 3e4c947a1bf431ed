//! In how many steps a robot can come to rest, as text, JSON and a picture.

use crate::walk::CaptureReach;
use crate::{Align, Table};
use denavit_walk::capturability::{Capturability, CaptureRegion, Steps};
use serde_json::{Value, json as value};
use std::fmt::{self, Write};

/// The number of steps, for JSON; null where it falls.
pub(super) fn steps_value(steps: Steps) -> Value {
    match steps {
        Steps::Least(steps) => steps.into(),
        Steps::Falls => Value::Null,
    }
}

/// Capturability of a robot.
#[derive(Clone, Copy, Debug)]
pub struct CapturabilityAnswer<'a> {
    /// The scenario.
    pub name: &'a str,
    /// From which capture points which steps are enough.
    pub found: &'a Capturability,
    /// The largest number of steps that is listed.
    pub steps: u32,
    /// A capture point that is asked for \[m\], forward from the ankle that stands.
    pub capture_m: Option<f64>,
}

impl CapturabilityAnswer<'_> {
    fn reaches(&self) -> Vec<[f64; 2]> {
        (0..=self.steps as usize).map(|steps| self.found.reach_m(steps)).collect()
    }

    /// The capture point that is asked for, the steps that it needs, and where the foot may land at
    /// the least time.
    fn wanted(&self) -> Option<(f64, Steps, Option<CaptureRegion>)> {
        let capture_m = self.capture_m?;
        let steps = self.found.steps(capture_m);
        let region = match steps {
            Steps::Least(steps) => self.found.region(capture_m, self.found.limits().step_s, steps),
            Steps::Falls => None,
        };
        Some((capture_m, steps, region))
    }
}

/// Capturability as JSON.
pub fn capturability_json(answer: &CapturabilityAnswer<'_>) -> Value {
    let CapturabilityAnswer { name, found, .. } = *answer;
    let limits = found.limits();
    let one = |(steps, [back, forward]): (usize, [f64; 2])| {
        let backward_m = -back;
        value!({ "steps": steps, "backward_m": backward_m, "forward_m": forward })
    };
    let reach: Vec<Value> = answer.reaches().into_iter().enumerate().map(one).collect();
    let [back, forward] = found.limit_m();
    let capture = answer.wanted().map(|(capture_m, steps, region)| {
        value!({
            "capture_m": capture_m,
            "steps": steps_value(steps),
            "region_m": region.map(|region| region.places_m),
        })
    });
    value!({
        "scenario": name,
        "height_m": limits.height_m,
        "omega_per_s": limits.omega(),
        "heel_m": limits.heel_m,
        "toe_m": limits.toe_m,
        "step_s": limits.step_s,
        "longest_step_m": limits.longest_m,
        "reach": reach,
        "limit": { "backward_m": -back, "forward_m": forward },
        "capture": capture,
    })
}

/// The same as text.
pub fn capturability_text(answer: &CapturabilityAnswer<'_>) -> String {
    let mut out = String::new();
    write(&mut out, answer).expect("text has room");
    out
}

fn write(out: &mut String, answer: &CapturabilityAnswer<'_>) -> fmt::Result {
    let CapturabilityAnswer { name, found, .. } = *answer;
    let limits = found.limits();
    writeln!(out, "{name}: capture points from which so many steps are enough\n")?;
    let [longest_back, longest_forward] = limits.longest_m;
    let mut table = Table::new(&[("", Align::Left), ("", Align::Right)]);
    for (what, size) in [
        ("height of the centre of mass", format!("{:.4} m", limits.height_m)),
        ("sqrt(g / z)", format!("{:.4} 1/s", limits.omega())),
        ("sole behind the ankle", format!("{:.4} m", limits.heel_m)),
        ("sole ahead of the ankle", format!("{:.4} m", limits.toe_m)),
        ("least step time", format!("{:.4} s", limits.step_s)),
        ("longest step backward", format!("{longest_back:.4} m")),
        ("longest step forward", format!("{longest_forward:.4} m")),
    ] {
        table.push(vec![what.to_owned(), size]);
    }
    writeln!(out, "{table}")?;
    let columns =
        [("steps", Align::Right), ("backward [m]", Align::Right), ("forward [m]", Align::Right)];
    let mut table = Table::new(&columns);
    let mut row = |steps: String, [back, forward]: [f64; 2]| {
        table.push(vec![steps, format!("{:.4}", -back), format!("{forward:.4}")]);
    };
    for (steps, reach) in answer.reaches().into_iter().enumerate() {
        row(steps.to_string(), reach);
    }
    row("any".to_owned(), found.limit_m());
    write!(out, "{table}")?;
    if let Some((place, steps, region)) = answer.wanted() {
        writeln!(out)?;
        match steps {
            Steps::Falls => writeln!(out, "a capture point at {place} m: no number of steps")?,
            Steps::Least(steps) => writeln!(out, "a capture point at {place} m: {steps} at least")?,
        }
        if let Some(region) = region {
            let ([low, high], landing_s) = (region.places_m, region.landing_s);
            writeln!(out, "a foot that lands at {landing_s} s: from {low:.4} to {high:.4} m")?;
        }
    }
    Ok(())
}

/// The reaches over the sole.
pub fn capturability_picture(answer: &CapturabilityAnswer<'_>) -> String {
    let CapturabilityAnswer { name, found, .. } = *answer;
    let limits = found.limits();
    let title = format!("{}: capturability", name.replace('_', " "));
    let subtitle = format!(
        "capture points from which so many steps of {} s and {} m are enough",
        limits.step_s, limits.longest_m[1]
    );
    let marks: Vec<(f64, String)> =
        answer.capture_m.map(|place| (place, "capture point".to_owned())).into_iter().collect();
    CaptureReach {
        title: &title,
        subtitle: &subtitle,
        sole_m: limits.sole_m(),
        reach_m: &answer.reaches(),
        limit_m: found.limit_m(),
        marks: &marks,
    }
    .draw()
}
