//! Exact aliases: effects that do nothing that the model's own parameters could not do, whatever
//! the motion.
//!
//! The signature of an effect, the derivative of the torques by its parameters where it vanishes,
//! is symbolic. Appended as columns to the symbolic regressor it leaves the rank as it is, or does
//! not: decided modulo 2^61 - 1 at random points, where no number is rounded. What is independent
//! there is independent; what is dependent there is so but for a chance below 1e-12.

use crate::derive::{Flavour, derive};
use crate::effect::{Channel, Effect, Law, attach, with_term};
use crate::expr::{Dag, ExprId, derivative, substitute};
use crate::function::FunctionName;
use crate::model::{AddedEffect, EffectPlace, Robot, Terms, TorqueSide, bake_geometry};
use crate::number::Residue;
use crate::regressor::functions::modelled;
use crate::regressor::{Regressor, rank};
use rustc_hash::FxHashMap;

/// An effect in a place, by name: `stribeck` at `knee`, `knee with ankle` or `model`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Named<'a> {
    /// The effect.
    pub effect: &'a str,
    /// Its place.
    pub at: &'a str,
}

/// The symbolic regressor of a model, to which signatures of effects are appended.
#[derive(Clone, Debug)]
pub struct ExactAliases<'a> {
    robot: Robot,
    effects: &'a [Effect],
    regressor: Regressor,
}

/// The columns of an effect: for each of its parameters the torque of each joint.
struct Signature {
    dag: Dag,
    columns: Vec<Vec<ExprId>>,
}

impl<'a> ExactAliases<'a> {
    /// The regressor of a robot with the values of its constants, exactly; none if it has none.
    pub fn new(robot: &Robot, effects: &'a [Effect]) -> Option<Self> {
        let robot = bake_geometry(robot).ok()?;
        let regressor = Regressor::new(&robot, modelled(&robot), TorqueSide::Joint).ok()?;
        if regressor.columns.is_empty() {
            return None;
        }
        Some(Self { robot, effects, regressor })
    }

    /// The parameters of the model that do together all that an effect does; empty if they do not,
    /// or if that cannot be said: of delays and of laws with states.
    pub fn of_parameters(&self, one: Named<'_>) -> Vec<String> {
        let dag = self.regressor.dag.clone();
        let signature = self.signature(dag, one);
        signature
            .and_then(|own| self.within(one.at, own.dag, &[], &own.columns))
            .unwrap_or_default()
    }

    /// Whether two effects do the same, but for what the model's own parameters could do.
    pub fn are_alike(&self, one: Named<'_>, other: Named<'_>) -> bool {
        let of = || {
            let first = self.signature(self.regressor.dag.clone(), one)?;
            let second = self.signature(first.dag, other)?;
            let [a, b] = [&first.columns, &second.columns];
            let forth = self.within(one.at, second.dag.clone(), a, b)?;
            let back = self.within(one.at, second.dag, b, a)?;
            Some(!(forth.is_empty() || back.is_empty()))
        };
        of().unwrap_or(false)
    }

    /// The names of the columns that make up `asked`, if those of the regressor and `more` do.
    fn within(
        &self,
        at: &str,
        dag: Dag,
        more: &[Vec<ExprId>],
        asked: &[Vec<ExprId>],
    ) -> Option<Vec<String>> {
        let mut regressor = self.regressor.clone();
        regressor.dag = dag;
        let like = regressor.columns[0].clone();
        let own = regressor.columns.len();
        for entries in more.iter().chain(asked) {
            let mut column = like.clone();
            column.entries.clone_from(entries);
            regressor.columns.push(column);
        }
        // Those of the place itself come first, so that relations are told in them.
        let mut order: Vec<usize> = (0..own + more.len()).collect();
        let is_there = |column: usize| regressor.columns[column].name.ends_with(&format!("_{at}"));
        order.sort_by_key(|&column| column < own && !is_there(column));
        let first = order.len();
        order.extend(own + more.len()..own + more.len() + asked.len());
        let ranking = rank(&regressor, &order).ok()?;
        if ranking.pivots.iter().any(|pivot| order[first..].contains(pivot)) {
            return None;
        }
        let mut members: Vec<usize> = Vec::new();
        for (column, factors) in &ranking.dependent {
            if order[first..].contains(column) {
                let used = ranking.pivots.iter().zip(factors);
                members.extend(used.filter(|(_, f)| **f != Residue::ZERO).map(|(pivot, _)| pivot));
            }
        }
        members.sort_unstable();
        members.dedup();
        let name = |&column: &usize| match column < own {
            true => regressor.columns[column].name.clone(),
            false => String::new(),
        };
        Some(members.iter().map(name).collect())
    }

