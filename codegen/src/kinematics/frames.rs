//! One frame for each body, in which the recursions run.

use super::mechanism::{Mechanism, to_parent};
use crate::expr::Dag;
use crate::model::JointVariables;
use crate::spatial::{Axis, PseudoInertia, Turn, Vector, add};

/// The frame of one body: how it lies in its parent's frame, and the body's matter in it.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The parent's frame; none for frame 0.
    pub parent: Option<usize>,
    /// Whether the joint turns about the frame's z axis; if not, it slides along it.
    pub is_revolute: bool,
    /// Constant rotation, parent to joint.
    pub seat: Vec<Turn>,
    /// The joint's own turn, which follows; none for a sliding joint, and for a frame that does not
    /// turn with its joint.
    pub joint_turn: Option<Turn>,
    /// Origin in the parent's frame \[m\].
    pub offset: Vector,
    /// The joint's symbols.
    pub variables: JointVariables,
    /// The body's matter about the frame's origin.
    pub inertia: PseudoInertia,
    /// The rotation from the frame to coordinates fixed in the body, where they differ: a frame of
    /// a group of parallel axes does not turn with its own joint.
    pub attachment: Option<Turn>,
}

impl Frame {
    /// The rotation, parent to frame.
    pub fn turns(&self) -> impl DoubleEndedIterator<Item = &Turn> {
        self.seat.iter().chain(&self.joint_turn)
    }
}

/// The frames of a mechanism; parents come first.
#[derive(Clone, Debug)]
pub struct Frames {
    /// Index j belongs to the j-th joint variable.
    pub frames: Vec<Frame>,
    /// Acceleration of free fall in frame 0 [m/s^2].
    pub gravity: Vector,
}

impl Frames {
    /// Each frame turns with its joint.
    pub fn plain(dag: &mut Dag, mechanism: &Mechanism) -> Self {
        Self::build(dag, mechanism, &vec![false; mechanism.bodies.len()])
    }

    /// Along a group of parallel revolute axes the frames keep the orientation in which the group
    /// begins, and the last turns by the cumulated angle of the group. `None` if there is no group.
    pub fn grouped(dag: &mut Dag, mechanism: &Mechanism) -> Option<Self> {
        let continues = group_members(mechanism);
        let any = continues.contains(&true);
        any.then(|| Self::build(dag, mechanism, &continues))
    }

    /// `continues[i]`: body i's axis is parallel to its parent's, and they form one group.
    fn build(dag: &mut Dag, mechanism: &Mechanism, continues: &[bool]) -> Self {
        let bodies = &mechanism.bodies;
        let keeps: Vec<bool> = (0..bodies.len())
            .map(|i| (0..bodies.len()).any(|j| continues[j] && bodies[j].parent == Some(i)))
            .collect();
        let mut frames: Vec<Frame> = Vec::new();
        let mut cumulated = Vec::new();
        for (i, body) in bodies.iter().enumerate() {
            let parent_turn = body.parent.filter(|_| continues[i]).map(|p| (p, cumulated[p]));
            let angle = match (body.angle, parent_turn) {
                (Some(own), Some((_, Some(before)))) => Some(dag.add(before, own)),
                (own, _) => own,
            };
            cumulated.push(angle);
            let seat = if continues[i] { Vec::new() } else { body.turns.clone() };
            let own_turn = angle.map(|angle| Turn::new(dag, Axis::Z, angle));
            let mut offset = body.offset;
            if !body.is_revolute {
                let slide = [dag.zero(), dag.zero(), body.variables.q];
                let slide = to_parent(dag, &body.turns, slide);
                offset = add(dag, offset, slide);
            }
            // The parent's frame may not turn with the parent's body, where the offset is fixed.
            if let Some(attachment) = body.parent.and_then(|p| frames[p].attachment) {
                offset = attachment.to_parent(dag, offset);
            }
            let (mut inertia, mut attachment, mut joint_turn) = (body.inertia, None, own_turn);
            if let Some(turn) = own_turn.filter(|_| keeps[i]) {
                inertia = inertia.turned(dag, &turn);
                (attachment, joint_turn) = (Some(turn), None);
            }
            frames.push(Frame {
                parent: body.parent,
                is_revolute: body.is_revolute,
                seat,
                joint_turn,
                offset,
                variables: body.variables,
                inertia,
                attachment,
            });
        }
        Self { frames, gravity: mechanism.gravity }
    }

    /// Number of frames.
    pub fn len(&self) -> usize {
        self.frames.len()
    }

    /// Whether nothing moves.
    pub fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// The chain from frame `i` to the root, `i` first.
    pub fn chain(&self, i: usize) -> impl Iterator<Item = usize> + '_ {
        std::iter::successors(Some(i), |&j| self.frames[j].parent)
    }

    /// A free vector, parent coordinates to those of frame `i`.
    pub fn to_child(&self, dag: &mut Dag, i: usize, vector: Vector) -> Vector {
        self.frames[i].turns().fold(vector, |vector, turn| turn.to_child(dag, vector))
    }

    /// A free vector, coordinates of frame `i` to those of its parent.
    pub fn to_parent(&self, dag: &mut Dag, i: usize, vector: Vector) -> Vector {
        self.frames[i].turns().rev().fold(vector, |vector, turn| turn.to_parent(dag, vector))
    }
}

/// The groups of parallel revolute axes, each from its first body outwards; groups of one are left
/// out.
pub fn parallel_groups(mechanism: &Mechanism) -> Vec<Vec<usize>> {
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (i, continues) in group_members(mechanism).into_iter().enumerate() {
        let parent = mechanism.bodies[i].parent.filter(|_| continues);
        match parent.and_then(|p| groups.iter_mut().find(|group| group.last() == Some(&p))) {
            Some(group) => group.push(i),
            None => groups.push(vec![i]),
        }
    }
    groups.retain(|group| group.len() > 1);
    groups
}

/// For each body, whether it continues the group of its parent: both joints turn, the axes are
/// parallel (nothing but turns about z between them), and the parent carries nothing else.
fn group_members(mechanism: &Mechanism) -> Vec<bool> {
    let bodies = &mechanism.bodies;
    bodies
        .iter()
        .map(|body| {
            let Some(parent) = body.parent else { return false };
            let siblings = bodies.iter().filter(|other| other.parent == Some(parent)).count();
            body.is_revolute && bodies[parent].is_revolute && body.turns.is_empty() && siblings == 1
        })
        .collect()
}
