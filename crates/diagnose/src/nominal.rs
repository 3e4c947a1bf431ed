//! What the model says, and how sure it is of it.
//!
//! Torques are linear in theta0 (docs/reference/base-parameters.md). The numbers of the model file
//! move theta0 each within its standard deviation; a unit of z moves one of them by one deviation,
//! so that z has the prior N(0, 1) in all its entries.

use super::data::SPRING_ZERO;
use super::elastic::Spring;
use super::floor::rms;
use super::signals::Signals;
use super::turning::PER_JOINT;
use crate::policy::nominal::{BODY, JOINT};
use denavit_codegen::model::JointEntry;
use denavit_measure::JointIndex;
use denavit_plants::regression::{ModelParameter, RegressionModel, StandardParameter};

/// A number of the model that may be off.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Uncertain {
    /// Its name in the model.
    pub(super) name: String,
    /// The value that the model gives.
    pub(super) value: f64,
    /// Its standard deviation.
    pub(super) std: f64,
    /// Whether it cannot be negative.
    pub(super) is_positive: bool,
}

/// The nominal model: phi of its values and the directions in which they may be off.
#[derive(Clone, Debug)]
pub struct Nominal<'a> {
    /// Base parameters and their columns.
    pub model: &'a RegressionModel,
    /// The numbers that may be off, one for each entry of z.
    pub(super) uncertain: Vec<Uncertain>,
    /// For each of them its place among the parameters of the regression.
    places: Vec<usize>,
    /// theta0 of the model's values.
    theta: Vec<f64>,
    /// What a unit of each entry of z adds to theta0.
    directions: Vec<Vec<f64>>,
    /// Springs whose balance is measured: an equation each, after those of the joints' torques.
    pub springs: Vec<Spring>,
    /// For each joint torque and rate (root of mean square) of the logs that it is asked about,
    /// which say how large errors of every model are: 0 where that is not known.
    pub(super) usual: Vec<[f64; 2]>,
}

/// What the torques are linear in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Phi {
    /// On the joint axes, as the model has it.
    pub axes: Vec<f64>,
    /// The same of rotors and friction alone, which move with the motor where a spring is between
    /// it and the joint.
    pub drives: Vec<f64>,
    /// The same of everything behind springs.
    pub loads: Vec<f64>,
    /// The stiffness of each spring.
    pub springs: Vec<f64>,
}

impl<'a> Nominal<'a> {
    /// The nominal model with the deviations that it states, or else usual ones.
    pub fn new(model: &'a RegressionModel) -> Self {
        let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
        let theta = model.standard_values(&values);
        let (mut uncertain, mut places, mut directions) = (Vec::new(), Vec::new(), Vec::new());
        for (place, parameter) in model.parameters.iter().enumerate() {
            let Some(std) = deviation(model, parameter) else { continue };
            // theta0 is a polynomial of the numbers: products of mass and distances.
            let at = |sign: f64| {
                let mut moved = values.clone();
                moved[place] += 0.5 * sign * std;
                model.standard_values(&moved)
            };
            let (above, below) = (at(1.0), at(-1.0));
            directions.push(above.iter().zip(&below).map(|(a, b)| a - b).collect());
            places.push(place);
            uncertain.push(Uncertain {
                name: parameter.name.clone(),
                value: parameter.value,
                std,
                is_positive: parameter.is_positive,
            });
        }
        Self {
            model,
            uncertain,
            places,
            theta,
            directions,
            springs: Vec::new(),
            usual: vec![[0.0; 2]; model.joints.len()],
        }
    }

    /// With springs whose balance is measured.
    pub fn with_springs(self, springs: &[Spring]) -> Self {
        Self { springs: springs.to_vec(), ..self }
    }

    /// Knowing the torques and rates of logs.
    pub(super) fn moving_as(mut self, logs: &[Signals]) -> Self {
        for (joint, usual) in self.usual.iter_mut().enumerate() {
            let torques = logs.iter().filter_map(|log| log.torque[joint].as_ref());
            let torques: Vec<f64> = torques.flatten().copied().collect();
            let rates = logs.iter().flat_map(|log| log.of_drive(JointIndex(joint))[0]);
            *usual = [rms(&torques), rms(rates)];
        }
        self
    }

    /// Whether a number of the model is of friction, or an offset.
    pub(super) fn is_friction(&self, name: &str) -> bool {
        let rotor = JointEntry::RotorInertia.prefix();
        let mut standard = self.model.standard.iter().filter(|one| one.name == name);
        standard.any(|one| {
            one.is_of_joint() && one.owner.as_ref().is_none_or(|(_, prefix)| *prefix != rotor)
        })
    }

