//! How long a call takes: every emitted function, and beside them the interpreters and code that is
//! compiled in memory.
//!
//! Each measurement is of 64 calls with different inputs, in hot caches, or of 65536 samples in
//! columns; the throughput that is printed is calls or samples per second.

use criterion::measurement::WallTime;
use criterion::{
    BatchSize, BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main,
};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model;
use denavit_codegen::number::Residue;
use denavit_codegen::program::{
    BatchEvaluator, Evaluate, EvaluateBatch, Evaluator, Program, lower, parameter_defaults,
    prelude_values,
};
use denavit_jit::{Compiled, CompiledBatch};
use denavit_plants::batch::map_packs_in_parallel;
use denavit_runtime::map_packs;
use denavit_runtime::wide::f64x4;
use std::hint::black_box;

/// Made for this measurement alone.
mod tulip_leg6 {
    #![allow(dead_code, unreachable_pub)] // a user's module is public
    include!(concat!(env!("OUT_DIR"), "/tulip_leg6_dynamics.rs"));
}

const SAMPLES: usize = 64;

/// A number in [-1, 1), from a written seed.
fn number(seed: usize, key: usize) -> f64 {
    let bits = Residue::scrambled(seed as u64, key as u64).value() >> 8;
    bits as f64 / (1_u64 << 52) as f64 - 1.0
}

/// q, qd and a third vector of each sample.
fn samples<const N: usize>() -> Vec<[[f64; N]; 3]> {
    let vector = |seed| std::array::from_fn(|entry| number(seed, entry));
    (0..SAMPLES).map(|sample| [0, 1, 2].map(|row| vector(3 * sample + row))).collect()
}

fn measure<const N: usize, T>(
    group: &mut BenchmarkGroup<'_, WallTime>,
    name: &str,
    call: impl Fn(&[f64; N], &[f64; N], &[f64; N]) -> T,
) {
    let samples = samples::<N>();
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function(name, |b| {
        b.iter(|| {
            for [q, qd, x] in black_box(&samples) {
                black_box(call(q, qd, x));
            }
        });
    });
}

/// The functions that every robot has.
macro_rules! robot {
    ($criterion:ident, $module:path, $name:literal) => {{
        use $module as m;
        let p = &m::Parameters::<f64>::default();
        let mut group = $criterion.benchmark_group(concat!("emitted/", $name));
        let g = &mut group;
        measure(g, "inverse_dynamics", |q, v, x| m::inverse_dynamics(p, q, v, x));
        measure(g, "mass_matrix", |q, _, _| m::mass_matrix(p, q));
        measure(g, "coriolis_matrix", |q, v, _| m::coriolis_matrix(p, q, v));
        measure(g, "gravity_vector", |q, _, _| m::gravity_vector(p, q));
        measure(g, "bias", |q, v, _| m::bias(p, q, v));
        measure(g, "dynamics_terms", |q, v, _| m::dynamics_terms(p, q, v));
        measure(g, "forward_dynamics", |q, v, x| m::forward_dynamics(p, q, v, x));
        measure(g, "mass_matrix_solve", |q, _, x| m::mass_matrix_solve(p, q, x));
        measure(g, "inverse_dynamics_derivatives", |q, v, x| {
            m::inverse_dynamics_derivatives(p, q, v, x)
        });
        measure(g, "forward_dynamics_derivatives", |q, v, x| {
            m::forward_dynamics_derivatives(p, q, v, x)
        });
        measure(g, "link_transforms", |q, _, _| m::link_transforms(p, q));
        let last = m::Link::ALL[m::Link::ALL.len() - 1];
        measure(g, "link_jacobian", |q, _, _| m::link_jacobian(p, last, q));
        measure(g, "center_of_mass", |q, _, _| m::center_of_mass(p, q));
        measure(g, "center_of_mass_jacobian", |q, _, _| m::center_of_mass_jacobian(p, q));
        measure(g, "momentum", |q, v, _| m::momentum(p, q, v));
        measure(g, "kinetic_energy", |q, v, _| m::kinetic_energy(p, q, v));
        measure(g, "potential_energy", |q, _, _| m::potential_energy(p, q));
        group.finish();
    }};
}

