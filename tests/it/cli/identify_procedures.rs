//! `denavit identify`: two stages, measurements at rest, laws of friction, signs of torques.

use super::{Directory, run_in};
use denavit::shipped;
use serde_json::{Value, json};

fn write(directory: &Directory, name: &str, text: &str) {
    std::fs::write(directory.path.join(name), text).expect("written");
}

fn simulate(directory: &Directory, scenario: &str) {
    let run = run_in(&directory.path, &["simulate", scenario, "-o", "log.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
}

fn identified(directory: &Directory, words: &[&str]) -> Value {
    let words = [&["identify"][..], words, &["--json"]].concat();
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(0), "{words:?}: {}", run.stderr);
    serde_json::from_str(&run.stdout).expect("JSON")
}

/// A scenario of the planar arm.
fn moving_arm() -> Value {
    json!({
        "format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 5,
        "control": {"joints": {
            "link1": {"kp": 300, "kd": 30, "reference":
                {"fourier": {"frequency_rad_s": 2, "sines": [0.4, 0.2], "cosines": [0.1, 0.2]}}},
            "link2": {"kp": 300, "kd": 30, "reference":
                {"fourier": {"frequency_rad_s": 3, "sines": [0.5, 0.2], "cosines": [0.1, 0.3]}}}}},
        "log_period_s": 0.002,
    })
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// Table 3.5 on TUlip's leg, its motors and encoders of 20 bits; the model starts from springs that
/// are wrong by half.
#[test]
fn springs_come_out_in_two_stages() {
    let directory = Directory::new("two-stages");
    simulate(&directory, "tulip_leg_elastic_identification");
    let shipped = shipped::find("tulip_leg").expect("shipped");
    let mut soft: Value = serde_json::from_str(shipped.text).expect("JSON");
    let truth = soft["drives"].clone();
    for joint in ["hip_y", "knee", "ankle_y"] {
        soft["drives"][joint]["series_elastic"]["stiffness"] = 40000.into();
        soft["drives"][joint]["coulomb"] = 0.001.into();
    }
    write(&directory, "soft.json", &soft.to_string());
    let words = [
        "soft.json",
        "--train",
        "log.csv",
        "--accept-suspicious",
        "--two-stage",
        "--filter",
        "40",
        "--friction",
        "tanh",
    ];
    let found = identified(&directory, &[&words[..], &["-o", "found.json"]].concat());
    let springs = found["springs"].as_array().expect("a list");
    assert_eq!(springs.len(), 3);
    let written = std::fs::read_to_string(directory.path.join("found.json")).expect("a model");
    let written: Value = serde_json::from_str(&written).expect("JSON");
    for spring in springs {
        let joint = spring["joint"].as_str().expect("a name");
        let drive = &truth[joint];
        for (key, truth, tolerance) in [
            ("stiffness", &drive["series_elastic"]["stiffness"], 0.01),
            ("coulomb", &drive["coulomb"], 0.02),
            ("viscous", &drive["viscous"], 0.05),
        ] {
            let (value, truth) = (number(&spring[key]["value"]), number(truth));
            assert!((value / truth - 1.0).abs() < tolerance, "{joint} {key}: {value} for {truth}");
        }
        let stiffness = &written["drives"][joint]["series_elastic"]["stiffness"]["value"];
        let apart = number(stiffness) / number(&spring["stiffness"]["value"]) - 1.0;
        assert!(apart.abs() < 1e-9, "{stiffness}");
    }
    let again = run_in(&directory.path, &["inspect", "found.json"]);
    assert_eq!(again.code, Some(0), "{}", again.stderr);

    // as one regression of joints whose own torque is not in the log it is refused, not answered
    let log = std::fs::read_to_string(directory.path.join("log.csv")).expect("a log");
    let still: String = log
        .lines()
        .map(|line| match line.split_once(',') {
            // within the limits of the model
            Some((t, _)) if t.parse::<f64>().is_ok_and(|t| t > 1.0) => String::new(),
            _ => format!("{line}\n"),
        })
        .collect();
    write(&directory, "short.csv", &still);
    let run = run_in(&directory.path, &["identify", "tulip_leg", "--train", "short.csv"]);
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("--two-stage"), "{}", run.stderr);
    let words = ["identify", "puma560", "--train", "log.csv", "--two-stage"];
    assert_eq!(run_in(&directory.path, &words).code, Some(2));
}

/// Both stages are judged by a log that they have not seen, and drawn.
#[test]
fn two_stages_are_judged_by_other_logs() {
    let directory = Directory::new("two-stages-judged");
    simulate(&directory, "tulip_leg_elastic_identification");
    std::fs::rename(directory.path.join("log.csv"), directory.path.join("train.csv"))
        .expect("renamed");
    let text = shipped::find_scenario("tulip_leg_elastic_identification").expect("shipped").text;
    let mut other: Value = serde_json::from_str(text).expect("JSON");
    // another beginning and other noise
    (other["initial"]["t_s"], other["seed"]) = (5.into(), 2.into());
    (other["duration_s"], other["parameters"]["m6"]) = (9.into(), 2.4.into());
    write(&directory, "other.json", &other.to_string());
    simulate(&directory, "other.json");
    let words = ["tulip_leg", "--train", "train.csv", "--accept-suspicious", "--two-stage"];
    let words = [&words[..], &["--filter", "40", "--friction", "tanh", "--validate"]].concat();
    let drawn = ["log.csv", "--svg", "torques.svg", "--html", "page.html"];
    let found = identified(&directory, &[&words[..], &drawn].concat());
    // the foot of the other log is 33 g heavier
    let left = number(&found["validate"]);
    assert!((1e-3..0.05).contains(&left), "{left}");
    for joint in found["residual"].as_array().expect("a list") {
        assert!(number(&joint["validate"]) < 0.1, "{joint}");
    }
    let text = |name: &str| std::fs::read_to_string(directory.path.join(name)).expect("a file");
    let (svg, page) = (text("torques.svg"), text("page.html"));
    assert!(svg.starts_with("<svg") && svg.contains("of the logs for validation"), "{svg}");
    for part in
        ["Springs and motors", "of those of other logs", "ankle_y", "class=\"chart\"", "log.csv"]
    {
        assert!(page.contains(part), "no {part}");
    }
    // without a log to judge by they are those of the estimate, which the fit is known of
    let found = identified(&directory, &words[..words.len() - 1]);
    assert_eq!(found["validate"], Value::Null);
    let run = run_in(&directory.path, &[&["identify"], &words[..], &["train.csv"]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stdout.contains("train.csv: says the same as train.csv"), "{}", run.stdout);
    let mute = text("log.csv").replace("motor_knee", "angle_knee");
    write(&directory, "mute.csv", &mute);
    let run = run_in(&directory.path, &[&["identify"], &words[..], &["mute.csv"]].concat());
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("mute.csv") && run.stderr.contains("motor_knee"), "{}", run.stderr);
}

/// Weighings and held postures of the planar arm, by hand: gravity along -y, centres of mass 0.28
/// and 0.23 m from their joints, a link of 0.5 m between these.
#[test]
fn weighings_and_postures_say_what_follows() {
    let directory = Directory::new("statics");
    let posture = |a: f64, b: f64| {
        let second = 1.5 * 9.81 * 0.23 * (a + b).cos();
        let first = (2.0 * 0.28 + 1.5 * 0.5) * 9.81 * a.cos() + second;
        let torque = |torque: f64| json!({"torque": torque, "std": 0.02});
        json!({"q": {"link1": a, "link2": b},
               "torques": {"link1": torque(first), "link2": torque(second)}})
    };
    let file = json!({
        "format": "denavit-statics/1",
        "weighings": [
            {"links": ["link1", "link2"], "mass_kg": 3.5, "std_kg": 0.01},
            {"links": ["link2"], "mass_kg": 1.5, "std_kg": 0.01},
        ],
        "postures": [
            posture(0.0, 0.0), posture(0.5, -1.0), posture(1.2, 0.4), posture(-0.7, 1.9)],
    });
    write(&directory, "rest.json", &file.to_string());
    let words = ["planar_2r", "--static", "rest.json"];
    let found = identified(&directory, &words);
    let follows = |name: &str| {
        let all = found["parameters"].as_array().expect("a list");
        let one = all.iter().find(|one| one["name"] == name).expect(name);
        (one["value"].as_f64(), one["identifiable"].as_bool().expect("a flag"))
    };
    for (name, value) in
        [("m_link1", 2.0), ("m_link2", 1.5), ("mx_link1", -0.44), ("mx_link2", -0.255)]
    {
        let (found, is_told) = follows(name);
        assert!(is_told && (found.expect(name) - value).abs() < 1e-9, "{name}: {found:?}");
    }
    assert_eq!(follows("Izz_link2"), (None, false), "nothing moved");
    let run = run_in(&directory.path, &[&["identify"][..], &words].concat());
    assert!(run.stdout.contains("of which 6 stand alone"), "{}", run.stdout);
    assert!(!run.stdout.contains("contradict"), "{}", run.stdout);
    let mut file = file;
    file["postures"][2]["torques"]["link1"]["torque"] = (-3.0).into();
    write(&directory, "sign.json", &file.to_string());
    let run = run_in(&directory.path, &["identify", "planar_2r", "--static", "sign.json"]);
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stdout.contains("They contradict each other"), "{}", run.stdout);
    let words = ["identify", "planar_2r", "--static", "rest.json", "--validate", "rest.json"];
    assert_eq!(run_in(&directory.path, &words).code, Some(2));

    // faults are told with their place, all at once
    let file = r#"{"format": "denavit-statics/1",
        "weighings": [{"links": ["link3"], "mass_kg": -1, "std_kg": 0}],
        "postures": [{"q": {"link1": 0, "lnk2": 0}, "torques": {}}]}"#;
    write(&directory, "wrong.json", file);
    let run = run_in(&directory.path, &["identify", "planar_2r", "--static", "wrong.json"]);
    assert_eq!(run.code, Some(2));
    for said in ["mass_kg", "std_kg", "`lnk2`", "position of `link2`", "wrong.json:2:"] {
        assert!(run.stderr.contains(said), "{said}: {}", run.stderr);
    }
}

