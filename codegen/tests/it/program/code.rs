//! What code looks like: sharing, hoisting, order, counts, and the faults that are found in it.

use super::two_link::functions;
use denavit_codegen::arena::Handle;
use denavit_codegen::expr::{Dag, ExprId, SymbolClass};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::number::Rational;
use denavit_codegen::program::{
    Counts, Fault, Instruction, Leaf, LowerError, Operation, Slot, counts, fuse, lower, peak_live,
    schedule, verify,
};

fn function(arguments: &[ExprId], entries: &[ExprId]) -> Function {
    Function {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![Argument { name: "q", symbols: arguments.to_vec() }],
        outputs: vec![Output {
            name: "bias",
            shape: vec![entries.len()],
            entries: entries.to_vec(),
            doc: String::new(),
            details: Vec::new(),
        }],
        form: Form::Explicit,
    }
}

fn counts_of(dag: &Dag, function: Function) -> Counts {
    let program = lower(dag, &[function]).unwrap();
    counts(&program, &program.routines[0])
}

#[test]
fn sine_and_cosine_of_one_angle_are_one_operation() {
    let mut dag = Dag::new();
    let a = dag.symbol("a", SymbolClass::Configuration);
    let b = dag.symbol("b", SymbolClass::Configuration);
    let (sine, cosine, other) = (dag.sin(a), dag.cos(a), dag.cos(b));
    let found = counts_of(&dag, function(&[a, b], &[sine, cosine, other]));
    assert_eq!(found, Counts { sincos: 2, ..Counts::default() });
}

#[test]
fn powers_share_their_squares() {
    let mut dag = Dag::new();
    let a = dag.symbol("a", SymbolClass::Configuration);
    let powers = [2, 3, 4, 5, 8].map(|n| dag.pow(a, n));
    // a^2, a^3 = a^2 a, a^4 = (a^2)^2, a^5 = a^4 a, a^8 = (a^4)^2.
    let found = counts_of(&dag, function(&[a], &powers));
    assert_eq!(found, Counts { mul: 5, ..Counts::default() });
    // a^6 = (a^3)^2: a^2, a^3, a^6.
    let sixth = dag.pow(a, 6);
    assert_eq!(counts_of(&dag, function(&[a], &[sixth])).mul, 3);
}

#[test]
fn parameters_alone_are_computed_once_in_the_prelude_of_all_functions() {
    let (dag, functions) = functions();
    let program = lower(&dag, &functions).unwrap();
    // Of I1 + m1 c1^2 + m2 l1^2 + I2 + m2 c2^2, m2 c2^2 + I2, m2 l1 c2 and the two weights.
    let [torque, mass] = [0, 1].map(|row| counts(&program, &program.routines[row]));
    let run_time = |c: Counts| (c.mul, c.add, c.neg, c.div, c.sincos);
    // By hand: with x = h cos q2, D = [[x + p + d12, d12], [d12, d22]], d12 = x + d22. tau needs
    // four products with qdd, two with h and h itself, 2 qd1 qd2 + qd2^2, qd1^2, two weights.
    assert_eq!(run_time(mass), (1, 3, 0, 0, 1));
    let (mul, add, neg, div, sincos) = run_time(torque);
    // One of two opposite differences is stored, so the other is its negation.
    assert!(mul <= 16 && add <= 13 && neg <= 1 && (div, sincos) == (0, 3), "{torque:?}");
    for routine in &program.routines {
        let only_prelude = routine.code.leaves.values().all(|leaf| match leaf {
            Leaf::Parameter(_) => false,
            Leaf::Constant(_) | Leaf::Prelude(_) | Leaf::Argument { .. } => true,
        });
        assert!(only_prelude);
    }
    let shared: Vec<Vec<usize>> = program
        .routines
        .iter()
        .map(|routine| {
            let rows = routine.code.leaves.values().filter_map(|leaf| match leaf {
                Leaf::Prelude(row) => Some(*row),
                _ => None,
            });
            rows.collect()
        })
        .collect();
    assert!(shared[1].iter().all(|row| shared[0].contains(row)), "one prelude serves both");
}

#[test]
fn no_operation_is_lowered_that_is_no_output() {
    let mut dag = Dag::new();
    let a = dag.symbol("a", SymbolClass::Configuration);
    let p = dag.symbol("p", SymbolClass::Inertia);
    let (sum, product) = (dag.add(a, p), dag.mul(a, p));
    let _ = dag.mul(sum, product);
    assert_eq!(counts_of(&dag, function(&[a], &[sum])).total(), 1);
}

