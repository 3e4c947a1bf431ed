//! A model read at run time, derived with its values folded in, and compiled in memory.

use super::laws::{LawMoment, LawResponse, Laws};
use super::model::baked;
use super::native::NativeRoutine;
use super::on_demand::OnDemand;
use super::{ContactDerivatives, Override, Plant, PlantModel, WalkingFunctions};
use crate::error::Error;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{Evaluate, Program, lower};

const FUNCTIONS: [FunctionName; 10] = [
    FunctionName::MassMatrix,
    FunctionName::Bias,
    FunctionName::LinkTransforms,
    FunctionName::ContactPositions,
    FunctionName::ContactJacobian,
    FunctionName::ContactBias,
    FunctionName::KineticEnergy,
    FunctionName::PotentialEnergy,
    FunctionName::CenterOfMass,
    FunctionName::Momentum,
];

/// A plant of any model file.
#[derive(Clone, Debug)]
pub struct LoadedPlant {
    model: PlantModel,
    /// In the order of `FUNCTIONS`; none where the robot has no contact point.
    evaluators: [Option<NativeRoutine>; FUNCTIONS.len()],
    /// Laws of added effects but for inertias, which the bias leaves out.
    laws: Option<Laws>,
    /// What few users call.
    on_demand: OnDemand,
}

impl LoadedPlant {
    /// Derives the functions of a robot, with values that replace the model's own.
    pub fn new(robot: &Robot, overrides: &[Override]) -> Result<Self, Error> {
        let mut robot = baked(robot, overrides)?;
        let model = PlantModel::of_baked(&robot);
        for link in robot.links.values_mut() {
            if let Some(drive) = &mut link.drive {
                // no function of the rate at rest: the simulation adds it
                drive.coulomb = None;
            }
        }
        let laws = Laws::take(&mut robot)?;
        let derivation = derive(&robot, Flavour::Baked, &FUNCTIONS)?;
        let program = lower(&derivation.dag, &derivation.functions)?;
        let evaluators = FUNCTIONS.map(|function| evaluator(&program, function));
        Ok(Self { model, evaluators, laws, on_demand: OnDemand::new(robot) })
    }

    fn call(&mut self, function: FunctionName, arguments: &[&[f64]], outputs: &mut [f64]) {
        let index = FUNCTIONS.iter().position(|known| *known == function);
        let evaluator = index.and_then(|index| self.evaluators[index].as_mut());
        match evaluator {
            Some(evaluator) => evaluator
                .evaluate(arguments, outputs)
                .expect("the caller's slices have the sizes of the plant"),
            None => assert!(outputs.is_empty(), "only functions of contacts can be missing"),
        }
    }
}

fn evaluator(program: &Program, function: FunctionName) -> Option<NativeRoutine> {
    let routine = program.find(function, None)?;
    // baked: there is nothing left that depends on parameters alone
    Some(NativeRoutine::new(routine, &[]))
}

impl Plant for LoadedPlant {
    fn model(&self) -> &PlantModel {
        &self.model
    }

    fn mass_matrix(&mut self, q: &[f64], mass: &mut [f64]) {
        self.call(FunctionName::MassMatrix, &[q], mass);
    }

    fn bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
        self.call(FunctionName::Bias, &[q, qd], bias);
    }

    fn contact_positions(&mut self, q: &[f64], positions: &mut [f64]) {
        self.call(FunctionName::ContactPositions, &[q], positions);
    }

    fn contact_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
        self.call(FunctionName::ContactJacobian, &[q], jacobian);
    }

    fn contact_bias(&mut self, q: &[f64], qd: &[f64], bias: &mut [f64]) {
        self.call(FunctionName::ContactBias, &[q, qd], bias);
    }

    fn center_of_mass_jacobian(&mut self, q: &[f64], jacobian: &mut [f64]) {
        let name = FunctionName::CenterOfMassJacobian;
        assert!(self.on_demand.call(name, None, &[q], &mut [jacobian]), "every robot has it");
    }

    fn walking(&mut self) -> Option<WalkingFunctions<'_>> {
        Some(WalkingFunctions::new(&self.model, &mut self.on_demand))
    }

    fn inverse_dynamics_derivatives(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        by_position: &mut [f64],
        by_velocity: &mut [f64],
    ) -> bool {
        let name = FunctionName::InverseDynamicsDerivatives;
        self.on_demand.call(name, None, &[q, qd, qdd], &mut [by_position, by_velocity])
    }

    fn contact_derivatives(
        &mut self,
        q: &[f64],
        qd: &[f64],
        qdd: &[f64],
        f: &[f64],
        derivatives: &mut ContactDerivatives,
    ) -> bool {
        let name = FunctionName::ContactDerivatives;
        if self.model.contacts.is_empty() {
            derivatives.torque_dq.fill(0.0);
            return true;
        }
        self.on_demand.call(name, None, &[q, qd, qdd, f], &mut derivatives.arrays())
    }

    fn law_states(&self) -> usize {
        self.laws.as_ref().map_or(0, |laws| laws.states)
    }

    fn has_accelerated_laws(&self) -> bool {
        self.laws.as_ref().is_some_and(Laws::is_accelerated)
    }

    fn law_start(&mut self, moment: &LawMoment<'_>) -> Vec<f64> {
        self.laws.as_mut().map_or_else(Vec::new, |laws| laws.start(moment))
    }

    fn laws(&mut self, moment: &LawMoment<'_>, response: &mut LawResponse) -> bool {
        match &mut self.laws {
            Some(laws) => laws.respond(moment, response),
            None => return false,
        }
        true
    }

    fn kinetic_energy(&mut self, q: &[f64], qd: &[f64]) -> f64 {
        let mut energy = [0.0];
        self.call(FunctionName::KineticEnergy, &[q, qd], &mut energy);
        energy[0]
    }

    fn potential_energy(&mut self, q: &[f64]) -> f64 {
        let mut energy = [0.0];
        self.call(FunctionName::PotentialEnergy, &[q], &mut energy);
        energy[0]
    }

    fn center_of_mass(&mut self, q: &[f64]) -> [f64; 3] {
        let mut position = [0.0; 3];
        self.call(FunctionName::CenterOfMass, &[q], &mut position);
        position
    }

    fn momentum(&mut self, q: &[f64], qd: &[f64]) -> [f64; 6] {
        let mut momentum = [0.0; 6];
        self.call(FunctionName::Momentum, &[q, qd], &mut momentum);
        momentum
    }

    fn link_transforms(&mut self, q: &[f64], transforms: &mut [f64]) {
        self.call(FunctionName::LinkTransforms, &[q], transforms);
    }
}
