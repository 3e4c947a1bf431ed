//! What a channel can tell apart: how it was printed, the steps of its encoder, its white noise.
//!
//! All of it is read from raw cells. Cells that are filled in, samples at equal distances and
//! other units come later, and none of them keeps what is looked for here.

mod lattice;
mod printed;
mod white;

pub use printed::spacing as printed_spacing;
pub use white::WHITE;

/// The resolution of a channel, in the unit of its signal.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Resolution {
    /// The distance of printed values, root of mean square: one of their last digit, or of single
    /// precision. 0 where all digits of double precision are there, or nothing is known.
    pub printed: f64,
    /// The distance of the levels that values lie on, as far as printing leaves them there.
    pub encoder_step: Option<f64>,
    /// Deviation of white noise, by what cubics through neighbours leave; none if it is not white.
    pub white_std: Option<f64>,
}

/// Resolutions of the channels of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointResolution {
    /// Of the position [rad, m].
    pub position: Resolution,
    /// Of the velocity, if it was logged [rad/s, m/s].
    pub velocity: Resolution,
    /// Of the torque [N m, N].
    pub torque: Resolution,
    /// Of the angle of a motor before a spring \[rad\].
    pub motor: Resolution,
}

impl Resolution {
    /// The resolution of raw values at their times, in any units; NaN is none of them.
    pub fn of(time: &[f64], values: &[f64]) -> Self {
        let printed = printed::spacing(values);
        Self {
            printed,
            encoder_step: lattice::step(values, printed),
            white_std: white::deviation(time, values),
        }
    }

    /// The same of a signal that was multiplied by a number.
    pub fn scaled(self, by: f64) -> Self {
        let by = by.abs();
        Self {
            printed: by * self.printed,
            encoder_step: self.encoder_step.map(|step| by * step),
            white_std: self.white_std.map(|deviation| by * deviation),
        }
    }

    /// The step whose rounding has the variance of both: of an encoder's, s^2/12, and of printing,
    /// u^2/12.
    pub fn step(&self) -> f64 {
        self.encoder_step.unwrap_or(0.0).hypot(self.printed)
    }

    /// Deviation of an error that is anywhere within the steps.
    pub fn rounding_std(&self) -> f64 {
        self.step() / 12.0_f64.sqrt()
    }

    /// The step as a staircase in a signal of this size, whose treads are rests: that of an
    /// encoder, or of digits that are coarser than single precision.
    pub fn staircase(&self, size: f64) -> Option<f64> {
        let is_coarse = self.printed > f64::from(f32::EPSILON) * size;
        (self.encoder_step.is_some() || is_coarse).then(|| self.step())
    }
}
