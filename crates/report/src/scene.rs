//! A robot as simple solids in space: bars for links, cylinders and blocks for joints, arrows for
//! frames.

use super::pose::Pose;
use super::space::{Transform, Vec3, add, dot, norm, scale, sub};
use denavit_codegen::arena::Handle;
use denavit_codegen::model::{Base, Convention, JointKind, LinkId, Robot};

/// A solid, or a part of a line.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// A straight piece of a link, or of the virtual chain of a floating base.
    Bar { from: Vec3, to: Vec3, is_virtual: bool },
    /// A revolute joint.
    Cylinder { center: Vec3, axis: Vec3 },
    /// A prismatic joint.
    Block { center: Vec3, axes: [Vec3; 3] },
    /// An axis of a frame: 0, 1, 2 for x, y, z.
    Arrow { from: Vec3, to: Vec3, axis: usize },
    /// What a fixed robot is bolted to: a square.
    Plate { corners: [Vec3; 4] },
}

/// A point with a name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Named {
    pub(super) name: String,
    pub(super) point: Vec3,
}

/// What a picture shows, in frame 0.
#[derive(Clone, Debug)]
pub(super) struct Scene {
    /// Longest extent of the robot \[m\].
    pub(super) size: f64,
    /// The solids, in link order.
    pub(super) shapes: Vec<Shape>,
    /// The frames by name, in link order.
    pub(super) frames: Vec<Named>,
    /// For each link with contact points: its joint and the points, which outline a foot.
    pub(super) feet: Vec<Vec<Vec3>>,
    /// Every point that must be in the picture.
    pub(super) extent: Vec<Vec3>,
    /// The axis of all turning joints, where they are parallel and not upright.
    pub(super) axis: Option<Vec3>,
}

/// Half the length of a joint's cylinder, and its radius, per size of the robot.
pub(super) const JOINT: [f64; 2] = [0.032, 0.02];

/// Length of the axes of a frame, per size of the robot.
const AXIS: f64 = 0.105;

/// Coincident frames are drawn shorter and shorter by this factor.
const NESTED: f64 = 0.72;

impl Scene {
    pub(super) fn new(robot: &Robot, pose: &Pose) -> Self {
        let mut points = vec![[0.0; 3]];
        points.extend(pose.frames.iter().map(|frame| frame.origin));
        points.extend(&pose.contacts);
        let size = extent(&points);
        points.extend(pose.center_of_mass);
        let mut scene = Self {
            size,
            shapes: Vec::new(),
            frames: Vec::new(),
            feet: Vec::new(),
            extent: points,
            axis: None,
        };
        let generated = generated_links(robot);
        scene.links(robot, pose, generated);
        scene.axis = scene.common_axis(pose.up);
        scene.frames(robot, pose, generated);
        scene.feet(robot, pose);
        if robot.base == Base::Fixed && robot.contacts.is_empty() {
            scene.plate();
        }
        scene
    }

    fn links(&mut self, robot: &Robot, pose: &Pose, generated: usize) {
        for (id, link) in robot.links.iter() {
            let frame = pose.frames[id.index()];
            let carrier = carrier(robot, pose, id);
            let is_virtual = id.index() < generated;
            let corner = match robot.convention {
                Convention::Standard => along(carrier.origin, carrier.axes[2], frame.origin),
                Convention::Modified => along(frame.origin, frame.axes[2], carrier.origin),
            };
            for [from, to] in [[carrier.origin, corner], [corner, frame.origin]] {
                if norm(sub(to, from)) > 1e-6 * self.size {
                    self.shapes.push(Shape::Bar { from, to, is_virtual });
                }
            }
            let seat = match robot.convention {
                Convention::Standard => carrier,
                Convention::Modified => frame,
            };
            match link.joint.kind {
                _ if is_virtual => {}
                JointKind::Revolute => {
                    let (center, axis) = (seat.origin, seat.axes[2]);
                    self.shapes.push(Shape::Cylinder { center, axis });
                }
                JointKind::Prismatic => {
                    let (center, axes) = (seat.origin, seat.axes);
                    self.shapes.push(Shape::Block { center, axes });
                }
                JointKind::Fixed => {}
            }
        }
    }

