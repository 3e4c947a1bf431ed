//! Bad input and bad luck: exit code 2, a message with place, cause and hint, nothing half-written.

use super::{Directory, Run, command, run_in};
use denavit::shipped;
use std::fs;
use std::io::{Read, Write};
use std::process::Stdio;

/// The message of a run that must fail as bad input does.
pub(super) fn refused(directory: &Directory, arguments: &[&str]) -> String {
    let before = directory.files();
    let Run { code, stdout, stderr } = run_in(&directory.path, arguments);
    assert_eq!(code, Some(2), "{arguments:?}: {stderr}");
    assert_eq!(stdout, "", "{arguments:?}");
    assert!(!stderr.contains("panicked"), "{stderr}");
    assert_eq!(directory.files(), before, "{arguments:?} left something behind");
    stderr
}

pub(super) fn assert_says(message: &str, parts: &[&str]) {
    for part in parts {
        assert!(message.contains(part), "no `{part}` in:\n{message}");
    }
}

#[test]
fn a_file_that_is_not_there_is_named() {
    let directory = Directory::new("missing");
    for command in ["inspect", "derive", "count"] {
        let message = refused(&directory, &[command, "models/no_such.json"]);
        assert_says(&message, &["models/no_such.json", "no such file", "hint: "]);
    }
}

#[test]
fn a_misspelt_shipped_model_is_guessed() {
    let directory = Directory::new("misspelt");
    let message = refused(&directory, &["inspect", "tullip"]);
    assert_says(&message, &["tullip", "hint: ", "`tulip`"]);
    let message = refused(&directory, &["inspect", "zebra"]);
    assert_says(&message, &["zebra", "hint: ", "puma560", "double_pendulum"]);
}

#[test]
fn no_output_takes_the_place_of_an_input() {
    let directory = Directory::new("input-kept");
    let text = shipped::find("double_pendulum").expect("a model").text;
    fs::write(directory.path.join("model.json"), text).expect("a file");
    for arguments in [
        ["export", "model.json", "-o", "./model.json"],
        ["inspect", "model.json", "--svg", "model.json"],
        ["derive", "model.json", "--latex", "model.json"],
        ["base", "model.json", "--certificate", "model.json"],
    ] {
        let message = refused(&directory, &arguments);
        assert_says(&message, &["model.json", "would be replaced", "hint: "]);
        let kept = fs::read_to_string(directory.path.join("model.json")).expect("a file");
        assert_eq!(kept, text);
    }
}

#[test]
fn effects_that_nothing_adds_are_not_passed_over() {
    let directory = Directory::new("effects");
    let text = shipped::find("double_pendulum").expect("a model").text;
    let added = r#""effects": [{"effect": "stribeck", "at": "model"}], "links""#;
    fs::write(directory.path.join("model.json"), text.replacen("\"links\"", added, 1))
        .expect("a file");
    let message = refused(&directory, &["derive", "model.json"]);
    assert_says(&message, &["`stribeck`", "hint: "]);
}

#[test]
fn a_mass_matrix_without_an_inverse_leaves_forward_dynamics_out() {
    let directory = Directory::new("singular");
    let arguments = ["count", "puma560", "--terms", "gravity"];
    let Run { code, stdout, stderr } = run_in(&directory.path, &arguments);
    assert_eq!(code, Some(0), "{stderr}");
    assert!(stdout.contains("gravity_vector") && !stdout.contains("forward_dynamics"), "{stdout}");
    let asked = [&arguments[..], &["--functions", "forward_dynamics"]].concat();
    assert_says(&refused(&directory, &asked), &["forward_dynamics", "no inverse"]);
}

#[test]
fn a_directory_is_no_model() {
    let directory = Directory::new("directory");
    fs::create_dir(directory.path.join("robots.json")).expect("a directory");
    let message = refused(&directory, &["inspect", "robots.json"]);
    assert_says(&message, &["robots.json", "is a directory", "hint: "]);
}

