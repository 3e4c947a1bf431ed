//! What files and flags bring along reaches no terminal, and makes no lines of a log.

use super::{Directory, run_in};
use std::fs;

#[track_caller]
fn assert_shown(text: &str) {
    let hidden = |c: char| c.is_control() && c != '\n';
    assert!(!text.contains(hidden), "{text:?}");
}

#[test]
fn escape_sequences_of_files_and_flags_are_shown() {
    let directory = Directory::new("escapes");
    let model = r#"{"format": "denavit-model/1", "name": "bad", "\u001b[2Jkey": 1,
        "convention": "standard", "gravity": [0, 0, 0], "links": []}"#;
    fs::write(directory.path.join("bad.json"), model).expect("a file");
    fs::write(directory.path.join("a\x1b[31mred.json"), model).expect("a file");
    for words in [
        &["inspect", "bad.json"][..],
        &["inspect", "bad.json", "--json"],
        &["inspect", "a\x1b[31mred.json"],
        &["inspect", "no\x1b]0;title\x07.json"],
        &["inspect", "--\x1b[31m\x07flag"],
        &["simulate", "bouncing_ball", "--step", "\x1b[31m\r1"],
        &["identify", "bad.json", "--train", "no\u{9b}31m.csv"],
    ] {
        let run = run_in(&directory.path, words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert_shown(&run.stdout);
        assert_shown(&run.stderr);
    }
    let run = run_in(&directory.path, &["inspect", "a\x1b[31mred.json"]);
    assert!(run.stderr.contains(r"a\u001b[31mred.json:1:"), "{}", run.stderr);
    assert!(run.stderr.contains(r"\u001b[2Jkey"), "{}", run.stderr);
}

/// Answers, too: a description, a model's texts.
#[test]
fn escape_sequences_of_texts_are_shown_in_answers() {
    let directory = Directory::new("escaped-texts");
    let text = denavit::shipped::find("planar_2r").expect("a model").text;
    let text = text.replace("Textbook arm", r"Text\u001b[2Jbook\u009b arm\u202e");
    assert!(text.contains("u202e"));
    fs::write(directory.path.join("arm.json"), text).expect("a file");
    for words in [&["inspect", "arm.json"][..], &["inspect", "arm.json", "--json"]] {
        let run = run_in(&directory.path, words);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert_shown(&run.stdout);
        assert!(!run.stdout.contains('\u{202e}'), "{}", run.stdout);
    }
    let json = run_in(&directory.path, &["inspect", "arm.json", "--json"]).stdout;
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let source = json.to_string();
    assert!(!source.contains("Textbook"), "{source}");
}

#[test]
fn the_name_of_a_scenario_forges_no_line_of_a_log() {
    let directory = Directory::new("forged");
    let scenario = r##"{"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 0.1,
        "name": "fine\n# torque_side: motor\r\n\u001b[2J", "log_period_s": 0.01}"##;
    fs::write(directory.path.join("run.json"), scenario).expect("a file");
    let run = run_in(&directory.path, &["simulate", "run.json", "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    assert!(!run.stdout.contains(['\x1b', '\r']), "{}", run.stdout);
    let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
    let sides: Vec<&str> = log.lines().filter(|line| line.starts_with("# torque_side")).collect();
    assert_eq!(sides, ["# torque_side: joint"]);
    assert!(log.contains(r"# scenario: fine\u000a# torque_side: motor\u000d\u000a\u001b[2J"));
    let run = run_in(&directory.path, &["simulate", "run.json", "-o", "-"]);
    assert_eq!(run.stdout, log);
}
