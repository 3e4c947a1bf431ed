//! A robot in space with two legs, and its joint positions for given places of its soles.

use super::posture::{Conditions, Posture, Sought, bent, first, placed, reach};
use crate::error::{Error, PlanError};
use crate::inverse_kinematics::{Condition, largest_error};
use denavit_numerics::least_and_most;
use denavit_plants::{Plant, PlantModel};
use denavit_simulate::SupportPolygon;

/// The sole of a foot. Its place is the middle of its contact points, the mean of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Sole {
    /// Its contact points, three at least.
    pub points: Vec<usize>,
    /// Where they are, forward and to the left of the middle \[m\].
    pub places_m: Vec<[f64; 2]>,
    /// Three of `points` that say how the sole lies: two far apart, one beside their line.
    frame: [usize; 3],
    /// The joint nearest to the foot that rolls it, if there is one.
    pub roll: Option<AnkleRoll>,
}

/// A joint that turns a foot about its forward axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnkleRoll {
    /// The coordinate.
    pub joint: usize,
    /// Where its axis crosses the sole, to the left of the middle \[m\].
    pub left_m: f64,
}

/// Where a sole is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolePlace {
    /// Its middle in the world, x and y \[m\].
    pub middle_m: [f64; 2],
    /// Its direction, from x to the left \[rad\].
    pub yaw_rad: f64,
    /// Its height above the ground \[m\].
    pub lift_m: f64,
}

impl SolePlace {
    /// A point seen from the sole, forward and to the left of its middle, in the world \[m\].
    pub fn point_m(&self, [forward, left]: [f64; 2]) -> [f64; 2] {
        let (sine, cosine) = self.yaw_rad.sin_cos();
        let [x, y] = self.middle_m;
        [x + cosine * forward - sine * left, y + sine * forward + cosine * left]
    }
}

/// What says how the trunk rolls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RollCondition {
    /// The roll of the base \[rad\].
    Torso(f64),
    /// The ankle rolls are at zero: that of the right foot, weighted by 1 - share, and that of the
    /// left one by the share.
    Ankles(f64),
}

/// A posture by what it is to do, in the world frame; both soles are level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BipedPose {
    /// Of the right and the left foot.
    pub soles: [SolePlace; 2],
    /// Centre of mass along x and y, and above the ground \[m\].
    pub center_m: [f64; 3],
    /// Direction of the torso, from x to the left \[rad\].
    pub yaw_rad: f64,
    /// Pitch of the torso, positive forward \[rad\].
    pub pitch_rad: f64,
    /// Its roll.
    pub roll: RollCondition,
}

/// A robot in space with a floating base and two legs, whose contact points are named `right_..`
/// and `left_..`. At zero of all coordinates its soles are level, and its forward direction is x.
#[derive(Clone, Debug)]
pub struct Biped {
    /// Right, left.
    pub soles: [Sole; 2],
    /// Coordinates with a drive.
    pub drivable: Vec<usize>,
    /// Acceleration of free fall [m/s^2].
    pub gravity: f64,
    ground_m: f64,
    base: Base,
}

/// Coordinates of the base: x, y, z; yaw to the left, roll, pitch forward, with the sign that each
/// has.
#[derive(Clone, Copy, Debug)]
struct Base {
    places: [usize; 3],
    turns: [(usize, f64); 3],
}

/// Points nearer to each other make no sole; soles less level than this are not level \[m\].
const SOLE_M: f64 = 1e-6;
/// A joint rolls a foot if this much of its turning is about the forward axis.
const ROLLS: f64 = 0.9;

impl Biped {
    /// The biped that a plant is.
    ///
    /// # Errors
    /// Robots in the plane, on a slope, without two soles.
    pub fn of(plant: &mut dyn Plant) -> Result<Self, Error> {
        let lacks = |what: &str| Error::from(PlanError::NoBiped(what.to_owned()));
        let model = plant.model().clone();
        if model.planar {
            return Err(lacks("freedom to move in space"));
        }
        let gravity = model
            .fall_onto_level_ground()
            .ok_or_else(|| lacks("gravity straight down onto level ground"))?;
        let joint = |name: &str| {
            let found = model.find_joint(name);
            found.ok_or_else(|| lacks(&format!("joint `{name}`")))
        };
        let places = [joint("base_x")?, joint("base_y")?, joint("base_z")?];
        let turns = [joint("base_yaw")?, joint("base_roll")?, joint("base_pitch")?];
        let upright = Upright::of(plant);
        let [right, left] = ["right_", "left_"].map(|side| upright.sole(&model, side));
        let soles = [right?, left?];
        // every sole turns with the base
        let turned = |about: usize| (turns[about], upright.turn(&soles[0], turns[about])[about]);
        let drivable = model.joints.iter().enumerate().filter(|(_, joint)| joint.drivable);
        Ok(Self {
            drivable: drivable.map(|(index, _)| index).collect(),
            gravity,
            ground_m: model.ground.point[2],
            base: Base { places, turns: [0, 1, 2].map(turned) },
            soles,
        })
    }

