//! Two legs in a plane: which coordinates and contact points are whose, and how legs swap.

use crate::error::{DesignError, Error};
use denavit_plants::{Plant, PlantModel};

/// A contact point of a walker, seen from the step: the stance leg carries it until the swing leg
/// strikes the ground, then the legs swap.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Role {
    /// Rear end of the stance foot.
    StanceHeel,
    /// Front end of the stance foot.
    StanceToe,
    /// Rear end of the swing foot.
    SwingHeel,
    /// Front end of the swing foot.
    SwingToe,
}

impl Role {
    /// All roles, in the order of the enum.
    pub const ALL: [Self; 4] = [Self::StanceHeel, Self::StanceToe, Self::SwingHeel, Self::SwingToe];

    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 4] = ["stance_heel", "stance_toe", "swing_heel", "swing_toe"];

    /// What files call it.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// The role that the point has after the legs have swapped.
    pub fn swapped(self) -> Self {
        match self {
            Self::StanceHeel => Self::SwingHeel,
            Self::StanceToe => Self::SwingToe,
            Self::SwingHeel => Self::StanceHeel,
            Self::SwingToe => Self::StanceToe,
        }
    }

    /// Whether it belongs to the stance leg.
    pub fn is_stance(self) -> bool {
        matches!(self, Self::StanceHeel | Self::StanceToe)
    }

    /// Whether it is the rear end of its foot.
    pub fn is_heel(self) -> bool {
        matches!(self, Self::StanceHeel | Self::SwingHeel)
    }
}

/// Joints of a leg, from the hip down.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Leg {
    /// Coordinate of the hip.
    pub hip: usize,
    /// Of the knee.
    pub knee: usize,
    /// Of the ankle.
    pub ankle: usize,
}

/// A planar walker with two legs. The right leg stands in the step that is planned.
#[derive(Clone, Debug, PartialEq)]
pub struct Legs {
    /// Number of coordinates.
    pub coordinates: usize,
    /// Coordinate of the base's place along x.
    pub base_x: usize,
    /// Of its height.
    pub base_z: usize,
    /// Of the torso's lean.
    pub pitch: usize,
    /// The leg that stands.
    pub stance: Leg,
    /// The leg that swings.
    pub swing: Leg,
    /// The coordinate that each has the place of after the legs have swapped.
    pub mirror: Vec<usize>,
    /// Coordinates with a drive, in the order of the plant.
    pub driven: Vec<usize>,
    /// Contact point of each role.
    contacts: [usize; 4],
    /// Height of the ground \[m\].
    pub ground_m: f64,
    /// Mass \[kg\].
    pub mass_kg: f64,
    /// Acceleration of free fall [m/s^2].
    pub gravity: f64,
    /// From the hip to the sole of a straight leg \[m\].
    pub leg_m: f64,
}

/// The plant is no planar walker: there is no such part.
fn lacks(what: String) -> Error {
    DesignError::NoWalker(what).into()
}

fn joint(model: &PlantModel, name: &str) -> Result<usize, Error> {
    let found = model.joints.iter().position(|joint| joint.name == name);
    found.ok_or_else(|| lacks(format!("joint `{name}`")))
}

fn leg(model: &PlantModel, side: &str) -> Result<Leg, Error> {
    let part = |name: &str| joint(model, &format!("{side}_{name}"));
    Ok(Leg { hip: part("hip")?, knee: part("knee")?, ankle: part("ankle")? })
}

/// The name of the other leg's part.
fn mirrored(name: &str) -> String {
    match (name.strip_prefix("right_"), name.strip_prefix("left_")) {
        (Some(part), _) => format!("left_{part}"),
        (_, Some(part)) => format!("right_{part}"),
        _ => name.to_owned(),
    }
}

impl Legs {
    /// The legs of a plant, by the names of joints and contact points.
    pub fn of(plant: &mut dyn Plant) -> Result<Self, Error> {
        let model = plant.model().clone();
        if !model.planar {
            return Err(lacks("plane that it moves in".to_owned()));
        }
        let gravity = model
            .fall_onto_level_ground()
            .ok_or_else(|| lacks("gravity straight down onto level ground".to_owned()))?;
        let contact = |name: &str| {
            let found = model.contacts.iter().position(|contact| contact.name == name);
            found.ok_or_else(|| lacks(format!("contact point `{name}`")))
        };
        let names = model.joints.iter().map(|own| joint(&model, &mirrored(&own.name)));
        let mirror = names.collect::<Result<Vec<_>, _>>()?;
        let driven: Vec<usize> =
            (0..model.joints.len()).filter(|index| model.joints[*index].drivable).collect();
        let (stance, swing) = (leg(&model, "right")?, leg(&model, "left")?);
        let known = [stance.hip, stance.knee, stance.ankle, swing.hip, swing.knee, swing.ankle];
        if let Some(other) = driven.iter().find(|index| !known.contains(index)) {
            return Err(lacks(format!("place for the joint `{}`", model.joints[*other].name)));
        }
        let mut legs = Self {
            coordinates: model.joints.len(),
            base_x: joint(&model, "base_x")?,
            base_z: joint(&model, "base_z")?,
            pitch: joint(&model, "base_pitch")?,
            stance,
            swing,
            mirror,
            driven,
            contacts: [
                contact("right_heel")?,
                contact("right_toe")?,
                contact("left_heel")?,
                contact("left_toe")?,
            ],
            ground_m: model.ground.point[2],
            mass_kg: model.mass_kg,
            gravity,
            leg_m: 0.0,
        };
        let mut positions = vec![0.0; 3 * model.contacts.len()];
        plant.contact_positions(&vec![0.0; legs.coordinates], &mut positions);
        legs.leg_m = -positions[3 * legs.contact(Role::StanceHeel) + 2];
        if !(legs.leg_m > 0.0 && legs.mass_kg > 0.0) {
            return Err(lacks("weight on legs below a hip".to_owned()));
        }
        Ok(legs)
    }

    /// The contact point of a role while the right leg stands.
    pub fn contact(&self, role: Role) -> usize {
        self.contacts[role as usize]
    }

    /// A vector of coordinates after the legs have swapped.
    pub fn swap(&self, values: &[f64]) -> Vec<f64> {
        self.mirror.iter().map(|index| values[*index]).collect()
    }
}
