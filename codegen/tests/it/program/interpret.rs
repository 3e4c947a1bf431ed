//! The interpreters against plain floating point, and against each other.

use super::two_link::{PARAMETERS, functions, textbook};
use denavit_codegen::arena::{Handle, PrimaryMap};
use denavit_codegen::expr::{BinaryFunction, Dag, ExprId, Relation, SymbolClass, UnaryFunction};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::number::{Residue, ratio};
use denavit_codegen::program::{
    BatchEvaluator, Evaluator, LANES, Leaf, Program, Routine, ShapeMismatch, Slot, constant_values,
    lower, prelude_values,
};

/// A number in [-2, 2) from a written seed.
fn random(seed: u64, key: u64) -> f64 {
    let bits = Residue::scrambled(seed, key).value() >> 8;
    bits as f64 / (1_u64 << 53) as f64 * 4.0 - 2.0
}

fn random_vector(seed: u64, key: u64) -> [f64; 2] {
    [random(seed, 2 * key), random(seed, 2 * key + 1)]
}

fn two_link() -> (Program, [f64; 8]) {
    let (dag, functions) = functions();
    let program = lower(&dag, &functions).unwrap();
    (program, [2.0, 1.5, 0.7, 0.3, 0.25, 0.08, 0.05, 9.81])
}

fn prelude_of(program: &Program, values: [f64; 8]) -> Vec<f64> {
    let value_of = |name: &String| {
        let row = PARAMETERS.iter().position(|(known, _)| known == name).unwrap();
        values[row]
    };
    let parameters: Vec<f64> = program.parameters.iter().map(value_of).collect();
    prelude_values(program, &parameters).unwrap()
}

#[test]
fn the_two_link_arm_needs_the_textbooks_torque() {
    let (program, values) = two_link();
    let prelude = prelude_of(&program, values);
    let routine = program.find(FunctionName::InverseDynamics, None).unwrap();
    let mut evaluator = Evaluator::<f64>::new(routine, &prelude);
    let mut single = Evaluator::<f32>::new(routine, &prelude);
    for key in 0..50 {
        let [q, qd, qdd] = [1, 2, 3].map(|seed| random_vector(seed, key));
        let mut tau = [0.0; 2];
        evaluator.evaluate(&[&q, &qd, &qdd], &mut tau).unwrap();
        let expected = textbook(values, q, qd, qdd);
        let mut tau32 = [0.0_f32; 2];
        let [q, qd, qdd] = [q, qd, qdd].map(|v| v.map(|x| x as f32));
        single.evaluate(&[&q, &qd, &qdd], &mut tau32).unwrap();
        for row in 0..2 {
            assert!((tau[row] - expected[row]).abs() < 1e-13 * 40.0, "{tau:?} {expected:?}");
            assert!((f64::from(tau32[row]) - expected[row]).abs() < 1e-5 * 40.0);
        }
    }
}

/// One function of everything that is no ring operation, of a and b.
fn every_operation() -> (Dag, Function) {
    let mut dag = Dag::new();
    let a = dag.symbol("a", SymbolClass::Configuration);
    let b = dag.symbol("b", SymbolClass::Configuration);
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
    let mut entries: Vec<ExprId> = unary.map(|function| dag.unary(function, a)).to_vec();
    for function in [BinaryFunction::Atan2, BinaryFunction::Min, BinaryFunction::Max] {
        entries.push(dag.binary(function, a, b));
    }
    for relation in [Relation::Less, Relation::LessEqual, Relation::Equal] {
        let (then, otherwise) = (dag.integer(1), dag.integer(2));
        entries.push(dag.select(relation, a, b, then, otherwise));
    }
    entries.push(dag.pow(a, 7));
    let (sum, quotient) = (dag.add(a, b), dag.div(a, b));
    entries.push(dag.neg(sum));
    entries.push(quotient);
    let output = Output {
        name: "values",
        shape: vec![entries.len()],
        entries,
        doc: String::new(),
        details: Vec::new(),
    };
    let function = Function {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![Argument { name: "q", symbols: vec![a, b] }],
        outputs: vec![output],
        form: Form::Explicit,
    };
    (dag, function)
}

