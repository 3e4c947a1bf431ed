//! Parameters are recovered from torques that another formulation computes.

use super::{INERTIAL, robot};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::RegressorOptions;
use denavit_identify::estimate::{
    Errors, Estimate, Loss, Method, Options, Status, consistent, convergence, estimate, parameters,
    validate,
};
use denavit_measure::condition::Conditioned;
use denavit_numerics::Random;
use denavit_plants::regression::RegressionModel;
use denavit_plants::{LoadedPlant, Plant};
use std::f64::consts::TAU;

/// Friction of every joint that is added to the torques of a plant without any.
const VISCOUS: f64 = 0.7;
const COULOMB: f64 = 0.4;

/// A motion of five harmonics in every joint, with its torques by D qdd + bias, noise added.
pub(super) struct Experiment {
    pub(super) samples: usize,
    pub(super) noise: f64,
    pub(super) seed: u64,
    pub(super) friction: bool,
}

impl Experiment {
    pub(super) fn run(&self, robot: &Robot) -> Conditioned {
        let mut plant = LoadedPlant::new(robot, &[]).expect("it has every value");
        let n = robot.degrees_of_freedom();
        let mut random = Random::new(self.seed);
        let harmonics: Vec<[f64; 10]> =
            (0..n).map(|_| std::array::from_fn(|_| 0.5 * random.normal())).collect();
        let step_s = 0.01;
        let mut data = Conditioned {
            file: "simulated".to_owned(),
            step_s,
            q: vec![Vec::new(); n],
            torque: vec![Some(Vec::new()); n],
            range: 0..self.samples,
            decimation: 1,
            ..Conditioned::default()
        };
        let mut rates = [vec![Vec::new(); n], vec![Vec::new(); n]];
        let (mut mass, mut bias) = (vec![0.0; n * n], vec![0.0; n]);
        for k in 0..self.samples {
            let t = step_s * k as f64;
            let mut at = [vec![0.0; n], vec![0.0; n], vec![0.0; n]];
            for (joint, harmonics) in harmonics.iter().enumerate() {
                for (order, pair) in harmonics.chunks(2).enumerate() {
                    // Incommensurable, so that no motion repeats.
                    let w = TAU * 0.11 * (order as f64 + 1.0) * (1.0 + 0.037 * joint as f64);
                    let (s, c) = (w * t).sin_cos();
                    at[0][joint] += pair[0] * s + pair[1] * c;
                    at[1][joint] += w * (pair[0] * c - pair[1] * s);
                    at[2][joint] -= w * w * (pair[0] * s + pair[1] * c);
                }
            }
            let [q, qd, qdd] = &at;
            plant.mass_matrix(q, &mut mass);
            plant.bias(q, qd, &mut bias);
            for joint in 0..n {
                let inertial: f64 = (0..n).map(|i| mass[joint * n + i] * qdd[i]).sum();
                let added = VISCOUS * qd[joint] + COULOMB * qd[joint].signum();
                let friction = if self.friction { added } else { 0.0 };
                let torque = inertial + bias[joint] + friction + self.noise * random.normal();
                data.torque[joint].as_mut().expect("measured").push(torque);
                data.q[joint].push(q[joint]);
                rates[0][joint].push(qd[joint]);
                rates[1][joint].push(qdd[joint]);
            }
        }
        data.rates = Some(rates);
        data
    }
}

/// A robot without drives: what they would add is added by hand.
pub(super) fn bare(name: &str) -> Robot {
    without_drives(robot(name))
}

fn without_drives(mut robot: Robot) -> Robot {
    for link in robot.links.values_mut() {
        link.drive = None;
        link.joint.damping = None;
        link.joint.spring = None;
    }
    robot
}

fn truth(model: &RegressionModel) -> Vec<f64> {
    let value = |parameter: &denavit_plants::regression::RegressionParameter| {
        let by_name = match parameter.name.split('_').next() {
            Some("fv") => Some(VISCOUS),
            Some("fc") => Some(COULOMB),
            _ => parameter.value,
        };
        by_name.expect("the model has all values")
    };
    model.listed.iter().map(value).collect()
}

fn run(model: &RegressionModel, data: &[Conditioned], options: &Options) -> Estimate {
    let start = vec![0.0; model.rank()];
    estimate(model, data, &[], options, &start).expect("an estimate")
}

