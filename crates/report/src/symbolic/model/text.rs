//! The robot as tables.

use crate::{Align, Table, Values, paragraph, short};
use denavit_codegen::expr::ExprId;
use denavit_codegen::model::{
    About, Base, Convention, Joint, JointKind, Link, LinkId, Robot, Role, Side, Terms,
};
use std::fmt::{self, Write};

pub(super) fn write(out: &mut dyn Write, robot: &Robot, values: &mut Values) -> fmt::Result {
    head(out, robot, values)?;
    writeln!(out, "\n{}", link_table(robot, values))?;
    totals(out, robot, values)?;
    for (title, table) in tables(robot, values) {
        writeln!(out, "\n{title}")?;
        for line in table.to_string().lines() {
            writeln!(out, "  {line}")?;
        }
    }
    if !robot.assumptions.is_empty() {
        writeln!(out, "\nassumptions")?;
        for assumption in &robot.assumptions {
            writeln!(out, "{}", paragraph("  - ", "    ", assumption))?;
        }
    }
    Ok(())
}

/// The numbers of a model beside its rows, those that it has.
pub(super) fn tables(robot: &Robot, values: &mut Values) -> Vec<(&'static str, Table)> {
    let all = [
        ("constants", constant_table(robot, values)),
        ("moments of inertia [kg m^2]", inertia_table(robot, values)),
        ("standard deviations that the file states", deviation_table(robot, values)),
        ("limits", limit_table(robot, values)),
        (drive_title(robot), drive_table(robot, values)),
        ("contacts", contact_table(robot, values)),
        ("must not touch the ground", body_table(robot, values)),
    ];
    let full = all.into_iter().map(|(title, table)| (title, table.without_empty_columns()));
    // names alone say nothing
    full.filter(|(_, table)| !table.is_empty() && table.columns().len() > 1).collect()
}

fn head(out: &mut dyn Write, robot: &Robot, values: &mut Values) -> fmt::Result {
    writeln!(out, "{}, hash {:016x}", robot.name, robot.hash)?;
    for (label, text) in [("", &robot.description), ("source: ", &robot.source)] {
        if !text.is_empty() {
            writeln!(out, "{}", paragraph("  ", "  ", &format!("{label}{text}")))?;
        }
    }
    let base = match robot.base {
        Base::Fixed => "fixed base",
        Base::Floating => "floating base",
        Base::PlanarFloating => "planar floating base",
    };
    let convention = match robot.convention {
        Convention::Standard => "standard",
        Convention::Modified => "modified",
    };
    let gravity = robot.gravity.map(|component| values.show(component)).join(", ");
    writeln!(out, "  {base}, {convention} convention, free fall [{gravity}] m/s^2 in frame 0")?;
    if robot.terms != Terms::ALL {
        writeln!(out, "  terms: {}", term_names(robot.terms).join(", "))?;
    }
    Ok(())
}

/// The terms that a model has.
pub(super) fn term_names(terms: Terms) -> Vec<&'static str> {
    let Terms { inertia, coriolis, gravity, friction, rotor, spring } = terms;
    let all = [
        (inertia, "inertia"),
        (coriolis, "coriolis"),
        (gravity, "gravity"),
        (friction, "friction"),
        (rotor, "rotor"),
        (spring, "spring"),
    ];
    all.into_iter().filter(|(has, _)| *has).map(|(_, name)| name).collect()
}

fn totals(out: &mut dyn Write, robot: &Robot, values: &mut Values) -> fmt::Result {
    let joints: Vec<_> = robot.joints().map(|(link, _)| &robot.links[link]).collect();
    let of_base = match robot.base {
        Base::Fixed => 0,
        Base::Floating => 6,
        Base::PlanarFloating => 3,
    };
    let driven = joints.iter().filter(|link| link.drive.is_some()).count();
    write!(out, "degrees of freedom: {}", joints.len())?;
    match of_base {
        0 => writeln!(out, " ({driven} with a drive)")?,
        _ => writeln!(
            out,
            " ({of_base} of the base, {} joints, {driven} of them with a drive)",
            joints.len() - of_base
        )?,
    }
    match total_mass(robot, values) {
        Some(mass) => writeln!(out, "total mass: {} kg", short(mass))?,
        None => writeln!(out, "total mass: not known, some masses have no value")?,
    }
    let known = robot.parameters.values().filter(|parameter| parameter.known).count();
    let all = robot.parameters.len();
    writeln!(out, "parameters: {all} ({known} known, {} to identify)", all - known)?;
    Ok(())
}

