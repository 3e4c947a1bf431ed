//! Diagnoses of logs of real robots, where they are: the path of the folder is in
//! `DENAVIT_REAL_DATA`. docs/evidence/real-data.md has what is known of each, and every answer.

use super::{Directory, Run, run_in};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Instant;

const COULOMB: [&str; 4] =
    ["coulomb", "smoothed_coulomb", "arctangent_coulomb", "asymmetric_coulomb"];
const LATE: [&str; 3] = ["torque_lag", "torque_delay", "position_delay"];
/// Names with a cycle of the position in them.
const PERIODIC: [&str; 4] =
    ["cogging", "torque_ripple", "transmission_error", "encoder_eccentricity"];

/// Of a log: what is searched or judges.
#[derive(Clone, Copy)]
enum Part {
    Whole,
    /// The first 60 %.
    First,
    /// The last 40 %.
    Rest,
}

/// One data set with its model, and a directory for parts of its logs.
struct Set {
    model: PathBuf,
    columns: PathBuf,
    logs: PathBuf,
    directory: Directory,
}

impl Set {
    fn new(name: &str, model: &str, columns: &str, folder: &str) -> Self {
        let Some(data) = std::env::var_os("DENAVIT_REAL_DATA") else {
            panic!("DENAVIT_REAL_DATA is not set: the folder that has {folder}/")
        };
        let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/real");
        let (model, columns) = (fixtures.join(model), fixtures.join(columns));
        let logs = Path::new(&data).join(folder);
        assert!(logs.is_dir(), "{} is no folder: DENAVIT_REAL_DATA has none", logs.display());
        Self { model, columns, logs, directory: Directory::new(name) }
    }

    fn pendulum(name: &str) -> Self {
        let columns = "simple_pendulum_columns.json";
        Self::new(name, "simple_pendulum.json", columns, "dfki_simple_pendulum")
    }

    fn part(&self, name: &str, part: Part) -> String {
        let path = self.logs.join(name);
        let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path:?}: {error}"));
        let rows: Vec<&str> = text.lines().collect();
        let (head, rows) = rows.split_first().expect("a header");
        let cut = rows.len() * 6 / 10;
        let (label, rows) = match part {
            Part::Whole => ("whole", rows),
            Part::First => ("first", &rows[..cut]),
            Part::Rest => ("rest", &rows[cut..]),
        };
        let written = self.directory.path.join(format!("{label}_{name}"));
        fs::write(&written, format!("{head}\n{}\n", rows.join("\n"))).expect("a part");
        written.to_str().expect("UTF-8").to_owned()
    }

    /// Searches some logs, judges by others.
    fn diagnose(&self, train: &[String], held_out: &[String], more: &[&str]) -> Said {
        let [model, columns] =
            [&self.model, &self.columns].map(|path| path.to_str().expect("UTF-8"));
        let mut words = vec!["diagnose", model, "--json", "--columns", columns];
        words.extend(more);
        words.push("--train");
        words.extend(train.iter().map(String::as_str));
        words.push("--validate");
        words.extend(held_out.iter().map(String::as_str));
        let said = Said::new(run_in(&self.directory.path, &words));
        println!("{said}");
        said
    }

    /// Searches the first 60 % of logs, judges by the rest of them.
    fn halves(&self, logs: &[&str], more: &[&str]) -> Said {
        let [train, held_out] = [Part::First, Part::Rest]
            .map(|part| logs.iter().map(|log| self.part(log, part)).collect::<Vec<_>>());
        self.diagnose(&train, &held_out, more)
    }
}

/// What the command said.
struct Said {
    /// None if the logs were refused.
    answer: Option<Value>,
    message: String,
    effects: Vec<Effect>,
}

/// An effect with a name.
struct Effect {
    name: String,
    at: String,
    /// Its own name and those that the logs do not tell from it, with their places.
    family: Vec<[String; 2]>,
}

impl Said {
    fn new(run: Run) -> Self {
        let answer: Option<Value> = serde_json::from_str(&run.stdout).ok();
        let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let effect = |one: &Value| {
            let others = one["indistinguishable"].as_array().into_iter().flatten();
            let both = |one: &Value| [text(&one["effect"]), text(&one["at"])];
            let [name, at] = both(one);
            Effect { name, at, family: [one].into_iter().chain(others).map(both).collect() }
        };
        let all = answer.iter().flat_map(|answer| answer["effects"].as_array()).flatten();
        let effects = all.map(effect).filter(|effect| effect.name != "unnamed").collect();
        Self { answer, message: run.stderr, effects }
    }

    fn answered(&self) -> &Value {
        self.answer.as_ref().unwrap_or_else(|| panic!("no answer: {}", self.message))
    }

    fn verdict(&self) -> &str {
        self.answered()["verdict"].as_str().expect("a verdict")
    }

    fn held_out(&self) -> f64 {
        self.answered()["gap"]["validate"]["after"].as_f64().expect("a gap")
    }

    /// Which effects are one of these at a place, alone or as one of few.
    fn these(&self, at: &str, names: &[&str]) -> Vec<usize> {
        let is_one = |(_, effect): &(usize, &Effect)| {
            let known = |[name, place]: &[String; 2]| place == at && names.contains(&name.as_str());
            effect.family.len() <= 3 && effect.family.iter().any(known)
        };
        self.effects.iter().enumerate().filter(is_one).map(|(index, _)| index).collect()
    }

