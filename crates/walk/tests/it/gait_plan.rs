//! Gaits planned by kinematics: the pendulum against its equation, postures against forward
//! kinematics, and what is written is read back and walked in the simulator.

use super::assert_near;
use denavit_codegen::model;
use denavit_plants::{Override, Plant, plant_of, point_positions, shipped};
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Run, Stop};
use denavit_walk::ErrorKind;
use denavit_walk::ScenarioHead;
use denavit_walk::balance::{Criterion, Over, course_of_scenario};
use denavit_walk::gait_file::{GaitFile, GaitKind, read_gait};
use denavit_walk::gait_plan::{
    GaitPlan, InvertedPendulumProblem, Join, PendulumPath, PressureSegment, PrimitivesProblem,
    plan_inverted_pendulum, plan_primitives,
};
use denavit_walk::poincare::{PoincareOptions, analyse};

fn biped() -> Box<dyn Plant> {
    let text = shipped::find("planar_biped").unwrap().text;
    plant_of(&model::read("planar_biped", text.as_bytes()).unwrap(), &[]).unwrap()
}

fn file(name: &str) -> GaitFile {
    read_gait(name, shipped::find_gait(name).unwrap().text.as_bytes()).unwrap()
}

fn primitives() -> PrimitivesProblem {
    match file("planar_biped_primitives").kind {
        GaitKind::Primitives(problem) => problem,
        other => panic!("{other:?}"),
    }
}

fn pendulum() -> InvertedPendulumProblem {
    match file("planar_biped_inverted_pendulum").kind {
        GaitKind::InvertedPendulum(problem) => problem,
        other => panic!("{other:?}"),
    }
}

/// The scenario of a plan, written and read back.
fn scenario(plan: &GaitPlan) -> Scenario {
    let plant = biped();
    let head = ScenarioHead {
        name: "planned",
        description: "",
        source: "",
        model: "planar_biped",
        parameters: &[],
        steps: plan.steps,
    };
    let text = plan.scenario_text(plant.model(), &head);
    let load = |model: &str| {
        let shipped = shipped::find_referred(model).ok_or("no such model")?;
        Ok(shipped.text.as_bytes().to_vec())
    };
    denavit_walk::read_scenario("planned", text.as_bytes(), &load)
        .unwrap_or_else(|error| panic!("{error}"))
}

/// How far the base comes in each of these times, one after the other [m].
fn advances(run: &Run, period_s: f64, count: usize) -> Vec<f64> {
    let [times, places] = ["t", "q_base_x"].map(|name| run.log.column(name).unwrap());
    let at = |t_s: f64| places[times.partition_point(|time| *time < t_s - 1e-6)];
    (0..count).map(|k| at((k + 1) as f64 * period_s) - at(k as f64 * period_s)).collect()
}

/// The run of a plan of primitives, which makes all its steps.
fn walked(plan: &GaitPlan) -> (Scenario, Run) {
    let mut scenario = scenario(plan);
    let run = scenario.run().unwrap();
    assert_eq!(run.stop, Stop::End, "at {} s", run.end.t_s);
    assert!(scenario.broken(&run).is_empty(), "{:?}", scenario.broken(&run));
    let steps = advances(&run, plan.step_s, plan.steps);
    let length = plan.step_length_m;
    assert!(steps.iter().all(|step| (0.5 * length..1.5 * length).contains(step)), "{steps:?}");
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    assert_near(mean, length, 0.1 * length);
    (scenario, run)
}

#[test]
fn primitives_walk_twenty_steps_with_their_zmp_inside() {
    let plan = plan_primitives(biped().as_mut(), &primitives()).unwrap();
    assert_eq!((plan.steps, plan.step_s, plan.step_length_m), (20, 4.0, 0.1));
    let (mut scenario, _) = walked(&plan);
    let course = course_of_scenario(&mut scenario, 1e-3, false).unwrap();
    assert_eq!(course.over, Over::Cycle);
    let margin = course.margins(Criterion::ZeroMoment).unwrap().least_m;
    assert!(margin >= 45e-3, "{margin}");
    let options = PoincareOptions { checks: false, ..PoincareOptions::default() };
    let found = analyse(&mut scenario, &options).unwrap();
    let largest = found.multipliers[0].modulus();
    assert!(largest < 0.01, "{largest}");
}

