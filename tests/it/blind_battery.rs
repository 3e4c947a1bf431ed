//! The blind battery's own physics, against another engine's numbers and laws of mechanics; its
//! files, against the program that reads them.

use denavit::model;
use denavit::plants::{LoadedPlant, Plant as _};
use denavit_blind::battery::{answer, examine, report, reported, suite};
use denavit_blind::case::Case;
use denavit_blind::design::{Kind, ROWS, plan};
use denavit_blind::filter::LowPass;
use denavit_blind::hidden::{Hidden, Law, Shape, TABLE};
use denavit_blind::laws::Moment;
use denavit_blind::nominal::{Motion, Nominal};
use denavit_blind::plant::{Plant, Transmission};
use denavit_blind::random::Random;
use denavit_blind::rigid::{Body, MOST, Posture, Row};
use denavit_blind::robots::{ROBOTS, robot};
use denavit_blind::score::{Answer, Named, binomial_interval, score};
use nalgebra::{Matrix3, Vector3};
use serde_json::Value;
use std::collections::BTreeSet;

fn numbers(value: &Value) -> Vec<f64> {
    let list = value.as_array().expect("a list");
    list.iter().map(|number| number.as_f64().expect("a number")).collect()
}

fn engine_row(row: &Value, link: &Value) -> Row {
    let inertia: Vec<Vec<f64>> =
        link["inertia_com"].as_array().expect("rows").iter().map(numbers).collect();
    Row {
        a: row["a"].as_f64().expect("a length"),
        alpha: row["alpha_quarter_turns"].as_i64().expect("turns") as i32,
        d: row["d"].as_f64().expect("a length"),
        theta: row["theta_offset_quarter_turns"].as_i64().expect("turns") as i32,
        body: Body {
            mass: link["mass"].as_f64().expect("a mass"),
            com: Vector3::from_vec(numbers(&link["com"])),
            inertia: Matrix3::from_fn(|row, column| inertia[row][column]),
        },
    }
}

#[test]
fn numeric_dynamics_are_those_of_another_engine() {
    let text = include_str!("../oracles/engine_values.json");
    let robots: Vec<Value> = serde_json::from_str(text).expect("JSON");
    let mut compared = 0;
    for robot in &robots {
        let rows = robot["dh"].as_array().expect("rows");
        if rows.iter().any(|row| row["type"] != "R") {
            continue;
        }
        let links = robot["links"].as_array().expect("links");
        let rows: Vec<Row> = rows.iter().zip(links).map(|(r, l)| engine_row(r, l)).collect();
        let fall = Vector3::from_vec(numbers(&robot["gravity"]));
        for sample in robot["samples"].as_array().expect("samples") {
            let [q, qd, qdd, tau] = ["q", "qd", "qdd", "tau"].map(|key| numbers(&sample[key]));
            let posture = Posture::new(&rows, &q);
            let mut torques = vec![0.0; q.len()];
            posture.torques(&qd, &qdd, &fall, &mut torques);
            for (found, expected) in torques.iter().zip(&tau) {
                assert!((found - expected).abs() < 1e-10, "{}: {found}, {expected}", robot["name"]);
            }
            // D qdd + C qd + G is the same torque
            let mut matrix = [[0.0; MOST]; MOST];
            posture.mass_matrix(&mut matrix);
            let mut bias = vec![0.0; q.len()];
            posture.torques(&qd, &vec![0.0; q.len()], &fall, &mut bias);
            for joint in 0..q.len() {
                let inertial: f64 = matrix[joint].iter().zip(&qdd).map(|(d, a)| d * a).sum();
                assert!((inertial + bias[joint] - tau[joint]).abs() < 1e-10);
            }
            compared += 1;
        }
    }
    assert!(compared >= 12, "{compared} states");
}

