//! A drive behind a transmission that gives way: what of its torque reaches the joint.
//!
//! The log has the torque of the drive and the position of the joint. So the rotor is moved along
//! the log, by that torque, by its friction, and by what the transmission passes on where it is
//! pressed:
//!
//! ```text
//! I th'' = tau - off - fv th' - fc sgn(th') - T,   T = c s' + k s + d s',
//! ```
//!
//! with s how far th is ahead of q, k and d only beyond half the play, where k counts what is
//! beyond. Steps are short against the swing of a rotor on a transmission that hardly gives way,
//! and the same on all; the position of the joint is the cubic of positions and rates between
//! samples. Friction holds a rotor that it stops within a step. What reaches the joint is T.
//!
//! The same rotor on a transmission that hardly gives way is what it is compared with: that drives
//! stick while they turn around, which no model that takes the sign of a rate knows, is in both.

use super::program::LawProgram;
use super::{EffectLaw, JointSamples, LawParameter, names};
use crate::error::Error;
use crate::regression::RegressionModel;
use denavit_codegen::effect::{Effect, Transmission};
use denavit_codegen::expr::Dag;

/// Numbers of a joint's drive, on the side of the joint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drive {
    /// Inertia of the rotor [kg m^2, kg].
    pub inertia: f64,
    /// Viscous friction [N m s/rad, N s/m].
    pub viscous: f64,
    /// Coulomb friction [N m, N].
    pub coulomb: f64,
    /// A constant torque [N m, N].
    pub offset: f64,
}

impl Drive {
    /// The drives of a model's joints, by phi of what a joint's drive takes and no body does: read
    /// off the torques of a robot at rest, and of one with an acceleration of 1 and rates of 1 and
    /// 2 of one joint.
    pub fn all(model: &RegressionModel, phi: &[f64]) -> Vec<Self> {
        let joints = model.joints.len();
        let of = |joint: usize| {
            let mut motion = vec![vec![0.0; 4]; 3 * joints];
            motion[joints + joint] = vec![0.0, 0.0, 1.0, 2.0];
            motion[2 * joints + joint] = vec![0.0, 1.0, 0.0, 0.0];
            let &[offset, accelerated, slow, fast] = &model.torques(&motion, phi)[joint][..] else {
                unreachable!("a torque for each sample")
            };
            let viscous = fast - slow;
            let coulomb = slow - offset - viscous;
            Self { inertia: accelerated - offset, viscous, coulomb, offset }
        };
        (0..joints).map(of).collect()
    }

    /// What a drive takes that moves with its joint, at a sample [N m, N].
    fn rigid(&self, samples: &JointSamples<'_>, k: usize) -> f64 {
        self.inertia * samples.qdd[k] + self.friction(samples.qd[k]) + self.offset
    }

    /// Friction at a velocity [N m, N].
    pub fn friction(&self, qd: f64) -> f64 {
        let sign = if qd == 0.0 { 0.0 } else { qd.signum() };
        self.viscous * qd + self.coulomb * sign
    }
}

/// The law of a transmission: swing \[s\], play, damping and drag by the parameters.
#[derive(Clone, Debug)]
pub(super) struct TransmissionLaw(LawProgram);

/// The swing of a transmission that hardly gives way \[s\]: faster than any filter of logs passes.
pub(super) const SHORTEST_S: f64 = 0.002;

/// Steps to a swing, and most of them between samples.
const STEPS: f64 = 16.0;
const MOST_STEPS: f64 = 64.0;

/// By which share of its size a parameter is moved for a difference: far enough that impacts of
/// the rotor move by what a filter sees, since between impacts of two motions there is no slope.
const DIFFERENCE: f64 = 0.02;

impl TransmissionLaw {
    pub(super) fn new(dag: &Dag, effect: &Effect, of: Transmission) -> Result<Self, Error> {
        let entries = vec![of.swing_s, of.play, of.damping, of.drag, of.joint_friction];
        Ok(Self(LawProgram::new(dag, &names(effect), Vec::new(), entries)?))
    }

    /// The transmission with these values.
    fn at(&self, values: &[f64]) -> GivesWay {
        let entries = self.0.run(&[], values, 1);
        let [swing_s, play, damping, drag, joint_friction] =
            [0, 1, 2, 3, 4].map(|place| entries[place][0]);
        GivesWay { swing_s, play, damping, drag, joint_friction }
    }

