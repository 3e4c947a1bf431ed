//! Expressions of a law as a program whose parameters stand in the order of the effect's.

use crate::error::Error;
use denavit_codegen::expr::{Dag, ExprId};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::program::{BatchEvaluator, Evaluator, Program, lower, prelude_values};

/// A program of one routine.
#[derive(Clone, Debug)]
pub(super) struct LawProgram {
    program: Program,
    /// For each parameter of the program its place among those of the effect.
    order: Vec<usize>,
}

impl LawProgram {
    /// The program from `inputs` and parameters of these names to `entries`.
    pub(super) fn new(
        dag: &Dag,
        parameters: &[String],
        inputs: Vec<ExprId>,
        entries: Vec<ExprId>,
    ) -> Result<Self, Error> {
        let output = Output {
            name: "tau",
            shape: vec![entries.len()],
            entries,
            doc: String::new(),
            details: Vec::new(),
        };
        let function = Function {
            name: FunctionName::InverseDynamics,
            link: None,
            arguments: vec![Argument { name: "q", symbols: inputs }],
            outputs: vec![output],
            form: Form::Plain,
        };
        let program = lower(dag, &[function])?;
        let place = |name: &String| {
            let place = parameters.iter().position(|known| known == name);
            place.expect("a law depends on its own parameters alone")
        };
        let order = program.parameters.iter().map(place).collect();
        Ok(Self { program, order })
    }

    fn prelude(&self, values: &[f64]) -> Vec<f64> {
        let given: Vec<f64> = self.order.iter().map(|&place| values[place]).collect();
        prelude_values(&self.program, &given).expect("one value for each parameter")
    }

    /// All outputs for many samples, one column for each.
    pub(super) fn run(&self, inputs: &[&[f64]], values: &[f64], samples: usize) -> Vec<Vec<f64>> {
        let mut batch = self.batch(values);
        let mut outputs = vec![vec![0.0; samples]; batch.outputs()];
        let mut columns: Vec<&mut [f64]> = outputs.iter_mut().map(Vec::as_mut_slice).collect();
        batch.evaluate(inputs, &mut columns).expect("columns that a law uses have one length");
        outputs
    }

    /// The routine made ready for many samples.
    pub(super) fn batch(&self, values: &[f64]) -> BatchEvaluator<f64> {
        BatchEvaluator::new(&self.program.routines[0], &self.prelude(values))
    }

    /// The routine made ready for one sample after the other.
    pub(super) fn evaluator(&self, values: &[f64]) -> Evaluator<f64> {
        Evaluator::new(&self.program.routines[0], &self.prelude(values))
    }
}
