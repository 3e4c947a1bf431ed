//! The regressor of given equations (thesis, appendix B): every product of unknowns is a column,
//! what has none moves to the left side, and R0_ij = f^T b_ij comes with it.

use super::theta::{Theta, order_of};
use crate::expr::{Dag, EvaluateError, ExprId, SymbolId, free_symbols, text};
use crate::fundamental::{
    Basis, Decomposition, EchelonError, Entry, Expansion, FourierError, Matrix, Wave, decompose,
    equal_columns, separate,
};
use crate::model::Dimension;
use crate::model::equations::Equations;
use std::collections::BTreeSet;
use std::fmt;

/// Why equations have no regressor.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EquationsError {
    /// They are not written out.
    Fourier {
        /// The equations' name.
        name: String,
        /// Why not.
        error: FourierError,
    },
    /// An unknown stands where the equations are no polynomial in it.
    NotPolynomial {
        /// The equations' name.
        name: String,
        /// The unknown.
        unknown: String,
    },
    /// A column to keep that there is not.
    NoColumn {
        /// The equations' name.
        name: String,
        /// What was asked for.
        column: String,
        /// The columns.
        columns: Vec<String>,
    },
    /// No unknown is in any equation.
    NoUnknowns {
        /// The equations' name.
        name: String,
    },
    /// Functions that count as different obey a relation.
    Related {
        /// The equations' name.
        name: String,
        /// The rank of B.
        rank: usize,
        /// The rank of the columns at random points.
        at_points: usize,
    },
    /// B is not eliminated.
    Echelon {
        /// The equations' name.
        name: String,
        /// Why not.
        error: EchelonError,
    },
    /// The equations have no value at a random point.
    Evaluate {
        /// The equations' name.
        name: String,
        /// Why not.
        error: EvaluateError,
    },
}

impl fmt::Display for EquationsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fourier { name, error } => write!(f, "{name}: {error}"),
            Self::NotPolynomial { name, unknown } => write!(
                f,
                "{name}: the equations are no polynomials in the unknown {unknown}\n  hint: \
                 unknowns may stand in sums, products and powers; make {unknown} a known"
            ),
            Self::NoColumn { name, column, columns } => write!(
                f,
                "{name}: there is no column {column}\n  hint: the columns are {}",
                columns.join(", ")
            ),
            Self::NoUnknowns { name } => write!(
                f,
                "{name}: no equation has an unknown\n  hint: declare what is to be found under \
                 \"unknowns\""
            ),
            Self::Related { name, rank, at_points } => write!(
                f,
                "{name}: of {rank} columns only {at_points} are independent at random points: \
                 functions of the equations obey a relation that their form does not show, as \
                 tan^2 = 1/cos^2 - 1\n  hint: multiply the equations by their denominators, and \
                 write tan as sin over cos"
            ),
            Self::Echelon { name, error } => write!(f, "{name}: {error}"),
            Self::Evaluate { name, error } => {
                write!(f, "{name}: the equations have no value: {error}")
            }
        }
    }
}

impl std::error::Error for EquationsError {}

/// zeta = R0 theta0 from equations.
#[derive(Clone, Debug)]
pub struct EquationsRegressor {
    /// Holds all expressions, those of the equations among them.
    pub dag: Dag,
    /// theta0: products of unknowns, or sums of them that act alike (c1^2 m1 + I1).
    pub parameters: Vec<ExprId>,
    /// Their SI units; empty where an unknown has none.
    pub units: Vec<String>,
    /// zeta, equation by equation.
    pub left: Vec<ExprId>,
    /// f and B; the columns are those of theta0.
    pub decomposition: Decomposition,
    name: String,
    /// What the equations ask to be 0.
    residuals: Vec<ExprId>,
}

/// The regressor of equations, in one basis of functions.
pub fn equations_regressor(
    equations: &Equations,
    basis: Basis,
    expansion: &mut Expansion<'_>,
) -> Result<EquationsRegressor, EquationsError> {
    let mut dag = equations.dag.clone();
    let rows: Vec<Vec<ExprId>> =
        equations.equations.iter().map(|one| vec![dag.sub(one.right, one.left)]).collect();
    let knowns: BTreeSet<ExprId> = equations.knowns.iter().map(|known| known.symbol).collect();
    let ids: Vec<SymbolId> = dag.symbols().keys().collect();
    let known_ids: BTreeSet<SymbolId> =
        ids.into_iter().filter(|&id| knowns.contains(&dag.symbol_expr(id))).collect();
    let is_known = |id: SymbolId| known_ids.contains(&id);
    let matrix = Matrix { rows: &rows, is_known: &is_known, chains: &[] };
    let name = equations.name.clone();
    let found = decompose(&mut dag, &matrix, &[basis], expansion)
        .map_err(|error| EquationsError::Fourier { name: name.clone(), error })?;
    let found = found.first().expect("every matrix has the first two bases");
    let unknowns: Vec<ExprId> = equations.unknowns.iter().map(|unknown| unknown.symbol).collect();
    require_polynomial(&dag, found, &unknowns, &equations.name)?;
    let mut separated = separate(found, &unknowns);
    let left = separated.left_side(&mut dag);
    let products: Vec<ExprId> = separated
        .products
        .iter()
        .map(|product| {
            product.iter().fold(dag.one(), |result, &(unknown, exponent)| {
                let power = dag.pow(unknown, exponent);
                dag.mul(result, power)
            })
        })
        .collect();
    if products.is_empty() {
        return Err(EquationsError::NoUnknowns { name });
    }
    let (mut parameters, mut units) = (Vec::new(), Vec::new());
    let mut columns: Vec<Vec<Entry>> = Vec::new();
    for group in equal_columns(&separated.decomposition) {
        let zero = dag.zero();
        parameters.push(group.iter().fold(zero, |sum, &place| dag.add(sum, products[place])));
        units.push(unit(equations, &separated.products[group[0]]));
        columns.push(separated.decomposition.columns[group[0]].clone());
    }
    separated.decomposition.columns = columns;
    let decomposition = separated.decomposition;
    let residuals = rows.concat();
    Ok(EquationsRegressor { dag, parameters, units, left, decomposition, name, residuals })
}

