// Dynamics of the robot `awkward`.
//
// Written by denavit-codegen 0.1.0; do not edit, generate it again.
//
// model: awkward, hash 436178db3e5b0002
// parameters: tunable at run time (`ModelParameters`)
// description: Text with [brackets], a break and hidden turns. */ {{items}}
// source: https://example.org/[x]
//
// Operations of one call (sub counts as add; prelude: on parameters alone, done once):
//
//     function                 mul      add      neg   sincos  prelude
//     inverse_dynamics           4        2        0        1       43
//     link_jacobian_type         0        0        0        0        0
//     link_jacobian_Self         2        0        1        1        1
//     link_jacobian_type_        2        0        1        1        1
//     potential_energy           2        1        0        1       11

use denavit_runtime::Scalar;

/// Number of degrees of freedom: of entries of `q`, `qd`, `qdd` and `tau`.
pub const DOF: usize = 2;

/// The moving joints, in the order of the entries of `q`.
pub const JOINT_NAMES: [&str; DOF] = ["type", "Self"];

/// A link of the robot.
#[allow(clippy::enum_variant_names)] // the model's names are kept
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Link {
    /// "type"
    Type,
    /// "Self"
    Self_,
    /// "type_"
    Type2,
}

impl Link {
    /// All of them, in the order of the model.
    pub const ALL: [Self; 3] = [Self::Type, Self::Self_, Self::Type2];

    /// The name in the model.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Type => "type",
            Self::Self_ => "Self",
            Self::Type2 => "type_",
        }
    }
}

/// The parameters of the model, by the names of its file. Change what differs on your robot, then
/// make [`Parameters`] of it.
#[allow(non_snake_case)] // the model's names are kept
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModelParameters<S> {
    /// see <https://example.org> \[1\] \<b>; unit `m/s^2`; 9.81 in the model.
    pub p: S,
    /// Constant `live`; unit `m`; 3.14159 in the model.
    pub live: S,
    /// Constant `t1`; unit `m`; 0.5 in the model.
    pub t1: S,
    /// Constant `r1`; unit `m`; 0.25 in the model.
    pub r1: S,
    /// Constant `k1`; unit `m`; 0.125 in the model.
    pub k1: S,
    /// Mass of `type`; unit `kg`; 1.5 in the model.
    pub m_type: S,
    /// Centre of mass y of `type`, in its frame; unit `m`; 0.0 in the model.
    pub cy_type: S,
    /// Inertia xx of `type`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Ixx_type: S,
    /// Inertia yy of `type`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Iyy_type: S,
    /// Inertia zz of `type`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Izz_type: S,
    /// Inertia xy of `type`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixy_type: S,
    /// Inertia xz of `type`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixz_type: S,
    /// Inertia yz of `type`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Iyz_type: S,
    /// Mass of `Self`; unit `kg`; 0.5 in the model.
    pub m_Self: S,
    /// Centre of mass x of `Self`, in its frame; unit `m`; 0.1 in the model.
    pub cx_Self: S,
    /// Centre of mass z of `Self`, in its frame; unit `m`; 0.0 in the model.
    pub cz_Self: S,
    /// Inertia xx of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Ixx_Self: S,
    /// Inertia yy of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Iyy_Self: S,
    /// Inertia zz of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 1.0 in the
    /// model.
    pub Izz_Self: S,
    /// Inertia xy of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixy_Self: S,
    /// Inertia xz of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Ixz_Self: S,
    /// Inertia yz of `Self`, in its frame, about the centre of mass; unit `kg m^2`; 0.0 in the
    /// model.
    pub Iyz_Self: S,
}

