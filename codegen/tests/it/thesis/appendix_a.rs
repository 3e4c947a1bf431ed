//! Appendix A: the double pendulum, A.1-A.77.

use super::Case;
use denavit_codegen::dynamics::methods::dh_lagrange::{Transform, row_transform};
use denavit_codegen::dynamics::methods::{Method, lagrange};
use denavit_codegen::expr::{ExprId, substitute};
use denavit_codegen::model::Convention;

/// A.17, by rows; printed again as A.34, A.49, A.75.
const A17: [&str; 4] = [
    "m1*c1^2 + m2*(l1^2 + c2^2 + 2*l1*c2*cos(th2)) + I1 + I2",
    "m2*(c2^2 + l1*c2*cos(th2)) + I2",
    "m2*(c2^2 + l1*c2*cos(th2)) + I2",
    "m2*c2^2 + I2",
];

/// A.18, corrected, by rows.
const A18: [&str; 4] =
    ["-m2*l1*c2*sin(th2)*th2d", "-m2*l1*c2*sin(th2)*(th1d + th2d)", "m2*l1*c2*sin(th2)*th1d", "0"];

/// The second entry of C as A.18, A.35, A.50 and A.76 print it.
const A18_PRINTED: &str = "-m2*l1*c2*th2d*sin(th2)*(th1d + th2d)";

/// A.19; printed again as A.36, A.51, A.77.
const A19: [&str; 2] =
    ["(m1*c1 + m2*l1)*g*cos(th1) + m2*c2*g*cos(th1 + th2)", "m2*c2*g*cos(th1 + th2)"];

/// Positions and angles of the two bodies, A.20-A.23, A.41-A.43.
const POSITIONS: [&str; 6] = [
    "c1*cos(th1)",
    "c1*sin(th1)",
    "th1",
    "l1*cos(th1) + c2*cos(th1 + th2)",
    "l1*sin(th1) + c2*sin(th1 + th2)",
    "th1 + th2",
];

#[test]
fn a17_to_a19_are_what_every_method_finds() {
    let mut case = Case::pendulum();
    let [mass_matrix, coriolis_matrix] = [A17, A18].map(|entries| case.read_all(entries));
    let gravity = case.read_all(A19);
    for method in Method::ALL {
        let result = case.derive(method);
        assert!(case.equal(&result.mass_matrix.concat(), &mass_matrix), "A.17, {method}");
        assert!(case.equal(&result.coriolis_matrix.concat(), &coriolis_matrix), "A.18, {method}");
        assert!(case.equal(&result.gravity, &gravity), "A.19, {method}");
    }
}

#[test]
fn a18_has_a_rate_too_many() {
    let mut case = Case::pendulum();
    let printed = case.read(A18_PRINTED);
    let corrected = case.read(A18[1]);
    for method in Method::ALL {
        let truth = case.derive(method).coriolis_matrix[0][1];
        case.misprint(&[printed], &[corrected], &[truth]);
    }
    let excess = case.read("m2*l1*c2*sin(th2)*(th1d + th2d)*(1 - th2d)");
    let difference = case.dag.sub(printed, corrected);
    assert!(case.equal(&[difference], &[excess]));
}

#[test]
fn a6_turns_the_second_body_with_the_first_angle_twice() {
    let mut case = Case::pendulum();
    let [x1, y1, _, x2, y2, _] = case.read_all(POSITIONS);
    let velocities = case.in_time([x1, y1, x2, y2]);
    let accelerations = case.in_time(velocities);
    for (name, value) in ["x1dd", "y1dd", "x2dd", "y2dd"].into_iter().zip(accelerations) {
        case.define(name, value);
    }
    // A.1-A.4, solved for the forces
    case.let_text("Fh2", "m2*x2dd");
    case.let_text("Fv2", "m2*y2dd + m2*g");
    case.let_text("Fh1", "m1*x1dd + Fh2");
    case.let_text("Fv1", "m1*y1dd + Fv2 + m1*g");
    // A.6 and A.5, solved for the torques
    let mut torques = |inertial: &str| {
        let levers = "Fh2*c2*sin(phi2) - Fv2*c2*cos(phi2)";
        case.let_text("tau2", &format!("{inertial} - ({levers})"));
        let levers = "Fh1*c1*sin(phi1) + Fh2*d1*sin(phi1) - Fv1*c1*cos(phi1) - Fv2*d1*cos(phi1)";
        [case.read(&format!("I1*phi1dd + tau2 - ({levers})")), case.read("tau2")]
    };
    let (printed, corrected) = (torques("I2*(phi1dd + phi2dd)"), torques("I2*phi2dd"));
    let truth = case.derive(Method::Lagrange).inverse_dynamics;
    case.misprint(&printed, &corrected, &truth);
    let excess = case.read("I2*th1dd");
    let difference = case.dag.sub(printed[1], corrected[1]);
    assert!(case.equal(&[difference], &[excess]));
}

