//! Laws of friction written by hand, for tests of the search alone.

use denavit_diagnose::{Law, Motion, Response};
use denavit_plants::effect::LawParameter;

/// A law of one joint: torque and derivatives by its parameters at a sample.
pub(super) struct Handwritten {
    pub(super) parameters: Vec<LawParameter>,
    pub(super) joint: usize,
    pub(super) follows_accelerations: bool,
    pub(super) at: fn(Sample, &[f64]) -> (f64, Vec<f64>),
}

/// What a law by hand may depend on.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) q: f64,
    pub(super) qd: f64,
    pub(super) qdd: f64,
    pub(super) load: f64,
    pub(super) load_rate: f64,
}

impl Law for Handwritten {
    fn parameters(&self) -> &[LawParameter] {
        &self.parameters
    }

    fn follows_accelerations(&self) -> bool {
        self.follows_accelerations
    }

    fn response(&self, motion: Motion<'_>, values: &[f64]) -> Response {
        let (joint, signals) = (self.joint, motion.signals);
        let mut torque = Vec::new();
        let mut gradient = vec![vec![Vec::new()]; values.len()];
        for k in 0..signals.samples() {
            let sample = Sample {
                q: signals.q[joint][k],
                qd: signals.qd[joint][k],
                qdd: signals.qdd[joint][k],
                load: motion.torques.load[joint][k],
                load_rate: motion.torques.load_rate[joint][k],
            };
            let (value, slopes) = (self.at)(sample, values);
            torque.push(value);
            gradient.iter_mut().zip(slopes).for_each(|(column, slope)| column[0].push(slope));
        }
        Response { equations: vec![joint], torque: vec![torque], gradient }
    }
}

fn linear(name: &str) -> LawParameter {
    LawParameter {
        name: name.to_owned(),
        unit: String::new(),
        nominal: Some(0.0),
        bounds: [-1e3, 1e3],
        start: Vec::new(),
        linear: true,
    }
}

fn shape(name: &str, start: &[f64], bounds: [f64; 2]) -> LawParameter {
    let (name, unit, start) = (name.to_owned(), String::new(), start.to_vec());
    LawParameter { name, unit, nominal: None, bounds, start, linear: false }
}

type Kind = (&'static str, Vec<LawParameter>, fn(Sample, &[f64]) -> (f64, Vec<f64>));

/// A dozen laws of a joint.
pub(super) fn kinds() -> Vec<Kind> {
    let one = |name| vec![linear(name)];
    vec![
        ("viscous", one("fv"), |s, p| (p[0] * s.qd, vec![s.qd])),
        ("coulomb", one("fc"), |s, p| (p[0] * sign(s.qd), vec![sign(s.qd)])),
        ("offset", one("c"), |_, p| (p[0], vec![1.0])),
        ("rotor_inertia", one("Ia"), |s, p| (p[0] * s.qdd, vec![s.qdd])),
        ("asymmetric_viscous", one("d"), |s, p| (p[0] * s.qd.abs(), vec![s.qd.abs()])),
        ("quadratic_drag", one("c"), |s, p| (p[0] * s.qd * s.qd.abs(), vec![s.qd * s.qd.abs()])),
        ("load_friction", one("mu"), |s, p| {
            let unit = sign(s.qd) * s.load.abs();
            (p[0] * unit, vec![unit])
        }),
        ("torque_gain", one("g"), |s, p| (p[0] * s.load, vec![s.load])),
        ("delay", one("T"), |s, p| (-p[0] * s.load_rate, vec![-s.load_rate])),
        ("hardening_spring", one("k3"), |s, p| (p[0] * s.q.powi(3), vec![s.q.powi(3)])),
        ("smoothed_coulomb", vec![linear("fc"), shape("vs", &[0.05, 0.2], [1e-3, 2.0])], |s, p| {
            let x = (s.qd / p[1]).tanh();
            (p[0] * x, vec![x, -p[0] * (1.0 - x * x) * s.qd / (p[1] * p[1])])
        }),
        ("stribeck", vec![linear("fs"), shape("vs", &[0.03, 0.1, 0.3], [1e-3, 2.0])], |s, p| {
            let x = s.qd / p[1];
            let bell = sign(s.qd) * (-x * x).exp();
            (p[0] * bell, vec![bell, p[0] * bell * 2.0 * x * x / p[1]])
        }),
    ]
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}
