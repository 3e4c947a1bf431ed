//! What a step costs, with exact derivatives and a convex model of its curvature.

use super::layout::Point;
use super::program::Linearisation;
use super::step::Step;

/// What is minimised.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CostKind {
    /// The integral of the absolute power of each joint, summed over joints, over weight and
    /// distance.
    #[default]
    CostOfTransport,
    /// The integral of the square of torques over distance [N^2 m s].
    TorqueSquared,
}

impl CostKind {
    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 2] = ["cost_of_transport", "torque_squared"];
}

/// How the cost is made smooth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CostSettings {
    pub(super) kind: CostKind,
    /// Powers below this share of weight times speed cost less than their absolute value.
    pub(super) rounding: f64,
    /// Weight of squared torques beside the cost of transport.
    pub(super) torque: f64,
    /// Weight of squared changes of torque.
    pub(super) torque_rate: f64,
    /// Weight of squared accelerations of joints.
    pub(super) acceleration: f64,
    /// Weight of squared impulses: feet that land softly make a walk that forgives a wrong instant.
    pub(super) impulse: f64,
}

/// A function of two variables: value, gradient, and a positive semidefinite model of the Hessian.
struct Power {
    value: f64,
    gradient: [f64; 2],
    hessian: [f64; 3],
}

/// sqrt(s^2 + e^2) - e of the power s = torque * rate; the Hessian without its negative part.
fn smooth_power(torque: f64, rate: f64, rounding: f64) -> Power {
    let power = torque * rate;
    let root = (power * power + rounding * rounding).sqrt();
    let (slope, bend) = (power / root, rounding * rounding / (root * root * root));
    let (a, c) = (bend * rate * rate, bend * torque * torque);
    let b = bend * power + slope;
    // eigenvalues of [[a, b], [b, c]]: the negative one is left out
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let radius = (half * half + b * b).sqrt();
    let hessian = if mean >= radius {
        [a, b, c]
    } else {
        let (x, y) = if half >= 0.0 { (half + radius, b) } else { (b, radius - half) };
        let scale = (mean + radius) / (x * x + y * y).max(f64::MIN_POSITIVE);
        [scale * x * x, scale * x * y, scale * y * y]
    };
    Power { value: root - rounding, gradient: [slope * rate, slope * torque], hessian }
}

/// Derivatives of the effort at a point.
type Curvature<'a> = Option<(&'a mut Linearisation, f64)>;

