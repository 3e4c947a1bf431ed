//! Gaits: their postures meet their conditions, and the robot walks them.

mod event_driven_step;
mod passive_walkers;
mod poincare;
mod weight_shift_step;

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64) {
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}: off by {:.3e}, allowed {tolerance:.0e}",
        (found - expected).abs()
    );
}
