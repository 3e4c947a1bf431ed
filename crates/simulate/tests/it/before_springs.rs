//! Laws of added effects at series elastic drives: on the motor, on the link, and between them.
//! Against matrix exponentials, and against the plant of the blind battery.

use super::assert_near;
use denavit_blind::hidden::{Hidden, Law, Shape};
use denavit_blind::nominal::Nominal;
use denavit_blind::plant::Plant;
use denavit_blind::robots::robot;
use denavit_codegen::effect::read_model;
use denavit_plants::LoadedPlant;
use denavit_plants::trajectory::Reference;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::time_stepping::{Stepping, simulate_by_steps};
use denavit_simulate::{
    Control, DriveModelling, JointControl, Run, Simulation, State, Stop, simulate,
};
use nalgebra::{DMatrix, DVector};
use serde_json::{Value, json};

const INERTIA: f64 = 0.05 + 2.0 * 0.09;
const GEAR: f64 = 50.0;
const ROTOR: f64 = 4e-5 * GEAR * GEAR;
const STIFFNESS: f64 = 27.0;

/// A rod without gravity behind a spring: linear, whatever acts on it.
fn rod(effects: &Value) -> LoadedPlant {
    let file = json!({
        "format": "denavit-model/1", "name": "elastic_rod", "convention": "standard",
        "gravity": [0, 0, 0],
        "links": [{
            "name": "rod",
            "joint": {"type": "revolute", "theta": 0, "d": 0, "a": 0.5, "alpha": 0},
            "body": {"mass": 2, "com": [-0.2, 0, 0], "about": "com",
                     "inertia": {"xx": 0.001, "yy": 0.05, "zz": 0.05, "xy": 0, "xz": 0, "yz": 0}}
        }],
        "drives": {"rod": {
            "gear_ratio": GEAR, "rotor_inertia": 4e-5,
            "series_elastic": {"stiffness": 30000, "motor_radius": 0.03, "load_radius": 0.03}
        }},
        "effects": effects,
    });
    plant_of(&file)
}

fn plant_of(file: &Value) -> LoadedPlant {
    let robot = read_model("a model", file.to_string().as_bytes(), &[]).expect("a model");
    LoadedPlant::new(&robot, &[]).expect("a plant")
}

/// What acts beside the series spring: viscous friction and inertia of the drive, a damper beside
/// the spring, a spring across the joint; viscous friction of the link.
#[derive(Clone, Copy)]
struct Added {
    viscous: f64,
    of_link: f64,
    inertia: f64,
    damper: f64,
    across: f64,
}

const ADDED: Added =
    Added { viscous: 0.3, of_link: 0.05, inertia: 0.04, damper: 0.08, across: 5.0 };

impl Added {
    fn effects(self) -> Value {
        let at = json!({"link": "rod"});
        let one =
            |name: &str, values: Value| json!({"effect": name, "at": at, "parameters": values});
        let mut of_link = one("viscous", json!({"fv": self.of_link}));
        of_link["at"]["side"] = "link".into();
        let mut effects = vec![
            one("viscous", json!({"fv": self.viscous})),
            of_link,
            one("damper", json!({"d": self.damper})),
            one("spring", json!({"k": self.across, "q_0": 0})),
        ];
        if self.inertia > 0.0 {
            effects.push(one("rotor_inertia", json!({"ia": self.inertia})));
        }
        effects.into()
    }

    /// q and its rate, then those of the motor on the joint's side, after a time.
    fn after(self, t_s: f64, [q, motor]: [f64; 2]) -> Vec<f64> {
        let Self { viscous, of_link, inertia, damper, across } = self;
        let (link, drive) = (INERTIA, ROTOR + inertia);
        let rates = DMatrix::from_row_slice(
            4,
            4,
            &[
                0.0,
                1.0,
                0.0,
                0.0, //
                -(STIFFNESS + across) / link,
                -(damper + of_link) / link,
                STIFFNESS / link,
                damper / link, //
                0.0,
                0.0,
                0.0,
                1.0, //
                STIFFNESS / drive,
                damper / drive,
                -STIFFNESS / drive,
                -(damper + viscous) / drive,
            ],
        );
        let start = DVector::from_column_slice(&[q, 0.0, motor, 0.0]);
        ((rates * t_s).exp() * start).as_slice().to_vec()
    }
}

