//! Audits: laws of mechanics that a run must obey, measured on what it did.

use super::ground::{cross, dot};
use super::integrate::Method;
use super::motion::Motion;
use denavit_plants::PlantModel;

/// What a run may miss the laws by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerances {
    /// Energy, work and impact losses \[J\]; also this part of the energy that was exchanged, or in
    /// motion.
    pub energy_j: f64,
    /// Change of momentum at impacts against their impulses [N s].
    pub momentum_ns: f64,
    /// Depth of a contact point below the ground \[m\].
    pub penetration_m: f64,
    /// Product of force and height of a closed contact [N m].
    pub complementarity_nm: f64,
    /// Pull of the ground on a contact \[N\].
    pub adhesion_n: f64,
    /// Normal speed of a closed contact [m/s].
    pub separation_m_s: f64,
    /// Zero moment point from forces against that from momentum \[m\].
    pub zmp_m: f64,
    /// Contact forces against the change of momentum \[N\].
    pub force_n: f64,
    /// Tangential force beyond the friction cone of a contact \[N\].
    pub cone_n: f64,
    /// Angle between friction and what is opposite to the velocity of a slipping contact \[rad\].
    pub friction_angle_rad: f64,
}

/// A fall by this height is an error of position that the balance of energy need not see \[m\]: a
/// contact lands within 1e-8 m.
const FALL_M: f64 = 1e-3;

/// Closed contacts may move by so many times the accuracy of rates.
const ERRORS: f64 = 100.0;

/// Tolerances of forces, momentum and their products count once per so much kinetic energy: what a
/// robot of human size has that walks \[J\].
const MOTION_J: f64 = 4.0;

impl Tolerances {
    /// Those of motion from event to event, integrated like this.
    pub fn of_method(method: Method) -> Self {
        let standard = Self::default();
        let separation_m_s = match method {
            Method::DormandPrince(accuracy) | Method::Radau(accuracy) => {
                standard.separation_m_s.max(ERRORS * accuracy.absolute)
            }
            Method::RungeKutta { .. } => standard.separation_m_s,
        };
        Self { separation_m_s, ..standard }
    }

    /// Those of time stepping with steps of this length: in proportion to it, what a robot of
    /// human size that walks or stumbles is off by.
    pub fn of_steps(step_s: f64) -> Self {
        Self {
            energy_j: 50.0 * step_s,
            momentum_ns: 100.0 * step_s,
            penetration_m: 5.0 * step_s,
            complementarity_nm: 1e3 * step_s,
            adhesion_n: 1e-6,
            separation_m_s: 1e-6,
            zmp_m: 50.0 * step_s,
            force_n: 1e4 * step_s,
            cone_n: 1e-6,
            // half a facet of a pyramid of 16
            friction_angle_rad: 0.2,
        }
    }

    /// For steps longer by this factor; what solvers miss stays.
    pub(super) fn scaled(self, factor: f64) -> Self {
        Self {
            energy_j: factor * self.energy_j,
            momentum_ns: factor * self.momentum_ns,
            penetration_m: factor * self.penetration_m,
            complementarity_nm: factor * self.complementarity_nm,
            zmp_m: factor * self.zmp_m,
            force_n: factor * self.force_n,
            ..self
        }
    }
}

impl Default for Tolerances {
    fn default() -> Self {
        Self {
            energy_j: 1e-5,
            momentum_ns: 1e-9,
            penetration_m: 1e-7,
            complementarity_nm: 1e-5,
            adhesion_n: 1e-6,
            separation_m_s: 1e-6,
            zmp_m: 1e-7,
            force_n: 1e-6,
            cone_n: 1e-6,
            friction_angle_rad: 1e-6,
        }
    }
}

/// The worst of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Audit {
    /// |E - E0 - work + losses - impacts| \[J\].
    pub energy_j: f64,
    /// Work put in, either way, impact losses included: what the energy error is compared with
    /// \[J\].
    pub exchanged_j: f64,
    /// Largest kinetic energy: what errors of forces and of momentum are compared with \[J\].
    pub motion_j: f64,
    /// Weight: times a millimetre, it is what the energy error of a heavy body at rest is compared
    /// with \[N\].
    pub weight_n: f64,
    /// Linear momentum across impacts [N s].
    pub momentum_ns: f64,
    /// Largest energy that an impact made \[J\]; 0 if all lost.
    pub impact_gain_j: f64,
    /// \[m\].
    pub penetration_m: f64,
    /// [N m].
    pub complementarity_nm: f64,
    /// \[N\].
    pub adhesion_n: f64,
    /// [m/s].
    pub separation_m_s: f64,
    /// Largest |F_t| / F_n of the forces on one link.
    pub friction_demand: f64,
    /// Largest |F_t| / F_n of all contact forces together.
    pub friction_total: f64,
    /// \[m\].
    pub zmp_m: f64,
    /// \[N\].
    pub force_n: f64,
    /// Largest tangential force of a contact beyond its friction cone; 0 within all cones \[N\].
    pub cone_n: f64,
    /// Largest angle between friction and what is opposite to the velocity of a contact that slips
    /// faster than errors are \[rad\].
    pub friction_angle_rad: f64,
    /// Distance of the zero moment point from the edge of the support polygon, the least in time;
    /// negative outside, infinite if never defined \[m\].
    pub zmp_margin_m: f64,
    /// Largest torque on a joint [N m, N].
    pub torque: f64,
}

