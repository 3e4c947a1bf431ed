//! What is read and printed, and that each undoes the other.

use super::super::random::{Kind, build, recipes};
use super::super::{Dag, ExprId, Node, Residues, SymbolClass, evaluate};
use super::*;
use crate::number::DecimalError;
use proptest::prelude::*;
use std::time::{Duration, Instant};

fn class_of(name: &str) -> SymbolClass {
    match name.trim_end_matches(|c: char| c.is_ascii_digit()) {
        "q" => SymbolClass::Configuration,
        "qd" => SymbolClass::Rate,
        "qdd" => SymbolClass::Acceleration,
        "m" => SymbolClass::Inertia,
        "N" => SymbolClass::Drive,
        _ => SymbolClass::Geometry,
    }
}

/// Reads a text; any name of one letter, or letters and a number, is a symbol.
fn read(dag: &mut Dag, text: &str) -> Result<ExprId, ParseError> {
    parse(dag, text, &mut |dag, name| {
        let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
        let known = stem.len() == 1 || (stem.len() < name.len() && !stem.contains('_'));
        known.then(|| dag.symbol(name, class_of(name)))
    })
}

fn reprinted(text: &str) -> String {
    let mut dag = Dag::new();
    let expr = read(&mut dag, text).unwrap_or_else(|error| panic!("{text}: {error}"));
    print(&dag, expr)
}

/// Values at a random point modulo p; an error where something is divided by 0 everywhere.
fn residues(dag: &Dag, exprs: &[ExprId]) -> Option<Vec<crate::number::Residue>> {
    evaluate(dag, exprs, &mut Residues::new(7)).ok()
}

#[test]
fn texts_are_printed_with_the_brackets_they_need() {
    for text in [
        "a + b - c",
        "a - (b + c)",
        "a - (b - c)",
        "a + b + (c + d)",
        "a*b/c",
        "a/(b*c)",
        "a/(b/c)",
        "c*(a + b)",
        "-a*b",
        "-(a + b)",
        "-a^2",
        "(a + b)^2",
        "sin(a)^2",
        "2*a",
        "a/2",
        "3*a/2",
        "3*(a*b)/2",
        "-3/2",
        "a - 3/2",
        "-3/2/b",
        "-(a + 3)",
        "sqrt(a)/tan(b)",
        "atan2(b, a)",
        "min(a, b)*max(a, b)",
        "select(a < b, a, b + c)",
        "select(a <= b, -a, b)",
        "select(a == 0, a, pi)",
    ] {
        assert_eq!(reprinted(text), text);
    }
}

#[test]
fn operators_group_as_stated() {
    for (text, canonical) in [
        ("a^2^3", "a^8"),
        ("a^-2", "1/a^2"),
        ("a^-1^2", "1/a"),
        ("a^(1+1)*a", "a^3"),
        ("-2^2", "-4"),
        ("(-2)^2", "4"),
        ("a*-b", "-a*b"),
        ("2*-3*-a", "6*a"),
        ("--a", "a"),
        ("a--b", "a + b"),
        ("+a - +b", "a - b"),
        ("-a + b", "b - a"),
        ("1-2-3", "-4"),
        ("12/2/3", "2"),
        ("2/-4", "-1/2"),
        (" a\t*\n( b ) ", "a*b"),
        ("0.15005", "3001/20000"),
        ("1e-3*a", "a/1000"),
        (".5e1", "5"),
        ("select(a > b, 1, 2)", "select(b < a, 1, 2)"),
        ("select(a >= b, 1, 2)", "select(b <= a, 1, 2)"),
        ("sin(pi/2)+cos(pi)", "0"),
        ("a*0 + b*1", "b"),
    ] {
        assert_eq!(reprinted(text), canonical, "{text}");
    }
}

