//! Passes rewrite code and are verified, each of them, in all profiles.
//!
//! What rewrites code is run through these functions and by no other way, so that the verifier
//! cannot be forgotten.

use super::verify::{expect_sound_prelude, expect_sound_routine};
use super::{Code, Routine};

/// A rewriting of code that keeps its outputs.
#[derive(Clone, Copy)]
pub(super) struct Pass {
    /// For messages.
    pub(super) name: &'static str,
    pub(super) rewrite: fn(&mut Code),
}

/// Runs passes on the prelude of so many parameters.
pub(super) fn run_on_prelude(passes: &[Pass], prelude: &mut Code, parameters: usize) {
    for pass in passes {
        (pass.rewrite)(prelude);
        expect_sound_prelude(pass.name, prelude, parameters);
    }
}

/// Runs passes on a routine beside a prelude of so many values.
pub(super) fn run_on_routine(passes: &[Pass], routine: &mut Routine, prelude_values: usize) {
    for pass in passes {
        (pass.rewrite)(&mut routine.code);
        expect_sound_routine(pass.name, routine, prelude_values);
    }
}

#[cfg(test)]
mod tests {
    use super::super::{BinaryOperation, FusedOperation, Instruction, Leaf, Operation, Slot};
    use super::*;
    use crate::arena::{Handle, PrimaryMap};
    use crate::function::{Form, FunctionName};
    use crate::program::{ArgumentShape, OutputShape};
    use std::panic::{AssertUnwindSafe, catch_unwind};

    /// s = sin a, c = cos a; the output is s c + p, fused.
    fn sound() -> Routine {
        let slot = Slot::from_index;
        let leaves = [Leaf::Argument { argument: 0, entry: 0 }, Leaf::Prelude(0)];
        let turn = Instruction::SinCos { sine: slot(2), cosine: slot(3), angle: slot(0) };
        let operation = Operation::Fused(FusedOperation::ProductPlus, [2, 3, 1].map(slot));
        let code = Code {
            leaves: leaves.into_iter().collect::<PrimaryMap<Slot, Leaf>>(),
            instructions: vec![turn, Instruction::Value { result: slot(4), operation }],
            outputs: vec![slot(4)],
            slots: 5,
        };
        let shape =
            OutputShape { name: "bias", shape: vec![1], doc: String::new(), details: Vec::new() };
        Routine {
            name: FunctionName::Bias,
            link: None,
            arguments: vec![ArgumentShape { name: "q", len: 1 }],
            outputs: vec![shape],
            form: Form::Explicit,
            code,
        }
    }

    /// What is said of a pass, if anything.
    fn message(name: &'static str, rewrite: fn(&mut Code)) -> Option<String> {
        let mut routine = sound();
        let run = || run_on_routine(&[Pass { name, rewrite }], &mut routine, 1);
        let fault = catch_unwind(AssertUnwindSafe(run)).err()?;
        fault.downcast_ref::<String>().cloned()
    }

    fn set_operand(code: &mut Code, operand: usize, slot: usize) {
        if let Instruction::Value { operation: Operation::Fused(_, operands), .. } =
            &mut code.instructions[1]
        {
            operands[operand] = Slot::from_index(slot);
        }
    }

    #[test]
    fn a_pass_that_breaks_code_is_stopped_in_every_profile() {
        assert_eq!(message("nothing", |_| ()), None);
        type Rewrite = fn(&mut Code);
        let broken: [(Rewrite, &str); 8] = [
            (|code| code.instructions.reverse(), "UsedBeforeAssigned"),
            (|code| code.instructions.truncate(0), "UsedBeforeAssigned"),
            (|code| set_operand(code, 2, 4), "UsedBeforeAssigned"),
            (|code| set_operand(code, 1, 9), "NoSuchSlot"),
            (|code| code.instructions.push(code.instructions[0]), "AssignedTwice"),
            (|code| code.leaves[Slot::from_index(1)] = Leaf::Prelude(1), "ForeignLeaf"),
            (|code| code.outputs.clear(), "OutputCount"),
            (|code| code.slots = 4, "NoSuchSlot"),
        ];
        for (rewrite, fault) in broken {
            let message = message("breaking", rewrite).expect(fault);
            assert!(message.starts_with("the pass `breaking` broke the program"), "{message}");
            assert!(message.contains(fault), "{fault}: {message}");
        }
    }

    #[test]
    fn a_pass_that_breaks_the_prelude_is_stopped_too() {
        let slot = Slot::from_index;
        let sum = Operation::Binary(BinaryOperation::Add, slot(0), slot(1));
        let mut prelude = Code {
            leaves: [Leaf::Parameter(0), Leaf::Parameter(1)].into_iter().collect(),
            instructions: vec![Instruction::Value { result: slot(2), operation: sum }],
            outputs: vec![slot(2)],
            slots: 3,
        };
        let nothing = Pass { name: "nothing", rewrite: |_| () };
        run_on_prelude(&[nothing], &mut prelude, 2);
        let foreign = AssertUnwindSafe(|| run_on_prelude(&[nothing], &mut prelude, 1));
        assert!(catch_unwind(foreign).is_err());
        let dropping = Pass { name: "dropping", rewrite: |code| code.instructions.clear() };
        let unassigned = AssertUnwindSafe(|| run_on_prelude(&[dropping], &mut prelude, 2));
        assert!(catch_unwind(unassigned).is_err());
    }
}
