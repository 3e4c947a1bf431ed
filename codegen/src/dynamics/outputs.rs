//! The outputs of every function, with shapes and one line of documentation each.

use super::candidate::{Candidate, Solver};
use super::portfolio::Route;
use super::walking;
use crate::expr::{Dag, ExprId, SymbolClass};
use crate::function::{FunctionName, Output};
use crate::model::LinkId;

/// The symbol of one entry of the right-hand side b of D x = b.
pub(super) fn right_side(dag: &mut Dag, link: &str) -> ExprId {
    dag.symbol(&format!("b_{link}"), SymbolClass::Effort)
}

/// The Jacobian of one link's frame.
pub(super) fn link_jacobian(dag: &mut Dag, candidate: &Candidate<'_>, link: LinkId) -> Output {
    let n = candidate.frames.len();
    let name = &candidate.robot.links[link].name;
    let doc = format!(
        "Geometric Jacobian of the frame of link {name}, world frame: rows vx, vy, vz of its \
         origin, then wx, wy, wz; one column for each joint."
    );
    output("link_jacobian", &[6, n], candidate.link_jacobian(dag, link), &doc)
}

/// The outputs of a function in one formulation, by one route.
pub(super) fn outputs(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    name: FunctionName,
    route: Route,
) -> Vec<Output> {
    use FunctionName as F;
    let n = candidate.frames.len();
    match name {
        F::InverseDynamics => vec![torques(candidate.inverse_dynamics(dag))],
        F::Bias => vec![output(
            "bias",
            &[n],
            candidate.bias(dag),
            "C qd + G and the joints' own torques at qdd = 0 [N m, N].",
        )],
        F::MassMatrix | F::CoriolisMatrix | F::GravityVector | F::DynamicsTerms => {
            dynamics_terms(dag, candidate, name, route)
        }
        F::ForwardDynamics => {
            let tau = efforts(candidate);
            let qdd = candidate.forward_dynamics(dag, &tau, solver(route));
            vec![output("qdd", &[n], qdd, "Joint accelerations [rad/s^2, m/s^2].")]
        }
        F::MassMatrixSolve => {
            let names: Vec<String> = candidate
                .robot
                .joints()
                .map(|(link, _)| candidate.robot.links[link].name.clone())
                .collect();
            let right: Vec<_> = names.iter().map(|link| right_side(dag, link)).collect();
            let x = candidate.solve(dag, &right);
            vec![output("x", &[n], x, "D^-1 b.")]
        }
        F::InverseDynamicsDerivatives | F::ForwardDynamicsDerivatives => {
            derivatives(dag, candidate, name, route)
        }
        F::StateRates => vec![state_rates(dag, candidate)],
        _ if F::WALKING.contains(&name) => walking::outputs(dag, candidate, name),
        _ => kinematics_and_energy(dag, candidate, name),
    }
}

fn state_rates(dag: &mut Dag, candidate: &Candidate<'_>) -> Output {
    let rates = candidate.state_rates(dag);
    let doc = "Derivatives of the states of added effects, each per second.";
    let mut rates = output("state_rates", &[rates.len()], rates, doc);
    rates.details = candidate.robot.law_states().map(|state| state.name.clone()).collect();
    rates
}

fn dynamics_terms(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    name: FunctionName,
    route: Route,
) -> Vec<Output> {
    use FunctionName as F;
    let n = candidate.frames.len();
    let mut outputs = Vec::new();
    if matches!(name, F::MassMatrix | F::DynamicsTerms) {
        let entries = candidate.mass_matrix(dag).concat();
        let doc = "D(q), symmetric, rotors included [kg m^2, kg m, kg].";
        outputs.push(output("mass_matrix", &[n, n], entries, doc));
    }
    if matches!(name, F::CoriolisMatrix | F::DynamicsTerms) {
        let entries = candidate.coriolis_matrix(dag).concat();
        let doc = "C(q, qd) from the Christoffel symbols: dD/dt - 2 C is skew.";
        outputs.push(output("coriolis_matrix", &[n, n], entries, doc));
    }
    if matches!(name, F::GravityVector | F::DynamicsTerms) {
        let entries = candidate.gravity_vector(dag, route != Route::Recursion);
        let doc = "G(q) = dP/dq of gravity [N m, N].";
        outputs.push(output("gravity_vector", &[n], entries, doc));
    }
    outputs
}

