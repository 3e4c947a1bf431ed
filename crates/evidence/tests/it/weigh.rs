//! The evidence of small problems against the density of all rows at once.

use denavit_evidence::{Base, Filtered, Glance, Layout, Spectrum, Terms, Unpredicted, Weighed};
use denavit_numerics::Random;
use nalgebra::{DMatrix, DVector};
use std::f64::consts::TAU;

/// Two channels of two bands, of which one has a band without rows.
fn layout() -> Layout {
    Layout { bands: vec![vec![0..7, 7..19], vec![0..9, 9..9]], levels: vec![0.1, 0.2] }
}

fn random_rows(random: &mut Random) -> Spectrum {
    [19, 9].map(|rows| (0..rows).map(|_| random.normal()).collect()).to_vec()
}

/// Data, own columns, and terms of which one acts on the first channel alone.
fn problem(seed: u64) -> (Spectrum, Vec<Spectrum>, Terms) {
    let mut random = Random::new(seed);
    let (data, own) = (random_rows(&mut random), vec![random_rows(&mut random); 1]);
    let own = [own, vec![random_rows(&mut random)]].concat();
    let mut first = random_rows(&mut random);
    first[1] = Vec::new();
    let terms = Terms {
        known: random_rows(&mut random),
        columns: vec![first, random_rows(&mut random)],
        lowest: vec![f64::NEG_INFINITY; 2],
        is_curved: vec![false; 2],
        believed: vec![0.3, 0.0],
        unpredicted: Unpredicted::default(),
        filtered: Vec::new(),
    };
    (data, own, terms)
}

fn stacked(spectrum: &Spectrum) -> DVector<f64> {
    let rows = [19, 9].into_iter().zip(spectrum);
    let all =
        rows.flat_map(|(rows, own)| if own.is_empty() { vec![0.0; rows] } else { own.clone() });
    DVector::from_vec(all.collect())
}

/// The log density of all rows with the covariance that variances and columns make together.
fn density(rows: &DVector<f64>, columns: &[DVector<f64>], variances: &[f64]) -> f64 {
    let sizes = [7, 12, 9];
    let of_rows = sizes.iter().zip(variances).flat_map(|(n, v)| std::iter::repeat_n(*v, *n));
    let mut covariance = DMatrix::from_diagonal(&DVector::from_iterator(28, of_rows));
    columns.iter().for_each(|column| covariance += column * column.transpose());
    let factor = covariance.cholesky().expect("positive");
    let log_root: f64 = factor.l().diagonal().iter().map(|pivot| pivot.ln()).sum();
    -log_root - 0.5 * rows.dot(&factor.solve(rows)) - 14.0 * TAU.ln()
}

fn by_density(data: &Spectrum, own: &[Spectrum], terms: &[&Terms], variances: &[f64]) -> f64 {
    let mut rows = stacked(data);
    let mut columns: Vec<DVector<f64>> = own.iter().map(stacked).collect();
    for one in terms {
        rows -= stacked(&one.known);
        for (column, believed) in one.columns.iter().zip(&one.believed) {
            rows -= stacked(column) * *believed;
            columns.push(stacked(column));
        }
    }
    density(&rows, &columns, variances)
}

const VARIANCES: [f64; 3] = [0.3, 1.7, 0.05];

#[test]
fn evidence_is_the_density_of_all_rows_at_once() {
    for seed in 1..6 {
        let (data, own, terms) = problem(seed);
        let base = Base::new(layout(), data.clone(), &own);
        let weigh = |terms: &[&Terms]| base.weigh(terms, Some(&VARIANCES), 0).log_evidence;
        let expected = by_density(&data, &own, &[&terms], &VARIANCES)
            - by_density(&data, &own, &[], &VARIANCES);
        let found = weigh(&[&terms]) - weigh(&[]);
        assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} {expected}");
    }
}

#[test]
fn no_other_variance_is_more_likely() {
    let (data, own, terms) = problem(11);
    let base = Base::new(layout(), data, &own);
    let Weighed { variances, .. } = base.weigh(&[&terms], None, 400);
    let of = |variances: &[f64]| base.weigh(&[&terms], Some(variances), 0).log_evidence;
    let most = of(&variances);
    for cell in 0..3 {
        for factor in [0.97, 1.03] {
            let mut other = variances.clone();
            other[cell] *= factor;
            assert!(of(&other) < most + 1e-3, "{cell} {factor}");
        }
    }
}

