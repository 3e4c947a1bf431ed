//! What is found keeps the limits, and excites.

use super::{arm, shipped_robot};
use denavit_codegen::model::{self, Robot};
use denavit_codegen::regressor::RegressorOptions;
use denavit_excite::{
    Columns, Error, ErrorKind, Excitation, ExciteOptions, Excited, Family, LimitKind, Objective,
    check_trajectory, excite,
};
use denavit_plants::{LoadedPlant, Plant};
use denavit_simulate::scenario::{Trajectory, read_trajectory};

fn options() -> ExciteOptions {
    ExciteOptions {
        duration_s: 4.0,
        family: Family::Fourier { harmonics: 4 },
        with: RegressorOptions { friction: true, only_modelled: true, ..Default::default() },
        starts: 2,
        evaluations: 150,
        ..ExciteOptions::default()
    }
}

fn found(robot: &Robot, options: &ExciteOptions) -> Excited {
    excite(robot, options, &|_| true).unwrap_or_else(|error| panic!("{error}"))
}

fn trajectory(found: &Excited) -> Trajectory {
    let file = found.to_json("found", &serde_json::json!({})).to_string();
    let none = |_: &str| Err("there is no other file".to_owned());
    read_trajectory("found.json", file.as_bytes(), &none).expect("our own files are sound")
}

const TIP: &str = ", \"contacts\": [{\"name\": \"tip\", \"link\": \"link2\", \"position\": \
                   [0, 0, 0]}], \"ground\": {\"point\": [0, -0.6, 0], \"normal\": [0, 1, 0]}";

/// Torques of D qdd + bias and Coulomb friction, and the tip's height from the arm's two lengths.
#[test]
fn limits_hold_by_other_functions_than_those_that_were_optimised() {
    let robot = arm("[-1.0, 2.0]", TIP);
    let found = found(&robot, &options());
    assert!(found.found().ended.is_feasible(), "{:?}", found.found().ended);
    let file = trajectory(&found);
    let mut plant = LoadedPlant::new(&robot, &[]).expect("a plant");
    let references: Vec<_> =
        ["link1", "link2"].iter().map(|joint| file.find(joint).expect("it moves")).collect();
    let (mut highest, mut lowest) = ([0.0_f64; 2], f64::INFINITY);
    for k in 0..4001 {
        let points: Vec<_> = references.iter().map(|r| r.at(0.001 * f64::from(k))).collect();
        let q = [points[0].position, points[1].position];
        let qd = [points[0].rate, points[1].rate];
        let (mut mass, mut torque) = ([0.0; 4], [0.0; 2]);
        plant.mass_matrix(&q, &mut mass);
        plant.bias(&q, &qd, &mut torque);
        for row in 0..2 {
            torque[row] += (0..2).map(|c| mass[2 * row + c] * points[c].acceleration).sum::<f64>();
        }
        torque[1] += 0.5 * if qd[1] == 0.0 { 0.0 } else { qd[1].signum() };
        let height = 0.5 * q[0].sin() + 0.5 * (q[0] + q[1]).sin() + 0.6;
        lowest = lowest.min(height);
        let limits = [[-1.5, 1.5], [-1.0, 2.0]];
        for joint in 0..2 {
            highest[joint] = highest[joint].max(torque[joint].abs());
            let [low, high] = limits[joint];
            assert!((low - 1e-6..=high + 1e-6).contains(&q[joint]), "{q:?}");
            assert!(qd[joint].abs() <= 4.0 + 1e-6, "{qd:?}");
            assert!(points[joint].acceleration.abs() <= 20.0 + 1e-4);
        }
    }
    assert!(highest[0] <= 30.0 + 1e-3 && highest[1] <= 30.0 + 1e-3, "{highest:?}");
    assert!(lowest >= 0.01 - 1e-6, "{lowest}");
    let check = &found.found().ended;
    let torque = check.limits.joints[0].torque.expect("it has a limit").range;
    assert!((torque[0].abs().max(torque[1].abs()) - highest[0]).abs() < 0.05, "{torque:?}");
    let (point, height) = check.limits.lowest.clone().expect("the arm has a tip");
    assert!(point == "tip" && (height - lowest).abs() < 1e-3, "{height} {lowest}");
}

