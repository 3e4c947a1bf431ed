//! A case: everything that its number stands for, and the plant that it makes.

use super::conditions::Recording;
use super::design::{Kind, Plan, STRENGTHS, plan};
use super::experiment::{Control, Sensors};
use super::hidden::{Hidden, Law, Shape};
use super::nominal::{Nominal, turned};
use super::plant::{Plant, Transmission};
use super::random::Random;
use super::reference::Reference;
use super::rigid::Body;
use super::robots::{Robot, robot};
use nalgebra::{Matrix3, Vector3};

/// A case before anything is simulated; sizes of effects are still open.
#[derive(Clone, Debug)]
pub struct Case {
    pub number: u64,
    pub plan: Plan,
    /// The robot without what is hidden.
    pub truth: Robot,
    pub nominal: Nominal,
    pub control: Control,
    /// References of the two logs.
    pub references: [Reference; 2],
    /// Length of a log \[s\].
    pub duration_s: f64,
    pub sensors: Sensors,
    /// Standard deviation of measured torques against their root mean square.
    pub relative_noise: f64,
    pub hidden: Vec<Hidden>,
    /// How strong each effect shall be.
    pub target: f64,
    /// Of forces that no sensor sees, for the two logs.
    pub seeds: [f64; 2],
    pub recording: Recording,
    /// Standard deviation of what drives give beside their commands against their largest torque.
    pub relative_disturbance: f64,
    /// The same \[N m\], once the largest torques are known.
    pub disturbance: Vec<f64>,
}

impl Case {
    /// The case of a number.
    pub fn new(number: u64) -> Self {
        let plan = plan(number);
        let mut truth = robot(plan.robot);
        let mut random = Random::new(number, "effects");
        let mut hidden = draw_hidden(&plan, &truth, &mut random);
        for one in &hidden {
            let drive = &mut truth.joints[one.joint].drive;
            if !one.law.keeps_coulomb() {
                drive.coulomb = 0.0;
            }
            if one.law == Law::Viscous {
                drive.viscous = 0.0;
            }
        }
        let mut nominal = Nominal::draw(&truth, plan.exact, &mut Random::new(number, "nominal"));
        nominal.coriolis = !plan.laws.contains(&Law::Coriolis);
        for one in hidden.iter_mut().filter(|one| one.law == Law::RotorInertia) {
            nominal.robot.joints[one.joint].drive.rotor = 0.0;
            one.size = truth.joint_side(one.joint)[0];
        }
        let mut random = Random::new(number, "motion");
        let laps = [random.between(4.0, 5.0), random.between(3.0, 3.75)];
        let reach = if plan.still { [0.02, 0.02] } else { [1.0, 1.0] };
        let other = [random.between(0.6, 0.8) * reach[0], random.between(0.7, 0.95) * reach[1]];
        // laps are whole numbers of rows and of samples of the controller
        let whole = |lap: f64| (lap / 0.1).round() * 0.1;
        let references = [(laps[0], reach), (laps[1], other)]
            .map(|(lap, reach)| Reference::draw(&truth, whole(lap), reach, &mut random));
        let mut random = Random::new(number, "loop");
        let control = Control::draw(&mut random);
        let bits = random.between(18.0, 20.5);
        let sensors = Sensors {
            steps: [8, 8, 10][random.below(3)],
            resolution: std::f64::consts::TAU / bits.exp2(),
            encoder_noise: 0.0,
            torque_noise: vec![0.0; truth.joints.len()],
            rate_noise: random.chance(0.3).then_some(2e-3),
        };
        let condition = plan.condition;
        let mut case = Self {
            number,
            truth,
            nominal,
            control,
            references,
            duration_s: 15.0,
            sensors,
            relative_noise: random.log_between(0.004, 0.012),
            hidden,
            target: STRENGTHS[plan.strength].1,
            seeds: [random.unit(), random.unit()],
            plan,
            recording: Recording::default(),
            relative_disturbance: 0.0,
            disturbance: Vec::new(),
        };
        if let Some(condition) = condition {
            case.meet(condition);
        }
        case
    }

