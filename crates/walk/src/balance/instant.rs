//! The criteria of balance at one time.

use denavit_plants::{GroundModel, Plant};
use denavit_simulate::{LinkWrench, SupportForm, SupportPolygon};

/// What stands on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Nothing: flight, which is no fall.
    Flight,
    /// One foot on all of its sole: a line in the plane, an area in space.
    Flat,
    /// One foot on an edge or a corner.
    Toe,
    /// More than one foot.
    Double,
}

/// The state of balance at one time; points and vectors in the world frame.
#[derive(Clone, Debug, PartialEq)]
pub struct Instant {
    /// \[s\].
    pub t_s: f64,
    /// Centre of mass \[m\], its velocity [m/s] and acceleration [m/s^2].
    pub center_of_mass: [[f64; 3]; 3],
    /// Where the ground's force acts for gravity, inertia and what pushes; not finite in flight
    /// \[m\].
    pub zero_moment_point_m: [f64; 3],
    /// Centre of pressure of the contact forces; not finite without them \[m\].
    pub center_of_pressure_m: [f64; 3],
    /// Zero moment point of the cart-table model (thesis 4.3) \[m\].
    pub cart_table_m: [f64; 3],
    /// Foot rotation indicator of the one foot that stands (Goswami 1999), while nothing pushes
    /// from outside \[m\].
    pub foot_rotation_m: Option<[f64; 3]>,
    /// Capture point of the linear inverted pendulum \[m\].
    pub capture_m: [f64; 3],
    /// Angular momentum about the centre of mass [kg m^2/s].
    pub angular_momentum: [f64; 3],
    /// The part of the body on each joint in it [kg m^2/s].
    pub body_momenta: Vec<[f64; 3]>,
    /// What carries the robot.
    pub support: SupportPolygon,
    /// The feet that it stands on.
    pub phase: Phase,
    /// How many contact points carry it.
    pub closed: usize,
    /// Whether more than one point carries the robot, and all of them rest.
    pub is_still: bool,
}

/// Contact points this near to the ground carry a robot, where one of their foot does and they
/// rest \[m\].
const NEAR_M: f64 = 1e-6;
/// Points that are slower rest [m/s].
const STILL_M_S: f64 = 1e-6;
/// Without a hundredth of the weight no point is where it presses.
const LOADED: f64 = 0.01;

/// The motion of a robot at one time.
#[derive(Clone, Copy, Debug)]
pub(super) struct Moving<'a> {
    pub(super) t_s: f64,
    pub(super) q: &'a [f64],
    pub(super) qd: &'a [f64],
    pub(super) qdd: &'a [f64],
    /// Force on each contact point in the world \[N\].
    pub(super) forces: &'a [[f64; 3]],
    /// What pushes from outside.
    pub(super) wrenches: &'a [LinkWrench],
    /// Whether each contact point carries.
    pub(super) closed: &'a [bool],
}

impl Instant {
    /// None for plants without functions for walking.
    pub(super) fn of(plant: &mut dyn Plant, at: &Moving<'_>) -> Option<Self> {
        let (n, points) = (at.q.len(), plant.model().contacts.len());
        let mut positions = vec![0.0; 3 * points];
        plant.contact_positions(at.q, &mut positions);
        let speeds = speeds(plant, at);
        let (closed, feet) = carrying(plant, at, &positions, &speeds);
        let support = {
            let places = closed.iter().map(|c| &positions[3 * c..3 * c + 3]);
            SupportPolygon::of(plant.model(), places)
        };
        let phase = match (feet.len(), support.form()) {
            (0, _) => Phase::Flight,
            (1, form) if form == flat(plant) => Phase::Flat,
            (1, _) => Phase::Toe,
            _ => Phase::Double,
        };
        let center = plant.center_of_mass(at.q);
        let mut jacobian = vec![0.0; 3 * n];
        plant.center_of_mass_jacobian(at.q, &mut jacobian);
        let momentum = plant.momentum(at.q, at.qd);
        let is_still =
            closed.len() > 1 && closed.iter().all(|contact| speeds[*contact] < STILL_M_S);
        let center_of_pressure_m = pressure(plant, at, &positions);
        let is_pushed = !at.wrenches.is_empty();
        let pushed = if is_pushed { Some(pushed_zero_moment_point(plant, at)?) } else { None };
        let mut walking = plant.walking()?;
        let bias = walking.center_of_mass_bias(at.q, at.qd);
        let line = |row: usize| &jacobian[row * n..(row + 1) * n];
        let velocity = [0, 1, 2].map(|row| along(line(row), at.qd));
        let acceleration = [0, 1, 2].map(|row| along(line(row), at.qdd) + bias[row]);
        let mut body_momenta = vec![[0.0; 3]; n];
        walking.angular_momenta(at.q, at.qd, body_momenta.as_flattened_mut());
        let foot_rotation_m = match feet[..] {
            [foot] if !is_pushed => walking.foot_rotation_indicator(foot, at.q, at.qd, at.qdd),
            _ => None,
        };
        Some(Self {
            t_s: at.t_s,
            center_of_mass: [center, velocity, acceleration],
            zero_moment_point_m: match phase {
                Phase::Flight => [f64::NAN; 3],
                _ => match pushed {
                    Some(point) => point,
                    None => walking.zero_moment_point(at.q, at.qd, at.qdd)?,
                },
            },
            center_of_pressure_m,
            cart_table_m: walking.cart_table_zmp(at.q, at.qd, at.qdd)?,
            foot_rotation_m,
            capture_m: walking.capture_point(at.q, at.qd)?,
            angular_momentum: [momentum[3], momentum[4], momentum[5]],
            body_momenta,
            support,
            phase,
            closed: closed.len(),
            is_still,
        })
    }

