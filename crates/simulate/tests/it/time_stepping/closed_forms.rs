//! Closed forms, reached at the order of the scheme.

use super::systems::{Cradle, GRAVITY, Oscillator, PlaneBody, Sample, order, run, stepping};
use denavit_simulate::time_stepping::{Scheme, Stepping};

const MOREAU: Scheme = Scheme::MoreauMidpoint;
const ANITESCU: Scheme = Scheme::Anitescu { reach_m: 0.05 };

fn assert_order(found: f64, expected: f64) {
    assert!((found - expected).abs() < 0.25, "order {found} instead of {expected}");
}

fn ball() -> PlaneBody {
    PlaneBody { mass: 1.0, inertia: 1.0, points: vec![[0.0, 0.0]], force: [0.0, -GRAVITY] }
}

fn start(z: f64) -> ([f64; 3], [f64; 3]) {
    ([0.0, z, 0.0], [0.0; 3])
}

/// Height of a ball that falls from 1 m and bounces with e = 0.8, at time t.
fn bouncing(t: f64) -> f64 {
    let (mut at, mut speed) = ((2.0 / GRAVITY).sqrt(), 0.8 * (2.0 * GRAVITY).sqrt());
    if t < at {
        return 1.0 - 0.5 * GRAVITY * t * t;
    }
    while t > at + 2.0 * speed / GRAVITY {
        at += 2.0 * speed / GRAVITY;
        speed *= 0.8;
    }
    speed * (t - at) - 0.5 * GRAVITY * (t - at) * (t - at)
}

#[test]
fn a_bouncing_ball_is_of_first_order() {
    let (q, qd) = start(1.0);
    let error = |h| {
        let samples = run(&mut ball(), stepping(MOREAU, h, 1, 0.0, 0.8), &q, &qd, 2.5);
        let last = samples.last().unwrap();
        (last.q[1] - bouncing(last.t_s)).abs()
    };
    assert_order(order(2e-3, error), 1.0);
}

/// It comes to rest after infinitely many bounces at 4.06371276887 s.
#[test]
fn a_ball_passes_its_last_bounce() {
    let (q, qd) = start(1.0);
    for h in [1e-3, 1e-4] {
        let samples = run(&mut ball(), stepping(MOREAU, h, 1, 0.0, 0.8), &q, &qd, 4.5);
        let moving = samples.iter().rev().find(|sample| sample.qd[1].abs() > 1e-9).unwrap();
        let late = moving.t_s - 4.063_712_768_87;
        assert!(late.abs() < 70.0 * h, "late by {late} s at {h}");
        assert!(samples.last().unwrap().q[1].abs() < h);
    }
}

#[test]
fn a_ball_without_restitution_does_not_penetrate_where_the_gap_is_constrained() {
    let (q, qd) = start(0.1);
    let samples = run(&mut ball(), stepping(ANITESCU, 1e-3, 1, 0.0, 0.0), &q, &qd, 0.5);
    assert!(samples.iter().all(|sample| sample.q[1] > -1e-12));
    let last = samples.last().unwrap();
    assert!(last.q[1].abs() < 1e-12 && last.qd[1].abs() < 1e-12);
}

/// mu = 0.3 on a slope of 10 degrees, v = 2: stops at t = x = 1.67391948891 and sticks.
#[test]
fn a_sliding_block_stops_and_sticks() {
    let slope = 10.0_f64.to_radians();
    let (pull, push) = (GRAVITY * slope.sin(), GRAVITY * slope.cos());
    for scheme in [MOREAU, ANITESCU] {
        let slide = |h| {
            let points = vec![[-0.1, 0.0], [0.1, 0.0]];
            let force = [pull, -push];
            let mut block = PlaneBody { mass: 1.0, inertia: 0.1, points, force };
            let laws = stepping(scheme, h, 2, 0.3, 0.0);
            run(&mut block, laws, &[0.0; 3], &[2.0, 0.0, 0.0], 2.0)
        };
        let path = |h| (slide(h).last().unwrap().q[0] - 1.673_919_488_91).abs();
        match scheme {
            // The force is constant: only the step of the stop is inexact.
            Scheme::MoreauMidpoint => assert!(path(1e-3) < 1e-6, "{}", path(1e-3)),
            Scheme::Anitescu { .. } => assert_order(order(4e-3, path), 1.0),
        }
        let samples = slide(1e-3);
        let stop = samples.iter().find(|sample| sample.qd[0].abs() < 1e-9).unwrap();
        assert!((stop.t_s - 1.673_919_488_91).abs() < 1e-3, "{}", stop.t_s);
        assert!(samples.last().unwrap().qd[0].abs() < 1e-12);
    }
}

