//! Every function of a model, each in its cheapest formulation.

use super::candidate::Candidate;
use super::joint_torque::joint_terms;
use super::outputs;
use crate::expr::{Dag, ExprId, Operations};
use crate::function::{Argument, Form, Function, FunctionName, Output};
use crate::kinematics::{Frames, Mechanism};
use crate::model::Robot;
use crate::regroup::regroup;

/// Derives the functions of `wanted`, in that order; those that the robot cannot have (contacts of
/// a robot without contact points) are left out. All expressions go to `dag`, a copy of the
/// robot's own.
pub fn functions(dag: &mut Dag, robot: &Robot, wanted: &[FunctionName]) -> Vec<Function> {
    let mechanism = Mechanism::new(dag, robot);
    let regrouped = regroup(dag, &mechanism);
    let joints = joint_terms(dag, robot);
    let plain = Frames::plain(dag, &regrouped);
    let grouped = Frames::grouped(dag, &regrouped);
    let candidate =
        |frames| Candidate { robot, mechanism: &mechanism, frames, joints: joints.as_slice() };
    let mut candidates = vec![(Form::Plain, candidate(&plain))];
    candidates.extend(grouped.as_ref().map(|frames| (Form::Grouped, candidate(frames))));
    wanted.iter().flat_map(|&name| derive(dag, robot, name, &candidates)).collect()
}

/// A way to one function; the cheapest is kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Route {
    /// There is one way only.
    Only,
    /// G from composite inertias.
    Composites,
    /// G by inverse dynamics at rest.
    Recursion,
    /// D factorised.
    Factorised,
    /// Articulated bodies.
    Articulated,
}

fn routes(name: FunctionName) -> &'static [Route] {
    match name {
        FunctionName::GravityVector => &[Route::Composites, Route::Recursion],
        FunctionName::ForwardDynamics => &[Route::Factorised, Route::Articulated],
        _ => &[Route::Only],
    }
}

fn derive(
    dag: &mut Dag,
    robot: &Robot,
    name: FunctionName,
    candidates: &[(Form, Candidate<'_>)],
) -> Vec<Function> {
    let is_of_contacts = matches!(
        name,
        FunctionName::ContactPositions | FunctionName::ContactJacobian | FunctionName::ContactBias
    );
    if is_of_contacts && robot.contacts.is_empty() {
        return Vec::new();
    }
    if name == FunctionName::LinkJacobian {
        let links = robot.links.keys();
        return links
            .map(|link| {
                let build = |dag: &mut Dag, candidate: &Candidate<'_>, _| {
                    vec![outputs::link_jacobian(dag, candidate, link)]
                };
                let link = Some(robot.links[link].name.clone());
                cheapest(dag, robot, (name, link), candidates, &build)
            })
            .collect();
    }
    let build = |dag: &mut Dag, candidate: &Candidate<'_>, route| {
        outputs::outputs(dag, candidate, name, route)
    };
    vec![cheapest(dag, robot, (name, None), candidates, &build)]
}

/// Builds every formulation by every route and keeps the one of the lowest price.
fn cheapest(
    dag: &mut Dag,
    robot: &Robot,
    (name, link): (FunctionName, Option<String>),
    candidates: &[(Form, Candidate<'_>)],
    build: &dyn Fn(&mut Dag, &Candidate<'_>, Route) -> Vec<Output>,
) -> Function {
    let mut best: Option<(usize, Form, Vec<Output>)> = None;
    for (form, candidate) in candidates {
        for &route in routes(name) {
            let outputs = build(dag, candidate, route);
            let entries: Vec<ExprId> =
                outputs.iter().flat_map(|output| output.entries.iter().copied()).collect();
            let price = Operations::count(dag, &entries).price();
            if best.as_ref().is_none_or(|(lowest, ..)| price < *lowest) {
                best = Some((price, *form, outputs));
            }
        }
    }
    let (_, form, outputs) = best.expect("the plain formulation is always there");
    Function { name, link, arguments: arguments(dag, robot, name), outputs, form }
}

/// The arguments of a function, in the order of the call.
fn arguments(dag: &mut Dag, robot: &Robot, name: FunctionName) -> Vec<Argument> {
    use FunctionName as F;
    let names: &[&'static str] = match name {
        F::InverseDynamics | F::InverseDynamicsDerivatives => &["q", "qd", "qdd"],
        F::ForwardDynamics | F::ForwardDynamicsDerivatives => &["q", "qd", "tau"],
        F::CoriolisMatrix
        | F::Bias
        | F::DynamicsTerms
        | F::ContactBias
        | F::Momentum
        | F::KineticEnergy => &["q", "qd"],
        F::MassMatrixSolve => &["q", "b"],
        F::MassMatrix
        | F::GravityVector
        | F::LinkTransforms
        | F::LinkJacobian
        | F::ContactPositions
        | F::ContactJacobian
        | F::CenterOfMass
        | F::CenterOfMassJacobian
        | F::PotentialEnergy => &["q"],
    };
    names
        .iter()
        .map(|&argument| {
            let symbols = robot.joints().map(|(link, variables)| match argument {
                "q" => variables.q,
                "qd" => variables.qd,
                "qdd" => variables.qdd,
                "tau" => variables.tau,
                _ => outputs::right_side(dag, &robot.links[link].name),
            });
            Argument { name: argument, symbols: symbols.collect() }
        })
        .collect()
}
