//! The criteria of balance at one time.

use denavit_plants::Plant;
use denavit_simulate::{SupportForm, SupportPolygon};

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
    /// Zero moment point of inertia and gravity; not finite in flight \[m\].
    pub zero_moment_point_m: [f64; 3],
    /// Centre of pressure of the contact forces; not finite without them \[m\].
    pub center_of_pressure_m: [f64; 3],
    /// Zero moment point of the cart-table model (thesis 4.3) \[m\].
    pub cart_table_m: [f64; 3],
    /// Foot rotation indicator of the one foot that stands (Goswami 1999) \[m\].
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
    /// Whether each contact point is closed.
    pub(super) closed: &'a [bool],
}

impl Instant {
    /// None for plants without functions for walking.
    pub(super) fn of(plant: &mut dyn Plant, at: &Moving<'_>) -> Option<Self> {
        let (n, points) = (at.q.len(), plant.model().contacts.len());
        let mut positions = vec![0.0; 3 * points];
        plant.contact_positions(at.q, &mut positions);
        let speeds = speeds(plant, at);
        let (closed, feet) = carrying(plant, at, (&positions, &speeds));
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
        let mut walking = plant.walking()?;
        let bias = walking.center_of_mass_bias(at.q, at.qd);
        let along = |row: usize, values: &[f64]| -> f64 {
            jacobian[row * n..(row + 1) * n].iter().zip(values).map(|(a, b)| a * b).sum()
        };
        let velocity = [0, 1, 2].map(|row| along(row, at.qd));
        let acceleration = [0, 1, 2].map(|row| along(row, at.qdd) + bias[row]);
        let mut body_momenta = vec![[0.0; 3]; n];
        walking.angular_momenta(at.q, at.qd, body_momenta.as_flattened_mut());
        let foot_rotation_m = match feet[..] {
            [foot] => walking.foot_rotation_indicator(foot, at.q, at.qd, at.qdd),
            _ => None,
        };
        Some(Self {
            t_s: at.t_s,
            center_of_mass: [center, velocity, acceleration],
            zero_moment_point_m: match phase {
                Phase::Flight => [f64::NAN; 3],
                _ => walking.zero_moment_point(at.q, at.qd, at.qdd)?,
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
    (positions, speeds): (&[f64], &[f64]),
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
    let (normal, origin) = (model.ground.normal, model.ground.point);
    let (mut sum, mut moment) = (0.0, [0.0; 3]);
    for (force, place) in at.forces.iter().zip(positions.chunks_exact(3)) {
        sum += dot(normal, *force);
        let arm: [f64; 3] = std::array::from_fn(|axis| place[axis] - origin[axis]);
        let of_force = cross(arm, *force);
        moment.iter_mut().zip(of_force).for_each(|(entry, part)| *entry += part);
    }
    let weight = model.mass_kg * dot(model.gravity, model.gravity).sqrt();
    if sum <= LOADED * weight {
        return [f64::NAN; 3];
    }
    let arm = cross(normal, moment);
    std::array::from_fn(|axis| origin[axis] + arm[axis] / sum)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
