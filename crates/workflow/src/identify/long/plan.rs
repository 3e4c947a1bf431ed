//! What the head of a long log says of the rest, and rows of its pieces, as JSON: so pieces are
//! condensed where their rows are.

use super::super::clock::Clock;
use super::super::{Head, IdentifyOptions};
use super::reading::Survey;
use crate::error::{Cause, Error};
use crate::logs::{LogSource, Logs};
use denavit_identify::estimate::long::{LongRows, RowRule, pieces};
use denavit_measure::JointIndex;
use denavit_measure::condition::{Conditioned, Conditioning, Filter, Stretches};
use denavit_plants::regression::RegressionModel;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::ops::Range;

const PLAN: &str = "denavit-long-plan/1";
const ROWS: &str = "denavit-long-rows/2";

/// Rows at the beginning of a log that its first piece is known by.
const FIRST_ROWS: usize = 256;

/// Samples of which one is left, at most.
const MOST_DECIMATED: usize = 100_000;

/// How the pieces of a long log are condensed.
#[derive(Clone, Debug, PartialEq)]
pub struct LongPlan {
    /// Rows of the log.
    pub rows: usize,
    /// The time of the first row \[s\].
    pub start_s: f64,
    /// The distance of rows \[s\].
    pub step_s: f64,
    pub(super) how: Conditioning,
    pub(super) rule: RowRule,
    pub(super) position_noise: Vec<f64>,
    /// Which rows these are of: the parameters that are found, and what their columns depend on.
    identifies: String,
    /// Names the head by its signals.
    head: String,
    stretches: usize,
}

/// The rows of a piece of a long log.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceRows {
    /// Its number, from 0.
    pub piece: usize,
    /// The stretches that are in it.
    pub stretches: Range<usize>,
    /// Names the plan that they were condensed by.
    plan: String,
    pub(super) rows: Option<LongRows>,
    /// Logs for validation, each with a stretch that says the same.
    pub(super) same: Vec<(String, String)>,
    /// Names rows of the log at its seams: with what is before it, and with what follows, which
    /// read them, too. None at the end of the log.
    pub(super) seams: [Option<String>; 2],
}

/// A plan as its file has it.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PlanFile {
    format: String,
    identifies: String,
    head: String,
    rows: usize,
    start_s: f64,
    step_s: f64,
    filter: Option<FilterFile>,
    decimation: usize,
    widened: Vec<WidenedFile>,
    position_noise: Vec<f64>,
    stretches: usize,
    pieces: usize,
    /// For each stretch its first row, and the one behind its last; for each piece the same of
    /// stretches. For those who read the rows.
    rows_of_stretches: Vec<[usize; 2]>,
    stretches_of_pieces: Vec<[usize; 2]>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FilterFile {
    order: usize,
    cutoff_hz: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct WidenedFile {
    joint: usize,
    times: f64,
}

/// Names bytes. FNV-1a: it tells apart what is mixed up, and keeps nobody out.
pub(super) fn name_of(bytes: impl Iterator<Item = u8>) -> String {
    let hash = bytes.fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
    });
    format!("{hash:016x}")
}

/// Names a log by its positions and torques.
fn name_of_log(log: &Conditioned) -> String {
    let torques = log.torque.iter().flatten();
    let numbers = log.q.iter().chain(torques).flatten();
    name_of(numbers.flat_map(|number| number.to_bits().to_le_bytes()))
}

/// What rows depend on beside their log.
fn identifies(model: &RegressionModel, options: &IdentifyOptions, logs: &Logs) -> String {
    let judges: Vec<String> = logs.held_out.iter().map(LogSource::to_string).collect();
    let names: Vec<&str> = model.listed.iter().map(|one| one.name.as_str()).collect();
    let IdentifyOptions { slow, conditions, resolution, .. } = options;
    format!(
        "{} of {}; {:?}, {slow:?}, {:?}, {resolution:?}; judged by {judges:?}",
        names.join(", "),
        model.model,
        model.law,
        conditions.derivatives
    )
}

impl LongPlan {
    pub(super) fn new(head: &Head<'_>, survey: Survey) -> Self {
        let work = head.estimation.work;
        let Survey { rows, start_s, step_s } = survey;
        let conditions = &work.options.conditions;
        let how = Conditioning {
            resolution: work.options.resolution,
            ..conditions.of(step_s, rows, head.read.halvings)
        };
        let mut plan = Self {
            rows,
            start_s,
            step_s,
            how,
            rule: head.found.estimate.row_rule(work.model, &head.read.train, &head.how),
            position_noise: head.read.position_noise.clone(),
            identifies: identifies(work.model, work.options, work.logs),
            head: head.read.train.first().map(name_of_log).unwrap_or_default(),
            stretches: 0,
        };
        plan.stretches = plan.cut().map_or(0, |cut| cut.count());
        plan
    }

