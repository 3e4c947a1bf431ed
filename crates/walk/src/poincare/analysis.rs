//! The stability of a scenario's gait: its cycle, its multipliers, and on which section they were
//! found.

use super::convergence::{Convergence, converge};
use super::cycle::{FixedPoint, by_differences, by_variation, fixed_point};
use super::multipliers::{Multiplier, multipliers};
use super::rhythm::{NotPeriodic, Rhythm};
use super::section::{ReturnMap, Section};
use crate::error::{CycleError, Error};
use denavit_plants::Plant;
use denavit_simulate::integrate::{Accuracy, Method};
use denavit_simulate::scenario::Scenario;
use denavit_simulate::{EventKind, Run, Simulation, State, Stop, simulate};
use nalgebra::DMatrix;

/// Where a gait is to be looked at.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum WantedSection {
    /// In the middle of the longest time without an event; where there is no clock, just after a
    /// strike.
    #[default]
    Best,
    /// At this share of the cycle of the clock, from 0 to 1.
    Phase(f64),
    /// Just after the strike of the swing foot.
    Strike,
}

/// How a gait is looked at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PoincareOptions {
    /// Where.
    pub section: WantedSection,
    /// Steps from the start of the scenario on before the cycle is looked for.
    pub approach_steps: usize,
    /// Whether the monodromy is found in both ways and on other sections, too.
    pub checks: bool,
    /// A walker without a clock that does not strike within this time does not walk \[s\].
    pub patience_s: f64,
    /// How far two velocities are off the cycle [rad/s, m/s], and over how many cycles the way back
    /// is followed; 0: not at all.
    pub returns: (f64, usize),
}

impl Default for PoincareOptions {
    fn default() -> Self {
        Self {
            section: WantedSection::Best,
            approach_steps: 4,
            checks: true,
            patience_s: 5.0,
            returns: (0.1, 0),
        }
    }
}

/// What was found of a gait's cycle.
#[derive(Clone, Debug)]
pub struct PoincareAnalysis {
    /// The cycle.
    pub cycle: FixedPoint,
    /// Where it was looked at.
    pub section: Section,
    /// The multipliers by falling modulus, without those that are 0 because contacts forbid
    /// deviations.
    pub multipliers: Vec<Multiplier>,
    /// How many deviations the contacts forbid on the section: so many more multipliers are 0.
    pub forbidden: usize,
    /// Largest difference between entries of the monodromy matrices of both ways; none if not
    /// compared.
    pub methods_apart: Option<f64>,
    /// Largest difference of multipliers above 1e-2 between sections, with how many there were.
    pub section_spread: Option<(f64, usize)>,
    /// Returns from off the cycle, if asked for.
    pub convergence: Option<Convergence>,
}

/// Sections nearer to an event than this share of the cycle are not looked at.
const CLEAR: f64 = 0.04;
/// Multipliers below this may differ between sections: deviations that die within a step leave
/// different traces.
const LARGE: f64 = 1e-2;
/// Checks that are farther apart contradict each other.
const CONTRADICTS: f64 = 1e-3;
/// More sections are not compared.
const SECTIONS: usize = 3;

/// Finds the cycle of a scenario's gait, and its multipliers.
///
/// # Errors
/// A gait that does not repeat itself, that stops, or has no cycle.
pub fn analyse(
    scenario: &mut Scenario,
    options: &PoincareOptions,
) -> Result<PoincareAnalysis, Error> {
    if !scenario.simulation.pushes.is_empty() {
        return Err(CycleError::Pushed.into());
    }
    let plant = scenario.plant.as_mut();
    let rhythm = Rhythm::of(plant, &scenario.control).map_err(|NotPeriodic(joint)| {
        CycleError::NotPeriodic(plant.model().joints[joint].name.clone())
    })?;
    let mut map = ReturnMap {
        plant,
        control: &scenario.control,
        simulation: accurate(&scenario.simulation),
        exchange: rhythm.exchange,
        section: Section::Clock { at_s: 0.0, period_s: 0.0 },
        cycles: 1,
        patience_s: options.patience_s,
        clock_s: rhythm.clock_s,
    };
    let near = approach(&mut map, &scenario.initial, options)?;
    let cycle = fixed_point(&mut map, &near)?;
    let matrix = monodromy(&mut map, &cycle)?;
    let own = multipliers(&matrix).ok_or(CycleError::Multipliers)?;
    let section = map.section;
    let is_clock = matches!(section, Section::Clock { .. });
    let methods_apart = if options.checks && is_clock {
        let other = by_differences(&mut map, &cycle.chart)?;
        Some((&matrix - other).amax())
    } else {
        None
    };
    let mut section_spread =
        if options.checks && is_clock { spread(&mut map, &cycle, &own)? } else { None };
    let (off, cycles) = options.returns;
    let leading = own.first().filter(|_| cycles > 0);
    let convergence = leading.map(|one| converge(&mut map, &cycle, one, off, cycles));
    // where contacts forbid that deviation there is no way back
    let is_off = |way: &Convergence| way.lengths[0] > LEFT * off;
    let convergence = convergence.filter(is_off);
    let forbidden = if is_clock { forbidden(map.plant, own.len()) } else { 0 };
    if options.checks && !is_clock && rhythm.clock_s.is_some() {
        // differences across a strike may meet other events: the variational equation does not
        let plain = PoincareOptions { checks: false, returns: (0.0, 0), ..*options };
        let on_clock = PoincareOptions { section: WantedSection::Best, ..plain };
        section_spread = Some((apart(&own, &analyse(scenario, &on_clock)?.multipliers), 2));
    }
    Ok(PoincareAnalysis {
        cycle,
        section,
        multipliers: own,
        forbidden,
        methods_apart,
        section_spread,
        convergence,
    })
}

