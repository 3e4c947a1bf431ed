//! The rigid bodies that move. Links on fixed rows are part of the body that carries them.

use crate::arena::SecondaryMap;
use crate::expr::{Dag, ExprId, angle_atoms};
use crate::model::{About, Convention, JointKind, JointVariables, Link, LinkId, Robot};
use crate::spatial::{Axis, PseudoInertia, Turn, Vector, add, zero};

/// A frame fixed in a moving body, or in frame 0: turned by `turns` (first turn outermost), its
/// origin at `offset` in the coordinates of the carrier.
#[derive(Clone, Debug)]
pub struct Placement {
    /// The moving body that carries the frame; none for frame 0.
    pub body: Option<usize>,
    /// The rotation, carrier to frame.
    pub turns: Vec<Turn>,
    /// The origin \[m\].
    pub offset: Vector,
}

/// A rigid body with the joint that carries it. Its frame has the joint axis as z axis and turns
/// with the joint (a "proximal" frame: a row's a and alpha belong to what comes after it).
#[derive(Clone, Debug)]
pub struct MovingBody {
    /// The body that carries the joint; none for frame 0.
    pub parent: Option<usize>,
    /// Whether the joint turns; if not, it slides.
    pub is_revolute: bool,
    /// Constant rotation from the parent's frame to the joint, before the joint angle.
    pub turns: Vec<Turn>,
    /// The joint angle \[rad\] with its constant part; none for a sliding joint.
    pub angle: Option<ExprId>,
    /// Origin in the parent's frame \[m\], for a sliding joint at q = 0.
    pub offset: Vector,
    /// The joint's symbols.
    pub variables: JointVariables,
    /// All matter of the body, about the origin of its frame.
    pub inertia: PseudoInertia,
}

/// The moving bodies of a robot, in the order of the joint variables; parents come first.
#[derive(Clone, Debug)]
pub struct Mechanism {
    /// The bodies; index j belongs to the j-th joint variable.
    pub bodies: Vec<MovingBody>,
    /// Where each link's own frame is.
    pub placements: SecondaryMap<LinkId, Placement>,
    /// Acceleration of free fall in frame 0 [m/s^2].
    pub gravity: Vector,
}

impl Mechanism {
    /// Reads the table of `robot`. The expressions go to `dag`, which must know the robot's symbols
    /// (a copy of `robot.dag`).
    pub fn new(dag: &mut Dag, robot: &Robot) -> Self {
        let base = Placement { body: None, turns: Vec::new(), offset: zero(dag) };
        let mut mechanism = Self {
            bodies: Vec::new(),
            placements: SecondaryMap::filled(base.clone(), robot.links.len()),
            gravity: robot.gravity,
        };
        for (id, link) in robot.links.iter() {
            let carrier = match link.parent {
                Some(parent) => mechanism.placements[parent].clone(),
                None => base.clone(),
            };
            let is_tip = !robot
                .tree
                .subtree(id)
                .iter()
                .any(|&other| other != id && robot.links[other].joint.variables.is_some());
            let placement = mechanism.attach(dag, robot.convention, link, is_tip, carrier);
            if let (Some(index), Some(body)) = (placement.body, &link.body) {
                let central = body.about == About::Com;
                let own = PseudoInertia::from_body(dag, body.mass, body.com, body.inertia, central);
                let carried = placement.carry(dag, &own);
                let total = mechanism.bodies[index].inertia.add(dag, &carried);
                mechanism.bodies[index].inertia = total;
            }
            mechanism.placements.set(id, placement);
        }
        mechanism
    }

