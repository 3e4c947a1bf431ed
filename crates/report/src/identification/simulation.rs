//! Logs that were simulated again.

use super::curves::motion;
use super::{SimulationPart, headings, share};
use crate::html::{Cell, HtmlTable, Part, Row, SceneMark, Section};
use crate::jointed::{JointMotion, JointedRobot};
use denavit_codegen::model::Robot;
use denavit_replay::{Compared, Forward, ForwardJoint};

impl SimulationPart<'_> {
    pub(super) fn section(&self, robot: &Robot) -> Section {
        let columns = headings(&[
            ("joint", false),
            ("position before", true),
            ("position", true),
            ("velocity before", true),
            ("velocity", true),
            ("torque before", true),
            ("torque", true),
        ]);
        let joints = self.after.or(self.before).map_or(&[][..], |made| &made.joints);
        let rows = joints.iter().map(|joint| {
            let of = |forward: Option<&Forward>| {
                let joints = forward.map_or(&[][..], |made| &made.joints);
                joints.iter().find(|other| other.name == joint.name).cloned()
            };
            let both = [of(self.before), of(self.after)];
            let mut cells = vec![Cell::text(&joint.name)];
            let signals: [fn(&ForwardJoint) -> Option<&Compared>; 3] =
                [|one| Some(&one.position), |one| Some(&one.rate), |one| one.torque.as_ref()];
            for signal in signals {
                for made in &both {
                    let compared = made.as_ref().and_then(signal);
                    cells.push(compared.map_or_else(|| Cell::text(""), |one| share(one.relative)));
                }
            }
            Row { cells, is_marked: false }
        });
        let caption = format!(
            "Logs {}: rms of simulated less measured, over the size of what there is to predict.",
            self.method
        );
        let table = HtmlTable { caption, columns, rows: rows.collect() };
        let mut parts = vec![Part::Table(table)];
        let paragraph = |text: &String| Part::Paragraph { text: text.clone() };
        parts.extend(self.reasons.iter().map(paragraph));
        if let Some(after) = self.after {
            parts.extend(self.played(robot, after));
            parts.extend(motion(after).map(Part::Chart));
        }
        Section { heading: "Simulation".to_owned(), parts }
    }

    /// The robot as it was simulated with what was found, and as it was measured.
    fn played(&self, robot: &Robot, forward: &Forward) -> Option<Part> {
        // of several logs the first: where time goes back, another one begins
        let t_s = &forward.t_s;
        let end = t_s.windows(2).position(|pair| pair[1] <= pair[0]).map_or(t_s.len(), |at| at + 1);
        let of = |signal: fn(&Compared) -> &[f64]| {
            let joints = forward.joints.iter();
            joints.map(|joint| (joint.name.as_str(), &signal(&joint.position)[..end])).collect()
        };
        let motion = JointMotion {
            t_s: &t_s[..end],
            q: of(|position| &position.simulated),
            beside: Some(of(|position| &position.measured)),
            ..JointMotion::default()
        };
        let name = format!("{}, measured and simulated, in three dimensions", robot.name);
        let caption = format!(
            "{}, {}: in grey as it was simulated with what was found, in blue as it was measured. \
             Drag to turn, scroll to come closer.",
            forward.file, self.method
        );
        let marks = vec![SceneMark::beside(format!("measured: {}", forward.file))];
        let scene = JointedRobot::new(robot).ok()?;
        scene.moving([name, caption], marks, &motion).map(Part::Replay)
    }
}
