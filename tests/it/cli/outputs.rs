//! Outputs that are whole or not there: signals, links, what killed runs left behind.
#![cfg(unix)]

use super::errors::assert_says;
use super::{Directory, command, run_in};
use std::fs;
use std::os::unix::fs::symlink;
use std::os::unix::process::ExitStatusExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const LONGEST_WAIT: Duration = Duration::from_secs(120);

/// Sends a running command a signal as soon as something is there.
fn send(signal: &str, child: &mut Child, is_there: &dyn Fn() -> bool) {
    let start = Instant::now();
    while !is_there() {
        assert!(child.try_wait().expect("a status").is_none(), "it waits");
        assert!(start.elapsed() < LONGEST_WAIT, "nothing came");
        sleep(Duration::from_micros(200));
    }
    let sent = Command::new("kill").args([signal, &child.id().to_string()]).status();
    assert!(sent.expect("kill runs").success());
}

/// How a command ends, which it does not if it missed its signal.
fn ended(mut child: Child) -> ExitStatus {
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a status") {
            return status;
        }
        if start.elapsed() > LONGEST_WAIT {
            child.kill().expect("it is ended");
            panic!("it does not end");
        }
        sleep(Duration::from_millis(1));
    }
}

/// Whether a signal is ignored by whoever runs the tests, as an interrupt is by jobs in the
/// background: commands that they start ignore it as well, and are to.
fn is_ignored(signal: i32) -> bool {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_some_and(|mask| mask & (1 << (signal - 1)) != 0)
}

fn is_temporary(name: &str) -> bool {
    name.starts_with('.')
}

fn make_pipe(directory: &Directory, name: &str) {
    let made = Command::new("mkfifo").arg(directory.path.join(name)).status();
    assert!(made.expect("mkfifo runs").success());
}

/// Files are named together. Of these the second is a pipe: until somebody reads it, the first is
/// written and has no name.
const TWO_FILES: [&str; 5] = ["emit", "scara", "--language", "c", "-o"];

#[test]
fn a_signal_leaves_no_half_of_an_output() {
    let signals = [("-INT", 2), ("-TERM", 15), ("-HUP", 1), ("-KILL", 9)];
    for (signal, number) in signals.into_iter().filter(|(_, number)| !is_ignored(*number)) {
        let directory = Directory::new("signal");
        make_pipe(&directory, "code.h");
        let mut waits = command(&directory.path);
        let mut child =
            waits.args(TWO_FILES).arg("code.c").stdout(Stdio::null()).spawn().expect("it starts");
        send(signal, &mut child, &|| directory.files().iter().any(|name| is_temporary(name)));
        let status = ended(child);
        assert_eq!(status.signal(), Some(number), "a shell sees 128 and {number}: {status}");
        let mut left = directory.files();
        // an end that cannot be heeded leaves a file under a name that is nobody's
        left.retain(|name| number != 9 || !is_temporary(name));
        assert_eq!(left, ["code.h"], "{signal}");
        // which is in no later run's way
        fs::remove_file(directory.path.join("code.h")).expect("a pipe");
        let run = run_in(&directory.path, &[&TWO_FILES[..], &["code.c"]].concat());
        assert_eq!(run.code, Some(0), "{}", run.stderr);
    }
}

/// The log is a pipe into which nothing is written: the run waits until the signal comes.
#[test]
fn a_signal_leaves_no_empty_folder() {
    let directory = Directory::new("signal-folder");
    make_pipe(&directory, "log.csv");
    let words = ["diagnose", "tulip_leg_table34", "--train", "log.csv", "--validate", "log.csv"];
    let mut child = command(&directory.path)
        .args([&words[..], &["--out", "new/found"]].concat())
        .spawn()
        .expect("the command starts");
    let there = directory.path.join("new/found");
    send("-TERM", &mut child, &|| there.exists());
    assert_eq!(ended(child).signal(), Some(15));
    assert_eq!(directory.files(), ["log.csv"]);
}

/// Who starts a run with `nohup` wants it to go on.
#[cfg(target_os = "linux")]
#[test]
fn a_signal_that_was_ignored_stays_ignored() {
    let directory = Directory::new("nohup");
    make_pipe(&directory, "code.h");
    let denavit = env!("CARGO_BIN_EXE_denavit");
    let script = format!("trap '' HUP; exec '{denavit}' {} code.c > said.txt", TWO_FILES.join(" "));
    let mut child = Command::new("sh")
        .args(["-c", &script])
        .current_dir(&directory.path)
        .spawn()
        .expect("a shell starts");
    send("-HUP", &mut child, &|| directory.files().iter().any(|name| is_temporary(name)));
    let read = Command::new("cat").arg(directory.path.join("code.h")).stdout(Stdio::null()).spawn();
    let status = ended(child);
    // a run that the signal ended has left nothing to read
    let _ = read.expect("a reader").kill();
    assert_eq!(status.code(), Some(0), "{status}");
    assert_eq!(directory.files(), ["code.c", "code.h", "said.txt"]);
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
