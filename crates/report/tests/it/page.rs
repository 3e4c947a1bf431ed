//! Reports: pages of HTML.

use denavit_report::html::{Cell, Fact, Heading, HtmlTable, Page, Part, Row, Section, mathml};
use std::process::Command;

fn page() -> Page {
    let row = |name: &str, latex: &str, value: f64| Row {
        cells: vec![
            Cell::text(name),
            Cell::formula(latex).unwrap(),
            Cell::number(value, format!("{value:.3}")),
        ],
        is_marked: value < 0.0,
    };
    let heading = |text: &str, is_number| Heading { heading: text.to_owned(), is_number };
    let table = HtmlTable {
        caption: "Base parameters".to_owned(),
        columns: vec![heading("name", false), heading("formula", false), heading("value", true)],
        rows: vec![
            row("a", r"m_{1} + \frac{c_{1}^{2} m_{2} + I_{1}}{l_{1}^{2}}", 10.0),
            row("b", r"\left(m_{x,2} - d_{3} m_{2}\right) \cdot \cos \alpha_{1}", -2.5),
            row("c", r"\dot{q}_{1} \mathrm{off}_{3}", 9.0),
        ],
    };
    let svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"9\" height=\"9\"></svg>";
    Page {
        title: "Identified <robot> & more".to_owned(),
        lead: "All is \"well\".".to_owned(),
        facts: vec![Fact { name: "seed".to_owned(), value: "7".to_owned() }],
        sections: vec![Section {
            heading: "Parameters".to_owned(),
            parts: vec![
                Part::Table(table),
                Part::Figure { svg: svg.to_owned(), caption: "nothing".to_owned() },
                Part::Paragraph { text: "</p><script>alert(1)</script>".to_owned() },
                Part::Formula { mathml: mathml("y = x^{2}", true).unwrap() },
            ],
        }],
    }
}

#[test]
fn text_is_escaped_and_nothing_is_loaded() {
    let text = page().render();
    assert!(text.contains("Identified &lt;robot&gt; &amp; more"), "{text}");
    assert!(!text.contains("<script>alert"), "{text}");
    // names of XML dialects are no addresses
    let loaded = text.replace("http://www.w3.org/", "");
    for word in ["http:", "https:", "src=", "href=", "url(", "@import"] {
        assert!(!loaded.contains(word), "{word}");
    }
}

#[test]
fn spaces_of_formulas_are_spaces() {
    let text = mathml(r"\tau_{\mathrm{ankle~y}}", false).unwrap();
    assert!(text.contains("<mspace") && !text.contains("nbsp"), "{text}");
}

#[test]
fn formulas_become_elements() {
    let text = mathml(r"\frac{a}{b_{1}}", false).unwrap();
    for element in ["<math", "<mfrac>", "<msub>"] {
        assert!(text.contains(element), "{text}");
    }
    let error = mathml(r"\frac{a}", false).unwrap_err();
    assert!(error.to_string().contains(r"\frac{a}"), "{error}");
}

/// The first of these programs that is installed.
fn chromium() -> Option<&'static str> {
    let names = ["chromium", "chromium-browser", "google-chrome"];
    names.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok())
}

/// In a browser, where one is installed: the script runs, and a click sorts rows by their numbers.
#[test]
fn a_browser_shows_and_sorts_the_page() {
    let Some(program) = chromium() else {
        eprintln!("no browser is installed");
        return;
    };
    let directory = std::env::temp_dir().join(format!("denavit-page-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let file = directory.join("report.html");
    let click = "<script>document.querySelectorAll('th')[2].click()</script>\n</body>";
    std::fs::write(&file, page().render().replace("</body>", click)).unwrap();
    let output = Command::new(program)
        .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .arg(format!("--user-data-dir={}", directory.join("profile").display()))
        .arg(format!("file://{}", file.display()))
        .output()
        .unwrap();
    let shown = String::from_utf8_lossy(&output.stdout).into_owned();
    std::fs::remove_dir_all(&directory).unwrap();
    assert!(shown.contains("data-ready=\"yes\""), "{shown}");
    let place = |text: &str| shown.find(text).unwrap_or_else(|| panic!("{text}: {shown}"));
    assert!(place("-2.500") < place("9.000") && place("9.000") < place("10.000"));
}
