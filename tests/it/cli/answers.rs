//! What the commands say of the shipped robots.

use super::{Directory, answer, json, run_in};
use denavit::expr::text::parse;
use denavit::expr::{Dag, Floats, SymbolClass, evaluate};
use denavit::shipped::MODELS;
use serde_json::Value;

/// Degrees of freedom and total mass [kg] from the models' sources: the thesis for TUlip (18, the
/// masses of its table 3.1), the makers' or authors' tables for the others.
const FACTS: [(&str, u64, f64); 6] = [
    ("tulip", 18, 25.29),
    ("tulip_one_torso", 18, 25.29 - 8.594),
    ("planar_biped", 9, 25.29),
    ("puma560", 6, 17.4 + 4.8 + 0.82 + 0.34 + 0.09),
    ("double_pendulum", 2, 3.5),
    ("tulip_leg6", 6, 0.614 + 0.614 + 2.141 + 0.315 + 0.001 + 0.366),
];

#[test]
fn inspect_states_freedom_and_mass() {
    for (model, freedom, mass) in FACTS {
        let robot = json(&["inspect", model, "--json"]);
        assert_eq!(robot["degrees_of_freedom"], freedom, "{model}");
        let total = robot["total_mass"].as_f64().expect("a mass");
        assert!((total - mass).abs() < 1e-12, "{model}: {total}");
    }
}

#[test]
fn inspect_draws_the_tree_of_tulip() {
    let text = answer(&["inspect", "tulip"]);
    let place = |name: &str| text.find(name).unwrap_or_else(|| panic!("no {name} in:\n{text}"));
    let chain = ["base_z", "base_x", "base_y", "base_yaw", "base_roll", "base_pitch"];
    for pair in chain.windows(2) {
        assert!(place(pair[0]) < place(pair[1]), "{pair:?}");
    }
    assert!(text.contains("├─ right_torso") && text.contains("└─ left_torso"), "{text}");
    assert!(text.contains("total mass: 25.29 kg"), "{text}");
    assert!(text.contains("degrees of freedom: 18 (6 of the base, 12 joints"), "{text}");
    assert!(text.contains("right_toe_inner") && text.contains("return 5 where q > -0.5"), "{text}");
}

#[test]
fn every_shipped_robot_is_inspected_drawn_and_counted() {
    for model in MODELS.iter().map(|model| model.name) {
        let directory = Directory::new("shipped");
        let run = run_in(&directory.path, &["inspect", model, "--svg", "robot.svg"]);
        assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""), "{model}");
        assert_eq!(directory.files(), ["robot.svg"], "{model}");
        let svg = std::fs::read_to_string(directory.path.join("robot.svg")).expect("the picture");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"), "{model}");
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{model}");
        let robot = json(&["inspect", model, "--json"]);
        for link in robot["links"].as_array().expect("links") {
            let name = link["name"].as_str().expect("a name");
            let is_drawn = svg.contains(&format!(">{name}<"));
            let is_inner = name.starts_with("base_") && name != "base_pitch";
            assert!(is_drawn != is_inner, "{model}: {name}");
        }
        let counts = json(&["count", model, "--functions", "mass_matrix,bias", "--json"]);
        assert_eq!(counts["functions"].as_object().map(serde_json::Map::len), Some(2), "{model}");
    }
}

#[test]
fn a_picture_is_the_same_every_time() {
    let draw = || answer(&["inspect", "tulip", "--svg", "-"]);
    assert_eq!(draw(), draw());
}

/// Best published and prototyped counts of PUMA 560's inverse dynamics: 252 multiplications, 224
/// additions.
#[test]
fn count_is_at_or_below_the_best_known_for_puma() {
    let arguments = ["count", "puma560", "--terms", "inertia,coriolis,gravity", "--json"];
    let counts = json(&arguments);
    assert_eq!((&counts["model"], &counts["flavour"]), (&"puma560".into(), &"tunable".into()));
    let row = &counts["functions"]["inverse_dynamics"];
    let number = |key: &str| row[key].as_u64().unwrap_or_else(|| panic!("no {key}: {row}"));
    assert!(number("mul") + number("add") <= 252 + 224, "{row}");
    assert!(number("sincos") <= 6 && number("div") == 0, "{row}");
    for key in ["neg", "sqrt", "select", "prelude"] {
        number(key);
    }
}

