//! Tests of what is private in `law_curve.rs`.

use super::*;

#[test]
fn a_function_of_velocity_is_explained_by_velocity_alone() {
    let phase = |k: usize| 0.01 * k as f64;
    let position: Vec<f64> = (0..2000).map(|k| phase(k).sin()).collect();
    let velocity: Vec<f64> = (0..2000).map(|k| phase(k).cos()).collect();
    let law: Vec<f64> = velocity.iter().map(|rate| rate.signum()).collect();
    assert!(explained_by(&velocity, &law) > 0.95);
    assert!(explained_by(&position, &law) < 0.2);
}
