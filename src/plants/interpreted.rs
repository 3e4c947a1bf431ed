//! A model read at run time, derived with its values folded in, and interpreted.

use super::model::baked;
use super::{Override, Plant, PlantError, PlantModel};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::dynamics::implicit_effects;
use denavit_codegen::expr::{ExprId, UnaryFunction, substitute};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::model::{JointVariables, LinkId, Robot};
use denavit_codegen::number::ratio;
use denavit_codegen::program::{Evaluator, Program, lower};
use rustc_hash::FxHashMap;

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
pub struct InterpretedPlant {
    model: PlantModel,
    /// In the order of `FUNCTIONS`; none where the robot has no contact point.
    evaluators: [Option<Evaluator<f64>>; FUNCTIONS.len()],
    /// Torques of the laws of added effects, of q and qd; none if there are none.
    laws: Option<Evaluator<f64>>,
}

/// Below this rate a jump of a law at rate 0 is a steep line, as that of Coulomb friction is
/// [rad/s, m/s].
const STICTION_RATE: (i64, i64) = (1, 100);

impl InterpretedPlant {
    /// Derives the functions of a robot, with values that replace the model's own.
    pub fn new(robot: &Robot, overrides: &[Override]) -> Result<Self, PlantError> {
        let mut robot = baked(robot, overrides)?;
        let model = PlantModel::of_baked(&robot);
        for link in robot.links.values_mut() {
            if let Some(drive) = &mut link.drive {
                // no function of the rate at rest: the simulation adds it
                drive.coulomb = None;
            }
        }
        let laws = follow_laws(&mut robot)?;
        let derivation = derive(&robot, Flavour::Baked, &FUNCTIONS).map_err(PlantError::Bake)?;
        let program = lower(&derivation.dag, &derivation.functions).map_err(PlantError::Lower)?;
        let evaluators = FUNCTIONS.map(|function| evaluator(&program, function));
        Ok(Self { model, evaluators, laws })
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

/// Makes the laws of added effects such that a simulation can follow them, and gives their torques
/// without what is proportional to qdd.
fn follow_laws(robot: &mut Robot) -> Result<Option<Evaluator<f64>>, PlantError> {
    if robot.laws.is_empty() {
        return Ok(None);
    }
    let refuse = |effect: &str, what| Err(PlantError::Effect(effect.to_owned(), what));
    if let Some(effect) = implicit_effects(robot).first() {
        return refuse(effect, "the load or accelerations");
    }
    for law in &robot.laws {
        match (law.time, law.states.is_empty()) {
            (Some(_), _) => return refuse(&law.effect, "the time"),
            (None, false) => return refuse(&law.effect, "states of its own"),
            (None, true) => {}
        }
    }
    let variables: Vec<JointVariables> = robot.joints().map(|(_, symbols)| *symbols).collect();
    let rows: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
    let (numerator, denominator) = STICTION_RATE;
    let dag = &mut robot.dag;
    let slope = dag.constant(ratio(denominator, numerator));
    let mut smooth: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    let mut rest: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for joint in &variables {
        let steep = dag.mul(slope, joint.qd);
        let tanh = dag.unary(UnaryFunction::Tanh, steep);
        smooth.insert(dag.unary(UnaryFunction::Sign, joint.qd), tanh);
        rest.insert(joint.qdd, dag.zero());
    }
    let mut torques = vec![dag.zero(); variables.len()];
    for law in &mut robot.laws {
        law.torque = substitute(dag, &[law.torque], &smooth)[0];
        let torque = substitute(dag, &[law.torque], &rest)[0];
        let row = rows.iter().position(|link| *link == law.joint);
        let row = row.expect("a law acts on a joint that moves");
        torques[row] = dag.add(torques[row], torque);
    }
    let argument = |name, symbol: fn(&JointVariables) -> ExprId| Argument {
        name,
        symbols: variables.iter().map(symbol).collect(),
    };
    let function = Function {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![argument("q", |joint| joint.q), argument("qd", |joint| joint.qd)],
        outputs: vec![Output {
            name: "tau",
            shape: vec![torques.len()],
            entries: torques,
            doc: String::new(),
            details: Vec::new(),
        }],
        form: Form::Plain,
    };
    let program = lower(dag, &[function]).map_err(PlantError::Lower)?;
    Ok(Some(Evaluator::new(&program.routines[0], &[])))
}

fn evaluator(program: &Program, function: FunctionName) -> Option<Evaluator<f64>> {
    let routine = program.find(function, None)?;
    // baked: there is nothing left that depends on parameters alone
    Some(Evaluator::new(routine, &[]))
}

impl Plant for InterpretedPlant {
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

    fn law_power(&mut self, q: &[f64], qd: &[f64]) -> f64 {
        let Some(laws) = &mut self.laws else { return 0.0 };
        let mut torque = vec![0.0; q.len()];
        laws.evaluate(&[q, qd], &mut torque).expect("the caller's slices have its sizes");
        torque.iter().zip(qd).map(|(torque, rate)| torque * rate).sum()
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
