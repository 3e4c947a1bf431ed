//! Closed loop: joints that follow a planned step in the simulator.

use super::legs::Leg;
use super::planned::{PlannedPhase, PlannedStep};
use super::stance_foot::StanceFoot;
use crate::error::{DesignError, Error};
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::{Control, JointControl, Run, Simulation, State, simulate};

/// Gains of a leg's joints: hip, knee, ankle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gains {
    /// Stiffness while the leg's foot is on the ground [N m/rad].
    pub carrying: [f64; 3],
    /// While it is in the air [N m/rad].
    pub flying: [f64; 3],
    /// Damping over stiffness \[s\].
    pub damping_s: f64,
}

impl Gains {
    /// One stiffness for a leg that carries. In the air a joint is as stiff as that, but no stiffer
    /// than damps it well: at touchdown velocities jump a little sooner or later than planned, and
    /// a stiff ankle would throw its foot off the ground again.
    pub fn of_stiffness(
        plant: &mut dyn Plant,
        step: &PlannedStep,
        stiffness: f64,
        damping_s: f64,
    ) -> Result<Self, Error> {
        let inertia = moved_inertias(plant, step)?;
        let leg = step.legs.swing;
        let flying = [leg.hip, leg.knee, leg.ankle]
            .map(|joint| stiffness.min(inertia[joint] / (damping_s * damping_s)));
        Ok(Self { carrying: [stiffness; 3], flying, damping_s })
    }
}

/// The inertia that each joint moves at mid-swing while the others stand still and the stance foot
/// stays on the ground [kg m^2].
fn moved_inertias(plant: &mut dyn Plant, step: &PlannedStep) -> Result<Vec<f64>, Error> {
    let legs = step.legs.clone();
    let n = legs.coordinates;
    let [q, ..] = step.motion(step.mid_swing().1).map_err(DesignError::Reference)?;
    let mut mass = vec![0.0; n * n];
    plant.mass_matrix(&q, &mut mass);
    let mut foot = StanceFoot::at_mid_swing(step);
    let mut inertias = vec![0.0; n];
    for joint in &legs.driven {
        let mut qd = vec![0.0; n];
        qd[*joint] = 1.0;
        foot.hold_velocities(plant, &q, &mut qd);
        let row = |i: usize| (0..n).map(|j| mass[i * n + j] * qd[j]).sum::<f64>();
        inertias[*joint] = (0..n).map(|i| qd[i] * row(i)).sum();
    }
    Ok(inertias)
}

/// The law of a joint in numbers: stiffness and damping, and the factor of both in each phase of
/// two steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct JointGains {
    pub(super) stiffness: f64,
    pub(super) damping: f64,
    pub(super) factors: [Vec<f64>; 2],
}

/// The gains of a joint: those of a leg that carries, with a factor for the phases in which it
/// flies.
pub(super) fn joint_gains(step: &PlannedStep, gains: &Gains, joint: usize) -> JointGains {
    let legs = &step.legs;
    let place = |leg: Leg, coordinate| {
        [leg.hip, leg.knee, leg.ankle].iter().position(|joint| *joint == coordinate)
    };
    let index = place(legs.stance, joint).or(place(legs.swing, joint)).unwrap_or(0);
    let (carrying, flying) = (gains.carrying[index], gains.flying[index]);
    let factors = [0, 1].map(|number| {
        let stands = place(legs.stance, step.role_of(joint, number)).is_some();
        let of = |phase: &PlannedPhase| {
            let carries = phase.closed.iter().any(|role| role.is_stance() == stands);
            if carries || carrying == 0.0 { 1.0 } else { flying / carrying }
        };
        step.phases.iter().map(of).collect()
    });
    JointGains { stiffness: carrying, damping: carrying * gains.damping_s, factors }
}

/// The control that follows a planned step, again and again.
pub fn control(
    plant: &dyn Plant,
    step: &PlannedStep,
    gains: &Gains,
) -> Result<Control, denavit_plants::Error> {
    let mut control = Control::passive(plant.model().joints.len());
    for joint in &step.legs.driven {
        let law = joint_gains(step, gains, *joint);
        let factor =
            step.two_steps(|phase, number| Ok(Reference::Constant(law.factors[number][phase])))?;
        control.joints[*joint] = JointControl {
            reference: Some(step.reference(*joint)?),
            feed_forward: Some(step.feed_forward(*joint)?),
            gain_factor: Some(factor),
            stiffness: law.stiffness,
            damping: law.damping,
            ..JointControl::default()
        };
    }
    Ok(control)
}

