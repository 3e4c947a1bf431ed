//! Runs as messages of ROS 2: what Foxglove, PlotJuggler and Rerun open.
//!
//! | columns | topic | messages |
//! |---|---|---|
//! | `q_`, `qd_`, `tau_` | `/joint_states` | `sensor_msgs/JointState` |
//! | `ref_`, `qdd_`, `tau_cmd_` | `/controller_state` | `JointTrajectoryControllerState` |
//! | `motor_`, `tau_cmd_` before springs | `/motor_states` | `sensor_msgs/JointState` |
//! | `f_CONTACT_x..z` | `/contacts/CONTACT` | `geometry_msgs/WrenchStamped` |
//! | `w_LINK_fx..mz` | `/wrenches/LINK` | `geometry_msgs/WrenchStamped` |
//! | others | `/run/COLUMN` | `std_msgs/Float64` |
//!
//! Times are whole nanoseconds. What the log says of itself is the record of metadata `denavit`.

use super::METADATA;
use crate::message::{
    CONTACTS, CONTROLLER_STATE, JOINT_STATE, LINKS, MOTORS, NUMBER, Usual, WRENCH,
};
use byteorder::LittleEndian;
use mcap::records::{MessageHeader, Metadata};
use mcap::{McapError, WriteOptions, Writer};
use serde::Serialize;
use std::collections::BTreeMap;
use std::io::Cursor;

/// The topic of joints, and of what their controller wants.
/// Bytes of messages in a chunk.
const CHUNK: u64 = 1 << 17;
const JOINTS: &str = "/joint_states";
const CONTROLLER: &str = "/controller_state";

/// Where columns go that are no signal of a joint, contact or link.
const OTHERS: &str = "/run/";

/// Forces are in the world's directions.
const WORLD: &str = "world";

/// A table to be written, row by row; the column `t` is the time \[s\].
#[derive(Clone, Copy, Debug)]
pub struct Rows<'a> {
    /// What it says of itself.
    pub header: &'a [(String, String)],
    /// The columns, with the project's names.
    pub columns: &'a [String],
    /// Row after row.
    pub values: &'a [f64],
}

/// The bytes before a message: CDR, the lowest byte first.
const HEAD: [u8; 4] = [0, 1, 0, 0];

#[derive(Serialize)]
struct Stamp {
    sec: i32,
    nanosec: u32,
}

#[derive(Serialize)]
struct Header<'a> {
    stamp: Stamp,
    frame_id: &'a str,
}

#[derive(Serialize)]
struct JointState<'a> {
    header: Header<'a>,
    name: &'a [String],
    position: Vec<f64>,
    velocity: Vec<f64>,
    effort: Vec<f64>,
}

#[derive(Default, Serialize)]
struct Point {
    positions: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    effort: Vec<f64>,
    time_from_start: (i32, u32),
}

/// A point of bodies that there are none of.
#[derive(Default, Serialize)]
struct NoBodies {
    transforms: Vec<f64>,
    velocities: Vec<f64>,
    accelerations: Vec<f64>,
    time_from_start: (i32, u32),
}

#[derive(Serialize)]
struct ControllerState<'a> {
    header: Header<'a>,
    joint_names: &'a [String],
    reference: Point,
    feedback: Point,
    error: Point,
    output: Point,
    multi_dof_joint_names: Vec<String>,
    multi_dof: [NoBodies; 4],
}

#[derive(Serialize)]
struct WrenchStamped<'a> {
    header: Header<'a>,
    wrench: [f64; 6],
}

/// Columns of joints: of each prefix the place of each joint's column.
struct Joints {
    names: Vec<String>,
    /// By prefix, then joint.
    columns: Vec<Vec<Option<usize>>>,
}

impl Joints {
    /// The joints that have a column with one of these prefixes, if it is meant.
    fn of(columns: &[String], prefixes: &[&str], is_meant: impl Fn(&str, &str) -> bool) -> Self {
        let mut names: Vec<String> = Vec::new();
        let mut found = Vec::new();
        for (place, column) in columns.iter().enumerate() {
            for (at, prefix) in prefixes.iter().enumerate() {
                let joint = column.strip_prefix(prefix).filter(|joint| is_meant(prefix, joint));
                let Some(joint) = joint else { continue };
                let known = names.iter().position(|name| name == joint).unwrap_or_else(|| {
                    names.push(joint.to_owned());
                    names.len() - 1
                });
                found.push((at, known, place));
            }
        }
        let mut columns = vec![vec![None; names.len()]; prefixes.len()];
        found.into_iter().for_each(|(at, joint, place)| columns[at][joint] = Some(place));
        Self { names, columns }
    }

