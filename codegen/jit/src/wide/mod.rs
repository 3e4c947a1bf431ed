//! Straight-line code for four or eight samples at once, on processors of x86-64.
//!
//! The generator that compiles single samples and pairs has no wider registers, so that these have
//! a short way of their own. [`lower`] makes steps of the code: a step is about an instruction of
//! the processor, on values that are assigned once. [`allocate`] walks the steps and gives values
//! registers; [`assemble`] writes instructions. Each takes time in proportion to the code.
//!
//! Sine and cosine are steps among others, so that nothing is called for ordinary angles. A block
//! of samples with an angle that is not is computed once more by code that calls the runtime.

mod allocate;
mod arithmetic;
mod assemble;
mod calls;
mod layout;
mod lower;
mod machine;
mod registers;
mod steps;
mod turns;

use crate::compiler::Unsupported;
use crate::lanes::Lanes;
use denavit_codegen::program::Routine;
use layout::Memory;
use machine::{Line, WideMachine};
use std::sync::Arc;

pub(crate) use layout::Layout;

/// A routine as code for several samples at once.
#[derive(Clone, Debug)]
pub(crate) struct Wide {
    lanes: Lanes,
    machine: Arc<WideMachine>,
    /// Each number once for eight samples, four times for four: processors of these repeat none.
    table: Arc<[Line]>,
    /// What registers do not hold.
    scratch: Vec<Line>,
}

impl Wide {
    /// Compiles `routine` for four or eight samples.
    ///
    /// # Panics
    /// If this processor does not have so many lanes.
    pub(crate) fn new(
        routine: &Routine,
        prelude: &[f64],
        lanes: Lanes,
        layout: &Layout,
    ) -> Result<Self, Unsupported> {
        assert!(lanes != Lanes::Two && lanes.is_available(), "no registers for so many samples");
        let straight = lower::lower(routine, prelude, lanes, lower::Turns::Inline, &[]);
        let mut table = table(&straight.constants, lanes);
        let memory = Memory::new(layout, &mut table);
        let mut assembler = assemble::Assembler::new(lanes, memory);
        let mut slots = allocate::assemble(&straight, &mut assembler);
        let mut thorough = None;
        if straight.watches {
            thorough = Some(assembler.position());
            let constants = &straight.constants;
            let called = lower::lower(routine, prelude, lanes, lower::Turns::Called, constants);
            assert_eq!(called.constants.len(), constants.len(), "the functions share a table");
            slots = slots.max(allocate::assemble(&called, &mut assembler));
        }
        let machine =
            WideMachine::new(&assembler.finish(), thorough).map_err(Unsupported::because)?;
        Ok(Self {
            lanes,
            machine: Arc::new(machine),
            table: table.into(),
            scratch: vec![Line::default(); (slots * lanes.count()).div_ceil(8)],
        })
    }

    /// Computes whole blocks of samples. Addresses of rows go to the next block with each.
    ///
    /// # Safety
    /// `inputs` and `outputs` hold the addresses of the layout, of `blocks` blocks of numbers each,
    /// and nothing else reads or writes the outputs meanwhile.
    // Machine code can only be called unsafely.
    #[allow(unsafe_code)]
    pub(crate) unsafe fn call(
        &mut self,
        inputs: &mut [*const f64],
        outputs: &mut [*mut f64],
        blocks: usize,
    ) {
        // SAFETY: the caller says that numbers are there; the table and the scratch memory have the
        // sizes that the code was compiled for, on a processor that has its instructions.
        unsafe {
            let block = 8 * self.lanes.count();
            self.machine.call(inputs, &self.table, outputs, &mut self.scratch, block, blocks);
        }
    }
}

/// The constants as the code reads them.
fn table(constants: &[f64], lanes: Lanes) -> Vec<Line> {
    let copies = if lanes == Lanes::Eight { 1 } else { lanes.count() };
    let numbers: Vec<f64> =
        constants.iter().flat_map(|&number| std::iter::repeat_n(number, copies)).collect();
    let line = |chunk: &[f64]| {
        let mut line = Line::default();
        line.0[..chunk.len()].copy_from_slice(chunk);
        line
    };
    numbers.chunks(8).map(line).collect()
}
