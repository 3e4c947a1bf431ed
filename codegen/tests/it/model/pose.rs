//! Forward kinematics straight from the definition of the table, in plain floating point: an
//! oracle for the rows of model files, not the compiler's kinematics.

use denavit_codegen::expr::{ExprId, Floats, evaluate};
use denavit_codegen::model::{Convention, Robot};

/// Rotation (rows) and origin of a frame, in frame 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) rotation: [[f64; 3]; 3],
    pub(super) origin: [f64; 3],
}

impl Pose {
    const IDENTITY: Self =
        Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], origin: [0.0; 3] };

    fn then(&self, next: &Self) -> Self {
        let rotation = std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                (0..3).map(|k| self.rotation[row][k] * next.rotation[k][column]).sum()
            })
        });
        Self { rotation, origin: self.place(next.origin) }
    }

    /// Where a point of the frame is in frame 0.
    pub(super) fn place(&self, point: [f64; 3]) -> [f64; 3] {
        let turned = self.turn(point);
        std::array::from_fn(|axis| self.origin[axis] + turned[axis])
    }

    /// A direction of the frame in frame 0.
    pub(super) fn turn(&self, v: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|row| (0..3).map(|k| self.rotation[row][k] * v[k]).sum())
    }

    /// A tensor of the frame in the axes of frame 0: R I R^T; entries xx, yy, zz, xy, xz, yz.
    pub(super) fn turn_tensor(&self, [xx, yy, zz, xy, xz, yz]: [f64; 6]) -> [f64; 6] {
        let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
        let entry = |i: usize, j: usize| -> f64 {
            let terms = (0..9).map(|n| {
                let (k, l) = (n / 3, n % 3);
                self.rotation[i][k] * tensor[k][l] * self.rotation[j][l]
            });
            terms.sum()
        };
        [entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)]
    }

    fn about_z(theta: f64, d: f64) -> Self {
        let (s, c) = theta.sin_cos();
        let rotation = [[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]];
        Self { rotation, origin: [0.0, 0.0, d] }
    }

    fn about_x(alpha: f64, a: f64) -> Self {
        let (s, c) = alpha.sin_cos();
        let rotation = [[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]];
        Self { rotation, origin: [a, 0.0, 0.0] }
    }
}

/// The value of an expression with the model's own numbers and the given joint variables (0 where
/// none is given).
pub(super) fn value(robot: &Robot, expr: ExprId, q: &[(&str, f64)]) -> f64 {
    let default = |name: &str| {
        let default = robot.parameters[robot.find_parameter(name)?].default?;
        let number = evaluate(&robot.dag, &[default], &mut Floats::new(|_: &str| None));
        Some(number.expect("defaults have no symbols")[0])
    };
    let mut ring = Floats::new(|name: &str| {
        let variable = q.iter().find(|(known, _)| *known == name).map(|(_, value)| *value);
        variable.or_else(|| default(name)).or(name.starts_with("q_").then_some(0.0))
    });
    evaluate(&robot.dag, &[expr], &mut ring).expect("a value")[0]
}

/// The frame of every link, in link order.
pub(super) fn poses(robot: &Robot, q: &[(&str, f64)]) -> Vec<Pose> {
    let mut poses: Vec<Pose> = Vec::new();
    let ids: Vec<_> = robot.links.keys().collect();
    for link in robot.links.values() {
        let parent = link.parent.and_then(|parent| ids.iter().position(|id| *id == parent));
        let base = parent.map_or(Pose::IDENTITY, |parent| poses[parent]);
        let joint = &link.joint;
        let [a, alpha, d, theta] =
            [joint.a, joint.alpha, joint.d, joint.theta].map(|entry| value(robot, entry, q));
        let variable = joint.variables.map_or(0.0, |symbols| value(robot, symbols.q, q));
        let (theta, d) = match joint.kind {
            denavit_codegen::model::JointKind::Revolute => (theta + variable, d),
            denavit_codegen::model::JointKind::Prismatic => (theta, d + variable),
            denavit_codegen::model::JointKind::Fixed => (theta, d),
        };
        let (turn, twist) = (Pose::about_z(theta, d), Pose::about_x(alpha, a));
        let row = match robot.convention {
            Convention::Standard => turn.then(&twist),
            Convention::Modified => twist.then(&turn),
        };
        poses.push(base.then(&row));
    }
    poses
}

/// The frame of one link.
pub(super) fn pose(robot: &Robot, link: &str, q: &[(&str, f64)]) -> Pose {
    let index = robot.links.values().position(|row| row.name == link).expect("a link");
    poses(robot, q)[index]
}

#[track_caller]
pub(super) fn assert_near<const N: usize>(found: [f64; N], expected: [f64; N], what: &str) {
    for axis in 0..N {
        let error = (found[axis] - expected[axis]).abs();
        assert!(error < 1e-12, "{what}: {found:?}, expected {expected:?}");
    }
}
