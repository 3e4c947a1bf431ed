//! Robots as numbers: one trait for generated modules, models read at run time, and plants written
//! by hand.
//!
//! - [`Plant`]: the functions of a robot, into the caller's memory
//! - [`PlantModel`]: what a simulation must know of it besides: names, drives, contact points
//! - [`LoadedPlant`]: any model file, derived and compiled in memory
//! - [`Cradle`]: balls that collide with each other
//! - [`SimplestWalker`], [`KneedWalker`]: passive walkers with jumps of their own
//! - [`plant_of`]: the fastest plant of a robot: a generated module where there is one
//! - [`RobotFunction`]: any function of a robot, on one sample or on many, from many threads
//! - [`WalkingFunctions`]: momentum about the centre of mass, zero-moment point and the like
//! - [`effect`]: laws of missing physics, with derivatives by their parameters
//! - [`body`], [`coordinates`]: coordinates of bodies, and of all parameters of models, that exist
//! - [`regression`]: torques as linear functions of the base parameters, for many samples at once
//!
//! - [`model_text`]: new values and effects in the text of a model file, which else stays as it is
//! - [`updated_model`]: a model with values that were found
//! - [`trajectory`]: references for joints
//! - [`shipped`]: robots whose model files are part of the library
//! - [`emitted`]: what the compiler made of some of them when this library was built
//! - [`batch`]: emitted functions on many samples, on all processors
//! - [`Error`]: why a robot is no plant, has no regression, or numbers are no reference
//!
//! Matrices are row-major slices, the shape in which emitted code returns them. All units are SI,
//! all vectors and positions are those of the world frame.

pub mod batch;
pub mod body;
pub mod coordinates;
mod cradle;
mod derivatives;
pub mod effect;
pub mod emitted;
mod error;
mod function;
mod generated;
mod laws;
mod loaded;
mod model;
pub mod model_text;
mod native;
mod on_demand;
mod passive_walkers;
pub mod regression;
mod regression_file;
mod regression_model;
mod regression_parameter;
mod regression_rows;
mod regression_values;
pub mod shipped;
pub mod trajectory;
mod updated_model;
mod walking;

pub use cradle::Cradle;
pub use derivatives::ContactDerivatives;
pub use error::{Error, ErrorKind};
pub use function::{RobotFunction, Samples};
pub use generated::{planar_biped, plant_of, puma560, tulip};
pub use laws::{DriveMoment, LawMoment, LawResponse};
pub use loaded::LoadedPlant;
pub use model::{
    DriveModel, GroundModel, JointModel, Override, PlantModel, PointModel, SeriesElasticModel,
    fall_points,
};
pub use native::{Native, NativeBatch, native_code};
pub use passive_walkers::{KneedWalker, SimplestWalker};
pub use updated_model::{FoundValues, UpdatedModel, updated_model};
pub use walking::WalkingFunctions;

/// The functions of a robot with n joints and c contact points. Each may use memory of its own,
/// hence `&mut self`; none changes what another returns.
pub trait Plant {
    /// Names, drives, contact points and ground.
    fn model(&self) -> &PlantModel;

    /// D(q), n x n, symmetric [kg m^2, kg m, kg]; rotors of stiff drives included.
    fn mass_matrix(&mut self, q: &[f64], mass: &mut [f64]);

