//! Ordinary differential equations: one step at a time, with dense output.
//!
//! The simulation decides where steps must end and looks for events inside them; a [`Stepper`]
//! knows nothing of either. Three methods stand behind it:
//!
//! - [`Method::DormandPrince`]: explicit, order 5(4), adaptive (Dormand, Prince 1980)
//! - [`Method::Radau`]: implicit, L-stable, order 5(3), adaptive, for stiff controllers
//! - [`Method::RungeKutta`]: the classical one of order 4, fixed steps
//!
//! Every step is capped: an error estimate of zero (free flight is a parabola) must not let a step
//! jump over whole flights.

mod explicit;
mod newton;
mod radau;

use super::breakdown::Breakdown;
use radau::Implicit;

/// A system dy/dt = f(t, y).
pub trait Rates {
    /// Writes dy/dt.
    fn rates(&mut self, t_s: f64, y: &[f64], dy: &mut [f64]) -> Result<(), Breakdown>;

    /// How many entries at the beginning of y are positions: as many after them are their rates.
    fn positions(&self) -> usize {
        0
    }

    /// How many entries at the end of y are integrals alone: no rate depends on them.
    fn integrals(&self) -> usize {
        0
    }
}

/// How accurate a step must be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Accuracy {
    /// Relative to the entry of the state.
    pub relative: f64,
    /// Absolute, in the unit of the entry.
    pub absolute: f64,
    /// No step is longer \[s\].
    pub max_step_s: f64,
}

impl Default for Accuracy {
    fn default() -> Self {
        Self { relative: 1e-9, absolute: 1e-10, max_step_s: 0.02 }
    }
}

/// Where steps as short as this have no answer, there is none \[s\].
const SHORTEST_FAILURE_S: f64 = 1e-10;

/// So many steps in a row that are shorter than `SHORT_S` lead nowhere: the rates have a limit
/// there that no step gets over.
const SHORT_STEPS: usize = 10_000;
const SHORT_S: f64 = 1e-8;

/// The method of integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Method {
    /// Explicit, adaptive.
    DormandPrince(Accuracy),
    /// Implicit, adaptive.
    Radau(Accuracy),
    /// Explicit, fixed steps.
    RungeKutta {
        /// Step \[s\].
        step_s: f64,
    },
}

impl Default for Method {
    fn default() -> Self {
        Self::DormandPrince(Accuracy::default())
    }
}

impl Method {
    /// The longest step \[s\], and how many evaluations one takes at least.
    pub(super) fn longest_step(self) -> (f64, f64) {
        match self {
            Self::DormandPrince(accuracy) => (accuracy.max_step_s, 6.0),
            Self::Radau(accuracy) => (accuracy.max_step_s, 4.0),
            Self::RungeKutta { step_s } => (step_s, 4.0),
        }
    }
}

/// What integration cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted steps.
    pub steps: usize,
    /// Steps that were too inaccurate, or did not converge.
    pub rejected: usize,
    /// Evaluations of the rates.
    pub evaluations: usize,
    /// Jacobians of the rates (whose evaluations are counted as such).
    pub jacobians: usize,
}

/// The last step, and what the next one needs.
#[derive(Clone, Debug)]
pub struct Stepper {
    method: Method,
    pub(super) statistics: Statistics,
    t0: f64,
    t1: f64,
    y0: Vec<f64>,
    y1: Vec<f64>,
    f0: Vec<f64>,
    f1: Vec<f64>,
    /// Rates of the stages.
    stages: Vec<Vec<f64>>,
    /// Coefficients of the dense output of Dormand and Prince.
    dense: [Vec<f64>; 5],
    trial: Vec<f64>,
    error: Vec<f64>,
    /// How many accepted steps in a row were short.
    short: usize,
    /// The next step to try; none before the first.
    proposal: Option<f64>,
    implicit: Implicit,
    /// The rates `f1` are those at the end of the last step, and so the next one's first.
    known: bool,
}

impl Stepper {
    /// At `t_s` with state `y`; nothing is known of the motion before.
    pub fn new(method: Method, t_s: f64, y: &[f64]) -> Self {
        let zero = vec![0.0; y.len()];
        Self {
            method,
            statistics: Statistics::default(),
            t0: t_s,
            t1: t_s,
            y0: y.to_vec(),
            y1: y.to_vec(),
            f0: zero.clone(),
            f1: zero.clone(),
            stages: vec![zero.clone(); 7],
            dense: std::array::from_fn(|_| zero.clone()),
            trial: zero.clone(),
            error: zero,
            short: 0,
            proposal: None,
            implicit: Implicit::default(),
            known: false,
        }
    }