    /// Where the log is cut; why not.
    pub(super) fn cut(&self) -> Result<Stretches, String> {
        let cut = Stretches::new(self.rows, self.step_s, &self.how);
        cut.ok_or_else(|| format!("{} rows are too few for the filter", self.rows))
    }

    /// How many pieces there are.
    pub fn pieces(&self) -> usize {
        pieces(self.stretches)
    }

    /// The stretches of a piece.
    pub fn stretches_of(&self, piece: usize) -> Range<usize> {
        let first = |piece: usize| piece * self.stretches / self.pieces().max(1);
        first(piece)..first(piece + 1)
    }

    /// Whether a piece is one part that errors are found from, and not its stretches.
    pub(super) fn has_long_parts(&self) -> bool {
        self.stretches > self.pieces()
    }

    /// Rows that two stretches read, this one and the one before it: pieces of one log have the
    /// same ones there. The middle of them; of the first stretch those that it begins with. None
    /// behind the last one, or where no row is read twice.
    pub(super) fn seam(&self, stretch: usize) -> Option<Range<usize>> {
        let cut = self.cut().ok().filter(|_| stretch < self.stretches)?;
        let Range { start, end } = match stretch.checked_sub(1) {
            None => return Some(0..FIRST_ROWS.min(cut.get(0).read.end)),
            Some(before) => cut.get(stretch).read.start..cut.get(before).read.end,
        };
        let quarter = end.saturating_sub(start) / 4;
        (start < end).then(|| start + quarter..end - quarter)
    }

    pub(super) fn clock(&self, accepts_suspicious: bool) -> Clock {
        Clock { start_s: self.start_s, step_s: self.step_s, accepts_suspicious }
    }

    /// The piece that a stretch is added to; why it cannot be.
    pub(super) fn piece_of(
        &self,
        stretch: usize,
        before: Option<PieceRows>,
    ) -> Result<PieceRows, String> {
        let holds = |piece: &usize| self.stretches_of(*piece).contains(&stretch);
        let piece = (0..self.pieces()).find(holds);
        let piece = piece.ok_or_else(|| format!("there is no stretch {stretch} in the plan"))?;
        let first = self.stretches_of(piece).start;
        let mut begun = before.unwrap_or_else(|| self.piece(piece, first..first));
        let is_other = begun.plan != self.key() || begun.piece != piece;
        if is_other || begun.stretches != (first..stretch) {
            return Err(format!(
                "stretch {stretch} follows stretches {first} to {stretch} of piece {piece}, and \
                 these are others"
            ));
        }
        begun.stretches.end = stretch + 1;
        Ok(begun)
    }

    /// Sees to it that a plan is of this robot and these options.
    pub(super) fn check(
        &self,
        model: &RegressionModel,
        options: &IdentifyOptions,
        logs: &Logs,
    ) -> Result<(), Error> {
        let (own, joints) = (identifies(model, options, logs), model.joints.len());
        let is_joint = |one: &(JointIndex, f64)| one.0.0 < joints;
        let why = if own != self.identifies {
            format!("the plan is for {}, and this is {own}", self.identifies)
        } else if self.position_noise.len() != joints || !self.rule.widened.iter().all(is_joint) {
            format!("the plan has other joints than the {joints} of the model")
        } else {
            return Ok(());
        };
        let name = logs.train.first().map_or_else(String::new, LogSource::to_string);
        Err(Cause::Long(name, why).into())
    }

    /// Names the plan by all that it says.
    pub(super) fn key(&self) -> String {
        name_of(self.to_json().to_string().bytes())
    }

    /// Rows of a piece that has none yet.
    pub(super) fn piece(&self, piece: usize, stretches: Range<usize>) -> PieceRows {
        let (rows, same, seams) = (None, Vec::new(), [None, None]);
        PieceRows { piece, stretches, plan: self.key(), rows, same, seams }
    }

    /// Why rows are not those that come next; none if they are.
    pub(super) fn wrong_piece(&self, piece: &PieceRows, next: usize) -> Option<String> {
        if piece.plan != self.key() {
            return Some(format!("piece {} was condensed by another plan", piece.piece));
        }
        let is_next = piece.piece == next && piece.stretches == self.stretches_of(next);
        (!is_next).then(|| format!("piece {next} is not there, or not whole"))
    }

    /// As JSON.
    pub fn to_json(&self) -> Value {
        let cut = self.cut().ok();
        let read = |number: usize| {
            let rows = cut.map_or(0..0, |cut| cut.get(number).read);
            [rows.start, rows.end]
        };
        let of_piece = |piece: usize| {
            let all = self.stretches_of(piece);
            [all.start, all.end]
        };
        json!(PlanFile {
            format: PLAN.to_owned(),
            identifies: self.identifies.clone(),
            head: self.head.clone(),
            rows: self.rows,
            start_s: self.start_s,
            step_s: self.step_s,
            filter: self
                .how
                .filter
                .map(|Filter { order, cutoff_hz }| FilterFile { order, cutoff_hz }),
            decimation: self.how.decimation,
            widened: self
                .rule
                .widened
                .iter()
                .map(|&(joint, times)| WidenedFile { joint: joint.0, times })
                .collect(),
            position_noise: self.position_noise.clone(),
            stretches: self.stretches,
            pieces: self.pieces(),
            rows_of_stretches: (0..self.stretches).map(read).collect(),
            stretches_of_pieces: (0..self.pieces()).map(of_piece).collect(),
        })
    }

