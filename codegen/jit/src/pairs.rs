//! A routine, compiled for two samples at a time: what one register of every 64-bit processor
//! holds.
// Machine code can only be called unsafely.
#![allow(unsafe_code)]

use crate::compiler::{Unsupported, compile};
use crate::machine::Machine;
use crate::translate::{Callees, Places, Translation, Width, constant_memory, table, table_rows};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::I64;
use cranelift_codegen::ir::{InstBuilder, MemFlags, Value};
use cranelift_frontend::FunctionBuilder;
use denavit_codegen::arena::Handle;
use denavit_codegen::program::{Leaf, Routine};
use std::sync::Arc;

/// A routine as code for pairs of samples.
#[derive(Clone, Debug)]
pub(crate) struct Pairs {
    machine: Arc<Machine>,
    /// Each number twice: once for each sample of a pair.
    table: Arc<[[f64; 2]]>,
}

impl Pairs {
    /// Compiles `routine`.
    pub(crate) fn new(routine: &Routine, prelude: &[f64]) -> Result<Self, Unsupported> {
        let machine = compile(4, routine, write_loop)?;
        let table = table(&routine.code, prelude).into_iter().map(|value| [value; 2]).collect();
        Ok(Self { machine: Arc::new(machine), table })
    }

    /// Computes pairs of samples.
    ///
    /// # Safety
    /// `inputs` and `outputs` hold an address of `pairs` pairs of numbers for each column of the
    /// routine, and nothing else reads or writes the outputs meanwhile.
    pub(crate) unsafe fn call(&self, inputs: &[*const f64], outputs: &[*mut f64], pairs: usize) {
        // SAFETY: the code was compiled for pairs; the caller says that columns are there.
        unsafe { self.machine.call_pairs(inputs, &self.table, outputs, pairs) };
    }
}

/// A loop over pairs of samples; `done` counts their bytes.
fn write_loop(builder: &mut FunctionBuilder<'_>, callees: Callees, routine: &Routine) {
    let start = builder.current_block().expect("the function has begun");
    let [inputs, table, outputs, pairs] = [0, 1, 2, 3].map(|row| builder.block_params(start)[row]);
    let (head, body, end) =
        (builder.create_block(), builder.create_block(), builder.create_block());
    let done = builder.append_block_param(head, I64);
    let bytes = builder.ins().ishl_imm(pairs, 4);
    let zero = builder.ins().iconst(I64, 0);
    builder.ins().jump(head, &[zero.into()]);

    builder.switch_to_block(head);
    let is_left = builder.ins().icmp(IntCC::UnsignedLessThan, done, bytes);
    builder.ins().brif(is_left, body, &[], end, &[]);

    builder.switch_to_block(body);
    let code = &routine.code;
    let column = |builder: &mut FunctionBuilder<'_>, columns: Value, row: usize| {
        let offset = i32::try_from(8 * row).expect("columns of functions are below 2^28");
        let address = builder.ins().load(I64, constant_memory(), columns, offset);
        builder.ins().iadd(address, done)
    };
    let mut places = Places { table, rows: table_rows(code), arguments: vec![None; code.slots] };
    let mut first = Vec::with_capacity(routine.arguments.len());
    let mut columns = 0;
    for argument in &routine.arguments {
        first.push(columns);
        columns += argument.len;
    }
    for (slot, leaf) in code.leaves.iter() {
        if let Leaf::Argument { argument, entry } = *leaf {
            let address = column(builder, inputs, first[argument] + entry);
            places.arguments[slot.index()] = Some((address, 0));
        }
    }
    let translation = Translation::new(builder, Width::Two, callees, code, places);
    translation.run(|builder, entry, value| {
        let address = column(builder, outputs, entry);
        builder.ins().store(MemFlags::new().with_notrap(), value, address, 0);
    });
    let next = builder.ins().iadd_imm(done, 16);
    builder.ins().jump(head, &[next.into()]);

    builder.switch_to_block(end);
    builder.ins().return_(&[]);
}