impl Audit {
    pub(super) fn new(model: &PlantModel) -> Self {
        let weight_n = model.mass_kg * dot(model.gravity, &model.gravity).sqrt();
        Self { zmp_margin_m: f64::INFINITY, weight_n, ..Self::default() }
    }

    /// The figures that have a meaning for a plant, each with the name in its log's header (none
    /// if it is not there) and with what it is called: those of contacts where there are contact
    /// points, balances where contacts are all that holds the plant.
    pub fn listed(&self, model: &PlantModel) -> Vec<(Option<&'static str>, &'static str, f64)> {
        let touches = !model.contacts.is_empty();
        let free = touches && model.joints.first().is_some_and(|joint| !joint.drivable);
        let margin = free && self.zmp_margin_m.is_finite();
        let rows = [
            (true, Some("energy_j"), "energy balance [J]", self.energy_j),
            (free, Some("momentum_ns"), "momentum across impacts [N s]", self.momentum_ns),
            (touches, Some("penetration_m"), "penetration [m]", self.penetration_m),
            (touches, Some("complementarity_nm"), "complementarity [N m]", self.complementarity_nm),
            (touches, Some("adhesion_n"), "adhesion [N]", self.adhesion_n),
            (
                touches,
                Some("separation_m_s"),
                "speed of closed contacts [m/s]",
                self.separation_m_s,
            ),
            (free, Some("force_n"), "forces against momentum [N]", self.force_n),
            (free, Some("zmp_m"), "zero moment point against momentum [m]", self.zmp_m),
            (touches, Some("cone_n"), "friction beyond its cone [N]", self.cone_n),
            (
                touches,
                Some("friction_angle_rad"),
                "friction off slipping [rad]",
                self.friction_angle_rad,
            ),
            (touches, Some("friction_demand"), "friction demand of one link", self.friction_demand),
            (touches, None, "friction demand of all contacts", self.friction_total),
            (true, None, "largest torque [N m, N]", self.torque),
            (margin, None, "margin of the zero moment point [m]", self.zmp_margin_m),
        ];
        rows.into_iter()
            .filter(|row| row.0)
            .map(|(_, key, name, found)| (key, name, found))
            .collect()
    }

    /// The laws that were missed by more than is tolerated: name, by how much, tolerance.
    pub fn broken(&self, tolerances: &Tolerances) -> Vec<(&'static str, f64, f64)> {
        let t = tolerances;
        let fall = FALL_M * self.weight_n;
        let energy = t.energy_j * self.exchanged_j.max(self.motion_j).max(fall).max(1.0);
        let size = (self.motion_j / MOTION_J).max(1.0);
        let checks = [
            ("energy", self.energy_j, energy),
            ("impact_gain", self.impact_gain_j, energy),
            ("momentum", self.momentum_ns, size * t.momentum_ns),
            ("penetration", self.penetration_m, t.penetration_m),
            ("complementarity", self.complementarity_nm, size * t.complementarity_nm),
            ("adhesion", self.adhesion_n, t.adhesion_n),
            ("separation", self.separation_m_s, t.separation_m_s),
            ("zmp", self.zmp_m, t.zmp_m),
            ("force_balance", self.force_n, size * t.force_n),
            ("friction_cone", self.cone_n, t.cone_n),
            ("friction_direction", self.friction_angle_rad, t.friction_angle_rad),
        ];
        // NaN breaks a law too
        checks.into_iter().filter(|(_, found, allowed)| found.is_nan() || found > allowed).collect()
    }
}

/// Forces on the ground, and what follows from them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Balance {
    /// Zero moment point from the contact forces \[m\]; not finite in flight.
    pub(super) zmp: [f64; 3],
    /// The same from the change of momentum.
    pub(super) zmp_of_momentum: [f64; 3],
    /// Contact forces minus the change of momentum \[N\].
    pub(super) force_error: f64,
    /// Normal force \[N\].
    pub(super) normal_force: f64,
}

/// A force, or an impulse, without a direction [N, N s].
const NO_FRICTION: f64 = 1e-9;

/// Largest movement of a joint in the differences of momentum [rad, m]: rounding and what is left
/// of the Taylor series are both about 1e-13 then.
const DIFFERENCE: f64 = 1e-3;

