//! The torques per unit of the ten parameters of each link, in frames that are the links' own.
//!
//! The twists are pulled from link frame to link frame, so that nothing is converted afterwards:
//! the frame of a standard row lies behind its joint, where the twists go on to the next joint
//! anyway. Along parallel axes the angular parts may be taken from where the group begins, by the
//! cumulated angle: there they are often constant.

use super::axle::Axle;
use super::inertial::ENTRIES;
use super::matter::{FrameMotion, power_on_parameters};
use super::pull::{MotionTerms, State};
use crate::expr::{Dag, ExprId};
use crate::kinematics::{Mechanism, MovingBody, Placement};
use crate::model::{LinkId, Robot};
use crate::spatial::{Axis, Turn, Vector, add, subtract};

/// What spares operations. Each is exact; which of them pay is decided by counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Shortcuts {
    /// Angular parts cross a group of parallel axes at once.
    pub(super) grouped: bool,
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
    (links, shortcuts): (&[LinkId], Shortcuts),
) -> Vec<LinkShares> {
    // The link whose joint moves the body; its frame is where the body's motion is followed.
    let hosts: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
    let mut states: Vec<State> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    let mut of_hosts: Vec<LinkShares> = Vec::new();
    for (j, body) in mechanism.bodies.iter().enumerate() {
        let origin = origin(dag, body);
        let (before, offset, turns) = match body.parent {
            Some(parent) => {
                let host = &mechanism.placements[hosts[parent]];
                let (offset, turns) = relative(dag, host, origin, &body.turns);
                (states[parent].clone(), offset, turns)
            }
            None => {
                let ground = State::fixed(dag, mechanism.gravity, terms);
                (ground, origin, body.turns.clone())
            }
        };
        let seat = before.moved_then_turned(dag, offset, turns.iter());
        let carrier = body.parent.filter(|&p| continues(mechanism, p, body));
        let group = match carrier.filter(|_| shortcuts.grouped) {
            Some(parent) => groups[parent].continued(body),
            None => Group { seat: seat.clone(), chain: vec![body.clone()] },
        };
        let own_turn = body.angle.map(|angle| Turn::new(dag, Axis::Z, angle));
        let none = [dag.zero(); 3];
        let state = seat.moved_then_turned(dag, none, own_turn.iter());
        let mut state = state.jointed(dag, (body.variables, body.is_revolute), (j, terms));
        if group.chain.len() > 1 {
            group.take_angular(dag, &mut state, terms);
        }
        groups.push(group);
        let host = &mechanism.placements[hosts[j]];
        let state = placed(dag, &state, host.offset, &host.turns);
        let mut shares = shares(dag, &state);
        if body.is_revolute {
            let carrier = body.parent.map_or(&[][..], |parent| &of_hosts[parent]);
            let seat = Axle::of_carrier(dag, offset, &turns);
            let axle = Axle::of_body(dag, host);
            if let (Some(seat), Some(axle)) = (seat, axle) {
                axle.spare(dag, &mut shares, (&seat, carrier), shortcuts);
            }
        }
        of_hosts.push(shares);
        states.push(state);
    }
    let mut of_link = |&link: &LinkId| {
        let placement = &mechanism.placements[link];
        let Some(body) = placement.body else { return Vec::new() };
        if hosts[body] == link {
            return of_hosts[body].clone();
        }
        let host = &mechanism.placements[hosts[body]];
        let (offset, turns) = relative(dag, host, placement.offset, &placement.turns);
        let state = states[body].moved_then_turned(dag, offset, turns.iter());
        shares(dag, &state)
    };
    links.iter().map(&mut of_link).collect()
}

fn shares(dag: &mut Dag, state: &State) -> LinkShares {
    let State { motion, twists } = state;
    twists
        .iter()
        .map(|twist| {
            let torques = power_on_parameters(dag, motion, (twist.angular, twist.linear));
            (twist.row, torques)
        })
        .collect()
}

/// The origin of a body's frame in its carrier's, with the slide of a sliding joint.
fn origin(dag: &mut Dag, body: &MovingBody) -> Vector {
    if body.is_revolute {
        return body.offset;
    }
    let slide = [dag.zero(), dag.zero(), body.variables.q];
    let slide = body.turns.iter().rev().fold(slide, |slide, turn| turn.to_parent(dag, slide));
    add(dag, body.offset, slide)
}

/// A place of a body as seen from the frame of its host: offset in the host frame's coordinates,
/// and turns from there.
fn relative(
    dag: &mut Dag,
    host: &Placement,
    offset: Vector,
    turns: &[Turn],
) -> (Vector, Vec<Turn>) {
    let between = subtract(dag, offset, host.offset);
    let between = host.turns.iter().fold(between, |vector, turn| turn.to_child(dag, vector));
    if let Some(rest) = turns.strip_prefix(&host.turns[..]) {
        return (between, rest.to_vec());
    }
    let mut all: Vec<Turn> = Vec::new();
    for turn in host.turns.iter().rev() {
        let angle = dag.neg(turn.angle);
        all.push(Turn::new(dag, turn.axis, angle));
    }
    all.extend(turns);
    (between, all)
}

/// The frame of a link from that of its body.
fn placed(dag: &mut Dag, state: &State, offset: Vector, turns: &[Turn]) -> State {
    let offset = turns.iter().fold(offset, |vector, turn| turn.to_child(dag, vector));
    state.turned_then_moved(dag, offset, turns.iter())
}

/// Whether a body's axis is parallel to that of its carrier, both turning.
fn continues(mechanism: &Mechanism, parent: usize, body: &MovingBody) -> bool {
    body.is_revolute && body.turns.is_empty() && mechanism.bodies[parent].is_revolute
}

/// Bodies on parallel axes, each carried by the one before.
struct Group {
    /// The frame of the first before its joint turns.
    seat: State,
    chain: Vec<MovingBody>,
}

impl Group {
    fn continued(&self, body: &MovingBody) -> Self {
        let mut chain = self.chain.clone();
        chain.push(body.clone());
        Self { seat: self.seat.clone(), chain }
    }

    /// Replaces what turns in the state of the last body by what one joint does that turns by the
    /// sum of the angles.
    fn take_angular(&self, dag: &mut Dag, state: &mut State, terms: MotionTerms) {
        let last = self.chain.last().expect("a group has bodies");
        let mut variables = last.variables;
        let mut angle = None;
        for (place, body) in self.chain.iter().enumerate() {
            angle = match (angle, body.angle) {
                (Some(sum), Some(own)) => Some(dag.add(sum, own)),
                (sum, own) => sum.or(own),
            };
            let own = body.variables;
            (variables.qd, variables.qdd) = match place {
                0 => (own.qd, own.qdd),
                _ => (dag.add(variables.qd, own.qd), dag.add(variables.qdd, own.qdd)),
            };
        }
        let turn = angle.map(|angle| Turn::new(dag, Axis::Z, angle));
        let none = [dag.zero(); 3];
        let at_once = self.seat.moved_then_turned(dag, none, turn.iter());
        let row = state.twists.len();
        let at_once = at_once.jointed(dag, (variables, true), (row, terms));
        let linear = state.motion.linear;
        state.motion = FrameMotion { linear, ..at_once.motion };
        let before = at_once.twists.len() - 1;
        for (twist, angular) in state.twists.iter_mut().zip(&at_once.twists[..before]) {
            twist.angular = angular.angular;
        }
    }
}
