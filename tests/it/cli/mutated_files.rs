//! Files that are nearly right: every reader answers with what it read or with a message, and never
//! panics, whatever a byte was changed to.

use denavit::effect;
use denavit::measure::log::{ColumnMapping, LogOf, read_log};
use denavit::model::{self, Robot};
use denavit::plants::regression::RegressionModel;
use denavit::plants::{PlantModel, plant_of};
use denavit::regressor::functions::modelled;
use denavit::shipped;
use denavit::simulate::Log;
use denavit::simulate::scenario::{read_controller, read_trajectory};
use denavit::walk::read_scenario;
use denavit::workflow::{IdentifyOptions, Logs, RobotFile, Silent, identify_statics};
use proptest::prelude::*;
use std::fmt::Display;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;

/// What takes the place of parts of files: JSON of every kind, numbers at the ends of what
/// computers count, halves of structures, and words that stand elsewhere in the files.
const PARTS: [&str; 28] = [
    "null",
    "true",
    "-1",
    "0",
    "1e999",
    "-1e308",
    "1e-320",
    "0.5",
    "99999999999999999999",
    "[]",
    "{}",
    "\"\"",
    "\"\\u0000\"",
    "\"\\ud800\"",
    "\"tulip\"",
    "\"link1\"",
    "[[[[[[",
    "}",
    "]",
    ",",
    "\"",
    "\n",
    "\r#",
    "nan",
    ";",
    "\u{feff}",
    "é\u{202e}",
    "\u{0}",
];

/// A change: at which part of the file, of what kind, with what.
type Change = (f64, usize, usize);

fn changes() -> impl Strategy<Value = Vec<Change>> {
    prop::collection::vec((0.0..1.0, 0usize..6, 0usize..10_000), 1..5)
}

fn mutated(text: &str, changes: &[Change]) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    for &(share, kind, what) in changes {
        let at = (share * bytes.len() as f64) as usize;
        let part = PARTS[what % PARTS.len()].as_bytes().iter().copied();
        let is_word = |byte: &u8| !b" ,:[]{}\n;".contains(byte);
        match kind {
            0 => drop(bytes.splice(at..at, part)),
            // the next word or number
            1 | 2 => {
                let begin = at + bytes[at..].iter().position(is_word).unwrap_or(0);
                let length = bytes[begin..].iter().position(|byte| !is_word(byte)).unwrap_or(0);
                bytes.splice(begin..begin + length, part);
            }
            3 => drop(bytes.drain(at..(at + what % 40).min(bytes.len()))),
            4 => {
                let again = bytes[at..(at + what % 200).min(bytes.len())].to_vec();
                bytes.splice(at..at, again);
            }
            _ => match bytes.get_mut(at) {
                Some(byte) => *byte = what as u8,
                None => bytes.push(what as u8),
            },
        }
    }
    bytes
}

/// What a reader said of a file: of one that is wrong, what that file is called.
fn assert_told<T, E: Display>(read: Result<T, E>) {
    if let Err(error) = read {
        let said = error.to_string();
        assert!(said.contains("mutated.file"), "{said}");
    }
}

const FILE: &str = "mutated.file";

fn load(name: &str) -> Result<Vec<u8>, String> {
    match (name, shipped::find_referred(name)) {
        (_, Some(shipped)) => Ok(shipped.text.as_bytes().to_vec()),
        ("run.csv", _) => Ok(b"t,q_link1\n0,1\n1,2\n2,0\n".to_vec()),
        _ => Err("there is none".to_owned()),
    }
}

fn robot(name: &str) -> Robot {
    let text = shipped::find(name).expect("shipped").text;
    model::read(name, text.as_bytes()).expect("a model")
}

/// The shipped controllers with the robots of the same names.
static CONTROLLERS: LazyLock<Vec<(&str, PlantModel)>> = LazyLock::new(|| {
    let plant = |name| plant_of(&robot(name), &[]).expect("a plant").model().clone();
    shipped::CONTROLLERS.iter().map(|one| (one.text, plant(one.name))).collect()
});

/// The texts of the catalogue.
static EFFECTS: LazyLock<Vec<String>> = LazyLock::new(|| {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("models/effects");
    let files = effect::files(&folder).expect("a folder");
    files.iter().map(|path| fs::read_to_string(path).expect("a file")).collect()
});

static ARM: LazyLock<RegressionModel> = LazyLock::new(|| {
    let robot = robot("planar_2r");
    RegressionModel::new(&robot, modelled(&robot), &[]).expect("a model")
});