/// ((a b) c + d) and so on in a chain, against the sum of many products computed beforehand.
#[test]
fn the_schedule_keeps_values_short_lived() {
    let mut dag = Dag::new();
    let symbols: Vec<ExprId> =
        (0..40).map(|i| dag.symbol(&format!("x{i}"), SymbolClass::Configuration)).collect();
    let products: Vec<ExprId> = symbols.windows(2).map(|pair| dag.mul(pair[0], pair[1])).collect();
    let sum = products.iter().skip(1).fold(products[0], |sum, &p| dag.add(sum, p));
    let program = lower(&dag, &[function(&symbols, &[sum])]).unwrap();
    let code = &program.routines[0].code;
    // Each product is added as soon as it is there.
    assert_eq!(peak_live(code), 3);
    let mut reversed = code.clone();
    reversed.instructions.sort_by_key(|instruction| match instruction {
        Instruction::Value { result, .. } => result.index(),
        Instruction::SinCos { sine, .. } => sine.index(),
    });
    assert!(peak_live(&reversed) >= 39);
    assert_eq!(schedule(&reversed), code.instructions);
}

/// The sines that wait for nothing but arguments come first, so that they can be computed at once.
#[test]
fn sines_of_arguments_come_first() {
    let mut dag = Dag::new();
    let [a, b, c] = ["a", "b", "c"].map(|name| dag.symbol(name, SymbolClass::Configuration));
    let (sine, cosine, both) = (dag.sin(a), dag.cos(b), dag.add(a, b));
    let far = dag.sin(both);
    let product = dag.mul(c, sine);
    let late = dag.cos(product);
    let program = lower(&dag, &[function(&[a, b, c], &[product, cosine, far, late])]).unwrap();
    let kinds: Vec<bool> = (program.routines[0].code.instructions.iter())
        .map(|instruction| matches!(instruction, Instruction::SinCos { .. }))
        .collect();
    // a + b; then the sines of a, b and a + b; then c sin a; and its cosine.
    assert_eq!(kinds, [false, true, true, true, false, true]);
}

/// Products that one sum uses are taken in; a product of two users is computed once as before.
#[test]
fn products_of_one_user_are_fused() {
    let mut dag = Dag::new();
    let [a, b, c, d] = ["a", "b", "c", "d"].map(|n| dag.symbol(n, SymbolClass::Configuration));
    let (shared, own) = (dag.mul(a, b), dag.mul(c, d));
    let (sum, difference) = (dag.add(own, a), dag.sub(shared, c));
    let other = dag.add(shared, d);
    let mut program = lower(&dag, &[function(&[a, b, c, d], &[sum, difference, other])]).unwrap();
    let before = counts(&program, &program.routines[0]);
    fuse(&mut program);
    let code = &program.routines[0].code;
    assert_eq!(counts(&program, &program.routines[0]), before);
    // c d + a in one; a b, a b - c, a b + d.
    let fused = (code.instructions.iter())
        .filter(|instruction| {
            matches!(instruction, Instruction::Value { operation: Operation::Fused(..), .. })
        })
        .count();
    assert_eq!((fused, code.instructions.len()), (1, 4));
    assert!(verify(&program).is_empty());
}

#[test]
fn a_number_beyond_f64_is_an_error_and_not_an_infinity() {
    let mut dag = Dag::new();
    let a = dag.symbol("a", SymbolClass::Configuration);
    let huge = dag.constant(Rational::from_integer(num_bigint_power(400)));
    let product = dag.mul(a, huge);
    let error = lower(&dag, &[function(&[a], &[product])]).unwrap_err();
    assert_eq!(error, LowerError::NotFinite { function: "bias".to_owned() });
    let (one, zero) = (dag.one(), dag.zero());
    let division = dag.div(one, zero);
    assert!(lower(&dag, &[function(&[a], &[division])]).is_err());
}

fn num_bigint_power(exponent: usize) -> num_bigint::BigInt {
    num_traits::pow(num_bigint::BigInt::from(10), exponent)
}

#[test]
fn the_verifier_finds_each_kind_of_fault() {
    let (dag, functions) = functions();
    let sound = lower(&dag, &functions).unwrap();
    assert_eq!(verify(&sound), []);
    let code = "mass_matrix".to_owned();

    let mut swapped = sound.clone();
    swapped.routines[1].code.instructions.reverse();
    assert!(matches!(verify(&swapped)[0], Fault::UsedBeforeAssigned { .. }));

    let mut twice = sound.clone();
    let again = twice.routines[1].code.instructions[0];
    twice.routines[1].code.instructions.push(again);
    assert!(matches!(verify(&twice)[..], [Fault::AssignedTwice { .. }, ..]));

    let mut foreign = sound.clone();
    foreign.routines[1].code.leaves[Slot::from_index(0)] = Leaf::Parameter(0);
    assert_eq!(verify(&foreign), [Fault::ForeignLeaf { code: code.clone(), slot: 0 }]);

    let mut missing = sound.clone();
    missing.routines[1].code.outputs.pop();
    let expected = Fault::OutputCount { code: code.clone(), expected: 4, found: 3 };
    assert_eq!(verify(&missing), [expected]);

    let mut beyond = sound;
    beyond.routines[1].code.outputs[0] = Slot::from_index(1000);
    assert_eq!(verify(&beyond), [Fault::NoSuchSlot { code, slot: 1000 }]);
}
