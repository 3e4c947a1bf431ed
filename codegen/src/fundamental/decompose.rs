//! R0 = f^T B: the entries of a matrix as combinations of few functions of the motion, with
//! coefficients that are known (thesis 3.2, 3.3).

use super::basis::{cumulated, product_powers, products};
use super::expand::{Expansion, FourierError, Stop, expand};
use super::key::Key;
use super::layout::{Layout, expanded_nodes};
use super::polynomial::{Monomial, Polynomial};
use super::series::{Series, SeriesError};
use super::whole::Whole;
use crate::expr::{Dag, ExprId, SymbolId};
use crate::number::Rational;
use num_bigint::BigInt;
use rustc_hash::FxHashMap;
use std::fmt;

/// What the functions are made of, besides rates, accelerations and opaque factors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Basis {
    /// `cos(k.q)` and `sin(k.q)`.
    Fourier,
    /// Products of `1, c, s, c^2, c s, ..` of single angles.
    Product,
    /// The same of cumulated angles along groups of parallel axes.
    Cumulated,
}

impl Basis {
    /// Every basis, in the order in which they are tried.
    pub const ALL: [Self; 3] = [Self::Fourier, Self::Product, Self::Cumulated];

    /// The name in flags and JSON.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Fourier => "fourier",
            Self::Product => "product",
            Self::Cumulated => "cumulated",
        }
    }

    /// The basis of a name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|basis| basis.as_str() == name)
    }
}

impl fmt::Display for Basis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

/// A matrix to be decomposed.
pub struct Matrix<'a> {
    /// The entries: rows are equations, all with the same number of columns.
    pub rows: &'a [Vec<ExprId>],
    /// Tells the symbols that belong to B (lengths, gear ratios, gravity) from those of f.
    pub is_known: &'a dyn Fn(SymbolId) -> bool,
    /// Groups of angles that are cumulated in [`Basis::Cumulated`]: the q of parallel axes, in
    /// order from the base. An angle may be in one group.
    pub chains: &'a [Vec<ExprId>],
}

/// A fundamental function.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FundamentalFunction {
    /// Powers of rates, accelerations and other factors.
    pub factors: Vec<(ExprId, i32)>,
    /// What it has of angles.
    pub wave: Wave,
}

/// What a fundamental function has of angles.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wave {
    /// The cosine or sine of a combination of angles; of none for the function 1.
    Harmonic {
        /// Angles with their multiples.
        angle: Vec<(ExprId, i32)>,
        /// Whether it is a sine.
        is_sine: bool,
    },
    /// The product of `c^power`, and `s` or not, over angles.
    Product(Vec<(ExprId, u32, bool)>),
}

impl FundamentalFunction {
    /// The function as an expression.
    pub fn to_expr(&self, dag: &mut Dag) -> ExprId {
        let mut product = match &self.wave {
            Wave::Harmonic { angle, is_sine } => {
                let mut sum = dag.zero();
                for &(angle, multiple) in angle {
                    let multiple = dag.integer(multiple.into());
                    let part = dag.mul(multiple, angle);
                    sum = dag.add(sum, part);
                }
                if *is_sine { dag.sin(sum) } else { dag.cos(sum) }
            }
            Wave::Product(powers) => {
                let mut product = dag.one();
                for &(angle, power, has_sine) in powers {
                    if power > 0 {
                        let cosine = dag.cos(angle);
                        let cosines = dag.pow(cosine, power as i32);
                        product = dag.mul(product, cosines);
                    }
                    if has_sine {
                        let sine = dag.sin(angle);
                        product = dag.mul(product, sine);
                    }
                }
                product
            }
        };
        for &(factor, exponent) in &self.factors {
            let power = dag.pow(factor, exponent);
            product = dag.mul(product, power);
        }
        product
    }
}

/// A nonzero entry of B, in a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Entry {
    /// The equation.
    pub equation: u32,
    /// The function.
    pub function: u32,
    /// The coefficient, an index into [`Decomposition::coefficients`].
    pub coefficient: u32,
}