#[test]
fn binary_garbage_is_no_model() {
    let directory = Directory::new("garbage");
    let garbage: Vec<u8> = (0..4096u32).map(|i| (i * i % 251) as u8).collect();
    fs::write(directory.path.join("garbage"), garbage).expect("a file");
    let message = refused(&directory, &["inspect", "garbage"]);
    assert_says(&message, &["garbage:1:1", "UTF-8"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_without_end_is_not_read_to_it() {
    let directory = Directory::new("endless");
    let message = refused(&directory, &["inspect", "/dev/zero"]);
    assert_says(&message, &["/dev/zero", "bytes", "hint: "]);
}

#[test]
fn all_faults_of_a_model_are_listed_at_once() {
    let directory = Directory::new("faults");
    let text = shipped::find("scara").expect("a model").text;
    let broken = text.replace("\"revolute\"", "\"revolut\"").replace("\"standard\"", "\"normal\"");
    assert_ne!(broken, text);
    fs::write(directory.path.join("broken.json"), broken).expect("a file");
    let message = refused(&directory, &["count", "broken.json"]);
    assert_says(&message, &["broken.json:", "/convention", "/links/0/joint/type", "hint: "]);

    let run = run_in(&directory.path, &["inspect", "broken.json", "--json"]);
    assert_eq!(run.code, Some(2));
    let answer: serde_json::Value = serde_json::from_str(&run.stdout).expect("JSON");
    let faults = answer["faults"].as_array().expect("faults");
    assert!(faults.iter().any(|fault| fault["pointer"] == "/convention"), "{answer}");
}

#[test]
fn an_unknown_function_is_answered_with_the_known_ones() {
    let directory = Directory::new("function");
    let message = refused(&directory, &["count", "scara", "--functions", "mass_matix"]);
    assert_says(&message, &["mass_matix", "'mass_matrix'", "inverse_dynamics", "similar"]);
}

#[test]
fn a_function_that_the_robot_cannot_have_is_refused() {
    let directory = Directory::new("no-function");
    let message = refused(&directory, &["count", "scara", "--functions", "contact_jacobian"]);
    assert_says(&message, &["scara", "contact_jacobian", "hint: "]);
}

#[test]
fn wrong_usage_has_exit_code_2() {
    let directory = Directory::new("usage");
    for arguments in [
        &["frobnicate"][..],
        &[],
        &["inspect"],
        &["count", "scara", "--terms", "inertia,magic"],
        &["derive", "scara", "--method", "guessing"],
        &["schema", "poem"],
        &["inspect", "scara", "--colour"],
    ] {
        let message = refused(&directory, arguments);
        assert_says(&message, &["--help"]);
    }
}

#[test]
fn an_output_that_cannot_be_written_leaves_nothing() {
    let directory = Directory::new("unwritable");
    let message = refused(&directory, &["inspect", "scara", "--svg", "no/such/place.svg"]);
    assert_says(&message, &["no/such/place.svg", "cannot be written", "hint: "]);
    fs::create_dir(directory.path.join("picture.svg")).expect("a directory");
    let message = refused(&directory, &["inspect", "scara", "--svg", "picture.svg"]);
    assert_says(&message, &["picture.svg", "is a directory", "hint: "]);
}

#[test]
fn an_output_replaces_what_was_there_and_only_when_all_is_well() {
    let directory = Directory::new("replace");
    let file = directory.path.join("scara.svg");
    fs::write(&file, "old").expect("a file");
    let run = run_in(&directory.path, &["inspect", "no_such.json", "--svg", "scara.svg"]);
    assert_eq!(run.code, Some(2));
    assert_eq!(fs::read_to_string(&file).expect("a file"), "old");
    let run = run_in(&directory.path, &["inspect", "scara", "--svg", "scara.svg"]);
    assert_eq!(run.code, Some(0));
    assert!(fs::read_to_string(&file).expect("a file").starts_with("<svg"));
    assert_eq!(directory.files(), ["scara.svg"]);
}

#[test]
fn a_path_wins_over_a_shipped_name() {
    let directory = Directory::new("path");
    fs::write(directory.path.join("tulip"), "{}").expect("a file");
    let message = refused(&directory, &["inspect", "tulip"]);
    assert_says(&message, &["tulip:1:1"]);
}

#[test]
fn a_model_may_come_from_standard_input() {
    let directory = Directory::new("stdin");
    let mut child = command(&directory.path)
        .args(["inspect", "-", "--json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let text = shipped::find("scara").expect("a model").text;
    child.stdin.take().expect("a pipe").write_all(text.as_bytes()).expect("it reads");
    let run = Run::of(child.wait_with_output().expect("it ends"));
    assert_eq!(run.code, Some(0));
    assert!(run.stdout.contains("\"model\": \"scara\""), "{}", run.stdout);
}

#[test]
fn a_reader_that_leaves_is_no_failure() {
    let directory = Directory::new("pipe");
    for arguments in [&["inspect", "tulip"][..], &["schema", "model"], &["derive", "--help"]] {
        let mut child = command(&directory.path)
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("the command starts");
        drop(child.stdout.take());
        let mut stderr = String::new();
        child.stderr.take().expect("a pipe").read_to_string(&mut stderr).expect("UTF-8");
        let code = child.wait().expect("it ends").code();
        assert_eq!((code, stderr.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_reported() {
    let directory = Directory::new("full");
    let full = fs::OpenOptions::new().write(true).open("/dev/full").expect("the full device");
    let child = command(&directory.path)
        .args(["inspect", "tulip"])
        .stdout(full)
        .stderr(Stdio::piped())
        .spawn()
        .expect("the command starts");
    let run = Run::of(child.wait_with_output().expect("it ends"));
    assert_eq!(run.code, Some(2));
    assert_says(&run.stderr, &["standard output", "cannot be written"]);
}

/// Devices are written to, never replaced by a file.
#[cfg(target_os = "linux")]
#[test]
fn a_device_stays_a_device() {
    use std::os::unix::fs::FileTypeExt;
    let directory = Directory::new("device");
    let run = run_in(&directory.path, &["inspect", "scara", "--svg", "/dev/null"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let metadata = fs::metadata("/dev/null").expect("the device");
    assert!(metadata.file_type().is_char_device());
}

#[test]
fn a_module_is_written_whole_or_not_at_all() {
    let directory = Directory::new("module");
    let message = refused(&directory, &["emit", "scara", "-o", "no/such/scara.rs"]);
    assert_says(&message, &["no/such/scara.rs", "hint: make the directory first"]);
    let message = refused(&directory, &["emit", "scara", "--functions", "momntum", "-o", "x.rs"]);
    assert_says(&message, &["momntum", "'momentum'"]);
    let message = refused(&directory, &["emit", "scara"]);
    assert_says(&message, &["--output"]);
}

#[test]
fn values_that_are_missing_cannot_be_baked() {
    let directory = Directory::new("bake");
    let text = shipped::find("double_pendulum").expect("a model").text;
    let symbolic = text.replace("\"value\": 0.04, ", "");
    assert_ne!(symbolic, text);
    fs::write(directory.path.join("pendulum.json"), symbolic).expect("a file");
    let message = refused(&directory, &["emit", "pendulum.json", "--baked", "-o", "x.rs"]);
    assert_says(&message, &["double_pendulum", "I1", "hint: "]);
    let run = run_in(&directory.path, &["inspect", "pendulum.json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn the_demo_needs_a_place_for_its_files() {
    let directory = Directory::new("demo-place");
    fs::write(directory.path.join("file"), "").expect("a file");
    let message = refused(&directory, &["demo", "--out", "file/out"]);
    assert_says(&message, &["file/out", "cannot be written", "hint: "]);
}

/// No joint moves: every matrix is empty.
#[test]
fn a_robot_that_cannot_move_is_no_trouble() {
    let directory = Directory::new("statue");
    let statue = r#"{"format": "denavit-model/1", "name": "statue", "convention": "standard",
        "gravity": [0, 0, 0], "links": [{"name": "stone", "joint": {"type": "fixed"}}]}"#;
    fs::write(directory.path.join("statue.json"), statue).expect("a file");
    for arguments in [
        &["inspect", "statue.json", "--svg", "statue.svg"][..],
        &["derive", "statue.json", "--latex", "statue.tex"],
        &["derive", "statue.json", "--method", "newton-euler", "--json"],
        &["count", "statue.json", "--baked"],
        &["emit", "statue.json", "-o", "statue.rs"],
    ] {
        let run = run_in(&directory.path, arguments);
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{arguments:?}");
    }
    assert_eq!(directory.files(), ["statue.json", "statue.rs", "statue.svg", "statue.tex"]);
}