#[test]
fn files_say_what_the_plants_are_made_of() {
    let mut random = Random::new(7, "states");
    for number in 0..ROBOTS.len() {
        let robot = robot(number);
        let whole = Nominal::draw(&robot, true, &mut random);
        let nominal = Nominal { relative_std: 0.05, ..whole };
        let text = nominal.file().to_string();
        let read = model::read(robot.name, text.as_bytes()).expect("a sound file");
        let mut plant = LoadedPlant::new(&read, &[]).expect("a plant");
        let count = robot.joints.len();
        let mut draw = || (0..count).map(|_| random.normal()).collect::<Vec<_>>();
        let (q, qd) = (draw(), draw());
        let mut expected = vec![0.0; nominal.equations()];
        let rest = vec![0.0; count];
        let motion = Motion {
            q: &q,
            qd: &qd,
            qdd: &rest,
            motor: &q,
            motor_rate: &qd,
            motor_acceleration: &rest,
        };
        nominal.smooth_torques(&motion, &mut expected);
        let mut found = vec![0.0; count];
        plant.bias(&q, &qd, &mut found);
        for joint in 0..count {
            // of elastic joints friction stands in the drive
            let elastic = robot.joints[joint].drive.spring.is_some();
            let viscous = if elastic { robot.joint_side(joint)[1] * qd[joint] } else { 0.0 };
            let missed = found[joint] + viscous - expected[joint];
            assert!(missed.abs() < 1e-9, "{} {joint}: off by {missed}", robot.name);
        }
    }
}

/// A wheel on a vertical axis: nothing but its inertia of 0.5 kg m^2 and friction.
fn wheel(coulomb: f64, hidden: Vec<Hidden>) -> Plant {
    let inertia = Matrix3::identity() * 0.3;
    let body = Body { mass: 1.0, com: Vector3::zeros(), inertia };
    Plant {
        rows: vec![Row { a: 0.0, alpha: 0, d: 0.0, theta: 0, body }],
        fall: Vector3::new(0.0, 0.0, -9.81),
        rotor: vec![0.2],
        viscous: vec![0.0],
        coulomb: vec![coulomb],
        transmissions: Vec::new(),
        hidden,
        seed: 0.0,
    }
}

#[test]
fn dry_friction_stops_and_holds() {
    let plant = wheel(0.4, Vec::new());
    let mut state = plant.start(0.0, &[0.0], &[2.0]);
    for _ in 0..12_000 {
        plant.step(&mut state, &[0.0], 2.5e-4);
    }
    // q = v^2 I / (2 Fc)
    assert!((state.y[0] - 2.5).abs() < 1e-3, "stopped at {}", state.y[0]);
    let stopped = state.y[0];
    for _ in 0..4_000 {
        plant.step(&mut state, &[0.39], 2.5e-4);
    }
    assert_eq!(state.y[0], stopped, "held against less than its friction");
    for _ in 0..4_000 {
        plant.step(&mut state, &[0.9], 2.5e-4);
    }
    // one second of (0.9 - 0.4) / 0.5 rad/s^2
    assert!((state.y[0] - stopped - 0.5).abs() < 1e-3);
}

#[test]
fn stiction_lets_go_at_its_own_level() {
    let shape = Shape { rate: 1.0, torque: 1.0, reach: 1.0, ..Shape::default() };
    let stiction = Hidden { law: Law::Stiction, variant: 1, joint: 0, other: 0, size: 0.3, shape };
    let plant = wheel(0.4, vec![stiction]);
    let mut state = plant.start(0.0, &[0.0], &[0.0]);
    for _ in 0..400 {
        plant.step(&mut state, &[0.69], 2.5e-4);
    }
    assert_eq!(state.y[0], 0.0);
    for _ in 0..4_000 {
        plant.step(&mut state, &[0.71], 2.5e-4);
    }
    // once it slides, 0.4 of 0.71 are lost
    assert!((state.y[0] - 0.5 * 0.31 / 0.5).abs() < 1e-3, "{}", state.y[0]);
}