#[test]
fn faults_are_placed_and_explained() {
    use ParseCause::*;
    let operand = |text: &str| ExpectedOperand(Some(text.to_owned()));
    let operator = |text: &str| ExpectedOperator(text.to_owned());
    let count = |function, expected, found| ArgumentCount { function, expected, found };
    for (text, offset, cause) in [
        ("", 0, ExpectedOperand(None)),
        ("  ", 2, ExpectedOperand(None)),
        ("a +", 3, ExpectedOperand(None)),
        ("a + * b", 4, operand("*")),
        ("()", 1, operand(")")),
        ("sin()", 4, operand(")")),
        ("2a", 1, operator("a")),
        ("a (b)", 0, UnknownFunction("a_b".to_owned())),
        ("(a + b", 0, NeverClosed),
        ("sin(a", 3, NeverClosed),
        ("a + b)", 5, NeverOpened),
        ("a, b", 1, StrayComma),
        ("(a, b)", 2, StrayComma),
        ("sin(a, b)", 3, count("sin", 1, 2)),
        ("atan2(a)", 5, count("atan2", 2, 1)),
        ("select(a < b, a)", 6, count("select", 3, 2)),
        ("select(a, b, c)", 8, SelectWithoutRelation),
        ("a < b", 2, StrayRelation),
        ("select(a < b < c, a, b)", 13, StrayRelation),
        ("select(a < b, a < b, c)", 16, StrayRelation),
        ("a = b", 2, UnexpectedCharacter('=')),
        ("a + §", 4, UnexpectedCharacter('§')),
        ("1.2.3", 0, Number(DecimalError::Malformed)),
        ("a + .", 4, Number(DecimalError::Malformed)),
        ("1e999", 0, Number(DecimalError::TooLong)),
        ("sin + 1", 0, FunctionWithoutArguments("sin")),
        ("1 + a/(b - b)", 5, DivisionByZero),
        ("0^-1", 1, DivisionByZero),
        ("a^b", 1, ExponentNotWhole),
        ("a^0.5", 1, ExponentNotWhole),
        ("a^65", 1, ExponentTooLarge),
        ("a^-65", 1, ExponentTooLarge),
        ("a^2^7", 1, ExponentTooLarge),
    ] {
        // A one-letter name resolves as a symbol, so an unknown function needs a longer one.
        let text = if let UnknownFunction(_) = cause { "a_b (b)" } else { text };
        let error = read(&mut Dag::new(), text).expect_err(text);
        assert_eq!((error.offset, &error.cause), (offset, &cause), "{text}: {error}");
        assert!(text.is_char_boundary(error.offset));
    }
}

#[test]
fn an_unknown_name_is_answered_with_the_nearest_known_one() {
    let mut dag = Dag::new();
    let none = &mut |_: &mut Dag, _: &str| None;
    dag.symbol("mass_knee", SymbolClass::Inertia);
    let error = parse(&mut dag, "1 + mass_kene", none).unwrap_err();
    assert_eq!(
        error.to_string(),
        "at byte 4: unknown name `mass_kene`; hint: did you mean `mass_knee`?"
    );
    let error = parse(&mut dag, "g0", none).unwrap_err().suggest(["gravity", "g"]);
    assert_eq!(error.hint.as_deref(), Some("did you mean `g`?"));
    let error = parse(&mut dag, "zzz", none).unwrap_err().suggest(["gravity"]);
    assert_eq!(error.hint, None);
    let error = parse(&mut dag, "Pi", none).unwrap_err();
    assert_eq!(error.hint.as_deref(), Some("did you mean `pi`?"));
    let error = parse(&mut dag, "sine(2)", none).unwrap_err();
    assert_eq!(error.hint.as_deref(), Some("did you mean `sin`?"));
}

#[test]
fn symbol_names_are_what_the_parser_reads_as_names() {
    for name in ["q1", "_x", "m_base_z", "E5", "Pi"] {
        assert!(is_symbol_name(name), "{name}");
    }
    for name in ["", "1q", "q 1", "q.1", "pi", "sin", "select", "ä"] {
        assert!(!is_symbol_name(name), "{name}");
    }
}

