//! Wide machine code and its memory.
// Whoever calls machine code vouches for it.
#![allow(unsafe_code)]

/// Eight numbers, aligned as the widest register is.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(64))]
pub(super) struct Line(pub(super) [f64; 8]);

/// Functions of the wide code. Their memory is executable and never writable at a time, and goes
/// back when this is dropped.
#[derive(Debug)]
pub(super) struct WideMachine {
    memory: memmap2::Mmap,
    /// Where the function begins that computes blocks at which the first one stops.
    thorough: Option<usize>,
}

/// Addresses of the arguments, constants, addresses of the results, scratch memory, bytes of a
/// column before the first block and before the end. The result is how many bytes are done.
type WideFunction = unsafe extern "sysv64" fn(
    *mut *const f64,
    *const Line,
    *mut *mut f64,
    *mut Line,
    usize,
    usize,
) -> usize;

impl WideMachine {
    /// Makes code executable.
    pub(super) fn new(code: &[u8], thorough: Option<usize>) -> std::io::Result<Self> {
        let mut memory = memmap2::MmapMut::map_anon(code.len())?;
        memory.copy_from_slice(code);
        Ok(Self { memory: memory.make_exec()?, thorough })
    }

    /// Calls the code on blocks of samples; a column has `size` bytes of each.
    ///
    /// # Safety
    /// The processor has the instructions; `inputs` and `outputs` hold the addresses of all blocks
    /// that the code reads and writes, and `table` and `scratch` have the lengths that it was
    /// written for.
    pub(super) unsafe fn call(
        &self,
        inputs: &mut [*const f64],
        table: &[Line],
        outputs: &mut [*mut f64],
        scratch: &mut [Line],
        size: usize,
        blocks: usize,
    ) {
        // SAFETY: code of this type begins at both places, whose memory is alive and executable;
        // the caller says that what it is given suffices.
        unsafe {
            let at = |place: usize| -> WideFunction {
                std::mem::transmute(self.memory.as_ptr().add(place))
            };
            let mut call = |function: WideFunction, from: usize, to: usize| {
                let (table, scratch) = (table.as_ptr(), scratch.as_mut_ptr());
                function(inputs.as_mut_ptr(), table, outputs.as_mut_ptr(), scratch, from, to)
            };
            let mut done = 0;
            loop {
                done = call(at(0), done, size * blocks);
                let Some(thorough) = self.thorough.filter(|_| done < size * blocks) else { break };
                done = call(at(thorough), done, done + size);
            }
        }
    }
}
