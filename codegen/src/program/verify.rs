//! What must hold of a program after every pass.
//!
//! The verifier runs in all profiles, release too: it takes one walk over the code, which is less
//! than any pass that it follows.

use super::{Code, Leaf, Program, Routine, Slot};
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
    let mut faults = prelude_faults(&program.prelude, program.parameters.len());
    for routine in &program.routines {
        faults.extend(routine_faults(routine, program.prelude.outputs.len()));
    }
    faults
}

/// The code of a prelude of so many parameters after a pass. A fault is one of the pass, which no
/// file leads to, so it ends the program: code that is wrong must not be emitted.
pub(super) fn expect_sound_prelude(pass: &str, prelude: &Code, parameters: usize) {
    expect_none(pass, &prelude_faults(prelude, parameters));
}

/// The same of a routine beside a prelude of so many values.
pub(super) fn expect_sound_routine(pass: &str, routine: &Routine, prelude_values: usize) {
    expect_none(pass, &routine_faults(routine, prelude_values));
}

fn expect_none(pass: &str, faults: &[Fault]) {
    assert!(faults.is_empty(), "the pass `{pass}` broke the program: {faults:?}");
}

fn prelude_faults(prelude: &Code, parameters: usize) -> Vec<Fault> {
    let mut faults = Vec::new();
    verify_code("prelude", prelude, &mut faults, |leaf| match leaf {
        Leaf::Constant(_) => true,
        Leaf::Parameter(row) => row < parameters,
        Leaf::Prelude(_) | Leaf::Argument { .. } => false,
    });
    faults
}

fn routine_faults(routine: &Routine, prelude_values: usize) -> Vec<Fault> {
    let mut faults = Vec::new();
    let name = routine.full_name();
    verify_code(&name, &routine.code, &mut faults, |leaf| match leaf {
        Leaf::Constant(_) => true,
        Leaf::Parameter(_) => false,
        Leaf::Prelude(row) => row < prelude_values,
        Leaf::Argument { argument, entry } => {
            routine.arguments.get(argument).is_some_and(|argument| entry < argument.len)
        }
    });
    let expected = routine.outputs.iter().map(super::OutputShape::len).sum();
    let found = routine.code.outputs.len();
    if expected != found {
        faults.push(Fault::OutputCount { code: name, expected, found });
    }
    faults
}

/// Sound code, which is all that passes make, is told by one tight loop; what is wrong is asked
/// only of code that is not.
fn verify_code(name: &str, code: &Code, faults: &mut Vec<Fault>, may_read: impl Fn(Leaf) -> bool) {
    if !is_sound(code, &may_read) {
        list_faults(name, code, faults, may_read);
    }
}

fn is_sound(code: &Code, may_read: impl Fn(Leaf) -> bool) -> bool {
    let leaves = code.leaves.len();
    if leaves > code.slots || !code.leaves.values().all(|&leaf| may_read(leaf)) {
        return false;
    }
    let mut assigned = vec![false; code.slots];
    assigned[..leaves].fill(true);
    let is_assigned =
        |assigned: &[bool], slot: Slot| assigned.get(slot.index()).copied().unwrap_or(false);
    for instruction in &code.instructions {
        let mut sound = true;
        instruction.for_each_operand(|operand| sound &= is_assigned(&assigned, operand));
        instruction.for_each_result(|result| match assigned.get_mut(result.index()) {
            Some(assigned) => sound &= !std::mem::replace(assigned, true),
            None => sound = false,
        });
        if !sound {
            return false;
        }
    }
    code.outputs.iter().all(|&output| is_assigned(&assigned, output))
}

fn list_faults(name: &str, code: &Code, faults: &mut Vec<Fault>, may_read: impl Fn(Leaf) -> bool) {
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
