//! Balance along a run or a log, as text, JSON and a picture.

use super::balance_log::turning_bodies;
use crate::run::{BalanceCurve, BalancePicture};
use crate::{Align, Table, percent};
use denavit_numerics::least_and_most;
use denavit_walk::balance::{Course, Criterion, Instant, Margins};
use denavit_workflow::Judged;
use serde_json::{Map, Value, json as value};
use std::fmt::{self, Write};

/// What balance is judged by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BalanceCriterion {
    /// The zero moment point, exact and of the cart-table model.
    Zmp,
    /// The foot rotation indicator.
    Fri,
    /// The capture point.
    Capture,
    /// Angular momentum about the centre of mass.
    Momentum,
}

fn criteria(what: BalanceCriterion) -> &'static [(&'static str, Criterion)] {
    match what {
        BalanceCriterion::Zmp => {
            &[("exact", Criterion::ZeroMoment), ("cart_table", Criterion::CartTable)]
        }
        BalanceCriterion::Fri => &[("fri", Criterion::FootRotation)],
        BalanceCriterion::Capture => &[("capture", Criterion::Capture)],
        BalanceCriterion::Momentum => &[],
    }
}

/// A point with the edges of the support polygon over time.
pub fn balance_picture(what: BalanceCriterion, judged: &Judged) -> String {
    let (course, colours) = (&judged.course, ["#1f6fb4", "#d9822b"]);
    let times: Vec<f64> = course.instants.iter().map(|instant| instant.t_s).collect();
    let along = |criterion: Criterion| -> Vec<f64> {
        let ground = judged.model.ground;
        let x = |i: &Instant| criterion.point(i).map_or(f64::NAN, |p| ground.along(&p)[0]);
        course.instants.iter().map(x).collect()
    };
    let mut curves: Vec<BalanceCurve> = Vec::new();
    for ((name, criterion), colour) in criteria(what).iter().zip(colours) {
        curves.push(BalanceCurve { name, colour, values: along(*criterion) });
    }
    if what == BalanceCriterion::Momentum {
        let values = course.instants.iter().map(|i| i.angular_momentum[1]).collect();
        curves.push(BalanceCurve { name: "angular momentum", colour: colours[0], values });
    }
    let range = |end: usize| -> Vec<f64> {
        course.instants.iter().map(|i| i.support.range().map_or(f64::NAN, |r| r[end])).collect()
    };
    let band = (what != BalanceCriterion::Momentum).then(|| [range(0), range(1)]);
    let subtitle = format!("{}, over one {}", judged.model.name, course.over.word());
    let (title, unit) = match what {
        BalanceCriterion::Zmp => ("zero moment point", "forward [m]"),
        BalanceCriterion::Fri => ("foot rotation indicator", "forward [m]"),
        BalanceCriterion::Capture => ("capture point", "forward [m]"),
        BalanceCriterion::Momentum => ("centroidal angular momentum, forward", "[kg m\u{b2}/s]"),
    };
    let title = format!("{}: {title}", judged.name.replace('_', " "));
    let (times, curves) = (&times[..], &curves[..]);
    BalancePicture { title: &title, subtitle: &subtitle, unit, times, curves, band }.draw()
}

fn margins_json(margins: Option<Margins>) -> Value {
    margins.map_or(Value::Null, |margins| {
        value!({
            "margin_min_m": margins.least_m,
            "margin_min_at_s": margins.at_s,
            "margin_max_m": margins.largest_m,
            "outside_share": margins.outside,
        })
    })
}

/// Balance along a course as JSON.
pub fn balance_json(what: BalanceCriterion, judged: &Judged) -> Value {
    let course = &judged.course;
    let shares = course.shares();
    let mut answer = Map::new();
    let mut set = |key: &str, entry: Value| answer.insert(key.to_owned(), entry);
    set("of", value!(judged.name));
    set("model", value!(judged.model.name));
    set("over", value!(course.over.word()));
    set("scheme", value!(course.scheme));
    set("period_s", value!(course.period_s));
    set("duration_s", value!(course.duration_s()));
    for (name, criterion) in criteria(what) {
        set(name, margins_json(course.margins(*criterion)));
    }
    match what {
        BalanceCriterion::Zmp => {
            set("force_vs_momentum_max_m", value!(course.forces_against_momentum_m()));
        }
        BalanceCriterion::Fri => {
            set("still_foot_apart_max_m", value!(course.still_foot_apart_m()));
        }
        BalanceCriterion::Momentum => {
            for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
                let [low, high] = range(course, |instant| instant.angular_momentum[axis]);
                set(&format!("angular_momentum_{name}"), value!([low, high]));
            }
            let mut bodies = Map::new();
            for body in turning_bodies(judged) {
                let by_axis = [0, 1, 2].map(|a| range(course, |i| i.body_momenta[body][a]));
                bodies.insert(judged.model.joints[body].name.clone(), value!(by_axis));
            }
            set("angular_momentum_of_bodies", Value::Object(bodies));
        }
        BalanceCriterion::Capture => {}
    }
    set(
        "shares",
        value!({
            "flat": shares.flat,
            "toe": shares.toe,
            "double": shares.double,
            "flight": shares.flight,
            "one_point": shares.one_point,
        }),
    );
    if let Some(run) = &course.run {
        set("stop", value!(run.stop.word()));
    }
    Value::Object(answer)
}

