//! The shipped scenarios run to their end within their tolerances; bad ones are refused in full.

use super::assert_near;
use denavit_plants::shipped;
use denavit_simulate::scenario::{self, Scenario, ScenarioError};
use denavit_simulate::{Run, Stop};

fn load(name: &str) -> Result<Vec<u8>, String> {
    let found = shipped::find_referred(name);
    found.map(|model| model.text.as_bytes().to_vec()).ok_or_else(|| "no such model".to_owned())
}

fn open(name: &str) -> Scenario {
    let shipped = shipped::find_scenario(name).unwrap();
    scenario::read(name, shipped.text.as_bytes(), &load).unwrap_or_else(|error| panic!("{error}"))
}

fn run(name: &str) -> (Scenario, Run) {
    let mut scenario = open(name);
    let run = scenario.run().unwrap_or_else(|error| panic!("{name}: {error}"));
    (scenario, run)
}

fn assert_good(name: &str) -> (Scenario, Run) {
    let (scenario, run) = run(name);
    assert_eq!(run.stop, Stop::End, "{name}");
    let broken = run.audit.broken(&scenario.tolerances);
    assert!(broken.is_empty(), "{name}: {broken:?}");
    (scenario, run)
}

#[test]
fn bodies_run_to_their_end() {
    for name in ["bouncing_ball", "rocking_block", "falling_rod", "cradle", "sliding_block"] {
        assert_good(name);
    }
}

#[test]
fn the_double_pendulum_swings() {
    assert_good("double_pendulum");
}

#[test]
fn the_leg_tracks() {
    let (_, run) = assert_good("tulip_leg_tracking");
    assert_near(run.end.q[3], 0.0, 0.1);
}

/// The log of the simulated experiment is what instruments write, and follows its trajectory.
#[test]
fn the_leg_is_identified_from_what_instruments_write() {
    let (_, run) = assert_good("tulip_leg_identification");
    let column = |name: &str| run.log.column(name).unwrap_or_else(|| panic!("{name}"));
    let (q, reference) = (column("q_knee"), column("ref_knee"));
    let apart = q.iter().zip(&reference).map(|(q, r)| (q - r).abs()).fold(0.0, f64::max);
    assert!((1e-4..0.05).contains(&apart), "{apart}");
    let step = 0.0000314159;
    assert!(q.iter().all(|q| (q / step - (q / step).round()).abs() < 1e-6));
    assert!(run.log.column("qd_knee").is_none() && run.log.column("energy").is_none());
}

/// How often one foot takes over from the other: new contacts of a foot that had none.
fn steps(scenario: &Scenario, run: &Run) -> usize {
    let contacts = &scenario.plant.model().contacts;
    let on = |closed: &[usize], link: usize| closed.iter().any(|c| contacts[*c].link == link);
    let feet: std::collections::BTreeSet<usize> = contacts.iter().map(|c| c.link).collect();
    let pairs = run.events.windows(2);
    pairs
        .map(|pair| {
            let lands = |foot: &&usize| !on(&pair[0].closed, **foot) && on(&pair[1].closed, **foot);
            feet.iter().filter(lands).count()
        })
        .sum()
}

/// Thirty steps, feet flat; the figures are those of an independent simulator.
#[test]
fn the_biped_walks_thirty_steps_by_its_zero_moment_point() {
    let (scenario, run) = assert_good("planar_biped_zmp_gait");
    assert!(steps(&scenario, &run) >= 30, "{} steps", steps(&scenario, &run));
    // a step is 0.1 m, less or more what the joints give way
    assert_near(run.end.q[1], 30.0 * 0.1 - 0.02, 30.0 * 0.002);
    assert!(run.audit.zmp_margin_m > 0.03 && run.audit.torque < 31.0, "{:?}", run.audit);
    assert!(run.audit.friction_total < 0.35, "{:?}", run.audit);
    assert!(run.audit.zmp_m < 1e-8, "{:?}", run.audit);
}

#[test]
fn the_biped_walks_forty_steps_on_a_limit_cycle() {
    let (scenario, run) = assert_good("planar_biped_limit_cycle_gait");
    assert!(steps(&scenario, &run) >= 39, "{} steps", steps(&scenario, &run));
    assert!((run.end.q[1] - run.log.rows().next().unwrap()[2]) / 18.0 > 0.6);
}

#[test]
fn tulip_stands() {
    assert_good("tulip_standing");
}

fn faults(text: &str) -> ScenarioError {
    match scenario::read("bad.json", text.as_bytes(), &load) {
        Ok(_) => panic!("a bad scenario was read"),
        Err(error) => error,
    }
}

#[test]
fn all_faults_of_a_scenario_are_found_at_once() {
    let error = faults(
        r#"{
 "format": "denavit-scenario/1",
 "model": "planar_2r",
 "duration_s": -1,
 "initial": {"q": {"joint_1": 0, "nowhere": 1}},
 "control": {"joints": {"link1": {
  "kp": -5, "reference": {"cubic": {"times": [0, 0], "values": [1, 2]}}
 }}},
 "contact": {"restitution": 1.5, "frictoin": 1},
 "seed": 1, "seed": 2
}"#,
    );
    let text = error.to_string();
    for part in [
        "bad.json:4:16: /duration_s: the number must be from 0 to 1e5; it is -1\n  hint: ",
        "/initial/q/nowhere: no joint is called `nowhere`",
        "/contact/restitution: the number must be from 0 to 1; it is 1.5",
        "/contact/frictoin: unknown key `frictoin`\n  hint: did you mean `friction`?",
        "/seed: the key `seed` is given twice",
    ] {
        assert!(text.contains(part), "{part}\nis not in\n{text}");
    }
    assert!(error.faults.len() >= 6, "{text}");
}

