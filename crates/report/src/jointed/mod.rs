//! A robot whose joints a page moves: by sliders, or along the positions of a log. The page has the
//! rows of the table as transforms at zero; the joints turn about, or slide along, their z axes.

mod geometry;

use super::html::{Brief, Replay, Scene, SceneMark, with_decimals};
use super::pose::Pose;
use denavit_codegen::model::Robot;
use denavit_codegen::program::LowerError;
use geometry::{Geometry, JointData};
use serde::Serialize;

/// Frames of a motion at most.
const MOST_FRAMES: usize = 1500;
/// Frames of a second.
pub(crate) const RATE: f64 = 30.0;
/// Decimals of a time and of a position: those of a pixel.
const DECIMALS: usize = 4;

/// A robot in three dimensions.
#[derive(Clone, Debug)]
pub(crate) struct JointedRobot {
    geometry: Geometry,
}

/// Positions of joints over time.
#[derive(Clone, Debug)]
pub(crate) struct JointMotion<'a> {
    /// Times \[s\].
    pub(crate) t_s: &'a [f64],
    /// For each joint its name and its positions; others stay where they are.
    pub(crate) q: Vec<(&'a str, &'a [f64])>,
}

/// What the script draws.
#[derive(Serialize)]
struct Data<'a> {
    #[serde(flatten)]
    geometry: &'a Geometry,
    t: Vec<Brief>,
    /// Positions of all joints, frame after frame.
    q: Vec<Brief>,
    events: [(); 0],
}

impl JointedRobot {
    /// The robot at its zero pose. Values that its file leaves open are those of pictures.
    pub(crate) fn new(robot: &Robot) -> Result<Self, LowerError> {
        Ok(Self { geometry: Geometry::new(robot, &Pose::zero(robot)?) })
    }

    /// The same with the links of these names marked, or their joints, beside what is already.
    pub(crate) fn marking(mut self, links: &[&str], is_body: bool) -> Self {
        for link in &mut self.geometry.links {
            let is_own = links.contains(&link.name.as_str());
            link.is_marked |= is_own && is_body;
            link.is_joint_marked |= is_own && !is_body;
        }
        self
    }

    /// The same with what is said of a link when it is pointed at.
    pub(crate) fn telling(mut self, told: impl Fn(&str) -> String) -> Self {
        self.geometry.links.iter_mut().for_each(|link| link.text = told(&link.name));
        self
    }

    /// With a slider for each joint, and the frames of its links.
    pub(crate) fn with_sliders(mut self, [name, caption]: [String; 2]) -> Replay {
        self.geometry.frames = true;
        let sliders = self.geometry.joints.iter().filter(|joint| joint.is_shown);
        let scene = Scene {
            name,
            caption,
            marks: vec![SceneMark::frames(), SceneMark::center_of_mass()],
            sliders: sliders.map(JointData::slider).collect(),
            ..Scene::default()
        };
        scene.shown(&Data { geometry: &self.geometry, t: vec![], q: vec![], events: [] })
    }

    /// Along a motion; none of one that is too short to be played.
    pub(crate) fn moving(
        &self,
        [name, caption]: [String; 2],
        marks: Vec<SceneMark>,
        motion: &JointMotion<'_>,
    ) -> Option<Replay> {
        let (first, last) = (motion.t_s.first()?, motion.t_s.last()?);
        let rows = motion.t_s.len();
        let wanted = ((RATE * (last - first)) as usize).clamp(2, MOST_FRAMES);
        let stride = rows.div_ceil(wanted).max(1);
        let of_joint = |joint: &JointData| {
            let own = motion.q.iter().find(|(name, _)| *name == joint.name);
            own.map(|(_, positions)| *positions).filter(|positions| positions.len() == rows)
        };
        let columns: Vec<Option<&[f64]>> = self.geometry.joints.iter().map(of_joint).collect();
        let shown = || (0..rows).step_by(stride);
        let row = |at: usize| {
            let joints = self.geometry.joints.iter().zip(&columns);
            joints.map(move |(joint, own)| own.map_or(joint.start, |own| own[at]))
        };
        let brief = |value: f64| with_decimals(value, DECIMALS);
        let data = Data {
            geometry: &self.geometry,
            t: shown().map(|at| brief(motion.t_s[at])).collect(),
            q: shown().flat_map(row).map(brief).collect(),
            events: [],
        };
        let scene = Scene { name, caption, marks, has_time: true, ..Scene::default() };
        (last > first).then(|| scene.shown(&data))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_plants::shipped;

    #[test]
    fn marks_of_several_effects_stand_beside_each_other() {
        let text = shipped::find("puma560").expect("shipped").text;
        let robot = denavit_codegen::model::read("puma560", text.as_bytes()).expect("a model");
        let scene = JointedRobot::new(&robot).expect("numbers");
        let scene = scene.marking(&["elbow"], false).marking(&["waist"], false);
        let scene = scene.marking(&["shoulder"], true);
        let links = scene.geometry.links.iter();
        let marked = links.map(|link| (link.name.as_str(), link.is_joint_marked, link.is_marked));
        let marked: Vec<_> = marked.filter(|(_, joint, body)| *joint || *body).collect();
        let expected = [("waist", true, false), ("shoulder", false, true), ("elbow", true, false)];
        assert_eq!(marked, expected);
    }
}