#[test]
fn baked_values_save_operations_and_terms_cost_some() {
    let total = |more: &[&str]| {
        let arguments = ["count", "tulip", "--functions", "inverse_dynamics", "--json"];
        let counts = json(&[&arguments[..], more].concat());
        let row = counts["functions"]["inverse_dynamics"].clone();
        row["mul"].as_u64().expect("a count") + row["add"].as_u64().expect("a count")
    };
    let (tunable, baked) = (total(&[]), total(&["--baked"]));
    let rigid = total(&["--terms", "inertia,coriolis,gravity"]);
    assert!(baked < tunable, "{baked} {tunable}");
    assert!(rigid < tunable, "{rigid} {tunable}");
}

#[test]
fn functions_that_a_robot_cannot_have_are_left_out() {
    let counts = json(&["count", "puma560", "--json"]);
    assert!(counts["functions"].get("contact_positions").is_none());
    assert!(json(&["count", "tulip", "--json"])["functions"].get("contact_positions").is_some());
}

/// What is asked for by name is there, or the answer says why it is not.
#[test]
fn functions_that_are_named_are_not_left_out() {
    let directory = Directory::new("named_functions");
    for command in ["count", "emit"] {
        let asked = ["--functions", "state_rates,mass_matrix,contact_positions"];
        let to = if command == "emit" { &["-o", "-"][..] } else { &[] };
        let run = run_in(&directory.path, &[&[command, "puma560"][..], &asked, to].concat());
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""));
        assert!(run.stderr.contains("puma560: the model has no state_rates, contact_positions"));
        assert!(
            run.stderr.contains("no effects with states; contacts are declared"),
            "{}",
            run.stderr
        );
    }
}

/// The value of an entry that `derive --json` printed, intermediates included.
struct Entries {
    dag: Dag,
    answer: Value,
}

impl Entries {
    fn of(method: &str) -> Self {
        let answer = json(&["derive", "double_pendulum", "--method", method, "--json"]);
        Self { dag: Dag::new(), answer }
    }

    fn value(&mut self, function: &str, entry: usize) -> f64 {
        let mut values: Vec<(String, f64)> =
            POINT.iter().map(|&(name, value)| (name.to_owned(), value)).collect();
        for binding in self.answer["intermediates"].as_array().expect("a list").clone() {
            let [name, text] =
                ["name", "expression"].map(|key| binding[key].as_str().expect("text").to_owned());
            let value = self.evaluate(&text, &values);
            values.push((name, value));
        }
        let text = self.answer["functions"][function]["entries"][entry].clone();
        self.evaluate(text.as_str().expect("an entry"), &values)
    }

    fn evaluate(&mut self, text: &str, values: &[(String, f64)]) -> f64 {
        let dag = &mut self.dag;
        let is_known = |name: &str| values.iter().any(|(known, _)| known == name);
        let expr = parse(dag, text, &mut |dag, name| {
            is_known(name).then(|| dag.symbol(name, SymbolClass::Geometry))
        })
        .expect(text);
        let value_of = |name: &str| values.iter().find(|(n, _)| n == name).map(|(_, v)| *v);
        evaluate(dag, &[expr], &mut Floats::new(value_of)).expect(text)[0]
    }
}

/// A point with values that have nothing to do with those of the file.
const POINT: [(&str, f64); 15] = [
    ("l1", 0.7),
    ("l2", 0.9),
    ("g", 9.5),
    ("m1", 1.3),
    ("c1", 0.2),
    ("I1", 0.11),
    ("m2", 0.8),
    ("c2", 0.45),
    ("I2", 0.07),
    ("q_link1", 0.6),
    ("q_link2", -1.1),
    ("qd_link1", 1.7),
    ("qd_link2", -0.4),
    ("qdd_link1", 0.3),
    ("qdd_link2", 2.0),
];

