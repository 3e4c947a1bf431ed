//! Pushes from outside: an impulse, or a force over some time, at a point of a link.

use denavit_plants::{Plant, PointModel, point_positions};

/// What pushes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shove {
    /// All at once, world frame [N s].
    Impulse([f64; 3]),
    /// A constant force, world frame \[N\], for so long \[s\].
    Force([f64; 3], f64),
}

/// A push at a point of a link.
#[derive(Clone, Debug, PartialEq)]
pub struct Push {
    /// Where: a point fixed in a link.
    pub point: PointModel,
    /// When it begins \[s\].
    pub at_s: f64,
    /// What it does.
    pub shove: Shove,
}

/// Half the distance of differences [rad, m]: of order 4, so that rounding and what is left of the
/// Taylor series are both about 1e-13.
const DIFFERENCE: f64 = 1e-3;

impl Push {
    /// When it is over \[s\].
    pub fn end_s(&self) -> f64 {
        match self.shove {
            Shove::Impulse(_) => self.at_s,
            Shove::Force(_, duration_s) => self.at_s + duration_s,
        }
    }

    /// Its force at a time \[N\]; impulses have none.
    pub(super) fn force(&self, t_s: f64) -> Option<[f64; 3]> {
        match self.shove {
            Shove::Force(force, _) if t_s >= self.at_s && t_s < self.end_s() => Some(force),
            _ => None,
        }
    }

    /// The place of its point in the world \[m\].
    pub(super) fn place(&self, plant: &mut dyn Plant, q: &[f64]) -> [f64; 3] {
        let mut transforms = vec![0.0; 12 * plant.model().links.len()];
        plant.link_transforms(q, &mut transforms);
        let mut place = [0.0; 3];
        point_positions(std::slice::from_ref(&self.point), &transforms, &mut place);
        place
    }

    /// The torques that a force, or an impulse, at its point has on the joints [N m, N].
    pub(super) fn torques(&self, plant: &mut dyn Plant, q: &[f64], force: [f64; 3]) -> Vec<f64> {
        let mut moved = q.to_vec();
        let mut along = |joint: usize, change: f64, moved: &mut Vec<f64>| -> f64 {
            moved[joint] = q[joint] + change;
            let place = self.place(plant, moved);
            moved[joint] = q[joint];
            place.iter().zip(force).map(|(x, f)| x * f).sum()
        };
        (0..q.len())
            .map(|joint| {
                let [far, ahead, behind, far_behind] = [2.0, 1.0, -1.0, -2.0]
                    .map(|share| along(joint, share * DIFFERENCE, &mut moved));
                (8.0 * (ahead - behind) - (far - far_behind)) / (12.0 * DIFFERENCE)
            })
            .collect()
    }
}

/// Torques of all forces that push at a time; none if nothing does.
pub(super) fn torques(
    pushes: &[Push],
    plant: &mut dyn Plant,
    t_s: f64,
    q: &[f64],
) -> Option<Vec<f64>> {
    let mut sum: Option<Vec<f64>> = None;
    for push in pushes {
        let Some(force) = push.force(t_s) else { continue };
        let torques = push.torques(plant, q, force);
        match &mut sum {
            Some(sum) => sum.iter_mut().zip(torques).for_each(|(entry, torque)| *entry += torque),
            None => sum = Some(torques),
        }
    }
    sum
}
