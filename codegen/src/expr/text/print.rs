//! The printer: infix, with the brackets that are needed and no others, without recursion.

use super::{Function, MAX_EXPONENT, PI};
use crate::arena::{Handle, SecondaryMap};
use crate::expr::dag::{Dag, ExprId, Node, Relation};
use crate::expr::order::Order;
use crate::number::Rational;
use num_bigint::BigInt;
use num_traits::{One, Signed};

/// The text of an expression.
///
/// What is promised: parsed in the same graph, the text gives the same handle; parsed in another
/// graph, an expression that is equal (of `a - b` and `b - a` another one may be stored there). The
/// order of the text depends on the structure of the expression alone, not on that in which the
/// graph was built.
///
/// It holds where each symbol's name [is one](super::is_symbol_name), constants are within
/// [`MAX_CONSTANT_BITS`](super::MAX_CONSTANT_BITS), no constant is raised to a power beyond
/// [`MAX_EXPONENT`], and nothing is divided by the constant 0.
///
/// A shared operand is written out each time: a text can be exponentially longer than the graph.
/// [`print_with_intermediates`] is for graphs that are not known to be small.
pub fn print(dag: &Dag, expr: ExprId) -> String {
    let order = Order::of(dag, &[expr]);
    Printer { dag, order: &order, names: &SecondaryMap::filled(None, 0) }.text(expr)
}

/// Expressions as text, with intermediates named.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Printed {
    /// Intermediates: name and text, each after those that it uses.
    pub bindings: Vec<(String, String)>,
    /// The text of each output, in order.
    pub outputs: Vec<String>,
}

/// The text of `outputs`. If written out in full they have more than `threshold` nodes altogether,
/// what is used more than once is named `t1`, `t2`, ..., unless it is as short as `a*b`; the text
/// is then no longer than a small multiple of the graph.
pub fn print_with_intermediates(dag: &Dag, outputs: &[ExprId], threshold: u64) -> Printed {
    let order = Order::of(dag, outputs);
    let mut names = SecondaryMap::filled(None, dag.len());
    let mut bindings = Vec::new();
    let prefix = name_prefix(dag);
    for expr in intermediates(dag, outputs, threshold) {
        let text = Printer { dag, order: &order, names: &names }.text(expr);
        let name = format!("{prefix}{}", bindings.len() + 1);
        names.set(expr, Some(name.clone()));
        bindings.push((name, text));
    }
    let printer = Printer { dag, order: &order, names: &names };
    let outputs = outputs.iter().map(|&output| printer.text(output)).collect();
    Printed { bindings, outputs }
}

/// The expressions worth a name, operands before users.
fn intermediates(dag: &Dag, outputs: &[ExprId], threshold: u64) -> Vec<ExprId> {
    const SHORTEST: u64 = 4;
    let exprs = dag.topological(outputs);
    let mut full = SecondaryMap::<ExprId, u64>::filled(0, dag.len());
    let mut uses = vec![0u32; dag.len()];
    for &expr in &exprs {
        let mut size = 1u64;
        dag.node(expr).for_each_operand(|operand| {
            size = size.saturating_add(full[operand]);
            uses[operand.index()] += 1;
        });
        full.set(expr, size);
    }
    outputs.iter().for_each(|output| uses[output.index()] += 1);
    let total = outputs.iter().fold(0u64, |sum, &output| sum.saturating_add(full[output]));
    if total <= threshold {
        return Vec::new();
    }
    let mut named = Vec::new();
    let mut written = SecondaryMap::<ExprId, u64>::filled(0, dag.len());
    for expr in exprs {
        let mut size = 1u64;
        dag.node(expr).for_each_operand(|operand| size = size.saturating_add(written[operand]));
        let is_named = uses[expr.index()] > 1 && size >= SHORTEST;
        written.set(expr, if is_named { 1 } else { size });
        if is_named {
            named.push(expr);
        }
    }
    named
}

/// A prefix that no symbol has before a number.
fn name_prefix(dag: &Dag) -> String {
    let mut prefix = "t".to_owned();
    let is_number = |rest: &str| !rest.is_empty() && rest.bytes().all(|byte| byte.is_ascii_digit());
    let is_taken = |prefix: &str| {
        let mut names = dag.symbols().values().map(|symbol| symbol.name.as_str());
        names.any(|name| name.strip_prefix(prefix).is_some_and(is_number))
    };
    while is_taken(&prefix) {
        prefix.push('_');
    }
    prefix
}