/// The share of true values within intervals of 95 %, and the worst distance in standard errors.
fn coverage(model: &RegressionModel, found: &Estimate) -> (f64, f64) {
    let listed = parameters(model, found);
    let truth = truth(model);
    let mut inside = 0;
    let mut worst = 0.0_f64;
    for (one, truth) in listed.iter().zip(&truth) {
        let (std, interval) = (one.std.expect("excited"), one.interval.expect("excited"));
        inside += usize::from((one.value - truth).abs() <= interval);
        worst = worst.max((one.value - truth).abs() / std);
    }
    (inside as f64 / truth.len() as f64, worst)
}

#[test]
fn all_parameters_of_whole_robots_are_recovered() {
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    for name in ["puma560", "tulip_leg6"] {
        let robot = bare(name);
        let model = RegressionModel::new(&robot, friction, &[]).expect(name);
        assert_eq!(model.rank(), 48, "{name}");
        let noise = 0.05;
        let train = Experiment { samples: 3000, noise, seed: 11, friction: true }.run(&robot);
        let found = run(&model, &[train], &Options::default());
        let (inside, worst) = coverage(&model, &found);
        assert!(inside >= 0.85 && worst < 5.0, "{name}: {inside} {worst}");
        // Held out: nothing is left but the noise.
        let other = Experiment { samples: 2000, noise, seed: 12, friction: true }.run(&robot);
        let held_out = validate(&model, found.solution.phi.as_slice(), &[other]);
        for joint in &held_out.joints {
            assert!((joint.residual_rms / noise - 1.0).abs() < 0.08, "{name} {}", joint.name);
            assert!(joint.autocorrelation[0].abs() < 0.1, "{name} {}", joint.name);
        }
    }
}

/// Ayusawa's theorem: the wrench on the base shows everything, no joint torque is needed.
#[test]
fn the_wrench_on_the_base_of_tulip_shows_94_parameters() {
    let robot = bare("tulip");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    assert_eq!(model.rank(), 94);
    let mut data = Experiment { samples: 2500, noise: 0.01, seed: 3, friction: false }.run(&robot);
    for (torque, joint) in data.torque.iter_mut().zip(&model.joints) {
        if !joint.is_base {
            *torque = None;
        }
    }
    let found = run(&model, &[data], &Options::default());
    assert_eq!(found.solution.excited(), 94);
    let (inside, worst) = coverage(&model, &found);
    assert!(inside >= 0.85 && worst < 5.0, "{inside} {worst}");
}

#[test]
fn without_noise_the_parameters_are_exact() {
    let robot = bare("puma560");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let data = Experiment { samples: 1500, noise: 0.0, seed: 5, friction: false }.run(&robot);
    let found = run(&model, &[data], &Options::default());
    for (one, truth) in parameters(&model, &found).iter().zip(truth(&model)) {
        assert!((one.value - truth).abs() < 1e-7 * truth.abs().max(1.0), "{} {truth}", one.name);
    }
}

/// A motion of the last joint alone says nothing of bodies that it does not carry.
#[test]
fn what_is_not_excited_is_said_to_be() {
    let robot = bare("puma560");
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    let model = RegressionModel::new(&robot, friction, &[]).expect("a model");
    let mut data = Experiment { samples: 800, noise: 0.01, seed: 5, friction: true }.run(&robot);
    // Only the torque of the last joint is known.
    for torque in &mut data.torque[..5] {
        *torque = None;
    }
    let start = model.to_axes() * nalgebra::DVector::from_vec(truth(&model));
    let found = estimate(&model, &[data], &[], &Options::default(), start.as_slice()).unwrap();
    let listed = parameters(&model, &found);
    let of = |name: &str| listed.iter().find(|one| one.name == name).expect(name);
    assert_eq!(of("fv_wrist_yaw").status, Status::Identified);
    assert_eq!(of("fv_waist").status, Status::NotExcited);
    assert_eq!(of("fv_waist").std, None);
    // It stays where it was.
    assert!((of("fv_waist").value - VISCOUS).abs() < 1e-9);
}

#[test]
fn outliers_lose_their_weight() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let mut data = Experiment { samples: 1500, noise: 0.02, seed: 8, friction: false }.run(&robot);
    for (k, torque) in data.torque[0].as_mut().unwrap().iter_mut().enumerate() {
        if k % 25 == 0 {
            *torque += 30.0;
        }
    }
    let truth = truth(&model);
    let error = |method: Method| -> f64 {
        let options = Options { method, ..Options::default() };
        let found = run(&model, &[data.clone()], &options);
        let listed = parameters(&model, &found);
        listed.iter().zip(&truth).map(|(one, truth)| (one.value - truth).abs()).sum()
    };
    let plain = error(Method::Weighted);
    for loss in [Loss::Huber, Loss::Bisquare] {
        assert!(error(Method::Robust(loss)) < 0.2 * plain, "{loss:?}");
    }
}

