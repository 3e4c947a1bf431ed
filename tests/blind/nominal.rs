//! The nominal model: what the diagnosis is told of a robot, as numbers and as a model file.

use super::random::Random;
use super::rigid::{MOST, Posture};
use super::robots::{Joint, Robot};
use nalgebra::{Matrix3, Vector3};
use serde_json::{Map, Value, json};

/// A robot as its file has it.
#[derive(Clone, Debug)]
pub struct Nominal {
    pub robot: Robot,
    /// Standard deviation that the file states for every number, relative.
    pub relative_std: f64,
    /// The same of viscous and Coulomb friction.
    pub friction_std: f64,
    /// Whether the model has Coriolis and centrifugal terms.
    pub coriolis: bool,
}

/// Motion of one sample: joint angles and their derivatives, those of the drives.
#[derive(Clone, Copy, Debug)]
pub struct Motion<'a> {
    pub q: &'a [f64],
    pub qd: &'a [f64],
    pub qdd: &'a [f64],
    pub motor: &'a [f64],
    pub motor_rate: &'a [f64],
    pub motor_acceleration: &'a [f64],
}

impl Robot {
    /// Rotor inertia, viscous and Coulomb friction of a drive on the side of its joint.
    pub fn joint_side(&self, joint: usize) -> [f64; 3] {
        let drive = &self.joints[joint].drive;
        let squared = drive.gear * drive.gear;
        [drive.rotor * squared, drive.viscous * squared, drive.coulomb * drive.gear.abs()]
    }
}

impl Nominal {
    /// The robot itself with a standard deviation of 1 %, or every mass, centre of mass, inertia
    /// and friction off by up to 5 %, and 5 % stated.
    ///
    /// Masses, centres of mass and tensors are off by 5 % exactly, up or down; a tensor as a whole,
    /// so that it stays that of a body. Friction is off by anything up to that.
    pub fn draw(robot: &Robot, exact: bool, random: &mut Random) -> Self {
        let mut robot = robot.clone();
        if exact {
            return Self { robot, relative_std: 0.01, friction_std: 0.01, coriolis: true };
        }
        let std = 0.05;
        for joint in &mut robot.joints {
            let body = &mut joint.row.body;
            body.mass *= 1.0 + std * random.sign();
            body.com *= 1.0 + std * random.sign();
            body.inertia *= 1.0 + std * random.sign();
            joint.drive.viscous *= 1.0 + std * random.between(-1.0, 1.0);
            joint.drive.coulomb *= 1.0 + std * random.between(-1.0, 1.0);
        }
        Self { robot, relative_std: std, friction_std: std, coriolis: true }
    }

    /// Number of equations: one for each joint's torque, one for each spring.
    pub fn equations(&self) -> usize {
        self.robot.joints.len() + self.elastic_joints().count()
    }

    /// Joints with springs, in order.
    pub fn elastic_joints(&self) -> impl Iterator<Item = usize> {
        let joints = self.robot.joints.iter().enumerate();
        joints.filter(|(_, joint)| joint.drive.spring.is_some()).map(|(index, _)| index)
    }

    /// Torques that the model says a motion needs, Coulomb friction left out; then, for each
    /// spring, what its joint needs less what it gives, which is 0 if the model is right \[N m\].
    pub fn smooth_torques(&self, motion: &Motion<'_>, equations: &mut [f64]) {
        let joints = self.robot.joints.len();
        let (torques, springs) = equations.split_at_mut(joints);
        let posture = Posture::new(&self.robot.rows(), motion.q);
        let rest = [0.0; MOST];
        let rates = if self.coriolis { motion.qd } else { &rest[..motion.q.len()] };
        posture.torques(rates, motion.qdd, &self.robot.fall, torques);
        for (missed, joint) in springs.iter_mut().zip(self.elastic_joints()) {
            let stretch = motion.motor[joint] - motion.q[joint];
            let spring = self.robot.joints[joint].drive.spring;
            let stiffness = spring.map_or(0.0, |one| one.stiffness * one.radius * one.radius);
            *missed = torques[joint] - stiffness * stretch;
        }
        for (joint, torque) in torques.iter_mut().enumerate() {
            let [rotor, viscous, _] = self.robot.joint_side(joint);
            *torque += rotor * motion.motor_acceleration[joint];
            *torque += viscous * motion.motor_rate[joint];
        }
    }

