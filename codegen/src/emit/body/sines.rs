//! Sines and cosines: their names, and packs of them in one statement.

use super::{Binding, Body, Term};
use crate::arena::Handle;
use crate::emit::names::{Names, joint_numbers};
use crate::emit::syntax::Pack;
use crate::program::{BinaryOperation, Code, Instruction, Leaf, Operation, Slot};
use std::ops::Range;

/// Sines and cosines in one statement: what processors compute at a time.
const PACK: usize = 4;

/// Longest angle that is written where its sine is computed among others.
const SHORT_ANGLE: usize = 10;

impl Body<'_> {
    /// The sines and cosines at the start of a range that do not wait for each other: a pack.
    pub(super) fn turns(&self, range: Range<usize>) -> Vec<[Slot; 3]> {
        let mut turns: Vec<[Slot; 3]> = Vec::new();
        for instruction in &self.code.instructions[range] {
            let Instruction::SinCos { sine, cosine, angle } = *instruction else { break };
            if turns.len() == PACK || turns.iter().any(|turn| turn[..2].contains(&angle)) {
                break;
            }
            turns.push([sine, cosine, angle]);
        }
        turns
    }

    /// Sines and cosines, given with their angles, side by side where there are several.
    pub(super) fn sincos(&mut self, turns: &[[Slot; 3]]) {
        let (mut angles, mut sines, mut cosines) = (Vec::new(), Vec::new(), Vec::new());
        for &[sine, cosine, angle] in turns {
            self.declare(angle);
            angles.push(self.angle(angle, turns.len()));
            for (slot, names) in [(sine, &mut sines), (cosine, &mut cosines)] {
                let is_used = self.uses[slot.index()] > 0;
                names.push(is_used.then(|| self.name(slot)));
            }
        }
        let name = self.syntax.pack_name().map(|name| self.names.unique(name));
        let pack = Pack { name: name.unwrap_or_default(), angles, sines, cosines };
        self.lines.extend(self.syntax.sincos(&pack));
        self.store_all(turns);
    }

    fn store_all(&mut self, turns: &[[Slot; 3]]) {
        turns.iter().flat_map(|turn| &turn[..2]).for_each(|&slot| self.store(slot));
    }

    /// The text of an angle, alone or among others.
    fn angle(&mut self, angle: Slot, turns: usize) -> Term {
        let is_long = |term: &Term| term.text.len() > SHORT_ANGLE;
        if turns > 1 && self.waiting[angle.index()].as_ref().is_some_and(is_long) {
            let term = self.waiting[angle.index()].take().expect("it was found waiting");
            self.assign(angle, &term);
        }
        let [term] = self.operands([angle], 0, Binding::Sum);
        term
    }
}

/// Names sines and cosines of joint angles and their sums: s1, c1, s23, c23; sin1, cos1 where
/// those are taken.
pub(super) fn name_sines(code: &Code, names: &mut Names, named: &mut [Option<String>]) {
    let mut joints: Vec<Option<Vec<usize>>> = vec![None; code.slots];
    for (slot, leaf) in code.leaves.iter() {
        if let Leaf::Argument { argument: 0, entry } = leaf {
            joints[slot.index()] = Some(vec![entry + 1]);
        }
    }
    for instruction in &code.instructions {
        match *instruction {
            Instruction::Value {
                result,
                operation: Operation::Binary(BinaryOperation::Add, a, b),
            } => {
                if let (Some(a), Some(b)) = (&joints[a.index()], &joints[b.index()]) {
                    let mut sum = [a.as_slice(), b].concat();
                    sum.sort_unstable();
                    joints[result.index()] = Some(sum);
                }
            }
            Instruction::SinCos { sine, cosine, angle } => {
                let Some(joints) = &joints[angle.index()] else { continue };
                let numbers = joint_numbers(joints);
                for [s, c] in [["s", "c"], ["sin", "cos"]] {
                    let pair = [format!("{s}{numbers}"), format!("{c}{numbers}")];
                    if names.claim_all(&pair) {
                        let [s, c] = pair;
                        named[sine.index()] = Some(s);
                        named[cosine.index()] = Some(c);
                        break;
                    }
                }
            }
            Instruction::Value { .. } => {}
        }
    }
}