/// Less than this part of a deviation is left inside the manifold of the contacts: they forbid it.
const LEFT: f64 = 1e-3;

/// Largest difference of multipliers above 1e-2, by falling modulus.
fn apart(own: &[Multiplier], other: &[Multiplier]) -> f64 {
    let pairs = own.iter().zip(other).filter(|(one, _)| one.modulus() > LARGE);
    let apart = |(one, other): (&Multiplier, &Multiplier)| {
        (one.value[0] - other.value[0]).hypot(one.value[1] - other.value[1])
    };
    pairs.map(apart).fold(0.0, f64::max)
}

impl PoincareAnalysis {
    /// How far the checks of the multipliers are apart, where they contradict each other: events
    /// are so near to each other that small deviations meet others, and the linearised map says
    /// little of deviations that can be seen.
    pub fn contradiction(&self) -> Option<f64> {
        let spread = self.section_spread.map(|(apart, _)| apart);
        let worst = self.methods_apart.into_iter().chain(spread).fold(0.0, f64::max);
        (worst > CONTRADICTS).then_some(worst)
    }
}

/// Differences of runs take more accuracy than runs: states are to be good to about 1e-11.
fn accurate(simulation: &Simulation) -> Simulation {
    let tighter = |accuracy: Accuracy, relative: f64| Accuracy {
        relative: accuracy.relative.min(relative),
        absolute: accuracy.absolute.min(0.1 * relative),
        ..accuracy
    };
    let method = match simulation.method {
        Method::DormandPrince(accuracy) => Method::DormandPrince(tighter(accuracy, 1e-11)),
        // its steps are as long as a relation of orders allows that holds for small errors
        Method::Radau(accuracy) => Method::Radau(tighter(accuracy, 1e-13)),
        fixed @ Method::RungeKutta { .. } => fixed,
    };
    Simulation { method, ..simulation.clone() }
}

fn run(map: &mut ReturnMap<'_>, start: &State, end_s: f64) -> Result<Run, Error> {
    let simulation = Simulation { end_s, log_period_s: end_s.max(1.0), ..map.simulation.clone() };
    Ok(simulate(map.plant, map.control, start, &simulation).map_err(CycleError::Start)?)
}

/// Walks some steps from the start, chooses the section, and returns a state on it.
fn approach(
    map: &mut ReturnMap<'_>,
    initial: &State,
    options: &PoincareOptions,
) -> Result<State, Error> {
    let Some(period_s) = map.clock_s else {
        if let WantedSection::Phase(_) = options.section {
            return Err(CycleError::NoClock.into());
        }
        return first_strike(map, initial, options.patience_s);
    };
    let start_s = initial.t_s + options.approach_steps as f64 * period_s;
    let until = |map: &mut ReturnMap<'_>, from: &State, end_s: f64| -> Result<Run, Error> {
        let run = run(map, from, end_s)?;
        match run.stop {
            Stop::End => Ok(run),
            stop => Err(CycleError::Stopped(stop, run.end.t_s).into()),
        }
    };
    let begun = until(map, initial, start_s)?.end;
    if options.section == WantedSection::Strike {
        return strike_of_clock(map, &begun, period_s);
    }
    let at_s = match options.section {
        WantedSection::Phase(share) => {
            let first = (start_s / period_s).ceil() * period_s;
            first + share * period_s
        }
        _ => {
            let step = until(map, &begun, start_s + period_s)?;
            let quiet = quiet_times(&step, start_s, period_s);
            quiet.first().map_or(start_s, |(middle_s, _)| *middle_s)
        }
    };
    let mut state = until(map, &begun, at_s)?.end;
    // the clock of the first cycle, with the leg that stands then
    let cycles = (at_s / period_s + 1e-9).floor();
    for _ in 0..cycles as usize {
        state = map.exchanged(state);
    }
    map.section = Section::Clock { at_s: state.t_s, period_s };
    Ok(state)
}

