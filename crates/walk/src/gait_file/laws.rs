//! The laws of joints that follow a planned gait.

use crate::gait_plan::JointGains;
use denavit_codegen::model::Fields;
use denavit_simulate::scenario::{FieldsNumbers, Range, Report};

const FRICTION: Range = Range::new(1e-6, 1e3);

/// Gains of all joints, and the friction of contacts where no-slip has no answer.
pub(super) fn read(given: &Fields<'_>, report: &mut Report) -> JointGains {
    let absent = JointGains::default();
    JointGains {
        kp: given.number("kp", Range::GAIN, absent.kp, report),
        kd: given.number("kd", Range::GAIN, absent.kd, report),
        fallback_friction: given.number(
            "fallback_friction",
            FRICTION,
            absent.fallback_friction,
            report,
        ),
    }
}
