//! The largest lattice that values lie on, although printing rounds them.
//!
//! Changes of a position that an encoder of step s gives are n s + e, with whole n and the error e
//! of two roundings to a printed digit u: the mean of cos(2 pi f d) is sinc(u f)^2 at f = 1/s, and
//! near 0 at frequencies that are none of the lattice's, as soon as changes are of several sizes.
//! The lowest such frequency is looked for in small changes, or changes of changes, and made exact
//! in larger and larger ones. The values themselves decide: of N that lie on the lattice
//! |mean exp(2 pi i x / s)| is sinc(u/s), of others N times its square is exponential with mean 1.
//! Values that are printed to whole u repeat at f + 1/u, so that no step below 2 u can be told
//! (Nyquist).

use std::f64::consts::{PI, TAU};

/// The odds, as a logarithm, against a lattice by chance: less than one channel in ten thousand.
const SURE: f64 = 9.21;

/// Changes of a value that are needed at least: N R^2 <= N must exceed [`SURE`].
pub(super) const FEWEST_CHANGES: usize = 10;

/// The share of values that must lie on a lattice: slips and spikes need not.
const ON_LATTICE: f64 = 0.95;

/// Changes that are looked at, and small ones in the first search; speed alone.
const CHANGES: usize = 20_000;
const SMALL: usize = 64;
const SEARCHED: usize = 256;
const FREQUENCIES: usize = 4096;

/// Frequencies in a period of the fastest wave: neighbours are 1/16 of it off at most.
const FINE: f64 = 8.0;

/// Steps that the smallest change may be, and the largest over that in the first search.
const MOST_OF_LEAST: f64 = 5.0;
const FIRST: f64 = 32.0;

/// By how much changes grow from one refinement to the next; a phase that is known within u/s of
/// a quarter turn stays below half a turn.
const GROWTH: f64 = 2.0;

/// The step of the lattice that values lie on, which were printed to a distance `printed`.
pub(super) fn step(values: &[f64], printed: f64) -> Option<f64> {
    let all: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    let size = all.iter().fold(0.0, |size: f64, value| size.max(value.abs()));
    // sums in double precision are off by some of its last digits
    let rounding = printed.max(16.0 * f64::EPSILON * size);
    let mut levels = Vec::with_capacity(all.len().min(CHANGES + 1));
    for value in all {
        let is_new = levels.last().is_none_or(|last: &f64| (value - last).abs() > 0.5 * rounding);
        if is_new {
            levels.push(value);
        }
        if levels.len() > CHANGES {
            break;
        }
    }
    if levels.len() <= FEWEST_CHANGES {
        return None;
    }
    let signed: Vec<f64> = levels.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let changes = sorted(differences(&levels, 1), rounding);
    // of what is fast all the time, changes of changes alone are small
    let of_changes = sorted(differences(&signed, 1), rounding);
    let accepted = |sets: &[&[f64]]| {
        let (tried, guesses) = guesses(sets[0], rounding);
        guesses.iter().find_map(|guess| {
            let step = refined(&levels, sets, (*guess, printed))?;
            let expected = sinc(printed / step);
            let [share, _] = phase(&levels, step);
            let odds = share * share * levels.len() as f64 - (tried as f64).ln();
            let is_lattice = share > ON_LATTICE * expected && odds > SURE;
            (step > 2.0 * rounding && is_lattice).then_some(step)
        })
    };
    accepted(&[&changes]).or_else(|| accepted(&[&of_changes, &changes]))
}

/// Sizes in order, without those that rounding makes.
fn sorted(mut sizes: Vec<f64>, rounding: f64) -> Vec<f64> {
    sizes.retain(|size| *size > 0.5 * rounding);
    sizes.sort_by(f64::total_cmp);
    sizes
}

/// How far values are from those so many samples later.
fn differences(levels: &[f64], lag: usize) -> Vec<f64> {
    levels.iter().zip(levels.iter().skip(lag)).map(|(one, other)| (other - one).abs()).collect()
}

