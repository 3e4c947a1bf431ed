//! Gait files: shipped ones are read, and all faults of a wrong one are told at once.

use denavit_plants::shipped::GAITS;
use denavit_walk::gait_file::{GaitKind, read_gait, schema};
use denavit_walk::optimal::{CostKind, Role};

#[test]
fn shipped_gaits_are_read() {
    let speeds: Vec<f64> = GAITS
        .iter()
        .filter_map(|shipped| {
            let gait = read_gait(shipped.name, shipped.text.as_bytes()).expect("a sound file");
            let robot = if shipped.name.starts_with("tulip") { "tulip" } else { "planar_biped" };
            assert_eq!((gait.name.as_str(), gait.model.as_str()), (shipped.name, robot));
            let GaitKind::LimitCycle(problem) = gait.kind else { return None };
            assert_eq!(problem.cost, CostKind::CostOfTransport);
            Some(problem.limits.speed_m_s)
        })
        .collect();
    assert_eq!(speeds, [0.95, 0.687]);
}

#[test]
fn everything_that_is_said_is_read() {
    let text = r#"{"format": "denavit-gait/1", "name": "x", "model": "planar_biped",
        "limit_cycle": {"speed_m_s": 0.5, "step_length_m": 0.3, "cost": "torque_squared",
        "friction": 0.4, "clearance_m": 0.01, "torque_limit_nm": 40, "largest_multiplier": 0.5,
        "intervals": 30,
        "phases": [{"name": "flat", "closed": ["stance_toe", "stance_heel"], "share": 2}],
        "aspects": {"push_off": false, "lean": true}, "guess": {"knee_rad": 0.2}}}"#;
    let kind = read_gait("x", text.as_bytes()).expect("sound").kind;
    let GaitKind::LimitCycle(problem) = kind else { panic!("{kind:?}") };
    assert_eq!(problem.limits.step_length_m, Some(0.3));
    assert_eq!(problem.limits.torque_nm, Some(40.0));
    assert_eq!(problem.cost, CostKind::TorqueSquared);
    let phases = problem.phases.expect("phases");
    assert_eq!(phases[0].closed, [Role::StanceHeel, Role::StanceToe]);
    assert!(!problem.aspects.push_off && problem.aspects.lean && problem.aspects.heel_strike);
    assert_eq!((problem.guess.knee_rad, problem.intervals), (0.2, 30));
}

#[test]
fn all_faults_of_a_file_are_told_at_once() {
    let text = r#"{"format": "denavit-gait/2", "limit_cycle": {
        "speed_m_s": -1, "cost": "free", "sped": 1,
        "phases": [{"name": "air", "closed": ["tail"]}], "aspects": {"lean": 3}}}"#;
    let error = read_gait("bad.json", text.as_bytes()).expect_err("a wrong file").to_string();
    for part in ["denavit-gait/1", "model", "from 0.001 to 10", "free", "sped", "tail", "lean"] {
        assert!(error.contains(part), "{part} is missing in\n{error}");
    }
}

#[test]
fn lists_of_phases_that_are_no_step_are_refused() {
    let with = |closed: &str| {
        let text = format!(
            r#"{{"format": "denavit-gait/1", "model": "m", "limit_cycle": {{"speed_m_s": 1,
            "phases": [{{"name": "a", "closed": [{closed}]}}]}}}}"#
        );
        read_gait("x", text.as_bytes()).expect_err("no step").to_string()
    };
    assert!(with("").contains("no contact is closed in phase 1"));
    assert!(with(r#""stance_toe""#).contains("heel and toe"));
}

#[test]
fn the_schema_is_json_and_knows_the_kinds() {
    let schema: serde_json::Value = serde_json::from_str(schema()).expect("JSON");
    assert!(schema["properties"]["limit_cycle"].is_object());
}
