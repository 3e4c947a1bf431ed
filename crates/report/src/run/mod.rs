//! The picture of a run: stick figures (thesis figure 2.5), joints against their references with
//! the torque that drives them (figures 3.4, 3.6), and contact forces.

mod axes;
mod balance;
mod beside;
mod compared;
mod curves;
mod excitation;
mod figures;
mod gait;
mod replay;
mod torques;

pub(crate) use balance::{BalanceCurve, BalancePicture};
pub(crate) use beside::beside_parts;
pub(crate) use compared::diagnosis_picture;
pub(crate) use curves::run_charts;
pub(crate) use gait::{GaitCurve, GaitPicture};
pub use replay::ShownWithRun;
pub(crate) use replay::replay;
pub use torques::{TorquePicture, motion_picture, torque_picture};

pub use excitation::{ExcitationPicture, excitation_picture};

use super::svg::Svg;
use axes::{Axes, Scale, TICK};
use denavit_plants::{Plant, PlantModel};
use denavit_simulate::Log;
use figures::{Strip, feet};

/// What a picture of a run is about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RunPicture<'a> {
    /// First line.
    pub(crate) title: &'a str,
    /// Second line, smaller.
    pub(crate) subtitle: &'a str,
    /// The run.
    pub(crate) log: &'a Log,
    /// The part of it that is shown, all of it if none \[s\].
    pub(crate) window_s: Option<[f64; 2]>,
}

const WIDTH: f64 = 1000.0;
const SIDE: f64 = 24.0;
/// Room at the left of a diagram for its scale.
const SCALE: f64 = 62.0;
const STRIP: f64 = 250.0;
/// Heights of the diagrams: of positions, of torques, of forces.
const POSITION: f64 = 104.0;
const TORQUE: f64 = 62.0;
const FORCE: f64 = 150.0;
/// What is between two diagrams: the lowest mark of one and the highest of the next fit there.
const APART: f64 = 20.0;
const MOST_JOINTS: usize = 6;

const BLUE: &str = "stroke=\"#1f5fd0\" stroke-width=\"1.6\"";
const WANTED: &str = "stroke=\"#d9730d\" stroke-width=\"1.6\" stroke-dasharray=\"5 4\"";
const GREY: &str = "stroke=\"#5a6472\" stroke-width=\"1.1\"";
/// Those of curves on pages: told apart with any colour blindness.
const COLOURS: [&str; 6] = ["#1f5fd0", "#b8860b", "#7a0f2e", "#ff5663", "#9f81af", "#2e1a6b"];
const HEADING: &str = "font-size=\"13\" font-weight=\"bold\" fill=\"#222\"";

/// SVG of a run of this plant. The same run gives the same bytes.
pub(crate) fn run_picture(plant: &mut dyn Plant, picture: &RunPicture<'_>) -> String {
    let log = Windowed::new(picture);
    let model = plant.model().clone();
    let joints = shown_joints(&model, &log, MOST_JOINTS);
    let forces = force_curves(&model, &log);
    let rows = joints.len().div_ceil(2);
    let block = 30.0 + POSITION + APART + TORQUE + 30.0;
    let top = 74.0 + STRIP + 22.0;
    let below = if forces.is_empty() { 0.0 } else { FORCE + 62.0 };
    let height = top + rows as f64 * block + below + 18.0;
    let mut svg = Svg::new([WIDTH, height], picture.title);
    svg.label(
        [SIDE, 34.0],
        "start",
        "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"",
        picture.title,
    );
    svg.label([SIDE, 55.0], "start", "font-size=\"13\" fill=\"#555\"", picture.subtitle);
    let positions = log.positions(&model);
    let width = WIDTH - 2.0 * SIDE;
    Strip::new(plant, &positions, [width, STRIP]).draw(&mut svg, [SIDE, 74.0], [width, STRIP]);
    for (index, joint) in joints.iter().enumerate() {
        let column = (index % 2) as f64;
        let half = 0.5 * width;
        let left = SIDE + column * half + SCALE;
        let corner = [left, top + (index / 2) as f64 * block];
        joint_diagrams(&mut svg, &log, joint, corner, half - SCALE - 10.0);
    }
    if !forces.is_empty() {
        let corner = [SIDE + SCALE, top + rows as f64 * block];
        force_diagram(&mut svg, &log, &forces, corner, width - SCALE - 10.0);
    }
    svg.finish()
}

/// Height of the picture of one figure.
const FIGURE: f64 = 640.0;

