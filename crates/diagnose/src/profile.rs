//! Laws without a name: torques that are any function of a joint's position times one of its rate.
//!
//! What such a profile explains and a law of the catalogue does not is no noise, no other joint and
//! no memory: there is a law of the joint's own motion, and it is another one.

use super::law::{Law, Motion, Response};
use super::problem::{Fitted, Problem};
use super::search::range;
use super::state::{Setting, State, Taken, within};
use denavit_plants::effect::LawParameter;

/// What a profile leaves of held-out logs.
pub(super) struct Profiled {
    /// What it leaves of them [N m, N].
    pub(super) held_out_residual: Vec<f64>,
    rate: &'static str,
}

impl Profiled {
    /// The law of a joint of this name: `g(q_knee) qd_knee^2`, g being any smooth function.
    pub(super) fn formula(&self, joint: &str) -> String {
        let rate = self.rate.replace("qd", &format!("qd_{joint}"));
        format!("g(q_{joint}) {rate}")
    }
}

type Rate = (&'static str, fn(f64) -> f64);

/// Functions of a rate with their names. None is constant: torques that depend on the position
/// alone are what springs, stops and cogging of any shape do.
const RATES: [Rate; 5] = [
    ("qd", |v| v),
    ("|qd|", f64::abs),
    ("sgn qd", f64::signum),
    ("qd^2", |v| v * v),
    ("qd |qd|", |v| v * v.abs()),
];

/// Pieces of the range of a joint, each with a cubic of its own.
const PIECES: usize = 12;

/// Cubic B-splines that are not 0 somewhere in the range.
const SPLINES: usize = PIECES + 3;

/// A torque g(q) r(qd), g a cubic spline.
struct Profile {
    joint: usize,
    range: [f64; 2],
    rate: fn(f64) -> f64,
    parameters: Vec<LawParameter>,
}

impl Profile {
    fn new(joint: usize, range: [f64; 2], rate: fn(f64) -> f64) -> Self {
        let parameter = |_| LawParameter {
            name: String::new(),
            unit: String::new(),
            nominal: Some(0.0),
            bounds: [f64::NEG_INFINITY, f64::INFINITY],
            start: Vec::new(),
            linear: true,
        };
        Self { joint, range, rate, parameters: (0..SPLINES).map(parameter).collect() }
    }
}

impl Law for Profile {
    fn parameters(&self) -> &[LawParameter] {
        &self.parameters
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let signals = motion.signals;
        let [rates, _] = signals.of_drive(self.joint);
        let [low, high] = self.range;
        let samples = signals.q[self.joint].len();
        let mut columns = vec![vec![0.0; samples]; SPLINES];
        let mut torque = vec![0.0; samples];
        for (k, (q, v)) in signals.q[self.joint].iter().zip(rates).enumerate() {
            let place = (PIECES as f64 * (q - low) / (high - low)).clamp(0.0, PIECES as f64);
            let piece = (place as usize).min(PIECES - 1);
            let factor = (self.rate)(*v);
            for (spline, share) in cubic(place - piece as f64).into_iter().enumerate() {
                columns[piece + spline][k] = factor * share;
                torque[k] += values[piece + spline] * factor * share;
            }
        }
        Response {
            equations: vec![self.joint],
            torque: vec![torque],
            gradient: columns.into_iter().map(|column| vec![column]).collect(),
        }
    }
}

/// The four uniform cubic B-splines of a piece, at a share of it.
fn cubic(x: f64) -> [f64; 4] {
    let y = 1.0 - x;
    let inner = |x: f64| (3.0 * x.powi(3) - 6.0 * x * x + 4.0) / 6.0;
    [y.powi(3) / 6.0, inner(x), inner(y), x.powi(3) / 6.0]
}

/// The profile that leaves least of a joint in place of the effects that a state has there; what
/// bodies add stays.
pub(super) fn best_profile(setting: &Setting<'_>, state: &State, joint: usize) -> Option<Profiled> {
    let is_replaced = |(place, taken): &(usize, &Taken)| {
        let candidate = &setting.candidates[taken.candidate];
        *place >= setting.given.len() && candidate.joint == Some(joint) && !candidate.is_body
    };
    let places = state.taken.iter().enumerate();
    let others: Vec<Taken> =
        places.filter(|one| !is_replaced(one)).map(|(_, taken)| taken.clone()).collect();
    let others = setting.fitted(&others);
    let range = range(setting.train, joint);
    let problem = Problem::new(setting.train, &state.deviation[0], &[]);
    let squares = |left: &[f64]| setting.held_out_squares(state, left)[joint][0];
    let of = |(name, rate): Rate| {
        let profile = Profile::new(joint, range, rate);
        let own = Fitted { law: &profile, values: vec![0.0; SPLINES] };
        let mut laws = [others.as_slice(), &[own]].concat();
        let found = within(&problem, &mut laws, &state.torques[0]);
        let held_out_residual = setting.left_by(&laws, &found.z, &state.torques[1]);
        Profiled { held_out_residual, rate: name }
    };
    let all = RATES.into_iter().map(of);
    all.min_by(|a, b| squares(&a.held_out_residual).total_cmp(&squares(&b.held_out_residual)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Where a piece ends the next one goes on, with value and slope, and together they are 1.
    #[test]
    fn splines_are_smooth_across_pieces_and_can_be_one() {
        for x in [0.0, 0.3, 1.0] {
            let sum: f64 = cubic(x).iter().sum();
            assert!((sum - 1.0).abs() < 1e-15, "{sum}");
        }
        let [end, begin] = [cubic(1.0), cubic(0.0)];
        for spline in 0..3 {
            assert!((end[spline + 1] - begin[spline]).abs() < 1e-15);
        }
        let slope =
            |x: f64, spline: usize| (cubic(x + 1e-6)[spline] - cubic(x - 1e-6)[spline]) / 2e-6;
        for spline in 0..3 {
            assert!((slope(1.0, spline + 1) - slope(0.0, spline)).abs() < 1e-9);
        }
    }
}
