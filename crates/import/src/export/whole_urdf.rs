//! A whole URDF of a model: a link for each row of the table.

use super::frame::Frame;
use super::skeleton::Skeleton;
use super::values::{Numbers, notes};
use denavit_codegen::model::{JointKind, Limits, LinkId};
use denavit_codegen::number::to_f64;
use std::fmt::Write;

/// The URDF of a model, and what it does not say.
pub(super) fn urdf(numbers: Numbers) -> (String, Vec<String>) {
    let mut writer = Writer { notes: notes(&numbers, true), numbers, text: String::new() };
    writer.robot();
    (writer.text, writer.notes)
}

struct Writer {
    numbers: Numbers,
    notes: Vec<String>,
    text: String,
}

impl Writer {
    fn robot(&mut self) {
        let skeleton = Skeleton::new(&self.numbers);
        let name = self.numbers.robot.name.clone();
        let root_name = &skeleton.root_name;
        self.put(format_args!("<?xml version=\"1.0\"?>\n<robot name=\"{name}\">\n"));
        match skeleton.root {
            Some(root) => self.link_as(root, root_name, &Frame::identity()),
            None => self.put(format_args!("  <link name=\"{root_name}\"/>\n")),
        }
        for part in &skeleton.parts {
            let parent = match part.parent.filter(|parent| Some(*parent) != skeleton.root) {
                Some(parent) => self.numbers.robot.links[parent].name.clone(),
                None => root_name.clone(),
            };
            let own = self.numbers.robot.links[part.id].name.clone();
            self.link_as(part.id, &own, &part.beyond);
            self.joint(part.id, &parent, &part.own);
        }
        self.text.push_str("</robot>\n");
    }

    fn put(&mut self, text: std::fmt::Arguments<'_>) {
        // writing to a string does not fail
        let _ = self.text.write_fmt(text);
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

    fn limit(&mut self, limits: &Limits, kind: &str) {
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
