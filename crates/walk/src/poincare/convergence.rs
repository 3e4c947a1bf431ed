//! Returns from off the cycle: whether a deviation that is not small dies as the multipliers say.

use super::cycle::FixedPoint;
use super::multipliers::Multiplier;
use super::section::ReturnMap;
use crate::error::Error;
use denavit_plants::PlantModel;
use denavit_simulate::State;

/// Returns to the section of a cycle, from off the cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Convergence {
    /// The joints whose velocities deviate at the start: those that deviate most in the direction
    /// of the largest multiplier, two at most.
    pub joints: Vec<usize>,
    /// Their deviations at the start and after each cycle [rad/s, m/s].
    pub deviations: Vec<Vec<f64>>,
    /// Length of the whole deviation, velocities and positions inside the manifold of the
    /// contacts, at the start and after each cycle [rad, rad/s, m, m/s].
    pub lengths: Vec<f64>,
    /// Why the robot did not come back again.
    pub stopped: Option<Error>,
}

/// Deviations are not followed further down [rad, rad/s]: what is left then is error.
const GONE: f64 = 1e-8;

impl Convergence {
    /// What a cycle makes of a deviation in the mean: the root of what all make of it.
    pub fn factor(&self) -> Option<f64> {
        let cycles = self.lengths.len().checked_sub(1).filter(|cycles| *cycles > 0)?;
        let (first, last) = (self.lengths.first()?, self.lengths.last()?);
        Some((last / first).powf(1.0 / cycles as f64))
    }
}

/// Walks some cycles from a state in which two velocities deviate, by plus and minus this
/// [rad/s, m/s].
pub fn converge(
    map: &mut ReturnMap<'_>,
    cycle: &FixedPoint,
    leading: &Multiplier,
    off: f64,
    cycles: usize,
) -> Convergence {
    let chart = &cycle.chart;
    let joints = leading_velocities(map.plant.model(), cycle, leading);
    let n = chart.base.q.len();
    let mut change = State { q: vec![0.0; n], qd: vec![0.0; n], ..State::default() };
    change.motor = vec![0.0; chart.base.motor.len()];
    change.motor_rate = vec![0.0; chart.base.motor_rate.len()];
    change.laws = vec![0.0; chart.base.laws.len()];
    for (joint, sign) in joints.iter().zip([1.0, -1.0]) {
        change.qd[*joint] = sign * off;
    }
    let mut start = chart.coordinates_of_change(&change);
    start.resize(chart.len(), 0.0);
    let mut state = chart.state(map.plant, &start);
    let mut found =
        Convergence { joints, deviations: Vec::new(), lengths: Vec::new(), stopped: None };
    for index in 0..=cycles {
        let velocity = |joint: &usize| state.qd[*joint] - chart.base.qd[*joint];
        found.deviations.push(found.joints.iter().map(velocity).collect());
        let coordinates = chart.coordinates(&state);
        let length = coordinates.iter().map(|x| x * x).sum::<f64>().sqrt();
        found.lengths.push(length);
        if index == cycles || length < GONE {
            break;
        }
        match map.apply(&state) {
            Ok(returned) => state = returned.state,
            Err(error) => {
                found.stopped = Some(error);
                break;
            }
        }
    }
    found
}

fn leading_velocities(model: &PlantModel, cycle: &FixedPoint, leading: &Multiplier) -> Vec<usize> {
    let part = |index: usize| {
        let coordinates: Vec<f64> = leading.direction.iter().map(|z| z[index]).collect();
        cycle.chart.change(&coordinates)
    };
    let [real, imaginary] = [part(0), part(1)];
    let weight = |joint: usize| real.qd[joint].hypot(imaginary.qd[joint]);
    // where the base is follows from the others
    let follows = |joint: &usize| !model.joints[*joint].drivable && model.joints[*joint].slides;
    let mut joints: Vec<usize> = (0..model.joints.len()).filter(|joint| !follows(joint)).collect();
    joints.sort_by(|a, b| weight(*b).total_cmp(&weight(*a)));
    joints.truncate(2);
    joints
}
