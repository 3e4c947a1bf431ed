//! The code generator, set up for this processor.

use crate::external;
use crate::machine::Machine;
use crate::translate::Callees;
use cranelift_codegen::ir::types::{F64, I64};
use cranelift_codegen::ir::{AbiParam, Type};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{Linkage, Module, default_libcall_names};
use denavit_codegen::program::{Leaf, Routine};
use std::fmt;

/// Instructions from which on registers are assigned in one pass: the time of the search grows
/// faster than the code. TUlip's `forward_dynamics_derivatives`, 28000 instructions, is there in
/// 20 ms instead of 0.6 s, and takes 1.5 times as long.
const LARGE: usize = 16_384;

/// Why code is not compiled: there is no generator for this processor, or it has no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unsupported {
    reason: String,
}

impl Unsupported {
    pub(crate) fn because(reason: impl fmt::Display) -> Self {
        Self { reason: reason.to_string() }
    }
}

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "no code can be compiled in memory on this machine: {}", self.reason)
    }
}

impl std::error::Error for Unsupported {}

/// Whether there is a code generator for this processor, or why not.
///
/// # Errors
/// If there is none.
pub fn is_supported() -> Result<(), Unsupported> {
    module("backtracking").map(drop)
}

/// Compiles one function of `parameters` addresses (the last one may be a count); `body` writes it,
/// given the block that it starts in, and does not end it.
///
/// # Panics
/// If a leaf reads beyond its argument: lengths are compared at each call, entries only here.
pub(crate) fn compile(
    parameters: usize,
    routine: &Routine,
    body: impl FnOnce(&mut FunctionBuilder<'_>, Callees, &Routine),
) -> Result<Machine, Unsupported> {
    if std::mem::size_of::<usize>() != 8 {
        return Err(Unsupported::because("its addresses have no 64 bits"));
    }
    check_entries(routine);
    let is_large = routine.code.instructions.len() >= LARGE;
    let mut module = module(if is_large { "single_pass" } else { "backtracking" })?;
    let mut context = module.make_context();
    let mut builders = FunctionBuilderContext::new();
    context.func.signature = signature(&module, &vec![I64; parameters], None);
    let mut builder = FunctionBuilder::new(&mut context.func, &mut builders);
    let block = builder.create_block();
    builder.append_block_params_for_function_params(block);
    builder.switch_to_block(block);
    let callees = callees(&mut module, &mut builder)?;
    body(&mut builder, callees, routine);
    builder.seal_all_blocks();
    builder.finalize();

    let signature = context.func.signature.clone();
    let name = routine.full_name();
    let id =
        module.declare_function(&name, Linkage::Local, &signature).map_err(Unsupported::because)?;
    module.define_function(id, &mut context).map_err(Unsupported::because)?;
    module.finalize_definitions().map_err(Unsupported::because)?;
    Ok(Machine::new(module, id))
}

/// Sees that leaves are entries of their arguments.
///
/// # Panics
/// If one is beyond.
pub(crate) fn check_entries(routine: &Routine) {
    for leaf in routine.code.leaves.values() {
        if let Leaf::Argument { argument, entry } = *leaf {
            assert!(entry < routine.arguments[argument].len, "an entry beyond its argument");
        }
    }
}

/// The generator, with an algorithm that assigns registers.
fn module(registers: &str) -> Result<JITModule, Unsupported> {
    let mut flags = settings::builder();
    // Expressions share what they can before they come here, so that optimising finds nothing.
    let wanted = [
        ("opt_level", "none"),
        ("enable_verifier", if cfg!(debug_assertions) { "true" } else { "false" }),
        ("use_colocated_libcalls", "false"),
        ("is_pic", "false"),
        // Frames of large functions are longer than the page that guards a stack.
        ("enable_probestack", "true"),
        ("probestack_strategy", "inline"),
        ("regalloc_algorithm", registers),
    ];
    for (name, value) in wanted {
        flags.set(name, value).map_err(Unsupported::because)?;
    }
    let target = cranelift_native::builder().map_err(Unsupported::because)?;
    let target = target.finish(settings::Flags::new(flags)).map_err(Unsupported::because)?;
    let mut builder = JITBuilder::with_isa(target, default_libcall_names());
    builder.symbols(external::ADDRESSES.iter().map(|(name, address)| (*name, address())));
    Ok(JITModule::new(builder))
}

fn signature(
    module: &JITModule,
    parameters: &[Type],
    result: Option<Type>,
) -> cranelift_codegen::ir::Signature {
    let mut signature = module.make_signature();
    signature.params.extend(parameters.iter().map(|&kind| AbiParam::new(kind)));
    signature.returns.extend(result.map(AbiParam::new));
    signature
}

/// Declares the runtime's functions in a function.
fn callees(
    module: &mut JITModule,
    builder: &mut FunctionBuilder<'_>,
) -> Result<Callees, Unsupported> {
    let mut callee = |name: &str, parameters: &[Type], result: Option<Type>| {
        let signature = signature(module, parameters, result);
        let id = module
            .declare_function(name, Linkage::Import, &signature)
            .map_err(Unsupported::because)?;
        Ok(module.declare_func_in_func(id, builder.func))
    };
    Ok(Callees {
        sincos: callee("sincos", &[I64, I64], None)?,
        tangent: callee("tangent", &[F64], Some(F64))?,
        exponential: callee("exponential", &[F64], Some(F64))?,
        logarithm: callee("logarithm", &[F64], Some(F64))?,
        hyperbolic_tangent: callee("hyperbolic_tangent", &[F64], Some(F64))?,
        arctangent2: callee("arctangent2", &[F64, F64], Some(F64))?,
    })
}
