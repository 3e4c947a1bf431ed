//! Speed and energy of a gait (thesis 4.4.1).

use super::course::Course;
use denavit_plants::Plant;

/// Speed and energy over a course.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Energy {
    /// Mean speed of the centre of mass along the ground [m/s].
    pub speed_m_s: f64,
    /// Cost of transport: the integral of the absolute power of all joints over weight times
    /// distance.
    pub cost_of_transport: f64,
    /// The integral of the square of all joint torques over the distance [N^2 m s].
    pub torque_squared: f64,
}

impl Course {
    /// Speed and energy of the run that the course was made of; none without a run, or without a
    /// way.
    pub fn energy(&self, plant: &dyn Plant) -> Option<Energy> {
        let (log, model) = (&self.run.as_ref()?.log, plant.model());
        let (first, last) = (self.instants.first()?, self.instants.last()?);
        let along = |instant: &super::Instant| model.ground.along(&instant.center_of_mass[0]);
        let [from, to] = [along(first), along(last)];
        let (way, time_s) = ((to[0] - from[0]).hypot(to[1] - from[1]), last.t_s - first.t_s);
        if way <= 0.0 || time_s <= 0.0 {
            return None;
        }
        let times = log.column("t")?;
        let (mut work, mut square) = (0.0, 0.0);
        for joint in model.joints.iter().filter(|joint| joint.drivable) {
            let torques = log.column(&format!("tau_{}", joint.name))?;
            let speeds = log.column(&format!("qd_{}", joint.name))?;
            let rows = times.windows(2).zip(torques.windows(2).zip(speeds.windows(2)));
            for (time, (torque, speed)) in rows {
                let step_s = time[1] - time[0];
                let power = [0, 1].map(|end| (torque[end] * speed[end]).abs());
                work += 0.5 * step_s * (power[0] + power[1]);
                square += 0.5 * step_s * (torque[0].powi(2) + torque[1].powi(2));
            }
        }
        let weight = model.mass_kg * model.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        Some(Energy {
            speed_m_s: way / time_s,
            cost_of_transport: work / (weight * way),
            torque_squared: square / way,
        })
    }
}
