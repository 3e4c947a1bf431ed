//! Effects that change the model of a robot: the difference of inverse dynamics with and without.

use super::program::LawProgram;
use super::{LawParameter, gradient};
use crate::error::{Cause, Error};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::effect::{Effect, Law, ModelTerm, Property, attach, with_term};
use denavit_codegen::expr::{ExprId, substitute};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{AddedEffect, EffectPlace, JointKind, Robot, Terms, bake_where};
use rustc_hash::FxHashMap;

/// What an effect at one place adds to the torques of all joints of a robot.
#[derive(Clone, Debug)]
pub struct RobotEffect {
    /// The effect's name.
    pub name: String,
    /// Its parameters, in the order of the values that the functions take; none for a term, whose
    /// coefficient is 1.
    pub parameters: Vec<LawParameter>,
    joints: usize,
    /// Torques, then their derivatives: for each parameter one row for each joint.
    program: LawProgram,
    follows_accelerations: bool,
    is_of_motion: bool,
}

/// Whether what a law adds is made of accelerations.
fn is_of_accelerations(law: &Law) -> bool {
    match law {
        Law::Term(term) => matches!(term, ModelTerm::Rotor),
        Law::Moves(moves) => {
            moves.iter().any(|(property, _)| !matches!(property, Property::Gravity(_)))
        }
        Law::Torque(_) | Law::Measured(_) => false,
    }
}

/// Whether what a law adds depends on numbers of the model: what turns or leaves out what is there
/// does, what adds a body does not.
fn is_of_numbers(law: &Law) -> bool {
    let turns = |property: &Property| matches!(property, Property::Zero | Property::Gravity(_));
    match law {
        Law::Term(_) => true,
        Law::Moves(moves) => moves.iter().any(|(property, _)| turns(property)),
        Law::Torque(_) | Law::Measured(_) => false,
    }
}

impl RobotEffect {
    /// The effect on a robot with the values of its model, but for parameters of the names in
    /// `numbers`, whose values are asked for each time. A term is taken as left out of the
    /// model, whether the model has it or not. Friction, rotors and effects that the robot has
    /// already are no part of the difference.
    pub fn new(
        robot: &Robot,
        effect: &Effect,
        at: EffectPlace,
        numbers: &[String],
    ) -> Result<Self, Error> {
        let numbers = if is_of_numbers(&effect.law) { numbers } else { &[] };
        let mut rigid = bake_where(robot, |parameter| !numbers.contains(&parameter.name))?;
        rigid.laws.clear();
        rigid.terms = Terms { friction: false, rotor: false, ..rigid.terms };
        match effect.law {
            Law::Term(term) => {
                let with = Robot { terms: with_term(rigid.terms, term, true), ..rigid.clone() };
                rigid.terms = with_term(rigid.terms, term, false);
                Self::of_term(effect, [&with, &rigid], numbers)
            }
            Law::Moves(_) => {
                let added = AddedEffect {
                    effect: effect.name.clone(),
                    at,
                    side: None,
                    parameters: Vec::new(),
                    place: 0,
                };
                rigid.effects = vec![added];
                attach(&mut rigid, effect, 0).map_err(Cause::Place)?;
                Self::of_moved(effect, &rigid, at, numbers)
            }
            Law::Torque(_) | Law::Measured(_) => Err(Cause::OneJoint(effect.name.clone()).into()),
        }
    }

    fn of_term(
        effect: &Effect,
        [with, without]: [&Robot; 2],
        numbers: &[String],
    ) -> Result<Self, Error> {
        // both from one graph: what they share is computed once
        let first = derived(with)?;
        let second = derived(&Robot { dag: first.dag.clone(), ..without.clone() })?;
        let mut dag = second.dag;
        let entries: Vec<ExprId> =
            first.entries.iter().zip(&second.entries).map(|(&a, &b)| dag.sub(a, b)).collect();
        let joints = entries.len();
        let program = LawProgram::new(&dag, numbers, first.inputs, entries)?;
        let follows_accelerations = is_of_accelerations(&effect.law);
        let (name, parameters) = (effect.name.clone(), Vec::new());
        let is_of_motion = numbers.is_empty();
        Ok(Self { name, parameters, joints, program, follows_accelerations, is_of_motion })
    }

