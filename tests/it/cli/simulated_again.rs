//! `denavit identify` moves what it found against the logs.

use super::{Directory, Run, run_in};
use denavit::shipped;
use serde_json::{Value, json};

/// The experiment of a shipped scenario: its log, and its control as a file.
fn experiment(directory: &Directory, scenario: &str) {
    let shipped = shipped::find_scenario(scenario).expect("shipped");
    let mut control = serde_json::from_str::<Value>(shipped.text).expect("JSON")["control"].take();
    control["format"] = "denavit-controller/1".into();
    write(directory, "pd.json", &control);
    let run = run_in(&directory.path, &["simulate", scenario, "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

fn write(directory: &Directory, name: &str, value: &Value) {
    std::fs::write(directory.path.join(name), value.to_string()).expect("written");
}

fn identified(directory: &Directory, model: &str, more: &[&str]) -> (Run, Value) {
    let words = [&["identify", model, "--train", "log.csv", "--json"][..], more].concat();
    let run = run_in(&directory.path, &words);
    // the log of the estimate judges nothing
    let expected = if more.contains(&"--validate") { 1 } else { 0 };
    assert_eq!(run.code, Some(expected), "{more:?}: {}", run.stderr);
    let found = serde_json::from_str(&run.stdout).expect("JSON");
    (run, found)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// A model whose shin is too heavy is put right, under the controller and in windows.
#[test]
fn the_gap_of_a_wrong_model_closes() {
    let directory = Directory::new("simulated-again");
    experiment(&directory, "tulip_leg_identification");
    let shipped = shipped::find("tulip_leg_table34").expect("shipped");
    let mut wrong: Value = serde_json::from_str(shipped.text).expect("JSON");
    wrong["unknowns"]["I5z"]["value"] = 0.9.into();
    wrong["unknowns"]["I4z"]["value"] = 0.5.into();
    write(&directory, "wrong.json", &wrong);
    let common = ["--filter", "10"];
    for (more, kind) in [
        (&["--controller", "pd.json"][..], "closed_loop"),
        (&["--validate", "log.csv", "--window", "0.1"], "windows"),
    ] {
        let files = ["--html", "page.html", "--motion-svg", "motion.svg"];
        let words = [&common[..], more, &files].concat();
        let (_, found) = identified(&directory, "wrong.json", &words);
        let simulation = &found["simulation"];
        assert_eq!(simulation["kind"], kind);
        assert_eq!(simulation["window_s"] == 0.1, kind == "windows", "{simulation}");
        let [before, after] = ["before", "after"].map(|key| number(&simulation[key]));
        assert!(after < 0.05 * before, "{kind} {before} {after}");
        assert!(after < 0.002, "{kind} {after}");
        let joints = simulation["per_joint"].as_array().expect("a list");
        assert_eq!(joints.len(), 5);
        for joint in joints {
            assert!(number(&joint["rate"]["after"]) < 0.01, "{joint}");
            assert_eq!(joint["torque"].is_object(), kind == "closed_loop", "{joint}");
        }
        let read = |name: &str| std::fs::read_to_string(directory.path.join(name)).expect(name);
        assert!(read("page.html").contains("<h2>Simulation</h2>"), "{kind}");
        assert!(read("motion.svg").contains("simulated again"), "{kind}");
    }
    let words = ["identify", "wrong.json", "--train", "log.csv", "--filter", "10"];
    let more = ["--controller", "pd.json"];
    let run = run_in(&directory.path, &[&words[..], &more].concat());
    assert!(run.stdout.contains("under the controller"), "{}", run.stdout);
    // without either there is nothing to draw
    let run = run_in(&directory.path, &[&words[..], &["--motion-svg", "motion.svg"]].concat());
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("--controller"), "{}", run.stderr);
}

/// Instruments that the command simulates itself remove what noise of the positions does: the
/// encoder's steps, which a wide filter lets through, are differentiated twice.
#[test]
fn instruments_are_simulated_with_a_controller() {
    let directory = Directory::new("own-instruments");
    experiment(&directory, "tulip_leg_identification");
    let wide = ["--filter", "60"];
    let worst = |found: &Value| {
        let parameters = found["parameters"].as_array().expect("a list");
        let inertia = parameters.iter().filter(|one| {
            let name = one["name"].as_str().expect("a name");
            ["I2y", "I6y", "I4z", "I5z", "I3y"].contains(&name)
        });
        let off =
            inertia.map(|one| (number(&one["value"]) / number(&one["model_value"]) - 1.0).abs());
        off.fold(0.0, f64::max)
    };
    let (_, plain) = identified(&directory, "tulip_leg_table34", &wide);
    let own = [&wide[..], &["--method", "iv", "--controller", "pd.json"]].concat();
    let (_, own) = identified(&directory, "tulip_leg_table34", &own);
    let [plain, own] = [&plain, &own].map(worst);
    println!("worst moment of inertia: {plain} by least squares, {own} with instruments");
    assert!(own < 0.3 * plain && own < 0.05, "{plain} {own}");

    let words = ["identify", "tulip_leg_table34", "--train", "log.csv", "--method", "iv"];
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(2));
    assert!(run.stderr.contains("--instruments"), "{}", run.stderr);
}

#[test]
fn a_controller_that_follows_nothing_is_refused() {
    let directory = Directory::new("follows-nothing");
    experiment(&directory, "tulip_leg_identification");
    let pd = json!({"format": "denavit-controller/1", "joints": {"knee": {"kp": 1, "kd": 1}}});
    write(&directory, "pd.json", &pd);
    let log = std::fs::read_to_string(directory.path.join("log.csv")).expect("a log");
    std::fs::write(directory.path.join("log.csv"), log.replace("ref_", "wish_")).expect("written");
    let words = ["identify", "tulip_leg_table34", "--train", "log.csv", "--filter", "10"];
    let run = run_in(&directory.path, &[&words[..], &["--controller", "pd.json"]].concat());
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("`ref_knee`"), "{}", run.stderr);
}
