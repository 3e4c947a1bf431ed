//! Statements and expressions of C and C++.

use crate::emit::syntax::{Binding, Call, Pack, Syntax, Term};
use crate::expr::Relation;
use crate::program::{BinaryOperation, FusedOperation, UnaryOperation};

/// The names of functions that compute in `double`, for whatever scalar.
fn function(call: Call) -> &'static str {
    match call {
        Call::Unary(UnaryOperation::Tan) => "tan",
        Call::Unary(UnaryOperation::Sqrt) => "sqrt",
        Call::Unary(UnaryOperation::Exp) => "exp",
        Call::Unary(UnaryOperation::Log) => "log",
        Call::Unary(UnaryOperation::Tanh) => "tanh",
        Call::Unary(UnaryOperation::Abs) => "fabs",
        Call::Unary(UnaryOperation::Sign) => "sign_of",
        Call::Binary(BinaryOperation::Atan2) => "atan2",
        Call::Binary(BinaryOperation::Min) => "lesser",
        Call::Binary(BinaryOperation::Max) => "greater",
        Call::Unary(UnaryOperation::Neg) | Call::Binary(_) | Call::Fused(_) | Call::Select(_) => {
            unreachable!("it is an expression")
        }
    }
}

/// C, in which values have one type.
pub(super) struct InC {
    /// `real`, or `double` where the scalar may have too few digits.
    pub(super) scalar: &'static str,
}

impl InC {
    /// What turns a `double` into a value.
    fn cast(&self) -> &'static str {
        if self.scalar == "double" { "" } else { "(real)" }
    }
}

impl Syntax for InC {
    fn declare(&self, name: &str, value: &str) -> String {
        format!("const {} {name} = {value};", self.scalar)
    }

    fn constant(&self, value: f64) -> String {
        format!("{}{value:?}", self.cast())
    }

    fn call(&self, call: Call, operands: &[Term]) -> String {
        let text = |row: usize| operands[row].text.as_str();
        let negative = |row: usize| format!("-{}", operands[row].within(Binding::Atom));
        match call {
            Call::Select(relation) => {
                let sign = match relation {
                    Relation::Less => "<",
                    Relation::LessEqual => "<=",
                    Relation::Equal => "==",
                };
                format!("({} {sign} {} ? {} : {})", text(0), text(1), text(2), text(3))
            }
            // A product that is negated is exact.
            Call::Fused(FusedOperation::ProductPlus) => {
                format!("fused({}, {}, {})", text(0), text(1), text(2))
            }
            Call::Fused(FusedOperation::ProductMinus) => {
                format!("fused({}, {}, {})", text(0), text(1), negative(2))
            }
            Call::Fused(FusedOperation::MinusProduct) => {
                format!("fused({}, {}, {})", negative(1), text(2), text(0))
            }
            Call::Unary(_) | Call::Binary(_) => {
                format!("{}{}({})", self.cast(), function(call), joined(operands))
            }
        }
    }

    fn sincos(&self, pack: &Pack) -> Vec<String> {
        let name = &pack.name;
        let angles = |row: usize| pack.angles[row.min(pack.angles.len() - 1)].text.as_str();
        let is_single = pack.angles.len() == 1;
        let first = match is_single {
            true => format!("const struct turn {name} = sincos_of({});", angles(0)),
            // A pack that is not full ends with its last angle once more.
            false => {
                let four = [0, 1, 2, 3].map(angles).join(", ");
                format!("const struct turns {name} = sincos_pack({four});")
            }
        };
        let cast = self.cast();
        let entry = |row: usize| if is_single { String::new() } else { format!("[{row}]") };
        taken_apart(pack, first, |field, row| {
            (self.scalar, format!("{cast}{name}.{field}{}", entry(row)))
        })
    }

    fn pack_name(&self) -> Option<&'static str> {
        Some("turns")
    }

    fn store(&self, entry: &str, value: &Term) -> String {
        match self.scalar {
            // The parameters that were prepared are of the scalar's type.
            "double" => format!("{entry} = (real){};", value.within(Binding::Atom)),
            _ => format!("{entry} = {};", value.text),
        }
    }
}

/// C++, in which values are of the type `S`.
pub(super) struct InCpp;

impl Syntax for InCpp {
    fn declare(&self, name: &str, value: &str) -> String {
        format!("const S {name} = {value};")
    }

    fn constant(&self, value: f64) -> String {
        format!("S({value:?})")
    }

    fn call(&self, call: Call, operands: &[Term]) -> String {
        format!("Scalar<S>::{}({})", call.name(), joined(operands))
    }

    fn sincos(&self, pack: &Pack) -> Vec<String> {
        let (name, count) = (&pack.name, pack.angles.len());
        let angles = joined(&pack.angles);
        let call = format!("Scalar<S>::sincos(std::array<S, {count}>{{{angles}}})");
        taken_apart(pack, format!("const auto {name} = {call};"), |field, row| {
            ("S", format!("{name}.{field}[{row}]"))
        })
    }

    fn pack_name(&self) -> Option<&'static str> {
        Some("turns")
    }
}

fn joined(operands: &[Term]) -> String {
    operands.iter().map(|operand| operand.text.as_str()).collect::<Vec<_>>().join(", ")
}

/// The statement that computes a pack, and those that name its sines and cosines.
fn taken_apart(
    pack: &Pack,
    first: String,
    entry: impl Fn(&str, usize) -> (&'static str, String),
) -> Vec<String> {
    let mut lines = vec![first];
    for (row, names) in pack.sines.iter().zip(&pack.cosines).enumerate() {
        let fields = [("sine", names.0), ("cosine", names.1)];
        let named = fields.iter().filter_map(|(field, name)| Some((field, name.as_ref()?)));
        let declared: Vec<(&str, String)> = named
            .map(|(field, name)| {
                let (scalar, value) = entry(field, row);
                (scalar, format!("{name} = {value}"))
            })
            .collect();
        let Some((scalar, _)) = declared.first() else { continue };
        let values: Vec<&str> = declared.iter().map(|(_, value)| value.as_str()).collect();
        lines.push(format!("const {scalar} {};", values.join(", ")));
    }
    lines
}
