//! TUlip's step of thesis 2.3.5, planned and made, in both schemes of time stepping.

use denavit_plants::shipped;
use denavit_plants::{Override, Plant, tulip};
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Breakdown, Stop};
use denavit_walk::weight_shift_step::{Gait, GaitError, WeightShiftStep, plan};

pub(super) fn robot(roll_stiffness: f64) -> Box<dyn Plant> {
    let set =
        |side: &str| Override { parameter: format!("ks_{side}_ankle_x"), value: roll_stiffness };
    tulip(&[set("right"), set("left")]).expect("parameters of the generated plant")
}

pub(super) fn gait() -> Gait {
    plan(robot(300.0).as_mut(), &WeightShiftStep::default()).expect("the step is within reach")
}

fn points(plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
    let mut positions = vec![0.0; 24];
    plant.contact_positions(q, &mut positions);
    positions
}

#[test]
fn postures_meet_their_conditions() {
    let (mut plant, gait) = (robot(300.0), gait());
    let first = points(plant.as_mut(), &gait.postures[0]);
    let sole = [0.5 * (first[0] + first[6]), 0.5 * (first[1] + first[4])];
    for (t_s, q) in gait.times_s.iter().zip(&gait.postures) {
        let now = points(plant.as_mut(), q);
        for (a, b) in now.iter().zip(&first).take(12) {
            assert!((a - b).abs() < 1e-9, "the right foot stands, at {t_s} s");
        }
        assert!(now.iter().skip(2).step_by(3).all(|z| *z > -1e-9), "nothing sinks, at {t_s} s");
        let center = plant.center_of_mass(q);
        if *t_s <= 4.4 {
            let off = [center[0] - sole[0], center[1] - sole[1] - 0.01];
            assert!(off.iter().all(|distance| distance.abs() < 1e-9), "the weight, at {t_s} s");
        }
        assert!(q[3].abs() + q[5].abs() + q[11].abs() < 1e-9, "upright but for its roll");
    }
    let last = points(plant.as_mut(), gait.postures.last().unwrap());
    assert!((last[12] - first[12] - 0.10).abs() < 1e-9, "the left foot is a step ahead");
    // Walking.md 3: the torso must lean by 26.6 degrees, with other lengths.
    let lean = gait.postures[0][4].to_degrees();
    assert!((20.0..35.0).contains(&lean), "{lean}");
}

/// The shipped scenario, with these entries in place of its own.
fn scenario(changes: &[(&str, &str)]) -> Scenario {
    let mut text = shipped::find_scenario("tulip_step").unwrap().text.to_owned();
    for (own, new) in changes {
        assert!(text.contains(own), "{own}");
        text = text.replace(own, new);
    }
    let load = |name: &str| {
        let model = shipped::find(name).ok_or("no such model")?;
        Ok(model.text.as_bytes().to_vec())
    };
    denavit_walk::read_scenario("step.json", text.as_bytes(), &load)
        .unwrap_or_else(|error| panic!("{error}"))
}

const STIFFNESS: &str = "_ankle_x\": 300";