/// A disk that starts sliding rolls from t = 2 v0/(7 mu G) on with 5/7 v0, if it is a sphere.
#[test]
fn a_sliding_sphere_comes_to_roll() {
    let (radius, mu, speed) = (0.1, 0.2, 2.0);
    struct Sphere(PlaneBody);
    impl denavit_simulate::time_stepping::TimeSteppingModel for Sphere {
        fn dof(&self) -> usize {
            3
        }
        fn contacts(&self) -> usize {
            1
        }
        fn space(&self) -> denavit_simulate::contact::Space {
            self.0.space()
        }
        fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
            gaps[0] = q[1] - 0.1;
        }
        fn terms(
            &mut self,
            at: denavit_simulate::time_stepping::Instant<'_>,
            closed: &[usize],
            terms: &mut denavit_simulate::time_stepping::Terms,
        ) {
            self.0.terms(at, &[], terms);
            if !closed.is_empty() {
                terms.jacobian.copy_from_slice(&[1.0, 0.0, 0.1, 0.0, 1.0, 0.0]);
            }
        }
    }
    let mut sphere = Sphere(PlaneBody {
        mass: 1.0,
        inertia: 0.4 * radius * radius,
        points: vec![[0.0, -radius]],
        force: [0.0, -GRAVITY],
    });
    let h = 1e-4;
    let rolling = 2.0 * speed / (7.0 * mu * GRAVITY);
    let laws = stepping(MOREAU, h, 1, mu, 0.0);
    let samples = run(&mut sphere, laws, &[0.0, radius, 0.0], &[speed, 0.0, 0.0], 1.0);
    let slips = |sample: &&Sample| (sample.qd[0] + radius * sample.qd[2]).abs() > 1e-9;
    let last = samples.iter().filter(slips).count() as f64 * h;
    assert!((last - rolling).abs() < 2.0 * h, "{last} instead of {rolling}");
    let end = samples.last().unwrap();
    assert!((end.qd[0] - 5.0 / 7.0 * speed).abs() < 1e-9, "{}", end.qd[0]);
}

/// A block 2b x 2h rocks: after its first impact the rate is r = 1 - 3/2 sin^2 alpha times that
/// before.
#[test]
fn a_rocking_block_is_of_first_order() {
    let (b, height, tilt) = (0.1_f64, 0.4_f64, 0.1_f64);
    let r = 31.0 / 34.0;
    let ratio = |h: f64| {
        let inertia = (b * b + height * height) / 3.0;
        let points = vec![[-b, -height], [b, -height]];
        let mut block = PlaneBody { mass: 1.0, inertia, points, force: [0.0, -GRAVITY] };
        let z = b * tilt.sin() + height * tilt.cos();
        let laws = stepping(MOREAU, h, 2, 0.6, 0.0);
        let samples = run(&mut block, laws, &[0.0, z, -tilt], &[0.0; 3], 0.5);
        let rates: Vec<f64> = samples.iter().map(|sample| sample.qd[2]).collect();
        let impact = rates.windows(2).position(|pair| (pair[1] - pair[0]).abs() > 0.02).unwrap();
        assert!((samples[impact].t_s - 0.264_713_415_73).abs() < 5.0 * h);
        rates[impact + 1] / rates[impact]
    };
    assert_order(order(2e-3, |h| (ratio(h) - r).abs()), 1.0);
}

