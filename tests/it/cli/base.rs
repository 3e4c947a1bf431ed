//! `denavit base` and `denavit verify`.

use super::{Directory, answer, json, run_in};
use serde_json::Value;

fn text(value: &Value) -> &str {
    value.as_str().expect("text")
}

/// Ixx, Iyy, Izz of a link about the origin of its frame, its mass and its first moment, from the
/// model's file by Steiner's law.
fn about_origin(link: &Value) -> [f64; 7] {
    let number = |value: &Value| value.as_f64().unwrap_or(0.0);
    let body = &link["body"];
    assert_eq!(body["about"], "com");
    let mass = number(&body["mass"]);
    let [x, y, z] = [0, 1, 2].map(|k| number(&body["com"][k]));
    let [xx, yy, zz] = ["xx", "yy", "zz"].map(|key| number(&body["inertia"][key]));
    [
        xx + mass * (y * y + z * z),
        yy + mass * (x * x + z * z),
        zz + mass * (x * x + y * y),
        mass,
        mass * x,
        mass * y,
        mass * z,
    ]
}

/// The closed forms of Khalil and Dombre, in numbers.
#[test]
fn values_are_those_of_the_closed_forms() {
    let file = std::fs::read_to_string("models/rx90.json").expect("the model");
    let file: Value = serde_json::from_str(&file).expect("JSON");
    let links: Vec<[f64; 7]> =
        file["links"].as_array().expect("links").iter().map(about_origin).collect();
    let [d3, rl4] = ["D3", "RL4"].map(|name| file["constants"][name]["value"].as_f64().unwrap());
    let mass = |from: usize| links[from - 1..].iter().map(|link| link[3]).sum::<f64>();
    let [xx, yy, zz, mx, mz] = [0, 1, 2, 4, 6];
    let of = |link: usize, entry: usize| links[link - 1][entry];
    let expected = [
        ("Izz_j1", of(1, zz) + of(2, yy) + of(3, yy) + d3 * d3 * mass(3)),
        ("Ixx_j2", of(2, xx) - of(2, yy) - d3 * d3 * mass(3)),
        ("mx_j2", of(2, mx) + d3 * mass(3)),
        ("Izz_j3", of(3, zz) + of(4, yy) + 2.0 * rl4 * of(4, mz) + rl4 * rl4 * mass(4)),
        ("Ixx_j6", of(6, xx) - of(6, yy)),
    ];
    let keep = "Ixx,Ixy,Ixz,Iyz,Izz,mx,my";
    let found = json(&["base", "rx90", "--keep", keep, "--json"]);
    assert_eq!((&found["rank"], &found["model"]), (&36.into(), &"rx90".into()));
    let parameters = found["parameters"].as_array().expect("parameters");
    for (name, value) in expected {
        let parameter = parameters.iter().find(|one| one["name"] == name).expect(name);
        let ours = parameter["value"].as_f64().expect("a value");
        assert!(
            (ours - value).abs() <= 1e-12 * value.abs().max(1.0),
            "{name}: {ours}, not {value}"
        );
    }
    let grouped = parameters.iter().find(|one| one["name"] == "Ixx_j2").expect("Ixx_j2");
    assert_eq!(text(&grouped["expression"]), "Ixx_j2 - Iyy_j2 - D3^2*(m_j3 + m_j4 + m_j5 + m_j6)");
    assert_eq!(text(&grouped["latex"]), r"I_{xx,2} - I_{yy,2} - D_3^2\,(m_3 + m_4 + m_5 + m_6)");
    assert_eq!((text(&grouped["unit"]), text(&grouped["members"]["m_j5"])), ("kg m^2", "-D3^2"));
}

/// A.93 of the thesis, its sign corrected, where m2 and m1 c1 are wanted last.
#[test]
fn the_pendulum_of_the_thesis_is_grouped_as_in_its_appendix() {
    let found = json(&["base", "double_pendulum", "--keep", "c2*m2,c1*m1,m2", "--json"]);
    let parameters = found["parameters"].as_array().expect("parameters");
    let of = |name: &str| parameters.iter().find(|one| one["name"] == name).expect(name);
    assert_eq!(text(&of("c1*m1")["expression"]), "c1*m1 - (m1*c1^2 + I1)/l1");
    assert_eq!(text(&of("m2")["expression"]), "m2 + (m1*c1^2 + I1)/l1^2");
    assert_eq!(found["alone"], serde_json::json!(["c2*m2"]));
    assert_eq!(found["zero"], serde_json::json!(["m1"]));
    assert_eq!(found["certificate"]["verified"], true);
}

