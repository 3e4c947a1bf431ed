//! Contacts of points with the ground: which of them hold, slip or open, and with what force.
//!
//! Everything here works on small dense matrices given as row-major slices (the shape in which
//! emitted code returns them) and knows no robot. Rows of a contact are contact-major: x, z for a
//! motion in a plane, x, y, z in space; the last is the normal, positive away from the ground.
//!
//! Forces f and the accelerations (or, at impacts, velocities) w of the contact points obey
//!
//! > w = G f + b,  G = J M^-1 J^T,  0 <= w_n, 0 <= f_n, w_n f_n = 0  and a law of friction,
//!
//! where b is what w would be without contact forces: J M^-1 (tau - bias) + Jdot qd, or before an
//! impact the velocity.
//! [`ContactProblem`] is that problem:
//!
//! 1. [`delassus`] forms G;
//! 2. [`modes`] solves for given modes (linear; redundant contacts get the least forces that the
//!    laws allow) and says how far these are from violating a law: the function whose sign change
//!    is the event "a contact opens" or "a contact begins to slip";
//! 3. [`solver`] decides the modes: it enumerates them, and finds directions of slipping in space
//!    by [`newton`];
//! 4. [`impact`] is the problem of the velocities after an impact.
//!
//! [`lemke`] and [`denavit_numerics::MinimumNorm`] are the linear algebra below; [`hold`],
//! [`gauss_seidel`] and [`pyramid`] the solvers of time stepping.

pub(crate) mod cholesky;
pub mod delassus;
pub mod gauss_seidel;
pub mod hold;
pub mod impact;
pub(crate) mod independent;
mod interior;
pub mod lemke;
pub mod modes;
pub mod newton;
pub mod pyramid;
pub(crate) mod sharing;
pub mod solver;

/// Where the contacts move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// In the x-z plane: two rows per contact, x and the normal z.
    Planar,
    /// In space: three rows per contact, x, y and the normal z.
    Spatial,
}

impl Space {
    /// Rows per contact; the normal is the last.
    pub fn rows(self) -> usize {
        self.tangents() + 1
    }

    /// Tangential rows per contact.
    pub fn tangents(self) -> usize {
        match self {
            Space::Planar => 1,
            Space::Spatial => 2,
        }
    }
}

/// The law of friction of one contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    /// A closed contact never slips, whatever force that takes (thesis 2.3.3).
    NoSlip,
    /// |f_t| <= mu f_n; a contact that slips has |f_t| = mu f_n against its motion. 0 means
    /// frictionless.
    Coulomb(f64),
}

/// What is known of one contact before the problem is solved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Its law of friction.
    pub friction: Friction,
    /// Unit direction of its tangential velocity if it is slipping already (planar: [+-1, 0]).
    /// Nothing for impacts, and for contacts at rest.
    pub slipping: Option<[f64; 2]>,
    /// The contact is to open: it has just been released, and carries no force.
    pub released: bool,
}

impl Contact {
    /// A contact at rest.
    pub fn resting(friction: Friction) -> Self {
        Self { friction, slipping: None, released: false }
    }

    /// The coefficient of friction; none for a contact that never slips.
    pub fn coefficient(&self) -> Option<f64> {
        match self.friction {
            Friction::NoSlip => None,
            Friction::Coulomb(mu) => Some(mu),
        }
    }

    /// The contact's direction of slipping, if closed, does not depend on the solution.
    fn has_slip_law(&self) -> bool {
        self.slipping.is_some() || self.friction == Friction::Coulomb(0.0)
    }
}

/// What one contact does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mode {
    /// It carries no force and may leave the ground.
    Open,
    /// It holds.
    Stick,
    /// It slips in this unit direction (planar: [+-1, 0]; without friction: [0, 0]); friction is
    /// opposed to it.
    Slip([f64; 2]),
}

impl Mode {
    /// Whether the contact stays closed.
    pub fn is_closed(self) -> bool {
        self != Mode::Open
    }
}

/// One contact problem w = G f + b; see the module.
#[derive(Clone, Copy, Debug)]
pub struct ContactProblem<'a> {
    /// Planar or spatial.
    pub space: Space,
    /// The closed contacts.
    pub contacts: &'a [Contact],
    /// G, row-major; its size is contacts times rows per contact.
    pub delassus: &'a [f64],
    /// b.
    pub free: &'a [f64],
    /// What counts as zero.
    pub tolerance: Tolerance,
}