#[test]
fn broken_json_and_unknown_models_are_placed() {
    assert!(faults("{\"format\": ").to_string().starts_with("bad.json:1:11: not JSON"));
    let text = "{\"format\": \"denavit-scenario/1\", \"duration_s\": 1, \"model\": \"tulp\"}";
    assert!(faults(text).to_string().contains("/model: tulp: cannot be read"));
    let text = "{\"format\": \"x\", \"duration_s\": 1}";
    let said = faults(text).to_string();
    assert!(
        said.contains("the format is `x`") && said.contains("key `model` is missing"),
        "{said}"
    );
}

#[test]
fn what_is_no_text_or_no_number_is_said() {
    for (bytes, said) in [
        (&b"\xef\xbb\xbf{}"[..], "bad.json:1:1: the file begins with a byte order mark"),
        (b"{\"name\": \"\xff\"}", "bad.json:1:11: the file is not UTF-8 text"),
        (b"{\"duration_s\": NaN}", "JSON has no NaN"),
        (b"{\"duration_s\": 1e999}", "/duration_s: `1e999` is not a finite number"),
    ] {
        let error = scenario::read("bad.json", bytes, &load).err().expect("it is refused");
        assert!(error.to_string().contains(said), "no `{said}` in {error}");
    }
}

/// What would be ignored is refused: nothing that a scenario says is without effect.
#[test]
fn what_has_no_effect_is_refused() {
    let scenario = |entries: &str| {
        format!("{{\"format\": \"denavit-scenario/1\", \"duration_s\": 1,\n {entries}}}")
    };
    for (entries, parts) in [
        (
            "\"model\": \"planar_2r\", \"cradle_balls\": 3",
            &["2:40: /cradle_balls: `model` and `cradle_balls` are two robots"][..],
        ),
        (
            "\"cradle_balls\": 9, \"parameters\": {\"m1\": 1}",
            &["/cradle_balls: the number must be from 2 to 8", "/parameters: this has no effect"],
        ),
        (
            "\"model\": \"planar_2r\", \"measurement\": {\"rate_noise\": 1}",
            &["/measurement: this has no effect without `period_s` in `control`"],
        ),
        (
            "\"model\": \"planar_2r\", \"control\": {\"joints\":
 {\"link1\": {\"kp\": 1, \"kd\": 2}}}",
            &[
                "/control/joints/link1/kp: this has no",
                "/link1/kd: this has no effect without a `r",
            ],
        ),
        (
            "\"model\": \"ball\", \"drives\": \"model\", \"control\": {\"feedback\": \"motor\"}",
            &["/drives: this has no effect without drives", "/control/feedback: this has no"],
        ),
        (
            "\"model\": \"ball\", \"control\": {\"saturates\": true}",
            &["/control/saturates: this has no effect without torque limits"],
        ),
    ] {
        let said = faults(&scenario(entries)).to_string();
        for part in parts {
            assert!(said.contains(part), "no `{part}` in:\n{said}");
        }
    }
}

#[test]
fn parameters_that_no_body_has_are_refused() {
    let with = |parameters: &str, model: &str| {
        let text = format!(
            "{{\"format\": \"denavit-scenario/1\", \"duration_s\": 1, \"model\": \"{model}\",
 \"initial\": {{\"on_ground\": {}}}, \"parameters\": {{{parameters}}}}}",
            model == "tulip"
        );
        faults(&text).to_string()
    };
    let said = with("\"ks_right_ankle_x\": -1", "tulip");
    assert!(said.contains("the spring's stiffness of `right_ankle_x` is -1"), "{said}");
    let said = with("\"m_link1\": -1", "planar_2r");
    assert!(said.contains("/parameters: with these values the mass of `link1` is -1"), "{said}");
}

/// Garbage is answered at once, and not at length.
#[test]
fn a_million_faults_are_counted_not_listed() {
    let words = vec!["\"a\""; 150_000].join(",");
    let text = format!(
        "{{\"format\": \"denavit-scenario/1\", \"model\": \"planar_2r\", \"duration_s\": 1,
 \"control\": {{\"joints\": {{\"link1\": {{\"reference\": {{\"polynomial\": [{words}]}}}}}}}}}}"
    );
    let error = faults(&text);
    assert_eq!((error.faults.len(), error.omitted), (100, 150_000 - 100));
    assert!(error.to_string().ends_with("more faults"));
}

#[test]
fn pushes_without_an_effect_are_faults() {
    let error = faults(
        r#"{
 "format": "denavit-scenario/1",
 "model": "planar_biped",
 "duration_s": 2,
 "initial": {"t_s": 10},
 "pushes": [
  {"link": "base_pitch", "at_s": 100, "impulse_ns": [1, 0, 0]},
  {"link": "base_pitch", "at_s": 0.5, "impulse_ns": [1, 0, 0]},
  {"link": "base_pitch", "at_s": 11, "impulse_ns": [0, 5, 0]},
  {"link": "base_pitch", "at_s": 11, "force_n": [0, 0, 0], "duration_s": 1},
  {"link": "base_pitch", "at_s": 9.5, "force_n": [1, 0, 0], "duration_s": 1}
 ]
}"#,
    );
    let text = error.to_string();
    for part in [
        "/pushes/0: this has no effect without a run that lasts until then",
        "/pushes/1: this has no effect without a run that lasts until then",
        "/pushes/2: this has no effect without a part along x or z",
        "/pushes/3: this has no effect without a strength",
    ] {
        assert!(text.contains(part), "{part}\nis not in\n{text}");
    }
    assert!(!text.contains("/pushes/4"), "{text}");
}
