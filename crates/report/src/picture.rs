//! A robot drawn with the frames of its links, as the thesis draws it in figures 2.2, 2.3 and 4.1.

use super::camera::{Camera, Vec2};
use super::label::{LETTER, Labels};
use super::outline::{CIRCLE, hull, rectangle, round_step};
use super::pose::Pose;
use super::scene::{JOINT, Scene, Shape};
use super::space::{Vec3, add, cross, dot, perpendicular, scale, sub};
use super::svg::{Svg, number};
use super::values::Values;
use denavit_codegen::model::Robot;
use denavit_numerics::short;

/// The largest room that the robot itself has [px].
const ROOM: Vec2 = [680.0, 640.0];

/// Left, top, right and bottom of it: room for names, title and legend [px].
const MARGINS: [f64; 4] = [120.0, 92.0, 120.0, 78.0];

/// Least width of the picture, for title and legend [px].
const LEAST_WIDTH: f64 = 660.0;

/// Colours of the axes x, y, z.
const AXIS_COLOURS: [&str; 3] = ["#d62728", "#2a9134", "#1f5fd0"];

/// Style of the words that are no names.
const SMALL: &str = "font-size=\"12.5\" fill=\"#555\"";

/// SVG of the robot in a pose: links as bars, joints as cylinders (revolute) and blocks
/// (prismatic) about their axes, link frames with x red, y green, z blue, contact points, ground
/// and centre of mass. The same robot gives the same bytes.
pub fn picture(robot: &Robot, pose: &Pose) -> String {
    let scene = Scene::new(robot, pose);
    let mut camera = Camera::new(&scene.extent, pose.up, scene.axis, ROOM);
    let [_, [wide, tall]] = camera.bounds(&scene.extent).map(|corner| corner.map(in_room));
    let [left, top, right, bottom] = MARGINS;
    let size = [(left + wide + right).max(LEAST_WIDTH), top + tall + bottom];
    camera.shift([(size[0] - wide) / 2.0, top]);
    let mut drawing = Drawing {
        svg: Svg::new(size, &format!("{} at its zero pose", robot.name)),
        labels: Labels::new(size),
        camera,
        size,
        scene: &scene,
    };
    if !pose.contacts.is_empty() {
        drawing.ground(pose);
    }
    drawing.feet();
    drawing.shapes();
    drawing.points(pose);
    drawing.corners(robot, pose);
    drawing.names(robot, pose);
    drawing.svg.finish()
}

/// A length of the picture, whatever the robot's numbers are.
fn in_room(length: f64) -> f64 {
    if length.is_finite() { length.clamp(0.0, ROOM[0].max(ROOM[1])) } else { 0.0 }
}

struct Drawing<'a> {
    svg: Svg,
    labels: Labels,
    camera: Camera,
    /// Width and height of the picture [px].
    size: Vec2,
    scene: &'a Scene,
}