    /// Every number that the file states a standard deviation for, as a change of the robot by it.
    pub fn deviations(&self) -> Vec<Robot> {
        let mut changed = Vec::new();
        let std = self.relative_std;
        let mut push = |change: &dyn Fn(&mut Joint) -> &mut f64, joint: usize, std: f64| {
            let mut robot = self.robot.clone();
            let number = change(&mut robot.joints[joint]);
            if *number != 0.0 {
                *number *= 1.0 + std;
                changed.push(robot);
            }
        };
        for joint in 0..self.robot.joints.len() {
            push(&|one| &mut one.row.body.mass, joint, std);
            for axis in 0..3 {
                push(&|one| &mut one.row.body.com[axis], joint, std);
                push(&|one| &mut one.row.body.inertia[(axis, axis)], joint, std);
            }
            push(&|one| &mut one.drive.rotor, joint, std);
            push(&|one| &mut one.drive.viscous, joint, self.friction_std);
        }
        for joint in self.elastic_joints() {
            let mut robot = self.robot.clone();
            if let Some(spring) = &mut robot.joints[joint].drive.spring {
                spring.stiffness *= 1.0 + std;
            }
            changed.push(robot);
        }
        changed
    }

    /// The model file.
    pub fn file(&self) -> Value {
        let robot = &self.robot;
        let mut drives = Map::new();
        for joint in &robot.joints {
            drives.insert(joint.name.to_owned(), self.drive(joint));
        }
        let mut file = json!({
            "format": "denavit-model/1",
            "name": robot.name,
            "description": "A robot with its drives, as its maker describes it.",
            "convention": "standard",
            "gravity": <[f64; 3]>::from(robot.fall),
            "links": robot.joints.iter().map(|joint| self.link(joint)).collect::<Vec<_>>(),
            "drives": drives,
        });
        if !self.coriolis {
            file["terms"] = json!(["inertia", "gravity", "friction", "rotor", "spring"]);
        }
        file
    }

    fn number(&self, value: f64) -> Value {
        stated(value, self.relative_std)
    }

    fn link(&self, joint: &Joint) -> Value {
        let quarters = |turns: i32| match turns {
            0 => json!(0),
            _ => json!(format!("{turns}*pi/2")),
        };
        let row = &joint.row;
        let moments = ["xx", "yy", "zz"].iter().enumerate();
        let products = [("xy", (0, 1)), ("xz", (0, 2)), ("yz", (1, 2))];
        let mut inertia: Map<String, Value> = moments
            .map(|(axis, name)| ((*name).to_owned(), self.number(row.body.inertia[(axis, axis)])))
            .collect();
        for (name, at) in products {
            inertia.insert(name.to_owned(), self.number(row.body.inertia[at]));
        }
        let com: Vec<Value> = row.body.com.iter().map(|value| self.number(*value)).collect();
        let mut body = json!({
            "mass": self.number(row.body.mass),
            "com": com,
            "inertia": inertia,
            "about": "com",
        });
        if row.body.mass == 0.0 {
            // of a link on a fixed axis only the moment about it is known
            let known: Map<String, Value> = inertia_of(&body)
                .into_iter()
                .filter(|(_, entry)| entry["std"].is_number())
                .collect();
            body = json!({"inertia": known, "about": "com"});
        } else if breaks_triangle(&row.body.inertia) {
            body["accept_triangle_violation"] = json!("As its maker prints it.");
        }
        json!({
            "name": joint.name,
            "joint": {
                "type": "revolute",
                "a": row.a,
                "alpha": quarters(row.alpha),
                "d": row.d,
                "theta": quarters(row.theta),
            },
            "body": body,
        })
    }

    fn drive(&self, joint: &Joint) -> Value {
        let drive = &joint.drive;
        let mut file = json!({"gear_ratio": drive.gear});
        let entries = [
            ("rotor_inertia", drive.rotor, self.relative_std),
            ("viscous", drive.viscous, self.friction_std),
            ("coulomb", drive.coulomb, self.friction_std),
        ];
        for (name, value, std) in entries.into_iter().filter(|(_, value, _)| *value != 0.0) {
            file[name] = stated(value, std);
        }
        if let Some(spring) = drive.spring {
            file["series_elastic"] = json!({
                "stiffness": self.number(spring.stiffness),
                "motor_radius": spring.radius,
                "load_radius": spring.radius,
            });
        }
        file
    }
}

/// A number with its relative standard deviation; a zero is meant to be one.
fn stated(value: f64, relative_std: f64) -> Value {
    if value == 0.0 { json!(0) } else { json!({"value": value, "std": value.abs() * relative_std}) }
}

fn inertia_of(body: &Value) -> Map<String, Value> {
    body["inertia"].as_object().cloned().unwrap_or_default()
}

/// Whether no body has this tensor: second moments, tr(I)/2 - I, below 0.
fn breaks_triangle(inertia: &Matrix3<f64>) -> bool {
    let second = Matrix3::identity() * (0.5 * inertia.trace()) - inertia;
    second.symmetric_eigenvalues().min() < -1e-9 * inertia.trace()
}

/// A vector turned by an angle about an axis of length 1 (Rodrigues).
pub fn turned(vector: &Vector3<f64>, axis: &Vector3<f64>, angle: f64) -> Vector3<f64> {
    let (sin, cos) = angle.sin_cos();
    vector * cos + axis.cross(vector) * sin + axis * (axis.dot(vector) * (1.0 - cos))
}
