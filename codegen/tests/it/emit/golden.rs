//! Emitted text as it stands in the repository.
//!
//! `UPDATE_EXPECT=1 cargo test` writes the files anew; the difference then shows in review. The
//! package `denavit` compiles and runs them.

use denavit_codegen::build_script::{Request, source};
use denavit_codegen::derive::Flavour;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;
use std::path::Path;

/// A model's file, the name of the golden file, and what is emitted.
fn requests() -> [(&'static str, &'static str, Request); 3] {
    use FunctionName as F;
    let planar = vec![
        F::InverseDynamics,
        F::MassMatrix,
        F::DynamicsTerms,
        F::ForwardDynamics,
        F::LinkJacobian,
        F::KineticEnergy,
        F::BaseRegressor,
        F::BaseParameters,
    ];
    let scara = vec![F::InverseDynamics, F::MassMatrix, F::GravityVector, F::LinkTransforms];
    let awkward = vec![F::InverseDynamics, F::LinkJacobian, F::PotentialEnergy];
    let request = |flavour, functions| Request { flavour, functions, ..Request::default() };
    [
        ("models/planar_2r.json", "planar_2r", request(Flavour::Tunable, planar)),
        ("models/scara.json", "scara_baked", request(Flavour::Baked, scara)),
        ("tests/fixtures/models/awkward.json", "awkward", request(Flavour::Tunable, awkward)),
    ]
}

#[test]
fn emitted_text_is_the_text_in_the_repository() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    for (model, name, request) in requests() {
        let robot = model::read(model, &std::fs::read(root.join(model)).unwrap()).unwrap();
        let text = source(&robot, &request).unwrap();
        let path = root.join(format!("tests/golden/{name}.rs"));
        if std::env::var_os("UPDATE_EXPECT").is_some() {
            std::fs::write(&path, &text).unwrap();
        }
        let expected = std::fs::read_to_string(&path).unwrap_or_default();
        // Not assert_eq: it would print both texts.
        assert!(expected == text, "{} is not fresh; UPDATE_EXPECT=1 rewrites it", path.display());
    }
}
