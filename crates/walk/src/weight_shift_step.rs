//! The step of thesis 2.3.5: the weight rests over the right foot while the left one is lifted,
//! carried forward and set down; then the weight shifts to it.
//!
//! The ankles of TUlip do not turn about their forward axis: the right leg stays perpendicular to
//! the ground, and the torso has to be inclined heavily for the weight to be over one foot.
//!
//! Six conditions for each foot, two for the centre of mass, no pitch and yaw of the torso, no roll
//! of the right ankle, and the bend of the right knee: as many as coordinates. The postures at
//! regular times are joined by cubic splines.

use super::inverse_kinematics::{Condition, PostureError, solve};
use denavit_plants::Plant;
use denavit_plants::trajectory::{CubicSpline, EndCondition, Reference, TrajectoryError};
use denavit_runtime::Scalar;

/// The phases and sizes of the step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightShiftStep {
    /// The left heel rises until the foot is released, then the foot swings, lands, and the weight
    /// shifts from the third time to the fourth \[s\].
    pub phases_s: [f64; 4],
    /// How far the left foot goes \[m\].
    pub length_m: f64,
    /// How high \[m\].
    pub lift_m: f64,
    /// Rise of the heel before the release: pitch about the toe \[rad\].
    pub heel_rise: f64,
    /// Centre of mass from the middle of the right sole, forward and to the left, until the weight
    /// shifts \[m\].
    pub weight_m: [f64; 2],
    /// Bend of the right knee \[rad\].
    pub knee: f64,
    /// Distance of the postures \[s\].
    pub interval_s: f64,
}

impl Default for WeightShiftStep {
    fn default() -> Self {
        Self {
            phases_s: [1.6, 3.2, 4.4, 6.4],
            length_m: 0.10,
            lift_m: 0.03,
            heel_rise: 0.08,
            weight_m: [0.0, 0.01],
            knee: 1.5,
            interval_s: 0.05,
        }
    }
}

/// Why there is no gait.
#[derive(Clone, Debug, PartialEq)]
pub enum GaitError {
    /// The plant has no joint or contact point of this name: the step is that of TUlip.
    Missing(String),
    /// A posture is out of reach.
    Posture {
        /// Its time \[s\].
        t_s: f64,
        /// Why.
        error: PostureError,
    },
    /// Phases that do not follow each other, or an interval that is not positive.
    Times,
    /// More postures than there may be; holds the most.
    TooMany(usize),
    /// The splines refuse the postures.
    Spline(TrajectoryError),
}

