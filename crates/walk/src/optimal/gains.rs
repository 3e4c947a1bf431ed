//! The gains of a planned step, by search: the softest by which it walks as steadily as asked for.

use super::following::{Gains, Walk, walk};
use super::layout::Units;
use super::planned::PlannedStep;
use super::section::{Cycle, Section};
use crate::error::Error;
use denavit_plants::Plant;
use denavit_simulate::Stop;

/// Stiffness over weight times leg, and damping over stiffness over the time of a fall from rest:
/// what is tried, from soft to stiff. Soft gains forgive what differs from the plan at touchdown,
/// stiff and damped ones bring the torso back within a step.
const TRIED: [[f64; 2]; 14] = [
    [4.0, 0.06],
    [4.0, 0.12],
    [5.5, 0.06],
    [5.5, 0.12],
    [7.5, 0.06],
    [7.5, 0.12],
    [7.5, 0.24],
    [10.0, 0.12],
    [10.0, 0.24],
    [10.0, 0.5],
    [17.0, 0.12],
    [17.0, 0.24],
    [17.0, 0.5],
    [27.0, 0.5],
];

/// Gains by which a step repeats itself, the cycle, and the walk that was simulated.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    /// The gains.
    pub gains: Gains,
    /// The cycle.
    pub cycle: Cycle,
    /// A walk from the cycle.
    pub walk: Walk,
}

/// What a search came to.
pub(super) enum Outcome {
    Found(Box<Found>),
    /// The least of the largest multipliers of all cycles that were found; none was small enough.
    None(Option<f64>),
}

/// Steps after which a walk has come near its cycle.
const SETTLING_STEPS: usize = 16;
/// A state that repeats itself as well as this is on a cycle [rad, rad/s].
const PERIODIC: f64 = 1e-5;

/// Searches gains by which the largest multiplier is below `bound` and `steps` steps are walked.
pub(super) fn search(
    plant: &mut dyn Plant,
    step: &PlannedStep,
    bound: f64,
    steps: usize,
) -> Result<Outcome, Error> {
    let units = Units::of(&step.legs);
    let mut least: Option<f64> = None;
    for [stiffness, damping] in TRIED {
        let stiffness = stiffness * units.moment_nm();
        let gains = Gains::of_stiffness(plant, step, stiffness, damping * units.time_s)?;
        let Some(cycle) = settled_cycle(plant, step, &gains)? else { continue };
        let largest = cycle.largest_multiplier();
        least = Some(least.map_or(largest, |least| least.min(largest)));
        if largest >= bound {
            continue;
        }
        let walk = walk(plant, step, &gains, &cycle.start, steps)?;
        if walk.run.stop == Stop::End {
            return Ok(Outcome::Found(Box::new(Found { gains, cycle, walk })));
        }
    }
    Ok(Outcome::None(least))
}

/// The cycle that a walk from the plan comes to; none if it falls or comes to none.
fn settled_cycle(
    plant: &mut dyn Plant,
    step: &PlannedStep,
    gains: &Gains,
) -> Result<Option<Cycle>, Error> {
    let mut section = Section::new(plant, step, gains)?;
    let start = section.planned()?;
    let Some(settled) = section.repeat(&start, SETTLING_STEPS)? else { return Ok(None) };
    let cycle = section.cycle(settled, 3)?;
    Ok(cycle.filter(|cycle| cycle.residual < PERIODIC))
}
