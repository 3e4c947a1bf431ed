//! Compiled code against the interpreters, bit for bit.

use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::effect;
use denavit_codegen::expr::{BinaryFunction, Dag, ExprId, Relation, SymbolClass, UnaryFunction};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::number::Residue;
use denavit_codegen::program::{
    Evaluate, EvaluateBatch, Evaluator, Program, Routine, fuse, lower, parameter_defaults,
    prelude_values,
};
use denavit_jit::{Compiled, CompiledBatch, Lanes};

/// A number in [-2, 2), from a written seed.
fn number(seed: usize, key: usize) -> f64 {
    let bits = Residue::scrambled(seed as u64, key as u64).value() >> 8;
    4.0 * bits as f64 / (1_u64 << 53) as f64 - 2.0
}

/// Equal bits, but NaN is one value: its bits are no promise.
fn same(left: &[f64], right: &[f64]) -> bool {
    let equal = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan());
    left.len() == right.len() && left.iter().zip(right).all(equal)
}

/// All routines of a program on samples of `value(sample, column)`.
fn compare(program: &Program, prelude: &[f64], value: impl Fn(usize, usize) -> f64) {
    const SAMPLES: usize = 23;
    for routine in &program.routines {
        let name = routine.full_name();
        let mut compiled = Compiled::new(routine, prelude).unwrap();
        let mut interpreted = Evaluator::new(routine, prelude);
        let columns: usize = routine.arguments.iter().map(|argument| argument.len).sum();
        let inputs: Vec<Vec<f64>> =
            (0..columns).map(|c| (0..SAMPLES).map(|k| value(k, c)).collect()).collect();
        let mut rows = Vec::new();
        for sample in 0..SAMPLES {
            let mut next = 0;
            let arguments: Vec<Vec<f64>> = routine
                .arguments
                .iter()
                .map(|argument| {
                    next += argument.len;
                    inputs[next - argument.len..next].iter().map(|c| c[sample]).collect()
                })
                .collect();
            let arguments: Vec<&[f64]> = arguments.iter().map(|a| &a[..]).collect();
            let mut found = vec![f64::NAN; Evaluate::outputs(&compiled)];
            let mut expected = found.clone();
            compiled.evaluate(&arguments, &mut found).unwrap();
            interpreted.evaluate(&arguments, &mut expected).unwrap();
            assert!(same(&found, &expected), "{name}: {found:?} {expected:?}");
            rows.push(expected);
        }
        for lanes in lanes() {
            compare_batch(routine, prelude, lanes, &inputs, &rows);
        }
    }
}

/// All numbers of lanes that this processor has.
fn lanes() -> Vec<Lanes> {
    let (there, missing): (Vec<Lanes>, Vec<Lanes>) =
        Lanes::ALL.into_iter().partition(|lanes| lanes.is_available());
    if !missing.is_empty() {
        eprintln!("not tested, as this processor does not have them: {missing:?}");
    }
    there
}

/// A batch of every number of samples up to 17, and of all; `rows` has the results of each sample.
fn compare_batch(
    routine: &Routine,
    prelude: &[f64],
    lanes: Lanes,
    inputs: &[Vec<f64>],
    rows: &[Vec<f64>],
) {
    let mut batch = CompiledBatch::with_lanes(routine, prelude, lanes).unwrap();
    assert_eq!(batch.lanes(), lanes);
    for samples in (0..18).chain([rows.len()]) {
        let given: Vec<&[f64]> = inputs.iter().map(|column| &column[..samples]).collect();
        let mut outputs = vec![vec![f64::NAN; samples]; EvaluateBatch::outputs(&batch)];
        let mut columns: Vec<&mut [f64]> = outputs.iter_mut().map(|c| &mut c[..]).collect();
        batch.evaluate(&given, &mut columns).unwrap();
        for (sample, expected) in rows[..samples].iter().enumerate() {
            let found: Vec<f64> = outputs.iter().map(|column| column[sample]).collect();
            let name = routine.full_name();
            let place = format!("{name}, {lanes:?}, sample {sample} of {samples}");
            assert!(same(&found, expected), "{place}: {found:?} {expected:?}");
        }
    }
}

