//! How logs are conditioned: what is asked for, and what follows from a log where nothing is.

use denavit_measure::condition::{Averaging, Conditioned, Conditioning, Derivatives, Filter};

/// How logs are conditioned.
#[derive(Clone, Copy, Debug, Default)]
pub struct Conditions {
    /// The filter of positions and torques.
    pub filter: FilterChoice,
    /// One sample in so many is left; by default, as the filter allows and 1200 remain.
    pub decimation: Option<usize>,
    /// Which laps are averaged.
    pub averaging: Averaging,
    /// Where velocities and accelerations come from.
    pub derivatives: Derivatives,
}

/// A zero-phase Butterworth filter.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum FilterChoice {
    /// Of fourth order, a tenth of the sampling rate, halved as long as noise of the positions
    /// biases parameters.
    #[default]
    Found,
    /// None.
    None,
    /// This one.
    Given(Filter),
}

/// How often the cutoff of each log is halved, if none was given: of those for the estimate, and
/// behind them perhaps of those for validation.
pub(super) type Halvings = Vec<u32>;

/// Halvings of the cutoff, at most, and periods of it that all logs, each of them, or a lap, must
/// have more of.
const MOST_HALVINGS: u32 = 6;
const FEWEST_PERIODS: f64 = 40.0;
const FEWEST_OF_A_LOG: f64 = 10.0;
const FEWEST_OF_A_LAP: f64 = 20.0;

/// The filter if nothing is said: its order, and its cutoff over the sampling rate.
const ORDER: usize = 4;
const TENTH: f64 = 0.1;

/// Samples that are left, if nothing is said: standard errors are found from parts of a log, of
/// which few say little.
const FEWEST_LEFT: f64 = 1200.0;

impl Conditions {
    /// A zero-phase filter of fourth order, all else as it is if nothing is said.
    pub fn filtered(cutoff_hz: f64) -> Self {
        let filter = FilterChoice::Given(Filter { order: ORDER, cutoff_hz });
        Self { filter, ..Self::default() }
    }

    fn averages(&self) -> bool {
        self.averaging != Averaging::No
    }

    /// The filter of a log at this distance of samples \[s\].
    fn filter(&self, step_s: f64, halvings: u32) -> Option<Filter> {
        match self.filter {
            FilterChoice::None => None,
            FilterChoice::Given(filter) => Some(filter),
            FilterChoice::Found => {
                Some(Filter { order: ORDER, cutoff_hz: cutoff(halvings) / step_s })
            }
        }
    }

    /// What is done with a log of so many samples at this distance \[s\].
    pub(super) fn of(&self, step_s: f64, samples: usize, halvings: u32) -> Conditioning {
        let filter = self.filter(step_s, halvings);
        // The decimator passes up to 0.4 of what is left of the rate.
        let allowed = filter.map_or(1.0, |filter| 0.4 / (filter.cutoff_hz * step_s));
        // of laps one is left
        let samples = if self.averages() { 0 } else { samples };
        let allowed = allowed.min(samples as f64 / FEWEST_LEFT);
        let decimation = self.decimation.unwrap_or(allowed.max(1.0) as usize);
        Conditioning {
            filter,
            derivatives: self.derivatives,
            decimation,
            averaging: self.averaging,
            resolution: None,
        }
    }
}

/// The cutoff in cycles per sample.
fn cutoff(halvings: u32) -> f64 {
    TENTH / f64::from(1 << halvings)
}

/// Periods of the cutoff in so many samples, whose edges are cut.
fn periods(samples: usize, halvings: u32) -> f64 {
    samples as f64 * cutoff(halvings) - 2.0 * ORDER as f64
}

impl Conditions {
    /// The same with half the cutoff of the logs that ask for it and are long enough; none if a
    /// filter was asked for, or logs, or one lap, are too short for it. How long laps are is known
    /// when they have been found.
    pub(super) fn lower(
        &self,
        logs: &[&Conditioned],
        halvings: &[u32],
        asking: &[bool],
    ) -> Option<Halvings> {
        let samples = |log: &Conditioned| log.q.first().map_or(0, Vec::len);
        let is_long = |log: &Conditioned, halvings: u32| match (self.averaging, log.laps) {
            (Averaging::No, _) => periods(samples(log), halvings) > FEWEST_OF_A_LOG,
            // a lap has no edges that are cut
            (_, Some(laps)) => laps.samples as f64 * cutoff(halvings) > FEWEST_OF_A_LAP,
            (_, None) => true,
        };
        let all = logs.iter().zip(halvings).zip(asking);
        let lower: Halvings = all
            .map(|((log, &now), asks)| {
                match *asks && now < MOST_HALVINGS && is_long(log, now + 1) {
                    true => now + 1,
                    false => now,
                }
            })
            .collect();
        let all = logs.iter().zip(&lower);
        let of_all: f64 = all.map(|(log, &halvings)| periods(samples(log), halvings)).sum();
        let are_long = self.averages() || of_all > FEWEST_PERIODS;
        (self.filter == FilterChoice::Found && are_long && lower != halvings).then_some(lower)
    }
}