#[test]
fn a11_to_a14_are_the_joints_differentiated_twice() {
    let mut case = Case::pendulum();
    let [x1, y1, _, x2, y2, _] = case.read_all(POSITIONS);
    for (name, value) in ["x1", "y1", "x2", "y2"].into_iter().zip([x1, y1, x2, y2]) {
        case.define(name, value);
        let [rate] = case.in_time([value]);
        let [second] = case.in_time([rate]);
        case.define(&format!("{name}dd"), second);
    }
    let zero = case.dag.zero();
    // A.7-A.10
    let residuals = case.read_all([
        "x1 - c1*cos(phi1)",
        "y1 - c1*sin(phi1)",
        "x1 + d1*cos(phi1) - (x2 - c2*cos(phi2))",
        "y1 + d1*sin(phi1) - (y2 - c2*sin(phi2))",
    ]);
    assert!(case.equal(&residuals, &[zero; 4]));
    let differentiated = case.read_all([
        "x1dd + c1*cos(phi1)*phi1d^2 + c1*sin(phi1)*phi1dd",
        "y1dd + c1*sin(phi1)*phi1d^2 - c1*cos(phi1)*phi1dd",
        "x1dd - d1*cos(phi1)*phi1d^2 - d1*sin(phi1)*phi1dd
            - (x2dd + c2*cos(phi2)*phi2d^2 + c2*sin(phi2)*phi2dd)",
        "y1dd - d1*sin(phi1)*phi1d^2 + d1*cos(phi1)*phi1dd
            - (y2dd + c2*sin(phi2)*phi2d^2 - c2*cos(phi2)*phi2dd)",
    ]);
    assert!(case.equal(&differentiated, &[zero; 4]));
}

#[test]
fn a26_and_a27_name_the_wrong_rates() {
    let mut case = Case::pendulum();
    let [x1, y1, _, x2, y2, _] = case.read_all(POSITIONS);
    let truth = case.in_time([x1, y1, x2, y2]);
    let first = case.read_all(["-c1*sin(th1)*th1d", "c1*cos(th1)*th1d"]);
    assert!(case.equal(&first, &truth[..2]), "A.24, A.25");
    let second = |first: &str, second: &str| {
        [
            format!("(-l1*sin(th1) - c2*sin(th1 + th2))*{first} - c2*sin(th1 + th2)*{second}"),
            format!("(l1*cos(th1) + c2*cos(th1 + th2))*{first} + c2*cos(th1 + th2)*{second}"),
        ]
    };
    let printed = second("phi1d", "phi2d").map(|source| case.read(&source));
    let corrected = second("th1d", "th2d").map(|source| case.read(&source));
    case.misprint(&printed, &corrected, &truth[2..]);
}

#[test]
fn a28_line_1_squares_the_wrong_sum() {
    let mut case = Case::pendulum();
    let [x1, y1, _, x2, y2, _] = case.read_all(POSITIONS);
    let rates = case.in_time([x1, y1, x2, y2]);
    for (name, rate) in ["x1d", "y1d", "x2d", "y2d"].into_iter().zip(rates) {
        case.define(name, rate);
    }
    let truth = lagrange::energies(&mut case.dag, &case.robot).bodies;
    let common = "m1*(x1d^2 + y1d^2) + m2*(x2d^2 + y2d^2) + I1*th1d^2";
    let printed = case.read(&format!("1/2*({common} + I2*(th2d + th2d^2))"));
    let corrected = case.read(&format!("1/2*({common} + I2*(th1d + th2d)^2)"));
    case.misprint(&[printed], &[corrected], &[truth]);
}

