//! Chapter 2: the methods, and the equations of contact and impact (2.5-2.53).

use super::Case;
use denavit_codegen::dynamics::methods::dh_lagrange::{CoriolisForm, derive_with};
use denavit_codegen::dynamics::methods::{Method, lagrange, newton_euler};
use denavit_codegen::expr::{Dag, ExprId, SymbolClass, substitute};
use denavit_codegen::model::{Body, LinkId};
use denavit_codegen::spatial::{Matrix, Vector, add, cross, dot, scale, subtract, transpose};

/// The tensor of a body in world axes, about its centre of mass.
fn world_tensor(dag: &mut Dag, body: &Body, rotation: Matrix) -> Matrix {
    let [xx, yy, zz, xy, xz, yz] = body.inertia;
    let tensor = [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]];
    let columns = transpose(rotation);
    let turned = rotation.map(|row| columns_times(dag, row, tensor));
    turned.map(|row| columns_times(dag, row, columns))
}

/// `row B`.
fn columns_times(dag: &mut Dag, row: Vector, b: Matrix) -> Vector {
    transpose(b).map(|column| dot(dag, row, column))
}

fn apply(dag: &mut Dag, a: Matrix, v: Vector) -> Vector {
    a.map(|row| dot(dag, row, v))
}

/// The last link of a robot with its body and its motion.
fn last_link(case: &mut Case) -> (LinkId, Body, newton_euler::LinkMotion) {
    let solution = newton_euler::eliminate(&mut case.dag, &case.robot);
    let (id, link) = case.robot.links.iter().next_back().expect("a robot has links");
    let motion = *solution.motions.last().expect("a robot has links");
    (id, link.body.expect("the last link has a body"), motion)
}

#[test]
fn eq_2_5_lacks_the_euler_term_in_space() {
    let mut case = Case::new("puma560");
    let (id, body, motion) = last_link(&mut case);
    let tensor = world_tensor(&mut case.dag, &body, motion.rotation);
    let solution = newton_euler::eliminate(&mut case.dag, &case.robot);
    let wrench = solution.wrenches.last().expect("a robot has links");
    // moment of the joint: inertial moment, and the lever of the inertial force
    let falling = subtract(&mut case.dag, motion.acceleration, case.robot.gravity);
    let force = scale(&mut case.dag, body.mass, falling);
    let arm = subtract(&mut case.dag, motion.position, wrench.point);
    let lever = cross(&mut case.dag, arm, force);
    let accelerated = apply(&mut case.dag, tensor, motion.angular_acceleration);
    let momentum = apply(&mut case.dag, tensor, motion.angular_velocity);
    let gyroscopic = cross(&mut case.dag, motion.angular_velocity, momentum);
    let printed = add(&mut case.dag, accelerated, lever);
    let corrected = add(&mut case.dag, printed, gyroscopic);
    let torques = [printed, corrected].map(|moment| dot(&mut case.dag, wrench.axis, moment));
    let row = case.robot.joints().position(|(link, _)| link == id).expect("it moves");
    let truth = case.derive(Method::Lagrange);
    let truth = case.dag.sub(truth.inverse_dynamics[row], truth.drive_torque[row]);
    let rotor = rotor_torque(&mut case, row);
    let truth = case.dag.sub(truth, rotor);
    case.misprint(&[torques[0]], &[torques[1]], &[truth]);
}

/// N^2 Ia qdd of one joint.
fn rotor_torque(case: &mut Case, row: usize) -> ExprId {
    let rotors = lagrange::energies(&mut case.dag, &case.robot).rotors;
    let [_, qd, qdd] = case.coordinates();
    let momentum = case.by(rotors, qd[row]);
    let inertia = case.by(momentum, qd[row]);
    case.dag.mul(inertia, qdd[row])
}

#[test]
fn eq_2_6_needs_the_tensor_in_space() {
    let mut case = Case::new("puma560");
    let solution = newton_euler::eliminate(&mut case.dag, &case.robot);
    let bodies: Vec<_> = case.robot.links.values().map(|link| link.body).collect();
    let zero = case.dag.zero();
    let (mut printed, mut corrected) = (zero, zero);
    for (body, motion) in bodies.iter().zip(&solution.motions) {
        let Some(body) = body else { continue };
        let dag = &mut case.dag;
        let w = motion.angular_velocity;
        let square = dot(dag, motion.velocity, motion.velocity);
        let linear = dag.mul(body.mass, square);
        let square = dot(dag, w, w);
        let scalar = dag.mul(body.inertia[2], square);
        let tensor = world_tensor(dag, body, motion.rotation);
        let momentum = apply(dag, tensor, w);
        let angular = dot(dag, w, momentum);
        for (sum, angular) in [(&mut printed, scalar), (&mut corrected, angular)] {
            let doubled = dag.add(linear, angular);
            *sum = dag.add(*sum, doubled);
        }
    }
    let truth = lagrange::energies(&mut case.dag, &case.robot).bodies;
    let truth = case.dag.add(truth, truth);
    case.misprint(&[printed], &[corrected], &[truth]);
}

