//! Signals that go up and down faster than a picture shows: what is between their least and their
//! greatest values.

use std::ops::Range;

/// Rows of a span, at least: fewer do not tell chatter from a corner.
const LEAST_ROWS: usize = 8;
/// The share of its whole range that a signal goes, at least, before it turns round.
const SWING: f64 = 0.02;
/// How often a signal turns round within a span that it chatters in.
const TURNS: usize = 4;
/// The share of spans from which a signal is one that chatters.
const SPANS: f64 = 0.05;

/// Some rows of a signal, with what it is between there.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    /// The rows.
    pub rows: Range<usize>,
    /// Its least and its greatest value; no numbers where there are none.
    pub ends: [f64; 2],
}

/// A signal that chatters, by at most so many spans; none of one that does not.
pub fn envelope(signal: &[f64], spans: usize) -> Option<Vec<Span>> {
    let rows = signal.len();
    let length = rows.div_ceil(spans.max(1)).max(LEAST_ROWS);
    let [low, high] = ends(signal);
    let swing = SWING * (high - low);
    // also where nothing is a number
    if !(swing > 0.0 && swing.is_finite()) {
        return None;
    }
    let of = |first: usize| {
        let rows = first..(first + length).min(rows);
        Span { ends: ends(&signal[rows.clone()]), rows }
    };
    let all: Vec<Span> = (0..rows).step_by(length).map(of).collect();
    let chatters = |span: &&Span| turns(&signal[span.rows.clone()], swing) >= TURNS;
    let count = all.iter().filter(chatters).count();
    (count as f64 >= SPANS * all.len() as f64 && count > 1).then_some(all)
}

/// The least and the greatest number.
fn ends(signal: &[f64]) -> [f64; 2] {
    let mut ends = [f64::NAN; 2];
    for &value in signal.iter().filter(|value| value.is_finite()) {
        ends = [ends[0].min(value), ends[1].max(value)];
    }
    ends
}

/// How often a signal turns round after it has gone so far.
fn turns(signal: &[f64], swing: f64) -> usize {
    let mut numbers = signal.iter().copied().filter(|value| value.is_finite());
    let Some(first) = numbers.next() else { return 0 };
    let (mut low, mut high, mut way, mut count) = (first, first, 0_i8, 0);
    for value in numbers {
        // the way back counts from the farthest place since the last turn
        (low, high) = (f64::min(low, value), f64::max(high, value));
        if value - low >= swing && way <= 0 {
            count += usize::from(way < 0);
            (way, high) = (1, value);
        } else if high - value >= swing && way >= 0 {
            count += usize::from(way > 0);
            (way, low) = (-1, value);
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    fn wave(rows: usize, period: f64, size: f64) -> impl Iterator<Item = f64> {
        (0..rows).map(move |row| size * (std::f64::consts::TAU * row as f64 / period).sin())
    }

    #[test]
    fn what_is_slow_or_small_does_not_chatter() {
        let slow: Vec<f64> = wave(6000, 1500.0, 1.0).collect();
        assert!(envelope(&slow, 600).is_none());
        // a hundredth of the range is as thick as a line
        let small: Vec<f64> = slow.iter().zip(wave(6000, 4.0, 0.005)).map(|(a, b)| a + b).collect();
        assert!(envelope(&small, 600).is_none());
        assert!(envelope(&[1.0; 6000], 600).is_none());
        assert!(envelope(&[f64::NAN; 6000], 600).is_none());
        assert!(envelope(&[], 600).is_none());
    }

    #[test]
    fn what_is_fast_and_large_is_between_its_ends() {
        let slow = wave(6000, 1500.0, 1.0);
        let sum: Vec<f64> = slow.zip(wave(6000, 4.0, 0.2)).map(|(a, b)| a + b).collect();
        let spans = envelope(&sum, 600).expect("it chatters");
        assert_eq!(spans.len(), 600);
        assert_eq!(spans.last().expect("some").rows.end, 6000);
        for Span { rows, ends: [low, high] } in &spans {
            assert!(sum[rows.clone()].iter().all(|value| (low..=high).contains(&value)));
            assert!(high - low > 0.35, "{rows:?}: {low} to {high}");
        }
    }

    #[test]
    fn a_short_stretch_of_chatter_is_enough() {
        let mut signal: Vec<f64> = wave(6000, 1500.0, 1.0).collect();
        let fast: Vec<f64> = wave(600, 4.0, 0.3).collect();
        signal[1000..1600].iter_mut().zip(fast).for_each(|(at, off)| *at += off);
        signal[300] = f64::NAN;
        assert!(envelope(&signal, 600).is_some());
    }
}
