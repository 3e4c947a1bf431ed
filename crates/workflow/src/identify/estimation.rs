//! Estimates of one run, with the filter that noise of the positions asks for.

use super::Work;
use super::conditions::Halvings;
use super::logs::{self, Read};
use crate::error::{Cause, Error};
use crate::observer::{Reading, Stage, Watched};
use denavit_codegen::effect::{self, Effect};
use denavit_codegen::model::Robot;
use denavit_identify::estimate::{Consistent, IdentifiedParameter, Method, Options};
use denavit_identify::{Estimated, Identification, Request, estimated};
use denavit_measure::condition::Conditioned;
use denavit_plants::regression::RegressionModel;
use denavit_plants::{FoundValues, UpdatedModel, updated_model};

/// What estimates of one run have in common.
#[derive(Clone, Copy)]
pub(super) struct Estimation<'a> {
    pub(super) work: Work<'a>,
    pub(super) own: &'a [Effect],
    pub(super) source: &'a str,
}

/// What is found, and the model with it.
pub(super) type Found = (Identification, Result<UpdatedModel, denavit_plants::Error>);

impl Estimation<'_> {
    /// All logs, for the first time.
    pub(super) fn read_first(&self, watched: &mut Watched<'_>) -> Result<Read, Error> {
        logs::read(self.work, &[], &mut Reading::first(watched, self.work.files()))
    }

    /// All logs again, with these halvings of their cutoffs.
    fn read_again(
        &self,
        halvings: &[u32],
        stage: Stage,
        watched: &mut Watched<'_>,
    ) -> Result<Read, Error> {
        let mut reading = Reading::needed(watched, stage, self.work.files());
        logs::read(self.work, halvings, &mut reading)
    }

    pub(super) fn request<'a>(&'a self, read: &'a Read, options: &'a Options) -> Request<'a> {
        Request {
            model: self.work.model,
            train: &read.train,
            validate: &read.validate,
            instruments: &read.instruments,
            options,
        }
    }

    pub(super) fn found(&self, read: &Read, options: &Options) -> Result<Found, Error> {
        let estimated = self.estimated(read, options)?;
        Ok(self.judged(read, options, estimated))
    }

    fn estimated(&self, read: &Read, options: &Options) -> Result<Estimated, Error> {
        let failed = |error| Cause::Identify(self.work.model.model.clone(), error).into();
        estimated(self.request(read, options)).map_err(failed)
    }

    fn judged(&self, read: &Read, options: &Options, estimated: Estimated) -> Found {
        let found = estimated.judged(self.request(read, options));
        let updated = self.updated(&found);
        (found, updated)
    }

    /// The model with what is found.
    pub(super) fn updated(
        &self,
        found: &Identification,
    ) -> Result<UpdatedModel, denavit_plants::Error> {
        let Work { robot, model, .. } = self.work;
        let (bodies, listed) = (&found.consistent, &found.parameters);
        let updated = updated(robot, model, bodies, listed, self.source);
        updated.and_then(|updated| with_all_effects(updated, self.own))
    }

    /// What is found with the highest filter, of those that nobody asked for, below which noise of
    /// the positions biases nothing; where parameters change with half the cutoff, with the one
    /// that makes their errors smallest.
    pub(super) fn unbiased(
        &self,
        mut read: Read,
        options: &Options,
        watched: &mut Watched<'_>,
    ) -> Result<(Read, Found), Error> {
        let mut halvings = vec![0; read.train.len()];
        if !watched.begins(Stage::Estimating) {
            return Err(Cause::Stopped.into());
        }
        let mut found = self.estimated(&read, options)?;
        let allows_for_noise = options.method == Method::Instrumental;
        while !allows_for_noise && let Some((lower, most)) = self.lower(&read, &halvings, &found) {
            let times = lower.iter().copied().max().unwrap_or(0);
            let again = Stage::ReadingLogsAgain(times);
            if !watched.begins(again) {
                break;
            }
            drop(read); // logs are large: not all of them twice
            read = self.read_again(&lower, again, watched)?;
            let next = match watched.begins(Stage::EstimatingAgain(times)) {
                true => Some(self.estimated(&read, options)?),
                false => None,
            };
            let better = next.filter(|next| {
                let growth = growth_of_errors(&next.parameters, &found.parameters);
                next.filter_error.is_none() && growth < most
            });
            let Some(better) = better else {
                // worse than the noise that it takes away, or stopped
                drop(read);
                read = self.read_again(&halvings, again, watched)?;
                break;
            };
            (found, halvings) = (better, lower);
        }
        read.halvings = halvings.first().copied().unwrap_or(0);
        self.lower_held_out(&mut read, halvings, &found, watched)?;
        let mut found = self.judged(&read, options, found);
        let given = &self.work.logs.columns;
        found.0.misread.iter_mut().for_each(|one| one.given = given.clone());
        Ok((read, found))
    }

    /// Reads the logs for validation behind the highest filters that leave little of the noise of
    /// their positions, if nobody asked for others.
    fn lower_held_out(
        &self,
        read: &mut Read,
        mut halvings: Halvings,
        found: &Estimated,
        watched: &mut Watched<'_>,
    ) -> Result<(), Error> {
        let train = read.train.len();
        halvings.resize(read.logs().len(), 0);
        loop {
            let others = read.validate.iter().map(|log| found.is_noisy(self.work.model, log));
            let asking: Vec<bool> = std::iter::repeat_n(false, train).chain(others).collect();
            let lower = self.work.options.conditions.lower(&read.logs(), &halvings, &asking);
            let Some(lower) = lower else { return Ok(()) };
            let again = Stage::ReadingHeldOutAgain;
            if !watched.begins(again) {
                return Ok(());
            }
            let count = self.work.logs.held_out.len();
            read.held_out(self.work, &lower[train..], &mut Reading::needed(watched, again, count))?;
            halvings = lower;
        }
    }

    /// The next lower filters of logs, if noise of the positions asks for them, and how errors may
    /// grow with them: of the logs that bias parameters, or of all where parameters may change
    /// with it.
    fn lower(&self, read: &Read, halvings: &[u32], found: &Estimated) -> Option<(Halvings, f64)> {
        let conditions = &self.work.options.conditions;
        let logs: Vec<&Conditioned> = read.train.iter().collect();
        let lower = |asking: &[bool]| conditions.lower(&logs, halvings, asking);
        let of_biasing = lower(&found.biasing_logs).map(|lower| (lower, f64::INFINITY));
        let may_change = found.parameters.iter().any(IdentifiedParameter::may_change);
        let of_all = || lower(&vec![may_change; halvings.len()]).map(|lower| (lower, SMALLER));
        of_biasing.or_else(of_all)
    }
}

