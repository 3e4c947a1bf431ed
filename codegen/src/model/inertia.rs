//! Whether a mass, a centre of mass and an inertia tensor can belong to a body: exact tests over
//! the rationals.
//!
//! A body exists if and only if the second moments about its centre of mass,
//! `S = tr(I)/2 1 - I`, are positive semidefinite. Its diagonal is the triangle inequality of the
//! moments of inertia. Thin rods and plates are on the border and allowed.

use crate::number::{Rational, decimal_text};
use num_traits::{Signed, Zero};
use std::fmt;

/// Why no body has these mass properties.
#[derive(Clone, Debug, PartialEq)]
pub enum Unphysical {
    /// There is inertia without mass.
    InertiaWithoutMass,
    /// A moment of inertia about an axis through the centre of mass is negative: the name of the
    /// entry and its value.
    NegativeMoment(&'static str, String),
    /// The tensor has a negative moment about some axis that is no coordinate axis.
    NotPositive,
    /// A moment of inertia is larger than the sum of the other two.
    Triangle {
        /// The names of the three entries, the large one first.
        entries: [&'static str; 3],
        /// The large moment about the centre of mass (kg m^2).
        moment: String,
        /// The sum of the other two (kg m^2).
        sum: String,
    },
    /// The diagonal would do, but the products of inertia are too large for it.
    Products,
}

impl Unphysical {
    /// Whether `accept_triangle_violation` covers it: energies stay positive.
    pub fn can_be_accepted(&self) -> bool {
        matches!(self, Self::Triangle { .. } | Self::Products)
    }

    /// What to do about it.
    pub fn hint(&self) -> Option<String> {
        let hint = match self {
            Self::InertiaWithoutMass => "give the mass, or leave out the inertia",
            Self::NegativeMoment(..) | Self::NotPositive => {
                "check \"about\": a tensor about the origin that is read as about the centre of \
                 mass, or the reverse, often ends here"
            }
            Self::Triangle { .. } | Self::Products => {
                "no distribution of mass has such moments: check the source; to keep numbers as \
                 published, add \"accept_triangle_violation\": \"reason\" to the body"
            }
        };
        Some(hint.to_owned())
    }
}

impl fmt::Display for Unphysical {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InertiaWithoutMass => write!(f, "the body has inertia, but its mass is 0"),
            Self::NegativeMoment(entry, value) => {
                write!(f, "about the centre of mass, {entry} = {value} is negative")
            }
            Self::NotPositive => {
                write!(f, "the inertia about the centre of mass is negative about some axis")
            }
            Self::Triangle { entries: [large, a, b], moment, sum } => write!(
                f,
                "triangle inequality violated about the centre of mass: \
                 {large} = {moment} > {a} + {b} = {sum}"
            ),
            Self::Products => {
                write!(f, "the products of inertia are too large for the moments of inertia")
            }
        }
    }
}

/// Moves a tensor about the frame's origin to the centre of mass: `I - m (c.c 1 - c c^T)`.
pub(super) fn about_com(
    mass: &Rational,
    [x, y, z]: &[Rational; 3],
    about_origin: [Rational; 6],
) -> [Rational; 6] {
    let [xx, yy, zz, xy, xz, yz] = about_origin;
    [
        xx - mass * (y * y + z * z),
        yy - mass * (x * x + z * z),
        zz - mass * (x * x + y * y),
        xy + mass * x * y,
        xz + mass * x * z,
        yz + mass * y * z,
    ]
}

const ENTRIES: [&str; 3] = ["Ixx", "Iyy", "Izz"];

/// What a file says of moments that no body has, though energies stay positive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Violation {
    /// Nothing: they are a fault.
    Refused,
    /// That they are meant, and where.
    Accepted(usize),
    /// Its numbers were estimated: moments that no motion tells apart may be any.
    Estimated,
}

