//! A run as poses that are played back: places and turns of all links at the times of a display,
//! with what acts on them and how the robot keeps its balance.

use super::super::outline::{hull, round_step};
use super::super::quaternion::pose_of;
use super::super::space::{LEAST_SIZE_M, Transform, Vec3, add, extent, norm, scale, sub};
use super::figures::{feet, generated, has_ground};
use crate::html::{Brief, Mark, Replay, SceneMark, with_decimals};
use crate::shapes::{Looks, SceneShape};
use denavit_plants::{Plant, PlantModel};
use denavit_simulate::{Event, EventKind, Log, Run};
use denavit_walk::balance::{Instant, course_of_run};
use denavit_workflow::{LogBeside, Shapes};
use serde::Serialize;

/// Frames of a second, and of a run at least and at most.
const RATE: f64 = 30.0;
const LEAST_FRAMES: f64 = 240.0;
const MOST_FRAMES: f64 = 1500.0;
/// Decimals of a place \[m\], of a turn's quaternion, of a force \[N\], of a time \[s\].
const PLACE: usize = 5;
const TURN: usize = 4;
const FORCE: usize = 2;
const TIME: usize = 5;
/// Events that are listed, at most: a ball has no last bounce.
const MOST_EVENTS: usize = 500;
/// The radius of a ball that is a point, per size of the picture.
const BALL: f64 = 0.2;

/// What the script draws.
#[derive(Serialize)]
struct Data {
    up: Vec3,
    base: Vec3,
    t: Vec<Brief>,
    links: Vec<LinkData>,
    /// Place and quaternion (x, y, z, w) of each link, frame after frame.
    poses: Vec<Brief>,
    /// The same of a log beside the run; nothing where it has none.
    beside: Option<Vec<Brief>>,
    tips: Vec<PointData>,
    feet: Vec<FootData>,
    contacts: Vec<PointData>,
    com: Vec<Brief>,
    forces: Option<Vec<Brief>>,
    /// The force that an arrow of half the robot's size stands for \[N\].
    force_n: f64,
    zmp: Option<Vec<Brief>>,
    capture: Option<Vec<Brief>>,
    support: Option<Vec<Vec<Brief>>>,
    events: Vec<EventData>,
    ground: Option<[Vec3; 2]>,
    grid_m: f64,
    size: f64,
    /// How far the robot goes \[m\].
    reach: f64,
    center: Vec3,
    /// Whether the camera goes along.
    follows: bool,
    eye: Option<Vec3>,
    /// How much is seen; where nothing is said, the size.
    view: Option<f64>,
    /// Shapes of links in place of its rows.
    shapes: Vec<SceneShape>,
    /// Whether nothing of it is missing.
    shapes_whole: bool,
}

impl Data {
    /// Shows shapes of links: the picture holds them.
    fn show(&mut self, looks: Looks, frames: &[Frame]) {
        let frames = if self.follows { &frames[..frames.len().min(1)] } else { frames };
        let mut points: Vec<Vec3> = frames.iter().map(|frame| frame.center).collect();
        for shape in &looks.shapes {
            let (link, ends) = shape.ends();
            match link {
                None => points.extend(ends),
                Some(link) => {
                    let at = frames.iter().map(|frame| &frame.links[link]);
                    points.extend(at.flat_map(|at| ends.map(|end| at.point(end))));
                }
            }
        }
        if !looks.shapes.is_empty() {
            let [low, high] = [f64::min, f64::max].map(|of: fn(f64, f64) -> f64| {
                [0, 1, 2]
                    .map(|axis| points.iter().map(|point| point[axis]).fold(points[0][axis], of))
            });
            self.center = scale(add(low, high), 0.5);
            self.view = Some(sub(high, low).into_iter().fold(0.0, f64::max));
        }
        (self.shapes, self.shapes_whole) = (looks.shapes, looks.is_whole);
    }
}

#[derive(Serialize)]
struct LinkData {
    name: String,
    carrier: i64,
    slides: bool,
    is_joint: bool,
    is_body: bool,
    /// That of a ball that stands for itself \[m\].
    radius: Option<f64>,
}

#[derive(Serialize)]
struct PointData {
    link: usize,
    at: Vec3,
}

#[derive(Serialize)]
struct FootData {
    link: usize,
    carrier: i64,
    points: Vec<Vec3>,
}

#[derive(Serialize)]
struct EventData {
    t: f64,
    text: String,
}

/// What a page shows with a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShownWithRun<'a> {
    /// A log of the same robot.
    pub log: Option<&'a LogBeside>,
    /// What its links look like.
    pub shapes: Option<&'a Shapes>,
}

