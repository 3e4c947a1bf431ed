//! The links of a robot as a page needs them to move them.

use crate::html::Slider;
use crate::outline::round_step;
use crate::pose::Pose;
use crate::quaternion::pose_of;
use crate::shapes::SceneShape;
use crate::space::{Transform, Vec3, extent, scale, sub};
use crate::values::Values;
use denavit_codegen::arena::Handle;
use denavit_codegen::model::{Base, Convention, JointKind, LinkId, Robot};
use serde::Serialize;
use std::f64::consts::PI;

/// What does not change when joints move.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Geometry {
    up: Vec3,
    base: Vec3,
    /// Whether a frame stands on the axis of its own joint.
    is_modified: bool,
    pub(super) links: Vec<LinkData>,
    pub(super) joints: Vec<JointData>,
    /// Whether frames of links are drawn.
    pub(super) frames: bool,
    tips: Vec<PointData>,
    feet: Vec<FootData>,
    contacts: Vec<PointData>,
    ground: Option<[Vec3; 2]>,
    grid_m: f64,
    size: f64,
    reach: f64,
    center: Vec3,
    follows: bool,
    eye: Option<Vec3>,
    /// The axis of all joints, where they are parallel: from there they are seen to turn.
    look: Option<Vec3>,
    /// Shapes of links in place of its rows.
    pub(super) shapes: Vec<SceneShape>,
    /// Whether nothing of it is missing.
    pub(super) shapes_whole: bool,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LinkData {
    pub(super) name: String,
    /// What is said of it when it is pointed at.
    pub(super) text: String,
    carrier: i64,
    slides: bool,
    is_joint: bool,
    is_body: bool,
    pub(super) is_marked: bool,
    pub(super) is_joint_marked: bool,
    /// Place and quaternion in the frame of its carrier where its joint is at zero.
    zero: [f64; 7],
    /// The number of its joint; -1 of what does not move.
    joint: i64,
    mass: f64,
    com: Vec3,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct JointData {
    pub(super) name: String,
    pub(super) slides: bool,
    low: f64,
    high: f64,
    pub(super) start: f64,
    /// Whether it is one of the file, and not of a floating base.
    pub(super) is_shown: bool,
}

#[derive(Clone, Debug, Serialize)]
struct PointData {
    link: usize,
    at: Vec3,
}

#[derive(Clone, Debug, Serialize)]
struct FootData {
    link: usize,
    carrier: i64,
    points: Vec<Vec3>,
}

impl JointData {
    pub(super) fn slider(&self) -> Slider {
        let unit = if self.slides { "m" } else { "rad" };
        let Self { name, low, high, start, .. } = self;
        Slider { name: name.clone(), unit, low: *low, high: *high, start: *start }
    }
}

impl Geometry {
    pub(super) fn new(robot: &Robot, pose: &Pose) -> Self {
        let mut values = Values::new(robot);
        let (size, center) = size_and_middle(pose);
        let is_walker = !robot.contacts.is_empty() && robot.base != Base::Fixed;
        let point = |link: LinkId, at: Vec3| PointData { link: link.index(), at };
        let local = |contact: &denavit_codegen::model::Contact, at: Vec3| {
            point(contact.link, inverse(&pose.frames[contact.link.index()], at))
        };
        let contacts: Vec<PointData> =
            robot.contacts.values().zip(&pose.contacts).map(|(one, at)| local(one, *at)).collect();
        Self {
            up: pose.up,
            base: [0.0; 3],
            is_modified: robot.convention == Convention::Modified,
            links: links(robot, pose, &mut values),
            joints: joints(robot, pose, &mut values, size),
            frames: false,
            tips: tips(robot, &mut values),
            feet: if is_walker { feet(robot, &contacts) } else { Vec::new() },
            contacts,
            ground: is_walker.then_some(pose.ground),
            grid_m: round_step(size / 4.0),
            size,
            reach: 0.0,
            center,
            follows: false,
            look: common_axis(robot, pose),
            shapes: Vec::new(),
            shapes_whole: false,
            eye: (robot.base == Base::PlanarFloating).then_some([0.12, -1.0, 0.12]),
        }
    }
}

/// The axis of all joints that turn; none where they are not parallel, or upright.
fn common_axis(robot: &Robot, pose: &Pose) -> Option<Vec3> {
    let axis = |id: LinkId| {
        let link = &robot.links[id];
        let seat = match robot.convention {
            Convention::Modified => Some(id),
            Convention::Standard => link.parent,
        };
        seat.map_or(Transform::IDENTITY.axes[2], |seat| pose.frames[seat.index()].axes[2])
    };
    let turning = robot.joints().map(|(id, _)| id);
    let turning = turning.filter(|id| robot.links[*id].joint.kind == JointKind::Revolute);
    let mut axes = turning.map(axis);
    let first = axes.next()?;
    let along = |a: Vec3, b: Vec3| crate::space::dot(a, b).abs();
    let is_common = axes.all(|axis| along(first, axis) > 0.999) && along(first, pose.up) < 0.9;
    (is_common && robot.base == Base::Fixed).then_some(first)
}

fn number(link: Option<LinkId>) -> i64 {
    link.and_then(|link| i64::try_from(link.index()).ok()).unwrap_or(-1)
}

fn links(robot: &Robot, pose: &Pose, values: &mut Values) -> Vec<LinkData> {
    let generated = robot.base.generated_joints();
    let at = |link: LinkId| pose.frames[link.index()];
    let mut moving = 0;
    let mut all = Vec::new();
    for (id, link) in robot.links.iter() {
        let carrier = link.parent.map_or(Transform::IDENTITY, at);
        let moves = link.joint.kind != JointKind::Fixed;
        let lift = if moves { pose.q.get(moving).copied().unwrap_or(0.0) } else { 0.0 };
        let is_modified = robot.convention == Convention::Modified;
        let frame = at(id);
        // a base that is lifted is so by its joint
        let along = if is_modified { frame.axes[2] } else { carrier.axes[2] };
        let lifted = if link.joint.kind == JointKind::Prismatic { lift } else { 0.0 };
        let origin = sub(frame.origin, scale(along, lifted));
        let body = link.body.as_ref();
        let mass = body.and_then(|body| values.number(body.mass)).unwrap_or(0.0);
        let com = body.map(|body| body.com.map(|entry| values.number(entry).unwrap_or(0.0)));
        all.push(LinkData {
            name: link.name.clone(),
            text: String::new(),
            carrier: number(link.parent),
            slides: link.joint.kind == JointKind::Prismatic,
            is_joint: moves && id.index() >= generated,
            is_body: id.index() >= generated,
            is_marked: false,
            is_joint_marked: false,
            zero: pose_of(&relative(&carrier, &Transform { origin, ..frame })),
            joint: if moves { i64::try_from(moving).unwrap_or(-1) } else { -1 },
            mass,
            com: com.unwrap_or([0.0; 3]),
        });
        moving += usize::from(moves);
    }
    all
}

fn joints(robot: &Robot, pose: &Pose, values: &mut Values, size: f64) -> Vec<JointData> {
    let generated = robot.base.generated_joints();
    let mut all = Vec::new();
    for (place, (id, _)) in robot.joints().enumerate() {
        let link = &robot.links[id];
        let slides = link.joint.kind == JointKind::Prismatic;
        let open = if slides { [-0.5 * size, 0.5 * size] } else { [-PI, PI] };
        let given = link.limits.position.map(|ends| ends.map(|end| values.number(end)));
        let [low, high] = match given {
            Some([Some(low), Some(high)]) if low < high => [low, high],
            _ => open,
        };
        let start = pose.q.get(place).copied().unwrap_or(0.0);
        let is_shown = place >= generated;
        let start = if is_shown { start.clamp(low, high) } else { start };
        all.push(JointData { name: link.name.clone(), slides, low, high, start, is_shown });
    }
    all
}

/// Ends of bodies that must not touch the ground.
fn tips(robot: &Robot, values: &mut Values) -> Vec<PointData> {
    let mut all = Vec::new();
    for body in &robot.bodies_that_must_not_touch {
        for end in &body.ends {
            let at = end.map(|entry| values.number(entry).unwrap_or(0.0));
            all.push(PointData { link: body.link.index(), at });
        }
    }
    all
}

fn feet(robot: &Robot, contacts: &[PointData]) -> Vec<FootData> {
    let foot = |(id, link): (LinkId, &denavit_codegen::model::Link)| {
        let own = contacts.iter().filter(|point| point.link == id.index());
        let points: Vec<Vec3> = own.map(|point| point.at).collect();
        let foot = FootData { link: id.index(), carrier: number(link.parent), points };
        (!foot.points.is_empty()).then_some(foot)
    };
    robot.links.iter().filter_map(foot).collect()
}

/// A frame seen from another one.
fn relative(from: &Transform, to: &Transform) -> Transform {
    let turned = |v: Vec3| from.axes.map(|axis| crate::space::dot(axis, v));
    Transform { axes: to.axes.map(turned), origin: inverse(from, to.origin) }
}

/// A point in the coordinates of a frame.
fn inverse(frame: &Transform, point: Vec3) -> Vec3 {
    let away = sub(point, frame.origin);
    frame.axes.map(|axis| crate::space::dot(axis, away))
}

/// Size and middle of the robot.
fn size_and_middle(pose: &Pose) -> (f64, Vec3) {
    let mut points = vec![[0.0; 3]];
    points.extend(pose.frames.iter().map(|frame| frame.origin));
    points.extend(&pose.contacts);
    if pose.is_lifted {
        points.remove(0);
    }
    extent(&points)
}
