//! Effects of whole robots, and robots that have effects.

use denavit_codegen::derive::{Derivation, Flavour, derive};
use denavit_codegen::effect::{find, read_model};
use denavit_codegen::expr::{Floats, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{EffectPlace, LinkId, Robot};
use denavit_plants::effect::{Moves, RobotEffect};
use denavit_plants::shipped;
use std::collections::BTreeMap;

fn text(name: &str) -> String {
    shipped::find(name).expect("shipped").text.to_owned()
}

fn robot(text: &str) -> Robot {
    read_model("model.json", text.as_bytes(), &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// The model with effects in its file.
fn with_effects(name: &str, effects: &str) -> Robot {
    robot(&text(name).replacen("\"links\"", &format!("\"effects\": {effects}, \"links\""), 1))
}

/// Motions of all joints: q, qd, qdd, a column for each joint.
fn motion(joints: usize, samples: usize) -> [Vec<Vec<f64>>; 3] {
    let column = |row: usize, joint: usize| -> Vec<f64> {
        let (row, joint) = (row as f64, joint as f64);
        (0..samples).map(|k| (1.3 * k as f64 + 0.7 * joint + 2.1 * row + 0.3).sin()).collect()
    };
    [0, 1, 2].map(|row| (0..joints).map(|joint| column(row, joint)).collect())
}

fn slices(columns: &[Vec<f64>]) -> Vec<&[f64]> {
    columns.iter().map(Vec::as_slice).collect()
}

/// A function of a derived robot at one sample, with `more` for symbols beside q, qd, qdd.
fn values_of(
    derivation: &Derivation,
    function: FunctionName,
    [q, qd, qdd]: &[Vec<Vec<f64>>; 3],
    sample: usize,
    more: &BTreeMap<String, f64>,
) -> Vec<f64> {
    let found = derivation.functions.iter().find(|known| known.name == function);
    let entries = found.expect("derived").entries();
    let robot = &derivation.robot;
    let mut values = more.clone();
    for (row, (link, _)) in robot.joints().enumerate() {
        let name = &robot.links[link].name;
        for (prefix, columns) in [("q", q), ("qd", qd), ("qdd", qdd)] {
            values.insert(format!("{prefix}_{name}"), columns[row][sample]);
        }
    }
    let mut ring = Floats::new(|symbol: &str| values.get(symbol).copied());
    evaluate(&derivation.dag, &entries, &mut ring).expect("numbers")
}

fn derived(robot: &Robot, functions: &[FunctionName]) -> Derivation {
    derive(robot, Flavour::Baked, functions).expect("values")
}

/// Torques of inverse dynamics without friction, of every joint at one sample.
fn rigid_torques(robot: &Robot, motion: &[Vec<Vec<f64>>; 3], sample: usize) -> Vec<f64> {
    let mut robot = robot.clone();
    robot.terms.friction = false;
    robot.terms.rotor = false;
    let derivation = derived(&robot, &[FunctionName::InverseDynamics]);
    values_of(&derivation, FunctionName::InverseDynamics, motion, sample, &BTreeMap::new())
}

fn assert_near(found: f64, expected: f64, what: &str) {
    let scale = 1.0 + expected.abs();
    assert!((found - expected).abs() < 1e-9 * scale, "{what}: {found} is not {expected}");
}

#[test]
fn neglected_coriolis_torques_are_those_of_the_christoffel_matrix() {
    let robot = robot(&text("puma560"));
    let effect = find("coriolis").expect("shipped");
    let found = RobotEffect::new(&robot, effect, EffectPlace::Model, &[]).expect("an effect");
    let motion = motion(6, 5);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    let torque = found.torques([&q, &qd, &qdd], &[], &[], &Moves::none(q.len())).torque;
    let derivation = derived(&robot, &[FunctionName::CoriolisMatrix]);
    for sample in 0..5 {
        let more = BTreeMap::new();
        let c = values_of(&derivation, FunctionName::CoriolisMatrix, &motion, sample, &more);
        for joint in 0..6 {
            let expected: f64 = (0..6).map(|k| c[6 * joint + k] * qd[k][sample]).sum();
            assert_near(torque[joint][sample], expected, "C qd");
        }
    }
}

#[test]
fn a_tilted_base_is_gravity_of_another_direction_for_the_masses_of_the_moment() {
    let robot = robot(&text("puma560"));
    let effect = find("base_tilt").expect("shipped");
    let (third, _) = robot.joints().nth(2).expect("a joint");
    let mass = robot.links[third].body.as_ref().expect("a body").mass;
    let named = robot.parameters.values().find(|one| one.symbol == mass).expect("a parameter");
    let numbers = [named.name.clone()];
    let found = RobotEffect::new(&robot, effect, EffectPlace::Model, &numbers).expect("an effect");
    let (a, b) = (0.3_f64, -0.2_f64);
    // gravity (0, 0, -g), turned about x by a and then about y by b
    let g = 9.81;
    let turned = [-g * a.cos() * b.sin(), g * a.sin(), -g * a.cos() * b.cos()];
    let heavy = 7.1;
    let mut file: serde_json::Value = serde_json::from_str(&text("puma560")).expect("JSON");
    assert_eq!(file["gravity"], serde_json::json!([0, 0, "-g"]));
    let link = file["links"].as_array_mut().expect("links").iter_mut();
    let name = &robot.links[third].name;
    let mut links = link.filter(|link| link["name"] == name.as_str());
    links.next().expect("the link")["body"]["mass"] = serde_json::json!(heavy);
    let upright = self::robot(&file.to_string());
    file["gravity"] = serde_json::json!(turned.map(|entry| format!("{entry}")));
    let tilted = self::robot(&file.to_string());
    let motion = motion(6, 4);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    let torque = found.torques([&q, &qd, &qdd], &[a, b], &[heavy], &Moves::none(q.len())).torque;
    for sample in 0..4 {
        let with = rigid_torques(&tilted, &motion, sample);
        let without = rigid_torques(&upright, &motion, sample);
        for joint in 0..6 {
            assert_near(torque[joint][sample], with[joint] - without[joint], "tilt");
        }
    }
}

#[test]
fn a_payload_is_a_body_fixed_in_its_link() {
    let robot = robot(&text("puma560"));
    let (tip, link) = robot.links.iter().last().expect("a link");
    let (mass, c) = (1.7, [0.05, -0.02, 0.11]);
    let central = [0.004, 0.003, 0.002];
    let mut file: serde_json::Value = serde_json::from_str(&text("puma560")).expect("JSON");
    file["links"].as_array_mut().expect("links").push(serde_json::json!({
        "name": "load", "parent": link.name, "joint": {"type": "fixed"},
        "body": {"mass": mass, "com": c, "about": "com",
            "inertia": {"xx": central[0], "yy": central[1], "zz": central[2]}}
    }));
    let loaded = self::robot(&file.to_string());
    let square: f64 = c.iter().map(|x| x * x).sum();
    // about the origin: J + m (c.c 1 - c c^T)
    let mut values = vec![mass, mass * c[0], mass * c[1], mass * c[2]];
    values.extend((0..3).map(|i| central[i] + mass * (square - c[i] * c[i])));
    values.extend([(0, 1), (0, 2), (1, 2)].map(|(i, j): (usize, usize)| -mass * c[i] * c[j]));
    let effect = find("payload").expect("shipped");
    let found = RobotEffect::new(&robot, effect, EffectPlace::Link(tip), &[]).expect("an effect");
    let motion = motion(6, 4);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    let torque = found.torques([&q, &qd, &qdd], &values, &[], &Moves::none(q.len())).torque;
    for sample in 0..4 {
        let with = rigid_torques(&loaded, &motion, sample);
        let without = rigid_torques(&robot, &motion, sample);
        for joint in 0..6 {
            assert_near(torque[joint][sample], with[joint] - without[joint], "payload");
        }
    }
}

#[test]
fn gradients_of_whole_robots_are_those_of_differences_and_nominal_is_nothing() {
    let robot = robot(&text("puma560"));
    let (link, _) = robot.joints().nth(2).expect("a joint");
    let motion = motion(6, 3);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    for (name, at) in [
        ("payload", EffectPlace::Link(link)),
        ("payload_point", EffectPlace::Link(link)),
        ("link_parameters", EffectPlace::Link(link)),
        ("joint_zero", EffectPlace::Link(link)),
        ("base_tilt", EffectPlace::Model),
    ] {
        let effect = find(name).expect("shipped");
        let found = RobotEffect::new(&robot, effect, at, &[]).expect("an effect");
        let nominal: Vec<f64> = found.parameters.iter().map(|p| p.nominal.unwrap_or(0.4)).collect();
        let nothing = found.torques([&q, &qd, &qdd], &nominal, &[], &Moves::none(q.len())).torque;
        assert!(nothing.iter().flatten().all(|torque| torque.abs() < 1e-10), "{name}");
        let values: Vec<f64> = (0..nominal.len()).map(|i| 0.2 + 0.05 * i as f64).collect();
        let gradient = found.torques([&q, &qd, &qdd], &values, &[], &Moves::none(q.len())).gradient;
        for parameter in 0..values.len() {
            let side = |step: f64| {
                let mut moved = values.clone();
                moved[parameter] += step;
                found.torques([&q, &qd, &qdd], &moved, &[], &Moves::none(q.len())).torque
            };
            let (above, below) = (side(1e-5), side(-1e-5));
            for joint in 0..6 {
                for k in 0..3 {
                    let difference = (above[joint][k] - below[joint][k]) / 2e-5;
                    let slope = gradient[parameter][joint][k];
                    let scale = 1.0 + difference.abs();
                    assert!((difference - slope).abs() < 1e-5 * scale, "{name}: {parameter}");
                }
            }
        }
    }
}

#[test]
fn effects_beside_each_other_add_up_to_what_they_do_together() {
    let effects = r#"[{"effect": "base_tilt", "at": "model",
        "parameters": {"about_x": 0.3, "about_y": -0.2}},
        {"effect": "joint_zero", "at": {"link": "second"}, "parameters": {"dq": 0.4}},
        {"effect": "joint_zero", "at": {"link": "third"}, "parameters": {"dq": -0.3}},
        {"effect": "payload_point", "at": {"link": "third"},
        "parameters": {"mass": 2.5, "cx": 0.1, "cy": 0.05, "cz": -0.2}}]"#;
    let plain = robot(&text("puma560"));
    let links: Vec<LinkId> = plain.joints().map(|(link, _)| link).collect();
    let name = |joint: usize| &plain.links[links[joint]].name;
    let effects = effects.replace("second", name(1)).replace("third", name(2));
    let together = with_effects("puma560", &effects);
    let motion = motion(6, 4);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    let all: Vec<(RobotEffect, Vec<f64>)> = [
        ("base_tilt", EffectPlace::Model, vec![0.3, -0.2]),
        ("joint_zero", EffectPlace::Link(links[1]), vec![0.4]),
        ("joint_zero", EffectPlace::Link(links[2]), vec![-0.3]),
        ("payload_point", EffectPlace::Link(links[2]), vec![2.5, 0.1, 0.05, -0.2]),
    ]
    .into_iter()
    .map(|(effect, at, values)| {
        let effect = RobotEffect::new(&plain, find(effect).expect("shipped"), at, &[]);
        (effect.expect("an effect"), values)
    })
    .collect();
    let mut beside = Moves::none(6);
    for (effect, values) in &all {
        let own = effect.moves(values, &[]);
        let both = beside.gravity.iter_mut().chain(&mut beside.zeros);
        both.zip(own.gravity.iter().chain(&own.zeros)).for_each(|(sum, more)| *sum += more);
    }
    let mut sum = vec![vec![0.0; 4]; 6];
    for (effect, values) in &all {
        let torque = effect.torques([&q, &qd, &qdd], values, &[], &beside).torque;
        let both = sum.iter_mut().flatten().zip(torque.iter().flatten());
        both.for_each(|(sum, more)| *sum += more);
    }
    assert_eq!(beside.zeros, [0.0, 0.4, -0.3, 0.0, 0.0, 0.0]);
    for sample in 0..4 {
        let with = rigid_torques(&together, &motion, sample);
        let without = rigid_torques(&plain, &motion, sample);
        for joint in 0..6 {
            assert_near(sum[joint][sample], with[joint] - without[joint], "together");
        }
    }
}

#[test]
fn slopes_by_parameters_that_are_called_linear_do_not_depend_on_these() {
    let robot = robot(&text("puma560"));
    let (link, _) = robot.joints().nth(2).expect("a joint");
    let motion = motion(6, 3);
    let [q, qd, qdd] = [0, 1, 2].map(|row| slices(&motion[row]));
    for (name, at, linear) in [
        ("payload", EffectPlace::Link(link), 10),
        ("payload_point", EffectPlace::Link(link), 1),
        ("joint_zero", EffectPlace::Link(link), 0),
        ("base_tilt", EffectPlace::Model, 0),
    ] {
        let effect = find(name).expect("shipped");
        let found = RobotEffect::new(&robot, effect, at, &[]).expect("an effect");
        assert_eq!(found.parameters.iter().filter(|one| one.linear).count(), linear, "{name}");
        let [slopes, others] = [0.0, 0.3].map(|more| {
            let of = |linear: bool| if linear { 0.2 + more } else { 0.2 };
            let values: Vec<f64> = found.parameters.iter().map(|one| of(one.linear)).collect();
            found.torques([&q, &qd, &qdd], &values, &[], &Moves::none(q.len())).gradient
        });
        for (place, _) in found.parameters.iter().enumerate().filter(|(_, one)| one.linear) {
            let both = slopes[place].iter().flatten().zip(others[place].iter().flatten());
            both.for_each(|(one, other)| assert_near(*one, *other, name));
        }
    }
}

#[test]
fn a_law_of_rates_is_part_of_every_function() {
    let effects = r#"[{"effect": "stribeck", "at": {"link": "upper_arm"},
        "parameters": {"fs": 0.7, "vs": 0.4}},
        {"effect": "rotor_inertia", "at": {"link": "shoulder"}, "parameters": {"ia": 0.3}}]"#;
    let names: Vec<String> =
        robot(&text("planar_2r")).links.values().map(|link| link.name.clone()).collect();
    let effects = effects.replace("shoulder", &names[0]).replace("upper_arm", &names[1]);
    let plain = robot(&text("planar_2r"));
    let with = with_effects("planar_2r", &effects);
    let functions = [
        FunctionName::InverseDynamics,
        FunctionName::Bias,
        FunctionName::MassMatrix,
        FunctionName::ForwardDynamics,
        FunctionName::InverseDynamicsDerivatives,
    ];
    let (plain, with) = (derived(&plain, &functions), derived(&with, &functions));
    let motion = motion(2, 3);
    for sample in 0..3 {
        let of = |derivation: &Derivation, function| {
            let mut more = BTreeMap::new();
            more.extend(names.iter().zip([1.5, -0.8]).map(|(n, tau)| (format!("tau_{n}"), tau)));
            values_of(derivation, function, &motion, sample, &more)
        };
        let v = motion[1][1][sample];
        let friction = 0.7 * (-(v / 0.4).powi(2)).exp() * v.signum();
        let added = |function| -> Vec<f64> {
            let pairs = of(&with, function).into_iter().zip(of(&plain, function));
            pairs.map(|(with, plain)| with - plain).collect()
        };
        let torque = added(FunctionName::InverseDynamics);
        assert_near(torque[0], 0.3 * motion[2][0][sample], "rotor");
        assert_near(torque[1], friction, "Stribeck");
        assert_near(added(FunctionName::Bias)[1], friction, "bias");
        assert_near(added(FunctionName::MassMatrix)[0], 0.3, "D");
        // D qdd + bias is the torque that was given
        let (d, bias) = (of(&with, FunctionName::MassMatrix), of(&with, FunctionName::Bias));
        let qdd = of(&with, FunctionName::ForwardDynamics);
        for (joint, tau) in [1.5, -0.8].into_iter().enumerate() {
            let sum = d[2 * joint] * qdd[0] + d[2 * joint + 1] * qdd[1] + bias[joint];
            assert_near(sum, tau, "forward dynamics");
        }
        let slope = added(FunctionName::InverseDynamicsDerivatives)[4 + 3];
        assert_near(slope, -2.0 * v / 0.16 * friction, "d friction / d rate");
    }
}

