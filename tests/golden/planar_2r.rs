// Dynamics of the robot `planar_2r`.
//
// Written by denavit-codegen 0.1.0; do not edit, generate it again.
//
// model: planar_2r, hash 0175d7549c3ceed4
// parameters: tunable at run time (`ModelParameters`)
// description: Planar arm of two revolute joints, gravity in the plane.
// source: Textbook arm; numbers of this project.
// assumed: The values are round ones for a bench-sized arm.
// assumed: Three-dimensional bodies with all ten parameters, although a planar arm feels only
// mass, two first moments and one inertia of each.
//
// Operations of one call (sub counts as add; prelude: on parameters alone, done once):
//
//     function                 mul      add      neg      div   sincos  prelude
//     inverse_dynamics          23       15        2        0        2       44
//     mass_matrix                3        3        0        0        1       45
//     dynamics_terms            12       10        2        0        3       50
//     forward_dynamics          28       17        1        1        2       49
//     link_jacobian_link1        2        0        1        0        1        0
//     link_jacobian_link2        4        3        2        0        2        0
//     kinetic_energy             8        5        0        0        1       46
//     base_regressor            16       10        5        0        2        0
//     base_parameters            0        0        0        0        0       29

use denavit_runtime::Scalar;

/// Number of degrees of freedom: of entries of `q`, `qd`, `qdd` and `tau`.
pub const DOF: usize = 2;

/// The moving joints, in the order of the entries of `q`.
pub const JOINT_NAMES: [&str; DOF] = ["link1", "link2"];

/// A link of the robot.
#[allow(clippy::enum_variant_names)] // the model's names are kept
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Link {
    /// "link1"
    Link1,
    /// "link2"
    Link2,
}

impl Link {
    /// All of them, in the order of the model.
    pub const ALL: [Self; 2] = [Self::Link1, Self::Link2];

    /// The name in the model.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Link1 => "link1",
            Self::Link2 => "link2",
        }
    }
}

/// The parameters of the model, by the names of its file. Change what differs on your robot, then
/// make [`Parameters`] of it.
#[allow(non_snake_case)] // the model's names are kept
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelParameters<S> {
    /// length of link 1; unit `m`; 0.5 in the model.
    pub l1: S,
    /// length of link 2; unit `m`; 0.4 in the model.
    pub l2: S,
    /// gravity; unit `m/s^2`; 9.81 in the model.
    pub g: S,
    /// Mass of `link1`; unit `kg`; 2.0 in the model.
    pub m_link1: S,
    /// Centre of mass x of `link1`, in its frame; unit `m`; -0.22 in the model.
    pub cx_link1: S,
    /// Centre of mass y of `link1`, in its frame; unit `m`; 0.0 in the model.
    pub cy_link1: S,
    /// Centre of mass z of `link1`, in its frame; unit `m`; 0.0 in the model.
    pub cz_link1: S,
    /// Inertia xx of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.001 in the
    /// model.
    pub Ixx_link1: S,
    /// Inertia yy of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.04 in the
    /// model.
    pub Iyy_link1: S,
    /// Inertia zz of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.04 in the
    /// model.
    pub Izz_link1: S,
    /// Inertia xy of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixy_link1: S,
    /// Inertia xz of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixz_link1: S,
    /// Inertia yz of `link1`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Iyz_link1: S,
    /// Mass of `link2`; unit `kg`; 1.5 in the model.
    pub m_link2: S,
    /// Centre of mass x of `link2`, in its frame; unit `m`; -0.17 in the model.
    pub cx_link2: S,
    /// Centre of mass y of `link2`, in its frame; unit `m`; 0.0 in the model.
    pub cy_link2: S,
    /// Centre of mass z of `link2`, in its frame; unit `m`; 0.0 in the model.
    pub cz_link2: S,
    /// Inertia xx of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.001 in the
    /// model.
    pub Ixx_link2: S,
    /// Inertia yy of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.03 in the
    /// model.
    pub Iyy_link2: S,
    /// Inertia zz of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.03 in the
    /// model.
    pub Izz_link2: S,
    /// Inertia xy of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixy_link2: S,
    /// Inertia xz of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixz_link2: S,
    /// Inertia yz of `link2`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Iyz_link2: S,
}

