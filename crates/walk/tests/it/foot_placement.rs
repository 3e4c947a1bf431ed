//! Feet that are placed as the robot is pushed: the push fells the walk that is only planned, and
//! the one with this law goes on beside its plan.

use super::{assert_near, scenario};
use denavit_plants::{Plant, shipped};
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Shove, Stop};

const NAME: &str = "tulip_pushed";

/// The shipped scenario without its law: references of the same walk, planned before the run.
fn planned() -> Scenario {
    let mut scenario = scenario(NAME);
    scenario.control.planning = None;
    scenario
}

/// Middles of the soles, right and left, in the world [m].
fn soles(plant: &mut dyn Plant, q: &[f64]) -> [[f64; 2]; 2] {
    let mut positions = vec![0.0; 24];
    plant.contact_positions(q, &mut positions);
    let mean = |first: usize, axis: usize| {
        (first..first + 4).map(|point| positions[3 * point + axis]).sum::<f64>() / 4.0
    };
    [0, 4].map(|first| [0, 1].map(|axis| mean(first, axis)))
}

fn push(scenario: &mut Scenario, impulse_ns: [f64; 3], at_s: f64) {
    scenario.simulation.pushes[0].shove = Shove::Impulse(impulse_ns);
    scenario.simulation.pushes[0].at_s = at_s;
}

#[test]
fn the_push_fells_what_is_only_planned_and_a_foot_to_the_side_saves() {
    let run = planned().run().unwrap();
    assert!(matches!(run.stop, Stop::Fall(_)), "{:?}", run.stop);
    let mut unpushed = planned();
    unpushed.simulation.pushes.clear();
    let wanted = unpushed.run().unwrap();
    assert_eq!(wanted.stop, Stop::End);
    let mut scenario = scenario(NAME);
    let run = scenario.run().unwrap();
    assert_eq!(run.stop, Stop::End, "at {} s", run.end.t_s);
    assert_eq!(scenario.broken(&run), []);
    // beside the planned walk: all steps walked, farther to the left, feet side by side, at rest
    let placed = soles(scenario.plant.as_mut(), &run.end.q);
    let wanted = soles(unpushed.plant.as_mut(), &wanted.end.q);
    let beside = placed[0][1] - wanted[0][1];
    assert!((0.05..0.5).contains(&beside), "{placed:?}");
    assert_near(placed[1][1] - placed[0][1], wanted[1][1] - wanted[0][1], 5e-3);
    assert_near(placed[1][0], placed[0][0], 5e-3);
    assert!((placed[0][0] - wanted[0][0]).abs() < 0.1, "{placed:?} {wanted:?}");
    let fastest = run.end.qd.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
    assert!(fastest < 0.02, "{:?}", run.end.qd);
}

/// To the side of the foot that swings, so that it need not pass the other one: the left one of the
/// first step, the right one of the second.
#[test]
fn more_is_endured_to_either_side_and_the_same_twice() {
    for (impulse_ns, at_s) in [([0.0, 11.0, 0.0], 1.2), ([0.0, -14.0, 0.0], 1.6)] {
        let mut pushed = planned();
        push(&mut pushed, impulse_ns, at_s);
        assert!(matches!(pushed.run().unwrap().stop, Stop::Fall(_)));
        let mut ends = Vec::new();
        for _ in 0..2 {
            let mut scenario = scenario(NAME);
            push(&mut scenario, impulse_ns, at_s);
            let run = scenario.run().unwrap();
            assert_eq!(run.stop, Stop::End, "{impulse_ns:?}");
            assert_eq!(scenario.broken(&run), []);
            ends.push(run.end);
        }
        assert_eq!(ends[0], ends[1]);
    }
}

/// Nobody pushes: the law leaves the plan as it is.
#[test]
fn without_a_push_the_walk_is_the_planned_one() {
    let ends = [planned(), scenario(NAME)].map(|mut scenario| {
        scenario.simulation.pushes.clear();
        let run = scenario.run().unwrap();
        assert_eq!(run.stop, Stop::End);
        run.end.q
    });
    for (planned, placed) in ends[0].iter().zip(&ends[1]) {
        assert_near(*placed, *planned, 1e-5);
    }
}

#[test]
fn faults_of_the_law_are_told_with_those_of_the_walk() {
    let text = shipped::find_scenario(NAME).unwrap().text;
    let load = |model: &str| {
        let shipped = shipped::find_referred(model).ok_or("no such model")?;
        Ok(shipped.text.as_bytes().to_vec())
    };
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from));
        let changed = text.replace(from, to);
        denavit_walk::read_scenario(NAME, changed.as_bytes(), &load).err().unwrap().to_string()
    };
    let both = refused("\"gain\": 1,", "\"gain\": -1, \"speed\": 3,");
    assert!(both.contains("/gait/foot_placement/gain") && both.contains("`speed`"), "{both}");
    let passive = refused("\"steps\": 10,", "\"steps\": 10, \"ankle_rolls\": \"passive\",");
    assert!(passive.contains("rolls are passive"), "{passive}");
}
