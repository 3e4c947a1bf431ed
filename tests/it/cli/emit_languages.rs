//! `emit` in C and C++: which files it writes, and what it refuses.

use super::errors::{assert_says, refused};
use super::{Directory, answer, run_in};
use serde_json::Value;
use std::fs;

#[test]
fn c_is_a_source_and_a_header_whichever_is_named() {
    let directory = Directory::new("emit_c");
    let run = run_in(&directory.path, &["emit", "scara", "--lang", "c", "-o", "one.c"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    assert_says(&run.stdout, &["wrote one.c, one.h: "]);
    // The end of the name says which language it is, too.
    let run = run_in(&directory.path, &["emit", "scara", "-o", "two.h"]);
    assert_says(&run.stdout, &["wrote two.h, two.c: "]);
    let [one, two] = ["one", "two"].map(|name| {
        [".c", ".h"].map(|end| {
            fs::read_to_string(directory.path.join(format!("{name}{end}"))).expect("a file")
        })
    });
    assert_eq!(one[1], two[1], "the same model gives the same bytes");
    assert_eq!(one[0].replace("one.h", "two.h"), two[0]);
    assert!(one[0].contains("#include \"one.h\"\n"));
    assert_says(&one[1], &["#ifndef SCARA_H", "extern \"C\"", "void scara_inverse_dynamics("]);
}

fn json_in(directory: &Directory, arguments: &[&str]) -> Value {
    let run = run_in(&directory.path, arguments);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    serde_json::from_str(&run.stdout).expect("JSON")
}

#[test]
fn cpp_is_one_header_that_goes_anywhere() {
    let header = answer(&["emit", "scara", "--language", "cpp", "--baked", "-o", "-"]);
    assert_says(&header, &["namespace scara {", "template <typename S>\ninline void mass_matrix("]);
    assert!(!header.contains("ModelParameters"));
    let directory = Directory::new("emit_cpp");
    let shown = json_in(&directory, &["emit", "scara", "-o", "scara.hpp", "--json"]);
    assert_eq!((&shown["language"], &shown["beside"]), (&"C++".into(), &Value::Null));
    let shown = json_in(&directory, &["emit", "scara", "-o", "scara.c", "--json"]);
    assert_eq!((&shown["language"], &shown["beside"]), (&"C".into(), &"scara.h".into()));
}

#[test]
fn a_name_of_another_language_is_refused() {
    let directory = Directory::new("emit_other");
    let message = refused(&directory, &["emit", "scara", "-o", "scara.py"]);
    assert_says(&message, &["scara.py", "no language", "hint: ", "--language"]);
    let run = run_in(&directory.path, &["emit", "scara", "-o", "scara.inc", "--language", "rust"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn what_c_cannot_be_written_to_is_refused() {
    let directory = Directory::new("emit_c_refused");
    for output in ["-", "scara", "scara.rs"] {
        let message = refused(&directory, &["emit", "scara", "--language", "c", "-o", output]);
        assert_says(&message, &[output, "a source and a header", "hint: ", "robot.c"]);
    }
    let message = refused(&directory, &["emit", "scara", "-o", "a\"b.c"]);
    assert_says(&message, &["cannot include", "hint: "]);
    let message = refused(&directory, &["emit", "scara", "--language", "ada", "-o", "scara.c"]);
    assert_says(&message, &["ada", "rust", "c", "cpp"]);
}
