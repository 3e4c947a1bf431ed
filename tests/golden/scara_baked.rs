// Dynamics of the robot `scara`.
//
// Written by denavit-codegen 0.1.0; do not edit, generate it again.
//
// model: scara, hash eea948bf1b36b8a4
// parameters: none: the functions hold all values
// description: SCARA arm: two parallel revolute joints, a vertical prismatic one, and a
// revolute wrist.
// source: The usual SCARA geometry (RRPR); numbers of this project.
// assumed: Masses, centres of mass and inertias are round values of the right size, not those
// of one machine; the inertias are physically consistent.
// assumed: All axes point up: a positive q_quill lifts the tool.
//
// Operations of one call (sub counts as add; prelude: on parameters alone, done once):
//
//     function              mul      add      neg   sincos
//     inverse_dynamics       33       23        0        2
//     mass_matrix            14       18        0        2
//     gravity_vector          0        0        0        0
//     link_transforms         8        5        3        3

use denavit_runtime::Scalar;

/// Number of degrees of freedom: of entries of `q`, `qd`, `qdd` and `tau`.
pub const DOF: usize = 4;

/// The moving joints, in the order of the entries of `q`.
pub const JOINT_NAMES: [&str; DOF] = ["shoulder", "elbow", "quill", "wrist"];

/// Nothing: the values of the parameters are part of the functions. It is here so that functions
/// are called alike whether parameters are tunable or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<S> {
    scalar: core::marker::PhantomData<S>,
}

impl<S> Default for Parameters<S> {
    fn default() -> Self {
        Self {
            scalar: core::marker::PhantomData,
        }
    }
}

/// Joint torques of a motion: tau = D(q) qdd + C(q, qd) qd + G(q) + drive torques.
///
/// - `q`: joint positions (rad, m)
/// - `qd`: joint velocities (rad/s, m/s)
/// - `qdd`: joint accelerations (rad/s^2, m/s^2)
///
/// Result: Joint torques, positive along the axes \[N m, N\].
///
/// One call: 33 mul, 23 add, 2 sincos.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn inverse_dynamics<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
    qdd: &[S; DOF],
) -> [S; DOF] {
    let _ = parameters;
    let (sines, cosines) = S::sincos_all([q[1], q[3]]);
    let [s2, s4] = sines;
    let [c2, c4] = cosines;
    let k1 = S::from_f64(0.35);
    let t1 = qd[0] * qd[0] * k1;
    let t2 = k1 * qdd[0];
    let t3 = qd[0] + qd[1];
    let t4 = t3 * t3;
    let k2 = S::from_f64(0.25);
    let t5 = c2 * t1 - s2 * t2 + k2 * t4;
    let t6 = s2 * t1 + c2 * t2;
    let t7 = qdd[0] + qdd[1];
    let t8 = t6 + k2 * t7;
    let k5 = S::from_f64(0.006);
    let t9 = qdd[3] + t7;
    let k9 = S::from_f64(0.00056);
    let t10 = k9 * t9 + (s4 * t5 + c4 * t8) * k5;
    let k6 = S::from_f64(1.8);
    let t11 = qd[3] + t3;
    let t12 = t11 * t11 * k5;
    let t13 = k5 * t9;
    let t14 = k6 * t8 - (s4 * t12 - c4 * t13);
    let k4 = S::from_f64(0.585);
    let k8 = S::from_f64(0.12165);
    let t15 = k8 * t7 + k4 * t6 + (t10 + k2 * t14);
    let t16 = c4 * t12 + s4 * t13 + k6 * t5 + k4 * t4;
    let t17 = s2 * t16 - (k4 * t7 + t14) * c2;
    let k7 = S::from_f64(0.85355);
    let t18 = t15 - k1 * t17 + qdd[0] * k7;
    let k3 = S::from_f64(9.81);
    let t19 = (k3 + qdd[2]) * k6;
    [t18, t15, t19, t10]
}

