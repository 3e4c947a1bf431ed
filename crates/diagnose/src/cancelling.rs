//! Torques that are a small difference of large ones.
//!
//! Where weight and inertia nearly cancel, errors of positions and of their derivatives are as large
//! as the torque. What is left of such a torque says nothing of the model.

use super::data::Data;
use super::floor::rms;
use super::rows::torques;
use denavit_measure::JointIndex;

/// For each joint what weight takes and what all else does (roots of mean squares together), over
/// the torque.
pub(super) fn terms_over_torque(data: &Data<'_>) -> Vec<f64> {
    let nominal = data.nominal;
    let phi = nominal.phi(&vec![0.0; nominal.len()]);
    let joints = nominal.model.joints.len();
    let mut rows = vec![[const { Vec::new() }; 3]; joints];
    for signals in &data.signals {
        let mut still = signals.clone();
        for joint in 0..joints {
            still.drive_mut(JointIndex(joint)).into_iter().for_each(|rate| rate.fill(0.0));
            still.qd[joint].fill(0.0);
            still.qdd[joint].fill(0.0);
        }
        let [all, still] = [signals, &still].map(|motion| torques(nominal, motion, &phi));
        for (joint, [weight, motion, torque]) in rows.iter_mut().enumerate() {
            let Some(measured) = &signals.torque[joint] else { continue };
            let moving = all[joint].iter().zip(&still[joint]).map(|(all, still)| all - still);
            weight.extend(signals.rows_of(&still[joint]));
            motion.extend(signals.rows_of(&moving.collect::<Vec<f64>>()));
            torque.extend(measured);
        }
    }
    let of = |[weight, motion, torque]: &[Vec<f64>; 3]| {
        rms(weight).hypot(rms(motion)) / rms(torque).max(f64::MIN_POSITIVE)
    };
    rows.iter().map(of).collect()
}
