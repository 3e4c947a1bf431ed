//! Walks in space: knots against forward kinematics; and what is planned is walked, from event to
//! event and by time stepping.

use super::assert_near;
use denavit_codegen::model;
use denavit_plants::{Override, Plant, plant_of, shipped};
use denavit_simulate::Stop;
use denavit_simulate::scenario::{RunScheme, Scenario};
use denavit_walk::ErrorKind;
use denavit_walk::ScenarioHead;
use denavit_walk::balance::{Criterion, course_of_scenario};
use denavit_walk::gait_file::{GaitKind, read_gait};
use denavit_walk::gait_plan::{
    AnkleRolls, DivergentComponentProblem, Ending, Footstep, GaitPlan, Side,
    plan_divergent_component,
};

fn tulip(parameters: &[Override]) -> Box<dyn Plant> {
    let text = shipped::find("tulip").unwrap().text;
    plant_of(&model::read("tulip", text.as_bytes()).unwrap(), parameters).unwrap()
}

fn problem(name: &str) -> DivergentComponentProblem {
    let text = shipped::find_gait(name).unwrap().text;
    match read_gait(name, text.as_bytes()).unwrap().kind {
        GaitKind::DivergentComponent(problem) => problem,
        other => panic!("{other:?}"),
    }
}

fn planned(problem: &DivergentComponentProblem) -> GaitPlan {
    plan_divergent_component(tulip(&[]).as_mut(), problem).unwrap_or_else(|e| panic!("{e}"))
}

