//! Standing on held joints (2000 N m/rad, 40 N m s/rad): what a push leaves, a rotation of the
//! whole body about its ankles, is borne at 0.4 rad/s and fells at 0.6 rad/s, at a time that three
//! laws of contact agree about.

use super::scenario;
use denavit_simulate::contact::Friction;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_simulate::{Run, Stop};

/// Laws of contact: no slip with friction where it has no answer, friction alone, steps of 0.5 ms.
const LAWS: [fn(&mut Scenario); 3] = [
    |scenario| scenario.simulation.touching.fallback_friction = Some(0.8),
    |scenario| scenario.simulation.friction = Friction::Coulomb(0.8),
    |scenario| {
        scenario.scheme = RunScheme::TimeStepping;
        scenario.set_step_s(5e-4);
    },
];

/// The shipped robot that stands on held joints, turning about its ankles.
fn turning(rate_rad_s: f64, law: fn(&mut Scenario)) -> Run {
    let mut scenario = scenario("planar_biped_pushed");
    scenario.simulation.pushes.clear();
    let model = scenario.plant.model().clone();
    let mut transforms = vec![0.0; 12 * model.links.len()];
    scenario.plant.link_transforms(&scenario.initial.q, &mut transforms);
    let place = |link: &str, axis: usize| {
        let link = model.links.iter().position(|known| known == link).unwrap();
        transforms[12 * link + 4 * axis + 3]
    };
    let arm = |axis: usize| place("base_pitch", axis) - place("right_ankle", axis);
    for (joint, rate) in [
        ("base_x", rate_rad_s * arm(2)),
        ("base_z", -rate_rad_s * arm(0)),
        ("base_pitch", rate_rad_s),
        ("right_ankle", -rate_rad_s),
        ("left_ankle", -rate_rad_s),
    ] {
        scenario.initial.qd[model.find_joint(joint).unwrap()] = rate;
    }
    law(&mut scenario);
    scenario.run().unwrap()
}

#[test]
fn a_slow_turn_about_the_ankles_is_borne() {
    for law in LAWS {
        let run = turning(0.4, law);
        assert_eq!(run.stop, Stop::End);
        let fastest = run.end.qd.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        assert!(fastest < 0.01, "it still moves: {:?}", run.end.qd);
    }
}

#[test]
fn a_faster_turn_fells_at_the_same_time_under_three_laws_of_contact() {
    let times = LAWS.map(|law| {
        let run = turning(0.6, law);
        assert!(matches!(run.stop, Stop::Fall(_)), "{:?}", run.stop);
        run.end.t_s
    });
    let [least, most] = [f64::min, f64::max].map(|of| times.into_iter().reduce(of).unwrap());
    assert!(most - least < 6e-3, "{times:?}");
}