/// How tightly a text holds together; an operand that holds together less than its place demands
/// is put in brackets.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Sum,
    Product,
    Power,
    Atom,
}

/// What is still to be written.
enum Task {
    Text(&'static str),
    Number(BigInt),
    Expr(ExprId, Level),
    Power(ExprId, u32),
}

struct Printer<'a> {
    dag: &'a Dag,
    order: &'a Order,
    names: &'a SecondaryMap<ExprId, Option<String>>,
}

impl Printer<'_> {
    fn text(&self, expr: ExprId) -> String {
        let mut text = String::new();
        let mut tasks = vec![Task::Expr(expr, Level::Sum)];
        while let Some(task) = tasks.pop() {
            match task {
                Task::Text(piece) => text.push_str(piece),
                Task::Number(value) => push_integer(&mut text, &value),
                Task::Power(base, n) => self.push_power(&mut tasks, base, n),
                Task::Expr(expr, place) => {
                    if let Some(name) = &self.names[expr] {
                        text.push_str(name);
                        continue;
                    }
                    let mut pieces = Vec::new();
                    let brackets = self.level(expr) < place;
                    if brackets {
                        pieces.push(Task::Text("("));
                    }
                    if let Node::Symbol(id) = self.dag.node(expr) {
                        text.push_str(&self.dag.symbols()[id].name);
                    } else {
                        self.pieces(expr, &mut pieces);
                    }
                    if brackets {
                        pieces.push(Task::Text(")"));
                    }
                    tasks.extend(pieces.into_iter().rev());
                }
            }
        }
        text
    }

    /// The level of the text of an expression.
    fn level(&self, expr: ExprId) -> Level {
        if self.names[expr].is_some() {
            return Level::Atom;
        }
        match self.dag.node(expr) {
            Node::Constant(id) => {
                let value = self.dag.constant_value(id);
                match (value.is_negative(), value.is_integer()) {
                    (true, _) => Level::Sum,
                    (false, true) => Level::Atom,
                    (false, false) => Level::Product,
                }
            }
            Node::Neg(_) | Node::Add(..) | Node::Sub(..) => Level::Sum,
            Node::Mul(..) | Node::Div(..) => Level::Product,
            Node::Pow(_, n) if n > LONGEST_POWER && n % LONGEST_POWER != 0 => Level::Product,
            Node::Pow(..) => Level::Power,
            Node::Pi | Node::Symbol(_) => Level::Atom,
            Node::Unary(..) | Node::Binary(..) | Node::Select { .. } => Level::Atom,
        }
    }

    /// The pieces of the text of an expression that is no symbol, left to right.
    fn pieces(&self, expr: ExprId, pieces: &mut Vec<Task>) {
        match self.dag.node(expr) {
            Node::Symbol(_) => {}
            Node::Constant(id) => {
                let value = self.dag.constant_value(id);
                if value.is_negative() {
                    pieces.push(Task::Text("-"));
                }
                pieces.push(Task::Number(value.numer().abs()));
                push_denominator(value, pieces);
            }
            Node::Pi => pieces.push(Task::Text(PI)),
            Node::Neg(a) => match self.dag.node(a) {
                // One of two opposite differences is stored; a name hides what it is.
                Node::Sub(x, y) if self.names[a].is_none() => {
                    infix(pieces, y, Level::Sum, " - ", x, Level::Product);
                }
                _ => pieces.extend([Task::Text("-"), Task::Expr(a, Level::Product)]),
            },
            Node::Add(a, b) => {
                let [first, second] = match self.dag.as_constant(a) {
                    Some(_) => [b, a],
                    None if self.dag.as_constant(b).is_some() => [a, b],
                    None => self.arranged(a, b, Level::Sum),
                };
                infix(pieces, first, Level::Sum, " + ", second, Level::Product);
            }
            Node::Sub(a, b) => infix(pieces, a, Level::Sum, " - ", b, Level::Product),
            Node::Mul(a, b) => self.product(a, b, pieces),
            Node::Div(a, b) => infix(pieces, a, Level::Product, "/", b, Level::Power),
            Node::Pow(a, n) => pieces.push(Task::Power(a, n)),
            Node::Unary(function, a) => {
                arguments(pieces, Function::Unary(function), &[a]);
            }
            Node::Binary(function, a, b) => {
                use crate::expr::dag::BinaryFunction::Atan2;
                let exchanged = function != Atan2 && self.order.compare(a, b).is_gt();
                let sides = if exchanged { [b, a] } else { [a, b] };
                arguments(pieces, Function::Binary(function), &sides);
            }
            Node::Select { relation, left, right, then, otherwise } => {
                let relation = match relation {
                    Relation::Less => " < ",
                    Relation::LessEqual => " <= ",
                    Relation::Equal => " == ",
                };
                pieces.push(Task::Text("select("));
                infix(pieces, left, Level::Sum, relation, right, Level::Sum);
                pieces.push(Task::Text(", "));
                infix(pieces, then, Level::Sum, ", ", otherwise, Level::Sum);
                pieces.push(Task::Text(")"));
            }
        }
    }

    /// `a b`; with a rational factor `p/q` written as `p*a/q`, which folds to the same.
    fn product(&self, a: ExprId, b: ExprId, pieces: &mut Vec<Task>) {
        for (factor, other) in [(a, b), (b, a)] {
            if let Some(value) = self.dag.as_constant(factor) {
                let place = if value.numer().is_one() {
                    Level::Product
                } else {
                    pieces.extend([Task::Number(value.numer().clone()), Task::Text("*")]);
                    Level::Power
                };
                pieces.push(Task::Expr(other, place));
                push_denominator(value, pieces);
                return;
            }
        }
        let [first, second] = self.arranged(a, b, Level::Product);
        infix(pieces, first, Level::Product, "*", second, Level::Power);
    }

    /// Two operands that may be exchanged: the one that needs no brackets in the first place
    /// stands there, otherwise their order decides.
    fn arranged(&self, a: ExprId, b: ExprId, level: Level) -> [ExprId; 2] {
        match (self.level(a) == level, self.level(b) == level) {
            (true, false) => [a, b],
            (false, true) => [b, a],
            _ if self.order.compare(a, b).is_gt() => [b, a],
            _ => [a, b],
        }
    }

    /// `base^n`, as `(base^64)^k*base^r` where n is beyond the exponents that are read.
    fn push_power(&self, tasks: &mut Vec<Task>, base: ExprId, n: u32) {
        if n == 1 {
            tasks.push(Task::Expr(base, Level::Power));
            return;
        }
        if n <= LONGEST_POWER {
            tasks.extend([Task::Number(n.into()), Task::Text("^"), Task::Expr(base, Level::Atom)]);
            return;
        }
        let (whole, rest) = (n / LONGEST_POWER, n % LONGEST_POWER);
        if rest > 0 {
            tasks.extend([Task::Power(base, rest), Task::Text("*")]);
        }
        tasks.extend([Task::Number(LONGEST_POWER.into()), Task::Text(")^")]);
        tasks.extend([Task::Power(base, whole), Task::Text("(")]);
    }
}

