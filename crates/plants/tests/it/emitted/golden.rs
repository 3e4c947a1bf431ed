//! Emitted text as it stands in the repository (the compiler's tests keep it fresh): compiled and
//! run; and what must hold of fresh text beside.

use super::flat::{Flat, Interpreted, bits, project, random_sample};
use denavit_codegen::build_script::{Request, generate, source};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;
use std::fs;
use std::process::Command;

#[allow(dead_code, unreachable_pub)] // a user's module is public
mod planar_2r {
    include!("../../../../../tests/golden/planar_2r.rs");
}

#[allow(dead_code, unreachable_pub)] // a user's module is public
mod scara_baked {
    include!("../../../../../tests/golden/scara_baked.rs");
}

/// Names that are words of the language, or those of emitted code itself.
#[deny(warnings)]
#[allow(dead_code, unreachable_pub)] // a user's module is public
mod awkward {
    include!("../../../../../tests/golden/awkward.rs");
}

/// tau of the arm of models/planar_2r.json, after the textbook: angles from the horizontal,
/// centres of mass 0.28 m and 0.23 m from their joints.
#[test]
fn the_planar_arm_needs_the_textbooks_torque() {
    use planar_2r as m;
    let (m1, m2, l1, c1, c2, i1, i2, g) = (2.0, 1.5, 0.5, 0.28, 0.23, 0.04, 0.03, 9.81);
    let ([q1, q2], [v1, v2], [a1, a2]) = ([0.7_f64, -1.1_f64], [1.5, -0.8], [2.0, 3.5]);
    let h = m2 * l1 * c2 * q2.sin();
    let d22 = i2 + m2 * c2 * c2;
    let d12 = d22 + m2 * l1 * c2 * q2.cos();
    let d11 = i1 + m1 * c1 * c1 + m2 * l1 * l1 + d22 + 2.0 * m2 * l1 * c2 * q2.cos();
    let g2 = m2 * c2 * g * (q1 + q2).cos();
    let g1 = (m1 * c1 + m2 * l1) * g * q1.cos() + g2;
    let tau = [
        d11 * a1 + d12 * a2 - h * (2.0 * v1 * v2 + v2 * v2) + g1,
        d12 * a1 + d22 * a2 + h * v1 * v1 + g2,
    ];
    let p = m::Parameters::<f64>::default();
    let found = m::inverse_dynamics(&p, &[q1, q2], &[v1, v2], &[a1, a2]);
    let back = m::forward_dynamics(&p, &[q1, q2], &[v1, v2], &tau);
    let terms = m::dynamics_terms(&p, &[q1, q2], &[v1, v2]);
    for row in 0..2 {
        assert!((found[row] - tau[row]).abs() < 1e-13, "{found:?} {tau:?}");
        assert!((back[row] - [a1, a2][row]).abs() < 1e-12, "{back:?}");
        assert!((terms.gravity_vector[row] - [g1, g2][row]).abs() < 1e-13);
        assert!((terms.mass_matrix[row][1] - [d12, d22][row]).abs() < 1e-14);
    }
    let energy = 0.5 * (d11 * v1 * v1 + 2.0 * d12 * v1 * v2 + d22 * v2 * v2);
    assert!((m::kinetic_energy(&p, &[q1, q2], &[v1, v2]) - energy).abs() < 1e-14);
    // The tip of the second link.
    let jacobian = m::link_jacobian(&p, m::Link::Link2, &[q1, q2]);
    let across = -l1 * q1.sin() - 0.4 * (q1 + q2).sin();
    assert!(jacobian.concat().iter().any(|entry| (entry - across).abs() < 1e-15), "{jacobian:?}");
}

