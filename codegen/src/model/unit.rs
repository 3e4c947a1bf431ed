//! Units: products of powers of SI units, and their dimensions.
//!
//! Only coherent units are read (m, not mm): a value never needs a hidden factor.

use std::fmt;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and candela. Radians count as 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Dimension([i8; 7]);

const BASE_NAMES: [&str; 7] = ["m", "kg", "s", "A", "K", "mol", "cd"];

impl Dimension {
    /// A pure number, or an angle.
    pub const NONE: Self = Self([0; 7]);
    /// Metre.
    pub const LENGTH: Self = Self([1, 0, 0, 0, 0, 0, 0]);
    /// Kilogram.
    pub const MASS: Self = Self([0, 1, 0, 0, 0, 0, 0]);
    /// kg m.
    pub const FIRST_MOMENT: Self = Self([1, 1, 0, 0, 0, 0, 0]);
    /// kg m^2.
    pub const INERTIA: Self = Self([2, 1, 0, 0, 0, 0, 0]);
    /// m/s^2.
    pub const ACCELERATION: Self = Self([1, 0, -2, 0, 0, 0, 0]);
    /// Newton.
    pub const FORCE: Self = Self([1, 1, -2, 0, 0, 0, 0]);
    /// Newton metre.
    pub const TORQUE: Self = Self([2, 1, -2, 0, 0, 0, 0]);
    /// 1/s.
    pub const RATE: Self = Self([0, 0, -1, 0, 0, 0, 0]);

    /// The dimension of a product; none if an exponent leaves the range that physics uses.
    pub fn times(self, other: Self) -> Option<Self> {
        self.combine(other, 1)
    }

    /// The dimension of a quotient.
    pub fn per(self, other: Self) -> Option<Self> {
        self.combine(other, -1)
    }

    /// The dimension of a power.
    pub fn power(self, exponent: i32) -> Option<Self> {
        Self::NONE.combine(self, exponent)
    }

    /// The dimension of a square root; none if an exponent is odd.
    pub fn root(self) -> Option<Self> {
        self.0.iter().all(|e| e % 2 == 0).then(|| Self(self.0.map(|e| e / 2)))
    }

    fn combine(self, other: Self, factor: i32) -> Option<Self> {
        let mut sum = self.0;
        for (exponent, &more) in sum.iter_mut().zip(&other.0) {
            let exact = i32::from(*exponent).checked_add(i32::from(more).checked_mul(factor)?)?;
            *exponent = i8::try_from(exact).ok()?;
        }
        Some(Self(sum))
    }
}

impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // products that everybody calls by one name, or writes the other way round
        for (dimension, name) in [
            (Self::FORCE, "N"),
            (Self::TORQUE, "N m"),
            (Self::FIRST_MOMENT, "kg m"),
            (Self::INERTIA, "kg m^2"),
        ] {
            if *self == dimension {
                return write!(f, "{name}");
            }
        }
        let part = |sign: i8| {
            let factors =
                self.0.iter().zip(BASE_NAMES).filter(|(exponent, _)| *exponent * sign > 0);
            let factors: Vec<String> = factors
                .map(|(exponent, name)| match exponent.unsigned_abs() {
                    1 => name.to_owned(),
                    power => format!("{name}^{power}"),
                })
                .collect();
            (factors.len(), factors.join(" "))
        };
        let ((above, numerator), (below, denominator)) = (part(1), part(-1));
        write!(f, "{}", if above == 0 { "1" } else { &numerator })?;
        match below {
            0 => Ok(()),
            1 => write!(f, "/{denominator}"),
            _ => write!(f, "/({denominator})"),
        }
    }
}

/// A unit as the user wrote it, with its dimension.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unit {
    text: String,
    dimension: Dimension,
}

