//! Scenarios by time stepping: within their tolerances, and as the event-driven scheme has them.

use denavit_plants::shipped;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_simulate::{Run, Stop};
use denavit_walk::read_scenario;

fn load(name: &str) -> Result<Vec<u8>, String> {
    let found = shipped::find_referred(name);
    found.map(|model| model.text.as_bytes().to_vec()).ok_or_else(|| "no such model".to_owned())
}

fn open(name: &str, scheme: RunScheme) -> Scenario {
    let shipped = shipped::find_scenario(name).unwrap();
    let read = read_scenario(name, shipped.text.as_bytes(), &load);
    let mut scenario = read.unwrap_or_else(|error| panic!("{error}"));
    scenario.scheme = scheme;
    scenario
}

fn run(scenario: &mut Scenario) -> Run {
    let run = fallen_or_not(scenario);
    assert_eq!(run.stop, Stop::End, "{}", scenario.name);
    run
}

fn fallen_or_not(scenario: &mut Scenario) -> Run {
    let run = scenario.run().unwrap_or_else(|error| panic!("{error}"));
    let broken = scenario.broken(&run);
    assert!(broken.is_empty(), "{}: {broken:?}", scenario.name);
    run
}

/// Scenarios with pushes, or with feet that may pass through the ground.
const EVENTS_ONLY: [&str; 5] = [
    "compass_gait",
    "planar_biped_capture_step",
    "planar_biped_lunge",
    "planar_biped_pushed",
    "tulip_pushed",
];

#[test]
fn every_scenario_runs_by_steps_within_its_tolerances() {
    for shipped in shipped::SCENARIOS {
        let mut scenario = open(shipped.name, RunScheme::TimeStepping);
        if EVENTS_ONLY.contains(&shipped.name) {
            let refused = scenario.run().expect_err("has what only events can do").to_string();
            assert!(refused.contains("only the event-driven scheme has them"), "{refused}");
        } else {
            let run = fallen_or_not(&mut scenario);
            if run.stop != Stop::End {
                let exact = fallen_or_not(&mut open(shipped.name, RunScheme::Event));
                assert_eq!(run.stop, exact.stop, "{}", shipped.name);
                let apart_s = (run.end.t_s - exact.end.t_s).abs();
                assert!(apart_s < 2e-2, "{}: {apart_s} s", shipped.name);
            }
        }
    }
}

/// What audits miss is of the order of the step: halved with it where motion is smooth.
#[test]
fn audits_miss_half_with_half_the_step() {
    let energy = |step_s: f64| {
        let mut scenario = open("planar_biped_zmp_gait", RunScheme::TimeStepping);
        scenario.simulation.end_s = 2.4;
        scenario.set_step_s(step_s);
        run(&mut scenario).audit
    };
    let [coarse, fine] = [1e-3, 2.5e-4].map(energy);
    for (of, coarse, fine) in [
        ("energy", coarse.energy_j, fine.energy_j),
        ("force", coarse.force_n, fine.force_n),
        ("penetration", coarse.penetration_m, fine.penetration_m),
    ] {
        assert!(fine < 0.4 * coarse, "{of}: {coarse}, {fine}");
    }
}

/// Motors, springs, Coulomb friction, sampled control with encoders: the drives of a leg move as
/// they do in the event-driven scheme.
#[test]
fn drives_and_sampled_control_are_those_of_the_event_driven_scheme() {
    let exact = run(&mut open("tulip_leg_tracking", RunScheme::Event));
    let apart = |step_s: f64| {
        let mut scenario = open("tulip_leg_tracking", RunScheme::TimeStepping);
        scenario.set_step_s(step_s);
        let run = run(&mut scenario);
        assert_eq!(run.end.motor.len(), exact.end.motor.len());
        let columns = exact.log.columns.iter().filter(|name| name.starts_with("q_"));
        let mut worst = 0.0_f64;
        for name in columns {
            let [a, b] = [&run, &exact].map(|run| run.log.column(name).unwrap());
            worst = a.iter().zip(b).fold(worst, |worst, (a, b)| worst.max((a - b).abs()));
        }
        worst
    };
    let [coarse, fine] = [1e-3, 1.25e-4].map(apart);
    assert!(coarse < 5e-3 && fine < 1e-3, "{coarse} {fine}");
}