#[test]
fn energy_is_kept_without_friction() {
    for number in 0..ROBOTS.len() {
        let robot = robot(number);
        let count = robot.joints.len();
        let transmissions = (0..count).filter_map(|joint| {
            let spring = robot.joints[joint].drive.spring?;
            let stiffness = spring.stiffness * spring.radius * spring.radius;
            Some(Transmission { joint, stiffness, damping: 0.0, play: 0.0, soft: false })
        });
        let plant = Plant {
            rows: robot.rows(),
            fall: robot.fall,
            rotor: (0..count).map(|joint| robot.joint_side(joint)[0]).collect(),
            viscous: vec![0.0; count],
            coulomb: vec![0.0; count],
            transmissions: transmissions.collect(),
            hidden: Vec::new(),
            seed: 0.0,
        };
        let q: Vec<f64> = robot.joints.iter().map(|joint| joint.range.middle).collect();
        let mut state = plant.start(0.0, &q, &vec![0.7; count]);
        let before = plant.energy(&state);
        for _ in 0..4_000 {
            plant.step(&mut state, &vec![0.0; count], 2.5e-4);
        }
        let change = plant.energy(&state) - before;
        assert!(change.abs() < 1e-7 * before.abs().max(1.0), "{}: {change}", robot.name);
    }
}

#[test]
fn the_filter_is_half_at_its_cutoff() {
    let filter = LowPass::new(20.0, 0.002);
    let wave = |hz: f64| -> Vec<f64> {
        (0..4_000).map(|k| (std::f64::consts::TAU * hz * 0.002 * f64::from(k)).sin()).collect()
    };
    for (hz, expected) in [(1.0, 1.0), (20.0, 0.5), (40.0, 1.0 / 257.0)] {
        let (before, after) = (wave(hz), filter.apply(&wave(hz)));
        let dot = |a: &[f64], b: &[f64]| -> f64 {
            a[1000..3000].iter().zip(&b[1000..3000]).map(|(a, b)| a * b).sum()
        };
        let gain = dot(&before, &after) / dot(&before, &before);
        // the bilinear transform bends frequencies above the cutoff a little
        assert!((gain - expected).abs() < 2e-3, "{hz} Hz: {gain}");
    }
}

#[test]
fn intervals_are_those_of_the_tables() {
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-4, "{found}");
    // none of 150: 1 - 0.025^(1/150); 9 of 10: Clopper and Pearson's 0.5550 .. 0.9975
    near(binomial_interval(0, 150)[1], 1.0 - 0.025_f64.powf(1.0 / 150.0));
    near(binomial_interval(9, 10)[0], 0.5550);
    near(binomial_interval(9, 10)[1], 0.9975);
}

#[test]
fn the_design_is_what_it_says() {
    let plans: Vec<_> = (0..ROWS as u64).map(plan).collect();
    let count = |kind: Kind| plans.iter().filter(|plan| plan.kind == kind).count();
    assert!(plans.len() >= 500);
    assert_eq!(count(Kind::Nothing), 150);
    let alone: BTreeSet<Law> =
        plans.iter().filter(|plan| plan.kind == Kind::Single).map(|plan| plan.laws[0]).collect();
    let named = TABLE.iter().filter(|entry| !entry.name.is_empty()).count();
    // forces that no sensor sees are there to be refused
    assert_eq!(alone.len(), named - 1);
    let pairs: BTreeSet<Vec<Law>> =
        plans.iter().filter(|plan| plan.kind == Kind::Pair).map(|plan| plan.laws.clone()).collect();
    assert_eq!(pairs.len(), 10);
    for robot in 0..ROBOTS.len() {
        let singles = plans.iter().filter(|plan| plan.kind == Kind::Single && plan.robot == robot);
        assert!(singles.count() >= 40, "{}", ROBOTS[robot]);
    }
    let choice = |plan: &&denavit_blind::design::Plan| {
        plan.kind == Kind::Single && plan.laws[0].entry().variants > 1
    };
    let other = plans.iter().filter(choice).filter(|plan| plan.variants[0] > 0).count();
    let share = other as f64 / plans.iter().filter(choice).count() as f64;
    assert!((0.25..0.45).contains(&share), "{share} follow another law");
}

/// The first tuning case with one effect of this law on a robot.
fn first(law: Law, robot: usize) -> u64 {
    let fits = |number: &u64| {
        let plan = plan(*number);
        plan.kind == Kind::Single && plan.laws[0] == law && plan.robot == robot
    };
    (0..1000).find(fits).expect("such a case")
}

