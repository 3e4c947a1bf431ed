//! Instructions that compute.

use super::assemble::{Assembler, ORDINARY, Place};
use super::steps::{Comparison, Operation};
use iced_x86::{Code, Instruction, Register};

/// Which operand of a fused product is overwritten, and which may be in memory.
#[derive(Clone, Copy, Debug)]
pub(super) enum Form {
    /// to = to last + middle
    F132,
    /// to = middle to + last
    F213,
    /// to = middle last + to
    F231,
}

/// The mask of single comparisons.
const HOLDS: Register = Register::K1;

impl Assembler {
    /// to = a operation b
    pub(super) fn binary(&mut self, operation: Operation, to: u8, a: u8, b: Place) {
        let code = match (operation, self.is_eight()) {
            (Operation::Add, true) => Code::EVEX_Vaddpd_zmm_k1z_zmm_zmmm512b64_er,
            (Operation::Sub, true) => Code::EVEX_Vsubpd_zmm_k1z_zmm_zmmm512b64_er,
            (Operation::Mul, true) => Code::EVEX_Vmulpd_zmm_k1z_zmm_zmmm512b64_er,
            (Operation::Div, true) => Code::EVEX_Vdivpd_zmm_k1z_zmm_zmmm512b64_er,
            (Operation::And, true) => Code::EVEX_Vpandq_zmm_k1z_zmm_zmmm512b64,
            (Operation::Xor, true) => Code::EVEX_Vpxorq_zmm_k1z_zmm_zmmm512b64,
            (Operation::AddBits, true) => Code::EVEX_Vpaddq_zmm_k1z_zmm_zmmm512b64,
            (Operation::Add, false) => Code::VEX_Vaddpd_ymm_ymm_ymmm256,
            (Operation::Sub, false) => Code::VEX_Vsubpd_ymm_ymm_ymmm256,
            (Operation::Mul, false) => Code::VEX_Vmulpd_ymm_ymm_ymmm256,
            (Operation::Div, false) => Code::VEX_Vdivpd_ymm_ymm_ymmm256,
            (Operation::And, false) => Code::VEX_Vandpd_ymm_ymm_ymmm256,
            (Operation::Xor, false) => Code::VEX_Vxorpd_ymm_ymm_ymmm256,
            (Operation::AddBits, false) => Code::VEX_Vpaddq_ymm_ymm_ymmm256,
            _ => unreachable!("no operation of two values"),
        };
        self.three(code, self.vector(to), a, b, None);
    }

    pub(super) fn square_root(&mut self, to: u8, a: Place) {
        let code = match self.is_eight() {
            true => Code::EVEX_Vsqrtpd_zmm_k1z_zmmm512b64_er,
            false => Code::VEX_Vsqrtpd_ymm_ymmm256,
        };
        let to = self.vector(to);
        let instruction = match a {
            Place::Register(a) => Instruction::with2(code, to, self.vector(a)),
            a => Instruction::with2(code, to, self.memory(a)),
        };
        self.write(instruction);
    }

    pub(super) fn shift_left(&mut self, to: u8, a: u8, bits: u8) {
        let code = match self.is_eight() {
            true => Code::EVEX_Vpsllq_zmm_k1z_zmmm512b64_imm8,
            false => Code::VEX_Vpsllq_ymm_ymm_imm8,
        };
        let (to, a) = (self.vector(to), self.vector(a));
        self.write(Instruction::with3(code, to, a, u32::from(bits)));
    }

