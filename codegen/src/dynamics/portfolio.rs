//! Every function of a model, each in its cheapest formulation.

use super::candidate::Candidate;
use super::contact_derivatives::forces;
use super::explicit::explicit;
use super::joint_torque::{JointTerms, joint_terms};
use super::outputs;
use super::walking;
use crate::expr::{Dag, ExprId, Operations, Residues, evaluate};
use crate::function::{Argument, Form, Function, FunctionName, Output};
use crate::kinematics::{Frames, Mechanism};
use crate::model::{Base, LinkId, Robot};
use crate::number::Residue;
use std::cell::OnceCell;

/// Closed forms grow exponentially with the joints: beyond three they never pay.
pub(crate) const MAX_EXPLICIT_JOINTS: usize = 3;

/// All formulations of one robot.
pub struct Portfolio<'a> {
    robot: &'a Robot,
    mechanism: &'a Mechanism,
    /// The frames of each formulation, the plain one first.
    forms: Vec<(Form, Frames)>,
    joints: Vec<JointTerms>,
    /// Whether D has no inverse, whatever the values of q and of the parameters; once asked.
    is_singular: OnceCell<bool>,
}

impl<'a> Portfolio<'a> {
    /// The formulations of `robot`, whose moving bodies are `mechanism` (regrouped or not).
    pub fn new(dag: &mut Dag, robot: &'a Robot, mechanism: &'a Mechanism) -> Self {
        let mut forms = vec![(Form::Plain, Frames::plain(dag, mechanism))];
        forms.extend(Frames::grouped(dag, mechanism).map(|frames| (Form::Grouped, frames)));
        let joints = joint_terms(dag, robot);
        Self { robot, mechanism, forms, joints, is_singular: OnceCell::new() }
    }

