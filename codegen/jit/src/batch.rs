//! A routine, compiled for two samples at a time: what one register of every 64-bit processor
//! holds.

use crate::compiler::{Unsupported, compile};
use crate::machine::Machine;
use crate::translate::{Callees, Places, Translation, Width, constant_memory, table, table_rows};
use cranelift_codegen::ir::condcodes::IntCC;
use cranelift_codegen::ir::types::I64;
use cranelift_codegen::ir::{InstBuilder, MemFlags, Value};
use cranelift_frontend::FunctionBuilder;
use denavit_codegen::arena::Handle;
use denavit_codegen::program::{EvaluateBatch, Leaf, Routine, ShapeMismatch};
use std::sync::Arc;

/// A routine made ready to be called on many samples for one set of parameters, as machine code.
#[derive(Clone, Debug)]
pub struct CompiledBatch {
    machine: Arc<Machine>,
    /// Each number twice: once for each sample of a pair.
    table: Arc<[[f64; 2]]>,
    inputs: usize,
    outputs: usize,
}

impl CompiledBatch {
    /// Compiles `routine`, with the prelude's values as
    /// [`prelude_values`](denavit_codegen::program::prelude_values) gives them.
    ///
    /// # Errors
    /// If there is no code generator for this processor.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Result<Self, Unsupported> {
        let machine = compile(4, routine, write_loop)?;
        Ok(Self {
            machine: Arc::new(machine),
            table: table(&routine.code, prelude).into_iter().map(|value| [value; 2]).collect(),
            inputs: routine.arguments.iter().map(|argument| argument.len).sum(),
            outputs: routine.code.outputs.len(),
        })
    }

    // Machine code can only be called unsafely.
    #[allow(unsafe_code)]
    fn call(&self, inputs: &[*const f64], outputs: &[*mut f64], pairs: usize) {
        assert!(inputs.len() == self.inputs && outputs.len() == self.outputs);
        // SAFETY: the code was compiled for pairs, and there is an address for each column; that
        // each has numbers for the pairs is what `evaluate` compared.
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

impl EvaluateBatch for CompiledBatch {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn outputs(&self) -> usize {
        self.outputs
    }

    fn evaluate(
        &mut self,
        inputs: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> Result<(), ShapeMismatch> {
        let samples = ShapeMismatch::check_columns(self.inputs, inputs, self.outputs, outputs)?;
        let pairs = samples / 2;
        if pairs > 0 {
            let from: Vec<*const f64> = inputs.iter().map(|column| column.as_ptr()).collect();
            let to: Vec<*mut f64> = outputs.iter_mut().map(|column| column.as_mut_ptr()).collect();
            self.call(&from, &to, pairs);
        }
        if samples % 2 == 1 {
            // The last sample alone, twice.
            let last = samples - 1;
            let given: Vec<[f64; 2]> = inputs.iter().map(|column| [column[last]; 2]).collect();
            let mut results = vec![[0.0; 2]; self.outputs];
            let from: Vec<*const f64> = given.iter().map(|pair| pair.as_ptr()).collect();
            let to: Vec<*mut f64> = results.iter_mut().map(|pair| pair.as_mut_ptr()).collect();
            self.call(&from, &to, 1);
            for (column, pair) in outputs.iter_mut().zip(&results) {
                column[last] = pair[0];
            }
        }
        Ok(())
    }
}