    /// The numbers of a prefix in a row; none if no joint has one.
    fn values(&self, prefix: usize, row: &[f64]) -> Vec<f64> {
        let places = &self.columns[prefix];
        if places.iter().all(Option::is_none) {
            return Vec::new();
        }
        places.iter().map(|place| place.map_or(f64::NAN, |place| row[place])).collect()
    }

    fn places(&self) -> impl Iterator<Item = usize> + '_ {
        self.columns.iter().flatten().flatten().copied()
    }
}

/// Forces and moments of a contact or link: topic and the places of its columns.
struct Wrench {
    topic: String,
    places: [Option<usize>; 6],
}

/// The wrenches of columns `f_CONTACT_x` and `w_LINK_fx`.
fn wrenches(columns: &[String]) -> Vec<Wrench> {
    const FORCES: [&str; 6] = ["_x", "_y", "_z", "", "", ""];
    const PARTS: [&str; 6] = ["_fx", "_fy", "_fz", "_mx", "_my", "_mz"];
    let mut found: Vec<Wrench> = Vec::new();
    for (place, column) in columns.iter().enumerate() {
        let of = |prefix: &str, endings: [&str; 6], topic: &str| {
            let rest = column.strip_prefix(prefix)?;
            let ends = |ending: &&str| !ending.is_empty() && rest.ends_with(*ending);
            let part = endings.iter().position(ends)?;
            Some((format!("{topic}{}", rest.strip_suffix(endings[part])?), part))
        };
        let part = of("f_", FORCES, CONTACTS).or_else(|| of("w_", PARTS, LINKS));
        let Some((topic, part)) = part else { continue };
        let at = found.iter().position(|one| one.topic == topic).unwrap_or_else(|| {
            found.push(Wrench { topic, places: [None; 6] });
            found.len() - 1
        });
        found[at].places[part] = Some(place);
    }
    found
}

/// The bytes of a row's message at a time \[ns\].
type Message<'a> = Box<dyn Fn(&[f64], i64) -> Result<Vec<u8>, String> + 'a>;

/// A topic, and what its messages are in a row.
struct Topic<'a> {
    channel: u16,
    sequence: u32,
    message: Message<'a>,
}

fn bytes(message: &impl Serialize) -> Result<Vec<u8>, String> {
    let body = cdr_encoding::to_vec::<_, LittleEndian>(message).map_err(|e| e.to_string())?;
    Ok([&HEAD[..], &body].concat())
}

fn header(frame_id: &str, time_ns: i64) -> Header<'_> {
    const SECOND: i64 = 1_000_000_000;
    // times of runs are far within both
    let sec = i32::try_from(time_ns.div_euclid(SECOND)).unwrap_or(i32::MAX);
    let nanosec = u32::try_from(time_ns.rem_euclid(SECOND)).unwrap_or(0);
    Header { stamp: Stamp { sec, nanosec }, frame_id }
}

