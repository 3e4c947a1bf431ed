//! All functions of robots.

use crate::compare::{compare, number};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::effect;
use denavit_codegen::function::FunctionName;
use denavit_codegen::program::{Program, fuse, lower, parameter_defaults, prelude_values};

pub(crate) fn program(model: &str, flavour: Flavour) -> (Program, Vec<f64>) {
    let path = format!("{}/../../models/{model}.json", env!("CARGO_MANIFEST_DIR"));
    let robot = effect::read_model(&path, &std::fs::read(&path).unwrap(), &[]).unwrap();
    let functions =
        [&FunctionName::ALL[..], &FunctionName::WALKING, &FunctionName::REGRESSORS].concat();
    let derivation = derive(&robot, flavour, &functions).unwrap();
    let program = lower(&derivation.dag, &derivation.functions).unwrap();
    let defaults = parameter_defaults(&program, &robot);
    let parameters: Vec<f64> = defaults.into_iter().map(Option::unwrap).collect();
    let prelude = prelude_values(&program, &parameters).unwrap();
    (program, prelude)
}

#[test]
fn robots_have_the_bits_of_the_interpreters() {
    for model in ["puma560", "tulip_leg6", "scara", "stanford"] {
        let (mut program, prelude) = program(model, Flavour::Tunable);
        compare(&program, &prelude, number);
        fuse(&mut program);
        compare(&program, &prelude, number);
    }
}

/// All that are shipped. TUlip's largest function has 28000 steps.
#[test]
fn all_shipped_robots_have_the_bits_of_the_interpreters() {
    let folder = format!("{}/../../models", env!("CARGO_MANIFEST_DIR"));
    let mut models: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .filter_map(|entry| entry.unwrap().file_name().into_string().ok())
        .filter_map(|name| name.strip_suffix(".json").map(str::to_owned))
        .collect();
    models.sort();
    assert!(models.len() > 10 && models.iter().any(|model| model == "tulip"));
    for model in models {
        let (program, prelude) = program(&model, Flavour::Baked);
        compare(&program, &prelude, number);
    }
}
