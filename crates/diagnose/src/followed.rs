//! What motors before springs do where joints follow a motion: they are ahead by what springs must
//! pass on.

use super::data::ModelTorques;
use super::nominal::Nominal;
use super::signals::{Shared, Signals};
use super::state::{Effects, Taken};
use crate::policy::followed::SETTLED;
use denavit_measure::JointIndex;
use denavit_numerics::derivative;
use denavit_plants::trajectory::Reference;

/// A robot that follows motions: the nominal model with z, and effects that it has.
pub(super) struct Follower<'a> {
    pub(super) nominal: &'a Nominal<'a>,
    pub(super) z: &'a [f64],
    pub(super) effects: Effects<'a>,
    /// A log, which says what is measured, and when.
    pub(super) log: &'a Signals,
}

/// Laws beside a spring depend on the deflection that they make: so often it is found anew.
const MOST_ROUNDS: usize = 10;

impl Follower<'_> {
    /// Readings of the motors before springs at so many samples of a log whose joints follow
    /// references, lap after lap: for each joint, on its side [rad, m]. None if laws beside springs
    /// take more than these pass on, so that no deflection is found.
    pub(super) fn motors(
        &self,
        references: &[Reference],
        samples: usize,
        lap_s: f64,
    ) -> Option<Vec<Option<Vec<f64>>>> {
        let within = (self.log.log_step_s / self.log.step_s).round() as usize;
        let signals = self.settled(self.joints(references, samples * within, lap_s))?;
        let zeros = self.nominal.zeros_of_springs(self.z);
        let mut found = vec![None; references.len()];
        for (spring, zero) in self.nominal.springs.iter().zip(zeros) {
            let [angle, ..] = signals.motor[spring.joint.0].as_ref()?;
            // A sample of a log is in the middle of its cell.
            let cells = angle.iter().skip(within / 2).step_by(within);
            found[spring.joint.0] = Some(cells.map(|angle| angle + zero).collect());
        }
        Some(found)
    }

    /// The motion of the joints at the rate of laws, with motors that are not ahead of them; of
    /// which nothing was measured.
    fn joints(&self, references: &[Reference], samples: usize, lap_s: f64) -> Signals {
        let mut signals = self.log.clone();
        let offset = 0.5 * (signals.log_step_s - signals.step_s);
        let time = |k: usize| signals.step_s * k as f64 - offset;
        let t: Vec<f64> = (0..samples).map(time).collect();
        let at = |reference: &Reference| {
            let states = t.iter().map(|t| reference.at(t.rem_euclid(lap_s)));
            let states = states.map(|at| [at.position, at.rate, at.acceleration]);
            states.collect::<Vec<[f64; 3]>>()
        };
        let motions: Vec<Vec<[f64; 3]>> = references.iter().map(at).collect();
        let [q, qd, qdd] = [0, 1, 2].map(|order| -> Vec<Shared> {
            let of = |motion: &Vec<[f64; 3]>| motion.iter().map(|at| at[order]).collect();
            motions.iter().map(|motion| Shared::new(of(motion))).collect()
        });
        signals.motor = (0..references.len())
            .map(|joint| {
                self.nominal.spring_equation(JointIndex(joint))?;
                Some([&q, &qd, &qdd].map(|all| all[joint].clone()))
            })
            .collect();
        signals.rests = vec![Vec::new(); references.len()];
        signals.measured = vec![None; references.len()];
        signals.torque = vec![None; references.len()];
        (signals.t, signals.q, signals.qd, signals.qdd) = (t, q, qd, qdd);
        signals
    }

    /// The motion with motors so far ahead that springs, and laws beside them, pass on what their
    /// joints take.
    fn settled(&self, mut signals: Signals) -> Option<Signals> {
        let nominal = self.nominal;
        let joints = nominal.model.joints.len();
        let stiffness = nominal.phi(self.z).springs;
        for _ in 0..MOST_ROUNDS {
            let torques = ModelTorques::new(nominal, &signals, self.z).beside(
                nominal,
                &signals,
                self.effects,
            );
            let mut missed = torques.total[joints..].to_vec();
            for Taken { candidate, values } in self.effects.taken {
                let law = &self.effects.candidates[*candidate].law;
                let response = law.response(torques.motion(nominal, &signals), values);
                for (equation, torque) in response.equations.iter().zip(&response.torque) {
                    let Some(spring) = equation.checked_sub(joints) else { continue };
                    missed[spring].iter_mut().zip(torque).for_each(|(sum, more)| *sum += more);
                }
            }
            let mut is_settled = true;
            for ((spring, missed), stiffness) in nominal.springs.iter().zip(missed).zip(&stiffness)
            {
                let change: Vec<f64> = missed.iter().map(|torque| torque / stiffness).collect();
                is_settled &= move_motor(&mut signals, spring.joint, &change)?;
            }
            if is_settled {
                return Some(signals);
            }
        }
        None
    }
}

/// Moves a motor further ahead; whether that hardly changed its deflection. None without a motor,
/// or without a finite change.
fn move_motor(signals: &mut Signals, joint: JointIndex, change: &[f64]) -> Option<bool> {
    let step_s = signals.step_s;
    let rate = derivative(change, step_s);
    let acceleration = derivative(&rate, step_s);
    let motor = signals.motor[joint.0].as_mut()?;
    for (own, more) in motor.iter_mut().zip([change, &rate, &acceleration]) {
        Shared::make_mut(own).iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
    }
    let [deflection, _] = signals.deflection(joint)?;
    let largest = |all: &[f64]| all.iter().fold(0.0_f64, |most, one| most.max(one.abs()));
    let (changed, all) = (largest(change), largest(&deflection));
    changed.is_finite().then_some(changed <= SETTLED * all)
}
