//! Static identification: weighings and held postures, joined with dynamic estimates.

use denavit_codegen::model;
use denavit_codegen::regressor::RegressorOptions;
use denavit_numerics::Equations;
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use denavit_plants::shipped;
use denavit_statics::{
    Error, ErrorKind, HoldingTorque, StaticMeasurement, add_estimate, static_knowledge,
};
use nalgebra::DMatrix;

const G: f64 = 9.81;
const LENGTH: f64 = 0.5;
/// Mass and distance of the centre of mass from the joint, of both links of planar_2r.
const LINKS: [(f64, f64); 2] = [(2.0, 0.5 - 0.22), (1.5, 0.4 - 0.17)];

fn arm() -> RegressionModel {
    let shipped = shipped::find("planar_2r").expect("a shipped model");
    let robot = model::read(shipped.name, shipped.text.as_bytes()).expect("sound");
    RegressionModel::new(&robot, RegressorOptions::default(), &[]).expect("a regression model")
}

/// Gravity torques of the arm in a posture, from its picture: gravity along -y.
fn gravity(q: [f64; 2]) -> [f64; 2] {
    let [(m1, c1), (m2, c2)] = LINKS;
    let second = m2 * G * c2 * (q[0] + q[1]).cos();
    [m1 * G * c1 * q[0].cos() + m2 * G * LENGTH * q[0].cos() + second, second]
}

fn posture(q: [f64; 2], noise: &mut dyn FnMut() -> f64, std: f64) -> StaticMeasurement {
    let torque = |(joint, torque): (&str, f64)| HoldingTorque {
        joint: joint.to_owned(),
        torque: torque + std * noise(),
        std,
    };
    let torques = ["link1", "link2"].into_iter().zip(gravity(q)).map(torque).collect();
    StaticMeasurement::Posture { q: q.to_vec(), torques }
}

fn weighing(links: &[&str], mass_kg: f64) -> StaticMeasurement {
    let links = links.iter().map(|link| (*link).to_owned()).collect();
    StaticMeasurement::Weighing { links, mass_kg, std_kg: 0.01 }
}

fn place(model: &RegressionModel, name: &str) -> usize {
    model.standard.iter().position(|one| one.name == name).expect("a parameter")
}

const POSTURES: [[f64; 2]; 4] = [[0.0, 0.0], [0.5, -1.0], [1.2, 0.4], [-0.7, 1.9]];

#[test]
fn masses_and_moments_follow_from_weighings_and_postures() {
    let model = arm();
    let mut none = || 0.0;
    let mut all: Vec<_> = POSTURES.iter().map(|q| posture(*q, &mut none, 0.02)).collect();
    // in the frame at the far end, first moments are m (c - length)
    let [mx1, mx2] = LINKS
        .map(|(m, _)| m)
        .into_iter()
        .zip([0.22, 0.17])
        .map(|(m, x)| -m * x)
        .collect::<Vec<f64>>()
        .try_into()
        .expect("two");
    let postures = static_knowledge(&model, &all).expect("sound").consequences();
    // without a scale masses and moments go together: m1 l + mx1 + m2 l is all that joint 1 feels
    assert!(postures.parameters[place(&model, "m_link1")].is_none());
    assert!(postures.parameters[place(&model, "mx_link1")].is_none());
    all.push(weighing(&["link1", "link2"], 3.5));
    all.push(weighing(&["link2"], 1.5));
    let found = static_knowledge(&model, &all).expect("sound").consequences();
    for (name, value) in [("m_link1", 2.0), ("m_link2", 1.5), ("mx_link1", mx1), ("mx_link2", mx2)]
    {
        let (estimate, std) = found.parameters[place(&model, name)].expect(name);
        assert!((estimate - value).abs() < 1e-9, "{name}: {estimate} for {value}");
        assert!(std > 0.0 && std < 0.05, "{name}: {std}");
    }
    assert!(found.parameters[place(&model, "Izz_link2")].is_none(), "nothing moved");
    assert!(found.chi_squared < 1e-12);
    // 8 torques and 2 weighings determine 2 masses and 4 first moments
    assert_eq!((found.combinations.len(), found.degrees_of_freedom), (6, 4));
}

/// The difference of two weighings has the error of both.
#[test]
fn errors_are_those_of_sums() {
    let model = arm();
    let all = [weighing(&["link1", "link2"], 3.5), weighing(&["link2"], 1.5)];
    let found = static_knowledge(&model, &all).expect("sound").consequences();
    let (mass, std) = found.parameters[place(&model, "m_link1")].expect("a difference");
    assert!((mass - 2.0).abs() < 1e-12);
    assert!((std - 0.01 * 2.0_f64.sqrt()).abs() < 1e-12);
}

