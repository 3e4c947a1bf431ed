//! From equations written out to columns: every product of unknowns becomes a column, and what has
//! none moves to the left side (thesis 3.1, appendix B).

use super::decompose::{Decomposition, Entry, FundamentalFunction};
use crate::expr::{Dag, ExprId};
use std::collections::BTreeMap;

/// Equations as combinations of products of unknowns.
#[derive(Clone, Debug)]
pub struct Separated {
    /// The products, as powers of unknowns, in the order of the columns.
    pub products: Vec<Vec<(ExprId, i32)>>,
    /// f and B of the columns.
    pub decomposition: Decomposition,
    /// What each equation has besides: (function, index into the coefficients).
    pub known: Vec<Vec<(FundamentalFunction, u32)>>,
}

impl Separated {
    /// zeta: what has no unknowns, equation by equation, on the left side of `zeta = R0 theta0`.
    pub fn left_side(&self, dag: &mut Dag) -> Vec<ExprId> {
        let mut sides = Vec::new();
        for terms in &self.known {
            let mut side = dag.zero();
            for (function, coefficient) in terms {
                let function = function.to_expr(dag);
                let coefficient =
                    self.decomposition.coefficients[*coefficient as usize].to_expr(dag);
                let term = dag.mul(coefficient, function);
                side = dag.sub(side, term);
            }
            sides.push(side);
        }
        sides
    }
}

/// The unknowns of a column by their rank, with exponents.
type Unknowns = Vec<(usize, i32)>;

/// Equation, function without unknowns, and coefficient of an entry of B.
type Separate = (u32, FundamentalFunction, u32);

/// Separates the unknowns from equations that were decomposed as a matrix of one column, with the
/// unknowns among the factors of the functions. Columns come in the order of `unknowns`: by the
/// first unknown in them, its exponent, then by the others.
pub fn separate(found: &Decomposition, unknowns: &[ExprId]) -> Separated {
    let rank = |factor: ExprId| unknowns.iter().position(|&unknown| unknown == factor);
    let mut columns: BTreeMap<Unknowns, Vec<Separate>> = BTreeMap::new();
    for entry in found.columns.iter().flatten() {
        let function = &found.functions[entry.function as usize];
        let (mut product, mut factors) = (Vec::new(), Vec::new());
        for &(factor, exponent) in &function.factors {
            match rank(factor) {
                Some(rank) => product.push((rank, exponent)),
                None => factors.push((factor, exponent)),
            }
        }
        product.sort_unstable();
        let function = FundamentalFunction { factors, wave: function.wave.clone() };
        columns.entry(product).or_default().push((entry.equation, function, entry.coefficient));
    }
    let mut known = vec![Vec::new(); found.equations];
    for (equation, function, coefficient) in columns.remove(&Vec::new()).unwrap_or_default() {
        known[equation as usize].push((function, coefficient));
    }
    let mut functions: Vec<FundamentalFunction> =
        columns.values().flatten().map(|(_, function, _)| function.clone()).collect();
    functions.sort();
    functions.dedup();
    let number = |function: &FundamentalFunction| {
        functions.binary_search(function).expect("every function was listed") as u32
    };
    let (mut products, mut entries) = (Vec::new(), Vec::new());
    for (product, column) in columns {
        let powers = product.into_iter().map(|(rank, exponent)| (unknowns[rank], exponent));
        products.push(powers.collect());
        let mut column: Vec<Entry> = column
            .into_iter()
            .map(|(equation, function, coefficient)| Entry {
                equation,
                function: number(&function),
                coefficient,
            })
            .collect();
        column.sort_unstable();
        entries.push(column);
    }
    let decomposition = Decomposition {
        basis: found.basis,
        functions,
        equations: found.equations,
        coefficients: found.coefficients.clone(),
        columns: entries,
    };
    Separated { products, decomposition, known }
}

/// Groups of equal columns of B, each as the columns that are in it; the first of a group stands
/// for all of them, because only the sum of their parameters acts (c1^2 m1 + I1 in A.84).
pub fn equal_columns(decomposition: &Decomposition) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (index, column) in decomposition.columns.iter().enumerate() {
        let same = groups.iter_mut().find(|group| decomposition.columns[group[0]] == *column);
        match same {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    groups
}
