//! Rigid-body dynamics in numbers, all vectors in the world frame.
//!
//! Inverse dynamics is the recursion of Newton and Euler (Luh, Walker, Paul 1980): velocities and
//! accelerations outwards, sums of forces and moments about the world's origin inwards. The mass
//! matrix sums composite bodies (Walker, Orin 1982): momentum of everything beyond joint i when it
//! alone turns, along joint k. Joints are revolute, rows are standard Denavit-Hartenberg rows
//! Rz(theta) Tz(d) Tx(a) Rx(alpha).

use nalgebra::{Matrix3, Vector3};

/// More joints than any robot here has.
pub const MOST: usize = 9;

/// A rigid body in the frame of its link.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Body {
    /// Mass \[kg\].
    pub mass: f64,
    /// Centre of mass \[m\].
    pub com: Vector3<f64>,
    /// Tensor about the centre of mass [kg m^2].
    pub inertia: Matrix3<f64>,
}

impl Body {
    /// Two bodies as one.
    pub fn with(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return Self { inertia: self.inertia + other.inertia, ..*self };
        }
        let com = (self.com * self.mass + other.com * other.mass) / mass;
        let moved = |body: &Self| body.inertia + parallel_axes(body.mass, &(body.com - com));
        Self { mass, com, inertia: moved(self) + moved(other) }
    }
}

/// What a point mass at r adds to a tensor.
fn parallel_axes(mass: f64, r: &Vector3<f64>) -> Matrix3<f64> {
    (Matrix3::identity() * r.norm_squared() - r * r.transpose()) * mass
}

/// A row of the table with its body. Angles of the row are quarter turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Length along x \[m\].
    pub a: f64,
    /// Quarter turns about x.
    pub alpha: i32,
    /// Length along z \[m\].
    pub d: f64,
    /// Quarter turns about z at q = 0.
    pub theta: i32,
    /// The body.
    pub body: Body,
}

/// Sine and cosine of a number of quarter turns, exactly.
fn quarter(turns: i32) -> (f64, f64) {
    [(0.0, 1.0), (1.0, 0.0), (0.0, -1.0), (-1.0, 0.0)][turns.rem_euclid(4) as usize]
}

/// A body in the world.
#[derive(Clone, Copy, Debug)]
struct Placed {
    axis: Vector3<f64>,
    origin: Vector3<f64>,
    com: Vector3<f64>,
    inertia: Matrix3<f64>,
    mass: f64,
}

/// Links as they stand in one posture.
#[derive(Clone, Debug)]
pub struct Posture {
    placed: Vec<Placed>,
    tip: Vector3<f64>,
}

impl Posture {
    /// Forward kinematics of a chain at joint angles q \[rad\].
    pub fn new(rows: &[Row], q: &[f64]) -> Self {
        let (mut turn, mut origin) = (Matrix3::identity(), Vector3::zeros());
        let mut placed = Vec::with_capacity(rows.len());
        for (row, angle) in rows.iter().zip(q) {
            let axis: Vector3<f64> = turn.column(2).into();
            let start = origin;
            let (offset_sin, offset_cos) = quarter(row.theta);
            let (sin, cos) = angle.sin_cos();
            let (s, c) = (sin * offset_cos + cos * offset_sin, cos * offset_cos - sin * offset_sin);
            let (sa, ca) = quarter(row.alpha);
            let local = Matrix3::new(c, -s * ca, s * sa, s, c * ca, -c * sa, 0.0, sa, ca);
            origin += turn * Vector3::new(row.a * c, row.a * s, row.d);
            turn *= local;
            placed.push(Placed {
                axis,
                origin: start,
                com: origin + turn * row.body.com,
                inertia: turn * row.body.inertia * turn.transpose(),
                mass: row.body.mass,
            });
        }
        Self { placed, tip: origin }
    }

    /// Joint torques of motion [N m]; `fall` is the acceleration of free fall [m/s^2].
    pub fn torques(&self, qd: &[f64], qdd: &[f64], fall: &Vector3<f64>, torques: &mut [f64]) {
        let zero = Vector3::zeros();
        let (mut w, mut wd, mut linear, mut at) = (zero, zero, -fall, zero);
        let mut loads = [(zero, zero); MOST];
        for (joint, body) in self.placed.iter().enumerate() {
            // the joint's origin moves with the body before it
            let arm = body.origin - at;
            linear += wd.cross(&arm) + w.cross(&w.cross(&arm));
            at = body.origin;
            wd += body.axis * qdd[joint] + w.cross(&(body.axis * qd[joint]));
            w += body.axis * qd[joint];
            let r = body.com - body.origin;
            let force = (linear + wd.cross(&r) + w.cross(&w.cross(&r))) * body.mass;
            let spin = body.inertia * wd + w.cross(&(body.inertia * w));
            loads[joint] = (force, spin + body.com.cross(&force));
        }
        let (mut force, mut moment) = (zero, zero);
        for (joint, body) in self.placed.iter().enumerate().rev() {
            force += loads[joint].0;
            moment += loads[joint].1;
            torques[joint] = body.axis.dot(&(moment - body.origin.cross(&force)));
        }
    }

    /// The mass matrix, row by row in `matrix[joint][joint]` [kg m^2].
    pub fn mass_matrix(&self, matrix: &mut [[f64; MOST]; MOST]) {
        let (mut mass, mut first, mut second) = (0.0, Vector3::zeros(), Matrix3::zeros());
        for (outer, body) in self.placed.iter().enumerate().rev() {
            mass += body.mass;
            first += body.com * body.mass;
            second += body.inertia + parallel_axes(body.mass, &body.com);
            // rate of the point of the composite body that is at the world's origin
            let rate = body.origin.cross(&body.axis);
            let linear = rate * mass + body.axis.cross(&first);
            let angular = second * body.axis + first.cross(&rate);
            for (inner, other) in self.placed[..=outer].iter().enumerate() {
                let entry = other.axis.dot(&(angular - other.origin.cross(&linear)));
                matrix[outer][inner] = entry;
                matrix[inner][outer] = entry;
            }
        }
    }

    /// Joint torques that a force on the end of the chain makes [N m].
    pub fn of_tip_force(&self, force: &Vector3<f64>, torques: &mut [f64]) {
        for (joint, body) in self.placed.iter().enumerate() {
            torques[joint] = body.axis.dot(&(self.tip - body.origin).cross(force));
        }
    }

    /// Potential energy \[J\].
    pub fn potential(&self, fall: &Vector3<f64>) -> f64 {
        self.placed.iter().map(|body| -body.mass * fall.dot(&body.com)).sum()
    }
}