#[test]
fn base_writes_documents() {
    let directory = Directory::new("base");
    let files = ["--latex", "base.tex", "--markdown", "base.md"];
    let run =
        run_in(&directory.path, &[&["base", "tulip", "--with", "modelled"][..], &files].concat());
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let read = |name: &str| std::fs::read_to_string(directory.path.join(name)).expect(name);
    let (latex, markdown) = (read("base.tex"), read("base.md"));
    let found = json(&["base", "tulip", "--with", "modelled", "--json"]);
    let rank = found["rank"].as_u64().expect("a number") as usize;
    let rows = markdown.lines().filter(|line| line.starts_with("| ") && line.contains(" | `"));
    assert_eq!(rows.count(), rank);
    assert!(latex.starts_with('%') && latex.ends_with("\\end{document}\n"));
    for parameter in found["parameters"].as_array().expect("parameters") {
        assert!(latex.contains(text(&parameter["latex"])), "{parameter}");
        assert!(markdown.contains(text(&parameter["expression"])), "{parameter}");
    }
    assert_eq!(answer(&["base", "tulip", "--with", "modelled", "--markdown", "-"]), markdown);
}

/// phi = T pi in numbers, and the moments of PUMA's arm are those of a body.
#[test]
fn base_lists_parameters_on_the_joint_axes() {
    let listed = json(&["base", "puma560", "--json"]);
    let found = json(&["base", "puma560", "--basis", "joints", "--json"]);
    assert_eq!((&listed["basis"], &found["basis"]), (&"kept".into(), &"joints".into()));
    assert_eq!((&found["rank"], &found["columns"]), (&listed["rank"], &listed["columns"]));
    let file = std::fs::read_to_string("models/puma560.json").expect("the model");
    let constants: Value = serde_json::from_str(&file).expect("JSON");
    let constant = |name: &str| constants["constants"][name]["value"].as_f64().expect("a value");
    // Factors of this robot are products of numbers, lengths and their squares.
    let factor = |text: &str| -> f64 {
        let (sign, text) = text.strip_prefix('-').map_or((1.0, text), |rest| (-1.0, rest));
        text.split('*').fold(sign, |product, factor| {
            let (base, power) = factor.split_once('^').unwrap_or((factor, "1"));
            let (over, under) = base.split_once('/').unwrap_or((base, "1"));
            let number = |text: &str| text.parse().unwrap_or_else(|_| constant(text));
            product * (number(over) / number(under)).powi(power.parse().expect("a power"))
        })
    };
    let list = |of: &Value| of["parameters"].as_array().expect("parameters").clone();
    let value = |one: &Value| one["value"].as_f64().expect("a value");
    let kept = list(&listed);
    let mut moments = 0;
    for parameter in list(&found) {
        let row = parameter["of_kept"].as_object().expect("a row");
        let terms: Vec<f64> = row
            .iter()
            .map(|(name, coefficient)| {
                let own = kept.iter().find(|one| one["name"] == **name).expect(name);
                factor(text(coefficient)) * value(own)
            })
            .collect();
        let size = terms.iter().map(|term| term.abs()).fold(1.0, f64::max);
        let (sum, own) = (terms.iter().sum::<f64>(), value(&parameter));
        assert!((sum - own).abs() <= 1e-12 * size, "{}: {sum}, not {own}", parameter["name"]);
        let name = text(&parameter["name"]);
        if name.starts_with("Kxx_") || name.starts_with("Kyy_") || name.starts_with("Jzz_") {
            moments += 1;
            assert!((0.0..5.0).contains(&own), "{name}: {own}");
        }
    }
    assert_eq!(moments, 11);
}

