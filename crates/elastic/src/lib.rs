//! Robots with series elastic drives in two stages (thesis 3.3.2).
//!
//! 1. Each spring with the friction of its motor, from motor torque, motor angle and joint angle
//!    alone (3.23):
//!    tau_M - Ia th'' = fv th' + fc sgn(th') + (r_M / N) (k (r_M th / N - r_L q) + F0).
//!    The encoders of motor and joint need not be 0 together: F0 is the force of the spring where
//!    both read 0.
//! 2. The springs then measure the torque on their joints,
//!    tau_L = r_L (k (r_M th / N - r_L q) + F0) (3.24), and these joints join the stiff ones, whose
//!    motors measure it (3.17), in one regression of the base parameters (3.25).
//!
//! Both sides of each equation pass the same zero-phase filter. Residuals of motion are correlated
//! in time, so that covariances are those of sums over blocks which are long against the
//! correlation, as of any estimate. The uncertainty of the springs goes on into the
//! loads: with d = phi(k + s) - phi(k), s the deviation of k and F0 along a column of the root of
//! their covariance, the covariance of phi grows by d d^T.

mod policy;
mod readings;

use denavit_identify::estimate::{self, OneEquation, SlowRows, estimate};
use denavit_identify::{Error, ErrorKind};
use denavit_measure::JointIndex;
use denavit_measure::condition::{Conditioned, Conditioning};
use denavit_measure::log::{JointSignals, MeasuredLog};
use denavit_numerics::least_squares::Triangle;
use denavit_numerics::rms;
use denavit_plants::regression::{CoulombLaw, RegressionModel};
use denavit_plants::{DriveModel, PlantModel, SeriesElasticModel};

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The number.
    pub value: f64,
    /// Its standard deviation.
    pub std: f64,
}

/// Spring and motor friction of one joint: a row of table 3.5.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring {
    /// The joint's name.
    pub joint: String,
    /// Viscous friction of the motor [N m s/rad].
    pub viscous: Estimate,
    /// Coulomb friction of the motor [N m].
    pub coulomb: Estimate,
    /// [N/m].
    pub stiffness: Estimate,
    /// The spring's force where both encoders read 0 \[N\].
    pub preload: Estimate,
    /// The covariance of stiffness and preload \[N^2/m\].
    pub covariance: f64,
    /// The motor's reading where the spring is relaxed and the joint reads 0 \[rad\].
    pub motor_zero: Estimate,
    /// Root mean square of what the equation misses \[N m\].
    pub residual: f64,
    /// Root mean square of its left side \[N m\].
    pub torque: f64,
}

impl Spring {
    /// The columns of the root of the covariance of stiffness and preload.
    fn deviations(&self) -> [[f64; 2]; 2] {
        let along = self.covariance / self.stiffness.std.max(f64::MIN_POSITIVE);
        let across = (self.preload.std.powi(2) - along * along).max(0.0).sqrt();
        [[self.stiffness.std, along], [0.0, across]]
    }
}

/// What both stages came to.
#[derive(Clone, Debug)]
pub struct TwoStage {
    /// The elastic joints, in the order of q.
    pub springs: Vec<Spring>,
    /// The base parameters of kept columns.
    pub listed: Vec<Estimate>,
    /// The estimate of those on the joint axes, with the uncertainty of the springs in its
    /// covariance.
    pub load: estimate::Estimate,
    /// For each joint the deviation of what its equation misses, and the root mean square of its
    /// torque [N m, N].
    pub residuals: Vec<[f64; 2]>,
}

/// Blocks over which scores are summed.
const BLOCKS: usize = 50;

/// How two stages go about a log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TwoStageOptions {
    /// The conditioning for springs and motors: it has no acceleration of a joint in it, and needs
    /// the reversals of friction.
    pub of_springs: Conditioning,
    /// The conditioning for the load.
    pub of_load: Conditioning,
    /// Which rows are left out, of joints and motors; the rate is that of a joint, and of motors
    /// [`SlowRows::Noise`] leaves out what biases.
    pub slow: SlowRows,
}