#[test]
fn a_case_is_its_number_and_reaches_its_strength() {
    for law in [Law::Coulomb, Law::ReturnSpring] {
        let number = (0..6).map(|robot| first_or_none(law, robot)).find_map(|found| found);
        let number = number.expect("a small robot");
        let one = Case::new(number).generate();
        let two = Case::new(number).generate();
        assert_eq!(one.answer(), two.answer());
        assert_eq!(one.train.tau, two.train.tau);
        assert_eq!(one.validate.q, two.validate.q);
        let reached = one.strengths[0] / one.case.target;
        assert!((0.9..1.1).contains(&reached), "{law:?}: {reached} of the strength");
    }
}

fn first_or_none(law: Law, robot: usize) -> Option<u64> {
    (0..1000).find(|number| {
        let plan = plan(*number);
        plan.kind == Kind::Single && plan.laws[0] == law && plan.robot == robot && robot < 2
    })
}

#[test]
fn scores_know_right_from_wrong() {
    let number = (0..1000).find(|number| {
        let plan = plan(*number);
        plan.kind == Kind::Single && plan.laws[0] == Law::Coulomb && plan.robot == 1
    });
    let generated = Case::new(number.unwrap_or_else(|| first(Law::Coulomb, 0))).generate();
    let hidden = &generated.case.hidden[0];
    let joint = generated.case.truth.joints[hidden.joint].name.to_owned();
    let named = |name: &str, joint: &str| Named {
        name: name.to_owned(),
        joint: Some(joint.to_owned()),
        ..Named::default()
    };
    let says = |effects: Vec<Named>| {
        let verdict = "explained".to_owned();
        score(&generated, &Answer { verdict, effects, closed: Some(1.0) })
    };
    let right = says(vec![named("coulomb", &joint)]);
    assert!(right.right && right.unambiguous == 1 && right.closed == Some(1.0));
    assert!(!says(vec![named("viscous", &joint)]).right);
    assert!(!says(vec![named("coulomb", "nowhere")]).right);
    let more = says(vec![named("coulomb", &joint), named("cogging", &joint)]);
    assert!(more.found == 1 && more.false_names == 1 && !more.right);
    let mut vague = named("viscous", &joint);
    let at = |joint: &str| ("coulomb".to_owned(), Some(joint.to_owned()));
    vague.others = vec![at(&joint)];
    let seen = says(vec![vague.clone()]);
    assert!(seen.right && seen.unambiguous == 0);
    vague.others = vec![at("nowhere")];
    assert!(!says(vec![vague.clone()]).right, "the right name elsewhere");
    vague.others = vec![at(&joint), at("nowhere"), at("elsewhere")];
    assert!(!says(vec![vague]).right, "four names");
}

/// Torque of a law with states after sliding at a rate for a distance.
fn after_sliding(hidden: &Hidden, rate: f64, distance: f64) -> f64 {
    let mut z = vec![0.0; hidden.states()];
    let mut dz = z.clone();
    let rates = [rate];
    let at = Moment {
        t: 0.0,
        q: &[0.0],
        qd: &rates,
        motor_rate: &rates,
        load: &[0.0],
        coulomb: &[0.0],
        viscous: &[0.0],
    };
    let steps = 20_000;
    let step_s = distance / rate.abs() / f64::from(steps);
    for _ in 0..steps {
        hidden.rates(&at, &z, &mut dz);
        z.iter_mut().zip(&dz).for_each(|(z, dz)| *z += step_s * dz);
    }
    hidden.rates(&at, &z, &mut dz);
    hidden.smooth(&at, &z, &dz)
}

#[test]
fn friction_with_memory_becomes_coulombs_in_steady_sliding() {
    let shape = Shape { rate: 1.0, torque: 1.0, reach: 1.0, ..Shape::default() };
    for (law, variant) in
        [(Law::Dahl, 0), (Law::Dahl, 1), (Law::MaxwellSlip, 0), (Law::MaxwellSlip, 1)]
    {
        let hidden = Hidden { law, variant, joint: 0, other: 0, size: 0.7, shape };
        for rate in [0.3, -0.3] {
            let found = after_sliding(&hidden, rate, 1.0);
            // with the exponent 2 the last of it comes slowly: 1 - 1 / (1 + distance / width)
            let last = if (law, variant) == (Law::MaxwellSlip, 1) {
                1.0 / (1.0 + 1.0 / 0.03)
            } else {
                0.0
            };
            let expected = 0.7 * f64::signum(rate) * (1.0 - last);
            assert!((found - expected).abs() < 0.003, "{law:?}/{variant}: {found}");
        }
        // a hundredth of a millimetre of sliding is elastic
        assert!(after_sliding(&hidden, 0.3, 1e-5).abs() < 1e-3);
    }
    // Stribeck's curve of LuGre: from 1.6 times at rest to once when fast
    let hidden = Hidden { law: Law::LuGre, variant: 0, joint: 0, other: 0, size: 0.7, shape };
    assert!((after_sliding(&hidden, 1e-3, 1.0) - 1.6 * 0.7).abs() < 0.01);
    assert!((after_sliding(&hidden, 1.0, 2.0) - 0.7).abs() < 0.01);
}

