//! Emitted C and C++: compiled without a warning, run, and compared bit by bit with the
//! interpreters, which have the bits of emitted Rust.

use super::compiled::{Build, Compiled, Language, Reference, compilers};
use super::recount::models;
use crate::robots::repository;
use denavit_codegen::derive::Flavour;
use denavit_codegen::effect;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{self, Robot};

/// States that each function is called on.
const SAMPLES: usize = 5;

fn all_functions() -> Vec<FunctionName> {
    [&FunctionName::ALL[..], &FunctionName::WALKING, &FunctionName::REGRESSORS].concat()
}

fn read(path: &std::path::Path) -> Robot {
    let file = path.to_string_lossy();
    model::read(&file, &std::fs::read(path).unwrap()).unwrap()
}

fn shipped(name: &str) -> Robot {
    read(&repository().join(format!("models/{name}.json")))
}

fn built(reference: &Reference, build: &Build) -> Compiled {
    Compiled::new(reference, build)
}

#[test]
fn c_has_the_bits_of_rust_on_every_shipped_model() {
    for path in models() {
        let robot = read(&path);
        let reference = Reference::new(&robot, Flavour::Tunable, &all_functions(), false);
        let samples = reference.samples(SAMPLES);
        for compiler in compilers(Language::C) {
            let build = Build { compiler, ..Build::default() };
            let found = built(&reference, &build).run::<f64>(&samples);
            reference.assert_bits(&found, &samples, &build);
        }
    }
}

#[test]
fn c_has_the_bits_of_rust_in_every_flavour() {
    for (name, flavour, is_fused) in [
        ("puma560", Flavour::Baked, false),
        ("scara", Flavour::Sparse, false),
        ("tulip_leg6", Flavour::Tunable, true),
    ] {
        let reference = Reference::new(&shipped(name), flavour, &FunctionName::ALL, is_fused);
        let samples = reference.samples(SAMPLES);
        for language in [Language::C, Language::Cpp] {
            for compiler in compilers(language) {
                let build = Build { language, compiler, optimisation: "-O1", ..Build::default() };
                let found = built(&reference, &build).run::<f64>(&samples);
                reference.assert_bits(&found, &samples, &build);
            }
        }
    }
}

/// No flag asks for exact products, and the processor has fused ones.
#[test]
fn no_flag_of_contraction_is_needed_with_all_instructions_of_the_processor() {
    let functions =
        [FunctionName::GravityVector, FunctionName::InverseDynamics, FunctionName::MassMatrix];
    let reference = Reference::new(&shipped("tulip"), Flavour::Baked, &functions, false);
    let samples = reference.samples(SAMPLES);
    for language in [Language::C, Language::Cpp] {
        for compiler in compilers(language) {
            let flags: [&[_]; 2] = [&["-march=native"], &["-march=native", "-ffp-contract=fast"]];
            // Where all is fast the pragma of the standard does not bind clang.
            let count = if compiler.starts_with("clang") { 1 } else { 2 };
            for defines in &flags[..count] {
                let build =
                    Build { language, compiler, optimisation: "-O3", defines, ..Build::default() };
                let found = built(&reference, &build).run::<f64>(&samples);
                reference.assert_bits(&found, &samples, &build);
            }
        }
    }
}

#[test]
fn floats_have_the_bits_of_rust_and_are_near_those_of_doubles() {
    for name in ["puma560", "planar_2r"] {
        let robot = shipped(name);
        let reference = Reference::new(&robot, Flavour::Tunable, &FunctionName::ALL, false);
        let samples = reference.samples(SAMPLES);
        for language in [Language::C, Language::Cpp] {
            let compiler = compilers(language)[0];
            let build = Build { language, compiler, real: "float", ..Build::default() };
            let found = built(&reference, &build).run::<f32>(&samples);
            reference.assert_bits(&found, &samples, &build);
            let found: Vec<f64> = found.iter().map(|&value| f64::from(value)).collect();
            reference.assert_near(&found, &samples, 1e-3);
        }
    }
}

#[test]
fn names_that_are_words_of_the_language_are_no_matter() {
    let path = repository().join("tests/fixtures/models/awkward.json");
    let text = std::fs::read_to_string(path).unwrap();
    let text = text.replace("\"live\"", "\"double\"").replace("\"live +", "\"double +");
    let text = text.replace("+ live\"", "+ double\"").replace("\"t1\"", "\"memcpy\"");
    let text = text.replace("t1 + ", "memcpy + ").replace("\"awkward\"", "\"namespace\"");
    let text = text.replace("\"k1\"", "\"S\"").replace("turns. */", "turns. */ ??/ \\\\");
    let robot = model::read("awkward.json", text.as_bytes()).unwrap();
    let reference = Reference::new(&robot, Flavour::Tunable, &all_functions(), false);
    let samples = reference.samples(SAMPLES);
    for language in [Language::C, Language::Cpp] {
        for compiler in compilers(language) {
            let build = Build { language, compiler, ..Build::default() };
            let found = built(&reference, &build).run::<f64>(&samples);
            reference.assert_bits(&found, &samples, &build);
        }
    }
}