/// Finds the plainest reason why no body has this mass (kg) and this tensor about its centre of
/// mass (xx, yy, zz, xy, xz, yz (kg m^2)), if there is one. Neither mass nor inertia is in order.
pub fn find_fault(mass: &Rational, inertia: &[Rational; 6]) -> Option<Unphysical> {
    if mass.is_zero() {
        let has_inertia = inertia.iter().any(|entry| !entry.is_zero());
        return has_inertia.then_some(Unphysical::InertiaWithoutMass);
    }
    let [xx, yy, zz, xy, xz, yz] = inertia;
    let moments = [xx, yy, zz];
    for (entry, moment) in ENTRIES.into_iter().zip(moments) {
        if moment.is_negative() {
            return Some(Unphysical::NegativeMoment(entry, decimal_text(moment)));
        }
    }
    if !is_positive_semidefinite(inertia) {
        return Some(Unphysical::NotPositive);
    }
    for axis in 0..3 {
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        let (a, b) = (second.min(third), second.max(third));
        let sum = moments[a] + moments[b];
        if *moments[axis] > sum {
            return Some(Unphysical::Triangle {
                entries: [ENTRIES[axis], ENTRIES[a], ENTRIES[b]],
                moment: decimal_text(moments[axis]),
                sum: decimal_text(&sum),
            });
        }
    }
    let half = (xx + yy + zz) / Rational::from_integer(2.into());
    let second_moments = [&half - xx, &half - yy, &half - zz, -xy, -xz, -yz];
    (!is_positive_semidefinite(&second_moments)).then_some(Unphysical::Products)
}

/// Sylvester's criterion for semidefinite matrices: no principal minor is negative.
fn is_positive_semidefinite([xx, yy, zz, xy, xz, yz]: &[Rational; 6]) -> bool {
    let minor = |a: &Rational, b: &Rational, ab: &Rational| a * b - ab * ab;
    let determinant = xx * minor(yy, zz, yz) - xy * (xy * zz - xz * yz) + xz * (xy * yz - xz * yy);
    let minors = [
        xx.clone(),
        yy.clone(),
        zz.clone(),
        minor(xx, yy, xy),
        minor(xx, zz, xz),
        minor(yy, zz, yz),
        determinant,
    ];
    minors.iter().all(|value| !value.is_negative())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::number::{integer, ratio};

    /// A mass in kg and a tensor in tenths of kg m^2.
    fn fault(mass: i64, inertia: [i64; 6]) -> Option<Unphysical> {
        find_fault(&integer(mass), &inertia.map(|entry| ratio(entry, 10)))
    }

    #[test]
    fn rods_plates_and_points_are_bodies() {
        for inertia in [[0; 6], [0, 3, 3, 0, 0, 0], [1, 2, 3, 0, 0, 0], [6, 6, 6, 0, 0, 0]] {
            assert_eq!(fault(1, inertia), None, "{inertia:?}");
        }
        assert_eq!(fault(0, [0; 6]), None);
    }

    #[test]
    fn two_points_at_a_slant_are_a_body_and_stop_being_one_when_a_product_grows() {
        // masses 1/2 at +-(1, 1, 0): S = [[1, 1], [1, 1]], so I = diag(1, 1, 2), xy = -1
        assert_eq!(fault(1, [10, 10, 20, -10, 0, 0]), None);
        // xy = -1.1: I is no longer positive; with 5 on the diagonal it is, but S is not
        assert_eq!(fault(1, [10, 10, 20, -11, 0, 0]), Some(Unphysical::NotPositive));
        assert_eq!(fault(1, [50, 50, 98, 0, -11, 0]), Some(Unphysical::Products));
    }

    #[test]
    fn the_violated_inequality_is_named() {
        let violated = fault(1, [1, 2, 4, 0, 0, 0]).expect("a fault");
        assert_eq!(
            violated.to_string(),
            "triangle inequality violated about the centre of mass: Izz = 0.4 > Ixx + Iyy = 0.3"
        );
        assert!(violated.can_be_accepted());
        let negative = fault(1, [-1, 2, 4, 0, 0, 0]).expect("a fault");
        assert_eq!(negative, Unphysical::NegativeMoment("Ixx", "-0.1".into()));
        assert!(!negative.can_be_accepted());
    }

    #[test]
    fn steiner_moves_the_tensor_to_the_centre_of_mass() {
        // a point of 2 kg at (1, 2, 3): nothing remains about its own place
        let about_origin = [26, 20, 10, -4, -6, -12].map(integer);
        let com = [1, 2, 3].map(integer);
        assert_eq!(about_com(&integer(2), &com, about_origin), [0; 6].map(integer));
    }
}