/// sin(pi x) / (pi x): what is left of a wave in the mean over x of its length.
fn sinc(x: f64) -> f64 {
    if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) }
}

/// Steps that small changes may be multiples of, largest first, and how many were tried.
fn guesses(changes: &[f64], rounding: f64) -> (usize, Vec<f64>) {
    let Some(&least) = changes.first() else { return (0, Vec::new()) };
    let beyond = (FIRST * least).max(changes[SMALL.min(changes.len() - 1)]);
    let small = &changes[..changes.partition_point(|change| *change <= beyond)];
    let every = small.len().div_ceil(SEARCHED);
    let searched: Vec<f64> = small.iter().rev().step_by(every).copied().collect();
    let spacing = 1.0 / (FINE * searched[0]);
    let highest = (0.5 / rounding).min(MOST_OF_LEAST * (1.0 + 1.0 / FINE) / least);
    let count = ((highest / spacing) as usize).min(FREQUENCIES);
    let (mut found, mut left_zero, mut best) = (Vec::new(), false, (0.0, 0.0));
    for at in 1..=count {
        let frequency = spacing * at as f64;
        let waves = searched.iter().map(|change| (TAU * frequency * change).cos()).sum::<f64>();
        let share = waves / searched.len() as f64;
        // the wave of a change is 1 at frequency 0, which is no lattice
        left_zero |= share < 0.0;
        if left_zero && share > 0.5 * sinc(rounding * frequency).powi(2) {
            if share > best.1 {
                best = (frequency, share);
            }
        } else if best.1 > 0.0 {
            found.push(1.0 / best.0);
            best = (0.0, 0.0);
        }
    }
    found.extend((best.1 > 0.0).then(|| 1.0 / best.0));
    (count, found)
}

/// A step by larger and larger changes, then by those over more and more samples, by least squares;
/// last by the values themselves, to within a turn of their phase. None if nothing is left.
fn refined(levels: &[f64], sets: &[&[f64]], (guess, printed): (f64, f64)) -> Option<f64> {
    let mut step = guess;
    for changes in sets {
        let mut beyond = FIRST * guess;
        let mut small = 0;
        while small < changes.len() {
            small = changes.partition_point(|change| *change <= beyond);
            if small > 0 {
                step = by_multiples(&changes[..small], step, printed)?;
            }
            beyond *= GROWTH;
        }
    }
    let mut lag = 2;
    while lag < levels.len() {
        step = by_multiples(&differences(levels, lag), step, printed)?;
        lag *= 2;
    }
    let [_, offset] = phase(levels, step);
    let zero = levels[0] + offset;
    let of_values: Vec<f64> = levels.iter().map(|value| value - zero).collect();
    by_multiples(&of_values, step, printed)
}

/// The step that least squares give, changes being the multiples that they are nearest to; none if
/// they are nearer to none than half of what the error of printing leaves.
fn by_multiples(changes: &[f64], step: f64, printed: f64) -> Option<f64> {
    let (mut products, mut squares, mut waves) = (0.0, 0.0, 0.0);
    for change in changes {
        let times = (change / step).round();
        products += times * change;
        squares += times * times;
        waves += (TAU * (change / step - times)).cos();
    }
    let found = products / squares;
    let is_near = waves > 0.5 * sinc(printed / step).powi(2) * changes.len() as f64;
    (is_near && found.is_finite() && found > 0.0).then_some(found)
}

/// The size of the mean of exp(2 pi i (x - x0) / step), and its phase as a length.
fn phase(levels: &[f64], step: f64) -> [f64; 2] {
    let (mut real, mut imaginary) = (0.0, 0.0);
    for value in levels {
        let (sin, cos) = (TAU * (value - levels[0]) / step).sin_cos();
        real += cos;
        imaginary += sin;
    }
    let count = levels.len() as f64;
    [real.hypot(imaginary) / count, step * imaginary.atan2(real) / TAU]
}
