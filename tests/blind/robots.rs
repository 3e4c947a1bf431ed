//! The robots of the battery, as numbers.
//!
//! PUMA 560: Armstrong, Khatib, Burdick 1986 with the motors of Corke, Armstrong-Helouvry 1994.
//! Leg: tables 3.1, 3.3, 3.5 and 3.6 of van Zutven's thesis with the gear of `tulip_leg5`. The
//! pendulums and the spatial arm are bench-sized robots of our own.

use super::rigid::{Body, Row};
use nalgebra::{Matrix3, Vector3};

/// Spring between motor and joint, over pulleys of one radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    /// Of the cable [N/m].
    pub stiffness: f64,
    /// Of both pulleys \[m\].
    pub radius: f64,
}

/// A drive, on the side of the motor's shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drive {
    /// Turns of the motor per turn of the joint.
    pub gear: f64,
    /// Inertia [kg m^2].
    pub rotor: f64,
    /// Friction [N m s/rad].
    pub viscous: f64,
    /// Friction [N m].
    pub coulomb: f64,
    /// Series elasticity.
    pub spring: Option<Spring>,
}

/// How far and fast a joint moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    /// Middle of the motion \[rad\].
    pub middle: f64,
    /// Farthest from the middle \[rad\].
    pub reach: f64,
    /// Fastest [rad/s].
    pub rate: f64,
}

/// A joint with its link and drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Joint {
    pub name: &'static str,
    pub row: Row,
    pub drive: Drive,
    pub range: Range,
}

/// A chain of revolute joints.
#[derive(Clone, Debug, PartialEq)]
pub struct Robot {
    pub name: &'static str,
    /// Acceleration of free fall [m/s^2].
    pub fall: Vector3<f64>,
    pub joints: Vec<Joint>,
}

impl Robot {
    /// Rows of the chain.
    pub fn rows(&self) -> Vec<Row> {
        self.joints.iter().map(|joint| joint.row).collect()
    }

    /// Whether all axes are parallel.
    pub fn is_planar(&self) -> bool {
        self.joints.iter().all(|joint| joint.row.alpha == 0)
    }

    /// Number of the first series elastic joint.
    pub fn elastic(&self) -> Option<usize> {
        self.joints.iter().position(|joint| joint.drive.spring.is_some())
    }
}

/// The robots, by name.
pub const ROBOTS: [&str; 6] =
    ["pendulum", "double_pendulum", "spatial_3r", "puma560", "tulip_leg", "tulip_leg_elastic"];

/// A robot by its number in [`ROBOTS`].
pub fn robot(number: usize) -> Robot {
    match number {
        0 => pendulum(),
        1 => double_pendulum(),
        2 => spatial_3r(),
        3 => puma(),
        4 => leg(false),
        _ => leg(true),
    }
}

fn body(mass: f64, com: [f64; 3], moments: [f64; 3]) -> Body {
    let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
    Body { mass, com: com.into(), inertia }
}

fn row(a: f64, alpha: i32, d: f64, theta: i32, body: Body) -> Row {
    Row { a, alpha, d, theta, body }
}

fn drive([gear, rotor, viscous, coulomb]: [f64; 4]) -> Drive {
    Drive { gear, rotor, viscous, coulomb, spring: None }
}

fn joint(name: &'static str, row: Row, numbers: [f64; 4], range: [f64; 3]) -> Joint {
    let [middle, reach, rate] = range;
    Joint { name, row, drive: drive(numbers), range: Range { middle, reach, rate } }
}

fn pendulum() -> Robot {
    let rod = body(2.0, [-0.2, 0.0, 0.0], [0.001, 0.04, 0.04]);
    let joints =
        vec![joint("rod", row(0.5, 0, 0.0, 0, rod), [50.0, 2e-5, 6e-5, 0.008], [-1.2, 1.3, 3.0])];
    Robot { name: ROBOTS[0], fall: Vector3::new(0.0, -9.81, 0.0), joints }
}

fn double_pendulum() -> Robot {
    let upper = body(2.0, [-0.22, 0.0, 0.0], [0.001, 0.04, 0.04]);
    let lower = body(1.5, [-0.17, 0.0, 0.0], [0.001, 0.03, 0.03]);
    let joints = vec![
        joint("link1", row(0.5, 0, 0.0, 0, upper), [60.0, 3e-5, 5e-5, 0.01], [-1.3, 1.1, 2.5]),
        joint("link2", row(0.4, 0, 0.0, 0, lower), [50.0, 2e-5, 4e-5, 0.006], [0.4, 1.4, 3.0]),
    ];
    Robot { name: ROBOTS[1], fall: Vector3::new(0.0, -9.81, 0.0), joints }
}