/// Shorter times: the zero moment point comes to the edge of the sole, and it walks all the same.
#[test]
fn faster_primitives_walk_too() {
    let mut problem = primitives();
    for (posture, part_s) in problem.postures.iter_mut().zip([0.5, 0.4, 0.6, 0.4, 0.5]) {
        posture.duration_s = part_s;
    }
    let plan = plan_primitives(biped().as_mut(), &problem).unwrap();
    let (mut scenario, _) = walked(&plan);
    let course = course_of_scenario(&mut scenario, 1e-3, true).unwrap();
    let margin = course.margins(Criterion::ZeroMoment).unwrap().least_m;
    assert!(margin.abs() < 1e-6, "{margin}");
}

#[test]
fn every_way_to_join_walks() {
    for join in [Join::Cubic, Join::Bezier] {
        let problem = PrimitivesProblem { join, steps: 4, ..primitives() };
        let plan = plan_primitives(biped().as_mut(), &problem).unwrap();
        walked(&plan);
        // joined, all references pass through all postures
        let model = biped().model().clone();
        let references = plan.references(&model).unwrap();
        for knot in plan.knots.iter().filter(|knot| knot.is_solved) {
            for (reference, q) in references.iter().zip(&knot.q) {
                let Some(reference) = reference else { continue };
                assert_near(reference.at(knot.t_s).position, *q, 1e-12);
            }
        }
    }
}

/// By forward kinematics, whatever the planner says.
#[test]
fn postures_have_their_feet_and_their_weight_where_they_are_to_be() {
    let (mut plant, problem) = (biped(), primitives());
    let plan = plan_primitives(plant.as_mut(), &problem).unwrap();
    let knots: Vec<_> = plan.knots.iter().filter(|knot| knot.is_solved).collect();
    assert_eq!(knots.len(), problem.postures.len());
    for (knot, posture) in knots.iter().zip(&problem.postures) {
        let mut points = [0.0; 12];
        plant.contact_positions(&knot.q, &mut points);
        let [x, lift] = posture.swing_foot_m;
        // right heel and toe, left heel and toe: -0.06 and 0.15 m from the ankle
        for (at, expected) in [
            (0, -0.06),
            (2, 0.0),
            (3, 0.15),
            (5, 0.0),
            (6, x - 0.06),
            (8, lift),
            (9, x + 0.15),
            (11, lift),
        ] {
            assert_near(points[at], expected, 1e-10);
        }
        assert_near(plant.center_of_mass(&knot.q)[0], posture.center_of_mass_m, 1e-10);
        assert_near(knot.q[plant.model().find_joint("base_z").unwrap()], 0.54, 1e-10);
        assert!(knot.residual < 1e-10 && knot.name == posture.name);
    }
    // the stance sole carries the weight, 0.055 m ahead of the ankle at most
    let least = plan.least_static().unwrap();
    assert_near(least.static_margin_m, 0.15 - 0.055, 1e-10);
    // between postures soles are off by fractions of a millimetre, and it is told by how much
    let worst = plan.worst(false).unwrap();
    assert!((1e-5..1e-3).contains(&worst.residual), "{}", worst.residual);
    let mut points = [0.0; 12];
    plant.contact_positions(&worst.q, &mut points);
    let off = [(6, -0.16), (8, 0.0), (11, 0.0)].map(|(at, place)| (points[at] - place).abs());
    assert_near(off.into_iter().fold(0.0, f64::max), worst.residual, 1e-9);
}

fn segment(duration_s: f64, places_m: [f64; 2]) -> PressureSegment {
    PressureSegment { duration_s, places_m }
}

/// While its pivot rests: x - p = x0 cosh wt + x0'/w sinh wt.
#[test]
fn the_pendulum_is_its_closed_form() {
    let (omega, pivot) = (3.9, 0.2);
    let path = PendulumPath::new(omega, &[segment(0.6, [pivot; 2]), segment(1.0, [0.5; 2])], 0.1);
    let start = path.at(0.0);
    assert_near(start.position_m, 0.1, 1e-15);
    for t_s in [0.0, 0.2, 0.45, 0.6] {
        let (x0, v0) = (start.position_m - pivot, start.velocity_m_s);
        let (cosh, sinh) = ((omega * t_s).cosh(), (omega * t_s).sinh());
        // just before the pivot jumps
        let now = path.at(t_s - 1e-14);
        assert_near(now.position_m, pivot + x0 * cosh + v0 / omega * sinh, 1e-12);
        assert_near(now.velocity_m_s, omega * x0 * sinh + v0 * cosh, 1e-12);
        assert_near(now.acceleration_m_s2, omega * omega * (now.position_m - pivot), 1e-11);
    }
    // it comes to rest over the last place
    assert!((path.at(0.6).position_m + path.at(0.6).velocity_m_s / omega - 0.5).abs() < 1e-12);
}

