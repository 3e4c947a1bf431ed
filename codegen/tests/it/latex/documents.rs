//! What the documents say, against the graph they were written from.

use super::reader::{Names, read};
use crate::robots::{load, shipped};
use denavit_codegen::derive::{Derivation, Flavour, derive};
use denavit_codegen::emit::latex::document;
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use std::collections::BTreeMap;

const WANTED: [FunctionName; 4] = [
    FunctionName::MassMatrix,
    FunctionName::CoriolisMatrix,
    FunctionName::GravityVector,
    FunctionName::ContactJacobian,
];

fn derived(name: &str) -> (Robot, Derivation, String) {
    set(name, &WANTED)
}

/// The document of some functions.
pub(super) fn set(name: &str, wanted: &[FunctionName]) -> (Robot, Derivation, String) {
    let robot = load(name);
    let derivation = derive(&robot, Flavour::Tunable, wanted).expect("nothing is baked");
    let text = document(&robot, &derivation.dag, &derivation.functions).expect("a template fits");
    (robot, derivation, text)
}

/// What the nomenclature says of the symbols, worked out from the model file's names alone.
fn names(robot: &Robot) -> Names {
    let mut names = Names::new();
    let joints: Vec<(String, String)> = robot
        .joints()
        .enumerate()
        .map(|(row, (link, _))| (robot.links[link].name.clone(), (row + 1).to_string()))
        .collect();
    let mut dag = robot.dag.clone();
    for id in robot.dag.symbols().keys() {
        let name = robot.dag.symbols()[id].name.clone();
        let (head, tail) = name.split_once('_').unwrap_or((&name, ""));
        let number = joints.iter().find(|(link, _)| link == tail).map(|(_, number)| number);
        let number = number.cloned().unwrap_or_else(|| tail.to_owned());
        let latex = match head {
            "q" => format!("q_{number}"),
            "qd" => format!("\\dot q_{number}"),
            "qdd" => format!("\\ddot q_{number}"),
            "cx" | "cy" | "cz" => format!("r_{},{number}", &head[1..]),
            _ if head.starts_with('I') && !tail.is_empty() => {
                format!("I_{},{number}", &head[1..])
            }
            _ if !tail.is_empty() => format!("{head}_{number}"),
            _ if head.len() > 1 => format!("{}_{}", &head[..1], &head[1..]),
            _ => head.to_owned(),
        };
        names.insert(latex, dag.symbol_expr(id));
    }
    names
}

/// The formulas `name = formula` in `\formula{...}`, with braces balanced.
fn formulas(text: &str) -> Vec<(String, String)> {
    let mut formulas = Vec::new();
    for part in text.split("\n\\formula{").skip(1) {
        let mut depth = 1;
        let end = part.find(|c| {
            depth += i32::from(c == '{') - i32::from(c == '}');
            depth == 0
        });
        let (name, formula) = part[..end.expect("closed")].split_once(" = ").expect("a formula");
        formulas.push((name.to_owned(), formula.to_owned()));
    }
    formulas
}

/// Formulas of several lines.
fn displays(text: &str) -> Vec<(String, String)> {
    let parts = text.split("\\begin{aligned}").skip(1);
    parts
        .map(|part| {
            let body = part.split_once("\\end{aligned}").expect("closed").0;
            let (name, formula) = body.split_once(" = {} & ").expect("a formula");
            (name.trim().to_owned(), formula.replace("\\\\\n&", " "))
        })
        .collect()
}

/// The entries of a matrix that is set as one.
fn matrix_entries(section: &str) -> Option<Vec<String>> {
    let body = section.split_once(r"\begin{bmatrix}")?.1.split_once(r"\end{bmatrix}")?.0;
    let rows = body.split(r"\\").flat_map(|row| row.split('&'));
    Some(rows.map(|entry| entry.trim().to_owned()).collect())
}

/// Reads a section back: `letter_{ij}` entry by entry, or the whole matrix.
fn read_section(
    dag: &mut Dag,
    names: &mut Names,
    section: &str,
    letter: &str,
    shape: [usize; 2],
) -> Vec<ExprId> {
    if let Some(entries) = matrix_entries(section) {
        return entries.iter().map(|entry| read(dag, names, entry)).collect();
    }
    let listed: BTreeMap<String, String> =
        formulas(section).into_iter().chain(displays(section)).collect();
    let is_symmetric = section.contains("is symmetric");
    let comma = if shape.iter().any(|&size| size > 9) { "," } else { "" };
    let mut entries = Vec::new();
    for row in 1..=shape[0] {
        for column in 1..=shape[1] {
            let mirrored = is_symmetric && row > column;
            let (i, j) = if mirrored { (column, row) } else { (row, column) };
            let name = format!("{letter}_{{{i}{comma}{j}}}");
            entries.push(match listed.get(&name) {
                Some(formula) => read(dag, names, formula),
                None => dag.zero(),
            });
        }
    }
    entries
}

