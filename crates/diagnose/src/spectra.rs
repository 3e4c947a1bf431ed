//! Rows as spectra: the cosine transform of each stretch, lines below the cutoff of torques.
//!
//! Stationary noise of any colour is independent from line to line there, but for the ends of a
//! stretch (Ahmed, Natarajan, Rao 1974). Lines of one joint and one band of frequencies make a
//! cell, whose noise has a variance of its own.

use super::data::{Data, RowResponse, Stretch};
use super::floor::rms;
use denavit_evidence::{Layout, Spectrum, policy};
use nalgebra::DVector;
use rustdct::{DctPlanner, TransformType2And3};
use std::collections::BTreeMap;
use std::sync::Arc;

/// One line of a spectrum: a stretch of a set of logs, and the number of the line.
#[derive(Clone, Copy, Debug)]
struct Line {
    set: usize,
    stretch: usize,
    number: usize,
    /// Its frequency \[Hz\].
    hz: f64,
}

/// Which lines there are, and how rows become them.
pub(super) struct Spectra {
    /// For each channel its lines, band by band.
    lines: Vec<Vec<Line>>,
    /// Where the bands are, and how much noise is expected.
    pub(super) layout: Layout,
    /// The torque of each channel (root of mean square) [N m, N].
    pub(super) torque: Vec<f64>,
    /// What was measured; all rows count.
    pub(super) measured: Spectrum,
    /// Rows in time of each channel.
    rows: Vec<f64>,
    plans: Vec<(usize, Arc<dyn TransformType2And3<f64>>)>,
    /// For each set and stretch what its rows count.
    weights: Vec<Vec<Vec<f64>>>,
    /// For each set and stretch the distance of its lines \[Hz\].
    line_hz: Vec<Vec<f64>>,
}

impl Spectra {
    /// The spectra of sets of logs, with bands of their cutoff frequency.
    pub(super) fn new(sets: &[&Data<'_>], cutoff_hz: f64) -> Self {
        let channels = sets[0].nominal.equations();
        let mut spectra = Self {
            lines: vec![Vec::new(); channels],
            layout: Layout { bands: vec![Vec::new(); channels], levels: vec![0.0; channels] },
            torque: vec![0.0; channels],
            measured: Vec::new(),
            rows: vec![0.0; channels],
            plans: Vec::new(),
            weights: Vec::new(),
            line_hz: Vec::new(),
        };
        let mut planner = DctPlanner::new();
        let mut torques: Vec<Vec<f64>> = vec![Vec::new(); channels];
        for (set, data) in sets.iter().enumerate() {
            spectra.weights.push(data.stretches.iter().map(|one| vec![1.0; one.rows]).collect());
            let line_hz = |stretch: &Stretch| {
                0.5 / (stretch.rows as f64 * data.signals[stretch.log.0].row_step_s())
            };
            spectra.line_hz.push(data.stretches.iter().map(line_hz).collect());
            for (place, stretch) in data.stretches.iter().enumerate() {
                let Stretch { equation, first, rows, .. } = *stretch;
                let line_hz = spectra.line_hz[set][place];
                let line = |number: usize| {
                    let hz = line_hz * number as f64;
                    Line { set, stretch: place, number, hz }
                };
                let lines = (0..rows).map(line).filter(|line| line.hz < cutoff_hz);
                spectra.lines[equation].extend(lines);
                spectra.rows[equation] += rows as f64;
                torques[equation].extend(&data.torque[first..first + rows]);
                if spectra.plans.iter().all(|(length, _)| *length != rows) {
                    spectra.plans.push((rows, planner.plan_dct2(rows)));
                }
            }
        }
        for (channel, lines) in spectra.lines.iter_mut().enumerate() {
            let band = |line: &Line| {
                policy::BANDS.iter().filter(|share| line.hz >= **share * cutoff_hz).count() - 1
            };
            lines.sort_by_key(band);
            let mut first = 0;
            for number in 0..policy::BANDS.len() {
                let end = first + lines[first..].iter().filter(|line| band(line) == number).count();
                spectra.layout.bands[channel].push(first..end);
                first = end;
            }
            spectra.torque[channel] = rms(&torques[channel]);
            let least = f64::MIN_POSITIVE.sqrt();
            spectra.layout.levels[channel] =
                (policy::NOISE_LEVEL * spectra.torque[channel]).max(least);
        }
        let rows: Vec<&[f64]> = sets.iter().map(|data| data.torque.as_slice()).collect();
        spectra.measured = spectra.of_rows(sets, &rows, f64::INFINITY);
        let weights = |data: &&Data<'_>| {
            data.stretches.iter().map(|one| data.weights[one.range()].to_vec()).collect()
        };
        spectra.weights = sets.iter().map(weights).collect();
        spectra
    }