    /// Goes on from another state: after an event, or where the rates jump.
    pub fn restart(&mut self, t_s: f64, y: &[f64]) {
        self.t1 = t_s;
        self.t0 = t_s;
        self.y1.copy_from_slice(y);
        self.y0.copy_from_slice(y);
        self.implicit.forget();
        self.known = false;
    }

    /// Start of the last step \[s\].
    pub fn start_time(&self) -> f64 {
        self.t0
    }

    /// End of the last step \[s\].
    pub fn time(&self) -> f64 {
        self.t1
    }

    /// The state at the end of the last step.
    pub fn state(&self) -> &[f64] {
        &self.y1
    }

    /// One accepted step, which ends at `stop_s` at the latest. `Ok(false)`: the step would have to
    /// be shorter than time can resolve, or too many have been nearly that.
    pub fn advance(&mut self, system: &mut dyn Rates, stop_s: f64) -> Result<bool, Breakdown> {
        self.t0 = self.t1;
        std::mem::swap(&mut self.y0, &mut self.y1);
        if self.known {
            std::mem::swap(&mut self.f0, &mut self.f1);
        } else {
            system.rates(self.t0, &self.y0, &mut self.f0)?;
            self.statistics.evaluations += 1;
        }
        self.known = false;
        let left = stop_s - self.t0;
        let accuracy = match self.method {
            Method::RungeKutta { step_s } => {
                let step = if left < step_s * (1.0 + 1e-9) { left } else { step_s };
                self.runge_kutta(system, step)?;
                return self.accept(system, step, stop_s);
            }
            Method::DormandPrince(accuracy) | Method::Radau(accuracy) => accuracy,
        };
        let mut step = self.proposal.unwrap_or_else(|| self.first_step(accuracy));
        loop {
            let capped = step.min(accuracy.max_step_s);
            // no sliver is left before the stop
            let trial = match left {
                left if left <= capped * 1.0000001 => left,
                left if left < 2.0 * capped => 0.5 * left,
                _ => capped,
            };
            if trial <= 1e-14 * self.t0.abs().max(1e-2) || self.short > SHORT_STEPS {
                return Ok(false);
            }
            let (tried, order) = match self.method {
                Method::Radau(_) => (self.implicit_step(system, trial, accuracy), 4.0),
                _ => (self.dormand_prince(system, trial, accuracy).map(Some), 5.0),
            };
            let error = match tried {
                Ok(error) => error,
                // a step too long may lead to where the equations have no answer
                Err(_) if trial > SHORTEST_FAILURE_S => None,
                Err(breakdown) => return Err(breakdown),
            };
            // an error that is not finite, or no convergence: a much shorter step
            let factor = match error {
                Some(error) if error.is_finite() => {
                    (0.9 * error.max(1e-10).powf(-1.0 / order)).clamp(0.2, 5.0)
                }
                _ => 0.25,
            };
            if error.is_some_and(|error| error <= 1.0) {
                // keep the step, and with it the factored matrix, for small gains
                let keeps =
                    matches!(self.method, Method::Radau(_)) && (0.95..1.2).contains(&factor);
                let grown = if keeps { trial } else { trial * factor };
                // a step cut short by a stop says nothing against the longer one
                self.proposal = Some(if trial < capped { grown.max(capped) } else { grown });
                self.short = if trial < SHORT_S && trial < left { self.short + 1 } else { 0 };
                return self.accept(system, trial, stop_s);
            }
            self.statistics.rejected += 1;
            step = trial * factor.min(0.9);
            self.proposal = Some(step);
        }
    }

    fn accept(
        &mut self,
        system: &mut dyn Rates,
        step: f64,
        stop_s: f64,
    ) -> Result<bool, Breakdown> {
        let end = self.t0 + step;
        // the stop exactly, so that schedules do not drift
        self.t1 = if (stop_s - end).abs() <= 1e-13 * stop_s.abs().max(1.0) { stop_s } else { end };
        self.statistics.steps += 1;
        self.conclude(system, step)?;
        Ok(true)
    }

