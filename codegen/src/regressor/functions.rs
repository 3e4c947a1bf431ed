//! The regressor functions, derived like all others.
//!
//! `regressor` has the columns of [`Regressor`]. `base_regressor` has a basis of the space that
//! they span, that on the joint axes, and `base_parameters` are the parameters that belong to it:
//! see [`joint_basis`](super::joint_basis()). Both regressors have the joint parameters that the
//! model has. Of the ways to a function that is taken which costs least. What a torque has besides
//! unknowns is a second output.

use super::axis_frames::axis_shares;
use super::base::{BaseParameters, reduce};
use super::column::{Feature, Regressor, RegressorOptions, Unknowns};
use super::follow::Route;
use super::joint_basis::{JointParameter, joint_basis};
use super::link_frames::Shortcuts;
use crate::dynamics::explicit;
use crate::dynamics::portfolio::{MAX_EXPLICIT_JOINTS, arguments};
use crate::expr::{Dag, ExprId, Operations};
use crate::function::{Form, Function, FunctionName, Output};
use crate::model::{Robot, TorqueSide};

/// The side of the drives that the emitted regressors are of.
const SIDE: TorqueSide = TorqueSide::Joint;

/// The regressor functions of a robot: none if its torques are no polynomials in its unknowns, or
/// have none.
pub fn derive(dag: &mut Dag, robot: &Robot, name: FunctionName) -> Vec<Function> {
    let mut with_graph = robot.clone();
    with_graph.dag = std::mem::take(dag);
    let made = match name {
        FunctionName::Regressor => regressor(&mut with_graph),
        FunctionName::BaseRegressor => base_regressor(&with_graph),
        _ => base_parameters(&with_graph),
    };
    let Some(Made { dag: grown, outputs, form }) = made else {
        *dag = with_graph.dag;
        return Vec::new();
    };
    *dag = grown;
    let arguments = arguments(dag, robot, name);
    vec![Function { name, link: None, arguments, outputs, form }]
}

/// The outputs of a function, with the graph that holds them.
struct Made {
    dag: Dag,
    outputs: Vec<Output>,
    form: Form,
}

/// The ways to the entries of a function that have been tried, and the cheapest of them.
struct Cheapest {
    price: usize,
    form: Form,
    entries: Vec<ExprId>,
}

impl Cheapest {
    fn new(dag: &mut Dag, entries: Vec<ExprId>, joints: usize) -> Self {
        let price = price(dag, &entries);
        let mut cheapest = Self { price, form: Form::Plain, entries };
        cheapest.try_closed(dag, joints);
        cheapest
    }

    /// Whether these entries, or those multiplied out, cost less than all before.
    fn try_other(
        &mut self,
        dag: &mut Dag,
        entries: Vec<ExprId>,
        form: Form,
        joints: usize,
    ) -> bool {
        let mut other = Self { price: price(dag, &entries), form, entries };
        other.try_closed(dag, joints);
        let is_cheaper = other.price < self.price;
        if is_cheaper {
            *self = other;
        }
        is_cheaper
    }

    /// Of robots of few joints, the entries multiplied out.
    fn try_closed(&mut self, dag: &mut Dag, joints: usize) {
        if joints > MAX_EXPLICIT_JOINTS {
            return;
        }
        let Some(entries) = explicit(dag, &self.entries) else { return };
        let price = price(dag, &entries);
        if price < self.price {
            *self = Self { price, form: Form::Explicit, entries };
        }
    }
}

fn price(dag: &Dag, entries: &[ExprId]) -> usize {
    Operations::count(dag, entries).price()
}

fn form(route: Route) -> Form {
    if route.grouped { Form::Grouped } else { Form::Plain }
}

fn regressor(robot: &mut Robot) -> Option<Made> {
    let options = modelled(robot);
    let mut regressor = Regressor::new(robot, options, SIDE).ok()?;
    if regressor.columns.is_empty() {
        return None;
    }
    let n = regressor.joints.len();
    let entries = regressor.entries();
    let mut cheapest = Cheapest::new(&mut regressor.dag, entries, n);
    // Each is tried together with those before that paid.
    let choices: [fn(&mut Shortcuts); 6] = [
        |shortcuts| shortcuts.second = true,
        |shortcuts| shortcuts.first = true,
        |shortcuts| shortcuts.mass = true,
        |shortcuts| shortcuts.route.grouped = true,
        |shortcuts| shortcuts.route.by_axes = true,
        |shortcuts| shortcuts.route.split = true,
    ];
    let mut best = Shortcuts::default();
    for choose in choices {
        let mut shortcuts = best;
        choose(&mut shortcuts);
        robot.dag = std::mem::take(&mut regressor.dag);
        let other = Regressor::with_shortcuts(robot, options, SIDE, shortcuts)
            .expect("shortcuts decide nothing about unknowns");
        let entries = other.entries();
        regressor.dag = other.dag;
        if cheapest.try_other(&mut regressor.dag, entries, form(shortcuts.route), n) {
            best = shortcuts;
        }
    }
    let names: Vec<&str> = regressor.columns.iter().map(|column| column.name.as_str()).collect();
    let doc = format!("Row: joint. Columns: {}.", names.join(", "));
    let shape = vec![n, names.len()];
    let (entries, name) = (cheapest.entries, FunctionName::Regressor.as_str());
    let mut outputs = vec![Output { name, shape, entries, doc, details: Vec::new() }];
    outputs.extend(known(&regressor));
    Some(Made { dag: regressor.dag, outputs, form: cheapest.form })
}