/// Compares contact forces with the change of momentum, for a plant that nothing else holds.
/// `work` of the motion is that of `y`.
pub(super) fn balance(motion: &mut Motion<'_>, t_s: f64, y: &[f64]) -> Balance {
    let rows = motion.ground.rows();
    let ([mut force, mut moment], normal) = ([[0.0; 3]; 2], motion.ground.normal());
    let origin = motion.plant.model().ground.point;
    for (index, closed) in motion.closed.iter().enumerate() {
        let world = motion.ground.in_world(&motion.work.force[index * rows..(index + 1) * rows]);
        let at = &motion.work.positions[3 * closed.contact..3 * closed.contact + 3];
        let arm = std::array::from_fn(|axis| at[axis] - origin[axis]);
        add(&mut force, world);
        add(&mut moment, cross(arm, world));
    }
    let (mut rate, gravity) = (momentum_rate(motion, y), motion.plant.model().gravity);
    let mass = motion.plant.model().mass_kg;
    let parts = motion.layout.parts(y);
    let center = motion.plant.center_of_mass(parts.q);
    for axis in 0..3 {
        rate[axis] -= mass * gravity[axis];
    }
    let [pushed, pushed_moment] = pushes(motion, t_s, y, origin);
    let carried = [rate[0], rate[1], rate[2]];
    let arm = std::array::from_fn(|axis| center[axis] - origin[axis]);
    let mut needed_moment = cross(arm, carried);
    add(&mut needed_moment, [rate[3], rate[4], rate[5]]);
    // what pushes is not the ground's to give
    let needed = std::array::from_fn(|axis| carried[axis] - pushed[axis]);
    needed_moment.iter_mut().zip(pushed_moment).for_each(|(entry, push)| *entry -= push);
    let error = (0..3).map(|axis| (force[axis] - needed[axis]).powi(2)).sum::<f64>().sqrt();
    let normal_force = dot(normal, &force);
    // below a hundredth of the weight a moment has no point
    let weight = mass * dot(gravity, &gravity).sqrt();
    let loaded = normal_force > 0.01 * weight;
    let undefined = [f64::NAN; 3];
    Balance {
        zmp: if loaded { point_of_moment(origin, normal, force, moment) } else { undefined },
        zmp_of_momentum: if loaded {
            point_of_moment(origin, normal, needed, needed_moment)
        } else {
            undefined
        },
        force_error: error,
        normal_force,
    }
}

/// Sum and moment about a point of the forces that push from outside [N, N m].
fn pushes(motion: &mut Motion<'_>, t_s: f64, y: &[f64], origin: [f64; 3]) -> [[f64; 3]; 2] {
    let [mut sum, mut moment] = [[0.0; 3]; 2];
    let (q, time) = (motion.layout.parts(y).q, motion.reference_time(t_s));
    for push in motion.pushes {
        let Some(force) = push.force(time) else { continue };
        let place = push.place(motion.plant, q);
        add(&mut sum, force);
        add(&mut moment, cross(std::array::from_fn(|axis| place[axis] - origin[axis]), force));
    }
    [sum, moment]
}

/// The point of the ground about which forces of this sum and of this moment about `origin` have no
/// moment but about the normal.
pub(super) fn point_of_moment(
    origin: [f64; 3],
    normal: [f64; 3],
    force: [f64; 3],
    moment: [f64; 3],
) -> [f64; 3] {
    let (size, arm) = (dot(normal, &force), cross(normal, moment));
    std::array::from_fn(|axis| origin[axis] + arm[axis] / size)
}

/// The angle between a force of friction and what is opposite to the velocity; 0 without force
/// \[rad\].
pub(super) fn friction_angle(force: &[f64], velocity: &[f64]) -> f64 {
    let at = |vector: &[f64], axis: usize| vector.get(axis).copied().unwrap_or(0.0);
    let [x, y] = [0, 1].map(|axis| at(force, axis));
    let [u, v] = [0, 1].map(|axis| -at(velocity, axis));
    if x.hypot(y) <= NO_FRICTION { 0.0 } else { (x * v - y * u).abs().atan2(x * u + y * v) }
}

/// The larger, or NaN: nothing hides behind a comparison.
pub(super) fn worst(a: f64, b: f64) -> f64 {
    if b.is_nan() || b > a { b } else { a }
}

fn add(sum: &mut [f64; 3], term: [f64; 3]) {
    sum.iter_mut().zip(term).for_each(|(entry, term)| *entry += term);
}

/// d/dt of linear and angular momentum p(q, qd) = A(q) qd: A qdd, which is exact, and the
/// derivative of p along qd, by differences of order 4. The acceleration stays out of the
/// differences: just after an event it is some 10^4 rad/s^2, and products of it with rates would be
/// their error.
fn momentum_rate(motion: &mut Motion<'_>, y: &[f64]) -> [f64; 6] {
    let parts = motion.layout.parts(y);
    let fastest = parts.qd.iter().fold(1.0_f64, |most, rate| most.max(rate.abs()));
    let h = DIFFERENCE / fastest;
    let mut at = |time: f64| {
        let moved: Vec<f64> =
            parts.q.iter().zip(parts.qd).map(|(q, rate)| q + time * rate).collect();
        motion.plant.momentum(&moved, parts.qd)
    };
    let [far_back, back, ahead, far_ahead] = [-2.0 * h, -h, h, 2.0 * h].map(&mut at);
    let of_acceleration = motion.plant.momentum(parts.q, &motion.work.acceleration);
    std::array::from_fn(|i| {
        let along = (8.0 * (ahead[i] - back[i]) - (far_ahead[i] - far_back[i])) / (12.0 * h);
        of_acceleration[i] + along
    })
}