/// A run that is played back, with what a log has of the same robot, and what is to be known of
/// the shapes of its links; none of a run without positions.
pub(crate) fn replay(
    plant: &mut dyn Plant,
    run: &Run,
    with: ShownWithRun<'_>,
) -> (Option<Replay>, Vec<String>) {
    let links = &plant.model().links;
    let number = |name: &str| number(links.iter().position(|link| link == name));
    let known = |name: &str| Some(number(name)).filter(|&place| place >= 0);
    let looks = with.shapes.map(|shapes| Looks::new(shapes, &known)).unwrap_or_default();
    let remarks = looks.remarks.clone();
    (played(plant, run, with.log, looks), remarks)
}

fn played(
    plant: &mut dyn Plant,
    run: &Run,
    log: Option<&LogBeside>,
    looks: Looks,
) -> Option<Replay> {
    let model = plant.model().clone();
    let shown = displayed(&run.log)?;
    let times = shown.column("t")?;
    let positions: Option<Vec<Vec<f64>>> =
        model.joints.iter().map(|joint| shown.column(&format!("q_{}", joint.name))).collect();
    let positions = positions?;
    let row = |at: usize| positions.iter().map(|column| column[at]).collect::<Vec<f64>>();
    let frames: Vec<Frame> = (0..times.len()).map(|at| Frame::of(plant, &row(at))).collect();
    let instants = course_of_run(plant, &shown).map(|course| course.instants).unwrap_or_default();
    let (forces, force_n) = forces(&model, &shown);
    let balance = Balance::of(&model, &times, &instants);
    let mut marks = vec![Mark::CenterOfMass];
    if !instants.is_empty() {
        marks.extend([Mark::ZeroMomentPoint, Mark::CapturePoint, Mark::Support]);
    }
    marks.extend(forces.is_some().then_some(Mark::Forces));
    let beside = log.map(|log| beside(plant, log, &times));
    let events = events(&model, &run.events);
    let listed: Vec<(f64, String)> = events.iter().map(|one| (one.t, one.text.clone())).collect();
    let name = format!("{} in motion, in three dimensions", model.name);
    let count = run.log.len();
    let caption = format!(
        "{} of {count} rows of the log are shown, with straight ways between. Drag to turn, \
         scroll to come closer. Marks on the time line are events.",
        frames.len()
    );
    let forces = forces.map(|f| (f, force_n));
    let mut others: Vec<SceneMark> = Vec::new();
    others.extend((!looks.shapes.is_empty()).then(SceneMark::shapes));
    others.extend(log.map(|log| SceneMark::beside(format!("measured: {}", log.file))));
    let mut data = data(&model, &times, &frames, balance, forces, events);
    data.beside = beside;
    data.show(looks, &frames);
    Some(Replay::new([name, caption], &marks, others, listed.into_iter(), &data))
}

/// Places and turns of the links as a log has them, frame after frame.
fn beside(plant: &mut dyn Plant, log: &LogBeside, times: &[f64]) -> Vec<Brief> {
    let links = plant.model().links.len();
    let mut all = Vec::new();
    for &t in times {
        let q: Option<Vec<f64>> = log.q.iter().map(|signal| log.at(signal, t)).collect();
        match q {
            Some(q) => all.extend(Frame::of(plant, &q).links.iter().flat_map(pose)),
            None => all.extend((0..7 * links).map(|_| with_decimals(f64::NAN, PLACE))),
        }
    }
    all
}

/// The rows of a log at the times of a display.
fn displayed(log: &Log) -> Option<Log> {
    let times = log.column("t")?;
    let over = times.last()? - times.first()?;
    let period = (over / MOST_FRAMES).max((1.0 / RATE).min(over / LEAST_FRAMES));
    let mut values = Vec::new();
    let mut next = f64::NEG_INFINITY;
    for (at, row) in log.rows().enumerate() {
        let is_last = at + 1 == times.len();
        if times[at] >= next - 1e-9 || is_last {
            values.extend_from_slice(row);
            next = times[at] + period;
        }
    }
    Some(Log { header: log.header.clone(), columns: log.columns.clone(), values })
}

/// A robot at one time.
struct Frame {
    links: Vec<Transform>,
    center: Vec3,
}

impl Frame {
    fn of(plant: &mut dyn Plant, q: &[f64]) -> Self {
        let mut rows = vec![0.0; 12 * plant.model().links.len()];
        plant.link_transforms(q, &mut rows);
        let links = rows.chunks_exact(12).map(Transform::from_rows).collect();
        Self { links, center: plant.center_of_mass(q) }
    }
}

/// Points of balance, frame after frame; none of robots that do not walk.
#[derive(Default)]
struct Balance {
    zmp: Option<Vec<Brief>>,
    capture: Option<Vec<Brief>>,
    support: Option<Vec<Vec<Brief>>>,
}