    /// From JSON, for options that it was made with.
    ///
    /// # Errors
    /// It is no plan, or contradicts itself; `name` is that of its file.
    pub fn of_json(name: &str, text: &str, options: &IdentifyOptions) -> Result<Self, Error> {
        let failed = |why: String| Error::from(Cause::Long(name.to_owned(), why));
        let file: PlanFile =
            serde_json::from_str(text).map_err(|error| failed(format!("no plan: {error}")))?;
        if file.format != PLAN {
            return Err(failed(format!("is `{}`, and no `{PLAN}`", file.format)));
        }
        let is_number = |one: &f64| one.is_finite() && *one >= 0.0;
        let is_sound = file.start_s.is_finite()
            && file.step_s.is_finite()
            && file.step_s > 0.0
            && (1..=MOST_DECIMATED).contains(&file.decimation)
            && file.widened.iter().all(|one| one.times.is_finite() && one.times > 0.0)
            && file.position_noise.iter().all(is_number)
            && file.widened.iter().all(|one| one.joint < file.position_noise.len());
        let filter = file.filter.map(|FilterFile { order, cutoff_hz }| Filter { order, cutoff_hz });
        let plan = Self {
            rows: file.rows,
            start_s: file.start_s,
            step_s: file.step_s,
            how: Conditioning {
                filter,
                derivatives: options.conditions.derivatives,
                decimation: file.decimation,
                resolution: options.resolution,
                ..Conditioning::default()
            },
            rule: RowRule {
                widened: file
                    .widened
                    .iter()
                    .map(|one| (JointIndex(one.joint), one.times))
                    .collect(),
            },
            position_noise: file.position_noise,
            identifies: file.identifies,
            head: file.head,
            stretches: file.stretches,
        };
        if !is_sound {
            return Err(failed("has numbers that no plan has".to_owned()));
        }
        // lists of the plan are as long as the file's, or it has none
        let stretches = plan.cut().map_err(failed)?.count();
        let has_lists = plan.stretches == stretches
            && file.rows_of_stretches.len() == stretches
            && file.stretches_of_pieces.len() == plan.pieces();
        // what follows from the rest stands there for others
        let is_given =
            || serde_json::from_str::<Value>(text).is_ok_and(|given| given == plan.to_json());
        match has_lists && is_given() {
            true => Ok(plan),
            false => Err(failed("contradicts itself".to_owned())),
        }
    }
}

impl PieceRows {
    /// As JSON, with a name of all that it says.
    pub fn to_json(&self) -> Value {
        let mut said = self.said();
        said["name"] = name_of(said.to_string().bytes()).into();
        said
    }

    fn said(&self) -> Value {
        json!({
            "format": ROWS,
            "plan": self.plan,
            "piece": self.piece,
            "stretches": [self.stretches.start, self.stretches.end],
            "rows": self.rows.as_ref().map(LongRows::to_json),
            "same": self.same,
            "seams": self.seams,
        })
    }

    /// From JSON, of a model; why it is none.
    pub(super) fn of_json(model: &RegressionModel, text: &str) -> Result<Self, String> {
        let value: Value =
            serde_json::from_str(text).map_err(|error| format!("no rows of a piece: {error}"))?;
        if value["format"] != ROWS {
            return Err(format!("is no `{ROWS}`"));
        }
        let count = |value: &Value| value.as_u64().and_then(|one| usize::try_from(one).ok());
        let ends = [0, 1].map(|at| count(&value["stretches"][at]));
        let (Some(piece), [Some(first), Some(end)]) = (count(&value["piece"]), ends) else {
            return Err("does not say which piece it is".to_owned());
        };
        let rows = match &value["rows"] {
            Value::Null => None,
            rows => Some(LongRows::of_json(model, rows).map_err(|error| error.to_string())?),
        };
        let plan = value["plan"].as_str().unwrap_or_default().to_owned();
        let same = serde_json::from_value(value["same"].clone());
        let same = same.map_err(|error| format!("`same`: {error}"))?;
        let seams = serde_json::from_value(value["seams"].clone());
        let seams = seams.map_err(|error| format!("`seams`: {error}"))?;
        let read = Self { piece, stretches: first..end, plan, rows, same, seams };
        match value["name"] == name_of(read.said().to_string().bytes()) {
            true => Ok(read),
            false => Err("has other numbers than were written: it was changed, or is corrupt\n  \
                          hint: condense the piece again"
                .to_owned()),
        }
    }
}