fn program(model: &str, flavour: Flavour) -> (Program, Vec<f64>) {
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

/// TUlip's largest function has 28000 steps.
#[test]
fn tulip_has_the_bits_of_the_interpreters() {
    let (program, prelude) = program("tulip", Flavour::Baked);
    compare(&program, &prelude, number);
}

/// Each operation of the language on every kind of number, zeros of both signs and NaN among them.
#[test]
fn every_operation_has_the_bits_of_the_interpreter() {
    let mut dag = Dag::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| dag.symbol(name, SymbolClass::Configuration));
    let unary = [
        UnaryFunction::Sin,
        UnaryFunction::Cos,
        UnaryFunction::Tan,
        UnaryFunction::Sqrt,
        UnaryFunction::Exp,
        UnaryFunction::Log,
        UnaryFunction::Tanh,
        UnaryFunction::Abs,
        UnaryFunction::Sign,
    ];
    let mut outputs: Vec<ExprId> = unary.iter().map(|&function| dag.unary(function, a)).collect();
    for function in [BinaryFunction::Atan2, BinaryFunction::Min, BinaryFunction::Max] {
        outputs.push(dag.binary(function, a, b));
    }
    for relation in [Relation::Less, Relation::LessEqual, Relation::Equal] {
        outputs.push(dag.select(relation, a, b, c, a));
    }
    let (product, sum, difference) = (dag.mul(a, b), dag.add(a, b), dag.sub(a, c));
    let (quotient, negative) = (dag.div(a, b), dag.neg(c));
    let nested = dag.sin(sum);
    let fused = [dag.add(product, c), dag.sub(c, product), dag.sub(product, nested)];
    outputs.extend([product, sum, difference, quotient, negative, nested, a]);
    outputs.extend(fused);
    let argument = Argument { name: "q", symbols: vec![a, b, c] };
    let output = Output {
        name: "bias",
        shape: vec![outputs.len()],
        entries: outputs,
        doc: String::new(),
        details: Vec::new(),
    };
    let function = Function {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![argument],
        outputs: vec![output],
        form: Form::Plain,
    };
    let program = lower(&dag, &[function]).unwrap();
    let kinds = [0.3, -1.7, 0.0, -0.0, f64::NAN, f64::INFINITY, -5e-324, 3e5, -1e300, 2.0];
    compare(&program, &[], |sample, column| kinds[(sample * (column + 1) + column) % kinds.len()]);
}

#[test]
fn wrong_lengths_are_refused() {
    let (program, prelude) = program("scara", Flavour::Tunable);
    let routine = program.find(FunctionName::Bias, None).unwrap();
    let mut single = Compiled::new(routine, &prelude).unwrap();
    let mut outputs = [0.0; 4];
    let error = single.evaluate(&[&[0.0; 4], &[0.0; 3]], &mut outputs).unwrap_err();
    assert_eq!((error.of, error.expected, error.found), ("qd", 4, 3));
    assert!(single.evaluate(&[&[0.0; 4]], &mut outputs).is_err());
    assert!(single.evaluate(&[&[0.0; 4], &[0.0; 4]], &mut outputs[..3]).is_err());
    let mut batch = CompiledBatch::new(routine, &prelude).unwrap();
    let (long, short) = ([0.0; 6], [0.0; 5]);
    let inputs: [&[f64]; 8] = [&long, &long, &long, &long, &long, &long, &long, &short];
    let mut columns = [[0.0; 6]; 4];
    let mut columns: Vec<&mut [f64]> = columns.iter_mut().map(|c| &mut c[..]).collect();
    let error = batch.evaluate(&inputs, &mut columns).unwrap_err();
    assert_eq!((error.expected, error.found), (6, 5));
    assert!(batch.evaluate(&inputs[..7], &mut columns).is_err());
}

/// Memory of compiled code goes back with its last owner, and copies may be called from threads.
#[test]
fn copies_share_code_across_threads() {
    let (program, prelude) = program("scara", Flavour::Tunable);
    let routine = program.find(FunctionName::MassMatrix, None).unwrap();
    let compiled = Compiled::new(routine, &prelude).unwrap();
    let threads: Vec<_> = (0..4)
        .map(|_| {
            let mut own = compiled.clone();
            std::thread::spawn(move || {
                let mut mass = [0.0; 16];
                own.evaluate(&[&[0.1, 0.2, 0.3, 0.4]], &mut mass).unwrap();
                mass
            })
        })
        .collect();
    drop(compiled);
    let results: Vec<[f64; 16]> = threads.into_iter().map(|t| t.join().unwrap()).collect();
    assert!(results.iter().all(|mass| *mass == results[0]) && results[0][0] > 0.0);
}
