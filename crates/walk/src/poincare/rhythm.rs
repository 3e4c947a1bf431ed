//! The clock of a controller: after which time it does the same again, and whether it does so after
//! half of that with the legs exchanged.

use crate::leg_exchange::LegExchange;
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;
use denavit_simulate::{Control, JointControl};

/// What a controller repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct Rhythm {
    /// The time of a cycle; none if the control does not depend on time \[s\].
    pub clock_s: Option<f64>,
    /// The exchange of the legs after each cycle; none if a cycle contains the steps of both.
    pub exchange: Option<LegExchange>,
}

/// A reference that does not repeat itself; holds the joint.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NotPeriodic(pub usize);

/// Instants at which references are compared.
const SAMPLES: usize = 97;
/// References that differ by less are alike [rad, m, N m].
const ALIKE: f64 = 1e-9;

impl Rhythm {
    /// The rhythm of a controller of a robot.
    ///
    /// # Errors
    /// A reference that does not repeat itself, or is planned during the run.
    pub fn of(plant: &mut dyn Plant, control: &Control) -> Result<Self, NotPeriodic> {
        if control.planning.is_some() {
            let planned = control.joints.iter().position(|law| law.reference.is_some());
            return Err(NotPeriodic(planned.unwrap_or(0)));
        }
        let mut stride_s: f64 = 0.0;
        for (joint, law) in control.joints.iter().enumerate() {
            for reference in followed(law) {
                stride_s = stride_s.max(reference.period_s().ok_or(NotPeriodic(joint))?);
            }
        }
        for (joint, law) in control.joints.iter().enumerate() {
            let divides = |reference: &Reference| {
                let period_s = reference.period_s().unwrap_or(0.0);
                let rounds = if period_s > 0.0 { stride_s / period_s } else { 1.0 };
                (rounds - rounds.round()).abs() < 1e-9
            };
            if !followed(law).all(divides) {
                return Err(NotPeriodic(joint));
            }
        }
        let exchange = LegExchange::find(plant);
        if stride_s == 0.0 {
            return Ok(Self { clock_s: None, exchange });
        }
        let half_s = 0.5 * stride_s;
        let exchange = exchange.filter(|exchange| alternates(control, exchange, half_s));
        let clock_s = if exchange.is_some() { half_s } else { stride_s };
        Ok(Self { clock_s: Some(clock_s), exchange })
    }
}

fn followed(law: &JointControl) -> impl Iterator<Item = &Reference> {
    [&law.reference, &law.feed_forward, &law.gain_factor].into_iter().flatten()
}

/// Whether each leg does after half a stride what the other one does now.
fn alternates(control: &Control, exchange: &LegExchange, half_s: f64) -> bool {
    let pairs = exchange.coordinates.iter().zip(&exchange.signs).enumerate();
    pairs.into_iter().all(|(joint, (&other, &sign))| {
        let [law, mirrored] = [&control.joints[joint], &control.joints[other]];
        let gains = |law: &JointControl| (law.stiffness, law.damping, law.damped);
        let parts = [
            (&law.reference, &mirrored.reference, sign),
            (&law.feed_forward, &mirrored.feed_forward, sign),
            (&law.gain_factor, &mirrored.gain_factor, 1.0),
        ];
        gains(law) == gains(mirrored)
            && parts.into_iter().all(|(here, there, sign)| match (here, there) {
                (None, None) => true,
                (Some(here), Some(there)) => are_alike(here, there, sign, half_s),
                _ => false,
            })
    })
}

fn are_alike(here: &Reference, there: &Reference, sign: f64, half_s: f64) -> bool {
    (0..SAMPLES).all(|sample| {
        // not at limits of parts, where references may jump
        let t_s = (sample as f64 + 0.5) / SAMPLES as f64 * 2.0 * half_s;
        let [here, there] = [here.at(t_s + half_s), there.at(t_s)];
        (here.position - sign * there.position).abs() <= ALIKE
    })
}