/// Identifies a robot whose plant says which joints are elastic, with the law of Coulomb friction
/// of `model` for joints and motors alike. The log has positions of joints, angles of the motors of
/// elastic ones, torques of stiff joints and those of the motors of elastic ones. Rotor inertias,
/// gear ratios and radii are known (thesis 3.3.1).
pub fn two_stage(
    plant: &PlantModel,
    model: &RegressionModel,
    log: &MeasuredLog,
    how: &TwoStageOptions,
) -> Result<TwoStage, Error> {
    let elastic = elastic_joints(plant)?;
    if elastic.is_empty() {
        let text = "the model has no series elastic drive";
        return Err(Error::new(ErrorKind::Unsuitable, text));
    }
    let measured = measured(plant, &elastic, log)?;
    let names: Vec<String> = plant
        .joints
        .iter()
        .map(|joint| joint.name.clone())
        .chain(elastic.iter().map(|one| format!("motor_{}", plant.joints[one.joint].name)))
        .collect();
    let conditioned = |how: &Conditioning| Conditioned::new(measured.clone(), &names, how);
    let motion = Motion::new(conditioned(&how.of_springs)?, plant.joints.len());
    let mut springs = Vec::new();
    for (place, one) in elastic.iter().enumerate() {
        let (law, slow) = (model.law, how.slow);
        springs.push(one.identify(&plant.joints[one.joint].name, &motion, place, law, slow)?);
    }
    let conditioned = conditioned(&how.of_load)?;
    let step = |joint: &JointSignals| joint.step.unwrap_or(0.0) / 12.0_f64.sqrt();
    let options = estimate::Options {
        slow: how.slow,
        position_noise: log.joints.iter().map(step).collect(),
        ..estimate::Options::default()
    };
    let load = Load { plant, model, conditioned: &conditioned, elastic: &elastic, options };
    load.identify(springs)
}

/// A drive with a spring.
#[derive(Clone, Copy, Debug)]
struct Elastic {
    joint: usize,
    drive: DriveModel,
    spring: SeriesElasticModel,
}

fn elastic_joints(plant: &PlantModel) -> Result<Vec<Elastic>, Error> {
    let mut elastic = Vec::new();
    for (joint, described) in plant.joints.iter().enumerate() {
        let Some(drive) = described.drive else { continue };
        let Some(spring) = drive.series_elastic else { continue };
        if drive.gear_ratio == 0.0 {
            let text = format!("the drive of `{}` has no gear ratio", described.name);
            return Err(Error::new(ErrorKind::Unsuitable, text));
        }
        elastic.push(Elastic { joint, drive, spring });
    }
    Ok(elastic)
}

/// The joints, then the motors of the elastic ones, as signals of one log.
fn measured(
    plant: &PlantModel,
    elastic: &[Elastic],
    log: &MeasuredLog,
) -> Result<MeasuredLog, Error> {
    let there = |values: &Option<Vec<f64>>, prefix: &str, joint: usize| {
        let missing = || Error::missing_column(format!("{prefix}_{}", plant.joints[joint].name));
        values.clone().ok_or_else(missing)
    };
    let mut joints = Vec::new();
    for (index, own) in log.joints.iter().enumerate() {
        let is_elastic = elastic.iter().any(|one| one.joint == index);
        let tau = match is_elastic {
            true => None,
            false => Some(there(&own.tau, "tau", index)?),
        };
        joints.push(JointSignals { q: own.q.clone(), tau, ..JointSignals::default() });
    }
    for one in elastic {
        let own = &log.joints[one.joint];
        let q = there(&own.motor, "motor", one.joint)?;
        let tau = Some(there(&own.motor_torque, "tau_cmd", one.joint)?);
        joints.push(JointSignals { q, tau, ..JointSignals::default() });
    }
    let MeasuredLog { start_s, step_s, .. } = *log;
    Ok(MeasuredLog { file: log.file.clone(), start_s, step_s, joints, ..MeasuredLog::default() })
}

/// What the first stage needs of the conditioned samples that count.
struct Motion {
    conditioned: Conditioned,
    /// Of each joint.
    positions: Vec<Vec<f64>>,
    /// Angle, rate and acceleration of each motor of an elastic joint.
    motors: Vec<[Vec<f64>; 3]>,
    /// Torques of these motors.
    torques: Vec<Vec<f64>>,
}

impl Motion {
    fn new(conditioned: Conditioned, joints: usize) -> Self {
        let range = conditioned.range.clone();
        let mut all = Vec::new();
        conditioned.motion(range.clone(), &mut all);
        let count = conditioned.joints();
        let motor = |at: usize| [0, 1, 2].map(|order| all[order * count + at].clone());
        let torque = |at: usize| {
            conditioned.torque[at].as_ref().map_or(Vec::new(), |t| t[range.clone()].to_vec())
        };
        Self {
            motors: (joints..count).map(motor).collect(),
            torques: (joints..count).map(torque).collect(),
            positions: all[..joints].to_vec(),
            conditioned,
        }
    }

    /// Friction of size 1 of the motor that is the `place`-th, after the filter; a law is that of
    /// joints: motors turn so many times as fast.
    fn friction(&self, place: usize, law: CoulombLaw, turns: f64) -> Vec<f64> {
        let (motor, range) = (self.positions.len() + place, self.conditioned.range.clone());
        self.conditioned.of_rate(JointIndex(motor), range, |rate| law.of(rate / turns))
    }