    /// The plant of a log (0: training, 1: validation) with some of the effects.
    pub fn plant(&self, hidden: &[Hidden], log: usize) -> Plant {
        let truth = &self.truth;
        let mut plant = Plant { seed: self.seeds[log], ..Plant::new(truth, hidden.to_vec()) };
        let Plant { rows, fall, rotor, transmissions, .. } = &mut plant;
        for one in hidden {
            let (joint, size) = (one.joint, one.size);
            match one.law {
                Law::Payload => {
                    let last = rows.len() - 1;
                    rows[last].body = rows[last].body.with(&payload(one));
                }
                Law::LinkInertia => {
                    let body = &mut rows[joint].body;
                    body.inertia *= 1.0 + size;
                    if one.variant == 0 {
                        body.mass *= 1.0 + size;
                    } else {
                        body.com *= 1.0 + size;
                    }
                }
                Law::BaseTilt => *fall = turned(fall, &tilt_axis(truth, one.shape.phase), size),
                Law::Damper => {
                    let own = transmissions.iter_mut().find(|own| own.joint == joint);
                    own.expect("an elastic joint").damping = size;
                }
                Law::JointElasticity | Law::Backlash => {
                    transmissions.push(transmission(one, rotor[joint]));
                }
                _ => {}
            }
        }
        plant
    }
}

/// A lump on the last link; law 1 is a ball of some size.
fn payload(hidden: &Hidden) -> Body {
    let shape = &hidden.shape;
    let com =
        Vector3::new(0.06 * shape.first, 0.04 * (shape.second - 0.5), 0.03 + 0.05 * shape.second);
    let moment = if hidden.variant == 0 { 0.0 } else { 0.4 * hidden.size * 0.05 * 0.05 };
    Body { mass: hidden.size, com, inertia: Matrix3::identity() * moment }
}

/// Horizontal axis of a tilt; of planar robots the one that their motion feels.
fn tilt_axis(robot: &Robot, phase: f64) -> Vector3<f64> {
    if robot.is_planar() { Vector3::z() } else { Vector3::new(phase.cos(), phase.sin(), 0.0) }
}

fn transmission(hidden: &Hidden, rotor: f64) -> Transmission {
    let joint = hidden.joint;
    if hidden.law == Law::JointElasticity {
        let stiffness = 1.0 / hidden.size;
        let share = if hidden.variant == 0 { 0.01 } else { 0.1 };
        let damping = share * 2.0 * (stiffness * rotor).sqrt();
        return Transmission { joint, stiffness, damping, play: 0.0, soft: false };
    }
    // a stiff gear: 25 Hz of the rotor alone and more, well damped
    let stiffness = rotor * 250.0_f64.powi(2);
    let damping = 0.2 * (stiffness * rotor).sqrt();
    Transmission { joint, stiffness, damping, play: hidden.size, soft: hidden.variant == 1 }
}

/// Joints on which an effect can be seen.
fn joints_for(law: Law, robot: &Robot) -> Vec<usize> {
    let count = robot.joints.len();
    let all: Vec<usize> = (0..count).collect();
    let bears_load: Vec<usize> = match robot.name {
        "pendulum" | "double_pendulum" => all.clone(),
        "tulip_leg" | "tulip_leg_elastic" => vec![1, 2, 3],
        _ => vec![1, 2],
    };
    match law {
        Law::JointZero
        | Law::LoadFriction
        | Law::Capstan
        | Law::GearEfficiency
        | Law::TorqueGain => bears_load,
        Law::LinkInertia if robot.name.starts_with("tulip") => vec![2],
        Law::LinkInertia => bears_load,
        Law::Damper => all[robot.elastic().unwrap_or(0)..].to_vec(),
        Law::RotorInertia | Law::JointElasticity | Law::Backlash => {
            all[..robot.elastic().unwrap_or(count)].to_vec()
        }
        _ => all,
    }
}

fn draw_hidden(plan: &Plan, robot: &Robot, random: &mut Random) -> Vec<Hidden> {
    let mut hidden: Vec<Hidden> = Vec::new();
    for (law, variant) in plan.laws.iter().zip(&plan.variants) {
        let mut joints = joints_for(*law, robot);
        if plan.kind == Kind::Thesis && plan.laws.len() > 1 {
            joints = vec![robot.joints.len() - 1];
        } else if joints.len() > 1 {
            // effects of a pair stand on different joints where they can
            joints.retain(|joint| hidden.iter().all(|other| other.joint != *joint));
        }
        let joint = joints[random.below(joints.len())];
        let count = robot.joints.len();
        let other = if joint + 1 < count { joint + 1 } else { joint.saturating_sub(1) };
        let shape = Shape {
            first: random.unit(),
            second: random.unit(),
            phase: random.between(0.0, std::f64::consts::TAU),
            ..Shape::default()
        };
        hidden.push(Hidden { law: *law, variant: *variant, joint, other, size: 0.0, shape });
    }
    hidden
}