    /// C qd + G, joint springs and viscous friction: the torque needed at qdd = 0 [N m, N], n
    /// entries. Coulomb friction is not part of it ([`JointModel::coulomb`] is): it is no
    /// function of the rate where the joint rests.
    fn bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]);

    /// Contact points, 3 c entries \[m\].
    fn contact_positions(&mut self, q: &[f64], positions: &mut [f64]);

    /// W^T = d(contact points)/dq, 3 c x n (thesis 2.47).
    fn contact_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]);

    /// (d/dt W^T) qd, 3 c entries [m/s^2].
    fn contact_bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]);

    /// Kinetic energy, rotors of stiff drives included \[J\].
    fn kinetic_energy(&mut self, q: &[f64], qd: &[f64]) -> f64;

    /// Potential energy of gravity and joint springs \[J\].
    fn potential_energy(&mut self, q: &[f64]) -> f64;

    /// Centre of mass \[m\].
    fn center_of_mass(&mut self, q: &[f64]) -> [f64; 3];

    /// Linear momentum [kg m/s], then angular momentum about the centre of mass [kg m^2/s].
    fn momentum(&mut self, q: &[f64], qd: &[f64]) -> [f64; 6];

    /// For each link the upper three rows of its homogeneous transform, 12 entries a link.
    fn link_transforms(&mut self, q: &[f64], transforms: &mut [f64]);

    /// d(centre of mass)/dq, 3 x n: the linear momentum of unit velocities over the mass, where the
    /// plant has no function of its own.
    fn center_of_mass_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
        let (n, mass) = (q.len(), self.model().mass_kg);
        for column in 0..n {
            let unit: Vec<f64> = (0..n).map(|k| f64::from(u8::from(k == column))).collect();
            let momentum = self.momentum(q, &unit);
            (0..3).for_each(|row| jacobian[row * n + column] = momentum[row] / mass);
        }
    }

    /// Functions for walking; none for plants written by hand.
    fn walking(&mut self) -> Option<WalkingFunctions<'_>> {
        None
    }

    /// Derivatives of D qdd + bias, exactly those of [`Plant::mass_matrix`] and [`Plant::bias`]:
    /// by q [N m/rad] and by qd [N m s/rad], n x n, row: torque. That by qdd is D. Answers whether
    /// the plant has them; if not, the slices are left as they are, as by plants written by hand.
    fn inverse_dynamics_derivatives(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        by_position: &mut [f64],
        by_velocity: &mut [f64],
    ) -> bool {
        let _ = (q, qd, qdd, by_position, by_velocity);
        false
    }

    /// Derivatives of the contact points' velocities and accelerations, and of the torques W f of
    /// the forces `f` on them (3 c entries, world frame \[N\]). `derivatives` has the sizes of the
    /// plant ([`ContactDerivatives::new`]). Answers whether the plant has them; if not,
    /// `derivatives` are left as they are, as by plants written by hand.
    fn contact_derivatives(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        f: &[f64],
        derivatives: &mut ContactDerivatives,
    ) -> bool {
        let _ = (q, qd, qdd, f, derivatives);
        false
    }

    /// Number of states that laws of added effects have.
    fn law_states(&self) -> usize {
        0
    }

    /// Whether a law of an added effect depends on accelerations.
    fn has_accelerated_laws(&self) -> bool {
        false
    }

    /// The values of the laws' states at the beginning; those of `moment` are not used.
    fn law_start(&mut self, moment: &LawMoment<'_>) -> Vec<f64> {
        let _ = moment;
        Vec::new()
    }

    /// Torques of laws of added effects, which the bias leaves out, and rates of their states.
    /// Answers whether there are laws; if not, `response` is left as it is.
    fn laws(&mut self, moment: &LawMoment<'_>, response: &mut LawResponse) -> bool {
        let _ = (moment, response);
        false
    }

    /// A run begins: what jumps have changed in the plant is undone.
    fn begin(&mut self) {}

    /// Number of guards: events of its own that a plant written by hand may have, beside those of
    /// its contacts (a knee that locks, a heel strike in a limit of vanishing masses).
    fn guards(&self) -> usize {
        0
    }

    /// The value of a guard: it fires when it falls below 0.
    fn guard(&mut self, guard: usize, q: &[f64], qd: &[f64]) -> f64 {
        let _ = (guard, q, qd);
        f64::INFINITY
    }

    /// What happens when a guard fires: positions and rates may jump, and the plant may change.
    fn jump(&mut self, guard: usize, q: &mut [f64], qd: &mut [f64]) {
        let _ = (guard, q, qd);
    }
}

/// World positions of points fixed in links, 3 entries each, of the links' transforms.
pub fn point_positions(points: &[PointModel], transforms: &[f64], positions: &mut [f64]) {
    for (point, position) in points.iter().zip(positions.chunks_exact_mut(3)) {
        let rows = &transforms[12 * point.link..12 * (point.link + 1)];
        for (row, entry) in rows.chunks_exact(4).zip(position) {
            let along: f64 = row[..3].iter().zip(point.position).map(|(r, p)| r * p).sum();
            *entry = along + row[3];
        }
    }
}
