//! Positions, rotations and Jacobians in frame 0.

use super::frames::Frames;
use super::mechanism::{Placement, to_parent};
use crate::expr::Dag;
use crate::spatial::{Matrix, PseudoInertia, Vector, add, cross, scale, subtract, zero};

/// Where every frame is in frame 0.
pub struct World<'a> {
    frames: &'a Frames,
    /// The axes of each frame: `axes[i][k]` is its k-th axis.
    axes: Vec<Matrix>,
    /// The origins \[m\].
    origins: Vec<Vector>,
}

impl<'a> World<'a> {
    /// Forward kinematics of all frames.
    pub fn new(dag: &mut Dag, frames: &'a Frames) -> Self {
        let mut world = Self { frames, axes: Vec::new(), origins: Vec::new() };
        for frame in &frames.frames {
            let mut axes = world.axes_of(dag, frame.parent);
            for turn in frame.turns() {
                axes = turned_axes(dag, axes, turn);
            }
            let origin = world.point(dag, frame.parent, frame.offset);
            world.axes.push(axes);
            world.origins.push(origin);
        }
        world
    }

    fn axes_of(&self, dag: &Dag, frame: Option<usize>) -> Matrix {
        match frame {
            Some(i) => self.axes[i],
            None => {
                let (one, zero) = (dag.one(), dag.zero());
                [[one, zero, zero], [zero, one, zero], [zero, zero, one]]
            }
        }
    }

    /// The axis of joint `j`.
    pub fn axis(&self, j: usize) -> Vector {
        self.axes[j][2]
    }

    /// A free vector of a frame (none: frame 0) in frame 0.
    pub fn vector(&self, dag: &mut Dag, frame: Option<usize>, vector: Vector) -> Vector {
        let axes = self.axes_of(dag, frame);
        combine(dag, axes, vector)
    }

    /// A point given in a frame, in frame 0.
    pub fn point(&self, dag: &mut Dag, frame: Option<usize>, point: Vector) -> Vector {
        let rotated = self.vector(dag, frame, point);
        match frame {
            Some(i) => add(dag, self.origins[i], rotated),
            None => rotated,
        }
    }

    /// A placement's point (in its own coordinates) in the coordinates of its carrier's frame.
    pub fn in_carrier(&self, dag: &mut Dag, placement: &Placement, point: Vector) -> Vector {
        let turned = to_parent(dag, &placement.turns, point);
        let in_body = add(dag, placement.offset, turned);
        match placement.body.and_then(|body| self.frames.frames[body].attachment) {
            Some(attachment) => attachment.to_parent(dag, in_body),
            None => in_body,
        }
    }

    /// Axes (columns) and origin of a placement in frame 0.
    pub fn placement(&self, dag: &mut Dag, placement: &Placement) -> (Matrix, Vector) {
        let mut axes = self.axes_of(dag, placement.body);
        let attachment = placement.body.and_then(|body| self.frames.frames[body].attachment);
        for turn in attachment.iter().chain(&placement.turns) {
            axes = turned_axes(dag, axes, turn);
        }
        let zero = zero(dag);
        let point = self.in_carrier(dag, placement, zero);
        (axes, self.point(dag, placement.body, point))
    }

    /// The column of joint `j` in the Jacobian of a point that it carries: z x (p - o) or z.
    pub fn linear_column(&self, dag: &mut Dag, j: usize, point: Vector) -> Vector {
        let z = self.axes[j][2];
        if self.frames.frames[j].is_revolute {
            let lever = subtract(dag, point, self.origins[j]);
            cross(dag, z, lever)
        } else {
            z
        }
    }

    /// The column of joint `j` in the angular Jacobian of what it carries: z or 0.
    pub fn angular_column(&self, dag: &Dag, j: usize) -> Vector {
        if self.frames.frames[j].is_revolute { self.axes[j][2] } else { zero(dag) }
    }

    /// The joints that move a frame.
    pub fn chain(&self, frame: Option<usize>) -> Vec<usize> {
        frame.map_or_else(Vec::new, |i| self.frames.chain(i).collect())
    }
}

/// `axes . vector`: the sum of the axes, weighted.
fn combine(dag: &mut Dag, axes: Matrix, vector: Vector) -> Vector {
    let mut sum = zero(dag);
    for (axis, coordinate) in axes.into_iter().zip(vector) {
        let part = scale(dag, coordinate, axis);
        sum = add(dag, sum, part);
    }
    sum
}

/// The axes after a turn: two of them mix.
fn turned_axes(dag: &mut Dag, axes: Matrix, turn: &crate::spatial::Turn) -> Matrix {
    // Row r of the rotation R (columns = axes) times the turn's matrix: its transpose acts on rows.
    let columns = [0, 1, 2].map(|r| [axes[0][r], axes[1][r], axes[2][r]]);
    let turned = columns.map(|row| turn.to_child(dag, row));
    [0, 1, 2].map(|k| [turned[0][k], turned[1][k], turned[2][k]])
}

/// The column of joint `j` in the centre-of-mass Jacobian: z x s in its frame, for the first moment
/// s of what it carries per unit of total mass, or m z for a sliding joint.
pub fn center_of_mass_column(
    dag: &mut Dag,
    world: &World<'_>,
    j: usize,
    carried: &PseudoInertia,
) -> Vector {
    let zero = dag.zero();
    let local = if world.frames.frames[j].is_revolute {
        [dag.neg(carried.first[1]), carried.first[0], zero]
    } else {
        [zero, zero, carried.mass]
    };
    world.vector(dag, Some(j), local)
}
