//! What nobody can know of friction while a joint turns around.
//!
//! A drive that sticks for milliseconds has any friction up to that of sliding, and a filter moves
//! the moment of its reversal: all that takes the sign of a rate is unsure there.

use super::data::{Data, ModelTorques};
use super::floor::rms;
use super::problem::Fitted;
use super::rows::torques as torques_of;

/// The time by which the filter of positions moves a corner of a rate, times the cutoff of torques.
const CORNER: f64 = 0.05;

/// What is between two torques is anywhere between them: the deviation of that.
const BETWEEN: f64 = 0.288_675_134_594_812_9;

/// For each row the deviation of torques whose rates are not known better than corners of the
/// filter leave them, by the model and by laws [N m, N].
pub(super) fn turning(data: &Data<'_>, torques: &[ModelTorques], laws: &[Fitted<'_>]) -> Vec<f64> {
    let mut unsure = vec![0.0; data.rows()];
    for (log, (signals, torques)) in data.signals.iter().zip(torques).enumerate() {
        let corner_s = CORNER / signals.torque_hz;
        let moved = |sign: f64| {
            let mut moved = signals.clone();
            for (rates, accelerations) in moved.qd.iter_mut().zip(&signals.qdd) {
                let by = sign * corner_s * rms(accelerations);
                rates.iter_mut().for_each(|rate| *rate += by);
            }
            let mut sum = torques_of(data.nominal, &moved, &torques.phi);
            for fitted in laws {
                let response =
                    fitted.law.response(torques.motion(data.nominal, &moved), &fitted.values);
                for (&joint, torque) in response.joints.iter().zip(&response.torque) {
                    sum[joint].iter_mut().zip(torque).for_each(|(sum, torque)| *sum += torque);
                }
            }
            sum
        };
        let (faster, slower) = (moved(1.0), moved(-1.0));
        for stretch in data.stretches.iter().filter(|stretch| stretch.log == log) {
            let both = faster[stretch.joint].iter().zip(&slower[stretch.joint]);
            let apart: Vec<f64> = both.map(|(a, b)| BETWEEN * (a - b)).collect();
            let rows = &mut unsure[stretch.first..stretch.first + stretch.rows];
            for (row, apart) in rows.iter_mut().zip(signals.rows_of(&apart)) {
                *row = apart.abs();
            }
        }
    }
    unsure
}