/// The unit of a product of unknowns; empty if one of them has none.
fn unit(equations: &Equations, product: &[(ExprId, i32)]) -> String {
    let unit_of = |unknown: ExprId| {
        let own = equations.unknowns.iter().find(|own| own.symbol == unknown);
        own.and_then(|own| own.unit.as_ref())
    };
    if let [(unknown, 1)] = product {
        return unit_of(*unknown).map_or_else(String::new, |unit| unit.text().to_owned());
    }
    let mut dimension = Some(Dimension::NONE);
    for &(unknown, exponent) in product {
        let power = unit_of(unknown).and_then(|unit| unit.dimension().power(exponent));
        dimension = dimension.zip(power).and_then(|(a, b)| a.times(b));
    }
    dimension.map_or_else(String::new, |dimension| dimension.to_string())
}

/// An unknown may be a factor, with an exponent that is not negative, and nothing else.
fn require_polynomial(
    dag: &Dag,
    found: &Decomposition,
    unknowns: &[ExprId],
    name: &str,
) -> Result<(), EquationsError> {
    let mut below: Vec<ExprId> = Vec::new();
    for function in &found.functions {
        for &(factor, exponent) in &function.factors {
            if exponent < 0 || !unknowns.contains(&factor) {
                below.push(factor);
            }
        }
        match &function.wave {
            Wave::Harmonic { angle, .. } => {
                below.extend(angle.iter().map(|&(angle, _)| angle));
            }
            Wave::Product(powers) => {
                below.extend(powers.iter().map(|&(angle, _, _)| angle));
            }
        }
    }
    let symbols = free_symbols(dag, &below);
    let inside = symbols.into_iter().map(|id| dag.symbols()[id].name.as_str()).find(|symbol| {
        unknowns.iter().any(|&unknown| dag.as_symbol(unknown).is_some_and(|s| s.name == *symbol))
    });
    match inside {
        Some(unknown) => Err(EquationsError::NotPolynomial {
            name: name.to_owned(),
            unknown: unknown.to_owned(),
        }),
        None => Ok(()),
    }
}

impl EquationsRegressor {
    /// The columns' names: their parameters as text.
    pub fn column_names(&self) -> Vec<String> {
        let name = |&parameter: &ExprId| text::print(&self.dag, parameter).to_string();
        self.parameters.iter().map(name).collect()
    }

    /// theta = B_Eu theta0 (thesis 3.3-3.5), with the columns of `keep` kept before others. A name
    /// is the parameter of a column as text.
    pub fn theta<N: AsRef<str>>(&mut self, keep: &[N]) -> Result<Theta, EquationsError> {
        let order = order_of(keep, self.parameters.len(), |name| self.find(name.as_ref()))
            .map_err(|column| EquationsError::NoColumn {
                name: self.name.clone(),
                column,
                columns: self.column_names(),
            })?;
        Theta::new(&mut self.dag, &self.decomposition, &order, self.parameters.clone())
            .map_err(|error| EquationsError::Echelon { name: self.name.clone(), error })
    }

    /// Whether the equations are `zeta = f^T B_u theta` at random points modulo a prime: whether
    /// what was written out, separated and eliminated is still what was given. Columns that are not
    /// independent there are an error.
    pub fn holds(&mut self, theta: &Theta) -> Result<bool, EquationsError> {
        let name = || self.name.clone();
        let at_points = theta
            .rank_at_points(&mut self.dag, &self.decomposition)
            .map_err(|error| EquationsError::Evaluate { name: name(), error })?;
        if at_points < theta.rank() {
            let rank = theta.rank();
            return Err(EquationsError::Related { name: name(), rank, at_points });
        }
        let sides = self.residuals.iter().zip(&self.left);
        let right: Vec<ExprId> =
            sides.map(|(&residual, &left)| self.dag.add(residual, left)).collect();
        theta
            .holds(&mut self.dag, &self.decomposition, &right)
            .map_err(|error| EquationsError::Evaluate { name: self.name.clone(), error })
    }

    /// The column of a name.
    fn find(&mut self, wanted: &str) -> Option<usize> {
        let mut resolve = |dag: &mut Dag, name: &str| {
            let id = dag.find_symbol(name)?;
            Some(dag.symbol_expr(id))
        };
        let expr = text::parse(&mut self.dag, wanted, &mut resolve).ok()?;
        self.parameters.iter().position(|&parameter| parameter == expr)
    }
}
