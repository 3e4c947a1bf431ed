//! The regression model: ranks that are known, and torques of another formulation.

use super::{INERTIAL, random_motion, robot, torques};
use denavit_codegen::regressor::RegressorOptions;
use denavit_codegen::regressor::functions::modelled;
use denavit_plants::regression::RegressionModel;
use denavit_plants::{LoadedPlant, Plant};

/// D qdd + bias + Coulomb friction of the simulator's plant, which knows no regressor.
fn plant_torques(name: &str, motion: &[Vec<f64>]) -> Vec<Vec<f64>> {
    torques_of(&robot(name), motion)
}

fn torques_of(robot: &denavit_codegen::model::Robot, motion: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let mut plant = LoadedPlant::new(robot, &[]).expect("it has every value");
    let n = motion.len() / 3;
    let samples = motion[0].len();
    let mut torques = vec![vec![0.0; samples]; n];
    let (mut mass, mut bias) = (vec![0.0; n * n], vec![0.0; n]);
    for k in 0..samples {
        let at = |first: usize| -> Vec<f64> { (0..n).map(|j| motion[first + j][k]).collect() };
        let (q, qd, qdd) = (at(0), at(n), at(2 * n));
        plant.mass_matrix(&q, &mut mass);
        plant.bias(&q, &qd, &mut bias);
        for j in 0..n {
            let inertial: f64 = (0..n).map(|i| mass[j * n + i] * qdd[i]).sum();
            let coulomb = plant.model().joints[j].coulomb * qd[j].signum();
            torques[j][k] = inertial + bias[j] + coulomb;
        }
    }
    torques
}

#[test]
fn rows_times_the_models_values_are_the_torques_of_the_plant() {
    for name in ["planar_2r", "double_pendulum", "puma560", "tulip_leg6", "stanford", "tulip"] {
        let robot = robot(name);
        let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect(name);
        let motion = random_motion(model.joints.len(), 37, 5);
        let phi = model.model_axes().expect("all values are given");
        let ours = torques(&model, &motion, &phi);
        let theirs = plant_torques(name, &motion);
        for (joint, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
            let size = theirs.iter().fold(1.0_f64, |size, tau| size.max(tau.abs()));
            for (a, b) in ours.iter().zip(theirs) {
                assert!((a - b).abs() < 1e-11 * size, "{name} {joint}: {a} {b}");
            }
        }
    }
}

/// math.md 6 and peers.md 5b: numbers of base parameters.
#[test]
fn ranks_are_those_that_are_known() {
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    for (name, options, expected) in [
        ("puma560", INERTIAL, 36),
        ("puma560", friction, 48),
        ("tulip_leg6", INERTIAL, 36),
        ("tulip_leg", INERTIAL, 14),
        ("tulip", INERTIAL, 94),
        ("scara", INERTIAL, 8),
    ] {
        let model = RegressionModel::new(&robot(name), options, &[]).expect(name);
        assert_eq!(model.rank(), expected, "{name}");
        assert_eq!(model.listed.len(), expected, "{name}");
    }
}

#[test]
fn the_thesis_products_are_columns_of_the_leg() {
    let model = RegressionModel::new(&robot("tulip_leg"), INERTIAL, &[]).expect("a model");
    assert_eq!(model.standard.len(), 17);
    // theta0 of the file's own numbers, by hand
    let at = |name: &str| model.standard.iter().position(|one| one.name == name);
    let values: Vec<f64> = model.parameters.iter().map(|one| one.value).collect();
    let standard = model.standard_values(&values);
    let product = at("c4x*m4").or(at("m4*c4x")).expect("the first moment of the thigh");
    assert!((standard[product] - 2.141 * 0.193).abs() < 1e-15);
    let phi = model.axes_of_standard(&standard);
    for (ours, given) in phi.iter().zip(model.model_axes().expect("all values are given")) {
        assert!((ours - given).abs() < 1e-12);
    }
}

/// pi of kept columns and phi on the axes are one another's exact images.
#[test]
fn the_change_of_basis_takes_values_to_values() {
    for name in ["puma560", "tulip", "tulip_leg"] {
        let robot = robot(name);
        let model = RegressionModel::new(&robot, modelled(&robot), &[]).expect(name);
        let pi: Vec<f64> = model.listed.iter().map(|one| one.value.expect("given")).collect();
        let phi = model.to_axes() * nalgebra::DVector::from_vec(pi.clone());
        let back = model.to_listed() * &phi;
        for (place, axis) in model.axes.iter().enumerate() {
            let given = axis.value.expect("given");
            assert!((phi[place] - given).abs() < 1e-9 * given.abs().max(1.0), "{}", axis.name);
            assert!((back[place] - pi[place]).abs() < 1e-6 * pi[place].abs().max(1.0));
        }
    }
}

