//! Instructions of the processor.
//!
//! A function has these parameters, by the convention of System V, and returns the bytes of each
//! column that are done: fewer than asked for where a block has an angle that is not ordinary.
//!
//! | parameter | while it runs | |
//! |---|---|---|
//! | `rdi` | `r12` | addresses of the columns of the arguments |
//! | `rsi` | `r13` | constants |
//! | `rdx` | `r14` | addresses of the columns of the results |
//! | `rcx` | `r15` | scratch memory |
//! | `r8` | `rbx` | bytes of each column before the first block |
//! | `r9` | `rbp` | bytes of each column before the end |
//!
//! Where samples are rows there is one address for each argument and each output, which goes on
//! with each block; bytes are counted as of columns.

use super::calls::Callee;
use super::layout::{Entry, Memory};
use crate::lanes::Lanes;
use iced_x86::{Code, Encoder, IcedError, Instruction, MemoryOperand, Register};

/// Where an operand is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// A vector register.
    Register(u8),
    /// A row of the table of constants.
    Table(u32),
    /// The block in a column of the arguments.
    Column(u32),
    /// A slot of the scratch memory.
    Scratch(u32),
}

/// The mask of ordinary angles.
pub(super) const ORDINARY: Register = Register::K7;
/// The mask of a gather, and one that is never written: what waits for no mask.
const GATHERED: Register = Register::K6;
const UNWRITTEN: Register = Register::K0;
/// The last registers, where samples are rows: one for parts of a block; the other, of eight, has
/// the distances of samples.
const RESERVED: u8 = 2;
/// Callee-saved registers, in the order in which they are saved.
const SAVED: [Register; 6] =
    [Register::RBX, Register::RBP, Register::R12, Register::R13, Register::R14, Register::R15];

/// Slots of the scratch memory that calls have: the operands, and what is watched.
pub(super) const OPERANDS: [u32; 2] = [0, 1];
const WATCHED: u32 = 2;
/// The first slot for values.
pub(super) const FIRST_SLOT: u32 = 3;

/// Writes instructions, one after the other.
pub(super) struct Assembler {
    encoder: Encoder,
    lanes: Lanes,
    memory: Memory,
    bytes: u64,
    /// The line of the table that the register of distances holds.
    distances: Option<u32>,
}

/// A function that is being written.
pub(super) struct Loop {
    head: u64,
    /// Where jumps to the end are, behind them.
    exits: Vec<u64>,
    watches: bool,
}

impl Assembler {
    pub(super) fn new(lanes: Lanes, memory: Memory) -> Self {
        Self { encoder: Encoder::new(64), lanes, memory, bytes: 0, distances: None }
    }

    /// Bytes that are written.
    pub(super) fn position(&self) -> usize {
        usize::try_from(self.bytes).expect("code is in memory")
    }

    pub(super) fn finish(mut self) -> Vec<u8> {
        self.encoder.take_buffer()
    }

    pub(super) fn is_eight(&self) -> bool {
        self.lanes == Lanes::Eight
    }

    /// All vector registers.
    fn all_registers(&self) -> u8 {
        if self.is_eight() { 32 } else { 16 }
    }

    /// Vector registers for values.
    pub(super) fn registers(&self) -> u8 {
        self.all_registers() - if self.memory.is_rows { RESERVED } else { 0 }
    }

    /// Whether instructions read arguments from memory as they are there.
    pub(super) fn reads_columns(&self) -> bool {
        !self.memory.is_rows
    }

    fn width(&self) -> i64 {
        if self.is_eight() { 64 } else { 32 }
    }

    pub(super) fn write(&mut self, instruction: Result<Instruction, IcedError>) {
        let instruction = instruction.expect("operands fit the instruction");
        let written = self.encoder.encode(&instruction, self.bytes);
        self.bytes += written.expect("the processor has the instruction") as u64;
    }

    pub(super) fn vector(&self, register: u8) -> Register {
        let first = if self.is_eight() { Register::ZMM0 } else { Register::YMM0 };
        first + u32::from(register)
    }