impl Balance {
    fn of(model: &PlantModel, times: &[f64], instants: &[Instant]) -> Self {
        if instants.is_empty() {
            return Self::default();
        }
        // rows without forces have no instant
        let at = |time: &f64| {
            let place = instants.partition_point(|one| one.t_s < time - 1e-9);
            instants.get(place).filter(|one| (one.t_s - time).abs() < 1e-9)
        };
        let points = |of: fn(&Instant) -> Vec3| {
            let all = times.iter().flat_map(|time| at(time).map_or([f64::NAN; 3], of));
            all.map(|entry| with_decimals(entry, PLACE)).collect()
        };
        let polygon = |time: &f64| {
            let corners = at(time).map_or(&[][..], |one| one.support.corners());
            let outline = hull(corners.to_vec()).into_iter();
            let places = outline.flat_map(|corner| on_ground(model, corner));
            places.map(|entry| with_decimals(entry, PLACE)).collect()
        };
        Self {
            zmp: Some(points(|one| one.zero_moment_point_m)),
            capture: Some(points(|one| one.capture_m)),
            support: Some(times.iter().map(polygon).collect()),
        }
    }
}

/// The place of a corner that is given along the tangents of the ground.
fn on_ground(model: &PlantModel, [a, b]: [f64; 2]) -> Vec3 {
    let ground = &model.ground;
    let [first, second] = ground.tangents();
    let lift = 1e-3;
    let on = add(scale(first, a), scale(second, b));
    // corners are dot products with the tangents: what is left is the height of the ground
    let height = super::super::space::dot(ground.point, ground.normal) + lift;
    add(on, scale(ground.normal, height))
}

/// Forces on the contact points, and what an arrow stands for.
fn forces(model: &PlantModel, shown: &Log) -> (Option<Vec<Brief>>, f64) {
    let columns = model.contacts.iter().flat_map(|contact| {
        ["x", "y", "z"].map(|axis| shown.column(&format!("f_{}_{axis}", contact.name)))
    });
    let columns: Option<Vec<Vec<f64>>> = columns.collect();
    let Some(columns) = columns.filter(|columns| !columns.is_empty()) else { return (None, 1.0) };
    let rows = columns[0].len();
    let all = (0..rows).flat_map(|row| columns.iter().map(move |column| column[row]));
    let weight = model.mass_kg * norm(model.gravity);
    let most = columns.iter().flatten().filter(|force| force.is_finite()).copied();
    let most = most.fold(0.0, |most: f64, force| most.max(force.abs()));
    let stands_for = if weight > 0.0 { weight } else { most.max(1e-9) };
    (Some(all.map(|force| with_decimals(force, FORCE)).collect()), stands_for)
}

fn events(model: &PlantModel, events: &[Event]) -> Vec<EventData> {
    let contact = |at: usize| {
        let name = model.contacts.get(at).map_or("a contact", |contact| contact.name.as_str());
        name.replace('_', " ")
    };
    let text = |event: &Event| match event.kind {
        EventKind::Start => "start".to_owned(),
        EventKind::Touch(at) if has_ground(model) => {
            format!("{} touches the ground", contact(at))
        }
        EventKind::Touch(at) => format!("{} meet", contact(at)),
        EventKind::Limit => "a contact opens, or begins to slip".to_owned(),
        EventKind::LeastLoads => "a sole slides on the least loads".to_owned(),
        EventKind::SlipEnds(at) => format!("{} stops slipping", contact(at)),
        EventKind::Jump(_) => "a jump of the state".to_owned(),
        EventKind::Push => "a push".to_owned(),
        EventKind::Plan => "references are planned anew".to_owned(),
    };
    let shown = events.iter().filter(|event| event.kind != EventKind::Start).take(MOST_EVENTS);
    shown.map(|event| EventData { t: event.t_s, text: text(event) }).collect()
}

fn data(
    model: &PlantModel,
    times: &[f64],
    frames: &[Frame],
    balance: Balance,
    forces: Option<(Vec<Brief>, f64)>,
    events: Vec<EventData>,
) -> Data {
    let mut links = links(model);
    let follows = generated(model) > 0;
    let weight = norm(model.gravity);
    let up = match weight > 0.0 {
        true => scale(model.gravity, -1.0 / weight),
        false => model.ground.normal,
    };
    let (size, center) =
        size_and_middle(model, &links, if follows { &frames[..1] } else { frames });
    round_bodies(model, frames, size, &mut links);
    let first = frames.first().map_or([0.0; 3], |frame| frame.center);
    let reach = frames.iter().map(|frame| norm(sub(frame.center, first))).fold(0.0, f64::max);
    let triple = |v: Vec3| v.map(|entry| with_decimals(entry, PLACE));
    let is_walker = !model.contacts.is_empty() && has_ground(model);
    let (forces, force_n) = forces.map_or((None, 1.0), |(all, unit)| (Some(all), unit));
    Data {
        up,
        base: [0.0; 3],
        t: times.iter().map(|time| with_decimals(*time, TIME)).collect(),
        beside: None,
        poses: frames.iter().flat_map(|frame| &frame.links).flat_map(pose).collect(),
        links,
        tips: model
            .fall_points
            .iter()
            .map(|p| PointData { link: p.link, at: p.position })
            .collect(),
        feet: if is_walker { foot_data(model) } else { Vec::new() },
        contacts: model
            .contacts
            .iter()
            .map(|p| PointData { link: p.link, at: p.position })
            .collect(),
        com: frames.iter().flat_map(|frame| triple(frame.center)).collect(),
        forces,
        force_n,
        zmp: balance.zmp,
        capture: balance.capture,
        support: balance.support,
        events,
        ground: is_walker.then_some([model.ground.point, model.ground.normal]),
        grid_m: round_step((size / 4.0).max(reach / 25.0)),
        size,
        reach,
        center,
        follows,
        eye: model.planar.then_some([0.12, -1.0, 0.12]),
        view: None,
        shapes: Vec::new(),
        shapes_whole: false,
    }
}