/// How a step is simulated: rigid contacts that do not slip, with Coulomb's law where that has no
/// answer.
pub fn simulation(end_s: f64, log_period_s: f64) -> Simulation {
    let accuracy = Accuracy { relative: 1e-7, absolute: 1e-8, max_step_s: 0.02 };
    let mut simulation = Simulation {
        end_s,
        method: Method::Radau(accuracy),
        log_period_s,
        ..Simulation::default()
    };
    simulation.touching.fallback_friction = Some(0.8);
    simulation
}

/// What became of a walk.
#[derive(Clone, Debug, PartialEq)]
pub struct Walk {
    /// The run.
    pub run: Run,
    /// Whole steps walked.
    pub steps: usize,
    /// Speed over the second half of the walk [m/s].
    pub speed_m_s: f64,
    /// Integral of the absolute joint power over weight and distance, over the same time.
    pub cost_of_transport: f64,
    /// Integral of the squared torques over the distance, over the same time [N^2 m s].
    pub torque_squared: f64,
    /// The largest torque of a joint \[N m\].
    pub torque_nm: f64,
}

/// Walks so many steps from a state.
pub fn walk(
    plant: &mut dyn Plant,
    step: &PlannedStep,
    gains: &Gains,
    start: &State,
    steps: usize,
) -> Result<Walk, Error> {
    let control = control(plant, step, gains).map_err(DesignError::Reference)?;
    let end_s = start.t_s + steps as f64 * step.period_s;
    let simulation = simulation(end_s, step.period_s / 400.0);
    let run = simulate(plant, &control, start, &simulation).map_err(DesignError::Start)?;
    let walked = (run.end.t_s - start.t_s) / step.period_s + 1e-9;
    let half = start.t_s + 0.5 * steps as f64 * step.period_s;
    let figures = Figures::of(&run, step, plant.model(), half);
    Ok(Walk {
        steps: walked.floor() as usize,
        speed_m_s: figures.distance_m / figures.time_s,
        cost_of_transport: figures.work_j
            / (step.legs.mass_kg * step.legs.gravity * figures.distance_m),
        torque_squared: figures.squared / figures.distance_m,
        torque_nm: figures.torque_nm,
        run,
    })
}

/// Sums over a log.
#[derive(Default)]
struct Figures {
    time_s: f64,
    distance_m: f64,
    work_j: f64,
    squared: f64,
    torque_nm: f64,
}

impl Figures {
    fn of(run: &Run, step: &PlannedStep, model: &denavit_plants::PlantModel, from_s: f64) -> Self {
        let log = &run.log;
        let column = |name: String| log.column(&name).unwrap_or_default();
        let times = column("t".to_owned());
        let name = |joint: usize| model.joints[joint].name.as_str();
        let place = column(format!("q_{}", name(step.legs.base_x)));
        let mut figures = Self::default();
        let first = times.partition_point(|t| *t < from_s - 1e-9);
        if times.len() < first + 2 {
            return Self { time_s: 1.0, distance_m: f64::NAN, ..figures };
        }
        let last = times.len() - 1;
        figures.time_s = times[last] - times[first];
        figures.distance_m = place[last] - place[first];
        for joint in &step.legs.driven {
            let torques = column(format!("tau_{}", name(*joint)));
            let rates = column(format!("qd_{}", name(*joint)));
            figures.torque_nm = torques.iter().fold(figures.torque_nm, |m, t| m.max(t.abs()));
            for row in first..last {
                let h = times[row + 1] - times[row];
                let [a, b] = [row, row + 1].map(|row| (torques[row] * rates[row]).abs());
                figures.work_j += 0.5 * h * (a + b);
                figures.squared += 0.5 * h * (torques[row].powi(2) + torques[row + 1].powi(2));
            }
        }
        figures
    }
}
