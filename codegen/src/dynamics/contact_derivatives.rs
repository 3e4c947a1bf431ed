//! Derivatives of the contact points' velocities and accelerations, and of the torques of forces on
//! them.
//!
//! The column J_j of joint j in the Jacobian of a point p is z x (p - o), or z of a sliding joint.
//! Since d/dt and d/dq_j commute along every motion, d(velocity)/dq_j is d/dt J_j and
//! d(acceleration)/dq_j is its second derivative: products of the axis, of the lever and of their
//! own derivatives. Parallel axes in a row share the first column; the others differ from it by
//! z x (distance of the axes), whatever the point. And d J_far/dq_near = z_near x J_far for any two
//! joints of a chain, so that d(J^T f)/dq is z_near . sum (J_far x f), symmetric.

use super::candidate::Candidate;
use crate::expr::{Dag, ExprId, SymbolClass};
use crate::function::{Output, force_name};
use crate::kinematics::{Frames, Moving, World, WorldMotion};
use crate::model::{LinkId, Robot};
use crate::spatial::{Vector, add, cross, dot, scale, subtract, zero};

/// The columns of one contact point's Jacobian, with their derivatives by time; joints that do not
/// move the point are left out.
type Columns = Vec<(usize, Moving)>;

/// Contact points that one body carries.
struct Foot {
    /// None for frame 0.
    body: Option<usize>,
    /// Rows of the robot's contact points.
    points: Vec<usize>,
}

/// The symbols of the forces on the contact points: x, y, z of each in turn.
pub(super) fn forces(dag: &mut Dag, robot: &Robot) -> Vec<ExprId> {
    let mut symbols = Vec::new();
    for contact in robot.contacts.values() {
        for coordinate in ["x", "y", "z"] {
            let name = force_name(&contact.name, coordinate);
            symbols.push(dag.symbol(&name, SymbolClass::Effort));
        }
    }
    symbols
}

/// All outputs.
pub(super) fn contact_derivatives(dag: &mut Dag, candidate: &Candidate<'_>) -> Vec<Output> {
    let frames = candidate.frames;
    let (n, count) = (frames.len(), candidate.robot.contacts.len());
    let world = World::new(dag, frames);
    let motion = WorldMotion::new(dag, &world, frames);
    let mut columns: Vec<Columns> = Vec::new();
    let mut places = Vec::new();
    for contact in candidate.robot.contacts.values() {
        let placement = &candidate.mechanism.placements[contact.link];
        let local = world.in_carrier(dag, placement, contact.position);
        let point = motion.point(dag, &world, placement.body, local);
        let before = candidate.robot.contacts.values().take(columns.len());
        let before: Vec<_> = before.map(|before| (before.link, before.position)).collect();
        columns.push(match corner(&before, (contact.link, contact.position)) {
            Some(corner) => corner_columns(dag, &columns, corner),
            None => point_columns(dag, frames, &motion, placement.body, point),
        });
        places.push(point.value);
    }
    let two = dag.integer(2);
    let mut rates = vec![vec![dag.zero(); n]; 3 * count];
    let (mut accelerations, mut by_velocity) = (rates.clone(), rates.clone());
    for (point, own) in columns.iter().enumerate() {
        for &(j, column) in own {
            for k in 0..3 {
                rates[3 * point + k][j] = column.velocity[k];
                accelerations[3 * point + k][j] = column.acceleration[k];
                by_velocity[3 * point + k][j] = dag.mul(two, column.velocity[k]);
            }
        }
    }
    let torques = torque_derivatives(dag, candidate, &motion, &columns, &places);
    let output = |name, shape: [usize; 2], rows: Vec<Vec<ExprId>>, doc: &str| Output {
        name,
        shape: shape.to_vec(),
        entries: rows.concat(),
        doc: doc.to_owned(),
        details: Vec::new(),
    };
    let shape = [3 * count, n];
    vec![
        output("contact_velocity_dq", shape, rates, VELOCITY),
        output("contact_acceleration_dq", shape, accelerations, ACCELERATION),
        output("contact_acceleration_dqd", shape, by_velocity, BY_VELOCITY),
        output("contact_torque_dq", [n, n], torques, TORQUE),
    ]
}

const VELOCITY: &str = "d(W^T qd)/dq, world frame: rows x, y, z of each point in turn, one column \
                        for each position.";
const ACCELERATION: &str = "d(W^T qdd + (d/dt W^T) qd)/dq, world frame: rows x, y, z of each point \
                            in turn, one column for each position.";
const BY_VELOCITY: &str = "The same accelerations by qd: one column for each velocity. It is twice \
                           contact_velocity_dq.";
const TORQUE: &str = "d(W f)/dq at constant forces, symmetric. Row: torque, column: position.";

/// The columns of a point that `body` carries.
fn point_columns(
    dag: &mut Dag,
    frames: &Frames,
    motion: &WorldMotion,
    body: Option<usize>,
    point: Moving,
) -> Columns {
    let mut chain: Vec<usize> = body.map_or_else(Vec::new, |body| frames.chain(body).collect());
    chain.reverse();
    let mut columns: Columns = Vec::new();
    for j in chain {
        let axis = motion.axes[j];
        let before = columns.last().copied().filter(|&(before, _)| {
            frames.frames[j].is_revolute
                && frames.frames[before].is_revolute
                && motion.axes[before].value == axis.value
                && axis.velocity != zero(dag)
        });
        let column = match before {
            _ if !frames.frames[j].is_revolute => axis,
            Some((before, column)) => {
                let distance = motion.origins[before].with(dag, motion.origins[j], subtract);
                let shift = axis.cross(dag, distance);
                column.with(dag, shift, add)
            }
            None => {
                let lever = point.with(dag, motion.origins[j], subtract);
                axis.cross(dag, lever)
            }
        };
        columns.push((j, column));
    }
    columns
}