#[test]
fn the_result_does_not_depend_on_the_number_of_threads() {
    let robot = arm("[-1.0, 2.0]", "");
    let with = |threads| {
        let options = ExciteOptions { starts: 3, evaluations: 60, ..options() };
        let found = found(&robot, &ExciteOptions { threads: Some(threads), ..options });
        (found.best, found.to_json("found", &serde_json::json!({})).to_string())
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn every_family_and_objective_finds_something_better_than_its_starts() {
    let robot = arm("[-1.0, 2.0]", "");
    let families = [
        Family::Fourier { harmonics: 3 },
        Family::FreeFourier { terms: 3 },
        Family::Polynomial { degree: 9 },
        Family::Samples { knots: 9 },
    ];
    let scaled = Objective { is_scaled: true, ..Objective::CONDITION };
    let objectives = [Objective::CONDITION, Objective::D_OPTIMAL, Objective::BOTH, scaled];
    for (family, objective) in families.into_iter().zip(objectives) {
        let options = ExciteOptions { family, objective, starts: 1, ..options() };
        let found = found(&robot, &options);
        let start = found.found();
        let (began, ended) = (start.began.excitation, start.ended.excitation);
        assert!(start.ended.is_feasible(), "{family:?}: {:?}", start.ended);
        let columns = found.stack.names.len() as f64;
        let value = |of: Excitation| {
            let condition = if objective.is_scaled { of.condition_scaled } else { of.condition };
            objective.condition * condition.ln()
                - objective.determinant * of.log_determinant / columns
        };
        // a tenth of an e-fold
        assert!(value(ended) < value(began) - 0.1, "{family:?}: {began:?} {ended:?}");
        let (check, _) = check_trajectory(&robot, &options, &trajectory(&found)).expect("sound");
        assert!(check.is_feasible());
        assert!((check.excitation.condition / ended.condition - 1.0).abs() < 0.02);
    }
}

/// Thesis 3.3.3: from an infeasible start to a condition number of 747. Ours is of the columns of
/// table 3.6, with the ten of friction besides.
#[test]
fn tulips_leg_is_excited_from_an_infeasible_start_at_least_as_well_as_in_the_thesis() {
    let keep = "e6,c6x*m6,m6,e5,c5x*m5,e4,c4x*m4,e3,m3,I6y,I5z,I4z,I2y,I3y";
    let options = ExciteOptions {
        columns: Columns::Kept,
        keep: keep.split(',').map(str::to_owned).collect(),
        reach: 20.0,
        starts: 1,
        evaluations: 200,
        duration_s: 10.0,
        ..options()
    };
    let found = found(&shipped_robot("tulip_leg_table34"), &options);
    assert_eq!(found.stack.names.len(), 24);
    let start = found.found();
    assert!(start.began.limits.worst() > 10.0, "the start is infeasible");
    assert!(start.ended.is_feasible());
    assert!(start.ended.excitation.condition < 747.0, "{:?}", start.ended.excitation);
}

#[test]
fn what_held_joints_hide_is_left_out_and_named() {
    let robot = arm("[-1.0, 2.0]", "");
    let hold = vec![("link2".to_owned(), 0.5)];
    let found = found(&robot, &ExciteOptions { hold, starts: 1, evaluations: 40, ..options() });
    // one joint that moves: of its row an inertia and two moments, of the second row more
    assert!(!found.stack.left_out.is_empty());
    assert!(found.stack.left_out.iter().any(|name| name == "fc_link2"));
    assert!(found.found().ended.excitation.condition.is_finite());
    let file = found.to_json("held", &serde_json::json!({}));
    assert_eq!(file["joints"]["link2"], serde_json::json!(0.5));
}

#[test]
fn all_faults_are_found_at_once() {
    let robot = shipped_robot("planar_2r");
    let bad = ExciteOptions {
        duration_s: 0.0,
        hold: vec![("link3".to_owned(), 0.0)],
        weights: vec![("link1".to_owned(), -1.0)],
        ..options()
    };
    let error = excite(&robot, &bad, &|_| true).expect_err("nothing is right");
    let faults = error.faults();
    let position = Some(LimitKind::Position);
    for fault in [
        (ErrorKind::Options, None, None),
        (ErrorKind::UnknownJoint, Some("link3"), None),
        (ErrorKind::Limits, Some("link1"), position),
        (ErrorKind::Limits, Some("link2"), position),
        (ErrorKind::Options, Some("link1"), None),
    ] {
        let is_it = |one: &Error| (one.kind(), one.joint(), one.limit()) == fault;
        assert!(faults.iter().any(is_it), "{fault:?} is not in {error:?}");
    }
    assert_eq!(faults.len(), 5, "{error:?}");
    let said = error.to_string();
    for part in ["a duration of 0 s", "`link1` is meant, perhaps", "the weight -1 of `link1`"] {
        assert!(said.contains(part), "{part} is not in {said}");
    }
    let narrow = excite(&arm("[0.5, 0.5]", ""), &options(), &|_| true).expect_err("no room");
    assert_eq!(narrow.faults().len(), 1, "{narrow}");
    assert_eq!((narrow.joint(), narrow.limit()), (Some("link2"), position));
    assert!(narrow.to_string().contains("leaves it no room"), "{narrow}");
}

#[test]
fn where_no_posture_is_allowed_the_answer_is_infeasible() {
    let buried = TIP.replace("-0.6", "2");
    let robot = arm("[-1.0, 2.0]", &buried);
    let found = found(&robot, &ExciteOptions { starts: 1, evaluations: 40, ..options() });
    assert!(!found.found().ended.is_feasible());
    assert!(found.found().ended.limits.worst() > 1.0);
}

/// A robot that hangs by its floating base, 0.45 m above the ground, with a leg of 0.5 m: the foot
/// clears the ground only while the leg is lifted by 0.495 rad or more, which the search must keep
/// to, and which it would not without a clearance.
#[test]
fn a_foot_below_a_floating_base_keeps_off_the_ground() {
    let text = r#"{"format": "denavit-model/1", "name": "hopper", "convention": "standard",
        "gravity": [0, 0, -9.81], "base": {"type": "planar_floating", "body":
            {"mass": 5, "com": [0, 0, 0], "inertia": {"zz": 0.1}, "about": "com"}},
        "links": [{"name": "leg", "parent": "base",
            "joint": {"type": "revolute", "a": 0.5, "theta": "pi"},
            "limits": {"position": [0.1, 2.5], "velocity": 4, "acceleration": 20},
            "body": {"mass": 1, "com": [-0.2, 0, 0], "inertia": {"zz": 0.02}, "about": "com"}}],
        "drives": {"leg": {"viscous": 0.1}},
        "contacts": [{"name": "foot", "link": "leg", "position": [0, 0, 0]}]}"#;
    let robot = model::read("hopper.json", text.as_bytes()).expect("a sound model");
    let lowest = |clearance_m: Option<f64>| {
        let hold = vec![("base_z".to_owned(), 0.45)];
        let found = found(&robot, &ExciteOptions { clearance_m, hold, ..options() });
        let file = trajectory(&found);
        let leg = file.find("leg").expect("it moves");
        let angles = (0..4001).map(|k| leg.at(0.001 * f64::from(k)).position);
        let lowest = angles.map(|q| 0.45 - 0.5 * q.cos()).fold(f64::INFINITY, f64::min);
        (lowest, found.found().ended.is_feasible(), found.found().ended.limits.lowest.clone())
    };
    let (height, is_feasible, told) = lowest(Some(0.01));
    assert!(is_feasible && height >= 0.01 - 1e-6, "{height}");
    let (point, seen) = told.expect("it has a foot");
    assert!(point == "foot" && (seen - height).abs() < 1e-3, "{seen} {height}");
    let (height, _, _) = lowest(None);
    assert!(height < -0.01, "{height}");
}

/// A solver that is broken off may be at a worse place than it was: what is answered is the best.
#[test]
fn few_evaluations_end_nowhere_worse_than_they_began() {
    let robot = arm("[-1.0, 2.0]", TIP);
    let mut began_within = 0;
    for seed in 0..12 {
        for evaluations in [2, 5, 9] {
            let few = ExciteOptions { starts: 1, evaluations, seed, reach: 0.5, ..options() };
            let found = found(&robot, &few);
            let start = found.found();
            if start.began.is_feasible() {
                began_within += 1;
                assert!(start.ended.is_feasible(), "{seed} {evaluations}");
                let [began, ended] = [&start.began, &start.ended];
                let [began, ended] = [began, ended].map(|one| one.excitation.condition);
                assert!(ended <= began * (1.0 + 1e-9), "{seed} {evaluations}: {began} {ended}");
            } else {
                assert!(
                    start.ended.limits.worst() <= start.began.limits.worst(),
                    "{seed} {evaluations}"
                );
            }
        }
    }
    assert!(began_within > 0, "no start is within the limits");
}
