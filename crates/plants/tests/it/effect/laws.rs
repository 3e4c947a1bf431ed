//! Laws as numbers: nothing at nominal values, derivatives against differences.

use denavit_codegen::effect::{Law, catalogue};
use denavit_codegen::model::JointKind;
use denavit_plants::effect::{Drive, EffectLaw, JointSamples, LawParameter};

/// A motion with reversals, as columns.
pub(super) struct Motion {
    /// In the order of the fields of [`JointSamples`]; `creep` is the rate.
    pub(super) columns: Vec<Vec<f64>>,
}

/// Samples of sums of sines; every quantity has the derivatives that its name says.
pub(super) fn motion(samples: usize, step_s: f64) -> Motion {
    let t: Vec<f64> = (0..samples).map(|k| k as f64 * step_s).collect();
    let of = |f: &dyn Fn(f64) -> f64| -> Vec<f64> { t.iter().map(|&t| f(t)).collect() };
    let q = of(&|t| 0.8 * (2.0 * t).sin() + 0.3 * (5.3 * t + 0.4).cos());
    let qd = of(&|t| 1.6 * (2.0 * t).cos() - 1.59 * (5.3 * t + 0.4).sin());
    let qdd = of(&|t| -3.2 * (2.0 * t).sin() - 8.427 * (5.3 * t + 0.4).cos());
    let tau_load = of(&|t| 4.0 * (3.1 * t + 0.2).sin() + 1.0);
    let tau_load_rate = of(&|t| 12.4 * (3.1 * t + 0.2).cos());
    let tau = of(&|t| 4.0 * (3.1 * t + 0.2).sin() + 1.0 + 0.5 * (2.0 * t).cos());
    let q_2 = of(&|t| 0.5 * (3.0 * t).cos());
    let qd_2 = of(&|t| -1.5 * (3.0 * t).sin());
    let qdd_2 = of(&|t| -4.5 * (3.0 * t).cos());
    let tau_load_2 = of(&|t| 2.0 * (1.7 * t).cos());
    let tau_load_rate_2 = of(&|t| -3.4 * (1.7 * t).sin());
    let [first, second] =
        [[tau_load, tau_load_rate, tau, q_2], [qd_2, qdd_2, tau_load_2, tau_load_rate_2]];
    Motion { columns: [t, q, qd, qdd].into_iter().chain(first).chain(second).collect() }
}

impl Motion {
    pub(super) fn samples(&self) -> JointSamples<'_> {
        let column = |place: usize| self.columns[place].as_slice();
        JointSamples {
            t: column(0),
            q: column(1),
            qd: column(2),
            creep: column(2),
            qdd: column(3),
            tau_load: column(4),
            tau_load_rate: column(5),
            tau: column(6),
            q_2: column(7),
            qd_2: column(8),
            qdd_2: column(9),
            tau_load_2: column(10),
            tau_load_rate_2: column(11),
            drive: Drive { inertia: 0.05, viscous: 0.1, coulomb: 0.3, offset: 0.0 },
        }
    }
}

fn laws() -> Vec<EffectLaw> {
    let of_joints =
        catalogue().iter().filter(|effect| matches!(effect.law, Law::Torque(_) | Law::Measured(_)));
    of_joints.map(|effect| EffectLaw::new(effect, JointKind::Revolute).expect("a law")).collect()
}

/// What couples two joints passively: the power that both give is what is stored or lost.
#[test]
fn both_joints_feel_what_couples_them() {
    let motion = motion(400, 0.01);
    let samples = motion.samples();
    let swapped = JointSamples {
        q: samples.q_2,
        qd: samples.qd_2,
        qdd: samples.qdd_2,
        q_2: samples.q,
        qd_2: samples.qd,
        qdd_2: samples.qdd,
        ..samples
    };
    let value = 0.7;
    let power = |name: &str| -> Vec<f64> {
        let effect = catalogue().iter().find(|effect| effect.name == name).expect("shipped");
        let law = EffectLaw::new(effect, JointKind::Revolute).expect("a law");
        let first = law.torque(&samples, &[value]);
        let second = law.on_second().expect("a pair").torque(&swapped, &[value]);
        (0..400).map(|k| first[k] * samples.qd[k] + second[k] * samples.qd_2[k]).collect()
    };
    let [stored, viscous, dry] =
        ["coupled_inertia", "coupled_viscous", "coupled_coulomb"].map(power);
    for k in 0..400 {
        let (v, w) = (samples.qd[k], samples.qd_2[k]);
        // the kinetic energy of a coupling is m qd qd_2
        let rate = value * (samples.qdd[k] * w + v * samples.qdd_2[k]);
        assert!((stored[k] - rate).abs() < 1e-12, "{k}: {} {rate}", stored[k]);
        assert!((viscous[k] - value * (v + w).powi(2)).abs() < 1e-12, "{k}");
        assert!((dry[k] - value * (v + w).abs()).abs() < 1e-12, "{k}");
    }
}

