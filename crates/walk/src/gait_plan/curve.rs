//! What a joint follows in a plan: functions of time that files can hold.

use crate::scenario_file::list;
use denavit_plants::trajectory::{
    Bezier, CosineProfile, CubicSpline, EndCondition, Part, Reference, Sequence,
};

/// A function of time on its own clock, which begins at 0 \[s\]; values in rad or m.
#[derive(Clone, Debug, PartialEq)]
pub enum Curve {
    /// A cubic spline through values, with the velocity 0 at both ends.
    Cubic {
        /// \[s\].
        times_s: Vec<f64>,
        /// [rad, m].
        values: Vec<f64>,
    },
    /// From one value to another with the velocity 1 - cos.
    Cosine {
        /// \[s\].
        duration_s: f64,
        /// [rad, m].
        values: [f64; 2],
    },
    /// A Bezier polynomial of these control values.
    Bezier {
        /// \[s\].
        duration_s: f64,
        /// [rad, m].
        controls: Vec<f64>,
    },
}

impl Curve {
    /// The same as a reference.
    ///
    /// # Errors
    /// Times that do not increase, numbers that are not finite.
    pub fn reference(&self) -> Result<Reference, denavit_plants::Error> {
        Ok(match self {
            Self::Cubic { times_s, values } => {
                let ends = [EndCondition::Rate(0.0); 2];
                Reference::Cubic(CubicSpline::new(times_s.clone(), values.clone(), ends)?)
            }
            Self::Cosine { duration_s, values } => {
                Reference::Cosine(CosineProfile::new([0.0, *duration_s], *values)?)
            }
            Self::Bezier { duration_s, controls } => {
                Reference::Bezier(Bezier::new([0.0, *duration_s], controls.clone())?)
            }
        })
    }

    /// Its entry in a scenario or trajectory file.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Cubic { times_s, values } => format!(
                "{{\"cubic\": {{\"times\": {}, \"values\": {}, \"end_rates\": [0.0, 0.0]}}}}",
                list(times_s.iter().copied()),
                list(values.iter().copied())
            ),
            Self::Cosine { duration_s, values } => format!(
                "{{\"cosine\": {{\"times\": [0.0, {duration_s:?}], \"values\": {}}}}}",
                list(values.iter().copied())
            ),
            Self::Bezier { duration_s, controls } => format!(
                "{{\"bezier\": {{\"times\": [0.0, {duration_s:?}], \"values\": {}}}}}",
                list(controls.iter().copied())
            ),
        }
    }
}

/// A curve that is followed for some time.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// \[s\].
    pub duration_s: f64,
    /// What is followed.
    pub curve: Curve,
}

/// What a joint follows: pieces one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct JointPath {
    /// The coordinate.
    pub joint: usize,
    /// The pieces.
    pub pieces: Vec<Piece>,
    /// Planned torques at times, joined by a cubic spline; none are planned for some gaits
    /// [N m, N].
    pub feed_forward: Option<Curve>,
}

impl JointPath {
    /// The same as a reference, once or again and again.
    ///
    /// # Errors
    /// Those of its curves.
    pub fn reference(&self, repeats: bool) -> Result<Reference, denavit_plants::Error> {
        let part = |piece: &Piece| {
            Ok(Part { duration_s: piece.duration_s, reference: piece.curve.reference()? })
        };
        let parts =
            self.pieces.iter().map(part).collect::<Result<Vec<_>, denavit_plants::Error>>()?;
        Ok(Reference::Sequence(Sequence::new(parts, repeats)?))
    }
}