/// The mass of all bodies \[kg\], if the file gives all of them.
pub(super) fn total_mass(robot: &Robot, values: &mut Values) -> Option<f64> {
    let masses: Vec<ExprId> =
        robot.links.values().filter_map(|link| Some(link.body.as_ref()?.mass)).collect();
    values.sum(&masses)
}

pub(super) fn link_table(robot: &Robot, values: &mut Values) -> Table {
    use Align::{Left, Right};
    let mut table = Table::new(&[
        ("link", Left),
        ("joint", Left),
        ("a [m]", Left),
        ("alpha [rad]", Left),
        ("d [m]", Left),
        ("theta [rad]", Left),
        ("mass [kg]", Right),
        ("com [m]", Left),
    ]);
    table.push(vec!["frame 0".to_owned()]);
    for (label, id) in tree(robot) {
        let link = &robot.links[id];
        let mut cells = vec![label, kind_name(link.joint.kind).to_owned()];
        cells.extend(row_entries(values, &link.joint).map(clip));
        if let Some(body) = &link.body {
            cells.push(values.show(body.mass));
            cells.push(clip(body.com.map(|c| values.show(c)).join(", ")));
        }
        table.push(cells);
    }
    table
}

/// The values of what the rows are written in.
fn constant_table(robot: &Robot, values: &mut Values) -> Table {
    use Align::{Left, Right};
    let columns = [("name", Left), ("value", Right), ("unit", Left), ("meaning", Left)];
    let mut table = Table::new(&columns);
    for one in robot.parameters.values().filter(|one| one.role == Role::Constant) {
        let value = one.default.map_or("not given".to_owned(), |value| values.show(value));
        let unit = one.unit.as_ref().map(ToString::to_string).filter(|unit| unit != "1");
        let unit = unit.unwrap_or_default();
        table.push(vec![one.name.clone(), value, unit, clip(one.doc.clone())]);
    }
    table
}

fn inertia_table(robot: &Robot, values: &mut Values) -> Table {
    let names = ["xx", "yy", "zz", "xy", "xz", "yz"];
    let mut columns = vec![("link", Align::Left), ("about", Align::Left)];
    columns.extend(names.map(|name| (name, Align::Right)));
    let mut table = Table::new(&columns);
    for link in robot.links.values() {
        let Some(body) = &link.body else { continue };
        let about = match body.about {
            About::Com => "centre of mass",
            About::Origin => "origin",
        };
        let mut cells = vec![link.name.clone(), about.to_owned()];
        cells.extend(body.inertia.map(|entry| clip(values.show(entry))));
        table.push(cells);
    }
    table
}

fn deviation_table(robot: &Robot, values: &mut Values) -> Table {
    let columns = [("parameter", Align::Left), ("value", Align::Right), ("std", Align::Right)];
    let mut table = Table::new(&columns);
    for parameter in robot.parameters.values() {
        let Some(std) = parameter.std else { continue };
        let value = parameter.default.map_or(String::new(), |value| values.show(value));
        table.push(vec![parameter.name.clone(), value, values.show(std)]);
    }
    table
}

/// What a joint is called in tables.
pub(super) fn kind_name(kind: JointKind) -> &'static str {
    match kind {
        JointKind::Revolute => "revolute",
        JointKind::Prismatic => "prismatic",
        JointKind::Fixed => "fixed",
    }
}

