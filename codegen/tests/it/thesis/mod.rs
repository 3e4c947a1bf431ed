//! What the thesis prints, recomputed: its equations as text, in its own symbols, against the
//! derivations of this crate. Each misprint of docs/evidence/errata.md that can be decided by
//! calculation has a test here which shows that the printed form is wrong and the corrected one
//! right.

mod appendix_a;
mod appendix_b;
mod chapter_2;
mod chapter_3;
mod identification;

use super::robots::load;
use denavit_codegen::dynamics::methods::{Method, MethodResult, derive};
use denavit_codegen::expr::{Dag, ExprId, Residues, derivative, evaluate, text};
use denavit_codegen::fundamental::canonical_all;
use denavit_codegen::model::Robot;
use std::collections::HashMap;

/// A robot with the graph in which its equations are written.
struct Case {
    robot: Robot,
    dag: Dag,
    /// Names of the text that stand for other expressions.
    names: HashMap<String, ExprId>,
}

impl Case {
    fn new(name: &str) -> Self {
        let robot = load(name);
        let dag = robot.dag.clone();
        Self { robot, dag, names: HashMap::new() }
    }

    /// The double pendulum, with th1, th1d, th1dd, th2 .. for q, qd and qdd, and the angles
    /// phi1 = th1, phi2 = th1 + th2 of A.1.1 with their rates.
    fn pendulum() -> Self {
        let mut case = Self::new("double_pendulum");
        let joints: Vec<_> = case.robot.joints().map(|(_, variables)| *variables).collect();
        for (number, joint) in (1..).zip(joints) {
            for (suffix, symbol) in [("", joint.q), ("d", joint.qd), ("dd", joint.qdd)] {
                case.define(&format!("th{number}{suffix}"), symbol);
            }
        }
        for suffix in ["", "d", "dd"] {
            case.let_text(&format!("phi1{suffix}"), &format!("th1{suffix}"));
            case.let_text(&format!("phi2{suffix}"), &format!("th1{suffix} + th2{suffix}"));
        }
        case.let_text("d1", "l1 - c1");
        case
    }

    fn define(&mut self, name: &str, value: ExprId) {
        self.names.insert(name.to_owned(), value);
    }

    fn let_text(&mut self, name: &str, value: &str) {
        let value = self.read(value);
        self.define(name, value);
    }

    /// An expression in the symbols of the thesis.
    fn read(&mut self, source: &str) -> ExprId {
        let names = &self.names;
        let mut resolve = |dag: &mut Dag, name: &str| {
            let symbol = dag.find_symbol(name);
            names.get(name).copied().or_else(|| symbol.map(|id| dag.symbol_expr(id)))
        };
        text::parse(&mut self.dag, source, &mut resolve).expect(source)
    }

    fn read_all<const N: usize>(&mut self, sources: [&str; N]) -> [ExprId; N] {
        sources.map(|source| self.read(source))
    }

    /// The equations of motion by one method.
    fn derive(&mut self, method: Method) -> MethodResult {
        derive(&mut self.dag, &self.robot, method)
    }

    /// q, qd and qdd of all joints.
    fn coordinates(&self) -> [Vec<ExprId>; 3] {
        let joints: Vec<_> = self.robot.joints().map(|(_, variables)| *variables).collect();
        let pick = |pick: fn(&denavit_codegen::model::JointVariables) -> ExprId| {
            joints.iter().map(pick).collect()
        };
        [pick(|joint| joint.q), pick(|joint| joint.qd), pick(|joint| joint.qdd)]
    }

    /// d/dt, while q moves at qd and qd at qdd.
    fn in_time<const N: usize>(&mut self, outputs: [ExprId; N]) -> [ExprId; N] {
        let [q, qd, qdd] = self.coordinates();
        let seeds = q.into_iter().chain(qd.clone()).zip(qd.into_iter().chain(qdd)).collect();
        let rates = derivative(&mut self.dag, &outputs, &seeds);
        rates.try_into().expect("one rate for each output")
    }

    /// d/d symbol.
    fn by(&mut self, output: ExprId, symbol: ExprId) -> ExprId {
        let one = self.dag.one();
        derivative(&mut self.dag, &[output], &std::iter::once((symbol, one)).collect())[0]
    }

    /// d/dt dK/dqd_i - dK/dq_i + dP/dq_i (2.11).
    fn lagrange_equation(&mut self, kinetic: ExprId, potential: ExprId, i: usize) -> ExprId {
        let [q, qd, _] = self.coordinates();
        let momentum = self.by(kinetic, qd[i]);
        let [momentum_rate] = self.in_time([momentum]);
        let lagrangian = self.dag.sub(kinetic, potential);
        let slope = self.by(lagrangian, q[i]);
        self.dag.sub(momentum_rate, slope)
    }

    /// Whether two lists of expressions are the same, entry by entry. On the pendulum this is a
    /// proof: both are written out in canonical form and compared term by term. On larger robots
    /// they are compared at random points modulo a prime.
    fn equal(&mut self, left: &[ExprId], right: &[ExprId]) -> bool {
        assert_eq!(left.len(), right.len());
        if self.robot.name == "double_pendulum" {
            let mut written_out =
                |list| canonical_all(&mut self.dag, list).expect("a polynomial of a few terms");
            return written_out(left) == written_out(right);
        }
        (1..=3).all(|seed| {
            let at = |list: &[ExprId]| evaluate(&self.dag, list, &mut Residues::new(seed));
            at(left).expect("no division by zero") == at(right).expect("no division by zero")
        })
    }

    /// Asserts that `printed` is wrong and `corrected` right.
    fn misprint(&mut self, printed: &[ExprId], corrected: &[ExprId], truth: &[ExprId]) {
        assert!(self.equal(corrected, truth), "the corrected form is wrong");
        assert!(!self.equal(printed, truth), "the printed form is right");
    }
}