/// A matrix as f^T B.
#[derive(Clone, Debug)]
pub struct Decomposition {
    /// What the functions are made of.
    pub basis: Basis,
    /// f.
    pub functions: Vec<FundamentalFunction>,
    /// The number of equations.
    pub equations: usize,
    /// Every coefficient that comes up, once, as a polynomial in known expressions.
    pub coefficients: Vec<Polynomial>,
    /// B by columns; each is ordered by equation and function.
    pub columns: Vec<Vec<Entry>>,
}

impl Decomposition {
    /// The number of nonzero entries of B.
    pub fn nonzeros(&self) -> usize {
        self.columns.iter().map(Vec::len).sum()
    }

    /// Rows and columns of B: its rows are equation by equation the functions (thesis 3.3).
    pub fn shape(&self) -> (usize, usize) {
        (self.equations * self.functions.len(), self.columns.len())
    }
}

/// The decomposition in each of the bases that the matrix has, in the order asked for.
/// [`Basis::Cumulated`] is left out where no two angles are in one group.
pub fn decompose(
    dag: &mut Dag,
    matrix: &Matrix<'_>,
    bases: &[Basis],
    expansion: &mut Expansion<'_>,
) -> Result<Vec<Decomposition>, FourierError> {
    let outputs: Vec<ExprId> = matrix.rows.iter().flatten().copied().collect();
    let nodes = expanded_nodes(dag, &outputs);
    let layout = Layout::new(dag, &nodes, matrix.is_known, matrix.chains)?;
    let job = Job { matrix, outputs: &outputs, nodes: &nodes, layout: &layout, bases };
    let result = match layout.end {
        0..=64 => job.run::<1, i64>(dag, expansion),
        65..=128 => job.run::<2, i64>(dag, expansion),
        129..=256 => job.run::<4, i64>(dag, expansion),
        257..=2048 => job.run::<32, i64>(dag, expansion),
        _ => return Err(FourierError::TooManyIndeterminates),
    };
    let result = match result {
        Err(Stop::Overflow) if layout.end <= 128 => job.run::<2, BigInt>(dag, expansion),
        Err(Stop::Overflow) => job.run::<32, BigInt>(dag, expansion),
        result => result,
    };
    result.map_err(|stop| match stop {
        Stop::Error(error) => error,
        Stop::Overflow => unreachable!("integers without bounds do not overflow"),
    })
}

/// The smallest decomposition: fewest functions, then fewest entries of B.
pub fn smallest(decompositions: Vec<Decomposition>) -> Option<Decomposition> {
    decompositions.into_iter().min_by_key(|found| (found.functions.len(), found.nonzeros()))
}

struct Job<'a> {
    matrix: &'a Matrix<'a>,
    outputs: &'a [ExprId],
    nodes: &'a [ExprId],
    layout: &'a Layout,
    bases: &'a [Basis],
}

