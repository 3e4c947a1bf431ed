//! docs/reference/command.md is made of the help texts of the command.

use super::root;
use std::fs;
use std::process::Command;

const COMMANDS: [&str; 37] = [
    "demo",
    "list",
    "inspect",
    "import",
    "export",
    "derive",
    "decompose",
    "base",
    "verify",
    "count",
    "evaluate",
    "emit",
    "schema",
    "simulate",
    "excite",
    "identify",
    "long",
    "long plan",
    "long condense",
    "long estimate",
    "diagnose",
    "walk",
    "walk design",
    "walk zmp",
    "walk fri",
    "walk capture",
    "walk momentum",
    "walk poincare",
    "walk basin",
    "walk push",
    "walk capturability",
    "walk capture-steps",
    "walk compare",
    "walk page",
    "completions",
    "man",
    "view",
];

fn help(command: &str) -> String {
    let mut run = Command::new(env!("CARGO_BIN_EXE_denavit"));
    run.args(command.split_whitespace()).arg("--help").env_remove("COLUMNS");
    let output = run.output().expect("the command starts");
    assert!(output.status.success(), "{command}");
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    text.lines().map(|line| format!("{}\n", line.trim_end())).collect()
}

fn page() -> String {
    let mut page = String::from(
        "# The command\n\nMade of the help texts (`UPDATE_EXPECT=1 cargo test --release --test it \
         command_page` writes it anew). `-h` prints a short form.\n\n",
    );
    for command in [""].into_iter().chain(COMMANDS) {
        let title = format!("denavit {command}");
        page += &format!("## {}\n\n```text\n{}```\n\n", title.trim_end(), help(command));
    }
    page.truncate(page.trim_end().len());
    page + "\n"
}

#[test]
fn the_page_of_the_command_is_that_of_its_help() {
    let page = page();
    let path = root().join("docs/reference/command.md");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        fs::write(&path, &page).unwrap();
    }
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(written == page, "{}: UPDATE_EXPECT=1 writes it anew", path.display());
}

#[test]
fn the_page_has_every_command() {
    for parent in ["", "walk ", "long "] {
        let text = help(parent);
        let (_, listed) = text.split_once("Commands:\n").expect("commands");
        let lines = listed.lines().take_while(|line| !line.is_empty());
        let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
        for name in names.filter_map(|line| line.split_whitespace().next()) {
            let full = format!("{parent}{name}");
            assert!(name == "help" || COMMANDS.contains(&full.as_str()), "{full}");
        }
    }
}
