//! A whole URDF of a model: a link for each row of the table.
//!
//! A link of the URDF has its frame on its joint. In the modified convention that is the frame of
//! the row; in the standard one the row's frame is further on, by a and alpha, so bodies and
//! children are moved there. Numbers are doubles here, as every reader of URDF has them.

use super::values::Numbers;
use super::{ExportError, Exported};
use crate::fault::listed;
use denavit_codegen::model::{Base, Convention, Joint, JointKind, LinkId, Robot};
use denavit_codegen::number::to_f64;
use std::fmt::Write;

/// A frame in another one: rows of a rotation, and a place.
#[derive(Clone, Copy, Debug)]
struct Frame {
    turn: [[f64; 3]; 3],
    at: [f64; 3],
}

/// The URDF of a model.
pub fn export(robot: &Robot) -> Result<Exported, ExportError> {
    if robot.base == Base::PlanarFloating {
        let said = "a URDF floats in space or not at all: this one floats in a plane";
        return Err(ExportError::Model(said.to_owned()));
    }
    let numbers = Numbers::new(robot)?;
    let mut writer = Writer { notes: notes(&numbers), numbers, text: String::new() };
    writer.robot();
    Ok(Exported { text: writer.text, notes: writer.notes })
}

/// What a URDF does not say.
fn notes(numbers: &Numbers) -> Vec<String> {
    let robot = &numbers.robot;
    let mut notes = Vec::new();
    let gravity = robot.gravity.map(|entry| numbers.number(entry));
    if gravity != [0.0, 0.0, -9.81] {
        notes.push(format!("gravity is {gravity:?} here, which a URDF does not say"));
    }
    let with = |has: &dyn Fn(LinkId) -> bool| -> Vec<String> {
        let links = robot.links.iter().filter(|(id, _)| has(*id));
        links.map(|(_, link)| link.name.clone()).collect()
    };
    let sprung = with(&|id| {
        let link = &robot.links[id];
        let drive = link.drive.unwrap_or_default();
        link.joint.spring.is_some()
            || drive.series_elastic.is_some()
            || drive.return_spring.is_some()
    });
    if !sprung.is_empty() {
        notes.push(format!("a URDF has no springs; these have: {}", listed(&sprung)));
    }
    let offsets = with(&|id| robot.links[id].drive.is_some_and(|drive| drive.offset.is_some()));
    if !offsets.is_empty() {
        notes.push(format!("a URDF has no constant torques; these have: {}", listed(&offsets)));
    }
    if !robot.effects.is_empty() {
        let names: Vec<String> = robot.effects.iter().map(|effect| effect.effect.clone()).collect();
        notes.push(format!("a URDF has no effects; these are left out: {}", listed(&names)));
    }
    notes
}

struct Writer {
    numbers: Numbers,
    notes: Vec<String>,
    text: String,
}

impl Writer {
    fn robot(&mut self) {
        let robot = &self.numbers.robot;
        let skipped = robot.base.generated_joints();
        let tip = robot.links.iter().nth(skipped.wrapping_sub(1)).map(|(id, _)| id);
        let on_base: Vec<LinkId> = robot
            .links
            .iter()
            .skip(skipped)
            .filter(|(_, link)| link.parent == tip)
            .map(|(id, _)| id)
            .collect();
        // what floats is the only row on the base, if it is fixed there
        let root = match on_base[..] {
            [one] if tip.is_some() && robot.links[one].joint.kind == JointKind::Fixed => Some(one),
            _ => None,
        };
        let name = robot.name.clone();
        let root_name = root.map_or("base", |root| &robot.links[root].name).to_owned();
        let ids: Vec<LinkId> = robot.links.iter().skip(skipped).map(|(id, _)| id).collect();
        self.put(format_args!("<?xml version=\"1.0\"?>\n<robot name=\"{name}\">\n"));
        if let Some(root) = root {
            self.link(root, &Frame::identity());
        } else {
            match tip {
                Some(tip) => self.link_as(tip, &root_name, &Frame::identity()),
                None => self.put(format_args!("  <link name=\"{root_name}\"/>\n")),
            }
        }
        for &id in ids.iter().filter(|&&id| Some(id) != root) {
            let link = &self.numbers.robot.links[id];
            let (own, beyond) = self.frames(&link.joint);
            let parent = link.parent.filter(|parent| Some(*parent) != tip);
            let before = match parent {
                None => Frame::identity(),
                Some(parent) if Some(parent) == root => Frame::identity(),
                Some(parent) => self.frames(&self.numbers.robot.links[parent].joint).1,
            };
            let parent =
                parent.map_or(root_name.clone(), |id| self.numbers.robot.links[id].name.clone());
            self.link(id, &beyond);
            self.joint(id, &parent, &before.times(&own));
        }
        self.text.push_str("</robot>\n");
    }