/// x'' = w^2 (x - p), and position, velocity and acceleration are continuous from piece to piece,
/// after 60 s as at the beginning.
#[test]
fn the_pendulum_is_continuous_over_many_steps() {
    let omega = (9.81_f64 / 0.66).sqrt();
    let mut segments = vec![segment(0.5, [0.045; 2]), segment(0.5, [0.045; 2])];
    for step in 0..75 {
        let foot = 0.045 + 0.1 * f64::from(step);
        segments.extend([segment(0.6, [foot; 2]), segment(0.2, [foot, foot + 0.1])]);
    }
    segments.extend([segment(0.5, [7.545; 2]), segment(0.5, [7.545; 2])]);
    let last = segments.len() - 2;
    let path = PendulumPath::resting(omega, &segments, 0.045, [0, last]).unwrap();
    let mut t_s = 0.0;
    for segment in &segments[..segments.len() - 1] {
        t_s += segment.duration_s;
        let [before, after] = [path.at(t_s - 1e-9), path.at(t_s + 1e-9)];
        assert_near(before.position_m, after.position_m, 1e-8);
        assert_near(before.velocity_m_s, after.velocity_m_s, 1e-7);
        assert_near(before.acceleration_m_s2, after.acceleration_m_s2, 1e-6);
    }
    let h = 1e-4;
    for t_s in [0.3, 0.77, 1.3, 30.21, 60.95] {
        let [before, now, after] = [t_s - h, t_s, t_s + h].map(|t_s| path.at(t_s));
        let velocity = (after.position_m - before.position_m) / (2.0 * h);
        assert_near(now.velocity_m_s, velocity, 1e-6);
        let second = (after.position_m - 2.0 * now.position_m + before.position_m) / (h * h);
        assert_near(now.acceleration_m_s2, second, 1e-4);
        let law = omega * omega * (now.position_m - now.pressure_m);
        assert_near(now.acceleration_m_s2, law, 1e-9);
    }
    for end in [path.at(0.0), path.at(path.duration_s())] {
        assert_near(end.velocity_m_s, 0.0, 1e-12);
        assert_near(end.acceleration_m_s2, 0.0, 1e-10);
        assert_near(end.position_m, end.pressure_m, 1e-12);
    }
}

#[test]
fn the_pendulum_walks_from_standing_to_standing() {
    let mut plant = biped();
    let plan = plan_inverted_pendulum(plant.as_mut(), &pendulum()).unwrap();
    assert!(plan.worst(true).unwrap().residual < 1e-10);
    assert!(plan.worst(false).unwrap().residual < 1e-3);
    assert!(plan.least_pressure().unwrap().pressure_margin_m.unwrap() > 0.05);
    let mut scenario = scenario(&plan);
    let course = course_of_scenario(&mut scenario, 1e-3, true).unwrap();
    let margin = course.margins(Criterion::ZeroMoment).unwrap();
    assert!(margin.least_m > 0.0, "{margin:?}");
    let run = course.run.as_ref().unwrap();
    assert_eq!(run.stop, Stop::End);
    assert!(scenario.broken(run).is_empty(), "{:?}", scenario.broken(run));
    // every foot is where it was planned, at the end of each step
    let places = run.log.column("q_base_x").unwrap();
    let moved = places[places.len() - 1] - places[0];
    assert_near(moved, plan.distance_m, 0.05 * plan.distance_m);
    let fastest = run.end.qd.iter().fold(0.0_f64, |most, qd| most.max(qd.abs()));
    assert!(fastest < 0.02, "it stands in the end: {fastest} rad/s");
}

/// The pose of a knot by forward kinematics: soles level, the weight where the pendulum has it.
#[test]
fn knots_of_the_pendulum_meet_their_conditions() {
    let (mut plant, problem) = (biped(), pendulum());
    let plan = plan_inverted_pendulum(plant.as_mut(), &problem).unwrap();
    let mut points = [0.0; 12];
    for knot in &plan.knots {
        plant.contact_positions(&knot.q, &mut points);
        let center = plant.center_of_mass(&knot.q);
        let tolerance = if knot.is_solved { 1e-10 } else { knot.residual + 1e-10 };
        assert_near(center[2], problem.center_of_mass_height_m, tolerance);
        assert_near(points[2], points[5], 2.0 * tolerance);
        assert_near(points[8], points[11], 2.0 * tolerance);
        let lowest = points[2].min(points[8]);
        assert_near(lowest, 0.0, tolerance);
        assert!(points[2].max(points[8]) < problem.lift_m + tolerance);
    }
    // steps are placed at equal distances
    let last = plan.knots.last().unwrap();
    plant.contact_positions(&last.q, &mut points);
    assert_near(points[0], 1.9 - 0.06, 1e-10);
    assert_near(points[6], 1.9 - 0.06, 1e-10);
}

