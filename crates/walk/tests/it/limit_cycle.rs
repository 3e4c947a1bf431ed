//! Limit cycles that are designed from straight legs, and walk.

use denavit_plants::shipped::{find, find_gait};
use denavit_plants::{Plant, planar_biped};
use denavit_simulate::Stop;
use denavit_walk::gait_file::{GaitKind, read_gait};
use denavit_walk::optimal::{
    CostKind, LimitCycle, LimitCycleProblem, ScenarioHead, StepLimits, design, scenario_text,
};

fn biped() -> Box<dyn Plant> {
    planar_biped(&[]).expect("the shipped biped")
}

fn text_of(gait: &LimitCycle, plant: &dyn Plant, steps: usize) -> String {
    let head = ScenarioHead {
        name: "designed",
        description: "a \"designed\" gait",
        source: "test",
        model: "planar_biped",
        parameters: &[],
        steps,
    };
    scenario_text(gait, plant.model(), &head)
}

/// Torque squared at 0.687 m/s: the first stage of every design.
#[test]
fn a_cycle_from_straight_legs_walks_and_its_scenario_too() {
    let mut plant = biped();
    let problem = LimitCycleProblem {
        limits: StepLimits { speed_m_s: 0.687, ..StepLimits::default() },
        cost: CostKind::TorqueSquared,
        steps: 20,
        ..LimitCycleProblem::default()
    };
    let gait = design(plant.as_mut(), &problem).expect("a gait");
    assert!(gait.stages.iter().all(|stage| stage.violation < 1e-4));
    assert!(gait.cycle.largest_multiplier() < 0.8);
    assert!(gait.cycle.residual < 1e-5);
    assert_eq!((gait.walk.run.stop.clone(), gait.walk.steps), (Stop::End, 20));
    // the hand-made cycle: 0.583, and 1818 N^2 m s
    assert!(gait.walk.cost_of_transport < 0.4, "{}", gait.walk.cost_of_transport);
    assert!(gait.walk.torque_squared < 900.0, "{}", gait.walk.torque_squared);
    assert!((gait.walk.speed_m_s - 0.687).abs() < 0.01, "{}", gait.walk.speed_m_s);
    // the simulator follows the plan
    let [q, ..] = gait.step.motion(gait.step.mid_swing().1).expect("a motion");
    for joint in &gait.step.legs.driven {
        let apart = (q[*joint] - gait.cycle.start.q[*joint]).abs();
        assert!(apart < 0.05, "joint {joint} is {apart} rad from the plan");
    }
    let text = text_of(&gait, plant.as_ref(), 10);
    let load = |name: &str| {
        find(name).map(|model| model.text.as_bytes().to_vec()).ok_or_else(|| name.to_owned())
    };
    let mut scenario = denavit_walk::read_scenario("designed.json", text.as_bytes(), &load)
        .expect("a sound scenario");
    assert_eq!(scenario.initial.t_s, gait.cycle.start.t_s);
    let run = scenario.run().expect("a run");
    assert_eq!(run.stop, Stop::End);
    assert!(scenario.broken(&run).is_empty(), "{:?}", scenario.broken(&run));
}

#[test]
fn a_step_longer_than_the_legs_allow_is_told_by_its_worst_constraint() {
    let mut plant = biped();
    let limits = StepLimits { speed_m_s: 0.7, step_length_m: Some(1.6), ..StepLimits::default() };
    let problem = LimitCycleProblem { limits, intervals: 10, ..LimitCycleProblem::default() };
    let error = design(plant.as_mut(), &problem).expect_err("legs are shorter");
    assert_eq!(error.kind(), denavit_walk::ErrorKind::Infeasible, "{error}");
    let violated = error.violated().expect("a constraint");
    assert!(violated.residual > 0.0 && !violated.what.is_empty());
    assert!(violated.t_s >= 0.0 && !violated.phase.is_empty());
}

#[test]
#[ignore = "takes minutes: designs with costs of transport"]
fn shipped_gaits_cost_less_than_the_hand_made_one_and_repeat_to_the_byte() {
    for (name, cost) in [("planar_biped_limit_cycle", 0.3), ("planar_biped_fast_limit_cycle", 0.5)]
    {
        let shipped = find_gait(name).expect("a shipped gait");
        let kind = read_gait(name, shipped.text.as_bytes()).expect("sound").kind;
        let GaitKind::LimitCycle(problem) = kind else { panic!("{name}") };
        let mut plant = biped();
        let gait = design(plant.as_mut(), &problem).expect("a gait");
        println!(
            "{name}: cost of transport {:.3} (plan {:.3}), largest multiplier {:.3}, {} steps",
            gait.walk.cost_of_transport,
            gait.planned_cost_of_transport,
            gait.cycle.largest_multiplier(),
            gait.walk.steps
        );
        assert!(gait.walk.cost_of_transport < cost);
        assert!(gait.cycle.largest_multiplier() < 0.8);
        assert_eq!(gait.walk.steps, 50);
        assert!((gait.walk.speed_m_s / problem.limits.speed_m_s - 1.0).abs() < 0.02);
        let again = design(biped().as_mut(), &problem).expect("a gait");
        let [first, second] = [gait, again].map(|gait| text_of(&gait, plant.as_ref(), 50));
        assert_eq!(first, second);
    }
}