/// SVG of a robot at the row of a log that is nearest to a time. The same run gives the same bytes.
pub(crate) fn figure_at(plant: &mut dyn Plant, log: &Log, title: &str, t_s: f64) -> String {
    let times = log.column("t").unwrap_or_default();
    let apart = |time: &&f64| (*time - t_s).abs();
    let nearest = times.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
    let window_s = nearest.map(|time| [*time; 2]);
    let title = &nearest.map_or_else(String::new, |time| format!("{title} at {time:.3} s"));
    let picture = RunPicture { title, subtitle: "", log, window_s };
    let rows = Windowed::new(&picture).positions(&plant.model().clone());
    let mut svg = Svg::new([WIDTH, FIGURE + 90.0], title);
    let style = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
    svg.label([SIDE, 34.0], "start", style, title);
    let size = [WIDTH - 2.0 * SIDE, FIGURE];
    Strip::new(plant, &rows, size).draw(&mut svg, [SIDE, 60.0], size);
    svg.finish()
}

/// The part of a log that is shown, by columns.
struct Windowed<'a> {
    log: &'a Log,
    times: Vec<f64>,
    rows: std::ops::Range<usize>,
}

impl<'a> Windowed<'a> {
    fn new(picture: &RunPicture<'a>) -> Self {
        let log = picture.log;
        let all = log.column("t").unwrap_or_default();
        let inside = |time: &f64| {
            picture.window_s.is_none_or(|[from, to]| (from - 1e-9..=to + 1e-9).contains(time))
        };
        let start = all.iter().position(inside).unwrap_or(0);
        let end = all.iter().rposition(inside).map_or(0, |last| last + 1);
        let rows = start..end.max(start);
        Self { log, times: all[rows.clone()].to_vec(), rows }
    }

    fn column(&self, name: &str) -> Option<Vec<f64>> {
        Some(self.log.column(name)?[self.rows.clone()].to_vec())
    }

    fn positions(&self, model: &PlantModel) -> Vec<(f64, Vec<f64>)> {
        let columns: Vec<Vec<f64>> = model
            .joints
            .iter()
            .filter_map(|joint| self.column(&format!("q_{}", joint.name)))
            .collect();
        let row = |index: usize| columns.iter().map(|column| column[index]).collect();
        let times = self.times.iter().enumerate();
        match columns.len() == model.joints.len() {
            true => times.map(|(index, time)| (*time, row(index))).collect(),
            false => Vec::new(),
        }
    }

    fn time_scale(&self, marks: f64) -> Scale {
        match (self.times.first(), self.times.last()) {
            (Some(first), Some(last)) if last > first => Scale::exactly(*first, *last, marks),
            _ => Scale::exactly(0.0, 1.0, marks),
        }
    }
}

/// A joint with its curves.
struct JointCurves {
    name: String,
    slides: bool,
    position: Vec<f64>,
    reference: Option<Vec<f64>>,
    /// Torque of the drive, if there is any.
    torque: Option<Vec<f64>>,
}

/// The joints that follow something and move most; without any, those that move.
fn shown_joints(model: &PlantModel, log: &Windowed<'_>, most: usize) -> Vec<JointCurves> {
    let curves = |joint: &denavit_plants::JointModel| {
        let column = |prefix: &str| log.column(&format!("{prefix}_{}", joint.name));
        let torque = column("tau_cmd").or_else(|| column("tau"));
        Some(JointCurves {
            name: joint.name.clone(),
            slides: joint.slides,
            position: column("q")?,
            reference: column("ref"),
            torque: torque.filter(|t| t.iter().any(|torque| *torque != 0.0)),
        })
    };
    let all: Vec<JointCurves> = model.joints.iter().filter_map(curves).collect();
    let is_driven = all.iter().any(|joint| joint.reference.is_some());
    let range = |joint: &JointCurves| {
        let values = joint.position.iter().filter(|value| value.is_finite());
        let high = values.clone().copied().fold(f64::NEG_INFINITY, f64::max);
        high - values.copied().fold(f64::INFINITY, f64::min)
    };
    let mut chosen: Vec<(usize, JointCurves)> = all
        .into_iter()
        .filter(|joint| if is_driven { joint.reference.is_some() } else { range(joint) > 1e-9 })
        .enumerate()
        .collect();
    chosen.sort_by(|(_, a), (_, b)| range(b).total_cmp(&range(a)));
    chosen.truncate(most);
    chosen.sort_by_key(|(index, _)| *index);
    chosen.into_iter().map(|(_, joint)| joint).collect()
}