#[allow(clippy::approx_constant)] // a model's number may lie near a famous one
impl<S: Scalar> Default for ModelParameters<S> {
    /// The values that the model's file gives.
    fn default() -> Self {
        Self {
            p: S::from_f64(9.81),
            live: S::from_f64(3.14159),
            t1: S::from_f64(0.5),
            r1: S::from_f64(0.25),
            k1: S::from_f64(0.125),
            m_type: S::from_f64(1.5),
            cy_type: S::from_f64(0.0),
            Ixx_type: S::from_f64(1.0),
            Iyy_type: S::from_f64(1.0),
            Izz_type: S::from_f64(1.0),
            Ixy_type: S::from_f64(0.0),
            Ixz_type: S::from_f64(0.0),
            Iyz_type: S::from_f64(0.0),
            m_Self: S::from_f64(0.5),
            cx_Self: S::from_f64(0.1),
            cz_Self: S::from_f64(0.0),
            Ixx_Self: S::from_f64(1.0),
            Iyy_Self: S::from_f64(1.0),
            Izz_Self: S::from_f64(1.0),
            Ixy_Self: S::from_f64(0.0),
            Ixz_Self: S::from_f64(0.0),
            Iyz_Self: S::from_f64(0.0),
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
    r2: S,
    m_Self: S,
    r3: S,
    r4: S,
    r5: S,
    r6: S,
    r7: S,
}

impl<S: Scalar> Parameters<S> {
    /// Prepares the parameters of a model: 49 operations.
    ///
    /// Regrouped parameters mix magnitudes. For a scalar of less precision than `f64`, prepare in
    /// `f64` and [`convert`](Parameters::convert).
    #[must_use]
    pub fn new(model: &ModelParameters<S>) -> Self {
        let r2 = model.live + model.t1;
        let t1 = model.m_Self * model.cx_Self;
        let t2 = model.p * r2 * model.m_Self + model.p * t1;
        let t3 = model.r1 * model.m_type;
        let r3 = model.p * t3 + t2;
        let t4 = model.m_type * model.cy_type;
        let t5 = model.t1 * model.m_Self;
        let r4 = model.p * t4 + model.p * t5;
        let t6 = model.Ixx_type - (model.Iyy_type + model.Izz_type);
        let k1 = S::from_f64(0.5);
        let t7 = model.Ixx_Self - (model.Iyy_Self + model.Izz_Self);
        let t8 = k1 * t6 - model.r1 * t3 + (k1 * t7 - model.cx_Self * t1);
        let t9 = model.Iyy_type - (model.Ixx_type + model.Izz_type);
        let t10 = model.Iyy_Self - (model.Ixx_Self + model.Izz_Self);
        let t11 = k1 * t9 - model.cy_type * t4 + (k1 * t10 - model.t1 * t5);
        let k2 = S::from_f64(2.0);
        let t12 = r2 * k2 * t1 + r2 * r2 * model.m_Self;
        let r5 = t8 + t11 - t12;
        let r6 = (t4 + t5) * model.p;
        let r7 = (t1 + r2 * model.m_Self + t3) * model.p;
        Self {
            r2,
            m_Self: model.m_Self,
            r3,
            r4,
            r5,
            r6,
            r7,
        }
    }
}

impl Parameters<f64> {
    /// The same parameters, for another scalar.
    #[must_use]
    pub fn convert<S: Scalar>(&self) -> Parameters<S> {
        Parameters {
            r2: S::from_f64(self.r2),
            m_Self: S::from_f64(self.m_Self),
            r3: S::from_f64(self.r3),
            r4: S::from_f64(self.r4),
            r5: S::from_f64(self.r5),
            r6: S::from_f64(self.r6),
            r7: S::from_f64(self.r7),
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
/// One call: 4 mul, 2 add, 1 sincos.
#[must_use]
pub fn inverse_dynamics<S: Scalar>(
    parameters: &Parameters<S>,
    q: &[S; DOF],
    qd: &[S; DOF],
    qdd: &[S; DOF],
) -> [S; DOF] {
    let p = parameters;
    let _ = qd;
    let (s1, c1) = q[0].sincos();
    let t1 = c1 * p.r3 - s1 * p.r4 - qdd[0] * p.r5;
    let t2 = qdd[1] * p.m_Self;
    [t1, t2]
}

/// Geometric Jacobian of a link's frame.
///
/// - `q`: joint positions (rad, m)
///
/// Result: Geometric Jacobian of the frame of link type, world frame: rows vx, vy, vz of its
/// origin, then wx, wy, wz; one column for each joint.
#[must_use]
pub fn link_jacobian<S: Scalar>(
    parameters: &Parameters<S>,
    link: Link,
    q: &[S; DOF],
) -> [[S; DOF]; 6] {
    match link {
        Link::Type => link_jacobian_type(parameters, q),
        Link::Self_ => link_jacobian_self(parameters, q),
        Link::Type2 => link_jacobian_type_(parameters, q),
    }
}

/// Geometric Jacobian of a link's frame. Of the link `type`: no operation.
fn link_jacobian_type<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; 6] {
    let _ = parameters;
    let _ = q;
    let zero = S::ZERO;
    let one = S::ONE;
    [
        [zero, zero],
        [zero, zero],
        [zero, zero],
        [zero, zero],
        [zero, zero],
        [one, zero],
    ]
}

/// Geometric Jacobian of a link's frame. Of the link `Self`: 2 mul, 1 neg, 1 sincos.
fn link_jacobian_self<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; 6] {
    let p = parameters;
    let (s1, c1) = q[0].sincos();
    let t1 = -(p.r2 * s1);
    let t2 = p.r2 * c1;
    let zero = S::ZERO;
    let one = S::ONE;
    [
        [t1, zero],
        [t2, zero],
        [zero, one],
        [zero, zero],
        [zero, zero],
        [one, zero],
    ]
}

/// Geometric Jacobian of a link's frame. Of the link `type_`: 2 mul, 1 neg, 1 sincos.
fn link_jacobian_type_<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> [[S; DOF]; 6] {
    let p = parameters;
    let (s1, c1) = q[0].sincos();
    let t1 = -(p.r2 * s1);
    let t2 = p.r2 * c1;
    let zero = S::ZERO;
    let one = S::ONE;
    [
        [t1, zero],
        [t2, zero],
        [zero, one],
        [zero, zero],
        [zero, zero],
        [one, zero],
    ]
}

/// Potential energy.
///
/// - `q`: joint positions (rad, m)
///
/// Result: Of gravity (0 where all centres of mass lie in the origin) and springs \[J\].
///
/// One call: 2 mul, 1 add, 1 sincos.
#[must_use]
pub fn potential_energy<S: Scalar>(parameters: &Parameters<S>, q: &[S; DOF]) -> S {
    let p = parameters;
    let (s1, c1) = q[0].sincos();
    c1 * p.r6 + s1 * p.r7
}
