//! A reader of formulas as a person reads them: side by side is a product, `\frac`, `^`, subscripts
//! as part of a name, `c_{12}` the cosine of q_1 + q_2.

use denavit_codegen::expr::{Dag, ExprId};
use denavit_codegen::number::parse_decimal;
use std::collections::HashMap;

/// What a name of the document stands for.
pub(super) type Names = HashMap<String, ExprId>;

/// The expression of a formula.
pub(super) fn read(dag: &mut Dag, names: &Names, formula: &str) -> ExprId {
    let tokens = tokens(formula);
    let mut reader = Reader { dag, names, tokens: &tokens, at: 0, formula };
    let value = reader.sum();
    assert_eq!(reader.at, tokens.len(), "{formula}: left over {:?}", &tokens[reader.at..]);
    value
}

/// Commands, numbers and single characters.
fn tokens(formula: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    let mut rest = formula.trim_start();
    while let Some(first) = rest.chars().next() {
        let length = match first {
            '\\' => {
                let letters = rest[1..].find(|c: char| !c.is_ascii_alphabetic());
                1 + letters.unwrap_or(rest.len() - 1).max(1)
            }
            '0'..='9' => {
                // After `_` or `^` without braces only one digit counts.
                let is_script = tokens.last().is_some_and(|token| token == "_" || token == "^");
                let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.');
                if is_script { 1 } else { digits.unwrap_or(rest.len()) }
            }
            _ => first.len_utf8(),
        };
        let token = &rest[..length];
        if !["\\left", "\\right", "\\,"].contains(&token) {
            tokens.push(token.to_owned());
        }
        rest = rest[length..].trim_start();
    }
    tokens
}

struct Reader<'a> {
    dag: &'a mut Dag,
    names: &'a Names,
    tokens: &'a [String],
    at: usize,
    formula: &'a str,
}

impl Reader<'_> {
    fn peek(&self) -> &str {
        self.tokens.get(self.at).map_or("", String::as_str)
    }

    fn take(&mut self, token: &str) -> bool {
        let is_next = self.peek() == token;
        self.at += usize::from(is_next);
        is_next
    }

    fn expect(&mut self, token: &str) {
        assert!(self.take(token), "{}: no {token} before {:?}", self.formula, self.peek());
    }

    fn sum(&mut self) -> ExprId {
        let negative = self.take("-");
        let mut sum = self.product();
        if negative {
            sum = self.dag.neg(sum);
        }
        loop {
            if self.take("+") {
                let term = self.product();
                sum = self.dag.add(sum, term);
            } else if self.take("-") {
                let term = self.product();
                sum = self.dag.sub(sum, term);
            } else {
                return sum;
            }
        }
    }

    fn product(&mut self) -> ExprId {
        let mut product = self.factor();
        while !["", "+", "-", ")", "}", "&", ","].contains(&self.peek()) {
            let factor = self.factor();
            product = self.dag.mul(product, factor);
        }
        product
    }

    fn factor(&mut self) -> ExprId {
        for function in ["\\sin", "\\cos"] {
            if self.take(function) {
                let power = self.power();
                let angle = self.factor();
                let value = match function {
                    "\\sin" => self.dag.sin(angle),
                    _ => self.dag.cos(angle),
                };
                return self.dag.pow(value, power);
            }
        }
        let base = self.base();
        let power = self.power();
        self.dag.pow(base, power)
    }

    fn power(&mut self) -> i32 {
        if self.take("^") { self.script().parse().expect("exponents are numbers") } else { 1 }
    }

    fn base(&mut self) -> ExprId {
        if self.take("(") {
            let sum = self.sum();
            self.expect(")");
            return sum;
        }
        if self.take("\\frac") || self.take("\\tfrac") {
            let [over, under] = [(); 2].map(|()| {
                self.expect("{");
                let part = self.sum();
                self.expect("}");
                part
            });
            return self.dag.div(over, under);
        }
        if self.peek().starts_with(|c: char| c.is_ascii_digit()) {
            let value = parse_decimal(self.peek()).expect("a number");
            self.at += 1;
            return self.dag.constant(value);
        }
        self.name()
    }

    /// A letter with its dots and its subscript.
    fn name(&mut self) -> ExprId {
        let mut name = self.peek().to_owned();
        self.at += 1;
        if name == "\\dot" || name == "\\ddot" {
            name = format!("{name} {}", self.script());
        }
        let mut subscript = String::new();
        if self.take("_") {
            subscript = self.script();
            name = format!("{name}_{subscript}");
        }
        if let Some(&value) = self.names.get(&name) {
            return value;
        }
        // c_{12}, s_{2,13}
        let is_sum = subscript.contains(',');
        let joints: Vec<String> = match is_sum || self.names.contains_key("q_10") {
            true => subscript.split(',').map(str::to_owned).collect(),
            false => subscript.chars().map(String::from).collect(),
        };
        let mut angle = self.dag.zero();
        for joint in joints {
            let position = self.names.get(&format!("q_{joint}"));
            let position = *position.unwrap_or_else(|| panic!("{}: {name}", self.formula));
            angle = self.dag.add(angle, position);
        }
        match name.chars().next() {
            Some('s') => self.dag.sin(angle),
            Some('c') => self.dag.cos(angle),
            _ => panic!("{}: nobody knows {name}", self.formula),
        }
    }

    /// What is in braces, or the one character that stands for it, without upright commands.
    fn script(&mut self) -> String {
        if !self.take("{") {
            self.at += 1;
            return self.tokens[self.at - 1].clone();
        }
        let (mut text, mut depth) = (String::new(), 1);
        loop {
            match self.peek() {
                "{" => depth += 1,
                "}" => depth -= 1,
                "\\mathrm" => {}
                "\\_" => text.push('_'),
                token => text.push_str(token),
            }
            self.at += 1;
            if depth == 0 {
                return text;
            }
        }
    }
}