    /// The rotor with these values on its way along samples; none where the transmission hardly
    /// gives way.
    fn rotor(&self, drive: Drive, values: &[f64]) -> Option<Rotor> {
        let way = self.at(values);
        let GivesWay { swing_s, play, damping, drag, .. } = way;
        let drive = way.split(drive).0;
        let gives_way = swing_s > SHORTEST_S || play > 0.0;
        let (swing_s, half) = (swing_s.max(SHORTEST_S), 0.5 * play);
        let rotor = Rotor { drive, swing_s, damping, drag, half };
        (gives_way && drive.inertia > 0.0).then_some(rotor)
    }
}

#[derive(Clone, Copy)]
struct Rotor {
    drive: Drive,
    swing_s: f64,
    damping: f64,
    drag: f64,
    half: f64,
}

/// Rotors that are moved side by side.
const LANES: usize = 4;

impl Rotor {
    /// What reaches the joint of each rotor at each sample [N m, N].
    fn all_along(rotors: &[Self], samples: &JointSamples<'_>) -> Vec<Vec<f64>> {
        let lanes = |rotors: &[Self]| -> Vec<Vec<f64>> {
            let means =
                Self::along(std::array::from_fn(|k| rotors[k.min(rotors.len() - 1)]), samples);
            let of_lane = |lane: usize| {
                // of the steps before a sample and of those behind it
                let mean =
                    |k: usize| 0.5 * (means[k][lane] + means[(k + 1).min(means.len() - 1)][lane]);
                (0..means.len()).map(mean).collect()
            };
            (0..rotors.len()).map(of_lane).collect()
        };
        rotors.chunks(LANES).flat_map(lanes).collect()
    }

    /// What reaches the joints of a few rotors: for each sample the mean of the steps before it,
    /// which are the same for all, so that what differs is no error of theirs.
    fn along(rotors: [Self; LANES], samples: &JointSamples<'_>) -> Vec<[f64; LANES]> {
        let JointSamples { t, q, qd, tau, .. } = *samples;
        let stiffness = rotors.map(|one| one.drive.inertia / (one.swing_s * one.swing_s));
        let damping = rotors.map(|one| 2.0 * one.damping * one.drive.inertia / one.swing_s);
        let first = rotors.map(|one| tau[0] - one.drive.rigid(samples, 0));
        let mut position: [f64; LANES] = std::array::from_fn(|lane| {
            q[0] + rotors[lane].half.copysign(first[lane]) + first[lane] / stiffness[lane]
        });
        // rates are those between positions: a leapfrog
        let mut rate = [qd[0]; LANES];
        let mut means = vec![first];
        for k in 1..t.len() {
            let step_s = t[k] - t[k - 1];
            let steps = (STEPS * step_s / SHORTEST_S).ceil().clamp(1.0, MOST_STEPS);
            let h = step_s / steps;
            let gained = rotors.map(|one| h / one.drive.inertia);
            let mut sum = [0.0; LANES];
            for step in 0..steps as usize {
                let u = step as f64 / steps;
                let joint = between([q[k - 1], q[k]], [qd[k - 1], qd[k]], u, step_s);
                let torque = tau[k - 1] + u * (tau[k] - tau[k - 1]);
                for (lane, Self { drive, drag, half, .. }) in rotors.iter().enumerate() {
                    let (ahead, faster) = (position[lane] - joint[0], rate[lane] - joint[1]);
                    let beyond = ahead - ahead.clamp(-half, *half);
                    let pressed = stiffness[lane] * beyond + damping[lane] * faster;
                    let pressed = if beyond == 0.0 { 0.0 } else { pressed };
                    let reaches = drag * drive.inertia * faster + pressed;
                    let driven = torque - drive.offset - drive.viscous * rate[lane] - reaches;
                    let free = rate[lane] + gained[lane] * driven;
                    // an estimate may be below 0, and friction pushes nothing
                    let most = (gained[lane] * drive.coulomb).max(0.0);
                    rate[lane] = free - free.clamp(-most, most);
                    position[lane] += h * rate[lane];
                    sum[lane] += reaches;
                }
            }
            means.push(sum.map(|sum| sum / steps));
        }
        means
    }
}

/// Position and rate of the cubic with these ends, a share of the step from the first one.
fn between(q: [f64; 2], qd: [f64; 2], u: f64, step_s: f64) -> [f64; 2] {
    let (slope, rise) = (qd.map(|rate| step_s * rate), q[1] - q[0]);
    let (square, cube) = (3.0 * rise - 2.0 * slope[0] - slope[1], slope[0] + slope[1] - 2.0 * rise);
    let position = q[0] + u * (slope[0] + u * (square + u * cube));
    [position, (slope[0] + u * (2.0 * square + 3.0 * u * cube)) / step_s]
}

