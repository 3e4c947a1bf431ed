//! Compiles the functions of a model in memory.
//!
//! A model that is read at run time need not wait for rustc: its straight-line code becomes machine
//! code here, within milliseconds, by Cranelift. [`Compiled`] is called as the reference
//! interpreter [`Evaluator`](denavit_codegen::program::Evaluator) is, [`CompiledBatch`] as its
//! [`BatchEvaluator`](denavit_codegen::program::BatchEvaluator); both give the bits of theirs.
//!
//! ```
//! use denavit_codegen::derive::{Flavour, derive};
//! use denavit_codegen::function::FunctionName;
//! use denavit_codegen::program::{Evaluate, lower};
//! use denavit_jit::Compiled;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../models/puma560.json");
//! let robot = denavit_codegen::model::read(path, &std::fs::read(path)?)?;
//! let derivation = derive(&robot, Flavour::Baked, &[FunctionName::GravityVector])?;
//! let program = lower(&derivation.dag, &derivation.functions)?;
//! let mut gravity = Compiled::new(&program.routines[0], &[])?;
//! let mut torques = [0.0; 6];
//! gravity.evaluate(&[&[0.0; 6]], &mut torques)?;
//! assert!((torques[1] - 37.48).abs() < 0.01);
//! # Ok(())
//! # }
//! ```

mod batch;
mod compiler;
mod external;
mod lanes;
mod machine;
mod pairs;
mod single;
mod translate;
#[cfg(target_arch = "x86_64")]
mod wide;

pub use batch::CompiledBatch;
pub use compiler::{Unsupported, is_supported};
pub use lanes::Lanes;
pub use single::Compiled;
