//! Where there is no code for more than two samples at a time.

use crate::compiler::Unsupported;
use crate::lanes::Lanes;
use denavit_codegen::program::Routine;

/// How samples are in memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Layout {
    Columns,
    Rows,
}

impl Layout {
    pub(crate) fn rows(_: &Routine) -> Self {
        Self::Rows
    }
}

/// Nothing: it cannot be made.
#[derive(Clone, Debug)]
pub(crate) enum Wide {}

impl Wide {
    pub(crate) fn new(
        _: &Routine,
        _: &[f64],
        lanes: Lanes,
        layout: &Layout,
    ) -> Result<Self, Unsupported> {
        let count = lanes.count();
        Err(Unsupported::because(format!("it has no code for {count} samples ({layout:?})")))
    }

    /// # Safety
    /// There is nothing that it could be called on.
    // The call of the wide code on other processors has the same signature.
    #[allow(unsafe_code)]
    pub(crate) unsafe fn call(&mut self, _: &mut [*const f64], _: &mut [*mut f64], _: usize) {
        match *self {}
    }
}
