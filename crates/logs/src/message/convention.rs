//! What the project calls the fields of messages that it knows.

use crate::source::Known;

/// A kind of message without `msg`: `sensor_msgs/JointState`.
pub(crate) fn short_kind(kind: &str) -> String {
    kind.replace("/msg/", "/")
}

/// Topics of a run that `simulate` writes: motors before springs, contacts, links.
pub(crate) const MOTORS: &str = "/motor_states";
pub(crate) const CONTACTS: &str = "/contacts/";
pub(crate) const LINKS: &str = "/wrenches/";

/// What the project calls a field of a message of this kind.
pub(super) fn known(kind: &str, topic: &str, path: &str, joint: Option<&str>) -> Option<Known> {
    let name = |prefix: &str| joint.map(|joint| format!("{prefix}_{joint}"));
    let sure = |name: Option<String>| name.map(|name| Known { name, rank: 0 });
    // what the controller says of joints counts where nobody else says it, and its old names where
    // it has no new ones
    let spare = |name: Option<String>, rank| name.map(|name| Known { name, rank });
    match (short_kind(kind).as_str(), path) {
        ("sensor_msgs/JointState", path) if topic == MOTORS => match path {
            "position" => sure(name("motor")),
            "effort" => sure(name("tau_cmd")),
            _ => None,
        },
        ("sensor_msgs/JointState", "position") => sure(name("q")),
        ("sensor_msgs/JointState", "velocity") => sure(name("qd")),
        ("sensor_msgs/JointState", "effort") => sure(name("tau")),
        ("control_msgs/JointTrajectoryControllerState", path) => match path {
            "reference/positions" => sure(name("ref")),
            "desired/positions" => spare(name("ref"), 1),
            "output/effort" => sure(name("tau_cmd")),
            "feedback/positions" => spare(name("q"), 1),
            "feedback/velocities" => spare(name("qd"), 1),
            "feedback/accelerations" => spare(name("qdd"), 1),
            "feedback/effort" => spare(name("tau"), 1),
            "actual/positions" => spare(name("q"), 2),
            "actual/velocities" => spare(name("qd"), 2),
            "actual/accelerations" => spare(name("qdd"), 2),
            "actual/effort" => spare(name("tau"), 2),
            _ => None,
        },
        ("geometry_msgs/WrenchStamped", path) => sure(wrench(topic, path)),
        _ => None,
    }
}

/// The component of a force or moment on a contact or a link.
fn wrench(topic: &str, path: &str) -> Option<String> {
    let (what, axis) = path.strip_prefix("wrench/")?.split_once('/')?;
    if let Some(contact) = topic.strip_prefix(CONTACTS) {
        return (what == "force").then(|| format!("f_{contact}_{axis}"));
    }
    let link = topic.strip_prefix(LINKS)?;
    let letter = if what == "force" { 'f' } else { 'm' };
    Some(format!("w_{link}_{letter}{axis}"))
}
