//! A planar arm with two links, written by hand: the functions from the textbook's equations, and
//! the same equations in plain floating point to compare with.

use denavit_codegen::expr::{Dag, ExprId, SymbolClass};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};

/// m1, m2, l1, c1, c2, I1, I2 (about the centres of mass) and g, in this order.
pub(crate) const PARAMETERS: [(&str, SymbolClass); 8] = [
    ("m1", SymbolClass::Inertia),
    ("m2", SymbolClass::Inertia),
    ("l1", SymbolClass::Geometry),
    ("c1", SymbolClass::Inertia),
    ("c2", SymbolClass::Inertia),
    ("I1", SymbolClass::Inertia),
    ("I2", SymbolClass::Inertia),
    ("g", SymbolClass::Geometry),
];

/// The arm's graph with its inverse dynamics and its mass matrix.
pub(crate) fn functions() -> (Dag, Vec<Function>) {
    let mut dag = Dag::new();
    let [m1, m2, l1, c1, c2, i1, i2, g] = PARAMETERS.map(|(name, class)| dag.symbol(name, class));
    let vector = |dag: &mut Dag, name: &'static str, class| Argument {
        name,
        symbols: (1..=2).map(|j| dag.symbol(&format!("{name}_{j}"), class)).collect(),
    };
    let q = vector(&mut dag, "q", SymbolClass::Configuration);
    let qd = vector(&mut dag, "qd", SymbolClass::Rate);
    let qdd = vector(&mut dag, "qdd", SymbolClass::Acceleration);

    let d = mass_matrix(&mut dag, [m1, m2, l1, c1, c2, i1, i2], q.symbols[1]);
    let tau = {
        let bias = bias(&mut dag, [m1, m2, l1, c1, c2, g], &q.symbols, &qd.symbols);
        [0, 1].map(|row| {
            let first = dag.mul(d[row][0], qdd.symbols[0]);
            let second = dag.mul(d[row][1], qdd.symbols[1]);
            let inertial = dag.add(first, second);
            dag.add(inertial, bias[row])
        })
    };
    let output = |name, shape: &[usize], entries, doc: &str| Output {
        name,
        shape: shape.to_vec(),
        entries,
        doc: doc.to_owned(),
        details: Vec::new(),
    };
    let inverse_dynamics = Function {
        name: FunctionName::InverseDynamics,
        link: None,
        arguments: vec![q.clone(), qd, qdd],
        outputs: vec![output("tau", &[2], tau.to_vec(), "joint torques [N m]")],
        form: Form::Explicit,
    };
    let mass_matrix = Function {
        name: FunctionName::MassMatrix,
        link: None,
        arguments: vec![q],
        outputs: vec![output("mass_matrix", &[2, 2], d.concat(), "D(q) [kg m^2]")],
        form: Form::Explicit,
    };
    (dag, vec![inverse_dynamics, mass_matrix])
}

fn mass_matrix(dag: &mut Dag, parameters: [ExprId; 7], q2: ExprId) -> [[ExprId; 2]; 2] {
    let [m1, m2, l1, c1, c2, i1, i2] = parameters;
    let product = |dag: &mut Dag, factors: &[ExprId]| {
        factors.iter().fold(dag.one(), |product, &factor| dag.mul(product, factor))
    };
    let cosine = dag.cos(q2);
    let coupling = product(dag, &[m2, l1, c2, cosine]);
    let d22 = {
        let square = product(dag, &[m2, c2, c2]);
        dag.add(i2, square)
    };
    let d12 = dag.add(d22, coupling);
    let d11 = {
        let own = product(dag, &[m1, c1, c1]);
        let carried = product(dag, &[m2, l1, l1]);
        [i1, own, carried, coupling].into_iter().fold(d12, |sum, term| dag.add(sum, term))
    };
    [[d11, d12], [d12, d22]]
}

fn bias(dag: &mut Dag, parameters: [ExprId; 6], q: &[ExprId], qd: &[ExprId]) -> [ExprId; 2] {
    let [m1, m2, l1, c1, c2, g] = parameters;
    let sine = dag.sin(q[1]);
    let h = [m2, l1, c2, sine].into_iter().fold(dag.one(), |product, f| dag.mul(product, f));
    let (rate, other) = (dag.mul(qd[0], qd[1]), dag.pow(qd[1], 2));
    let two = dag.integer(2);
    let twice = dag.mul(two, rate);
    let rates = dag.add(twice, other);
    let coriolis = dag.mul(h, rates);
    let centrifugal = dag.pow(qd[0], 2);
    let centrifugal = dag.mul(h, centrifugal);
    let sum = dag.add(q[0], q[1]);
    let (s1, s12) = (dag.sin(q[0]), dag.sin(sum));
    let shoulder = {
        let (first, second) = (dag.mul(m1, c1), dag.mul(m2, l1));
        let moment = dag.add(first, second);
        let weight = dag.mul(moment, g);
        dag.mul(weight, s1)
    };
    let elbow = [m2, c2, g, s12].into_iter().fold(dag.one(), |product, f| dag.mul(product, f));
    let gravity = dag.add(shoulder, elbow);
    let bias1 = dag.sub(gravity, coriolis);
    let bias2 = dag.add(centrifugal, elbow);
    [bias1, bias2]
}

/// tau of the same arm, from the equations as a textbook prints them (angles from the downward
/// vertical): thesis A.17 to A.19 with A.18 corrected.
pub(crate) fn textbook(p: [f64; 8], q: [f64; 2], qd: [f64; 2], qdd: [f64; 2]) -> [f64; 2] {
    let [m1, m2, l1, c1, c2, i1, i2, g] = p;
    let (s2, k2) = q[1].sin_cos();
    let d11 = i1 + i2 + m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2.0 * l1 * c2 * k2);
    let d12 = i2 + m2 * (c2 * c2 + l1 * c2 * k2);
    let d22 = i2 + m2 * c2 * c2;
    let h = m2 * l1 * c2 * s2;
    let g2 = m2 * g * c2 * (q[0] + q[1]).sin();
    let g1 = (m1 * c1 + m2 * l1) * g * q[0].sin() + g2;
    [
        d11 * qdd[0] + d12 * qdd[1] - h * (2.0 * qd[0] * qd[1] + qd[1] * qd[1]) + g1,
        d12 * qdd[0] + d22 * qdd[1] + h * qd[0] * qd[0] + g2,
    ]
}
