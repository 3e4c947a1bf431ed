//! What holds of every regressor: it is the torque, base columns carry it alone, certificates hold.

use super::{INERTIAL, base, rigid, tree};
use crate::robots::{fixture, load, shipped};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::{Dag, ExprId, Residues, evaluate};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{Robot, Terms};
use denavit_codegen::number::Residue;
use denavit_codegen::regressor::{
    Certificate, Regressor, RegressorOptions, Unknowns, Verdict, base_parameters,
};

fn values(dag: &Dag, exprs: &[ExprId], seed: u64) -> Vec<Residue> {
    evaluate(dag, exprs, &mut Residues::new(seed)).unwrap()
}

fn torques(robot: &Robot, seed: u64) -> Vec<Residue> {
    let derivation = derive(robot, Flavour::Tunable, &[FunctionName::InverseDynamics]).unwrap();
    values(&derivation.dag, &derivation.functions[0].entries(), seed)
}

/// Sums of rows: entries (row-major) times parameters.
fn product(entries: &[Residue], parameters: &[Residue]) -> Vec<Residue> {
    let rows = entries.chunks(parameters.len());
    rows.map(|row| row.iter().zip(parameters).fold(Residue::ZERO, |sum, (&a, &b)| sum + a * b))
        .collect()
}

#[test]
fn the_regressor_times_its_parameters_is_the_torque() {
    for name in shipped() {
        let robot = load(&name);
        for unknowns in [Unknowns::Parameters, Unknowns::Products] {
            let options = RegressorOptions {
                friction: true,
                rotor: true,
                offset: true,
                only_modelled: true,
                unknowns,
            };
            let side = denavit_codegen::model::TorqueSide::Joint;
            let regressor = Regressor::new(&robot, options, side).unwrap();
            let parameters: Vec<_> = regressor.columns.iter().map(|c| c.value).collect();
            for seed in [1, 2] {
                let known = values(&regressor.dag, &regressor.known, seed);
                let entries = values(&regressor.dag, &regressor.entries(), seed);
                let theta = values(&regressor.dag, &parameters, seed);
                let sum = product(&entries, &theta);
                let total: Vec<_> = sum.iter().zip(&known).map(|(&a, &b)| a + b).collect();
                assert_eq!(total, torques(&robot, seed), "{name} {unknowns:?}");
            }
        }
    }
}

#[test]
fn base_columns_times_base_parameters_are_the_torque() {
    for name in ["puma560", "iiwa", "scara", "tulip_leg", "double_pendulum", "tulip"] {
        let robot = rigid(load(name));
        let found = base(&robot, INERTIAL);
        let dag = &found.regressor.dag;
        let n = found.regressor.joints.len();
        let entries: Vec<_> = (0..n)
            .flat_map(|row| {
                let columns = &found.regressor.columns;
                found.parameters.iter().map(move |p| columns[p.column].entries[row])
            })
            .collect();
        let theta: Vec<_> = found.parameters.iter().map(|p| p.value).collect();
        let (entries, theta) = (values(dag, &entries, 3), values(dag, &theta, 3));
        assert_eq!(product(&entries, &theta), torques(&robot, 3), "{name}");
    }
}

#[test]
fn coriolis_terms_add_no_base_parameter() {
    for name in shipped() {
        let robot = rigid(load(&name));
        let still = Robot { terms: Terms { coriolis: false, ..robot.terms }, ..robot.clone() };
        let (full, still) = (base(&robot, INERTIAL), base(&still, INERTIAL));
        let relations = |found: &denavit_codegen::regressor::BaseParameters| {
            let texts = found.dependent.iter().map(|d| (d.column, found.text(d.expression)));
            texts.collect::<Vec<_>>()
        };
        assert_eq!(relations(&full), relations(&still), "{name}");
    }
}

fn certified(robot: &Robot, options: RegressorOptions, keep: &[String]) -> Certificate {
    let found = base_parameters(robot, options, keep)
        .unwrap_or_else(|error| panic!("{}: {error}", robot.name));
    let certificate = Certificate::new(robot, options, &found, false);
    let Verdict::Verified { rank, multiplied_out } = certificate.verify(robot) else {
        panic!("{}: {}", robot.name, certificate.verify(robot));
    };
    assert_eq!(rank, found.rank(), "{}", robot.name);
    let is_small = robot.joints().count() <= 6 && certificate.generic_angles.is_empty();
    assert!(is_small || !multiplied_out, "{}", robot.name);
    certificate
}

