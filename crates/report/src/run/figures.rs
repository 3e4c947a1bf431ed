//! Stick figures: a robot at some of the times of a run, side by side (thesis figure 2.5).

use super::super::camera::{Camera, Vec2};
use super::super::outline::hull;
use super::super::space::{Transform, Vec3, norm, scale, sub};
use super::super::svg::Svg;
use super::COLOURS;
use super::axes::TICK;
use denavit_plants::{Plant, PlantModel};

/// A robot at one time.
struct Figure {
    t_s: f64,
    /// Lines between joints, each with the number of its leg, and the points that they join.
    bars: Vec<([Vec3; 2], Option<usize>)>,
    joints: Vec<Vec3>,
    /// Contact points of a link, with its joint.
    feet: Vec<Vec<Vec3>>,
    center: Vec3,
    /// What is seen in the middle: the centre of mass of a robot that moves about, the origin of
    /// one that is fixed.
    middle: Vec3,
}

impl Figure {
    fn of(plant: &mut dyn Plant, t_s: f64, q: &[f64]) -> Self {
        let links = plant.model().links.len();
        let mut rows = vec![0.0; 12 * links];
        plant.link_transforms(q, &mut rows);
        let frames: Vec<Transform> = rows.chunks_exact(12).map(Transform::from_rows).collect();
        let center = plant.center_of_mass(q);
        let model = plant.model();
        let first = generated(model);
        let middle = if first > 0 { center } else { [0.0; 3] };
        let mut figure =
            Self { t_s, bars: Vec::new(), joints: Vec::new(), feet: Vec::new(), center, middle };
        let legs = legs(model);
        let roots = model.parents.iter().filter(|parent| parent.is_none()).count();
        for (link, frame) in frames.iter().enumerate().skip(first) {
            let carrier = model.parents[link].map_or([0.0; 3], |parent| frames[parent].origin);
            // bodies beside each other hang on nothing
            let stands_alone = model.parents[link].is_none() && roots > 1;
            if norm(sub(frame.origin, carrier)) > 1e-6 && !stands_alone {
                figure.bars.push(([carrier, frame.origin], legs[link]));
                figure.joints.push(carrier);
            }
            figure.joints.push(frame.origin);
        }
        for point in &model.fall_points {
            let frame = &frames[point.link];
            let tip = frame.point(point.position);
            if norm(sub(tip, frame.origin)) > 1e-6 {
                figure.bars.push(([frame.origin, tip], legs[point.link]));
            }
        }
        for link in 0..links {
            let own = model.contacts.iter().filter(|contact| contact.link == link);
            let mut foot: Vec<Vec3> =
                own.map(|contact| frames[link].point(contact.position)).collect();
            if foot.len() > 1 {
                // a body without joints is drawn about its own frame
                let carrier = model.parents[link].filter(|_| link >= first);
                foot.push(frames[carrier.unwrap_or(link)].origin);
            }
            if !foot.is_empty() && model.gravity != [0.0; 3] {
                figure.feet.push(foot);
            }
        }
        figure
    }

    /// Where a point is seen: sideways from the middle, downwards from the origin.
    fn seen(&self, camera: &Camera, point: Vec3) -> Vec2 {
        let ([x, y], [middle, _]) = (camera.turn(point), camera.turn(self.middle));
        [x - middle, y]
    }

    fn points(&self) -> impl Iterator<Item = Vec3> + '_ {
        let bars = self.bars.iter().flat_map(|(bar, _)| bar);
        bars.chain(&self.joints).chain(self.feet.iter().flatten()).copied()
    }
}

/// For each link the leg that it alone belongs to, by the number of its foot.
fn legs(model: &PlantModel) -> Vec<Option<usize>> {
    let mut owners: Vec<Vec<usize>> = vec![Vec::new(); model.links.len()];
    for (foot, link) in feet(model).into_iter().enumerate() {
        let mut next = Some(link);
        while let Some(link) = next {
            owners[link].push(foot);
            next = model.parents[link];
        }
    }
    let several = feet(model).len() > 1;
    owners
        .iter()
        .map(|own| if several && own.len() == 1 { own.first().copied() } else { None })
        .collect()
}

/// The links with contact points, in the order of these.
pub(super) fn feet(model: &PlantModel) -> Vec<usize> {
    let mut feet = Vec::new();
    for contact in &model.contacts {
        if !feet.contains(&contact.link) {
            feet.push(contact.link);
        }
    }
    feet
}

/// Whether contacts are with a ground: without weight they are between bodies.
pub(super) fn has_ground(model: &PlantModel) -> bool {
    norm(model.gravity) > 0.0
}

/// How many links of a floating base were generated; all but the last are its virtual chain.
pub(super) fn generated(model: &PlantModel) -> usize {
    model.joints.iter().take_while(|joint| !joint.drivable).count()
}

/// The strip of figures.
pub(super) struct Strip {
    figures: Vec<Figure>,
    /// Where it is seen from, of a motion in a plane.
    eye: Option<Vec3>,
    up: Vec3,
    ground: Option<Vec3>,
}

/// Room for one figure at least, and at most so many [px].
const LEAST_CELL: f64 = 72.0;
/// Room below the figures for their times [px].
const CAPTION: f64 = 26.0;
/// One figure shows no motion.
const LEAST_FIGURES: usize = 3;
const MOST_FIGURES: usize = 10;

