//! Outputs that are whole or not there: signals, links, what killed runs left behind.
#![cfg(unix)]

use super::errors::assert_says;
use super::{Directory, command, run_in};
use std::fs;
use std::io::Write;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// A shell that waits for a word before it sends a signal: on a busy machine a command that is
/// started only then comes too late.
fn ready(signal: &str, child: &Child) -> Child {
    let mut shell = Command::new("sh");
    shell.args(["-c", r#"read -r word && kill "$0" "$1""#, signal, &child.id().to_string()]);
    shell.stdin(Stdio::piped()).spawn().expect("a shell starts")
}

/// Has a shell that is ready send its signal.
fn send(mut shell: Child) {
    shell.stdin.take().expect("a pipe").write_all(b"now\n").expect("the shell waits");
    assert!(shell.wait().expect("it ends").success());
}

/// Sends a running command a signal as soon as something is there, and says how it ended; none if
/// it ended before.
fn ended_by(signal: &str, child: &mut Child, is_there: &dyn Fn() -> bool) -> Option<ExitStatus> {
    let (start, mut shell) = (Instant::now(), ready(signal, child));
    while !is_there() {
        if let Some(status) = child.try_wait().expect("a status") {
            assert_eq!(status.code(), Some(0), "nothing but its end ends it");
            drop(shell.stdin.take());
            shell.wait().expect("it ends");
            return None;
        }
        assert!(start.elapsed() < Duration::from_secs(120), "nothing came");
        sleep(Duration::from_micros(200));
    }
    send(shell);
    Some(child.wait().expect("it ends"))
}

fn is_temporary(name: &str) -> bool {
    name.starts_with('.')
}

/// A log of tens of megabytes: it takes longer to be written than `kill` to be started, on a busy
/// machine as well.
const LONG: &str = r#"{"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 0.2,
 "log_period_s": 1e-6}"#;

#[test]
fn a_signal_leaves_no_half_of_an_output() {
    let directory = Directory::new("no-signal");
    fs::write(directory.path.join("long.json"), LONG).expect("a file");
    let whole = run_in(&directory.path, &["simulate", "long.json", "-o", "-"]).stdout;
    for (signal, number) in [("-INT", 2), ("-TERM", 15), ("-HUP", 1), ("-KILL", 9)] {
        let mut status = None;
        // A run may have written before `kill` is started, and on a busy machine mostly has.
        for _ in 0..200 {
            let directory = Directory::new("signal");
            fs::write(directory.path.join("long.json"), LONG).expect("a file");
            let mut child = command(&directory.path)
                .args(["simulate", "long.json", "-o", "log.csv"])
                .stdout(Stdio::null())
                .spawn()
                .expect("the command starts");
            let is_writing = || directory.files().iter().any(|name| is_temporary(name));
            status = ended_by(signal, &mut child, &is_writing);
            let mut left = directory.files();
            // an end that cannot be heeded leaves a file under a name that is nobody's
            left.retain(|name| number != 9 || !is_temporary(name));
            let is_named = left == ["log.csv", "long.json"];
            if status.is_some_and(|status| status.signal() == Some(number)) && !is_named {
                assert_eq!(left, ["long.json"], "{signal}");
                // which is in no later run's way
                let run = run_in(&directory.path, &["simulate", "long.json", "-o", "log.csv"]);
                assert_eq!(run.code, Some(0), "{}", run.stderr);
                break;
            }
            // what has its name is whole
            assert!(is_named, "{signal}: {left:?}");
            let log = fs::read_to_string(directory.path.join("log.csv")).expect("a log");
            assert!(log == whole, "{signal}: {} of {} bytes", log.len(), whole.len());
            status = None;
        }
        let status = status.expect("a run is caught");
        assert_eq!(status.signal(), Some(number), "a shell sees 128 and {number}: {status}");
    }
}

/// The log is a pipe into which nothing is written: the run waits until the signal comes.
#[test]
fn a_signal_leaves_no_empty_folder() {
    let directory = Directory::new("signal-folder");
    let made = Command::new("mkfifo").arg(directory.path.join("log.csv")).status();
    assert!(made.expect("mkfifo runs").success());
    let words = ["diagnose", "tulip_leg_table34", "--train", "log.csv", "--validate", "log.csv"];
    let mut child = command(&directory.path)
        .args([&words[..], &["--out", "new/found"]].concat())
        .spawn()
        .expect("the command starts");
    let there = directory.path.join("new/found");
    let status = ended_by("-TERM", &mut child, &|| there.exists()).expect("it waits");
    assert_eq!(status.signal(), Some(15));
    assert_eq!(directory.files(), ["log.csv"]);
}

/// Who starts a run with `nohup` wants it to go on.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_was_ignored_stays_ignored() {
    let directory = Directory::new("nohup");
    fs::write(directory.path.join("long.json"), LONG).expect("a file");
    let denavit = env!("CARGO_BIN_EXE_denavit");
    let script = format!("trap '' HUP; exec '{denavit}' simulate long.json -o log.csv > said.txt");
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(&directory.path)
        .spawn()
        .expect("a shell starts");
    let is_begun = || directory.files().iter().any(|name| is_temporary(name) || name == "said.txt");
    if let Some(status) = ended_by("-HUP", &mut child, &is_begun) {
        assert_eq!(status.code(), Some(0), "{status}");
    }
    assert_eq!(directory.files(), ["log.csv", "long.json", "said.txt"]);
}