    /// The derivatives of the torques by the parameters of an effect, where it vanishes.
    fn signature(&self, dag: Dag, one: Named<'_>) -> Option<Signature> {
        let effect = self.effects.iter().find(|known| known.name == one.effect)?;
        let added = AddedEffect {
            effect: effect.name.clone(),
            at: self.place(one.at)?,
            side: None,
            parameters: Vec::new(),
            place: 0,
        };
        let mut robot = Robot { dag, effects: vec![added], laws: Vec::new(), ..self.robot.clone() };
        let (dag, entries) = match &effect.law {
            Law::Term(term) => {
                let terms = Terms { friction: false, rotor: false, ..robot.terms };
                let [with, without] = [true, false].map(|present| with_term(terms, *term, present));
                let (dag, with) = torques(Robot { terms: with, ..robot.clone() })?;
                let (mut dag, without) = torques(Robot { dag, terms: without, ..robot })?;
                let left = with.iter().zip(&without).map(|(&a, &b)| dag.sub(a, b)).collect();
                return Some(Signature { dag, columns: vec![left] });
            }
            Law::Moves(_) => {
                attach(&mut robot, effect, 0).ok()?;
                robot.terms = Terms { friction: false, rotor: false, ..robot.terms };
                let own = self.symbols(&robot, effect);
                let (dag, entries) = torques(Robot { laws: Vec::new(), ..robot })?;
                return Some(differentiated(effect, &own, dag, &entries));
            }
            Law::Torque(_) | Law::Measured(_) => {
                let law = as_torque(effect)?;
                attach(&mut robot, &law, 0).ok()?;
                self.of_laws(&mut robot)?
            }
        };
        let own = self.symbols(&robot, effect);
        Some(differentiated(effect, &own, dag, &entries))
    }

    /// The torques of all joints by the laws of the one effect that a robot has.
    fn of_laws(&self, robot: &mut Robot) -> Option<(Dag, Vec<ExprId>)> {
        let laws = std::mem::take(&mut robot.laws);
        let first = laws.first().filter(|law| law.states.is_empty())?;
        let row = |joint| robot.joints().position(|(link, _)| link == joint);
        let loads: Option<Vec<(usize, ExprId)>> = laws
            .iter()
            .flat_map(|law| &law.loads)
            .map(|&(link, symbol)| Some((row(link)?, symbol)))
            .collect();
        let loads = loads?;
        let terms = Terms { friction: false, rotor: false, ..robot.terms };
        let (dag, rigid) = torques(Robot { terms, ..robot.clone() })?;
        let (mut dag, all) = torques(Robot { dag, ..robot.clone() })?;
        let mut known: FxHashMap<ExprId, ExprId> =
            loads.iter().map(|&(row, symbol)| (symbol, rigid[row])).collect();
        let tau = format!("tau_{}_{}", first.effect, robot.links[first.joint].name);
        if let Some(id) = dag.find_symbol(&tau) {
            known.insert(dag.symbol_expr(id), all[row(first.joint)?]);
        }
        let mut entries = vec![dag.zero(); all.len()];
        for law in &laws {
            let torque = substitute(&mut dag, &[law.torque], &known)[0];
            let entry = &mut entries[row(law.joint)?];
            *entry = dag.add(*entry, torque);
        }
        Some((dag, entries))
    }

    /// The symbols of an effect's parameters in a robot that has it.
    fn symbols(&self, robot: &Robot, effect: &Effect) -> Vec<ExprId> {
        let added = robot.parameters.len() - effect.parameters.len();
        robot.parameters.values().skip(added).map(|parameter| parameter.symbol).collect()
    }

    fn place(&self, at: &str) -> Option<EffectPlace> {
        let link = |name: &str| self.robot.find_link(name);
        match at.split_once(" with ") {
            Some((first, second)) => Some(EffectPlace::Pair(link(first)?, link(second)?)),
            None => match link(at) {
                Some(link) => Some(EffectPlace::Link(link)),
                None => (at == "model").then_some(EffectPlace::Model),
            },
        }
    }
}

/// A law of a logged torque as one that adds to it; none of what acts on its time, and of other
/// channels.
fn as_torque(effect: &Effect) -> Option<Effect> {
    let mut effect = effect.clone();
    let Law::Measured(measured) = effect.law else { return Some(effect) };
    let zero = effect.dag.zero();
    let is_timed = measured.delay_s != zero || measured.lag_s != zero;
    if is_timed || measured.is_inverse || measured.channel != Channel::Torque {
        return None;
    }
    let tau = effect.symbol("tau")?;
    effect.law = Law::Torque(effect.dag.sub(measured.value, tau));
    Some(effect)
}

fn torques(robot: Robot) -> Option<(Dag, Vec<ExprId>)> {
    let derived = derive(&robot, Flavour::Tunable, &[FunctionName::InverseDynamics]).ok()?;
    let entries = derived.functions.first()?.entries();
    Some((derived.dag, entries))
}

/// Derivatives by parameters, those that switch an effect off being at that value.
fn differentiated(effect: &Effect, own: &[ExprId], mut dag: Dag, entries: &[ExprId]) -> Signature {
    let mut off: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    for (parameter, &symbol) in effect.parameters.iter().zip(own) {
        if let Some(value) = &parameter.nominal {
            off.insert(symbol, dag.constant(value.clone()));
        }
    }
    let mut columns = Vec::new();
    let switching = effect.parameters.iter().zip(own).filter(|(one, _)| one.nominal.is_some());
    for (_, &symbol) in switching {
        let seeds: FxHashMap<ExprId, ExprId> = [(symbol, dag.one())].into_iter().collect();
        let slopes = derivative(&mut dag, entries, &seeds);
        columns.push(substitute(&mut dag, &slopes, &off));
    }
    Signature { dag, columns }
}