/// Nominal values, and the first start for what has none.
fn nominal(parameter: &LawParameter) -> f64 {
    parameter.nominal.unwrap_or_else(|| parameter.start[0])
}

/// Values inside the bounds at which the law is there and smooth in its parameters.
fn typical(parameter: &LawParameter) -> f64 {
    let [low, high] = parameter.bounds;
    match (parameter.start.last(), parameter.nominal) {
        (Some(&start), _) => 0.97 * start + 0.01 * start.abs(),
        (None, Some(nominal)) => (nominal + 0.137).clamp(low, high),
        (None, None) => unreachable!("a parameter without nominal value has a start"),
    }
}

#[test]
fn every_law_vanishes_at_its_nominal_values() {
    let motion = motion(400, 0.002);
    for law in laws() {
        let values: Vec<f64> = law.parameters.iter().map(nominal).collect();
        let torque = law.torque(&motion.samples(), &values);
        assert_eq!(torque.len(), 400);
        assert!(torque.iter().all(|torque| *torque == 0.0), "{}", law.name);
        let typical: Vec<f64> = law.parameters.iter().map(typical).collect();
        if law.channel().is_none_or(|channel| channel.as_str() == "tau") {
            let torque = law.torque(&motion.samples(), &typical);
            assert!(torque.iter().any(|torque| torque.abs() > 1e-4), "{} is there", law.name);
        }
        let logged = law.logged(&motion.samples(), &typical);
        assert!(logged.iter().all(|logged| logged.is_finite()), "{}", law.name);
    }
}

/// A law is of motion alone if other torques and another drive leave it as it is.
#[test]
fn laws_of_motion_do_not_notice_torques() {
    let [one, mut other] = [motion(400, 0.01), motion(400, 0.01)];
    for place in [4, 5, 6, 10, 11] {
        other.columns[place].iter_mut().for_each(|torque| *torque = 0.3 - 0.6 * *torque);
    }
    let other = JointSamples { drive: Drive::default(), ..other.samples() };
    for law in laws().iter().filter(|law| law.channel().is_none()) {
        let values: Vec<f64> = law.parameters.iter().map(typical).collect();
        let is_same = law.torque(&one.samples(), &values) == law.torque(&other, &values);
        assert_eq!(law.is_of_motion(), is_same, "{}", law.name);
    }
    assert!(laws().iter().all(|law| law.channel().is_none() || !law.is_of_motion()));
}

#[test]
fn gradients_are_those_of_differences() {
    let motion = motion(1500, 0.002);
    let samples = motion.samples();
    // impacts of a rotor have no derivative that a small difference would show
    for law in laws().into_iter().filter(|law| !law.is_transmission()) {
        let values: Vec<f64> = law.parameters.iter().map(typical).collect();
        let gradient = law.gradient(&samples, &values);
        assert_eq!(gradient.len(), values.len());
        for (parameter, column) in gradient.iter().enumerate() {
            let size = values[parameter].abs().max(1e-3);
            let step = 1e-5 * size;
            let side = |sign: f64| {
                let mut moved = values.clone();
                moved[parameter] += sign * step;
                law.torque(&samples, &moved)
            };
            let (above, below) = (side(1.0), side(-1.0));
            let largest = column.iter().fold(1e-9_f64, |most, entry| most.max(entry.abs()));
            // kinks fall between two samples, or on one: few samples may differ
            let off = (0..column.len()).filter(|&k| {
                let difference = (above[k] - below[k]) / (2.0 * step);
                (difference - column[k]).abs() > 2e-4 * largest
            });
            let name = &law.parameters[parameter].name;
            let off = off.count();
            assert!(off <= 6, "{}: d/d{name} differs in {off} samples", law.name);
        }
    }
}