#[test]
fn a_cable_on_a_post_follows_eulers_belt() {
    let shape = Shape { rate: 1.0, torque: 1.0, reach: 1.0, ..Shape::default() };
    let cable = Hidden { law: Law::Capstan, variant: 0, joint: 0, other: 0, size: 0.1, shape };
    let dry = |q: f64, direction: f64, load: f64| {
        let at = Moment {
            t: 0.0,
            q: &[q],
            qd: &[direction],
            motor_rate: &[direction],
            load: &[load],
            coulomb: &[0.0],
            viscous: &[0.0],
        };
        cable.dry(&at, direction, &[])[0]
    };
    // half a turn in the middle, 1.6 times that at the end of the reach
    let (pulls, slackens) = (5.0 + dry(0.0, 1.0, 5.0), 5.0 - dry(0.0, -1.0, 5.0));
    assert!((pulls / 5.0 - (0.1 * std::f64::consts::PI).exp()).abs() < 1e-12);
    assert!((pulls * slackens / 25.0 - 1.0).abs() < 1e-12, "one way undoes the other");
    let far = 5.0 + dry(1.0, 1.0, 5.0);
    assert!((far / 5.0 - (0.16 * std::f64::consts::PI).exp()).abs() < 1e-12);
}

#[test]
fn the_suite_has_every_kind_and_no_reported_case() {
    let numbers = suite();
    assert_eq!(numbers.iter().collect::<BTreeSet<_>>().len(), 31);
    assert!(numbers.iter().all(|number| *number < 1000));
    assert!(reported().all(|number| !numbers.contains(&number)));
    let kinds =
        [Kind::Single, Kind::Pair, Kind::Nothing, Kind::Outside, Kind::CannotTell, Kind::Thesis];
    for kind in kinds {
        assert!(numbers.iter().any(|number| plan(*number).kind == kind), "{kind:?}");
    }
}

#[test]
fn a_diagnosis_gets_the_files_and_not_the_answer() {
    let folder = std::env::temp_dir().join(format!("denavit-blind-{}", std::process::id()));
    let nothing = (0..1000).find(|number| {
        let plan = plan(*number);
        plan.kind == Kind::Nothing && plan.robot == 0
    });
    let number = nothing.expect("a pendulum without an effect");
    let says = |verdict: &str, effects: Value| {
        let said = serde_json::json!({"verdict": verdict, "effects": effects});
        examine(number, &folder, |files| {
            for file in [files.model, files.train, files.validate] {
                assert!(file.is_file(), "{}", file.display());
            }
            let sealed = files.model.with_file_name("answer.json");
            let _ = std::fs::remove_file(&sealed);
            answer(&said)
        })
        .expect("files")
    };
    let right = says("nothing_missing", serde_json::json!([]));
    assert!(right.right);
    let effects = serde_json::json!([{
        "effect": "cogging",
        "at": {"link": "rod"},
        "parameters": {"a": {"value": 1.0, "std": 0.1}},
        "indistinguishable": ["transmission_error"],
    }]);
    let wrong = says("explained", effects);
    assert!(!wrong.right && wrong.false_names == 1 && wrong.said == ["cogging"]);
    let text = report(&[right, wrong]);
    assert!(text.contains("| nothing hidden: false discoveries | 1 | 2 | 50.0 %"), "{text}");
    assert!(text.contains("| nothing | cogging | 1 |"), "{text}");
    std::fs::remove_dir_all(&folder).expect("the folder was made");
}
