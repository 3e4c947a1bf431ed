//! How long a step of time stepping takes for TUlip: 18 degrees of freedom, 8 contact points, a PD
//! controller on its twelve joints, h = 1 ms.
//!
//! A sample is 1000 steps: one simulated second. The setting is that of the peers' figures in
//! docs/benchmarks.md: standing still, and marching on the spot.

use criterion::{Criterion, criterion_group, criterion_main};
use denavit::simulate::contact::Space;
use denavit::simulate::contact::gauss_seidel::SweepLimits;
use denavit::simulate::time_stepping::{
    Instant, Scheme, StepLaw, StepReport, StepSolver, Stepping, Terms, TimeStepper,
    TimeSteppingModel,
};
use denavit::tulip;

const N: usize = tulip::DOF;
const STEP_S: f64 = 1e-3;
const STEPS: usize = 1000;

/// TUlip under PD control; `lift` is the amplitude of marching [rad].
struct Tulip {
    parameters: tulip::Parameters<f64>,
    posture: [f64; N],
    lift: f64,
}

impl Tulip {
    /// Bent knees, soles on the ground.
    fn standing(lift: f64) -> Self {
        let parameters = tulip::Parameters::new(&without_coulomb_friction());
        let mut posture = [0.0; N];
        for leg in [6, 12] {
            posture[leg + 2] = -0.3;
            posture[leg + 3] = 0.6;
            posture[leg + 4] = -0.3;
        }
        posture[0] -= tulip::contact_positions(&parameters, &posture)[0][2];
        Self { parameters, posture, lift }
    }

    /// The legs are lifted in turn, half a second each.
    fn reference(&self, joint: usize, t_s: f64) -> f64 {
        let leg = if joint < 12 { 0.0 } else { 0.5 };
        let phase = (t_s - leg).rem_euclid(1.0);
        let bent = if phase < 0.5 { (std::f64::consts::TAU * phase).sin().max(0.0) } else { 0.0 };
        let share = [0.0, 0.0, -1.0, 2.0, -1.0, 0.0][(joint - 6) % 6];
        self.posture[joint] + self.lift * share * bent
    }
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
        let points = tulip::contact_positions(&self.parameters, q.try_into().expect("n entries"));
        for (gap, point) in gaps.iter_mut().zip(points) {
            *gap = point[2];
        }
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        let q = at.q.try_into().expect("n entries");
        let qd = at.qd.try_into().expect("n entries");
        let mass = tulip::mass_matrix(&self.parameters, q);
        terms.mass.copy_from_slice(mass.as_flattened());
        let bias = tulip::bias(&self.parameters, q, qd);
        for joint in 0..N {
            terms.force[joint] = -bias[joint];
        }
        // Marching without a plan falls: a soft gantry holds the torso, as in the peers' setting.
        for joint in if self.lift > 0.0 { 1..6 } else { 0..0 } {
            let error = self.posture[joint] - at.q[joint];
            terms.force[joint] += 500.0 * error - 50.0 * at.qd[joint];
            terms.damping[joint * N + joint] = 50.0;
        }
        for joint in 6..N {
            let error = self.reference(joint, at.t_s) - at.q[joint];
            terms.force[joint] += 1500.0 * error - 30.0 * at.qd[joint];
            terms.damping[joint * N + joint] = 30.0;
        }
        let rows = tulip::contact_jacobian(&self.parameters, q);
        for (block, contact) in terms.jacobian.chunks_exact_mut(3 * N).zip(closed) {
            block.copy_from_slice(rows[3 * contact..3 * contact + 3].as_flattened());
        }
    }
}

/// The drives' Coulomb friction is a set-valued law, not a term of the equations of motion.
fn without_coulomb_friction() -> tulip::ModelParameters<f64> {
    tulip::ModelParameters {
        fc_right_hip_z: 0.0,
        fc_right_hip_x: 0.0,
        fc_right_hip_y: 0.0,
        fc_right_knee: 0.0,
        fc_right_ankle_y: 0.0,
        fc_left_hip_z: 0.0,
        fc_left_hip_x: 0.0,
        fc_left_hip_y: 0.0,
        fc_left_knee: 0.0,
        fc_left_ankle_y: 0.0,
        ..tulip::ModelParameters::default()
    }
}

/// State and stepper after the robot has settled.
fn settled(robot: &mut Tulip, scheme: Scheme) -> (TimeStepper, [f64; N], [f64; N]) {
    let laws = vec![StepLaw { friction: 1.0, restitution: 0.0 }; 8];
    let solver = StepSolver::Sweeps(SweepLimits { sweeps: 500, response: 1e-8 });
    let stepping = Stepping { scheme, step_s: STEP_S, solver, laws };
    let mut stepper = TimeStepper::new(stepping, robot);
    let (mut q, mut qd) = (robot.posture, [0.0; N]);
    for _ in 0..500 {
        stepper.step(robot, 0.0, &mut q, &mut qd).expect("a step");
    }
    (stepper, q, qd)
}

fn steps(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("tulip_second_of_1ms_steps");
    group.sample_size(20);
    for (scheme_name, scheme) in
        [("moreau", Scheme::MoreauMidpoint), ("anitescu", Scheme::Anitescu { reach_m: 0.01 })]
    {
        for (name, lift) in [("standing", 0.0), ("marching", 0.3)] {
            let mut robot = Tulip::standing(lift);
            let (stepper, q, qd) = settled(&mut robot, scheme);
            let mut second = |work: &mut dyn FnMut(StepReport)| {
                let (mut stepper, mut q, mut qd) = (stepper.clone(), q, qd);
                for step in 0..STEPS {
                    let t_s = step as f64 * STEP_S;
                    work(stepper.step(&mut robot, t_s, &mut q, &mut qd).expect("a step"));
                }
            };
            let (mut closed, mut iterations) = (0, 0);
            second(&mut |report| {
                closed += report.closed;
                iterations += report.iterations;
            });
            let mean = |sum: usize| sum as f64 / STEPS as f64;
            let label = format!(
                "{scheme_name}/{name}, {:.1} contacts, {:.1} sweeps a step",
                mean(closed),
                mean(iterations)
            );
            group.bench_function(label, |b| {
                b.iter(|| second(&mut |report| _ = std::hint::black_box(report)));
            });
        }
    }
    group.finish();
}

criterion_group!(benches, steps);
criterion_main!(benches);