fn spatial_3r() -> Robot {
    let column = body(4.0, [0.0, -0.1, 0.01], [0.03, 0.02, 0.03]);
    let upper = body(3.0, [-0.21, 0.01, 0.03], [0.006, 0.05, 0.052]);
    let fore = body(1.6, [-0.16, 0.0, 0.02], [0.003, 0.022, 0.023]);
    let joints = vec![
        joint("column", row(0.0, 1, 0.3, 0, column), [80.0, 4e-5, 1e-4, 0.02], [0.0, 1.5, 2.5]),
        joint("upper", row(0.4, 0, 0.05, 0, upper), [100.0, 4e-5, 8e-5, 0.015], [0.6, 1.0, 2.0]),
        joint("fore", row(0.35, 0, 0.0, 0, fore), [80.0, 2e-5, 5e-5, 0.009], [-0.7, 1.2, 2.8]),
    ];
    Robot { name: ROBOTS[2], fall: Vector3::new(0.0, 0.0, -9.81), joints }
}

fn puma() -> Robot {
    let waist = body(0.0, [0.0; 3], [0.0, 0.35, 0.0]);
    let shoulder = body(17.4, [-0.3638, 0.006, 0.2275], [0.13, 0.524, 0.539]);
    let elbow = body(4.8, [-0.0203, -0.0141, 0.07], [0.066, 0.086, 0.0125]);
    let roll = body(0.82, [0.0, 0.019, 0.0], [0.0018, 0.0013, 0.0018]);
    let pitch = body(0.34, [0.0; 3], [0.0003, 0.0004, 0.0003]);
    let yaw = body(0.09, [0.0, 0.0, 0.032], [0.00015, 0.00015, 0.00004]);
    let joints = vec![
        joint(
            "waist",
            row(0.0, 1, 0.0, 0, waist),
            [-62.6111, 2e-4, 0.00148, 0.435],
            [0.0, 1.3, 2.0],
        ),
        joint(
            "shoulder",
            row(0.4318, 0, 0.0, 0, shoulder),
            [107.815, 2e-4, 0.000817, 0.126],
            [0.8, 0.9, 1.5],
        ),
        joint(
            "elbow",
            row(0.0203, -1, 0.15005, 0, elbow),
            [-53.7063, 2e-4, 0.00138, 0.132],
            [-0.6, 1.1, 2.0],
        ),
        joint(
            "wrist_roll",
            row(0.0, 1, 0.4318, 0, roll),
            [76.0364, 3.3e-5, 7.12e-5, 0.0169],
            [0.3, 1.3, 3.0],
        ),
        joint(
            "wrist_pitch",
            row(0.0, -1, 0.0, 0, pitch),
            [71.923, 3.3e-5, 8.26e-5, 0.0145],
            [0.0, 1.2, 3.0],
        ),
        joint(
            "wrist_yaw",
            row(0.0, 0, 0.0, 0, yaw),
            [76.686, 3.3e-5, 3.67e-5, 0.0105],
            [0.0, 1.6, 3.5],
        ),
    ];
    Robot { name: ROBOTS[3], fall: Vector3::new(0.0, 0.0, -9.81), joints }
}

/// The leg; with springs it carries 2 kg on its foot, so that they have something to bear.
fn leg(elastic: bool) -> Robot {
    let flank = body(0.614, [0.0, 0.007, 0.054], [0.00095, 0.00056, 0.00002]);
    let hip = body(0.614, [-0.028, 0.066, 0.0], [0.00056, 0.00002, 0.00095]);
    let thigh = body(2.141, [-0.193, -0.054, -0.03], [0.00148, 0.01467, 0.01134]);
    let shin = body(0.315, [-0.144, 0.0, -0.021], [0.00009, 0.00396, 0.00368]);
    let mut foot = body(0.366, [0.005, -0.068, 0.087], [0.00205, 0.00157, 0.0004]);
    if elastic {
        foot = foot.with(&body(2.0, [0.06, -0.05, 0.02], [0.004, 0.003, 0.003]));
    }
    let mut joints = vec![
        joint(
            "hip_z",
            row(0.0, -1, 0.0, -1, flank),
            [100.0, 3.35e-6, 4e-5, 0.00861],
            [0.0, 0.6, 2.5],
        ),
        joint(
            "hip_x",
            row(0.035, -1, 0.12, 1, hip),
            [100.0, 3.35e-6, 4.2e-4, 0.02167],
            [0.0, 0.5, 2.0],
        ),
        joint(
            "hip_y",
            row(0.275, 0, 0.065, 0, thigh),
            [100.0, 3.35e-6, 8e-5, 0.00456],
            [-0.5, 0.9, 2.5],
        ),
        joint(
            "knee",
            row(0.275, 0, 0.0, 0, shin),
            [100.0, 3.35e-6, 8e-5, 0.00268],
            [1.1, 0.9, 3.0],
        ),
        joint(
            "ankle_y",
            row(0.01, 1, 0.0, 0, foot),
            [100.0, 3.35e-6, 4e-5, 0.01178],
            [0.0, 0.7, 3.0],
        ),
    ];
    if elastic {
        for (joint, stiffness) in joints[2..].iter_mut().zip([83008.0, 59966.0, 51394.0]) {
            joint.drive.spring = Some(Spring { stiffness, radius: 0.03 });
            joint.range.rate *= 0.6;
        }
    }
    let name = if elastic { ROBOTS[5] } else { ROBOTS[4] };
    Robot { name, fall: Vector3::new(0.0, 0.0, -9.81), joints }
}
