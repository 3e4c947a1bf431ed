//! A planned gait as files: a complete scenario (`"denavit-scenario/1"`), which `simulate` walks,
//! and what joints follow alone (`"denavit-trajectory/1"`). The same plan gives the same bytes.

use super::curve::JointPath;
use super::plan::GaitPlan;
use crate::optimal::ScenarioHead;
use denavit_plants::PlantModel;
use serde_json::Value;
use std::fmt::Write;

impl GaitPlan {
    /// The scenario file of the plan; `head` names its steps, too.
    pub fn scenario_text(&self, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
        let mut text = String::from("{\n  \"format\": \"denavit-scenario/1\",\n");
        for (key, value) in [
            ("name", head.name),
            ("description", head.description),
            ("source", head.source),
            ("model", head.model),
        ] {
            if !value.is_empty() {
                let _ = writeln!(text, "  \"{key}\": {},", quoted(value));
            }
        }
        let _ = writeln!(text, "  \"duration_s\": {:?},", self.duration_s);
        text.push_str("  \"initial\": {\n    \"q\": {\n");
        let joints = model.joints.iter().zip(&self.start);
        let lines = joints.map(|(joint, q)| format!("      {}: {q:?}", quoted(&joint.name)));
        text += &lines.collect::<Vec<_>>().join(",\n");
        text.push_str("\n    },\n    \"on_ground\": true\n  },\n");
        text.push_str("  \"control\": {\n    \"joints\": {\n");
        let laws = self.paths.iter().map(|path| {
            format!(
                "      {}: {{\n        \"kp\": {:?},\n        \"kd\": {:?},\n        \
                 \"reference\": {}\n      }}",
                quoted(&model.joints[path.joint].name),
                self.gains.kp,
                self.gains.kd,
                self.reference_text(path, self.repeats)
            )
        });
        text += &laws.collect::<Vec<_>>().join(",\n");
        text.push_str("\n    }\n  },\n");
        let friction = self.gains.fallback_friction;
        let _ = writeln!(text, "  \"contact\": {{\"fallback_friction\": {friction:?}}},");
        text.push_str(
            "  \"integrator\": {\n    \"method\": \"radau\",\n    \"relative\": 1e-07,\n",
        );
        text.push_str("    \"absolute\": 1e-08,\n    \"max_step_s\": 0.02\n  },\n");
        text.push_str("  \"log_period_s\": 0.01,\n  \"tolerances\": {\"energy_j\": 0.001}\n}\n");
        text
    }

    /// The trajectory file of the plan.
    pub fn trajectory_text(&self, model: &PlantModel, head: &ScenarioHead<'_>) -> String {
        let mut text = String::from("{\n  \"format\": \"denavit-trajectory/1\",\n");
        for (key, value) in
            [("name", head.name), ("description", head.description), ("model", head.model)]
        {
            if !value.is_empty() {
                let _ = writeln!(text, "  \"{key}\": {},", quoted(value));
            }
        }
        // two steps, after which the same leg stands again
        let lap_s = if self.repeats { 2.0 * self.step_s } else { self.duration_s };
        let _ = writeln!(text, "  \"duration_s\": {lap_s:?},");
        let _ = writeln!(text, "  \"periodic\": {},\n  \"joints\": {{", self.repeats);
        let joints = self.paths.iter().map(|path| {
            let name = quoted(&model.joints[path.joint].name);
            format!("    {name}: {}", self.reference_text(path, false))
        });
        text += &joints.collect::<Vec<_>>().join(",\n");
        text.push_str("\n  }\n}\n");
        text
    }

    fn reference_text(&self, path: &JointPath, repeats: bool) -> String {
        if let ([piece], false) = (&path.pieces[..], repeats) {
            return piece.curve.text();
        }
        let parts = path.pieces.iter().map(|piece| {
            let (duration_s, curve) = (piece.duration_s, piece.curve.text());
            format!("          {{\"duration_s\": {duration_s:?}, \"reference\": {curve}}}")
        });
        format!(
            "{{\"sequence\": {{\"repeat\": {repeats}, \"parts\": [\n{}\n        ]}}}}",
            parts.collect::<Vec<_>>().join(",\n")
        )
    }
}

fn quoted(text: &str) -> String {
    Value::from(text).to_string()
}
