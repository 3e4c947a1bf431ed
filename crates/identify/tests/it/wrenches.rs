//! Wrenches on links from outside.

use super::robot;
use denavit_measure::log::{JointSignals, LogRemark, MeasuredLog};
use denavit_numerics::Random;
use denavit_plants::{plant_of, point_positions};
use denavit_replay::{add_contact_forces, add_wrenches};

const SAMPLES: usize = 5;

/// A force at a contact is the same force at the origin of its link's frame, and its moment there.
#[test]
fn a_wrench_does_what_the_same_force_at_a_point_does() {
    let mut plant = plant_of(&robot("tulip"), &[]).expect("a plant");
    let model = plant.model().clone();
    let mut random = Random::new(5);
    let joint = |_| {
        let q = (0..SAMPLES).map(|_| 0.4 * random.normal()).collect();
        JointSignals { q, tau: Some(vec![0.0; SAMPLES]), ..JointSignals::default() }
    };
    let joints: Vec<JointSignals> = (0..model.joints.len()).map(joint).collect();
    let mut by_contact = MeasuredLog { joints, ..MeasuredLog::default() };
    let mut by_wrench = by_contact.clone();
    for point in [&model.contacts[0], &model.contacts[model.contacts.len() - 1]] {
        let mut force: [Vec<f64>; 3] = Default::default();
        let mut wrench: [Vec<f64>; 6] = Default::default();
        for sample in 0..SAMPLES {
            let q: Vec<f64> = by_contact.joints.iter().map(|joint| joint.q[sample]).collect();
            let mut transforms = vec![0.0; 12 * model.links.len()];
            plant.link_transforms(&q, &mut transforms);
            let mut place = [0.0; 3];
            point_positions(std::slice::from_ref(point), &transforms, &mut place);
            let origin = |axis: usize| transforms[12 * point.link + 4 * axis + 3];
            let arm: [f64; 3] = std::array::from_fn(|axis| place[axis] - origin(axis));
            let f: [f64; 3] = std::array::from_fn(|_| 100.0 * random.normal());
            let at = |axis: usize| axis % 3;
            for axis in 0..3 {
                let (next, last) = (at(axis + 1), at(axis + 2));
                force[axis].push(f[axis]);
                wrench[axis].push(f[axis]);
                wrench[3 + axis].push(arm[next] * f[last] - arm[last] * f[next]);
            }
        }
        by_contact.contacts.push((point.name.clone(), force));
        by_wrench.wrenches.push((model.links[point.link].clone(), wrench));
    }
    let is_base = vec![false; model.joints.len()];
    add_contact_forces(&mut by_contact, plant.as_mut(), &is_base);
    add_wrenches(&mut by_wrench, plant.as_mut());
    let mut largest: f64 = 0.0;
    for (one, other) in by_contact.joints.iter().zip(&by_wrench.joints) {
        let (one, other) = (one.tau.as_ref().expect("some"), other.tau.as_ref().expect("some"));
        for (one, other) in one.iter().zip(other) {
            assert!((one - other).abs() < 1e-8, "{one} {other}");
            largest = largest.max(one.abs());
        }
    }
    assert!(largest > 10.0, "{largest}");
}

#[test]
fn a_link_that_is_none_is_reported() {
    let mut plant = plant_of(&robot("planar_2r"), &[]).expect("a plant");
    let joint = JointSignals { q: vec![0.1], tau: Some(vec![2.0]), ..JointSignals::default() };
    let mut log = MeasuredLog {
        joints: vec![joint; plant.model().joints.len()],
        wrenches: vec![("gripper".to_owned(), Default::default())],
        ..MeasuredLog::default()
    };
    add_wrenches(&mut log, plant.as_mut());
    assert_eq!(log.remarks, [LogRemark::NoSuchLink { link: "gripper".to_owned() }]);
    assert_eq!(log.joints[0].tau, Some(vec![2.0]));
}
