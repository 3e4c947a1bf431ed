//! The search for the reading that is believed most.

use super::balance::{Balance, Change, Fitted, LEAST, Shares, root_mean_square};
use super::misreading::Misreading;
use super::reading::{Reading, hypotheses};
use super::verdict::{BETTER, EXPLAINED, NEAR, PROMPT, Verdict};
use denavit_plants::regression::{RegressionJoint, RegressionModel};
use std::f64::consts::PI;

/// From this share on, left by the model's own values, single columns are looked at.
const FAR: f64 = 0.05;

/// The share of what is left by the model's own values that noise of the positions explains.
const NOISE: f64 = 0.5;

/// Readings that are estimated with, at most; those that the model's own values like best.
const ESTIMATED: usize = 80;

/// Steps of a zero [rad, m].
const ZERO_STEP: f64 = 2e-3;

/// The share of what an estimate leaves that a line of readings must explain, to first order, to be
/// followed; and lines that are, at most.
const PROMISING: f64 = 0.02;
const FOLLOWED: usize = 4;

/// What search and answers have in common.
pub(super) struct Search<'a> {
    pub(super) model: &'a RegressionModel,
    pub(super) balance: Balance<'a>,
    /// How much of each joint's torque noise of the positions makes by the values that are given:
    /// where that explains what these leave, nothing is tried that makes less of it, whatever is
    /// true.
    pub(super) noise: Vec<f64>,
    /// Signals are at most so many samples late.
    pub(super) latest: isize,
    /// Whether nothing is tried but what makes more of noise.
    pub(super) is_lower: bool,
}

/// Readings that differ by degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Line {
    Late,
    LateTorque(usize),
    LatePosition(usize),
    Zero(usize),
}

impl Line {
    /// The reading so many steps along it.
    fn at(self, steps: f64) -> Misreading {
        let samples = steps.round() as isize;
        match self {
            Self::Late => Misreading::Late(samples),
            Self::LateTorque(joint) => Misreading::LateTorque(joint, samples),
            Self::LatePosition(joint) => Misreading::LatePosition(joint, samples),
            Self::Zero(joint) => Misreading::Zero(joint, ZERO_STEP * steps),
        }
    }
}

/// Who says what is left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Witness {
    Own,
    Fit,
}