/// A point of a link.
type Place = (LinkId, Vector);

/// The rows a, b, c of points of the same link for which the point is a + b - c: three corners of a
/// parallelogram, of which a foot's sole often is one.
fn corner(before: &[Place], (link, point): Place) -> Option<[usize; 3]> {
    let own: Vec<usize> = (0..before.len()).filter(|&row| before[row].0 == link).collect();
    let at = |row: usize| before[row].1;
    let closes = |[a, b, c]: [usize; 3]| {
        (0..3).all(|k| {
            let (a, b, c) = (at(a)[k], at(b)[k], at(c)[k]);
            (point[k] == a && b == c) || (point[k] == b && a == c)
        })
    };
    let triples = own.iter().flat_map(|&a| own.iter().map(move |&b| (a, b)));
    let mut triples = triples.flat_map(|(a, b)| own.iter().map(move |&c| [a, b, c]));
    triples.find(|&[a, b, c]| a < b && a != c && b != c && closes([a, b, c]))
}

/// Columns are sums of levers, so that those of the fourth corner follow from three.
fn corner_columns(dag: &mut Dag, columns: &[Columns], [a, b, c]: [usize; 3]) -> Columns {
    let rows = columns[a].iter().zip(&columns[b]).zip(&columns[c]);
    let rows: Vec<_> = rows.map(|((&(j, a), &(_, b)), &(_, c))| (j, [a, b, c])).collect();
    let sum = |(j, [a, b, c]): (usize, [Moving; 3])| {
        let edge = b.with(dag, c, subtract);
        (j, a.with(dag, edge, add))
    };
    rows.into_iter().map(sum).collect()
}

/// d(W f)/dq.
fn torque_derivatives(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    motion: &WorldMotion,
    columns: &[Columns],
    places: &[Vector],
) -> Vec<Vec<ExprId>> {
    let frames = candidate.frames;
    let n = frames.len();
    let symbols = forces(dag, candidate.robot);
    let (forces, _) = symbols.as_chunks::<3>();
    let points = Points { columns, places, forces };
    let mut turned = vec![zero(dag); n];
    for foot in feet(candidate) {
        add_turned(dag, frames, motion, &foot, &points, &mut turned);
    }
    let mut torques = vec![vec![dag.zero(); n]; n];
    for far in 0..n {
        for near in frames.chain(far).filter(|&near| frames.frames[near].is_revolute) {
            torques[near][far] = dot(dag, motion.axes[near].value, turned[far]);
            torques[far][near] = torques[near][far];
        }
    }
    torques
}

/// The contact points by the bodies that carry them.
fn feet(candidate: &Candidate<'_>) -> Vec<Foot> {
    let mut feet: Vec<Foot> = Vec::new();
    for (row, contact) in candidate.robot.contacts.values().enumerate() {
        let body = candidate.mechanism.placements[contact.link].body;
        match feet.iter_mut().find(|foot| foot.body == body) {
            Some(foot) => foot.points.push(row),
            None => feet.push(Foot { body, points: vec![row] }),
        }
    }
    feet
}

/// The contact points, each at its number.
struct Points<'a> {
    /// The columns of its Jacobian.
    columns: &'a [Columns],
    /// Where the point is.
    places: &'a [Vector],
    /// The force on it.
    forces: &'a [Vector],
}

/// Adds sum (J_j x f) over the points of a foot, for each joint j.
///
/// From three points on the forces are summed first: with c the first point, F the sum of the
/// forces and A = sum (p - c) f^T, it is J_j(c) x F + (A - tr A) z.
fn add_turned(
    dag: &mut Dag,
    frames: &Frames,
    motion: &WorldMotion,
    foot: &Foot,
    points: &Points<'_>,
    turned: &mut [Vector],
) {
    let Points { columns, places, forces } = *points;
    let first = foot.points[0];
    if foot.points.len() < 3 {
        for &point in &foot.points {
            for &(j, column) in &columns[point] {
                let part = cross(dag, column.value, forces[point]);
                turned[j] = add(dag, turned[j], part);
            }
        }
        return;
    }
    let mut total = forces[first];
    let mut spread = [zero(dag); 3];
    for &point in &foot.points[1..] {
        total = add(dag, total, forces[point]);
        let lever = subtract(dag, places[point], places[first]);
        for k in 0..3 {
            let part = scale(dag, lever[k], forces[point]);
            spread[k] = add(dag, spread[k], part);
        }
    }
    let upper = dag.add(spread[0][0], spread[1][1]);
    let trace = dag.add(upper, spread[2][2]);
    (0..3).for_each(|k| spread[k][k] = dag.sub(spread[k][k], trace));
    for &(j, column) in &columns[first] {
        let own = cross(dag, column.value, total);
        turned[j] = add(dag, turned[j], own);
        if frames.frames[j].is_revolute {
            let axis = motion.axes[j].value;
            let part = spread.map(|row| dot(dag, row, axis));
            turned[j] = add(dag, turned[j], part);
        }
    }
}
