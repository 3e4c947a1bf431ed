//! The torques per unit of the ten parameters of each link, in frames that are the links' own.
//!
//! The twists are looked at in link frames, so that nothing is converted afterwards: the frame of
//! a standard row lies behind its joint, where the twists go on to the next joint anyway.

use super::axle::Axle;
use super::follow::{Route, follow, hosts, relative};
use super::inertial::ENTRIES;
use super::matter::power_on_parameters;
use super::pull::{MotionTerms, State};
use crate::expr::{Dag, ExprId};
use crate::kinematics::Mechanism;
use crate::model::{LinkId, Robot};

/// What spares operations. Each is exact; which of them pay is decided by counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Shortcuts {
    /// How the motion is followed.
    pub(super) route: Route,
    /// Matter on a joint's axis is felt like the carrier's: from that come the torques of a second
    /// moment across the axis ...
    pub(super) second: bool,
    /// ... of the first moment along the axis ...
    pub(super) first: bool,
    /// ... and of the mass.
    pub(super) mass: bool,
}

/// Torques per unit of the ten parameters of one link, joint by joint of the chain that carries it.
pub(super) type LinkShares = Vec<(usize, [ExprId; ENTRIES])>;

/// The shares of each link of `links`, root first.
pub(super) fn link_shares(
    dag: &mut Dag,
    robot: &Robot,
    mechanism: &Mechanism,
    terms: MotionTerms,
    links: &[LinkId],
    shortcuts: Shortcuts,
) -> Vec<LinkShares> {
    let hosts = hosts(robot);
    let stops = follow(dag, robot, mechanism, terms, shortcuts.route);
    let mut of_hosts: Vec<LinkShares> = Vec::new();
    for (j, body) in mechanism.bodies.iter().enumerate() {
        let stop = &stops[j];
        let mut shares = shares(dag, &stop.in_link);
        if body.is_revolute {
            let carrier = body.parent.map_or(&[][..], |parent| &of_hosts[parent]);
            let seat = Axle::of_carrier(dag, stop.seat_offset, &stop.seat_turns);
            let axle = Axle::of_body(dag, &mechanism.placements[hosts[j]]);
            if let (Some(seat), Some(axle)) = (seat, axle) {
                axle.spare(dag, &mut shares, &seat, carrier, shortcuts);
            }
        }
        of_hosts.push(shares);
    }
    let mut of_link = |&link: &LinkId| {
        let placement = &mechanism.placements[link];
        let Some(body) = placement.body else { return Vec::new() };
        if hosts[body] == link {
            return of_hosts[body].clone();
        }
        let host = &mechanism.placements[hosts[body]];
        let (offset, turns) = relative(dag, host, placement.offset, &placement.turns);
        let state = stops[body].in_link.moved_then_turned(dag, offset, turns.iter());
        shares(dag, &state)
    };
    links.iter().map(&mut of_link).collect()
}

fn shares(dag: &mut Dag, state: &State) -> LinkShares {
    let State { motion, twists } = state;
    twists
        .iter()
        .map(|twist| {
            let torques = power_on_parameters(dag, motion, twist.angular, twist.linear);
            (twist.row, torques)
        })
        .collect()
}
