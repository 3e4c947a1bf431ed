//! Joint positions that meet conditions, within limits: the search that all planners share.

use crate::error::{PlanError, PostureError};
use crate::inverse_kinematics::{Condition, largest_error, place};
use denavit_numerics::Random;
use denavit_plants::{Plant, PlantModel, point_positions};

/// Joint positions that meet a pose.
#[derive(Clone, Debug, PartialEq)]
pub struct Posture {
    /// All coordinates [rad, m].
    pub q: Vec<f64>,
    /// The largest error of a condition, by forward kinematics [m, rad].
    pub residual: f64,
}

/// Which posture is looked for: messages say it.
#[derive(Clone, Copy, Debug)]
pub struct Sought<'a> {
    /// Its name, or that of its phase.
    pub name: &'a str,
    /// When it is taken \[s\].
    pub t_s: f64,
}

/// Starts of the search for the first posture.
const STARTS: usize = 24;
/// How far joints are from their middle in these \[rad\].
const SPREAD: f64 = 0.7;
/// How far joints begin inside a limit that stands at straight legs \[rad\].
const BENT: f64 = 0.5;
/// Beyond a limit by less is at it [rad, m].
const AT_LIMIT: f64 = 1e-9;

/// The posture near `near` that meets conditions, whatever the limits.
///
/// # Errors
/// Conditions that are out of reach.
pub(super) fn placed(
    plant: &mut dyn Plant,
    conditions: &[Condition],
    near: &[f64],
    at: Sought<'_>,
) -> Result<Vec<f64>, PlanError> {
    let mut q = near.to_vec();
    match place(plant, conditions, &mut q) {
        Ok(()) => Ok(q),
        Err(PostureError::OutOfReach { residual }) => {
            Err(PlanError::OutOfReach { posture: at.name.to_owned(), t_s: at.t_s, residual })
        }
        Err(PostureError::Count { conditions, coordinates }) => {
            Err(PlanError::Undetermined { conditions, coordinates })
        }
    }
}

/// What a posture is to meet.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Conditions {
    /// As many as coordinates, which are solved for.
    pub(super) solved: Vec<Condition>,
    /// What follows from them but for another branch: a foot upside down is on its points, too.
    pub(super) implied: Vec<Condition>,
}

/// Implied conditions are missed by less, or by the size of a foot [m, rad].
const BRANCH: f64 = 1e-6;

/// The posture near `near` that meets conditions.
///
/// # Errors
/// Conditions that are out of reach, or beyond a joint's limit; bodies below the ground.
pub(super) fn reach(
    plant: &mut dyn Plant,
    conditions: &Conditions,
    near: &[f64],
    at: Sought<'_>,
) -> Result<Posture, PlanError> {
    let Conditions { solved, implied } = conditions;
    let q = placed(plant, solved, near, at)?;
    let missed = largest_error(plant, implied, &q);
    if missed > BRANCH {
        return Err(PlanError::OutOfReach {
            posture: at.name.to_owned(),
            t_s: at.t_s,
            residual: missed,
        });
    }
    for (joint, value) in plant.model().joints.iter().zip(&q) {
        let Some(limits) = joint.position_limits else { continue };
        if *value < limits[0] - AT_LIMIT || *value > limits[1] + AT_LIMIT {
            let (posture, joint) = (at.name.to_owned(), joint.name.clone());
            return Err(PlanError::Limit { posture, t_s: at.t_s, joint, value: *value, limits });
        }
    }
    stays_above(plant, &q, at)?;
    let residual = largest_error(plant, solved, &q);
    Ok(Posture { q, residual })
}

/// What must not touch the ground is above it.
fn stays_above(plant: &mut dyn Plant, q: &[f64], at: Sought<'_>) -> Result<(), PlanError> {
    let mut transforms = vec![0.0; 12 * plant.model().links.len()];
    plant.link_transforms(q, &mut transforms);
    let model = plant.model();
    let mut places = vec![0.0; 3 * model.fall_points.len()];
    point_positions(&model.fall_points, &transforms, &mut places);
    for (index, place) in places.chunks_exact(3).enumerate() {
        let place = [place[0], place[1], place[2]];
        let height_m = model.ground.height(&place) - model.fall_radii_m[index];
        if height_m < 0.0 {
            let (posture, body) = (at.name.to_owned(), model.fall_points[index].name.clone());
            return Err(PlanError::Fallen { posture, t_s: at.t_s, body, height_m });
        }
    }
    Ok(())
}

/// The posture that meets conditions, looked for from several starts about one: of those within
/// limits that whose joints have the least angles.
///
/// # Errors
/// As of [`reach`]: the error of the first start, or of the one that comes nearest.
pub(super) fn first(
    plant: &mut dyn Plant,
    conditions: &Conditions,
    start: &[f64],
    joints: &[usize],
    at: Sought<'_>,
) -> Result<Posture, PlanError> {
    let mut random = Random::new(1);
    let mut best: Option<(f64, Posture)> = None;
    let mut worst: Option<PlanError> = None;
    for attempt in 0..STARTS {
        let mut q = start.to_vec();
        if attempt > 0 {
            for joint in joints {
                q[*joint] += SPREAD * (2.0 * random.uniform() - 1.0);
            }
        }
        match reach(plant, conditions, &q, at) {
            Ok(posture) => {
                let size: f64 = joints.iter().map(|joint| posture.q[*joint].powi(2)).sum();
                if best.as_ref().is_none_or(|(least, _)| size < least - 1e-9) {
                    best = Some((size, posture));
                }
            }
            Err(error) => worst = Some(nearer(worst, error)),
        }
    }
    match (best, worst) {
        (Some((_, posture)), _) => Ok(posture),
        (None, Some(error)) => Err(error),
        (None, None) => Err(PlanError::NoWalker("posture".to_owned())),
    }
}

/// Legs nearly straight, bent to where their limits allow; the base at 0.
pub(super) fn bent(model: &PlantModel, joints: &[usize]) -> Vec<f64> {
    let mut q = vec![0.0; model.joints.len()];
    for joint in joints {
        q[*joint] = match model.joints[*joint].position_limits {
            Some([low, high]) if low > -0.5 * BENT => (low + BENT).min(0.5 * (low + high)),
            Some([low, high]) if high < 0.5 * BENT => (high - BENT).max(0.5 * (low + high)),
            _ => 0.0,
        };
    }
    q
}

/// The error to report of two: limits before residuals, small residuals before large ones.
fn nearer(known: Option<PlanError>, other: PlanError) -> PlanError {
    match (known, other) {
        (
            Some(PlanError::OutOfReach { posture, t_s, residual }),
            PlanError::OutOfReach { residual: next, .. },
        ) => PlanError::OutOfReach { posture, t_s, residual: residual.min(next) },
        (Some(known @ PlanError::Limit { .. }), _) => known,
        (_, other) => other,
    }
}