    /// The frequencies of a channel's lines \[Hz\].
    pub(super) fn frequencies(&self, channel: usize) -> impl Iterator<Item = f64> {
        self.lines[channel].iter().map(|line| line.hz)
    }

    /// The spectrum of what stretches have, if they have anything.
    fn of<'r>(&self, rows: &dyn Fn(usize, usize) -> Option<&'r [f64]>, up_to_hz: f64) -> Spectrum {
        let of_channel = |lines: &Vec<Line>| {
            let mut all: BTreeMap<(usize, usize), Option<Vec<f64>>> = BTreeMap::new();
            let of_line = |&Line { set, stretch, number, .. }: &Line| {
                let of = || Some(self.transformed(rows(set, stretch)?, set, stretch, up_to_hz));
                let own = all.entry((set, stretch)).or_insert_with(of);
                own.as_ref().map_or(0.0, |own| own[number])
            };
            let lines: Vec<f64> = lines.iter().map(of_line).collect();
            if all.values().any(Option::is_some) { lines } else { Vec::new() }
        };
        self.lines.iter().map(of_channel).collect()
    }

    /// The orthonormal cosine transform of what a stretch has up to a frequency \[Hz\], its rows by
    /// what they count.
    fn transformed(&self, rows: &[f64], set: usize, stretch: usize, up_to_hz: f64) -> Vec<f64> {
        let plan = self.plan(rows.len());
        let mut lines = rows.to_vec();
        if up_to_hz.is_finite() {
            plan.process_dct2(&mut lines);
            let last = (up_to_hz / self.line_hz[set][stretch]) as usize;
            lines.iter_mut().skip(last + 1).for_each(|line| *line = 0.0);
            plan.process_dct3(&mut lines);
            let scale = 2.0 / rows.len() as f64;
            lines.iter_mut().for_each(|row| *row *= scale);
        }
        let weights = &self.weights[set][stretch];
        lines.iter_mut().zip(weights).for_each(|(row, weight)| *row *= weight);
        plan.process_dct2(&mut lines);
        let scale = (2.0 / rows.len() as f64).sqrt();
        lines.iter_mut().for_each(|line| *line *= scale);
        lines[0] *= 0.5_f64.sqrt();
        lines
    }

    /// For each set what factors of lines are in its rows: the transposed transform.
    pub(super) fn to_rows(&self, sets: &[&Data<'_>], factors: &Spectrum) -> Vec<Vec<f64>> {
        let mut all: Vec<Vec<f64>> = sets.iter().map(|data| vec![0.0; data.rows()]).collect();
        for (line, factor) in self.lines.iter().flatten().zip(factors.iter().flatten()) {
            let first = sets[line.set].stretches[line.stretch].first;
            all[line.set][first + line.number] = *factor;
        }
        for ((data, all), weights) in sets.iter().zip(&mut all).zip(&self.weights) {
            for (stretch, weights) in data.stretches.iter().zip(weights) {
                let rows = &mut all[stretch.range()];
                rows[0] *= 2.0_f64.sqrt();
                self.plan(stretch.rows).process_dct3(rows);
                let scale = (2.0 / stretch.rows as f64).sqrt();
                rows.iter_mut().zip(weights).for_each(|(row, weight)| *row *= scale * weight);
            }
        }
        all
    }

    fn plan(&self, rows: usize) -> &dyn TransformType2And3<f64> {
        let plan = self.plans.iter().find(|(length, _)| *length == rows);
        &*plan.expect("every stretch has a plan").1
    }

    /// The spectrum of what rows of all sets have up to a frequency \[Hz\].
    pub(super) fn of_rows(&self, sets: &[&Data<'_>], rows: &[&[f64]], up_to_hz: f64) -> Spectrum {
        let own = |set: usize, stretch: usize| {
            let Stretch { first, rows: count, .. } = sets[set].stretches[stretch];
            Some(&rows[set][first..first + count])
        };
        self.of(&own, up_to_hz)
    }

    /// The spectra of what the torque of a response to all sets has up to a frequency \[Hz\], and
    /// of its gradient.
    pub(super) fn of_response(
        &self,
        sets: &[&Data<'_>],
        responses: &[RowResponse],
        up_to_hz: f64,
    ) -> (Spectrum, Vec<Spectrum>) {
        let place = |set: usize, stretch: usize| {
            let first = sets[set].stretches[stretch].first;
            responses[set].stretches.iter().position(|own| own.first == first)
        };
        let torque = |set: usize, stretch: usize| {
            Some(responses[set].torque[place(set, stretch)?].as_slice())
        };
        let torque = self.of(&torque, up_to_hz);
        let counts = responses.iter().filter_map(|one| one.gradient.first().map(Vec::len));
        let parameters = counts.max().unwrap_or(0);
        let of_parameter = |parameter: usize| {
            let own = |set: usize, stretch: usize| {
                Some(responses[set].gradient[place(set, stretch)?][parameter].as_slice())
            };
            self.of(&own, up_to_hz)
        };
        (torque, (0..parameters).map(of_parameter).collect())
    }

    /// The root of the mean square of a channel in time, over that of its torque.
    pub(super) fn share(&self, spectrum: &Spectrum, channel: usize) -> f64 {
        let rows = spectrum.get(channel).into_iter().flatten();
        self.share_of_squares(channel, rows.map(|row| row * row).sum())
    }

    /// The same of the sum of squares of all lines.
    pub(super) fn share_of_squares(&self, channel: usize, squares: f64) -> f64 {
        let mean = squares / self.rows[channel].max(1.0);
        mean.sqrt() / self.torque[channel].max(f64::MIN_POSITIVE)
    }

    /// All channels of a spectrum, over their torques.
    pub(super) fn stacked(&self, spectrum: &Spectrum) -> DVector<f64> {
        let of_channel = |(channel, lines): (usize, &Vec<Line>)| {
            let unit = 1.0 / self.torque[channel].max(f64::MIN_POSITIVE);
            match spectrum.get(channel).filter(|rows| !rows.is_empty()) {
                Some(rows) => rows.iter().map(|row| unit * row).collect(),
                None => vec![0.0; lines.len()],
            }
        };
        DVector::from_vec(self.lines.iter().enumerate().flat_map(of_channel).collect())
    }

    /// The spectrum of stacked channels.
    pub(super) fn unstacked(&self, stacked: &DVector<f64>) -> Spectrum {
        let mut rest = stacked.as_slice();
        let of_channel = |(channel, lines): (usize, &Vec<Line>)| {
            let (own, others) = rest.split_at(lines.len());
            rest = others;
            own.iter().map(|row| row * self.torque[channel]).collect()
        };
        self.lines.iter().enumerate().map(of_channel).collect()
    }

    /// The largest share of a channel.
    pub(super) fn largest_share(&self, spectrum: &Spectrum) -> f64 {
        (0..self.lines.len()).map(|channel| self.share(spectrum, channel)).fold(0.0, f64::max)
    }
}

/// The cosine transform of rows, up to a factor.
pub(super) fn cosine_lines(rows: &[f64]) -> Vec<f64> {
    let mut lines = rows.to_vec();
    DctPlanner::new().plan_dct2(rows.len()).process_dct2(&mut lines);
    lines
}

/// The line up to which nearly all of the power of a rate is.
pub(super) fn last_driven(lines: &[f64]) -> usize {
    let power = |line: &f64| line * line;
    let whole: f64 = lines.iter().map(power).sum();
    let mut sum = 0.0;
    let mut is_below = |line: &f64| {
        sum += power(line);
        sum < policy::DRIVEN_SHARE * whole
    };
    lines.iter().take_while(|line| is_below(line)).count()
}
