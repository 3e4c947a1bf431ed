//! A planar robot with two legs, and its joint positions for given places of its feet.

use super::posture::{Conditions, Posture, Sought, bent, first, placed, reach};
use crate::error::{Error, PlanError};
use crate::inverse_kinematics::{Condition, largest_error};
use crate::leg_exchange::LegExchange;
use denavit_plants::Plant;

/// A foot: its ankle is the origin of the link that its contact points are on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    /// Contact point at the rear end of the sole.
    pub heel: usize,
    /// At the front end.
    pub toe: usize,
    /// From the heel forward to the ankle \[m\].
    pub heel_to_ankle_m: f64,
    /// From the ankle forward to the toe \[m\].
    pub ankle_to_toe_m: f64,
}

/// What sets the height of the robot.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Height {
    /// That of the base frame, where the hips are, above the ground \[m\].
    Hip(f64),
    /// That of the centre of mass above the ground \[m\].
    CenterOfMass(f64),
}

/// A posture by what it is to do, in the world frame; both feet are level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Of the right and the left foot: place of the ankle along x, height of the sole above the
    /// ground \[m\].
    pub feet_m: [[f64; 2]; 2],
    /// Centre of mass along x \[m\].
    pub center_m: f64,
    /// Height.
    pub height: Height,
    /// Pitch of the torso, positive forward \[rad\].
    pub pitch_rad: f64,
}

/// A planar robot with two legs whose joints and contact points are named `right_..` and
/// `left_..`.
#[derive(Clone, Debug)]
pub struct Walker {
    /// The feet: right, left.
    pub feet: [Foot; 2],
    /// Coordinates with a drive.
    pub driven: Vec<usize>,
    /// The exchange of the legs.
    pub exchange: LegExchange,
    /// Acceleration of free fall [m/s^2].
    pub gravity: f64,
    ground_m: f64,
    base: [usize; 3],
}

/// Sole points nearer to each other make no sole \[m\].
const SOLE_M: f64 = 1e-6;

impl Walker {
    /// The walker that a plant is.
    ///
    /// # Errors
    /// Robots in space, on a slope, without two legs that are alike.
    pub fn of(plant: &mut dyn Plant) -> Result<Self, Error> {
        let lacks = |what: &str| Error::from(PlanError::NoWalker(what.to_owned()));
        let model = plant.model().clone();
        if !model.planar {
            return Err(lacks("plane that it moves in"));
        }
        let base = ["base_x", "base_z", "base_pitch"].map(|name| {
            let found = model.find_joint(name);
            found.ok_or_else(|| lacks(&format!("joint `{name}`")))
        });
        let [x, z, pitch] = base;
        let exchange = LegExchange::find(plant)
            .ok_or_else(|| lacks("pair of legs, right_.. and left_.., that are alike"))?;
        let driven = model.joints.iter().enumerate().filter(|(_, joint)| joint.drivable);
        let driven = driven.map(|(index, _)| index).collect();
        let [right, left] = ["right_", "left_"].map(|side| foot(plant, side));
        let gravity = model
            .fall_onto_level_ground()
            .ok_or_else(|| lacks("gravity straight down onto level ground"))?;
        Ok(Self {
            feet: [right?, left?],
            driven,
            exchange,
            gravity,
            ground_m: model.ground.point[2],
            base: [x?, z?, pitch?],
        })
    }

    /// Where the hips are: along x, and up \[m\].
    pub(crate) fn hips_m(&self, q: &[f64]) -> [f64; 2] {
        [q[self.base[0]], q[self.base[1]]]
    }

    /// The coordinate that is the pitch of the torso, positive forward.
    pub(crate) fn pitch(&self) -> usize {
        self.base[2]
    }

    /// The middle of a sole, forward from its ankle \[m\].
    pub fn middle_m(&self) -> f64 {
        0.5 * (self.feet[0].ankle_to_toe_m - self.feet[0].heel_to_ankle_m)
    }

    /// The range along x of the soles of these feet, placed so \[m\].
    pub fn support_m(&self, feet_m: &[[f64; 2]; 2], standing: [bool; 2]) -> [f64; 2] {
        let mut range = [f64::INFINITY, f64::NEG_INFINITY];
        for side in (0..2).filter(|side| standing[*side]) {
            let (foot, ankle) = (self.feet[side], feet_m[side][0]);
            range[0] = range[0].min(ankle - foot.heel_to_ankle_m);
            range[1] = range[1].max(ankle + foot.ankle_to_toe_m);
        }
        range
    }

    fn sole(&self, side: usize, [ankle, lift]: [f64; 2]) -> [Condition; 3] {
        let (foot, height) = (self.feet[side], self.ground_m + lift);
        let x = ankle - foot.heel_to_ankle_m;
        [
            Condition::point(foot.heel, 0, x),
            Condition::point(foot.heel, 2, height),
            Condition::point(foot.toe, 2, height),
        ]
    }

