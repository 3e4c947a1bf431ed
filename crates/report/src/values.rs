//! The numbers behind a model's expressions.

use denavit_codegen::expr::text::print;
use denavit_codegen::expr::{Dag, ExprId, substitute};
use denavit_codegen::model::Robot;
use denavit_codegen::number::to_f64;
use denavit_codegen::program::constant_values;
use denavit_numerics::short;
use rustc_hash::FxHashMap;

/// Expressions of one robot with the values that its file gives in place of its parameters.
#[derive(Clone, Debug)]
pub struct Values {
    dag: Dag,
    defaults: FxHashMap<ExprId, ExprId>,
}

impl Values {
    /// The values of `robot`.
    pub fn new(robot: &Robot) -> Self {
        Self::in_graph(&robot.dag, robot)
    }

    /// The values of expressions in a graph that grew from that of `robot`.
    pub fn in_graph(dag: &Dag, robot: &Robot) -> Self {
        let parameters = robot.parameters.values();
        let given = parameters.filter_map(|parameter| Some((parameter.symbol, parameter.default?)));
        Self { dag: dag.clone(), defaults: given.collect() }
    }

    /// The value of an expression of the robot; none if it needs a parameter that has none.
    pub fn number(&mut self, expr: ExprId) -> Option<f64> {
        let known = substitute(&mut self.dag, &[expr], &self.defaults)[0];
        match self.dag.as_constant(known) {
            Some(value) => Some(to_f64(value)),
            None if self.dag.classes(known).is_empty() => {
                constant_values(&self.dag, &[known]).first().copied()
            }
            None => None,
        }
    }

    /// The value of a sum, added exactly.
    pub fn sum(&mut self, terms: &[ExprId]) -> Option<f64> {
        let known = substitute(&mut self.dag, terms, &self.defaults);
        let zero = self.dag.zero();
        let sum = known.into_iter().fold(zero, |sum, term| self.dag.add(sum, term));
        self.number(sum)
    }

    /// The expression as the model writes it.
    pub fn formula(&self, expr: ExprId) -> String {
        print(&self.dag, expr)
    }

    /// The value in few digits, or the formula where there is none.
    pub fn show(&mut self, expr: ExprId) -> String {
        match self.number(expr) {
            Some(value) => short(value),
            None => self.formula(expr),
        }
    }
}
