//! The parser: operator precedence with two explicit stacks, so depth costs memory of the heap.

use super::error::{ParseCause, ParseError};
use super::lexer::{Lexer, Token};
use super::{Function, PI};
use crate::expr::dag::{Dag, ExprId, Node, Relation};
use crate::number::parse_decimal;
use num_traits::{Signed, ToPrimitive};

/// The largest absolute value of an exponent.
pub const MAX_EXPONENT: i32 = 64;
/// Numerator and denominator of each constant on the way may have at most this many bits.
pub const MAX_CONSTANT_BITS: u64 = 8192;
/// A longer text is refused before it is read.
pub const MAX_TEXT_BYTES: usize = 1 << 24;

/// Reads an expression into `dag`. Names are given to `resolve`, which answers with the expression
/// that the name stands for (a symbol, a constant, anything), or `None` if it knows no such name.
///
/// The hint for an unknown name is the nearest symbol of `dag`; where other names are known too,
/// ask the error to [`ParseError::suggest`] one of them.
pub fn parse(
    dag: &mut Dag,
    text: &str,
    resolve: &mut dyn FnMut(&mut Dag, &str) -> Option<ExprId>,
) -> Result<ExprId, ParseError> {
    parse_with(dag, text, resolve, Dag::make)
}

/// [`parse`], with `make` in place of the folding constructor of nodes.
pub(in crate::expr) fn parse_with(
    dag: &mut Dag,
    text: &str,
    resolve: &mut dyn FnMut(&mut Dag, &str) -> Option<ExprId>,
    make: fn(&mut Dag, Node) -> ExprId,
) -> Result<ExprId, ParseError> {
    if text.len() > MAX_TEXT_BYTES {
        return Err(ParseError::new(0, ParseCause::TextTooLong));
    }
    let mut parser =
        Parser { dag, make, lexer: Lexer::new(text), values: Vec::new(), pending: Vec::new() };
    let mut expects_operand = true;
    loop {
        let (start, token) = parser.lexer.next()?;
        expects_operand = if expects_operand {
            parser.operand(start, token, resolve)?
        } else {
            match token {
                Token::End => return parser.finish(),
                _ => parser.operator(start, token)?,
            }
        };
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Operator {
    Add,
    Sub,
    Mul,
    Div,
    Pow,
}

/// How tightly an operator binds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Power,
}

impl Operator {
    fn binding(self) -> Binding {
        match self {
            Self::Add | Self::Sub => Binding::Sum,
            Self::Mul | Self::Div => Binding::Product,
            Self::Pow => Binding::Power,
        }
    }
}

/// What waits for its right operand or its closing bracket.
#[derive(Clone, Copy, Debug)]
enum Pending {
    Operator { operator: Operator, offset: usize },
    Negation { binding: Binding },
    Bracket { offset: usize, call: Option<Call> },
}

/// A function whose arguments are being read.
#[derive(Clone, Copy, Debug)]
struct Call {
    function: Function,
    commas: usize,
    relation: Option<(Relation, bool)>,
}

struct Parser<'a, 'd> {
    dag: &'d mut Dag,
    make: fn(&mut Dag, Node) -> ExprId,
    lexer: Lexer<'a>,
    values: Vec<ExprId>,
    pending: Vec<Pending>,
}

impl Parser<'_, '_> {
    /// Takes a token where an operand should start; answers whether one is still expected.
    fn operand(
        &mut self,
        start: usize,
        token: Token<'_>,
        resolve: &mut dyn FnMut(&mut Dag, &str) -> Option<ExprId>,
    ) -> Result<bool, ParseError> {
        match token {
            Token::Number(text) => {
                let value = parse_decimal(text)
                    .map_err(|error| ParseError::new(start, ParseCause::Number(error)))?;
                let value = self.dag.constant(value);
                self.values.push(value);
                Ok(false)
            }
            Token::Name(name) => self.name(start, name, resolve),
            Token::Open => {
                self.pending.push(Pending::Bracket { offset: start, call: None });
                Ok(true)
            }
            Token::Plus => Ok(true),
            Token::Minus => {
                // After an operator the sign belongs to that operator's right operand.
                let binding = match self.pending.last() {
                    Some(Pending::Operator { operator, .. }) => operator.binding(),
                    Some(Pending::Negation { binding }) => *binding,
                    Some(Pending::Bracket { .. }) | None => Binding::Sum,
                };
                self.pending.push(Pending::Negation { binding });
                Ok(true)
            }
            Token::End => Err(ParseError::new(start, ParseCause::ExpectedOperand(None))),
            _ => {
                let found = Some(self.lexer.token_text(start));
                Err(ParseError::new(start, ParseCause::ExpectedOperand(found)))
            }
        }
    }

    fn name(
        &mut self,
        start: usize,
        name: &str,
        resolve: &mut dyn FnMut(&mut Dag, &str) -> Option<ExprId>,
    ) -> Result<bool, ParseError> {
        if let Some(function) = Function::of_name(name) {
            let (offset, next) = self.lexer.next()?;
            if next != Token::Open {
                let cause = ParseCause::FunctionWithoutArguments(function.name());
                return Err(ParseError::new(start, cause));
            }
            let call = Some(Call { function, commas: 0, relation: None });
            self.pending.push(Pending::Bracket { offset, call });
            return Ok(true);
        }
        let value = if name == PI { Some(self.dag.pi()) } else { resolve(self.dag, name) };
        match value {
            Some(value) => {
                self.values.push(value);
                Ok(false)
            }
            None if self.lexer.at_open() => {
                Err(ParseError::new(start, ParseCause::UnknownFunction(name.to_owned())))
            }
            None => {
                let error = ParseError::new(start, ParseCause::UnknownName(name.to_owned()));
                Err(error.suggest(self.dag.symbols().values().map(|symbol| symbol.name.as_str())))
            }
        }
    }

    /// Takes a token after an operand; answers whether the next operand is expected.
    fn operator(&mut self, offset: usize, token: Token<'_>) -> Result<bool, ParseError> {
        let operator = match token {
            Token::Plus => Operator::Add,
            Token::Minus => Operator::Sub,
            Token::Star => Operator::Mul,
            Token::Slash => Operator::Div,
            Token::Caret => Operator::Pow,
            Token::Close => return self.close(offset).map(|()| false),
            Token::Comma => return self.comma(offset).map(|()| true),
            Token::Relation { relation, exchanged } => {
                self.reduce_to_bracket()?;
                let call = match self.pending.last_mut() {
                    Some(Pending::Bracket { call, .. }) => call.as_mut(),
                    _ => None,
                };
                match call {
                    Some(Call { function: Function::Select, commas: 0, relation: slot })
                        if slot.is_none() =>
                    {
                        *slot = Some((relation, exchanged));
                    }
                    _ => return Err(ParseError::new(offset, ParseCause::StrayRelation)),
                }
                return Ok(true);
            }
            Token::Number(_) | Token::Name(_) | Token::Open | Token::End => {
                let found = self.lexer.token_text(offset);
                return Err(ParseError::new(offset, ParseCause::ExpectedOperator(found)));
            }
        };
        let binding = operator.binding();
        while let Some(top) = self.pending.last() {
            let waits = match top {
                Pending::Operator { operator, .. } => operator.binding(),
                Pending::Negation { binding } => *binding,
                Pending::Bracket { .. } => break,
            };
            // Powers group to the right, all else to the left.
            if waits < binding || (waits == binding && operator == Operator::Pow) {
                break;
            }
            self.reduce_one()?;
        }
        self.pending.push(Pending::Operator { operator, offset });
        Ok(true)
    }

    fn comma(&mut self, offset: usize) -> Result<(), ParseError> {
        self.reduce_to_bracket()?;
        match self.pending.last_mut() {
            Some(Pending::Bracket { call: Some(call), .. }) => {
                if call.function == Function::Select && call.relation.is_none() {
                    return Err(ParseError::new(offset, ParseCause::SelectWithoutRelation));
                }
                call.commas += 1;
                Ok(())
            }
            _ => Err(ParseError::new(offset, ParseCause::StrayComma)),
        }
    }

    fn close(&mut self, offset: usize) -> Result<(), ParseError> {
        self.reduce_to_bracket()?;
        match self.pending.pop() {
            Some(Pending::Bracket { call: None, .. }) => Ok(()),
            Some(Pending::Bracket { call: Some(call), offset }) => self.call(call, offset),
            _ => Err(ParseError::new(offset, ParseCause::NeverOpened)),
        }
    }

    /// Builds the function whose closing bracket was read.
    fn call(&mut self, call: Call, offset: usize) -> Result<(), ParseError> {
        let (function, found) = (call.function, call.commas + 1);
        let expected = function.argument_count();
        if found != expected {
            let cause = ParseCause::ArgumentCount { function: function.name(), expected, found };
            return Err(ParseError::new(offset, cause));
        }
        let node = match function {
            Function::Unary(function) => Node::Unary(function, self.pop_value()),
            Function::Binary(function) => {
                let (b, a) = (self.pop_value(), self.pop_value());
                Node::Binary(function, a, b)
            }
            Function::Select => {
                let (otherwise, then) = (self.pop_value(), self.pop_value());
                let (right, left) = (self.pop_value(), self.pop_value());
                let (relation, exchanged) = call.relation.expect("seen at the first comma");
                let (left, right) = if exchanged { (right, left) } else { (left, right) };
                Node::Select { relation, left, right, then, otherwise }
            }
        };
        let value = (self.make)(self.dag, node);
        self.values.push(value);
        Ok(())
    }

    fn finish(mut self) -> Result<ExprId, ParseError> {
        self.reduce_to_bracket()?;
        match self.pending.last() {
            Some(&Pending::Bracket { offset, .. }) => {
                Err(ParseError::new(offset, ParseCause::NeverClosed))
            }
            _ => Ok(self.pop_value()),
        }
    }

    fn reduce_to_bracket(&mut self) -> Result<(), ParseError> {
        while matches!(
            self.pending.last(),
            Some(Pending::Operator { .. } | Pending::Negation { .. })
        ) {
            self.reduce_one()?;
        }
        Ok(())
    }

    /// Applies the operator on top of the stack to its operands.
    fn reduce_one(&mut self) -> Result<(), ParseError> {
        let b = self.pop_value();
        let (value, offset) = match self.pending.pop() {
            Some(Pending::Operator { operator, offset }) => {
                let a = self.pop_value();
                let value =
                    self.apply(operator, a, b).map_err(|cause| ParseError::new(offset, cause))?;
                (value, offset)
            }
            _ => ((self.make)(self.dag, Node::Neg(b)), 0),
        };
        if let Some(constant) = self.dag.as_constant(value)
            && constant.numer().bits().max(constant.denom().bits()) > MAX_CONSTANT_BITS
        {
            return Err(ParseError::new(offset, ParseCause::ConstantTooLong));
        }
        self.values.push(value);
        Ok(())
    }

    fn apply(&mut self, operator: Operator, a: ExprId, b: ExprId) -> Result<ExprId, ParseCause> {
        let node = match operator {
            Operator::Add => Node::Add(a, b),
            Operator::Sub => Node::Sub(a, b),
            Operator::Mul => Node::Mul(a, b),
            Operator::Div if b == self.dag.zero() => return Err(ParseCause::DivisionByZero),
            Operator::Div => Node::Div(a, b),
            Operator::Pow => return self.apply_power(a, b),
        };
        Ok((self.make)(self.dag, node))
    }

    fn apply_power(&mut self, a: ExprId, b: ExprId) -> Result<ExprId, ParseCause> {
        let one = self.dag.one();
        let exponent = self.dag.as_constant(b).filter(|value| value.is_integer());
        let exponent = exponent.ok_or(ParseCause::ExponentNotWhole)?;
        if exponent.abs() > crate::number::integer(i64::from(MAX_EXPONENT)) {
            return Err(ParseCause::ExponentTooLarge);
        }
        let exponent = exponent.to_i32().expect("just seen to be small");
        if a == self.dag.zero() && exponent < 0 {
            return Err(ParseCause::DivisionByZero);
        }
        let power = match exponent.unsigned_abs() {
            0 => one,
            1 => a,
            n => (self.make)(self.dag, Node::Pow(a, n)),
        };
        Ok(if exponent < 0 { (self.make)(self.dag, Node::Div(one, power)) } else { power })
    }

    fn pop_value(&mut self) -> ExprId {
        self.values.pop().expect("each operator is pushed after its left operand")
    }
}
