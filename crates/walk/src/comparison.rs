//! What each criterion of stability says of runs, and what comes out (thesis 4.2, 4.4.6).
//!
//! A criterion is judged by its own terms: a point of the ground must be in the support polygon all
//! the time, and so there must be one; angular momentum must be small; multipliers must be inside
//! the unit circle. The exact zero moment point may be on the edge, where a foot begins to turn:
//! forces of the ground have no other place. The outcome is that of the run.

use crate::balance::{Course, Criterion, Energy, Over, course_of_scenario};
use crate::error::Error;
use crate::poincare::{Fate, Multiplier, PoincareOptions, analyse};
use denavit_simulate::Stop;
use denavit_simulate::scenario::Scenario;

/// A shipped scenario that shows what criteria miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Case {
    /// The name of the shipped scenario.
    pub scenario: &'static str,
    /// What it is an example of.
    pub shows: &'static str,
}

/// The examples of the thesis's chapter 4, and the gaits.
pub const CASES: &[Case] = &[
    Case { scenario: "planar_biped_zmp_gait", shows: "a gait that meets every criterion but one" },
    Case { scenario: "planar_biped_limit_cycle_gait", shows: "a gait that no static one allows" },
    Case { scenario: "planar_biped_start_stop", shows: "start, stop: no period, and it walks" },
    Case { scenario: "planar_biped_switched_off", shows: "motors off: it collapses on its feet" },
    Case { scenario: "planar_biped_hopping", shows: "flight has no zero moment point, no fall" },
    Case { scenario: "planar_biped_landing", shows: "a drop onto bent legs" },
    Case { scenario: "planar_biped_dropped", shows: "angular momentum 0 throughout, and a fall" },
    Case { scenario: "planar_biped_trunk_swing", shows: "much angular momentum, and no fall" },
    Case { scenario: "planar_biped_pushed", shows: "a push that fells what is held stiff" },
    Case { scenario: "planar_biped_lunge", shows: "the same push, and a lunge that saves" },
];

/// What a criterion says of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Verdict {
    /// It is met throughout.
    Met,
    /// It is first missed at this time \[s\].
    Missed(f64),
    /// It says nothing: there is no period, no flat foot.
    Silent,
}

/// What all criteria say of a run, and what came out.
#[derive(Clone, Debug)]
pub struct Compared {
    /// The scenario.
    pub scenario: String,
    /// Whether it ended without a fall, and when \[s\].
    pub outcome: (Stop, f64),
    /// Whether the model names what must not touch the ground: else nothing counts as a fall.
    pub falls_are_seen: bool,
    /// Exact zero moment point, inside or on the edge.
    pub zero_moment: Verdict,
    /// Cart-table zero moment point inside.
    pub cart_table: Verdict,
    /// Foot rotation indicator inside, while one foot stands.
    pub foot_rotation: Verdict,
    /// Capture point inside.
    pub capture: Verdict,
    /// Angular momentum small.
    pub momentum: Verdict,
    /// The largest angular momentum about the lateral axes [kg m^2/s].
    pub largest_momentum: f64,
    /// Largest multiplier inside the unit circle.
    pub poincare: Verdict,
    /// The largest multiplier, where there is a cycle.
    pub largest_multiplier: Option<f64>,
    /// Speed and energy over a cycle, where the robot travels.
    pub energy: Option<Energy>,
}

/// Points nearer to the edge than this are on it \[m\].
const EDGE_M: f64 = 1e-6;
/// Angular momentum is small below this share of m h sqrt(g h), what a pendulum of the robot's
/// height that falls has.
const SMALL: f64 = 0.01;
/// A robot that comes less far in a cycle does not walk \[m\].
const TRAVELS_M: f64 = 0.02;

impl Verdict {
    /// Whether it is wrong about a run that ended so: met, and it fell, or missed, and it did not.
    pub fn is_wrong(self, fell: bool) -> bool {
        match self {
            Self::Met => fell,
            Self::Missed(_) => !fell,
            Self::Silent => false,
        }
    }
}