#[test]
fn errors_are_those_that_repetitions_show() {
    let model = arm();
    let mut random = Random::new(5);
    let at = place(&model, "mx_link2");
    let (mut values, mut stds, mut chi) = (Vec::new(), Vec::new(), 0.0);
    for _ in 0..400 {
        let mut noise = || random.normal();
        let mut all: Vec<_> = POSTURES.iter().map(|q| posture(*q, &mut noise, 0.02)).collect();
        all.push(weighing(&["link2"], 1.5 + 0.01 * random.normal()));
        let found = static_knowledge(&model, &all).expect("sound").consequences();
        let (value, std) = found.parameters[at].expect("it follows");
        values.push(value);
        stds.push(std);
        chi += found.chi_squared / found.degrees_of_freedom as f64;
    }
    let mean = values.iter().sum::<f64>() / 400.0;
    let scatter = (values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / 399.0).sqrt();
    // five standard errors of a scatter and of a mean of chi squared
    assert!((stds[0] / scatter - 1.0).abs() < 5.0 / 800.0_f64.sqrt(), "{} {scatter}", stds[0]);
    assert!((chi / 400.0 - 1.0).abs() < 0.2, "{chi}");
    assert!((mean + 1.5 * 0.17).abs() < 5.0 * scatter / 20.0);
}

/// What is known at rest goes on into a dynamic estimate, and tells apart what it cannot.
#[test]
fn a_scale_splits_base_parameters() {
    let model = arm();
    let phi = model.model_axes().expect("the model has values");
    let covariance = DMatrix::from_diagonal_element(phi.len(), phi.len(), 1e-6);
    let mut dynamic = Equations::none(model.standard.len());
    assert!(add_estimate(&mut dynamic, &model, &phi, &covariance));
    let alone = dynamic.consequences();
    assert_eq!(alone.combinations.len(), model.rank());
    assert!(alone.parameters[place(&model, "m_link1")].is_none());
    let scale = [weighing(&["link1"], 2.0), weighing(&["link2"], 1.5)];
    let mut both = static_knowledge(&model, &scale).expect("sound");
    assert!(add_estimate(&mut both, &model, &phi, &covariance));
    let joined = both.consequences();
    for name in ["m_link1", "m_link2", "mx_link1", "mx_link2", "Izz_link1", "Izz_link2"] {
        let at = place(&model, name);
        let (value, std) = joined.parameters[at].expect(name);
        let truth = model.standard[at].value.expect("the model has values");
        assert!((value - truth).abs() < 1e-9 && std < 0.02, "{name}: {value} for {truth}");
    }
    assert!(joined.parameters[place(&model, "Ixx_link1")].is_none(), "the arm is planar");
}

#[test]
fn all_faults_are_found_at_once() {
    let model = arm();
    let wrong = [
        weighing(&["link3"], 1.0),
        StaticMeasurement::Posture { q: vec![0.0], torques: Vec::new() },
        weighing(&["link1"], f64::NAN),
        StaticMeasurement::Posture {
            q: vec![0.0; 2],
            torques: vec![HoldingTorque { joint: "link9".to_owned(), torque: 1.0, std: 1.0 }],
        },
    ];
    let faults = static_knowledge(&model, &wrong).expect_err("nothing is right");
    assert_eq!(faults.kind(), ErrorKind::Measurements);
    let faults = faults.faults();
    let of: Vec<Option<usize>> = faults.iter().map(Error::measurement).collect();
    assert_eq!(of, [Some(0), Some(1), Some(2), Some(3)], "{faults:?}");
    assert!(faults[1].to_string().contains("has 2 positions, 1 are given"), "{}", faults[1]);
    assert!(faults[2].to_string().contains("must be finite"), "{}", faults[2]);
}

#[test]
fn a_scale_bears_each_link_once() {
    let wrong = [weighing(&["link1", "link1"], 4.0), weighing(&[], 1.0)];
    let faults = static_knowledge(&arm(), &wrong).expect_err("neither is a weighing");
    let faults = faults.faults();
    let of: Vec<Option<usize>> = faults.iter().map(Error::measurement).collect();
    assert_eq!(of, [Some(0), Some(1)], "{faults:?}");
    assert!(faults[0].to_string().contains("`link1` is named twice"), "{}", faults[0]);
    assert!(faults[1].to_string().contains("`links` is empty"), "{}", faults[1]);
}

/// Five deviations of a normal distribution are the bound: 1 degree of freedom, by hand.
#[test]
fn weighings_that_contradict_each_other_are_told() {
    let apart = |deviations: f64| {
        // the difference of two numbers with a deviation of 0.01 each
        let both = [
            weighing(&["link2"], 1.5),
            weighing(&["link2"], 1.5 + deviations * 0.01 * 2f64.sqrt()),
        ];
        let found = static_knowledge(&arm(), &both).expect("sound").consequences();
        assert!((found.chi_squared - deviations.powi(2)).abs() < 1e-6);
        found.contradicts()
    };
    assert!(!apart(1.0) && !apart(4.0));
    assert!(apart(6.0) && apart(100.0));
}
