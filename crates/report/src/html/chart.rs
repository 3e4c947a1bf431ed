//! Curves that a reader looks into: panels below each other over one axis.

use super::data::{embedded, times, values};
use super::units::with_units;
use denavit_numerics::{envelope, extremes};
use serde::{Serialize, Serializer};

/// Spans of a long log: a picture is about as many pixels wide.
const SPANS: usize = 600;

/// Curves over one quantity. Charts of one group are zoomed together.
#[derive(Clone, Debug, Default)]
pub struct Chart {
    /// What it shows, above it.
    pub name: String,
    /// What is to be known of it, below it.
    pub caption: String,
    /// What it is zoomed together with.
    pub group: &'static str,
    /// What curves are over, and with its unit.
    pub over: [&'static str; 2],
    /// Its values, in order.
    pub x: Vec<f64>,
    /// What stands above each other.
    pub panels: Vec<Panel>,
    /// Parts of the axis that stand out.
    pub windows: Vec<[f64; 2]>,
}

/// Curves with one scale.
#[derive(Clone, Debug, Serialize)]
pub struct Panel {
    /// The scale, with its unit.
    pub label: String,
    /// Its height \[px\].
    pub height: u32,
    /// Whether the scale is logarithmic.
    pub log: bool,
    /// Its curves.
    pub curves: Vec<ChartCurve>,
}

/// A curve of a chart.
#[derive(Clone, Debug, Serialize)]
pub struct ChartCurve {
    /// What it is.
    pub name: String,
    /// How it looks.
    pub look: Look,
    /// A value for each of the chart's.
    #[serde(rename = "y", serialize_with = "values")]
    pub values: Vec<f64>,
    /// What it is between, where it goes up and down faster than is seen.
    #[serde(skip_serializing_if = "Option::is_none")]
    band: Option<Band>,
}

/// The least and the greatest values of a curve, one for each of its own.
#[derive(Clone, Debug, Serialize)]
struct Band {
    #[serde(serialize_with = "values")]
    low: Vec<f64>,
    #[serde(serialize_with = "values")]
    high: Vec<f64>,
}

impl Band {
    /// Of a curve that chatters.
    fn of(curve: &ChartCurve) -> Option<Self> {
        let is_line = !matches!(curve.look, Look::Points | Look::Law);
        let spans = is_line.then(|| envelope(&curve.values, SPANS)).flatten()?;
        let column = |end: usize| {
            let ends = spans.iter().flat_map(|span| span.rows.clone().map(|_| span.ends[end]));
            ends.collect::<Vec<f64>>()
        };
        Some(Self { low: column(0), high: column(1) })
    }
}

/// How a curve looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Look {
    /// What was measured.
    Measured,
    /// What a model says of it.
    Computed,
    /// What the model said before.
    Before,
    /// The difference.
    Residual,
    /// Points that were measured.
    Points,
    /// Points of a law.
    Law,
    /// One of many: by its place.
    Palette,
    /// One of many more.
    Faint,
}

fn as_times<S: Serializer>(list: &&[f64], serializer: S) -> Result<S::Ok, S::Error> {
    times(list, serializer)
}

/// What the script gets.
#[derive(Serialize)]
struct Data<'a> {
    group: &'a str,
    x_name: &'a str,
    x_label: &'a str,
    #[serde(serialize_with = "as_times")]
    x: &'a [f64],
    panels: &'a [Panel],
    windows: &'a [[f64; 2]],
}

impl ChartCurve {
    /// A curve.
    pub fn new(name: impl Into<String>, look: Look, values: Vec<f64>) -> Self {
        Self { name: name.into(), look, values, band: None }
    }
}

impl Panel {
    /// A panel of this height \[px\].
    pub fn new(label: impl Into<String>, height: u32, curves: Vec<ChartCurve>) -> Self {
        Self { label: with_units(&label.into()), height, log: false, curves }
    }
}

