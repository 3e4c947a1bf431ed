//! Programs of all instructions, at random: many values at a time, or few, results of every kind.

use crate::compare::{compare_routine, number};
use denavit_codegen::arena::{Handle, PrimaryMap};
use denavit_codegen::expr::Relation;
use denavit_codegen::function::{Form, FunctionName};
use denavit_codegen::program::{
    ArgumentShape, BinaryOperation, Code, FusedOperation, Instruction, Leaf, Operation,
    OutputShape, Routine, Slot, UnaryOperation,
};

/// Numbers from a seed.
struct Random {
    seed: usize,
    drawn: usize,
}

impl Random {
    fn below(&mut self, bound: usize) -> usize {
        self.drawn += 1;
        let share = (number(self.seed, self.drawn) + 2.0) / 4.0;
        ((share * bound as f64) as usize).min(bound - 1)
    }

    fn one_of<T: Copy>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())]
    }
}

/// What a program is drawn from.
#[derive(Clone, Copy, Debug)]
struct Size {
    arguments: usize,
    instructions: usize,
    /// Operands are among so many last values: how many are alive at a time.
    window: usize,
    outputs: usize,
}

const UNARY: [UnaryOperation; 8] = [
    UnaryOperation::Neg,
    UnaryOperation::Tan,
    UnaryOperation::Sqrt,
    UnaryOperation::Exp,
    UnaryOperation::Log,
    UnaryOperation::Tanh,
    UnaryOperation::Abs,
    UnaryOperation::Sign,
];

/// Those that keep numbers small come often.
const BINARY: [BinaryOperation; 10] = [
    BinaryOperation::Add,
    BinaryOperation::Sub,
    BinaryOperation::Mul,
    BinaryOperation::Add,
    BinaryOperation::Sub,
    BinaryOperation::Div,
    BinaryOperation::Atan2,
    BinaryOperation::Min,
    BinaryOperation::Max,
    BinaryOperation::Min,
];

const FUSED: [FusedOperation; 3] =
    [FusedOperation::ProductPlus, FusedOperation::ProductMinus, FusedOperation::MinusProduct];

const RELATIONS: [Relation; 3] = [Relation::Less, Relation::LessEqual, Relation::Equal];

const CONSTANTS: [f64; 8] = [0.0, -0.0, 1.0, -0.5, 3.25, 1e-300, 1e5, -7.0];

fn operation(
    random: &mut Random,
    calls: bool,
    slot: &mut impl FnMut(&mut Random) -> Slot,
) -> Operation {
    match random.below(10) {
        0..=1 => {
            let mut function = random.one_of(&UNARY);
            let is_called = |function| {
                use UnaryOperation::{Exp, Log, Tan, Tanh};
                matches!(function, Exp | Log | Tan | Tanh)
            };
            while !calls && is_called(function) {
                function = random.one_of(&UNARY);
            }
            Operation::Unary(function, slot(random))
        }
        2..=6 => {
            let mut function = random.one_of(&BINARY);
            while !calls && function == BinaryOperation::Atan2 {
                function = random.one_of(&BINARY);
            }
            Operation::Binary(function, slot(random), slot(random))
        }
        7..=8 => {
            let function = random.one_of(&FUSED);
            Operation::Fused(function, std::array::from_fn(|_| slot(random)))
        }
        _ => Operation::Select {
            relation: random.one_of(&RELATIONS),
            sides: std::array::from_fn(|_| slot(random)),
            then: slot(random),
            otherwise: slot(random),
        },
    }
}

fn routine(random: &mut Random, size: Size, calls: bool) -> Routine {
    let mut leaves = PrimaryMap::new();
    // the second argument has one number
    for entry in 0..size.arguments {
        leaves.push(Leaf::Argument { argument: 0, entry });
    }
    leaves.push(Leaf::Argument { argument: 1, entry: 0 });
    for constant in CONSTANTS {
        leaves.push(Leaf::Constant(constant));
    }
    leaves.push(Leaf::Prelude(0));
    let first = leaves.len();
    let mut next = first;
    let mut instructions = Vec::new();
    for _ in 0..size.instructions {
        let mut slot = |random: &mut Random| {
            let is_leaf = next == first || random.below(6) == 0;
            let index = match is_leaf {
                true => random.below(first),
                false => next - 1 - random.below(size.window.min(next - first)),
            };
            Slot::from_index(index)
        };
        if random.below(8) == 0 {
            let angle = slot(random);
            let (sine, cosine) = (Slot::from_index(next), Slot::from_index(next + 1));
            instructions.push(Instruction::SinCos { sine, cosine, angle });
            next += 2;
        } else {
            let operation = operation(random, calls, &mut slot);
            instructions.push(Instruction::Value { result: Slot::from_index(next), operation });
            next += 1;
        }
    }
    let output = |_| Slot::from_index(random.below(next));
    let outputs: Vec<Slot> = (0..size.outputs).map(output).collect();
    let split = size.outputs / 3;
    let shape =
        |shape: Vec<usize>| OutputShape { name: "o", shape, doc: String::new(), details: vec![] };
    Routine {
        name: FunctionName::Bias,
        link: None,
        arguments: vec![
            ArgumentShape { name: "a", len: size.arguments },
            ArgumentShape { name: "b", len: 1 },
        ],
        outputs: vec![shape(vec![split]), shape(vec![size.outputs - split])],
        form: Form::Plain,
        code: Code { leaves, instructions, outputs, slots: next },
    }
}

fn compare_programs(seeds: std::ops::Range<usize>, size: Size) {
    let (mut finite, mut all) = (0, 0);
    for seed in seeds {
        let mut random = Random { seed, drawn: 0 };
        let routine = routine(&mut random, size, seed % 3 == 0);
        let columns: Vec<Vec<f64>> = (0..=size.arguments)
            .map(|column| (0..21).map(|k| number(seed + k, 1000 + column)).collect())
            .collect();
        for row in compare_routine(&routine, &[0.75], &columns) {
            finite += row.iter().filter(|number| number.is_finite()).count();
            all += row.len();
        }
    }
    // Programs whose numbers are all lost would show nothing.
    assert!(5 * finite > 2 * all, "{finite} of {all} results are numbers, of {size:?}");
}

#[test]
fn short_programs() {
    compare_programs(0..300, Size { arguments: 3, instructions: 12, window: 6, outputs: 7 });
}

#[test]
fn programs_of_few_values_at_a_time() {
    compare_programs(1000..1040, Size { arguments: 8, instructions: 200, window: 10, outputs: 12 });
}

/// More values than registers: they go to memory and come back.
#[test]
fn programs_of_many_values_at_a_time() {
    compare_programs(
        2000..2040,
        Size { arguments: 20, instructions: 400, window: 90, outputs: 60 },
    );
}

#[test]
fn large_programs_of_many_results() {
    compare_programs(
        3000..3004,
        Size { arguments: 30, instructions: 5000, window: 700, outputs: 900 },
    );
}