#[test]
fn laws_of_loads_time_and_states_have_the_arguments_that_they_need() {
    let name = robot(&text("planar_2r")).links.values().last().expect("a link").name.clone();
    let effects = format!(
        r#"[{{"effect": "capstan", "at": {{"link": "{name}"}}, "parameters": {{"mu_theta": 0.5}}}},
        {{"effect": "dahl", "at": {{"link": "{name}"}}, "parameters": {{"fc": 2, "slip": 0.01}}}},
        {{"effect": "torque_drift", "at": {{"link": "{name}"}}, "parameters": {{"c": 0.1}}}}]"#
    );
    let with = with_effects("planar_2r", &effects);
    let derivation = derived(&with, &FunctionName::ALL);
    let has = |name| derivation.functions.iter().any(|function| function.name == name);
    assert!(!has(FunctionName::Bias) && !has(FunctionName::ForwardDynamics));
    assert!(has(FunctionName::MassMatrix) && has(FunctionName::StateRates));
    assert_eq!(denavit_codegen::dynamics::implicit_effects(&with), ["capstan"]);
    let motion = motion(2, 4);
    let plain = robot(&text("planar_2r"));
    for sample in 0..4 {
        let (z, t) = (0.3, 2.5);
        let more = BTreeMap::from([(format!("z_dahl_{name}"), z), ("t".to_owned(), t)]);
        let of = |function| values_of(&derivation, function, &motion, sample, &more);
        let torque = of(FunctionName::InverseDynamics)[1];
        let load = rigid_torques(&plain, &motion, sample)[1];
        let v = motion[1][1][sample];
        let cable = load * ((0.5 * v.signum() * load.signum()).exp() - 1.0);
        let all = derived(&plain, &[FunctionName::InverseDynamics]);
        let own = values_of(&all, FunctionName::InverseDynamics, &motion, sample, &more)[1];
        assert_near(torque, own + cable + 2.0 * z + 0.1 * t, "all three");
        let rate = of(FunctionName::StateRates)[0];
        assert_near(rate, (v - v.abs() * z) / 0.01, "bristle");
    }
}