#[test]
fn relations_are_multiplied_out_up_to_six_joints() {
    for (name, expected) in [
        ("planar_2r", true),
        ("puma560", true),
        ("rx90", true),
        ("tulip_leg6", true),
        ("iiwa", false),
    ] {
        let robot = load(name);
        let written = Certificate::new(&robot, INERTIAL, &base(&robot, INERTIAL), false);
        let Verdict::Verified { multiplied_out, .. } = written.verify(&robot) else {
            panic!("{name}");
        };
        assert_eq!(multiplied_out, expected, "{name}");
    }
}

/// A twist that is a symbol, behind a length: sines in the denominators of the relations.
#[test]
fn skew_arms_are_certified() {
    let rows = [("revolute", "a0", "pi/2", "0", None), ("revolute", "a1", "al", "0", Some(0))];
    let robot = tree("skew", ["0", "0", "-g"], &rows);
    assert_eq!(certified(&robot, INERTIAL, &[]).pivots.len(), 8);
}

#[test]
fn certificates_hold_on_every_robot() {
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    for name in shipped() {
        let robot = load(&name);
        for options in [INERTIAL, all] {
            certified(&robot, options, &[]);
        }
    }
}

/// A permutation of the names, from a written seed.
fn shuffled(mut names: Vec<String>, seed: u64) -> Vec<String> {
    for at in (1..names.len()).rev() {
        let random = Residue::scrambled(seed, at as u64).value() as usize;
        names.swap(at, random % (at + 1));
    }
    names
}

#[test]
fn any_column_order_is_exact() {
    for (robot, orders) in [
        (rigid(load("puma560")), 11),
        (rigid(load("iiwa")), 11),
        (rigid(load("tulip_leg6")), 11),
        (rigid(fixture("general_6r.json")), 11),
    ] {
        let regressor = Regressor::new(&robot, INERTIAL, robot.torque_side).unwrap();
        let names: Vec<String> = regressor.columns.iter().map(|c| c.name.clone()).collect();
        for order in 0..orders {
            let keep = match order {
                0 => names.iter().rev().cloned().collect(),
                _ => shuffled(names.clone(), order),
            };
            certified(&robot, INERTIAL, &keep);
        }
    }
}

#[test]
fn tampered_certificates_and_other_models_are_refused() {
    let robot = load("puma560");
    let good = certified(&robot, INERTIAL, &[]);
    let mut factor = good.clone();
    let with_sum = factor.relations.iter_mut().find(|relation| !relation.sum.is_empty()).unwrap();
    with_sum.sum[0].0.push_str(" + 1");
    assert!(matches!(factor.verify(&robot), Verdict::Relation(_)));
    let mut dropped = good.clone();
    let last = dropped.relations.pop().unwrap();
    assert_eq!(dropped.verify(&robot), Verdict::NotAPartition(last.column.clone()));
    let mut pivot = good.clone();
    (pivot.pivots[0].point, pivot.pivots[0].joint) = (pivot.pivots[1].point, pivot.pivots[1].joint);
    assert_eq!(pivot.verify(&robot), Verdict::RankTooLow);
    // A zero column passed off as one that stays.
    let mut zero = good.clone();
    let at = zero.relations.iter().position(|relation| relation.sum.is_empty()).unwrap();
    let column = zero.relations.remove(at).column;
    zero.pivots.push(denavit_codegen::regressor::certificate::Pivot { column, point: 1, joint: 0 });
    assert_eq!(zero.verify(&robot), Verdict::RankTooLow);
    assert!(matches!(good.verify(&load("rx90")), Verdict::OtherModel(_)));
    for word in ["rotors", "friction"] {
        let mut words = good.clone();
        words.with.extend([word.to_owned(), word.to_owned()]);
        assert!(!words.verify(&robot).is_verified(), "{word}");
    }
    let mut terms = good.clone();
    terms.terms.push("gravity".to_owned());
    assert_eq!(terms.verify(&robot), Verdict::Words);
    let mut prime = good;
    prime.prime = 97;
    assert!(matches!(prime.verify(&robot), Verdict::Format(_)));
}

