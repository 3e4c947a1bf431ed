//! A drive behind a transmission that gives way, against closed forms.

use denavit_codegen::effect::find;
use denavit_codegen::model::JointKind;
use denavit_plants::effect::{Drive, EffectLaw, JointSamples};

const STEP_S: f64 = 0.001;
const INERTIA: f64 = 0.05;

fn law(name: &str) -> EffectLaw {
    EffectLaw::new(find(name).expect("shipped"), JointKind::Revolute).expect("a law")
}

fn times(count: u32) -> Vec<f64> {
    (0..count).map(|k| STEP_S * f64::from(k)).collect()
}

/// (a + ib) / (c + id).
fn quotient([a, b]: [f64; 2], [c, d]: [f64; 2]) -> [f64; 2] {
    let square = c * c + d * d;
    [(a * c + b * d) / square, (b * c - a * d) / square]
}

/// Without dry friction the rotor is linear: I th'' + fv th' + d (th' - q') + k (th - q) = tau,
/// here for tau = P sin wt and q = Q sin wt.
#[test]
fn what_an_elastic_transmission_passes_on_is_its_transfer_function() {
    let law = law("joint_elasticity");
    let (viscous, zeta, w) = (0.1, 0.2, 30.0);
    let (p, q) = (2.0, 0.01);
    let t = times(8000);
    let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { t.iter().map(|&t| f(t)).collect() };
    let position = of(&|t| q * (w * t).sin());
    let rate = of(&|t| q * w * (w * t).cos());
    let acceleration = of(&|t| -q * w * w * (w * t).sin());
    let tau = of(&|t| p * (w * t).sin());
    let samples = JointSamples {
        t: &t,
        q: &position,
        qd: &rate,
        qdd: &acceleration,
        tau: &tau,
        drive: Drive { inertia: INERTIA, viscous, coulomb: 0.0, offset: 0.0 },
        ..JointSamples::default()
    };
    // T = (k + iwd) (th - q) of amplitudes, as parts with sin and with cos
    let passed = |swing: f64| {
        let (k, d) = (INERTIA / (swing * swing), 2.0 * zeta * INERTIA / swing);
        let stiff = [k - INERTIA * w * w, w * (d + viscous)];
        let [re, im] = quotient([p + k * q, w * d * q], stiff);
        let (re, im) = (re - q, im);
        [k * re - w * d * im, k * im + w * d * re]
    };
    let swing = 0.015;
    let (soft, rigid) = (passed(swing), passed(0.002));
    // friction whose estimate is below 0 pushes nothing
    for coulomb in [0.0, -0.1] {
        let drive = Drive { coulomb, ..samples.drive };
        let found = law.torque(&JointSamples { drive, ..samples }, &[swing, zeta, 0.0]);
        for (t, found) in t.iter().zip(found).skip(4000) {
            let (sine, cosine) = (w * t).sin_cos();
            let at = |[re, im]: [f64; 2]| re * sine + im * cosine;
            let expected = at(rigid) - at(soft);
            assert!((found - expected).abs() < 0.01 * p, "{t}: {found} is not {expected}");
        }
    }
}

/// A rotor that its torque turns around crosses the play alone: in sqrt(2 gap I / tau) from rest,
/// while nothing reaches the joint. Here tau is 1.
#[test]
fn a_rotor_crosses_its_play_in_the_time_of_free_motion() {
    let law = law("play");
    let t = times(4000);
    let rest = vec![0.0; t.len()];
    let tau: Vec<f64> = t.iter().map(|&t| if t < 2.0 { 1.0 } else { -1.0 }).collect();
    let drive = Drive { inertia: INERTIA, viscous: 0.0, coulomb: 0.0, offset: 0.0 };
    let samples = JointSamples {
        t: &t,
        q: &rest,
        qd: &rest,
        qdd: &rest,
        tau: &tau,
        drive,
        ..JointSamples::default()
    };
    for gap in [0.01, 0.03] {
        let through = law.through(&samples, &[gap, 0.002, 1.0, 0.0, 0.0]).expect("it gives way");
        // where it hits the other side more reaches the joint than without play
        let hit = (2005..4000).find(|&k| through.torque[k] > 0.0).expect("it hits");
        let crossed_s = t[hit] - 2.0;
        let expected = (2.0 * gap * INERTIA).sqrt();
        assert!((crossed_s / expected - 1.0).abs() < 0.1, "{gap}: {crossed_s} s, not {expected}");
        // what moved it on the way, it gives back where it hits
        assert!((through.share - 1.0).abs() < 0.02, "{gap}: {}", through.share);
        // at both sides all reaches the joint that reaches it without play
        let [before, after] = [1990, 3990].map(|k: usize| through.torque[k]);
        assert!(before.abs() < 1e-3 && after.abs() < 1e-3, "{before} {after}");
    }
}

