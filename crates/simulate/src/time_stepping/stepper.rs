//! The steps.

use super::alike::AlikeSharing;
use super::{Instant, Scheme, StepFailure, StepReport, StepSolver, Stepping, Terms};
use super::{StepLaw, TimeSteppingModel};
use crate::audit::{friction_angle, worst};
use crate::contact::cholesky::dot;
use crate::contact::delassus::Delassus;
use crate::contact::gauss_seidel;
use crate::contact::hold::Hold;
use crate::contact::lemke::LcpOutcome;
use crate::contact::pyramid::Pyramid;
use crate::contact::{Contact, ContactProblem, Friction, Space, Tolerance};

/// Facets of the pyramid that stands in for cones on which sweeps do not converge.
const FALLBACK_FACETS: usize = 16;
/// What is added to the diagonal of their problem, relative to its mean, in turn.
const GIVE: [f64; 4] = [0.0, 1e-11, 1e-9, 1e-7];

/// Pivots that miss the laws by no more, relative to the largest velocity, do where none do better.
const NEARLY: f64 = 1e-6;

/// Impulses that make more of the energy that they exchange than this part make energy: then all
/// restitution is reduced by one factor, found by so many halvings.
const GAIN: f64 = 1e-3;
const HALVINGS: usize = 12;

/// Points this little above the ground take part \[m\]: rounding moves those of a flat foot apart,
/// and would leave some without their load.
const ROUNDING_M: f64 = 1e-10;

/// Slower contacts have no direction of slipping that a solver finds [m/s].
const SLIPS: f64 = 1e-4;

/// Makes steps; holds the impulses of the last one, from which the next one starts.
#[derive(Clone, Debug)]
pub struct TimeStepper {
    stepping: Stepping,
    laws: Vec<StepLaw>,
    space: Space,
    /// Of the last step, for all contacts.
    impulses: Vec<f64>,
    contacts: Vec<Contact>,
    closed: Vec<usize>,
    gaps: Vec<f64>,
    middle: Vec<f64>,
    mean: Vec<f64>,
    terms: Terms,
    delassus: Delassus,
    /// v without, then with contact impulses; and without.
    rates: Vec<f64>,
    without: Vec<f64>,
    /// Part of all restitution that makes no energy.
    bounce: f64,
    free: Vec<f64>,
    force: Vec<f64>,
    softened: Vec<f64>,
    scratch: Vec<f64>,
    hold: Hold,
    pyramid: Pyramid,
    alike: AlikeSharing,
}

impl TimeStepper {
    /// Prepares steps of a model with as many contacts as there are laws.
    pub fn new(stepping: Stepping, laws: Vec<StepLaw>, model: &impl TimeSteppingModel) -> Self {
        let (n, count) = (model.dof(), model.contacts());
        assert_eq!(laws.len(), count, "a law for every contact");
        let space = model.space();
        Self {
            space,
            stepping,
            laws,
            impulses: vec![0.0; count * space.rows()],
            contacts: Vec::with_capacity(count),
            closed: Vec::with_capacity(count),
            gaps: vec![0.0; count],
            middle: vec![0.0; n],
            mean: vec![0.0; n],
            terms: Terms::default(),
            delassus: Delassus::new(),
            rates: vec![0.0; n],
            without: vec![0.0; n],
            bounce: 1.0,
            free: Vec::new(),
            force: Vec::new(),
            softened: Vec::new(),
            scratch: vec![0.0; n],
            hold: Hold::new(),
            pyramid: Pyramid::new(),
            alike: AlikeSharing::default(),
        }
    }

    /// Impulses of the last step on all contact points, along tangents and normal [N s].
    pub fn impulses(&self) -> &[f64] {
        &self.impulses
    }

    /// Contact points in the problem of the last step.
    pub fn closed(&self) -> &[usize] {
        &self.closed
    }

    /// Heights of all contact points where the last step looked for contacts \[m\].
    pub fn gaps(&self) -> &[f64] {
        &self.gaps
    }

    /// The settings.
    pub fn stepping(&self) -> &Stepping {
        &self.stepping
    }

    /// The length of the steps from now on \[s\]; impulses, from which the next step starts, change
    /// with it.
    pub fn set_step_s(&mut self, step_s: f64) {
        let share = step_s / self.stepping.step_s;
        if share != 1.0 {
            self.impulses.iter_mut().for_each(|impulse| *impulse *= share);
            self.stepping.step_s = step_s;
        }
    }

