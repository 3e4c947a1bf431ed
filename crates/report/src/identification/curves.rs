//! Curves of an identification.

use crate::html::{Chart, ChartCurve, Look, Panel, Part, Section};
use crate::percent;
use denavit_identify::estimate::{Convergence, IdentifiedParameter, JointResidual, Validation};
use denavit_replay::{Compared, Forward};

/// Heights of panels [px].
const TALL: u32 = 190;
const LOW: u32 = 90;
/// Standard errors that the scale holds: what is further away at first is cut.
const SHOWN: f64 = 20.0;

const TIME: [&str; 2] = ["time [s]", "time [s]"];

/// Measured and computed torques, of logs that the estimate has not seen if there are any.
pub(crate) fn torques(train: &Validation, held_out: Option<&Validation>) -> Section {
    let (judged, text) = match held_out {
        Some(judged) => (judged, "Torques of logs that the estimate has not seen, filtered."),
        None => (train, "Torques of the logs that the estimate is from, filtered: no others."),
    };
    let keys = "Drag over a curve to zoom in, click twice to see all. On the keyboard: + and -, \
                arrows, 0.";
    let mut parts = vec![Part::Paragraph { text: format!("{text} {keys}") }];
    parts.extend(judged.joints.iter().map(|joint| Part::Chart(torque(joint, judged.samples))));
    Section { heading: "Torques".to_owned(), parts }
}

fn torque(joint: &JointResidual, samples: usize) -> Chart {
    // logs follow each other: their times do not, so that a step back begins a new curve
    let (mut x, mut columns) = (Vec::new(), [Vec::new(), Vec::new(), Vec::new()]);
    let (mut shift, mut before) = (0.0, None::<f64>);
    for &[time, measured, computed] in &joint.drawn {
        if let Some(last) = before.filter(|last| time < *last) {
            shift += last - time;
            x.push(last + shift - (last - time));
            columns.iter_mut().for_each(|column| column.push(f64::NAN));
        }
        before = Some(time);
        x.push(time + shift);
        for (column, value) in columns.iter_mut().zip([measured, computed, measured - computed]) {
            column.push(value);
        }
    }
    let [measured, computed, residual] = columns;
    let torques = vec![
        ChartCurve::new("measured", Look::Measured, measured),
        ChartCurve::new("computed", Look::Computed, computed),
    ];
    let residual = vec![ChartCurve::new("residual", Look::Residual, residual)];
    let drawn = joint.drawn.len();
    let caption = match drawn < samples {
        true => format!(
            "{drawn} of {samples} samples are drawn: of each span of time the first, the last, \
             the least and the greatest."
        ),
        false => String::new(),
    };
    Chart {
        name: format!("{}: residual {}", joint.name.replace('_', " "), percent(joint.relative)),
        caption,
        group: "torques",
        over: TIME,
        x,
        panels: vec![
            Panel::new("torque [N m, N]", TALL, torques),
            Panel::new("residual [N m, N]", LOW, residual),
        ],
        windows: Vec::new(),
    }
}

/// Positions, and torques where they are compared, of a log that was simulated again.
pub(super) fn motion(forward: &Forward) -> impl Iterator<Item = Chart> + '_ {
    let chart = move |joint: &str, [what, unit]: [&str; 2], compared: &Compared| {
        let pairs = compared.measured.iter().zip(&compared.simulated);
        let off = pairs.map(|(measured, simulated)| measured - simulated).collect();
        let both = vec![
            ChartCurve::new("measured", Look::Measured, compared.measured.clone()),
            ChartCurve::new("simulated", Look::Computed, compared.simulated.clone()),
        ];
        let off = vec![ChartCurve::new("difference", Look::Residual, off)];
        let left = percent(compared.relative);
        Chart {
            name: format!("{}, {what}: residual {left}", joint.replace('_', " ")),
            caption: String::new(),
            group: "motion",
            over: TIME,
            x: forward.t_s.clone(),
            panels: vec![
                Panel::new(format!("{what} [{unit}]"), TALL, both),
                Panel::new(format!("difference [{unit}]"), LOW, off),
            ],
            windows: Vec::new(),
        }
        .thinned()
    };
    forward.joints.iter().flat_map(move |joint| {
        let torque = joint.torque.as_ref();
        let torque = torque.map(|torque| chart(&joint.name, ["torque", "N m, N"], torque));
        let position = chart(&joint.name, ["position", "rad, m"], &joint.position);
        std::iter::once(position).chain(torque)
    })
}

/// Parameters with a colour of their own: a palette has no more that everybody tells apart.
const COLOURED: usize = 6;

/// Each parameter against its end, in its own standard errors: those that come last in colour, the
/// others in grey.
pub(super) fn convergence(parameters: &[IdentifiedParameter], points: &[Convergence]) -> Chart {
    let curve = |(place, one): (usize, &IdentifiedParameter)| {
        let std = one.std.filter(|std| *std > 0.0)?;
        let off =
            |point: &Convergence| ((point.values[place] - one.value) / std).clamp(-SHOWN, SHOWN);
        let values: Vec<f64> = points.iter().map(off).collect();
        Some(ChartCurve::new(&one.name, Look::Palette, values))
    };
    let mut curves: Vec<ChartCurve> = parameters.iter().enumerate().filter_map(curve).collect();
    let mut others = String::new();
    if curves.len() > COLOURED {
        // how far a parameter still was in the second half of the data
        let late = |one: &ChartCurve| {
            let half = one.values.iter().skip(one.values.len() / 2);
            half.fold(
                0.0,
                |most: f64, off| if off.is_finite() { most.max(off.abs()) } else { most },
            )
        };
        // what is drawn last is seen
        curves.sort_by(|a, b| late(a).total_cmp(&late(b)));
        let grey = curves.len() - COLOURED;
        curves[..grey].iter_mut().for_each(|one| one.look = Look::Faint);
        others = format!(
            " In colour are the {COLOURED} that were still furthest away in the second half; the \
             others are grey. A curve stands out where the pointer is near it, or on its name."
        );
    }
    Chart {
        name: "Parameters as data come in".to_owned(),
        caption: format!(
            "Estimates of the data up to a time, with the weights of the end; what is more than \
             {SHOWN} standard errors off is drawn there.{others}"
        ),
        group: "convergence",
        over: ["time [s]", "time of measurement [s]"],
        x: points.iter().map(|point| point.time_s).collect(),
        panels: vec![Panel::new("standard errors from the end", 240, curves)],
        windows: Vec::new(),
    }
}

/// The condition of what parameters are computed from.
pub(super) fn condition(points: &[Convergence]) -> Chart {
    let curve = |name: &str, look, of: fn(&Convergence) -> f64| {
        // before anything is excited it is infinite
        ChartCurve::new(name, look, points.iter().map(of).collect())
    };
    let curves = vec![
        curve("as measured", Look::Residual, |point| point.condition),
        curve("columns scaled", Look::Measured, |point| point.scaled_condition),
    ];
    let panel = Panel { log: true, ..Panel::new("condition", 120, curves) };
    Chart {
        name: "Condition of the regressor".to_owned(),
        caption: String::new(),
        group: "convergence",
        over: ["time [s]", "time of measurement [s]"],
        x: points.iter().map(|point| point.time_s).collect(),
        panels: vec![panel],
        windows: Vec::new(),
    }
}
