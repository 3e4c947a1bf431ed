//! What is said of work that is large.

use super::said::say_note;
use denavit::model::Robot;

/// From so many joints on, functions whose size grows with the cube of that number take seconds:
/// 3 n^3 operations are then half a million.
const MANY_JOINTS: usize = 55;

/// Writes to standard error that the functions of a long chain take their time.
pub(crate) fn print_size(robot: &Robot, has_derivatives: bool) {
    let joints = robot.joints().count();
    if joints >= MANY_JOINTS && has_derivatives {
        say_note(&format_args!(
            "remark: {}: forward_dynamics_derivatives grows with the cube of {joints} joints\n  \
             hint: `--functions` chooses others",
            robot.name
        ));
    }
}
