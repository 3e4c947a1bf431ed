//! The motion of each body and the twists of all joints, followed from joint to joint outwards.
//!
//! Both are known in two frames of a body: that on its joint's axis, and that of the link whose
//! joint it is (its host), which lies behind the joint. From either of them the way may go on to
//! the next joint; along parallel axes the angular parts may be taken from where the group begins,
//! by the cumulated angle: there they are often constant.

use super::matter::FrameMotion;
use super::pull::{MotionTerms, State};
use crate::expr::{Dag, ExprId};
use crate::fundamental::canonical_generic;
use crate::kinematics::{Mechanism, MovingBody, Placement};
use crate::model::{LinkId, Robot};
use crate::spatial::{Axis, Turn, Vector, add, subtract};

/// Which way the motion is followed. All give the same; which is cheapest is decided by counting.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Route {
    /// Angular parts cross a group of parallel axes at once.
    pub(super) grouped: bool,
    /// From the frame on one axis to that on the next, not by way of the frame of the link.
    pub(super) by_axes: bool,
    /// What lies between two joints along the axis of the second comes last: a point of the axis
    /// moves with either body.
    pub(super) split: bool,
}

/// What is known of a body.
pub(super) struct Stop {
    /// In the frame on its joint's axis, which turns with it.
    pub(super) on_axis: State,
    /// In the frame of its host.
    pub(super) in_link: State,
    /// The origin of its joint in the frame of its carrier's host (in that of frame 0), ...
    pub(super) seat_offset: Vector,
    /// ... and how the joint is turned there.
    pub(super) seat_turns: Vec<Turn>,
}

/// The link whose joint moves each body.
pub(super) fn hosts(robot: &Robot) -> Vec<LinkId> {
    robot.joints().map(|(link, _)| link).collect()
}

/// Follows the motion to each body.
pub(super) fn follow(
    dag: &mut Dag,
    robot: &Robot,
    mechanism: &Mechanism,
    terms: MotionTerms,
    route: Route,
) -> Vec<Stop> {
    let hosts = hosts(robot);
    let mut stops: Vec<Stop> = Vec::new();
    let mut groups: Vec<Group> = Vec::new();
    for (j, body) in mechanism.bodies.iter().enumerate() {
        let origin = origin(dag, body);
        let (seat_offset, seat_turns) = match body.parent {
            Some(parent) => {
                relative(dag, &mechanism.placements[hosts[parent]], origin, &body.turns)
            }
            None => (origin, body.turns.clone()),
        };
        let (seat, along) = match body.parent {
            Some(parent) => {
                let before = &stops[parent];
                let (state, offset, turns) = match route.by_axes {
                    true => (&before.on_axis, origin, &body.turns),
                    false => (&before.in_link, seat_offset, &seat_turns),
                };
                let (across, along) = match route.split && body.is_revolute {
                    true => split(dag, offset, turns),
                    false => (offset, dag.zero()),
                };
                (state.moved_then_turned(dag, across, turns.iter()), along)
            }
            None => {
                let ground = State::fixed(dag, mechanism.gravity, terms);
                (ground.turned(dag, body.turns.iter()), dag.zero())
            }
        };
        let carrier = body.parent.filter(|&p| continues(mechanism, p, body));
        let group = match carrier.filter(|_| route.grouped) {
            Some(parent) => groups[parent].continued(body),
            None => Group { seat: seat.clone(), chain: vec![body.clone()] },
        };
        let own_turn = body.angle.map(|angle| Turn::new(dag, Axis::Z, angle));
        let state = seat.turned(dag, own_turn.iter());
        let mut on_axis = state.jointed(dag, body.variables, body.is_revolute, j, terms);
        if group.chain.len() > 1 {
            group.take_angular(dag, &mut on_axis, terms);
        }
        let along = [dag.zero(), dag.zero(), along];
        on_axis.shift(dag, along);
        groups.push(group);
        let host = &mechanism.placements[hosts[j]];
        let in_link = placed(dag, &on_axis, host.offset, &host.turns);
        stops.push(Stop { on_axis, in_link, seat_offset, seat_turns });
    }
    stops
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
pub(super) fn relative(
    dag: &mut Dag,
    host: &Placement,
    offset: Vector,
    turns: &[Turn],
) -> (Vector, Vec<Turn>) {
    let between = subtract(dag, offset, host.offset);
    let between = host.turns.iter().fold(between, |vector, turn| turn.to_child(dag, vector));
    let between = between.map(|component| shown(dag, component));
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

/// An offset, given before turns, as what is across the z axis after them and what is along it.
fn split(dag: &mut Dag, offset: Vector, turns: &[Turn]) -> (Vector, ExprId) {
    let turned = turns.iter().fold(offset, |vector, turn| turn.to_child(dag, vector));
    let along = shown(dag, turned[2]);
    let back = [dag.zero(), dag.zero(), along];
    let back = turns.iter().rev().fold(back, |vector, turn| turn.to_parent(dag, vector));
    let across = subtract(dag, offset, back);
    (across.map(|component| shown(dag, component)), along)
}

/// A known length in its shortest form: what is turned there and back is what it was.
fn shown(dag: &mut Dag, length: ExprId) -> ExprId {
    if dag.is_run_time(length) {
        return length;
    }
    match canonical_generic(dag, &[length]) {
        Ok(forms) if forms[0].len() <= 1 => forms[0].to_expr(dag),
        _ => length,
    }
}

/// The frame of a link from that of its body.
pub(super) fn placed(dag: &mut Dag, state: &State, offset: Vector, turns: &[Turn]) -> State {
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
        let at_once = at_once.jointed(dag, variables, true, row, terms);
        let linear = state.motion.linear;
        state.motion = FrameMotion { linear, ..at_once.motion };
        let before = at_once.twists.len() - 1;
        for (twist, angular) in state.twists.iter_mut().zip(&at_once.twists[..before]) {
            twist.angular = angular.angular;
        }
    }
}
