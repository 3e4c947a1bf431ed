//! Expressions as formulas: one pass over the graph, operands first, without recursion.

use super::notation::Notation;
use super::term::{Body, Factor, Form, Place};
use crate::arena::Handle;
use crate::expr::{BinaryFunction, Dag, ExprId, Node, Order, Relation, SymbolClass, UnaryFunction};
use rustc_hash::FxHashMap;

/// Which expressions are named. Widths are in tenths of a digit, as the text is set, roughly.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// What is used more than once is named from this width on.
    pub shared: u32,
    /// Whatever is wider is named.
    pub longest: u32,
}

impl Extent {
    /// Nothing is named but selections, whatever the length: for expressions known to be short.
    pub const FULL: Self = Self { shared: u32::MAX, longest: u32::MAX };
}

/// Formulas.
#[derive(Clone, Debug, PartialEq, Eq, Default)]
pub struct Written {
    /// Intermediates in the order of their definition: name and formula.
    pub definitions: Vec<(String, String)>,
    /// Each output as the texts of its terms: side by side they are the formula, and a line may
    /// end before any but the first.
    pub outputs: Vec<Vec<String>>,
}

/// One short expression. A selection in it is written as it stands.
pub fn write_expression(dag: &Dag, expr: ExprId, notation: &Notation) -> String {
    let mut writer = Writer::new(dag, &[expr], notation, Extent::FULL);
    writer.names_selections = false;
    writer.write(&[expr]).outputs.concat().join(" ")
}

/// Formulas of `outputs`, in order, with intermediates named as `extent` says.
pub fn write_expressions(
    dag: &Dag,
    outputs: &[ExprId],
    notation: &Notation,
    extent: Extent,
) -> Written {
    Writer::new(dag, outputs, notation, extent).write(outputs)
}

struct Writer<'a> {
    dag: &'a Dag,
    notation: &'a Notation,
    order: Order,
    extent: Extent,
    names_selections: bool,
    uses: FxHashMap<ExprId, u32>,
    forms: FxHashMap<ExprId, Form>,
    definitions: Vec<(String, String)>,
}

impl<'a> Writer<'a> {
    fn new(dag: &'a Dag, outputs: &[ExprId], notation: &'a Notation, extent: Extent) -> Self {
        Self {
            dag,
            notation,
            order: Order::of(dag, outputs),
            extent,
            names_selections: true,
            uses: FxHashMap::default(),
            forms: FxHashMap::default(),
            definitions: Vec::new(),
        }
    }

    fn write(mut self, outputs: &[ExprId]) -> Written {
        let exprs = self.dag.topological(outputs);
        for &expr in &exprs {
            self.dag.node(expr).for_each_operand(|a| *self.uses.entry(a).or_default() += 1);
        }
        let mut distinct = outputs.to_vec();
        distinct.sort_unstable();
        distinct.dedup();
        distinct.iter().for_each(|output| *self.uses.entry(*output).or_default() += 1);
        for expr in exprs {
            let form = self.form(expr);
            let form = if self.is_named(expr, &form) { self.named(expr, form) } else { form };
            self.forms.insert(expr, form);
        }
        let outputs = outputs.iter().map(|output| {
            let texts = self.forms[output].clone().term_texts();
            if texts.is_empty() { vec!["0".to_owned()] } else { texts }
        });
        Written { outputs: outputs.collect(), definitions: self.definitions }
    }

    fn is_named(&self, expr: ExprId, form: &Form) -> bool {
        match self.dag.node(expr) {
            Node::Symbol(_) | Node::Constant(_) | Node::Pi => return false,
            Node::Select { .. } if self.names_selections => return true,
            // A sign needs no name of its own, nor a sum of joint angles, nor its sine.
            Node::Neg(_) => return false,
            Node::Add(..) | Node::Unary(UnaryFunction::Sin | UnaryFunction::Cos, _) => {
                let angle = match self.dag.node(expr) {
                    Node::Unary(_, angle) if self.notation.abbreviates() => angle,
                    _ => expr,
                };
                if self.notation.joints_of_angle(self.dag, angle).is_some() {
                    return false;
                }
            }
            _ => {}
        }
        if self.extent == Extent::FULL {
            return false;
        }
        let width = width(&form.clone().text());
        let is_shared = self.uses.get(&expr).is_some_and(|&uses| uses > 1);
        width > self.extent.longest || (is_shared && width >= self.extent.shared)
    }

