//! A cycle of a robot that walks: its fixed point on a section, and the linearised return map.

use super::chart::Chart;
use super::section::{ReturnMap, Returned, Section};
use super::symmetry::{Symmetry, find};
use crate::error::{CycleError, Error};
use crate::leg_exchange::LegExchange;
use denavit_simulate::{Simulation, State, simulate_varied};
use nalgebra::{DMatrix, DVector};

/// A state that comes back to itself.
#[derive(Clone, Debug)]
pub struct FixedPoint {
    /// Coordinates of the states near by.
    pub chart: Chart,
    /// The contacts that are closed in it.
    pub closed: Vec<usize>,
    /// The exchange of the legs after a cycle, if a cycle is a step.
    pub exchange: Option<LegExchange>,
    /// The time of a cycle \[s\].
    pub period_s: f64,
    /// How far the state is from itself a cycle later: the largest entry [rad, rad/s, m, m/s].
    pub residual: f64,
    /// The distance that it has moved along the ground in a cycle, in the world \[m\].
    pub travel_m: [f64; 3],
}

/// Half the distance of differences of the return map [rad, rad/s].
const DIFFERENCE: f64 = 2e-5;
/// A state this near to itself is a fixed point [rad, rad/s].
const FIXED: f64 = 1e-11;
/// Rounding of long runs keeps some cycles from more than this [rad, rad/s].
const NEARLY_FIXED: f64 = 1e-7;
const ITERATIONS: usize = 30;
/// No shorter part of a Newton step is tried.
const LEAST_SHARE: f64 = 1e-3;
/// A Newton step moves the time on the clock by no more than this share of a cycle.
const LATER: f64 = 0.1;
/// A Newton step that reduces the residual by less asks for a new matrix.
const SLOW: f64 = 0.2;

/// The fixed point of a return map near a state that is on its section.
///
/// # Errors
/// States that do not come back, or no convergence.
pub fn fixed_point(map: &mut ReturnMap<'_>, near: &State) -> Result<FixedPoint, Error> {
    let symmetries = find(map.plant, map.control);
    let mut state = near.clone();
    let mut returned = map.apply(&state)?;
    let mut matrix: Option<DMatrix<f64>> = None;
    let mut best: Option<(f64, State)> = None;
    for _ in 0..ITERATIONS {
        let chart = chart(map, &symmetries, &state, &returned);
        let missed = DVector::from_vec(chart.coordinates(&returned.state));
        let residual = missed.amax();
        let improves = best.as_ref().is_none_or(|(least, _)| residual < SLOW * least);
        if best.as_ref().is_none_or(|(least, _)| residual < *least) {
            best = Some((residual, state.clone()));
        } else if residual < NEARLY_FIXED {
            break;
        }
        if residual < FIXED {
            break;
        }
        if !improves {
            matrix = None;
        }
        // contacts that open or close make another chart
        let known = matrix.take().filter(|known| known.nrows() == chart.len());
        let jacobian = match known {
            Some(known) => known,
            None => linearised(map, &chart, returned.took_s)?,
        };
        let size = chart.len();
        let newton = (DMatrix::identity(size, size) - &jacobian).lu().solve(&missed);
        let Some(step) = newton.filter(|step| step.iter().all(|entry| entry.is_finite())) else {
            return Err(CycleError::NotFound(residual).into());
        };
        matrix = Some(jacobian);
        (state, returned) = advance(map, &chart, step.as_slice(), returned.took_s)?;
    }
    let (residual, state) = best.unwrap_or_else(|| (f64::INFINITY, near.clone()));
    if residual >= NEARLY_FIXED {
        return Err(CycleError::NotFound(residual).into());
    }
    let returned = map.apply(&state)?;
    let chart = chart(map, &symmetries, &state, &returned);
    let travel_m = travel(map, &state, &returned);
    let (exchange, closed, period_s) = (map.exchange.clone(), returned.closed, returned.took_s);
    Ok(FixedPoint { chart, closed, exchange, period_s, residual, travel_m })
}

/// The linearised map in the quicker way, where that can be gone.
fn linearised(map: &mut ReturnMap<'_>, chart: &Chart, took_s: f64) -> Result<DMatrix<f64>, Error> {
    if matches!(map.section, Section::Clock { .. })
        && map.cycles == 1
        && let Ok(matrix) = by_variation(map, chart, took_s)
    {
        return Ok(matrix);
    }
    by_differences(map, chart)
}

