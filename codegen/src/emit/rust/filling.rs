//! Results that are filled entry by entry.
//!
//! An array that is written down as a whole, at the end, needs all its entries until then, and no
//! processor has registers for hundreds of them: each would be stored, read and stored again. So
//! the arrays of large results start as zeros, and each entry is assigned as soon as it is there.

use super::functions::array_of;
use crate::arena::Handle;
use crate::emit::context::Context;
use crate::emit::names::camel_case;
use crate::program::{Leaf, OutputShape, Routine, Slot};

/// Most entries that a function holds until its end.
const HELD: usize = 16;

/// Widest list of fields that rustfmt keeps on one line.
const ONE_LINE: usize = 18;

/// Whether the arrays of the result are filled entry by entry.
pub(super) fn fills_arrays(routine: &Routine) -> bool {
    routine.code.outputs.len() > HELD
}

/// The local array of an output.
pub(super) fn array_name<'a>(routine: &Routine, output: &'a OutputShape) -> &'a str {
    if routine.outputs.len() == 1 { "result" } else { output.name }
}

/// Arrays of zeros, to be filled.
pub(super) fn empty_arrays(context: &Context<'_>, routine: &Routine) -> Vec<String> {
    let mut entries = entry_places(routine).into_iter();
    let array = |output: &OutputShape| {
        let is_filled = entries.by_ref().take(output.len()).fold(false, |any, e| any | e.is_some());
        let mutable = if is_filled { "mut " } else { "" };
        let name = array_name(routine, output);
        let zeros = array_of("S::ZERO", context, routine, output);
        format!("let {mutable}{name} = {zeros};")
    };
    routine.outputs.iter().map(array).collect()
}

/// How each entry of the outputs is written, in order; none where it is the number 0 and stays so.
pub(super) fn entry_places(routine: &Routine) -> Vec<Option<String>> {
    let leaves = &routine.code.leaves;
    let is_zero = |slot: Slot| {
        // The sign of a zero is part of its value.
        let zero = |leaf: &Leaf| matches!(leaf, Leaf::Constant(value) if value.to_bits() == 0);
        slot.index() < leaves.len() && zero(&leaves[slot])
    };
    let places = routine.outputs.iter().flat_map(|output| {
        let name = array_name(routine, output);
        (0..output.len()).map(move |entry| format!("{name}{}", indices(&output.shape, entry)))
    });
    let slots = routine.code.outputs.iter();
    slots.zip(places).map(|(&slot, place)| (!is_zero(slot)).then_some(place)).collect()
}

/// The indices of an entry of an array: `[2][0]`.
fn indices(shape: &[usize], entry: usize) -> String {
    let mut stride: usize = shape.iter().product();
    let mut rest = entry;
    let index = |&len: &usize| {
        stride /= len;
        let index = rest / stride;
        rest %= stride;
        format!("[{index}]")
    };
    shape.iter().map(index).collect()
}

/// The arrays that were filled, in their struct if there are several.
pub(super) fn filled_result(routine: &Routine) -> Vec<String> {
    if routine.outputs.len() == 1 {
        return vec!["result".to_owned()];
    }
    let name = camel_case(routine.name.as_str());
    let fields: Vec<&str> = routine.outputs.iter().map(|output| output.name).collect();
    let fields = fields.join(", ");
    if fields.len() <= ONE_LINE {
        return vec![format!("{name} {{ {fields} }}")];
    }
    let mut lines = vec![format!("{name} {{")];
    lines.extend(routine.outputs.iter().map(|output| format!("    {},", output.name)));
    lines.push("}".to_owned());
    lines
}