    fn named(&mut self, expr: ExprId, form: Form) -> Form {
        let name = self.notation.intermediate(self.definitions.len() + 1);
        self.definitions.push((name.clone(), form.text()));
        let rank = u32::try_from(self.definitions.len()).unwrap_or(u32::MAX);
        self.factor(expr, Place::Intermediate, rank, Body::Symbol(name))
    }

    fn factor(&self, base: ExprId, place: Place, rank: u32, body: Body) -> Form {
        Form::factor(Factor { base, place, rank, body, exponent: 1 })
    }

    fn form(&self, expr: ExprId) -> Form {
        let of = |operand: ExprId| self.forms[&operand].clone();
        match self.dag.node(expr) {
            Node::Constant(id) => Form::number(self.dag.constant_value(id).clone()),
            Node::Pi => self.factor(expr, Place::Inertia, 0, Body::Symbol(r"\pi".to_owned())),
            Node::Symbol(id) => {
                let place = match self.dag.symbols()[id].class {
                    SymbolClass::Inertia => Place::Inertia,
                    SymbolClass::Drive => Place::Drive,
                    SymbolClass::Geometry => Place::Geometry,
                    SymbolClass::Configuration => Place::Configuration,
                    SymbolClass::Rate => Place::Rate,
                    SymbolClass::Acceleration => Place::Acceleration,
                    SymbolClass::Effort | SymbolClass::Time | SymbolClass::State => Place::Other,
                };
                let text = self.notation.symbol(self.dag, id);
                // In the order of their making: the file's.
                let rank = u32::try_from(id.index() + 1).unwrap_or(u32::MAX);
                self.factor(expr, place, rank, Body::Symbol(text))
            }
            Node::Neg(a) => of(a).negated(),
            Node::Add(a, b) => of(a).plus(of(b)),
            Node::Sub(a, b) => of(a).plus(of(b).negated()),
            Node::Mul(a, b) => of(a).times(of(b), [a, b]),
            Node::Div(a, b) if b == self.dag.zero() => {
                let text = format!(r"\frac{{{}}}{{0}}", of(a).text());
                self.closed(expr, text, true)
            }
            Node::Div(a, b) => of(a).times(of(b).power(-1, b), [a, expr]),
            Node::Pow(a, n) => match i32::try_from(n) {
                Ok(n) if self.dag.as_constant(a).is_none() => of(a).power(n, a),
                // A power of a number that is too long to be worked out.
                _ => self.closed(expr, format!("{{({})}}^{{{n}}}", of(a).text()), false),
            },
            Node::Unary(function, a) => self.unary(expr, function, a),
            Node::Binary(function, a, b) => self.binary(expr, function, a, b),
            Node::Select { relation, left, right, then, otherwise } => {
                let relation = match relation {
                    Relation::Less => "<",
                    Relation::LessEqual => r"\le",
                    Relation::Equal => "=",
                };
                let [left, right, then, otherwise] =
                    [left, right, then, otherwise].map(|part| of(part).text());
                let first = format!(r"{then} & \text{{if }} {left} {relation} {right}");
                let second = format!(r"{otherwise} & \text{{otherwise}}");
                let text = format!(r"\begin{{cases}} {first} \\ {second} \end{{cases}}");
                self.closed(expr, text, true)
            }
        }
    }

    fn closed(&self, expr: ExprId, text: String, is_tall: bool) -> Form {
        let rank = self.order.rank(expr);
        self.factor(expr, Place::Function, rank, Body::Closed { text, is_tall })
    }

