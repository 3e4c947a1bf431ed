//! What must hold of a program after every pass.

use super::{Code, Leaf, Program, Routine};
use crate::arena::Handle;

/// A broken invariant: always the fault of the pass before, never of the user.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Fault {
    /// An instruction or output reads a slot that nothing has assigned yet.
    UsedBeforeAssigned {
        /// Name of the routine, or `prelude`.
        code: String,
        /// The slot.
        slot: usize,
    },
    /// A slot is assigned twice, or a leaf is assigned.
    AssignedTwice {
        /// Name of the routine, or `prelude`.
        code: String,
        /// The slot.
        slot: usize,
    },
    /// A slot is beyond the number of slots.
    NoSuchSlot {
        /// Name of the routine, or `prelude`.
        code: String,
        /// The slot.
        slot: usize,
    },
    /// A leaf names a parameter, prelude value or argument that there is not, or that this code
    /// may not read.
    ForeignLeaf {
        /// Name of the routine, or `prelude`.
        code: String,
        /// The leaf.
        slot: usize,
    },
    /// The number of outputs differs from what the shapes say.
    OutputCount {
        /// Name of the routine.
        code: String,
        /// Number of entries that the shapes have.
        expected: usize,
        /// Number of outputs that the code has.
        found: usize,
    },
}

/// The faults of a program; none of them, if our passes are right.
pub fn verify(program: &Program) -> Vec<Fault> {
    let mut faults = Vec::new();
    verify_code("prelude", &program.prelude, &mut faults, |leaf| match leaf {
        Leaf::Constant(_) => true,
        Leaf::Parameter(row) => row < program.parameters.len(),
        Leaf::Prelude(_) | Leaf::Argument { .. } => false,
    });
    for routine in &program.routines {
        verify_routine(program, routine, &mut faults);
    }
    faults
}

fn verify_routine(program: &Program, routine: &Routine, faults: &mut Vec<Fault>) {
    let name = routine.full_name();
    verify_code(&name, &routine.code, faults, |leaf| match leaf {
        Leaf::Constant(_) => true,
        Leaf::Parameter(_) => false,
        Leaf::Prelude(row) => row < program.prelude.outputs.len(),
        Leaf::Argument { argument, entry } => {
            routine.arguments.get(argument).is_some_and(|argument| entry < argument.len)
        }
    });
    let expected = routine.outputs.iter().map(super::OutputShape::len).sum();
    let found = routine.code.outputs.len();
    if expected != found {
        faults.push(Fault::OutputCount { code: name, expected, found });
    }
}

fn verify_code(name: &str, code: &Code, faults: &mut Vec<Fault>, may_read: impl Fn(Leaf) -> bool) {
    let mut assigned = vec![false; code.slots];
    for (slot, &leaf) in code.leaves.iter() {
        match assigned.get_mut(slot.index()) {
            Some(assigned) => *assigned = true,
            None => faults.push(Fault::NoSuchSlot { code: name.to_owned(), slot: slot.index() }),
        }
        if !may_read(leaf) {
            faults.push(Fault::ForeignLeaf { code: name.to_owned(), slot: slot.index() });
        }
    }
    for instruction in &code.instructions {
        instruction.for_each_operand(|operand| {
            faults.extend(unassigned(name, &assigned, operand.index()));
        });
        instruction.for_each_result(|result| {
            let (code, slot) = (name.to_owned(), result.index());
            match assigned.get_mut(slot) {
                None => faults.push(Fault::NoSuchSlot { code, slot }),
                Some(true) => faults.push(Fault::AssignedTwice { code, slot }),
                Some(assigned) => *assigned = true,
            }
        });
    }
    for output in &code.outputs {
        faults.extend(unassigned(name, &assigned, output.index()));
    }
}

fn unassigned(name: &str, assigned: &[bool], slot: usize) -> Option<Fault> {
    match assigned.get(slot) {
        Some(true) => None,
        Some(false) => Some(Fault::UsedBeforeAssigned { code: name.to_owned(), slot }),
        None => Some(Fault::NoSuchSlot { code: name.to_owned(), slot }),
    }
}
