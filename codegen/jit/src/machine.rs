//! Machine code and its memory.
// Whoever calls machine code vouches for it: the calls are here and in the two callers.
#![allow(unsafe_code)]

use cranelift_jit::JITModule;
use cranelift_module::FuncId;
use std::fmt;

/// One compiled function. Its memory goes back when the last owner is dropped.
pub(crate) struct Machine {
    /// Kept for the memory that it owns; none only while this is dropped.
    module: Option<JITModule>,
    entry: *const u8,
}

// SAFETY: after it is made, the module is not touched until it is dropped, by whoever owns it last;
// the code behind `entry` is read-only, and writes to nothing but what its callers hand it.
unsafe impl Send for Machine {}
// SAFETY: as above: shared owners do no more than call the code.
unsafe impl Sync for Machine {}

impl fmt::Debug for Machine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Machine").field("entry", &self.entry).finish_non_exhaustive()
    }
}

impl Machine {
    /// The code of a function whose definition is final.
    pub(crate) fn new(module: JITModule, function: FuncId) -> Self {
        let entry = module.get_finalized_function(function);
        Self { module: Some(module), entry }
    }

    /// Calls code of one sample.
    ///
    /// # Safety
    /// The code was compiled for these parameters; `arguments` holds an address of enough numbers
    /// for each argument, and `table` and `outputs` have the lengths that it reads and writes.
    pub(crate) unsafe fn call_single(
        &self,
        arguments: &[*const f64],
        table: &[f64],
        outputs: &mut [f64],
    ) {
        // SAFETY: the caller says that this is the function's type and that the memory suffices.
        unsafe {
            let function: extern "C" fn(*const *const f64, *const f64, *mut f64) =
                std::mem::transmute(self.entry);
            function(arguments.as_ptr(), table.as_ptr(), outputs.as_mut_ptr());
        }
    }

    /// Calls code of `pairs` pairs of samples.
    ///
    /// # Safety
    /// The code was compiled for these parameters; `inputs` and `outputs` hold an address of
    /// `2 * pairs` numbers for each column, and `table` has the length that the code reads.
    pub(crate) unsafe fn call_pairs(
        &self,
        inputs: &[*const f64],
        table: &[[f64; 2]],
        outputs: &[*mut f64],
        pairs: usize,
    ) {
        // SAFETY: the caller says that this is the function's type and that the memory suffices.
        unsafe {
            let function: extern "C" fn(
                *const *const f64,
                *const [f64; 2],
                *const *mut f64,
                usize,
            ) = std::mem::transmute(self.entry);
            function(inputs.as_ptr(), table.as_ptr(), outputs.as_ptr(), pairs);
        }
    }
}

impl Drop for Machine {
    fn drop(&mut self) {
        if let Some(module) = self.module.take() {
            // SAFETY: no owner is left, so nobody calls the code, and no address of it is kept.
            unsafe { module.free_memory() };
        }
    }
}