    fn put(&mut self, text: std::fmt::Arguments<'_>) {
        // writing to a string does not fail
        let _ = self.text.write_fmt(text);
    }

    /// The frame of a joint in that of its row's parent, and the frame of the row in the joint's.
    fn frames(&self, joint: &Joint) -> (Frame, Frame) {
        let number = |expr| self.numbers.number(expr);
        let (a, alpha) = (number(joint.a), number(joint.alpha));
        let (d, theta) = (number(joint.d), number(joint.theta));
        let across = Frame::along(0, a).times(&Frame::about(0, alpha));
        let up = Frame::about(2, theta).times(&Frame::along(2, d));
        match self.numbers.robot.convention {
            Convention::Modified => {
                (Frame::about(0, alpha).times(&Frame::along(0, a)).times(&up), Frame::identity())
            }
            Convention::Standard => (up, across),
        }
    }

    fn link(&mut self, id: LinkId, beyond: &Frame) {
        let name = self.numbers.robot.links[id].name.clone();
        self.link_as(id, &name, beyond);
    }

    fn link_as(&mut self, id: LinkId, name: &str, beyond: &Frame) {
        let Some(body) = self.numbers.body(id) else {
            return self.put(format_args!("  <link name=\"{name}\"/>\n"));
        };
        let com = beyond.place(body.com.each_ref().map(to_f64));
        let [xx, yy, zz, xy, xz, yz] = body.inertia.each_ref().map(to_f64);
        let [r, p, y] = beyond.rpy();
        self.put(format_args!("  <link name=\"{name}\">\n    <inertial>\n"));
        let [x, up, z] = com;
        self.put(format_args!("      <origin xyz=\"{x} {up} {z}\" rpy=\"{r} {p} {y}\"/>\n"));
        self.put(format_args!("      <mass value=\"{}\"/>\n", to_f64(&body.mass)));
        self.put(format_args!(
            "      <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"{xy}\" ixz=\"{xz}\" \
             iyz=\"{yz}\"/>\n    </inertial>\n  </link>\n"
        ));
    }

    fn joint(&mut self, id: LinkId, parent: &str, own: &Frame) {
        let link = self.numbers.robot.links[id].clone();
        let limits = link.limits;
        let kind = match (link.joint.kind, limits.position) {
            (JointKind::Fixed, _) => "fixed",
            (JointKind::Prismatic, _) => "prismatic",
            (JointKind::Revolute, Some(_)) => "revolute",
            (JointKind::Revolute, None) => "continuous",
        };
        let name = &link.name;
        // a fixed joint and its link may not have one name for some readers
        let joint = if kind == "fixed" { format!("{name}_fixed") } else { name.clone() };
        let ([x, y, z], [r, p, w]) = (own.at, own.rpy());
        self.put(format_args!("  <joint name=\"{joint}\" type=\"{kind}\">\n"));
        self.put(format_args!("    <origin xyz=\"{x} {y} {z}\" rpy=\"{r} {p} {w}\"/>\n"));
        self.put(format_args!("    <parent link=\"{parent}\"/>\n    <child link=\"{name}\"/>\n"));
        if kind != "fixed" {
            self.put(format_args!("    <axis xyz=\"0 0 1\"/>\n"));
            self.limit(&limits, kind);
            let [viscous, coulomb] = self.numbers.friction(id).each_ref().map(to_f64);
            if viscous != 0.0 || coulomb != 0.0 {
                self.put(format_args!(
                    "    <dynamics damping=\"{viscous}\" friction=\"{coulomb}\"/>\n"
                ));
            }
        }
        self.text.push_str("  </joint>\n");
        let drive = link.drive.unwrap_or_default();
        if let Some(rotor) = drive.rotor_inertia {
            let rotor = self.numbers.number(rotor);
            let ratio = drive.gear_ratio.map_or(1.0, |ratio| self.numbers.number(ratio));
            self.put(format_args!(
                "  <transmission name=\"{name}_transmission\">\n    \
                 <type>transmission_interface/SimpleTransmission</type>\n    \
                 <joint name=\"{name}\"/>\n    <actuator name=\"{name}_motor\">\n      \
                 <mechanicalReduction>{ratio}</mechanicalReduction>\n      \
                 <rotorInertia>{rotor}</rotorInertia>\n    </actuator>\n  </transmission>\n"
            ));
        }
    }

