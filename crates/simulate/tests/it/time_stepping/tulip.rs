//! TUlip on its feet: 18 degrees of freedom, 8 contact points, redundant.

use denavit_plants::trajectory::Reference;
use denavit_plants::{Override, Plant, tulip};
use denavit_simulate::Control;
use denavit_simulate::contact::gauss_seidel::SweepLimits;
use denavit_simulate::time_stepping::{
    ControlledPlant, Scheme, StepLaw, StepSolver, Stepping, TimeStepper,
};

const N: usize = denavit_plants::emitted::tulip::DOF;

/// TUlip without springs in its ankles, and a PD controller that holds this posture with all twelve
/// joints: bent knees, the soles on the ground.
fn standing() -> (Box<dyn Plant>, Control, Vec<f64>) {
    let none = |parameter: &str| Override { parameter: parameter.to_owned(), value: 0.0 };
    let names = ["ks_right_ankle_x", "ks_left_ankle_x", "fv_right_ankle_x", "fv_left_ankle_x"];
    let mut plant = tulip(&names.map(none)).expect("parameters of the generated plant");
    let mut q = vec![0.0; N];
    for leg in [6, 12] {
        q[leg + 2] = -0.3;
        q[leg + 3] = 0.6;
        q[leg + 4] = -0.3;
    }
    let heights: Vec<f64> = points(plant.as_mut(), &q).chunks(3).map(|point| point[2]).collect();
    assert!(heights.iter().all(|z| (z - heights[0]).abs() < 1e-12), "flat: {heights:?}");
    q[0] -= heights[0];
    let reference = |joint: usize| (joint >= 6).then(|| Reference::Constant(q[joint]));
    let control = Control::proportional((0..N).map(reference).collect(), 1500.0, 30.0);
    (plant, control, q)
}

fn points(plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
    let mut positions = vec![0.0; 24];
    plant.contact_positions(q, &mut positions);
    positions
}

fn stepper(scheme: Scheme, solver: StepSolver, robot: &ControlledPlant<'_>) -> TimeStepper {
    let laws = vec![StepLaw { friction: 0.8, restitution: 0.0 }; 8];
    TimeStepper::new(Stepping { scheme, solver, ..Stepping::default() }, laws, robot)
}

const SWEEPS: StepSolver = StepSolver::Sweeps(SweepLimits { sweeps: 100_000, response: 1e-13 });

/// At rest the ground carries the weight, at the centre of pressure below the centre of mass.
#[test]
fn at_rest_the_ground_carries_the_weight_below_the_centre_of_mass() {
    for scheme in [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m: 0.01 }] {
        let (mut plant, control, mut q) = standing();
        let mut robot = ControlledPlant::new(plant.as_mut(), &control);
        let mut qd = [0.0; N];
        let mut stepper = stepper(scheme, SWEEPS, &robot);
        for step in 0..12_000 {
            stepper.step(&mut robot, f64::from(step) * 1e-3, &mut q, &mut qd).expect("a step");
        }
        assert!(qd.iter().all(|rate| rate.abs() < 1e-9), "at rest: {qd:?}");
        let mass = plant.model().mass_kg;
        assert!((mass - 25.29).abs() < 0.01, "{mass}");
        let points = points(plant.as_mut(), &q);
        let normals: Vec<f64> = stepper.impulses().chunks(3).map(|p| p[2] / 1e-3).collect();
        let total: f64 = normals.iter().sum();
        assert!((total - mass * 9.81).abs() < 1e-6, "{total}");
        let center = plant.center_of_mass(&q);
        for axis in 0..2 {
            // The points stand some micrometres below the ground, and friction acts there.
            let moment: f64 = stepper
                .impulses()
                .chunks(3)
                .zip(points.chunks(3))
                .map(|(p, at)| (p[2] * at[axis] - p[axis] * at[2]) / 1e-3)
                .sum();
            assert!((moment / total - center[axis]).abs() < 1e-8, "axis {axis}");
        }
    }
}

/// Robots that land on redundant contacts move alike, whichever way the impulses are found.
#[test]
fn sweeps_and_pivots_move_a_redundant_robot_alike() {
    let run = |solver| {
        let (mut plant, control, mut q) = standing();
        let mut robot = ControlledPlant::new(plant.as_mut(), &control);
        // Set down with a small speed, slightly tilted: the soles land edge by edge.
        q[0] += 2e-3;
        q[4] = 0.01;
        let mut qd = [0.0; N];
        qd[0] = -0.1;
        let mut stepper = stepper(Scheme::MoreauMidpoint, solver, &robot);
        let mut most = 0;
        for step in 0..200 {
            let report =
                stepper.step(&mut robot, f64::from(step) * 1e-3, &mut q, &mut qd).expect("a step");
            assert!(!report.fell_back, "step {step}: {report:?}");
            most = most.max(report.closed);
        }
        assert_eq!(most, 8);
        (q, qd)
    };
    // Friction is never exhausted, so that cone and pyramid are one.
    let (swept, pivoted) = (run(SWEEPS), run(StepSolver::Pivots { facets: 8 }));
    for (a, b) in swept.0.iter().chain(&swept.1).zip(pivoted.0.iter().chain(&pivoted.1)) {
        assert!((a - b).abs() < 1e-8, "{a} {b}");
    }
}