impl Chart {
    /// The chart with the rows that stand out, where it has more than can be seen; says so.
    #[must_use]
    pub fn thinned(mut self) -> Self {
        for curve in self.panels.iter_mut().flat_map(|panel| &mut panel.curves) {
            curve.band = Band::of(curve);
        }
        let mut curves = self.panels.iter().flat_map(|panel| &panel.curves);
        if curves.any(|curve| curve.band.is_some()) {
            self.caption = format!("{} {BAND_NOTE}", self.caption).trim().to_owned();
        }
        let all = self.x.len();
        let kept = {
            let curves: Vec<&Vec<f64>> =
                self.panels.iter().flat_map(|panel| &panel.curves).map(|one| &one.values).collect();
            extremes(all, curves.len(), SPANS, |curve, row| curves[curve][row])
        };
        if kept.len() == all {
            return self;
        }
        let pick = |list: &[f64]| kept.iter().map(|&row| list[row]).collect::<Vec<f64>>();
        self.x = pick(&self.x);
        for curve in self.panels.iter_mut().flat_map(|panel| &mut panel.curves) {
            curve.values = pick(&curve.values);
            if let Some(band) = &mut curve.band {
                (band.low, band.high) = (pick(&band.low), pick(&band.high));
            }
        }
        let note = thinned_note(kept.len(), all);
        self.caption = format!("{} {note}", self.caption).trim().to_owned();
        self
    }

    /// What it shows, for whom the picture does not: the range of each curve.
    fn told(&self) -> String {
        let range = |curve: &ChartCurve| {
            let known = curve.values.iter().copied().filter(|value| value.is_finite());
            let low = known.clone().fold(f64::INFINITY, f64::min);
            let high = known.fold(f64::NEG_INFINITY, f64::max);
            (low <= high).then(|| {
                let [low, high] = [low, high].map(crate::short);
                format!("{} from {low} to {high}", curve.name)
            })
        };
        let curves = self.panels.iter().flat_map(|panel| &panel.curves);
        let ranges: Vec<String> = curves.take(12).filter_map(range).collect();
        format!("{}, over {}: {}", self.name, self.over[1], ranges.join("; "))
    }
}

/// What is said of curves that are bands.
const BAND_NOTE: &str = "A curve that goes up and down faster than is seen is a band between its \
                         least and its greatest values.";

/// What is said of rows that are not drawn.
fn thinned_note(kept: usize, all: usize) -> String {
    format!(
        "{kept} of {all} samples are drawn: of each span of time the first, the last, the least \
         and the greatest."
    )
}

/// What the frame of a page asks for.
#[derive(Serialize)]
struct Shown<'a> {
    name: &'a str,
    caption: &'a str,
    told: String,
    data: String,
}

impl Serialize for Chart {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let data = Data {
            group: self.group,
            x_name: self.over[0],
            x_label: &with_units(self.over[1]),
            x: &self.x,
            panels: &self.panels,
            windows: &self.windows,
        };
        let data = embedded(&data);
        let (name, caption) = (&self.name, &self.caption);
        Shown { name, caption, told: self.told(), data }.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_chatters_is_a_band_and_what_does_not_is_a_line() {
        let x: Vec<f64> = (0..4000).map(|row| 1e-3 * f64::from(row)).collect();
        let slow: Vec<f64> = x.iter().map(|t| t.sin()).collect();
        let fast = |(row, value): (usize, &f64)| value + if row % 2 == 0 { 0.3 } else { -0.3 };
        let fast: Vec<f64> = slow.iter().enumerate().map(fast).collect();
        let curves = vec![
            ChartCurve::new("slow", Look::Measured, slow),
            ChartCurve::new("fast", Look::Computed, fast),
        ];
        let panels = vec![Panel::new("torque [N m]", 100, curves)];
        let chart = Chart { over: ["time [s]"; 2], x, panels, ..Chart::default() }.thinned();
        assert!(chart.caption.contains("between its least and its greatest values"));
        let [slow, fast] = &chart.panels[0].curves[..] else { panic!("two curves") };
        assert!(slow.band.is_none());
        let band = fast.band.as_ref().expect("a band");
        assert_eq!(band.low.len(), chart.x.len());
        for ((value, low), high) in fast.values.iter().zip(&band.low).zip(&band.high) {
            assert!((low..=high).contains(&value) && high - low >= 0.6);
        }
    }
}
