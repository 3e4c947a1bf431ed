//! A planned gait as files: a complete scenario, which `simulate` walks, and what joints follow
//! alone (`"denavit-trajectory/1"`). The same plan gives the same bytes.

use super::curve::JointPath;
use super::plan::GaitPlan;
use crate::scenario_file::{
    JointLaw, ScenarioHead, ScenarioRun, head_lines, line, number, scenario_file, sequence,
};
use denavit_plants::PlantModel;
use denavit_simulate::State;

impl GaitPlan {
    /// The scenario file of the plan, which knows its own number of steps.
    pub fn scenario_text(&self, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
        let law = |path: &JointPath| JointLaw {
            joint: path.joint,
            stiffness: self.gains.kp,
            damping: self.gains.kd,
            functions: {
                let reference = ("reference", reference_text(path, self.repeats));
                let torque = path.feed_forward.as_ref();
                let torque = torque.map(|curve| ("feed_forward", curve.text()));
                std::iter::once(reference).chain(torque).collect()
            },
        };
        let laws: Vec<JointLaw> = self.paths.iter().map(law).collect();
        let run = ScenarioRun {
            duration_s: self.duration_s,
            start: &State::resting(self.start.clone()),
            laws: &laws,
            friction: self.gains.friction,
        };
        scenario_file(model, head, &run)
    }

    /// The trajectory file of the plan.
    pub fn trajectory_text(&self, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
        let mut text = String::from("{\n  \"format\": \"denavit-trajectory/1\",\n");
        let entries =
            [("name", head.name), ("description", head.description), ("model", head.model)];
        head_lines(&mut text, &entries);
        // two steps, after which the same leg stands again
        let lap_s = if self.repeats { 2.0 * self.step_s } else { self.duration_s };
        line(&mut text, 1, "duration_s", &number(lap_s), true);
        line(&mut text, 1, "periodic", &self.repeats.to_string(), true);
        text.push_str("  \"joints\": {\n");
        for (index, path) in self.paths.iter().enumerate() {
            let name = &model.joints[path.joint].name;
            line(&mut text, 2, name, &reference_text(path, false), index + 1 < self.paths.len());
        }
        text.push_str("  }\n}\n");
        text
    }
}

fn reference_text(path: &JointPath, repeats: bool) -> String {
    match (&path.pieces[..], repeats) {
        ([piece], false) => piece.curve.text(),
        (pieces, _) => {
            sequence(pieces.iter().map(|piece| (piece.duration_s, piece.curve.text())), repeats)
        }
    }
}