    fn limit(&mut self, limits: &denavit_codegen::model::Limits, kind: &str) {
        /// What stands for no bound where URDF wants one.
        const ENDLESS: f64 = 1e9;
        let number = |expr| self.numbers.number(expr);
        let position = limits.position.map(|ends| ends.map(number));
        let velocity = limits.velocity.map_or(ENDLESS, number);
        let effort = limits.torque.map_or(ENDLESS, |[low, high]| number(high).max(-number(low)));
        let ends = match (position, kind) {
            (Some([low, high]), _) => format!(" lower=\"{low}\" upper=\"{high}\""),
            (None, "prismatic") => format!(" lower=\"-{ENDLESS}\" upper=\"{ENDLESS}\""),
            (None, _) => String::new(),
        };
        self.put(format_args!("    <limit{ends} velocity=\"{velocity}\" effort=\"{effort}\"/>\n"));
    }
}

impl Frame {
    fn identity() -> Self {
        let turn = std::array::from_fn(|row| {
            std::array::from_fn(|column| f64::from(u8::from(row == column)))
        });
        Self { turn, at: [0.0; 3] }
    }

    fn along(axis: usize, length: f64) -> Self {
        let mut frame = Self::identity();
        frame.at[axis] = length;
        frame
    }

    fn about(axis: usize, angle: f64) -> Self {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut frame = Self::identity();
        let (sine, cosine) = sine_and_cosine(angle);
        frame.turn[next][next] = cosine;
        frame.turn[last][last] = cosine;
        frame.turn[last][next] = sine;
        frame.turn[next][last] = -sine;
        frame
    }

    fn place(&self, point: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|row| {
            self.at[row] + (0..3).map(|k| self.turn[row][k] * point[k]).sum::<f64>()
        })
    }

    fn times(&self, other: &Self) -> Self {
        let turn = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                (0..3).map(|k| self.turn[row][k] * other.turn[k][column]).sum()
            })
        });
        Self { turn, at: self.place(other.at) }
    }

    /// Angles about x, y, z, each about the fixed axes.
    fn rpy(&self) -> [f64; 3] {
        let m = &self.turn;
        let across = m[0][0].hypot(m[1][0]);
        if across < 1e-12 {
            return [0.0, (-m[2][0]).atan2(across), (-m[0][1]).atan2(m[1][1])];
        }
        [m[2][1].atan2(m[2][2]), (-m[2][0]).atan2(across), m[1][0].atan2(m[0][0])]
            .map(|angle| if angle == 0.0 { 0.0 } else { angle })
    }
}

/// Sine and cosine, exact at quarter turns.
fn sine_and_cosine(angle: f64) -> (f64, f64) {
    let quarters = angle / std::f64::consts::FRAC_PI_2;
    if quarters == quarters.round() && quarters.abs() < 1e6 {
        let place = (quarters.rem_euclid(4.0)) as usize % 4;
        return ([0.0, 1.0, 0.0, -1.0][place], [1.0, 0.0, -1.0, 0.0][place]);
    }
    angle.sin_cos()
}