/// Y theta = tau in emitted code, and every number that of both interpreters, bit for bit.
#[test]
fn the_base_regressor_of_the_planar_arm_times_its_base_parameters_is_the_torque() {
    use FunctionName as F;
    use planar_2r as m;
    let wanted = [
        F::InverseDynamics,
        F::MassMatrix,
        F::DynamicsTerms,
        F::ForwardDynamics,
        F::LinkJacobian,
        F::KineticEnergy,
        F::BaseRegressor,
        F::BaseParameters,
    ];
    let interpreted = Interpreted::new("planar_2r", Flavour::Tunable, &wanted);
    let p = m::Parameters::<f64>::default();
    let theta = m::base_parameters(&p);
    for seed in 0..20 {
        let sample = random_sample(seed, m::DOF);
        let arguments: Vec<&[f64]> = sample.iter().map(|vector| &vector[..]).collect();
        let [q, qd, qdd]: [[f64; m::DOF]; 3] =
            [0, 1, 2].map(|row| std::array::from_fn(|entry| sample[row][entry]));
        let regressor = m::base_regressor(&p, &q, &qd, &qdd);
        let tau = m::inverse_dynamics(&p, &q, &qd, &qdd);
        for (row, tau) in regressor.iter().zip(tau) {
            let sum: f64 = row.iter().zip(theta).map(|(entry, value)| entry * value).sum();
            assert!((sum - tau).abs() < 1e-12, "{sum}, not {tau}");
        }
        for (name, found, arguments) in [
            (F::BaseRegressor, regressor.flat(), &arguments[..]),
            (F::BaseParameters, theta.flat(), &[]),
        ] {
            let routine = interpreted.routine(name, None);
            assert_eq!(bits(&found), bits(&interpreted.one(routine, arguments)), "{name}");
            let lanes = interpreted.many(routine, std::slice::from_ref(&sample));
            assert_eq!(bits(&lanes[0]), bits(&found), "{name} in a batch");
        }
    }
}

/// A SCARA arm carries the weight of quill and wrist (1.8 kg) on its third joint alone.
#[test]
fn the_baked_scara_arm_lifts_its_quill() {
    use scara_baked as m;
    let p = m::Parameters::<f64>::default();
    let q = [0.4, -0.9, -0.1, 0.3];
    let weight = 1.8 * 9.81;
    let gravity = m::gravity_vector(&p, &q);
    let lifted = m::inverse_dynamics(&p, &q, &[0.0; 4], &[0.0, 0.0, 2.0, 0.0]);
    for (joint, (gravity, lifted)) in gravity.into_iter().zip(lifted).enumerate() {
        let (held, moved) = if joint == 2 { (weight, weight + 3.6) } else { (0.0, 0.0) };
        assert!((gravity - held).abs() < 1e-14 && (lifted - moved).abs() < 1e-14);
    }
    assert!((m::mass_matrix(&p, &q)[2][2] - 1.8).abs() < 1e-15);
    assert_eq!(size_of::<m::Parameters<f64>>(), 0);
}

#[test]
fn emitting_again_from_another_directory_gives_the_same_bytes() {
    let temporary = std::path::Path::new(env!("CARGO_TARGET_TMPDIR"));
    for model in ["tulip", "puma560"] {
        let texts = ["here", "elsewhere"].map(|place| {
            let directory = temporary.join("same_bytes").join(place);
            fs::create_dir_all(&directory).unwrap();
            let copy = directory.join(format!("{model}.json"));
            fs::copy(project(&format!("models/{model}.json")), &copy).unwrap();
            let path = generate(&copy, &directory, &Request::default()).unwrap();
            assert!(path.ends_with(format!("{model}_dynamics.rs")));
            let text = fs::read(path).unwrap();
            let others = fs::read_dir(&directory).unwrap().count();
            assert!(others <= 4, "no unfinished file is left");
            text
        });
        assert!(texts[0] == texts[1], "{model}");
        assert!(!String::from_utf8_lossy(&texts[0]).contains("elsewhere"));
    }
}

/// Emitted text is laid out as rustfmt lays it out by default.
#[test]
fn rustfmt_has_nothing_to_change() {
    let directory = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("layout");
    fs::create_dir_all(&directory).unwrap();
    for (model, flavour) in [("tulip", Flavour::Tunable), ("puma560", Flavour::Baked)] {
        let model_text = fs::read(project(&format!("models/{model}.json"))).unwrap();
        let robot = model::read(model, &model_text).unwrap();
        let functions = [&FunctionName::ALL[..], &FunctionName::WALKING].concat();
        let request = Request { flavour, functions, ..Request::default() };
        let text = source(&robot, &request).unwrap();
        let path = directory.join(format!("{model}.rs"));
        fs::write(&path, &text).unwrap();
        // The default configuration, not the project's.
        fs::write(directory.join("rustfmt.toml"), "").unwrap();
        let arguments = ["--check", "--edition", "2024"];
        let output = match Command::new("rustfmt").args(arguments).arg(&path).output() {
            Ok(output) => output,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => return,
            Err(error) => panic!("{error}"),
        };
        let difference = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success(), "{}", difference.lines().take(30).collect::<String>());
    }
}