    /// The operand of a place that is no register.
    pub(super) fn memory(&mut self, place: Place) -> MemoryOperand {
        match place {
            Place::Register(_) => unreachable!("a register is no memory"),
            Place::Table(row) => {
                let size = if self.is_eight() { 8 } else { 32 };
                let mut operand = based(Register::R13, size * i64::from(row));
                operand.is_broadcast = self.is_eight();
                operand
            }
            Place::Column(column) => self.column(Register::R12, column),
            Place::Scratch(slot) => based(Register::R15, self.width() * i64::from(slot)),
        }
    }

    fn column(&mut self, columns: Register, column: u32) -> MemoryOperand {
        let address = based(columns, 8 * i64::from(column));
        self.write(Instruction::with2(Code::Mov_r64_rm64, Register::RAX, address));
        MemoryOperand::with_base_index(Register::RAX, Register::RBX)
    }

    /// An instruction of two operands and its result; with an immediate number where it has one.
    pub(super) fn three(&mut self, code: Code, to: Register, a: u8, b: Place, number: Option<u32>) {
        self.masked(code, to, a, b, number, Register::None);
    }

    pub(super) fn masked(
        &mut self,
        code: Code,
        to: Register,
        a: u8,
        b: Place,
        number: Option<u32>,
        mask: Register,
    ) {
        let a = self.vector(a);
        let instruction = match (b, number) {
            (Place::Register(b), None) => Instruction::with3(code, to, a, self.vector(b)),
            (Place::Register(b), Some(n)) => Instruction::with4(code, to, a, self.vector(b), n),
            (b, None) => Instruction::with3(code, to, a, self.memory(b)),
            (b, Some(n)) => Instruction::with4(code, to, a, self.memory(b), n),
        };
        let masked = instruction.map(|mut instruction| {
            instruction.set_op_mask(mask);
            instruction
        });
        self.write(masked);
    }

    /// to = place
    pub(super) fn load(&mut self, to: u8, place: Place) {
        if let Place::Column(column) = place
            && self.memory.is_rows
        {
            return self.gather(to, self.memory.inputs[column as usize]);
        }
        let to = self.vector(to);
        let instruction = match (place, self.is_eight()) {
            (Place::Register(from), true) => {
                Instruction::with2(Code::EVEX_Vmovapd_zmm_k1z_zmmm512, to, self.vector(from))
            }
            (Place::Register(from), false) => {
                Instruction::with2(Code::VEX_Vmovapd_ymm_ymmm256, to, self.vector(from))
            }
            (Place::Table(_), true) => {
                let mut memory = self.memory(place);
                memory.is_broadcast = false;
                Instruction::with2(Code::EVEX_Vbroadcastsd_zmm_k1z_xmmm64, to, memory)
            }
            (_, true) => {
                Instruction::with2(Code::EVEX_Vmovupd_zmm_k1z_zmmm512, to, self.memory(place))
            }
            (_, false) => Instruction::with2(Code::VEX_Vmovupd_ymm_ymmm256, to, self.memory(place)),
        };
        self.write(instruction);
    }

    fn store(&mut self, from: u8, memory: MemoryOperand) {
        let code = match self.is_eight() {
            true => Code::EVEX_Vmovupd_zmmm512_k1z_zmm,
            false => Code::VEX_Vmovupd_ymmm256_ymm,
        };
        self.write(Instruction::with2(code, memory, self.vector(from)));
    }

    /// Keeps a register in the scratch memory.
    pub(super) fn keep(&mut self, from: u8, slot: u32) {
        let memory = self.memory(Place::Scratch(slot));
        self.store(from, memory);
    }

    /// Writes a register to a column of the results.
    pub(super) fn store_column(&mut self, from: u8, column: u32) {
        if self.memory.is_rows {
            return self.scatter(from, self.memory.outputs[column as usize]);
        }
        let memory = self.column(Register::R14, column);
        self.store(from, memory);
    }

    /// The address of an array, and where its number is of a sample of the block.
    fn row(&mut self, arrays: Register, entry: Entry) -> impl Fn(u8) -> MemoryOperand + use<> {
        let address = based(arrays, 8 * i64::from(entry.array));
        self.write(Instruction::with2(Code::Mov_r64_rm64, Register::RAX, address));
        move |sample| based(Register::RAX, entry.offset + i64::from(sample) * entry.stride)
    }