    /// The distance of the middles of the soles when all coordinates are zero \[m\].
    pub fn width_m(&self, plant: &mut dyn Plant) -> f64 {
        let upright = Upright::of(plant);
        let middle = |sole: &Sole| upright.middle_m(&sole.points)[1];
        (middle(&self.soles[1]) - middle(&self.soles[0])).abs()
    }

    /// Where a sole is, seen from above, for these places of all contact points \[m\].
    pub(crate) fn place(&self, side: usize, positions: &[f64]) -> SolePlace {
        let sole = &self.soles[side];
        let at = |point: usize, axis: usize| positions[3 * point + axis];
        let mean = |axis: usize| {
            sole.points.iter().map(|point| at(*point, axis)).sum::<f64>() / sole.points.len() as f64
        };
        let [from, far, _] = sole.frame;
        let [u, v] = [0, 1].map(|axis| at(sole.points[far], axis) - at(sole.points[from], axis));
        let [p, q] = [0, 1].map(|axis| sole.places_m[far][axis] - sole.places_m[from][axis]);
        SolePlace {
            middle_m: [mean(0), mean(1)],
            yaw_rad: (p * v - q * u).atan2(p * u + q * v),
            lift_m: mean(2) - self.ground_m,
        }
    }

    /// Corners of a sole in the world \[m\].
    pub fn corners_m(&self, side: usize, place: &SolePlace) -> Vec<[f64; 3]> {
        let corner = |at: &[f64; 2]| {
            let [x, y] = place.point_m(*at);
            [x, y, self.ground_m + place.lift_m]
        };
        self.soles[side].places_m.iter().map(corner).collect()
    }

    /// Distance of a point of the ground from the edge of the support polygon of those soles that
    /// stand, negative outside \[m\].
    pub fn margin_m(
        &self,
        model: &PlantModel,
        soles: &[SolePlace; 2],
        standing: [bool; 2],
        [x, y]: [f64; 2],
    ) -> f64 {
        let own = (0..2).filter(|side| standing[*side]);
        let corners: Vec<[f64; 3]> =
            own.flat_map(|side| self.corners_m(side, &soles[side])).collect();
        let polygon = SupportPolygon::of(model, corners.iter().map(|corner| &corner[..]));
        polygon.margin([x, y, self.ground_m])
    }

    /// The share of each contact point in the load, of which the left foot has a share.
    pub(crate) fn weights(&self, model: &PlantModel, left: f64) -> Vec<f64> {
        let mut weights = vec![0.0; model.contacts.len()];
        for (sole, load) in self.soles.iter().zip([1.0 - left, left]) {
            sole.points.iter().for_each(|point| weights[*point] = load);
        }
        weights
    }

    /// Whether soles at these places are beside each other, seen from above.
    pub fn are_apart(&self, soles: &[SolePlace; 2]) -> bool {
        let hulls = [0, 1].map(|side| self.corners_m(side, &soles[side]));
        let edges = hulls.iter().flat_map(|hull| {
            let pairs = hull.iter().flat_map(|a| hull.iter().map(move |b| (a, b)));
            pairs.map(|(a, b)| [b[1] - a[1], a[0] - b[0]])
        });
        // convex shapes are apart if a line along an edge of one of them has them on both sides
        let extent = |hull: &[[f64; 3]], [u, v]: [f64; 2]| {
            least_and_most(hull.iter().map(|corner| u * corner[0] + v * corner[1]))
        };
        edges.into_iter().any(|edge| {
            let [right, left] = [0, 1].map(|side| extent(&hulls[side], edge));
            right[1] < left[0] || left[1] < right[0]
        })
    }

    /// The six conditions of a sole at a place.
    fn sole(&self, side: usize, place: &SolePlace) -> [Condition; 6] {
        let sole = &self.soles[side];
        let [a, b, c] = sole.frame;
        let height = self.ground_m + place.lift_m;
        let [[x, y], [far_x, far_y]] = [a, b].map(|of| place.point_m(sole.places_m[of]));
        let length = (far_x - x).hypot(far_y - y);
        let across = [(y - far_y) / length, (far_x - x) / length, 0.0];
        let value = across[0] * x + across[1] * y;
        let [a, b, c] = [a, b, c].map(|of| sole.points[of]);
        [
            Condition::point(a, 0, x),
            Condition::point(a, 1, y),
            Condition::point(a, 2, height),
            Condition::Point { contact: b, along: across, value },
            Condition::point(b, 2, height),
            Condition::point(c, 2, height),
        ]
    }