#[test]
fn the_change_of_basis_is_written_in_documents() {
    let directory = Directory::new("joints");
    let files = ["--latex", "joints.tex", "--markdown", "joints.md"];
    let run =
        run_in(&directory.path, &[&["base", "scara", "--basis", "joints"][..], &files].concat());
    assert_eq!((run.code, run.stderr.as_str()), (Some(0), ""));
    let read = |name: &str| std::fs::read_to_string(directory.path.join(name)).expect(name);
    let (latex, markdown) = (read("joints.tex"), read("joints.md"));
    let found = json(&["base", "scara", "--basis", "joints", "--json"]);
    for parameter in found["parameters"].as_array().expect("parameters") {
        assert!(latex.contains(text(&parameter["latex"])), "{parameter}");
        assert!(markdown.contains(text(&parameter["expression"])), "{parameter}");
        assert!(markdown.contains(&format!("- `{} = ", text(&parameter["name"]))), "{parameter}");
    }
    assert!(latex.contains("J_{zz,1}"));
    let equations =
        run_in(&directory.path, &["base", "double_pendulum_drives", "--basis", "joints"]);
    assert_eq!(equations.code, Some(2), "{}", equations.stderr);
}

#[test]
fn certificates_are_verified_and_tampered_ones_refused() {
    let directory = Directory::new("verify");
    let run = run_in(&directory.path, &["base", "puma560", "--certificate", "good.json"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let verify = |file: &str, model: &str| run_in(&directory.path, &["verify", file, model]);
    let good = verify("good.json", "puma560");
    assert_eq!(
        (good.code, good.stdout.as_str()),
        (
            Some(0),
            "puma560: verified: 36 base parameters (each relation by joint and in every torque)\n"
        )
    );
    assert_eq!(verify("good.json", "rx90").code, Some(1));
    let certificate = std::fs::read_to_string(directory.path.join("good.json")).expect("a file");
    for (from, to) in
        [("1/a2", "2/a2"), ("\"joint\": 1", "\"joint\": 0"), ("Ixz_elbow", "Ixz_shoulder")]
    {
        assert!(certificate.contains(from), "{from}");
        let changed = certificate.replacen(from, to, 1);
        std::fs::write(directory.path.join("changed.json"), changed).expect("a file");
        let run = verify("changed.json", "puma560");
        assert_eq!((run.code, run.stderr.as_str()), (Some(1), ""), "{from}: {}", run.stdout);
    }
    std::fs::write(directory.path.join("broken.json"), "{}").expect("a file");
    let broken = verify("broken.json", "puma560");
    assert_eq!(broken.code, Some(2));
    assert!(broken.stderr.contains("broken.json"), "{}", broken.stderr);
}

#[test]
fn the_schema_of_certificates_is_printed() {
    let schema: Value = json(&["schema", "certificate"]);
    assert_eq!(schema["title"], "denavit-certificate/1");
}

#[test]
fn what_cannot_be_kept_is_said() {
    let directory = Directory::new("keep");
    let run = run_in(&directory.path, &["base", "puma560", "--keep", "Ixx_knee"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("Ixx_knee") && run.stderr.contains("hint"), "{}", run.stderr);
}

#[test]
fn lengths_can_be_numbers() {
    let directory = Directory::new("numeric");
    let arguments = ["base", "puma560", "--numeric", "--json", "--certificate", "numbers.json"];
    let run = run_in(&directory.path, &arguments);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let numbers: Value = serde_json::from_str(&run.stdout).expect("JSON");
    let symbols = json(&["base", "puma560", "--json"]);
    assert_eq!(numbers["rank"], symbols["rank"]);
    assert!(!run.stdout.contains("a2"), "{}", run.stdout);
    let values = |found: &Value| -> Vec<f64> {
        let list = found["parameters"].as_array().expect("a list");
        list.iter().map(|one| one["value"].as_f64().expect("a number")).collect()
    };
    for (number, symbol) in values(&numbers).into_iter().zip(values(&symbols)) {
        assert!((number - symbol).abs() <= 1e-12 * symbol.abs().max(1.0), "{number} {symbol}");
    }
    let verdict: Value = {
        let run = run_in(&directory.path, &["verify", "numbers.json", "puma560", "--json"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        serde_json::from_str(&run.stdout).expect("JSON")
    };
    assert_eq!(verdict["verified"], true);
    assert_eq!(verdict["rank"], 36);
}

#[test]
fn standard_output_holds_one_document() {
    let directory = Directory::new("documents");
    for arguments in [
        ["base", "planar_2r", "--certificate", "-", "--json"].as_slice(),
        &["base", "planar_2r", "--latex", "-", "--markdown", "-"],
    ] {
        let run = run_in(&directory.path, arguments);
        assert_eq!((run.code, run.stdout.as_str()), (Some(2), ""));
        assert!(run.stderr.contains("two documents") && run.stderr.contains("hint"));
    }
}

#[test]
fn base_parameters_of_equations_are_documents_too() {
    let markdown = answer(&["base", "double_pendulum_drives", "--markdown", "-"]);
    let found = json(&["base", "double_pendulum_drives", "--json"]);
    for parameter in found["parameters"].as_array().expect("a list") {
        assert!(markdown.contains(text(&parameter["expression"])), "{parameter}");
    }
    let latex = answer(&["base", "double_pendulum_drives", "--latex", "-"]);
    assert!(latex.contains("Base parameters") && latex.contains("\\end{document}"));
}

#[test]
fn terms_in_which_no_body_acts_are_refused() {
    let directory = Directory::new("terms");
    let run = run_in(&directory.path, &["base", "puma560", "--terms", "friction"]);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("inertia or gravity") && run.stderr.contains("--with friction"));
}

/// A planar arm whose second link begins at `a`, and turns about an axis at `alpha`.
fn arm(a: &str, alpha: &str, com: &str) -> String {
    format!(
        "{{\"format\": \"denavit-model/1\", \"name\": \"arm\", \"convention\": \"standard\", \
         \"gravity\": [0, -9.81, 0], \"constants\": {{\"l\": {{\"value\": 0.5, \"unit\": \"m\"}}}}, \
         \"links\": [{{\"name\": \"one\", \"joint\": {{\"type\": \"revolute\", \"a\": 0.4}}, \
         \"body\": {{\"mass\": 1, \"com\": [0, 0, 0], \"inertia\": {{\"zz\": 0.1}}, \
         \"about\": \"com\"}}}}, {{\"name\": \"two\", \"joint\": {{\"type\": \"revolute\", \
         \"a\": {a}, \"alpha\": {alpha}}}, \"body\": {{\"mass\": 1, \"com\": [{com}, 0, 0], \
         \"inertia\": {{\"zz\": 0.1}}, \"about\": \"com\"}}}}]}}"
    )
}

#[test]
fn a_length_without_an_exact_form_is_told_with_its_place_and_a_way_out() {
    let directory = Directory::new("inexact");
    let file = directory.path.join("arm.json");
    std::fs::write(&file, arm("\"1/(1+l)\"", "0", "0.1")).expect("a file");
    let run = run_in(&directory.path, &["base", "arm.json"]);
    assert_eq!(run.code, Some(2), "{}", run.stderr);
    for part in ["arm.json: ", "/links/1/joint/a", "`two`", "--numeric"] {
        assert!(run.stderr.contains(part), "{part}: {}", run.stderr);
    }
    let run = run_in(&directory.path, &["base", "arm.json", "--numeric"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

#[test]
fn degrees_and_millimetres_are_remarked_on_and_answered() {
    let directory = Directory::new("remarks");
    let file = directory.path.join("arm.json");
    for (text, said) in [
        (arm("0.3", "90", "0.1"), "/links/1/joint/alpha"),
        (arm("0.3", "0", "120"), "/links/1/body/com"),
    ] {
        std::fs::write(&file, text).expect("a file");
        for command in ["base", "inspect", "count"] {
            let run = run_in(&directory.path, &[command, "arm.json"]);
            assert_eq!(run.code, Some(0), "{}", run.stderr);
            assert!(run.stderr.starts_with("remark: arm.json:1:"), "{}", run.stderr);
            assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
        }
    }
}

/// Certificates with and without joint parameters say what they are about.
#[test]
fn a_verdict_says_what_its_certificate_is_about() {
    let directory = Directory::new("about");
    for (with, about) in [("", "about: bodies\n"), ("friction", "about: bodies, friction\n")] {
        let mut words = vec!["base", "scara", "--certificate", "c.json"];
        words.extend(if with.is_empty() { vec![] } else { vec!["--with", with] });
        assert_eq!(run_in(&directory.path, &words).code, Some(0));
        let run = run_in(&directory.path, &["verify", "c.json", "scara"]);
        assert_eq!(run.code, Some(0), "{}", run.stderr);
        assert!(run.stdout.ends_with(about), "{}", run.stdout);
    }
}