#[test]
fn eq_2_39_lacks_one_half() {
    let mut case = Case::new("tulip_leg6");
    let result = case.derive(Method::DhLagrange);
    let [_, qd, _] = case.coordinates();
    let mut printed = case.dag.zero();
    for (row, &left) in result.mass_matrix.iter().zip(&qd) {
        for (&entry, &right) in row.iter().zip(&qd) {
            let rates = case.dag.mul(left, right);
            let term = case.dag.mul(entry, rates);
            printed = case.dag.add(printed, term);
        }
    }
    let half = case.read("1/2");
    let corrected = case.dag.mul(half, printed);
    let energies = lagrange::energies(&mut case.dag, &case.robot);
    let truth = case.dag.add(energies.bodies, energies.rotors);
    case.misprint(&[printed], &[corrected], &[truth]);
}

#[test]
fn eq_2_40_turns_gravity_round() {
    let mut case = Case::new("tulip_leg6");
    let solution = newton_euler::eliminate(&mut case.dag, &case.robot);
    let bodies: Vec<_> = case.robot.links.values().map(|link| link.body).collect();
    let mut printed = case.dag.zero();
    for (body, motion) in bodies.iter().zip(&solution.motions) {
        let Some(body) = body else { continue };
        let height = dot(&mut case.dag, case.robot.gravity, motion.position);
        let weight = case.dag.mul(body.mass, height);
        printed = case.dag.add(printed, weight);
    }
    let corrected = case.dag.neg(printed);
    let [q, _, _] = case.coordinates();
    let slopes = [printed, corrected]
        .map(|potential| q.iter().map(|&q| case.by(potential, q)).collect::<Vec<_>>());
    let truth = case.derive(Method::NewtonEuler).gravity;
    case.misprint(&slopes[0], &slopes[1], &truth);
}

#[test]
fn eq_2_42_shows_another_coriolis_matrix_with_the_same_product() {
    let mut case = Case::pendulum();
    let [printed, christoffel] = [CoriolisForm::AsPrinted, CoriolisForm::Christoffel]
        .map(|form| derive_with(&mut case.dag, &case.robot, form));
    case.let_text("h", "m2*l1*c2*sin(th2)");
    let literal = case.read_all(["-2*h*th2d", "-h*th2d", "h*(th1d - th2d/2)", "h*th1d/2"]);
    let corrected = case.read_all(["-h*th2d", "-h*(th1d + th2d)", "h*th1d", "0"]);
    assert!(case.equal(&printed.coriolis_matrix.concat(), &literal));
    assert!(case.equal(&christoffel.coriolis_matrix.concat(), &corrected));
    assert!(!case.equal(&literal, &corrected));
    assert!(case.equal(&printed.inverse_dynamics, &christoffel.inverse_dynamics));
    // dD/dt - 2 C is skew for the Christoffel matrix alone
    let entries: [ExprId; 4] = christoffel.mass_matrix.concat().try_into().expect("two joints");
    let rates = case.in_time(entries);
    let mut skew = |c: [ExprId; 4]| {
        let twice = c.map(|entry| case.dag.add(entry, entry));
        let n: Vec<_> = rates.iter().zip(twice).map(|(&d, c)| case.dag.sub(d, c)).collect();
        let zero = case.dag.zero();
        let sums = [(0, 0), (3, 3), (1, 2)].map(|(i, j)| case.dag.add(n[i], n[j]));
        case.equal(&sums, &[zero; 3])
    };
    assert!(skew(corrected));
    assert!(!skew(literal));
}

/// The position h of the pendulum's tip, and W = (dh/dq)^T by rows: one column a direction.
fn tip(case: &mut Case) -> ([ExprId; 2], [[ExprId; 2]; 2]) {
    let h = case.read_all(["l1*cos(th1) + l2*cos(th1 + th2)", "l1*sin(th1) + l2*sin(th1 + th2)"]);
    let [q, _, _] = case.coordinates();
    (h, [0, 1].map(|joint| h.map(|height| case.by(height, q[joint]))))
}

/// `A v` for two rows.
fn times(case: &mut Case, a: [[ExprId; 2]; 2], v: [ExprId; 2]) -> [ExprId; 2] {
    a.map(|row| {
        let [x, y] = [0, 1].map(|k| case.dag.mul(row[k], v[k]));
        case.dag.add(x, y)
    })
}

fn transposed(a: [[ExprId; 2]; 2]) -> [[ExprId; 2]; 2] {
    [[a[0][0], a[1][0]], [a[0][1], a[1][1]]]
}

fn pair(list: &[ExprId]) -> [ExprId; 2] {
    [list[0], list[1]]
}

