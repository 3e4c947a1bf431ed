//! A long log stretch by stretch, as it is whole.

use denavit_measure::SampleIndex;
use denavit_measure::condition::{
    Conditioned, Conditioning, Decimator, Filter, STENCIL, Stretches,
};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::Random;
use std::ops::Range;

const STEP_S: f64 = 1e-3;

fn walk(samples: usize) -> [Vec<f64>; 2] {
    let mut random = Random::new(8);
    let mut noisy = |size: f64, slow: f64| -> Vec<f64> {
        let at = |k: usize| (slow * k as f64).sin() + 0.3 * (2.7 * slow * k as f64).cos();
        (0..samples).map(|k| size * at(k) + 1e-3 * random.normal()).collect()
    };
    [noisy(1.0, 0.002), noisy(30.0, 0.003)]
}

fn log([q, tau]: &[Vec<f64>; 2], of: Range<usize>) -> MeasuredLog {
    let joint = JointSignals {
        q: q[of.clone()].to_vec(),
        tau: Some(tau[of.clone()].to_vec()),
        ..JointSignals::default()
    };
    MeasuredLog {
        start_s: STEP_S * of.start as f64,
        step_s: STEP_S,
        joints: vec![joint],
        ..MeasuredLog::default()
    }
}

fn conditioned(log: MeasuredLog, how: &Conditioning) -> Conditioned {
    Conditioned::new(log, &["joint".to_owned()], how).expect("long enough")
}

/// Every sample that is left of the whole is left of one stretch, with its time, motion and
/// torque; of orders, cutoffs and decimations of which poles are near the circle and far.
#[test]
fn stretches_have_the_samples_of_the_whole() {
    let signals = walk(400_000);
    let cases = [(4, 6.25, 40, 3), (4, 100.0, 4, 3), (1, 20.0, 10, 3), (8, 50.0, 1, 4)];
    for (order, cutoff_hz, decimation, expected) in cases {
        let filter = Some(Filter { order, cutoff_hz });
        let how = Conditioning { filter, decimation, ..Conditioning::default() };
        let whole = conditioned(log(&signals, 0..400_000), &how);
        let cut = Stretches::new(400_000, STEP_S, &how).expect("long enough");
        assert_eq!(cut.kept(), whole.samples());
        assert!((expected..=expected + 1).contains(&cut.count()), "{}", cut.count());
        let mut first = 0;
        let (mut ours, mut its) = (Vec::new(), Vec::new());
        let mut scale = [0.0_f64; 3];
        let mut off = [0.0_f64; 3];
        for number in 0..cut.count() {
            let stretch = cut.get(number);
            let part = conditioned(log(&signals, stretch.read.clone()), &how);
            let part = part.of_stretch(&stretch);
            let samples = part.samples();
            part.motion_at(SampleIndex(0), samples, &mut ours);
            whole.motion_at(SampleIndex(first), samples, &mut its);
            for order in 0..3 {
                for (a, b) in ours[order].iter().zip(&its[order]) {
                    off[order] = off[order].max((a - b).abs());
                    scale[order] = scale[order].max(b.abs());
                }
            }
            let at = |k: usize| part.time_s(SampleIndex(k)) - whole.time_s(SampleIndex(first + k));
            assert!(at(0).abs() < 1e-9 && at(samples - 1).abs() < 1e-9);
            first += samples;
        }
        assert_eq!(first, whole.samples());
        // differences of positions lose digits: steps are 1 ms
        for (order, most) in [1e-13, 1e-11, 1e-9].into_iter().enumerate() {
            assert!(off[order] <= most * scale[order], "{cutoff_hz} {order}: {off:?} {scale:?}");
        }
    }
}

/// A log that is shorter than its edges has no stretches; one with a single sample left, one.
#[test]
fn short_logs_have_one_stretch_or_none() {
    let filter = Some(Filter { order: 4, cutoff_hz: 10.0 });
    let how = Conditioning { filter, decimation: 4, ..Conditioning::default() };
    let edges = 2 * (400 + STENCIL + Decimator::reach_of(4));
    assert_eq!(Stretches::new(edges, STEP_S, &how), None);
    let one = Stretches::new(edges + 1, STEP_S, &how).expect("one sample");
    assert_eq!((one.kept(), one.count(), one.get(0).read), (1, 1, 0..edges + 1));
    let beyond = Some(Filter { order: 4, cutoff_hz: 600.0 });
    let beyond = Conditioning { filter: beyond, ..Conditioning::default() };
    assert_eq!(Stretches::new(100_000, STEP_S, &beyond), None);
}