    /// One step from `t_s`: `q` and `qd` become those of `t_s` + h.
    pub fn step(
        &mut self,
        model: &mut impl TimeSteppingModel,
        t_s: f64,
        q: &mut [f64],
        qd: &mut [f64],
    ) -> Result<StepReport, StepFailure> {
        let (n, h) = (qd.len(), self.stepping.step_s);
        let ahead = match self.stepping.scheme {
            Scheme::MoreauMidpoint => 0.5 * h,
            Scheme::Anitescu { .. } => 0.0,
        };
        for ((middle, q), qd) in self.middle.iter_mut().zip(&*q).zip(&*qd) {
            *middle = q + ahead * qd;
        }
        self.find_closed(model);
        let mut report = StepReport {
            closed: self.closed.len(),
            penetration_m: self.gaps.iter().fold(0.0, |sum, gap| sum.max(-gap)),
            ..StepReport::default()
        };
        self.mean.copy_from_slice(qd);
        let mut corrections = self.stepping.corrections;
        loop {
            report.passes += 1;
            self.terms.clear(n, self.closed.len() * self.space.rows());
            let at = Instant { t_s: t_s + ahead, q: &self.middle, qd, smooth_qd: &self.mean };
            model.terms(at, &self.closed, &mut self.terms);
            self.new_rates(qd, &mut report)?;
            // each refusal fixes a drive at its limit, so that there are few
            let accepted = model.accept(qd, &self.rates, self.stepping.implicitness);
            if corrections > 0 {
                corrections -= 1;
                for (mean, (old, new)) in self.mean.iter_mut().zip(qd.iter().zip(&self.rates)) {
                    *mean = 0.5 * (old + new);
                }
            } else if accepted || report.passes > n + self.stepping.corrections {
                break;
            }
        }
        (report.contact_work_j, report.law_error_m_s) = self.contact_figures(qd);
        report.friction_angle_rad = self.friction_angle(n);
        for ((q, middle), rate) in q.iter_mut().zip(&self.middle).zip(&self.rates) {
            *q = middle + (h - ahead) * rate;
        }
        qd.copy_from_slice(&self.rates);
        Ok(report)
    }