    /// Samples in which a motor does not show its friction; none if they are to count.
    fn slow(&self, place: usize, slow: SlowRows, turns: f64) -> Option<Vec<bool>> {
        let motor = JointIndex(self.positions.len() + place);
        match slow {
            SlowRows::Kept => None,
            SlowRows::Below(rate) => Some(self.conditioned.slow(motor, rate * turns, 1)),
            SlowRows::Biasing | SlowRows::Noise => self.conditioned.near_reversals(motor, 1.0),
        }
    }
}

impl Elastic {
    /// The elongation of the spring \[m\] (3.18).
    fn elongation(&self, motor: f64, q: f64) -> f64 {
        let SeriesElasticModel { motor_radius, load_radius, .. } = self.spring;
        motor_radius * motor / self.drive.gear_ratio - load_radius * q
    }

    /// Turns of the motor for one of the joint, the spring being relaxed.
    fn turns(&self) -> f64 {
        self.drive.gear_ratio * self.spring.load_radius / self.spring.motor_radius
    }

    /// The first stage (3.23).
    fn identify(
        &self,
        name: &str,
        motion: &Motion,
        place: usize,
        law: CoulombLaw,
        slow: SlowRows,
    ) -> Result<Spring, Error> {
        let [angles, rates, accelerations] = &motion.motors[place];
        readings::check_angles(name, angles, &motion.positions[self.joint], self.turns())?;
        let lever = self.spring.motor_radius / self.drive.gear_ratio;
        let turns = self.drive.gear_ratio.abs();
        let pairs = angles.iter().zip(&motion.positions[self.joint]);
        let columns = [
            rates.clone(),
            motion.friction(place, law, turns),
            pairs.map(|(motor, q)| lever * self.elongation(*motor, *q)).collect::<Vec<f64>>(),
            vec![lever; rates.len()],
        ];
        let inertia = self.drive.rotor_inertia;
        let of_model = accelerations.iter().zip(&columns[2]);
        let of_model: Vec<f64> =
            of_model.map(|(a, e)| inertia * a + self.spring.stiffness * e).collect();
        readings::check_torque(name, &motion.torques[place], &of_model, self.turns())?;
        let left = motion.torques[place].iter().zip(accelerations);
        let left: Vec<f64> = left.map(|(torque, a)| torque - inertia * a).collect();
        let is_left_out = match law {
            CoulombLaw::Sign => motion.slow(place, slow, turns),
            CoulombLaw::Tanh(_) => None,
        };
        let all: Vec<&[f64]> = columns.iter().chain([&left]).map(Vec::as_slice).collect();
        let OneEquation { values, covariance, residual } = solved(&all, 1, is_left_out)
            .ok_or_else(|| not_excited(&format!("the spring of `{name}`")))?;
        let estimate =
            |at: usize| Estimate { value: values[at], std: covariance[(at, at)].max(0.0).sqrt() };
        let (stiffness, preload) = (estimate(2), estimate(3));
        readings::check_stiffness(name, stiffness)?;
        // r_M th / N + F0 / k = 0, to first order
        let zero = -preload.value / (stiffness.value * lever);
        let slopes = [-zero / stiffness.value, -1.0 / (stiffness.value * lever)];
        let shared = covariance[(2, 3)];
        let variance = (slopes[0] * stiffness.std).powi(2)
            + (slopes[1] * preload.std).powi(2)
            + 2.0 * slopes[0] * slopes[1] * shared;
        Ok(Spring {
            joint: name.to_owned(),
            viscous: estimate(0),
            coulomb: estimate(1),
            stiffness,
            preload,
            covariance: shared,
            motor_zero: Estimate { value: zero, std: variance.max(0.0).sqrt() },
            residual,
            torque: rms(&left),
        })
    }
}

/// The second stage.
struct Load<'a> {
    plant: &'a PlantModel,
    model: &'a RegressionModel,
    /// The joints, then the motors of the elastic ones.
    conditioned: &'a Conditioned,
    elastic: &'a [Elastic],
    options: estimate::Options,
}

