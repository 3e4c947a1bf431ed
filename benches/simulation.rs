//! How long simulated seconds take.
//!
//! Time stepping: TUlip with 18 degrees of freedom, 8 contact points, a PD controller on its twelve
//! joints, h = 1 ms. From event to event: parts of shipped scenarios, with log and audits.
//!
//! A sample of time stepping is 1000 steps: one simulated second. The setting is that of the peers'
//! figures in docs/evidence/benchmarks.md: standing still, and marching on the spot.

use criterion::{Criterion, criterion_group, criterion_main};
use denavit::plants::{Plant, tulip};
use denavit::shipped;
use denavit::simulate::Control;
use denavit::simulate::contact::Space;
use denavit::simulate::contact::gauss_seidel::SweepLimits;
use denavit::simulate::scenario::RunScheme;
use denavit::simulate::time_stepping::{
    ControlledPlant, Instant, Scheme, StepLaw, StepReport, StepSolver, Stepping, Terms,
    TimeStepper, TimeSteppingModel,
};
use denavit::trajectory::{Fourier, Part, Reference, Sequence};
use denavit::walk::read_scenario;
use std::f64::consts::TAU;

const N: usize = denavit::tulip::DOF;
const STEPS: usize = 1000;

/// Bent knees, soles on the ground.
fn posture(plant: &mut dyn Plant) -> Vec<f64> {
    let mut q = vec![0.0; N];
    for leg in [6, 12] {
        q[leg + 2] = -0.3;
        q[leg + 3] = 0.6;
        q[leg + 4] = -0.3;
    }
    let mut points = vec![0.0; 24];
    plant.contact_positions(&q, &mut points);
    q[0] -= points[2];
    q
}

/// The legs are lifted in turn, half a second each, by half a period of a sine of this amplitude
/// [rad].
fn march(q: &[f64], lift: f64) -> Control {
    let reference = |joint: usize| {
        let share = [0.0, 0.0, -1.0, 2.0, -1.0, 0.0][joint.checked_sub(6)? % 6];
        let bent = Fourier::new(TAU, q[joint], vec![lift * share], vec![0.0]).expect("a series");
        let mut halves = [Reference::Fourier(bent), Reference::Constant(q[joint])];
        if joint >= 12 {
            halves.reverse();
        }
        let parts = halves.map(|reference| Part { duration_s: 0.5, reference });
        Some(Reference::Sequence(Sequence::new(parts.into(), true).expect("two parts")))
    };
    Control::proportional((0..N).map(reference).collect(), 1500.0, 30.0)
}

/// Marching without a plan falls: a soft gantry holds the torso, as in the peers' setting.
struct OnGantry<'a> {
    robot: ControlledPlant<'a>,
    posture: Vec<f64>,
    holds: bool,
}

impl TimeSteppingModel for OnGantry<'_> {
    fn dof(&self) -> usize {
        self.robot.dof()
    }

    fn contacts(&self) -> usize {
        self.robot.contacts()
    }

    fn space(&self) -> Space {
        self.robot.space()
    }

    fn gaps(&mut self, q: &[f64], gaps: &mut [f64]) {
        self.robot.gaps(q, gaps);
    }

    fn terms(&mut self, at: Instant<'_>, closed: &[usize], terms: &mut Terms) {
        self.robot.terms(at, closed, terms);
        for joint in if self.holds { 1..6 } else { 0..0 } {
            let error = self.posture[joint] - at.q[joint];
            terms.force[joint] += 500.0 * error - 50.0 * at.qd[joint];
            terms.damping[joint * N + joint] += 50.0;
        }
    }

    fn accept(&mut self, before: &[f64], after: &[f64], implicitness: f64) -> bool {
        self.robot.accept(before, after, implicitness)
    }
}

/// Stepper and state after the robot has settled.
fn settled(robot: &mut OnGantry<'_>, scheme: Scheme) -> (TimeStepper, Vec<f64>, Vec<f64>) {
    let laws = vec![StepLaw { friction: 1.0, restitution: 0.0 }; 8];
    let solver = StepSolver::Sweeps(SweepLimits { sweeps: 500, response: 1e-8 });
    let stepping = Stepping { scheme, solver, ..Stepping::default() };
    let mut stepper = TimeStepper::new(stepping, laws, robot);
    let (mut q, mut qd) = (robot.posture.clone(), vec![0.0; N]);
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
            let mut plant = tulip(&[]).expect("the generated plant");
            let posture = posture(plant.as_mut());
            let control = march(&posture, lift);
            let robot = ControlledPlant::new(plant.as_mut(), &control);
            let mut robot = OnGantry { robot, posture, holds: lift > 0.0 };
            let (stepper, q, qd) = settled(&mut robot, scheme);
            let mut second = |work: &mut dyn FnMut(StepReport)| {
                let (mut stepper, mut q, mut qd) = (stepper.clone(), q.clone(), qd.clone());
                for step in 0..STEPS {
                    let t_s = step as f64 * 1e-3;
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

/// Shipped scenarios from event to event, so many seconds of each.
fn events(criterion: &mut Criterion) {
    let load = |name: &str| {
        let model = shipped::find(name).ok_or("no such model")?;
        Ok(model.text.as_bytes().to_vec())
    };
    let mut group = criterion.benchmark_group("from_event_to_event");
    group.sample_size(10);
    for (name, duration_s) in [
        ("planar_biped_zmp_gait", 2.4),
        ("planar_biped_limit_cycle_gait", 0.9),
        ("tulip_standing", 1.0),
        ("tulip_step", 7.4),
    ] {
        let file = shipped::find_scenario(name).expect("it is shipped");
        let mut scenario =
            read_scenario(name, file.text.as_bytes(), &load).expect("shipped scenarios are sound");
        scenario.scheme = RunScheme::Event;
        scenario.simulation.end_s = duration_s;
        let run = scenario.run().expect("it begins");
        let label = format!("{name}, {duration_s} s, {} evaluations", run.statistics.evaluations);
        group.bench_function(label, |b| {
            b.iter(|| std::hint::black_box(scenario.run().expect("it begins")));
        });
    }
    group.finish();
}

criterion_group!(benches, steps, events);
criterion_main!(benches);
