//! Directions of multipliers in words: which coordinate deviates most.

use super::chart::Chart;
use super::multipliers::Multiplier;
use denavit_plants::PlantModel;

/// A coordinate's share of a direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Share {
    /// `q_JOINT` or `qd_JOINT`; `motor_JOINT` and `motor_rate_JOINT` of series elastic joints.
    pub coordinate: String,
    /// Modulus, where the largest is 1 [rad, rad/s, m, m/s].
    pub weight: f64,
}

/// The coordinates of a direction by falling weight; the position of the base is left out, which
/// follows from the others.
pub fn shares(model: &PlantModel, chart: &Chart, multiplier: &Multiplier) -> Vec<Share> {
    let part = |index: usize| {
        let coordinates: Vec<f64> = multiplier.direction.iter().map(|z| z[index]).collect();
        chart.change(&coordinates)
    };
    let [real, imaginary] = [part(0), part(1)];
    let follows = |joint: usize| !model.joints[joint].drivable && model.joints[joint].slides;
    let mut shares = Vec::new();
    for (prefix, real, imaginary) in [("q", &real.q, &imaginary.q), ("qd", &real.qd, &imaginary.qd)]
    {
        for joint in (0..model.joints.len()).filter(|joint| !follows(*joint)) {
            let coordinate = format!("{prefix}_{}", model.joints[joint].name);
            shares.push(Share { coordinate, weight: real[joint].hypot(imaginary[joint]) });
        }
    }
    for (prefix, real, imaginary) in [
        ("motor", &real.motor, &imaginary.motor),
        ("motor_rate", &real.motor_rate, &imaginary.motor_rate),
    ] {
        for (index, joint) in model.sprung_joints().enumerate().take(real.len()) {
            let coordinate = format!("{prefix}_{}", model.joints[joint].name);
            shares.push(Share { coordinate, weight: real[index].hypot(imaginary[index]) });
        }
    }
    let largest = shares.iter().fold(f64::MIN_POSITIVE, |most, share| most.max(share.weight));
    shares.iter_mut().for_each(|share| share.weight /= largest);
    shares.sort_by(|a, b| b.weight.total_cmp(&a.weight));
    shares
}