    /// A product fused with a sum.
    pub(super) fn fused(
        &mut self,
        operation: Operation,
        form: Form,
        to: u8,
        middle: u8,
        last: Place,
    ) {
        use Form::{F132, F213, F231};
        use Operation::{MulAdd, MulSub, NegMulAdd};
        let code = match (operation, form, self.is_eight()) {
            (MulAdd, F132, true) => Code::EVEX_Vfmadd132pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulAdd, F213, true) => Code::EVEX_Vfmadd213pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulAdd, F231, true) => Code::EVEX_Vfmadd231pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulSub, F132, true) => Code::EVEX_Vfmsub132pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulSub, F213, true) => Code::EVEX_Vfmsub213pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulSub, F231, true) => Code::EVEX_Vfmsub231pd_zmm_k1z_zmm_zmmm512b64_er,
            (NegMulAdd, F132, true) => Code::EVEX_Vfnmadd132pd_zmm_k1z_zmm_zmmm512b64_er,
            (NegMulAdd, F213, true) => Code::EVEX_Vfnmadd213pd_zmm_k1z_zmm_zmmm512b64_er,
            (NegMulAdd, F231, true) => Code::EVEX_Vfnmadd231pd_zmm_k1z_zmm_zmmm512b64_er,
            (MulAdd, F132, false) => Code::VEX_Vfmadd132pd_ymm_ymm_ymmm256,
            (MulAdd, F213, false) => Code::VEX_Vfmadd213pd_ymm_ymm_ymmm256,
            (MulAdd, F231, false) => Code::VEX_Vfmadd231pd_ymm_ymm_ymmm256,
            (MulSub, F132, false) => Code::VEX_Vfmsub132pd_ymm_ymm_ymmm256,
            (MulSub, F213, false) => Code::VEX_Vfmsub213pd_ymm_ymm_ymmm256,
            (MulSub, F231, false) => Code::VEX_Vfmsub231pd_ymm_ymm_ymmm256,
            (NegMulAdd, F132, false) => Code::VEX_Vfnmadd132pd_ymm_ymm_ymmm256,
            (NegMulAdd, F213, false) => Code::VEX_Vfnmadd213pd_ymm_ymm_ymmm256,
            (NegMulAdd, F231, false) => Code::VEX_Vfnmadd231pd_ymm_ymm_ymmm256,
            _ => unreachable!("no product and sum"),
        };
        self.three(code, self.vector(to), middle, last, None);
    }

    /// Of eight: to = to xor (a and b).
    pub(super) fn xor_and(&mut self, to: u8, a: u8, b: Place) {
        /// The results of all eight triples of bits.
        const TRIPLES: u32 = 0x78;
        let code = Code::EVEX_Vpternlogq_zmm_k1z_zmm_zmmm512b64_imm8;
        self.three(code, self.vector(to), a, b, Some(TRIPLES));
    }

    /// Of four: all bits where a comparison holds.
    pub(super) fn compare(&mut self, comparison: Comparison, to: u8, a: u8, b: Place) {
        let code = Code::VEX_Vcmppd_ymm_ymm_ymmm256_imm8;
        self.three(code, self.vector(to), a, b, Some(comparison as u32));
    }

    /// Of four: to = a where `mask` has its highest bit, else b.
    pub(super) fn choose(&mut self, to: u8, mask: u8, a: Place, b: u8) {
        let code = Code::VEX_Vblendvpd_ymm_ymm_ymmm256_ymm;
        let (to, b, mask) = (self.vector(to), self.vector(b), self.vector(mask));
        let instruction = match a {
            Place::Register(a) => Instruction::with4(code, to, b, self.vector(a), mask),
            a => Instruction::with4(code, to, b, self.memory(a), mask),
        };
        self.write(instruction);
    }

    /// Of eight: remembers where a comparison holds, for the next [`choose_by`](Self::choose_by).
    pub(super) fn test_comparison(&mut self, comparison: Comparison, a: u8, b: Place) {
        let code = Code::EVEX_Vcmppd_kr_k1_zmm_zmmm512b64_imm8_sae;
        self.three(code, HOLDS, a, b, Some(comparison as u32));
    }

    /// Of eight: remembers in a mask where two values have a bit in common.
    pub(super) fn test_bits(&mut self, mask: u8, a: u8, b: Place) {
        let code = Code::EVEX_Vptestmq_kr_k1_zmm_zmmm512b64;
        self.three(code, Register::K0 + u32::from(mask), a, b, None);
    }

    /// Of eight: to = a where the mask is set (where the comparison holds, without one), else b.
    pub(super) fn choose_by(&mut self, mask: Option<u8>, to: u8, a: Place, b: u8) {
        let mask = mask.map_or(HOLDS, |mask| Register::K0 + u32::from(mask));
        let code = Code::EVEX_Vblendmpd_zmm_k1z_zmm_zmmm512b64;
        self.masked(code, self.vector(to), b, a, None, mask);
    }

    /// Of eight: watches that a is not greater than b.
    pub(super) fn watch_order(&mut self, a: u8, b: Place) {
        let code = Code::EVEX_Vcmppd_kr_k1_zmm_zmmm512b64_imm8_sae;
        self.masked(code, ORDINARY, a, b, Some(Comparison::NotGreater as u32), ORDINARY);
    }

    /// Of four: watches that a has no highest bit.
    pub(super) fn watch_bit(&mut self, a: u8) {
        let a = self.vector(a);
        self.write(Instruction::with2(Code::VEX_Vmovmskpd_r32_ymm, Register::EAX, a));
        self.write(Instruction::with2(Code::Or_r32_rm32, Register::R11D, Register::EAX));
    }
}