#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
impl<S: Scalar> Default for ModelParameters<S> {
    /// The values that the model's file gives.
    fn default() -> Self {
        Self {
            l1: S::from_f64(0.5),
            l2: S::from_f64(0.4),
            g: S::from_f64(9.81),
            m_link1: S::from_f64(2.0),
            cx_link1: S::from_f64(-0.22),
            cy_link1: S::from_f64(0.0),
            cz_link1: S::from_f64(0.0),
            Ixx_link1: S::from_f64(0.001),
            Iyy_link1: S::from_f64(0.04),
            Izz_link1: S::from_f64(0.04),
            Ixy_link1: S::from_f64(0.0),
            Ixz_link1: S::from_f64(0.0),
            Iyz_link1: S::from_f64(0.0),
            m_link2: S::from_f64(1.5),
            cx_link2: S::from_f64(-0.17),
            cy_link2: S::from_f64(0.0),
            cz_link2: S::from_f64(0.0),
            Ixx_link2: S::from_f64(0.001),
            Iyy_link2: S::from_f64(0.03),
            Izz_link2: S::from_f64(0.03),
            Ixy_link2: S::from_f64(0.0),
            Ixz_link2: S::from_f64(0.0),
            Iyz_link2: S::from_f64(0.0),
        }
    }
}

impl<S: Scalar> Default for Parameters<S> {
    /// The parameters that the model's file gives, prepared in `f64`.
    fn default() -> Self {
        Parameters::<f64>::new(&ModelParameters::default()).convert()
    }
}

/// What the functions read: the parameters, and what depends on them alone, computed once.
#[allow(non_snake_case)] // the model's names are kept
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<S> {
    l1: S,
    l2: S,
    g: S,
    r1: S,
    r2: S,
    r3: S,
    r4: S,
    r5: S,
    r6: S,
    r7: S,
    r8: S,
    r9: S,
    r10: S,
    r11: S,
    r12: S,
    r13: S,
    r14: S,
    r15: S,
    r16: S,
    r17: S,
    r18: S,
    r19: S,
    r20: S,
    r21: S,
}

impl<S: Scalar> Parameters<S> {
    /// Prepares the parameters of a model: 75 operations.
    ///
    /// Regrouped parameters mix magnitudes. For a scalar of less precision than `f64`, prepare in
    /// `f64` and [`convert`](Parameters::convert).
    #[must_use]
    pub fn new(model: &ModelParameters<S>) -> Self {
        let r1 = model.m_link1 * model.cy_link1;
        let r2 = model.m_link2 * model.cy_link2;
        let t1 = model.m_link2 * model.cx_link2;
        let r3 = t1 + model.l2 * model.m_link2;
        let t2 = model.Ixx_link1 - (model.Iyy_link1 + model.Izz_link1);
        let k1 = S::from_f64(0.5);
        let t3 = model.m_link1 * model.cx_link1;
        let t4 = model.cx_link1 * t3;
        let t5 = t3 + model.l1 * model.m_link1;
        let t6 = k1 * t2 - t4 - (model.l1 * t5 + model.l1 * t3);
        let t7 = model.l1 * model.m_link2;
        let t8 = model.Iyy_link1 - (model.Ixx_link1 + model.Izz_link1);
        let t9 = model.cy_link1 * r1;
        let r4 = k1 * t8 - t9 + (t6 - model.l1 * t7);
        let t10 = model.Ixx_link2 - (model.Iyy_link2 + model.Izz_link2);
        let t11 = model.cx_link2 * t1;
        let t12 = k1 * t10 - t11 - (model.l2 * r3 + model.l2 * t1);
        let t13 = model.Iyy_link2 - (model.Ixx_link2 + model.Izz_link2);
        let t14 = model.cy_link2 * r2;
        let r5 = k1 * t13 - t14 + t12;
        let r6 = -r5;
        let r7 = k1 * r5;
        let r8 = (t5 + t7) * model.g;
        let r9 = model.g * r1;
        let r10 = model.g * r3;
        let r11 = model.g * r2;
        let r12 = model.l1 * r2;
        let r13 = model.l1 * r3;
        let r14 = r4 + r5;
        let k2 = S::from_f64(2.0);
        let r15 = model.l1 * k2;
        let r16 = r4 + r7 + r7;
        let one = S::ONE;
        let r17 = one / r5;
        let r18 = k1 * r4 + r7;
        let t15 = model.m_link1 + model.m_link2;
        let r19 = t3 + model.l1 * t15;
        let t16 = t4 + t9 + model.Izz_link1 + model.l1 * model.l1 * t15;
        let r20 = t16 + t3 * r15;
        let t17 = t11 + t14 + model.Izz_link2 + model.l2 * model.l2 * model.m_link2;
        let r21 = t17 + model.l2 * k2 * t1;
        Self {
            l1: model.l1,
            l2: model.l2,
            g: model.g,
            r1,
            r2,
            r3,
            r4,
            r5,
            r6,
            r7,
            r8,
            r9,
            r10,
            r11,
            r12,
            r13,
            r14,
            r15,
            r16,
            r17,
            r18,
            r19,
            r20,
            r21,
        }
    }
}