#[test]
fn depth_is_not_limited() {
    let depth = 100_000;
    let wrap = |open: &str, close: &str| format!("{}a{}", open.repeat(depth), close.repeat(depth));
    let start = Instant::now();
    let mut dag = Dag::new();
    let a = read(&mut dag, "a").unwrap();
    assert_eq!(read(&mut dag, &wrap("(", ")")), Ok(a));
    assert_eq!(read(&mut dag, &wrap("-", "")), Ok(a));
    let nested = read(&mut dag, &wrap("sin(b + ", ")")).unwrap();
    assert_eq!(print(&dag, nested).len(), wrap("sin(b + ", ")").len());
    let error = read(&mut dag, &"(".repeat(depth)).unwrap_err();
    assert_eq!((error.offset, error.cause), (depth, ParseCause::ExpectedOperand(None)));
    let sum = vec!["sin(a)*b"; depth].join(" + a*");
    read(&mut dag, &sum).unwrap();
    assert!(start.elapsed() < Duration::from_secs(20), "{:?}", start.elapsed());
}

#[test]
fn constants_and_texts_that_are_too_long_are_refused() {
    let mut dag = Dag::new();
    let long = "9e300*".repeat(1000) + "1";
    assert_eq!(read(&mut dag, &long).unwrap_err().cause, ParseCause::ConstantTooLong);
    let text = " ".repeat(MAX_TEXT_BYTES + 1);
    assert_eq!(read(&mut dag, &text).unwrap_err().cause, ParseCause::TextTooLong);
}

#[test]
fn long_constants_and_powers_round_trip() {
    let mut dag = Dag::new();
    let a = read(&mut dag, "a").unwrap();
    let base = dag.integer(1_000_003);
    let big = dag.power(base, 200);
    let one = dag.one();
    let inverse = dag.div(one, big);
    let negative = dag.neg(inverse);
    let mut exprs = vec![big, inverse, negative, dag.mul(a, inverse)];
    exprs.extend([64, 65, 128, 4096, 4097].map(|n| dag.power(a, n)));
    for expr in exprs {
        let text = print(&dag, expr);
        assert_eq!(read(&mut dag, &text), Ok(expr), "{text}");
    }
}

#[test]
fn the_text_does_not_depend_on_the_order_of_making() {
    let text = "c*b + a*sin(q10 + q2) + (b + a)/(c + b)";
    let mut dag = Dag::new();
    let first = read(&mut dag, text).unwrap();
    let mut reversed = Dag::new();
    for name in ["q10", "q2", "c", "b", "a"] {
        read(&mut reversed, name).unwrap();
    }
    read(&mut reversed, "(c + b)*(a + b) - (q10 + q2)").unwrap();
    let second = read(&mut reversed, text).unwrap();
    assert_eq!(print(&dag, first), print(&reversed, second));
    assert_eq!(print(&dag, first), "b*c + (a + b)/(b + c) + a*sin(q2 + q10)");
}

#[test]
fn shared_operands_are_named_when_the_text_would_be_long() {
    let mut dag = Dag::new();
    let mut expr = read(&mut dag, "a + sin(t2)").unwrap();
    for _ in 0..200 {
        let sin = dag.sin(expr);
        expr = dag.mul(expr, sin);
    }
    let printed = print_with_intermediates(&dag, &[expr], 1000);
    let length: usize = printed.bindings.iter().map(|(_, text)| text.len()).sum();
    assert!(length < 200 * 30, "{length}");
    // `t2` is a symbol of this graph, so the intermediates are called otherwise.
    assert_eq!(printed.bindings[0], ("t_1".to_owned(), "a + sin(t2)".to_owned()));
    let mut named = std::collections::HashMap::new();
    for (name, text) in &printed.bindings {
        let value = parse(&mut dag, text, &mut |dag, name| match named.get(name) {
            Some(&expr) => Some(expr),
            None => dag.find_symbol(name).map(|id| dag.symbol_expr(id)),
        });
        named.insert(name.clone(), value.unwrap());
    }
    let again = parse(&mut dag, &printed.outputs[0], &mut |_, name| named.get(name).copied());
    assert_eq!(again, Ok(expr));
    let short = read(&mut dag, "(a + b + c)*sin(a + b + c)").unwrap();
    assert_eq!(print_with_intermediates(&dag, &[short], 100).bindings, []);
}