impl Job<'_> {
    fn run<const N: usize, C: Whole>(
        &self,
        dag: &mut Dag,
        expansion: &mut Expansion<'_>,
    ) -> Result<Vec<Decomposition>, Stop> {
        let series = expand::<N, C>(dag, self.nodes, self.outputs, self.layout, expansion)?;
        let limit = expansion.allowed_terms::<N, C>();
        let chains: Vec<Vec<usize>> = self
            .matrix
            .chains
            .iter()
            .map(|chain| chain.iter().filter_map(|&q| self.layout.find_angle(q)).collect())
            .filter(|chain: &Vec<usize>| chain.len() > 1)
            .collect();
        let mut result = Vec::new();
        for &basis in self.bases {
            if basis != Basis::Cumulated || !chains.is_empty() {
                let tables = self.tables(&series, basis, &chains, limit);
                let tables = tables.map_err(|error| match error {
                    SeriesError::Overflow => Stop::Overflow,
                    SeriesError::TooManyTerms => {
                        Stop::too_large(expansion, self.nodes.len(), self.nodes.len())
                    }
                })?;
                result.push(tables.finish(dag, self, basis, &chains));
            }
        }
        Ok(result)
    }

    fn tables<const N: usize, C: Whole>(
        &self,
        series: &FxHashMap<ExprId, Series<N, C>>,
        basis: Basis,
        chains: &[Vec<usize>],
        limit: usize,
    ) -> Result<Tables<N, C>, SeriesError> {
        let columns = self.matrix.rows.first().map_or(0, Vec::len);
        let mut tables =
            Tables { functions: Index::new(), coefficients: Index::new(), columns: Vec::new() };
        for column in 0..columns {
            let mut entries = Vec::new();
            for (equation, row) in self.matrix.rows.iter().enumerate() {
                let entry = &series[&row[column]];
                let terms = products(self.layout, entry.terms.clone(), true, limit)?;
                let terms = match basis {
                    Basis::Fourier => terms,
                    Basis::Product => products(self.layout, terms, false, limit)?,
                    Basis::Cumulated => {
                        let terms = cumulated(self.layout, chains, &terms);
                        products(self.layout, terms, false, limit)?
                    }
                };
                let found = self.by_function(&entry.denominator, terms);
                entries.extend(found.into_iter().map(|(function, coefficient)| Entry {
                    equation: equation as u32,
                    function: tables.functions.of(function),
                    coefficient: tables.coefficients.of(coefficient),
                }));
            }
            tables.columns.push(entries);
        }
        Ok(tables)
    }

    /// The terms of an entry, by function.
    fn by_function<const N: usize, C: Whole>(
        &self,
        denominator: &C,
        terms: Vec<(Key<N>, C)>,
    ) -> Vec<(Key<N>, Coefficient<N, C>)> {
        let layout = self.layout;
        let mut split: Vec<(Key<N>, Key<N>, C)> = terms
            .into_iter()
            .map(|(key, c)| {
                let flag = key.flag();
                let key = key.with_flag(false);
                let waves = key.below(layout.function_angles_end);
                let above = key.minus(waves);
                let known_waves = above.below(layout.angles_end);
                let factors = above.minus(known_waves);
                let function = factors.below(layout.functions_end);
                let known = factors.minus(function).plus(known_waves);
                (function.plus(waves).with_flag(flag), known, c)
            })
            .collect();
        split.sort_unstable_by_key(|a| (a.0, a.1));
        let groups = split.chunk_by(|a, b| a.0 == b.0);
        groups
            .map(|group| {
                let divisor = group.iter().fold(denominator.clone(), |d, term| d.gcd(&term.2));
                let terms = group.iter().map(|(_, known, c)| (*known, c.over(&divisor))).collect();
                (group[0].0, Coefficient { denominator: denominator.over(&divisor), terms })
            })
            .collect()
    }
}

/// A coefficient of B: (known monomial, numerator) over a common denominator.
#[derive(Clone, PartialEq, Eq, Hash)]
struct Coefficient<const N: usize, C> {
    denominator: C,
    terms: Vec<(Key<N>, C)>,
}

/// Numbers for things, in the order in which they come.
struct Index<T> {
    numbers: FxHashMap<T, u32>,
    things: Vec<T>,
}

impl<T: Clone + Eq + std::hash::Hash> Index<T> {
    fn new() -> Self {
        Self { numbers: FxHashMap::default(), things: Vec::new() }
    }

    fn of(&mut self, thing: T) -> u32 {
        if let Some(&number) = self.numbers.get(&thing) {
            return number;
        }
        let number = self.things.len() as u32;
        self.things.push(thing.clone());
        self.numbers.insert(thing, number);
        number
    }
}

struct Tables<const N: usize, C> {
    functions: Index<Key<N>>,
    coefficients: Index<Coefficient<N, C>>,
    columns: Vec<Vec<Entry>>,
}

