//! The solver: sequential quadratic programming (Kraft's SLSQP), one start.
//!
//! Where rounding stops it, the solver calls that a failure and still returns its best point. What
//! its point is worth is decided elsewhere, on a finer grid ([`check`](super::check)).

use super::model::Evaluators;
use super::problem::{Derivatives, Problem, Values};
use slsqp::{FailStatus, StopTols, SuccessStatus, minimize};
use std::cell::RefCell;

/// Why the solver stopped.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SolverStop {
    /// Neither objective nor coordinates change any more.
    Converged,
    /// Rounding hides what is left to gain.
    Rounding,
    /// As many evaluations as it may have.
    Evaluations,
    /// It found no way on.
    Stuck,
    /// Who watched asked for no more.
    Watcher,
}

impl SolverStop {
    /// One word for tables and JSON.
    pub fn word(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::Rounding => "rounding",
            Self::Evaluations => "evaluations",
            Self::Stuck => "stuck",
            Self::Watcher => "watcher",
        }
    }
}

/// A place that the solver went to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Iterate {
    /// The condition number.
    pub condition: f64,
    /// The objective.
    pub objective: f64,
    /// The largest excess over a limit, of its range; at most 0 where all hold.
    pub excess: f64,
}

/// The end of a start.
#[derive(Clone, Debug)]
pub(super) struct Solved {
    pub(super) x: Vec<f64>,
    pub(super) stop: SolverStop,
    pub(super) evaluations: usize,
    pub(super) iterates: Vec<Iterate>,
}

/// Values and derivatives at the latest place, which solver callbacks ask for one by one.
struct Memory<'p, 'm> {
    problem: &'p Problem<'m>,
    evaluators: &'p mut Evaluators,
    x: Vec<f64>,
    values: Option<Values>,
    derivatives: Option<Derivatives>,
    evaluations: usize,
    iterates: Vec<Iterate>,
    tell: &'p dyn Fn(&Iterate, usize) -> bool,
    is_stopped: bool,
}

impl Memory<'_, '_> {
    fn go_to(&mut self, x: &[f64]) {
        if self.x != x || self.values.is_none() {
            self.x = x.to_vec();
            self.values = Some(self.problem.values(self.evaluators, x));
            self.derivatives = None;
            self.evaluations += 1;
        }
    }

    fn iterate(&self) -> Option<Iterate> {
        let values = self.values.as_ref()?;
        let excess = values.limits.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (condition, objective) = (values.excitation.condition, values.objective);
        Some(Iterate { condition, objective, excess })
    }

    fn differentiate(&mut self) {
        if self.derivatives.is_some() {
            return;
        }
        self.derivatives = Some(self.problem.derivatives(self.evaluators, &self.x));
        // derivatives are asked for where a search along a line has ended
        if let Some(iterate) = self.iterate() {
            self.iterates.push(iterate);
            self.is_stopped = self.is_stopped || !(self.tell)(&iterate, self.evaluations);
        }
    }

    /// The objective, or the limit of a number.
    fn value(&mut self, limit: Option<usize>, x: &[f64], gradient: Option<&mut [f64]>) -> f64 {
        if self.is_stopped {
            // the solver ends where nothing has a slope, and limits hold
            gradient.into_iter().flatten().for_each(|slope| *slope = 0.0);
            return -1.0;
        }
        self.go_to(x);
        if let Some(gradient) = gradient {
            self.differentiate();
            if let Some(found) = &self.derivatives {
                gradient.copy_from_slice(match limit {
                    Some(limit) => &found.limits[limit],
                    None => &found.objective,
                });
            }
        }
        let value = self.values.as_ref().map(|values| match limit {
            Some(limit) => values.limits[limit],
            None => values.objective,
        });
        // far from every limit numbers may overflow, which the solver does not survive
        value.filter(|value| value.is_finite()).unwrap_or(1e6)
    }
}

/// Makes the objective small from a start, with at most so many evaluations.
pub(super) fn solve(
    problem: &Problem<'_>,
    evaluators: &mut Evaluators,
    start: &[f64],
    most: usize,
    tell: &dyn Fn(&Iterate, usize) -> bool,
) -> Solved {
    let bounds: Vec<(f64, f64)> =
        problem.model.moving().iter().flat_map(|_| problem.space.bounds()).collect();
    let memory = RefCell::new(Memory {
        problem,
        evaluators,
        x: Vec::new(),
        values: None,
        derivatives: None,
        evaluations: 0,
        iterates: Vec::new(),
        tell,
        is_stopped: false,
    });
    let function = |limit: Option<usize>| {
        let memory = &memory;
        move |x: &[f64], gradient: Option<&mut [f64]>, _: &mut ()| {
            memory.borrow_mut().value(limit, x, gradient)
        }
    };
    let limits: Vec<_> = (0..problem.limits()).map(|limit| function(Some(limit))).collect();
    let tolerances = StopTols { ftol_rel: 1e-6, xtol_rel: 1e-7, ..StopTols::default() };
    let ended =
        minimize(function(None), start, &bounds, &limits, (), most.max(1), Some(tolerances));
    let (x, stop) = match ended {
        Ok((SuccessStatus::MaxEvalReached | SuccessStatus::MaxTimeReached, x, _)) => {
            (x, SolverStop::Evaluations)
        }
        Ok((_, x, _)) => (x, SolverStop::Converged),
        Err((FailStatus::RoundoffLimited, x, _)) => (x, SolverStop::Rounding),
        Err((_, x, _)) => (x, SolverStop::Stuck),
    };
    let Memory { evaluations, iterates, is_stopped, .. } = memory.into_inner();
    let stop = if is_stopped { SolverStop::Watcher } else { stop };
    Solved { x, stop, evaluations, iterates }
}