fn accurate(drives: DriveModelling, end_s: f64) -> Simulation {
    let accuracy = Accuracy { relative: 1e-11, absolute: 1e-12, max_step_s: 0.01 };
    let method = Method::DormandPrince(accuracy);
    Simulation { end_s, drives, method, ..Simulation::default() }
}

/// The rod let go with its motor ahead, and where motor and joint are at the end.
fn let_go(added: Added, ahead: f64, how: &Simulation) -> Run {
    let mut plant = rod(&added.effects());
    let initial = State { motor: vec![GEAR * (0.1 + ahead)], ..State::resting(vec![0.1]) };
    let run = simulate(&mut plant, &Control::passive(1), &initial, how).expect("it begins");
    assert_eq!(run.stop, Stop::End);
    run
}

#[test]
fn laws_of_motor_spring_and_link_move_two_inertias_as_the_matrix_exponential_says() {
    for inertia in [0.0, ADDED.inertia] {
        let added = Added { inertia, ..ADDED };
        let run = let_go(added, 0.4, &accurate(DriveModelling::Model, 0.7));
        let State { q, qd, motor, motor_rate, .. } = &run.end;
        let found = [q[0], qd[0], motor[0] / GEAR, motor_rate[0] / GEAR];
        let expected = added.after(0.7, [0.1, 0.5]);
        for (found, expected) in found.iter().zip(&expected) {
            assert_near(*found, *expected, 1e-9);
        }
        // What friction and damper took is in the balance: 1/2 27 0.4^2 J were in the spring.
        assert!(run.audit.energy_j < 1e-8, "{}", run.audit.energy_j);
        assert!(run.audit.exchanged_j > 0.5, "{}", run.audit.exchanged_j);
        // A log has what is passed on to the link, the damper's part as well.
        let passed = run.log.column("tau_rod").expect("a column")[70];
        let [q, qd, motor, rate] = expected[..] else { panic!("four") };
        assert_near(passed, STIFFNESS * (motor - q) + ADDED.damper * (rate - qd), 1e-7);
    }
}

/// Where drives are ideal motor and link are one, and nothing is between them.
#[test]
fn laws_of_a_motor_act_on_its_joint_where_the_drive_counts_as_stiff() {
    for inertia in [0.0, ADDED.inertia] {
        let added = Added { inertia, ..ADDED };
        for drives in [DriveModelling::Ideal, DriveModelling::Required] {
            let mut plant = rod(&added.effects());
            let initial = State::resting(vec![0.1]);
            let how = accurate(drives, 0.7);
            let run = simulate(&mut plant, &Control::passive(1), &initial, &how).expect("begins");
            let whole = INERTIA + inertia;
            let lines = [0.0, 1.0, -added.across / whole, -(added.viscous + added.of_link) / whole];
            let rates = DMatrix::from_row_slice(2, 2, &lines);
            let expected = (rates * 0.7).exp() * DVector::from_column_slice(&[0.1, 0.0]);
            assert_near(run.end.q[0], expected[0], 1e-9);
            assert_near(run.end.qd[0], expected[1], 1e-9);
            assert!(run.audit.energy_j < 1e-8, "{}", run.audit.energy_j);
        }
    }
}

/// Steps of first order: half the step, half the error.
#[test]
fn steps_come_nearer_to_the_same_motion() {
    let added = Added { inertia: 0.0, ..ADDED };
    let expected = added.after(0.5, [0.1, 0.5]);
    let errors = [2e-4, 1e-4].map(|step_s| {
        let mut plant = rod(&added.effects());
        let initial = State { motor: vec![GEAR * 0.5], ..State::resting(vec![0.1]) };
        let stepping = Stepping { step_s, ..Stepping::default() };
        let how = Simulation { end_s: 0.5, drives: DriveModelling::Model, ..Simulation::default() };
        let run = simulate_by_steps(&mut plant, &Control::passive(1), &initial, &how, &stepping);
        let run = run.expect("it begins");
        (run.end.q[0] - expected[0]).abs() + (run.end.motor[0] / GEAR - expected[2]).abs()
    });
    assert!(errors[0] < 2e-3 && errors[1] < 0.6 * errors[0], "{errors:?}");
}