impl<const N: usize, C: Whole> Tables<N, C> {
    /// Unpacks the keys, and puts the functions in order.
    fn finish(
        self,
        dag: &mut Dag,
        job: &Job<'_>,
        basis: Basis,
        chains: &[Vec<usize>],
    ) -> Decomposition {
        let layout = job.layout;
        let angles = displayed_angles(dag, layout, basis, chains);
        let unpacked: Vec<_> = self
            .functions
            .things
            .iter()
            .map(|&key| unpack_function(layout, &angles, basis, key))
            .collect();
        let mut order: Vec<usize> = (0..unpacked.len()).collect();
        order.sort_by_key(|&index| &unpacked[index]);
        let mut rank = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| rank[old] = new as u32);
        let mut columns = self.columns;
        for entries in &mut columns {
            entries.iter_mut().for_each(|entry| entry.function = rank[entry.function as usize]);
            entries.sort_unstable();
        }
        let waves: Vec<_> =
            layout.angles.iter().map(|atom| (dag.cos(atom.expr), dag.sin(atom.expr))).collect();
        let coefficients = self.coefficients.things.iter();
        Decomposition {
            basis,
            functions: order.iter().map(|&index| unpacked[index].clone()).collect(),
            equations: job.matrix.rows.len(),
            coefficients: coefficients.map(|c| unpack_coefficient(layout, &waves, c)).collect(),
            columns,
        }
    }
}

/// The angle that the field of each angle stands for.
fn displayed_angles(
    dag: &mut Dag,
    layout: &Layout,
    basis: Basis,
    chains: &[Vec<usize>],
) -> Vec<ExprId> {
    let mut angles: Vec<ExprId> = layout.angles.iter().map(|atom| atom.expr).collect();
    if basis == Basis::Cumulated {
        for pair in chains.iter().flat_map(|chain| chain.windows(2)) {
            angles[pair[1]] = dag.add(angles[pair[0]], angles[pair[1]]);
        }
    }
    angles
}

fn unpack_function<const N: usize>(
    layout: &Layout,
    angles: &[ExprId],
    basis: Basis,
    key: Key<N>,
) -> FundamentalFunction {
    let is_sine = key.flag();
    let key = key.with_flag(false);
    let waves = key.below(layout.function_angles_end);
    let factors = layout.exponents(&layout.factors, key.minus(waves));
    let factors = factors.into_iter().map(|(index, n)| (layout.factors[index].expr, n)).collect();
    let exponents = layout.exponents(&layout.angles, waves);
    let wave = if basis == Basis::Fourier {
        let angle = exponents.into_iter().map(|(index, n)| (angles[index], n)).collect();
        Wave::Harmonic { angle, is_sine }
    } else {
        let powers = exponents.into_iter().map(|(index, code)| {
            let (power, has_sine) = product_powers(code);
            (angles[index], power, has_sine)
        });
        Wave::Product(powers.collect())
    };
    FundamentalFunction { factors, wave }
}

fn unpack_coefficient<const N: usize, C: Whole>(
    layout: &Layout,
    waves: &[(ExprId, ExprId)],
    coefficient: &Coefficient<N, C>,
) -> Polynomial {
    let mut polynomial = Polynomial::zero();
    let denominator = coefficient.denominator.to_big();
    for (key, numerator) in &coefficient.terms {
        let angles = key.below(layout.angles_end);
        let mut monomial = Monomial::default();
        let mut multiply = |atom: ExprId, exponent: i32| {
            let power = Monomial::atom(atom).power(exponent);
            let product = power.and_then(|power| monomial.times(&power));
            monomial = product.expect("exponents are at most 4096");
        };
        for (index, code) in layout.exponents(&layout.angles, angles) {
            let (power, has_sine) = product_powers(code);
            let (cosine, sine) = waves[index];
            multiply(cosine, power as i32);
            if has_sine {
                multiply(sine, 1);
            }
        }
        for (index, exponent) in layout.exponents(&layout.factors, key.minus(angles)) {
            multiply(layout.factors[index].expr, exponent);
        }
        let value = Rational::new(numerator.to_big(), denominator.clone());
        polynomial.add_term(monomial, value);
    }
    polynomial
}