    /// v+ into `rates`.
    fn new_rates(&mut self, qd: &[f64], report: &mut StepReport) -> Result<(), StepFailure> {
        self.free_rates(qd)?;
        if self.closed.is_empty() {
            self.impulses.fill(0.0);
        } else {
            self.delassus.project(&self.terms.jacobian);
            self.without.clone_from(&self.rates);
            self.push(qd, 1.0, report)?;
            if self.makes_energy(qd) {
                let (mut low, mut high) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    self.push(qd, middle, report)?;
                    *if self.makes_energy(qd) { &mut high } else { &mut low } = middle;
                }
                self.push(qd, low, report)?;
            }
            self.keep_impulses();
        }
        match self.rates.iter().all(|rate| rate.is_finite()) {
            true => Ok(()),
            false => Err(StepFailure::NotFinite),
        }
    }

    /// Impulses with this part of all restitution, and the rates that they make.
    fn push(
        &mut self,
        qd: &[f64],
        bounce: f64,
        report: &mut StepReport,
    ) -> Result<(), StepFailure> {
        self.bounce = bounce;
        self.rates.copy_from_slice(&self.without);
        self.free_response(qd);
        let (iterations, fell_back) = self.solve_contacts()?;
        report.iterations += iterations;
        report.fell_back |= fell_back;
        self.delassus.respond(&self.force, &mut self.rates, &mut self.scratch);
        Ok(())
    }

    /// Whether the impulses make energy, as Newton's restitution can where contacts that part are
    /// pushed on, or rub.
    fn makes_energy(&self, qd: &[f64]) -> bool {
        let n = qd.len();
        let bounces = |contact: &usize| self.laws[*contact].restitution > 0.0;
        if self.bounce == 0.0 || !self.closed.iter().any(bounces) {
            return false;
        }
        let (mut work, mut size) = (0.0, 0.0);
        for (line, impulse) in self.terms.jacobian.chunks_exact(n).zip(&self.force) {
            let (before, after) = (dot(line, qd), dot(line, &self.rates));
            work += impulse * (before + after);
            size += (impulse * before).abs() + (impulse * after).abs();
        }
        work > GAIN * size
    }

    /// Work of the impulses, and how far those that push miss the law of the scheme.
    fn contact_figures(&self, qd: &[f64]) -> (f64, f64) {
        let (n, rows, h) = (qd.len(), self.space.rows(), self.stepping.step_s);
        let (mut work, mut error) = (0.0, 0.0_f64);
        let largest = self.force.iter().fold(0.0_f64, |most, p| most.max(p.abs()));
        for (place, &contact) in self.closed.iter().enumerate() {
            for row in place * rows..(place + 1) * rows {
                let line = &self.terms.jacobian[row * n..(row + 1) * n];
                let (before, after) = (dot(line, qd), dot(line, &self.rates));
                let impulse = self.force[row];
                work += 0.5 * impulse * (before + after);
                // a smaller impulse is rounding of none
                if row + 1 == (place + 1) * rows && impulse > 1e-12 * largest {
                    let wanted = match self.stepping.scheme {
                        Scheme::MoreauMidpoint => {
                            -self.bounce * self.laws[contact].restitution * before.min(0.0)
                        }
                        Scheme::Anitescu { .. } => -self.gaps[contact] / h,
                    };
                    error = error.max((after - wanted).abs());
                }
            }
        }
        (work, error)
    }

    /// The largest angle between friction and what is opposite to the velocity after the step.
    fn friction_angle(&self, n: usize) -> f64 {
        let rows = self.space.rows();
        let mut largest = 0.0_f64;
        let mut velocity = [0.0; 2];
        for place in 0..self.closed.len() {
            let tangents = place * rows..(place + 1) * rows - 1;
            for (speed, row) in velocity.iter_mut().zip(tangents.clone()) {
                *speed = dot(&self.terms.jacobian[row * n..(row + 1) * n], &self.rates);
            }
            if velocity.iter().map(|v| v * v).sum::<f64>() > SLIPS * SLIPS {
                largest = worst(largest, friction_angle(&self.force[tangents], &velocity));
            }
        }
        largest
    }

    fn find_closed(&mut self, model: &mut impl TimeSteppingModel) {
        let reach = match self.stepping.scheme {
            Scheme::MoreauMidpoint => ROUNDING_M,
            Scheme::Anitescu { reach_m } => reach_m.max(ROUNDING_M),
        };
        model.gaps(&self.middle, &mut self.gaps);
        self.closed.clear();
        let near = self.gaps.iter().enumerate().filter(|(_, gap)| **gap <= reach);
        self.closed.extend(near.map(|(contact, _)| contact));
        self.contacts.clear();
        let friction = |contact: &usize| Friction::Coulomb(self.laws[*contact].friction);
        self.contacts.extend(self.closed.iter().map(|c| Contact::resting(friction(c))));
    }

    /// v + h (D + th h B)^-1 f.
    fn free_rates(&mut self, qd: &[f64]) -> Result<(), StepFailure> {
        let (n, h) = (qd.len(), self.stepping.step_s);
        let implicit = self.stepping.implicitness * h;
        let Terms { mass, damping, force, .. } = &mut self.terms;
        for (entry, damping) in mass.iter_mut().zip(damping) {
            *entry += implicit * *damping;
        }
        self.delassus.factor(mass, n).map_err(StepFailure::Singular)?;
        for (rate, force) in self.rates.iter_mut().zip(force) {
            *rate = h * *force;
        }
        self.delassus.solve_mass(&mut self.rates);
        for (rate, old) in self.rates.iter_mut().zip(qd) {
            *rate += old;
        }
        Ok(())
    }

    /// What the law of contact applies to, without impulses: J v and the scheme's normal term.
    fn free_response(&mut self, qd: &[f64]) {
        let (n, rows, h) = (qd.len(), self.space.rows(), self.stepping.step_s);
        self.free.clear();
        self.free.extend(self.terms.jacobian.chunks_exact(n).map(|row| dot(row, &self.rates)));
        for (place, &contact) in self.closed.iter().enumerate() {
            let normal = place * rows + rows - 1;
            let StepLaw { restitution, .. } = self.laws[contact];
            self.free[normal] += match self.stepping.scheme {
                Scheme::MoreauMidpoint if restitution == 0.0 => 0.0,
                Scheme::MoreauMidpoint => {
                    let row = &self.terms.jacobian[normal * n..(normal + 1) * n];
                    self.bounce * restitution * dot(row, qd).min(0.0)
                }
                Scheme::Anitescu { .. } => self.gaps[contact] / h,
            };
        }
    }

    /// Impulses of the closed contacts into `force`; returns iterations and whether it fell back.
    fn solve_contacts(&mut self) -> Result<(usize, bool), StepFailure> {
        let rows = self.space.rows();
        self.force.clear();
        for &contact in &self.closed {
            self.force.extend_from_slice(&self.impulses[contact * rows..(contact + 1) * rows]);
        }
        let problem = ContactProblem {
            space: self.space,
            contacts: &self.contacts,
            delassus: self.delassus.matrix(),
            free: &self.free,
            tolerance: Tolerance::default(),
        };
        let memory = &mut self.softened;
        let limits = match self.stepping.solver {
            StepSolver::Pivots { facets } => {
                let (pivots, solved) =
                    pivot(&mut self.pyramid, &problem, facets, &mut self.force, memory);
                self.alike.share(&problem, &mut self.force);
                return if solved { Ok((pivots, false)) } else { Err(StepFailure::NoImpulses) };
            }
            StepSolver::Sweeps(limits) => limits,
        };
        if self.alike.follow(&problem, &mut self.force) {
            return Ok((1, false));
        }
        if self.hold.solve(&problem, limits.response, &mut self.force) {
            return Ok((0, false));
        }
        let report = gauss_seidel::solve(&problem, limits, &mut self.force);
        let mut spent = report.sweeps;
        let mut converged = report.converged;
        if !converged {
            let damped = gauss_seidel::solve_damped(&problem, limits, &mut self.force, memory);
            spent += damped.sweeps;
            converged = damped.converged;
        }
        let mut solved = converged;
        if !converged {
            let pivots;
            (pivots, solved) =
                pivot(&mut self.pyramid, &problem, FALLBACK_FACETS, &mut self.force, memory);
            spent += pivots;
        }
        self.alike.share(&problem, &mut self.force);
        if solved { Ok((spent, !converged)) } else { Err(StepFailure::NoImpulses) }
    }

    fn keep_impulses(&mut self) {
        let rows = self.space.rows();
        self.impulses.fill(0.0);
        for (&contact, force) in self.closed.iter().zip(self.force.chunks_exact(rows)) {
            self.impulses[contact * rows..(contact + 1) * rows].copy_from_slice(force);
        }
    }
}