#[test]
fn a_joint_parameter_that_is_not_asked_for_has_no_column() {
    let robot = robot("puma560");
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    let names = |options| -> Vec<String> {
        let model = RegressionModel::new(&robot, options, &[]).expect("a model");
        model.listed.into_iter().map(|one| one.name).collect()
    };
    assert!(names(all).contains(&"off_elbow".to_owned()));
    assert!(names(INERTIAL).iter().all(|name| !name.starts_with('f') && !name.starts_with("Ia")));
}

#[test]
fn columns_to_keep_are_checked() {
    let wrong = RegressionModel::new(&robot("scara"), INERTIAL, &["mass".to_owned()]);
    assert_eq!(wrong.expect_err("no base").kind(), denavit_plants::ErrorKind::Regression);
}

/// Where the first body is known, what remains of the second one's mass is a number times a symbol
/// whose value is 0: as many columns, another basis.
#[test]
fn a_known_body_before_one_on_its_axis_has_a_basis() {
    let shipped = denavit_plants::shipped::find("planar_2r").expect("shipped");
    let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
    let known = |value: f64| serde_json::json!({"value": value, "known": true});
    let body = &mut text["links"][0]["body"];
    body["mass"] = known(2.0);
    body["com"] = [known(-0.22), known(0.0), known(0.0)].into();
    text["links"][1]["body"]["com"][1] = known(0.0);
    let robot = denavit_codegen::model::read("arm", text.to_string().as_bytes()).expect("sound");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    // by hand: the moment of inertia of the first, mass and two moments of the second
    assert_eq!(model.rank(), 4);
    let motion = random_motion(2, 30, 8);
    let ours = torques(&model, &motion, &model.model_axes().expect("it has values"));
    let theirs = torques_of(&robot, &motion);
    for (joint, (ours, theirs)) in ours.iter().zip(&theirs).enumerate() {
        for (a, b) in ours.iter().zip(theirs) {
            assert!((a - b).abs() < 1e-9, "joint {joint}: {a} {b}");
        }
    }
}

/// A centre of mass that is known to be on an axis makes columns depend on others; the rows times
/// the values of the model are still its torques.
#[test]
fn numbers_of_bodies_that_are_known_to_be_0_are_no_symbols() {
    let shipped = denavit_plants::shipped::find("planar_2r").expect("shipped");
    let known = |value: f64| serde_json::json!({"value": value, "known": true});
    let com = |x: serde_json::Value, y: serde_json::Value| serde_json::json!([x, y, 0]);
    let bodies = [
        (com((-0.17).into(), known(0.0)), 5),
        (com(known(-0.17), known(0.0)), 5),
        (com(known(0.0), known(0.0)), 5),
        // the mass of the second link is on its axis
        (com(known(-0.4), known(0.0)), 4),
    ];
    for (com, rank) in bodies {
        let mut text: serde_json::Value = serde_json::from_str(shipped.text).expect("JSON");
        text["links"][1]["body"]["com"] = com.clone();
        let robot =
            denavit_codegen::model::read("arm", text.to_string().as_bytes()).expect("sound");
        let model = RegressionModel::new(&robot, INERTIAL, &[])
            .unwrap_or_else(|error| panic!("{com}: {error}"));
        assert_eq!(model.rank(), rank, "{com}");
        let motion = random_motion(2, 40, 6);
        let phi = model.model_axes().expect("it has values");
        let ours = torques(&model, &motion, &phi);
        let mut plant = denavit_plants::LoadedPlant::new(&robot, &[]).expect("values");
        for k in 0..40 {
            let at = |order: usize| [motion[2 * order][k], motion[2 * order + 1][k]];
            let ([q, qd], qdd) = ([at(0), at(1)], at(2));
            let (mut mass, mut bias) = ([0.0; 4], [0.0; 2]);
            denavit_plants::Plant::mass_matrix(&mut plant, &q, &mut mass);
            denavit_plants::Plant::bias(&mut plant, &q, &qd, &mut bias);
            for joint in 0..2 {
                let torque = mass[2 * joint] * qdd[0] + mass[2 * joint + 1] * qdd[1] + bias[joint];
                assert!((ours[joint][k] - torque).abs() < 1e-9, "{com}: joint {joint}");
            }
        }
    }
}