impl Parameters<f64> {
    /// The same parameters, for another scalar.
    #[must_use]
    pub fn convert<S: Scalar>(&self) -> Parameters<S> {
        Parameters {
            l1: S::from_f64(self.l1),
            l2: S::from_f64(self.l2),
            g: S::from_f64(self.g),
            r1: S::from_f64(self.r1),
            r2: S::from_f64(self.r2),
            r3: S::from_f64(self.r3),
            r4: S::from_f64(self.r4),
            r5: S::from_f64(self.r5),
            r6: S::from_f64(self.r6),
            r7: S::from_f64(self.r7),
            r8: S::from_f64(self.r8),
            r9: S::from_f64(self.r9),
            r10: S::from_f64(self.r10),
            r11: S::from_f64(self.r11),
            r12: S::from_f64(self.r12),
            r13: S::from_f64(self.r13),
            r14: S::from_f64(self.r14),
            r15: S::from_f64(self.r15),
            r16: S::from_f64(self.r16),
            r17: S::from_f64(self.r17),
            r18: S::from_f64(self.r18),
            r19: S::from_f64(self.r19),
            r20: S::from_f64(self.r20),
            r21: S::from_f64(self.r21),
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
/// One call: 23 mul, 15 add, 2 neg, 2 sincos.
#[must_use]
pub fn inverse_dynamics<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
    qdd: &[S; DOF],
) -> [S; DOF] {
    let p = parameters;
    let (sines, cosines) = S::sincos_all([q[0], q[1]]);
    let [s1, s2] = sines;
    let [c1, c2] = cosines;
    let t1 = p.g * s1 - qd[0] * qd[0] * p.l1;
    let t2 = p.g * c1 + p.l1 * qdd[0];
    let t3 = (s2 * t1 - c2 * t2) * p.r3 + (c2 * t1 + s2 * t2) * p.r2;
    let t4 = qdd[0] + qdd[1];
    let t5 = p.r5 * t4 + t3;
    let t6 = qd[0] + qd[1];
    let t7 = t6 * t6;
    let t8 = (p.r3 * t7 + p.r2 * t4) * s2 - (p.r3 * t4 - p.r2 * t7) * c2;
    let t9 = qdd[0] * p.r4 - (c1 * p.r8 - s1 * p.r9);
    let t10 = -(t5 + p.l1 * t8 + t9);
    let t11 = -t5;
    [t10, t11]
}

/// Mass matrix D(q), symmetric.
///
/// - `q`: joint positions (rad, m)
///
/// Result: D(q), symmetric, rotors included \[kg m^2, kg m, kg\].
///
/// One call: 3 mul, 3 add, 1 sincos.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn mass_matrix<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; DOF] {
    let p = parameters;
    let (s2, c2) = q[1].sincos();
    let t1 = c2 * p.r13 - s2 * p.r12;
    let k1 = S::from_f64(2.0);
    let t2 = k1 * t1 - p.r14;
    let t3 = t1 - p.r5;
    [[t2, t3], [t3, p.r6]]
}

/// What [`dynamics_terms`] computes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DynamicsTerms<S> {
    /// D(q), symmetric, rotors included \[kg m^2, kg m, kg\].
    pub mass_matrix: [[S; DOF]; DOF],
    /// C(q, qd) from the Christoffel symbols: dD/dt - 2 C is skew.
    pub coriolis_matrix: [[S; DOF]; DOF],
    /// G(q) = dP/dq of gravity \[N m, N\].
    pub gravity_vector: [S; DOF],
}

