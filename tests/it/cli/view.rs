//! `denavit view`: the page of a folder's results; its server is tried in a browser
//! (tests/pages).

use super::errors::{assert_says, refused};
use super::{Directory, run_in};
use std::fs;

#[test]
fn a_folder_has_a_page_that_links_to_its_results() {
    let directory = Directory::new("view");
    fs::create_dir(directory.path.join("runs")).expect("a folder");
    fs::write(directory.path.join("runs/<b>.csv"), "t\n0\n").expect("a file");
    fs::write(directory.path.join(".hidden.csv"), "t\n0\n").expect("a file");
    let run = run_in(&directory.path, &["view", ".", "-o", "index.html"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let read = || fs::read_to_string(directory.path.join("index.html")).expect("a page");
    let page = read();
    assert_eq!(run_in(&directory.path, &["view", ".", "-o", "index.html"]).code, Some(0));
    assert_eq!(read(), page, "a page does not list itself");
    assert!(page.contains("&lt;b&gt;.csv") && !page.contains("<b>.csv"));
    assert!(!page.contains(".hidden.csv"));
}

#[test]
fn pages_elsewhere_and_folders_that_are_not_there_are_refused() {
    let directory = Directory::new("view_refused");
    fs::create_dir(directory.path.join("runs")).expect("a folder");
    let message = refused(&directory, &["view", "runs", "-o", "index.html"]);
    assert_says(&message, &["index.html: is not in runs", "hint: "]);
    let message = refused(&directory, &["view", "none"]);
    assert_says(&message, &["none: cannot be read: no such file"]);
}
