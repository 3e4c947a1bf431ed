//! The command in a shell: completions, manual pages, and how much it says.

use super::{Directory, Run, answer, command, run_in};
use std::fs;
use std::process::Command;

const SHELLS: [&str; 5] = ["bash", "zsh", "fish", "elvish", "powershell"];

/// The subcommands that a help text lists.
fn listed(of: &[&str]) -> Vec<String> {
    let help = answer(&[of, &["--help"]].concat());
    let (_, commands) = help.split_once("Commands:\n").expect("commands");
    let lines = commands.lines().take_while(|line| !line.is_empty());
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

#[test]
fn completions_of_every_shell_name_every_subcommand() {
    let names = [listed(&[]), listed(&["walk"])].concat();
    assert!(names.len() > 30, "{names:?}");
    for shell in SHELLS {
        let script = answer(&["completions", shell]);
        let is_part = |c: char| c.is_ascii_alphanumeric() || c == '-' || c == '_';
        let words: Vec<&str> = script.split(|c| !is_part(c)).collect();
        for name in &names {
            assert!(words.contains(&name.as_str()), "{shell}: no {name}");
        }
        for option in ["quiet", "verbose", "certificate", "functions"] {
            assert!(script.contains(option), "{shell}: no {option}");
        }
        assert_eq!(script, answer(&["completions", shell]), "the same bytes twice");
    }
}

/// The shells that are installed read their scripts without a fault.
#[test]
fn completions_are_scripts_of_their_shell() {
    let directory = Directory::new("completions");
    for shell in ["bash", "zsh", "fish"] {
        let file = directory.path.join(shell);
        fs::write(&file, answer(&["completions", shell])).expect("written");
        let Ok(read) = Command::new(shell).arg("-n").arg(&file).output() else { continue };
        let said = String::from_utf8_lossy(&read.stderr);
        assert!(read.status.success() && said.is_empty(), "{shell}: {said}");
    }
}

#[test]
fn another_shell_is_refused_with_those_that_there_are() {
    let directory = Directory::new("shells");
    let run = run_in(&directory.path, &["completions", "fsh"]);
    assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""));
    for said in [&SHELLS[..], &["similar", "fish"]].concat() {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

#[test]
fn every_subcommand_has_a_manual_page() {
    let directory = Directory::new("man");
    let run = run_in(&directory.path, &["man", "--out", "man"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let of = |parent: &str| {
        let names = listed(&[parent]).into_iter();
        names.map(|name| format!("denavit-{parent}-{name}.1")).collect::<Vec<_>>()
    };
    let mut expected: Vec<String> = listed(&[])
        .into_iter()
        .map(|name| format!("denavit-{name}.1"))
        .chain(of("walk"))
        .chain(of("long"))
        .chain(["denavit.1".to_owned()])
        .collect();
    expected.sort();
    let there = Directory { path: directory.path.join("man") };
    assert_eq!(there.files(), expected);
    for file in &expected {
        let page = fs::read_to_string(there.path.join(file)).expect("a page");
        assert!(page.contains(".SH NAME") && page.contains(".SH SYNOPSIS"), "{file}");
        assert!(page.contains(".SH EXAMPLES\n.nf\n  denavit "), "{file} has no example");
        assert!(page.contains("denavit 0.") && !page.contains("help(1)"), "{file}");
        assert!(run.stdout.contains(&format!("wrote man/{file}\n")), "{file}: {}", run.stdout);
    }
    let whole = fs::read_to_string(there.path.join("denavit.1")).expect("a page");
    assert_eq!(whole, answer(&["man"]));
}

const GANTRY: &str = include_str!("../../../crates/import/tests/robots/gantry.urdf");

#[test]
fn quiet_leaves_notes_out_and_faults_in() {
    let directory = Directory::new("quiet");
    fs::write(directory.path.join("gantry.urdf"), GANTRY).expect("written");
    let told = run_in(&directory.path, &["inspect", "gantry.urdf"]);
    assert!(told.stderr.starts_with("note: gantry.urdf: "), "{}", told.stderr);
    for line in [["-q", "inspect", "gantry.urdf"], ["inspect", "gantry.urdf", "--quiet"]] {
        let quiet = run_in(&directory.path, &line);
        assert_eq!((quiet.code, quiet.stderr.as_str()), (Some(0), ""), "{line:?}");
        assert_eq!(quiet.stdout, told.stdout);
    }
    let (loud, quiet) = (["inspect", "puma650"], ["inspect", "puma650", "-q"]);
    let [loud, quiet] = [run_in(&directory.path, &loud), run_in(&directory.path, &quiet)];
    assert_eq!((quiet.code, &quiet.stderr), (Some(2), &loud.stderr));
    assert!(loud.stderr.contains("hint: `puma560`"), "{}", loud.stderr);
}

#[test]
fn verbose_says_what_took_how_long() {
    let directory = Directory::new("verbose");
    let run = run_in(&directory.path, &["-v", "simulate", "bouncing_ball"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let lines: Vec<&str> = run.stderr.lines().collect();
    let begins = ["time: simulating: ", "time: altogether: "];
    assert_eq!(lines.len(), begins.len(), "{lines:?}");
    for (line, begin) in lines.iter().zip(begins) {
        assert!(line.starts_with(begin) && line.ends_with(" s"), "{line}");
    }
    let quiet = run_in(&directory.path, &["list", "models"]);
    let verbose = run_in(&directory.path, &["list", "models", "-v"]);
    assert_eq!(verbose.stdout, quiet.stdout);
}

#[test]
fn quiet_and_verbose_contradict_each_other() {
    let directory = Directory::new("contradiction");
    for line in [&["-q", "-v", "list"][..], &["-q", "list", "-v"], &["list", "-qv"]] {
        let run = run_in(&directory.path, line);
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""), "{line:?}");
        assert!(run.stderr.contains("'--quiet' cannot be used with '--verbose'"), "{}", run.stderr);
    }
}

/// Nothing but the answer, in bytes: no progress, and no colours where there is no terminal.
#[test]
fn short_work_says_nothing_and_faults_have_no_colour() {
    let directory = Directory::new("short");
    let output = command(&directory.path).args(["derive", "double_pendulum"]).output();
    assert_eq!(output.expect("it runs").stderr, b"");
    let forced = command(&directory.path)
        .args(["inspect", "puma650"])
        .env("CLICOLOR_FORCE", "1")
        .output()
        .expect("it runs");
    let expected = run_in(&directory.path, &["inspect", "puma650"]).stderr;
    assert_eq!(String::from_utf8(forced.stderr).expect("UTF-8"), expected);
    assert!(!expected.contains('\u{1b}'));
}

/// What is good for another command is said to be.
#[test]
fn files_and_names_in_the_wrong_place_are_recognised() {
    let directory = Directory::new("mistaken");
    fs::write(directory.path.join("gantry.urdf"), GANTRY).expect("written");
    let log = run_in(&directory.path, &["simulate", "bouncing_ball", "-o", "ball.csv"]);
    assert_eq!(log.code, Some(0), "{}", log.stderr);
    for (line, said) in [
        ("simulate tulip_walk", "tulip_walk: this is a gait, where a scenario is simulated"),
        ("simulate gantry.urdf", "gantry.urdf: this is a URDF or MJCF, where a scenario"),
        ("simulate ball.csv", "ball.csv: this is a log, where a scenario is simulated"),
        ("simulate boncing_ball", "`bouncing_ball` is a shipped scenario"),
        ("inspect tulip_step", "tulip_step: this is a scenario, where a model is read"),
        ("inspect ball.csv", "ball.csv: this is a log, where a model is read"),
        ("walk design tulip_step", "tulip_step: this is a scenario, where a gait is designed"),
        ("walk design tulip_wlk", "`tulip_walk` is a shipped gait"),
        ("walk zmp tulip_turn", "tulip_turn: this is a gait, where a scenario is simulated"),
        ("identify tulip_leg --train tulip_leg_tracking", "this is a scenario, where a log is"),
        ("identify tulip_leg --train gantry.urdf", "this is a URDF or MJCF, where a log is read"),
    ] {
        let words: Vec<&str> = line.split_whitespace().collect();
        let Run { code, stdout, stderr } = run_in(&directory.path, &words);
        assert_eq!((code, stdout.as_str()), (Some(2), ""), "{line}");
        assert!(stderr.contains(said) && stderr.contains("hint: "), "{line}: {stderr}");
    }
}