    fn of_moved(
        effect: &Effect,
        moved: &Robot,
        at: EffectPlace,
        numbers: &[String],
    ) -> Result<Self, Error> {
        let Derived { mut dag, entries, inputs } = derived(moved)?;
        // the effect's own parameters were added last
        let count = effect.parameters.len();
        let own = moved.parameters.values().skip(moved.parameters.len() - count);
        let (symbols, mut names): (Vec<ExprId>, Vec<String>) =
            own.map(|parameter| (parameter.symbol, parameter.name.clone())).unzip();
        let mut nominal: FxHashMap<ExprId, ExprId> = FxHashMap::default();
        for (parameter, &symbol) in effect.parameters.iter().zip(&symbols) {
            if let Some(value) = &parameter.nominal {
                nominal.insert(symbol, dag.constant(value.clone()));
            }
        }
        let without = substitute(&mut dag, &entries, &nominal);
        let added: Vec<ExprId> =
            entries.iter().zip(&without).map(|(&a, &b)| dag.sub(a, b)).collect();
        let joints = added.len();
        let slopes = gradient(&mut dag, &added, &symbols);
        let mut all = added;
        for parameter in 0..count {
            all.extend(slopes.iter().map(|row| row[parameter]));
        }
        names.extend_from_slice(numbers);
        let program = LawProgram::new(&dag, &names, inputs, all)?;
        let joint = match at {
            EffectPlace::Link(link) => moved.links[link].joint.kind,
            _ => JointKind::Revolute,
        };
        let parameters = effect.parameters.iter().map(|p| LawParameter::new(p, joint)).collect();
        let follows_accelerations = is_of_accelerations(&effect.law);
        let name = effect.name.clone();
        let is_of_motion = numbers.is_empty();
        Ok(Self { name, parameters, joints, program, follows_accelerations, is_of_motion })
    }

    /// Whether what the effect adds is made of accelerations.
    pub fn follows_accelerations(&self) -> bool {
        self.follows_accelerations
    }

    /// Whether what the effect adds is a function of the motion alone: of no number of the model.
    pub fn is_of_motion(&self) -> bool {
        self.is_of_motion
    }

    /// What the effect adds to the torques, and the derivative by each parameter. `q`, `qd` and
    /// `qdd` have one column of samples for each joint; `numbers` are the values of the numbers of
    /// the model that were named.
    pub fn torques(
        &self,
        [q, qd, qdd]: [&[&[f64]]; 3],
        values: &[f64],
        numbers: &[f64],
    ) -> AddedTorques {
        let inputs: Vec<&[f64]> = [q, qd, qdd].concat();
        let samples = q.first().map_or(0, |column| column.len());
        let mut torque = self.program.run(&inputs, &[values, numbers].concat(), samples);
        let slopes = torque.split_off(self.joints);
        let gradient = slopes.chunks_exact(self.joints).map(<[Vec<f64>]>::to_vec).collect();
        AddedTorques { torque, gradient }
    }
}

/// What an effect adds to the torques of all joints.
#[derive(Clone, Debug, PartialEq)]
pub struct AddedTorques {
    /// For each joint one column of samples [N m, N].
    pub torque: Vec<Vec<f64>>,
    /// For each parameter and joint the derivative.
    pub gradient: Vec<Vec<Vec<f64>>>,
}

/// Inverse dynamics of a robot.
struct Derived {
    dag: denavit_codegen::expr::Dag,
    entries: Vec<ExprId>,
    inputs: Vec<ExprId>,
}

fn derived(robot: &Robot) -> Result<Derived, Error> {
    let derivation = derive(robot, Flavour::Tunable, &[FunctionName::InverseDynamics])?;
    let function = &derivation.functions[0];
    let arguments = function.arguments.iter();
    let inputs = arguments.flat_map(|argument| argument.symbols.clone()).collect();
    Ok(Derived { entries: function.entries(), inputs, dag: derivation.dag })
}
