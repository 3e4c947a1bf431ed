//! Functions that only effects (friction, elasticity, user expressions) need, from `libm`.

use crate::Scalar;

/// The functions beyond [`Scalar`], computed by the crate `libm` and never by the platform's
/// mathematics library, so that they too give the same bits everywhere.
///
/// Save for `sqrt`, which is correctly rounded, their names are words: `x.exp()` on an `f64`
/// would be the standard library's, whose bits depend on the platform.
pub trait Transcendental: Scalar {
    /// The square root, correctly rounded; NaN below zero, and `sqrt(-0.0) = -0.0`.
    #[must_use]
    fn sqrt(self) -> Self;

    /// The tangent of an angle in radians.
    #[must_use]
    fn tangent(self) -> Self;

    /// The angle, in radians in [-pi, pi], of the point with ordinate `self` and abscissa
    /// `abscissa`: `y.arctangent2(x)` is atan2(y, x).
    #[must_use]
    fn arctangent2(self, abscissa: Self) -> Self;

    /// e to the power `self`.
    #[must_use]
    fn exponential(self) -> Self;

    /// The natural logarithm; negative infinity at zero, NaN below.
    #[must_use]
    fn logarithm(self) -> Self;

    /// The hyperbolic tangent.
    #[must_use]
    fn hyperbolic_tangent(self) -> Self;
}

/// One implementation per width, from the functions of `libm` in the trait's order.
macro_rules! from_libm {
    ($float:ty, $sqrt:ident, $tan:ident, $atan2:ident, $exp:ident, $log:ident, $tanh:ident) => {
        impl Transcendental for $float {
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }

            #[inline]
            fn tangent(self) -> Self {
                libm::$tan(self)
            }

            #[inline]
            fn arctangent2(self, abscissa: Self) -> Self {
                libm::$atan2(self, abscissa)
            }

            #[inline]
            fn exponential(self) -> Self {
                libm::$exp(self)
            }

            #[inline]
            fn logarithm(self) -> Self {
                libm::$log(self)
            }

            #[inline]
            fn hyperbolic_tangent(self) -> Self {
                libm::$tanh(self)
            }
        }
    };
}

from_libm!(f64, sqrt, tan, atan2, exp, log, tanh);
from_libm!(f32, sqrtf, tanf, atan2f, expf, logf, tanhf);