fn range(course: &Course, value: impl Fn(&Instant) -> f64) -> [f64; 2] {
    least_and_most(course.instants.iter().map(value))
}

/// The least and the largest angular momentum about each axis, of the robot and of its bodies.
fn momentum_table(judged: &Judged) -> Table {
    let course = &judged.course;
    let axes: &[(&str, usize)] = match judged.model.planar {
        true => &[("about y, to the left", 1)],
        false => &[("about x, forward", 0), ("about y, to the left", 1), ("about z, up", 2)],
    };
    let mut columns = vec![("angular momentum [kg m^2/s]", Align::Left)];
    columns.extend(axes.iter().map(|(name, _)| (*name, Align::Right)));
    let mut table = Table::new(&columns);
    let mut push = |name: &str, of: &dyn Fn(&Instant, usize) -> f64| {
        let ranges = axes.iter().map(|(_, axis)| {
            let [low, high] = range(course, |instant| of(instant, *axis));
            format!("{low:.4} to {high:.4}")
        });
        table.push([name.to_owned()].into_iter().chain(ranges).collect());
    };
    push("robot, about its centre of mass", &|instant, axis| instant.angular_momentum[axis]);
    for body in turning_bodies(judged) {
        push(&judged.model.joints[body].name, &|instant, axis| instant.body_momenta[body][axis]);
    }
    table
}

/// Each point of a criterion with its margins, as cells of a table.
pub(super) fn margin_cells(what: BalanceCriterion, course: &Course) -> Vec<Vec<String>> {
    let cells = |(name, criterion): &(&str, Criterion)| {
        let found = course.margins(*criterion)?;
        Some(vec![
            name.replace('_', "-"),
            // what rounds to zero has no sign
            format!("{:.2}", (1e5 * found.least_m).round() / 1e2 + 0.0),
            format!("{:.4}", found.at_s),
            format!("{:.2}", 1e3 * found.largest_m),
            percent(found.outside),
        ])
    };
    criteria(what).iter().filter_map(cells).collect()
}

/// The same as text.
pub fn balance_text(what: BalanceCriterion, judged: &Judged) -> String {
    let mut out = String::new();
    write(&mut out, what, judged).expect("text has room");
    out
}

fn write(out: &mut String, what: BalanceCriterion, judged: &Judged) -> fmt::Result {
    let course = &judged.course;
    let shares = course.shares();
    let over = course.over.word();
    let scheme = match course.scheme.as_deref() {
        Some("event") => ", from event to event",
        Some("time_stepping") => ", by time stepping",
        _ => "",
    };
    writeln!(out, "{}: over one {over} of {:.4} s{scheme}", judged.name, course.duration_s())?;
    judged.notes.iter().try_for_each(|note| writeln!(out, "{note}"))?;
    writeln!(out)?;
    let rows = margin_cells(what, course);
    if course.instants.is_empty() {
        writeln!(out, "no instant has forces\n")?;
    } else if what == BalanceCriterion::Momentum {
        writeln!(out, "{}", momentum_table(judged))?;
    } else if rows.is_empty() {
        let why = match what {
            BalanceCriterion::Fri => {
                "no foot ever stands alone, or something pushes whenever one does"
            }
            _ => "nothing ever stands on the ground",
        };
        writeln!(out, "{why}\n")?;
    } else {
        let columns = [
            ("point", Align::Left),
            ("least margin [mm]", Align::Right),
            ("at [s]", Align::Right),
            ("largest [mm]", Align::Right),
            ("outside", Align::Right),
        ];
        let mut table = Table::new(&columns);
        rows.into_iter().for_each(|cells| table.push(cells));
        writeln!(out, "{table}")?;
    }
    if what == BalanceCriterion::Zmp {
        let apart = course.forces_against_momentum_m();
        writeln!(out, "from forces and from momentum: apart by {apart:.1e} m at most")?;
    }
    if let (BalanceCriterion::Fri, Some(apart)) = (what, course.still_foot_apart_m()) {
        writeln!(out, "apart from the zero moment point by {apart:.1e} m while the foot is still")?;
    }
    writeln!(
        out,
        "one foot flat {}, on an edge {}, two feet {}, flight {}; one point alone {}",
        percent(shares.flat),
        percent(shares.toe),
        percent(shares.double),
        percent(shares.flight),
        percent(shares.one_point)
    )?;
    if let Some(run) = course.run.as_ref().filter(|run| run.stop.word() != "end") {
        writeln!(out, "the run {} at {:.4} s", run.stop, run.end.t_s)?;
    }
    Ok(())
}