fn emitted(criterion: &mut Criterion) {
    robot!(criterion, denavit_plants::emitted::puma560, "puma560");
    robot!(criterion, crate::tulip_leg6, "tulip_leg6");
    robot!(criterion, denavit_plants::emitted::tulip, "tulip");
    use denavit_plants::emitted::tulip as m;
    let p = &m::Parameters::<f64>::default();
    let mut group = criterion.benchmark_group("emitted/tulip");
    measure(&mut group, "contact_positions", |q, _, _| m::contact_positions(p, q));
    measure(&mut group, "contact_jacobian", |q, _, _| m::contact_jacobian(p, q));
    measure(&mut group, "contact_bias", |q, v, _| m::contact_bias(p, q, v));
    let f: [f64; 24] = std::array::from_fn(|entry| number(7, entry));
    let g = &mut group;
    measure(g, "contact_derivatives", |q, v, x| m::contact_derivatives(p, q, v, x, &f));
    measure(g, "center_of_mass_bias", |q, v, _| m::center_of_mass_bias(p, q, v));
    measure(g, "centroidal_momentum_matrix", |q, _, _| m::centroidal_momentum_matrix(p, q));
    measure(g, "centroidal_momentum_bias", |q, v, _| m::centroidal_momentum_bias(p, q, v));
    measure(g, "angular_momenta", |q, v, _| m::angular_momenta(p, q, v));
    measure(g, "zero_moment_point", |q, v, x| m::zero_moment_point(p, q, v, x));
    measure(g, "cart_table_zmp", |q, v, x| m::cart_table_zmp(p, q, v, x));
    let foot = m::Foot::ALL[0];
    measure(g, "foot_rotation_indicator", |q, v, x| m::foot_rotation_indicator(p, foot, q, v, x));
    measure(g, "capture_point", |q, v, _| m::capture_point(p, q, v));
    group.bench_function("parameters", |b| {
        b.iter_batched_ref(
            m::ModelParameters::<f64>::default,
            |model| m::Parameters::new(model),
            BatchSize::SmallInput,
        );
    });
    group.finish();
}

/// The program of a model and the values of its prelude.
fn program(name: &str, text: &str) -> (Program, Vec<f64>) {
    let robot = model::read(name, text.as_bytes()).expect("shipped models are right");
    let derivation = derive(&robot, Flavour::Tunable, &FunctionName::ALL).expect("tunable");
    let program = lower(&derivation.dag, &derivation.functions).expect("small numbers");
    let defaults = parameter_defaults(&program, &robot).into_iter().flatten();
    let prelude = prelude_values(&program, &defaults.collect::<Vec<f64>>()).expect("all given");
    (program, prelude)
}

/// Routines of models that are read at run time, by the interpreters and as compiled code.
fn at_run_time(criterion: &mut Criterion) {
    let puma560 = ("puma560", include_str!("../models/puma560.json"));
    let tulip = ("tulip", include_str!("../models/tulip.json"));
    let names = [
        FunctionName::InverseDynamics,
        FunctionName::MassMatrix,
        FunctionName::ForwardDynamics,
        FunctionName::DynamicsTerms,
    ];
    for (model, text) in [puma560, tulip] {
        let (program, prelude) = program(model, text);
        for name in names {
            let routine = program.find(name, None).expect("every robot has it");
            let label = format!("{model}/{name}");
            let lengths: Vec<usize> = routine.arguments.iter().map(|a| a.len).collect();
            let interpreted = &mut Evaluator::<f64>::new(routine, &prelude);
            let compiled = &mut Compiled::new(routine, &prelude).expect("a common processor");
            one(criterion, &format!("interpreted/one/{label}"), &lengths, interpreted);
            one(criterion, &format!("compiled/one/{label}"), &lengths, compiled);
            let interpreted = &mut BatchEvaluator::<f64>::new(routine, &prelude);
            let compiled = &mut CompiledBatch::new(routine, &prelude).expect("a common processor");
            many(criterion, &format!("interpreted/batch/{label}"), interpreted);
            many(criterion, &format!("compiled/batch/{label}"), compiled);
        }
        criterion.bench_function(&format!("compiling/{model}"), |b| {
            b.iter(|| {
                for routine in &program.routines {
                    black_box(Compiled::new(routine, &prelude).expect("a common processor"));
                }
            });
        });
    }
}

