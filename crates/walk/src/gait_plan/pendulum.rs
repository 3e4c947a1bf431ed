//! The linear inverted pendulum: x'' = w^2 (x - p) with w = sqrt(g / z), in closed form.
//!
//! About a pivot p that rests, x - p = x0 cosh wt + x0'/w sinh wt (thesis 4.4.2). Here p, the
//! centre of pressure, goes from place to place at constant velocity, as from foot to foot in
//! double support. The divergent component x + x'/w is computed backwards in time and the centre of
//! mass forwards, so that errors shrink in both, over any number of steps.

/// A time in which the centre of pressure goes from one place to another at constant velocity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PressureSegment {
    /// \[s\].
    pub duration_s: f64,
    /// Where the centre of pressure is at the beginning and at the end \[m\].
    pub places_m: [f64; 2],
}

/// The pendulum at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PendulumState {
    /// Centre of mass \[m\].
    pub position_m: f64,
    /// Its velocity [m/s].
    pub velocity_m_s: f64,
    /// Its acceleration [m/s^2].
    pub acceleration_m_s2: f64,
    /// Centre of pressure \[m\].
    pub pressure_m: f64,
}

/// The path of the centre of mass.
#[derive(Clone, Debug, PartialEq)]
pub struct PendulumPath {
    /// w \[1/s\].
    omega: f64,
    pieces: Vec<Piece>,
}

/// x - p = growing / 2 e^(w (t - end)) + decaying e^(-w t), t since the start.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start_s: f64,
    segment: PressureSegment,
    growing_m: f64,
    decaying_m: f64,
}

impl PressureSegment {
    fn velocity(&self) -> f64 {
        (self.places_m[1] - self.places_m[0]) / self.duration_s
    }
}

impl PendulumPath {
    /// The path that begins at `start_m` and comes to rest over the last centre of pressure;
    /// durations are positive. With `omega` in 1/s.
    pub fn new(omega: f64, segments: &[PressureSegment], start_m: f64) -> Self {
        let mut pieces = Vec::with_capacity(segments.len());
        let total: f64 = segments.iter().map(|segment| segment.duration_s).sum();
        let mut start_s = total;
        let mut divergent = segments.last().map_or(start_m, |last| last.places_m[1]);
        for segment in segments.iter().rev() {
            let drift = segment.velocity() / omega;
            let growing_m = divergent - segment.places_m[1] - drift;
            let decay = (-omega * segment.duration_s).exp();
            divergent = segment.places_m[0] + drift + growing_m * decay;
            start_s -= segment.duration_s;
            pieces.push(Piece { start_s, segment: *segment, growing_m, decaying_m: 0.0 });
        }
        pieces.reverse();
        let mut position = start_m;
        let mut path = Self { omega, pieces: Vec::new() };
        for mut piece in pieces {
            let decay = (-omega * piece.segment.duration_s).exp();
            piece.decaying_m = position - piece.segment.places_m[0] - 0.5 * piece.growing_m * decay;
            position = path.state(&piece, piece.segment.duration_s).position_m;
            path.pieces.push(piece);
        }
        path
    }

    /// The path from rest at `start_m` to rest over the last centre of pressure. The centre of
    /// pressure at the ends of segments `first` and `last`, where the next ones begin, is moved for
    /// that: backwards to begin to walk, forwards to stop.
    ///
    /// None if nothing there makes it rest.
    pub fn resting(
        omega: f64,
        segments: &[PressureSegment],
        start_m: f64,
        ends: [usize; 2],
    ) -> Option<Self> {
        let shape = |moved: usize| -> Vec<f64> {
            (0..=segments.len()).map(|place| f64::from(u8::from(place == moved + 1))).collect()
        };
        let shapes = ends.map(shape);
        let is_inside = ends[1] + 1 < segments.len();
        is_inside.then(|| Self::resting_by(omega, segments, start_m, &shapes)).flatten()
    }

    /// As [`Self::resting`], where two shapes are added to the centre of pressure as far as rest
    /// asks for: `shapes` hold a value for each end of a segment, one more than there are segments.
    pub fn resting_by(
        omega: f64,
        segments: &[PressureSegment],
        start_m: f64,
        shapes: &[Vec<f64>; 2],
    ) -> Option<Self> {
        let moved = |shifts: [f64; 2]| {
            let mut segments = segments.to_vec();
            for (shape, shift) in shapes.iter().zip(shifts) {
                for (segment, ends) in segments.iter_mut().zip(shape.windows(2)) {
                    segment.places_m[0] += shift * ends[0];
                    segment.places_m[1] += shift * ends[1];
                }
            }
            Self::new(omega, &segments, start_m)
        };
        let missed = |path: &Self| {
            let [begin, end] = [path.at(0.0), path.at(path.duration_s())];
            [begin.velocity_m_s, end.velocity_m_s]
        };
        // linear in both shifts
        let own = missed(&moved([0.0, 0.0]));
        let columns = [[1.0, 0.0], [0.0, 1.0]].map(|unit| missed(&moved(unit)));
        let [a, c] = [0, 1].map(|row| columns[0][row] - own[row]);
        let [b, d] = [0, 1].map(|row| columns[1][row] - own[row]);
        let determinant = a * d - b * c;
        let shifts =
            [(b * own[1] - d * own[0]) / determinant, (c * own[0] - a * own[1]) / determinant];
        shifts.iter().all(|shift| shift.is_finite()).then(|| moved(shifts))
    }

    /// The whole time \[s\].
    pub fn duration_s(&self) -> f64 {
        self.pieces.last().map_or(0.0, |last| last.start_s + last.segment.duration_s)
    }

    /// The pendulum at a time, up to both ends \[s\].
    pub fn at(&self, t_s: f64) -> PendulumState {
        let after = self.pieces.partition_point(|piece| piece.start_s <= t_s);
        match self.pieces.get(after.saturating_sub(1)) {
            Some(piece) => {
                let since = (t_s - piece.start_s).clamp(0.0, piece.segment.duration_s);
                self.state(piece, since)
            }
            None => PendulumState {
                position_m: 0.0,
                velocity_m_s: 0.0,
                acceleration_m_s2: 0.0,
                pressure_m: 0.0,
            },
        }
    }

    fn state(&self, piece: &Piece, since_s: f64) -> PendulumState {
        let (omega, segment) = (self.omega, &piece.segment);
        let decay = (-omega * since_s).exp();
        let rise = (-omega * (segment.duration_s - since_s)).exp();
        let (growing, decaying) = (0.5 * piece.growing_m * rise, piece.decaying_m * decay);
        let pressure_m = segment.places_m[0] + segment.velocity() * since_s;
        let apart = growing + decaying;
        PendulumState {
            position_m: pressure_m + apart,
            velocity_m_s: segment.velocity() + omega * (growing - decaying),
            acceleration_m_s2: omega * omega * apart,
            pressure_m,
        }
    }
}