/// D(q), C(q, qd) and G(q) at once; they share most of their work.
///
/// - `q`: joint positions (rad, m)
/// - `qd`: joint velocities (rad/s, m/s)
///
/// One call: 12 mul, 10 add, 2 neg, 3 sincos.
#[must_use]
#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
pub fn dynamics_terms<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
) -> DynamicsTerms<S> {
    let p = parameters;
    let t1 = q[0] + q[1];
    let (sines, cosines) = S::sincos_all([q[0], q[1], t1]);
    let [s1, s2, s12] = sines;
    let [c1, c2, c12] = cosines;
    let t2 = c2 * p.r13 - s2 * p.r12;
    let k1 = S::from_f64(2.0);
    let t3 = k1 * t2 - p.r14;
    let t4 = t2 - p.r5;
    let t5 = c2 * p.r12 + s2 * p.r13;
    let t6 = -(qd[1] * t5);
    let t7 = (qd[0] + qd[1]) * t5;
    let t8 = -t7;
    let t9 = qd[0] * t5;
    let t10 = c12 * p.r10;
    let t11 = s12 * p.r11;
    let t12 = c1 * p.r8 - s1 * p.r9 + t10 - t11;
    let t13 = t10 - t11;
    let zero = S::ZERO;
    DynamicsTerms {
        mass_matrix: [[t3, t4], [t4, p.r6]],
        coriolis_matrix: [[t6, t8], [t9, zero]],
        gravity_vector: [t12, t13],
    }
}

/// Joint accelerations qdd that given torques cause.
///
/// - `q`: joint positions (rad, m)
/// - `qd`: joint velocities (rad/s, m/s)
/// - `tau`: joint torques (N m, N)
///
/// Result: Joint accelerations \[rad/s^2, m/s^2\].
///
/// One call: 28 mul, 17 add, 1 neg, 1 div, 2 sincos.
#[must_use]
pub fn forward_dynamics<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
    tau: &[S; DOF],
) -> [S; DOF] {
    let p = parameters;
    let (sines, cosines) = S::sincos_all([q[0], q[1]]);
    let [s1, s2] = sines;
    let [c1, c2] = cosines;
    let t1 = p.g * s1 - qd[0] * qd[0] * p.l1;
    let t2 = p.g * c1;
    let t3 = (s2 * t1 - c2 * t2) * p.r3 + (c2 * t1 + s2 * t2) * p.r2;
    let t4 = qd[0] + qd[1];
    let t5 = t4 * t4;
    let t6 = (p.r3 * t5 * s2 + p.r2 * t5 * c2) * p.l1;
    let t7 = c1 * p.r8 - s1 * p.r9 - (t3 + t6);
    let t8 = tau[1] + t3;
    let t9 = p.r3 * c2 - p.r2 * s2;
    let t10 = p.r5 - p.l1 * t9;
    let t11 = t10 * p.r17;
    let one = S::ONE;
    let t12 = one / (t9 * p.r15 - p.r16 + t10 * t11);
    let t13 = (tau[0] - t7 - t8 * t11) * t12;
    let t14 = -(t8 * p.r17 + t11 * t13);
    [t13, t14]
}

/// Geometric Jacobian of a link's frame.
///
/// - `q`: joint positions (rad, m)
///
/// Result: Geometric Jacobian of the frame of link link1, world frame: rows vx, vy, vz of its
/// origin, then wx, wy, wz; one column for each joint.
#[must_use]
pub fn link_jacobian<S: Scalar>(
    parameters: &Parameters<S>,
    link: Link,
    q: &[S; DOF],
) -> [[S; DOF]; 6] {
    match link {
        Link::Link1 => link_jacobian_link1(parameters, q),
        Link::Link2 => link_jacobian_link2(parameters, q),
    }
}

/// Geometric Jacobian of a link's frame. Of the link `link1`: 2 mul, 1 neg, 1 sincos.
fn link_jacobian_link1<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; 6] {
    let p = parameters;
    let (s1, c1) = q[0].sincos();
    let t1 = -(p.l1 * s1);
    let t2 = p.l1 * c1;
    let zero = S::ZERO;
    let one = S::ONE;
    [
        [t1, zero],
        [t2, zero],
        [zero, zero],
        [zero, zero],
        [zero, zero],
        [one, zero],
    ]
}

