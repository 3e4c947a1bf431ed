//! Random robots: a URDF written of random decimals, against transforms composed plainly and
//! energies of their bodies.

use crate::evaluated::{
    IDENTITY, Random, Transform, called, frame, imported, moved, off, origin, times, turned,
};
use denavit_codegen::function::FunctionName;
use denavit_import::{BaseChoice, Options};
use std::f64::consts::{FRAC_PI_2, PI};

/// A joint with the link that it carries.
struct Joint {
    parent: usize,
    kind: &'static str,
    xyz: [f64; 3],
    rpy: [f64; 3],
    axis: [f64; 3],
    mass: f64,
    com: [f64; 3],
    turn: [f64; 3],
    inertia: [f64; 3],
}

const KINDS: [&str; 4] = ["revolute", "continuous", "prismatic", "fixed"];

/// Quarter turns, and what files have in their place.
const ROUNDED: [(f64, &str); 3] =
    [(FRAC_PI_2, "1.5708"), (-FRAC_PI_2, "-1.5707963"), (PI, "3.14159")];

/// A decimal of three places: often 0, often a quarter turn where it is an angle.
fn decimal(random: &mut Random, angle: bool) -> f64 {
    match random.whole(4) {
        0 => 0.0,
        1 if angle => ROUNDED[random.whole(3) as usize].0,
        _ => (random.next() * 1000.0).round() / 1000.0,
    }
}

fn triple(random: &mut Random, angle: bool) -> [f64; 3] {
    std::array::from_fn(|_| decimal(random, angle))
}

fn robot(random: &mut Random) -> Vec<Joint> {
    let count = 2 + random.whole(6) as usize;
    let joint = |at: usize, random: &mut Random| {
        let axis = match random.whole(4) {
            0 => [[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]][random.whole(3) as usize],
            1 => [0.0, 0.6, -0.8],
            _ => [1.0, decimal(random, false), decimal(random, false)],
        };
        let kind = if at == 0 { "revolute" } else { KINDS[random.whole(4) as usize] };
        Joint {
            parent: random.whole(at as u64 + 1) as usize,
            kind,
            xyz: triple(random, false),
            rpy: triple(random, true),
            axis,
            mass: 1.0 + (random.next().abs() * 100.0).round() / 10.0,
            com: triple(random, false),
            turn: triple(random, true),
            inertia: [0.03, 0.04, 0.05],
        }
    };
    (0..count).map(|at| joint(at, random)).collect()
}

fn written(joints: &[Joint]) -> String {
    let one = |value: f64| match ROUNDED.iter().find(|(exact, _)| *exact == value) {
        Some((_, text)) => (*text).to_owned(),
        None => value.to_string(),
    };
    let list = |v: [f64; 3]| v.map(one).join(" ");
    let mut text = String::from("<robot name=\"random\"><link name=\"l0\"/>");
    for (at, joint) in joints.iter().enumerate() {
        let [xx, yy, zz] = joint.inertia;
        text.push_str(&format!(
            "<link name=\"l{own}\"><inertial><origin xyz=\"{com}\" rpy=\"{turn}\"/>\
             <mass value=\"{mass}\"/>\
             <inertia ixx=\"{xx}\" iyy=\"{yy}\" izz=\"{zz}\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/>\
             </inertial></link>\
             <joint name=\"j{own}\" type=\"{kind}\"><origin xyz=\"{xyz}\" rpy=\"{rpy}\"/>\
             <parent link=\"l{parent}\"/><child link=\"l{own}\"/><axis xyz=\"{axis}\"/></joint>",
            own = at + 1,
            com = list(joint.com),
            turn = list(joint.turn),
            mass = joint.mass,
            kind = joint.kind,
            xyz = list(joint.xyz),
            rpy = list(joint.rpy),
            parent = joint.parent,
            axis = list(joint.axis),
        ));
    }
    text + "</robot>"
}

/// Frames of all links.
fn frames(joints: &[Joint], q: &[f64]) -> Vec<Transform> {
    let (mut frames, mut next) = (vec![IDENTITY], 0);
    for joint in joints {
        let mut own = times(&frames[joint.parent], &origin(joint.xyz, joint.rpy));
        if joint.kind != "fixed" {
            let value = q[next];
            next += 1;
            let length = joint.axis.iter().map(|x| x * x).sum::<f64>().sqrt();
            let motion = match joint.kind {
                "prismatic" => moved(joint.axis.map(|part| part / length * value)),
                _ => turned(joint.axis, value),
            };
            own = times(&own, &motion);
        }
        frames.push(own);
    }
    frames
}

