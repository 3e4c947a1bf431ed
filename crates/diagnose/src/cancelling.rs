//! Torques that are a small difference of large ones.
//!
//! Where weight and inertia nearly cancel, errors of positions and of their derivatives are as
//! large as the torque. What is left of such a torque says nothing of the model.

use super::data::Data;
use super::floor::rms;
use super::rows::torques;
use super::signals::Shared;
use denavit_measure::JointIndex;

/// What weight and all else take (roots of mean squares together), over the torque of a joint.
pub(super) fn terms_over_torque(data: &Data<'_>, joint: usize) -> f64 {
    let nominal = data.nominal;
    let phi = nominal.phi(&vec![0.0; nominal.len()]);
    let [mut weight, mut motion, mut torque] = [const { Vec::new() }; 3];
    for signals in &data.signals {
        let Some(measured) = &signals.torque[joint] else { continue };
        let mut still = signals.clone();
        let rates = still.qd.iter_mut().chain(&mut still.qdd);
        rates.for_each(|rates| Shared::make_mut(rates).fill(0.0));
        for joint in (0..still.joints()).map(JointIndex) {
            still.drive_mut(joint).into_iter().for_each(|rates| rates.fill(0.0));
        }
        let [all, still] =
            [signals, &still].map(|motion| signals.rows_of(&torques(nominal, motion, &phi)[joint]));
        motion.extend(all.iter().zip(&still).map(|(all, still)| all - still));
        weight.extend(still);
        torque.extend(measured);
    }
    rms(&weight).hypot(rms(&motion)) / rms(&torque).max(f64::MIN_POSITIVE)
}
