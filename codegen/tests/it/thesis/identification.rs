//! Appendix A.2: the regressor of the double pendulum, from its equations as text.

use denavit_codegen::expr::{Dag, ExprId, SymbolClass, text};
use denavit_codegen::fundamental::{
    Basis, DEFAULT_MEMORY_BYTES, Decomposition, Echelon, Expansion, Matrix, Separated, decompose,
    echelon, equal, equal_columns, separate,
};

/// A.79 and A.80, moved to one side.
const A79: &str = "N1*(IM1*th1dd + BM1*th1d) + Fc1*sign(th1d) + 1/N1*((m1*c1^2 \
    + m2*(l1^2 + c2^2 + 2*l1*c2*cos(th2)) + I1 + I2)*th1dd \
    + (m2*(c2^2 + l1*c2*cos(th2)) + I2)*th2dd \
    + (m1*c1 + m2*l1)*g*cos(th1) + m2*c2*g*cos(th1 + th2)) - tauM1";
const A80: &str = "N2*(IM2*th2dd + BM2*th2d) + Fc2*sign(th2d) + 1/N2*((m2*(c2^2 + l1*c2*cos(th2)) \
    + I2)*th1dd + (m2*c2^2 + I2)*th2dd + m2*c2*g*cos(th1 + th2)) - tauM2";

const KNOWN: [&str; 6] = ["l1", "g", "N1", "N2", "IM1", "IM2"];
const UNKNOWN: [&str; 10] = ["m1", "c1", "I1", "m2", "c2", "I2", "BM1", "Fc1", "BM2", "Fc2"];

/// A.84: the columns, and which products are in each.
const A84: [&[&str]; 9] = [
    &["m2*c2"],
    &["m1*c1"],
    &["m2"],
    &["m1*c1^2", "I1"],
    &["m2*c2^2", "I2"],
    &["BM1"],
    &["Fc1"],
    &["BM2"],
    &["Fc2"],
];

/// A.83, transposed to ne x np as zeta = R0 theta0 asks.
const A83: [[&str; 9]; 2] = [
    [
        "1/N1*(g*cos(th1 + th2) + 2*l1*cos(th2)*th1dd + l1*cos(th2)*th2dd)",
        "1/N1*g*cos(th1)",
        "l1/N1*(g*cos(th1) + th1dd*l1)",
        "1/N1*th1dd",
        "1/N1*(th1dd + th2dd)",
        "N1*th1d",
        "sign(th1d)",
        "0",
        "0",
    ],
    [
        "1/N2*(g*cos(th1 + th2) + l1*cos(th2)*th1dd)",
        "0",
        "0",
        "0",
        "1/N2*(th1dd + th2dd)",
        "0",
        "0",
        "N2*th2d",
        "sign(th2d)",
    ],
];

struct Pendulum {
    dag: Dag,
    separated: Separated,
    /// The columns of A.84 among those found: each stands for all that equal it.
    order: Vec<usize>,
}

fn read(dag: &mut Dag, source: &str) -> ExprId {
    let mut resolve = |dag: &mut Dag, name: &str| {
        let class = if KNOWN.contains(&name) {
            SymbolClass::Geometry
        } else if UNKNOWN.contains(&name) {
            SymbolClass::Inertia
        } else {
            SymbolClass::Configuration
        };
        Some(dag.symbol(name, class))
    };
    text::parse(dag, source, &mut resolve).expect(source)
}

fn pendulum(basis: Basis) -> Pendulum {
    let mut dag = Dag::new();
    let unknowns = UNKNOWN.map(|name| read(&mut dag, name));
    let rows = [A79, A80].map(|source| vec![read(&mut dag, source)]);
    let symbols = dag.symbols().clone();
    let is_known = |id| KNOWN.contains(&symbols[id].name.as_str());
    let matrix = Matrix { rows: &rows, is_known: &is_known, chains: &[] };
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let found = decompose(&mut dag, &matrix, &[basis], &mut expansion).expect("small");
    let separated = separate(&found[0], &unknowns);
    let names: Vec<ExprId> = separated
        .products
        .iter()
        .map(|product| {
            product.iter().fold(dag.one(), |result, &(unknown, exponent)| {
                let power = dag.pow(unknown, exponent);
                dag.mul(result, power)
            })
        })
        .collect();
    let groups = equal_columns(&separated.decomposition);
    let order = A84.map(|members| {
        let mut places: Vec<usize> = members
            .iter()
            .map(|member| {
                let product = read(&mut dag, member);
                names.iter().position(|&name| name == product).expect(member)
            })
            .collect();
        places.sort_unstable();
        assert!(groups.contains(&places), "{members:?} are one column");
        places[0]
    });
    assert_eq!(groups.len(), order.len(), "no other columns");
    Pendulum { dag, separated, order: order.to_vec() }
}

impl Pendulum {
    fn found(&self) -> &Decomposition {
        &self.separated.decomposition
    }

    fn echelon(&mut self) -> Echelon {
        let Self { dag, separated, order } = self;
        echelon(dag, &separated.decomposition, order).expect("small")
    }

    fn same(&mut self, left: ExprId, right: &str) -> bool {
        let right = read(&mut self.dag, right);
        equal(&mut self.dag, left, right).expect("polynomials")
    }
}

