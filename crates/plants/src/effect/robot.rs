//! Effects that change the model of a robot: the difference of inverse dynamics with and without.

use super::program::LawProgram;
use super::{LawParameter, gradient};
use crate::error::{Cause, Error};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::effect::{Effect, Law, ModelTerm, Property, attach, with_term};
use denavit_codegen::expr::{Dag, ExprId, SymbolClass, substitute};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{
    AddedEffect, EffectPlace, JointKind, LinkId, Robot, Terms, bake_where,
};
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
    /// What it moves: gravity along three axes, then the zero of each joint; none for a term.
    moved: Option<LawProgram>,
    /// Its place among those that move something.
    order: Order,
    follows_accelerations: bool,
    /// How many numbers of the model it depends on.
    numbers: usize,
}

/// What moves the model is added in this order, each beside those before it: what turns gravity,
/// what moves the zero of a joint, joint by joint, and all others.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Order {
    Gravity,
    Zero(usize),
    Other,
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
        for (gravity, name) in rigid.gravity.iter_mut().zip(GRAVITY_BESIDE) {
            let more = rigid.dag.symbol(name, SymbolClass::Geometry);
            *gravity = rigid.dag.add(*gravity, more);
        }
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
                let mut moved = Robot { effects: vec![added], ..rigid.clone() };
                attach(&mut moved, effect, 0).map_err(Cause::Place)?;
                Self::of_moved(effect, [&moved, &rigid], at, numbers)
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
        let program = LawProgram::new(&dag, &with_gravity(numbers), first.inputs, entries)?;
        Ok(Self {
            name: effect.name.clone(),
            parameters: Vec::new(),
            joints,
            program,
            moved: None,
            order: Order::Other,
            follows_accelerations: is_of_accelerations(&effect.law),
            numbers: numbers.len(),
        })
    }

    fn of_moved(
        effect: &Effect,
        [moved, rigid]: [&Robot; 2],
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
        names.extend(with_gravity(numbers));
        let program = LawProgram::new(&dag, &names, inputs, all)?;
        let moves = moves(&mut dag, [moved, rigid]);
        let order = match moves.iter().position(|&by| by != dag.zero()) {
            Some(0..3) => Order::Gravity,
            Some(place) => Order::Zero(place - 3),
            None => Order::Other,
        };
        let moves = LawProgram::new(&dag, &names, Vec::new(), moves)?;
        let joint = match at {
            EffectPlace::Link(link) => moved.links[link].joint.kind,
            _ => JointKind::Revolute,
        };
        Ok(Self {
            name: effect.name.clone(),
            parameters: effect.parameters.iter().map(|p| LawParameter::new(p, joint)).collect(),
            joints,
            program,
            moved: Some(moves),
            order,
            follows_accelerations: is_of_accelerations(&effect.law),
            numbers: numbers.len(),
        })
    }

    /// Whether what the effect adds is made of accelerations.
    pub fn follows_accelerations(&self) -> bool {
        self.follows_accelerations
    }

    /// Whether what the effect adds is a function of the motion alone: of no number of the model.
    pub fn is_of_motion(&self) -> bool {
        self.numbers == 0
    }

    /// Whether the effect turns gravity or a joint, and with it what bodies do.
    pub fn turns_numbers(&self) -> bool {
        self.order != Order::Other
    }

    /// What the effect moves that other effects depend on; `numbers` are the values of the numbers
    /// of the model that were named.
    pub fn moves(&self, values: &[f64], numbers: &[f64]) -> Moves {
        let Some(program) = &self.moved else { return Moves::none(self.joints) };
        let all = [values, &numbers[..self.numbers], &[0.0; 3]].concat();
        let all: Vec<f64> = program.run(&[], &all, 1).iter().map(|one| one[0]).collect();
        Moves { gravity: [all[0], all[1], all[2]], zeros: all[3..].to_vec() }
    }

    fn before(&self, all: &Moves) -> Moves {
        let before = |order, by: f64| if order < self.order { by } else { 0.0 };
        let zeros = all.zeros.iter().enumerate();
        Moves {
            gravity: all.gravity.map(|by| before(Order::Gravity, by)),
            zeros: zeros.map(|(joint, by)| before(Order::Zero(joint), *by)).collect(),
        }
    }

    /// What the effect adds to the torques, and the derivative by each parameter. `q`, `qd` and
    /// `qdd` have one column of samples for each joint; `numbers` are the values of the numbers of
    /// the model that were named. Of what moves gravity and zeros it is added beside what comes
    /// before it: gravity, zeros of joints in their order, then all others, so that effects add up
    /// to what they do together.
    pub fn torques(
        &self,
        [q, qd, qdd]: [&[&[f64]]; 3],
        values: &[f64],
        numbers: &[f64],
        beside: &Moves,
    ) -> AddedTorques {
        let beside = self.before(beside);
        let turn = |(q, zero): (&&[f64], &f64)| q.iter().map(|q| q + zero).collect();
        let turned: Vec<Vec<f64>> = match beside.zeros.iter().all(|zero| *zero == 0.0) {
            true => Vec::new(),
            false => q.iter().zip(&beside.zeros).map(turn).collect(),
        };
        let turned: Vec<&[f64]> = turned.iter().map(Vec::as_slice).collect();
        let stand = if turned.is_empty() { q } else { &turned };
        let inputs: Vec<&[f64]> = [stand, qd, qdd].concat();
        let samples = q.first().map_or(0, |column| column.len());
        let values = [values, &numbers[..self.numbers], &beside.gravity].concat();
        let mut torque = self.program.run(&inputs, &values, samples);
        let slopes = torque.split_off(self.joints);
        let gradient = slopes.chunks_exact(self.joints).map(<[Vec<f64>]>::to_vec).collect();
        AddedTorques { torque, gradient }
    }
}

/// What effects move that other effects depend on.
#[derive(Clone, Debug, PartialEq)]
pub struct Moves {
    /// Acceleration of free fall in frame 0, along its axes \[m/s^2\].
    pub gravity: [f64; 3],
    /// For each joint by how much it stands further than it reads [rad, m].
    pub zeros: Vec<f64>,
}

impl Moves {
    /// Nothing.
    pub fn none(joints: usize) -> Self {
        Self { gravity: [0.0; 3], zeros: vec![0.0; joints] }
    }
}

/// Acceleration of free fall that other effects add along each axis. No file can name these
/// symbols: they are no identifiers.
const GRAVITY_BESIDE: [&str; 3] =
    ["x of gravity beside", "y of gravity beside", "z of gravity beside"];

fn with_gravity(numbers: &[String]) -> Vec<String> {
    numbers.iter().cloned().chain(GRAVITY_BESIDE.map(str::to_owned)).collect()
}

/// By how much a robot that is moved has another gravity, and other zeros of its joints.
fn moves(dag: &mut Dag, [moved, rigid]: [&Robot; 2]) -> Vec<ExprId> {
    let zero = |robot: &Robot, link: LinkId| {
        let joint = &robot.links[link].joint;
        if joint.kind == JointKind::Prismatic { joint.d } else { joint.theta }
    };
    let gravity = moved.gravity.into_iter().zip(rigid.gravity);
    let zeros = rigid.joints().map(|(link, _)| (zero(moved, link), zero(rigid, link)));
    gravity.chain(zeros).map(|(a, b)| dag.sub(a, b)).collect()
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
    dag: Dag,
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
