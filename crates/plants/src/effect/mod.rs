//! Effects as numbers: what a law adds to the torque of its joint, and its derivatives by the
//! parameters, over many samples at once.
//!
//! - [`EffectLaw`]: laws of one joint, with their states integrated along the samples
//! - [`RobotEffect`]: effects that change the model, and with it the torques of all joints
//! - [`apart()`]: the effects that a model has, in its equations and beside them
//! - [`logged`](EffectLaw::logged), [`corrected`](EffectLaw::corrected): laws of a logged channel
//!
//! Samples are columns; columns that a law does not use may be empty.

mod added;
mod affine;
mod ahead;
mod behind;
mod channel;
mod program;
mod robot;
mod states;
mod transmission;

pub use added::{AddedLaw, ApartEffects, apart};
pub use ahead::Passing;
pub use robot::{AddedTorques, Moves, RobotEffect};
pub use transmission::{Drive, GivesWay, Transmitted};

use crate::error::{Cause, Error};
use denavit_codegen::effect::{
    COLUMNS, Channel, Effect, EffectParameter, EffectSite, Law, SpringSide,
};
use denavit_codegen::expr::{Dag, ExprId, derivative, free_symbols};
use denavit_codegen::model::JointKind;
use denavit_codegen::number::to_f64;
use program::LawProgram;
use rustc_hash::FxHashMap;
use states::StateLaw;

/// A parameter of a law, for a joint of one kind.
#[derive(Clone, Debug, PartialEq)]
pub struct LawParameter {
    /// The name.
    pub name: String,
    /// Its SI unit.
    pub unit: String,
    /// The value that switches the effect off; none for those that only shape it.
    pub nominal: Option<f64>,
    /// Lowest and highest value; infinite where there is no end.
    pub bounds: [f64; 2],
    /// Values to start a search from.
    pub start: Vec<f64>,
    /// Whether the law is linear in it, jointly with the other linear ones.
    pub linear: bool,
}

impl LawParameter {
    fn new(parameter: &EffectParameter, joint: JointKind) -> Self {
        let end = |end: usize, open: f64| parameter.bounds[end].as_ref().map_or(open, to_f64);
        Self {
            name: parameter.name.clone(),
            unit: parameter.unit.of(joint).text().to_owned(),
            nominal: parameter.nominal.as_ref().map(to_f64),
            bounds: [end(0, f64::NEG_INFINITY), end(1, f64::INFINITY)],
            start: parameter.start.iter().map(to_f64).collect(),
            linear: parameter.linear,
        }
    }

    /// What a value is moved by for a difference: a share of its size, or of its least start where
    /// it is 0; back from its upper bound.
    pub fn step(&self, value: f64, share: f64) -> f64 {
        let starts = self.start.iter().map(|start| start.abs()).filter(|start| *start > 0.0);
        let size = if value > 0.0 { value } else { starts.fold(f64::INFINITY, f64::min) };
        let step = if size.is_finite() { share * size } else { share };
        if value + step > self.bounds[1] { -step } else { step }
    }
}

/// Samples of one joint, and of the other joint of a pair. All columns that a law uses have the
/// same length; the others may be empty.
#[derive(Clone, Copy, Debug, Default)]
pub struct JointSamples<'a> {
    /// Time \[s\].
    pub t: &'a [f64],
    /// Position [rad, m].
    pub q: &'a [f64],
    /// Rate [rad/s, m/s].
    pub qd: &'a [f64],
    /// Rate for laws of sticking: of a drive that creeps where a log shows it at rest, and that of
    /// the joint elsewhere [rad/s, m/s].
    pub creep: &'a [f64],
    /// Acceleration [rad/s^2, m/s^2].
    pub qdd: &'a [f64],
    /// Rigid-body torque without friction [N m, N].
    pub tau_load: &'a [f64],
    /// Its derivative with respect to time [N m/s, N/s].
    pub tau_load_rate: &'a [f64],
    /// The whole torque of the joint, for laws of what is logged [N m, N].
    pub tau: &'a [f64],
    /// Position of the other joint.
    pub q_2: &'a [f64],
    /// Rate of the other joint.
    pub qd_2: &'a [f64],
    /// Acceleration of the other joint.
    pub qdd_2: &'a [f64],
    /// Rigid-body torque of the other joint.
    pub tau_load_2: &'a [f64],
    /// Its derivative with respect to time.
    pub tau_load_rate_2: &'a [f64],
    /// Numbers of the drive, for laws of what is between it and the joint.
    pub drive: Drive,
}