#[test]
fn effects_that_a_robot_cannot_have_are_faults_of_its_file() {
    let name = robot(&text("planar_2r")).links.values().next().expect("a link").name.clone();
    let effects = r#"[
        {"effect": "striebeck", "at": {"link": "LINK"}},
        {"effect": "coulomb", "at": "model"},
        {"effect": "coulomb", "at": {"link": "LINK"}, "parameters": {"fcc": 1}},
        {"effect": "viscous", "at": {"link": "LINK"}, "parameters": {"fv": -1}},
        {"effect": "spring", "at": {"link": "LINK"}},
        {"effect": "spring", "at": {"link": "LINK"}},
        {"effect": "coriolis", "at": "model"},
        {"effect": "base_tilt", "at": {"link": "LINK"}},
        {"effect": "damper", "at": {"link": "LINK"}},
        {"effect": "viscous", "at": {"link": "LINK", "side": "link"}, "parameters": {"fv": 1}},
        {"effect": "torque_gain", "at": {"link": "LINK", "side": "link"}}]"#;
    let effects = effects.replace("LINK", &name);
    let text =
        text("planar_2r").replacen("\"links\"", &format!("\"effects\": {effects}, \"links\""), 1);
    let said = read_model("arm.json", text.as_bytes(), &[]).expect_err("faults").to_string();
    for (place, what) in [
        ("/effects/0", "no effect is called `striebeck`"),
        ("/effects/1", "`coulomb` acts on a joint that moves, not here"),
        ("/effects/2", "`coulomb` has no parameter `fcc`"),
        ("/effects/3", "`fv` of `viscous` is -1: it cannot be below 0"),
        ("/effects/5", "`spring` is added twice in this place"),
        ("/effects/6", "the model has the term already"),
        ("/effects/7", "`base_tilt` acts on the whole model, not here"),
        ("/effects/8", "`damper` could change: the joint has no series spring"),
        ("/effects/9", "`viscous` could change: the joint has no series spring, and so no sides"),
        ("/effects/10", "`torque_gain` could change: only laws of a joint's torque have a `side`"),
    ] {
        let found = said.lines().any(|line| line.contains(place) && line.contains(what));
        assert!(found, "{place}: {what}\nnot in\n{said}");
    }
    assert!(said.contains("did you mean `stribeck`?") && !said.contains("/effects/4"), "{said}");
}