    fn names(&self, at: &str, names: &[&str]) -> bool {
        !self.these(at, names).is_empty()
    }

    /// Effects that are not among what may be named.
    fn others(&self, may: impl Fn(&Effect) -> bool) -> Vec<String> {
        let others = self.effects.iter().filter(|effect| !may(effect));
        others.map(|effect| format!("{} at {}", effect.name, effect.at)).collect()
    }
}

impl std::fmt::Display for Said {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Some(answer) = &self.answer else { return write!(f, "refused: {}", self.message) };
        write!(f, "{}, held-out gap {}:", answer["verdict"], answer["gap"]["validate"])?;
        for effect in &self.effects {
            let names: Vec<&str> = effect.family.iter().map(|[name, _]| name.as_str()).collect();
            write!(f, " {} at {},", names.join(" or "), effect.at)?;
        }
        write!(f, " {}", answer["reasons"])
    }
}

#[test]
#[ignore = "needs the measurements, which are not part of the repository"]
fn a_real_axis_has_friction_that_differs_by_its_direction() {
    let rigid = "emps_rigid.json";
    for (name, model) in [("real_emps", "../../../models/emps.json"), ("real_emps_rigid", rigid)] {
        let set = Set::new(name, model, "emps_columns.json", "emps");
        let [train, held_out] =
            ["emps_ident.csv", "emps_pulses.csv"].map(|log| vec![set.part(log, Part::Whole)]);
        let said = set.diagnose(&train, &held_out, &[]);
        assert!(said.held_out() <= 0.032, "{model}: {}", said.held_out());
        assert!(said.names("carriage", &["asymmetric_viscous"]), "{model}: {said}");
        let periodic = |effect: &Effect| PERIODIC.contains(&effect.name.as_str());
        assert!(!said.effects.iter().any(periodic), "{model}: {said}");
    }
}

#[test]
#[ignore = "needs the measurements, which are not part of the repository"]
fn a_real_pendulum_has_coulomb_friction() {
    let said = Set::pendulum("real_pendulum").halves(&["ddp.csv", "dircol.csv"], &[]);
    assert!(said.names("rod", &COULOMB), "{said}");
    let may = |effect: &Effect| {
        let is = |names: &[&str]| names.contains(&effect.name.as_str());
        is(&COULOMB) || is(&LATE)
    };
    assert_eq!(said.others(may), Vec::<String>::new(), "{said}");
}

#[test]
#[ignore = "needs the measurements, which are not part of the repository"]
fn logs_that_show_nothing_of_a_real_pendulum_are_refused() {
    let set = Set::pendulum("real_pendulum_refused");
    // errors in variables twice, a hand that no channel records, a hold
    let logs = ["sac", "energy_shaping", "gravity_comp_handmoved_200hz", "pd_1nm"];
    let mut wrong = Vec::new();
    for log in logs {
        let said = set.halves(&[&format!("{log}.csv")], &[]);
        // that nothing moves may be reported before anything is computed
        let is_told = log == "pd_1nm" && said.message.contains("no joint moves");
        let is_refused = match &said.answer {
            None => is_told,
            Some(_) => ["cannot_tell", "unexplained"].contains(&said.verdict()),
        };
        if !is_refused || !said.effects.is_empty() {
            wrong.push(format!("{log}: {said}"));
        }
    }
    assert_eq!(wrong, Vec::<String>::new());
}

/// Joints of the arm whose friction grows with the root of the rate.
fn is_concave(at: &str) -> bool {
    ["shoulder", "flange"].contains(&at)
}

fn viscous_of(at: &str) -> &'static [&'static str] {
    if is_concave(at) { &["viscous", "shear_thinning"] } else { &["viscous"] }
}

#[test]
#[ignore = "needs the measurements, which are not part of the repository"]
fn a_real_arm_has_viscous_and_coulomb_friction_in_all_joints() {
    let columns = "staubli_tx40_columns.json";
    let set = Set::new("real_arm", "staubli_tx40.json", columns, "staubli_tx40");
    let started = Instant::now();
    // two effects a joint are asked for
    let said = set.halves(&["tx40_1kHz.csv"], &["--most", "20"]);
    let seconds = started.elapsed().as_secs_f64();
    println!("{seconds:.0} s");
    let joints = ["shoulder", "upper_arm", "elbow", "forearm", "wrist", "flange"];
    // two effects of a joint, even if each of them could be either
    let has_both = |joint: &&str| {
        let [viscous, dry] = [viscous_of(joint), &COULOMB].map(|names| said.these(joint, names));
        viscous.iter().any(|one| dry.iter().any(|other| one != other))
    };
    let without: Vec<&str> = joints.into_iter().filter(|joint| !has_both(joint)).collect();
    assert!(without.is_empty(), "without viscous and Coulomb friction: {without:?}; {said}");
    let may = |effect: &Effect| {
        let (name, at) = (effect.name.as_str(), effect.at.as_str());
        let coupled = ["wrist with flange", "flange with wrist"].contains(&at);
        ["viscous", "rotor_inertia", "torque_offset"].contains(&name)
            || COULOMB.contains(&name)
            || (name == "shear_thinning" && is_concave(at))
            || (name.starts_with("coupled_") && coupled)
    };
    assert_eq!(said.others(may), Vec::<String>::new(), "{said}");
}