impl EffectLaw {
    /// Whether the law is of what is between the drive and the joint.
    pub fn is_transmission(&self) -> bool {
        self.transmission().is_some()
    }

    /// Whether the law is of a transmission that has play where its parameters start.
    pub fn has_play(&self) -> bool {
        let start = |one: &LawParameter| one.start.first().copied().or(one.nominal).unwrap_or(0.0);
        let starts: Vec<f64> = self.parameters.iter().map(start).collect();
        self.gives_way(&starts).is_some_and(|one| one.play > 0.0)
    }

    /// The transmission with these values of the parameters; none of other laws.
    pub fn gives_way(&self, values: &[f64]) -> Option<GivesWay> {
        Some(self.transmission()?.at(values))
    }

    fn transmission(&self) -> Option<&TransmissionLaw> {
        self.channel.as_ref()?.transmission.as_ref()
    }

    /// What a transmission adds to the torque that is logged, and the share that it passes on of
    /// what a stiff one would; none where it hardly gives way, and of other laws. The drive's
    /// numbers are among the samples.
    pub fn through(&self, samples: &JointSamples<'_>, values: &[f64]) -> Option<Transmitted> {
        let rotor = self.rotor(samples, values).filter(|_| samples.t.len() > 1)?;
        let rigid = Rotor { swing_s: SHORTEST_S, half: 0.0, ..rotor };
        let mut both = Rotor::all_along(&[rigid, rotor], samples).into_iter();
        let (rigid, passed) = both.next().zip(both.next())?;
        let size = |torque: &[f64]| torque.iter().map(|torque| torque.abs()).sum::<f64>();
        let share = size(&passed) / size(&rigid).max(f64::MIN_POSITIVE);
        let torque = rigid.iter().zip(&passed).map(|(rigid, passed)| rigid - passed).collect();
        Some(Transmitted { share, torque, passed })
    }

    /// The derivatives of what it adds by each parameter, from differences.
    pub fn through_gradient(
        &self,
        samples: &JointSamples<'_>,
        values: &[f64],
        Transmitted { passed, .. }: &Transmitted,
    ) -> Vec<Vec<f64>> {
        let step = |place: usize| self.parameters[place].step(values[place], DIFFERENCE);
        let moved = |place: usize| {
            let mut moved = values.to_vec();
            moved[place] += step(place);
            self.rotor(samples, &moved)
        };
        let rotors: Vec<Option<Rotor>> = (0..values.len()).map(moved).collect();
        let moving: Vec<Rotor> = rotors.iter().flatten().copied().collect();
        let mut all = Rotor::all_along(&moving, samples).into_iter();
        let by = |(place, rotor): (usize, Option<Rotor>)| -> Vec<f64> {
            let moved = rotor.and_then(|_| all.next()).unwrap_or_else(|| passed.clone());
            passed.iter().zip(moved).map(|(a, b)| (a - b) / step(place)).collect()
        };
        rotors.into_iter().enumerate().map(by).collect()
    }

    fn rotor(&self, samples: &JointSamples<'_>, values: &[f64]) -> Option<Rotor> {
        self.transmission()?.rotor(samples.drive, values)
    }
}

/// How a transmission gives way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GivesWay {
    /// Root of the inertia times the compliance \[s\]: of the rotor where the position is the
    /// joint's, else of the bodies.
    pub swing_s: f64,
    /// The play, from one side to the other [rad, m].
    pub play: f64,
    /// The damping of the rotor, as a share of the critical one.
    pub damping: f64,
    /// What the sides drag each other along by, over inertia and difference in velocity \[1/s\].
    pub drag: f64,
    /// The share of the drive's friction that brakes the joint instead.
    pub joint_friction: f64,
}

impl GivesWay {
    /// A drive with the friction that is its own, and one that has what brakes the joint alone.
    pub fn split(&self, drive: Drive) -> (Drive, Drive) {
        let of = |share: f64, drive: Drive| Drive {
            viscous: share * drive.viscous,
            coulomb: share * drive.coulomb,
            ..drive
        };
        let braked = Drive { inertia: 0.0, offset: 0.0, ..drive };
        (of(1.0 - self.joint_friction, drive), of(self.joint_friction, braked))
    }
}

/// What a transmission makes of a drive's torque.
#[derive(Clone, Debug)]
pub struct Transmitted {
    /// What is logged more than a drive on a transmission that hardly gives way would need, at each
    /// sample [N m, N].
    pub torque: Vec<f64>,
    /// What reaches the joint [N m, N].
    pub passed: Vec<f64>,
    /// What reaches the joint, as a share of what would through a transmission that hardly gives
    /// way (means of absolute values).
    pub share: f64,
}