    /// Rates at the end of the step that was just made, and its dense output.
    fn conclude(&mut self, system: &mut dyn Rates, step: f64) -> Result<(), Breakdown> {
        match self.method {
            Method::DormandPrince(_) => {
                self.prepare_dense(step);
                self.f1.copy_from_slice(&self.stages[6]);
            }
            Method::Radau(_) | Method::RungeKutta { .. } => {
                if let Method::Radau(_) = self.method {
                    self.implicit.accept(step);
                }
                system.rates(self.t1, &self.y1, &mut self.f1)?;
                self.statistics.evaluations += 1;
            }
        }
        self.known = true;
        Ok(())
    }

    /// The state at a time inside the last step, by dense output.
    pub fn interpolate(&self, t_s: f64, y: &mut [f64]) {
        let step = self.t1 - self.t0;
        if step <= 0.0 {
            y.copy_from_slice(&self.y1);
            return;
        }
        let s = (t_s - self.t0) / step;
        match self.method {
            Method::DormandPrince(_) => self.interpolate_dense(s, y),
            _ => self.interpolate_hermite(s, step, y),
        }
    }

    /// The state at a time inside the last step, by a step of that length.
    pub fn restep(
        &mut self,
        system: &mut dyn Rates,
        t_s: f64,
        y: &mut [f64],
    ) -> Result<(), Breakdown> {
        if t_s <= self.t0 {
            y.copy_from_slice(&self.y0);
            return Ok(());
        }
        let kept = self.y1.clone();
        let made = self.make(system, t_s - self.t0);
        y.copy_from_slice(&self.y1);
        self.y1.copy_from_slice(&kept);
        if !made? {
            // dense output is the best that is left
            self.interpolate(t_s, y);
        }
        Ok(())
    }

    /// Takes a shorter step in place of the last one, from its start to `t_s`. False if that step
    /// was not made: the last one stays then.
    pub fn retake(&mut self, system: &mut dyn Rates, t_s: f64) -> Result<bool, Breakdown> {
        let kept = self.y1.clone();
        let step = t_s - self.t0;
        if !matches!(self.make(system, step), Ok(true)) {
            self.y1.copy_from_slice(&kept);
            return Ok(false);
        }
        self.t1 = t_s;
        self.conclude(system, step)?;
        Ok(true)
    }

    /// A step of any length from the start of the last one, into `y1`; false without convergence.
    fn make(&mut self, system: &mut dyn Rates, step: f64) -> Result<bool, Breakdown> {
        match self.method {
            Method::DormandPrince(accuracy) => {
                self.dormand_prince(system, step, accuracy).map(|_| true)
            }
            Method::RungeKutta { .. } => self.runge_kutta(system, step).map(|()| true),
            Method::Radau(accuracy) => {
                self.implicit_step(system, step, accuracy).map(|error| error.is_some())
            }
        }
    }

    /// Hairer, Norsett, Wanner, II.4, without its second evaluation.
    fn first_step(&self, accuracy: Accuracy) -> f64 {
        let [size, rate] = [&self.y0, &self.f0].map(|vector| {
            let weighted = |(entry, y): (&f64, &f64)| {
                (entry / (accuracy.absolute + accuracy.relative * y.abs())).powi(2)
            };
            vector.iter().zip(&self.y0).map(weighted).sum::<f64>().sqrt()
        });
        let step = if size < 1e-5 || rate < 1e-5 { 1e-6 } else { 0.01 * size / rate };
        step.max(1e-9).min(accuracy.max_step_s)
    }

    /// Root mean square of the error over what is allowed.
    fn weighted(&self, accuracy: Accuracy) -> f64 {
        let sum: f64 = self
            .error
            .iter()
            .zip(self.y0.iter().zip(&self.y1))
            .map(|(error, (before, after))| {
                let size = before.abs().max(after.abs());
                (error / (accuracy.absolute + accuracy.relative * size)).powi(2)
            })
            .sum();
        (sum / self.error.len().max(1) as f64).sqrt()
    }

    /// Cubic, through both ends with their rates.
    fn interpolate_hermite(&self, s: f64, step: f64, y: &mut [f64]) {
        let r = 1.0 - s;
        for (i, entry) in y.iter_mut().enumerate() {
            let rise = self.y1[i] - self.y0[i];
            let bend = r * (step * self.f0[i] - rise) - s * (step * self.f1[i] - rise);
            *entry = r * self.y0[i] + s * self.y1[i] + s * r * bend;
        }
    }
}