/// In its play a rotor is dragged along by the joint: I v' = tau - c I v from one side, so that the
/// joint, which stands, feels c I v. Friction that brakes the joint does not brake the rotor.
#[test]
fn drag_is_passed_on_within_the_play_and_friction_of_the_joint_stays_there() {
    let law = law("play");
    let t = times(4000);
    let rest = vec![0.0; t.len()];
    let tau: Vec<f64> = t.iter().map(|&t| if t < 2.0 { 1.0 } else { -1.0 }).collect();
    let (gap, drag) = (0.05, 20.0);
    let of = |coulomb: f64, values: [f64; 5]| {
        let drive = Drive { inertia: INERTIA, viscous: 0.0, coulomb, offset: 0.0 };
        let [q, qd, qdd] = [rest.as_slice(); 3];
        let samples = JointSamples { t: &t, q, qd, qdd, tau: &tau, drive, ..Default::default() };
        law.through(&samples, &values).expect("it gives way").torque
    };
    let found = of(0.0, [gap, 0.002, 1.0, drag, 0.0]);
    // a stiff transmission passes all of -1 on, so that 1 + found is c I v, with v' = 1 / I - c v
    let late = |torque: &[f64]| (2010..4000).find(|&k| torque[k] > 0.0).expect("it hits");
    let passed = |k: usize| 1.0 + found[k];
    for k in (2030..late(&found) - 20).step_by(5) {
        let slope = (passed(k + 5) - passed(k)) / (t[k + 5] - t[k]);
        let expected = drag * (1.0 - 0.5 * (passed(k) + passed(k + 5)));
        assert!((slope - expected).abs() < 0.02 * drag, "{}: {slope} is not {expected}", t[k]);
    }
    assert!(passed(late(&found) - 20) > 0.5, "{}", passed(late(&found) - 20));
    let [own, joint] = [0.0, 1.0].map(|share| of(0.4, [gap, 0.002, 1.0, drag, share]));
    assert!(late(&own) > late(&joint) + 5, "{} {}", late(&own), late(&joint));
    assert_eq!(late(&joint), late(&found));
}

/// Where friction is all of the drive or all of the joint, torques have the slope that they have
/// beside it.
#[test]
fn slopes_by_the_share_of_friction_are_finite_at_its_bounds() {
    let t = times(2000);
    let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { t.iter().map(|&t| f(t)).collect() };
    let (position, rate) = (of(&|t| 0.2 * (5.0 * t).sin()), of(&|t| (5.0 * t).cos()));
    let acceleration = of(&|t| -5.0 * (5.0 * t).sin());
    let tau = of(&|t| 0.8 * (5.0 * t).cos() - 0.3 * (5.0 * t).sin());
    let samples = JointSamples {
        t: &t,
        q: &position,
        qd: &rate,
        qdd: &acceleration,
        tau: &tau,
        drive: Drive { inertia: INERTIA, viscous: 0.5, coulomb: 0.0, offset: 0.0 },
        ..JointSamples::default()
    };
    let slope = |name: &str, values: &[f64]| {
        law(name).gradient(&samples, values).pop().expect("a column for each parameter")
    };
    let size = |column: &[f64]| column.iter().map(|x| x * x).sum::<f64>().sqrt();
    for (bound, inner) in [(0.0, 0.05), (1.0, 0.95)] {
        let [bound, inner] =
            [bound, inner].map(|share| slope("joint_elasticity", &[0.01, 0.3, share]));
        let apart: Vec<f64> = bound.iter().zip(&inner).map(|(a, b)| a - b).collect();
        assert!(size(&apart) < 0.1 * size(&inner), "{} {}", size(&apart), size(&inner));
    }
    // impacts of a play are at other times for another share
    for share in [0.0, 1.0] {
        let slope = size(&slope("play", &[0.02, 0.004, 0.5, 5.0, share]));
        assert!(slope.is_finite() && slope > 0.0, "{slope}");
    }
}
