//! What became of each joint in a run: how it followed its reference, how far and how fast it went,
//! and how long its drive was at a limit.

use super::control::Control;
use denavit_plants::PlantModel;

/// An extreme value with its time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Peak {
    /// The value.
    pub value: f64,
    /// When it was there first \[s\].
    pub at_s: f64,
}

/// How far a joint was from its reference [rad, m].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TrackingError {
    /// Reference less position at the end.
    pub last: f64,
    /// The largest distance, without a sign.
    pub largest: Peak,
}

/// What became of one joint. Times are those of rows of the log, of ends of steps, and of others
/// at most 4 ms apart.
#[derive(Clone, Debug, PartialEq)]
pub struct JointRecord {
    /// How it followed its reference; none if it has none.
    pub tracking: Option<TrackingError>,
    /// The share of the time at which its command was at a torque limit of the model, or beyond;
    /// none if the joint is not controlled, or has no limits.
    pub at_torque_limit: Option<f64>,
    /// Its least and its largest position [rad, m].
    pub position: [Peak; 2],
    /// Its largest speed, either way [rad/s, m/s].
    pub speed: Peak,
}

/// Watches the joints of a run.
#[derive(Clone, Debug)]
pub(super) struct JointObserver {
    records: Vec<JointRecord>,
    /// Torque limits of joints that are controlled.
    limits: Vec<Option<[f64; 2]>>,
    /// Whether the command of each joint is at a limit now, and for how long it has been \[s\].
    is_at_limit: Vec<bool>,
    limited_s: Vec<f64>,
    /// The time of the last look, and how long commands have been watched \[s\].
    seen_s: Option<f64>,
    watched_s: f64,
}

impl JointObserver {
    pub(super) fn new(model: &PlantModel, control: &Control) -> Self {
        let none = JointRecord {
            tracking: None,
            at_torque_limit: None,
            position: [f64::INFINITY, f64::NEG_INFINITY].map(|value| Peak { value, at_s: 0.0 }),
            speed: Peak { value: f64::NEG_INFINITY, at_s: 0.0 },
        };
        let limits = model.joints.iter().zip(&control.joints).map(|(joint, law)| {
            let is_driven = law.reference.is_some() || law.feed_forward.is_some();
            joint.torque_limits.filter(|_| is_driven && joint.drivable)
        });
        let joints = model.joints.len();
        Self {
            records: vec![none; joints],
            limits: limits.collect(),
            is_at_limit: vec![false; joints],
            limited_s: vec![0.0; joints],
            seen_s: None,
            watched_s: 0.0,
        }
    }

    /// A state, with the time at which references are asked: not beyond where they jump.
    pub(super) fn see(
        &mut self,
        control: &Control,
        t_s: f64,
        reference_s: f64,
        [q, qd]: [&[f64]; 2],
    ) {
        self.seen_s = Some(t_s);
        for (joint, record) in self.records.iter_mut().enumerate() {
            let [low, high] = &mut record.position;
            raise(high, q[joint], t_s);
            if q[joint] < low.value {
                *low = Peak { value: q[joint], at_s: t_s };
            }
            raise(&mut record.speed, qd[joint].abs(), t_s);
            if let Some(setpoint) = control.setpoint(joint, reference_s) {
                let tracking = record.tracking.get_or_insert_default();
                tracking.last = setpoint.position - q[joint];
                raise(&mut tracking.largest, tracking.last.abs(), t_s);
            }
        }
    }

    /// The commands that are given from now on.
    pub(super) fn command(&mut self, command: &[f64]) {
        for ((is_at_limit, limits), command) in
            self.is_at_limit.iter_mut().zip(&self.limits).zip(command)
        {
            *is_at_limit = limits.is_some_and(|[low, high]| *command <= low || *command >= high);
        }
    }

    /// The commands have been given until now.
    pub(super) fn commanded_until(&mut self, t_s: f64) {
        let Some(length_s) = self.seen_s.map(|seen_s| t_s - seen_s) else { return };
        self.watched_s += length_s;
        for (sum, is_at_limit) in self.limited_s.iter_mut().zip(&self.is_at_limit) {
            *sum += if *is_at_limit { length_s } else { 0.0 };
        }
    }

    pub(super) fn finish(mut self) -> Vec<JointRecord> {
        for (joint, record) in self.records.iter_mut().enumerate() {
            let share = self.limited_s[joint] / self.watched_s;
            // a run of no length has no shares
            let share = if self.watched_s > 0.0 { share } else { 0.0 };
            record.at_torque_limit = self.limits[joint].map(|_| share);
        }
        self.records
    }
}

fn raise(peak: &mut Peak, value: f64, at_s: f64) {
    // a rate that is no number any more is worse than any
    if value > peak.value || value.is_nan() && !peak.value.is_nan() {
        *peak = Peak { value, at_s };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_plants::trajectory::Reference;
    use denavit_plants::{Cradle, Plant};

    #[test]
    fn errors_extremes_and_time_at_limits_are_those_of_the_run() {
        let mut model = Cradle::new(2).model().clone();
        model.joints[0].torque_limits = Some([-2.0, 3.0]);
        let reference = Reference::Constant(1.0);
        let control = Control::proportional(vec![Some(reference), None], 1.0, 0.0);
        let mut seen = JointObserver::new(&model, &control);
        let looks = [(0.0, 0.0, 3.0), (1.0, 1.5, 1.0), (1.5, 0.75, -2.5), (4.0, 0.5, 0.0)];
        for (t_s, q, command) in looks {
            seen.commanded_until(t_s);
            seen.see(&control, t_s, t_s, [&[q, -q], &[-2.0 * t_s, 0.0]]);
            seen.command(&[command, 9.0]);
        }
        let records = seen.finish();
        let peak = |value, at_s| Peak { value, at_s };
        let first = JointRecord {
            tracking: Some(TrackingError { last: 0.5, largest: peak(1.0, 0.0) }),
            // 0 to 1 s and 1.5 to 4 s
            at_torque_limit: Some(3.5 / 4.0),
            position: [peak(0.0, 0.0), peak(1.5, 1.0)],
            speed: peak(8.0, 4.0),
        };
        assert_eq!(records[0], first);
        assert_eq!((records[1].tracking, records[1].at_torque_limit), (None, None));
        assert_eq!(records[1].position, [peak(-1.5, 1.0), peak(0.0, 0.0)]);
    }
}
