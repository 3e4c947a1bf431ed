//! Operations one by one, and what calls refuse.

use crate::compare::{compare, lanes, number};
use crate::robots::program;
use denavit_codegen::derive::Flavour;
use denavit_codegen::expr::{BinaryFunction, Dag, ExprId, Relation, SymbolClass, UnaryFunction};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::program::{Evaluate, EvaluateBatch, fuse, lower};
use denavit_jit::{Compiled, CompiledBatch, CompiledRows, Lanes};

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

#[test]
fn wrong_rows_are_refused() {
    let (program, prelude) = program("scara", Flavour::Tunable);
    let routine = program.find(FunctionName::Bias, None).unwrap();
    assert!(CompiledRows::with_lanes(routine, &prelude, Lanes::Two).is_err());
    for lanes in lanes().into_iter().filter(|&lanes| lanes != Lanes::Two) {
        let mut code = CompiledRows::with_lanes(routine, &prelude, lanes).unwrap();
        let (given, mut room) = ([0.1; 36], [7.0; 36]);
        let mut call = |samples, first: usize, second: usize, length: usize| {
            code.evaluate(samples, &[&given[..first], &given[..second]], &mut [&mut room[..length]])
        };
        let error = call(9, 36, 35, 36).unwrap_err();
        assert_eq!((error.of, error.expected, error.found), ("qd", 36, 35));
        assert!(call(9, 36, 36, 32).is_err() && call(8, 36, 32, 32).is_err());
        assert!(call(8, 32, 32, 32).is_ok());
        assert!(code.evaluate(9, &[&given], &mut [&mut room]).is_err());
        assert!(code.evaluate(9, &[&given, &given], &mut []).is_err());
        // four numbers a sample: their number wraps to none
        assert!(code.evaluate(1 << 62, &[&[], &[]], &mut [&mut []]).is_err());
        // What is refused is not computed, and what is computed is within bounds.
        assert!(room[..32].iter().all(|&torque| torque != 7.0) && room[32..] == [7.0; 4]);
    }
}

/// Lanes that a processor does not have are refused, and all that it has may be asked for.
#[test]
fn lanes_are_those_of_the_processor() {
    let (program, prelude) = program("scara", Flavour::Tunable);
    let routine = program.find(FunctionName::Bias, None).unwrap();
    for lanes in Lanes::ALL {
        let made = CompiledBatch::with_lanes(routine, &prelude, lanes);
        assert_eq!(made.is_ok(), lanes.is_available(), "{lanes:?}");
    }
    let widest = CompiledBatch::new(routine, &prelude).unwrap().lanes();
    assert_eq!(Some(&widest), lanes().last());
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

/// Copies of a batch share code, and each has memory of its own for what registers do not hold.
#[test]
fn copies_of_a_batch_work_at_the_same_time() {
    let (program, prelude) = program("puma560", Flavour::Tunable);
    let routine = program.find(FunctionName::InverseDynamicsDerivatives, None).unwrap();
    for lanes in lanes() {
        let batch = CompiledBatch::with_lanes(routine, &prelude, lanes).unwrap();
        let run = |mut own: CompiledBatch, seed: usize| {
            let columns = |count: usize| vec![vec![0.0; 800]; count];
            let mut inputs = columns(own.inputs());
            for (at, column) in inputs.iter_mut().enumerate() {
                column.iter_mut().enumerate().for_each(|(k, q)| *q = number(seed + k, at));
            }
            let inputs: Vec<&[f64]> = inputs.iter().map(|column| &column[..]).collect();
            let mut outputs = columns(EvaluateBatch::outputs(&own));
            let mut slices: Vec<&mut [f64]> = outputs.iter_mut().map(|c| &mut c[..]).collect();
            for _ in 0..20 {
                own.evaluate(&inputs, &mut slices).unwrap();
            }
            outputs
        };
        let alone: Vec<_> = (0..3).map(|seed| run(batch.clone(), seed)).collect();
        let together: Vec<_> = std::thread::scope(|scope| {
            let start = |seed| {
                let own = batch.clone();
                scope.spawn(move || run(own, seed))
            };
            let threads: Vec<_> = (0..3).map(start).collect();
            threads.into_iter().map(|thread| thread.join().unwrap()).collect()
        });
        assert!(alone == together && alone[0] != alone[1], "{lanes:?}");
    }
}