/// Factors are those of least squares with the prior as rows.
#[test]
fn factors_are_those_of_weighted_least_squares() {
    let (data, own, terms) = problem(21);
    let base = Base::new(layout(), data.clone(), &own);
    let found = base.weigh(&[&terms], Some(&VARIANCES), 0);
    let columns: Vec<DVector<f64>> = own.iter().chain(&terms.columns).map(stacked).collect();
    let weights =
        [7, 12, 9].iter().zip(VARIANCES).flat_map(|(n, v)| std::iter::repeat_n(1.0 / v.sqrt(), *n));
    let weights: Vec<f64> = weights.collect();
    let rows = stacked(&data) - stacked(&terms.known) - stacked(&terms.columns[0]) * 0.3;
    let matrix = DMatrix::from_fn(32, 4, |row, column| match row < 28 {
        true => weights[row] * columns[column][row],
        false => f64::from(u8::from(row - 28 == column)),
    });
    let target =
        DVector::from_fn(32, |row, _| if row < 28 { weights[row] * rows[row] } else { 0.0 });
    let solved = matrix.clone().svd(true, true).solve(&target, 1e-14).expect("full rank");
    let all = [found.own.as_slice(), &[found.factors[0] - 0.3, found.factors[1]]].concat();
    for (found, expected) in all.iter().zip(solved.iter()) {
        assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    }
    let inverse = (matrix.transpose() * &matrix).try_inverse().expect("full rank");
    assert!((found.covariance[(0, 1)] - inverse[(2, 3)]).abs() < 1e-10);
    let left = base.left(&found.own);
    assert!(
        (left[0][3] - (data[0][3] - own[0][0][3] * all[0] - own[1][0][3] * all[1])).abs() < 1e-12
    );
}

/// Half of a normal prior: the density with the bound is twice what the allowed half has of it.
#[test]
fn a_bound_keeps_the_allowed_share() {
    let (data, own, mut terms) = problem(31);
    terms.columns.truncate(1);
    (terms.is_curved, terms.believed) = (vec![false], vec![0.0]);
    let base = Base::new(layout(), data.clone(), &own);
    terms.lowest = vec![f64::NEG_INFINITY];
    let free = base.weigh(&[&terms], Some(&VARIANCES), 0);
    let deviation = free.covariance[(0, 0)].sqrt();
    for by in [-0.5, 0.8, 3.0] {
        is_kept(&base, &data, &own, &mut terms, &free, free.factors[0] + by * deviation);
    }
}

/// The evidence with a lower bound against integration over the factor.
fn is_kept(
    base: &Base,
    data: &Spectrum,
    own: &[Spectrum],
    terms: &mut Terms,
    free: &Weighed,
    lowest: f64,
) {
    let deviation = free.covariance[(0, 0)].sqrt();
    terms.lowest = vec![lowest];
    let bounded = base.weigh(&[terms], Some(&VARIANCES), 0);
    // by integration over the factor, step by step
    let at = |factor: f64| {
        let rows = stacked(data) - stacked(&terms.known) - stacked(&terms.columns[0]) * factor;
        let columns: Vec<DVector<f64>> = own.iter().map(stacked).collect();
        (density(&rows, &columns, &VARIANCES) - 0.5 * factor * factor - 0.5 * TAU.ln()).exp()
    };
    let steps = |from: f64, to: f64| {
        let h = (to - from) / 4000.0;
        (0..4000).map(|k| at(from + h * (f64::from(k) + 0.5))).sum::<f64>() * h
    };
    let (low, far) = (lowest, free.factors[0] + 9.0 * deviation);
    let kept = steps(low, far) / steps(free.factors[0] - 9.0 * deviation, far);
    let of_prior = {
        let h = 1e-3;
        let density = |x: f64| (-0.5 * x * x).exp() / TAU.sqrt();
        (0..12_000).map(|k| density(low + h * (f64::from(k) + 0.5))).sum::<f64>() * h
    };
    let gained = bounded.log_evidence - free.log_evidence;
    assert!((gained - (kept / of_prior).ln()).abs() < 1e-4, "{gained} {}", (kept / of_prior).ln());
}

/// A first look knows what is gained where variances are known and do not change.
#[test]
fn a_glance_sees_errors_and_factors() {
    let (data, own, terms) = problem(41);
    let base = Base::new(layout(), data, &own);
    let glance = Glance::new(&base, &[], &VARIANCES);
    let seen = glance.see(&terms);
    let whole = base.weigh(&[&terms], Some(&VARIANCES), 0);
    for (a, b) in seen.factors.iter().zip(&whole.factors) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
    let alone = Terms {
        columns: vec![terms.columns[1].clone()],
        lowest: vec![f64::NEG_INFINITY],
        is_curved: vec![false],
        believed: vec![0.0],
        ..terms
    };
    let whole = base.weigh(&[&alone], Some(&VARIANCES), 0);
    // the prior of the factor is one more measurement of it
    let precision = 1.0 / whole.covariance[(0, 0)] - 1.0;
    assert!((glance.see(&alone).precision[0] - precision).abs() < 1e-8 * precision);
}