impl<'a> JointSamples<'a> {
    fn column(&self, column: usize) -> &'a [f64] {
        [
            self.t,
            self.q,
            self.qd,
            self.creep,
            self.qdd,
            self.tau_load,
            self.tau_load_rate,
            self.tau,
            self.q_2,
            self.qd_2,
            self.qdd_2,
            self.tau_load_2,
            self.tau_load_rate_2,
        ][column]
    }

    /// Number of samples: of the longest column.
    pub fn len(&self) -> usize {
        (0..COLUMNS.len()).map(|column| self.column(column).len()).max().unwrap_or(0)
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// The law of an effect on a joint of one kind.
#[derive(Clone, Debug)]
pub struct EffectLaw {
    /// The effect's name.
    pub name: String,
    /// Where it acts.
    pub at: EffectSite,
    /// On which side of a series spring, if it is a law of a joint.
    pub side: SpringSide,
    /// Its parameters, in the order of the values that the functions take.
    pub parameters: Vec<LawParameter>,
    /// The columns that the law uses.
    columns: Vec<usize>,
    /// Value and derivatives by parameters, then by states: functions of columns and states.
    program: LawProgram,
    states: Option<StateLaw>,
    channel: Option<channel::ChannelLaw>,
    /// What the second joint of a pair feels.
    on_second: Option<Box<EffectLaw>>,
}

impl EffectLaw {
    /// The law of `effect` on a joint of this kind.
    pub fn new(effect: &Effect, joint: JointKind) -> Result<Self, Error> {
        let mut law = Self::of_first(effect, joint)?;
        if let Some(second) = effect.on_second() {
            law.on_second = Some(Box::new(Self::of_first(&second, joint)?));
        }
        Ok(law)
    }

    /// The law of the second joint of a pair, with the same parameters; its samples have that joint
    /// first. None where the first one alone feels the effect.
    pub fn on_second(&self) -> Option<&Self> {
        self.on_second.as_deref()
    }

    fn of_first(effect: &Effect, joint: JointKind) -> Result<Self, Error> {
        let mut dag = effect.dag.clone();
        let (value, timing) = match &effect.law {
            Law::Torque(torque) => (*torque, None),
            Law::Measured(measured) => (measured.value, Some(measured)),
            Law::Moves(_) | Law::Term(_) => {
                return Err(Cause::WholeRobot(effect.name.clone()).into());
            }
        };
        let parameters: Vec<ExprId> = effect.parameters.iter().map(|p| p.symbol).collect();
        let states: Vec<ExprId> = effect.states.iter().map(|state| state.symbol).collect();
        let by: Vec<ExprId> = parameters.iter().chain(&states).copied().collect();
        let mut entries = vec![value];
        entries.extend(gradient(&mut dag, &[value], &by).concat());
        let mut used = entries.clone();
        used.extend(effect.states.iter().flat_map(|state| [state.rate, state.initial]));
        let columns = columns(&dag, &used);
        let inputs = inputs(&mut dag, &columns, &states);
        let program = LawProgram::new(&dag, &names(effect), inputs.clone(), entries)?;
        let state_law =
            if states.is_empty() { None } else { Some(StateLaw::new(&mut dag, effect, inputs)?) };
        let channel = match timing {
            Some(measured) => Some(channel::ChannelLaw::new(&mut dag, effect, measured)?),
            None => None,
        };
        Ok(Self {
            name: effect.name.clone(),
            at: effect.at,
            side: effect.side,
            parameters: effect.parameters.iter().map(|p| LawParameter::new(p, joint)).collect(),
            columns,
            program,
            states: state_law,
            channel,
            on_second: None,
        })
    }

    /// The channel that the effect changes, if it is one of what is logged.
    pub fn channel(&self) -> Option<Channel> {
        self.channel.as_ref().map(|law| law.channel)
    }

    /// Whether the law gives the truth for what is logged: torques of samples are then those that
    /// are logged.
    pub fn is_inverse(&self) -> bool {
        self.channel.as_ref().is_some_and(|law| law.is_inverse)
    }

    /// Whether a position is read before something that gives way: it is that of the drive.
    pub fn is_read_at_drive(&self) -> bool {
        let uses_load = self.columns.iter().any(|&column| COLUMNS[column] == "tau_load");
        self.channel() == Some(Channel::Position) && (uses_load || self.is_transmission())
    }

    /// Whether the law is made of accelerations, or moves a logged torque in time or multiplies it
    /// by a constant, which answers them. Where the factor changes with position, their noise has
    /// another frequency there than in the residual.
    pub fn follows_accelerations(&self) -> bool {
        let answers = ["qdd", "qdd_2", "tau_load_rate", "tau_load_rate_2"];
        let uses = self.columns.iter().any(|&column| answers.contains(&COLUMNS[column]));
        uses || self.is_timing() || self.is_gain()
    }

    /// Whether the law is of motion alone, and of no torque.
    pub fn is_of_motion(&self) -> bool {
        let is_torque = |column: &usize| COLUMNS[*column].starts_with("tau");
        self.channel.is_none() && !self.columns.iter().any(is_torque)
    }

    /// What the effect adds to the torque that is logged of its joint [N m, N], sample by sample:
    /// 0 for an effect on another channel.
    pub fn torque(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<f64> {
        match self.channel() {
            None => self.value(samples, values).swap_remove(0),
            Some(Channel::Torque) if self.is_inverse() => {
                let truth = self.corrected(samples, values);
                samples.tau.iter().zip(truth).map(|(logged, truth)| logged - truth).collect()
            }
            Some(Channel::Torque) => {
                let logged = self.logged(samples, values);
                logged.iter().zip(samples.tau).map(|(logged, tau)| logged - tau).collect()
            }
            Some(_) => vec![0.0; samples.len()],
        }
    }

    /// The derivative of [`torque`](Self::torque) by each parameter: one column for each.
    pub fn gradient(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<Vec<f64>> {
        match self.channel() {
            None => self.value(samples, values).split_off(1),
            Some(Channel::Torque) if self.is_transmission() => {
                let nothing = || vec![vec![0.0; samples.len()]; values.len()];
                let gradient = |through| self.through_gradient(samples, values, &through);
                self.through(samples, values).map_or_else(nothing, gradient)
            }
            Some(Channel::Torque) if self.is_inverse() => {
                let mut columns = self.given_gradient(samples, values);
                columns.iter_mut().flatten().for_each(|entry| *entry = -*entry);
                columns
            }
            Some(Channel::Torque) => self.given_gradient(samples, values),
            Some(_) => vec![vec![0.0; samples.len()]; self.parameters.len()],
        }
    }

    /// Both, which costs no more than one of them where the effect is on no channel.
    pub fn torque_and_gradient(
        &self,
        samples: &JointSamples<'_>,
        values: &[f64],
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        if self.channel().is_some() {
            return (self.torque(samples, values), self.gradient(samples, values));
        }
        let mut columns = self.value(samples, values);
        (columns.remove(0), columns)
    }

    /// The states that the samples lead to: one column for each.
    pub fn states(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<Vec<f64>> {
        let columns: Vec<&[f64]> = self.columns.iter().map(|&at| samples.column(at)).collect();
        let states = self.states.as_ref();
        states.map_or_else(Vec::new, |law| law.integrate(samples.t, &columns, values).0)
    }

    /// Value and derivatives by parameters, along the states that the samples lead to.
    fn value(&self, samples: &JointSamples<'_>, values: &[f64]) -> Vec<Vec<f64>> {
        let count = self.parameters.len();
        let columns: Vec<&[f64]> = self.columns.iter().map(|&at| samples.column(at)).collect();
        let mut path = Vec::new();
        let mut sensitivities = Vec::new();
        if let Some(law) = &self.states {
            let t = samples.t;
            (path, sensitivities) = law.integrate(t, &columns, values);
        }
        let mut inputs = columns;
        inputs.extend(path.iter().map(Vec::as_slice));
        let mut outputs = self.program.run(&inputs, values, samples.len());
        // by parameters also through the states
        let by_states = outputs.split_off(1 + count);
        for (state, slope) in by_states.iter().enumerate() {
            for (parameter, column) in outputs[1..].iter_mut().enumerate() {
                let moved: &[f64] = &sensitivities[state * count + parameter];
                for ((sum, slope), moved) in column.iter_mut().zip(slope).zip(moved) {
                    *sum += slope * moved;
                }
            }
        }
        outputs
    }
}

/// The names of an effect's parameters.
fn names(effect: &Effect) -> Vec<String> {
    effect.parameters.iter().map(|parameter| parameter.name.clone()).collect()
}

/// The derivatives of expressions by symbols: for each expression, in the order of the symbols.
fn gradient(dag: &mut Dag, exprs: &[ExprId], by: &[ExprId]) -> Vec<Vec<ExprId>> {
    let columns: Vec<Vec<ExprId>> = by
        .iter()
        .map(|&symbol| {
            let seeds: FxHashMap<ExprId, ExprId> = [(symbol, dag.one())].into_iter().collect();
            derivative(dag, exprs, &seeds)
        })
        .collect();
    (0..exprs.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect()
}

/// The columns that expressions use.
fn columns(dag: &Dag, exprs: &[ExprId]) -> Vec<usize> {
    let symbols = free_symbols(dag, exprs);
    let names: Vec<&str> = symbols.iter().map(|&id| dag.symbols()[id].name.as_str()).collect();
    (0..COLUMNS.len()).filter(|&column| names.contains(&COLUMNS[column])).collect()
}

/// The symbols of columns, then those of states.
fn inputs(dag: &mut Dag, columns: &[usize], states: &[ExprId]) -> Vec<ExprId> {
    let mut inputs = Vec::with_capacity(columns.len() + states.len());
    for &column in columns {
        let id = dag.find_symbol(COLUMNS[column]).expect("a column is a symbol that is used");
        inputs.push(dag.symbol_expr(id));
    }
    inputs.extend(states);
    inputs
}
