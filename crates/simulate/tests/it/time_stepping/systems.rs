//! Systems with few coordinates, written down by hand.

use denavit_simulate::contact::Space;
use denavit_simulate::time_stepping::{
    Instant, Scheme, StepLaw, StepReport, Stepping, Terms, TimeStepper, TimeSteppingModel,
};

pub(crate) const GRAVITY: f64 = 9.81;

/// A body in the plane (x, z, angle counterclockwise) under a constant force, with contact points
/// fixed in it, above the line z = 0.
pub(crate) struct PlaneBody {
    pub(crate) mass: f64,
    pub(crate) inertia: f64,
    pub(crate) points: Vec<[f64; 2]>,
    pub(crate) force: [f64; 2],
}

impl PlaneBody {
    fn arm(&self, contact: usize, angle: f64) -> [f64; 2] {
        let ([x, z], (s, c)) = (self.points[contact], angle.sin_cos());
        [c * x - s * z, s * x + c * z]
    }
}

impl TimeSteppingModel for PlaneBody {
    fn dof(&self) -> usize {
        3
    }

    fn contacts(&self) -> usize {
        self.points.len()
    }

    fn space(&self) -> Space {
        Space::Planar
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        for (contact, gap) in gaps.iter_mut().enumerate() {
            *gap = q[1] + self.arm(contact, q[2])[1];
        }
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        for (place, entry) in [(0, self.mass), (4, self.mass), (8, self.inertia)] {
            terms.mass[place] = entry;
        }
        terms.force[..2].copy_from_slice(&self.force);
        for (rows, &contact) in terms.jacobian.chunks_exact_mut(6).zip(closed) {
            let [x, z] = self.arm(contact, at.q[2]);
            rows.copy_from_slice(&[1.0, 0.0, -z, 0.0, 1.0, x]);
        }
    }
}

/// Equal balls on a line; contact k is the gap between balls k and k + 1.
pub(crate) struct Cradle {
    pub(crate) balls: usize,
}

impl TimeSteppingModel for Cradle {
    fn dof(&self) -> usize {
        self.balls
    }

    fn contacts(&self) -> usize {
        self.balls - 1
    }

    fn space(&self) -> Space {
        Space::Planar
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        for (gap, pair) in gaps.iter_mut().zip(q.windows(2)) {
            *gap = pair[1] - pair[0];
        }
    }

    fn terms(&mut self, _: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        let n = self.balls;
        for ball in 0..n {
            terms.mass[ball * n + ball] = 1.0;
        }
        for (rows, &contact) in terms.jacobian.chunks_exact_mut(2 * n).zip(closed) {
            rows[n + contact] = -1.0;
            rows[n + contact + 1] = 1.0;
        }
    }
}

/// A mass between a spring and a damper, far from any ground.
pub(crate) struct Oscillator {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
}

impl TimeSteppingModel for Oscillator {
    fn dof(&self) -> usize {
        1
    }

    fn contacts(&self) -> usize {
        0
    }

    fn space(&self) -> Space {
        Space::Planar
    }

    fn gaps(&mut self, _: &[f64], _: &mut [f64]) {}

    fn terms(&mut self, at: Instant<'_>, _: &[usize], terms: &mut Terms) {
        terms.mass[0] = 1.0;
        terms.damping[0] = self.damping;
        terms.force[0] = -self.stiffness * at.q[0] - self.damping * at.qd[0];
    }
}

pub(crate) fn stepping(
    scheme: Scheme,
    step_s: f64,
    contacts: usize,
    friction: f64,
    restitution: f64,
) -> Laws {
    let laws = vec![StepLaw { friction, restitution }; contacts];
    (Stepping { scheme, step_s, ..Stepping::default() }, laws)
}

/// How steps are made, and the law of each contact.
pub(crate) type Laws = (Stepping, Vec<StepLaw>);

/// State after each step.
pub(crate) struct Sample {
    pub(crate) t_s: f64,
    pub(crate) q: Vec<f64>,
    pub(crate) qd: Vec<f64>,
    pub(crate) report: StepReport,
}

pub(crate) fn run(
    model: &mut impl TimeSteppingModel,
    (stepping, laws): Laws,
    q: &[f64],
    qd: &[f64],
    end_s: f64,
) -> Vec<Sample> {
    let h = stepping.step_s;
    let mut stepper = TimeStepper::new(stepping, laws, model);
    let (mut q, mut qd) = (q.to_vec(), qd.to_vec());
    (0..(end_s / h).round() as usize)
        .map(|step| {
            let report = stepper.step(model, step as f64 * h, &mut q, &mut qd).expect("a step");
            Sample { t_s: (step + 1) as f64 * h, q: q.clone(), qd: qd.clone(), report }
        })
        .collect()
}

/// The order at which an error falls from a step to a 16th of it; errors are means over eight
/// steps near each, since an impact may fall anywhere within a step.
pub(crate) fn order(step_s: f64, error: impl Fn(f64) -> f64) -> f64 {
    let mean =
        |step: f64| (0..8).map(|k| error(step * (1.0 + 0.037 * f64::from(k)))).sum::<f64>() / 8.0;
    (mean(step_s) / mean(step_s / 16.0)).log2() / 4.0
}
