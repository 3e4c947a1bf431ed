//! Operations one by one, and what calls refuse.

use crate::compare::compare;
use crate::robots::program;
use denavit_codegen::derive::Flavour;
use denavit_codegen::expr::{BinaryFunction, Dag, ExprId, Relation, SymbolClass, UnaryFunction};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::program::{Evaluate, EvaluateBatch, fuse, lower};
use denavit_jit::{Compiled, CompiledBatch};

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
    let mut program = lower(&dag, &[function]).unwrap();
    let kinds = [0.3, -1.7, 0.0, -0.0, f64::NAN, f64::INFINITY, -5e-324, 3e5, -1e300, 2.0];
    let kind = |sample: usize, column: usize| {
        // every pair of kinds in the first two columns
        let step = [1, kinds.len(), 7][column];
        kinds[(sample / step + column * sample / 3) % kinds.len()]
    };
    compare(&program, &[], kind);
    fuse(&mut program);
    compare(&program, &[], kind);
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