impl Step<'_> {
    /// The cost of a step, and its derivatives.
    pub(super) fn cost(&self, x: &[f64], mut linear: Option<&mut Linearisation>) -> f64 {
        let length = x[self.layout.length];
        let mut total = 0.0;
        for point in &self.layout.points {
            let duration = self.layout.durations + point.phase;
            let weight = point.weight * x[duration] / length;
            let effort = self.effort(x, point, linear.as_deref_mut().map(|l| (l, weight)));
            total += weight * effort;
            if let Some(linear) = linear.as_deref_mut() {
                linear.gradient[duration] += point.weight * effort / length;
                linear.gradient[self.layout.length] -= weight * effort / length;
            }
        }
        total + self.impulses(x, linear.as_deref_mut()) + self.torque_changes(x, linear)
    }

    /// Cost of transport and squared torques over the distance [N^2 m s] as they are, without
    /// smoothing.
    pub(super) fn plain_costs(&self, x: &[f64]) -> [f64; 2] {
        let (layout, length) = (&self.layout, x[self.layout.length]);
        let mut totals = [0.0; 2];
        for point in &layout.points {
            let weight = point.weight * x[layout.durations + point.phase] / length;
            for (drive, joint) in self.legs.driven.iter().enumerate() {
                let torque = x[layout.torques(point) + drive];
                let power = torque * x[layout.motion(point, 1) + joint];
                totals[0] += weight * power.abs() / self.units.force_n;
                totals[1] += weight * torque * torque;
            }
        }
        totals
    }

    /// Squared impulses, over weight times time.
    fn impulses(&self, x: &[f64], mut linear: Option<&mut Linearisation>) -> f64 {
        let weight = self.cost_settings.impulse / (self.units.force_n * self.units.time_s).powi(2);
        let range = self.layout.durations + self.layout.phases.len()..self.layout.length;
        let mut total = 0.0;
        for index in range {
            total += weight * x[index] * x[index];
            if let Some(linear) = linear.as_deref_mut() {
                linear.gradient[index] += 2.0 * weight * x[index];
                linear.hessian.add(index, index, 2.0 * weight);
            }
        }
        total
    }

    /// What is integrated, without dimension but for a length in the denominator.
    fn effort(&self, x: &[f64], point: &Point, mut linear: Curvature<'_>) -> f64 {
        let (layout, settings, units) = (&self.layout, &self.cost_settings, self.units);
        let moment = units.moment_nm();
        let mut total = 0.0;
        for (drive, joint) in self.legs.driven.iter().enumerate() {
            let (torque, rate) = (layout.torques(point) + drive, layout.motion(point, 1) + joint);
            let squared = match settings.kind {
                CostKind::CostOfTransport => settings.torque,
                CostKind::TorqueSquared => 1.0,
            };
            // per time, so that the integral over a length is without dimension
            let unit = squared * units.speed_m_s() / (moment * moment);
            total += unit * x[torque] * x[torque];
            let acceleration = layout.motion(point, 2) + joint;
            let bend = settings.acceleration * units.speed_m_s() * units.time_s.powi(4);
            total += bend * x[acceleration] * x[acceleration];
            if let Some((linear, weight)) = linear.as_mut() {
                linear.gradient[torque] += *weight * 2.0 * unit * x[torque];
                linear.hessian.add(torque, torque, *weight * 2.0 * unit);
                linear.gradient[acceleration] += *weight * 2.0 * bend * x[acceleration];
                linear.hessian.add(acceleration, acceleration, *weight * 2.0 * bend);
            }
            if settings.kind == CostKind::TorqueSquared {
                continue;
            }
            let rounding = settings.rounding * units.power_w();
            let power = smooth_power(x[torque], x[rate], rounding);
            total += power.value / units.force_n;
            if let Some((linear, weight)) = linear.as_mut() {
                let weight = *weight / units.force_n;
                linear.gradient[torque] += weight * power.gradient[0];
                linear.gradient[rate] += weight * power.gradient[1];
                linear.hessian.add(torque, torque, weight * power.hessian[0]);
                // velocities stand before torques
                linear.hessian.add(rate, torque, weight * power.hessian[1]);
                linear.hessian.add(rate, rate, weight * power.hessian[2]);
            }
        }
        total
    }

    /// Squared changes of torques from point to point, across phases too, in the time between them
    /// of the guess.
    fn torque_changes(&self, x: &[f64], mut linear: Option<&mut Linearisation>) -> f64 {
        let (layout, moment) = (&self.layout, self.units.moment_nm());
        let mut total = 0.0;
        let mut pairs = Vec::new();
        for (number, transition) in layout.transitions.iter().enumerate() {
            pairs.push((
                *layout.last_of(transition.from),
                layout.points_of(number)[0],
                transition.swaps,
            ));
            let points = layout.points_of(number);
            pairs.extend(points.windows(2).map(|pair| (pair[0], pair[1], false)));
        }
        let weight = self.cost_settings.torque_rate * pairs.len() as f64 / (moment * moment);
        for (before, after, swaps) in pairs {
            for (drive, joint) in self.legs.driven.iter().enumerate() {
                let source = if swaps { self.legs.mirror[*joint] } else { *joint };
                let Some(source) = self.legs.driven.iter().position(|other| *other == source)
                else {
                    continue;
                };
                let [from, to] =
                    [(before, source), (after, drive)].map(|(p, d)| layout.torques(&p) + d);
                let change = x[to] - x[from];
                total += weight * change * change;
                if let Some(linear) = linear.as_deref_mut() {
                    linear.gradient[to] += 2.0 * weight * change;
                    linear.gradient[from] -= 2.0 * weight * change;
                    linear.hessian.add(to, to, 2.0 * weight);
                    linear.hessian.add(from, from, 2.0 * weight);
                    linear.hessian.add(from.min(to), from.max(to), -2.0 * weight);
                }
            }
        }
        total
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_smooth_power_has_its_gradient_and_no_negative_curvature() {
        for (torque, rate) in [(3.0, 2.0), (-0.4, 1.0), (0.0, -2.0), (1e-3, 1e-3), (0.0, 0.0)] {
            let power = smooth_power(torque, rate, 0.5);
            let h = 1e-6;
            let by_torque = smooth_power(torque + h, rate, 0.5).value
                - smooth_power(torque - h, rate, 0.5).value;
            let by_rate = smooth_power(torque, rate + h, 0.5).value
                - smooth_power(torque, rate - h, 0.5).value;
            assert!((by_torque / (2.0 * h) - power.gradient[0]).abs() < 1e-8);
            assert!((by_rate / (2.0 * h) - power.gradient[1]).abs() < 1e-8);
            let [a, b, c] = power.hessian;
            assert!(a >= 0.0 && c >= 0.0 && a * c - b * b >= -1e-9 * (a + c), "{a} {b} {c}");
        }
    }
}