    /// Adds the joint of `link`, which may carry no further joint (`is_tip`), on `carrier` and
    /// returns the placement of the link's frame.
    fn attach(
        &mut self,
        dag: &mut Dag,
        convention: Convention,
        link: &Link,
        is_tip: bool,
        mut carrier: Placement,
    ) -> Placement {
        let joint = &link.joint;
        if convention == Convention::Modified {
            carrier.turn(dag, Axis::X, joint.alpha);
            carrier.slide(dag, [joint.a, dag.zero(), dag.zero()]);
        }
        let along_z = [dag.zero(), dag.zero(), joint.d];
        // A body's origin may be anywhere on its axis: where nothing is carried further, the
        // offset along the axis is the link's own affair.
        let slides_after = joint.kind == JointKind::Revolute && is_tip;
        if !slides_after {
            carrier.slide(dag, along_z);
        }
        let mut placement = match joint.variables {
            None => {
                carrier.turn(dag, Axis::Z, joint.theta);
                carrier
            }
            Some(variables) => {
                let revolute = joint.kind == JointKind::Revolute;
                let angle = revolute.then(|| {
                    let constant = carrier.take_last_z_turn(dag, joint.theta);
                    dag.add(variables.q, constant)
                });
                if !revolute {
                    carrier.turn(dag, Axis::Z, joint.theta);
                }
                let inertia = PseudoInertia::zero(dag);
                self.bodies.push(MovingBody {
                    parent: carrier.body,
                    is_revolute: revolute,
                    turns: carrier.turns,
                    angle,
                    offset: carrier.offset,
                    variables,
                    inertia,
                });
                let body = Some(self.bodies.len() - 1);
                let offset = if slides_after { along_z } else { zero(dag) };
                Placement { body, turns: Vec::new(), offset }
            }
        };
        if convention == Convention::Standard {
            placement.slide(dag, [joint.a, dag.zero(), dag.zero()]);
            placement.turn(dag, Axis::X, joint.alpha);
        }
        placement
    }

    /// Number of joint variables.
    pub fn degrees_of_freedom(&self) -> usize {
        self.bodies.len()
    }

    /// Whether a body has no matter for any value of the parameters.
    pub fn is_massless(&self, dag: &Dag, body: usize) -> bool {
        self.bodies[body].inertia == PseudoInertia::zero(dag)
    }
}

impl Placement {
    /// Appends a turn; turns about one axis merge, and whole turns vanish.
    fn turn(&mut self, dag: &mut Dag, axis: Axis, angle: ExprId) {
        let angle = match self.turns.last() {
            Some(last) if last.axis == axis => {
                let sum = dag.add(last.angle, angle);
                self.turns.pop();
                sum
            }
            _ => angle,
        };
        let angle = if angle_atoms(dag, angle).is_empty() { dag.zero() } else { angle };
        let turn = Turn::new(dag, axis, angle);
        if !turn.is_identity(dag) {
            self.turns.push(turn);
        }
    }

    /// Moves the origin by `step`, given in the frame's own coordinates.
    fn slide(&mut self, dag: &mut Dag, step: Vector) {
        let step = to_parent(dag, &self.turns, step);
        self.offset = add(dag, self.offset, step);
    }

    /// `angle` plus the angle of a last turn about z, which is taken away: a constant turn before
    /// a joint about the same axis is part of the joint angle.
    fn take_last_z_turn(&mut self, dag: &mut Dag, angle: ExprId) -> ExprId {
        match self.turns.last() {
            Some(last) if last.axis == Axis::Z => {
                let sum = dag.add(last.angle, angle);
                self.turns.pop();
                sum
            }
            _ => angle,
        }
    }

    /// Matter given in this frame, in the coordinates and about the origin of the carrier.
    pub fn carry(&self, dag: &mut Dag, inertia: &PseudoInertia) -> PseudoInertia {
        let turned =
            self.turns.iter().rev().fold(*inertia, |inertia, turn| inertia.turned(dag, turn));
        turned.shifted(dag, self.offset)
    }
}

/// A vector through a list of turns, innermost coordinates to outermost.
pub(super) fn to_parent(dag: &mut Dag, turns: &[Turn], vector: Vector) -> Vector {
    turns.iter().rev().fold(vector, |vector, turn| turn.to_parent(dag, vector))
}
