//! Columns that nothing was measured of.

use denavit_evidence::Told;

#[test]
fn without_measurements_what_is_believed_stays() {
    let told = Told::of(&[], &[1.5, -2.0], &[f64::NEG_INFINITY; 2], 10);
    assert_eq!(told.factors.as_slice(), [1.5, -2.0]);
    assert_eq!(told.deviations.as_slice(), [1.0, 1.0]);
    assert!(told.log_evidence.abs() < 1e-12, "nothing is told: {}", told.log_evidence);
}
