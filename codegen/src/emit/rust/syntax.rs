//! Statements and expressions of Rust: methods of the runtime's scalar.

use crate::emit::arrays::{Place, list};
use crate::emit::syntax::{Binding, Call, Pack, Syntax, Term};

/// Most instructions in one block. Each `let` opens a scope within that of the one before, and
/// rustc runs out of stack where some 2500 are nested (1.95, with debug information).
const BLOCK: usize = 2_000;

/// The syntax of Rust.
pub(super) struct Rust;

impl Syntax for Rust {
    fn declare(&self, name: &str, value: &str) -> String {
        ["let ", name, " = ", value, ";"].concat()
    }

    fn constant(&self, value: f64) -> String {
        match value.to_bits() {
            0 => "S::ZERO".to_owned(),
            0x3ff0_0000_0000_0000 => "S::ONE".to_owned(),
            _ => format!("S::from_f64({value:?})"),
        }
    }

    fn call(&self, call: Call, operands: &[Term]) -> String {
        let name = call.name();
        if let Call::Select(_) = call {
            return format!("S::{name}({})", joined(operands));
        }
        // The first operand is the one whose method is called.
        let (first, others) = operands.split_first().expect("a call has an operand");
        format!("{}.{name}({})", first.within(Binding::Atom), joined(others))
    }

    fn sincos(&self, pack: &Pack) -> Vec<String> {
        let names = |names: &[Option<String>]| -> Vec<String> {
            names.iter().map(|name| name.clone().unwrap_or_else(|| "_".to_owned())).collect()
        };
        let (sines, cosines) = (names(&pack.sines), names(&pack.cosines));
        if let ([angle], [sine], [cosine]) = (&pack.angles[..], &sines[..], &cosines[..]) {
            let angle = angle.within(Binding::Atom);
            return vec![format!("let ({sine}, {cosine}) = {angle}.sincos();")];
        }
        let angles = joined(&pack.angles);
        let mut lines = vec![format!("let (sines, cosines) = S::sincos_all([{angles}]);")];
        for (names, values) in [(sines, "sines"), (cosines, "cosines")] {
            let place = Place { indent: 4, followed: true };
            let names = list(names.into_iter().map(|name| vec![name]).collect(), place);
            let text = format!("let {} = {values};", names.join("\n"));
            lines.extend(text.lines().map(str::to_owned));
        }
        lines
    }

    fn longest_block(&self) -> usize {
        BLOCK
    }

    fn block(&self, lines: Vec<String>, names: &[String]) -> Vec<String> {
        let mut statements = Vec::with_capacity(lines.len() + 2);
        if names.is_empty() {
            statements.push("{".to_owned());
            statements.extend(lines.iter().map(|line| format!("    {line}")));
            statements.push("}".to_owned());
            return statements;
        }
        let names = names.iter().map(|name| vec![name.clone()]).collect();
        let names = list(names, Place { indent: 8, followed: true });
        statements.push(format!("let {} = {{", names.join("\n")));
        statements.extend(lines.iter().chain(&names).map(|line| format!("    {line}")));
        statements.push("};".to_owned());
        statements
    }
}

fn joined(operands: &[Term]) -> String {
    operands.iter().map(|operand| operand.text.as_str()).collect::<Vec<_>>().join(", ")
}