    fn conditions(&self, pose: &BipedPose) -> Conditions {
        let corners = (0..2).flat_map(|side| {
            let places = self.corners_m(side, &pose.soles[side]);
            self.soles[side].points.iter().copied().zip(places)
        });
        let implied = corners.flat_map(|(point, place)| {
            let axes = place.into_iter().enumerate();
            axes.map(move |(axis, value)| Condition::point(point, axis, value))
        });
        Conditions { solved: self.solved(pose), implied: implied.collect() }
    }

    fn solved(&self, pose: &BipedPose) -> Vec<Condition> {
        let mut conditions = [0, 1].map(|side| self.sole(side, &pose.soles[side])).concat();
        let [x, y, z] = pose.center_m;
        let center = [x, y, self.ground_m + z].into_iter().enumerate();
        conditions.extend(center.map(|(axis, value)| Condition::CenterOfMass { axis, value }));
        let [yaw, roll, pitch] = self.base.turns;
        let turned = |(joint, sign): (usize, f64), value: f64| {
            // a turn of unit rate is a coordinate of unit rate, but for its sign
            Condition::Coordinate(joint, value * sign.signum())
        };
        conditions.push(turned(yaw, pose.yaw_rad));
        conditions.push(turned(pitch, pose.pitch_rad));
        match (pose.roll, self.rolls()) {
            (RollCondition::Ankles(share), Some(rolls)) => {
                let coordinates = rolls.map(|roll| roll.joint);
                conditions.push(Condition::Blend { coordinates, share, value: 0.0 });
            }
            (RollCondition::Torso(value), _) => conditions.push(turned(roll, value)),
            (RollCondition::Ankles(_), None) => conditions.push(turned(roll, 0.0)),
        }
        conditions
    }

    /// The ankle rolls of both feet, right and left, if they have them.
    pub fn rolls(&self) -> Option<[AnkleRoll; 2]> {
        let [right, left] = &self.soles;
        Some([right.roll?, left.roll?])
    }

    /// The posture of a pose near `near`; `name` and time are for messages.
    ///
    /// # Errors
    /// Poses that are out of reach, or beyond a joint's limit.
    pub fn reach(
        &self,
        plant: &mut dyn Plant,
        pose: &BipedPose,
        near: &[f64],
        at: Sought<'_>,
    ) -> Result<Posture, Error> {
        Ok(reach(plant, &self.conditions(pose), near, at)?)
    }

    /// The posture of a pose, looked for from several starts: of those within limits that with the
    /// least angles.
    ///
    /// # Errors
    /// As of [`Self::reach`]: the error of the first start, or of the one that comes nearest.
    pub fn first(
        &self,
        plant: &mut dyn Plant,
        pose: &BipedPose,
        at: Sought<'_>,
    ) -> Result<Posture, Error> {
        let mut start = bent(plant.model(), &self.drivable);
        let [x, y, z] = pose.center_m;
        for (place, value) in self.base.places.into_iter().zip([x, y, self.ground_m + z]) {
            start[place] = value;
        }
        Ok(first(plant, &self.conditions(pose), &start, &self.drivable, at)?)
    }

    /// All coordinates for these joint positions while a foot stands at a place.
    ///
    /// # Errors
    /// If the foot cannot be put there.
    pub(super) fn placed(
        &self,
        plant: &mut dyn Plant,
        side: usize,
        place: &SolePlace,
        q: &[f64],
        at: Sought<'_>,
    ) -> Result<Vec<f64>, Error> {
        let mut conditions = self.sole(side, place).to_vec();
        let joints = self.drivable.iter();
        conditions.extend(joints.map(|joint| Condition::Coordinate(*joint, q[*joint])));
        Ok(placed(plant, &conditions, q, at)?)
    }

    /// The largest error of a pose's conditions at these coordinates [m, rad].
    pub(super) fn error(&self, plant: &mut dyn Plant, pose: &BipedPose, q: &[f64]) -> f64 {
        largest_error(plant, &self.solved(pose), q)
    }
}

/// A robot with all coordinates at zero: places and velocities of its contact points.
struct Upright {
    coordinates: usize,
    positions: Vec<f64>,
    jacobian: Vec<f64>,
}

impl Upright {
    fn of(plant: &mut dyn Plant) -> Self {
        let (coordinates, points) = (plant.model().joints.len(), plant.model().contacts.len());
        let q = vec![0.0; coordinates];
        let mut positions = vec![0.0; 3 * points];
        let mut jacobian = vec![0.0; 3 * points * coordinates];
        plant.contact_positions(&q, &mut positions);
        plant.contact_jacobian(&q, &mut jacobian);
        Self { coordinates, positions, jacobian }
    }

