//! TUlip's step of thesis 2.3.5, as it is shipped: what its description says is what happens, in
//! both schemes.

use denavit_plants::shipped;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_simulate::{Breakdown, Run, Stop};

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
const ANITESCU: (&str, &str) = ("\"moreau\"", "\"anitescu\"");
const EVENT: (&str, &str) = ("\"scheme\": \"time_stepping\"", "\"scheme\": \"event\"");
const WEIGHT_N: f64 = 25.29 * 9.81;

/// The vertical force on a foot, row by row [N].
fn force(run: &Run, side: &str) -> Vec<f64> {
    let parts = ["toe_inner", "toe_outer", "heel_inner", "heel_outer"];
    let columns = parts.map(|part| run.log.column(&format!("f_{side}_{part}_z")).unwrap());
    (0..run.log.len()).map(|row| columns.iter().map(|column| column[row]).sum()).collect()
}

/// Middle of the left sole, x and y [m].
fn left_sole(scenario: &mut Scenario, q: &[f64]) -> [f64; 2] {
    let mut positions = vec![0.0; 24];
    scenario.plant.contact_positions(q, &mut positions);
    [0, 1].map(|axis| (4..8).map(|point| positions[3 * point + axis]).sum::<f64>() / 4.0)
}

fn assert_stepped(changes: &[(&str, &str)]) {
    let mut scenario = scenario(changes);
    let initial = scenario.initial.q.clone();
    let start = left_sole(&mut scenario, &initial);
    let run = scenario.run().unwrap();
    assert_eq!(run.stop, Stop::End, "{changes:?}: at {} s", run.end.t_s);
    assert!(scenario.broken(&run).is_empty(), "{changes:?}: {:?}", scenario.broken(&run));
    for (joint, model) in run.joints.iter().zip(&scenario.plant.model().joints) {
        let Some([low, high]) = model.position_limits else { continue };
        let [least, most] = joint.position.map(|peak| peak.value);
        assert!(low <= least && most <= high, "{changes:?}: {} {least} {most}", model.name);
    }
    let end = left_sole(&mut scenario, &run.end.q);
    assert!((end[0] - start[0] - 0.1).abs() < 1e-3, "{changes:?}: {start:?} {end:?}");
    let (left, times) = (force(&run, "left"), run.log.column("t").unwrap());
    let zmp = run.log.column("zmp_y").unwrap();
    let lean = run.log.column("q_base_roll").unwrap();
    let largest = lean.iter().fold(0.0_f64, |most, roll| most.max(roll.abs()));
    assert!((0.4..0.6).contains(&largest), "{changes:?}: {largest}");
    for (row, t_s) in times.iter().enumerate() {
        let is_in_air = left[row] < 1e-9;
        // it leaves and lands within a tenth of a second of what is described
        if (1.8..2.9).contains(t_s) {
            assert!(is_in_air, "{changes:?}: at {t_s} s");
        } else if (0.1..1.6).contains(t_s) || *t_s > 3.1 {
            assert!(!is_in_air, "{changes:?}: at {t_s} s");
        }
        // it carries the weight: inner and outer edge of its sole
        if *t_s >= 6.4 {
            let range = end[1] - 0.075..end[1] + 0.075;
            assert!(range.contains(&zmp[row]), "{changes:?}: {} at {t_s} s", zmp[row]);
            assert!(left[row] > 0.6 * WEIGHT_N, "{changes:?}: {} N at {t_s} s", left[row]);
        }
    }
}

#[test]
fn what_is_described_happens_in_time_stepping() {
    assert_stepped(&[]);
    assert_stepped(&[ANITESCU]);
}

#[test]
fn what_is_described_happens_from_event_to_event() {
    assert_stepped(&[EVENT]);
}

/// While one foot stands the robot is an inverted pendulum on its ankle roll: that stands on a
/// spring stiffer than m g h, 149 N m/rad for the centre of mass at 0.6 m.
#[test]
fn it_needs_springs_stiffer_than_weight_times_height() {
    let needed = WEIGHT_N * 0.6;
    assert!((100.0..200.0).contains(&needed));
    for scheme in [&[][..], &[EVENT]] {
        for (stiffness, stands) in [("0", false), ("100", false), ("200", true)] {
            let other = format!("_ankle_x\": {stiffness}");
            let changes = [&[(STIFFNESS, other.as_str())], scheme].concat();
            let run = scenario(&changes).run().unwrap();
            // it has rolled by a quarter turn: beyond, its coordinates would say anything
            let fallen = Stop::Breakdown(Breakdown::SingularPose);
            let expected = if stands { Stop::End } else { fallen };
            assert_eq!(run.stop, expected, "{changes:?}: at {} s", run.end.t_s);
        }
    }
}

/// The forces of the log carry the weight in the end; what audits miss is of the order of the step.
#[test]
fn a_run_of_the_step_is_logged_and_audited() {
    let audits = ["0.001", "0.0005"].map(|step| {
        let step = format!("\"step_s\": {step}");
        let mut scenario = scenario(&[("\"step_s\": 0.001", &step)]);
        assert_eq!(scenario.scheme, RunScheme::TimeStepping);
        let run = scenario.run().unwrap();
        assert_eq!((&run.stop, run.log.len()), (&Stop::End, 741));
        let last = force(&run, "left")[740] + force(&run, "right")[740];
        assert!((last - WEIGHT_N).abs() < 5.0, "in the end it stands: {last} N");
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
