//! A log that is too long to be held at once.
//!
//! Its head is identified as any log is. That says behind which filter, and without which rows, the
//! rest is condensed: stretch by stretch, each with as much of the log beside it as the filter
//! remembers, to triangles, which are added. Pieces of the log can so be condensed anywhere, in any
//! order, and are added in theirs: the same numbers to the last bit.

mod condensing;
mod plan;
mod reading;

use super::estimation::Estimation;
use super::{Head, Identified, IdentifyOptions, regression};
use crate::error::{Cause, Error};
use crate::files::Files;
use crate::logs::{LogSource, Logs};
use crate::observer::{Observer, Stage, Watched};
use crate::robot_file::RobotFile;
use condensing::{Condenser, Whole};
use denavit_identify::estimate::long::is_of_triangles;
use denavit_measure::condition::Averaging;
use denavit_measure::log::LogRemark;
use denavit_plants::regression::RegressionModel;
pub use plan::{LongPlan, PieceRows};
use reading::{Held, Survey, Window};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::sync::Arc;

/// A long log, the robot that it is of, and how it is identified.
#[derive(Clone, Copy, Debug)]
pub struct LongLog<'a> {
    /// The robot.
    pub file: &'a RobotFile,
    /// The log, alone for training, and those that judge it, which are held as a whole.
    pub logs: &'a Logs,
    /// How; by least squares, weighted perhaps, without laps, instruments and a controller.
    pub options: &'a IdentifyOptions,
    /// Rows of its head.
    pub head_rows: usize,
}

impl LongLog<'_> {
    /// Rows of a head if nothing is said.
    pub const USUAL_HEAD: usize = 1 << 19;
}

/// Identifies base parameters from a log that may be larger than the memory. One that is no longer
/// than its head is identified as any log is.
///
/// # Errors
/// All that is wrong with the logs, or why they do not suit the robot or the options.
pub fn identify_long(long: LongLog<'_>, observer: &mut dyn Observer) -> Result<Identified, Error> {
    let mut watched = Watched::new(observer);
    let model = long.model()?;
    let survey = long.survey(&model)?;
    if survey.rows <= long.head_rows {
        return super::identify(long.file, long.logs, long.options, watched.observer());
    }
    let logs = long.head_logs(&model)?;
    let head = Head::new(long.file, &logs, long.options, &model, &mut watched)?;
    let plan = long.planned(&head, survey)?;
    let mut whole = Whole::default();
    long.each_piece(&model, &plan, 0..plan.pieces(), &mut watched, |piece| whole.add(piece))?;
    long.answered(head, whole, &mut watched)
}

/// Whether a log can be read once alone, as what another program writes.
fn is_stream(source: &LogSource) -> bool {
    let found = source.file().and_then(|path| path.metadata().ok());
    found.is_some_and(|found| !found.is_file() && !found.is_dir())
}

