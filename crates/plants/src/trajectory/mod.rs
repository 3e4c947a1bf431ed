//! What a joint is to follow: position, rate and acceleration as functions of time.
//!
//! Every kind of reference is checked when it is made, so that following it cannot fail. Outside
//! its time range a reference rests at its end value (Fourier series and polynomials have no end).

mod bezier;
mod fourier;
mod numbers;
mod polynomial;
mod profile;
mod samples;
mod sequence;
mod spline;

pub use bezier::Bezier;
pub use fourier::Fourier;
pub use polynomial::Polynomial;
pub use profile::CosineProfile;
pub use samples::{Between, Samples};
pub use sequence::{Part, Sequence};
pub use spline::{CubicSpline, EndCondition, QuinticSpline, Spline};

/// Position, rate and acceleration at one time [rad, m; per s; per s^2].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Setpoint {
    /// Position.
    pub position: f64,
    /// Its first derivative.
    pub rate: f64,
    /// Its second derivative.
    pub acceleration: f64,
}

impl Setpoint {
    fn resting(position: f64) -> Self {
        Self { position, rate: 0.0, acceleration: 0.0 }
    }
}

/// A reference of one joint.
#[derive(Clone, Debug, PartialEq)]
pub enum Reference {
    /// One position for ever.
    Constant(f64),
    /// Piecewise cubic, two derivatives continuous. A log may be one, through its samples.
    Cubic(CubicSpline),
    /// Piecewise quintic with given rates and accelerations.
    Quintic(QuinticSpline),
    /// From one position to another with the velocity profile 1 - cos.
    Cosine(CosineProfile),
    /// A Bezier polynomial.
    Bezier(Bezier),
    /// A finite Fourier series.
    Fourier(Fourier),
    /// A polynomial in time.
    Polynomial(Polynomial),
    /// Samples, held or joined by lines: a log.
    Samples(Samples),
    /// References one after the other, perhaps again and again.
    Sequence(Sequence),
}

impl Reference {
    /// The reference at time `t_s`.
    pub fn at(&self, t_s: f64) -> Setpoint {
        match self {
            Self::Constant(position) => Setpoint::resting(*position),
            Self::Cubic(spline) => spline.at(t_s),
            Self::Quintic(spline) => spline.at(t_s),
            Self::Cosine(profile) => profile.at(t_s),
            Self::Bezier(bezier) => bezier.at(t_s),
            Self::Fourier(series) => series.at(t_s),
            Self::Polynomial(polynomial) => polynomial.at(t_s),
            Self::Samples(samples) => samples.at(t_s),
            Self::Sequence(sequence) => sequence.at(t_s),
        }
    }

    /// The time after which it repeats itself \[s\]: 0 for one that never changes, none for one
    /// that does not repeat.
    pub fn period_s(&self) -> Option<f64> {
        match self {
            Self::Constant(_) => Some(0.0),
            Self::Sequence(sequence) => sequence.period_s(),
            Self::Fourier(series) => series.period_s(),
            _ => None,
        }
    }

    /// The first time after `t_s` at which position or rate may jump: integrators stop there.
    pub fn next_break(&self, t_s: f64) -> Option<f64> {
        let ends = |range: [f64; 2]| range.into_iter().find(|end| *end > t_s);
        match self {
            Self::Constant(_) | Self::Fourier(_) | Self::Polynomial(_) => None,
            Self::Cubic(spline) => ends(spline.range()),
            Self::Quintic(spline) => ends(spline.range()),
            Self::Cosine(profile) => ends(profile.range()),
            Self::Bezier(bezier) => ends(bezier.range()),
            Self::Samples(samples) => samples.next_break(t_s),
            Self::Sequence(sequence) => sequence.next_break(t_s),
        }
    }
}