/// Pivots, by a pyramid of this many facets; says how many, and whether they found impulses. Where
/// friction locks redundant contacts, rounding decides whether pivots end, and a little give, which
/// moves them by as little, lets them.
fn pivot(
    pyramid: &mut Pyramid,
    problem: &ContactProblem<'_>,
    facets: usize,
    force: &mut [f64],
    softened: &mut Vec<f64>,
) -> (usize, bool) {
    let (size, mut spent) = (force.len(), 0);
    let mut nearest = (NEARLY, None);
    for give in GIVE {
        softened.clear();
        softened.extend_from_slice(problem.delassus);
        let mean = (0..size).map(|i| problem.delassus[i * (size + 1)]).sum::<f64>();
        for i in 0..size {
            softened[i * (size + 1)] += give * mean / size as f64;
        }
        let report =
            pyramid.solve(&ContactProblem { delassus: softened, ..*problem }, facets, force);
        spent += report.pivots;
        if report.outcome == LcpOutcome::Solved {
            return (spent, true);
        }
        if report.residual <= nearest.0 {
            nearest = (report.residual, Some(force.to_vec()));
        }
    }
    // what friction locks slips by less than rounding resolves
    let found = nearest.1.is_some();
    nearest.1.into_iter().for_each(|nearly| force.copy_from_slice(&nearly));
    (spent, found)
}

impl Terms {
    fn clear(&mut self, n: usize, rows: usize) {
        let sizes = [n * n, n * n, n, rows * n];
        let parts = [&mut self.mass, &mut self.damping, &mut self.force, &mut self.jacobian];
        for (part, size) in parts.into_iter().zip(sizes) {
            part.clear();
            part.resize(size, 0.0);
        }
    }
}