/// How a run of the step ended.
#[derive(Debug)]
struct Outcome {
    stop: Stop,
    end_s: f64,
    /// How far the left toe went [m].
    forward_m: f64,
    /// Rows from 2 to 3 s in which the left foot carried nothing.
    swinging: usize,
    /// Rows of these in which the zero moment point was not on the right sole.
    outside: usize,
    broken: Vec<(&'static str, f64, f64)>,
}

fn make_step(changes: &[(&str, &str)]) -> Outcome {
    let mut scenario = scenario(changes);
    let start = points(scenario.plant.as_mut(), &scenario.initial.q);
    let run = scenario.run().unwrap();
    let column = |name: &str| run.log.column(name).unwrap_or_else(|| panic!("{name}"));
    let parts = ["toe_inner", "toe_outer", "heel_inner", "heel_outer"];
    let left = parts.map(|part| column(&format!("f_left_{part}_z")));
    let (times, zmp) = (column("t"), column("zmp_y"));
    let edges = [start[1].min(start[4]) - 2e-3, start[1].max(start[4]) + 2e-3];
    let (mut swinging, mut outside) = (0, 0);
    for row in (0..times.len()).filter(|row| (2.0..3.0).contains(&times[*row])) {
        if left.iter().all(|force| force[row] == 0.0) {
            swinging += 1;
            outside += usize::from(!(edges[0]..edges[1]).contains(&zmp[row]));
        }
    }
    let end = points(scenario.plant.as_mut(), &run.end.q);
    Outcome {
        broken: scenario.broken(&run),
        stop: run.stop,
        end_s: run.end.t_s,
        forward_m: end[12] - start[12],
        swinging,
        outside,
    }
}

/// The forces of the log carry the weight in the end; what audits miss is of the order of the step.
#[test]
fn a_run_of_the_step_is_logged_and_audited() {
    let audits = ["0.001", "0.0005"].map(|step| {
        let step = format!("\"step_s\": {step}");
        let mut scenario = scenario(&[("\"step_s\": 0.001", &step)]);
        let run = scenario.run().unwrap();
        assert_eq!((&run.stop, run.log.len()), (&Stop::End, 741));
        let parts = ["toe_inner", "toe_outer", "heel_inner", "heel_outer"];
        let names =
            parts.iter().flat_map(|part| ["right", "left"].map(|s| format!("f_{s}_{part}_z")));
        let forces = names.map(|name| run.log.column(&name).expect("a contact"));
        let last: f64 = forces.map(|column| column[740]).sum();
        assert!((last - 25.29 * 9.81).abs() < 2.0, "in the end it stands: {last} N");
        run.audit
    });
    let [coarse, fine] = audits;
    for (of, coarse, fine) in [
        ("energy", coarse.energy_j, fine.energy_j),
        ("force", coarse.force_n, fine.force_n),
        ("zero moment point", coarse.zmp_m, fine.zmp_m),
        ("penetration", coarse.penetration_m, fine.penetration_m),
    ] {
        assert!(fine < 0.75 * coarse, "{of} is of first order: {coarse}, {fine}");
    }
}

const ANITESCU: (&str, &str) = ("\"moreau\"", "\"anitescu\"");

#[test]
fn the_step_is_completed_with_stiff_and_with_actuated_rolls() {
    let stiffer = (STIFFNESS, "_ankle_x\": 600");
    let actuated = ("\"actuates_rolls\": false", "\"actuates_rolls\": true");
    for changes in
        [&[][..], &[stiffer], &[actuated], &[ANITESCU], &[ANITESCU, stiffer], &[ANITESCU, actuated]]
    {
        let outcome = make_step(changes);
        assert_eq!(outcome.stop, Stop::End, "{changes:?}: {outcome:?}");
        assert!((outcome.forward_m - 0.10).abs() < 0.02, "{changes:?}: {outcome:?}");
        assert!(outcome.swinging > 60 && outcome.outside == 0, "{changes:?}: {outcome:?}");
        assert!(outcome.broken.is_empty(), "{changes:?}: {outcome:?}");
    }
}

/// Without stiffness a roll is an inverted pendulum that nothing holds; below m G h_com, about
/// 160 N m/rad, too.
#[test]
fn it_falls_without_stiffness() {
    for stiffness in ["0", "100"] {
        let soft = format!("_ankle_x\": {stiffness}");
        for changes in [&[(STIFFNESS, soft.as_str())][..], &[(STIFFNESS, soft.as_str()), ANITESCU]]
        {
            let outcome = make_step(changes);
            // it has rolled by a quarter turn: beyond, its coordinates would say anything
            let fallen = Stop::Breakdown(Breakdown::SingularPose);
            assert_eq!(outcome.stop, fallen, "{changes:?}: {outcome:?}");
            assert!((1.1..1.6).contains(&outcome.end_s), "{changes:?}: {outcome:?}");
        }
    }
}

#[test]
fn impossible_steps_are_refused() {
    let mut plant = robot(300.0);
    let far = WeightShiftStep { length_m: 0.8, ..WeightShiftStep::default() };
    let found = plan(plant.as_mut(), &far);
    assert!(matches!(found, Err(GaitError::Posture { .. })), "{found:?}");
    let reversed = WeightShiftStep { phases_s: [1.6, 1.2, 4.4, 6.4], ..WeightShiftStep::default() };
    assert_eq!(plan(plant.as_mut(), &reversed).unwrap_err(), GaitError::Times);
}