impl Load<'_> {
    fn identify(&self, springs: Vec<Spring>) -> Result<TwoStage, Error> {
        let forces: Vec<[f64; 2]> =
            springs.iter().map(|one| [one.stiffness.value, one.preload.value]).collect();
        let mut found = self.estimate(&forces)?;
        let phi = found.solution.phi.clone();
        let mut covariance = found.covariance.clone();
        for (place, spring) in springs.iter().enumerate() {
            for step in spring.deviations() {
                let mut moved = forces.clone();
                moved[place] = [0, 1].map(|at| moved[place][at] + step[at]);
                let direction = self.estimate(&moved)?.solution.phi - &phi;
                covariance += &direction * direction.transpose();
            }
        }
        let to = self.model.to_listed();
        let (values, spread) = (to * &phi, to * &covariance * to.transpose());
        let listed = (0..values.len())
            .map(|at| Estimate { value: values[at], std: spread[(at, at)].max(0.0).sqrt() });
        let listed = listed.collect();
        let torques = self.loads(&forces).torque;
        let size = |torque: &Option<Vec<f64>>| rms(torque.as_deref().unwrap_or_default());
        let noise = found.noise_of_joints().into_iter();
        let residuals = noise.zip(&torques).map(|(noise, t)| [noise, size(t)]).collect();
        found.covariance = covariance;
        Ok(TwoStage { springs, listed, load: found, residuals })
    }

    fn estimate(&self, forces: &[[f64; 2]]) -> Result<estimate::Estimate, Error> {
        let logs = [self.loads(forces)];
        let start = vec![0.0; self.model.rank()];
        let found = estimate(self.model, &logs, &[], &self.options, &start)?;
        match found.solution.excited() == self.model.rank() {
            true => Ok(found),
            false => Err(not_excited("the load")),
        }
    }

    /// The log of the joints alone, with the torques on the loads: those of the springs (3.24),
    /// and those of stiff drives without the known inertia of their rotors.
    fn loads(&self, forces: &[[f64; 2]]) -> Conditioned {
        let n = self.plant.joints.len();
        let mut loads = self.conditioned.clone();
        let range = loads.range.clone();
        let mut motion = Vec::new();
        loads.motion(range.clone(), &mut motion);
        let all = loads.joints();
        let motors = loads.q.split_off(n);
        loads.torque.truncate(n);
        for rates in loads.rates.iter_mut().flatten() {
            rates.truncate(n);
        }
        for (joint, described) in self.plant.joints.iter().enumerate() {
            if let Some(place) = self.elastic.iter().position(|one| one.joint == joint) {
                let one = &self.elastic[place];
                let angles = motors[place].iter().zip(&loads.q[joint]);
                let (radius, [stiffness, preload]) = (one.spring.load_radius, forces[place]);
                let force = |motor, q| stiffness * one.elongation(motor, q) + preload;
                let torque = angles.map(|(motor, q)| radius * force(*motor, *q));
                loads.torque[joint] = Some(torque.collect());
            } else if let Some(torque) = &mut loads.torque[joint] {
                let reflected = |drive: &DriveModel| drive.gear_ratio.powi(2) * drive.rotor_inertia;
                let reflected = described.drive.as_ref().map_or(0.0, reflected);
                let accelerations = &motion[2 * all + joint];
                for (torque, a) in torque[range.clone()].iter_mut().zip(accelerations) {
                    *torque -= reflected * a;
                }
            }
        }
        loads
    }
}

/// Least squares of columns, the last being what the others are to give. Of the friction in a
/// column rows that bias it more than its error says are left out. None if a column depends on
/// others.
fn solved(columns: &[&[f64]], friction: usize, left_out: Option<Vec<bool>>) -> Option<OneEquation> {
    let found = in_blocks(columns)?;
    let Some(left_out) = left_out else { return Some(found) };
    let count = |column: &&[f64]| -> Vec<f64> {
        let all = column.iter().zip(&left_out).filter(|(_, left_out)| !**left_out);
        all.map(|(entry, _)| *entry).collect()
    };
    let counted: Vec<Vec<f64>> = columns.iter().map(count).collect();
    let share = 1.0 - counted[0].len() as f64 / left_out.len().max(1) as f64;
    let variance = found.covariance[(friction, friction)];
    let is_biased = estimate::is_biased(share, found.values[friction], variance);
    let counted: Vec<&[f64]> = counted.iter().map(Vec::as_slice).collect();
    Some(if is_biased { in_blocks(&counted).unwrap_or(found) } else { found })
}

/// The same of all rows, in blocks of time.
fn in_blocks(columns: &[&[f64]]) -> Option<OneEquation> {
    let rows = columns[0].len();
    let blocks = BLOCKS.min(rows / 4).max(1);
    let part = |block: usize| {
        let range = block * rows / blocks..(block + 1) * rows / blocks;
        let own: Vec<&[f64]> = columns.iter().map(|column| &column[range.clone()]).collect();
        let mut triangle = Triangle::new(columns.len() - 1);
        triangle.push(&own);
        triangle
    };
    OneEquation::of_parts((0..blocks).map(part).collect())
}

fn not_excited(what: &str) -> Error {
    let text = format!("the motion does not tell the parameters of {what} apart");
    Error::new(ErrorKind::NotExcited, text)
}
