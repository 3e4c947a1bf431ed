//! The robot as JSON.

use super::text::{kind_name, row_entries, term_names, total_mass};
use crate::Values;
use denavit_codegen::expr::ExprId;
use denavit_codegen::model::{Base, Contact, Convention, FallBody, Link, Robot, Side};
use serde_json::{Value, json};

/// A robot. Values are numbers; a value that the file does not give is null.
pub(super) fn robot(robot: &Robot, values: &mut Values) -> Value {
    let links: Vec<Value> =
        robot.links.values().map(|link| self::link(robot, values, link)).collect();
    let contacts: Vec<Value> =
        robot.contacts.values().map(|contact| point(robot, values, contact)).collect();
    let must_not_touch: Vec<Value> = robot
        .bodies_that_must_not_touch
        .iter()
        .map(|body| fall_body(robot, values, body))
        .collect();
    json!({
        "model": robot.name,
        "hash": format!("{:016x}", robot.hash),
        "description": robot.description,
        "source": robot.source,
        "assumptions": robot.assumptions,
        "convention": match robot.convention {
            Convention::Standard => "standard",
            Convention::Modified => "modified",
        },
        "base": match robot.base {
            Base::Fixed => "fixed",
            Base::Floating => "floating",
            Base::PlanarFloating => "planar_floating",
        },
        "gravity": robot.gravity.map(|component| values.number(component)),
        "terms": term_names(robot.terms),
        "degrees_of_freedom": robot.degrees_of_freedom(),
        "total_mass": total_mass(robot, values),
        "parameters": robot.parameters.len(),
        "links": links,
        "contacts": contacts,
        "bodies_that_must_not_touch": must_not_touch,
        "faults": [],
    })
}

fn link(robot: &Robot, values: &mut Values, link: &Link) -> Value {
    let [a, alpha, d, theta] = row_entries(values, &link.joint);
    let mut number = |expr: ExprId| values.number(expr);
    let mut range = |ends: Option<[ExprId; 2]>| ends.map(|ends| ends.map(&mut number));
    let limits = json!({
        "position": range(link.limits.position),
        "torque": range(link.limits.torque),
        "velocity": link.limits.velocity.map(&mut number),
        "acceleration": link.limits.acceleration.map(&mut number),
    });
    let body = link.body.as_ref().map(|body| {
        json!({
            "mass": number(body.mass),
            "com": body.com.map(&mut number),
            "inertia": body.inertia.map(&mut number),
        })
    });
    json!({
        "name": link.name,
        "parent": link.parent.map(|parent| &robot.links[parent].name),
        "joint": kind_name(link.joint.kind),
        "a": a, "alpha": alpha, "d": d, "theta": theta,
        "limits": limits,
        "body": body,
        "spring": link.joint.spring.map(|spring| json!({
            "stiffness": values.number(spring.stiffness),
            "angle": values.number(spring.angle),
        })),
        "damping": link.joint.damping.map(|damping| values.number(damping)),
        "drive": drive(values, link),
    })
}

fn drive(values: &mut Values, link: &Link) -> Value {
    let Some(drive) = &link.drive else { return Value::Null };
    let mut number = |expr: ExprId| values.number(expr);
    json!({
        "gear_ratio": drive.gear_ratio.map(&mut number),
        "rotor_inertia": drive.rotor_inertia.map(&mut number),
        "viscous": drive.viscous.map(&mut number),
        "coulomb": drive.coulomb.map(&mut number),
        "offset": drive.offset.map(&mut number),
        "series_elastic": drive.series_elastic.map(|elastic| json!({
            "stiffness": number(elastic.stiffness),
            "motor_radius": number(elastic.motor_radius),
            "load_radius": number(elastic.load_radius),
        })),
        "return_spring": drive.return_spring.map(|spring| json!({
            "stiffness": number(spring.stiffness),
            "angle": number(spring.angle),
            "side": match spring.side { Side::Above => "above", Side::Below => "below" },
        })),
    })
}

fn fall_body(robot: &Robot, values: &mut Values, body: &FallBody) -> Value {
    let (name, link) = (&body.name, &robot.links[body.link].name);
    let ends: Vec<_> =
        body.ends.iter().map(|end| end.map(|component| values.number(component))).collect();
    match ends.as_slice() {
        [from, to] => {
            let radius_m = values.number(body.radius);
            json!({"name": name, "link": link, "from": from, "to": to, "radius_m": radius_m})
        }
        places => json!({"name": name, "link": link, "position": places.first()}),
    }
}

fn point(robot: &Robot, values: &mut Values, point: &Contact) -> Value {
    json!({
        "name": point.name,
        "link": robot.links[point.link].name,
        "position": point.position.map(|component| values.number(component)),
    })
}