impl ContactProblem<'_> {
    /// Number of rows of all contacts.
    pub fn rows(&self) -> usize {
        self.contacts.len() * self.space.rows()
    }

    /// The row of the normal of a contact.
    pub fn normal(&self, contact: usize) -> usize {
        contact * self.space.rows() + self.space.tangents()
    }

    /// The rows of a contact.
    pub fn block(&self, contact: usize) -> std::ops::Range<usize> {
        contact * self.space.rows()..(contact + 1) * self.space.rows()
    }

    /// w := G f + b.
    pub fn respond(&self, force: &[f64], response: &mut [f64]) {
        let rows = self.rows();
        for (i, entry) in response.iter_mut().enumerate() {
            let row = &self.delassus[i * rows..(i + 1) * rows];
            *entry = self.free[i] + cholesky::dot(row, force);
        }
    }

    /// Size of the free response, to which tolerances refer.
    fn response_scale(&self) -> f64 {
        self.free.iter().fold(0.0_f64, |largest, entry| largest.max(entry.abs()))
    }

    /// Size of the forces that the free response asks for.
    fn force_scale(&self) -> f64 {
        let rows = self.rows();
        let stiffest =
            (0..rows).fold(0.0_f64, |largest, i| largest.max(self.delassus[i * rows + i]));
        if stiffest > 0.0 { self.response_scale() / stiffest } else { 0.0 }
    }

    fn checked(&self) -> Result<(), ContactFailure> {
        let rows = self.rows();
        assert!(
            self.delassus.len() == rows * rows && self.free.len() == rows,
            "the matrix and the vector have one row per contact and direction"
        );
        let finite = self.delassus.iter().chain(self.free).all(|entry| entry.is_finite());
        if finite { Ok(()) } else { Err(ContactFailure::NotFinite) }
    }
}

/// What counts as zero: absolute parts plus `relative` times the size of the problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of forces \[N\] or impulses [N s].
    pub force: f64,
    /// Of accelerations [m/s^2] or velocities [m/s].
    pub response: f64,
    /// Relative to the free response, and to the forces that it asks for.
    pub relative: f64,
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { force: 1e-10, response: 1e-10, relative: 1e-9 }
    }
}

impl ContactProblem<'_> {
    /// What counts as no response.
    pub(crate) fn response_zero(&self) -> f64 {
        self.tolerance.response + self.tolerance.relative * self.response_scale()
    }

    /// What counts as no force, beside forces of the size `largest`.
    pub(crate) fn force_zero(&self, largest: f64) -> f64 {
        let scale = largest.max(self.force_scale());
        self.tolerance.force + self.tolerance.relative * scale
    }

    /// Whether forces and their responses obey the laws of contact in these modes.
    pub fn is_admissible(&self, modes: &[Mode], force: &[f64], response: &[f64]) -> bool {
        let no_response = self.response_zero();
        let no_force = self.force_zero(force.iter().fold(0.0_f64, |sum, f| sum.max(f.abs())));
        let tangents = self.space.tangents();
        modes.iter().zip(self.contacts).enumerate().all(|(index, (mode, contact))| {
            let (normal, block) = (self.normal(index), self.block(index));
            let (f, w) = (&force[block.clone()], &response[block]);
            let pushes = force[normal] >= -no_force && response[normal].abs() <= no_response;
            match mode {
                Mode::Open => response[normal] >= -no_response,
                // Constraints that are met only up to a drift contradict each other a little.
                Mode::Stick => match contact.friction {
                    _ if length(w) > 100.0 * no_response => false,
                    Friction::NoSlip => pushes,
                    Friction::Coulomb(mu) => {
                        pushes && length(&f[..tangents]) <= mu * force[normal] + no_force
                    }
                },
                // The direction is given, or there is no friction to have one.
                Mode::Slip(_) if contact.has_slip_law() => pushes,
                Mode::Slip(direction) => {
                    let along: f64 = w[..tangents].iter().zip(direction).map(|(w, d)| w * d).sum();
                    pushes && length(&w[..tangents]) - along <= no_response
                }
            }
        })
    }
}

/// What a contact does that is closed and at rest, or slips as it does already.
fn closed_mode(contact: &Contact) -> Mode {
    match contact.slipping {
        _ if contact.released => Mode::Open,
        Some(direction) => Mode::Slip(direction),
        None if contact.friction == Friction::Coulomb(0.0) => Mode::Slip([0.0; 2]),
        None => Mode::Stick,
    }
}

fn length(vector: &[f64]) -> f64 {
    vector.iter().map(|entry| entry * entry).sum::<f64>().sqrt()
}

/// Modes, forces and responses that solve a problem.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ContactSolution {
    /// One per contact.
    pub modes: Vec<Mode>,
    /// f, contact-major \[N\], or [N s] at impacts.
    pub force: Vec<f64>,
    /// w, contact-major [m/s^2], or [m/s] at impacts.
    pub response: Vec<f64>,
    /// Directions in which the forces of the closed contacts are not determined.
    pub redundancy: usize,
}

/// Why a contact problem has no answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactFailure {
    /// No choice of modes satisfies all laws. For a slipping contact this is Painleve's
    /// inconsistency; for no-slip laws friction would have to pull, and a finite coefficient may
    /// help.
    NoSolution,
    /// Choices of modes with different motions satisfy all laws.
    SeveralSolutions,
    /// There are more combinations of modes than can be tried.
    TooManyModes {
        /// Number of contacts.
        contacts: usize,
    },
    /// The forces of the given modes are contradictory.
    Inconsistent,
    /// A number given is not finite.
    NotFinite,
}

impl std::fmt::Display for ContactFailure {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::NoSolution => write!(f, "no contact forces satisfy the laws of contact"),
            Self::SeveralSolutions => write!(f, "the laws of contact allow several motions"),
            Self::TooManyModes { contacts } => {
                write!(f, "{contacts} contacts have too many combinations of modes")
            }
            Self::Inconsistent => write!(f, "no forces keep the contacts in their modes"),
            Self::NotFinite => write!(f, "a number of the contact problem is not finite"),
        }
    }
}

impl std::error::Error for ContactFailure {}