fn columns(inputs: usize) -> Vec<Vec<f64>> {
    (0..inputs).map(|e| (0..SAMPLES).map(|sample| number(sample, e)).collect()).collect()
}

fn one(criterion: &mut Criterion, name: &str, lengths: &[usize], routine: &mut dyn Evaluate) {
    let columns = columns(lengths.iter().sum());
    let rows: Vec<Vec<f64>> =
        (0..SAMPLES).map(|sample| columns.iter().map(|column| column[sample]).collect()).collect();
    let mut output = vec![0.0; routine.outputs()];
    let mut group = criterion.benchmark_group("run time");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function(name, |b| {
        b.iter(|| {
            for row in black_box(&rows) {
                let mut rest = &row[..];
                let mut vectors: [&[f64]; 3] = [&[]; 3];
                for (vector, &len) in vectors.iter_mut().zip(lengths) {
                    (*vector, rest) = rest.split_at(len);
                }
                let vectors = &vectors[..lengths.len()];
                routine.evaluate(vectors, &mut output).expect("lengths are right");
            }
        });
    });
    group.finish();
}

fn many(criterion: &mut Criterion, name: &str, routine: &mut dyn EvaluateBatch) {
    let columns = columns(routine.inputs());
    let inputs: Vec<&[f64]> = columns.iter().map(|column| &column[..]).collect();
    let mut outputs = vec![vec![0.0; SAMPLES]; routine.outputs()];
    let mut group = criterion.benchmark_group("run time");
    group.throughput(Throughput::Elements(SAMPLES as u64));
    group.bench_function(name, |b| {
        b.iter(|| {
            let mut columns: Vec<&mut [f64]> =
                outputs.iter_mut().map(|column| &mut column[..]).collect();
            routine.evaluate(black_box(&inputs), &mut columns).expect("lengths are right");
        });
    });
    group.finish();
}

/// A function of three vectors on 65536 samples, in packs of four: by one thread and by all.
macro_rules! log_of {
    ($criterion:ident, $module:path, $name:literal, $function:ident) => {{
        use $module as robot;
        const LONG: usize = 65_536;
        type Vector = [f64x4; robot::DOF];
        let column = |entry| (0..LONG).map(|sample| number(sample, entry)).collect();
        let columns: Vec<Vec<f64>> = (0..3 * robot::DOF).map(column).collect();
        let columns: Vec<&[f64]> = columns.iter().map(|column| &column[..]).collect();
        let inputs = [0, 1, 2].map(|row| &columns[row * robot::DOF..][..robot::DOF]);
        let parameters = robot::Parameters::<f64x4>::default();
        let function = |[q, qd, x]: [&Vector; 3]| robot::$function(&parameters, q, qd, x);
        let mut results = vec![vec![0.0; LONG]; robot::DOF];
        let mut outputs: Vec<&mut [f64]> =
            results.iter_mut().map(|column| &mut column[..]).collect();
        let mut group =
            $criterion.benchmark_group(concat!("log/", $name, "/", stringify!($function)));
        group.throughput(Throughput::Elements(LONG as u64));
        group.bench_function("one thread", |b| {
            b.iter(|| {
                map_packs(black_box(inputs), &mut outputs, function).expect("columns that fit")
            });
        });
        group.bench_function("all threads", |b| {
            b.iter(|| {
                map_packs_in_parallel(black_box(inputs), &mut outputs, function)
                    .expect("columns that fit");
            });
        });
        group.finish();
    }};
}

fn logs(criterion: &mut Criterion) {
    log_of!(criterion, denavit_plants::emitted::puma560, "puma560", inverse_dynamics);
    log_of!(criterion, denavit_plants::emitted::tulip, "tulip", inverse_dynamics);
    log_of!(criterion, denavit_plants::emitted::tulip, "tulip", forward_dynamics);
}

criterion_group!(benches, emitted, at_run_time, logs);
criterion_main!(benches);
