//! Where the search begins: straight legs that swing like compasses, no torques, the weight shared
//! out among the closed contacts. Nothing of it is a gait that walks.

use super::legs::{Leg, Role};
use super::phases::Axis;
use super::step::Step;

/// What the guess is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guess {
    /// Bend of both knees \[rad\].
    pub knee_rad: f64,
    /// Length of the step, in legs; none takes the square root of the speed, in its unit.
    pub length: Option<f64>,
}

impl Default for Guess {
    fn default() -> Self {
        Self { knee_rad: 0.1, length: None }
    }
}

impl Step<'_> {
    /// The variables of the guess.
    pub(super) fn guess(&mut self, guess: Guess) -> Vec<f64> {
        let mut x = vec![0.0; self.layout.variables];
        let speed = self.limits.speed_m_s / self.units.speed_m_s();
        let own = guess.length.unwrap_or(speed.sqrt()) * self.units.length_m;
        let length = self.limits.step_length_m.unwrap_or(own);
        let period = length / self.limits.speed_m_s;
        x[self.layout.length] = length;
        let total: f64 = self.layout.phases.iter().map(|phase| phase.share).sum();
        for phase in 0..self.layout.phases.len() {
            x[self.layout.durations + phase] = period * self.layout.phases[phase].share / total;
        }
        // legs beyond this angle do not reach the ground
        let angle = (0.5 * length / self.units.length_m).min(0.9).asin();
        let mut before = 0.0;
        for number in 0..self.layout.points.len() {
            let point = self.layout.points[number];
            if point.index == 0 && point.phase > 0 {
                before += self.layout.phases[point.phase - 1].share / total;
            }
            let share = before + point.fraction * self.layout.phases[point.phase].share / total;
            let (n, q) = (self.layout.n, self.layout.motion(&point, 0));
            let lean = |share: f64| angle * (2.0 * share - 1.0);
            let here = self.posture(lean(share), guess.knee_rad);
            let near = 1e-3;
            let sides = [share + near, share - near].map(|s| self.posture(lean(s), guess.knee_rad));
            for index in 0..n {
                x[q + index] = here[index];
                x[q + n + index] = (sides[0][index] - sides[1][index]) / (2.0 * near * period);
            }
            let held = &self.layout.held[point.phase];
            let normals = held.iter().filter(|held| held.1 == Axis::Up).count();
            for (index, (_, axis)) in held.iter().enumerate() {
                if *axis == Axis::Up {
                    x[self.layout.forces(&point) + index] = self.units.force_n / normals as f64;
                }
            }
        }
        x
    }

    /// Both legs straight but for the knees, the stance leg leaning back by an angle and the other
    /// one forward by the same, the stance foot flat at x = 0.
    fn posture(&mut self, angle: f64, knee: f64) -> Vec<f64> {
        let mut q = vec![0.0; self.layout.n];
        let mut set = |leg: Leg, angle: f64| {
            q[leg.hip] = angle - 0.5 * knee;
            q[leg.knee] = knee;
            q[leg.ankle] = -angle - 0.5 * knee;
        };
        // positive angles of hips swing thighs back
        set(self.legs.stance, angle);
        set(self.legs.swing, -angle);
        let mut places = vec![0.0; 3 * self.contacts];
        self.plant.contact_positions(&q, &mut places);
        let heel = 3 * self.legs.contact(Role::StanceHeel);
        q[self.legs.base_x] -= places[heel];
        q[self.legs.base_z] -= places[heel + 2] - self.legs.ground_m;
        q
    }
}