/// The table as an MCAP file.
///
/// # Errors
/// A sentence: there is no column `t`, or a table is too large for the format.
pub fn write_mcap(rows: &Rows<'_>) -> Result<Vec<u8>, String> {
    let failed = |error: McapError| error.to_string();
    let columns = rows.columns;
    let time = columns.iter().position(|column| column == "t").ok_or("no column `t`")?;
    // a file that is cut keeps its whole chunks: they are small
    let options = WriteOptions::new()
        .compression(None)
        .chunk_size(Some(CHUNK))
        .profile("ros2")
        .library("denavit");
    let mut writer = Writer::with_options(Cursor::new(Vec::new()), options).map_err(failed)?;
    let metadata = rows.header.iter().cloned().collect();
    let metadata = Metadata { name: METADATA.to_owned(), metadata };
    writer.write_metadata(&metadata).map_err(failed)?;
    let is_sprung = |joint: &str| columns.iter().any(|c| c.strip_prefix("motor_") == Some(joint));
    let motors = Joints::of(columns, &["motor_", "tau_cmd_"], |_, joint| is_sprung(joint));
    let is_joint = |joint: &str| columns.iter().any(|c| c.strip_prefix("q_") == Some(joint));
    let states = Joints::of(columns, &["q_", "qd_", "tau_"], |_, joint| is_joint(joint));
    let controlled = Joints::of(columns, &["ref_", "qdd_", "tau_cmd_"], |prefix, joint| {
        is_joint(joint) && (prefix != "tau_cmd_" || !is_sprung(joint))
    });
    let wrenches = wrenches(columns);
    let mut used: Vec<usize> = vec![time];
    used.extend(motors.places().chain(states.places()).chain(controlled.places()));
    used.extend(wrenches.iter().flat_map(|one| one.places.iter().flatten()));
    let mut topics: Vec<Topic<'_>> = Vec::new();
    let mut add = |writer: &mut Writer<_>, topic: &str, usual: &Usual, message| {
        let text = usual.definitions[0].as_bytes();
        let schema = writer.add_schema(usual.kind, "ros2msg", text).map_err(failed)?;
        let channel = writer.add_channel(schema, topic, "cdr", &BTreeMap::new()).map_err(failed)?;
        topics.push(Topic { channel, sequence: 0, message });
        Ok::<(), String>(())
    };
    let all = [(JOINTS, &states, [Some(0), Some(1), Some(2)]), (MOTORS, &motors, MOTOR_PARTS)];
    for (topic, joints, parts) in all.into_iter().filter(|(_, one, _)| !one.names.is_empty()) {
        let message = move |row: &[f64], at| joint_state(joints, parts, row, at);
        add(&mut writer, topic, &JOINT_STATE, Box::new(message))?;
    }
    if !controlled.names.is_empty() {
        let message = |row: &[f64], at| controller_state(&controlled, row, at);
        add(&mut writer, CONTROLLER, &CONTROLLER_STATE, Box::new(message))?;
    }
    for one in &wrenches {
        let message = |row: &[f64], at| wrench(one, row, at);
        add(&mut writer, &one.topic, &WRENCH, Box::new(message))?;
    }
    for place in (0..columns.len()).filter(|place| !used.contains(place)) {
        let topic = format!("{OTHERS}{}", columns[place]);
        let message = move |row: &[f64], _| bytes(&row[place]);
        add(&mut writer, &topic, &NUMBER, Box::new(message))?;
    }
    for row in rows.values.chunks_exact(columns.len().max(1)) {
        let time_ns = (row[time] * 1e9).round() as i64;
        for topic in &mut topics {
            let log_time = u64::try_from(time_ns).unwrap_or(0);
            let Topic { channel: channel_id, sequence, .. } = *topic;
            let head = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
            let data = (topic.message)(row, time_ns)?;
            writer.write_to_known_channel(&head, &data).map_err(failed)?;
            topic.sequence = topic.sequence.wrapping_add(1);
        }
    }
    writer.finish().map_err(failed)?;
    Ok(writer.into_inner().into_inner())
}

/// Where positions, velocities and efforts of motors stand among their columns.
const MOTOR_PARTS: [Option<usize>; 3] = [Some(0), None, Some(1)];

fn joint_state(
    joints: &Joints,
    parts: [Option<usize>; 3],
    row: &[f64],
    time_ns: i64,
) -> Result<Vec<u8>, String> {
    let part = |part: Option<usize>| part.map_or(Vec::new(), |part| joints.values(part, row));
    let [position, velocity, effort] = parts.map(part);
    let header = header("", time_ns);
    bytes(&JointState { header, name: &joints.names, position, velocity, effort })
}

fn controller_state(joints: &Joints, row: &[f64], time_ns: i64) -> Result<Vec<u8>, String> {
    bytes(&ControllerState {
        header: header("", time_ns),
        joint_names: &joints.names,
        reference: Point { positions: joints.values(0, row), ..Point::default() },
        feedback: Point { accelerations: joints.values(1, row), ..Point::default() },
        error: Point::default(),
        output: Point { effort: joints.values(2, row), ..Point::default() },
        multi_dof_joint_names: Vec::new(),
        multi_dof: Default::default(),
    })
}

fn wrench(one: &Wrench, row: &[f64], time_ns: i64) -> Result<Vec<u8>, String> {
    let part = |place: Option<usize>| place.map_or(0.0, |place| row[place]);
    bytes(&WrenchStamped { header: header(WORLD, time_ns), wrench: one.places.map(part) })
}
