//! Compiles the functions of a model in memory.
//!
//! A model that is read at run time need not wait for rustc: its straight-line code becomes machine
//! code here, within milliseconds. [`Compiled`] is called as the reference interpreter
//! [`Evaluator`](denavit_codegen::program::Evaluator) is, [`CompiledBatch`] as its
//! [`BatchEvaluator`](denavit_codegen::program::BatchEvaluator), and [`CompiledRows`] as that is,
//! but with samples one after the other; all give the bits of theirs.
//!
//! Cranelift makes code for one sample, and for pairs of them. On processors of x86-64 a short
//! generator of our own makes code for four samples at a time (AVX2) or eight (AVX-512); which
//! [`Lanes`] there are is asked at run time.
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
#[cfg(not(target_arch = "x86_64"))]
mod narrow;
mod pairs;
mod rows;
mod single;
mod translate;
#[cfg(target_arch = "x86_64")]
mod wide;

#[cfg(not(target_arch = "x86_64"))]
use narrow as wide;

pub use batch::CompiledBatch;
pub use compiler::{Unsupported, is_supported};
pub use lanes::Lanes;
pub use rows::CompiledRows;
pub use single::Compiled;