/// Mass matrix D(q), symmetric.
///
/// - `q`: joint positions (rad, m)
///
/// Result: D(q), symmetric, rotors included \[kg m^2, kg m, kg\].
///
/// One call: 14 mul, 18 add, 2 sincos.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn mass_matrix<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; DOF] {
    let _ = parameters;
    let (sines, cosines) = S::sincos_all([q[1], q[3]]);
    let [s2, s4] = sines;
    let [c2, c4] = cosines;
    let k3 = S::from_f64(0.006);
    let t1 = k3 * c4;
    let k11 = S::from_f64(1.035);
    let t2 = k3 * s4 * s2;
    let t3 = (t1 + k11) * c2 - t2;
    let k8 = S::from_f64(0.63);
    let k1 = S::from_f64(0.35);
    let t4 = k1 * t3;
    let k7 = S::from_f64(0.45);
    let k2 = S::from_f64(0.25);
    let k9 = S::from_f64(0.0015);
    let t5 = c4 * k9;
    let t6 = (k7 + t1) * k2 + t5;
    let k12 = S::from_f64(0.003);
    let t7 = (c2 * t6 - s4 * k12 * s2) * c2;
    let k10 = S::from_f64(0.061105);
    let t8 = (k8 + t3) * k1 + t4;
    let k5 = S::from_f64(0.85355);
    let t9 = t6 + k10 - t7 + (k10 + t7 + t8 + k5);
    let k13 = S::from_f64(0.12221);
    let t10 = t6 + k13;
    let t11 = t4 + t10;
    let k6 = S::from_f64(0.00056);
    let t12 = k6 + t5;
    let t13 = t12 - (t2 - c2 * t1) * k1;
    let zero = S::ZERO;
    let k4 = S::from_f64(1.8);
    [
        [t9, t11, zero, t13],
        [t11, t10, zero, t12],
        [zero, zero, k4, zero],
        [t13, t12, zero, k6],
    ]
}

/// Gravity torques G(q), the gradient of the potential energy.
///
/// - `q`: joint positions (rad, m)
///
/// Result: G(q) = dP/dq of gravity \[N m, N\].
///
/// One call: no operation.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn gravity_vector<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [S; DOF] {
    let _ = parameters;
    let _ = q;
    let zero = S::ZERO;
    let k1 = S::from_f64(17.658);
    [zero, zero, k1, zero]
}

/// Homogeneous transforms of the link frames.
///
/// - `q`: joint positions (rad, m)
///
/// Result: Link by link, the upper three rows \[R | o\] of the transform to the world frame
/// \[1, m\].
///
/// One call: 8 mul, 5 add, 3 neg, 3 sincos.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn link_transforms<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[[S; 4]; 3]; 4] {
    let _ = parameters;
    let mut result = [[[S::ZERO; 4]; 3]; 4];
    let one = S::ONE;
    result[0][2][2] = one;
    result[1][2][2] = one;
    result[2][2][2] = one;
    result[3][2][2] = one;
    result[2][2][3] = q[2];
    result[3][2][3] = q[2];
    let t1 = q[0] + q[1];
    let (sines, cosines) = S::sincos_all([q[0], q[3], t1]);
    let [s1, s4, s12] = sines;
    let [c1, c4, c12] = cosines;
    result[0][1][0] = s1;
    result[0][0][0] = c1;
    result[0][1][1] = c1;
    result[1][1][0] = s12;
    result[2][1][0] = s12;
    result[1][0][0] = c12;
    result[1][1][1] = c12;
    result[2][0][0] = c12;
    result[2][1][1] = c12;
    result[0][0][1] = -s1;
    let k1 = S::from_f64(0.35);
    let t2 = k1 * c1;
    result[0][0][3] = t2;
    let t3 = k1 * s1;
    result[0][1][3] = t3;
    let t4 = -s12;
    result[1][0][1] = t4;
    result[2][0][1] = t4;
    let k2 = S::from_f64(0.25);
    let t5 = t2 + k2 * c12;
    result[1][0][3] = t5;
    result[2][0][3] = t5;
    result[3][0][3] = t5;
    let t6 = t3 + k2 * s12;
    result[1][1][3] = t6;
    result[2][1][3] = t6;
    result[3][1][3] = t6;
    let t7 = c4 * c12 - s4 * s12;
    result[3][0][0] = t7;
    result[3][1][1] = t7;
    let t8 = s4 * c12 + c4 * s12;
    result[3][1][0] = t8;
    result[3][0][1] = -t8;
    result
}