fn joint_diagrams(
    svg: &mut Svg,
    log: &Windowed<'_>,
    joint: &JointCurves,
    corner: [f64; 2],
    width: f64,
) {
    let (name, times) = (joint.name.replace('_', " "), &log.times);
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, &name);
    let unit = if joint.slides { ["m", "N"] } else { ["rad", "N m"] };
    let both = joint.position.iter().chain(joint.reference.iter().flatten());
    let has_torque = joint.torque.is_some();
    let upper = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, if has_torque { POSITION } else { POSITION + APART + TORQUE }],
        x: log.time_scale(8.0),
        y: Scale::around(both.copied(), 4.0),
    };
    upper.draw(svg, !has_torque);
    upper.name_y(svg, unit[0]);
    upper.curve(svg, times, &joint.position, BLUE);
    if let Some(reference) = &joint.reference {
        upper.curve(svg, times, reference, WANTED);
    }
    let mut legend = vec![("position", BLUE)];
    legend.extend(joint.reference.as_ref().map(|_| ("reference", WANTED)));
    let mut bottom = upper.corner[1] + upper.size[1];
    if let Some(torque) = &joint.torque {
        let lower = Axes {
            corner: [corner[0], bottom + APART],
            size: [width, TORQUE],
            x: upper.x,
            y: Scale::around(torque.iter().copied().chain([0.0]), 3.0),
        };
        lower.draw(svg, true);
        lower.name_y(svg, unit[1]);
        lower.curve(svg, times, torque, GREY);
        let above = [corner[0] + width, lower.corner[1] - 2.0];
        draw_legend(svg, above, &[("torque of the motor", GREY)]);
        bottom = lower.corner[1] + TORQUE;
    }
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, bottom + 28.0], "end", TICK, "time [s]");
}

/// A legend that ends at a place.
fn draw_legend(svg: &mut Svg, [right, y]: [f64; 2], entries: &[(&str, &str)]) {
    let mut x = right;
    for (text, style) in entries.iter().rev() {
        x -= 6.3 * text.chars().count() as f64;
        svg.label([x, y], "start", TICK, text);
        svg.line(&[[x - 26.0, y - 4.0], [x - 5.0, y - 4.0]], style);
        x -= 40.0;
    }
}

/// Normal forces: of each link on the ground; of each contact, if there is one such link.
fn force_curves(model: &PlantModel, log: &Windowed<'_>) -> Vec<(String, Vec<f64>)> {
    let normal = |contact: &denavit_plants::PointModel| {
        let [x, y, z] =
            ["x", "y", "z"].map(|axis| log.column(&format!("f_{}_{axis}", contact.name)));
        let (x, y, z) = (x?, y?, z?);
        let [a, b, c] = model.ground.normal;
        Some((0..z.len()).map(|k| a * x[k] + b * y[k] + c * z[k]).collect::<Vec<f64>>())
    };
    let contacts = model.contacts.iter();
    let all: Option<Vec<(usize, String, Vec<f64>)>> = contacts
        .map(|contact| Some((contact.link, contact.name.clone(), normal(contact)?)))
        .collect();
    let all = all.unwrap_or_default();
    let feet = feet(model);
    if feet.len() < 2 {
        let few = all.into_iter().take(COLOURS.len());
        return few.map(|(_, name, force)| (name, force)).collect();
    }
    let sum = |foot: usize| {
        let mut sum = vec![0.0; log.times.len()];
        for (_, _, force) in all.iter().filter(|(link, ..)| *link == foot) {
            sum.iter_mut().zip(force).for_each(|(sum, force)| *sum += force);
        }
        (model.links[foot].clone(), sum)
    };
    feet.into_iter().take(COLOURS.len()).map(sum).collect()
}

fn force_diagram(
    svg: &mut Svg,
    log: &Windowed<'_>,
    forces: &[(String, Vec<f64>)],
    corner: [f64; 2],
    width: f64,
) {
    svg.label([corner[0], corner[1] + 14.0], "start", HEADING, "normal force of the ground");
    let all = forces.iter().flat_map(|(_, force)| force.iter().copied());
    let axes = Axes {
        corner: [corner[0], corner[1] + 24.0],
        size: [width, FORCE],
        x: log.time_scale(14.0),
        y: Scale::around(all.chain([0.0]), 4.0),
    };
    axes.draw(svg, true);
    axes.name_y(svg, "N");
    let styles: Vec<String> =
        COLOURS.iter().map(|colour| format!("stroke=\"{colour}\" stroke-width=\"1.5\"")).collect();
    let mut legend = Vec::new();
    let names: Vec<String> = forces.iter().map(|(name, _)| name.replace('_', " ")).collect();
    for ((_, force), (name, style)) in forces.iter().zip(names.iter().zip(&styles)) {
        axes.curve(svg, &log.times, force, style);
        legend.push((name.as_str(), style.as_str()));
    }
    draw_legend(svg, [corner[0] + width, corner[1] + 14.0], &legend);
    svg.label([corner[0] + width, axes.corner[1] + FORCE + 32.0], "end", TICK, "time [s]");
}