    /// Number of equations: one for the torque of each joint, one for each spring.
    pub fn equations(&self) -> usize {
        self.model.joints.len() + self.springs.len()
    }

    /// The joint of an equation.
    pub fn joint_of(&self, equation: usize) -> JointIndex {
        let spring = equation.checked_sub(self.model.joints.len());
        spring.map_or(JointIndex(equation), |spring| self.springs[spring].joint)
    }

    /// The equation of the spring of a joint.
    pub fn spring_equation(&self, joint: JointIndex) -> Option<usize> {
        let place = self.springs.iter().position(|spring| spring.joint == joint)?;
        Some(self.model.joints.len() + place)
    }

    /// What an equation is of, in words: a joint, or the spring of one.
    pub fn equation_name(&self, equation: usize) -> String {
        let joint = &self.model.joints[self.joint_of(equation).0].name;
        match equation < self.model.joints.len() {
            true => joint.clone(),
            false => format!("spring of {joint}"),
        }
    }

    /// Why a motor that was measured does not say how its joint moves, in words.
    pub(super) fn lacks_stiffness(&self, joint: JointIndex) -> String {
        let joint = &self.model.joints[joint.0].name;
        format!("the model has no stiffness of the spring behind the motor of `{joint}`")
    }

    /// The place in z of the first entry of a spring: of its stiffness; its zero follows.
    pub(super) fn place_of_spring(&self, spring: usize) -> usize {
        self.len() + 1 + PER_JOINT * self.model.joints.len() + 2 * spring
    }

    /// What the motor of each spring reads more than its joint where the spring is relaxed, with z
    /// [rad, m].
    pub(super) fn zeros_of_springs(&self, z: &[f64]) -> Vec<f64> {
        let of = |place| z.get(self.place_of_spring(place) + 1).copied().unwrap_or(0.0);
        (0..self.springs.len()).map(|place| SPRING_ZERO * of(place)).collect()
    }

    /// Number of entries of z.
    pub fn len(&self) -> usize {
        self.uncertain.len()
    }

    /// Whether the model is certain of everything.
    pub fn is_empty(&self) -> bool {
        self.uncertain.is_empty()
    }

    /// theta0 of z.
    pub fn theta(&self, z: &[f64]) -> Vec<f64> {
        let mut theta = self.theta.clone();
        for (direction, factor) in self.directions.iter().zip(z) {
            for (sum, entry) in theta.iter_mut().zip(direction) {
                *sum += factor * entry;
            }
        }
        theta
    }

    /// The numbers of the model file with z, in the order of the regression's parameters.
    pub fn numbers(&self, z: &[f64]) -> Vec<f64> {
        let mut numbers = self.model.parameters.iter().map(|one| one.value).collect::<Vec<f64>>();
        for ((one, place), factor) in self.uncertain.iter().zip(&self.places).zip(z) {
            numbers[*place] += factor * one.std;
        }
        numbers
    }

    /// phi of z.
    pub fn phi(&self, z: &[f64]) -> Phi {
        let of = |(place, spring): (usize, &Spring)| {
            let own = z.get(self.place_of_spring(place)).copied().unwrap_or(0.0);
            spring.stiffness + own * spring.std
        };
        let springs = self.springs.iter().enumerate().map(of).collect();
        Phi { springs, ..self.phi_of(&self.theta(z)) }
    }

    fn phi_of(&self, theta: &[f64]) -> Phi {
        let own = |(value, standard): (&f64, &StandardParameter)| {
            if standard.is_of_joint() { *value } else { 0.0 }
        };
        let drives: Vec<f64> = theta.iter().zip(&self.model.standard).map(own).collect();
        let loads: Vec<f64> = theta.iter().zip(&drives).map(|(all, own)| all - own).collect();
        Phi {
            axes: self.model.axes_of_standard(theta),
            drives: self.model.axes_of_standard(&drives),
            loads: self.model.axes_of_standard(&loads),
            springs: vec![0.0; self.springs.len()],
        }
    }

    /// What a unit of each entry of z adds to phi.
    pub fn directions(&self) -> Vec<Phi> {
        self.directions.iter().map(|direction| self.phi_of(direction)).collect()
    }
}

/// The deviation of a number; none where it is certain: stated as 0, or 0 without a statement.
fn deviation(model: &RegressionModel, parameter: &ModelParameter) -> Option<f64> {
    let mut own = model.standard.iter().filter(|standard| standard.name == parameter.name);
    let is_of_joint = own.any(StandardParameter::is_of_joint);
    let share = if is_of_joint { JOINT } else { BODY };
    let std = parameter.std.unwrap_or(share * parameter.value.abs());
    Some(std).filter(|std| *std > 0.0)
}
