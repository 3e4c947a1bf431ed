//! Pushes of a standing robot: how many steps its capture point asks for, and what it does.

use super::outcome::Outcome;
use super::parallel::{Observer, Opener, each};
use crate::capturability::{Capturability, Steps};
use crate::gait_plan::Walker;
use denavit_plants::{Plant, PointModel};
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{Event, EventKind, Push, Run, Shove, Simulation, simulate};

/// Which pushes are tried: impulses along x, in place of the pushes of the scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct CapturePushOptions {
    /// Where it is pushed.
    pub point: PointModel,
    /// When, after the start \[s\].
    pub at_s: f64,
    /// How strongly; negative backward [N s].
    pub impulses_ns: Vec<f64>,
    /// How long it has to come to rest \[s\].
    pub after_s: f64,
}

/// What became of one push.
#[derive(Clone, Debug, PartialEq)]
pub struct CapturePush {
    /// [N s].
    pub impulse_ns: f64,
    /// Capture point just after it, forward from the ankle that is nearest to it \[m\].
    pub capture_m: f64,
    /// The steps that the linear inverted pendulum needs.
    pub predicted: Option<Steps>,
    /// The steps that the robot made.
    pub steps: usize,
    /// The least margin of the capture point to the edges of the sole that holds it at the end,
    /// negative outside \[m\].
    pub margin_m: f64,
    /// How the run ended.
    pub outcome: Outcome,
}

impl CapturePush {
    /// Whether it stands at the end: nothing fell, and its capture point is over its soles.
    pub fn stands(&self) -> bool {
        self.outcome.walks() && self.margin_m >= 0.0
    }

    /// Whether the run did what was predicted: so many steps and standing, or a fall.
    pub fn agrees(&self) -> bool {
        match self.predicted {
            Some(Steps::Least(steps)) => self.stands() && self.steps == steps,
            Some(Steps::Falls) => !self.stands(),
            None => false,
        }
    }
}

/// Pushes a robot, from its start, by each impulse in turn. Predictions are those of the linear
/// inverted pendulum with these limits.
pub fn capture_pushes(
    open: &Opener<'_>,
    capturability: &Capturability,
    options: &CapturePushOptions,
    observer: &Observer<'_>,
) -> Vec<CapturePush> {
    let count = options.impulses_ns.len();
    each(count, observer, &|| open(), &|scenario, index| {
        let impulse_ns = options.impulses_ns[index];
        let made = scenario.as_mut().and_then(|scenario| run(scenario, impulse_ns, options));
        let Some((run, walker, scenario)) = made else { return nothing(impulse_ns) };
        judged(scenario.plant.as_mut(), &walker, capturability, impulse_ns, run)
    })
}

/// Of a run that did not begin.
fn nothing(impulse_ns: f64) -> CapturePush {
    CapturePush {
        impulse_ns,
        capture_m: f64::NAN,
        predicted: None,
        steps: 0,
        margin_m: f64::NAN,
        outcome: Outcome::NoStart,
    }
}

fn run<'a>(
    scenario: &'a mut Scenario,
    impulse_ns: f64,
    options: &CapturePushOptions,
) -> Option<(Run, Walker, &'a mut Scenario)> {
    let walker = Walker::of(scenario.plant.as_mut()).ok()?;
    let at_s = scenario.initial.t_s + options.at_s;
    let shove = Shove::Impulse([impulse_ns, 0.0, 0.0]);
    let end_s = at_s + options.after_s;
    let simulation = Simulation {
        end_s,
        log_period_s: (end_s - scenario.initial.t_s).max(1e-9),
        pushes: vec![Push { point: options.point.clone(), at_s, shove }],
        ..scenario.simulation.clone()
    };
    let (control, initial) = (&scenario.control, &scenario.initial);
    let run = simulate(scenario.plant.as_mut(), control, initial, &simulation).ok()?;
    Some((run, walker, scenario))
}

fn judged(
    plant: &mut dyn Plant,
    walker: &Walker,
    capturability: &Capturability,
    impulse_ns: f64,
    run: Run,
) -> CapturePush {
    let omega = capturability.limits().omega();
    let pushed = run.events.iter().find(|event| event.kind == EventKind::Push);
    let capture_m = pushed.map(|event| {
        let place = capture_point_m(plant, omega, &event.q, &event.after);
        let ankles = ankles_m(plant, walker, &event.q);
        let nearest = if place > ankles[0].max(ankles[1]) {
            ankles[0].max(ankles[1])
        } else {
            ankles[0].min(ankles[1])
        };
        place - nearest
    });
    let end = &run.end;
    let capture_end_m = capture_point_m(plant, omega, &end.q, &end.qd);
    let feet = ankles_m(plant, walker, &end.q).map(|ankle| [ankle, 0.0]);
    let [low, high] = walker.support_m(&feet, [true; 2]);
    CapturePush {
        impulse_ns,
        capture_m: capture_m.unwrap_or(f64::NAN),
        predicted: capture_m.map(|place| capturability.steps(place)),
        steps: steps_taken(plant, walker, &run.events),
        margin_m: (capture_end_m - low).min(high - capture_end_m),
        outcome: Outcome::of(run.stop, end.t_s),
    }
}

/// x + x'/w of the centre of mass \[m\].
fn capture_point_m(plant: &mut dyn Plant, omega: f64, q: &[f64], qd: &[f64]) -> f64 {
    let mut rows = vec![0.0; 3 * q.len()];
    plant.center_of_mass_jacobian(q, &mut rows);
    let velocity: f64 = rows.iter().zip(qd).map(|(row, rate)| row * rate).sum();
    plant.center_of_mass(q)[0] + velocity / omega
}

/// Places of the ankles along x; of feet that are level \[m\].
fn ankles_m(plant: &mut dyn Plant, walker: &Walker, q: &[f64]) -> [f64; 2] {
    let mut positions = vec![0.0; 3 * plant.model().contacts.len()];
    plant.contact_positions(q, &mut positions);
    walker.feet.map(|foot| {
        let [heel, toe] = [foot.heel, foot.toe].map(|point| positions[3 * point]);
        let share = foot.heel_to_ankle_m / (foot.heel_to_ankle_m + foot.ankle_to_toe_m);
        heel + share * (toe - heel)
    })
}

/// A foot that lands nearer than this share of its sole to where it left the ground has made no
/// step.
const MOVED: f64 = 0.25;

/// The steps of a run: feet that leave the ground with all points, and land elsewhere.
pub fn steps_taken(plant: &mut dyn Plant, walker: &Walker, events: &[Event]) -> usize {
    let mut steps = 0;
    let mut left_m = [None; 2];
    let mut stands = [true; 2];
    for event in events {
        let ankles = ankles_m(plant, walker, &event.q);
        for (side, foot) in walker.feet.iter().enumerate() {
            let touches = event.closed.contains(&foot.heel) || event.closed.contains(&foot.toe);
            match (stands[side], touches) {
                (true, false) => left_m[side] = Some(ankles[side]),
                (false, true) => {
                    let way = left_m[side].map_or(0.0, |left: f64| (ankles[side] - left).abs());
                    steps +=
                        usize::from(way > MOVED * (foot.heel_to_ankle_m + foot.ankle_to_toe_m));
                }
                _ => {}
            }
            stands[side] = touches;
        }
    }
    steps
}