/// Kinetic and potential energy by differences of places: masses stand on six points each.
fn energies(joints: &[Joint], q: &[f64], qd: &[f64]) -> (f64, f64) {
    const STEP: f64 = 1e-5;
    let at = |sign: f64| {
        let q: Vec<f64> = q.iter().zip(qd).map(|(q, qd)| q + sign * STEP * qd).collect();
        frames(joints, &q)
    };
    let (before, here, after) = (at(-1.0), at(0.0), at(1.0));
    let (mut kinetic, mut potential) = (0.0, 0.0);
    for (link, joint) in joints.iter().enumerate() {
        let own = origin(joint.com, joint.turn);
        let [xx, yy, zz] = joint.inertia;
        let second = [(yy + zz - xx) / 2.0, (xx + zz - yy) / 2.0, (xx + yy - zz) / 2.0];
        for axis in 0..3 {
            for sign in [-1.0, 1.0] {
                // two points of a sixth of the mass each have these second moments
                let mut place = [0.0; 3];
                place[axis] = sign * (3.0 * second[axis] / joint.mass).sqrt();
                let point = times(&own, &moved(place));
                let of = |frames: &[Transform]| times(&frames[link + 1], &point);
                let (early, now, late) = (of(&before), of(&here), of(&after));
                let square: f64 =
                    (0..3).map(|k| ((late[k][3] - early[k][3]) / (2.0 * STEP)).powi(2)).sum();
                kinetic += joint.mass / 6.0 * square / 2.0;
                potential += joint.mass / 6.0 * 9.81 * now[2][3];
            }
        }
    }
    (kinetic, potential)
}

#[test]
fn frames_and_energies_are_those_of_the_description() {
    let mut random = Random(5);
    for case in 0..40 {
        let joints = robot(&mut random);
        let text = written(&joints);
        let model = imported(&text, &Options::default());
        let moving = joints.iter().filter(|joint| joint.kind != "fixed").count();
        assert_eq!(model.degrees_of_freedom(), moving);
        // the order of rows is that of a walk through the tree
        let names: Vec<String> =
            model.joints().map(|(link, _)| model.links[link].name.clone()).collect();
        let values: Vec<f64> = names.iter().map(|_| random.next()).collect();
        let rates: Vec<f64> = names.iter().map(|_| random.next()).collect();
        let sorted = |values: &[f64]| -> Vec<f64> {
            let own = |joint: usize| names.iter().position(|name| *name == format!("j{joint}"));
            (1..=joints.len()).filter_map(own).map(|place| values[place]).collect()
        };
        let (q, qd) = (sorted(&values), sorted(&rates));
        let wanted = frames(&joints, &q);
        for (link, wanted) in wanted.iter().enumerate().skip(1) {
            let has_own = model.find_link(&format!("l{link}")).is_some();
            let name = if has_own { format!("l{link}") } else { format!("j{link}") };
            let found = frame(&model, &values, &name);
            assert!(off(&found, wanted) < 1e-12, "case {case}, {name}: {text}");
        }
        let (kinetic, potential) = energies(&joints, &q, &qd);
        let found = called(&model, FunctionName::KineticEnergy, &[&values, &rates])[0];
        assert!((found - kinetic).abs() < 1e-6 * (1.0 + kinetic), "case {case}: {text}");
        let found = called(&model, FunctionName::PotentialEnergy, &[&values])[0];
        let zero = vec![0.0; values.len()];
        let start = called(&model, FunctionName::PotentialEnergy, &[&zero])[0];
        let wanted = potential - energies(&joints, &vec![0.0; q.len()], &vec![0.0; q.len()]).1;
        assert!(
            (found - start - wanted).abs() < 1e-9 * (1.0 + potential.abs()),
            "case {case}: {text}"
        );
    }
}

#[test]
fn a_floating_base_stands_in_the_frame_of_the_first_link() {
    let joints = robot(&mut Random(11));
    let options = Options { base: BaseChoice::Floating, ..Options::default() };
    let model = imported(&written(&joints), &options);
    let n = model.degrees_of_freedom();
    let mut q = vec![0.0; n];
    assert!(off(&frame(&model, &q, "l0"), &IDENTITY) < 1e-15);
    // the chain of the base: up, forward, left, yaw, roll, pitch
    q[..6].copy_from_slice(&[0.3, 0.1, 0.2, 0.5, 0.0, 0.0]);
    let wanted = times(&moved([0.1, 0.2, 0.3]), &turned([0.0, 0.0, 1.0], 0.5));
    assert!(off(&frame(&model, &q, "l0"), &wanted) < 1e-15);
}