impl Compared {
    /// Whether a criterion's verdict is wrong about the run.
    pub fn is_wrong(&self, verdict: Verdict) -> bool {
        (self.falls_are_seen || self.fell()) && verdict.is_wrong(self.fell())
    }

    /// Whether the run ended with a fall.
    pub fn fell(&self) -> bool {
        matches!(self.outcome.0, Stop::Fall(_))
    }
}

/// Runs a scenario, and asks every criterion.
///
/// # Errors
/// Robots that do not walk, runs that do not begin.
pub fn compare(scenario: &mut Scenario, period_s: f64) -> Result<Compared, Error> {
    let course = course_of_scenario(scenario, period_s, true)?;
    let options = PoincareOptions { checks: false, ..PoincareOptions::default() };
    let cycle = analyse(scenario, &options);
    let largest_multiplier = match &cycle {
        Ok(found) => Some(found.multipliers.first().map_or(0.0, Multiplier::modulus)),
        Err(_) => None,
    };
    let poincare = match largest_multiplier.map(Fate::of) {
        Some(Fate::Die) => Verdict::Met,
        Some(Fate::Stay | Fate::Grow) => Verdict::Missed(0.0),
        None => Verdict::Silent,
    };
    let (momentum, largest_momentum) = momentum(scenario, &course);
    let energy = match &cycle {
        Ok(found) if found.cycle.travel_m[0].abs() > TRAVELS_M => {
            let over = course_of_scenario(scenario, period_s, false)?;
            (over.over == Over::Cycle).then(|| over.energy(scenario.plant.as_ref())).flatten()
        }
        _ => None,
    };
    let outcome = match &course.run {
        Some(run) => (run.stop.clone(), run.end.t_s),
        None => (Stop::End, course.duration_s()),
    };
    let strict = |criterion: Criterion| point(&course, criterion);
    Ok(Compared {
        scenario: scenario.name.clone(),
        outcome,
        falls_are_seen: !scenario.plant.model().fall_points.is_empty(),
        zero_moment: strict(Criterion::ZeroMoment),
        cart_table: strict(Criterion::CartTable),
        foot_rotation: strict(Criterion::FootRotation),
        capture: strict(Criterion::Capture),
        momentum,
        largest_momentum,
        poincare,
        largest_multiplier,
        energy,
    })
}

/// Whether a point is strictly inside all the time; in flight there is nothing to be inside of.
fn point(course: &Course, criterion: Criterion) -> Verdict {
    let mut is_asked = false;
    for instant in &course.instants {
        let margin = match criterion {
            // asked while exactly one foot stands
            Criterion::FootRotation if instant.foot_rotation_m.is_none() => continue,
            _ => criterion.margin(instant).unwrap_or(f64::NEG_INFINITY),
        };
        is_asked = true;
        let least = if criterion == Criterion::ZeroMoment { -EDGE_M } else { EDGE_M };
        if margin < least {
            return Verdict::Missed(instant.t_s);
        }
    }
    if is_asked { Verdict::Met } else { Verdict::Silent }
}

fn momentum(scenario: &Scenario, course: &Course) -> (Verdict, f64) {
    let model = scenario.plant.model();
    let gravity = model.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let height = |center: &[f64; 3]| model.ground.height(center).max(0.0);
    let start = course.instants.first().map_or(0.0, |i| height(&i.center_of_mass[0]));
    let small = SMALL * model.mass_kg * start * (gravity * start).sqrt();
    let (mut first, mut largest) = (None, 0.0_f64);
    for instant in &course.instants {
        let size = instant.angular_momentum.iter().map(|l| l * l).sum::<f64>().sqrt();
        largest = largest.max(size);
        if size > small && first.is_none() {
            first = Some(instant.t_s);
        }
    }
    (first.map_or(Verdict::Met, Verdict::Missed), largest)
}
