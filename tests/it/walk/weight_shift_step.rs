//! TUlip's step of thesis 2.3.5, planned and made, in both schemes of time stepping.

use denavit::plants::{Override, Plant, tulip};
use denavit::simulate::time_stepping::{
    ControlledPlant, Scheme, StepLaw, StepSolver, SteppedStop, Stepping, TimeStepper,
    TimeSteppingModel, simulate_by_steps,
};
use denavit::simulate::{Control, State};
use denavit::walk::weight_shift_step::{Gait, GaitError, WeightShiftStep, plan};

const STEP_S: f64 = 1e-3;
const END_S: f64 = 7.4;
/// The rolls of the ankles, which have no motor.
const ROLLS: [usize; 2] = [11, 17];

fn robot(roll_stiffness: f64) -> Box<dyn Plant> {
    let set =
        |side: &str| Override { parameter: format!("ks_{side}_ankle_x"), value: roll_stiffness };
    tulip(&[set("right"), set("left")]).expect("parameters of the generated plant")
}

fn gait() -> Gait {
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

/// How a run of the step ended.
#[derive(Debug)]
struct Outcome {
    /// When the centre of mass was below 0.7 of its height.
    fell_s: Option<f64>,
    /// How far the left toe went [m].
    forward_m: f64,
    /// Steps between 2 and 3 s in which the left foot carried nothing.
    swinging: usize,
    /// The centre of pressure left the right sole while that stood alone.
    outside: usize,
}

fn make_step(roll_stiffness: f64, actuated: bool, scheme: Scheme) -> Outcome {
    let gait = gait();
    let reference = |joint: usize| {
        let driven = joint >= 6 && (actuated || !ROLLS.contains(&joint));
        driven.then(|| gait.reference(joint).expect("a spline"))
    };
    let control = Control::proportional((0..18).map(reference).collect(), 3000.0, 60.0);
    let mut plant = robot(roll_stiffness);
    let mut q = gait.postures[0].clone();
    let start = (plant.center_of_mass(&q)[2], points(plant.as_mut(), &q));
    let mut qd = vec![0.0; 18];
    let mut model = ControlledPlant::new(plant.as_mut(), &control);
    let laws = vec![StepLaw { friction: 0.8, restitution: 0.0 }; model.contacts()];
    let stepping = Stepping { scheme, step_s: STEP_S, solver: StepSolver::default(), laws };
    let mut stepper = TimeStepper::new(stepping, &model);
    let mut outcome = Outcome { fell_s: None, forward_m: 0.0, swinging: 0, outside: 0 };
    for step in 0..(END_S / STEP_S) as usize {
        let t_s = step as f64 * STEP_S;
        stepper.step(&mut model, t_s, &mut q, &mut qd).expect("a step");
        let plant = model.plant();
        if plant.center_of_mass(&q)[2] < 0.7 * start.0 {
            outcome.fell_s = Some(t_s);
            break;
        }
        let normal: Vec<f64> = stepper.impulses().chunks(3).map(|p| p[2]).collect();
        let (right, left): (f64, f64) = (normal[..4].iter().sum(), normal[4..].iter().sum());
        if (2.0..3.0).contains(&t_s) && left == 0.0 {
            outcome.swinging += 1;
            let at = points(plant, &q);
            let y: f64 = (0..4).map(|k| normal[k] * at[3 * k + 1]).sum::<f64>() / right;
            let edges = [start.1[1].min(start.1[4]), start.1[1].max(start.1[4])];
            let slack = 2e-3;
            let inside = y > edges[0] - slack && y < edges[1] + slack;
            outcome.outside += usize::from(right > 0.0 && !inside);
        }
    }
    outcome.forward_m = points(model.plant(), &q)[12] - start.1[12];
    outcome
}

/// Whole runs say the same, in their log and in their audits.
#[test]
fn a_run_of_the_step_is_logged_and_audited() {
    let gait = gait();
    let reference = |joint: usize| {
        let driven = joint >= 6 && !ROLLS.contains(&joint);
        driven.then(|| gait.reference(joint).expect("a spline"))
    };
    let control = Control::proportional((0..18).map(reference).collect(), 3000.0, 60.0);
    let mut errors = Vec::new();
    for step_s in [1e-3, 5e-4] {
        let mut plant = robot(300.0);
        let laws = vec![StepLaw { friction: 0.8, restitution: 0.0 }; 8];
        let (scheme, solver) = (Scheme::MoreauMidpoint, StepSolver::default());
        let stepping = Stepping { scheme, step_s, solver, laws };
        let start = State::resting(gait.postures[0].clone());
        let rows = (0.01 / step_s).round() as usize;
        let run = simulate_by_steps(plant.as_mut(), &control, &start, &stepping, END_S, rows);
        assert_eq!(run.stop, SteppedStop::End);
        assert_eq!((run.end.t_s, run.log.len()), (END_S, 741));
        let forces = ["toe_inner", "toe_outer", "heel_inner", "heel_outer"]
            .iter()
            .flat_map(|point| ["right", "left"].map(|side| format!("f_{side}_{point}_z")))
            .map(|name| run.log.column(&name).expect("a contact"));
        let last: f64 = forces.map(|column| column[740]).sum();
        assert!((last - 25.29 * 9.81).abs() < 2.0, "in the end it stands: {last} N");
        assert!(run.audit.penetration_m < 1e-3 && run.audit.friction_demand < 0.8);
        errors.push(run.audit.force_n);
    }
    assert!(errors[1] < 0.75 * errors[0], "of first order: {errors:?}");
}

const SCHEMES: [Scheme; 2] = [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m: 0.01 }];

#[test]
fn the_step_is_completed_with_stiff_and_with_actuated_rolls() {
    for scheme in SCHEMES {
        for (stiffness, actuated) in [(300.0, false), (600.0, false), (300.0, true)] {
            let outcome = make_step(stiffness, actuated, scheme);
            let what = format!("{scheme:?}, {stiffness} N m/rad, {actuated}: {outcome:?}");
            assert!(outcome.fell_s.is_none(), "{what}");
            assert!((outcome.forward_m - 0.10).abs() < 0.02, "{what}");
            assert!(outcome.swinging > 600 && outcome.outside == 0, "{what}");
        }
    }
}

/// Without stiffness a roll is an inverted pendulum that nothing holds; below m G h_com, about
/// 160 N m/rad, too.
#[test]
fn it_falls_without_stiffness() {
    for scheme in SCHEMES {
        for stiffness in [0.0, 100.0] {
            let fell = make_step(stiffness, false, scheme).fell_s;
            assert!(fell.is_some_and(|t_s| (0.5..3.0).contains(&t_s)), "{stiffness}: {fell:?}");
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