/// D, C and G of the double pendulum as textbooks have them (thesis A.17-A.19, its misprints
/// corrected), by every method.
#[test]
fn the_double_pendulum_is_that_of_the_textbooks_by_every_method() {
    let value = |name: &str| POINT.iter().find(|(n, _)| *n == name).expect("a symbol").1;
    let [l1, g, m1, c1, i1, m2, c2, i2] =
        ["l1", "g", "m1", "c1", "I1", "m2", "c2", "I2"].map(value);
    let [q1, q2, qd1, qd2] = ["q_link1", "q_link2", "qd_link1", "qd_link2"].map(value);
    let coupling = m2 * l1 * c2;
    let d22 = i2 + m2 * c2 * c2;
    let d12 = d22 + coupling * q2.cos();
    let d11 = i1 + m1 * c1 * c1 + m2 * l1 * l1 + d22 + 2.0 * coupling * q2.cos();
    let h = coupling * q2.sin();
    let g2 = m2 * g * c2 * (q1 + q2).cos();
    let g1 = (m1 * c1 + m2 * l1) * g * q1.cos() + g2;
    let expected: [(&str, &[f64]); 3] = [
        ("mass_matrix", &[d11, d12, d12, d22]),
        ("coriolis_matrix", &[-h * qd2, -h * (qd1 + qd2), h * qd1, 0.0]),
        ("gravity_vector", &[g1, g2]),
    ];
    for method in ["recursive", "dh-lagrange", "lagrange", "newton-euler", "tmt"] {
        let mut entries = Entries::of(method);
        for (function, values) in expected {
            for (index, &value) in values.iter().enumerate() {
                let found = entries.value(function, index);
                assert!((found - value).abs() < 1e-12, "{method} {function}[{index}]: {found}");
            }
        }
    }
}

#[test]
fn small_equations_are_printed_in_full_and_large_ones_in_summary() {
    let small = answer(&["derive", "double_pendulum"]);
    for entry in ["D[1,1] = ", "D[1,2] = D[2,1] = ", "C[2,1] = ", "G[2] = "] {
        assert!(small.contains(entry), "{entry}\n{small}");
    }
    // the same equations, whichever way they were derived
    let entries = |text: &str| {
        let lines = text.lines().filter(|line| line.contains(" = ") && !line.contains(':'));
        lines.filter(|line| !line.starts_with("tau_drive")).map(str::to_owned).collect::<Vec<_>>()
    };
    for method in ["dh-lagrange", "lagrange", "newton-euler", "tmt"] {
        let other = answer(&["derive", "double_pendulum", "--method", method]);
        assert_eq!(entries(&other), entries(&small), "{method}");
    }
    let large = answer(&["derive", "puma560"]);
    assert!(large.contains("mass_matrix") && !large.contains("D[1,1]"), "{large}");
}