/// A rod, tilted by 0.5 rad, falls onto its end at 1 m/s: omega = 1.59056619792 without friction,
/// 1.31637384284 with enough.
#[test]
fn a_falling_rod_is_of_first_order() {
    let (c, s) = (0.5 * 0.5_f64.cos(), 0.5 * 0.5_f64.sin());
    for (mu, omega) in [(0.0, 1.590_566_197_92), (1.0, 1.316_373_842_84)] {
        let error = |h: f64| {
            let force = [0.0, -GRAVITY];
            let points = vec![[-c, -s]];
            let mut rod = PlaneBody { mass: 1.0, inertia: 1.0 / 12.0, points, force };
            // It touches after 0.01 s, with the speed of 1 m/s.
            let speed = 1.0 - GRAVITY * 0.01;
            let z = s + 0.01 * speed + 0.5 * GRAVITY * 1e-4;
            let laws = stepping(MOREAU, h, 1, mu, 0.0);
            let samples = run(&mut rod, laws, &[0.0, z, 0.0], &[0.0, -speed, 0.0], 0.02);
            let hit = samples.iter().find(|sample| sample.qd[2] != 0.0).unwrap();
            assert_eq!(hit.report.closed, 1);
            (hit.qd[2].abs() - omega).abs()
        };
        assert_order(order(1e-3, error), 1.0);
    }
}

/// All balls at once by Newton's law: (-1/3, 2/3, 2/3), and (-0.6, 0.4, 0.4, 0.4, 0.4).
#[test]
fn cradles_collide_at_once() {
    for (balls, first, others) in [(3, -1.0 / 3.0, 2.0 / 3.0), (5, -0.6, 0.4)] {
        let mut q = vec![0.0; balls];
        q[0] = -0.0105;
        let mut qd = vec![0.0; balls];
        qd[0] = 1.0;
        let laws = stepping(MOREAU, 1e-3, balls - 1, 0.0, 1.0);
        let samples = run(&mut Cradle { balls }, laws, &q, &qd, 0.02);
        let end = &samples.last().unwrap().qd;
        assert!((end[0] - first).abs() < 1e-9, "{end:?}");
        assert!(end[1..].iter().all(|rate| (rate - others).abs() < 1e-9), "{end:?}");
    }
}

#[test]
fn smooth_motion_is_of_second_order_and_stiff_damping_is_stable() {
    let error = |h| {
        let mut spring = Oscillator { stiffness: 4.0, damping: 0.0 };
        let samples = run(&mut spring, stepping(MOREAU, h, 0, 0.0, 0.0), &[1.0], &[0.0], 1.0);
        let last = samples.last().unwrap();
        (last.q[0] - (2.0 * last.t_s).cos()).abs()
    };
    assert_order(order(1e-2, error), 2.0);
    // Explicitly unstable: h d = 30.
    let mut damper = Oscillator { stiffness: 0.0, damping: 3e4 };
    let samples = run(&mut damper, stepping(MOREAU, 1e-3, 0, 0.0, 0.0), &[0.0], &[1.0], 0.05);
    assert!(samples.windows(2).all(|pair| pair[1].qd[0].abs() < pair[0].qd[0].abs()));
}

/// v = exp(-d t): half of the damping taken implicitly is of second order, all of it of first.
#[test]
fn damping_is_of_the_order_of_its_implicit_part() {
    for (implicitness, expected) in [(1.0, 1.0), (0.5, 2.0)] {
        let error = |h| {
            let mut damper = Oscillator { stiffness: 0.0, damping: 3.0 };
            let (steps, laws) = stepping(MOREAU, h, 0, 0.0, 0.0);
            let laws = (Stepping { implicitness, ..steps }, laws);
            let samples = run(&mut damper, laws, &[0.0], &[1.0], 1.0);
            let last = samples.last().unwrap();
            (last.qd[0] - (-3.0 * last.t_s).exp()).abs()
        };
        assert_order(order(1e-2, error), expected);
    }
}