#[test]
fn a83_is_the_regressor_of_a79_and_a80_transposed() {
    let mut pendulum = pendulum(Basis::Product);
    for (j, column) in pendulum.order.clone().into_iter().enumerate() {
        for (i, row) in A83.iter().enumerate() {
            let entries = pendulum.found().columns[column].clone();
            let mut sum = pendulum.dag.zero();
            for entry in entries.iter().filter(|entry| entry.equation as usize == i) {
                let function = pendulum.found().functions[entry.function as usize].clone();
                let value = pendulum.found().coefficients[entry.coefficient as usize].clone();
                let dag = &mut pendulum.dag;
                let (function, value) = (function.to_expr(dag), value.to_expr(dag));
                let product = dag.mul(function, value);
                sum = dag.add(sum, product);
            }
            assert!(pendulum.same(sum, row[j]), "R0 {i} {j}");
        }
    }
    // A.82
    let sides = pendulum.separated.left_side(&mut pendulum.dag);
    assert!(pendulum.same(sides[0], "tauM1 - IM1*N1*th1dd"));
    assert!(pendulum.same(sides[1], "tauM2 - IM2*N2*th2dd"));
}

#[test]
fn a86_lists_the_eleven_functions_of_the_product_basis() {
    let mut pendulum = pendulum(Basis::Product);
    let functions = pendulum.found().functions.clone();
    let mut found: Vec<ExprId> = functions.iter().map(|f| f.to_expr(&mut pendulum.dag)).collect();
    let printed = [
        "cos(th1)*cos(th2)",
        "sin(th1)*sin(th2)",
        "cos(th2)*th1dd",
        "cos(th2)*th2dd",
        "cos(th1)",
        "th1dd",
        "th2dd",
        "th1d",
        "sign(th1d)",
        "th2d",
        "sign(th2d)",
    ];
    let mut printed = printed.map(|source| read(&mut pendulum.dag, source));
    found.sort_unstable();
    printed.sort_unstable();
    assert_eq!(found, printed);
    // cos(th1 + th2) is one function of the other basis.
    assert_eq!(super::identification::pendulum(Basis::Fourier).found().functions.len(), 10);
}

#[test]
fn a87_to_a89_are_rebuilt() {
    let mut pendulum = pendulum(Basis::Product);
    let found = pendulum.found();
    assert_eq!((found.equations * found.functions.len(), pendulum.order.len()), (22, 9));
    let nonzeros: usize = pendulum.order.iter().map(|&column| found.columns[column].len()).sum();
    assert_eq!(nonzeros, 19);
    let echelon = pendulum.echelon();
    assert_eq!(echelon.rank(), 8);
    let order = pendulum.order.clone();
    let pivots: Vec<usize> = order.iter().copied().filter(|&column| column != order[3]).collect();
    assert_eq!(echelon.pivots, pivots, "column 4 alone is dependent");
    // column 4 = -(1/l1) column 2 + (1/l1^2) column 3
    let relation: Vec<(usize, ExprId)> = echelon
        .relation(order[3])
        .into_iter()
        .map(|(pivot, factor)| (pivot, factor.to_expr(&mut pendulum.dag)))
        .collect();
    assert_eq!(relation.len(), 2);
    for ((pivot, factor), (column, expected)) in
        relation.into_iter().zip([(order[1], "-1/l1"), (order[2], "1/l1^2")])
    {
        assert_eq!(pivot, column);
        assert!(pendulum.same(factor, expected));
    }
    // B_E has 1 at its pivots and nothing else but column 4.
    for (row, &pivot) in echelon.rows.iter().zip(&echelon.pivots) {
        assert!(row[&pivot].is_one());
        assert!(row.keys().all(|&column| column == pivot || column == order[3]));
    }
}

#[test]
fn a93_has_a_wrong_sign_in_its_second_entry() {
    let mut pendulum = pendulum(Basis::Product);
    let echelon = pendulum.echelon();
    let theta0: Vec<ExprId> =
        A84.iter().map(|members| read(&mut pendulum.dag, &members.join(" + "))).collect();
    let theta: Vec<ExprId> = echelon
        .rows
        .iter()
        .map(|row| {
            let dag = &mut pendulum.dag;
            let mut sum = dag.zero();
            for (&column, factor) in row {
                let place = pendulum.order.iter().position(|&c| c == column).expect("A.84");
                let factor = factor.to_expr(dag);
                let product = dag.mul(factor, theta0[place]);
                sum = dag.add(sum, product);
            }
            sum
        })
        .collect();
    let corrected = [
        "c2*m2",
        "m1*c1 - 1/l1*(m1*c1^2 + I1)",
        "m2 + 1/l1^2*(m1*c1^2 + I1)",
        "c2^2*m2 + I2",
        "BM1",
        "Fc1",
        "BM2",
        "Fc2",
    ];
    for (value, expected) in theta.iter().zip(corrected) {
        assert!(pendulum.same(*value, expected), "{expected}");
    }
    assert!(!pendulum.same(theta[1], "m1*c1 - 1/l1*(m1*c1^2 - I1)"), "as printed");
}
