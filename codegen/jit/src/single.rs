//! A routine, compiled for one sample at a time.

use crate::compiler::{Unsupported, compile};
use crate::machine::Machine;
use crate::translate::{Places, Translation, Width, constant_memory, table, table_rows};
use cranelift_codegen::ir::types::I64;
use cranelift_codegen::ir::{InstBuilder, MemFlags, Value};
use cranelift_frontend::FunctionBuilder;
use denavit_codegen::arena::Handle;
use denavit_codegen::program::{Evaluate, Leaf, Routine, ShapeMismatch};
use std::sync::Arc;

/// A routine made ready to be called many times for one set of parameters, as machine code.
#[derive(Clone, Debug)]
pub struct Compiled {
    machine: Arc<Machine>,
    table: Arc<[f64]>,
    /// Name and length of each argument.
    arguments: Vec<(&'static str, usize)>,
    outputs: usize,
}

impl Compiled {
    /// Compiles `routine`, with the prelude's values as
    /// [`prelude_values`](denavit_codegen::program::prelude_values) gives them.
    ///
    /// # Errors
    /// If there is no code generator for this processor.
    ///
    /// # Panics
    /// If the routine reads beyond its arguments.
    pub fn new(routine: &Routine, prelude: &[f64]) -> Result<Self, Unsupported> {
        let machine = compile(3, routine, |builder, callees, routine| {
            let block = builder.current_block().expect("the function has begun");
            let [arguments, table, outputs] = [0, 1, 2].map(|row| builder.block_params(block)[row]);
            let places = places(builder, routine, arguments, table);
            let code = &routine.code;
            let translation = Translation::new(builder, Width::One, callees, code, places);
            translation.run(|builder, entry, value| {
                builder.ins().store(MemFlags::trusted(), value, outputs, offset(entry));
            });
            builder.ins().return_(&[]);
        })?;
        Ok(Self {
            machine: Arc::new(machine),
            table: table(&routine.code, prelude).into(),
            arguments: routine.arguments.iter().map(|a| (a.name, a.len)).collect(),
            outputs: routine.code.outputs.len(),
        })
    }
}

/// Where each leaf is: an argument behind its address, the others in the table.
fn places(
    builder: &mut FunctionBuilder<'_>,
    routine: &Routine,
    arguments: Value,
    table: Value,
) -> Places {
    let code = &routine.code;
    let vectors: Vec<Value> = (0..routine.arguments.len())
        .map(|row| builder.ins().load(I64, constant_memory(), arguments, offset(row)))
        .collect();
    let mut places = Places { table, rows: table_rows(code), arguments: vec![None; code.slots] };
    for (slot, leaf) in code.leaves.iter() {
        if let Leaf::Argument { argument, entry } = *leaf {
            places.arguments[slot.index()] = Some((vectors[argument], offset(entry)));
        }
    }
    places
}

/// Bytes before an entry.
fn offset(entry: usize) -> i32 {
    i32::try_from(8 * entry).expect("arrays of functions are below 2^31 bytes")
}

impl Compiled {
    /// [`Evaluate::evaluate`] for owners who share the code: it has no memory of its own.
    ///
    /// # Errors
    /// If a slice has a wrong length; nothing is computed then.
    // Machine code can only be called unsafely.
    #[allow(unsafe_code)]
    pub fn call(&self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch> {
        ShapeMismatch::check("arguments", self.arguments.len(), arguments.len())?;
        for (&(name, len), argument) in self.arguments.iter().zip(arguments) {
            ShapeMismatch::check(name, len, argument.len())?;
        }
        ShapeMismatch::check("outputs", self.outputs, outputs.len())?;
        // No function has more arguments; a list on the stack costs nothing.
        let mut addresses = [std::ptr::null(); 8];
        assert!(arguments.len() <= addresses.len(), "functions have up to six arguments");
        for (address, argument) in addresses.iter_mut().zip(arguments) {
            *address = argument.as_ptr();
        }
        // SAFETY: the code was compiled as a single one, and all lengths were compared.
        unsafe { self.machine.call_single(&addresses, &self.table, outputs) };
        Ok(())
    }
}

impl Evaluate for Compiled {
    fn outputs(&self) -> usize {
        self.outputs
    }

    fn evaluate(&mut self, arguments: &[&[f64]], outputs: &mut [f64]) -> Result<(), ShapeMismatch> {
        self.call(arguments, outputs)
    }
}
