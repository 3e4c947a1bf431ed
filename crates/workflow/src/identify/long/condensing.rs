//! Stretches of a long log to rows, which are added to each other.

use super::super::Work;
use super::super::logs::Reader;
use super::reading::{Held, OfRobot};
use super::{LongLog, LongPlan, PieceRows};
use crate::error::{Cause, Error};
use crate::logs::{LogSource, Logs};
use crate::observer::{Reading, Stage, Watched};
use denavit_identify::estimate::Options;
use denavit_identify::estimate::long::{LongRows, WholeLog};
use denavit_measure::condition::{Conditioned, Stretches};
use denavit_plants::regression::RegressionModel;
use std::ops::Range;

/// Adds rows that come later.
fn add(rows: &mut Option<LongRows>, later: LongRows, is_same_part: bool) {
    match rows {
        Some(rows) => rows.add(later, is_same_part),
        None => *rows = Some(later),
    }
}

/// What all pieces say.
#[derive(Debug, Default)]
pub(super) struct Whole {
    pub(super) rows: Option<LongRows>,
    /// Logs for validation, each with a stretch that says the same.
    pub(super) same: Vec<(String, String)>,
}

impl Whole {
    /// Adds the piece that comes next.
    pub(super) fn add(&mut self, piece: PieceRows) {
        if let Some(rows) = piece.rows {
            add(&mut self.rows, rows, false);
        }
        for one in piece.same {
            note(&mut self.same, one);
        }
    }
}

/// Keeps the first stretch that says the same as a log.
fn note(same: &mut Vec<(String, String)>, one: (String, String)) {
    if same.iter().all(|(file, _)| *file != one.0) {
        same.push(one);
    }
}

/// Makes rows of the stretches of a log, one by one.
pub(super) struct Condenser<'a> {
    plan: &'a LongPlan,
    cut: Stretches,
    options: Options,
    work: Work<'a>,
    logs: Logs,
    of_robot: OfRobot<'a>,
    /// The logs for validation, behind the filter of the stretches.
    judges: Vec<Conditioned>,
}

impl<'a> Condenser<'a> {
    /// Reads the logs for validation.
    pub(super) fn new(
        long: &LongLog<'a>,
        model: &'a RegressionModel,
        plan: &'a LongPlan,
        watched: &mut Watched<'_>,
    ) -> Result<Self, Error> {
        let (robot, laws) = (&long.file.apart.robot, &long.file.apart.laws);
        let work = Work { logs: long.logs, options: long.options, robot, laws, model };
        let mut reading = Reading::needed(watched, Stage::Condensing, 1);
        let mut reader = Reader::new(work, &mut reading)?;
        let judges = long.logs.held_out.iter().map(|log| reader.as_stretch(log, &plan.how));
        let judges = judges.filter_map(Result::transpose).collect::<Result<Vec<_>, _>>()?;
        let mut logs = long.logs.clone();
        // what only a whole log can show is asked of its head
        logs.accepts_suspicious = true;
        let cut = plan.cut().map_err(|why| long.wrong(why))?;
        let options = long.options.estimate(model, plan.position_noise.clone())?;
        let of_robot = long.robot(model);
        Ok(Self { plan, cut, options, work, logs, of_robot, judges })
    }

    /// The rows of the log that a stretch is read with.
    pub(super) fn read(&self, stretch: usize) -> Range<usize> {
        self.cut.get(stretch).read
    }

    /// Sees to it that a stretch is of the log that its piece is of.
    fn join(&self, piece: &mut PieceRows, stretch: usize, source: &LogSource) -> Result<(), Error> {
        let from = self.cut.get(stretch).read.start;
        let logs = Logs { train: vec![source.clone()], ..self.logs.clone() };
        let held = Held::read(&logs, &self.of_robot)?;
        let named = |seam: usize| {
            let rows = self.plan.seam(seam)?;
            Some(held.name_of(rows.start - from..rows.end - from))
        };
        let [begins, ends] = [named(stretch), named(stretch + 1)];
        if piece.stretches.start == stretch {
            piece.seams[0] = begins;
        } else if piece.seams[1] != begins {
            let why = format!(
                "stretch {stretch} is of another log than the one before it\n  hint: condense \
                 piece {} again, from one log",
                piece.piece
            );
            return Err(Cause::Long(source.to_string(), why).into());
        }
        piece.seams[1] = ends;
        Ok(())
    }

    /// Adds the rows of a stretch, which is the log, to those of its piece; none where nothing
    /// moves.
    pub(super) fn add(
        &self,
        piece: &mut PieceRows,
        stretch: usize,
        source: &LogSource,
        watched: &mut Watched<'_>,
    ) -> Result<(), Error> {
        let Self { plan, cut, options, work, logs, judges, .. } = self;
        self.join(piece, stretch, source)?;
        let mut reading = Reading::needed(watched, Stage::Condensing, 1);
        let mut reader = Reader::new(Work { logs, ..*work }, &mut reading)?;
        let clock = plan.clock(work.logs.accepts_suspicious);
        let Some(log) = reader.stretch(source, &cut.get(stretch), clock, &plan.how)? else {
            return Ok(());
        };
        for judge in judges.iter().filter(|judge| log.shares_a_part(judge)) {
            note(&mut piece.same, (judge.file.clone(), source.to_string()));
        }
        let whole = WholeLog {
            samples: cut.kept(),
            inner: cut.inner(),
            stretches: cut.count(),
            start_s: plan.start_s,
        };
        let rows = LongRows::of_stretch(work.model, &log, &plan.rule, options, whole);
        add(&mut piece.rows, rows, plan.has_long_parts());
        Ok(())
    }
}