#[test]
fn impossible_primitives_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut PrimitivesProblem)| {
        let mut problem = primitives();
        change(&mut problem);
        plan_primitives(biped().as_mut(), &problem).expect_err("a refusal")
    };
    let high = refused(&|problem| problem.postures[2].hip_height_m = 0.7);
    assert_eq!((high.kind(), high.posture()), (ErrorKind::OutOfReach, Some(("lifted", 1.6))));
    assert!(high.residual().is_some_and(|residual| residual > 1e-2), "{high}");
    let long = refused(&|problem| {
        let places = [-1.2, -1.2, -1.2, 1.2, 1.2];
        for (posture, place) in problem.postures.iter_mut().zip(places) {
            posture.swing_foot_m[0] = place;
        }
    });
    assert_eq!(long.kind(), ErrorKind::OutOfReach, "{long}");
    let leaning = refused(&|problem| problem.postures[3].center_of_mass_m = 0.2);
    assert_eq!(
        leaning.to_string(),
        "`forward` at 2.400 s: the centre of mass is 50.0 mm outside the support polygon, where \
         a margin of 10.0 mm is asked for"
    );
    // both feet stand, but one leaves next
    let behind = refused(&|problem| problem.postures[1].center_of_mass_m = -0.1);
    assert_eq!(behind.kind(), ErrorKind::Margin, "{behind}");
    let open = refused(&|problem| problem.postures[4].swing_foot_m[0] = 0.12);
    assert_eq!(open.kind(), ErrorKind::NotClosed, "{open}");
    let sliding = refused(&|problem| problem.postures[1].swing_foot_m[0] = -0.05);
    assert_eq!(sliding.kind(), ErrorKind::Collision, "{sliding}");
    let deep = refused(&|problem| problem.postures[0].hip_height_m = 0.05);
    assert!(matches!(deep.kind(), ErrorKind::Limit | ErrorKind::OutOfReach), "{deep}");
}

#[test]
fn impossible_pendulums_are_refused_by_name() {
    let refused = |change: &dyn Fn(&mut InvertedPendulumProblem)| {
        let mut problem = pendulum();
        change(&mut problem);
        plan_inverted_pendulum(biped().as_mut(), &problem).expect_err("a refusal")
    };
    let overlap = refused(&|problem| problem.double_support_s = 0.8);
    assert_eq!(overlap.kind(), ErrorKind::Options, "{overlap}");
    let said = "phases overlap: 0.8 s of double support in a step of 0.8 s";
    assert_eq!(overlap.to_string(), said);
    let high = refused(&|problem| problem.center_of_mass_height_m = 0.9);
    assert_eq!(high.kind(), ErrorKind::OutOfReach, "{high}");
    assert_eq!(high.posture().map(|(_, t_s)| t_s), Some(0.0), "{high}");
    let long = refused(&|problem| problem.step_length_m = 0.9);
    assert_eq!(long.kind(), ErrorKind::OutOfReach, "{long}");
    let (posture, t_s) = long.posture().expect("a posture");
    assert!(posture.starts_with("step ") && t_s > 0.0, "{long}");
    let outside = refused(&|problem| problem.center_of_pressure_m = Some([0.0, 0.2]));
    assert_eq!(outside.kind(), ErrorKind::Margin, "{outside}");
    let brief = refused(&|problem| problem.standing_s = [0.02, 0.02]);
    assert_eq!(brief.kind(), ErrorKind::Margin, "{brief}");
    let fine = refused(&|problem| problem.interval_s = 1e-4);
    assert_eq!(fine.kind(), ErrorKind::Options, "{fine}");
    let mut tulip = denavit_plants::tulip(&[]).unwrap();
    let space = plan_inverted_pendulum(tulip.as_mut(), &pendulum()).unwrap_err();
    assert_eq!(space.kind(), ErrorKind::Robot, "{space}");
}

