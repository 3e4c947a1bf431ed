//! A whole MJCF of a model: a body for each row of the table.

use super::frame::Frame;
use super::skeleton::{Part, Skeleton};
use super::values::{Numbers, notes};
use denavit_codegen::model::{JointKind, LinkId};
use denavit_codegen::number::to_f64;
use std::fmt::Write;

/// The MJCF of a model, and what it does not say.
pub(super) fn mjcf(numbers: &Numbers) -> (String, Vec<String>) {
    let skeleton = Skeleton::new(numbers);
    let mut writer = Writer { numbers, skeleton: &skeleton, text: String::new() };
    writer.robot();
    (writer.text, notes(numbers, false))
}

struct Writer<'n> {
    numbers: &'n Numbers,
    skeleton: &'n Skeleton,
    text: String,
}

impl Writer<'_> {
    fn robot(&mut self) {
        let robot = &self.numbers.robot;
        let [x, y, z] = robot.gravity.map(|entry| self.numbers.number(entry));
        self.line(0, format_args!("<mujoco model=\"{}\">", robot.name));
        self.line(1, format_args!("<compiler angle=\"radian\" autolimits=\"true\"/>"));
        self.line(1, format_args!("<option gravity=\"{x} {y} {z}\"/>"));
        self.line(1, format_args!("<worldbody>"));
        let skeleton = self.skeleton;
        match skeleton.root {
            Some(root) => {
                self.line(2, format_args!("<body name=\"{}\">", skeleton.root_name));
                self.line(3, format_args!("<freejoint name=\"{}_free\"/>", skeleton.root_name));
                self.inertial(root, &Frame::identity(), 3);
                self.children(Some(root), 3);
                self.line(2, format_args!("</body>"));
            }
            None => self.children(None, 2),
        }
        self.line(1, format_args!("</worldbody>"));
        self.actuators();
        self.line(0, format_args!("</mujoco>"));
    }

    fn line(&mut self, depth: usize, text: std::fmt::Arguments<'_>) {
        self.text.extend(std::iter::repeat_n(' ', 2 * depth));
        // writing to a string does not fail
        let _ = self.text.write_fmt(text);
        self.text.push('\n');
    }

    /// What stands on a row, and on that in turn.
    fn children(&mut self, parent: Option<LinkId>, depth: usize) {
        // the bodies that are open: what comes next in each, and where it stands
        let skeleton = self.skeleton;
        let of = |parent: Option<LinkId>| -> Vec<&Part> {
            skeleton.parts.iter().filter(|part| part.parent == parent).collect()
        };
        let mut open = vec![of(parent).into_iter()];
        while let Some(next) = open.last_mut().map(Iterator::next) {
            let inside = depth + open.len() - 1;
            match next {
                Some(part) => {
                    self.body(part, inside);
                    open.push(of(Some(part.id)).into_iter());
                }
                None => {
                    open.pop();
                    if !open.is_empty() {
                        self.line(inside - 1, format_args!("</body>"));
                    }
                }
            }
        }
    }

    fn body(&mut self, part: &Part, depth: usize) {
        let link = self.numbers.robot.links[part.id].clone();
        let ([x, y, z], [w, a, b, c]) = (part.own.at, part.own.quaternion());
        let name = &link.name;
        self.line(
            depth,
            format_args!("<body name=\"{name}\" pos=\"{x} {y} {z}\" quat=\"{w} {a} {b} {c}\">"),
        );
        self.joint(part.id, depth + 1);
        self.inertial(part.id, &part.beyond, depth + 1);
        let robot = &self.numbers.robot;
        let contacts: Vec<_> =
            robot.contacts.values().filter(|contact| contact.link == part.id).cloned().collect();
        for contact in contacts {
            let point = contact.position.map(|entry| self.numbers.number(entry));
            let [x, y, z] = part.beyond.place(point);
            let name = &contact.name;
            self.line(depth + 1, format_args!("<site name=\"{name}\" pos=\"{x} {y} {z}\"/>"));
        }
    }

    fn joint(&mut self, id: LinkId, depth: usize) {
        let link = self.numbers.robot.links[id].clone();
        let kind = match link.joint.kind {
            JointKind::Fixed => return,
            JointKind::Revolute => "hinge",
            JointKind::Prismatic => "slide",
        };
        let number = |expr| self.numbers.number(expr);
        let mut more = String::new();
        let mut put = |key: &str, value: f64| {
            if value != 0.0 {
                more.push_str(&format!(" {key}=\"{value}\""));
            }
        };
        let [viscous, coulomb] = self.numbers.friction(id).each_ref().map(to_f64);
        let drive = link.drive.unwrap_or_default();
        let ratio = drive.gear_ratio.map_or(1.0, number);
        put("damping", viscous);
        put("frictionloss", coulomb);
        put("armature", drive.rotor_inertia.map_or(0.0, number) * ratio * ratio);
        if let Some(spring) = link.joint.spring {
            put("stiffness", number(spring.stiffness));
            put("springref", number(spring.angle));
        }
        if let Some([low, high]) = link.limits.position.map(|ends| ends.map(number)) {
            more.push_str(&format!(" range=\"{low} {high}\""));
        }
        if let Some([low, high]) = link.limits.torque.map(|ends| ends.map(number)) {
            more.push_str(&format!(" actuatorfrcrange=\"{low} {high}\""));
        }
        let name = &link.name;
        self.line(
            depth,
            format_args!("<joint name=\"{name}\" type=\"{kind}\" axis=\"0 0 1\"{more}/>"),
        );
    }

    fn inertial(&mut self, id: LinkId, beyond: &Frame, depth: usize) {
        let Some(body) = self.numbers.body(id) else { return };
        let [x, y, z] = beyond.place(body.com.each_ref().map(to_f64));
        let mass = to_f64(&body.mass);
        let [xx, yy, zz, xy, xz, yz] = beyond.tensor(body.inertia.each_ref().map(to_f64));
        self.line(
            depth,
            format_args!(
                "<inertial pos=\"{x} {y} {z}\" mass=\"{mass}\" \
                 fullinertia=\"{xx} {yy} {zz} {xy} {xz} {yz}\"/>"
            ),
        );
    }

    fn actuators(&mut self) {
        let robot = &self.numbers.robot;
        let driven: Vec<String> = robot
            .links
            .values()
            .filter(|link| link.drive.is_some())
            .map(|link| link.name.clone())
            .collect();
        if driven.is_empty() {
            return;
        }
        self.line(1, format_args!("<actuator>"));
        for name in driven {
            self.line(2, format_args!("<motor name=\"{name}\" joint=\"{name}\"/>"));
        }
        self.line(1, format_args!("</actuator>"));
    }
}