/// A random tree: quarter turns, one joint in four slides, lengths whole numbers or symbols.
fn random_tree(joints: usize, seed: u64) -> Robot {
    let random = |key: u64, below: u64| Residue::scrambled(seed, key).value() % below;
    let names: Vec<[String; 3]> = (0..joints as u64)
        .map(|j| {
            let length = |key: u64| match random(10 * j + key, 3) {
                0 => "0".to_owned(),
                1 => format!("{}", 1 + random(10 * j + key + 4, 5)),
                _ => format!("x{}", random(10 * j + key + 4, 4)),
            };
            let alpha = ["0", "pi/2", "-pi/2", "0"][random(10 * j + 8, 4) as usize];
            [length(0), alpha.to_owned(), length(1)]
        })
        .collect();
    let rows: Vec<_> = (0..joints)
        .map(|j| {
            let slides = random(10 * j as u64 + 2, 4) == 0;
            let kind = if slides { "prismatic" } else { "revolute" };
            let back = 1 + random(10 * j as u64 + 3, 2) as usize;
            let [a, alpha, d] = &names[j];
            (kind, a.as_str(), alpha.as_str(), d.as_str(), j.checked_sub(back))
        })
        .collect();
    tree("random", ["0", "0", "-g"], &rows)
}

/// R0 theta0 = R theta, for values of theta0 that know nothing of each other.
#[test]
fn base_parameters_carry_what_all_parameters_do() {
    for seed in 0..24 {
        let robot = random_tree(1 + seed as usize % 8, 50 + seed);
        let found = base(&robot, INERTIAL);
        let dag = &found.regressor.dag;
        let n = found.regressor.joints.len();
        let theta0: Vec<Residue> = (0..found.regressor.columns.len())
            .map(|c| Residue::scrambled(seed, c as u64))
            .collect();
        let all = values(dag, &found.regressor.entries(), seed);
        let mut kept = vec![Residue::ZERO; n];
        for parameter in &found.parameters {
            let factors: Vec<_> = parameter.members.iter().map(|&(_, factor)| factor).collect();
            let factors = values(dag, &factors, seed);
            let members = parameter.members.iter().zip(factors);
            let theta = members.fold(Residue::ZERO, |sum, (&(c, _), k)| sum + k * theta0[c]);
            for (row, sum) in kept.iter_mut().enumerate() {
                *sum = *sum + all[row * theta0.len() + parameter.column] * theta;
            }
        }
        assert_eq!(kept, product(&all, &theta0), "seed {seed}");
    }
}

#[test]
fn random_trees_are_certified() {
    let all = RegressorOptions { friction: true, rotor: true, offset: true, ..INERTIAL };
    for seed in 0..24 {
        let robot = random_tree(1 + seed as usize % 8, seed);
        certified(&robot, INERTIAL, &[]);
        certified(&robot, all, &[]);
    }
}

/// Twists that are numbers, not quarter turns: alike, multiples, of other denominators, of pi.
#[test]
fn twists_that_are_numbers_are_generic_angles() {
    for (twists, angles) in [
        (["0.3", "0.3", "0.3", "0.3"], 1),
        (["0.3", "-0.6", "0.5", "1"], 4),
        (["pi/6", "pi/3", "-pi/6", "pi/4"], 4),
        (["pi/2 + 0.1", "30*pi/180", "0.5236", "2.0944"], 4),
    ] {
        let rows: Vec<_> = (0..4usize)
            .map(|j| ("revolute", ["a0", "a1", "a2", "a3"][j], twists[j], "d", j.checked_sub(1)))
            .collect();
        let robot = tree("numbers", ["0", "0", "-g"], &rows);
        let certificate = certified(&robot, INERTIAL, &[]);
        // A general arm, first axis upright.
        assert_eq!(certificate.pivots.len(), 7 * 4 - 6, "{twists:?}");
        assert_eq!(certificate.generic_angles.len(), angles, "{twists:?}");
        let names: Vec<String> = certificate.columns.iter().rev().cloned().collect();
        certified(&robot, INERTIAL, &names);
    }
}

#[test]
fn large_trees_are_certified() {
    for joints in [15, 30] {
        certified(&random_tree(joints, 7), INERTIAL, &[]);
    }
}