    fn common_axis(&self, up: Vec3) -> Option<Vec3> {
        let mut axes = self.shapes.iter().filter_map(|shape| match shape {
            Shape::Cylinder { axis, .. } => Some(*axis),
            _ => None,
        });
        let first = axes.next()?;
        let is_parallel = |axis: Vec3| dot(first, axis).abs() > 0.999;
        (axes.all(is_parallel) && dot(first, up).abs() < 0.9).then_some(first)
    }

    /// Frame 0 and the frames of the links; of the virtual chain the last alone.
    fn frames(&mut self, robot: &Robot, pose: &Pose, generated: usize) {
        let mut drawn: Vec<Transform> = Vec::new();
        let names = robot.links.values().map(|link| link.name.as_str()).zip(&pose.frames);
        let shown = names.skip(generated.saturating_sub(1));
        for (name, frame) in [("frame 0", &Transform::IDENTITY)].into_iter().chain(shown) {
            let near = |a: Vec3, b: Vec3| norm(sub(a, b)) < 1e-6 * self.size;
            let here = drawn.iter().filter(|other| near(other.origin, frame.origin));
            let rank = here.clone().count();
            let is_same = |other: &&Transform| {
                (0..3).all(|axis| norm(sub(other.axes[axis], frame.axes[axis])) < 1e-6)
            };
            if !here.clone().any(|other| is_same(&other)) {
                let length = AXIS * self.size * NESTED.powi(rank.min(3) as i32);
                for axis in 0..3 {
                    let to = add(frame.origin, scale(frame.axes[axis], length));
                    self.shapes.push(Shape::Arrow { from: frame.origin, to, axis });
                    self.extent.push(to);
                }
                drawn.push(*frame);
            }
            self.frames.push(Named { name: name.to_owned(), point: frame.origin });
        }
    }

    fn feet(&mut self, robot: &Robot, pose: &Pose) {
        for id in (0..robot.links.len()).map(LinkId::from_index) {
            let own = robot.contacts.iter().filter(|(_, contact)| contact.link == id);
            let mut points: Vec<Vec3> =
                own.map(|(contact, _)| pose.contacts[contact.index()]).collect();
            if !points.is_empty() {
                let joint = match robot.convention {
                    Convention::Standard => carrier(robot, pose, id).origin,
                    Convention::Modified => pose.frames[id.index()].origin,
                };
                points.push(joint);
                self.feet.push(points);
            }
        }
    }

    /// A square behind the first joint, at right angles to its axis.
    fn plate(&mut self) {
        let [half_length, _] = JOINT;
        let (half, back) = (0.075 * self.size, -1.15 * half_length * self.size);
        let corners =
            [[-half, -half, back], [half, -half, back], [half, half, back], [-half, half, back]];
        self.shapes.push(Shape::Plate { corners });
        self.extent.extend(corners);
    }
}

/// The frame that carries a link.
fn carrier(robot: &Robot, pose: &Pose, link: LinkId) -> Transform {
    let parent = robot.links[link].parent;
    parent.map_or(Transform::IDENTITY, |parent| pose.frames[parent.index()])
}

/// How many links of a floating base were generated; they come first.
fn generated_links(robot: &Robot) -> usize {
    match robot.base {
        Base::Fixed => 0,
        Base::Floating => 6,
        Base::PlanarFloating => 3,
    }
}

/// The point of the axis through `origin` that is nearest to `target`.
fn along(origin: Vec3, axis: Vec3, target: Vec3) -> Vec3 {
    add(origin, scale(axis, dot(sub(target, origin), axis)))
}

/// The longest side of the box that holds the points; 1 where there is none.
fn extent(points: &[Vec3]) -> f64 {
    let side = |axis: usize| {
        let coordinates = points.iter().map(|point| point[axis]);
        let high = coordinates.clone().fold(f64::NEG_INFINITY, f64::max);
        high - coordinates.fold(f64::INFINITY, f64::min)
    };
    let longest = (0..3).map(side).fold(0.0, f64::max);
    if longest.is_finite() && longest > 1e-9 { longest } else { 1.0 }
}
