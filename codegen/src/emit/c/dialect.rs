//! C or C++: what the two spell differently, and the names that a model has in them.

use crate::emit::names::{C, Names};

/// What headers of the standard declare globally, and a namespace may not be called: functions of
/// math.h, stdio.h, stdlib.h, string.h and unistd.h by names that a robot may have.
const TAKEN: &str = "\
    main posix link time index abs div remove rename acos acosh asin asinh atan atanh cbrt ceil \
    copysign cos cosh erf erfc exp2 expm1 fdim floor fma fmax fmin fmod frexp gamma hypot ilogb \
    j0 j1 jn ldexp lgamma llrint llround log10 log1p log2 logb lrint lround modf nan nearbyint \
    nextafter nexttoward pow remainder remquo rint round scalbln scalbn signgam sin sincos sinh \
    tanh tgamma trunc y0 y1 yn drem significand scalb exp10 pow10 printf puts gets getc putc \
    scanf fopen fclose fread fwrite abort atexit atof atoi atol calloc exit free getenv labs \
    ldiv malloc qsort rand random realloc srand strtod system a64l memcpy memmove memset strlen \
    rindex ffs read write close pipe dup access alarm sleep pause swab sync nice crypt brk sbrk \
    int8_t int16_t int32_t int64_t uint8_t uint16_t uint32_t uint64_t size_t ptrdiff_t div_t \
    ldiv_t double_t float_t";

/// One of the two languages, for one model.
pub(super) struct Dialect {
    pub(super) is_cpp: bool,
    /// What the names of the model begin with; in C++ its namespace.
    pub(super) prefix: String,
    /// The same of macros.
    pub(super) upper: String,
}

impl Dialect {
    pub(super) fn c(model: &str) -> Self {
        Self::new(model, false)
    }

    pub(super) fn cpp(model: &str) -> Self {
        Self::new(model, true)
    }

    fn new(model: &str, is_cpp: bool) -> Self {
        let mut names = Names::globals(C);
        for taken in TAKEN.split_ascii_whitespace() {
            names.claim(taken);
        }
        let prefix = names.field(&model.to_ascii_lowercase());
        let upper = prefix.to_ascii_uppercase();
        Self { is_cpp, prefix, upper }
    }

    /// The names, for templates.
    pub(super) fn filling(&self) -> [(&str, &str); 2] {
        [("prefix", &self.prefix), ("upper", &self.upper)]
    }

    /// The type of numbers in functions.
    pub(super) fn scalar(&self) -> &'static str {
        if self.is_cpp { "S" } else { "real" }
    }

    /// The first statement of a function: nothing is contracted in it.
    pub(super) fn exact(&self) -> String {
        if self.is_cpp { format!("{}_EXACT", self.upper) } else { String::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_namespace_is_none_of_the_functions_of_the_standard() {
        for name in ["gamma", "y1", "round", "printf", "int64_t"] {
            assert_ne!(Dialect::cpp(name).prefix, name);
        }
        assert_eq!(Dialect::cpp("puma560").prefix, "puma560");
    }
}