#[test]
fn every_operation_computes_what_its_name_says() {
    let (dag, function) = every_operation();
    let program = lower(&dag, &[function]).unwrap();
    let mut evaluator = Evaluator::<f64>::new(&program.routines[0], &[]);
    for (a, b) in [(0.5, 1.25), (1.25, 0.5), (0.75, 0.75), (2.5, -3.0)] {
        let mut values = vec![0.0; evaluator.outputs()];
        evaluator.evaluate(&[&[a, b]], &mut values).unwrap();
        let choice = |holds: bool| if holds { 1.0 } else { 2.0 };
        let a: f64 = a;
        let expected = [
            [a.sin(), a.cos(), a.tan(), a.sqrt(), a.exp(), a.ln(), a.tanh(), a.abs(), 1.0].to_vec(),
            [a.atan2(b), a.min(b), a.max(b), choice(a < b), choice(a <= b)].to_vec(),
            [choice(a == b), a.powi(7), -(a + b), a / b].to_vec(),
        ];
        for (value, expected) in values.iter().zip(expected.concat()) {
            let error = (value - expected).abs();
            assert!(error <= 4e-16 * expected.abs().max(1e-3), "{values:?} {expected}");
        }
    }
}

/// Interprets by walking the instructions of the SSA code, without registers that are used again.
fn walk(routine: &Routine, prelude: &[f64], arguments: &[&[f64]]) -> Vec<f64> {
    use denavit_codegen::program::{BinaryOperation as B, Instruction, Operation, UnaryOperation};
    use denavit_runtime::Scalar;
    let leaves: &PrimaryMap<Slot, Leaf> = &routine.code.leaves;
    let mut values = vec![f64::NAN; routine.code.slots];
    for (slot, leaf) in leaves.iter() {
        values[slot.index()] = match *leaf {
            Leaf::Constant(value) => value,
            Leaf::Prelude(row) => prelude[row],
            Leaf::Argument { argument, entry } => arguments[argument][entry],
            Leaf::Parameter(_) => unreachable!(),
        };
    }
    for instruction in &routine.code.instructions {
        match *instruction {
            Instruction::SinCos { sine, cosine, angle } => {
                let (s, c) = values[angle.index()].sincos();
                values[sine.index()] = s;
                values[cosine.index()] = c;
            }
            Instruction::Value { result, operation } => {
                values[result.index()] = match operation {
                    Operation::Unary(UnaryOperation::Neg, a) => -values[a.index()],
                    Operation::Binary(function, a, b) => {
                        let (a, b) = (values[a.index()], values[b.index()]);
                        match function {
                            B::Add => a + b,
                            B::Sub => a - b,
                            B::Mul => a * b,
                            B::Div => a / b,
                            _ => unreachable!("not in the arm"),
                        }
                    }
                    _ => unreachable!("not in the arm"),
                };
            }
        }
    }
    routine.code.outputs.iter().map(|output| values[output.index()]).collect()
}

#[test]
fn using_registers_again_changes_no_bit() {
    let (program, values) = two_link();
    let prelude = prelude_of(&program, values);
    for routine in &program.routines {
        let mut evaluator = Evaluator::<f64>::new(routine, &prelude);
        for key in 0..20 {
            let arguments = [1, 2, 3].map(|seed| random_vector(seed, key));
            let arguments: Vec<&[f64]> =
                arguments.iter().take(routine.arguments.len()).map(|a| &a[..]).collect();
            let mut found = vec![0.0; evaluator.outputs()];
            evaluator.evaluate(&arguments, &mut found).unwrap();
            let expected = walk(routine, &prelude, &arguments);
            assert_eq!(bits(&found), bits(&expected), "{}", routine.name);
        }
    }
}

fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|value| value.to_bits()).collect()
}

#[test]
fn a_batch_agrees_bit_for_bit_also_in_the_remainder() {
    let (program, values) = two_link();
    let prelude = prelude_of(&program, values);
    let (dag, function) = every_operation();
    let operations = lower(&dag, &[function]).unwrap();
    let routines = program.routines.iter().chain(&operations.routines);
    for routine in routines {
        let mut one = Evaluator::<f64>::new(routine, &prelude);
        let mut many = BatchEvaluator::<f64>::new(routine, &prelude);
        for samples in [0, 1, LANES - 1, LANES, LANES + 1, 3 * LANES + 5] {
            let inputs: Vec<Vec<f64>> = (0..many.inputs() as u64)
                .map(|column| (0..samples as u64).map(|k| random(column, k)).collect())
                .collect();
            let mut found = vec![vec![0.0; samples]; many.outputs()];
            let mut columns: Vec<&mut [f64]> = found.iter_mut().map(|c| &mut c[..]).collect();
            let inputs: Vec<&[f64]> = inputs.iter().map(|column| &column[..]).collect();
            many.evaluate(&inputs, &mut columns).unwrap();
            for sample in 0..samples {
                let arguments: Vec<[f64; 2]> = (0..routine.arguments.len())
                    .map(|a| [inputs[2 * a][sample], inputs[2 * a + 1][sample]])
                    .collect();
                let arguments: Vec<&[f64]> = arguments.iter().map(|a| &a[..]).collect();
                let mut expected = vec![0.0; one.outputs()];
                one.evaluate(&arguments, &mut expected).unwrap();
                let lane: Vec<f64> = found.iter().map(|column| column[sample]).collect();
                for (found, expected) in lane.iter().zip(&expected) {
                    let same = found.to_bits() == expected.to_bits();
                    assert!(same || (found.is_nan() && expected.is_nan()), "{lane:?} {expected:?}");
                }
            }
        }
    }
}

#[test]
fn wrong_lengths_are_refused_with_the_name_of_what_is_wrong() {
    let (program, values) = two_link();
    assert!(prelude_values(&program, &[1.0]).is_err());
    let prelude = prelude_of(&program, values);
    let routine = &program.routines[0];
    let mut evaluator = Evaluator::<f64>::new(routine, &prelude);
    let (v, mut out) = ([0.0; 2], [0.0; 2]);
    let fault = evaluator.evaluate(&[&v, &v[..1], &v], &mut out);
    assert_eq!(fault, Err(ShapeMismatch { of: "qd", expected: 2, found: 1 }));
    assert!(evaluator.evaluate(&[&v, &v], &mut out).is_err());
    assert!(evaluator.evaluate(&[&v, &v, &v], &mut out[..1]).is_err());
    let mut batch = BatchEvaluator::<f64>::new(routine, &prelude);
    let column = [0.0; 3];
    let mut inputs = [&column[..]; 6];
    inputs[4] = &column[..2];
    let mut outputs = [[0.0; 3]; 2];
    let mut outputs: Vec<&mut [f64]> = outputs.iter_mut().map(|c| &mut c[..]).collect();
    assert!(batch.evaluate(&inputs, &mut outputs).is_err());
}

#[test]
fn symbol_free_expressions_have_values() {
    let mut dag = Dag::new();
    let pi = dag.pi();
    let third = dag.constant(ratio(1, 3));
    let sixty_degrees = dag.mul(third, pi);
    let cosine = dag.cos(sixty_degrees);
    let two = dag.integer(2);
    let root = dag.unary(UnaryFunction::Sqrt, two);
    let values = constant_values(&dag, &[pi, cosine, root, third]);
    let expected = [std::f64::consts::PI, 0.5, std::f64::consts::SQRT_2, 1.0 / 3.0];
    for (value, expected) in values.iter().zip(expected) {
        assert!((value - expected).abs() < 2e-16, "{values:?}");
    }
}