/// The scenario of a plan, written and read back.
fn scenario(plan: &GaitPlan, parameters: &[Override]) -> Scenario {
    let head = ScenarioHead {
        name: "planned",
        description: "",
        source: "",
        model: "tulip",
        parameters,
        steps: plan.steps,
    };
    let text = plan.scenario_text(tulip(&[]).model(), &head);
    let load = |model: &str| {
        let shipped = shipped::find_referred(model).ok_or("no such model")?;
        Ok(shipped.text.as_bytes().to_vec())
    };
    denavit_walk::read_scenario("planned", text.as_bytes(), &load)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// Middles of the soles, right and left, in the world [m].
fn soles(plant: &mut dyn Plant, q: &[f64]) -> [[f64; 3]; 2] {
    let mut positions = vec![0.0; 24];
    plant.contact_positions(q, &mut positions);
    [0, 4].map(|first| {
        [0, 1, 2].map(|axis| {
            (first..first + 4).map(|point| positions[3 * point + axis]).sum::<f64>() / 4.0
        })
    })
}

fn coordinate(name: &str) -> usize {
    tulip(&[]).model().find_joint(name).unwrap()
}

/// Walks a plan in both schemes: no fall, audits kept, joints within limits, both feet where they
/// were planned. Answers the run's last coordinates from event to event.
fn walk(plan: &GaitPlan, parameters: &[Override]) -> Vec<f64> {
    let mut scenario = scenario(plan, parameters);
    let last = &plan.knots.last().unwrap().q;
    let mut ends = Vec::new();
    for scheme in [RunScheme::Event, RunScheme::TimeStepping] {
        scenario.scheme = scheme;
        let run = scenario.run().unwrap();
        assert_eq!(run.stop, Stop::End, "{scheme:?} at {} s", run.end.t_s);
        assert!(scenario.broken(&run).is_empty(), "{scheme:?}: {:?}", scenario.broken(&run));
        for (joint, model) in run.joints.iter().zip(&scenario.plant.model().joints) {
            let Some([low, high]) = model.position_limits else { continue };
            let [least, most] = joint.position.map(|peak| peak.value);
            assert!(low <= least && most <= high, "{}: {least} {most}", model.name);
        }
        let placed = soles(scenario.plant.as_mut(), &run.end.q);
        let wanted = soles(scenario.plant.as_mut(), last);
        for (placed, wanted) in placed.iter().flatten().zip(wanted.iter().flatten()) {
            assert_near(*placed, *wanted, 2e-3);
        }
        ends.push(run.end.q);
    }
    ends.swap_remove(0)
}

/// The least margin of the exact zero moment point over a whole run, from event to event [m].
fn margin_m(plan: &GaitPlan) -> f64 {
    let course = course_of_scenario(&mut scenario(plan, &[]), 1e-3, true).unwrap();
    course.margins(Criterion::ZeroMoment).unwrap().least_m
}

#[test]
fn ten_steps_are_walked_with_the_zmp_well_inside() {
    let plan = planned(&problem("tulip_walk"));
    assert_eq!((plan.steps, plan.step_s), (10, 0.8));
    // half of a sole is 75 mm wide
    assert!(plan.least_pressure().unwrap().pressure_margin_m.unwrap() > 0.07);
    walk(&plan, &[]);
    let margin = margin_m(&plan);
    assert!(margin > 0.06, "{margin}");
}

#[test]
fn thirty_degrees_are_turned() {
    let plan = planned(&problem("tulip_turn"));
    let end = walk(&plan, &[]);
    assert_near(end[coordinate("base_yaw")], 30.0_f64.to_radians(), 1e-3);
    let margin = margin_m(&plan);
    assert!(margin > 0.06, "{margin}");
}

/// Steps to the side, a wider stance, a turn to the right with the right foot first.
#[test]
fn feet_are_placed_one_by_one() {
    let step =
        |forward_m, left_m, turn_rad, width_m| Footstep { forward_m, left_m, turn_rad, width_m };
    let wide = Some(0.24);
    let footsteps = vec![
        step(0.0, -0.04, 0.0, wide),
        step(0.0, 0.0, 0.0, wide),
        step(0.05, 0.0, -0.1, wide),
        step(0.05, 0.0, 0.0, None),
    ];
    let problem =
        DivergentComponentProblem { footsteps, first_swing: Side::Right, ..problem("tulip_walk") };
    let plan = planned(&problem);
    let mut plant = tulip(&[]);
    let own = {
        let [right, left] = soles(plant.as_mut(), &[0.0; 18]);
        left[1] - right[1]
    };
    // by the rules of the file: the middle moves, turns, and the feet stand beside it
    let at = |name: &str| {
        let knot = plan.knots.iter().find(|knot| knot.name == name).unwrap();
        soles(tulip(&[]).as_mut(), &knot.q)
    };
    let [right, left] = at("step 1, double support");
    assert_near(right[1], -0.04 - 0.12, 1e-9);
    assert_near(left[1], 0.5 * own, 1e-9);
    let [_, left] = at("step 2, double support");
    assert_near(left[1], -0.04 + 0.12, 1e-9);
    let end = walk(&plan, &[]);
    assert_near(end[coordinate("base_yaw")], -0.1, 1e-3);
    let [right, left] = at("stop");
    assert_near((left[0] - right[0]).hypot(left[1] - right[1]), own, 1e-9);
}

/// By forward kinematics, whatever the planner says: soles level, one on the ground, height
/// and torso as asked for.
#[test]
fn knots_meet_their_conditions() {
    let (mut plant, problem) = (tulip(&[]), problem("tulip_turn"));
    let plan = planned(&problem);
    let [roll, pitch] = ["base_roll", "base_pitch"].map(coordinate);
    let mut positions = vec![0.0; 24];
    for knot in &plan.knots {
        assert!(knot.residual < if knot.is_solved { 1e-10 } else { 1e-4 }, "{knot:?}");
        if !knot.is_solved {
            continue;
        }
        plant.contact_positions(&knot.q, &mut positions);
        let heights = |first: usize| (first..first + 4).map(|point| positions[3 * point + 2]);
        for first in [0, 4] {
            let lowest = heights(first).fold(f64::INFINITY, f64::min);
            let highest = heights(first).fold(f64::NEG_INFINITY, f64::max);
            assert_near(lowest, highest, 1e-10);
            assert!((-1e-10..problem.lift_m + 1e-10).contains(&lowest), "{knot:?}");
        }
        assert_near(heights(0).chain(heights(4)).fold(f64::INFINITY, f64::min), 0.0, 1e-10);
        let center = plant.center_of_mass(&knot.q);
        assert_near(center[2], problem.center_of_mass_height_m, 1e-10);
        assert_near(knot.q[roll], 0.0, 1e-10);
        assert_near(knot.q[pitch], 0.0, 1e-10);
    }
}

/// Swinging limbs take the zero moment point away from where the pendulum has it, the middle of the
/// sole, 75 mm from its edges; corrections bring it back.
#[test]
fn corrections_bring_the_zero_moment_point_back() {
    let off_m = |corrections| {
        let problem = DivergentComponentProblem { corrections, ..problem("tulip_walk") };
        let knots = planned(&problem).knots;
        let swinging = knots.iter().filter(|knot| knot.is_solved && knot.name.ends_with("swing"));
        let off = swinging.map(|knot| (knot.pressure_margin_m.unwrap() - 0.075).abs());
        off.fold(0.0, f64::max)
    };
    let off = [0, 3].map(off_m);
    assert!(off[0] > 3e-3 && off[1] < 1e-4, "{off:?}");
}

fn springs(stiffness: f64) -> [Override; 2] {
    ["right", "left"]
        .map(|side| Override { parameter: format!("ks_{side}_ankle_x"), value: stiffness })
}

/// The walk on springs in the ankle rolls.
fn passive(step_s: f64) -> DivergentComponentProblem {
    DivergentComponentProblem {
        ankle_rolls: AnkleRolls::Passive,
        center_of_mass_height_m: 0.63,
        center_of_pressure_m: [-0.02; 2],
        step_s,
        double_support_s: 0.25 * step_s,
        ..problem("tulip_walk")
    }
}

/// Whether a walk on springs of this stiffness is walked from event to event: no fall, and both
/// feet within 2 cm of where they were planned.
fn walks(step_s: f64, stiffness: f64) -> bool {
    let springs = springs(stiffness);
    let mut plant = tulip(&springs);
    let plan = plan_divergent_component(plant.as_mut(), &passive(step_s)).unwrap();
    assert!(plan.paths.iter().all(|path| ![11, 17].contains(&path.joint)), "no motors there");
    let run = scenario(&plan, &springs).run().unwrap();
    let last = &plan.knots.last().unwrap().q;
    let [placed, wanted] = [&run.end.q, last].map(|q| soles(plant.as_mut(), q));
    let mut pairs = placed.iter().flatten().zip(wanted.iter().flatten());
    run.stop == Stop::End && pairs.all(|(placed, wanted)| (placed - wanted).abs() < 0.02)
}

#[test]
fn springs_walk_where_they_are_stiff_enough_or_steps_short() {
    assert!(walks(0.8, 400.0));
    assert!(!walks(0.8, 150.0));
    // a step of half a second is over before the robot has tilted
    assert!(walks(0.5, 0.0));
}

/// The least stiffness: from 600 N m/rad down, the last one before the first that does not walk.
#[test]
#[ignore = "takes minutes: the figures are in the docs"]
fn least_stiffness_of_passive_ankle_rolls() {
    for step_s in [0.5, 0.6, 0.7, 0.8, 1.0] {
        let stiffnesses = (0..=60).map(|index| 600.0 - 10.0 * f64::from(index));
        let walked = stiffnesses.take_while(|stiffness| walks(step_s, *stiffness));
        let least = walked.last().expect("600 N m/rad are enough");
        println!("steps of {step_s} s: {least} N m/rad");
        assert!(least < 500.0 && (step_s > 0.5 || least == 0.0), "{step_s} s: {least}");
    }
}

#[test]
fn walks_that_cannot_be_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut DivergentComponentProblem)| {
        let mut problem = problem("tulip_walk");
        change(&mut problem);
        plan_divergent_component(tulip(&[]).as_mut(), &problem).expect_err("a refusal")
    };
    let overlap = refused(&|problem| problem.double_support_s = 0.8);
    assert_eq!(overlap.kind(), ErrorKind::Options, "{overlap}");
    let said = "phases overlap: 0.8 s of double support in a step of 0.8 s";
    assert_eq!(overlap.to_string(), said);
    let high = refused(&|problem| problem.center_of_mass_height_m = 0.9);
    assert_eq!(high.kind(), ErrorKind::OutOfReach, "{high}");
    assert_eq!(high.posture().map(|(_, t_s)| t_s), Some(0.0), "{high}");
    let low = refused(&|problem| problem.center_of_mass_height_m = 0.55);
    assert_eq!((low.kind(), low.joint()), (ErrorKind::Limit, Some("right_ankle_y")));
    assert_eq!(low.posture().map(|(posture, _)| posture), Some("start"));
    let long = refused(&|problem| {
        problem.footsteps.iter_mut().for_each(|step| step.forward_m = 0.6);
    });
    assert_eq!(long.kind(), ErrorKind::OutOfReach, "{long}");
    let (posture, t_s) = long.posture().expect("a posture");
    assert!(posture.starts_with("step ") && t_s > 1.0, "{long}");
    // soles are 0.15 m wide
    let narrow = refused(&|problem| problem.step_width_m = Some(0.14));
    assert_eq!(narrow.kind(), ErrorKind::Collision, "{narrow}");
    assert_eq!(narrow.posture().map(|(_, t_s)| t_s), Some(0.0), "{narrow}");
    let outside = refused(&|problem| problem.pressure_inward_m = Some(0.08));
    assert_eq!(outside.kind(), ErrorKind::Margin, "{outside}");
    let brief = refused(&|problem| problem.standing_s = [0.05; 2]);
    assert!(matches!(brief.kind(), ErrorKind::Margin | ErrorKind::OutOfReach), "{brief}");
    let fine = refused(&|problem| problem.interval_s = 1e-4);
    assert_eq!(fine.kind(), ErrorKind::Options, "{fine}");
    let nowhere = refused(&|problem| {
        problem.footsteps.clear();
        problem.ends = Ending::OnLastFoot;
    });
    assert_eq!(nowhere.kind(), ErrorKind::Robot, "{nowhere}");
    let text = shipped::find("planar_biped").unwrap().text;
    let robot = model::read("planar_biped", text.as_bytes()).unwrap();
    let mut plant = plant_of(&robot, &[]).unwrap();
    let planar = plan_divergent_component(plant.as_mut(), &problem("tulip_walk")).unwrap_err();
    assert_eq!(planar.kind(), ErrorKind::Robot, "{planar}");
}

#[test]
fn all_faults_of_a_walk_in_space_are_told_at_once() {
    let text = r#"{"format": "denavit-gait/1", "model": "tulip", "parameters": {"ks": "x"},
        "divergent_component": {"footsteps": [{"forward": 1, "width_m": 0}], "steps": 3,
        "first_swing": "middle", "ankle_rolls": "loose", "ends": "never", "corrections": 1.5,
        "fallback_friction": 1}}"#;
    let error = read_gait("bad.json", text.as_bytes()).unwrap_err().to_string();
    for place in [
        "/parameters/ks",
        "`forward`",
        "/divergent_component/footsteps/0/width_m",
        "/divergent_component/steps",
        "/divergent_component/first_swing",
        "/divergent_component/ankle_rolls",
        "/divergent_component/ends",
        "/divergent_component/corrections",
        "step_s",
        "center_of_mass_height_m",
        "`fallback_friction`",
    ] {
        assert!(error.contains(place), "{place}:\n{error}");
    }
}
