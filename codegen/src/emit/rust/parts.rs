//! A function too large for one piece: parts that hand their values on in an array.

use super::Context;
use super::functions::{arguments, frame, prologue, signature};
use crate::arena::Handle;
use crate::emit::body::Body;
use crate::program::{Code, Leaf, Routine, Slot};
use std::ops::Range;

/// Instructions of a part.
const PART: usize = 4_000;

/// The parts as functions, and the statements that call them. Afterwards the body reads the
/// outputs from the array.
pub(super) fn in_parts(
    context: &Context<'_>,
    routine: &Routine,
    name: &str,
    body: &mut Body<'_>,
) -> (Vec<String>, Vec<String>) {
    let _ = context;
    let code = &routine.code;
    let plan = Plan::new(code);
    let mut items = Vec::new();
    let mut calls = vec![format!("let mut live = [S::ZERO; {}];", plan.places)];
    let vectors: String =
        routine.arguments.iter().map(|shape| format!("{}, ", shape.name)).collect();
    for (part, range) in plan.ranges.iter().enumerate() {
        let part_name = format!("{name}_part_{}", part + 1);
        body.write(range.clone());
        let mut written = body.take_lines();
        for &(slot, place) in &plan.handed_on[part] {
            written.push(format!("live[{place}] = {};", body.text(slot)));
        }
        for &(slot, place) in &plan.handed_on[part] {
            body.read_as(slot, format!("live[{place}]"));
        }
        let is_read = |leaf: &dyn Fn(&Leaf) -> bool| reads(code, range, leaf);
        let mut lines = prologue(routine, is_read);
        lines.extend(written);
        let mut arguments = arguments(routine);
        arguments.push(format!("live: &mut [S; {}]", plan.places));
        let doc = format!(
            "/// Part {} of {} of [`{name}`].\n#[inline(never)]",
            part + 1,
            plan.ranges.len()
        );
        items.push(frame(
            &doc,
            false,
            &signature(routine, &format!("fn {part_name}"), &arguments, ""),
            &lines,
        ));
        calls.push(format!("{part_name}(parameters, {vectors}&mut live);"));
    }
    (items, calls)
}

/// Whether an instruction of the range reads such a leaf.
fn reads(code: &Code, range: &Range<usize>, is_such: &dyn Fn(&Leaf) -> bool) -> bool {
    let mut found = false;
    for instruction in &code.instructions[range.clone()] {
        instruction.for_each_operand(|operand| {
            found |= code.leaves.get(operand).is_some_and(is_such);
        });
    }
    found
}

/// Which values are handed on, and where they stand in the array.
struct Plan {
    ranges: Vec<Range<usize>>,
    /// For each part: values made there that are used later, and their places.
    handed_on: Vec<Vec<(Slot, usize)>>,
    /// Length of the array.
    places: usize,
}

impl Plan {
    fn new(code: &Code) -> Self {
        let length = code.instructions.len();
        let ranges: Vec<Range<usize>> =
            (0..length).step_by(PART).map(|start| start..length.min(start + PART)).collect();
        let mut last_part = vec![0; code.slots];
        for (part, range) in ranges.iter().enumerate() {
            for instruction in &code.instructions[range.clone()] {
                instruction.for_each_operand(|operand| last_part[operand.index()] = part);
            }
        }
        code.outputs.iter().for_each(|output| last_part[output.index()] = ranges.len());

        let (mut handed_on, mut places) = (Vec::new(), 0);
        // The last part that reads each place: it is free for values made in that part or later.
        let mut busy_until: Vec<usize> = Vec::new();
        for (part, range) in ranges.iter().enumerate() {
            let mut values = Vec::new();
            for instruction in &code.instructions[range.clone()] {
                instruction.for_each_result(|slot| {
                    let last = last_part[slot.index()];
                    if last <= part {
                        return;
                    }
                    let free = busy_until.iter().position(|&busy| busy <= part);
                    let place = free.unwrap_or(places);
                    if place == places {
                        places += 1;
                        busy_until.push(last);
                    }
                    busy_until[place] = last;
                    values.push((slot, place));
                });
            }
            handed_on.push(values);
        }
        Self { ranges, handed_on, places }
    }
}
