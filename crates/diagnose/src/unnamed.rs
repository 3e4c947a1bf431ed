//! Functions of a joint's motion that have no name.
//!
//! One is a sum of columns whose factors may be anything: waves of a position, cos(k pi x) with x
//! from 0 to 1 over its range, or powers. What every drive has is in none of them: an offset,
//! viscous and Coulomb friction.

use super::data::{Data, RowResponse};
use super::rows::PerJoint;
use super::signals::Signals;
use super::weighing::{Weighing, range};
use denavit_evidence::{Terms, policy};
use denavit_measure::JointIndex;
use std::f64::consts::PI;

/// Waves of a position; of each of two, the constant with them; and of one that changes in time.
const WAVES: [usize; 3] = [12, 4, 6];

type OfVelocity = fn(f64) -> f64;

/// What functions of the position are multiplied by, and their first wave: what every drive has is
/// the constant.
const OF_VELOCITY: [(usize, OfVelocity); 5] =
    [(1, |_| 1.0), (1, |v| v), (1, f64::signum), (0, |v| v * v), (0, |v| v * v.abs())];

/// The degree of polynomials of position and velocity.
const DEGREE: usize = 3;

impl Weighing<'_> {
    /// Functions of a joint's position times powers of its velocity; of its position and that of
    /// another joint; and of its position, and of its position and velocity, changing in time.
    pub(super) fn unnamed(&self, joint: JointIndex) -> Vec<Terms> {
        let waves = |log: &Signals, of: JointIndex, count: usize| -> PerJoint {
            let [low, high] = range(&self.sets, of);
            let per_wave = PI / (high - low).max(f64::MIN_POSITIVE);
            let wave = |k: usize, q: &f64| (k as f64 * per_wave * (q - low)).cos();
            (0..count).map(|k| log.q[of.0].iter().map(|q| wave(k, q)).collect()).collect()
        };
        let of_position = OF_VELOCITY.iter().map(|(first, factor)| {
            self.free(joint, &|log| {
                let factors = log.of_drive(joint)[0].iter().map(|v| factor(*v)).collect();
                products(&waves(log, joint, WAVES[0])[*first..], &[factors])
            })
        });
        let others = (0..self.sets[0].nominal.model.joints.len()).filter(|one| *one != joint.0);
        let of_two = others.map(|other| {
            self.free(joint, &|log| {
                let [own, other] = [joint, JointIndex(other)].map(|of| waves(log, of, WAVES[1]));
                products(&own, &other).split_off(1)
            })
        });
        let fading = self.free(joint, &|log| {
            products(&waves(log, joint, WAVES[2])[1..], &powers(&time(log), 2))
        });
        let moving = self.free(joint, &|log| {
            let [q, v] = [&log.q[joint.0], log.of_drive(joint)[0]].map(|all| powers(all, DEGREE));
            let of = |k: usize| products(&q[k..=k], &v[if k == 0 { 2 } else { 0 }..=DEGREE - k]);
            products(&(0..=DEGREE).flat_map(of).collect::<PerJoint>(), &powers(&time(log), 1))
        });
        of_position.chain(of_two).chain([fading, moving]).collect()
    }

    /// Columns of a joint, each as large as effects are believed to be.
    fn free(&self, joint: JointIndex, columns: &dyn Fn(&Signals) -> PerJoint) -> Terms {
        let of_set = |data: &&Data<'_>| {
            let mut response = RowResponse::default();
            for stretch in data.stretches.iter().filter(|one| one.equation == joint.0) {
                let log = &data.signals[stretch.log.0];
                let columns = columns(log);
                let columns: Vec<&[f64]> = columns.iter().map(Vec::as_slice).collect();
                response.stretches.push(*stretch);
                response.torque.push(vec![0.0; stretch.rows]);
                response.gradient.push(log.all_rows_of(&columns));
            }
            response
        };
        let responses: Vec<RowResponse> = self.sets.iter().map(of_set).collect();
        let (_, mut columns) = self.spectra.of_response(&self.sets, &responses, f64::INFINITY);
        for column in &mut columns {
            let share = self.spectra.largest_share(column);
            let factor = if share > 0.0 { policy::SIZE / share } else { 0.0 };
            column.iter_mut().flatten().for_each(|row| *row *= factor);
        }
        Terms::free(columns)
    }
}

/// The products of all columns with all others.
fn products(columns: &[Vec<f64>], others: &[Vec<f64>]) -> PerJoint {
    let of = |(a, b): (&Vec<f64>, &Vec<f64>)| a.iter().zip(b).map(|(a, b)| a * b).collect();
    columns.iter().flat_map(|a| others.iter().map(move |b| of((a, b)))).collect()
}

/// The powers of values, from 1 on.
fn powers(values: &[f64], degree: usize) -> PerJoint {
    let power = |k: usize| values.iter().map(|value| value.powi(k as i32)).collect();
    (0..=degree).map(power).collect()
}

/// The time of a log, from -1 to 1.
fn time(log: &Signals) -> Vec<f64> {
    let last = log.samples().saturating_sub(1).max(1) as f64;
    (0..log.samples()).map(|k| 2.0 * k as f64 / last - 1.0).collect()
}
