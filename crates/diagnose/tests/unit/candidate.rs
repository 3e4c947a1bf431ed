//! Tests of what is private in `candidate.rs`.

use super::*;

#[test]
fn a_position_that_may_be_anywhere_is_looked_for_where_the_joint_moves() {
    let of = |unit: &str, nominal, bounds, linear| LawParameter {
        name: String::new(),
        unit: unit.to_owned(),
        nominal,
        bounds,
        start: vec![5.0],
        linear,
    };
    let open = [f64::NEG_INFINITY, f64::INFINITY];
    let stiffness = of("N m/rad", Some(0.0), [0.0, f64::INFINITY], true);
    let stiffness = LawParameter { start: Vec::new(), ..stiffness };
    let place = of("rad", None, open, false);
    let within = starts(&[stiffness.clone(), place.clone()], Some([1.0, 3.0]), None, true);
    assert_eq!(within.len(), PLACES.len());
    assert!(within.iter().all(|one| one[0] == (0.0, None)));
    assert!(within.iter().all(|one| 1.0 < one[1].0 && one[1].0 < 3.0));
    let only = |parameters: &[LawParameter], range| {
        let all = starts(parameters, range, None, true).into_iter();
        let values = |one: Start| one.into_iter().map(|(value, _)| value).collect();
        all.map(values).collect::<Vec<Vec<f64>>>()
    };
    assert_eq!(only(&[stiffness.clone(), place], None), [[0.0, 5.0]]);
    let bounded = of("rad", None, [0.0, 9.0], false);
    assert_eq!(only(&[stiffness, bounded], Some([1.0, 3.0])), [[0.0, 5.0]]);
}

#[test]
fn some_waves_are_asked_only_of_functions_of_the_motion() {
    let waves = LawParameter {
        name: "n".to_owned(),
        unit: "1/rad".to_owned(),
        nominal: None,
        bounds: [1.0, 100.0],
        start: vec![1.5, 6.0, 24.0],
        linear: false,
    };
    let values = |of: &LawParameter, is_of_motion: bool| -> Vec<f64> {
        let all = starts(std::slice::from_ref(of), Some([0.0, 1.0]), None, is_of_motion);
        all.into_iter().map(|one| one[0].0).collect()
    };
    assert_eq!(values(&waves, true), [24.0]);
    assert_eq!(values(&waves, false), [1.5, 6.0, 24.0]);
    // an angle is none of waves, and may begin where it is off
    let angle = LawParameter { unit: "rad".to_owned(), start: vec![-0.3, 0.0, 0.3], ..waves };
    assert_eq!(values(&angle, true), [-0.3, 0.0, 0.3]);
}