/// The Newton step, or the part of it after which the robot still walks.
fn advance(
    map: &mut ReturnMap<'_>,
    chart: &Chart,
    step: &[f64],
    took_s: f64,
) -> Result<(State, Returned), Error> {
    // a time on the clock far from here is that of another cycle
    let later_s = chart.later_s(step).abs();
    let mut share = if later_s > LATER * took_s { LATER * took_s / later_s } else { 1.0 };
    loop {
        let part: Vec<f64> = step.iter().map(|entry| share * entry).collect();
        let state = chart.state(map.plant, &part);
        match map.apply(&state) {
            Ok(returned) => return Ok((state, returned)),
            Err(error) if share < LEAST_SHARE => return Err(error),
            Err(_) => share *= 0.5,
        }
    }
}

fn chart(
    map: &mut ReturnMap<'_>,
    symmetries: &[Symmetry],
    state: &State,
    returned: &Returned,
) -> Chart {
    let has_time = map.clock_s.is_some() && !matches!(map.section, Section::Clock { .. });
    let mut base = state.clone();
    // motors and laws of a start that leaves them out
    if base.motor.is_empty() {
        base.motor.clone_from(&returned.state.motor);
        base.motor_rate.clone_from(&returned.state.motor_rate);
    }
    if base.laws.is_empty() {
        base.laws.clone_from(&returned.state.laws);
    }
    Chart::new(map.plant, &base, &returned.closed, symmetries, has_time)
}

/// The linearised return map in the coordinates of a chart, by central differences of order 4.
///
/// # Errors
/// States that do not come back.
pub fn by_differences(map: &mut ReturnMap<'_>, chart: &Chart) -> Result<DMatrix<f64>, Error> {
    let size = chart.len();
    let mut matrix = DMatrix::zeros(size, size);
    let mut coordinates = vec![0.0; size];
    for column in 0..size {
        let mut at = |share: f64| {
            coordinates[column] = share * DIFFERENCE;
            let state = chart.state(map.plant, &coordinates);
            coordinates[column] = 0.0;
            let returned = map.apply(&state)?;
            Ok::<_, Error>(chart.coordinates(&returned.state))
        };
        let [far, ahead, behind, far_behind] = [at(2.0)?, at(1.0)?, at(-1.0)?, at(-2.0)?];
        for row in 0..size {
            let rise = 8.0 * (ahead[row] - behind[row]) - (far[row] - far_behind[row]);
            matrix[(row, column)] = rise / (12.0 * DIFFERENCE);
        }
    }
    Ok(matrix)
}

/// The same from the variational equation along one cycle, with saltation at its events: for
/// sections of the clock.
///
/// # Errors
/// Events of which first-order changes say nothing.
pub fn by_variation(
    map: &mut ReturnMap<'_>,
    chart: &Chart,
    period_s: f64,
) -> Result<DMatrix<f64>, Error> {
    let size = chart.len();
    let unit = |column: usize| {
        let coordinates: Vec<f64> = (0..size).map(|k| f64::from(u8::from(k == column))).collect();
        chart.change(&coordinates)
    };
    let changes: Vec<State> = (0..size).map(unit).collect();
    let start = &chart.base;
    let end_s = start.t_s + period_s;
    let log_period_s = 2.0 * period_s;
    let simulation = Simulation { end_s, log_period_s, ..map.simulation.clone() };
    let (_, ends) = simulate_varied(map.plant, map.control, start, &simulation, &changes)
        .map_err(CycleError::Variation)?;
    let columns =
        ends.into_iter().map(|end| chart.coordinates_of_change(&map.exchanged_change(end)));
    let columns: Vec<DVector<f64>> = columns.map(DVector::from_vec).collect();
    Ok(if columns.is_empty() { DMatrix::zeros(0, 0) } else { DMatrix::from_columns(&columns) })
}

/// How far the base has come: its sliding coordinates, with the legs as they were.
fn travel(map: &ReturnMap<'_>, state: &State, returned: &Returned) -> [f64; 3] {
    let mut way = [0.0; 3];
    for (index, joint) in map.plant.model().joints.iter().enumerate() {
        let axis = match joint.name.as_str() {
            "base_x" => 0,
            "base_y" => 1,
            "base_z" => 2,
            _ => continue,
        };
        way[axis] = returned.state.q[index] - state.q[index];
    }
    way
}