    /// The functions of a name: none if the robot cannot have it (contacts without contact
    /// points, the inverse of a mass matrix that has none), one for each link if it is of links.
    pub fn derive(&self, dag: &mut Dag, name: FunctionName) -> Vec<Function> {
        if self.is_missing(dag, name) {
            return Vec::new();
        }
        let robot = self.robot;
        match name {
            FunctionName::LinkJacobian => {
                self.of_links(dag, name, robot.links.keys().collect(), outputs::link_jacobian)
            }
            FunctionName::FootRotationIndicator => {
                self.of_links(dag, name, self.feet(), walking::foot_rotation_indicator)
            }
            _ => {
                let build = |dag: &mut Dag, candidate: &Candidate<'_>, route| {
                    outputs::outputs(dag, candidate, name, route)
                };
                vec![self.cheapest(dag, name, None, &build)]
            }
        }
    }

    /// One function for each of some links.
    fn of_links(
        &self,
        dag: &mut Dag,
        name: FunctionName,
        links: Vec<LinkId>,
        output: fn(&mut Dag, &Candidate<'_>, LinkId) -> Output,
    ) -> Vec<Function> {
        let make = |link: LinkId| {
            let build =
                |dag: &mut Dag, candidate: &Candidate<'_>, _| vec![output(dag, candidate, link)];
            self.cheapest(dag, name, Some(self.robot.links[link].name.clone()), &build)
        };
        links.into_iter().map(make).collect()
    }

    /// The links that carry contact points and move.
    fn feet(&self) -> Vec<LinkId> {
        let contacts = &self.robot.contacts;
        let moves = |link: &LinkId| self.mechanism.placements[*link].body.is_some();
        let carries = |link: &LinkId| contacts.values().any(|contact| contact.link == *link);
        self.robot.links.keys().filter(|link| carries(link) && moves(link)).collect()
    }

    /// Whether the robot cannot have a function.
    fn is_missing(&self, dag: &mut Dag, name: FunctionName) -> bool {
        use FunctionName as F;
        let robot = self.robot;
        match name {
            F::ContactPositions | F::ContactJacobian | F::ContactBias | F::ContactDerivatives => {
                robot.contacts.is_empty()
            }
            F::ZeroMomentPoint | F::CartTableZmp | F::FootRotationIndicator | F::CapturePoint => {
                robot.contacts.is_empty() || robot.base == Base::Fixed
            }
            F::StateRates => robot.law_states().next().is_none(),
            F::Bias | F::InverseDynamicsDerivatives => self.is_implicit(dag),
            F::MassMatrixSolve => self.is_singular(dag),
            F::ForwardDynamics | F::ForwardDynamicsDerivatives => {
                self.is_implicit(dag) || self.is_singular(dag)
            }
            // Of the stage after this one.
            F::Regressor | F::BaseRegressor | F::BaseParameters => true,
            _ => false,
        }
    }

    /// Whether a law of an added effect is no function of q, qd and states alone, so that
    /// accelerations cannot be solved for.
    fn is_implicit(&self, dag: &Dag) -> bool {
        self.joints.iter().any(|joint| joint.implicit != dag.zero())
    }

    /// Whether D is singular at random points modulo p: at one where it is not, it has an inverse.
    fn is_singular(&self, dag: &mut Dag) -> bool {
        *self.is_singular.get_or_init(|| {
            let (_, frames) = &self.forms[0];
            let (robot, mechanism) = (self.robot, self.mechanism);
            let candidate = Candidate { robot, mechanism, frames, joints: &self.joints };
            let name = FunctionName::MassMatrix;
            let entries = outputs::outputs(dag, &candidate, name, Route::Only).remove(0).entries;
            (1..=2).all(|seed| {
                // Where a point divides by 0, nothing is known, and nothing left out.
                evaluate(dag, &entries, &mut Residues::new(seed))
                    .is_ok_and(|values| has_no_inverse(values, frames.len()))
            })
        })
    }

    /// Builds every formulation by every route and keeps the one of the lowest price.
    fn cheapest(
        &self,
        dag: &mut Dag,
        name: FunctionName,
        link: Option<String>,
        build: &dyn Fn(&mut Dag, &Candidate<'_>, Route) -> Vec<Output>,
    ) -> Function {
        let mut best: Option<(usize, Form, Vec<Output>)> = None;
        for (form, frames) in &self.forms {
            let (robot, mechanism) = (self.robot, self.mechanism);
            let candidate = Candidate { robot, mechanism, frames, joints: &self.joints };
            for &route in routes(name) {
                let outputs = build(dag, &candidate, route);
                let entries: Vec<ExprId> =
                    outputs.iter().flat_map(|output| output.entries.iter().copied()).collect();
                let mut keep = |dag: &Dag, form: Form, outputs: Vec<Output>| {
                    let price = price(dag, &outputs);
                    if best.as_ref().is_none_or(|(lowest, ..)| price < *lowest) {
                        best = Some((price, form, outputs));
                    }
                };
                if frames.len() <= MAX_EXPLICIT_JOINTS
                    && let Some(closed) = explicit(dag, &entries)
                {
                    keep(dag, Form::Explicit, with_entries(&outputs, &closed));
                }
                keep(dag, *form, outputs);
            }
        }
        let (_, form, outputs) = best.expect("the plain formulation is always there");
        Function { name, link, arguments: arguments(dag, self.robot, name), outputs, form }
    }
}

/// Whether Gauss's elimination of an n by n matrix, row by row, ends without a pivot.
fn has_no_inverse(mut entries: Vec<Residue>, n: usize) -> bool {
    for column in 0..n {
        let pivot = (column..n).find(|row| entries[row * n + column] != Residue::ZERO);
        let Some(pivot) = pivot else { return true };
        (0..n).for_each(|k| entries.swap(column * n + k, pivot * n + k));
        let inverse = entries[column * n + column].inverse().expect("a pivot is not 0");
        for row in column + 1..n {
            let factor = entries[row * n + column] * inverse;
            for k in column..n {
                entries[row * n + k] = entries[row * n + k] - factor * entries[column * n + k];
            }
        }
    }
    false
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

fn price(dag: &Dag, outputs: &[Output]) -> usize {
    let entries: Vec<ExprId> =
        outputs.iter().flat_map(|output| output.entries.iter().copied()).collect();
    Operations::count(dag, &entries).price()
}

/// The same outputs with other entries, in order.
fn with_entries(outputs: &[Output], entries: &[ExprId]) -> Vec<Output> {
    let mut rest = entries.iter().copied();
    outputs
        .iter()
        .map(|output| {
            let entries = rest.by_ref().take(output.entries.len()).collect();
            Output { entries, ..output.clone() }
        })
        .collect()
}

/// Which of the motion and its torques a function is called with.
fn motion_arguments(name: FunctionName) -> &'static [&'static str] {
    use FunctionName as F;
    match name {
        F::BaseParameters => &[],
        F::InverseDynamics
        | F::InverseDynamicsDerivatives
        | F::StateRates
        | F::ContactDerivatives
        | F::ZeroMomentPoint
        | F::CartTableZmp
        | F::FootRotationIndicator
        | F::Regressor
        | F::BaseRegressor => &["q", "qd", "qdd"],
        F::ForwardDynamics | F::ForwardDynamicsDerivatives => &["q", "qd", "tau"],
        F::CoriolisMatrix
        | F::Bias
        | F::DynamicsTerms
        | F::ContactBias
        | F::CenterOfMassBias
        | F::CentroidalMomentumBias
        | F::AngularMomenta
        | F::CapturePoint
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
        | F::CentroidalMomentumMatrix
        | F::PotentialEnergy => &["q"],
    }
}

/// The arguments of a function, in the order of the call.
pub(crate) fn arguments(dag: &mut Dag, robot: &Robot, name: FunctionName) -> Vec<Argument> {
    use FunctionName as F;
    let mut arguments: Vec<Argument> = motion_arguments(name)
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
        .collect();
    if name == F::ContactDerivatives {
        let symbols = forces(dag, robot);
        arguments.push(Argument { name: "f", symbols });
    }
    let has_laws = matches!(
        name,
        F::InverseDynamics
            | F::InverseDynamicsDerivatives
            | F::ForwardDynamics
            | F::ForwardDynamicsDerivatives
            | F::Bias
            | F::StateRates
    );
    if has_laws {
        let states: Vec<ExprId> = robot.law_states().map(|state| state.symbol).collect();
        let time: Vec<ExprId> = robot.time().into_iter().collect();
        let more = [("t", time), ("states", states)].into_iter();
        let more = more.filter(|(_, symbols)| !symbols.is_empty());
        arguments.extend(more.map(|(name, symbols)| Argument { name, symbols }));
    }
    arguments
}
