//! Whether an effect is the same in the course of a log.
//!
//! A law of the catalogue holds at all times, and those that do not say how they change. Something
//! else may be like one for a while: a force that fades is like a spring that becomes weak. Each
//! log gives the effect a column more, what it does times a line in time, from -1 at the first row
//! to 1 at the last. If the data ask for these columns and make them large, the effect is only near
//! to what is there. That is the test of Chow (1960) for constant parameters, as evidence.

use super::data::RowResponse;
use super::hypothesis::{Hypothesis, Part};
use super::search::Search;
use super::state::Taken;
use denavit_evidence::{Spectrum, Terms, policy};

impl Search<'_> {
    /// By how much of itself an effect is larger or smaller late in logs than early where it acts,
    /// as at the ends of a log if it acts at all times, root of mean square over logs; none where
    /// data do not ask for that, or ask for so little that friction which warms up does as much.
    pub(super) fn change_in_time(&self, found: &Hypothesis, place: usize) -> Option<f64> {
        let candidate = found.parts[place].placed.candidate;
        let both = self.weighing.in_time(&Taken { candidate, values: found.values(place) });
        let (columns, spreads): (Vec<Spectrum>, Vec<f64>) = both.into_iter().unzip();
        let count = columns.len();
        let scaled = |mut column: Spectrum| {
            column.iter_mut().flatten().for_each(|row| *row *= policy::CHANGE);
            column
        };
        let changing = Terms::free(columns.into_iter().map(scaled).collect());
        let with = |parts: Vec<Part>| self.weighed(parts, Some(found), policy::ROUNDS[1]);
        let own = Part { terms: changing, ..found.parts[place].clone() };
        let constant = with(found.parts.clone());
        let changes = with([&found.parts[..], &[own]].concat());
        let odds = changes.weighed.log_evidence - constant.weighed.log_evidence + policy::UNCOMMON;
        let factors = &changes.weighed.factors[changes.weighed.factors.len() - count..];
        // an effect that acts at few moments says nothing of the ends of a log
        let of_log = |(factor, spread): (&f64, &f64)| (policy::CHANGE * factor * spread).powi(2);
        let squares: f64 = factors.iter().zip(&spreads).map(of_log).sum();
        let change = (squares / count.max(1) as f64).sqrt();
        // a change that is smaller than what is left beside it may be of that
        let torque = changes.torque(found.parts.len());
        let share = |channel| self.weighing.spectra.share(&torque, channel);
        let is_seen = || {
            (0..)
                .zip(self.weighing.open(&changes, &self.floor))
                .any(|(channel, open)| share(channel) > open)
        };
        (odds > policy::NAMED && change > policy::CHANGED && is_seen()).then_some(change)
    }
}

impl super::weighing::Weighing<'_> {
    /// For each log what an effect does there, times a line in time, and how far that line spreads
    /// where the effect acts, over how far it does in the whole log.
    fn in_time(&self, taken: &Taken) -> Vec<(Spectrum, f64)> {
        let mut responses = self.responses(taken);
        let logs: Vec<usize> = self.sets.iter().map(|data| data.signals.len()).collect();
        let all: usize = logs.iter().sum();
        let mut moments = vec![[0.0; 3]; all];
        let mut before = 0;
        for (response, logs) in responses.iter_mut().zip(&logs) {
            let RowResponse { stretches, torque, gradient, .. } = response;
            let mut of = |(stretch, torque): (&super::data::Stretch, &Vec<f64>)| {
                let own = before + stretch.log.0;
                for (row, at) in torque.iter().zip(line(torque.len())) {
                    let weight = row * row;
                    let all = [weight, weight * at, weight * at * at];
                    moments[own].iter_mut().zip(all).for_each(|(sum, more)| *sum += more);
                }
                let along = || torque.iter().zip(line(torque.len())).map(|(row, at)| row * at);
                let of_log = |log: usize| match log == own {
                    true => along().collect(),
                    false => vec![0.0; torque.len()],
                };
                (0..all).map(of_log).collect()
            };
            *gradient = stretches.iter().zip(torque.iter()).map(&mut of).collect();
            before += logs;
        }
        let follows = self.candidates[taken.candidate].law.follows_accelerations();
        let columns = self.spectra.of_response(&self.sets, &responses, self.up_to(follows)).1;
        let spread = |[weight, first, second]: [f64; 3]| {
            let mean = first / f64::max(weight, f64::MIN_POSITIVE);
            (3.0 * (second / f64::max(weight, f64::MIN_POSITIVE) - mean * mean)).max(0.0).sqrt()
        };
        columns.into_iter().zip(moments.into_iter().map(spread)).collect()
    }
}

/// A line from -1 at the first row to 1 at the last.
fn line(rows: usize) -> impl Iterator<Item = f64> {
    let last = rows.saturating_sub(1).max(1) as f64;
    (0..rows).map(move |k| 2.0 * k as f64 / last - 1.0)
}
