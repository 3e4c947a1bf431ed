//! Throughput of identification: rows of the base regressor, and their condensation by QR.
//!
//! `cargo bench --bench identification` prints a table. One thread; the best of five runs.

use denavit::identify::estimate::{Condensed, Options, estimate};
use denavit::measure::condition::Conditioned;
use denavit::model;
use denavit::numerics::Random;
use denavit::numerics::least_squares::Triangle;
use denavit::plants::regression::{RegressionModel, RegressionRows};
use denavit::regressor::{RegressorOptions, Unknowns};
use denavit::shipped;
use std::hint::black_box;
use std::time::Instant;

const INERTIAL: RegressorOptions = RegressorOptions {
    friction: false,
    rotor: false,
    offset: false,
    only_modelled: false,
    unknowns: Unknowns::Parameters,
};

fn best(mut run: impl FnMut()) -> f64 {
    let time = |_| {
        let started = Instant::now();
        run();
        started.elapsed().as_secs_f64()
    };
    (0..5).map(time).fold(f64::INFINITY, f64::min)
}

fn data(model: &RegressionModel, samples: usize) -> Conditioned {
    let n = model.joints.len();
    let mut random = Random::new(1);
    let mut column = || -> Vec<f64> { (0..samples).map(|_| random.normal()).collect() };
    Conditioned {
        step_s: 1e-3,
        q: (0..n).map(|_| column()).collect(),
        rates: Some([(0..n).map(|_| column()).collect(), (0..n).map(|_| column()).collect()]),
        torque: (0..n).map(|_| Some(column())).collect(),
        range: 0..samples,
        decimation: 1,
        ..Conditioned::default()
    }
}

fn row(name: &str, samples: usize) {
    let shipped = shipped::find(name).expect("a shipped model");
    let robot = model::read(name, shipped.text.as_bytes()).expect("shipped models are sound");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let data = data(&model, samples);
    let mut evaluator = model.evaluator();
    let mut rows = RegressionRows::default();
    let rates = data.rates.as_ref().expect("given");
    let columns: Vec<&Vec<f64>> = data.q.iter().chain(&rates[0]).chain(&rates[1]).collect();
    let regressor = best(|| {
        for first in (0..samples).step_by(512) {
            let end = samples.min(first + 512);
            let motion: Vec<&[f64]> = columns.iter().map(|column| &column[first..end]).collect();
            evaluator.evaluate(&motion, &mut rows).expect("every column is there");
            black_box(rows.column(0, 0));
        }
    });
    let condense = best(|| _ = black_box(Condensed::new(&model, std::slice::from_ref(&data))));
    let start = vec![0.0; model.rank()];
    let all = best(|| {
        let data = std::slice::from_ref(&data);
        _ = black_box(estimate(&model, data, &[], &Options::default(), &start));
    });
    println!(
        "{name:<12} {samples:>8} samples x {} joints x {} columns: regressor {:.3} us/sample, \
         regressor and QR of all joints {condense:.3} s, estimate with errors {all:.3} s",
        model.joints.len(),
        model.rank(),
        1e6 * regressor / samples as f64,
    );
}

fn qr(rows: usize, columns: usize) {
    let mut random = Random::new(2);
    let matrix: Vec<Vec<f64>> =
        (0..=columns).map(|_| (0..rows).map(|_| random.normal()).collect()).collect();
    let time = best(|| {
        let mut triangle = Triangle::new(columns);
        for first in (0..rows).step_by(512) {
            let end = rows.min(first + 512);
            let block: Vec<&[f64]> = matrix.iter().map(|column| &column[first..end]).collect();
            triangle.push(&block);
        }
        black_box(triangle.matrix());
    });
    println!("QR of {rows} rows x {columns} columns in blocks of 512: {time:.3} s");
}

fn main() {
    qr(100_000, 36);
    qr(100_000, 60);
    row("tulip_leg6", 100_000);
    row("puma560", 1_000_000);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find(|line| line.starts_with("VmHWM"));
    println!("peak memory: {}", peak.unwrap_or("unknown"));
}