fn links(model: &PlantModel) -> Vec<LinkData> {
    let first = generated(model);
    let roots = model.parents.iter().filter(|parent| parent.is_none()).count();
    let link = |(place, name): (usize, &String)| {
        let parent = model.parents[place];
        let joint = model.joints.iter().find(|joint| joint.name == *name && joint.drivable);
        // bodies beside each other hang on nothing
        let is_body = place >= first && !(parent.is_none() && roots > 1);
        LinkData {
            name: name.clone(),
            carrier: number(parent),
            slides: joint.is_some_and(|joint| joint.slides),
            is_joint: is_body && joint.is_some(),
            is_body,
            radius: None,
        }
    };
    model.links.iter().enumerate().map(link).collect()
}

/// Gives bodies without a length a radius: those beside each other touch where they are nearest,
/// a point that touches the ground is a share of the picture.
fn round_bodies(model: &PlantModel, frames: &[Frame], size: f64, links: &mut [LinkData]) {
    let roots: Vec<usize> =
        (0..links.len()).filter(|&link| model.parents[link].is_none()).collect();
    if roots.len() > 1 {
        let apart = |frame: &Frame, a: usize, b: usize| {
            norm(sub(frame.links[a].origin, frame.links[b].origin))
        };
        let pairs = |frame| roots.windows(2).map(move |pair| apart(frame, pair[0], pair[1]));
        let nearest = frames.iter().flat_map(pairs).fold(f64::INFINITY, f64::min);
        let radius = nearest.is_finite().then_some((0.5 * nearest).max(0.02 * size));
        roots.iter().for_each(|&root| links[root].radius = radius);
    } else if let [only] = model.contacts.as_slice()
        && norm(only.position) <= BALL * size
        && model.fall_points.is_empty()
        && !links.iter().any(|link| link.is_joint)
    {
        links[only.link].radius = Some(BALL * size);
    }
}

fn foot_data(model: &PlantModel) -> Vec<FootData> {
    let first = generated(model);
    let foot = |link: usize| {
        let own = model.contacts.iter().filter(|contact| contact.link == link);
        let carrier = model.parents[link].filter(|_| link >= first);
        FootData { link, carrier: number(carrier), points: own.map(|p| p.position).collect() }
    };
    feet(model).into_iter().map(foot).collect()
}

fn number(link: Option<usize>) -> i64 {
    link.and_then(|link| i64::try_from(link).ok()).unwrap_or(-1)
}

/// Size and middle of what some frames show.
fn size_and_middle(model: &PlantModel, links: &[LinkData], frames: &[Frame]) -> (f64, Vec3) {
    let mut points: Vec<Vec3> = Vec::new();
    for frame in frames {
        for (place, link) in links.iter().enumerate().filter(|(_, link)| link.is_body) {
            // a body begins where what carries it is
            let carrier = usize::try_from(link.carrier).ok();
            points.extend(
                [Some(place), carrier].into_iter().flatten().map(|at| frame.links[at].origin),
            );
        }
        let ends = model.contacts.iter().chain(&model.fall_points);
        points.extend(ends.map(|point| frame.links[point.link].point(point.position)));
    }
    if generated(model) == 0 {
        points.push([0.0; 3]);
    }
    let (size, center) = extent(&points);
    if size > LEAST_SIZE_M && !points.is_empty() {
        return (size, center);
    }
    // a robot that is a point is as large as its way
    points.extend(frames.iter().map(|frame| frame.center));
    extent(&points)
}

/// Place and turn of a frame.
fn pose(frame: &Transform) -> Vec<Brief> {
    let all = pose_of(frame).into_iter().enumerate();
    all.map(|(at, entry)| with_decimals(entry, if at < 3 { PLACE } else { TURN })).collect()
}
