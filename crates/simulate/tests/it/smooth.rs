//! Motion without contacts.

use super::{assert_near, plant, plant_with};
use denavit_plants::trajectory::{CosineProfile, Fourier, Reference};
use denavit_plants::{Plant, puma560, tulip};
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{
    Compensation, Control, DriveModelling, Feedback, JointControl, Measurement, Simulation, State,
    Stop, Tolerances, simulate,
};

fn accurate() -> Method {
    Method::DormandPrince(Accuracy { relative: 1e-12, absolute: 1e-13, max_step_s: 0.02 })
}

/// A generated module and an interpreted model are the same plant.
#[test]
fn generated_and_interpreted_plants_agree() {
    for (name, mut generated) in
        [("tulip", tulip(&[]).unwrap()), ("puma560", puma560(&[]).unwrap())]
    {
        let mut interpreted = plant(name);
        assert_eq!(generated.model(), interpreted.model());
        let n = generated.model().joints.len();
        let c = 3 * generated.model().contacts.len();
        let links = 12 * generated.model().links.len();
        let q: Vec<f64> = (0..n).map(|i| 0.3 * (i as f64 + 1.0).sin()).collect();
        let qd: Vec<f64> = (0..n).map(|i| 0.7 * (i as f64).cos()).collect();
        let mut values = Vec::new();
        for plant in [generated.as_mut(), &mut interpreted as &mut dyn Plant] {
            let mut all = vec![0.0; n * n + n + c + c * n + c + links];
            let (mass, rest) = all.split_at_mut(n * n);
            let (bias, rest) = rest.split_at_mut(n);
            let (positions, rest) = rest.split_at_mut(c);
            let (jacobian, rest) = rest.split_at_mut(c * n);
            let (contact_bias, transforms) = rest.split_at_mut(c);
            plant.mass_matrix(&q, mass);
            plant.bias(&q, &qd, bias);
            plant.contact_positions(&q, positions);
            plant.contact_jacobian(&q, jacobian);
            plant.contact_bias(&q, &qd, contact_bias);
            plant.link_transforms(&q, transforms);
            all.extend([plant.kinetic_energy(&q, &qd), plant.potential_energy(&q)]);
            all.extend(plant.center_of_mass(&q));
            all.extend(plant.momentum(&q, &qd));
            values.push(all);
        }
        for (a, b) in values[0].iter().zip(&values[1]) {
            assert_near(*a, *b, 1e-9 * b.abs().max(1.0));
        }
    }
}

#[test]
fn a_swinging_double_pendulum_keeps_its_energy() {
    let mut plant = plant("double_pendulum");
    let control = Control::passive(2);
    let mut initial = State::resting(vec![1.0, 0.5]);
    initial.qd = vec![0.0, 3.0];
    for (method, allowed) in [
        (accurate(), 1e-8),
        (Method::Radau(Accuracy { relative: 1e-9, absolute: 1e-10, max_step_s: 0.02 }), 1e-5),
        (Method::RungeKutta { step_s: 1e-3 }, 1e-5),
    ] {
        let simulation = Simulation { end_s: 5.0, method, ..Simulation::default() };
        let run = simulate(&mut plant, &control, &initial, &simulation).unwrap();
        assert_eq!(run.stop, Stop::End);
        assert_near(run.audit.energy_j, 0.0, allowed);
        assert_eq!(run.log.len(), 501);
    }
}

/// With computed torque the error obeys e'' + kd e' + kp e = 0 exactly.
#[test]
fn computed_torque_makes_the_error_linear() {
    let mut plant = plant("puma560");
    let model = plant.model().clone();
    let reference = |joint: usize| {
        Reference::Fourier(Fourier::new(2.0, 0.1 * joint as f64, vec![0.2], vec![0.1]).unwrap())
    };
    let (stiffness, damping) = (100.0, 10.0);
    let control = Control {
        joints: (0..6)
            .map(|joint| JointControl {
                reference: Some(reference(joint)),
                stiffness,
                damping,
                ..JointControl::default()
            })
            .collect(),
        compensation: Compensation::ComputedTorque,
        ..Control::default()
    };
    let mut initial = State::resting(vec![0.0; model.joints.len()]);
    for joint in 0..6 {
        let start = reference(joint).at(0.0);
        initial.q[joint] = start.position + 0.3;
        initial.qd[joint] = start.rate;
    }
    let simulation = Simulation { end_s: 1.0, method: accurate(), ..Simulation::default() };
    let run = simulate(&mut plant, &control, &initial, &simulation).unwrap();
    let rate = (stiffness - damping * damping / 4.0_f64).sqrt();
    let decay = (-damping / 2.0_f64).exp();
    let error = 0.3 * decay * (rate.cos() + damping / (2.0 * rate) * rate.sin());
    for joint in 0..6 {
        assert_near(run.end.q[joint] - reference(joint).at(1.0).position, error, 1e-9);
    }
}

