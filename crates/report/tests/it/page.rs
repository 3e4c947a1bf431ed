//! Reports: pages of HTML.

use denavit_report::html::{
    Cell, Chart, ChartCurve, Fact, Grade, Heading, HtmlTable, Look, Page, Panel, Part, Row,
    Section, Tab, VerdictLine, mathml,
};
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
        watches: false,
        title: "Identified <robot> & more".to_owned(),
        verdict: Some(VerdictLine { grade: Grade::Fair, text: "So <so>.".to_owned() }),
        lead: "All is \"well\".".to_owned(),
        facts: vec![Fact { name: "seed".to_owned(), value: "7".to_owned() }],
        sections: vec![Section {
            heading: "Parameters".to_owned(),
            parts: vec![
                Part::Table(table),
                Part::Figure { svg: svg.to_owned(), caption: "nothing".to_owned() },
                Part::Paragraph { text: "</p><script>alert(1)</script>".to_owned() },
                Part::Formula { mathml: mathml("y = x^{2}", true).unwrap() },
                Part::Chart(chart()),
                Part::Tabs { tabs: vec![tab("one"), tab("two")] },
                Part::Folded {
                    summary: "more".to_owned(),
                    parts: vec![Part::Paragraph { text: "inside".to_owned() }],
                },
            ],
        }],
    }
}

/// A curve with more rows than are drawn, whose names end elements.
fn chart() -> Chart {
    let x: Vec<f64> = (0..20_000).map(|row| 1e-3 * f64::from(row)).collect();
    let mut values = vec![0.0; x.len()];
    values[7777] = 31.25;
    let curve = ChartCurve::new("</script><b>", Look::Measured, values);
    let panels = vec![Panel::new("torque <[N m]>", 100, vec![curve])];
    let name = "<!-- torque".to_owned();
    Chart { name, group: "torques", over: ["time", "time [s]"], x, panels, ..Chart::default() }
        .thinned()
}

fn tab(name: &str) -> Tab {
    let text = format!("panel {name}");
    Tab { name: name.to_owned(), parts: vec![Part::Paragraph { text }] }
}

/// A page without the scripts and styles that it carries.
fn written(text: &str) -> String {
    let mut rest = text;
    let mut kept = String::new();
    for (open, close) in [("<style>", "</style>"), ("<script>", "</script>")] {
        let (before, after) = rest.split_once(open).expect("an element");
        kept += before;
        rest = after.split_once(close).expect("its end").1;
    }
    kept + rest
}

#[test]
fn text_is_escaped_and_nothing_is_loaded() {
    let text = written(&page().render());
    assert!(text.contains("Identified &lt;robot&gt; &amp; more"), "{text}");
    assert!(text.contains("So &lt;so&gt;."), "{text}");
    for markup in ["<script>", "<b>", "<!-- ", " style=", "unsafe-inline"] {
        assert!(!text.contains(markup), "{markup}: {text}");
    }
    // names of XML dialects are no addresses
    let loaded = text.replace("http://www.w3.org/", "");
    for word in ["http:", "https:", "src=", "href=", "url(", "@import"] {
        assert!(!loaded.contains(word), "{word}");
    }
}

#[test]
fn long_curves_keep_what_stands_out_and_say_so() {
    let text = page().render();
    assert!(text.contains("31.25") && text.contains("7.777"), "the peak");
    assert!(text.contains("of 20000 samples are drawn"), "{}", chart().caption);
    assert!(chart().x.len() < 2500, "{}", chart().x.len());
}

/// A page without runs does without the library that draws them.
#[test]
fn pages_are_as_large_as_what_they_show() {
    let text = page().render();
    assert!(text.len() < 150_000, "{}", text.len());
    assert_eq!(text, page().render(), "the same bytes");
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

/// In a browser, where one is installed: the scripts are those that the page allows, and a click
/// sorts rows by their numbers.
#[test]
fn a_browser_shows_and_sorts_the_page() {
    let Some(program) = chromium() else {
        eprintln!("no browser is installed");
        return;
    };
    let directory = std::env::temp_dir().join(format!("denavit-page-{}", std::process::id()));
    std::fs::create_dir_all(&directory).unwrap();
    let file = directory.join("report.html");
    let show = |page: &str| {
        std::fs::write(&file, page).unwrap();
        let output = Command::new(program)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--dump-dom"])
            .arg(format!("--user-data-dir={}", directory.join("profile").display()))
            .arg(format!("file://{}", file.display()))
            .output()
            .unwrap();
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let page = page().render();
    let as_it_is = show(&page);
    // charts are made when they are seen, or all of them for paper
    let click = "<script>document.querySelectorAll('thead button')[2].click();\
                 window.dispatchEvent(new Event('beforeprint'))</script>\n</body>";
    let clicked = page.replace("</body>", click);
    // its policy refuses a script that is not of its frame
    let refused = show(&clicked);
    let shown = show(&clicked.replace("Content-Security-Policy", "none"));
    std::fs::remove_dir_all(&directory).unwrap();
    assert!(as_it_is.contains("data-ready=\"yes\""), "{as_it_is}");
    assert!(shown.contains("<canvas"), "the curve: {shown}");
    let is_sorted = |shown: &str| {
        let place = |text: &str| shown.find(text).unwrap_or_else(|| panic!("{text}: {shown}"));
        place("-2.500") < place("9.000") && place("9.000") < place("10.000")
    };
    assert!(is_sorted(&shown), "{shown}");
    assert!(!is_sorted(&refused), "a script that the page does not allow ran");
}