fn base_regressor(robot: &Robot) -> Option<Made> {
    let (base, parameters) = in_joint_basis(robot)?;
    let mut regressor = base.regressor;
    let n = regressor.joints.len();
    let mut cheapest: Option<Cheapest> = None;
    for choice in 0..8 {
        let has = |bit: u32| choice & bit != 0;
        let route = Route { grouped: has(4), by_axes: has(2), split: has(1) };
        let entries = axis_entries(&mut regressor, robot, &parameters, route);
        let dag = &mut regressor.dag;
        match &mut cheapest {
            Some(cheapest) => _ = cheapest.try_other(dag, entries, form(route), n),
            None => cheapest = Some(Cheapest::new(dag, entries, n)),
        }
    }
    let Cheapest { form, entries, .. } = cheapest?;
    let names: Vec<&str> = parameters.iter().map(|parameter| parameter.name.as_str()).collect();
    let doc = format!("Row: joint. Columns, those of `base_parameters`: {}.", names.join(", "));
    let shape = vec![n, names.len()];
    let name = FunctionName::BaseRegressor.as_str();
    let mut outputs = vec![Output { name, shape, entries, doc, details: Vec::new() }];
    outputs.extend(known(&regressor));
    Some(Made { dag: regressor.dag, outputs, form })
}

fn base_parameters(robot: &Robot) -> Option<Made> {
    let (base, parameters) = in_joint_basis(robot)?;
    let details = parameters
        .iter()
        .map(|parameter| {
            let JointParameter { name, unit, parts, .. } = parameter;
            format!("`{name}` [{unit}]: `{}`", base.sum_text(parts))
        })
        .collect();
    let output = Output {
        name: FunctionName::BaseParameters.as_str(),
        shape: vec![parameters.len()],
        entries: parameters.iter().map(|parameter| parameter.value).collect(),
        doc: "One for each column of `base_regressor`, in the names of `denavit base --basis \
              joints`. Of link L, m_L, mx_L .. mz_L and Ixx_L .. Iyz_L are mass, mass times \
              centre of mass and inertia about the origin of the link frame."
            .to_owned(),
        details,
    };
    Some(Made { dag: base.regressor.dag, outputs: vec![output], form: Form::Plain })
}

/// The base parameters of a robot on its joint axes, if it has any.
fn in_joint_basis(robot: &Robot) -> Option<(BaseParameters, Vec<JointParameter>)> {
    let regressor = Regressor::new(robot, modelled(robot), SIDE).ok()?;
    let mut base = reduce(regressor, &[]).ok()?;
    let parameters = joint_basis(&mut base, robot).ok()?;
    (!parameters.is_empty()).then_some((base, parameters))
}

/// The columns of the parameters, row by row.
fn axis_entries(
    regressor: &mut Regressor,
    robot: &Robot,
    parameters: &[JointParameter],
    route: Route,
) -> Vec<ExprId> {
    let terms = regressor.motion_terms();
    let dag = &mut regressor.dag;
    let shares = axis_shares(dag, robot, &regressor.mechanism, terms, route);
    let mut entries = Vec::new();
    for row in 0..regressor.joints.len() {
        for parameter in parameters {
            let mut sum = dag.zero();
            for &(feature, factor) in &parameter.column {
                let torque = match feature {
                    Feature::Matter { body, entry } => shares[body]
                        .iter()
                        .find(|(joint, _)| *joint == row)
                        .map(|(_, torques)| torques[entry]),
                    Feature::Joint { joint, function } => {
                        (joint == row).then(|| function.of(dag, robot, joint))
                    }
                };
                if let Some(torque) = torque {
                    let product = dag.mul(factor, torque);
                    sum = dag.add(sum, product);
                }
            }
            entries.push(sum);
        }
    }
    entries
}

/// What a torque has besides unknowns, if it has anything.
fn known(regressor: &Regressor) -> Option<Output> {
    let zero = regressor.dag.zero();
    let is_any = regressor.known.iter().any(|&torque| torque != zero);
    is_any.then(|| Output {
        name: "known",
        shape: vec![regressor.known.len()],
        entries: regressor.known.clone(),
        doc: "What each torque has besides [N m, N]: known matter, known joint parameters, \
              springs."
            .to_owned(),
        details: Vec::new(),
    })
}

/// The joint parameters that the model has.
pub fn modelled(robot: &Robot) -> RegressorOptions {
    RegressorOptions {
        friction: robot.terms.friction,
        rotor: robot.terms.rotor,
        offset: true,
        only_modelled: true,
        unknowns: Unknowns::Parameters,
    }
}