/// The same as a user has it.
static ARM_FILE: LazyLock<RobotFile> =
    LazyLock::new(|| RobotFile::open("planar_2r").expect("a shipped model"));

/// A scenario that has much of what scenarios may have.
const SCENARIO: &str = r#"{"format": "denavit-scenario/1", "name": "n", "model": "planar_2r",
 "parameters": {"l1": 0.4}, "duration_s": 2, "initial": {"t_s": 0, "q": {"link1": 0.1}},
 "control": {"compensation": "gravity", "period_s": 0.001, "saturates": false, "joints": {
   "link1": {"kp": 10, "kd": 1, "reference": {"log": {"file": "run.csv", "column": "q_link1"}}},
   "link2": {"kp": 5, "kd": 1, "damps": "rate", "reference": {"fourier": {"frequency_rad_s": 3,
     "sines": [0.1, 0.2], "cosines": [0, 0.1]}}, "feed_forward": {"polynomial": [1, 2]}}}},
 "measurement": {"resolution": 1e-4, "delay_samples": 1}, "seed": 3, "scheme": "time_stepping",
 "time_stepping": {"step_s": 0.001, "solver": "pivots", "facets": 8}, "log_period_s": 0.01,
 "integrator": {"method": "radau", "relative": 1e-6}, "limits": {"events": 10}}"#;

const STATICS: &str = r#"{"format": "denavit-statics/1",
 "weighings": [{"links": ["link1", "link2"], "mass_kg": 3.5, "std_kg": 0.01}],
 "postures": [{"q": {"link1": 0.1, "link2": 0.2},
   "torques": {"link1": {"torque": 3, "std": 0.1}}}]}"#;

const MAPPING: &str = r#"{"q_link1": {"column": "a", "scale": -1, "offset": 0.5}, "tau_link1": "b",
 "t": {"column": "time", "scale": 0.001}, "qd_link2": null}"#;

/// A log of the arm, with what logs may have.
fn log() -> String {
    let mut text = "# model: planar_2r\n# torque_side: joint\n".to_owned();
    text += "t,q_link1,q_link2,tau_link1,tau_link2\n";
    for k in 0..120 {
        let t = 0.01 * f64::from(k);
        let [a, b] = [(3.0 * t).sin(), (5.0 * t).cos()];
        text += &format!("{t:.3},{a:.6},{b:.6},{:.4},{:.4}\n", a * b, a - b);
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn scenarios(changes in changes(), which in 0usize..4) {
        let names = ["bouncing_ball", "rocking_block", "double_pendulum"];
        let text = names.get(which).map(|name| shipped::find_scenario(name).expect("shipped").text);
        assert_told(read_scenario(FILE, &mutated(text.unwrap_or(SCENARIO), &changes), &load));
    }

    #[test]
    fn trajectories_and_controllers(changes in changes(), which in 0usize..10) {
        let all = shipped::TRAJECTORIES;
        let text = all[which % all.len()].text;
        assert_told(read_trajectory(FILE, &mutated(text, &changes), &load));
        let (text, plant) = &CONTROLLERS[which % CONTROLLERS.len()];
        assert_told(read_controller(FILE, &mutated(text, &changes), plant, &load));
    }

    #[test]
    fn effects(changes in changes(), which in 0usize..1000) {
        let text = &EFFECTS[which % EFFECTS.len()];
        assert_told(effect::read(FILE, &mutated(text, &changes)));
    }

    #[test]
    fn mappings_weighings_and_logs(changes in changes()) {
        let model = &*ARM;
        let (logs, options) = (Logs::default(), IdentifyOptions::default());
        let rests = mutated(STATICS, &changes);
        let found = identify_statics(&ARM_FILE, FILE, &rests, &logs, &options, &mut Silent);
        assert_told(found);
        let mapping = ColumnMapping::from_json(FILE, &mutated(MAPPING, &changes));
        let log = mutated(&log(), &changes);
        assert_told(Log::from_csv(FILE, &log));
        for accepts_suspicious in [false, true] {
            let (model, joints) = (&model.model, &model.joints);
            let of = LogOf { model, joints, contacts: &[], accepts_suspicious };
            assert_told(read_log(FILE, &log[..], of, &ColumnMapping::default()));
            if let Ok(mapping) = &mapping {
                assert_told(read_log(FILE, &log[..], of, mapping));
            }
        }
        assert_told(mapping);
    }
}