fn draw(directory: &Directory, to: &str) -> super::Run {
    run_in(&directory.path, &["inspect", "scara", "--svg", to])
}

fn is_picture(path: &Path) -> bool {
    fs::read_to_string(path).is_ok_and(|text| text.starts_with("<svg"))
}

#[test]
fn a_link_stays_a_link_and_its_target_is_written() {
    let directory = Directory::new("links");
    let at = |name: &str| directory.path.join(name);
    fs::create_dir(at("folder")).expect("a directory");
    fs::write(at("folder/old.svg"), "old").expect("a file");
    symlink("folder/old.svg", at("old")).expect("a link");
    // of links that lead to nothing yet, one leads to another
    symlink("folder/new.svg", at("first")).expect("a link");
    symlink("first", at("second")).expect("a link");
    for (link, target) in [("old", "folder/old.svg"), ("second", "folder/new.svg")] {
        for _ in 0..2 {
            let run = draw(&directory, link);
            assert_eq!(run.code, Some(0), "{link}: {}", run.stderr);
            assert!(at(link).is_symlink() && is_picture(&at(target)), "{link}");
            assert!(!at(target).is_symlink(), "{target}");
        }
    }
    assert_eq!(directory.files(), ["first", "folder", "old", "second"]);
}

#[test]
fn standard_output_is_no_folder() {
    let directory = Directory::new("no_folder");
    let message = super::errors::refused(&directory, &["man", "--out", "-"]);
    assert_says(&message, &["no folder", "hint: "]);
}

#[test]
fn a_link_to_nowhere_is_refused() {
    let directory = Directory::new("lost-links");
    symlink("no/such/place.svg", directory.path.join("lost")).expect("a link");
    symlink("circle", directory.path.join("circle")).expect("a link");
    for (link, said) in [
        ("lost", &["lost: is a link to no/such/place.svg", "hint: make the directory"][..]),
        ("circle", &["circle: cannot be written"]),
    ] {
        let run = draw(&directory, link);
        assert_eq!(run.code, Some(2), "{}", run.stderr);
        assert_says(&run.stderr, said);
        assert!(directory.path.join(link).is_symlink());
    }
    assert_eq!(directory.files(), ["circle", "lost"]);
}

/// Two outputs are one file by whatever names they have.
#[test]
fn links_do_not_hide_that_two_outputs_are_one() {
    let directory = Directory::new("one-by-links");
    symlink("both", directory.path.join("link")).expect("a link");
    let words = ["simulate", "bouncing_ball", "-o", "both", "--svg", "link"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert_says(&run.stderr, &["two outputs would be this file"]);
}

#[test]
fn a_new_output_has_the_permissions_of_any_new_file() {
    use std::os::unix::fs::PermissionsExt;
    let directory = Directory::new("permissions");
    fs::write(directory.path.join("other"), "").expect("a file");
    assert_eq!(draw(&directory, "new.svg").code, Some(0));
    let mode = |name: &str| {
        let metadata = fs::metadata(directory.path.join(name)).expect("a file");
        metadata.permissions().mode() & 0o777
    };
    assert_eq!(mode("new.svg"), mode("other"));
    // and an old one keeps its own
    fs::set_permissions(directory.path.join("new.svg"), fs::Permissions::from_mode(0o640))
        .expect("permissions");
    assert_eq!(draw(&directory, "new.svg").code, Some(0));
    assert_eq!(mode("new.svg"), 0o640);
}
