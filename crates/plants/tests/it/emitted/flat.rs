//! The results of emitted functions as lists, and the interpreters beside them.

use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{self, Robot};
use denavit_codegen::number::Residue;
use denavit_codegen::program::{
    BatchEvaluator, Evaluator, Program, Routine, fuse, lower, parameter_defaults, prelude_values,
};
use std::path::{Path, PathBuf};

/// Entries of nested arrays, last index fastest.
pub(super) trait Flat<S> {
    fn flat(&self) -> Vec<S>;
}

impl Flat<f64> for f64 {
    fn flat(&self) -> Vec<f64> {
        vec![*self]
    }
}

impl Flat<f32> for f32 {
    fn flat(&self) -> Vec<f32> {
        vec![*self]
    }
}

impl<S, T: Flat<S>, const N: usize> Flat<S> for [T; N] {
    fn flat(&self) -> Vec<S> {
        self.iter().flat_map(Flat::flat).collect()
    }
}

/// Numbers that are compared by their bits.
pub(super) trait Bits {
    fn bits(&self) -> u64;
}

impl Bits for f64 {
    fn bits(&self) -> u64 {
        self.to_bits()
    }
}

impl Bits for f32 {
    fn bits(&self) -> u64 {
        u64::from(self.to_bits())
    }
}

pub(super) fn bits<T: Bits>(values: &[T]) -> Vec<u64> {
    values.iter().map(Bits::bits).collect()
}

/// A file of the project.
pub(super) fn project(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A model, lowered here and now, with its prelude for the model's own parameters.
pub(super) struct Interpreted {
    pub(super) program: Program,
    prelude: Vec<f64>,
}

impl Interpreted {
    pub(super) fn new(model: &str, flavour: Flavour, functions: &[FunctionName]) -> Self {
        let path = project(&format!("models/{model}.json"));
        let robot = model::read(model, &std::fs::read(path).unwrap()).unwrap();
        let derivation = derive(&robot, flavour, functions).unwrap();
        let program = lower(&derivation.dag, &derivation.functions).unwrap();
        Self::with(program, &robot)
    }

    /// The same with products fused.
    pub(super) fn fused(model: &str, flavour: Flavour, functions: &[FunctionName]) -> Self {
        let mut interpreted = Self::new(model, flavour, functions);
        fuse(&mut interpreted.program);
        interpreted
    }

    fn with(program: Program, robot: &Robot) -> Self {
        let defaults = parameter_defaults(&program, robot);
        let parameters: Vec<f64> = defaults.into_iter().map(Option::unwrap).collect();
        let prelude = prelude_values(&program, &parameters).unwrap();
        Self { program, prelude }
    }

    pub(super) fn routine(&self, name: FunctionName, link: Option<&str>) -> &Routine {
        self.program.find(name, link).unwrap()
    }

    pub(super) fn one(&self, routine: &Routine, arguments: &[&[f64]]) -> Vec<f64> {
        let mut evaluator = Evaluator::<f64>::new(routine, &self.prelude);
        let mut outputs = vec![f64::NAN; evaluator.outputs()];
        evaluator.evaluate(arguments, &mut outputs).unwrap();
        outputs
    }

    pub(super) fn one_f32(&self, routine: &Routine, arguments: &[&[f32]]) -> Vec<f32> {
        let mut evaluator = Evaluator::<f32>::new(routine, &self.prelude);
        let mut outputs = vec![f32::NAN; evaluator.outputs()];
        evaluator.evaluate(arguments, &mut outputs).unwrap();
        outputs
    }

    /// All samples at once; `samples[k][a]` is argument a of sample k.
    pub(super) fn many(&self, routine: &Routine, samples: &[Vec<Vec<f64>>]) -> Vec<Vec<f64>> {
        let mut batch = BatchEvaluator::<f64>::new(routine, &self.prelude);
        let flat: Vec<Vec<f64>> =
            samples.iter().map(|arguments| arguments[..routine.arguments.len()].concat()).collect();
        let column = |entry: usize| flat.iter().map(|sample| sample[entry]).collect();
        let inputs: Vec<Vec<f64>> = (0..batch.inputs()).map(column).collect();
        let inputs: Vec<&[f64]> = inputs.iter().map(|column| &column[..]).collect();
        let mut outputs = vec![vec![f64::NAN; samples.len()]; batch.outputs()];
        let mut columns: Vec<&mut [f64]> = outputs.iter_mut().map(|c| &mut c[..]).collect();
        batch.evaluate(&inputs, &mut columns).unwrap();
        (0..samples.len()).map(|k| outputs.iter().map(|column| column[k]).collect()).collect()
    }
}

/// Three vectors of numbers in [-3, 3), from a written seed.
pub(super) fn random_sample(seed: u64, dof: usize) -> Vec<Vec<f64>> {
    let number = |vector: usize, entry: usize| {
        let bits = Residue::scrambled(seed, (1000 * vector + entry) as u64).value() >> 8;
        bits as f64 / (1_u64 << 53) as f64 * 6.0 - 3.0
    };
    (0..3).map(|vector| (0..dof).map(|entry| number(vector, entry)).collect()).collect()
}
