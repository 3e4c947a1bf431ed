//! What criteria come to along a run.

use super::course::Course;
use super::instant::{Instant, Phase};
use denavit_simulate::SupportForm;

/// A point of the ground by which balance is judged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// The zero moment point of inertia and gravity.
    ZeroMoment,
    /// That of the cart-table model.
    CartTable,
    /// The foot rotation indicator of the one foot that stands.
    FootRotation,
    /// The capture point.
    Capture,
}

impl Criterion {
    /// Its point at an instant; none where it is not defined.
    pub fn point(self, instant: &Instant) -> Option<[f64; 3]> {
        let point = match self {
            Self::ZeroMoment => Some(instant.zero_moment_point_m),
            Self::CartTable => Some(instant.cart_table_m),
            Self::FootRotation => instant.foot_rotation_m,
            Self::Capture => Some(instant.capture_m),
        };
        point.filter(|point| point.iter().all(|entry| entry.is_finite()))
    }

    /// Its margin to the support polygon; negative outside \[m\].
    pub fn margin(self, instant: &Instant) -> Option<f64> {
        self.point(instant).and_then(|point| instant.margin(point))
    }
}

/// The margins of a criterion along a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margins {
    /// The least \[m\].
    pub least_m: f64,
    /// When \[s\].
    pub at_s: f64,
    /// The largest \[m\].
    pub largest_m: f64,
    /// The share of the time on the ground in which the point is outside.
    pub outside: f64,
}

/// Points of a line or of one point's support are on it: what is nearer is not outside \[m\].
const ON_M: f64 = 1e-7;

impl Course {
    /// The margins of a criterion; none where it is never defined.
    pub fn margins(&self, criterion: Criterion) -> Option<Margins> {
        let mut found: Option<Margins> = None;
        let (mut outside, mut count) = (0, 0);
        for instant in &self.instants {
            let Some(margin) = criterion.margin(instant) else { continue };
            count += 1;
            outside += usize::from(margin < -ON_M);
            let known = found.get_or_insert(Margins {
                least_m: margin,
                at_s: instant.t_s,
                largest_m: margin,
                outside: 0.0,
            });
            if margin < known.least_m {
                (known.least_m, known.at_s) = (margin, instant.t_s);
            }
            known.largest_m = known.largest_m.max(margin);
        }
        let outside = outside as f64 / f64::from(count.max(1));
        found.map(|margins| Margins { outside, ..margins })
    }

    /// The largest distance of the centre of pressure from the zero moment point: forces against
    /// momentum \[m\].
    pub fn forces_against_momentum_m(&self) -> f64 {
        let apart = |instant: &Instant| {
            let [a, b] = [instant.center_of_pressure_m, instant.zero_moment_point_m];
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            square.sqrt()
        };
        self.instants.iter().map(apart).filter(|apart| apart.is_finite()).fold(0.0, f64::max)
    }

    /// The largest distance of the foot rotation indicator from the zero moment point while the
    /// foot is flat and still \[m\].
    pub fn still_foot_apart_m(&self) -> Option<f64> {
        let still = self.instants.iter().filter(|i| i.is_still && i.phase == Phase::Flat);
        let apart = still.filter_map(|instant| {
            let [a, b] = [instant.foot_rotation_m?, instant.zero_moment_point_m];
            let square: f64 = a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum();
            Some(square.sqrt())
        });
        apart.reduce(f64::max)
    }

    /// Shares of the time.
    pub fn shares(&self) -> Shares {
        let total = self.instants.len().max(1) as f64;
        let share = |of: &dyn Fn(&Instant) -> bool| {
            self.instants.iter().filter(|instant| of(instant)).count() as f64 / total
        };
        Shares {
            flat: share(&|instant| instant.phase == Phase::Flat),
            toe: share(&|instant| instant.phase == Phase::Toe),
            double: share(&|instant| instant.phase == Phase::Double),
            flight: share(&|instant| instant.phase == Phase::Flight),
            one_point: share(&|instant| instant.support.form() == SupportForm::Point),
        }
    }

    /// The time that is covered \[s\].
    pub fn duration_s(&self) -> f64 {
        match (self.instants.first(), self.instants.last()) {
            (Some(first), Some(last)) => last.t_s - first.t_s,
            _ => 0.0,
        }
    }
}

/// Shares of the time by what stands on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shares {
    /// One foot on all of its sole.
    pub flat: f64,
    /// One foot on an edge or a corner.
    pub toe: f64,
    /// More than one foot.
    pub double: f64,
    /// Nothing.
    pub flight: f64,
    /// One point alone, of whatever foot.
    pub one_point: f64,
}