/// A limit far below the data leaves little of them. That is no gain where nothing predicts their
/// sides, although the noise becomes small.
#[test]
fn what_takes_nearly_all_away_must_predict_the_rest() {
    let mut random = Random::new(11);
    let data = vec![(0..400).map(|_| random.normal()).collect::<Vec<f64>>()];
    let scaled = |by: f64| vec![data[0].iter().map(|row| by * row).collect::<Vec<f64>>()];
    let layout = Layout { bands: vec![vec![0..400]], levels: vec![0.02] };
    let base = Base::new(layout, data.clone(), &[]);
    let evidence = |terms: &[&Terms]| base.weigh(terms, None, 40).log_evidence;
    for share in [0.7, 0.9, 0.97] {
        let left = scaled(1.0 - share)[0].iter().map(|row| row * row).sum::<f64>() / 400.0;
        let free = Terms { known: scaled(share), ..Terms::default() };
        let unpredicted = Unpredicted { share, left };
        let limited = Terms { unpredicted, ..free.clone() };
        let none = evidence(&[]);
        assert!(evidence(&[&free]) > none + 100.0, "{share}");
        assert!(evidence(&[&limited]) < none, "{share}");
    }
}

/// A row that is one more moves each factor, linear or curved, by its influence.
#[test]
fn rows_move_factors_by_their_influences() {
    let (data, own, terms) = problem(31);
    let terms = Terms { is_curved: vec![false, true], ..terms };
    let factors = |data: &Spectrum| {
        let base = Base::new(layout(), data.clone(), &own);
        base.weigh(&[&terms], Some(&VARIANCES), 0).step
    };
    let influences = Base::new(layout(), data.clone(), &own).influences(&[&terms], &VARIANCES);
    let before = factors(&data);
    for (channel, row) in [(0, 2), (0, 11), (1, 5)] {
        let mut more = data.clone();
        more[channel][row] += 1.0;
        for (k, after) in factors(&more).iter().enumerate() {
            let moved = after - before[k];
            assert!((moved - influences[k][channel][row]).abs() < 1e-9, "{k} {channel} {row}");
        }
    }
}

/// A lag of what was measured leaves less of its noise, and predicts nothing by that: the density
/// of the data is that of what passes, times by how much data shrink. What moves the robot is in
/// what is computed as well: there a lag predicts what it leaves.
#[test]
fn what_makes_noise_smaller_predicts_nothing() {
    let mut random = Random::new(12);
    let [noise, moved, other] =
        [(); 3].map(|()| (0..400).map(|_| random.normal()).collect::<Vec<f64>>());
    let layout = Layout { bands: vec![vec![0..400]], levels: vec![0.02] };
    let gained = |measured: &[f64], computed: &[f64], gain: f64, is_filter: bool| {
        let data = measured.iter().zip(computed).map(|(y, c)| y - c).collect();
        let base = Base::new(layout.clone(), vec![data], &[]);
        let known = vec![measured.iter().map(|row| (1.0 - gain) * row).collect()];
        let (channel, log_gain) = (0, vec![gain.ln(); 400]);
        let filtered = Filtered { channel, measured: measured.to_vec(), log_gain };
        let filtered = if is_filter { vec![filtered] } else { Vec::new() };
        let terms = Terms { known, filtered, ..Terms::default() };
        let none = base.weigh(&[], None, 40);
        let seen = Glance::new(&base, &[], &none.variances).see(&terms).gain;
        [base.weigh(&[&terms], None, 40).log_evidence - none.log_evidence, seen]
    };
    for gain in [0.99, 0.8, 0.5_f64] {
        // but for what is believed of the size of noise
        let little = -0.02 * 400.0 * gain.ln();
        for gained in gained(&noise, &[0.0; 400], gain, true) {
            assert!(gained.abs() < little, "{gain}: {gained}");
        }
        let both = moved.iter().zip(&other);
        let computed: Vec<f64> = both.map(|(moved, other)| gain * moved + 0.2 * other).collect();
        let [all, plain] = [true, false].map(|is| gained(&moved, &computed, gain, is));
        for (all, plain) in all.into_iter().zip(plain) {
            assert!((all - plain).abs() < -0.1 * 400.0 * gain.ln(), "{gain}: {all} {plain}");
        }
    }
}

/// A channel without torque has the least level there is.
#[test]
fn a_channel_without_torque_is_weighed() {
    let (_, own, _) = problem(3);
    let least = f64::MIN_POSITIVE.sqrt();
    let layout = Layout { levels: vec![0.1, least], ..layout() };
    let base = Base::new(layout, vec![vec![0.0; 19], vec![0.0; 9]], &own);
    assert_eq!(base.weigh(&[], None, 8).own.len(), own.len());
}