/// Intervals of weights that follow the residuals hold on noise without outliers as well: there
/// the weights alone would make them a sixth (Huber) to a fifth (bisquare) too narrow.
#[test]
fn intervals_of_robust_estimates_hold_on_plain_noise() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let clean = Experiment { samples: 1500, noise: 0.0, seed: 4, friction: false }.run(&robot);
    let truth = truth(&model);
    for loss in [Loss::Huber, Loss::Bisquare] {
        let drawn = Errors::Bootstrap { draws: 100, seed: 3 };
        for errors in [Errors::Classical, Errors::Correlated, drawn] {
            let options = Options { method: Method::Robust(loss), errors, ..Options::default() };
            let (mut squares, mut count) = (0.0, 0.0);
            for seed in 0..100 {
                let mut random = Random::new(5000 + seed);
                let mut data = clean.clone();
                for torque in data.torque.iter_mut().flatten().flatten() {
                    *torque += 0.1 * random.normal();
                }
                let found = run(&model, &[data], &options);
                for (one, truth) in parameters(&model, &found).iter().zip(&truth) {
                    squares += ((one.value - truth) / one.std.expect("excited")).powi(2);
                    count += 1.0;
                }
            }
            let size = f64::sqrt(squares / count);
            assert!((0.9..1.12).contains(&size), "{loss:?} {errors:?}: {size}");
        }
    }
}

/// Errors of a Monte Carlo: residuals of an AR(1) process, which independent errors understate.
#[test]
fn intervals_hold_for_residuals_that_are_correlated() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let clean = Experiment { samples: 2400, noise: 0.0, seed: 4, friction: false }.run(&robot);
    let truth = truth(&model);
    let errors = [Errors::Correlated, Errors::Classical, Errors::Bootstrap { draws: 60, seed: 9 }];
    let mut inside = [0.0; 3];
    let repetitions = 60;
    for seed in 0..repetitions {
        let mut random = Random::new(1000 + seed);
        let mut data = clean.clone();
        for torque in data.torque.iter_mut().flatten() {
            let mut noise = 0.0;
            for torque in torque {
                noise = 0.8 * noise + 0.1 * random.normal();
                *torque += noise;
            }
        }
        for (inside, errors) in inside.iter_mut().zip(errors) {
            let options = Options { errors, ..Options::default() };
            let found = run(&model, &[data.clone()], &options);
            for (one, truth) in parameters(&model, &found).iter().zip(&truth) {
                let interval = one.interval.expect("excited");
                *inside += f64::from(u8::from((one.value - truth).abs() <= interval));
            }
        }
    }
    let share = inside.map(|count| count / (truth.len() as f64 * repetitions as f64));
    assert!((0.90..=0.99).contains(&share[0]), "{share:?}");
    assert!(share[1] < 0.85, "independent errors understate: {share:?}");
    assert!((0.86..=0.99).contains(&share[2]), "{share:?}");
}

#[test]
fn bodies_that_exist_are_near_and_exist() {
    let robot = bare("tulip_leg6");
    let friction = RegressorOptions { friction: true, ..INERTIAL };
    let model = RegressionModel::new(&robot, friction, &[]).expect("a model");
    let data = Experiment { samples: 800, noise: 0.3, seed: 21, friction: true }.run(&robot);
    let found = run(&model, std::slice::from_ref(&data), &Options::default());
    let near = consistent(&model, &found);
    for (place, one) in model.standard.iter().enumerate() {
        match &one.owner {
            Some((_, "m")) => {
                let ten = &near.standard[place..place + 10];
                let [xx, yy, zz] = [ten[4], ten[5], ten[6]];
                let [xy, xz, yz] = [ten[7], ten[8], ten[9]];
                let half = 0.5 * (xx + yy + zz);
                let j = nalgebra::Matrix4::new(
                    half - xx,
                    -xy,
                    -xz,
                    ten[1],
                    -xy,
                    half - yy,
                    -yz,
                    ten[2],
                    -xz,
                    -yz,
                    half - zz,
                    ten[3],
                    ten[1],
                    ten[2],
                    ten[3],
                    ten[0],
                );
                assert!(j.symmetric_eigenvalues().min() >= 0.0, "{}", one.name);
            }
            Some((_, "fv" | "fc")) => assert!(near.standard[place] >= 0.0, "{}", one.name),
            _ => {}
        }
    }
    // As good as any: the data cannot tell it from the estimate.
    let best =
        validate(&model, found.solution.phi.as_slice(), std::slice::from_ref(&data)).relative;
    let ours = validate(&model, &near.phi, &[data]).relative;
    assert!(ours < 1.05 * best, "{ours} {best}: {}", near.distance);
}

