//! What emitted code needs at run time: a scalar, and one sine and cosine for all.
//!
//! Emitted dynamics and the reference interpreter of `denavit-codegen` both compute through
//! [`Scalar`]; that is why they agree **bit for bit**. Emitted code relies on the following.
//!
//! - **Plain IEEE arithmetic.** `+ - * /` and negation round to nearest, in the order written.
//!   Without the feature `fma` nothing here uses a fused multiply-add or asks which target features
//!   are enabled, so the same source gives the same bits on every target whose `f64` is IEEE
//!   binary64 (that excludes only 32-bit x86 without SSE2). The sign and payload of a NaN are not
//!   part of the promise. With the feature, [`Scalar::product_plus`] and its kin, which sine and
//!   cosine and modules emitted with fused products call, round once where [`FUSES`] says so.
//! - **One sine and cosine.** [`Scalar::sincos`] costs one argument reduction for the pair, has
//!   no branch in the ordinary range and is exactly odd and even; its error is stated there.
//! - **No name to fall into.** An inherent method of `f64` wins over a trait method of the same
//!   name, and `f64::sin_cos`, `f64::min` or `f64::exp` give other bits than ours. Hence every
//!   method here whose result could differ has a name that no float has: `sincos`, `lesser`,
//!   `exponential`. What keeps its name (`abs`, `sqrt`) is exactly rounded wherever it comes from.
//! - **Choices are values.** [`Scalar::select_less`] and its kin take both alternatives already
//!   computed: no emitted function branches on its numbers.
//! - **No allocation, no panic, no `unsafe`**, and without features no dependency.
//!
//! Friction and other effects may need `Transcendental`, behind the feature `libm`.
//!
//! ```
//! use denavit_runtime::Scalar;
//!
//! /// Torque that holds a pendulum of mass `m` [kg] and length `l` [m] at the angle `q` [rad].
//! fn gravity_torque<S: Scalar>(m: S, l: S, q: S) -> S {
//!     let (s1, _) = q.sincos();
//!     m * S::from_f64(9.81) * l * s1
//! }
//!
//! assert_eq!(gravity_torque(2.0, 0.5, 0.0), 0.0);
//! assert!((gravity_torque(2.0_f64, 0.5, core::f64::consts::FRAC_PI_6) - 4.905).abs() < 1e-15);
//! ```
#![no_std]

#[cfg(feature = "fma")]
extern crate std;

pub mod numbers;
#[cfg(feature = "wide")]
mod pack;
mod reduction;
mod scalar;
mod sincos;
#[cfg(feature = "libm")]
mod transcendental;
#[cfg(feature = "wide")]
mod wide_scalar;

#[cfg(feature = "wide")]
pub use pack::{ColumnFault, Packed, for_each_pack, map_packs};
pub use scalar::{FUSES, Scalar};
#[cfg(feature = "libm")]
pub use transcendental::Transcendental;
/// The crate of packs, in the version whose types are scalars here.
#[cfg(feature = "wide")]
pub use wide;