impl Drawing<'_> {
    fn place(&self, point: Vec3) -> Vec2 {
        self.camera.place(point)
    }

    /// Pixels of a length given per size of the robot.
    fn pixels(&self, part: f64) -> f64 {
        part * self.scene.size * self.camera.scale
    }

    /// A grid on the ground, about the robot.
    fn ground(&mut self, pose: &Pose) {
        let [point, normal] = pose.ground;
        let first = perpendicular(normal);
        let second = cross(normal, first);
        let step = round_step(self.scene.size / 9.0);
        let seats = self.scene.extent.iter().map(|&p| sub(p, point));
        let ends = |axis: Vec3| {
            let shares = seats.clone().map(|p| dot(p, axis) / step);
            let low = shares.clone().fold(f64::INFINITY, f64::min).floor() - 1.0;
            let high = shares.fold(f64::NEG_INFINITY, f64::max).ceil() + 1.0;
            [low.clamp(-60.0, 60.0) as i32, high.clamp(-60.0, 60.0) as i32]
        };
        let ([a_low, a_high], [b_low, b_high]) = (ends(first), ends(second));
        let at = |a: i32, b: i32| {
            let shift = add(scale(first, f64::from(a) * step), scale(second, f64::from(b) * step));
            self.camera.place(add(point, shift))
        };
        let corners = [at(a_low, b_low), at(a_high, b_low), at(a_high, b_high), at(a_low, b_high)];
        let lines: Vec<[Vec2; 2]> = (a_low..=a_high)
            .map(|a| [at(a, b_low), at(a, b_high)])
            .chain((b_low..=b_high).map(|b| [at(a_low, b), at(a_high, b)]))
            .collect();
        self.svg.polygon(&corners, "fill=\"#f4f2ee\"");
        for line in lines {
            self.svg.line(&line, "stroke=\"#dcd8d0\" stroke-width=\"0.8\"");
        }
    }

    fn feet(&mut self) {
        let scene = self.scene;
        for foot in &scene.feet {
            let outline = hull(foot.iter().map(|&point| self.place(point)).collect());
            self.svg.polygon(
                &outline,
                "fill=\"#c3cad4\" fill-opacity=\"0.55\" stroke=\"#8791a0\" stroke-width=\"1.2\"",
            );
        }
    }

    /// The solids, far ones first; then the frames, which are what the picture is for.
    fn shapes(&mut self) {
        let scene = self.scene;
        let mut order: Vec<(bool, f64, &Shape)> = scene
            .shapes
            .iter()
            .map(|shape| (matches!(shape, Shape::Arrow { .. }), self.nearness(shape), shape))
            .collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        for (_, _, shape) in order {
            match shape {
                Shape::Bar { from, to, is_virtual } => self.bar(*from, *to, *is_virtual),
                Shape::Cylinder { center, axis } => self.cylinder(*center, *axis),
                Shape::Block { center, axes } => self.block(*center, axes),
                Shape::Arrow { from, to, axis } => self.arrow(*from, *to, AXIS_COLOURS[*axis]),
                Shape::Plate { corners } => {
                    let corners = corners.map(|corner| self.place(corner));
                    self.svg.polygon(
                        &corners,
                        "fill=\"#d9d5cc\" stroke=\"#8d877b\" stroke-width=\"1.2\"",
                    );
                }
            }
        }
    }

    fn nearness(&self, shape: &Shape) -> f64 {
        let half = |a: &Vec3, b: &Vec3| scale(add(*a, *b), 0.5);
        let size = self.scene.size;
        let (point, bonus) = match shape {
            Shape::Bar { from, to, .. } => (half(from, to), 0.0),
            Shape::Cylinder { center, .. } | Shape::Block { center, .. } => (*center, 0.02),
            Shape::Arrow { from, to, .. } => (half(from, to), 0.0),
            Shape::Plate { corners } => (half(&corners[0], &corners[2]), -0.06),
        };
        self.camera.nearness(point) + bonus * size
    }

    fn bar(&mut self, from: Vec3, to: Vec3, is_virtual: bool) {
        let line = [self.place(from), self.place(to)];
        if is_virtual {
            let style = "stroke=\"#9aa3af\" stroke-width=\"1.4\" stroke-dasharray=\"5 5\"";
            self.svg.line(&line, style);
            return;
        }
        let width = self.pixels(0.016).clamp(3.0, 10.0);
        let (outer, inner) = (number(width), number(width - 2.4));
        self.svg.line(&line, &format!("stroke=\"#6f7884\" stroke-width=\"{outer}\""));
        self.svg.line(&line, &format!("stroke=\"#c6ccd5\" stroke-width=\"{inner}\""));
        self.labels.avoid(line[0], line[1]);
    }

    fn cylinder(&mut self, center: Vec3, axis: Vec3) {
        let [half_length, radius] = JOINT.map(|part| self.pixels(part));
        let toward = dot(axis, self.camera.eye);
        let seen = self.camera.turn(scale(axis, 1.0 / self.camera.scale));
        let length = seen[0].hypot(seen[1]);
        let along = if length > 1e-6 { seen.map(|part| part / length) } else { [1.0, 0.0] };
        let across = [-along[1], along[0]];
        let middle = self.place(center);
        let near = if toward >= 0.0 { 1.0 } else { -1.0 };
        let shift = |way: f64| {
            let part = way * near * half_length * length;
            [middle[0] + along[0] * part, middle[1] + along[1] * part]
        };
        let (front, back) = (shift(1.0), shift(-1.0));
        let flat = radius * toward.abs();
        let rim = |at: Vec2, step: usize| {
            let (sin, cos) = CIRCLE[step % CIRCLE.len()];
            [0, 1].map(|i| at[i] + across[i] * radius * cos + along[i] * flat * sin)
        };
        let cap = |at: Vec2| (0..CIRCLE.len()).map(|step| rim(at, step)).collect::<Vec<_>>();
        let body = hull([cap(front), cap(back)].concat());
        let ends = [radius, -radius].map(|r| [0, 1].map(|i| middle[i] + across[i] * r));
        let fill = self.svg.gradient(ends[0], ends[1], ["#d99a3d", "#f7cf86", "#b9761f"]);
        let outline = "stroke=\"#7a4d10\" stroke-width=\"1\"";
        self.svg.polygon(&body, &format!("fill=\"{fill}\" {outline}"));
        self.svg.polygon(&cap(front), &format!("fill=\"#f3c677\" {outline}"));
        for side in [-radius, 0.0, radius] {
            let [from, to] = [front, back].map(|at| [0, 1].map(|i| at[i] + across[i] * side));
            self.labels.avoid(from, to);
        }
    }

    fn block(&mut self, center: Vec3, axes: &[Vec3; 3]) {
        let half = [0.022, 0.022, 0.04].map(|part| part * self.scene.size);
        let corner = |signs: [f64; 3]| {
            (0..3).fold(center, |at, i| add(at, scale(axes[i], signs[i] * half[i])))
        };
        for (axis, shade) in [(0, "#9fc4a8"), (1, "#7fae8b"), (2, "#c3dfc9")] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let side = if dot(axes[axis], self.camera.eye) >= 0.0 { 1.0 } else { -1.0 };
            let face = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[a, b]| {
                let mut signs = [side; 3];
                (signs[u], signs[v]) = (a, b);
                self.camera.place(corner(signs))
            });
            let style = format!("fill=\"{shade}\" stroke=\"#3f6b4b\" stroke-width=\"1\"");
            self.svg.polygon(&face, &style);
        }
        let ends = [-1.0, 1.0].map(|way| add(center, scale(axes[2], way * half[2])));
        self.labels.avoid(self.place(ends[0]), self.place(ends[1]));
    }

    fn arrow(&mut self, from: Vec3, to: Vec3, colour: &str) {
        let (tail, tip) = (self.place(from), self.place(to));
        let way = [tip[0] - tail[0], tip[1] - tail[1]];
        let length = way[0].hypot(way[1]);
        if length < 4.0 {
            // seen from its end
            self.svg.circle(tail, 3.2, &format!("fill=\"#fff\" stroke=\"{colour}\""));
            self.svg.circle(tail, 1.2, &format!("fill=\"{colour}\""));
            return;
        }
        let way = way.map(|part| part / length);
        let head = (0.3 * length).clamp(3.5, 9.0);
        let neck = [0, 1].map(|i| tip[i] - way[i] * head);
        let side = |width: f64| [neck[0] - way[1] * width, neck[1] + way[0] * width];
        self.svg.line(&[tail, neck], &format!("stroke=\"{colour}\" stroke-width=\"2.2\""));
        let barbs = [side(0.42 * head), tip, side(-0.42 * head)];
        self.svg.polygon(&barbs, &format!("fill=\"{colour}\""));
        self.labels.avoid(tail, tip);
    }

    /// Contact points and the centre of mass, this with a plumb line where there is ground.
    fn points(&mut self, pose: &Pose) {
        for &contact in &pose.contacts {
            let place = self.place(contact);
            self.contact(place);
            self.labels.avoid(place, place);
        }
        let Some(com) = pose.center_of_mass else { return };
        let place = self.place(com);
        if !pose.contacts.is_empty() {
            let [point, normal] = pose.ground;
            let below = sub(com, scale(normal, dot(sub(com, point), normal)));
            let foot = self.place(below);
            let style = "stroke=\"#444\" stroke-width=\"1\" stroke-dasharray=\"2 4\"";
            self.svg.line(&[place, foot], style);
            self.svg.circle(foot, 2.0, "fill=\"#444\"");
        }
        self.quartered_disc(place);
        let [x, y] = place;
        self.labels.reserve([x - DISC, y - DISC, x + DISC, y + DISC]);
    }

    fn contact(&mut self, place: Vec2) {
        self.svg.circle(place, 3.6, "fill=\"#ffffff\" stroke=\"#222\" stroke-width=\"1.6\"");
    }

    /// The usual sign of a centre of mass.
    fn quartered_disc(&mut self, place: Vec2) {
        self.svg.circle(place, DISC, "fill=\"#ffffff\" stroke=\"#222\" stroke-width=\"1.2\"");
        for quarter in [0, CIRCLE.len() / 2] {
            let mut points = vec![place];
            points.extend((0..=CIRCLE.len() / 4).map(|step| {
                let (sin, cos) = CIRCLE[(quarter + step) % CIRCLE.len()];
                [place[0] + DISC * cos, place[1] + DISC * sin]
            }));
            self.svg.polygon(&points, "fill=\"#222\"");
        }
    }

    /// Title, legend and scale.
    fn corners(&mut self, robot: &Robot, pose: &Pose) {
        let title = "font-size=\"20\" font-weight=\"bold\" fill=\"#222\"";
        self.svg.label([24.0, 36.0], "start", title, &robot.name);
        let mut facts = format!("{} degrees of freedom", robot.degrees_of_freedom());
        let mut values = Values::new(robot);
        let masses: Vec<_> =
            robot.links.values().filter_map(|link| Some(link.body.as_ref()?.mass)).collect();
        if let Some(mass) = values.sum(&masses) {
            facts += &format!(", {} kg", short(mass));
        }
        facts += match pose.is_lifted {
            true => ", all joint positions 0 but the lift of the base",
            false => ", all joint positions 0",
        };
        if !pose.open.is_empty() {
            facts += &format!("; {} drawn as 0.5", pose.open.join(", "));
        }
        self.svg.label([24.0, 56.0], "start", SMALL, &facts);
        self.labels.reserve([0.0, 0.0, self.size[0], 66.0]);
        self.legend(pose);
        self.labels.reserve([0.0, self.size[1] - 34.0, self.size[0], self.size[1]]);
    }

    fn legend(&mut self, pose: &Pose) {
        let y = self.size[1] - 22.0;
        let mut x = 24.0;
        for (colour, name) in AXIS_COLOURS.into_iter().zip(["x", "y", "z"]) {
            let style = format!("stroke=\"{colour}\" stroke-width=\"2.6\"");
            self.svg.line(&[[x, y], [x + 18.0, y]], &style);
            self.svg.label([x + 24.0, y + 4.0], "start", SMALL, name);
            x += 44.0;
        }
        x += 10.0;
        if self.scene.shapes.iter().any(|shape| matches!(shape, Shape::Cylinder { .. })) {
            let style = "fill=\"#eab860\" stroke=\"#7a4d10\" stroke-width=\"1\"";
            self.svg.polygon(&rectangle([x + 6.0, y], [8.0, 5.0]), style);
            x = self.entry(x, y, "revolute");
        }
        if self.scene.shapes.iter().any(|shape| matches!(shape, Shape::Block { .. })) {
            let style = "fill=\"#9fc4a8\" stroke=\"#3f6b4b\" stroke-width=\"1\"";
            self.svg.polygon(&rectangle([x + 6.0, y], [8.0, 5.0]), style);
            x = self.entry(x, y, "prismatic");
        }
        if !pose.contacts.is_empty() {
            self.contact([x + 9.0, y]);
            x = self.entry(x, y, "contact");
        }
        if pose.center_of_mass.is_some() {
            self.quartered_disc([x + 7.0, y]);
            self.entry(x, y, "centre of mass");
        }
        self.scale_bar(y);
    }

    /// The words of an entry of the legend; gives where the next one begins.
    fn entry(&mut self, x: f64, y: f64, text: &str) -> f64 {
        self.svg.label([x + 20.0, y + 4.0], "start", SMALL, text);
        x + 20.0 + text.chars().count() as f64 * 6.8 + 14.0
    }

    fn scale_bar(&mut self, y: f64) {
        let length = round_step(self.scene.size / 5.0);
        let right = self.size[0] - 28.0;
        let left = right - length * self.camera.scale;
        let bar = [[left, y - 4.0], [left, y + 2.0], [right, y + 2.0], [right, y - 4.0]];
        self.svg.line(&bar, "stroke=\"#444\" stroke-width=\"1.4\"");
        let text = format!("{} m", short(length));
        self.svg.label([left - 8.0, y + 4.0], "end", SMALL, &text);
    }

    fn names(&mut self, robot: &Robot, pose: &Pose) {
        let scene = self.scene;
        for frame in &scene.frames {
            let place = self.place(frame.point);
            self.labels.place(&frame.name, place);
        }
        let named = self.labels.placed.len();
        for (contact, &point) in robot.contacts.values().zip(&pose.contacts) {
            let place = self.place(point);
            self.labels.place(&contact.name, place);
        }
        for (index, label) in self.labels.placed.iter().enumerate() {
            let [x, y] = label.place;
            if label.is_far {
                let width = label.text.chars().count() as f64 * LETTER[0];
                let end = [label.point[0].clamp(x - 1.0, x + width + 1.0), y];
                self.svg.line(&[label.point, end], "stroke=\"#b5b5b5\" stroke-width=\"0.8\"");
            }
            let colour = if index < named { "#1c2733" } else { "#6b6257" };
            let style = format!(
                "font-size=\"11.5\" fill=\"{colour}\" stroke=\"#fff\" stroke-width=\"2.5\" \
                 paint-order=\"stroke\""
            );
            self.svg.label([x, y + 4.0], "start", &style, &label.text);
        }
    }
}

/// Radius of the sign of the centre of mass [px].
const DISC: f64 = 7.0;
