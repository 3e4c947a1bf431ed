//! Documents of f and B, read back by a reader of its own.

use super::reader::{Names, read};
use crate::robots::{load, repository};
use denavit_codegen::emit::latex::{equations_decomposition, robot_decomposition};
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::fundamental::{Basis, DEFAULT_MEMORY_BYTES, Expansion, smallest};
use denavit_codegen::model::equations;
use denavit_codegen::regressor::equations::equations_regressor;
use denavit_codegen::regressor::{RegressorOptions, decompose_robot};

/// The document of a robot's D qdd + G with friction, with theta.
fn robot_document(name: &str) -> String {
    let mut robot = load(name);
    robot.terms.coriolis = false;
    let options = RegressorOptions { friction: true, ..RegressorOptions::default() };
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let mut found = decompose_robot(&robot, options, &Basis::ALL, &mut expansion).unwrap();
    let least = smallest(std::mem::take(&mut found.decompositions)).expect("a basis");
    let theta = found.theta(&least, &[]).expect("small");
    robot_decomposition(&robot, &found, &least, Some(&theta)).expect("a template fits")
}

/// The rows of the matrix that is called `name`.
fn matrix(text: &str, name: &str) -> Vec<Vec<String>> {
    let start = format!("\\[ {name} = \\begin{{bmatrix}}");
    let (_, body) = text.split_once(&start).unwrap_or_else(|| panic!("no {name} in:\n{text}"));
    let (body, _) = body.split_once(r"\end{bmatrix}").expect("closed");
    let row = |row: &str| row.split('&').map(|entry| entry.trim().to_owned()).collect();
    body.split(r"\\").map(row).collect()
}

/// What the letters of the thesis stand for (A.79-A.93).
fn names(dag: &mut Dag) -> Names {
    let letters = [
        ("l_1", "l1"),
        ("g", "g"),
        ("N_1", "N1"),
        ("N_2", "N2"),
        ("m_1", "m1"),
        ("c_1", "c1"),
        ("I_1", "I1"),
        ("m_2", "m2"),
        ("c_2", "c2"),
        ("I_2", "I2"),
    ];
    let symbol = |dag: &mut Dag, name: &str| {
        let id = dag.find_symbol(name).expect(name);
        dag.symbol_expr(id)
    };
    letters.into_iter().map(|(latex, name)| (latex.to_owned(), symbol(dag, name))).collect()
}

#[test]
fn a_reader_finds_b_and_b_e_of_the_double_pendulum_in_the_document() {
    let path = repository().join("models/equations/double_pendulum_drives.json");
    let equations = equations::read("drives", &std::fs::read(path).unwrap()).unwrap();
    let mut expansion = Expansion { memory_bytes: DEFAULT_MEMORY_BYTES, progress: &mut |_| {} };
    let mut found = equations_regressor(&equations, Basis::Product, &mut expansion).unwrap();
    let keep = ["c2*m2", "c1*m1", "m2"];
    let theta = found.theta(&keep).expect("small");
    let text = equations_decomposition(&equations, &found, Some(&theta)).expect("a template fits");
    for part in [
        r"f_3 = \cos \theta_1 \cos \theta_2",
        r"\zeta_1 = \tau_{M,1}",
        r"\dot{\theta}_1",
        r"\operatorname{sgn}",
        "22 \\times 9$ with 19 entries",
        "rank 8",
    ] {
        assert!(text.contains(part), "{part} is not in:\n{text}");
    }
    let mut dag = found.dag.clone();
    let names = names(&mut dag);
    let same = |dag: &mut Dag, formula: &str, value: ExprId| {
        let read = match formula {
            r"\cdot" => dag.zero(),
            _ => read(dag, &names, formula),
        };
        let values = evaluate(dag, &[read, value], &mut Residues::new(7)).unwrap();
        assert_eq!(values[0], values[1], "{formula}");
    };
    for equation in 0..2 {
        let rows = matrix(&text, &format!("B_{{{}}}", equation + 1));
        assert_eq!(rows.len(), 11);
        for (function, row) in rows.iter().enumerate() {
            // N and 1 of the friction columns are there, too.
            assert_eq!(row.len(), 9);
            for (column, formula) in row.iter().enumerate() {
                let entries = &found.decomposition.columns[column];
                let entry = entries
                    .iter()
                    .find(|e| (e.equation, e.function) == (equation, function as u32));
                let coefficients = &found.decomposition.coefficients;
                let value = match entry {
                    Some(entry) => coefficients[entry.coefficient as usize].to_expr(&mut dag),
                    None => dag.zero(),
                };
                same(&mut dag, formula, value);
            }
        }
    }
    let rows = matrix(&text, "B_{Eu}");
    assert_eq!(rows.len(), 8);
    for (parameter, row) in rows.iter().enumerate() {
        let members = theta.members(&mut dag, parameter);
        for (column, formula) in row.iter().enumerate() {
            let member = members.iter().find(|(own, _)| *own == column);
            let value = member.map_or(dag.zero(), |(_, factor)| *factor);
            same(&mut dag, formula, value);
        }
    }
}

#[test]
fn every_document_is_sound() {
    for name in ["double_pendulum", "planar_2r", "scara", "tulip_leg", "planar_biped"] {
        let text = robot_document(name);
        assert_eq!(text, robot_document(name), "{name}");
        let mut depth = 0i32;
        let mut escaped = false;
        for character in text.chars() {
            let opens = i32::from(character == '{' && !escaped);
            depth += opens - i32::from(character == '}' && !escaped);
            assert!(depth >= 0, "{name}: a brace is closed that was not opened");
            escaped = character == '\\' && !escaped;
        }
        assert_eq!(depth, 0, "{name}");
        let count = |part: &str| text.matches(part).count();
        assert_eq!(count("\\begin{"), count("\\end{"), "{name}");
        assert!(!text.contains("{{"), "{name}: a place is left");
    }
}

/// Needs `pdflatex`; run with `--ignored`.
#[test]
#[ignore = "needs pdflatex"]
fn documents_of_f_and_b_compile() {
    let folder = std::env::temp_dir().join(format!("denavit-decomposed-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    for name in ["double_pendulum", "planar_2r", "scara", "tulip_leg", "planar_biped", "puma560"] {
        std::fs::write(folder.join("f.tex"), robot_document(name)).unwrap();
        let run = std::process::Command::new("pdflatex")
            .args(["-interaction=nonstopmode", "-halt-on-error", "f.tex"])
            .current_dir(&folder)
            .output()
            .expect("pdflatex runs");
        let log = String::from_utf8_lossy(&run.stdout);
        assert!(run.status.success(), "{name}:\n{log}");
        assert!(!log.contains("Overfull"), "{name}: a line is too long\n{log}");
    }
    std::fs::remove_dir_all(&folder).unwrap();
}