/// Geometric Jacobian of a link's frame. Of the link `link2`: 4 mul, 3 add, 2 neg, 2 sincos.
fn link_jacobian_link2<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; 6] {
    let p = parameters;
    let t1 = q[0] + q[1];
    let (sines, cosines) = S::sincos_all([q[0], t1]);
    let [s1, s12] = sines;
    let [c1, c12] = cosines;
    let t2 = p.l2 * s12;
    let t3 = -(p.l1 * s1 + t2);
    let t4 = -t2;
    let t5 = p.l2 * c12;
    let t6 = p.l1 * c1 + t5;
    let zero = S::ZERO;
    let one = S::ONE;
    [
        [t3, t4],
        [t6, t5],
        [zero, zero],
        [zero, zero],
        [zero, zero],
        [one, one],
    ]
}

/// Kinetic energy.
///
/// - `q`: joint positions (rad, m)
/// - `qd`: joint velocities (rad/s, m/s)
///
/// Result: Of bodies and rotors \[J\].
///
/// One call: 8 mul, 5 add, 1 sincos.
#[must_use]
pub fn kinetic_energy<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF], qd: &[S; DOF]) -> S {
    let p = parameters;
    let (s2, c2) = q[1].sincos();
    let t1 = (qd[0] + qd[1]) * (c2 * p.r13 - s2 * p.r12);
    let t2 = (t1 - qd[1] * p.r5 - qd[0] * p.r18) * qd[0];
    t2 - qd[1] * qd[1] * p.r7
}

/// Regressor R: torques per unit of each base parameter.
///
/// - `q`: joint positions (rad, m)
/// - `qd`: joint velocities (rad/s, m/s)
/// - `qdd`: joint accelerations (rad/s^2, m/s^2)
///
/// Result: Row: joint. Columns, those of `base_parameters`: sx_link1, sy_link1, Jzz_link1,
/// sx_link2, sy_link2, Jzz_link2.
///
/// One call: 16 mul, 10 add, 5 neg, 2 sincos.
#[must_use]
pub fn base_regressor<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
    qdd: &[S; DOF],
) -> [[S; 6]; DOF] {
    let p = parameters;
    let (sines, cosines) = S::sincos_all([q[0], q[1]]);
    let [s1, s2] = sines;
    let [c1, c2] = cosines;
    let t1 = p.g * c1;
    let t2 = p.g * s1;
    let t3 = -t2;
    let t4 = t2 - qd[0] * qd[0] * p.l1;
    let t5 = t1 + p.l1 * qdd[0];
    let t6 = s2 * t4 - c2 * t5;
    let t7 = qd[0] + qd[1];
    let t8 = t7 * t7;
    let t9 = p.l1 * s2;
    let t10 = qdd[0] + qdd[1];
    let t11 = p.l1 * c2;
    let t12 = -(t8 * t9 - t10 * t11 + t6);
    let t13 = c2 * t4 + s2 * t5;
    let t14 = -(t10 * t9 + t8 * t11 + t13);
    let t15 = -t6;
    let t16 = -t13;
    let zero = S::ZERO;
    [
        [t1, t3, qdd[0], t12, t14, t10],
        [zero, zero, zero, t15, t16, t10],
    ]
}

/// Base parameters: what `base_regressor` is multiplied with, for torques.
///
/// Result: One for each column of `base_regressor`, in the names of `denavit base --basis
/// joints`. Of link L, m_L, mx_L .. mz_L and Ixx_L .. Iyz_L are mass, mass times centre of mass
/// and inertia about the origin of the link frame.
///
/// - `sx_link1` \[kg m\]: `mx_link1 + l1*(m_link1 + m_link2)`
/// - `sy_link1` \[kg m\]: `my_link1`
/// - `Jzz_link1` \[kg m^2\]: `Izz_link1 + l1^2*(m_link1 + m_link2) + 2*l1*mx_link1`
/// - `sx_link2` \[kg m\]: `mx_link2 + l2*m_link2`
/// - `sy_link2` \[kg m\]: `my_link2`
/// - `Jzz_link2` \[kg m^2\]: `Izz_link2 + l2^2*m_link2 + 2*l2*mx_link2`
///
/// One call: no operation.
#[must_use]
pub fn base_parameters<S: Scalar>(parameters: &Parameters<S>) -> [S; 6] {
    let p = parameters;
    [p.r19, p.r1, p.r20, p.r3, p.r2, p.r21]
}
