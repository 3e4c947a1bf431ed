//! Velocities and accelerations in frame 0.

use super::frames::Frames;
use super::world::World;
use crate::expr::{Dag, ExprId};
use crate::spatial::{Vector, add, cross, scale, zero};

/// A vector with its first two derivatives with respect to time.
#[derive(Clone, Copy, Debug)]
pub struct Moving {
    /// The vector.
    pub value: Vector,
    /// Its velocity.
    pub velocity: Vector,
    /// Its acceleration.
    pub acceleration: Vector,
}

impl Moving {
    /// A vector that rests.
    pub fn fixed(dag: &Dag, value: Vector) -> Self {
        Self { value, velocity: zero(dag), acceleration: zero(dag) }
    }

    /// The same operation on the vector and on each of its derivatives.
    pub fn with(
        self,
        dag: &mut Dag,
        other: Self,
        operation: fn(&mut Dag, Vector, Vector) -> Vector,
    ) -> Self {
        Self {
            value: operation(dag, self.value, other.value),
            velocity: operation(dag, self.velocity, other.velocity),
            acceleration: operation(dag, self.acceleration, other.acceleration),
        }
    }

    /// The cross product with its derivatives.
    pub fn cross(self, dag: &mut Dag, other: Self) -> Self {
        let value = cross(dag, self.value, other.value);
        let left = cross(dag, self.velocity, other.value);
        let right = cross(dag, self.value, other.velocity);
        let velocity = add(dag, left, right);
        let two = dag.integer(2);
        let twice = scale(dag, two, self.velocity);
        let left = cross(dag, self.acceleration, other.value);
        let middle = cross(dag, twice, other.velocity);
        let right = cross(dag, self.value, other.acceleration);
        let outer = add(dag, left, right);
        Self { value, velocity, acceleration: add(dag, outer, middle) }
    }
}

/// How every frame moves in frame 0: q at qd, qd at qdd.
pub struct WorldMotion {
    /// Angular velocity and angular acceleration of each body.
    turning: Vec<(Vector, Vector)>,
    /// The joint axes.
    pub axes: Vec<Moving>,
    /// The origins \[m\].
    pub origins: Vec<Moving>,
}

impl WorldMotion {
    /// The motion of all frames.
    pub fn new(dag: &mut Dag, world: &World<'_>, frames: &Frames) -> Self {
        let mut motion = Self { turning: Vec::new(), axes: Vec::new(), origins: Vec::new() };
        for (j, frame) in frames.frames.iter().enumerate() {
            let axis = motion.axis(dag, world, frames, j);
            let (mut w, mut wd) = motion.turning_of(dag, frame.parent);
            let mut origin = motion.point(dag, world, frame.parent, frame.offset);
            let (qd, qdd) = (frame.variables.qd, frame.variables.qdd);
            if frame.is_revolute {
                w = add_scaled(dag, w, qd, axis.value);
                wd = add_scaled(dag, wd, qdd, axis.value);
                wd = add_scaled(dag, wd, qd, axis.velocity);
            } else {
                let two = dag.integer(2);
                let twice = dag.mul(two, qd);
                origin.velocity = add_scaled(dag, origin.velocity, qd, axis.value);
                let sliding = add_scaled(dag, origin.acceleration, qdd, axis.value);
                origin.acceleration = add_scaled(dag, sliding, twice, axis.velocity);
            }
            motion.turning.push((w, wd));
            motion.axes.push(axis);
            motion.origins.push(origin);
        }
        motion
    }

    /// A point or vector fixed in frame 0 has no turning.
    fn turning_of(&self, dag: &Dag, body: Option<usize>) -> (Vector, Vector) {
        body.map_or_else(|| (zero(dag), zero(dag)), |body| self.turning[body])
    }

    /// The axis of joint `j`. It moves as the body before the joint does, and parallel axes in a
    /// row move alike.
    fn axis(&self, dag: &mut Dag, world: &World<'_>, frames: &Frames, j: usize) -> Moving {
        let axis = world.axis(j);
        let parent = frames.frames[j].parent;
        match parent {
            Some(p) if frames.frames[p].is_revolute && world.axis(p) == axis => self.axes[p],
            _ => self.carried(dag, parent, axis),
        }
    }

    /// A vector in frame 0, fixed in a body.
    fn carried(&self, dag: &mut Dag, body: Option<usize>, vector: Vector) -> Moving {
        let (w, wd) = self.turning_of(dag, body);
        let velocity = cross(dag, w, vector);
        let speeding = cross(dag, wd, vector);
        let turning = cross(dag, w, velocity);
        Moving { value: vector, velocity, acceleration: add(dag, speeding, turning) }
    }

    /// A point given in the frame of a body (none: frame 0), fixed in the body.
    pub fn point(
        &self,
        dag: &mut Dag,
        world: &World<'_>,
        body: Option<usize>,
        point: Vector,
    ) -> Moving {
        let lever = world.vector(dag, body, point);
        let lever = self.carried(dag, body, lever);
        match body {
            Some(body) => self.origins[body].with(dag, lever, add),
            None => lever,
        }
    }
}

/// `sum + factor vector`.
fn add_scaled(dag: &mut Dag, sum: Vector, factor: ExprId, vector: Vector) -> Vector {
    let part = scale(dag, factor, vector);
    add(dag, sum, part)
}