impl Strip {
    /// Figures at even times from the first to the last row, as many as fit into a rectangle; each
    /// row is a time and joint positions.
    pub(super) fn new(plant: &mut dyn Plant, rows: &[(f64, Vec<f64>)], size: Vec2) -> Self {
        let few = Self::with(plant, rows, 4);
        let Some([low, high, half]) = few.extent(&few.camera()) else { return few };
        let tall = (size[1] - CAPTION).min(size[0] * (high - low).max(1e-6) / (2.0 * half));
        let cell = (2.3 * half * tall / (high - low).max(1e-6)).max(LEAST_CELL);
        let count = ((size[0] / cell) as usize).clamp(LEAST_FIGURES, MOST_FIGURES);
        Self::with(plant, rows, count)
    }

    fn with(plant: &mut dyn Plant, rows: &[(f64, Vec<f64>)], count: usize) -> Self {
        let count = count.min(rows.len()).max(1);
        let picked = (0..count).filter_map(|index| {
            let row = index as f64 / (count - 1).max(1) as f64 * (rows.len().max(1) - 1) as f64;
            rows.get(row.round() as usize)
        });
        let figures: Vec<Figure> = picked.map(|(t_s, q)| Figure::of(plant, *t_s, q)).collect();
        let model = plant.model();
        let size = norm(model.gravity);
        let normal = model.ground.normal;
        let up = if size > 0.0 { scale(model.gravity, -1.0 / size) } else { normal };
        let stands = !model.contacts.is_empty() && size > 0.0;
        let points: Vec<Vec3> = figures.iter().flat_map(Figure::points).collect();
        let is_flat =
            |axis: usize| points.iter().all(|point| (point[axis] - points[0][axis]).abs() < 1e-9);
        let eyes = [(1, [0.0, -1.0, 0.0]), (2, [0.0, 0.0, 1.0]), (0, [1.0, 0.0, 0.0])];
        let eye = eyes.into_iter().find(|(axis, _)| is_flat(*axis) && up[*axis].abs() < 1e-9);
        let eye = eye.map(|(_, eye)| eye);
        let ground = stands.then_some(model.ground.point);
        Self { figures, eye, up, ground }
    }

    /// Draws the strip into a rectangle.
    pub(super) fn draw(&self, svg: &mut Svg, corner: Vec2, size: Vec2) {
        let cell = size[0] / self.figures.len().max(1) as f64;
        let camera = self.camera();
        let Some([low, high, half]) = self.extent(&camera) else { return };
        let tall = size[1] - CAPTION;
        let factor = (tall / (high - low).max(1e-6)).min(0.46 * cell / half);
        let base = corner[1] + 0.5 * (tall + factor * (high - low));
        if let Some(ground) = self.ground.filter(|_| self.eye.is_some()) {
            let y = base - factor * (high - camera.turn(ground)[1]);
            let ends = [[corner[0], y], [corner[0] + size[0], y]];
            svg.line(&ends, "stroke=\"#b9b3a6\" stroke-width=\"1.4\"");
        }
        for (index, figure) in self.figures.iter().enumerate() {
            let middle = corner[0] + (index as f64 + 0.5) * cell;
            let place = |point: Vec3| {
                let [x, y] = figure.seen(&camera, point);
                [middle + factor * x, base - factor * (high - y)]
            };
            figure.draw(svg, &place);
            let text = format!("{:.2} s", figure.t_s);
            svg.label([middle, corner[1] + size[1] - 4.0], "middle", TICK, &text);
        }
    }

    /// Highest, lowest and outermost point that is seen, per metre and downwards.
    fn extent(&self, camera: &Camera) -> Option<[f64; 3]> {
        let (mut low, mut high, mut half) = (f64::INFINITY, f64::NEG_INFINITY, 1e-6_f64);
        for figure in &self.figures {
            for [x, y] in figure.points().map(|point| figure.seen(camera, point)) {
                (low, high, half) = (low.min(y), high.max(y), half.max(x.abs()));
            }
        }
        (low <= high).then_some([low, high, half])
    }

    fn camera(&self) -> Camera {
        if let Some(eye) = self.eye {
            return Camera::from_eye(eye, self.up);
        }
        let points: Vec<Vec3> = self.figures.iter().flat_map(Figure::points).collect();
        Camera::new(&points, self.up, None, [1e3, 1e3])
    }
}

impl Figure {
    fn draw(&self, svg: &mut Svg, place: &dyn Fn(Vec3) -> Vec2) {
        for foot in &self.feet {
            let points: Vec<Vec2> = foot.iter().map(|&point| place(point)).collect();
            match points.len() {
                1 => svg.circle(points[0], 5.0, "fill=\"#c3cad4\" stroke=\"#5a6472\""),
                2 => svg.line(&points, "stroke=\"#5a6472\" stroke-width=\"3\""),
                _ => svg.polygon(
                    &hull(points),
                    "fill=\"#c3cad4\" fill-opacity=\"0.7\" stroke=\"#8791a0\" stroke-width=\"1\"",
                ),
            }
        }
        for ([from, to], leg) in &self.bars {
            let colour = leg.and_then(|leg| COLOURS.get(leg)).unwrap_or(&"#39424e");
            let style = format!("stroke=\"{colour}\" stroke-width=\"2.6\"");
            svg.line(&[place(*from), place(*to)], &style);
        }
        for joint in &self.joints {
            let style = "fill=\"#ffffff\" stroke=\"#39424e\" stroke-width=\"1.2\"";
            svg.circle(place(*joint), 2.4, style);
        }
        svg.circle(place(self.center), 3.2, "fill=\"#d9730d\"");
    }
}