    fn conditions(&self, pose: &Pose) -> Conditions {
        let implied = |side: usize| {
            let (foot, [ankle, _]) = (self.feet[side], pose.feet_m[side]);
            Condition::point(foot.toe, 0, ankle + foot.ankle_to_toe_m)
        };
        Conditions { solved: self.solved(pose), implied: [0, 1].map(implied).to_vec() }
    }

    fn solved(&self, pose: &Pose) -> Vec<Condition> {
        let [right, left] = [0, 1].map(|side| self.sole(side, pose.feet_m[side]));
        let mut conditions = [right, left].concat();
        conditions.push(Condition::CenterOfMass { axis: 0, value: pose.center_m });
        conditions.push(match pose.height {
            Height::Hip(height) => Condition::Coordinate(self.base[1], self.ground_m + height),
            Height::CenterOfMass(height) => {
                Condition::CenterOfMass { axis: 2, value: self.ground_m + height }
            }
        });
        conditions.push(Condition::Coordinate(self.base[2], pose.pitch_rad));
        conditions
    }

    /// The posture of a pose near `near`; `name` and time are for messages.
    ///
    /// # Errors
    /// Poses that are out of reach, or beyond a joint's limit.
    pub fn reach(
        &self,
        plant: &mut dyn Plant,
        pose: &Pose,
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
        pose: &Pose,
        at: Sought<'_>,
    ) -> Result<Posture, Error> {
        let mut start = bent(plant.model(), &self.driven);
        let height = match pose.height {
            Height::Hip(height) | Height::CenterOfMass(height) => height,
        };
        start[self.base[0]] = pose.center_m;
        start[self.base[1]] = self.ground_m + height;
        start[self.base[2]] = pose.pitch_rad;
        Ok(first(plant, &self.conditions(pose), &start, &self.driven, at)?)
    }

    /// All coordinates for these joint positions while a foot stands level at a place.
    ///
    /// # Errors
    /// If the foot cannot be put there.
    pub(super) fn placed(
        &self,
        plant: &mut dyn Plant,
        side: usize,
        foot_m: [f64; 2],
        q: &[f64],
        at: Sought<'_>,
    ) -> Result<Vec<f64>, Error> {
        let mut conditions = self.sole(side, foot_m).to_vec();
        let joints = (0..q.len()).filter(|joint| !self.base.contains(joint));
        conditions.extend(joints.map(|joint| Condition::Coordinate(joint, q[joint])));
        Ok(placed(plant, &conditions, q, at)?)
    }

    /// How far a sole is from being level at a place \[m\].
    pub(super) fn off_place_m(
        &self,
        plant: &mut dyn Plant,
        side: usize,
        foot_m: [f64; 2],
        q: &[f64],
    ) -> f64 {
        largest_error(plant, &self.sole(side, foot_m), q)
    }

    /// The largest error of a pose's conditions at these coordinates [m, rad].
    pub(super) fn error(&self, plant: &mut dyn Plant, pose: &Pose, q: &[f64]) -> f64 {
        largest_error(plant, &self.solved(pose), q)
    }

    /// How deep a sole is below the ground \[m\].
    pub(super) fn depth_m(&self, plant: &mut dyn Plant, side: usize, q: &[f64]) -> f64 {
        let mut positions = vec![0.0; 3 * plant.model().contacts.len()];
        plant.contact_positions(q, &mut positions);
        let foot = self.feet[side];
        let heights = [foot.heel, foot.toe].map(|point| positions[3 * point + 2]);
        (self.ground_m - heights[0].min(heights[1])).max(0.0)
    }
}

/// The foot of a side: the rearmost and the foremost of its contact points with straight legs.
fn foot(plant: &mut dyn Plant, side: &str) -> Result<Foot, Error> {
    let model = plant.model().clone();
    let straight = vec![0.0; model.joints.len()];
    let mut positions = vec![0.0; 3 * model.contacts.len()];
    plant.contact_positions(&straight, &mut positions);
    let mut transforms = vec![0.0; 12 * model.links.len()];
    plant.link_transforms(&straight, &mut transforms);
    let lacks =
        || Error::from(PlanError::NoWalker(format!("sole with two contact points `{side}..`")));
    let own = (0..model.contacts.len()).filter(|c| model.contacts[*c].name.starts_with(side));
    let x = |contact: &usize| positions[3 * contact];
    let heel = own.clone().min_by(|a, b| x(a).total_cmp(&x(b))).ok_or_else(lacks)?;
    let toe = own.max_by(|a, b| x(a).total_cmp(&x(b))).ok_or_else(lacks)?;
    let link = model.contacts[heel].link;
    let along = [x(&toe) - x(&heel), positions[3 * toe + 2] - positions[3 * heel + 2]];
    let length = along[0].hypot(along[1]);
    if model.contacts[toe].link != link || length < SOLE_M {
        return Err(lacks());
    }
    let ankle = [transforms[12 * link + 3], transforms[12 * link + 11]];
    let arm = [ankle[0] - x(&heel), ankle[1] - positions[3 * heel + 2]];
    let heel_to_ankle_m = (arm[0] * along[0] + arm[1] * along[1]) / length;
    Ok(Foot { heel, toe, heel_to_ankle_m, ankle_to_toe_m: length - heel_to_ankle_m })
}
