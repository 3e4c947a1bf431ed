//! How long the compiler takes: from a model's text to functions, to a program, to Rust.

use criterion::{Criterion, criterion_group, criterion_main};
use denavit::derive::{Flavour, derive};
use denavit::emit::rust::module;
use denavit::function::FunctionName;
use denavit::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion};
use denavit::model::{self, Robot, bake};
use denavit::program::lower;
use denavit::regressor::{RegressorOptions, base_parameters, decompose_robot};
use std::hint::black_box;

const MODELS: [(&str, &str); 3] = [
    ("puma560", include_str!("../models/puma560.json")),
    ("tulip_leg6", include_str!("../models/tulip_leg6.json")),
    ("tulip", include_str!("../models/tulip.json")),
];

fn read(name: &str, text: &str) -> Robot {
    model::read(name, text.as_bytes()).expect("shipped models are right")
}

fn stages(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("compiler");
    group.sample_size(20);
    for (name, text) in MODELS {
        let robot = read(name, text);
        let derived = || {
            derive(&robot, Flavour::Tunable, &FunctionName::ALL).expect("tunable needs no value")
        };
        let derivation = derived();
        let lowered = || {
            lower(&derivation.dag, &derivation.functions)
                .expect("shipped models have small numbers")
        };
        let program = lowered();
        group.bench_function(format!("read/{name}"), |b| b.iter(|| read(name, black_box(text))));
        group.bench_function(format!("derive/{name}"), |b| b.iter(derived));
        group.bench_function(format!("lower/{name}"), |b| b.iter(lowered));
        group.bench_function(format!("emit/{name}"), |b| b.iter(|| module(&robot, &program)));
    }
    group.finish();
}

/// f and B of whole regressors: PUMA 560 with every term, TUlip without Coriolis terms.
fn decompositions(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("decompose");
    group.sample_size(10);
    for (name, text) in MODELS {
        let mut robot = read(name, text);
        robot.terms.coriolis = name != "tulip";
        group.bench_function(name, |b| {
            b.iter(|| {
                let mut expansion =
                    Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
                let options = RegressorOptions::default();
                decompose_robot(black_box(&robot), options, &Basis::ALL, &mut expansion)
                    .expect("it fits the memory")
            });
        });
    }
    group.finish();
}

/// Base parameters, with lengths as symbols and as numbers.
fn base(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("base parameters");
    group.sample_size(20);
    for (name, text) in MODELS {
        let robot = read(name, text);
        let numeric = bake(&robot).expect("shipped models have values");
        for (kind, robot) in [("symbolic", &robot), ("numeric", &numeric)] {
            let find = || base_parameters(robot, RegressorOptions::default(), &[]);
            find().expect("shipped models have base parameters");
            group.bench_function(format!("{kind}/{name}"), |b| b.iter(find));
        }
    }
    group.finish();
}

criterion_group!(benches, stages, decompositions, base);
criterion_main!(benches);
