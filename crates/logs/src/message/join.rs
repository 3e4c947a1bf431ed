//! Topics on one clock: the rows are the messages of one topic, the others are interpolated.

use super::streams::Stream;
use crate::fault::FileFault;
use crate::remark::FileRemark;
use crate::table::{Places, Table};

/// Times from which on a clock counts from long ago, not from the start of a run: 10^6 s \[ns\].
/// Such times are told from the first row on, since seconds since 1970 in f64 have steps of 0.2 us.
const EPOCH_NS: i64 = 1_000_000_000_000_000;

/// Fewer rows in common make no log.
const FEWEST_ROWS: usize = 4;

/// The longest pause of a topic that is interpolated, over the distance of its messages.
const LONGEST_PAUSE: f64 = 6.0;

/// Less is no loss at the ends of a log \[s\].
const NO_LOSS_S: f64 = 1e-3;

/// A topic in the order of its times.
struct Ordered<'a> {
    stream: &'a Stream,
    times_ns: &'a [i64],
    /// Rows by time, without repeated ones.
    rows: Vec<usize>,
}

/// The columns of streams, each by stream and place in it, none for the time. `clocks` are streams
/// that may give the rows: the one with the most messages does.
pub(super) fn joined(
    all: &[Stream],
    wanted: &[Option<(usize, usize)>],
    clocks: &[usize],
) -> Result<Table, Vec<FileFault>> {
    let mut used: Vec<usize> = wanted.iter().flatten().map(|(stream, _)| *stream).collect();
    used.sort_unstable();
    used.dedup();
    let candidates = if clocks.is_empty() { &used[..] } else { clocks };
    let Some(clock) = longest(all, candidates) else { return Ok(Table::default()) };
    let mut remarks = Vec::new();
    // a run may begin at 0
    let lacks = |stream: &&usize| all[**stream].stamps_ns.iter().all(|stamp| *stamp == 0);
    let unstamped: Vec<String> =
        used.iter().filter(lacks).map(|stream| all[*stream].topic.clone()).collect();
    let times = |stream: usize| match unstamped.is_empty() {
        true => &all[stream].stamps_ns[..],
        false => &all[stream].recorded_ns[..],
    };
    let own = times(clock);
    let others: Vec<usize> = used.into_iter().filter(|stream| *stream != clock).collect();
    let (mut ordered, mut faults) = (Vec::new(), Vec::new());
    for &other in &others {
        let (rows, repeated) = in_order(&all[other], times(other));
        faults.extend(repeated);
        ordered.push(Ordered { stream: &all[other], times_ns: times(other), rows });
    }
    let rows = in_common(own, &ordered);
    if rows.len() < FEWEST_ROWS.min(own.len()) {
        let topics = ordered.iter().map(|one| one.stream.topic.clone());
        let topics = [all[clock].topic.clone()].into_iter().chain(topics).collect();
        faults.push(FileFault::Apart { topics, rows: rows.len() });
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    if !unstamped.is_empty() {
        remarks.push(FileRemark::RecordingTimes { topics: unstamped });
    }
    remarks.extend(outside(&all[clock], own, &rows));
    let weights: Vec<_> = ordered.iter().map(|other| Weights::new(other, own, &rows)).collect();
    for (other, weights) in ordered.iter().zip(&weights) {
        match pause(other, own, &rows) {
            Some(fault) => faults.push(fault),
            None if weights.is_exact() => {}
            None => remarks.push(FileRemark::Joined {
                topic: other.stream.topic.clone(),
                rate_hz: rate_hz(&other.rows, other.times_ns),
                clock: all[clock].topic.clone(),
                clock_hz: rate_hz(&rows, own),
            }),
        }
    }
    if !faults.is_empty() {
        return Err(faults);
    }
    let column = |place: &Option<(usize, usize)>| match *place {
        None => seconds(own, &rows),
        Some((stream, column)) if stream == clock => {
            rows.iter().map(|row| all[clock].value(column, *row)).collect()
        }
        Some((stream, column)) => {
            let at = others.iter().position(|other| *other == stream);
            at.map_or(Vec::new(), |at| weights[at].apply(&ordered[at], column))
        }
    };
    let columns = wanted.iter().map(column).collect();
    let messages = rows.iter().map(|row| all[clock].messages[*row]).collect();
    Ok(Table { columns, remarks, places: Places::Messages(messages) })
}

/// The first of the streams with the most messages.
fn longest(all: &[Stream], candidates: &[usize]) -> Option<usize> {
    let length = |stream: usize| all[stream].messages.len();
    let most = candidates.iter().map(|stream| length(*stream)).max()?;
    candidates.iter().copied().find(|stream| length(*stream) == most)
}

/// Times of rows \[s\].
fn seconds(times_ns: &[i64], rows: &[usize]) -> Vec<f64> {
    let first = rows.first().map_or(0, |row| times_ns[*row]);
    let start = if first.abs() >= EPOCH_NS { first } else { 0 };
    rows.iter().map(|row| times_ns[*row].saturating_sub(start) as f64 / 1e9).collect()
}

/// The rows of a stream by their times, without those that say again what the one before says.
fn in_order(stream: &Stream, times_ns: &[i64]) -> (Vec<usize>, Option<FileFault>) {
    let mut rows: Vec<usize> = (0..times_ns.len()).collect();
    rows.sort_by_key(|row| times_ns[*row]);
    let mut fault = None;
    rows.dedup_by(|next, row| {
        let is_repeated = times_ns[*next] == times_ns[*row];
        let is_same = |column: usize| {
            let [a, b] = [*next, *row].map(|row| stream.value(column, row).to_bits());
            a == b
        };
        if is_repeated && fault.is_none() && !(0..stream.columns.len()).all(is_same) {
            let at = crate::table::Place::Message(stream.messages[*next]);
            fault = Some(FileFault::Repeated { topic: stream.topic.clone(), at });
        }
        is_repeated
    });
    (rows, fault)
}

/// The first and last time of a topic.
fn span(one: &Ordered<'_>) -> Option<[i64; 2]> {
    Some([one.times_ns[*one.rows.first()?], one.times_ns[*one.rows.last()?]])
}

/// The rows of the clock in which all others have values.
fn in_common(own: &[i64], others: &[Ordered<'_>]) -> Vec<usize> {
    let mut window = [i64::MIN, i64::MAX];
    for other in others {
        let [from, to] = span(other).unwrap_or([i64::MAX, i64::MIN]);
        window = [window[0].max(from), window[1].min(to)];
    }
    (0..own.len()).filter(|row| (window[0]..=window[1]).contains(&own[*row])).collect()
}

/// What of the clock's topic the others do not have.
fn outside(stream: &Stream, own: &[i64], rows: &[usize]) -> Option<FileRemark> {
    let [all, kept] = [(0, own.len().checked_sub(1)?), (*rows.first()?, *rows.last()?)]
        .map(|(first, last)| own[last].saturating_sub(own[first]) as f64 / 1e9);
    let left_out_s = all - kept;
    let clock = stream.topic.clone();
    (left_out_s > NO_LOSS_S).then_some(FileRemark::OutsideOfOthers { clock, left_out_s })
}

/// Steps of the times of rows \[ns\].
fn steps<'a>(rows: &'a [usize], times_ns: &'a [i64]) -> impl Iterator<Item = i64> + 'a {
    rows.windows(2).map(|pair| times_ns[pair[1]].saturating_sub(times_ns[pair[0]]))
}

fn median_step_ns(rows: &[usize], times_ns: &[i64]) -> i64 {
    let mut steps: Vec<i64> = steps(rows, times_ns).collect();
    let middle = steps.len() / 2;
    match steps.is_empty() {
        true => 0,
        false => *steps.select_nth_unstable(middle).1,
    }
}

fn rate_hz(rows: &[usize], times_ns: &[i64]) -> f64 {
    1e9 / median_step_ns(rows, times_ns).max(1) as f64
}

/// The longest pause of a topic while the clock goes on, if it is too long.
fn pause(other: &Ordered<'_>, own: &[i64], rows: &[usize]) -> Option<FileFault> {
    let (first, last) = (own[*rows.first()?], own[*rows.last()?]);
    let usual = median_step_ns(&other.rows, other.times_ns);
    let within = other
        .rows
        .windows(2)
        .filter(|pair| other.times_ns[pair[1]] > first && other.times_ns[pair[0]] < last);
    let length = |pair: &[usize]| other.times_ns[pair[1]].saturating_sub(other.times_ns[pair[0]]);
    let longest = within.max_by_key(|pair| length(pair))?;
    let longest_ns = length(longest) as f64;
    (longest_ns > LONGEST_PAUSE * usual.max(1) as f64).then(|| FileFault::Pause {
        topic: other.stream.topic.clone(),
        longest_s: longest_ns / 1e9,
        at: crate::table::Place::Message(other.stream.messages[longest[1]]),
    })
}

/// How the values of a topic at the clock's times follow from its own: of each row the first of
/// four neighbours and their weights (the cubic through them).
struct Weights {
    rows: Vec<(usize, [f64; 4])>,
}

impl Weights {
    fn new(other: &Ordered<'_>, own: &[i64], rows: &[usize]) -> Self {
        let times = |at: usize| other.times_ns[other.rows[at]];
        let count = other.rows.len();
        let of = |row: &usize| {
            let at = own[*row];
            let after = other.rows.partition_point(|row| other.times_ns[*row] < at);
            let first = after.saturating_sub(2).min(count.saturating_sub(4));
            let points = count.min(4);
            let mut weights = [0.0; 4];
            for i in 0..points {
                let others = (0..points).filter(|&j| j != i);
                let part = |j: usize| {
                    let above = at.saturating_sub(times(first + j)) as f64;
                    above / times(first + i).saturating_sub(times(first + j)) as f64
                };
                weights[i] = others.map(part).product();
            }
            (first, weights)
        };
        Self { rows: rows.iter().map(of).collect() }
    }

    /// Whether every row is that of a message.
    fn is_exact(&self) -> bool {
        self.rows.iter().all(|(_, weights)| weights.contains(&1.0) && is_one(weights))
    }

    fn apply(&self, other: &Ordered<'_>, column: usize) -> Vec<f64> {
        let of = |(first, weights): &(usize, [f64; 4])| {
            let used = weights.iter().enumerate().filter(|(_, weight)| **weight != 0.0);
            used.map(|(at, weight)| weight * other.stream.value(column, other.rows[first + at]))
                .sum()
        };
        self.rows.iter().map(of).collect()
    }
}

/// Whether all weights but one are nothing.
fn is_one(weights: &[f64; 4]) -> bool {
    weights.iter().filter(|weight| **weight != 0.0).count() == 1
}
