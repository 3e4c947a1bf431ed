//! TUlip's step of thesis 2.3.5, from event to event: rigid contacts with Coulomb friction, eight
//! points of two feet, audited.

use super::weight_shift_step::{gait, robot};
use denavit_simulate::contact::Friction;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{Breakdown, Control, Run, Simulation, State, Stop, Tolerances, simulate};

const END_S: f64 = 7.4;
/// The rolls of the ankles, which have no motor.
const ROLLS: [usize; 2] = [11, 17];

fn make_step(roll_stiffness: f64, actuated: bool) -> Run {
    let gait = gait();
    let reference = |joint: usize| {
        let driven = joint >= 6 && (actuated || !ROLLS.contains(&joint));
        driven.then(|| gait.reference(joint).expect("a spline"))
    };
    let control = Control::proportional((0..18).map(reference).collect(), 3000.0, 60.0);
    // rates, and with them the speeds of closed contacts, are off by about this
    let accuracy = Accuracy { relative: 2e-9, absolute: 2e-10, max_step_s: 0.02 };
    let simulation = Simulation {
        end_s: END_S,
        method: Method::Radau(accuracy),
        friction: Friction::Coulomb(0.8),
        ..Simulation::default()
    };
    let start = State::resting(gait.postures[0].clone());
    simulate(robot(roll_stiffness).as_mut(), &control, &start, &simulation).expect("a start")
}

/// What the laws of mechanics allow (walking.md's acceptance checks).
fn assert_audited(run: &Run) {
    let tolerances = Tolerances {
        energy_j: 1e-6,
        momentum_ns: 1e-12,
        penetration_m: 1e-8,
        complementarity_nm: 1e-6,
        adhesion_n: 1e-6,
        separation_m_s: 1e-8,
        zmp_m: 1e-9,
        force_n: 1e-9,
        ..Tolerances::default()
    };
    let broken = run.audit.broken(&tolerances);
    assert!(broken.is_empty(), "{broken:?}");
    assert!(run.audit.impact_gain_j < 1e-9, "{:?}", run.audit);
}

/// Forward way of the left foot, and the vertical force on each foot in the end.
fn outcome(run: &Run) -> (f64, [f64; 2]) {
    let toe = |q: &[f64]| {
        let mut positions = vec![0.0; 24];
        robot(300.0).contact_positions(q, &mut positions);
        positions[12]
    };
    let forward = toe(&run.end.q) - toe(&gait().postures[0]);
    let last = run.log.len() - 1;
    let force = |side: &str| -> f64 {
        ["toe_inner", "toe_outer", "heel_inner", "heel_outer"]
            .map(|point| run.log.column(&format!("f_{side}_{point}_z")).expect("a contact")[last])
            .iter()
            .sum()
    };
    (forward, [force("right"), force("left")])
}

fn assert_stepped(run: &Run) {
    assert_eq!(run.stop, Stop::End);
    assert_audited(run);
    let (forward, [right, left]) = outcome(run);
    assert!((forward - 0.10).abs() < 0.01, "{forward}");
    assert!((right + left - 25.29 * 9.81).abs() < 2.0, "{right} + {left}");
    // a corner of a flat foot may be free of force, and count as open, without leaving the ground
    let mut positions = vec![0.0; 24];
    robot(300.0).contact_positions(&run.end.q, &mut positions);
    let heights = positions.chunks_exact(3).map(|point| point[2].abs());
    assert!(heights.fold(0.0, f64::max) < 1e-8, "both feet flat: {positions:?}");
    let carried = run.log.column("f_left_toe_inner_z").expect("a contact");
    let swings = carried[190..300].iter().all(|force| *force == 0.0);
    assert!(swings, "the left foot is off the ground");
}

#[test]
fn the_step_is_completed_on_stiff_rolls() {
    assert_stepped(&make_step(300.0, false));
}

#[test]
fn the_step_is_completed_on_stiffer_rolls() {
    assert_stepped(&make_step(600.0, false));
}

#[test]
fn the_step_is_completed_with_actuated_rolls() {
    assert_stepped(&make_step(300.0, true));
}

#[test]
fn it_falls_without_stiffness() {
    let run = make_step(0.0, false);
    assert_eq!(run.stop, Stop::Breakdown(Breakdown::SingularPose), "at {}", run.end.t_s);
    // it lies on its side; time stepping has it below 0.7 of its height at 1.08 s
    assert!((1.1..1.25).contains(&run.end.t_s), "{}", run.end.t_s);
    assert!(run.audit.energy_j < 1e-5 && run.audit.penetration_m < 1e-8, "{:?}", run.audit);
}