#[test]
fn equations_are_set_as_a_document() {
    let directory = Directory::new("latex");
    let run = run_in(&directory.path, &["derive", "tulip", "--latex", "tulip.tex"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let text = std::fs::read_to_string(directory.path.join("tulip.tex")).expect("the document");
    assert!(text.contains(r"\documentclass") && text.trim_end().ends_with(r"\end{document}"));
    assert_eq!(answer(&["derive", "tulip", "--latex", "-"]), text);
    let pendulum = answer(&["derive", "double_pendulum", "--method", "lagrange", "--latex", "-"]);
    assert!(pendulum.contains("D =") && pendulum.contains("G ="), "{pendulum}");
}

#[test]
fn the_schema_is_that_of_the_model_format() {
    let schema = json(&["schema", "model"]);
    assert!(schema["$schema"].as_str().is_some_and(|uri| uri.contains("json-schema.org")));
    assert!(schema.to_string().contains("denavit-model/1"));
    assert_eq!(schema, json(&["schema", "denavit-model/1", "--json"]));
}

#[test]
fn emit_writes_a_module_with_the_functions_asked_for() {
    let directory = Directory::new("emit");
    let run = run_in(&directory.path, &["emit", "tulip", "-o", "tulip.rs"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let text = std::fs::read_to_string(directory.path.join("tulip.rs")).expect("the module");
    for function in ["inverse_dynamics", "contact_jacobian", "link_jacobian"] {
        assert!(text.contains(&format!("pub fn {function}<")), "{function}");
    }
    assert_eq!(answer(&["emit", "tulip", "-o", "-"]), text);

    let some = answer(&["emit", "tulip", "--functions", "bias,mass_matrix", "--baked", "-o", "-"]);
    assert!(some.contains("pub fn bias<") && some.contains("pub fn mass_matrix<"));
    assert!(!some.contains("pub fn inverse_dynamics<") && !some.contains("ModelParameters"));
}

/// The answer names what was hidden, which stands in the file of the robot that was simulated.
fn assert_diagnosed(directory: &Directory, diagnosed: &Value) {
    let truth = directory.path.join("here/blind_truth.json");
    let truth = std::fs::read_to_string(truth).expect("the robot that was simulated");
    let truth: Value = serde_json::from_str(&truth).expect("JSON");
    let (hidden, answer) = (&truth["effects"][0], &diagnosed["answer"]);
    assert_eq!(answer.as_array().map(Vec::len), Some(1), "{answer}");
    assert_eq!(answer[0]["effect"], hidden["effect"], "{answer}");
    assert_eq!(answer[0]["at"], hidden["at"]["link"], "{answer}");
    assert_eq!(diagnosed["outcome"], "right");
    for (name, value) in hidden["parameters"].as_object().expect("parameters") {
        let found = answer[0]["parameters"][name].as_f64().expect("a number");
        let value = value.as_f64().expect("a number");
        assert!((found - value).abs() < 0.1 * value.abs(), "{name}: {found} {value}");
    }
    assert!(directory.path.join("here/blind/report.html").is_file());
}

#[test]
fn the_demo_writes_its_files_and_passes_its_checks() {
    let directory = Directory::new("demo");
    let run = run_in(&directory.path, &["demo", "--seed", "5", "--out", "here", "--json"]);
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let demo: Value = serde_json::from_str(&run.stdout).expect("JSON");
    assert_eq!((&demo["seed"], &demo["passed"]), (&5.into(), &true.into()));
    let robots = demo["robots"].as_array().expect("robots");
    let names: Vec<_> = robots.iter().map(|robot| robot["model"].as_str()).collect();
    assert_eq!(names, [Some("tulip"), Some("puma560")]);
    for robot in robots {
        let checks = robot["checks"].as_array().expect("checks");
        for method in ["newton-euler", "lagrange", "tmt", "dh-lagrange", "forward_dynamics"] {
            let is_of = |check: &&Value| check["what"].as_str().is_some_and(|w| w.contains(method));
            let check = checks.iter().find(is_of).unwrap_or_else(|| panic!("no {method}"));
            assert!(check["states"].as_u64().expect("a number") >= 20, "{check}");
            // rounding leaves its mark on a comparison that compares something
            assert!(check["max_relative_difference"].as_f64().expect("a number") > 0.0, "{check}");
        }
        let files = robot["files"].as_array().expect("files");
        for ending in
            ["_dynamics.rs", "_equations.tex", "_base_parameters.tex", "_certificate.json", ".svg"]
        {
            let has_ending =
                |file: &Value| file["file"].as_str().is_some_and(|f| f.ends_with(ending));
            assert!(files.iter().any(has_ending), "{ending}");
        }
        for file in files {
            let path = directory.path.join(file["file"].as_str().expect("a path"));
            let size = std::fs::metadata(&path).expect("a file").len();
            assert_eq!(file["bytes"], size, "{path:?}");
        }
    }
    // A.86 and A.93 of the thesis: eleven functions, eight base parameters
    let decomposed = &demo["decomposed"];
    assert_eq!((&decomposed["functions"], &decomposed["rank"]), (&11.into(), &8.into()));
    let path = directory.path.join(decomposed["file"]["file"].as_str().expect("a path"));
    let text = std::fs::read_to_string(path).expect("the document");
    assert!(text.contains(r"\section{Decomposition}"), "{text}");
    for run in demo["simulated"].as_array().expect("runs") {
        assert_eq!((&run["stop"], &run["broken"]), (&"end".into(), &Value::Array(Vec::new())));
        for file in run["files"].as_array().expect("files") {
            let path = directory.path.join(file["file"].as_str().expect("a path"));
            assert_eq!(file["bytes"], std::fs::metadata(&path).expect("a file").len(), "{path:?}");
        }
    }
    assert_diagnosed(&directory, &demo["diagnosed"]);
    let another = run_in(&directory.path, &["demo", "--out", "here"]);
    assert_eq!(another.code, Some(0));
    // that seed hides another effect, which is told too
    assert!(another.stdout.contains("right: effect and joint"), "{}", another.stdout);
    assert!(another.stdout.contains("seed 1") && another.stdout.contains("all checks passed"));
}