/// The leg of the thesis with its motors, springs and viscous friction, tracking: the books
/// balance.
#[test]
fn a_leg_with_series_elastic_drives_tracks_and_balances_its_energy() {
    let joints = ["hip_z", "hip_x", "hip_y", "knee", "ankle_y"];
    let smooth = joints.map(|joint| format!("fc_{joint}"));
    let smooth = smooth.each_ref().map(|name| (name.as_str(), 0.0));
    let mut plant = plant_with("tulip_leg", &smooth);
    let n = plant.model().joints.len();
    let reference = |joint: usize| {
        let target = [0.1, 0.05, -0.4, 0.8, -0.4][joint];
        Some(Reference::Cosine(CosineProfile::new([0.1, 0.6], [0.0, target]).unwrap()))
    };
    let mut control = Control::proportional((0..n).map(reference).collect(), 200.0, 10.0);
    control.compensation = Compensation::Gravity;
    control.feedback = Feedback::Motor;
    let simulation =
        Simulation { end_s: 1.5, drives: DriveModelling::Model, ..Simulation::default() };
    let run = simulate(&mut plant, &control, &State::resting(vec![0.0; n]), &simulation).unwrap();
    assert_eq!(run.stop, Stop::End);
    assert_eq!(run.end.motor.len(), 3);
    for joint in 0..n {
        let target = reference(joint).unwrap().at(1.5).position;
        assert_near(run.end.q[joint], target, 0.1);
    }
    assert!(run.audit.exchanged_j > 1.0);
    let tolerances = Tolerances { energy_j: 1e-3, ..Tolerances::default() };
    assert!(run.audit.broken(&tolerances).is_empty(), "{:?}", run.audit);
    // a motor turns N times its joint, less the stretch of the spring
    let motor = run.log.column("motor_knee").unwrap();
    let knee = run.log.column("q_knee").unwrap();
    assert_near(motor[150] / 100.0, knee[150], 0.1);
}

#[test]
fn a_sampled_controller_sees_quantised_delayed_noise_from_its_seed() {
    let mut plant = plant("planar_2r");
    let mut control = Control::proportional(vec![Some(Reference::Constant(0.5)); 2], 40.0, 4.0);
    control.period_s = Some(1e-3);
    control.compensation = Compensation::Gravity;
    let measurement = Measurement {
        resolution: 1e-3,
        position_noise: 1e-3,
        rate_noise: 1e-2,
        delay_samples: 2,
        differentiates: false,
    };
    let mut run = |seed| {
        let simulation = Simulation { end_s: 1.0, seed, measurement, ..Simulation::default() };
        simulate(&mut plant, &control, &State::resting(vec![0.0; 2]), &simulation).unwrap()
    };
    let (first, again, other) = (run(1), run(1), run(2));
    assert_eq!(first.log, again.log);
    assert_ne!(first.log, other.log);
    assert!((first.end.q[0] - other.end.q[0]).abs() < 0.02);
}

/// A torque that saturates cannot lift what is heavier.
#[test]
fn overridden_gravity_is_felt() {
    let mut plant = plant_with("double_pendulum", &[("g", 0.0)]);
    let initial = State { qd: vec![1.0, 0.0], ..State::resting(vec![0.0, 0.0]) };
    let run = simulate(&mut plant, &Control::passive(2), &initial, &Simulation::default()).unwrap();
    // without gravity the potential energy stays what it was
    let energy = run.log.column("energy").unwrap();
    assert_near(energy[100], plant.kinetic_energy(&initial.q, &initial.qd), 1e-9);
}