/// Reads matrices back, each with its letter; the first is the mass matrix.
pub(super) fn assert_reads_back(name: &str, wanted: &[FunctionName], letters: &[&str]) {
    let (robot, derivation, text) = set(name, wanted);
    let mut dag = derivation.dag.clone();
    let mut names = names(&robot);
    let (before, sections) = text.split_once("\\subsection{Mass matrix}").unwrap();
    for (name, formula) in formulas(before) {
        let value = read(&mut dag, &names, &formula);
        let plain = name.replace(['{', '}'], "");
        assert!(names.insert(plain, value).is_none(), "{name} is defined twice");
    }
    let mut parts = sections.split("\\subsection{");
    for (letter, function) in letters.iter().zip(&derivation.functions) {
        let section = parts.next().unwrap();
        let shape = function.outputs[0].shape[..].try_into().unwrap();
        let entries = read_section(&mut dag, &mut names, section, letter, shape);
        let ours = function.entries();
        assert_eq!(entries.len(), ours.len());
        for seed in 1..3 {
            let values = |list: &[ExprId]| evaluate(&dag, list, &mut Residues::new(seed)).unwrap();
            assert_eq!(values(&entries), values(&ours), "{name}: {letter}");
        }
    }
}

#[test]
fn a_reader_finds_d_and_c_of_puma_in_the_document() {
    assert_reads_back("puma560", &WANTED, &["D", "C"]);
}

#[test]
fn a_reader_finds_d_and_c_of_robots_with_parallel_axes_in_the_document() {
    for name in ["double_pendulum", "planar_2r", "scara", "tulip_leg6"] {
        assert_reads_back(name, &WANTED, &["D", "C"]);
    }
}

#[test]
fn the_double_pendulum_is_set_as_in_the_thesis() {
    let (_, _, text) = derived("double_pendulum");
    // A.17 and A.18 (corrected), with sums and products in this crate's order.
    for entry in [
        r"m_1 c_1^2 + I_1 + m_2 (c_2^2 + 2 c_2 l_1 \cos q_2 + l_1^2) + I_2",
        r"& m_2 c_2 (c_2 + l_1 \cos q_2) + I_2 \\",
        r"\\ m_2 c_2 (c_2 + l_1 \cos q_2) + I_2 & m_2 c_2^2 + I_2 \end{bmatrix}",
        r"\begin{bmatrix} -m_2 c_2 l_1 \dot{q}_2 \sin q_2 &",
        r"& -m_2 c_2 l_1 (\dot{q}_1 + \dot{q}_2) \sin q_2 \\",
        r"\\ m_2 c_2 l_1 \dot{q}_1 \sin q_2 & 0 \end{bmatrix}",
    ] {
        assert!(text.contains(entry), "{entry} is not in:\n{text}");
    }
}

#[test]
fn every_shipped_robot_has_a_sound_document() {
    let walking = [&[FunctionName::MassMatrix][..], &FunctionName::WALKING].concat();
    let mut documents: Vec<_> = shipped().into_iter().map(|name| (name, &WANTED[..])).collect();
    documents.push(("planar_biped".to_owned(), &walking[..]));
    for (name, wanted) in documents {
        let (robot, derivation, text) = set(&name, wanted);
        let again = document(&robot, &derivation.dag, &derivation.functions).unwrap();
        assert_eq!(text, again, "{name}");
        let mut depth = 0i32;
        let mut escaped = false;
        for character in text.chars() {
            depth +=
                i32::from(character == '{' && !escaped) - i32::from(character == '}' && !escaped);
            assert!(depth >= 0, "{name}: a brace is closed that was not opened");
            escaped = character == '\\' && !escaped;
        }
        assert_eq!(depth, 0, "{name}");
        let count = |part: &str| text.matches(part).count();
        assert_eq!(count("\\left("), count("\\right)"), "{name}");
        assert_eq!(count("\\begin{"), count("\\end{"), "{name}");
        // About 90 formulas fill a page: see the page count with pdflatex.
        assert!(count("\n\\formula{") < 40 * 70, "{name}: {}", count("\n\\formula{"));
        let mut defined = Vec::new();
        for (name, formula) in formulas(&text) {
            for used in formula.split("x_").skip(1) {
                let index: String =
                    used.trim_start_matches('{').chars().take_while(char::is_ascii_digit).collect();
                let used =
                    if index.len() > 1 { format!("x_{{{index}}}") } else { format!("x_{index}") };
                assert!(defined.contains(&used), "{name} uses {used} before it is defined");
            }
            if name.starts_with("x_") {
                defined.push(name);
            }
        }
    }
}

#[test]
fn declared_parameters_are_in_the_nomenclature() {
    let (robot, _, text) = derived("tulip");
    let special = |c: char| "_%&#^\"<>".contains(c);
    let docs = robot.parameters.values().map(|parameter| &parameter.doc);
    let plain: Vec<&String> =
        docs.filter(|doc| !doc.is_empty() && !doc.contains(special)).collect();
    assert!(plain.len() > 5);
    for doc in plain {
        assert!(text.contains(doc), "{doc}");
    }
}

/// Needs `pdflatex`; run with `--ignored`.
#[test]
#[ignore = "needs pdflatex"]
fn documents_compile_to_at_most_forty_pages() {
    let folder = std::env::temp_dir().join(format!("denavit-latex-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for name in shipped() {
        let (_, _, text) = derived(&name);
        std::fs::write(folder.join("equations.tex"), text).unwrap();
        let run = std::process::Command::new("pdflatex")
            .args(["-interaction=nonstopmode", "-halt-on-error", "equations.tex"])
            .current_dir(&folder)
            .output()
            .expect("pdflatex runs");
        let log = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success(), "{name}:\n{log}");
        assert!(!log.contains("Overfull"), "{name}: a line is too long\n{log}");
        let pages = log.split_once("Output written on equations.pdf (").unwrap().1;
        let pages: u32 = pages.split_once(" page").unwrap().0.parse().unwrap();
        assert!(pages <= 40, "{name}: {pages} pages");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