#[test]
fn a28_lines_2_and_3_name_the_wrong_rates() {
    let mut case = Case::pendulum();
    let truth = lagrange::energies(&mut case.dag, &case.robot).bodies;
    let mut lines = |first: &str, second: &str| {
        case.read(&format!(
            "1/2*(m1*c1^2 + m2*l1^2 + m2*c2^2 + 2*m2*l1*c2*cos(th2) + I1 + I2)*{first}^2
             + 1/2*(m2*c2^2 + I2)*{second}^2
             + (m2*c2^2 + m2*l1*c2*cos(th2) + I2)*{first}*{second}"
        ))
    };
    let (printed, corrected) = (lines("phi1d", "phi2d"), lines("th1d", "th2d"));
    case.misprint(&[printed], &[corrected], &[truth]);
}

#[test]
fn a30_takes_a_cosine_for_a_height() {
    let mut case = Case::pendulum();
    let truth = lagrange::energies(&mut case.dag, &case.robot).gravity;
    let [printed, corrected] = case.read_all([
        "m1*g*c1*cos(phi1) + m2*g*(l1*sin(th1) + c2*cos(th1 + th2))",
        "m1*g*c1*sin(th1) + m2*g*(l1*sin(th1) + c2*sin(th1 + th2))",
    ]);
    case.misprint(&[printed], &[corrected], &[truth]);
}

#[test]
fn a31_holds_for_relative_angles_not_for_absolute_ones() {
    let mut case = Case::pendulum();
    let energies = lagrange::energies(&mut case.dag, &case.robot);
    let (kinetic, potential) = (energies.bodies, energies.gravity);
    let truth = case.derive(Method::NewtonEuler).inverse_dynamics;
    let corrected = [0, 1].map(|i| case.lagrange_equation(kinetic, potential, i));

    // the same energies with q read as [phi1 phi2]: th2 becomes the difference of the angles
    let relative = case.read_all(["th1", "th2 - th1", "th1d", "th2d - th1d"]);
    let symbols = case.read_all(["th1", "th2", "th1d", "th2d"]);
    let map = symbols.into_iter().zip(relative).collect();
    let absolute = substitute(&mut case.dag, &[kinetic, potential], &map);
    let equations = [0, 1].map(|i| case.lagrange_equation(absolute[0], absolute[1], i));
    let back = case.read_all(["th1", "phi2", "th1d", "phi2d", "th1dd", "phi2dd"]);
    let symbols = case.read_all(["th1", "th2", "th1d", "th2d", "th1dd", "th2dd"]);
    let map = symbols.into_iter().zip(back).collect();
    let printed = substitute(&mut case.dag, &equations, &map);
    case.misprint(&printed, &corrected, &truth);
    // the forces that belong to absolute angles: tau1 - tau2 and tau2
    let forces = [case.dag.sub(truth[0], truth[1]), truth[1]];
    assert!(case.equal(&printed, &forces));
}

/// The sum of two vectors, if they are of one size.
fn sum(case: &mut Case, a: &[ExprId], b: &[ExprId]) -> Option<Vec<ExprId>> {
    let same = a.len() == b.len();
    same.then(|| a.iter().zip(b).map(|(&x, &y)| case.dag.add(x, y)).collect())
}

