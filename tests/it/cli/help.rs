//! Every help text has an example, and every example runs.

use super::{Directory, answer, run_in};

/// In an order in which an example may read what one before it wrote: `verify` reads a
/// certificate, `import` a URDF.
const COMMANDS: [&str; 20] = [
    "demo",
    "export",
    "import",
    "evaluate",
    "list",
    "inspect",
    "derive",
    "decompose",
    "count",
    "emit",
    "base",
    "verify",
    "schema",
    "simulate",
    "excite",
    "identify",
    "diagnose",
    "completions",
    "man",
    "view",
];

/// The commands of `walk`.
const WALK: [&str; 11] = [
    "zmp",
    "fri",
    "capture",
    "momentum",
    "poincare",
    "basin",
    "push",
    "capturability",
    "capture-steps",
    "compare",
    "page",
];

/// The command lines of a help text's examples; three blanks begin a remark.
fn examples(help: &str) -> Vec<Vec<String>> {
    let (_, examples) = help.split_once("Example").expect("a help text has an example");
    examples
        .lines()
        .filter_map(|line| line.trim().strip_prefix("denavit "))
        .map(|line| line.split("   ").next().unwrap_or(line))
        .map(|line| line.split_whitespace().map(str::to_owned).collect())
        .collect()
}

#[test]
fn every_example_of_every_help_text_runs() {
    let directory = Directory::new("examples");
    let helps = COMMANDS.map(|command| answer(&[command, "--help"])).into_iter();
    let walk = [answer(&["walk", "--help"])].into_iter();
    let walk = walk.chain(WALK.map(|command| answer(&["walk", command, "--help"])));
    for help in helps.chain([answer(&["--help"])]).chain(walk) {
        let examples = examples(&help);
        assert!(!examples.is_empty(), "no example in:\n{help}");
        for example in examples {
            let words: Vec<&str> = example.iter().map(String::as_str).collect();
            let run = run_in(&directory.path, &words);
            assert_eq!(run.code, Some(0), "{example:?}: {}", run.stderr);
            assert!(!run.stdout.is_empty(), "{example:?} says nothing");
            for option in ["--svg", "--html", "--latex", "--certificate", "-o"] {
                let at = words.iter().position(|word| *word == option);
                let file = at.and_then(|at| words.get(at + 1)).filter(|file| **file != "-");
                if let Some(file) = file {
                    assert!(directory.path.join(file).is_file(), "{example:?} wrote nothing");
                }
            }
        }
    }
}

#[test]
fn the_overview_lists_every_command() {
    let help = answer(&["--help"]);
    for command in COMMANDS.into_iter().chain(["walk"]) {
        assert!(help.lines().any(|line| line.trim().starts_with(command)), "{command}:\n{help}");
    }
}