#[test]
fn a_law_is_linear_in_the_parameters_that_say_so() {
    let motion = motion(200, 0.01);
    let samples = motion.samples();
    for law in laws().into_iter().filter(|law| law.channel().is_none()) {
        let values: Vec<f64> = law.parameters.iter().map(typical).collect();
        let at = |shift: f64| {
            let mut moved = values.clone();
            for (value, parameter) in moved.iter_mut().zip(&law.parameters) {
                *value += if parameter.linear { shift } else { 0.0 };
            }
            law.torque(&samples, &moved)
        };
        let [first, second, third] = [at(0.0), at(0.1), at(0.2)];
        for k in 0..first.len() {
            let bend = first[k] - 2.0 * second[k] + third[k];
            assert!(bend.abs() < 1e-9 * (1.0 + second[k].abs()), "{}", law.name);
        }
    }
}

#[test]
fn what_is_logged_is_corrected_to_the_truth() {
    let motion = motion(2000, 0.001);
    let of_logs = |law: &EffectLaw| law.channel().is_some() && !law.is_inverse();
    for law in laws().into_iter().filter(of_logs) {
        let values: Vec<f64> = law.parameters.iter().map(typical).collect();
        let samples = motion.samples();
        let logged = law.logged(&samples, &values);
        let mut seen = samples;
        let truth = match law.channel().map(|channel| channel.as_str()) {
            Some("tau") => std::mem::replace(&mut seen.tau, &logged),
            Some("q") => std::mem::replace(&mut seen.q, &logged),
            _ => std::mem::replace(&mut seen.qd, &logged),
        };
        let corrected = law.corrected(&seen, &values);
        // beyond the ends of the log nothing is known; what a clipped channel lost is lost
        let inner = 100..1900;
        let same = |a: f64, b: f64| (a - b).abs() < 1e-12 * (1.0 + a.abs());
        let clipped = |k: usize| same(logged[k], logged[k - 1]) || same(logged[k], logged[k + 1]);
        let worst = inner
            .filter(|&k| !clipped(k))
            .map(|k| (corrected[k] - truth[k]).abs())
            .fold(0.0_f64, f64::max);
        assert!(worst < 5e-3, "{}: {worst}", law.name);
    }
}

#[test]
fn a_drive_at_its_limit_gives_less_than_is_logged() {
    let motion = motion(2000, 0.001);
    let samples = motion.samples();
    let law =
        laws().into_iter().find(|law| law.name == "torque_saturation").expect("it is shipped");
    assert!(law.is_inverse());
    let largest = samples.tau.iter().fold(0.0_f64, |most, tau| most.max(tau.abs()));
    let limit = 0.6 * largest;
    let given = law.corrected(&samples, &[1.0 / limit]);
    let added = law.torque(&samples, &[1.0 / limit]);
    for ((&demanded, given), added) in samples.tau.iter().zip(&given).zip(added) {
        assert!((given - demanded.clamp(-limit, limit)).abs() < 1e-12);
        assert!((added - (demanded - given)).abs() < 1e-12);
    }
    let within: Vec<f64> = samples.tau.iter().map(|tau| 0.5 * tau).collect();
    let logged = law.logged(&JointSamples { tau: &within, ..samples }, &[1.0 / limit]);
    assert!(logged.iter().zip(&within).all(|(a, b)| (a - b).abs() < 1e-12));
}

/// A first-order lag in closed form, of each wave of the demanded torque.
#[test]
fn a_drive_that_lags_follows_its_demand() {
    let motion = motion(4000, 0.001);
    let samples = motion.samples();
    let law = laws().into_iter().find(|law| law.name == "drive_lag").expect("it is shipped");
    assert!(law.follows_log() && law.is_inverse());
    let lag = 0.03;
    let wave = |size: f64, w: f64, phase: f64, t: f64| {
        size / 1.0_f64.hypot(w * lag) * (w * t + phase - (w * lag).atan()).sin()
    };
    let half = std::f64::consts::FRAC_PI_2;
    let exact = |t: f64| 1.0 + wave(4.0, 3.1, 0.2, t) + wave(0.5, 2.0, half, t);
    let given = law.corrected(&samples, &[lag]);
    let added = law.torque(&samples, &[lag]);
    // the start is forgotten after some lags
    for k in 400..4000 {
        assert!((given[k] - exact(samples.t[k])).abs() < 1e-4, "{k}");
        assert!((added[k] - (samples.tau[k] - given[k])).abs() < 1e-12);
    }
    let back = law.logged(&JointSamples { tau: &given, ..samples }, &[lag]);
    assert!((400..3999).all(|k| (back[k] - samples.tau[k]).abs() < 1e-4));
    let gain = law.gain(3.1 / std::f64::consts::TAU, &[lag]);
    assert!((gain.sqrt() * 1.0_f64.hypot(3.1 * lag) - 1.0).abs() < 1e-12);
}
