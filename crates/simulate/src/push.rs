//! Pushes from outside: an impulse, or a force over some time, at a point of a link.

use super::ground::cross;
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
        places(plant, q, std::slice::from_ref(&self.point))[0]
    }

    /// The torques that a force, or an impulse, at its point has on the joints [N m, N].
    pub(super) fn torques(&self, plant: &mut dyn Plant, q: &[f64], force: [f64; 3]) -> Vec<f64> {
        torques_at(plant, q, std::slice::from_ref(&self.point), &[force])
    }
}

/// The places of points in the world \[m\].
fn places(plant: &mut dyn Plant, q: &[f64], points: &[PointModel]) -> Vec<[f64; 3]> {
    let mut transforms = vec![0.0; 12 * plant.model().links.len()];
    plant.link_transforms(q, &mut transforms);
    let mut places = vec![[0.0; 3]; points.len()];
    point_positions(points, &transforms, places.as_flattened_mut());
    places
}

/// The torques that forces at these points have on the joints [N m, N].
fn torques_at(
    plant: &mut dyn Plant,
    q: &[f64],
    points: &[PointModel],
    forces: &[[f64; 3]],
) -> Vec<f64> {
    let mut moved = q.to_vec();
    let mut along = |joint: usize, change: f64, moved: &mut Vec<f64>| -> f64 {
        moved[joint] = q[joint] + change;
        let places = places(plant, moved, points);
        moved[joint] = q[joint];
        places.as_flattened().iter().zip(forces.as_flattened()).map(|(x, f)| x * f).sum()
    };
    (0..q.len())
        .map(|joint| {
            let [far, ahead, behind, far_behind] =
                [2.0, 1.0, -1.0, -2.0].map(|share| along(joint, share * DIFFERENCE, &mut moved));
            (8.0 * (ahead - behind) - (far - far_behind)) / (12.0 * DIFFERENCE)
        })
        .collect()
}

/// What pushes a link from outside, at the origin of its frame, in the world's directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinkWrench {
    /// Row of [`PlantModel::links`](denavit_plants::PlantModel::links).
    pub link: usize,
    /// \[N\].
    pub force: [f64; 3],
    /// About the origin [N m].
    pub moment: [f64; 3],
}

impl LinkWrench {
    fn at(link: usize, position: [f64; 3]) -> PointModel {
        PointModel { name: String::new(), link, position }
    }

    /// The sum of the pushes at a time on a link.
    pub(super) fn of(
        pushes: &[Push],
        link: usize,
        plant: &mut dyn Plant,
        t_s: f64,
        q: &[f64],
    ) -> Self {
        let mut sum = Self { link, force: [0.0; 3], moment: [0.0; 3] };
        for push in pushes.iter().filter(|push| push.point.link == link) {
            let Some(force) = push.force(t_s) else { continue };
            let [origin, place] = [Self::at(link, [0.0; 3]), push.point.clone()]
                .map(|point| places(plant, q, &[point])[0]);
            let turn = cross(std::array::from_fn(|axis| place[axis] - origin[axis]), force);
            for axis in 0..3 {
                sum.force[axis] += force[axis];
                sum.moment[axis] += turn[axis];
            }
        }
        sum
    }

    /// Whether it is nothing.
    pub fn is_zero(&self) -> bool {
        self.force == [0.0; 3] && self.moment == [0.0; 3]
    }

    /// Its moment about a point of the world [N m].
    pub fn moment_about(&self, plant: &mut dyn Plant, q: &[f64], point: [f64; 3]) -> [f64; 3] {
        let origin = places(plant, q, &[Self::at(self.link, [0.0; 3])])[0];
        let arm = cross(std::array::from_fn(|axis| origin[axis] - point[axis]), self.force);
        std::array::from_fn(|axis| arm[axis] + self.moment[axis])
    }

    /// The torques that it has on the joints [N m, N].
    ///
    /// Its moment m acts as forces (m x e) / 2 at the ends of three unit vectors e of the link's
    /// frame, and what undoes their sum at the origin: e x (m x e) / 2 add up to m.
    pub fn torques(&self, plant: &mut dyn Plant, q: &[f64]) -> Vec<f64> {
        let ends = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let points = ends.map(|end| Self::at(self.link, end));
        let found = places(plant, q, &points);
        let mut forces = [self.force, [0.0; 3], [0.0; 3], [0.0; 3]];
        for end in 1..4 {
            let arm = std::array::from_fn(|axis| 0.5 * (found[end][axis] - found[0][axis]));
            forces[end] = cross(self.moment, arm);
            for axis in 0..3 {
                forces[0][axis] -= forces[end][axis];
            }
        }
        torques_at(plant, q, &points, &forces)
    }
}

/// The links that forces push some time, in their order.
pub(super) fn forced_links(pushes: &[Push]) -> Vec<usize> {
    let forced = pushes.iter().filter(|push| matches!(push.shove, Shove::Force(..)));
    let mut links: Vec<usize> = forced.map(|push| push.point.link).collect();
    links.sort_unstable();
    links.dedup();
    links
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