/// A side that is not stated is that of the law: the motor's of friction.
#[test]
fn an_effect_stands_once_on_a_side_of_a_spring() {
    let of = |sides: [&str; 2]| {
        let one = |side: &str| format!(r#"{{"effect": "dahl", "at": {{"link": "knee"{side}}}}}"#);
        let effects = format!(r#""effects": [{}], "links""#, sides.map(one).join(", "));
        let text = text("tulip_leg").replacen("\"links\"", &effects, 1);
        read_model("leg.json", text.as_bytes(), &[]).map_err(|error| error.to_string())
    };
    let (motor, link) = (r#", "side": "motor""#, r#", "side": "link""#);
    for sides in [["", motor], [motor, motor], [link, link]] {
        let said = of(sides).expect_err("a fault");
        assert!(said.contains("`dahl` is added twice in this place"), "{sides:?}: {said}");
    }
    of(["", link]).expect("one on each side");
}

/// Loads and states of effects are quantities of the model as well.
#[test]
fn a_constant_cannot_have_the_name_of_what_an_effect_brings() {
    let of = |constant: &str, effect: &str| {
        let name = robot(&text("planar_2r")).links.values().nth(1).expect("a link").name.clone();
        let constant = constant.replace("LINK", &name);
        let effects = format!(r#""effects": [{{"effect": {effect}, "at": {{"link": "{name}"}}}}]"#);
        let text = text("planar_2r").replacen("\"links\"", &format!("{effects}, \"links\""), 1);
        let text = text.replace("\"l2\"", &format!("\"{constant}\""));
        read_model("arm.json", text.as_bytes(), &[]).map_err(|error| error.to_string())
    };
    for (constant, effect) in [
        ("tau_load_LINK", r#""load_friction""#),
        ("z_dahl_LINK", r#""dahl""#),
        ("fc_dahl_LINK", r#""dahl""#),
    ] {
        let said = of(constant, effect).expect_err("a fault");
        assert!(said.contains("is already that of another quantity"), "{constant}: {said}");
    }
    of("l2", r#""dahl""#).expect("no fault");
}