/// The entries a, alpha, d, theta of a row, with q in its place.
pub(super) fn row_entries(values: &Values, joint: &Joint) -> [String; 4] {
    let with_variable = |expr: ExprId, is_variable: bool| {
        let constant = values.formula(expr);
        match (is_variable, constant.as_str()) {
            (false, _) => constant,
            (true, "0") => "q".to_owned(),
            (true, text) if text.starts_with('-') => format!("q - {}", &text[1..]),
            (true, text) => format!("q + {text}"),
        }
    };
    [
        values.formula(joint.a),
        values.formula(joint.alpha),
        with_variable(joint.d, joint.kind == JointKind::Prismatic),
        with_variable(joint.theta, joint.kind == JointKind::Revolute),
    ]
}

/// The links, each after the one that carries it, with lines that show who carries whom. A chain
/// without branches stays in its column.
fn tree(robot: &Robot) -> Vec<(String, LinkId)> {
    let mut rows = Vec::with_capacity(robot.links.len());
    let mut pending: Vec<(LinkId, String, String)> = Vec::new();
    push_children(robot, None, "", &mut pending);
    while let Some((id, first, rest)) = pending.pop() {
        rows.push((format!("{first}{}", robot.links[id].name), id));
        push_children(robot, Some(id), &rest, &mut pending);
    }
    rows
}

fn push_children(
    robot: &Robot,
    parent: Option<LinkId>,
    indent: &str,
    pending: &mut Vec<(LinkId, String, String)>,
) {
    let children: Vec<LinkId> = robot.tree.children(parent).collect();
    if let [child] = children[..] {
        pending.push((child, indent.to_owned(), indent.to_owned()));
        return;
    }
    for (place, &child) in children.iter().enumerate().rev() {
        let is_last = place + 1 == children.len();
        let (branch, below) = if is_last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
        pending.push((child, format!("{indent}{branch}"), format!("{indent}{below}")));
    }
}

fn limit_table(robot: &Robot, values: &mut Values) -> Table {
    use Align::Left;
    let mut table = Table::new(&[
        ("link", Left),
        ("q [rad, m]", Left),
        ("|qd| [rad/s, m/s]", Left),
        ("|qdd| [rad/s^2, m/s^2]", Left),
        ("tau [N m, N]", Left),
    ]);
    for link in robot.links.values() {
        let limits = &link.limits;
        let is_limited = limits.position.is_some()
            || limits.velocity.is_some()
            || limits.acceleration.is_some()
            || limits.torque.is_some();
        if is_limited {
            let mut range = |ends: Option<[ExprId; 2]>| {
                ends.map_or("-".to_owned(), |ends| {
                    format!("{} .. {}", values.show(ends[0]), values.show(ends[1]))
                })
            };
            let (q, tau) = (range(limits.position), range(limits.torque));
            let qd = optional(values, limits.velocity);
            let qdd = optional(values, limits.acceleration);
            table.push(vec![link.name.clone(), q, qd, qdd, tau]);
        }
    }
    table
}

fn optional(values: &mut Values, expr: Option<ExprId>) -> String {
    expr.map_or("-".to_owned(), |expr| values.show(expr))
}

/// Whether what a drive has is that of a motor's shaft.
fn is_geared(link: &Link) -> bool {
    link.drive.is_some_and(|drive| drive.gear_ratio.is_some())
}

fn drive_title(robot: &Robot) -> &'static str {
    match robot.links.values().any(is_geared) {
        true => {
            "drives, springs, damping; behind a gear, inertia and friction are those of the \
             motor's shaft"
        }
        false => "drives, springs, damping",
    }
}

/// A heading with its units: of what turns, of what slides, or both.
fn with_unit(robot: &Robot, name: &str, units: [&str; 2], turns: fn(&Link) -> bool) -> String {
    let moving = || robot.links.values().filter(|link| link.joint.kind != JointKind::Fixed);
    let has = [moving().any(turns), moving().any(|link| !turns(link))];
    let own: Vec<&str> =
        units.into_iter().zip(has).filter(|(_, has)| *has).map(|(unit, _)| unit).collect();
    format!("{name} [{}]", own.join(", "))
}