impl Unit {
    /// Reads a product of SI units: `kg m^2`, `N m s/rad`, `m/s^2`, `1`.
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        let mut reader = UnitReader { rest: text.trim() };
        let dimension = reader.product()?;
        match reader.rest.chars().next() {
            None => Ok(Self { text: text.trim().to_owned(), dimension }),
            Some(_) => Err(UnitError::Malformed),
        }
    }

    /// A unit of our own making, for entries whose role fixes it.
    pub fn fixed(text: &str, dimension: Dimension) -> Self {
        Self { text: text.to_owned(), dimension }
    }

    /// The unit as it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Its dimension.
    pub fn dimension(&self) -> Dimension {
        self.dimension
    }
}

impl fmt::Display for Unit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.text)
    }
}

/// Why a text is not a unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum UnitError {
    /// Not a product of powers.
    Malformed,
    /// No SI unit has this name.
    Unknown(String),
    /// A unit, but not a coherent one; holds it and what to write instead.
    NotCoherent(String, &'static str),
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Malformed => write!(f, "it is not a product of powers of SI units"),
            Self::Unknown(name) => write!(f, "`{name}` is not an SI unit"),
            Self::NotCoherent(name, _) => write!(f, "`{name}` hides a factor"),
        }
    }
}

/// Units that people write and that hide a factor, with the way out.
const NOT_COHERENT: [(&str, &str); 12] = [
    ("mm", "give the value in m"),
    ("cm", "give the value in m"),
    ("km", "give the value in m"),
    ("in", "give the value in m"),
    ("g", "give the value in kg"),
    ("lb", "give the value in kg"),
    ("ms", "give the value in s"),
    ("min", "give the value in s"),
    ("deg", "give the value in rad, for example \"30*pi/180\""),
    ("°", "give the value in rad, for example \"30*pi/180\""),
    ("rpm", "give the value in rad/s, for example \"60*2*pi/60\""),
    ("mN", "give the value in N"),
];

/// Coherent units: name and exponents.
const COHERENT: [(&str, [i8; 7]); 26] = [
    ("m", [1, 0, 0, 0, 0, 0, 0]),
    ("kg", [0, 1, 0, 0, 0, 0, 0]),
    ("s", [0, 0, 1, 0, 0, 0, 0]),
    ("A", [0, 0, 0, 1, 0, 0, 0]),
    ("K", [0, 0, 0, 0, 1, 0, 0]),
    ("mol", [0, 0, 0, 0, 0, 1, 0]),
    ("cd", [0, 0, 0, 0, 0, 0, 1]),
    ("rad", [0; 7]),
    ("sr", [0; 7]),
    ("1", [0; 7]),
    ("-", [0; 7]),
    ("Hz", [0, 0, -1, 0, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0, 0, 0]),
    ("Nm", [2, 1, -2, 0, 0, 0, 0]),
    ("Nms", [2, 1, -1, 0, 0, 0, 0]),
    ("J", [2, 1, -2, 0, 0, 0, 0]),
    ("W", [2, 1, -3, 0, 0, 0, 0]),
    ("Pa", [-1, 1, -2, 0, 0, 0, 0]),
    ("C", [0, 0, 1, 1, 0, 0, 0]),
    ("V", [2, 1, -3, -1, 0, 0, 0]),
    ("ohm", [2, 1, -3, -2, 0, 0, 0]),
    ("F", [-2, -1, 4, 2, 0, 0, 0]),
    ("H", [2, 1, -2, -2, 0, 0, 0]),
    ("Wb", [2, 1, -2, -1, 0, 0, 0]),
    ("T", [0, 1, -2, -1, 0, 0, 0]),
    ("S", [-2, -1, 3, 2, 0, 0, 0]),
];

struct UnitReader<'a> {
    rest: &'a str,
}