    /// Reads a number of all samples of a block, from rows.
    fn gather(&mut self, to: u8, entry: Entry) {
        let row = self.row(Register::R12, entry);
        if !self.is_eight() {
            let part = Register::XMM0 + u32::from(self.all_registers() - 1);
            let low = Register::XMM0 + u32::from(to);
            for (half, first) in [(low, 0), (part, 2)] {
                let (one, other) = (row(first), row(first + 1));
                self.write(Instruction::with2(Code::VEX_Vmovsd_xmm_m64, half, one));
                self.write(Instruction::with3(Code::VEX_Vmovhpd_xmm_xmm_m64, half, half, other));
            }
            let code = Code::VEX_Vinsertf128_ymm_ymm_xmmm128_imm8;
            let to = self.vector(to);
            return self.write(Instruction::with4(code, to, to, part, 1_u32));
        }
        let distances = self.vector(self.all_registers() - 2);
        if self.distances != Some(entry.distances) {
            self.distances = Some(entry.distances);
            let line = based(Register::R13, 64 * i64::from(entry.distances));
            self.write(Instruction::with2(Code::EVEX_Vmovupd_zmm_k1z_zmmm512, distances, line));
        }
        let ones = UNWRITTEN;
        self.write(Instruction::with3(Code::VEX_Kxnorw_kr_kr_kr, GATHERED, ones, ones));
        let mut memory = row(0);
        memory.index = distances;
        memory.scale = 8;
        let code = Code::EVEX_Vgatherqpd_zmm_k1_vm64z;
        let gather = Instruction::with2(code, self.vector(to), memory).map(|mut gather| {
            gather.set_op_mask(GATHERED);
            gather
        });
        self.write(gather);
    }

    /// Writes a number of all samples of a block to rows, pair by pair.
    fn scatter(&mut self, from: u8, entry: Entry) {
        let row = self.row(Register::R14, entry);
        let (low, high, extract) = match self.is_eight() {
            true => (
                Code::EVEX_Vmovsd_m64_k1_xmm,
                Code::EVEX_Vmovhpd_m64_xmm,
                Code::EVEX_Vextractf32x4_xmmm128_k1z_zmm_imm8,
            ),
            false => (
                Code::VEX_Vmovsd_m64_xmm,
                Code::VEX_Vmovhpd_m64_xmm,
                Code::VEX_Vextractf128_xmmm128_ymm_imm8,
            ),
        };
        let whole = self.vector(from);
        let part = Register::XMM0 + u32::from(self.all_registers() - 1);
        let pairs = if self.is_eight() { 4 } else { 2 };
        for pair in 0..pairs {
            let mut both = Register::XMM0 + u32::from(from);
            if pair > 0 {
                self.write(Instruction::with3(extract, part, whole, u32::from(pair)));
                both = part;
            }
            self.write(Instruction::with2(low, row(2 * pair), both));
            self.write(Instruction::with2(high, row(2 * pair + 1), both));
        }
    }

    /// Addresses of rows go to the next block.
    fn advance(&mut self) {
        let samples = i64::try_from(self.lanes.count()).expect("eight at most");
        for (arrays, row) in [(Register::R12, 0), (Register::R14, 1)] {
            for (array, stride) in (0..).zip(self.memory.strides[row].clone()) {
                let block = i32::try_from(samples * stride).expect("a block is below 2^31 bytes");
                let address = based(arrays, 8 * array);
                self.write(Instruction::with2(Code::Add_rm64_imm32, address, block));
            }
        }
    }

    /// Calls a function. No vector register keeps its value.
    pub(super) fn call(&mut self, callee: Callee, results: [u32; 2], watches: bool) {
        let watched = self.memory(Place::Scratch(WATCHED));
        if watches {
            self.write(match self.is_eight() {
                true => Instruction::with2(Code::VEX_Kmovw_m16_kr, watched, ORDINARY),
                false => Instruction::with2(Code::Mov_rm32_r32, watched, Register::R11D),
            });
        }
        self.write(Ok(Instruction::with(Code::VEX_Vzeroupper)));
        let slots = OPERANDS.into_iter().chain(results);
        for (to, slot) in
            [Register::RDI, Register::RSI, Register::RDX, Register::RCX].iter().zip(slots)
        {
            let memory = self.memory(Place::Scratch(slot));
            self.write(Instruction::with2(Code::Lea_r64_m, *to, memory));
        }
        let address = callee.address(self.lanes);
        self.write(Instruction::with2(Code::Mov_r64_imm64, Register::RAX, address));
        self.write(Instruction::with1(Code::Call_rm64, Register::RAX));
        self.distances = None;
        if watches {
            self.write(match self.is_eight() {
                true => Instruction::with2(Code::VEX_Kmovw_kr_km16, ORDINARY, watched),
                false => Instruction::with2(Code::Mov_r32_rm32, Register::R11D, watched),
            });
        }
    }