impl std::fmt::Display for GaitError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Missing(name) => write!(f, "the robot has no joint or contact `{name}`"),
            Self::Posture { t_s, error } => write!(f, "at {t_s} s: {error}"),
            Self::Times => write!(f, "the phases must follow each other, by more than an interval"),
            Self::TooMany(most) => write!(f, "the gait would have more than {most} postures"),
            Self::Spline(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for GaitError {}

/// Postures of a gait.
#[derive(Clone, Debug, PartialEq)]
pub struct Gait {
    /// \[s\].
    pub times_s: Vec<f64>,
    /// All coordinates at each time.
    pub postures: Vec<Vec<f64>>,
}

impl Gait {
    /// The reference of a coordinate: a cubic spline at rest at both ends.
    pub fn reference(&self, coordinate: usize) -> Result<Reference, TrajectoryError> {
        let values = self.postures.iter().map(|posture| posture[coordinate]).collect();
        let ends = [EndCondition::Rate(0.0); 2];
        Ok(Reference::Cubic(CubicSpline::new(self.times_s.clone(), values, ends)?))
    }
}

/// A gait with more postures is planned for longer than anybody waits.
const MAX_POSTURES: usize = 20_000;

/// The postures of the step.
pub fn plan(plant: &mut dyn Plant, step: &WeightShiftStep) -> Result<Gait, GaitError> {
    let [release, landing, shift, end] = step.phases_s;
    let ordered = 0.0 < release && release < landing && landing <= shift && shift < end;
    // Written so that NaN fails as well.
    if !(ordered && step.interval_s > 0.0 && step.interval_s < release && end.is_finite()) {
        return Err(GaitError::Times);
    }
    let count = (end / step.interval_s).round() as usize;
    if count > MAX_POSTURES {
        return Err(GaitError::TooMany(MAX_POSTURES));
    }
    let body = Body::of(plant)?;
    let mut q = body.stance(plant, step)?;
    let mut gait = Gait { times_s: Vec::new(), postures: Vec::new() };
    for index in 0..=count {
        let t_s = index as f64 * step.interval_s;
        let conditions = body.conditions(step, t_s, 1.0);
        solve(plant, &conditions, &mut q).map_err(|error| GaitError::Posture { t_s, error })?;
        gait.times_s.push(t_s);
        gait.postures.push(q.clone());
    }
    Ok(gait)
}

/// A sole.
#[derive(Clone, Copy, Debug)]
struct Sole {
    /// Contact numbers: inner toe, outer toe, inner heel.
    points: [usize; 3],
    /// Where these are when the robot stands upright: x and y in the world \[m\].
    flat: [[f64; 2]; 3],
}

/// Where the parts of the robot stand among coordinates and contacts.
struct Body {
    coordinates: usize,
    yaw: usize,
    pitch: usize,
    knee: usize,
    roll: usize,
    soles: [Sole; 2],
    /// Bent knees, soles flat on the ground.
    start: Vec<f64>,
}

impl Body {
    fn of(plant: &mut dyn Plant) -> Result<Self, GaitError> {
        let model = plant.model();
        let joint = |name: &str| {
            let found = model.joints.iter().position(|joint| joint.name == name);
            found.ok_or_else(|| GaitError::Missing(name.to_owned()))
        };
        let point = |name: String| {
            let found = model.contacts.iter().position(|contact| contact.name == name);
            found.ok_or(GaitError::Missing(name))
        };
        let mut start = vec![0.0; model.joints.len()];
        let mut points = [[0; 3]; 2];
        for (side, name) in ["right", "left"].into_iter().enumerate() {
            for (part, bend) in [("hip_y", -0.3), ("knee", 0.6), ("ankle_y", -0.3)] {
                start[joint(&format!("{name}_{part}"))?] = bend;
            }
            for (place, part) in ["toe_inner", "toe_outer", "heel_inner"].into_iter().enumerate() {
                points[side][place] = point(format!("{name}_{part}"))?;
            }
        }
        let [height, yaw, pitch] = [joint("base_z")?, joint("base_yaw")?, joint("base_pitch")?];
        let [knee, roll] = [joint("right_knee")?, joint("right_ankle_x")?];
        let (coordinates, contacts) = (model.joints.len(), model.contacts.len());
        let mut positions = vec![0.0; 3 * contacts];
        plant.contact_positions(&start, &mut positions);
        let at = |point: usize| [positions[3 * point], positions[3 * point + 1]];
        start[height] -= positions[3 * points[0][0] + 2];
        let soles = points.map(|points| Sole { points, flat: points.map(at) });
        Ok(Self { coordinates, yaw, pitch, knee, roll, soles, start })
    }

    /// The first posture, reached from the upright one by moving the weight in small steps.
    fn stance(&self, plant: &mut dyn Plant, step: &WeightShiftStep) -> Result<Vec<f64>, GaitError> {
        let mut q = self.start.clone();
        for part in 0..=20 {
            let conditions = self.conditions(step, 0.0, f64::from(part) / 20.0);
            solve(plant, &conditions, &mut q)
                .map_err(|error| GaitError::Posture { t_s: 0.0, error })?;
        }
        Ok(q)
    }

    /// All conditions at a time; `share` of the way from standing upright.
    fn conditions(&self, step: &WeightShiftStep, t_s: f64, share: f64) -> Vec<Condition> {
        let [release, landing, shift, end] = step.phases_s;
        let pitch = step.heel_rise
            * (smooth(t_s / release) - smooth((t_s - release) / (0.375 * (landing - release))));
        let swing = (t_s - release) / (landing - release);
        let forward = step.length_m * smooth((swing - 0.0625) / 0.875);
        let (sine, _) = (std::f64::consts::PI * swing.clamp(0.0, 1.0)).sincos();
        let lift = step.lift_m * sine * sine;
        let mut conditions = Vec::with_capacity(self.coordinates);
        self.place(&self.soles[0], [0.0; 3], &mut conditions);
        self.place(&self.soles[1], [forward, lift, pitch], &mut conditions);
        // Half the way to the left foot.
        let moved = smooth((t_s - shift) / (end - shift));
        let middle = 0.5 * (self.soles[0].flat[0][1] + self.soles[1].flat[0][1]);
        let [toe, outer, heel] = self.soles[0].flat;
        let weight = step.weight_m[1] + 0.5 * (toe[1] + outer[1]);
        let x = step.weight_m[0] + 0.5 * (toe[0] + heel[0] + step.length_m * moved);
        let y = middle + share * (1.0 - moved) * (weight - middle);
        conditions.push(Condition::CenterOfMass { axis: 0, value: x });
        conditions.push(Condition::CenterOfMass { axis: 1, value: y });
        conditions.push(Condition::Coordinate(self.yaw, 0.0));
        conditions.push(Condition::Coordinate(self.pitch, 0.0));
        conditions.push(Condition::Coordinate(self.roll, 0.0));
        let bend = self.start[self.knee];
        conditions.push(Condition::Coordinate(self.knee, bend + share * (step.knee - bend)));
        conditions
    }

    /// A foot moved forward and up, and pitched about its toes.
    fn place(
        &self,
        sole: &Sole,
        [forward, lift, pitch]: [f64; 3],
        conditions: &mut Vec<Condition>,
    ) {
        let [toe, outer, heel] = sole.flat;
        let (sine, _) = pitch.sincos();
        let behind = heel[0] - toe[0];
        let mut add = |place: usize, axis, value| {
            conditions.push(Condition::point(sole.points[place], axis, value));
        };
        add(0, 0, toe[0] + forward);
        add(0, 1, toe[1]);
        add(0, 2, lift);
        add(1, 0, outer[0] + forward);
        add(1, 2, lift);
        // Its height says the pitch.
        add(2, 2, lift - behind * sine);
    }
}

/// From 0 to 1 without rate and acceleration at the ends.
fn smooth(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    u * u * u * (10.0 - u * (15.0 - 6.0 * u))
}
