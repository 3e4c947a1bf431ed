//! A robot whose joints a page moves: by sliders, or along the positions of a log. The page has the
//! rows of the table as transforms at zero; the joints turn about, or slide along, their z axes.

mod geometry;

use super::html::{Brief, Replay, Scene, SceneMark, with_decimals, with_digits};
use super::pose::Pose;
use super::shapes::Looks;
use denavit_codegen::model::Robot;
use denavit_codegen::program::LowerError;
use denavit_workflow::Shapes;
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
#[derive(Clone, Debug, Default)]
pub(crate) struct JointMotion<'a> {
    /// Times \[s\].
    pub(crate) t_s: &'a [f64],
    /// For each joint its name and its positions; others stay where they are.
    pub(crate) q: Vec<(&'a str, &'a [f64])>,
    /// Another motion of the same times.
    pub(crate) beside: Option<Vec<(&'a str, &'a [f64])>>,
    /// What two models leave of the torques of joints at the same times.
    pub(crate) left: Vec<(&'a str, [&'a [f64]; 2])>,
}

/// What two models leave of torques, frame after frame, with what the longest signs stand for.
#[derive(Serialize)]
struct LeftData {
    full_nm: f64,
    full_n: f64,
    before: Vec<Brief>,
    after: Vec<Brief>,
}

/// What the script draws.
#[derive(Serialize)]
struct Data<'a> {
    #[serde(flatten)]
    geometry: &'a Geometry,
    t: Vec<Brief>,
    /// Positions of all joints, frame after frame.
    q: Vec<Brief>,
    /// The same of another motion.
    beside: Option<Vec<Brief>>,
    left: Option<LeftData>,
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

    /// The same with the shapes of a description, and what is to be known of these.
    pub(crate) fn looking(mut self, shapes: &Shapes) -> (Self, Vec<String>) {
        let links = &self.geometry.links;
        let number = |name: &str| {
            let place = links.iter().position(|link| link.name == name);
            place.and_then(|place| i64::try_from(place).ok())
        };
        let looks = Looks::new(shapes, &number);
        self.geometry.shapes = looks.shapes;
        self.geometry.shapes_whole = looks.is_whole;
        (self, looks.remarks)
    }

    /// With a slider for each joint, and the frames of its links.
    pub(crate) fn with_sliders(mut self, [name, caption]: [String; 2]) -> Replay {
        self.geometry.frames = true;
        let sliders = self.geometry.joints.iter().filter(|joint| joint.is_shown);
        let has_shapes = !self.geometry.shapes.is_empty();
        let shapes = has_shapes.then(SceneMark::shapes).into_iter();
        let marks = [SceneMark::frames(), SceneMark::center_of_mass()];
        let scene = Scene {
            name,
            caption,
            marks: shapes.chain(marks).collect(),
            sliders: sliders.map(JointData::slider).collect(),
            ..Scene::default()
        };
        let (t, q, beside, left) = (vec![], vec![], None, None);
        scene.shown(&Data { geometry: &self.geometry, t, q, beside, left, events: [] })
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
        let shown: Vec<usize> = (0..rows).step_by(stride).collect();
        let data = Data {
            geometry: &self.geometry,
            t: shown.iter().map(|&at| brief(motion.t_s[at])).collect(),
            q: self.positions(&motion.q, rows, &shown),
            beside: motion.beside.as_ref().map(|q| self.positions(q, rows, &shown)),
            left: self.left(motion, &shown),
            events: [],
        };
        let scene = Scene { name, caption, marks, has_time: true, ..Scene::default() };
        (last > first).then(|| scene.shown(&data))
    }

    /// Positions of all joints in some rows.
    fn positions(&self, q: &[(&str, &[f64])], rows: usize, shown: &[usize]) -> Vec<Brief> {
        let of_joint = |joint: &JointData| {
            let own = q.iter().find(|(name, _)| *name == joint.name);
            own.map(|(_, positions)| *positions).filter(|positions| positions.len() == rows)
        };
        let columns: Vec<Option<&[f64]>> = self.geometry.joints.iter().map(of_joint).collect();
        let row = |at: usize| {
            let joints = self.geometry.joints.iter().zip(&columns);
            joints.map(move |(joint, own)| own.map_or(joint.start, |own| own[at]))
        };
        shown.iter().flat_map(|&at| row(at)).map(brief).collect()
    }

    /// What the longest signs of a motion stand for [N m, N]: the most that is left of any joint.
    pub(crate) fn most_left(&self, motion: &JointMotion<'_>) -> [f64; 2] {
        let most = |slides: bool| {
            let own = self.geometry.joints.iter().filter(|joint| joint.slides == slides);
            let left = own.filter_map(|joint| left_of(motion, joint));
            let all = left.flatten().flatten().copied().filter(|value| value.is_finite());
            all.fold(0.0, |most: f64, value| most.max(value.abs()))
        };
        [most(false), most(true)]
    }

    fn left(&self, motion: &JointMotion<'_>, shown: &[usize]) -> Option<LeftData> {
        let [full_nm, full_n] = self.most_left(motion);
        if full_nm.max(full_n) == 0.0 {
            return None;
        }
        let columns: Vec<_> =
            self.geometry.joints.iter().map(|joint| left_of(motion, joint)).collect();
        let of = |which: usize| {
            let row = |&at: &usize| {
                let values = columns.iter().map(move |own| own.map(|own| own[which][at]));
                values.map(|value| with_digits(value.unwrap_or(f64::NAN))).collect::<Vec<_>>()
            };
            shown.iter().flat_map(row).collect()
        };
        // of joints of one kind alone the other has no largest
        let [full_nm, full_n] =
            [full_nm, full_n].map(|most| if most > 0.0 { most } else { f64::MAX });
        Some(LeftData { full_nm, full_n, before: of(0), after: of(1) })
    }
}

fn brief(value: f64) -> Brief {
    with_decimals(value, DECIMALS)
}

/// What models leave of the torque of a joint, if that is known in every row.
fn left_of<'a>(motion: &JointMotion<'a>, joint: &JointData) -> Option<[&'a [f64]; 2]> {
    let own = motion.left.iter().find(|(name, _)| *name == joint.name);
    let rows = motion.t_s.len();
    own.map(|(_, both)| *both).filter(|both| both.iter().all(|left| left.len() == rows))
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