impl LongLog<'_> {
    /// What its head says of it, for those who condense it. Where the log is read elsewhere, its
    /// head is given as the log, and `elsewhere` is the number of all rows, with the time of the
    /// last one as its column has it.
    ///
    /// # Errors
    /// As of [`identify_long`]; or the log is no longer than its head.
    pub fn plan(
        &self,
        elsewhere: Option<(usize, f64)>,
        observer: &mut dyn Observer,
    ) -> Result<LongPlan, Error> {
        let mut watched = Watched::new(observer);
        let model = self.model()?;
        let (survey, logs) = match elsewhere {
            Some((rows, end)) => (self.survey_of_head(&model, rows, end)?, self.logs.clone()),
            None => (self.survey(&model)?, self.head_logs(&model)?),
        };
        let head = Head::new(self.file, &logs, self.options, &model, &mut watched)?;
        self.planned(&head, survey)
    }

    /// The rows of one stretch, which is the log, added to those of its piece before it.
    ///
    /// # Errors
    /// As of [`identify_long`], or the plan is of another robot, other options, or has no such
    /// stretch.
    pub fn condense(
        &self,
        plan: &LongPlan,
        stretch: usize,
        before: Option<PieceRows>,
        observer: &mut dyn Observer,
    ) -> Result<PieceRows, Error> {
        let mut watched = Watched::new(observer);
        let model = self.model()?;
        plan.check(&model, self.options, self.logs)?;
        let mut piece = plan.piece_of(stretch, before).map_err(|why| self.wrong(why))?;
        let condenser = Condenser::new(self, &model, plan, &mut watched)?;
        condenser.add(&mut piece, stretch, &self.logs.train[0], &mut watched)?;
        Ok(piece)
    }

    /// The rows of pieces, read from the log's file.
    ///
    /// # Errors
    /// As of [`LongLog::condense`].
    pub fn condense_pieces(
        &self,
        plan: &LongPlan,
        pieces: std::ops::Range<usize>,
        observer: &mut dyn Observer,
    ) -> Result<Vec<PieceRows>, Error> {
        let mut watched = Watched::new(observer);
        let model = self.model()?;
        plan.check(&model, self.options, self.logs)?;
        if pieces.is_empty() || pieces.end > plan.pieces() {
            return Err(self.wrong(format!("there are pieces 0 to {}", plan.pieces() - 1)));
        }
        let mut all = Vec::new();
        self.each_piece(&model, plan, pieces, &mut watched, |piece| all.push(piece))?;
        Ok(all)
    }

    /// The answer of all pieces, in their order. The log is the head alone where it is in memory.
    ///
    /// # Errors
    /// As of [`LongLog::condense`], or a piece is not there.
    pub fn identified(
        &self,
        plan: &LongPlan,
        pieces: impl IntoIterator<Item = Result<PieceRows, Error>>,
        observer: &mut dyn Observer,
    ) -> Result<Identified, Error> {
        let mut watched = Watched::new(observer);
        let model = self.model()?;
        plan.check(&model, self.options, self.logs)?;
        let logs = match self.logs.train[0] {
            LogSource::File(_) => self.head_logs(&model)?,
            LogSource::Memory { .. } => self.logs.clone(),
        };
        let head = Head::new(self.file, &logs, self.options, &model, &mut watched)?;
        let LongPlan { rows, start_s, step_s, .. } = *plan;
        if LongPlan::new(&head, Survey { rows, start_s, step_s }) != *plan {
            let why = "the plan is of another head, or of other options";
            return Err(self.wrong(why));
        }
        let of_head = Held::read(&logs, &self.robot(&model))?;
        let (mut whole, mut next, mut before) = (Whole::default(), 0, None);
        for piece in pieces {
            let piece = piece?;
            if let Some(why) = plan.wrong_piece(&piece, next) {
                return Err(self.wrong(why));
            }
            let seam = plan.seam(piece.stretches.start);
            let in_head = seam.filter(|rows| rows.end <= self.head_rows);
            let in_head = in_head.map(|rows| of_head.name_of(rows));
            let is_of = |name: &Option<String>| name.is_none() || *name == piece.seams[0];
            if !is_of(&in_head) || next > 0 && before != piece.seams[0] {
                let other = if is_of(&in_head) { "the piece before it" } else { "the head" };
                let why = format!(
                    "piece {next} was condensed from another log than {other}\n  hint: condense \
                     it again, from this log"
                );
                return Err(self.wrong(why));
            }
            next += 1;
            before.clone_from(&piece.seams[1]);
            whole.add(piece);
        }
        if next != plan.pieces() {
            return Err(self.wrong(format!("piece {next} of {} is not there", plan.pieces())));
        }
        self.answered(head, whole, &mut watched)
    }

    /// Rows of pieces that were written as lines of JSON, one after the other.
    ///
    /// # Errors
    /// The file cannot be read, or has rows that are none of this robot.
    pub fn pieces_of_file(
        &self,
        files: &Files,
        path: &Path,
    ) -> Result<impl Iterator<Item = Result<PieceRows, Error>> + use<>, Error> {
        let model = self.model()?;
        let file = files.open(path).map_err(|error| Error::read(path, error))?;
        let path = path.to_owned();
        let lines = BufReader::new(file).lines().enumerate();
        Ok(lines.map(move |(at, line)| {
            let line = line.map_err(|error| Error::read(&path, error))?;
            let failed = |why| Cause::Long(format!("{}:{}", path.display(), at + 1), why);
            Ok(PieceRows::of_json(&model, &line).map_err(failed)?)
        }))
    }

    fn name(&self) -> String {
        self.logs.train.first().map_or_else(String::new, LogSource::to_string)
    }

    fn wrong(&self, why: impl Into<String>) -> Error {
        Cause::Long(self.name(), why.into()).into()
    }

    /// Base parameters and their columns, if the robot and the options suit a long log.
    fn model(&self) -> Result<RegressionModel, Error> {
        let Self { options, logs, .. } = self;
        let refused = if logs.train.len() != 1 {
            Some("one log is read piece by piece, and not several".to_owned())
        } else if is_stream(&logs.train[0]) {
            Some("a log that is read piece by piece is a file, which is read several times".into())
        } else if !is_of_triangles(options.method) {
            Some("least squares alone, weighted or not, forget the rows of a log".to_owned())
        } else if options.conditions.averaging != Averaging::No {
            Some("laps are averaged of logs that are held as a whole".to_owned())
        } else if options.controller.is_some() || !options.instruments.is_empty() {
            Some("a controller, or instruments, need a log that is held as a whole".to_owned())
        } else {
            let laws = &self.file.apart.laws;
            laws.first().map(|law| {
                format!(
                    "`{}` is beside the equations of the model and remembers what was before: it \
                     is not taken out of a log piece by piece\n  hint: leave it out of the model",
                    law.title
                )
            })
        };
        match refused {
            Some(why) => Err(self.wrong(why)),
            None => regression(&self.file.apart.robot, options),
        }
    }

    /// Calls `take` with the rows of each piece, which are read from the log's file.
    fn each_piece(
        &self,
        model: &RegressionModel,
        plan: &LongPlan,
        pieces: std::ops::Range<usize>,
        watched: &mut Watched<'_>,
        mut take: impl FnMut(PieceRows),
    ) -> Result<(), Error> {
        let condenser = Condenser::new(self, model, plan, watched)?;
        let mut window = Window::open(self.logs, &self.robot(model))?;
        let count = pieces.len() as f64;
        for (done, number) in pieces.enumerate() {
            let stretches = plan.stretches_of(number);
            let mut piece = plan.piece(number, stretches.clone());
            for stretch in stretches {
                let share = done as f64 / count;
                if !watched.share(Stage::Condensing, share) {
                    return Err(Cause::Stopped.into());
                }
                let rows = condenser.read(stretch);
                let name = format!("{} from row {} on", self.name(), rows.start + 1);
                let log = Arc::new(window.rows(rows)?);
                let source = LogSource::Memory { name, log };
                condenser.add(&mut piece, stretch, &source, watched)?;
            }
            take(piece);
        }
        Ok(())
    }

    /// The logs with the head of the long one in memory.
    fn head_logs(&self, model: &RegressionModel) -> Result<Logs, Error> {
        let mut window = Window::open(self.logs, &self.robot(model))?;
        let log = Arc::new(window.rows(0..self.head_rows)?);
        let name = format!("{}, its first {} rows", self.name(), self.head_rows);
        let head = LogSource::Memory { name, log };
        Ok(Logs { train: vec![head], ..self.logs.clone() })
    }

    /// The answer of a head and the rows of the whole.
    fn answered(
        &self,
        head: Head<'_>,
        whole: Whole,
        watched: &mut Watched<'_>,
    ) -> Result<Identified, Error> {
        let rows = whole.rows.ok_or_else(|| self.wrong("no joint moves".to_owned()))?;
        let Head { estimation, read, how, found, mut same, .. } = head;
        for (file, other) in whole.same {
            if same.iter().all(|(told, _)| *told != file) {
                same.push((file, LogRemark::SameAs { other }));
            }
        }
        let Estimation { work, .. } = estimation;
        let failed = |error| Cause::Identify(work.model.model.clone(), error);
        let found = found.of_long(estimation.request(&read, &how), &rows).map_err(failed)?;
        let updated = estimation.updated(&found);
        Head { estimation, read, how, found, updated, same }.answered(self.file, watched)
    }

    /// What the head says, with where the log is cut.
    fn planned(&self, head: &Head<'_>, survey: Survey) -> Result<LongPlan, Error> {
        if survey.rows <= self.head_rows {
            let why = format!(
                "{} rows are no more than those of its head, {}\n  hint: it needs no pieces; or \
                 choose a head of fewer rows",
                survey.rows, self.head_rows
            );
            return Err(self.wrong(why));
        }
        let plan = LongPlan::new(head, survey);
        plan.cut().map_err(|why| self.wrong(why))?;
        Ok(plan)
    }
}
