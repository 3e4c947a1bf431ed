//! The torques per unit of the pseudo-inertia entries of each body, in the frame on its joint's
//! axis: there the joint's own twist is (0, 0, 1), and its own torques are numbers of the motion.

use super::follow::{Route, follow};
use super::link_frames::LinkShares;
use super::matter::power_on_entries;
use super::pull::MotionTerms;
use crate::expr::Dag;
use crate::kinematics::Mechanism;
use crate::model::Robot;

/// The shares of each body: joint by joint of the chain that carries it, in the order of
/// [`entries`](super::inertial::entries).
pub(super) fn axis_shares(
    dag: &mut Dag,
    robot: &Robot,
    mechanism: &Mechanism,
    terms: MotionTerms,
    route: Route,
) -> Vec<LinkShares> {
    let stops = follow(dag, robot, mechanism, terms, route);
    stops
        .iter()
        .map(|stop| {
            let (motion, twists) = (&stop.on_axis.motion, &stop.on_axis.twists);
            twists
                .iter()
                .map(|twist| {
                    let power = power_on_entries(dag, motion, twist.angular, twist.linear);
                    (twist.row, power)
                })
                .collect()
        })
        .collect()
}