fn derivatives(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    name: FunctionName,
    route: Route,
) -> Vec<Output> {
    let n = candidate.frames.len();
    if name == FunctionName::InverseDynamicsDerivatives {
        let [by_position, by_rate] = candidate.inverse_derivatives(dag, None);
        return vec![
            output("dtau_dq", &[n, n], by_position.concat(), "Row: torque, column: position."),
            output("dtau_dqd", &[n, n], by_rate.concat(), "Row: torque, column: velocity."),
        ];
    }
    let tau = efforts(candidate);
    let qdd = candidate.forward_dynamics(dag, &tau, solver(route));
    let [by_position, by_rate, by_torque] = candidate.forward_derivatives(dag, &qdd);
    vec![
        output("dqdd_dq", &[n, n], by_position.concat(), "Row: acceleration, column: position."),
        output("dqdd_dqd", &[n, n], by_rate.concat(), "Row: acceleration, column: velocity."),
        output("dqdd_dtau", &[n, n], by_torque.concat(), "D^-1, symmetric."),
    ]
}

fn kinematics_and_energy(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    name: FunctionName,
) -> Vec<Output> {
    use FunctionName as F;
    let n = candidate.frames.len();
    let links = candidate.robot.links.len();
    let points = candidate.robot.contacts.len();
    match name {
        F::LinkTransforms => vec![output(
            "link_transforms",
            &[links, 3, 4],
            candidate.link_transforms(dag),
            "Link by link, the upper three rows [R | o] of the transform to the world frame \
             [1, m].",
        )],
        F::ContactPositions => vec![output(
            "contact_positions",
            &[points, 3],
            candidate.contact_positions(dag),
            "Point by point, x, y, z in the world frame [m].",
        )],
        F::ContactJacobian => vec![output(
            "contact_jacobian",
            &[3 * points, n],
            candidate.contact_jacobian(dag),
            "W^T = dh/dq: rows x, y, z of each point in turn, world frame.",
        )],
        F::ContactBias => vec![output(
            "contact_bias",
            &[3 * points],
            candidate.contact_bias(dag),
            "(d/dt W^T) qd: x, y, z of each point in turn, world frame [m/s^2].",
        )],
        F::CenterOfMass => vec![output(
            "center_of_mass",
            &[3],
            candidate.center_of_mass(dag),
            "Centre of mass in the world frame [m].",
        )],
        F::CenterOfMassJacobian => vec![output(
            "center_of_mass_jacobian",
            &[3, n],
            candidate.center_of_mass_jacobian(dag),
            "d(centre of mass)/dq, world frame.",
        )],
        F::Momentum => {
            let [linear, angular] = candidate.momentum(dag);
            let about = "Angular momentum about the centre of mass, world frame [kg m^2/s].";
            vec![
                output("linear_momentum", &[3], linear, "Linear momentum, world frame [kg m/s]."),
                output("angular_momentum", &[3], angular, about),
            ]
        }
        F::KineticEnergy => {
            let energy = vec![candidate.kinetic_energy(dag)];
            vec![output("kinetic_energy", &[], energy, "Of bodies and rotors [J].")]
        }
        F::PotentialEnergy => {
            let energy = vec![candidate.potential_energy(dag)];
            let doc = "Of gravity (0 where all centres of mass lie in the origin) and springs [J].";
            vec![output("potential_energy", &[], energy, doc)]
        }
        _ => unreachable!("{name} is no function of kinematics or energy"),
    }
}

fn torques(entries: Vec<ExprId>) -> Output {
    output("tau", &[entries.len()], entries, "Joint torques, positive along the axes [N m, N].")
}

fn efforts(candidate: &Candidate<'_>) -> Vec<ExprId> {
    candidate.frames.frames.iter().map(|frame| frame.variables.tau).collect()
}

fn solver(route: Route) -> Solver {
    if route == Route::Articulated { Solver::Articulated } else { Solver::Factorise }
}

fn output(name: &'static str, shape: &[usize], entries: Vec<ExprId>, doc: &str) -> Output {
    Output { name, shape: shape.to_vec(), entries, doc: doc.to_owned(), details: Vec::new() }
}
