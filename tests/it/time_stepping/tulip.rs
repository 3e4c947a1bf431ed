//! TUlip on its feet: 18 degrees of freedom, 8 contact points, redundant.

use denavit::simulate::contact::Space;
use denavit::simulate::contact::gauss_seidel::SweepLimits;
use denavit::simulate::time_stepping::{
    Instant, Scheme, StepLaw, StepSolver, Stepping, Terms, TimeStepper, TimeSteppingModel,
};
use denavit::tulip;

const N: usize = tulip::DOF;

/// TUlip with a PD controller on its twelve joints.
struct Tulip {
    parameters: tulip::Parameters<f64>,
    reference: [f64; N],
    stiffness: f64,
    damping: f64,
}

impl TimeSteppingModel for Tulip {
    fn dof(&self) -> usize {
        N
    }

    fn contacts(&self) -> usize {
        8
    }

    fn space(&self) -> Space {
        Space::Spatial
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        let points = tulip::contact_positions(&self.parameters, q.try_into().unwrap());
        for (gap, point) in gaps.iter_mut().zip(points) {
            *gap = point[2];
        }
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        let (q, qd) = (at.q.try_into().unwrap(), at.qd.try_into().unwrap());
        let mass = tulip::mass_matrix(&self.parameters, q);
        terms.mass.copy_from_slice(mass.as_flattened());
        let bias = tulip::bias(&self.parameters, q, qd);
        for joint in 0..N {
            terms.force[joint] = -bias[joint];
        }
        for joint in 6..N {
            terms.force[joint] += self.stiffness * (self.reference[joint] - at.q[joint]);
            terms.force[joint] -= self.damping * at.qd[joint];
            terms.damping[joint * N + joint] = self.damping;
        }
        let rows = tulip::contact_jacobian(&self.parameters, q);
        for (block, contact) in terms.jacobian.chunks_exact_mut(3 * N).zip(closed) {
            block.copy_from_slice(rows[3 * contact..3 * contact + 3].as_flattened());
        }
    }
}

/// Coulomb friction of the drives is a set-valued law, not a term of the equations; viscous
/// friction would have to be among the damping.
fn without_friction() -> tulip::ModelParameters<f64> {
    tulip::ModelParameters {
        fv_right_hip_z: 0.0,
        fc_right_hip_z: 0.0,
        fv_right_hip_x: 0.0,
        fc_right_hip_x: 0.0,
        fv_right_hip_y: 0.0,
        fc_right_hip_y: 0.0,
        fv_right_knee: 0.0,
        fc_right_knee: 0.0,
        fv_right_ankle_y: 0.0,
        fc_right_ankle_y: 0.0,
        fv_right_ankle_x: 0.0,
        ks_right_ankle_x: 0.0,
        fv_left_hip_z: 0.0,
        fc_left_hip_z: 0.0,
        fv_left_hip_x: 0.0,
        fc_left_hip_x: 0.0,
        fv_left_hip_y: 0.0,
        fc_left_hip_y: 0.0,
        fv_left_knee: 0.0,
        fc_left_knee: 0.0,
        fv_left_ankle_y: 0.0,
        fc_left_ankle_y: 0.0,
        fv_left_ankle_x: 0.0,
        ks_left_ankle_x: 0.0,
        ..tulip::ModelParameters::default()
    }
}

/// Standing with bent knees, the soles on the ground.
fn standing() -> (Tulip, [f64; N]) {
    let parameters = tulip::Parameters::new(&without_friction());
    let mut q = [0.0; N];
    for leg in [6, 12] {
        q[leg + 2] = -0.3;
        q[leg + 3] = 0.6;
        q[leg + 4] = -0.3;
    }
    let heights = tulip::contact_positions(&parameters, &q).map(|point| point[2]);
    assert!(heights.iter().all(|z| (z - heights[0]).abs() < 1e-12), "flat: {heights:?}");
    q[0] -= heights[0];
    (Tulip { parameters, reference: q, stiffness: 1500.0, damping: 30.0 }, q)
}

fn settings(scheme: Scheme, solver: StepSolver) -> Stepping {
    let laws = vec![StepLaw { friction: 0.8, restitution: 0.0 }; 8];
    Stepping { scheme, step_s: 1e-3, solver, laws }
}

const SWEEPS: StepSolver = StepSolver::Sweeps(SweepLimits { sweeps: 100_000, response: 1e-13 });

/// At rest the ground carries the weight, at the centre of pressure below the centre of mass.
#[test]
fn at_rest_the_ground_carries_the_weight_below_the_centre_of_mass() {
    for scheme in [Scheme::MoreauMidpoint, Scheme::Anitescu { reach_m: 0.01 }] {
        let (mut robot, mut q) = standing();
        let mut qd = [0.0; N];
        let mut stepper = TimeStepper::new(settings(scheme, SWEEPS), &robot);
        for step in 0..12_000 {
            stepper.step(&mut robot, f64::from(step) * 1e-3, &mut q, &mut qd).expect("a step");
        }
        assert!(qd.iter().all(|rate| rate.abs() < 1e-9), "at rest: {qd:?}");
        let mass = tulip::mass_matrix(&robot.parameters, &q)[0][0];
        assert!((mass - 25.29).abs() < 0.01, "base_z moves all of it: {mass}");
        let points = tulip::contact_positions(&robot.parameters, &q);
        let normals: Vec<f64> = stepper.impulses().chunks(3).map(|p| p[2] / 1e-3).collect();
        let total: f64 = normals.iter().sum();
        assert!((total - mass * 9.81).abs() < 1e-6, "{total}");
        let center = tulip::center_of_mass(&robot.parameters, &q);
        for axis in 0..2 {
            // The points stand some micrometres below the ground, and friction acts there.
            let moment: f64 = stepper
                .impulses()
                .chunks(3)
                .zip(points)
                .map(|(p, at)| (p[2] * at[axis] - p[axis] * at[2]) / 1e-3)
                .sum();
            assert!((moment / total - center[axis]).abs() < 1e-8, "axis {axis}");
        }
    }
}

#[test]
fn sweeps_and_pivots_move_a_redundant_robot_alike() {
    let run = |solver| {
        let (mut robot, mut q) = standing();
        // Set down with a small speed, slightly tilted: the soles land edge by edge.
        q[0] += 2e-3;
        q[4] = 0.01;
        let mut qd = [0.0; N];
        qd[0] = -0.1;
        let mut stepper = TimeStepper::new(settings(Scheme::MoreauMidpoint, solver), &robot);
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
