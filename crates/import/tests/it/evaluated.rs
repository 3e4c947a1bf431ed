//! Models in numbers, and small matrices of our own to compare them with.

use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{self, Robot};
use denavit_codegen::program::{Evaluator, lower};
use denavit_import::{Options, import, nothing_included};

/// Rows of a homogeneous transform, the last one left out.
pub(crate) type Transform = [[f64; 4]; 3];

/// The model of a description, read.
pub(crate) fn imported(text: &str, options: &Options) -> Robot {
    let found = import("robot.urdf", text.as_bytes(), options, &mut nothing_included);
    let found = found.unwrap_or_else(|error| panic!("{error}"));
    model::read("robot.json", found.model.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

/// The outputs of a function, one array after the other.
pub(crate) fn called(robot: &Robot, name: FunctionName, arguments: &[&[f64]]) -> Vec<f64> {
    let derivation = derive(robot, Flavour::Baked, &[name]).expect("all values are known");
    let program = lower(&derivation.dag, &derivation.functions).expect("finite numbers");
    let routine = program.find(name, None).expect("every robot has it");
    let mut evaluator: Evaluator<f64> = Evaluator::new(routine, &[]);
    let mut outputs = vec![0.0; evaluator.outputs()];
    evaluator.evaluate(arguments, &mut outputs).expect("sizes of the robot");
    outputs
}

/// The frames of rows, by name.
pub(crate) fn frame(robot: &Robot, q: &[f64], name: &str) -> Transform {
    let all = called(robot, FunctionName::LinkTransforms, &[q]);
    let at = robot.links.values().position(|link| link.name == name).expect("a row of that name");
    std::array::from_fn(|row| std::array::from_fn(|column| all[12 * at + 4 * row + column]))
}

pub(crate) const IDENTITY: Transform =
    [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]];

/// `a b`.
pub(crate) fn times(a: &Transform, b: &Transform) -> Transform {
    std::array::from_fn(|row| {
        std::array::from_fn(|column| {
            let sum: f64 = (0..3).map(|k| a[row][k] * b[k][column]).sum();
            sum + if column == 3 { a[row][3] } else { 0.0 }
        })
    })
}

/// A translation.
pub(crate) fn moved([x, y, z]: [f64; 3]) -> Transform {
    [[1.0, 0.0, 0.0, x], [0.0, 1.0, 0.0, y], [0.0, 0.0, 1.0, z]]
}

/// A turn about any axis (Rodrigues).
pub(crate) fn turned(axis: [f64; 3], angle: f64) -> Transform {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|part| part / length);
    let (s, c) = angle.sin_cos();
    let cross = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]];
    let n = [x, y, z];
    std::array::from_fn(|row| {
        std::array::from_fn(|column| match column {
            3 => 0.0,
            _ => {
                let one = if row == column { c } else { 0.0 };
                one + s * cross[row][column] + (1.0 - c) * n[row] * n[column]
            }
        })
    })
}

/// An origin as URDF means it: roll, pitch, yaw about fixed axes.
pub(crate) fn origin(xyz: [f64; 3], [roll, pitch, yaw]: [f64; 3]) -> Transform {
    let turns = [([0.0, 0.0, 1.0], yaw), ([0.0, 1.0, 0.0], pitch), ([1.0, 0.0, 0.0], roll)];
    turns.into_iter().fold(moved(xyz), |frame, (axis, angle)| times(&frame, &turned(axis, angle)))
}

/// Largest difference of two transforms.
pub(crate) fn off(a: &Transform, b: &Transform) -> f64 {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Numbers that look random, from -1 to 1.
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// The next one.
    pub(crate) fn next(&mut self) -> f64 {
        self.whole(1 << 30) as f64 / f64::from(1 << 29) - 1.0
    }

    /// The next whole number below a bound.
    pub(crate) fn whole(&mut self, bound: u64) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % bound
    }
}