/// A simulation's Coulomb friction is a hyperbolic tangent, which a slow motion shows: the law that
/// is true finds it, and so does the sign where rows near reversals are left out, not with all.
#[test]
fn laws_of_friction_can_be_chosen() {
    let directory = Directory::new("laws");
    simulate(&directory, "tulip_leg_tracking");
    let friction = |more: &[&str]| {
        let words = [&["tulip_leg", "--train", "log.csv", "--filter", "40"][..], more].concat();
        let found = identified(&directory, &words);
        let all = found["parameters"].as_array().expect("a list").clone();
        let one = all.iter().find(|one| one["name"] == "fc_hip_x").expect("a parameter").clone();
        let is_said = found["remarks"].to_string().contains("friction of hip_x is uncertain");
        assert_eq!(is_said, more == ["--skip-slow", "off"], "{more:?}: {}", found["remarks"]);
        let left_out = found["left_out"].as_array().expect("a list").iter();
        let left_out = left_out.filter(|rows| rows["joint"] == "hip_x").count();
        (number(&one["value"]) / number(&one["model_value"]), number(&one["std"]), left_out)
    };
    let (sign, std, left_out) = friction(&[]);
    let (all, _, none_left_out) = friction(&["--skip-slow", "off"]);
    let (tanh, ..) = friction(&["--friction", "tanh"]);
    let (skipped, ..) = friction(&["--skip-slow", "0.05"]);
    println!("{sign} ({std}), {all}, {tanh}, {skipped}");
    assert_eq!((left_out, none_left_out), (1, 0));
    assert!((all - 1.0).abs() > 0.1, "{all}");
    for found in [sign, tanh, skipped] {
        assert!((found - 1.0).abs() < 0.02, "{found}");
    }
    let words = ["identify", "tulip_leg", "--train", "log.csv", "--friction", "tanh:0"];
    assert_eq!(run_in(&directory.path, &words).code, Some(2));
}