#[test]
fn a41_and_a42_add_a_joint_without_an_angle_to_a_body_with_one() {
    let mut case = Case::pendulum();
    let positions = case.read_all(POSITIONS);
    let joints = case.read_all(["0", "0", "l1*cos(th1)", "l1*sin(th1)"]);
    let bodies = case.read_all([
        "cos(th1)*c1 - sin(th1)*0",
        "sin(th1)*c1 + cos(th1)*0",
        "th1",
        "cos(th1 + th2)*c2 - sin(th1 + th2)*0",
        "sin(th1 + th2)*c2 + cos(th1 + th2)*0",
        "th1 + th2",
    ]);
    for i in 0..2 {
        let (joint, body) = (&joints[2 * i..2 * i + 2], &bodies[3 * i..3 * i + 3]);
        assert_eq!(sum(&mut case, joint, body), None, "as printed: j_i has two entries");
        let padded = [joint, &[case.dag.zero()]].concat();
        let corrected = sum(&mut case, &padded, body).expect("three entries each");
        assert!(case.equal(&corrected, &positions[3 * i..3 * i + 3]));
    }
}

#[test]
fn a46_needs_the_transposed_jacobian() {
    let mut case = Case::pendulum();
    let positions = case.read_all(POSITIONS);
    let masses = case.read_all(["m1", "m1", "I1", "m2", "m2", "I2"]);
    let [q, _, _] = case.coordinates();
    let jacobian = positions.map(|position| [0, 1].map(|j| case.by(position, q[j])));
    assert_ne!(jacobian[0].len(), masses.len(), "the printed product has no meaning");

    // A.45 without torques: tau = T^T (M (T qdd + g) - F)
    let weight = case.read_all(["0", "-m1*g", "0", "0", "-m2*g", "0"]);
    let rates = case.in_time(positions);
    let accelerations = case.in_time(rates);
    let torque = [0, 1].map(|j| {
        (0..6).fold(case.dag.zero(), |sum, row| {
            let inertial = case.dag.mul(masses[row], accelerations[row]);
            let force = case.dag.sub(inertial, weight[row]);
            let projected = case.dag.mul(jacobian[row][j], force);
            case.dag.add(sum, projected)
        })
    });
    let truth = case.derive(Method::DhLagrange).inverse_dynamics;
    assert!(case.equal(&torque, &truth));
}

#[test]
fn a46_as_printed_is_wrong_also_where_its_shapes_fit() {
    // A point mass at the end alone: x2 and y2 are as many coordinates as joints.
    let mut case = Case::pendulum();
    let result = case.derive(Method::NewtonEuler);
    let others = case.read_all(["m1", "I1", "I2"]);
    let nothing = case.dag.zero();
    let map = others.into_iter().map(|mass| (mass, nothing)).collect();
    let truth = substitute(&mut case.dag, &result.mass_matrix.concat(), &map);

    let [_, _, _, x2, y2, _] = case.read_all(POSITIONS);
    let [q, _, _] = case.coordinates();
    let t = [x2, y2].map(|position| [0, 1].map(|j| case.by(position, q[j])));
    let mass = case.read("m2");
    let mut product = |left: [[ExprId; 2]; 2]| {
        [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| {
            let [x, y] = [0, 1].map(|k| case.dag.mul(left[i][k], t[k][j]));
            let sum = case.dag.add(x, y);
            case.dag.mul(mass, sum)
        })
    };
    let printed = product(t);
    let corrected = product([[t[0][0], t[1][0]], [t[0][1], t[1][1]]]);
    case.misprint(&printed, &corrected, &truth);
}

/// A_1^0 and A_2^1 (A.52, A.53).
fn transforms(case: &mut Case) -> [Transform; 2] {
    let joints: Vec<_> = case.robot.links.values().map(|link| link.joint).collect();
    [0, 1].map(|i| row_transform(&mut case.dag, Convention::Standard, &joints[i]))
}

fn product(case: &mut Case, a: &Transform, b: &Transform) -> Transform {
    [0, 1, 2, 3].map(|row| {
        [0, 1, 2, 3].map(|column| {
            (0..4).fold(case.dag.zero(), |sum, k| {
                let term = case.dag.mul(a[row][k], b[k][column]);
                case.dag.add(sum, term)
            })
        })
    })
}

/// The inverse of a rigid transform: R^T and -R^T o.
fn inverse(case: &mut Case, a: &Transform) -> Transform {
    let mut inverse = *a;
    for row in 0..3 {
        let moved = (0..3).fold(case.dag.zero(), |sum, k| {
            inverse[row][k] = a[k][row];
            let term = case.dag.mul(a[k][row], a[k][3]);
            case.dag.add(sum, term)
        });
        inverse[row][3] = case.dag.neg(moved);
    }
    inverse
}