fn drive_table(robot: &Robot, values: &mut Values) -> Table {
    use Align::Left;
    let joint_turns = |link: &Link| link.joint.kind == JointKind::Revolute;
    let motor_turns = |link: &Link| link.joint.kind == JointKind::Revolute || is_geared(link);
    let heads = [
        with_unit(robot, "rotor inertia", ["kg m^2", "kg"], motor_turns),
        with_unit(robot, "viscous", ["N m s/rad", "N s/m"], motor_turns),
        with_unit(robot, "coulomb", ["N m", "N"], motor_turns),
        with_unit(robot, "offset", ["N m", "N"], joint_turns),
        with_unit(robot, "springs", ["N m/rad", "N/m"], joint_turns),
    ];
    let gear = match robot.links.values().filter(|link| is_geared(link)).all(joint_turns) {
        true => "gear".to_owned(),
        false => "gear [1, rad/m]".to_owned(),
    };
    let columns: Vec<(&str, Align)> = ["link", &gear]
        .into_iter()
        .chain(heads.iter().map(String::as_str))
        .map(|text| (text, Left))
        .collect();
    let mut table = Table::new(&columns);
    for link in robot.links.values() {
        let springs = springs(values, link);
        let drive = link.drive.unwrap_or_default();
        let viscous = drive.viscous.or(link.joint.damping);
        if link.drive.is_none() && viscous.is_none() && springs.is_empty() {
            continue;
        }
        let gear = match link.drive {
            Some(_) => optional(values, drive.gear_ratio),
            None => "no drive".to_owned(),
        };
        table.push(vec![
            link.name.clone(),
            gear,
            optional(values, drive.rotor_inertia),
            optional(values, viscous),
            optional(values, drive.coulomb),
            optional(values, drive.offset),
            springs.join("; "),
        ]);
    }
    table
}

fn springs(values: &mut Values, link: &Link) -> Vec<String> {
    let mut springs = Vec::new();
    if let Some(spring) = &link.joint.spring {
        let (stiffness, angle) = (values.show(spring.stiffness), values.show(spring.angle));
        springs.push(format!("{stiffness} about q = {angle}"));
    }
    let drive = link.drive.unwrap_or_default();
    if let Some(elastic) = drive.series_elastic {
        let stiffness = values.show(elastic.stiffness);
        let radii = [elastic.motor_radius, elastic.load_radius].map(|r| values.show(r));
        springs.push(format!("series {stiffness} N/m on {} m, {} m", radii[0], radii[1]));
    }
    if let Some(spring) = drive.return_spring {
        let relation = match spring.side {
            Side::Above => '>',
            Side::Below => '<',
        };
        let (stiffness, angle) = (values.show(spring.stiffness), values.show(spring.angle));
        springs.push(format!("return {stiffness} where q {relation} {angle}"));
    }
    springs
}

fn contact_table(robot: &Robot, values: &mut Values) -> Table {
    let columns = [("point", Align::Left), ("link", Align::Left), ("position [m]", Align::Left)];
    let mut table = Table::new(&columns);
    for point in robot.contacts.values() {
        let position = clip(point.position.map(|c| values.show(c)).join(", "));
        table.push(vec![point.name.clone(), robot.links[point.link].name.clone(), position]);
    }
    table
}

/// Bodies that must not touch the ground: a point has one place, a capsule two.
fn body_table(robot: &Robot, values: &mut Values) -> Table {
    let columns = [
        ("body", Align::Left),
        ("link", Align::Left),
        ("position [m]", Align::Left),
        ("to [m]", Align::Left),
        ("radius [m]", Align::Right),
    ];
    let mut table = Table::new(&columns);
    for body in &robot.bodies_that_must_not_touch {
        let mut ends: Vec<String> =
            body.ends.iter().map(|end| clip(end.map(|c| values.show(c)).join(", "))).collect();
        let radius = if ends.len() > 1 { values.show(body.radius) } else { String::new() };
        ends.resize(2, String::new());
        let link = robot.links[body.link].name.clone();
        table.push([vec![body.name.clone(), link], ends, vec![radius]].concat());
    }
    table
}

/// A cell of bounded width: a formula may be long.
fn clip(text: String) -> String {
    const WIDEST: usize = 40;
    match text.char_indices().nth(WIDEST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