    /// How far the robot falls sideways: margin of the point of a criterion, if it has one now
    /// \[m\].
    pub fn margin(&self, point: [f64; 3]) -> Option<f64> {
        let stands = self.phase != Phase::Flight && point.iter().all(|entry| entry.is_finite());
        stands.then(|| self.support.margin(point))
    }
}

/// The form of what one whole sole touches.
fn flat(plant: &dyn Plant) -> SupportForm {
    if plant.model().planar { SupportForm::Line } else { SupportForm::Area }
}

/// The contact points that carry the robot, and the links that they belong to. In space, points of
/// a foot that stands count where they touch the ground, too: which of them have force is
/// arbitrary.
fn carrying(
    plant: &dyn Plant,
    at: &Moving<'_>,
    positions: &[f64],
    speeds: &[f64],
) -> (Vec<usize>, Vec<usize>) {
    let model = plant.model();
    let mut feet: Vec<usize> = Vec::new();
    for (contact, point) in model.contacts.iter().enumerate() {
        if at.closed[contact] && !feet.contains(&point.link) {
            feet.push(point.link);
        }
    }
    let carries = |contact: &usize| {
        let height = model.ground.height(&positions[3 * contact..3 * contact + 3]);
        let stands = feet.contains(&model.contacts[*contact].link);
        let rests = height.abs() < NEAR_M && speeds[*contact] < STILL_M_S;
        at.closed[*contact] || (stands && rests && !model.planar)
    };
    ((0..model.contacts.len()).filter(carries).collect(), feet)
}

/// Speed of every contact point [m/s].
fn speeds(plant: &mut dyn Plant, at: &Moving<'_>) -> Vec<f64> {
    let (n, points) = (at.q.len(), plant.model().contacts.len());
    let mut jacobian = vec![0.0; 3 * points * n];
    plant.contact_jacobian(at.q, &mut jacobian);
    let along = |row: &[f64]| row.iter().zip(at.qd).map(|(w, v)| w * v).sum::<f64>();
    let speed = |point: &[f64]| point.chunks_exact(n).map(|row| along(row).powi(2)).sum::<f64>();
    jacobian.chunks_exact(3 * n).map(|point| speed(point).sqrt()).collect()
}

/// Where the contact forces have no moment but about the normal.
fn pressure(plant: &dyn Plant, at: &Moving<'_>, positions: &[f64]) -> [f64; 3] {
    let model = plant.model();
    let [mut force, mut moment] = [[0.0; 3]; 2];
    for (one, place) in at.forces.iter().zip(positions.chunks_exact(3)) {
        let arm = std::array::from_fn(|axis| place[axis] - model.ground.point[axis]);
        add(&mut force, 1.0, *one);
        add(&mut moment, 1.0, cross(arm, *one));
    }
    let weight = model.mass_kg * dot(model.gravity, model.gravity).sqrt();
    if dot(model.ground.normal, force) <= LOADED * weight {
        return [f64::NAN; 3];
    }
    point_of_moment(&model.ground, force, moment)
}

/// Where the ground's force has to act: inertia takes what gravity, what pushes and the ground give
/// together.
fn pushed_zero_moment_point(plant: &mut dyn Plant, at: &Moving<'_>) -> Option<[f64; 3]> {
    let n = at.q.len();
    let (mass, gravity) = (plant.model().mass_kg, plant.model().gravity);
    let ground = plant.model().ground;
    let center = plant.center_of_mass(at.q);
    let mut walking = plant.walking()?;
    let mut matrix = vec![0.0; 6 * n];
    walking.centroidal_momentum_matrix(at.q, &mut matrix);
    let bias = walking.centroidal_momentum_bias(at.q, at.qd);
    let rate = |row: usize| along(&matrix[row * n..(row + 1) * n], at.qdd) + bias[row];
    let mut force = [0, 1, 2].map(rate);
    add(&mut force, -mass, gravity);
    let mut moment = [3, 4, 5].map(rate);
    let arm = std::array::from_fn(|axis| center[axis] - ground.point[axis]);
    add(&mut moment, 1.0, cross(arm, force));
    for wrench in at.wrenches {
        add(&mut force, -1.0, wrench.force);
        add(&mut moment, -1.0, wrench.moment_about(plant, at.q, ground.point));
    }
    Some(point_of_moment(&ground, force, moment))
}

/// The point of the ground about which forces of this sum, and of this moment about the ground's
/// point, have no moment but about the normal.
fn point_of_moment(ground: &GroundModel, force: [f64; 3], moment: [f64; 3]) -> [f64; 3] {
    let (size, arm) = (dot(ground.normal, force), cross(ground.normal, moment));
    std::array::from_fn(|axis| ground.point[axis] + arm[axis] / size)
}

fn along(row: &[f64], values: &[f64]) -> f64 {
    row.iter().zip(values).map(|(a, b)| a * b).sum()
}

fn add(sum: &mut [f64; 3], times: f64, term: [f64; 3]) {
    sum.iter_mut().zip(term).for_each(|(entry, term)| *entry += times * term);
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