#[test]
fn all_faults_of_a_gait_file_are_told_at_once() {
    let text = r#"{"format": "denavit-gait/1", "model": "planar_biped", "primitives": {
        "postures": [{"center_of_mass_m": "x", "swing_foot_m": [0, -1]}], "join": "glue",
        "kp": -1, "speed": 3}}"#;
    let error = read_gait("bad.json", text.as_bytes()).unwrap_err().to_string();
    for place in [
        "/primitives/postures/0/center_of_mass_m",
        "/primitives/postures/0/swing_foot_m",
        "hip_height_m",
        "two postures",
        "/primitives/join",
        "/primitives/kp",
        "`speed`",
    ] {
        assert!(error.contains(place), "{place}:\n{error}");
    }
    let text = r#"{"format": "denavit-gait/1", "model": "planar_biped", "inverted_pendulum": {
        "step_length_m": 0.1, "steps": 0.5, "standing_s": [1]}, "limit_cycle": {}}"#;
    let error = read_gait("bad.json", text.as_bytes()).unwrap_err().to_string();
    for place in ["step_s", "center_of_mass_height_m", "/steps", "/standing_s", "one kind of gait"]
    {
        assert!(error.contains(place), "{place}:\n{error}");
    }
}

/// By forward kinematics, whatever the search says: toes are ahead of heels, and nothing that must
/// not touch the ground is below it.
fn assert_upright(plant: &mut dyn Plant, plan: &GaitPlan) {
    let model = plant.model().clone();
    let contact = |name: &str| model.contacts.iter().position(|c| c.name == name).unwrap();
    let feet = ["right", "left"]
        .map(|side| [contact(&format!("{side}_heel")), contact(&format!("{side}_toe"))]);
    let mut positions = vec![0.0; 3 * model.contacts.len()];
    let mut transforms = vec![0.0; 12 * model.links.len()];
    let mut bodies = vec![0.0; 3 * model.fall_points.len()];
    for knot in &plan.knots {
        plant.contact_positions(&knot.q, &mut positions);
        for [heel, toe] in feet {
            assert_near(positions[3 * toe] - positions[3 * heel], 0.21, 5e-3);
        }
        plant.link_transforms(&knot.q, &mut transforms);
        point_positions(&model.fall_points, &transforms, &mut bodies);
        assert!(bodies.chunks_exact(3).all(|place| place[2] > -1e-3), "{knot:?}");
    }
}

/// At 0.45 m there is a posture on feet that are upside down.
#[test]
fn feet_are_the_right_way_up_at_every_height() {
    let mut plant = biped();
    let mut planned = 0;
    for height_m in [0.36, 0.40, 0.42, 0.45, 0.48, 0.52, 0.58, 0.62] {
        let problem =
            InvertedPendulumProblem { center_of_mass_height_m: height_m, steps: 4, ..pendulum() };
        if let Ok(plan) = plan_inverted_pendulum(plant.as_mut(), &problem) {
            assert_upright(plant.as_mut(), &plan);
            planned += 1;
        }
        let mut low = primitives();
        low.postures.iter_mut().for_each(|posture| posture.hip_height_m = height_m - 0.1);
        if let Ok(plan) = plan_primitives(plant.as_mut(), &low) {
            assert_upright(plant.as_mut(), &plan);
            planned += 1;
        }
    }
    assert!(planned >= 8, "{planned} plans");
}

#[test]
fn curves_that_leave_the_ground_between_knots_are_refused() {
    let problem = InvertedPendulumProblem { double_support_s: 0.79, steps: 4, ..pendulum() };
    let error = plan_inverted_pendulum(biped().as_mut(), &problem).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::OutOfReach);
    assert!(error.to_string().contains("curves between two knots"), "{error}");
    assert!(error.residual().is_some_and(|residual| residual > 0.05), "{error}");
}

/// Gravity that points up, or aslant, is not that of a pendulum on level ground.
#[test]
fn gravity_has_to_point_down() {
    let text = shipped::find("planar_biped").unwrap().text;
    let upwards = [Override { parameter: "g".to_owned(), value: -9.81 }];
    let robot = model::read("planar_biped", text.as_bytes()).unwrap();
    let aslant = text.replace("\"gravity\": [0, 0, \"-g\"]", "\"gravity\": [1, 0, \"-g\"]");
    assert_ne!(aslant, text);
    let slope = model::read("aslant", aslant.as_bytes()).unwrap();
    for mut plant in [plant_of(&robot, &upwards).unwrap(), plant_of(&slope, &[]).unwrap()] {
        for error in [
            plan_inverted_pendulum(plant.as_mut(), &pendulum()).unwrap_err(),
            plan_primitives(plant.as_mut(), &primitives()).unwrap_err(),
        ] {
            assert!(error.to_string().contains("gravity straight down"), "{error}");
        }
    }
}