/// Friction of the load and friction that turns over slowly [N m] at motors, with its rate; a
/// one-sided spring at a link and its edge; a damper beside a spring.
const LEG: [f64; 6] = [0.15, 2.0, 0.5, 30.0, 0.05, 0.3];

/// TUlip's leg behind springs, without dry friction of its own: as a model and as a plant of the
/// blind battery.
fn leg() -> (LoadedPlant, Plant) {
    let [mu, fc, vs, k, q_0, d] = LEG;
    let mut leg = robot(5);
    leg.joints.iter_mut().for_each(|joint| joint.drive.coulomb = 0.0);
    let mut file =
        Nominal { robot: leg.clone(), relative_std: 0.01, friction_std: 0.01, coriolis: true }
            .file();
    let one = |name: &str, link: &str, values: Value| {
        let at = json!({"link": link});
        json!({"effect": name, "at": at, "parameters": values})
    };
    file["effects"] = json!([
        one("load_friction", "hip_y", json!({"mu": mu})),
        one("smoothed_coulomb", "ankle_y", json!({"fc": fc, "vs": vs})),
        one("one_sided_spring", "ankle_y", json!({"k": k, "q_0": q_0})),
        one("damper", "knee", json!({"d": d})),
    ]);
    let hidden = |law, joint, size, shape| Hidden { law, variant: 0, joint, other: 0, size, shape };
    let slow = Shape { rate: 5.0 * vs, ..Shape::default() };
    let edge = Shape { middle: q_0, ..Shape::default() };
    let mut truth = Plant::new(
        &leg,
        vec![
            hidden(Law::LoadFriction, 2, mu, Shape::default()),
            hidden(Law::SmoothedCoulomb, 4, fc, slow),
            hidden(Law::ReturnSpring, 4, k, edge),
        ],
    );
    let knee = truth.transmissions.iter_mut().find(|one| one.joint == 3);
    knee.expect("an elastic joint").damping = d;
    (plant_of(&file), truth)
}

/// From a state in which all drives slide, for as long as they do.
#[test]
fn a_leg_behind_springs_moves_as_the_plant_of_the_blind_battery() {
    let (mut plant, truth) = leg();
    let (q, qd) = ([0.1, -0.1, -0.4, 0.9, 0.0], [0.5, -0.4, -1.5, 1.2, 2.0]);
    let command = [0.4, -0.6, -9.0, 3.0, 2.0];
    let end_s = 0.12;
    let after = |step_s: f64| {
        let mut state = truth.start(0.0, &q, &qd);
        for _ in 0..(end_s / step_s).round() as usize {
            truth.step(&mut state, &command, step_s);
        }
        state.y
    };
    // Friction there is that of the load a stage ago: an error of the first order of the step.
    let (whole, half) = (after(1e-5), after(5e-6));
    let expected = half.iter().zip(&whole).map(|(half, whole)| 2.0 * half - whole);
    let mut control = Control::passive(5);
    for (joint, torque) in control.joints.iter_mut().zip(command) {
        let feed_forward = Some(Reference::Constant(torque));
        *joint = JointControl { feed_forward, ..JointControl::default() };
    }
    let motors = |of: &[f64; 5]| of[2..].iter().map(|angle| 100.0 * angle).collect::<Vec<f64>>();
    let initial = State {
        q: q.to_vec(),
        qd: qd.to_vec(),
        motor: motors(&q),
        motor_rate: motors(&qd),
        ..State::default()
    };
    let run = simulate(&mut plant, &control, &initial, &accurate(DriveModelling::Model, end_s));
    let run = run.expect("it begins");
    assert_eq!(run.stop, Stop::End);
    assert!(run.audit.energy_j < 1e-6, "{}", run.audit.energy_j);
    let turned = run.end.motor.iter().map(|angle| angle / 100.0);
    let found: Vec<f64> = run.end.q.iter().copied().chain(turned).collect();
    let moved = found.iter().zip(q.iter().chain(&q[2..])).map(|(a, b)| (a - b).abs());
    assert!(moved.fold(0.0, f64::max) > 0.1);
    for (found, expected) in found.iter().zip(expected) {
        assert_near(*found, expected, 1e-6);
    }
}
