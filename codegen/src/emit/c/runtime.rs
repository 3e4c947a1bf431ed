//! What functions call: sine and cosine, products with sums, choices. Only what they need, so that
//! no compiler warns of the rest.

use super::dialect::Dialect;
use crate::emit::layout::template;
use crate::program::Program;

/// What follows is no code for gcc's vectorizer of straight-line code.
pub(super) const STRAIGHT_LINE: &str = include_str!("../../../templates/c/straight_line.c.in");

/// What stands before the functions.
pub(super) struct Runtime {
    /// Lines that include headers.
    pub(super) includes: String,
    /// Functions.
    pub(super) items: String,
    /// The template `Scalar`; in C++ alone.
    pub(super) scalar: String,
}

/// What the text of the functions calls.
pub(super) fn of_c(dialect: &Dialect, program: &Program, functions: &str) -> Runtime {
    let calls =
        |name: &str| functions.lines().any(|line| !line.starts_with("//") && line.contains(name));
    let turns = ["sincos_of(", "sincos_pack("].map(calls);
    let is_fused = is_fused(program);
    let mut items = Vec::new();
    if is_fused {
        items.push(fuses(dialect));
    }
    if turns.contains(&true) {
        items.push(sincos(dialect, is_fused, turns[1]));
    }
    items.push(STRAIGHT_LINE.to_owned());
    if is_fused {
        items.push(filled(include_str!("../../../templates/c/fused.c.in"), dialect));
    }
    for (call, text) in [
        ("sign_of(", include_str!("../../../templates/c/sign_of.c.in")),
        ("lesser(", include_str!("../../../templates/c/lesser.c.in")),
        ("greater(", include_str!("../../../templates/c/greater.c.in")),
    ] {
        if calls(call) {
            items.push(text.to_owned());
        }
    }
    let library = ["fabs(", "sqrt(", "tan(", "exp(", "log(", "tanh(", "atan2("];
    let mut includes = String::new();
    if is_fused || library.iter().any(|name| calls(name)) {
        includes += "#include <math.h>\n";
    } else if turns.contains(&true) {
        includes +=
            &format!("#ifdef {}_PLATFORM_SINCOS\n#include <math.h>\n#endif\n", dialect.upper);
    }
    if turns.contains(&true) {
        includes += "#include <stdint.h>\n#include <string.h>\n";
    }
    let items = items.iter().map(|item| item.to_owned() + "\n").collect();
    Runtime { includes, items, scalar: String::new() }
}

/// All of it: templates that nobody calls are no matter of warning.
pub(super) fn of_cpp(dialect: &Dialect, program: &Program) -> Runtime {
    let is_fused = is_fused(program);
    let mut items = Vec::new();
    if is_fused {
        items.push(fuses(dialect));
    }
    items.push(sincos(dialect, is_fused, true));
    let fused = match is_fused {
        true => filled(include_str!("../../../templates/c/fused.hpp.in"), dialect),
        false => String::new(),
    };
    let scalar = template(
        include_str!("../../../templates/c/scalar.hpp.in"),
        &[("exact", &dialect.exact()), ("fused", &fused)],
    );
    Runtime { includes: String::new(), items: items.join("\n"), scalar }
}

/// Sine and cosine: the platform's, or those of denavit-runtime.
fn sincos(dialect: &Dialect, is_fused: bool, is_packed: bool) -> String {
    let inline = if dialect.is_cpp { "inline " } else { "static inline " };
    // A function that is declared inline may not be kept apart; a template may stand in a header.
    let apart = if dialect.is_cpp { "template <int = 0>\n" } else { "static " };
    let apart = format!("{apart}{}_APART ", dialect.upper);
    let (exact, standard) = (dialect.exact(), if dialect.is_cpp { "std::" } else { "" });
    let mut platform = template(
        include_str!("../../../templates/c/platform_sincos.c.in"),
        &[("inline", inline), ("std", standard)],
    );
    let mut own = match is_fused {
        false => template(
            include_str!("../../../templates/c/products.c.in"),
            &[("inline", inline), ("exact", &exact)],
        ),
        true => template(
            include_str!("../../../templates/c/fused_products.c.in"),
            &[("inline", inline), ("exact", &exact), ("std", standard), ("upper", &dialect.upper)],
        ),
    };
    own += "\n";
    own += &template(
        include_str!("../../../templates/c/sincos.c.in"),
        &[("inline", inline), ("exact", &exact), ("apart", &apart)],
    );
    if is_packed {
        let text = include_str!("../../../templates/c/platform_sincos_pack.c.in");
        platform += "\n";
        platform += &template(text, &[("inline", inline)]);
        let text = include_str!("../../../templates/c/sincos_pack.c.in");
        own += "\n";
        own += &template(text, &[("apart", &apart)]);
    }
    template(
        include_str!("../../../templates/c/turns.c.in"),
        &[("upper", &dialect.upper), ("platform", &platform), ("own", &own)],
    )
}

fn fuses(dialect: &Dialect) -> String {
    filled(include_str!("../../../templates/c/fuses.c.in"), dialect)
}

fn filled(text: &str, dialect: &Dialect) -> String {
    template(text, &[("upper", &dialect.upper)])
}

fn is_fused(program: &Program) -> bool {
    program.routines.iter().any(|routine| routine.code.is_fused())
}