#[test]
fn a_torque_of_the_wrong_sign_is_told_by_its_joint() {
    let directory = Directory::new("signs");
    simulate(&directory, "tulip_leg_identification");
    for joint in ["knee", "hip_z"] {
        write(&directory, "map.json", &format!("{{\"tau_{joint}\": {{\"scale\": -1}}}}"));
        let words = ["tulip_leg_table34", "--train", "log.csv", "--filter", "10"];
        let sound = identified(&directory, &words);
        assert!(!sound["remarks"].to_string().contains("wrong sign"), "{}", sound["remarks"]);
        let words = [&["identify"][..], &words[..], &["--columns", "map.json"]].concat();
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{}", run.stdout);
        assert!(run.stderr.contains(&format!("the torque of {joint} seems")), "{}", run.stderr);
        assert_eq!(run.stderr.matches("wrong sign").count(), 1, "{}", run.stderr);
        let run = run_in(&directory.path, &[&words[..], &["--accept-suspicious"]].concat());
        assert_ne!(run.code, Some(2), "{}", run.stderr);
        assert!(run.stdout.contains("wrong sign"), "{}", run.stdout);
    }
}

/// Without rates and references only the balance of torques shows which joint is which.
#[test]
fn exchanged_joints_are_told_by_the_balance_of_torques() {
    let directory = Directory::new("exchanged");
    write(&directory, "arm.json", &moving_arm().to_string());
    let run = run_in(&directory.path, &["simulate", "arm.json", "-o", "arm.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let map = |exchanged: &[&str]| {
        let mut map = serde_json::Map::new();
        for (joint, other) in [("link1", "link2"), ("link2", "link1")] {
            for left_out in ["qd", "qdd", "ref"] {
                map.insert(format!("{left_out}_{joint}"), Value::Null);
            }
            for one in exchanged {
                map.insert(format!("{one}_{joint}"), format!("{one}_{other}").into());
            }
        }
        write(&directory, "map.json", &Value::Object(map).to_string());
    };
    let words = ["identify", "planar_2r", "--train", "arm.csv", "--columns", "map.json"];
    map(&[]);
    let run = run_in(&directory.path, &words);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let cases: [(&[&str], &str); 3] = [
        (&["q"], "the positions of"),
        (&["tau"], "the torques of"),
        (&["q", "tau"], "positions and torques of"),
    ];
    for (exchanged, said) in cases {
        map(exchanged);
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{exchanged:?}: {}", run.stdout);
        assert!(run.stderr.contains(said), "{exchanged:?}: {}", run.stderr);
        let accepted = [&words[..], &["--accept-suspicious"]].concat();
        let run = run_in(&directory.path, &accepted);
        assert!(run.code != Some(2) && run.stdout.contains("exchanged"), "{}", run.stdout);
    }
}

/// A torque that is something else is told, and logs that end before they say anything.
#[test]
fn unexplained_torques_and_short_logs_are_told() {
    let directory = Directory::new("unexplained");
    write(&directory, "arm.json", &moving_arm().to_string());
    let run = run_in(&directory.path, &["simulate", "arm.json", "-o", "arm.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let text = std::fs::read_to_string(directory.path.join("arm.csv")).expect("a log");
    let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let columns: Vec<&str> = lines[0].split(',').collect();
    let torque = columns.iter().position(|one| *one == "tau_link2").expect("a torque");
    let mut noise = lines[0].to_owned() + "\n";
    for (row, line) in lines[1..].iter().enumerate() {
        // a fast square wave of no motion's period
        let value = if row * row / 7 % 2 == 0 { "1.0" } else { "-1.0" };
        let mut fields: Vec<&str> = line.split(',').collect();
        fields[torque] = value;
        noise += &(fields.join(",") + "\n");
    }
    write(&directory, "noise.csv", &noise);
    let words = ["identify", "planar_2r", "--accept-suspicious", "--train"];
    let run = run_in(&directory.path, &[&words[..], &["noise.csv"]].concat());
    assert_eq!(run.code, Some(1), "{}{}", run.stdout, run.stderr);
    assert!(run.stdout.contains("The torque of link2 is not explained"), "{}", run.stdout);
    write(&directory, "short.csv", &(lines[..111].join("\n") + "\n"));
    let run = run_in(&directory.path, &[&words[..], &["short.csv"]].concat());
    assert_eq!(run.code, Some(2), "{}", run.stdout);
    assert!(run.stderr.contains("the logs are too short"), "{}", run.stderr);
}

/// What is written is a model, however little the log says: bodies as sums of unknowns, moments of
/// inertia about centres of mass, numbers that the file does not have yet.
#[test]
fn written_models_are_sound() {
    let directory = Directory::new("written");
    simulate(&directory, "tulip_leg_identification");
    // below 100 Hz steps of encoders drown the torque, and moments come out negative
    let words = ["tulip_leg_table34", "--train", "log.csv", "--filter", "100", "-o", "found.json"];
    let drowned = identified(&directory, &words[..5]);
    let negative = drowned["parameters"].as_array().expect("a list").iter().any(|one| {
        one["name"].as_str().is_some_and(|name| name.starts_with("fv"))
            && number(&one["value"]) < 0.0
    });
    assert!(negative, "an estimate of no bodies");
    let run = run_in(&directory.path, &[&["identify"][..], &words].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let read = run_in(&directory.path, &["inspect", "found.json", "--json"]);
    assert_eq!(read.code, Some(0), "{}", read.stderr);

    // a body about its centre of mass, written over several lines, without drives
    write(&directory, "arm.json", &moving_arm().to_string());
    let run = run_in(&directory.path, &["simulate", "arm.json", "-o", "arm.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let words = ["identify", "planar_2r", "--train", "arm.csv", "--with", "friction"];
    let run = run_in(&directory.path, &[&words[..], &["-o", "new.json"]].concat());
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let text = std::fs::read_to_string(directory.path.join("new.json")).expect("a model");
    let written: Value = serde_json::from_str(&text).expect("JSON");
    assert!(written["drives"]["link1"].is_object(), "{text}");
    let body = &written["links"][1]["body"];
    assert!(body["inertia"]["zz"].is_number(), "about the centre of mass: {body}");
    // what moves nothing stays as it is written
    assert_eq!((&body["com"][2], &body["inertia"]["xx"]), (&0.into(), &0.001.into()), "{body}");
    // every key at the beginning of its line
    let root: Vec<&str> = text.lines().filter(|line| line.starts_with("  \"")).collect();
    assert!(root.last().is_some_and(|line| line.starts_with("  \"drives\"")), "{text}");
}

/// Units that the model alone shows, logs that say the same, laps that do not repeat, a prior that
/// says nothing, weighings in grams: each is told, none changes an answer in silence.
#[test]
fn what_only_the_model_shows_is_told() {
    let directory = Directory::new("units");
    write(&directory, "arm.json", &moving_arm().to_string());
    let run = run_in(&directory.path, &["simulate", "arm.json", "-o", "arm.csv"]);
    assert_eq!(run.code, Some(0), "{}", run.stderr);
    let nothing_else =
        r#""qd_link1": null, "qd_link2": null, "ref_link1": null, "ref_link2": null"#;
    let map = |more: &str| format!("{{{nothing_else}{more}}}");
    let torques = |scale: f64| {
        let of = |joint: &str| format!(r#", "tau_{joint}": {{"scale": {scale}}}"#);
        of("link1") + &of("link2")
    };
    let cases = [
        (map(r#", "t": {"scale": 0.1}"#), Some(("the time seems", r#""scale": 1}"#))),
        (map(r#", "t": {"scale": 0.001}"#), Some(("the time seems", r#""scale": 1}"#))),
        (
            map(&torques(1000.0)),
            Some((
                "torques seem to",
                r#""scale": 0.001}} mends that, times the scale that a column has already"#,
            )),
        ),
        (
            map(r#", "tau_link2": {"scale": 1000}"#),
            Some(("the torque of link2 seems", r#""scale": 1}"#)),
        ),
        (
            map(r#", "q_link1": {"scale": 0.017453}, "q_link2": {"scale": 0.017453}"#),
            Some(("positions seem to be radians", r#""scale": 57.29"#)),
        ),
        (map(""), None),
    ];
    for (map, told) in cases {
        write(&directory, "map.json", &map);
        let words = ["identify", "planar_2r", "--train", "arm.csv", "--columns", "map.json"];
        let run = run_in(&directory.path, &words);
        match told {
            None => assert_eq!(run.code, Some(0), "{map}: {}", run.stderr),
            Some((what, hint)) => {
                assert_eq!(run.code, Some(2), "{map}: {}", run.stdout);
                assert!(run.stderr.contains(what), "{map}: {}", run.stderr);
                assert!(run.stderr.contains(hint), "{map}: {}", run.stderr);
                let accepted = [&words[..], &["--accept-suspicious"]].concat();
                assert_ne!(run_in(&directory.path, &accepted).code, Some(2), "{map}");
            }
        }
    }
    let refused = |words: &[&str], said: &str| {
        let words = [&["identify", "planar_2r"][..], words].concat();
        let run = run_in(&directory.path, &words);
        assert_eq!(run.code, Some(2), "{words:?}: {}", run.stdout);
        assert!(run.stderr.contains(said), "{words:?}: {}", run.stderr);
    };
    std::fs::copy(directory.path.join("arm.csv"), directory.path.join("copy.csv")).expect("copied");
    refused(&["--train", "arm.csv", "copy.csv"], "copy.csv says the same as arm.csv");
    refused(&["--train", "arm.csv", "--average", "1.7"], "do not repeat");
    refused(&["--train", "arm.csv", "--prior"], "--prior");
    // the same measurement under another name is no other one
    let words = ["planar_2r", "--train", "arm.csv", "--validate", "copy.csv"];
    let run = run_in(&directory.path, &[&["identify"], &words[..]].concat());
    assert_eq!(run.code, Some(1), "{}", run.stderr);
    assert!(run.stdout.contains("copy.csv: says the same as arm.csv"), "{}", run.stdout);
    assert!(run.stdout.contains("it validates nothing"), "{}", run.stdout);
    let weighing = json!({"links": ["link1", "link2"], "mass_kg": 3500, "std_kg": 1});
    let statics = json!({"format": "denavit-statics/1", "weighings": [weighing], "postures": []});
    write(&directory, "grams.json", &statics.to_string());
    refused(&["--static", "grams.json"], "is it in grams?");
    let accepted = ["identify", "planar_2r", "--static", "grams.json", "--accept-suspicious"];
    assert_eq!(run_in(&directory.path, &accepted).code, Some(0));
}