    /// Begins a function, and in it the loop over blocks.
    pub(super) fn begin(&mut self, watches: bool) -> Loop {
        for register in SAVED {
            self.write(Instruction::with1(Code::Push_r64, register));
        }
        // The stack is aligned where calls are made.
        self.write(Instruction::with2(Code::Sub_rm64_imm8, Register::RSP, 8));
        let moved = [
            (Register::R12, Register::RDI),
            (Register::R13, Register::RSI),
            (Register::R14, Register::RDX),
            (Register::R15, Register::RCX),
            (Register::RBX, Register::R8),
            (Register::RBP, Register::R9),
        ];
        for (to, from) in moved {
            self.write(Instruction::with2(Code::Mov_r64_rm64, to, from));
        }
        self.write(Instruction::with2(Code::Cmp_r64_rm64, Register::RBX, Register::RBP));
        let mut blocks = Loop { head: 0, exits: Vec::new(), watches };
        self.exit(Code::Je_rel32_64, &mut blocks);
        blocks.head = self.bytes;
        self.distances = None;
        if watches {
            let (mask, bits) = (ORDINARY, Register::R11D);
            self.write(match self.is_eight() {
                true => Instruction::with3(Code::VEX_Kxnorw_kr_kr_kr, mask, mask, mask),
                false => Instruction::with2(Code::Xor_r32_rm32, bits, bits),
            });
        }
        blocks
    }

    /// Jumps to the end.
    fn exit(&mut self, code: Code, blocks: &mut Loop) {
        self.write(Instruction::with_branch(code, self.bytes));
        blocks.exits.push(self.bytes);
    }

    /// Ends the loop and the function.
    pub(super) fn end(&mut self, mut blocks: Loop) {
        if blocks.watches {
            let bits = if self.is_eight() { Register::EAX } else { Register::R11D };
            let ordinary = if self.is_eight() { 0xff } else { 0 };
            if self.is_eight() {
                self.write(Instruction::with2(Code::VEX_Kmovw_r32_kr, bits, ORDINARY));
            }
            self.write(Instruction::with2(Code::Cmp_rm32_imm32, bits, ordinary));
            self.exit(Code::Jne_rel32_64, &mut blocks);
        }
        self.advance();
        let width = i32::try_from(self.width()).expect("32 or 64");
        self.write(Instruction::with2(Code::Add_rm64_imm8, Register::RBX, width));
        self.write(Instruction::with2(Code::Cmp_r64_rm64, Register::RBX, Register::RBP));
        self.write(Instruction::with_branch(Code::Jne_rel32_64, blocks.head));
        self.land(&blocks.exits);
        self.write(Instruction::with2(Code::Mov_r64_rm64, Register::RAX, Register::RBX));
        self.write(Ok(Instruction::with(Code::VEX_Vzeroupper)));
        self.write(Instruction::with2(Code::Add_rm64_imm8, Register::RSP, 8));
        for register in SAVED.into_iter().rev() {
            self.write(Instruction::with1(Code::Pop_r64, register));
        }
        self.write(Ok(Instruction::with(Code::Retnq)));
    }

    /// Jumps that end before these places come here: their last four bytes are the distance.
    fn land(&mut self, exits: &[u64]) {
        let mut code = self.encoder.take_buffer();
        for &exit in exits {
            let distance = i32::try_from(self.bytes - exit).expect("code is below 2^31 bytes");
            let exit = usize::try_from(exit).expect("code is in memory");
            code[exit - 4..exit].copy_from_slice(&distance.to_le_bytes());
        }
        self.encoder.set_buffer(code);
    }
}

fn based(base: Register, displacement: i64) -> MemoryOperand {
    MemoryOperand::with_base_displ(base, displacement)
}