/// Where the selection takes its second branch, the argument is 0 and has no sign, in whichever
/// order a graph writes its differences.
#[test]
fn odd_functions_of_what_vanishes_are_alike_in_all_graphs() {
    let names = ["a", "b", "c", "d", "e", "f", "g", "h"];
    let cases = names.iter().flat_map(|x| ["sign", "tanh"].map(|function| (x, function)));
    for (x, function) in cases {
        let text = format!("{function}(2*(y - z + select({x} <= z - y, z - pi, z - y)))");
        let value = |order: [&str; 2]| {
            let mut dag = Dag::new();
            for name in order {
                read(&mut dag, name).unwrap();
            }
            let expr = read(&mut dag, &text).unwrap();
            residues(&dag, &[expr])
        };
        assert_eq!(value(["y", "z"]), value(["z", "y"]), "{text}");
    }
}

proptest! {
    #[test]
    fn what_is_printed_is_read_back(recipe in recipes(Kind::Any, 40)) {
        let mut dag = Dag::new();
        for expr in build(&mut dag, Kind::Any, &recipe, Dag::make) {
            let printed = print_with_intermediates(&dag, &[expr], 20_000);
            if !printed.bindings.is_empty() {
                continue;
            }
            let text = &printed.outputs[0];
            // What the promise leaves out: long constants, high powers of constants, a/0.
            if dag.topological(&[expr]).into_iter().any(|expr| match dag.node(expr) {
                Node::Pow(base, n) => n > 64 && dag.as_constant(base).is_some(),
                Node::Div(_, b) => b == dag.zero(),
                _ => false,
            }) {
                continue;
            }
            let read_back = match read(&mut dag, text) {
                Err(ParseError { cause: ParseCause::ConstantTooLong, .. }) => continue,
                other => other,
            };
            prop_assert_eq!(&read_back, &Ok(expr), "{}", text);
            let mut other = Dag::new();
            // The other graph is made in another order.
            for name in ["qdd10", "qd1", "q2", "q1", "m1", "l1"] {
                read(&mut other, name).unwrap();
            }
            let read_there = read(&mut other, text);
            prop_assert!(read_there.is_ok(), "{}", text);
            let (here, there) = (residues(&dag, &[expr]), residues(&other, &[read_there.unwrap()]));
            prop_assert_eq!(here, there, "{}", text);
        }
    }

    #[test]
    fn random_bytes_are_read_or_refused(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let text = String::from_utf8_lossy(&bytes);
        if let Err(error) = read(&mut Dag::new(), &text) {
            prop_assert!(error.offset <= text.len() && text.is_char_boundary(error.offset));
            prop_assert!(error.to_string().len() < 1000);
        }
    }

    #[test]
    fn random_tokens_are_read_or_refused(
        tokens in prop::collection::vec(
            prop::sample::select(vec![
                "a", "b", "q1", "1", "2", "0.5", "9e300", "64", "pi", "+", "-", "*", "/", "^", "(",
                ")", "(", ")", ",", "<", "<=", "==", ">", ">=", "sin(", "cos(", "atan2(", "select(",
                "min(", "abs(", "sqrt(", "^64", "^2", "unknown", "=", "#",
            ]),
            0..400,
        )
    ) {
        let start = Instant::now();
        let text = tokens.concat();
        let mut dag = Dag::new();
        match read(&mut dag, &text) {
            Err(error) => prop_assert!(error.offset <= text.len()),
            Ok(expr) => { print_with_intermediates(&dag, &[expr], 100); }
        }
        prop_assert!(dag.len() < 20 * tokens.len() + 20);
        prop_assert!(start.elapsed() < Duration::from_secs(5));
    }

    /// Random tokens seldom make an expression; operands and operators in turn always do.
    #[test]
    fn random_expressions_are_read(
        tokens in prop::collection::vec(
            (
                prop::sample::select(vec![
                    "a", "-b", "q1", "0", "1", "2.5", "9e300", "pi", "(a - 1)",
                ]),
                prop::sample::select(vec!["+", "-", "*", "/", "^2*", "^64/", "^-3+", "^2^2-"]),
            ),
            1..300,
        )
    ) {
        let mut text: String = tokens.iter().flat_map(|(a, b)| [*a, *b]).collect();
        text.push('a');
        match read(&mut Dag::new(), &text) {
            Ok(_) => {}
            Err(error) => prop_assert!(
                matches!(error.cause, ParseCause::ConstantTooLong | ParseCause::DivisionByZero),
                "{}", error
            ),
        }
    }
}
