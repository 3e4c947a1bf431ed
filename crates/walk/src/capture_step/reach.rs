//! How high the centre of mass may be, so that both legs reach their feet.

use crate::gait_plan::Walker;
use denavit_plants::Plant;

/// The length of the legs, and where the hips are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// From hip to ankle with a straight knee \[m\].
    leg_m: f64,
    /// From the sole up to the ankle \[m\].
    ankle_m: f64,
    /// From the centre of mass to the hips: forward, up \[m\].
    hips_m: [f64; 2],
}

/// Legs are used up to this share of their length: near a straight knee its velocity has no bound.
const USED: f64 = 0.97;

impl Reach {
    /// Of a robot in a posture; the base frame is where the hips are.
    pub(super) fn of(plant: &mut dyn Plant, walker: &Walker, q: &[f64]) -> Self {
        let (links, points) = (plant.model().links.len(), plant.model().contacts.len());
        let straight = vec![0.0; q.len()];
        let foot = plant.model().contacts[walker.feet[0].heel].link;
        let (mut transforms, mut positions) = (vec![0.0; 12 * links], vec![0.0; 3 * points]);
        plant.link_transforms(&straight, &mut transforms);
        plant.contact_positions(&straight, &mut positions);
        let [x, z] = [transforms[12 * foot + 3], transforms[12 * foot + 11]];
        let center = plant.center_of_mass(q);
        let hips = walker.hips_m(q);
        Self {
            leg_m: x.hypot(z),
            ankle_m: z - positions[3 * walker.feet[0].heel + 2],
            hips_m: [hips[0] - center[0], hips[1] - center[2]],
        }
    }

    /// The largest height of the centre of mass above the ground, for a place of it and of the
    /// ankles along x, and heights of the soles \[m\].
    pub(super) fn height_m(&self, center_m: f64, feet_m: [[f64; 2]; 2]) -> f64 {
        let leg_m = USED * self.leg_m;
        let above = |[ankle_m, sole_m]: [f64; 2]| {
            let along = ankle_m - center_m - self.hips_m[0];
            let up = (leg_m * leg_m - along * along).max(0.0).sqrt();
            sole_m + self.ankle_m + up - self.hips_m[1]
        };
        let [right, left] = feet_m.map(above);
        right.min(left)
    }
}
