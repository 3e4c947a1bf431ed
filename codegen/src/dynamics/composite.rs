//! Composite inertias, and D and G from them.

use super::inverse::Wrench;
use crate::expr::{Dag, ExprId};
use crate::kinematics::Frames;
use crate::spatial::{PseudoInertia, negate};

/// For each frame, the matter of its body and of all that it carries.
pub(super) fn composites(dag: &mut Dag, frames: &Frames) -> Vec<PseudoInertia> {
    let mut composites: Vec<PseudoInertia> =
        frames.frames.iter().map(|frame| frame.inertia).collect();
    for i in (0..frames.len()).rev() {
        if let Some(p) = frames.frames[i].parent {
            let carried = to_parent(dag, frames, i, &composites[i]);
            composites[p] = composites[p].add(dag, &carried);
        }
    }
    composites
}

/// Matter of frame `i` in its parent's coordinates, about the parent's origin.
pub(super) fn to_parent(
    dag: &mut Dag,
    frames: &Frames,
    i: usize,
    inertia: &PseudoInertia,
) -> PseudoInertia {
    let turns = frames.frames[i].turns().rev();
    let turned = turns.fold(*inertia, |inertia, turn| inertia.turned(dag, turn));
    turned.shifted(dag, frames.frames[i].offset)
}

/// The wrench that gives the matter carried by joint `i` one unit of joint acceleration.
pub(super) fn unit_wrench(
    dag: &mut Dag,
    frames: &Frames,
    i: usize,
    composite: &PseudoInertia,
) -> Wrench {
    let (k, s) = (&composite.second, composite.first);
    let zero = dag.zero();
    if frames.frames[i].is_revolute {
        let force = [dag.neg(s[1]), s[0], zero];
        let moment = [dag.neg(k[0][2]), dag.neg(k[1][2]), dag.add(k[0][0], k[1][1])];
        Wrench { force, moment }
    } else {
        Wrench { force: [zero, zero, composite.mass], moment: [s[1], dag.neg(s[0]), zero] }
    }
}

/// D, symmetric, row by row (composite rigid bodies).
pub(super) fn mass_matrix(
    dag: &mut Dag,
    frames: &Frames,
    composites: &[PseudoInertia],
) -> Vec<Vec<ExprId>> {
    let n = frames.len();
    let mut d = vec![vec![dag.zero(); n]; n];
    for i in 0..n {
        let mut wrench = unit_wrench(dag, frames, i, &composites[i]);
        for j in frames.chain(i) {
            d[i][j] = wrench.along_joint(frames, j);
            d[j][i] = d[i][j];
            if frames.frames[j].parent.is_some() {
                wrench = wrench.to_parent(dag, frames, j);
            }
        }
    }
    d
}

/// G: the first moments of what each joint carries, against gravity passed down the chain.
///
/// The moment about a joint's axis is the same before and after the joint's own turn. Before it the
/// first moment is needed anyway, to be carried on; after it gravity would be needed at the tips
/// for nothing else. At the root it is the other way round.
pub(super) fn gravity_vector(
    dag: &mut Dag,
    frames: &Frames,
    composites: &[PseudoInertia],
) -> Vec<ExprId> {
    let mut lift: Vec<[ExprId; 3]> = Vec::new();
    let base = negate(dag, frames.gravity);
    let mut g = Vec::new();
    for (i, frame) in frames.frames.iter().enumerate() {
        let above = frame.parent.map_or(base, |p| lift[p]);
        let before = frame.seat.iter().fold(above, |lift, turn| turn.to_child(dag, lift));
        let after = frame.joint_turn.map_or(before, |turn| turn.to_child(dag, before));
        lift.push(after);
        let composite = &composites[i];
        g.push(if frame.is_revolute {
            let (first, lift) = match frame.joint_turn.filter(|_| frame.parent.is_some()) {
                Some(turn) => (turn.to_parent(dag, composite.first), before),
                None => (composite.first, after),
            };
            let (x, y) = (dag.mul(first[0], lift[1]), dag.mul(first[1], lift[0]));
            dag.sub(x, y)
        } else {
            dag.mul(composite.mass, after[2])
        });
    }
    g
}