impl Search<'_> {
    /// Whether noise of the positions explains what the model's own values leave of a torque, or,
    /// where these are near, what an estimate does.
    fn is_noisy(&self, own: &Shares, fit: &Shares) -> bool {
        let is_near = root_mean_square(own) < NEAR;
        self.is_noise(own) || (is_near && self.is_noise(fit))
    }

    fn is_noise(&self, left: &Shares) -> bool {
        let mut both = left.iter().zip(&self.noise);
        let is_noise = |(left, noise): (&Option<f64>, &f64)| {
            left.is_some_and(|left| left > EXPLAINED && *noise > NOISE * left)
        };
        both.any(is_noise)
    }

    fn joints(&self) -> &[RegressionJoint] {
        &self.model.joints
    }

    /// The reading that is believed most, beside one.
    pub(super) fn best(&mut self, reading: &Reading) -> Option<Verdict> {
        let straight = self.balance.left(reading, true);
        let (own, found) = (straight.own, straight.fit?);
        let fit = &found.left;
        let is_misfit = root_mean_square(fit) > EXPLAINED;
        let is_far = own.as_ref().is_some_and(|own| root_mean_square(own) > FAR);
        let single = is_misfit || is_far;
        let is_noisy = own.as_ref().is_some_and(|own| self.is_noisy(own, fit));
        let is_measured = |joint: usize| fit[joint].is_some();
        let mut tried = hypotheses(self.model, &is_measured, [single, is_noisy]);
        tried.retain(|one| reading.with(*one, self.joints()) != *reading);
        let mut along = Vec::new();
        if self.is_lower {
            tried.retain(|one| one.makes_noise());
        } else {
            along = self.along_lines(reading, (own.as_ref(), &found));
            tried.extend(&along);
        }
        let mut judged: Vec<(Misreading, Option<Shares>, f64)> = Vec::new();
        for one in tried {
            let other = reading.with(one, &self.model.joints);
            let after = own.as_ref().and_then(|_| self.balance.left(&other, false).own);
            let both = own.as_ref().zip(after.as_ref());
            let ratio = both.map(|(own, after)| Change::of(own, after).ratio);
            // without a misfit an estimate can speak against a reading, not for it
            let is_asked = along.contains(&one) || one.makes_noise();
            if is_misfit || is_asked || ratio.is_some_and(|ratio| ratio < BETTER) {
                judged.push((one, after, ratio.unwrap_or(1.0)));
            }
        }
        judged.sort_by(|a, b| a.2.total_cmp(&b.2));
        judged.truncate(ESTIMATED);
        let independent = self.balance.independent();
        let mut best: Option<Verdict> = None;
        for (one, own_after, _) in judged {
            let other = reading.with(one, &self.model.joints);
            let Some(after) = self.balance.left(&other, true).fit else { continue };
            let both = own.as_ref().zip(own_after.as_ref()).map(|(before, after)| [before, after]);
            let mut verdict = Verdict::new(one, both, ([fit, &after.left], independent));
            // of noise an estimate may leave less by chance, but not where there is more of it
            verdict.by_fit &= one.makes_noise() || !(is_noisy && self.is_noise(fit));
            let is_better = best.as_ref().is_none_or(|best| verdict.rank() < best.rank());
            if verdict.is_believed() && is_better {
                best = Some(verdict);
            }
        }
        best
    }

    /// Lines of readings that begin at one: delays, unless something is late already, and zeros.
    fn lines(&self, reading: &Reading, fit: &Shares) -> Vec<Line> {
        let joints = self.joints();
        let real: Vec<usize> = (0..joints.len()).filter(|&joint| !joints[joint].is_base).collect();
        let mut lines = Vec::new();
        // what is late in one joint may show in its torque alone
        let shows = |left: &Option<f64>| left.is_some_and(|left| left > PROMPT);
        if fit.iter().any(shows) && self.latest > 0 && !reading.is_shifted() {
            lines.push(Line::Late);
            // nothing is late at rest
            let moving = real.iter().filter(|&&joint| self.balance.moves(joint));
            for &joint in moving.filter(|_| real.len() > 1) {
                lines.push(Line::LatePosition(joint));
                lines.extend(shows(&fit[joint]).then_some(Line::LateTorque(joint)));
            }
        }
        let is_open = |joint: &&usize| reading.positions[**joint].offset == 0.0;
        lines.extend(real.iter().filter(is_open).map(|&joint| Line::Zero(joint)));
        lines
    }

    /// The best readings on lines, by the witness that sees the line.
    fn along_lines(
        &mut self,
        reading: &Reading,
        (own, found): (Option<&Shares>, &Fitted),
    ) -> Vec<Misreading> {
        let fit = root_mean_square(&found.left);
        let lines = self.lines(reading, &found.left);
        let beside =
            |line: &Line| [1.0, -1.0].map(|steps| reading.with(line.at(steps), &self.model.joints));
        let pairs: Vec<[Reading; 2]> = lines.iter().map(beside).collect();
        let explained = self.balance.explained((reading, found), &pairs);
        let mut promising: Vec<(f64, Line)> =
            explained.into_iter().zip(lines.iter().copied()).collect();
        promising.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut tried: Vec<Misreading> = Vec::new();
        for (place, (share, line)) in promising.into_iter().enumerate() {
            let is_zero = matches!(line, Line::Zero(_));
            // far from the true zero the first order says little
            let is_followed = (share > PROMISING && place < FOLLOWED)
                || (is_zero && share > 0.0 && fit > EXPLAINED);
            if is_followed {
                tried.extend(self.along(reading, line, (Witness::Fit, fit)));
            }
            let is_open = |own: &f64| *own > 2.0 * fit.max(LEAST);
            if let (Some(own), true) = (own.map(root_mean_square).filter(is_open), is_zero) {
                tried.extend(self.along(reading, line, (Witness::Own, own)));
            }
        }
        tried
    }

    /// What a witness leaves so many steps along a line.
    fn left(&mut self, reading: &Reading, (line, steps): (Line, f64), witness: Witness) -> f64 {
        let other = reading.with(line.at(steps), &self.model.joints);
        let left = self.balance.left(&other, witness == Witness::Fit);
        let shares = match witness {
            Witness::Own => left.own,
            Witness::Fit => left.fit.map(|fit| fit.left),
        };
        shares.map_or(f64::INFINITY, |shares| root_mean_square(&shares))
    }

    /// The reading on a line with which a witness leaves least, which is less than `straight`.
    fn along(
        &mut self,
        reading: &Reading,
        line: Line,
        (witness, straight): (Witness, f64),
    ) -> Option<Misreading> {
        let furthest = match line {
            Line::Zero(_) => (PI / ZERO_STEP) as isize,
            _ => self.latest,
        };
        let mut ladder: Vec<isize> = vec![0];
        let next = |last: isize| last + (last / 2).max(1);
        while let Some(steps) = ladder.last().map(|&last| next(last)).filter(|&s| s <= furthest) {
            ladder.push(steps);
        }
        let ladder: Vec<isize> =
            ladder.iter().skip(1).rev().map(|steps| -steps).chain(ladder.iter().copied()).collect();
        let mut left = |steps: isize| self.left(reading, (line, steps as f64), witness);
        let shares: Vec<f64> = ladder.iter().map(|&steps| left(steps)).collect();
        let at = (0..ladder.len()).min_by(|&a, &b| shares[a].total_cmp(&shares[b]))?;
        let mut low = ladder[at.saturating_sub(1)];
        let mut high = ladder[(at + 1).min(ladder.len() - 1)];
        while high - low > 2 {
            let third = (high - low) / 3;
            let [a, b] = [low + third, high - third];
            if left(a) < left(b) {
                high = b;
            } else {
                low = a;
            }
        }
        let best = (low..=high).map(|steps| (steps, left(steps)));
        let (steps, least) = best.min_by(|a, b| a.1.total_cmp(&b.1))?;
        if least >= straight {
            return None;
        }
        let Line::Zero(_) = line else { return (steps != 0).then(|| line.at(steps as f64)) };
        // squares are a parabola near their least
        let [before, here, after] = [steps - 1, steps, steps + 1].map(|at| left(at).powi(2));
        let bend = before - 2.0 * here + after;
        let beside = if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 };
        Some(line.at(steps as f64 + beside.clamp(-1.0, 1.0)))
    }
}
