//! The laws of joints that follow a planned gait.

use crate::gait_plan::{ContactFriction, JointGains};
use denavit_codegen::model::Fields;
use denavit_simulate::scenario::{FieldsNumbers, Range, Report};

const FRICTION: Range = Range::new(1e-6, 1e3);

/// Gains of all joints, and the friction of contacts where no-slip has no answer.
pub(super) fn read(given: &Fields<'_>, report: &mut Report) -> JointGains {
    let mut gains = gains(given, JointGains::default(), report);
    let friction = given.number("fallback_friction", FRICTION, 0.8, report);
    gains.friction = ContactFriction::Fallback(friction);
    gains
}

/// Gains of all joints, and the friction of the ground.
pub(super) fn read_with_friction(
    given: &Fields<'_>,
    absent: JointGains,
    report: &mut Report,
) -> JointGains {
    let mut gains = gains(given, absent, report);
    let friction = given.number("friction", FRICTION, 0.8, report);
    gains.friction = ContactFriction::Coulomb(friction);
    gains
}

fn gains(given: &Fields<'_>, absent: JointGains, report: &mut Report) -> JointGains {
    JointGains {
        kp: given.number("kp", Range::GAIN, absent.kp, report),
        kd: given.number("kd", Range::GAIN, absent.kd, report),
        ..absent
    }
}