/// How errors may grow with a lower filter, as the logarithm of their geometric mean.
const SMALLER: f64 = 0.0;

/// By what standard errors are larger than others: the logarithm of the geometric mean.
fn growth_of_errors(parameters: &[IdentifiedParameter], others: &[IdentifiedParameter]) -> f64 {
    let ratio = |(one, other): (&IdentifiedParameter, &IdentifiedParameter)| match other.std {
        Some(other) if other > 0.0 => one.std.map_or(f64::INFINITY, |std| (std / other).ln()),
        _ => 0.0,
    };
    parameters.iter().zip(others).map(ratio).sum::<f64>() / parameters.len().max(1) as f64
}

/// The model with the bodies nearest to what was found, and errors of what stands alone.
pub(super) fn updated(
    robot: &Robot,
    model: &RegressionModel,
    bodies: &Consistent,
    listed: &[IdentifiedParameter],
    source: &str,
) -> Result<UpdatedModel, denavit_plants::Error> {
    let estimate = |one: &IdentifiedParameter| one.std.map(|std| [one.value, std]);
    let estimates: Vec<Option<[f64; 2]>> = listed.iter().map(estimate).collect();
    let Consistent { standard, own, .. } = bodies;
    updated_model(robot, model, FoundValues { standard, own, estimates: &estimates }, source)
}

/// The identified model with all of its effects: what is simulated.
fn with_all_effects(
    updated: UpdatedModel,
    own: &[Effect],
) -> Result<UpdatedModel, denavit_plants::Error> {
    let UpdatedModel { text, errors, .. } = updated;
    let robot = effect::read_model("the identified model", text.as_bytes(), own)?;
    Ok(UpdatedModel { text, robot, errors })
}