#[test]
fn a52_to_a59_place_the_frames_and_centres_of_mass() {
    let mut case = Case::pendulum();
    let [first, second] = transforms(&mut case);
    for (transform, angle, length) in [(first, "th1", "l1"), (second, "th2", "l2")] {
        let (cos, sin) = (format!("cos({angle})"), format!("sin({angle})"));
        let rows = [
            [cos.clone(), format!("-{sin}"), "0".into(), format!("{length}*{cos}")],
            [sin.clone(), cos, "0".into(), format!("{length}*{sin}")],
        ];
        let expected = rows.concat().iter().map(|entry| case.read(entry)).collect::<Vec<_>>();
        assert!(case.equal(&transform[..2].concat(), &expected), "A.52, A.53");
    }
    let tip = product(&mut case, &first, &second);
    let positions = case.read_all(POSITIONS);
    let bodies: Vec<_> = case.robot.links.values().filter_map(|link| link.body).collect();
    let centers = case.read_all(["c1 - l1", "c2 - l2"]);
    for (i, frame) in [first, tip].into_iter().enumerate() {
        assert!(case.equal(&[bodies[i].com[0]], &[centers[i]]), "A.56, A.57");
        let center = [0, 1].map(|row| {
            let turned = case.dag.mul(frame[row][0], centers[i]);
            case.dag.add(frame[row][3], turned)
        });
        assert!(case.equal(&center, &positions[3 * i..3 * i + 2]), "A.58, A.59");
    }
}

#[test]
fn a55_multiplies_the_inverse_transforms() {
    let mut case = Case::pendulum();
    let [first, second] = transforms(&mut case);
    let corrected = product(&mut case, &first, &second);
    let inverses = [first, second].map(|transform| inverse(&mut case, &transform));
    let printed = product(&mut case, &inverses[0], &inverses[1]);
    let truth = case.read_all([
        "cos(th1 + th2)",
        "-sin(th1 + th2)",
        "0",
        "l1*cos(th1) + l2*cos(th1 + th2)",
        "sin(th1 + th2)",
        "cos(th1 + th2)",
        "0",
        "l1*sin(th1) + l2*sin(th1 + th2)",
    ]);
    case.misprint(&printed[..2].concat(), &corrected[..2].concat(), &truth);
}

#[test]
fn a64_to_a66_are_the_columns_of_the_jacobians() {
    let mut case = Case::pendulum();
    let [x1, y1, _, x2, y2, _] = case.read_all(POSITIONS);
    let [q, _, _] = case.coordinates();
    let columns = case.read_all([
        "-c1*sin(th1)",
        "c1*cos(th1)",
        "-l1*sin(th1) - c2*sin(th1 + th2)",
        "l1*cos(th1) + c2*cos(th1 + th2)",
        "-c2*sin(th1 + th2)",
        "c2*cos(th1 + th2)",
    ]);
    let slopes = [(x1, 0), (y1, 0), (x2, 0), (y2, 0), (x2, 1), (y2, 1)]
        .map(|(position, j)| case.by(position, q[j]));
    assert!(case.equal(&columns, &slopes));
}

#[test]
fn a71_has_the_right_sign_only_with_a_vector_that_points_up() {
    let mut case = Case::pendulum();
    let [_, y1, _, _, y2, _] = case.read_all(POSITIONS);
    case.define("y1", y1);
    case.define("y2", y2);
    let truth = lagrange::energies(&mut case.dag, &case.robot).gravity;
    // g = [0 g 0], as A.71 says, is minus the acceleration of free fall
    let as_stated = case.read("m1*g*y1 + m2*g*y2");
    let free_fall = case.robot.gravity[1];
    case.define("gy", free_fall);
    let [printed, corrected] = case.read_all(["m1*gy*y1 + m2*gy*y2", "-(m1*gy*y1 + m2*gy*y2)"]);
    case.misprint(&[printed], &[corrected], &[truth]);
    assert!(case.equal(&[as_stated], &[truth]));
}