#[test]
fn the_estimate_converges_as_data_come_in() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let data = Experiment { samples: 2000, noise: 0.05, seed: 2, friction: false }.run(&robot);
    let found = run(&model, &[data], &Options::default());
    let points = convergence(&model, &found);
    let truth = truth(&model);
    let error = |values: &[f64]| -> f64 {
        values.iter().zip(&truth).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
    };
    let (first, last) = (&points[0], &points[points.len() - 1]);
    assert!(error(&last.values) < error(&first.values));
    assert!(last.condition < first.condition && last.time_s > 19.0);
}

/// Two logs whose torques have noise of 0.02 and 1 N m: each method finds both, and weighs rows by
/// them, so that errors are as good as those of the better log alone.
#[test]
fn each_log_is_weighted_by_its_own_noise() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let log = |noise, seed| Experiment { samples: 2000, noise, seed, friction: false }.run(&robot);
    let logs = [log(1.0, 4), log(0.02, 5)];
    let of = |logs: &[Conditioned], method| {
        let options = Options { method, errors: Errors::Classical, ..Options::default() };
        let found = run(&model, logs, &options);
        let errors: Vec<f64> =
            parameters(&model, &found).iter().map(|one| one.std.expect("excited")).collect();
        (found, errors)
    };
    for method in [Method::Weighted, Method::Robust(Loss::Huber), Method::Likelihood] {
        let (_, alone) = of(&logs[1..], method);
        let (found, both) = of(&logs, method);
        for (noise, truth) in found.noise.iter().zip([1.0, 0.02]) {
            for noise in noise {
                assert!((noise / truth - 1.0).abs() < 0.1, "{method:?}: {noise} {truth}");
            }
        }
        for (alone, both) in alone.into_iter().zip(both) {
            assert!((0.9..1.05).contains(&(both / alone)), "{method:?}: {alone} {both}");
        }
        assert!(coverage(&model, &found).1 < 4.5, "{method:?}");
    }
}

/// Logs of a few samples beside a long one: what they seem to have less of noise is the share of
/// the parameters that they decide, and intervals hold.
#[test]
fn short_logs_do_not_seem_better_than_they_are() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let (mut squares, mut count) = (0.0, 0);
    for seed in 0..40 {
        let log =
            |samples, seed| Experiment { samples, noise: 0.05, seed, friction: false }.run(&robot);
        let logs = [log(300, 900 + seed), log(6, 1000 + seed), log(6, 2000 + seed)];
        let found =
            run(&model, &logs, &Options { errors: Errors::Classical, ..Options::default() });
        for (one, truth) in parameters(&model, &found).iter().zip(truth(&model)) {
            squares += ((one.value - truth) / one.std.expect("excited")).powi(2);
            count += 1;
        }
    }
    let spread = (squares / f64::from(count)).sqrt();
    assert!((0.85..1.15).contains(&spread), "{spread}");
}

/// White noise, of which errors are known in closed form: 25 parts of a log say as much in the
/// mean, though by chance of some parameters less.
#[test]
fn errors_of_few_parts_are_as_large_in_the_mean_as_they_are() {
    let robot = bare("planar_2r");
    let model = RegressionModel::new(&robot, INERTIAL, &[]).expect("a model");
    let (mut sum, mut count) = (0.0, 0.0);
    for seed in 0..60 {
        let log = [Experiment { samples: 500, noise: 0.05, seed, friction: false }.run(&robot)];
        let [known, found] = [Errors::Classical, Errors::Correlated].map(|errors| {
            let found = run(&model, &log, &Options { errors, ..Options::default() });
            parameters(&model, &found)
        });
        for (known, found) in known.iter().zip(&found) {
            sum += found.std.expect("excited") / known.std.expect("excited");
            count += 1.0;
        }
    }
    let ratio: f64 = sum / count;
    assert!((0.94..1.06).contains(&ratio), "{ratio}");
}