    fn middle_m(&self, points: &[usize]) -> [f64; 3] {
        let sum = |axis: usize| points.iter().map(|p| self.positions[3 * p + axis]).sum::<f64>();
        [0, 1, 2].map(|axis| sum(axis) / points.len().max(1) as f64)
    }

    fn sole(&self, model: &PlantModel, side: &str) -> Result<Sole, Error> {
        let lacks = |what: &str| Error::from(PlanError::NoBiped(format!("sole `{side}..` {what}")));
        let own = (0..model.contacts.len()).filter(|c| model.contacts[*c].name.starts_with(side));
        let points: Vec<usize> = own.collect();
        let link = points.first().map(|point| model.contacts[*point].link);
        if points.iter().any(|point| Some(model.contacts[*point].link) != link) {
            return Err(lacks("on one link"));
        }
        let middle = self.middle_m(&points);
        let from_middle =
            |point: &usize| [0, 1, 2].map(|axis| self.positions[3 * point + axis] - middle[axis]);
        let places: Vec<[f64; 3]> = points.iter().map(from_middle).collect();
        if places.iter().any(|place| place[2].abs() > SOLE_M) {
            return Err(lacks("that is level where all coordinates are zero"));
        }
        let places_m: Vec<[f64; 2]> = places.iter().map(|[x, y, _]| [*x, *y]).collect();
        let frame =
            frame(&places_m).ok_or_else(|| lacks("of three contact points with an area"))?;
        let mut sole = Sole { points, places_m, frame, roll: None };
        sole.roll = self.roll(model, &sole, link);
        Ok(sole)
    }

    /// How a coordinate of unit rate turns a sole: yaw to the left, roll, pitch forward.
    fn turn(&self, sole: &Sole, joint: usize) -> [f64; 3] {
        let [a, b, c] = sole.frame;
        let velocity = |of: usize| {
            let row = |axis: usize| (3 * sole.points[of] + axis) * self.coordinates + joint;
            [0, 1, 2].map(|axis| self.jacobian[row(axis)])
        };
        let [from, far, beside] = [a, b, c].map(velocity);
        let arm = |of: usize| {
            let [x, y] = sole.places_m[of];
            [x - sole.places_m[a][0], y - sole.places_m[a][1]]
        };
        let ([u, v], [p, q]) = (arm(b), arm(c));
        let rise = [far[2] - from[2], beside[2] - from[2]];
        // the rise of a sole is linear: roll times y, minus pitch times x
        let area = u * q - v * p;
        let roll = (u * rise[1] - p * rise[0]) / area;
        let pitch = (v * rise[1] - q * rise[0]) / area;
        let yaw = (u * (far[1] - from[1]) - v * (far[0] - from[0])) / (u * u + v * v);
        [yaw, roll, pitch]
    }

    /// The joint nearest to a foot that rolls it.
    fn roll(&self, model: &PlantModel, sole: &Sole, link: Option<usize>) -> Option<AnkleRoll> {
        let mut next = link;
        while let Some(link) = next {
            next = model.parents.get(link).copied().flatten();
            let Some(joint) = model.find_joint(&model.links[link]) else { continue };
            let [yaw, roll, pitch] = self.turn(sole, joint);
            let size = yaw.hypot(roll).hypot(pitch);
            if !model.joints[joint].drivable || roll.abs() < ROLLS * size || size < ROLLS {
                continue;
            }
            // the sole's rise is zero where the axis is
            let point = sole.points[sole.frame[0]];
            let rise = self.jacobian[(3 * point + 2) * self.coordinates + joint];
            let [x, y] = sole.places_m[sole.frame[0]];
            return Some(AnkleRoll { joint, left_m: y - (rise + pitch * x) / roll });
        }
        None
    }
}

/// Three of some points: the two that are farthest apart, and that which is farthest from their
/// line.
fn frame(places_m: &[[f64; 2]]) -> Option<[usize; 3]> {
    let apart = |a: usize, b: usize| {
        let ([x, y], [u, v]) = (places_m[a], places_m[b]);
        (u - x).hypot(v - y)
    };
    let pairs = (0..places_m.len()).flat_map(|a| (a + 1..places_m.len()).map(move |b| (a, b)));
    let (a, b) =
        pairs.reduce(
            |best, pair| {
                if apart(pair.0, pair.1) > apart(best.0, best.1) { pair } else { best }
            },
        )?;
    let length = apart(a, b);
    let beside = |c: usize| {
        let ([x, y], [u, v], [p, q]) = (places_m[a], places_m[b], places_m[c]);
        ((u - x) * (q - y) - (v - y) * (p - x)).abs() / length
    };
    let c =
        (0..places_m.len()).reduce(|best, c| if beside(c) > beside(best) { c } else { best })?;
    (length > SOLE_M && beside(c) > SOLE_M).then_some([a, b, c])
}