/// A spring that ages: of a state and the time.
const BUNGEE: &str = r#"{"format": "denavit-effect/1", "name": "bungee", "title": "bungee cord",
    "description": "d", "source": "s", "kind": "state", "at": "joint",
    "parameters": {"k": {"unit": "torque/position", "description": "stiffness",
        "nominal": 0, "bounds": [0, null]},
        "aging": {"unit": "s", "description": "time of aging", "bounds": [1, null],
        "start": [100]}},
    "states": {"x": {"unit": "position", "rate": "(q - x)*exp(-t/aging)/aging",
        "initial": "q"}},
    "torque": "k*(q - x)*tanh(1 + abs(t)/aging)"}"#;

/// Effects have states, the time, and functions whose last bits are the platform's.
#[test]
fn effects_are_functions_of_time_and_states_as_in_rust() {
    let text = std::fs::read_to_string(repository().join("models/puma560.json")).unwrap();
    let mut file: serde_json::Value = serde_json::from_str(&text).unwrap();
    let at = |row: usize| file["links"][row]["name"].clone();
    file["effects"] = serde_json::json!([
        {"effect": "stribeck_exponential", "at": {"link": at(1)},
            "parameters": {"fs": 0.3, "vs": 0.05}},
        {"effect": "bungee", "at": {"link": at(2)}, "parameters": {"k": 4, "aging": 3}},
    ]);
    let bungee = effect::read("bungee.json", BUNGEE.as_bytes()).unwrap();
    let text = file.to_string();
    let robot = effect::read_model("puma560.json", text.as_bytes(), &[bungee]).unwrap();
    let reference = Reference::new(&robot, Flavour::Tunable, &FunctionName::ALL, false);
    let samples = reference.samples(SAMPLES);
    for language in [Language::C, Language::Cpp] {
        for compiler in compilers(language) {
            let build = Build { language, compiler, ..Build::default() };
            let found = built(&reference, &build).run::<f64>(&samples);
            reference.assert_near(&found, &samples, 1e-11);
        }
    }
}

/// Angles in every range of the reduction, and beside multiples of a quarter turn.
fn angles() -> Vec<f64> {
    let mut angles = vec![0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e5, -1e5];
    for exponent in -1074..1024 {
        let power = 2.0_f64.powi(exponent);
        angles.extend([power, -1.1 * power, 1.7 * power]);
    }
    for turns in 0..400 {
        let near = f64::from(turns * turns) * std::f64::consts::FRAC_PI_2;
        angles.extend([near, -near, near.next_up(), near.next_down()]);
    }
    // Of all doubles the one that is nearest to a multiple of a quarter turn.
    angles.push(6_381_956_970_095_103.0 * 2.0_f64.powi(797));
    angles
}

#[test]
fn every_angle_has_the_sine_of_rust() {
    let transforms = [FunctionName::LinkTransforms];
    let robot = shipped("planar_2r");
    let angles = angles();
    let samples: Vec<Vec<f64>> = angles.windows(2).map(<[f64]>::to_vec).collect();
    for is_fused in [false, true] {
        let reference = Reference::new(&robot, Flavour::Tunable, &transforms, is_fused);
        for language in [Language::C, Language::Cpp] {
            for compiler in compilers(language) {
                // The Rust of this test is built for any processor: it fuses nothing.
                let flags: &[&[_]] = if is_fused { &[&[]] } else { &[&[], &["-march=native"]] };
                for &defines in flags {
                    let optimisation = "-O3";
                    let build =
                        Build { language, compiler, optimisation, defines, ..Build::default() };
                    let found = built(&reference, &build).run::<f64>(&samples);
                    reference.assert_bits(&found, &samples, &build);
                }
            }
        }
    }
}

#[test]
fn the_platforms_sines_are_a_choice() {
    let reference =
        Reference::new(&shipped("puma560"), Flavour::Tunable, &FunctionName::ALL, false);
    let samples = reference.samples(SAMPLES);
    for language in [Language::C, Language::Cpp] {
        let compiler = compilers(language)[0];
        let build = Build {
            language,
            compiler,
            defines: &["-DPUMA560_PLATFORM_SINCOS"],
            ..Build::default()
        };
        let found = built(&reference, &build).run::<f64>(&samples);
        reference.assert_near(&found, &samples, 1e-11);
    }
}