#[test]
fn eq_2_49_differentiates_by_the_positions_what_the_rates_multiply() {
    let mut case = Case::pendulum();
    let (h, w) = tip(&mut case);
    let [q, qd, qdd] = case.coordinates().map(|list| pair(&list));
    let rates = case.in_time(h);
    let truth = case.in_time(rates);
    // W^T qdd + (d(W^T x)/dq) qd, where x is held: q in the text after (2.49), qd corrected
    let mut second_derivative = |held: [ExprId; 2]| {
        let symbols = ["x1", "x2"].map(|name| case.dag.symbol(name, SymbolClass::Geometry));
        let product = times(&mut case, transposed(w), symbols);
        let slopes = product.map(|entry| [0, 1].map(|k| case.by(entry, q[k])));
        let map = symbols.into_iter().zip(held).collect();
        let slopes = slopes.map(|row| pair(&substitute(&mut case.dag, &row, &map)));
        let convective = times(&mut case, slopes, qd);
        let accelerated = times(&mut case, transposed(w), qdd);
        [0, 1].map(|k| case.dag.add(accelerated[k], convective[k]))
    };
    let (printed, corrected) = (second_derivative(q), second_derivative(qd));
    case.misprint(&printed, &corrected, &truth);
}

#[test]
fn eq_2_50_forgets_gravity() {
    let mut case = Case::pendulum();
    let (_, w) = tip(&mut case);
    let [_, qd, qdd] = case.coordinates().map(|list| pair(&list));
    let result = case.derive(Method::Tmt);
    let force = ["lambda_x", "lambda_y"].map(|name| case.dag.symbol(name, SymbolClass::Effort));
    let held = times(&mut case, w, force);
    // the torque with which (2.48) holds
    let tau = [0, 1].map(|k| case.dag.sub(result.inverse_dynamics[k], held[k]));
    // first row of (2.50): D qdd - W lambda + C qd
    let [d, c] = [&result.mass_matrix, &result.coriolis_matrix]
        .map(|matrix| [pair(&matrix[0]), pair(&matrix[1])]);
    let (accelerated, moving) = (times(&mut case, d, qdd), times(&mut case, c, qd));
    let left = [0, 1].map(|k| {
        let sum = case.dag.add(accelerated[k], moving[k]);
        case.dag.sub(sum, held[k])
    });
    let corrected = [0, 1].map(|k| case.dag.sub(tau[k], result.gravity[k]));
    case.misprint(&tau, &corrected, &left);
}

#[test]
fn eq_2_52_and_2_53_forget_the_impulse() {
    let mut case = Case::pendulum();
    let (_, w) = tip(&mut case);
    let [_, before, _] = case.coordinates().map(|list| pair(&list));
    let mass_matrix = case.derive(Method::DhLagrange).mass_matrix;
    let d = [pair(&mass_matrix[0]), pair(&mass_matrix[1])];
    let restitution = case.dag.symbol("e", SymbolClass::Geometry);
    let minus_e = case.dag.neg(restitution);
    // With both directions held, (2.51) alone gives the rates after the impact: W^T is square.
    let after = before.map(|rate| case.dag.mul(minus_e, rate));
    let jump = [0, 1].map(|k| case.dag.sub(after[k], before[k]));
    let momentum = times(&mut case, d, jump);
    // the impulse that D (qd+ - qd-) = W Lambda asks for, by Cramer's rule: numerators and det W
    let minor = |dag: &mut Dag, [a, b]: [ExprId; 2], [c, d]: [ExprId; 2]| {
        let (ad, bc) = (dag.mul(a, d), dag.mul(b, c));
        dag.sub(ad, bc)
    };
    let columns = transposed(w);
    let impulse =
        [minor(&mut case.dag, momentum, columns[1]), minor(&mut case.dag, columns[0], momentum)];
    let determinant = minor(&mut case.dag, w[0], w[1]);

    // (2.52): D qd+ = D qd-, times det W
    let held = times(&mut case, w, impulse);
    let [d_after, d_before] = [after, before]
        .map(|rates| times(&mut case, d, rates).map(|entry| case.dag.mul(determinant, entry)));
    let corrected = [0, 1].map(|k| case.dag.add(d_before[k], held[k]));
    case.misprint(&d_before, &corrected, &d_after);
    // (2.53), second row: W^T qd+ = -e W qd-, which for a single contact row has no meaning
    let left = times(&mut case, transposed(w), after);
    let mut right =
        |w: [[ExprId; 2]; 2]| times(&mut case, w, before).map(|entry| case.dag.mul(minus_e, entry));
    let (printed, corrected) = (right(w), right(transposed(w)));
    case.misprint(&printed, &corrected, &left);
}

#[test]
fn section_2_3_2_counts_fourteen_rows_for_thirteen_bodies_and_twelve_joints() {
    let count = |name: &str| {
        let case = Case::new(name);
        let bodies = case.robot.links.values().filter(|link| link.body.is_some()).count();
        (bodies, case.robot.degrees_of_freedom())
    };
    // rows 6 and 13 of tables 3.1-3.3 are both the torso
    assert_eq!(count("tulip"), (14, 18));
    // a torso and two legs of six; the base has six freedoms, so that the joints are twelve
    assert_eq!(count("tulip_one_torso"), (13, 18));
}