    fn unary(&self, expr: ExprId, function: UnaryFunction, a: ExprId) -> Form {
        let form = self.forms[&a].clone();
        let is_tall = form.is_tall();
        let text = form.text();
        let name = match function {
            UnaryFunction::Sqrt => return self.closed(expr, format!(r"\sqrt{{{text}}}"), false),
            UnaryFunction::Abs if is_tall => {
                return self.closed(expr, format!(r"\left| {text} \right|"), true);
            }
            UnaryFunction::Abs => return self.closed(expr, format!("|{text}|"), false),
            UnaryFunction::Sin => r"\sin",
            UnaryFunction::Cos => r"\cos",
            UnaryFunction::Tan => r"\tan",
            UnaryFunction::Exp => r"\exp",
            UnaryFunction::Log => r"\ln",
            UnaryFunction::Tanh => r"\tanh",
            UnaryFunction::Sign => r"\operatorname{sgn}",
        };
        if let (true, UnaryFunction::Sin | UnaryFunction::Cos) =
            (self.notation.abbreviates(), function)
            && let Some(joints) = self.notation.joints_of_angle(self.dag, a)
        {
            let (letter, first) = if function == UnaryFunction::Sin { ("s", 1) } else { ("c", 0) };
            let text = self.notation.abbreviation(letter, &joints);
            // By the lowest joint first; six bits hold a joint's number.
            let key = (0..4).fold(0, |key, row| (key << 6) | joints.get(row).map_or(0, |j| j & 63));
            let rank = u32::try_from(2 * key + first).unwrap_or(u32::MAX);
            return self.factor(expr, Place::Abbreviation, rank, Body::Symbol(text));
        }
        let is_symbol = matches!(self.dag.node(a), Node::Symbol(_) | Node::Pi);
        let argument = match is_symbol {
            true => text,
            false => super::term::bracketed(&text, is_tall),
        };
        let body = Body::Function { name: name.to_owned(), argument };
        self.factor(expr, Place::Function, self.order.rank(expr), body)
    }

    fn binary(&self, expr: ExprId, function: BinaryFunction, a: ExprId, b: ExprId) -> Form {
        let name = match function {
            BinaryFunction::Atan2 => r"\operatorname{atan2}",
            BinaryFunction::Min => r"\min",
            BinaryFunction::Max => r"\max",
        };
        let [a, b] = match function {
            BinaryFunction::Atan2 => [a, b],
            _ if self.order.compare(a, b).is_gt() => [b, a],
            _ => [a, b],
        };
        let [left, right] = [a, b].map(|operand| self.forms[&operand].clone());
        let is_tall = left.is_tall() || right.is_tall();
        let arguments = format!("{}, {}", left.text(), right.text());
        self.closed(expr, format!("{name}{}", super::term::bracketed(&arguments, is_tall)), is_tall)
    }
}

/// How wide a formula is set, in tenths of a digit: what is seen counts, and less if it is small.
pub(super) fn width(text: &str) -> u32 {
    let (mut total, mut depth, mut small) = (0, 0usize, Vec::new());
    let mut characters = text.chars().peekable();
    while let Some(character) = characters.next() {
        let is_small = !small.is_empty();
        match character {
            '\\' => {
                let mut name = String::new();
                while let Some(letter) = characters.next_if(char::is_ascii_alphabetic) {
                    name.push(letter);
                }
                total += match name.as_str() {
                    "left" | "right" | "frac" | "tfrac" | "dot" | "ddot" | "mathrm" | "text" => 0,
                    "sin" | "cos" | "tan" | "ln" | "exp" | "min" | "max" => 30,
                    "tanh" | "operatorname" => 40,
                    _ if is_small => 8,
                    _ => 12,
                };
            }
            '_' | '^' => match characters.peek() {
                Some('{') => {
                    characters.next();
                    depth += 1;
                    small.push(depth);
                }
                Some(_) => {
                    characters.next();
                    total += 7;
                }
                None => {}
            },
            '{' => depth += 1,
            '}' => {
                if small.last() == Some(&depth) {
                    small.pop();
                }
                depth = depth.saturating_sub(1);
            }
            ' ' | '&' => {}
            '+' | '-' | '=' | '<' if !is_small => total += 24,
            ',' | '.' | '(' | ')' | '|' => total += 7,
            _ if is_small => total += 7,
            _ => total += 11,
        }
    }
    total
}