const LONGEST_POWER: u32 = MAX_EXPONENT.unsigned_abs();

fn infix(
    pieces: &mut Vec<Task>,
    left: ExprId,
    left_place: Level,
    operator: &'static str,
    right: ExprId,
    right_place: Level,
) {
    let right = Task::Expr(right, right_place);
    pieces.extend([Task::Expr(left, left_place), Task::Text(operator), right]);
}

fn arguments(pieces: &mut Vec<Task>, function: Function, arguments: &[ExprId]) {
    pieces.extend([Task::Text(function.name()), Task::Text("(")]);
    for (index, &argument) in arguments.iter().enumerate() {
        if index > 0 {
            pieces.push(Task::Text(", "));
        }
        pieces.push(Task::Expr(argument, Level::Sum));
    }
    pieces.push(Task::Text(")"));
}

fn push_denominator(value: &Rational, pieces: &mut Vec<Task>) {
    if !value.is_integer() {
        pieces.extend([Task::Text("/"), Task::Number(value.denom().clone())]);
    }
}

/// An integer >= 0; one with more digits than the parser reads at once in pieces, by Horner's
/// scheme in brackets.
fn push_integer(text: &mut String, value: &BigInt) {
    const DIGITS: usize = 200;
    let digits = value.to_string();
    let mut chunks =
        digits.as_bytes().rchunks(DIGITS).rev().map(|chunk| {
            std::str::from_utf8(chunk).expect("digits are ASCII").trim_start_matches('0')
        });
    let count = digits.len().div_ceil(DIGITS);
    if count == 1 {
        text.push_str(&digits);
        return;
    }
    (1..count).for_each(|_| text.push('('));
    text.push_str(chunks.next().expect("there are digits"));
    for chunk in chunks {
        let chunk = if chunk.is_empty() { "0" } else { chunk };
        text.push_str(&format!("*1e{DIGITS} + {chunk})"));
    }
}