/// The first strike of a walker without a clock.
fn first_strike(map: &mut ReturnMap<'_>, initial: &State, patience_s: f64) -> Result<State, Error> {
    let run = run(map, initial, initial.t_s + patience_s)?;
    let strike = run.events.iter().find_map(|event| match event.kind {
        EventKind::Touch(contact) => Some((contact, event)),
        _ => None,
    });
    let Some((contact, event)) = strike else {
        return Err(match run.stop {
            Stop::End => CycleError::NoStrike(patience_s).into(),
            stop => CycleError::Stopped(stop, run.end.t_s).into(),
        });
    };
    map.section = Section::Touch(contact);
    let (q, qd) = (event.q.clone(), event.after.clone());
    Ok(State { q, qd, ..State::default() })
}

/// The strongest impact in a cycle of the clock.
fn strike_of_clock(map: &mut ReturnMap<'_>, begun: &State, period_s: f64) -> Result<State, Error> {
    let run = run(map, begun, begun.t_s + period_s)?;
    let strength = |event: &denavit_simulate::Event| {
        event.impulses.iter().map(|(_, p)| p.iter().map(|x| x * x).sum::<f64>()).sum::<f64>()
    };
    let touches = run.events.iter().filter_map(|event| match event.kind {
        EventKind::Touch(contact) => Some((contact, event)),
        _ => None,
    });
    let strongest = touches.max_by(|a, b| strength(a.1).total_cmp(&strength(b.1)));
    let Some((contact, event)) = strongest else {
        return Err(CycleError::NoStrike(period_s).into());
    };
    map.section = Section::Touch(contact);
    map.patience_s = 1.5 * period_s;
    let (q, qd) = (event.q.clone(), event.after.clone());
    Ok(State { t_s: event.t_s, q, qd, ..State::default() })
}

/// Middle and length of the times without an event in a cycle, the longest first \[s\].
fn quiet_times(run: &Run, start_s: f64, period_s: f64) -> Vec<(f64, f64)> {
    let events = run.events.iter().filter(|event| event.kind != EventKind::Start);
    let mut times: Vec<f64> = events.map(|event| event.t_s).collect();
    // the cycle closes
    let Some(first) = times.first().copied() else { return vec![(start_s, period_s)] };
    times.push(first + period_s);
    let mut quiet: Vec<(f64, f64)> =
        times.windows(2).map(|pair| (0.5 * (pair[0] + pair[1]), pair[1] - pair[0])).collect();
    quiet.retain(|(_, length_s)| *length_s > 2.0 * CLEAR * period_s);
    quiet.sort_by(|a, b| b.1.total_cmp(&a.1));
    quiet
}

fn monodromy(map: &mut ReturnMap<'_>, cycle: &FixedPoint) -> Result<DMatrix<f64>, Error> {
    let varied = match map.section {
        Section::Clock { .. } => by_variation(map, &cycle.chart, cycle.period_s).ok(),
        _ => None,
    };
    match varied {
        Some(matrix) => Ok(matrix),
        None => by_differences(map, &cycle.chart),
    }
}

/// How far the large multipliers are apart on other sections of the same cycle.
fn spread(
    map: &mut ReturnMap<'_>,
    cycle: &FixedPoint,
    own: &[Multiplier],
) -> Result<Option<(f64, usize)>, Error> {
    let start = cycle.chart.base.clone();
    let step = run(map, &start, start.t_s + cycle.period_s)?;
    let section = map.section;
    let (mut apart, mut count) = (0.0_f64, 1);
    let others = quiet_times(&step, start.t_s, cycle.period_s);
    for (at_s, _) in others.into_iter().skip(1).take(SECTIONS) {
        let mut near = run(map, &start, at_s)?.end;
        if at_s >= start.t_s + cycle.period_s {
            near = map.exchanged(near);
        }
        map.section = Section::Clock { at_s: near.t_s, period_s: cycle.period_s };
        let found = fixed_point(map, &near).and_then(|other| monodromy(map, &other));
        map.section = section;
        let found = multipliers(&found?).ok_or(CycleError::Multipliers)?;
        apart = apart.max(distance(own, &found)).max(distance(&found, own));
        count += 1;
    }
    Ok((count > 1).then_some((apart, count)))
}

/// The largest distance of a large multiplier from the nearest one on another section.
fn distance(some: &[Multiplier], others: &[Multiplier]) -> f64 {
    let large = some.iter().filter(|multiplier| multiplier.modulus() > LARGE);
    let nearest = |one: &Multiplier| {
        let from = |other: &Multiplier| {
            (one.value[0] - other.value[0]).hypot(one.value[1] - other.value[1])
        };
        others.iter().map(from).fold(f64::INFINITY, f64::min)
    };
    large.map(nearest).fold(0.0, f64::max)
}

/// How many of the deviations of a floating robot contacts forbid: its position along and above
/// the ground is no deviation of its own.
fn forbidden(plant: &dyn Plant, allowed: usize) -> usize {
    let joints = &plant.model().joints;
    let slides = joints.iter().filter(|joint| !joint.drivable && joint.slides).count();
    let hidden = 2 * plant.model().sprung_joints().count();
    (2 * (joints.len() - slides) + hidden + plant.law_states()).saturating_sub(allowed)
}
