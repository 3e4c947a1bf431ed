//! Schemes that take contacts into account over whole steps, impacts and forces alike (thesis 2.3.4
//! and 5.2.1).
//!
//! No events are searched: a step solves one contact problem for velocities and impulses, so that
//! simultaneous impacts and infinitely many bounces need nothing special. The price is a fixed step
//! and first order. Two schemes:
//!
//! - [`Scheme::MoreauMidpoint`]: the contacts that are closed at the midpoint q + h/2 v; the law
//!   holds for velocities, with restitution;
//! - [`Scheme::Anitescu`] (Stewart and Trinkle, linearised): the law holds for the gap at the end
//!   of the step, g + h u_n >= 0, without restitution; nothing penetrates beyond the curvature.
//!
//! [`simulate_by_steps`] makes a whole run, with the log and the audits of the event-driven scheme;
//! [`ControlledPlant`] is a plant with its drives and its controller, [`TimeSteppingModel`] all
//! that a step asks of a system; [`TimeStepper`] makes the steps, and allocates nothing once it has
//! seen the largest number of contacts.

mod alike;
mod plant;
mod record;
mod run;
mod stepper;

pub use plant::ControlledPlant;
pub use run::{simulate_by_steps, simulate_by_steps_told};
pub use stepper::TimeStepper;

use super::contact::Space;
use super::contact::delassus::NotPositiveDefinite;
use super::contact::gauss_seidel::SweepLimits;

/// A mechanical system with contact points above a ground.
pub trait TimeSteppingModel {
    /// Number of coordinates n.
    fn dof(&self) -> usize;

    /// Number of contact points.
    fn contacts(&self) -> usize;

    /// Planar or spatial contacts.
    fn space(&self) -> Space;

    /// Heights of all contact points above the ground \[m\].
    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]);

    /// The terms of the equations of motion; `closed` lists the contacts whose rows are wanted.
    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms);

    /// Whether the rates `after` a step, from those `before` it, agree with what the terms were
    /// made for; where not, the step is made again with new terms. A drive at its torque limit has
    /// no damping, which shows only after the step.
    fn accept(&mut self, before: &[f64], after: &[f64], implicitness: f64) -> bool {
        let _ = (before, after, implicitness);
        true
    }
}

/// Where terms are evaluated.
#[derive(Clone, Copy, Debug)]
pub struct Instant<'a> {
    /// Time, of references and controllers \[s\].
    pub t_s: f64,
    /// Coordinates.
    pub q: &'a [f64],
    /// Rates.
    pub qd: &'a [f64],
    /// Better rates for terms that are smooth in them (Coriolis): `qd`, or a mean over the step.
    pub smooth_qd: &'a [f64],
}

/// What a step needs; the matrices have their sizes and are zero before they are filled.
#[derive(Clone, Debug, Default)]
pub struct Terms {
    /// D(q), n x n.
    pub mass: Vec<f64>,
    /// -d(force)/d(rates), n x n, symmetric and positive semidefinite, or a part of it: damping is
    /// taken implicitly. Stiff gains of a PD controller need it (explicitly they are unstable from
    /// a step of twice a foot's inertia over the gain on).
    pub damping: Vec<f64>,
    /// tau - C qd - G, damping at the given rates included, n entries.
    pub force: Vec<f64>,
    /// Rows of the closed contacts in turn, along tangents and normal; (rows) x n.
    pub jacobian: Vec<f64>,
}

/// The scheme of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scheme {
    /// q_m = q + h/2 v; (D + th h B)(v+ - v) = h f(q_m, v) + J^T P for the contacts with
    /// g(q_m) <= 0; q+ = q_m + h/2 v+.
    MoreauMidpoint,
    /// (D + th h B)(v+ - v) = h f(q, v) + J^T P, 0 <= P_n _|_ g(q)/h + u_n+ >= 0; q+ = q + h v+.
    Anitescu {
        /// Contacts farther from the ground are left out \[m\].
        reach_m: f64,
    },
}

/// How the contact problem of a step is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepSolver {
    /// The guess that all contacts stick; where that does not hold, sweeps over friction cones from
    /// the impulses of the step before; damped sweeps where these circle, and pivots with 16 facets
    /// where those do too.
    Sweeps(SweepLimits),
    /// Lemke's method with a pyramid of this many facets in space; exact in a plane.
    Pivots {
        /// An even number, at least 4.
        facets: usize,
    },
}

impl Default for StepSolver {
    fn default() -> Self {
        Self::Sweeps(SweepLimits::default())
    }
}

/// The laws of one contact point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLaw {
    /// Coefficient of Coulomb friction.
    pub friction: f64,
    /// e, 0 to 1; used by the midpoint scheme.
    pub restitution: f64,
}

/// How steps are made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stepping {
    /// The scheme.
    pub scheme: Scheme,
    /// h; a run shortens steps so that some end at samples, rows and jumps of references \[s\].
    pub step_s: f64,
    /// th, 0 to 1: the part of the damping that is taken at the rates after the step. 1 is stable
    /// for any damping and of first order in it, 1/2 is of second order and lets stiff motion ring.
    pub implicitness: f64,
    /// How often each step is made again with the Coriolis terms of its mean rates: with one
    /// correction smooth motion is of second order, without of first.
    pub corrections: usize,
    /// How contact problems are solved.
    pub solver: StepSolver,
    /// The coefficient of friction of runs whose contacts never slip: sweeps need a cone.
    pub no_slip_friction: f64,
}

impl Default for Stepping {
    fn default() -> Self {
        Self {
            scheme: Scheme::MoreauMidpoint,
            step_s: 1e-3,
            implicitness: 1.0,
            corrections: 0,
            solver: StepSolver::default(),
            no_slip_friction: 0.8,
        }
    }
}

/// What one step did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepReport {
    /// Number of contacts in its problem.
    pub closed: usize,
    /// Sweeps or pivots; 0 if all contacts stick.
    pub iterations: usize,
    /// The largest depth of a contact point where the contacts were looked for \[m\].
    pub penetration_m: f64,
    /// Sweeps did not converge, and pivots solved the problem.
    pub fell_back: bool,
    /// How often the step was made: more than once if its terms were not accepted.
    pub passes: usize,
    /// Work of the contact impulses over the step, P . J (v + v+)/2 \[J\].
    pub contact_work_j: f64,
    /// How far contacts with an impulse miss the law that the scheme holds them by [m/s].
    pub law_error_m_s: f64,
    /// Largest angle between friction and what is opposite to the velocity after the step, of
    /// contacts that slip \[rad\].
    pub friction_angle_rad: f64,
}

/// Why a step could not be made; the state stays that before it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepFailure {
    /// The mass matrix, with damping, is singular.
    Singular(NotPositiveDefinite),
    /// A term or a new rate is not finite.
    NotFinite,
    /// Neither sweeps nor pivots found impulses.
    NoImpulses,
}

impl std::fmt::Display for StepFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Singular(error) => error.fmt(f),
            Self::NotFinite => write!(f, "a term of the step is not finite"),
            Self::NoImpulses => write!(f, "no contact impulses were found for the step"),
        }
    }
}

impl std::error::Error for StepFailure {}