impl UnitReader<'_> {
    fn product(&mut self) -> Result<Dimension, UnitError> {
        let mut total = self.factor()?;
        loop {
            self.rest = self.rest.trim_start();
            let divide = match self.rest.chars().next() {
                None | Some(')') => return Ok(total),
                Some('/') => true,
                Some('*' | '·') => false,
                Some(_) => {
                    total = total.times(self.factor()?).ok_or(UnitError::Malformed)?;
                    continue;
                }
            };
            self.skip_char();
            let factor = self.factor()?;
            let product = if divide { total.per(factor) } else { total.times(factor) };
            total = product.ok_or(UnitError::Malformed)?;
        }
    }

    fn factor(&mut self) -> Result<Dimension, UnitError> {
        self.rest = self.rest.trim_start();
        let dimension = if self.rest.starts_with('(') {
            self.skip_char();
            // a second level of brackets has no use in a unit, and would let a text recurse
            if self.rest.trim_start().starts_with('(') {
                return Err(UnitError::Malformed);
            }
            let inner = self.product()?;
            if !self.rest.starts_with(')') {
                return Err(UnitError::Malformed);
            }
            self.skip_char();
            inner
        } else {
            self.name()?
        };
        if !self.rest.starts_with('^') {
            return Ok(dimension);
        }
        self.skip_char();
        let end = self
            .rest
            .char_indices()
            .find(|&(at, c)| !(c.is_ascii_digit() || (at == 0 && c == '-')))
            .map_or(self.rest.len(), |(at, _)| at);
        let exponent = self.rest[..end].parse().map_err(|_| UnitError::Malformed)?;
        self.rest = &self.rest[end..];
        dimension.power(exponent).ok_or(UnitError::Malformed)
    }

    fn name(&mut self) -> Result<Dimension, UnitError> {
        let end = self
            .rest
            .find(|c: char| c.is_whitespace() || "*/^()·".contains(c))
            .unwrap_or(self.rest.len());
        let name = &self.rest[..end];
        self.rest = &self.rest[end..];
        if name.is_empty() {
            return Err(UnitError::Malformed);
        }
        if let Some((_, exponents)) = COHERENT.iter().find(|(known, _)| *known == name) {
            return Ok(Dimension(*exponents));
        }
        match NOT_COHERENT.iter().find(|(known, _)| *known == name) {
            Some((_, advice)) => Err(UnitError::NotCoherent(name.to_owned(), advice)),
            None => Err(UnitError::Unknown(name.to_owned())),
        }
    }

    fn skip_char(&mut self) {
        let mut chars = self.rest.chars();
        chars.next();
        self.rest = chars.as_str();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn dimension(text: &str) -> Dimension {
        Unit::parse(text).expect("a unit").dimension()
    }

    #[test]
    fn products_quotients_and_powers_are_read() {
        assert_eq!(dimension("N m"), Dimension::TORQUE);
        assert_eq!(dimension("kg*m^2/s^2"), Dimension::TORQUE);
        assert_eq!(dimension("m s^-2"), Dimension::ACCELERATION);
        assert_eq!(dimension("N m s/rad"), dimension("Nms"));
        assert_eq!(dimension("kg/(m s^2)"), dimension("Pa"));
        assert_eq!(dimension("V A"), dimension("N m/s"));
        assert_eq!(dimension("1"), Dimension::NONE);
    }

    #[test]
    fn what_is_no_unit_is_refused_with_its_reason() {
        assert_eq!(Unit::parse("furlong"), Err(UnitError::Unknown("furlong".into())));
        assert!(matches!(Unit::parse("mm"), Err(UnitError::NotCoherent(..))));
        for text in ["", "/m", "m^", "m^x", "(m", "m)", "((m))", "m^200", "m//s"] {
            assert_eq!(Unit::parse(text), Err(UnitError::Malformed), "{text}");
        }
    }

    #[test]
    fn dimensions_print_as_a_person_writes_them() {
        let shown = ["kg m^2/s^2", "m s^-2", "1", "N", "s^-1", "Pa"]
            .map(|text| dimension(text).to_string());
        assert_eq!(shown, ["N m", "m/s^2", "1", "N", "1/s", "kg/(m s^2)"]);
    }
}
