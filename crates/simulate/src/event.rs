//! Events inside a step: what is watched, and where it changes sign.
//!
//! A watched value fires when it falls below zero after it was positive. Dense output brackets the
//! crossing, steps of the very length locate it. A value that starts at zero (a contact that has
//! just bounced) is armed by the first positive sample, which is looked for ever closer to the
//! start; a contact may rise and fall inside one step. Bounces and transients much shorter than the
//! step are below the error of its dense output: then a shorter step is taken in its place, until
//! the crossing is a matter of the whole step.

use super::alighting::Alighting;
use super::breakdown::Breakdown;
use super::contact::{ContactProblem, Mode};
use super::integrate::Stepper;
use super::motion::Motion;
use super::start::quarter_turn_left;
use denavit_plants::point_positions;

/// What is watched during smooth motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watched {
    /// Height of an open contact point.
    Gap(usize),
    /// Height of a point that must not touch.
    FallPoint(usize),
    /// How far the forces are from pulling, or from leaving a cone.
    Margin,
    /// Speed of a slipping contact along its direction: position in the list of closed ones.
    SlipSpeed(usize),
    /// A guard of the plant.
    Guard(usize),
    /// Distance of a coordinate from those at which the base has no unique coordinates.
    QuarterTurn(usize),
}

impl Watched {
    /// Values this little below zero are rounding.
    fn floor(self) -> f64 {
        match self {
            Self::Margin => 0.0,
            _ => 1e-11,
        }
    }
}

/// An event: what fired, and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fired {
    pub(super) watched: Watched,
    pub(super) t_s: f64,
}

/// Samples inside a step, its end included.
const SAMPLES: usize = 8;
/// A crossing in an earlier part of the step than this calls for a shorter one.
const EARLY: f64 = 0.25;
/// Where no positive value was found before a negative one, so many halvings from the end on.
const HALVINGS: i32 = 6;
/// Steps are shortened so often at most; and to no less than this \[s\].
const RETAKES: usize = 24;
const SHORTEST_S: f64 = 1e-12;
/// The shortest look ahead \[s\].
const AHEAD_S: f64 = 1e-6;
/// Crossings are located to this \[s\].
const RESOLUTION_S: f64 = 1e-13;

/// Dense output is searched for limits of forces down to this part of the step.
const FORCES_SEEN: f64 = 1e-6;
/// Slack begins with this \[N\].
const LEAST_SLACK_N: f64 = 1e-8;

/// Looks for events; keeps what must be known of contacts that have just opened.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    /// Height at which each open contact counts as on the ground: below 0 by the error it had when
    /// it opened, until it has risen.
    pub(super) level: Vec<f64>,
    alighting: Alighting,
    /// How much less than no force to spare is no event \[N\]: none, unless the laws of contact saw
    /// nothing to change where the forces were short by a part of that.
    pub(super) slack: f64,
    /// Force to spare at the start of the last step in which the forces reached a limit \[N\].
    margin: f64,
    transforms: Vec<f64>,
    points: Vec<f64>,
    y: Vec<f64>,
}

impl Watch {
    /// For so many contacts, links and points that must not touch, and a state of this length.
    pub(super) fn new([contacts, links, fall_points]: [usize; 3], len: usize) -> Self {
        Self {
            level: vec![0.0; contacts],
            alighting: Alighting::new(contacts, len),
            slack: 0.0,
            margin: 0.0,
            transforms: vec![0.0; 12 * links],
            points: vec![0.0; 3 * fall_points],
            y: vec![0.0; len],
        }
    }

    /// The slack after the laws of contact saw nothing to change where the forces had this to
    /// spare: always more, so that no limit fires without end.
    pub(super) fn more_slack(&self, spare: f64) -> f64 {
        2.0 * (self.slack - spare.min(self.margin).min(0.0)).max(LEAST_SLACK_N)
    }

    /// Everything to be watched with the contacts as they are.
    fn list(motion: &Motion<'_>) -> Vec<Watched> {
        let model = motion.plant.model();
        let mut list: Vec<Watched> = (0..model.contacts.len())
            .filter(|contact| motion.closed.iter().all(|closed| closed.contact != *contact))
            .map(Watched::Gap)
            .collect();
        list.extend((0..model.fall_points.len()).map(Watched::FallPoint));
        list.extend((0..motion.plant.guards()).map(Watched::Guard));
        let slips = |(index, closed): (usize, &super::motion::Closed)| match closed.mode {
            Mode::Slip(direction) if direction != [0.0; 2] => Some(Watched::SlipSpeed(index)),
            _ => None,
        };
        list.extend(motion.closed.iter().enumerate().filter_map(slips));
        list.extend(model.singular_base_joint().map(Watched::QuarterTurn));
        list.extend((!motion.closed.is_empty()).then_some(Watched::Margin));
        list
    }

    /// The earliest event of the last step, which is taken anew with a shorter length where it is
    /// too long to tell.
    pub(super) fn find(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
    ) -> Result<Option<Fired>, Breakdown> {
        let mut list = Self::list(motion);
        let mut retakes = 0;
        loop {
            let crossings = self.crossings(motion, stepper, &list, retakes > 0)?;
            let Some(earliest) = first(&crossings) else {
                self.lower_levels(motion, stepper);
                let touches =
                    |contact| Fired { watched: Watched::Gap(contact), t_s: stepper.time() };
                return Ok(self.alighting.find(motion, stepper).map(touches));
            };
            let (t0, length) = (stepper.start_time(), stepper.time() - stepper.start_time());
            let part = (earliest.t_s - t0) / length;
            let shorter = 2.0 * part.max(0.5_f64.powi(HALVINGS + 1)) * length;
            let tells = part >= EARLY || shorter < SHORTEST_S || retakes == RETAKES;
            if tells || !stepper.retake(motion, t0 + shorter)? {
                return self.pin_down(motion, stepper, crossings);
            }
            list = crossings.iter().map(|fired| fired.watched).collect();
            retakes += 1;
        }
    }

    /// What of a list crosses zero in the last step, as dense output sees it; what is negative all
    /// along does at its start. What is known to cross soon after this step does so in it even by
    /// as little as rounding.
    fn crossings(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        list: &[Watched],
        known: bool,
    ) -> Result<Vec<Fired>, Breakdown> {
        let values = self.sample(motion, stepper, list);
        let (t0, t1) = (stepper.start_time(), stepper.time());
        let mut found = Vec::new();
        for (index, &watched) in list.iter().enumerate() {
            let floor = if known { 0.0 } else { watched.floor() };
            let mut last = (t0, values[index]);
            for sample in 1..=SAMPLES {
                let (t, value) = (sample_time(t0, t1, sample), values[sample * list.len() + index]);
                if value < -floor {
                    found.push(self.bracket(motion, stepper, watched, last, (t, value))?);
                    break;
                }
                if value > 0.0 || last.1 <= 0.0 {
                    last = (t, value);
                }
            }
        }
        if list.contains(&Watched::Margin) {
            // forces at the end of the step alone: they cost most
            let value = self.value(motion, stepper, Watched::Margin, t1)?;
            if value < 0.0 {
                let before = (t0, self.value(motion, stepper, Watched::Margin, t0)?);
                self.margin = before.1 - self.slack;
                let watched = Watched::Margin;
                found.push(self.bracket(motion, stepper, watched, before, (t1, value))?);
            }
        }
        Ok(found)
    }

    /// Values of all that is listed at the start of the last step and at its samples.
    fn sample(&mut self, motion: &mut Motion<'_>, stepper: &Stepper, list: &[Watched]) -> Vec<f64> {
        let (t0, t1) = (stepper.start_time(), stepper.time());
        let mut values = Vec::with_capacity((SAMPLES + 1) * list.len());
        let mut y = std::mem::take(&mut self.y);
        for sample in 0..=SAMPLES {
            stepper.interpolate(sample_time(t0, t1, sample), &mut y);
            self.look(motion, list, &y);
            values.extend(list.iter().map(|watched| self.seen(motion, *watched, &y)));
        }
        self.y = y;
        values
    }

    /// The first of some crossings, by steps of the very length.
    fn pin_down(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        mut crossings: Vec<Fired>,
    ) -> Result<Option<Fired>, Breakdown> {
        for fired in &mut crossings {
            if fired.t_s > stepper.start_time() {
                fired.t_s = self.polish(motion, stepper, fired.watched, fired.t_s)?;
            }
        }
        Ok(first(&crossings))
    }

    /// A crossing between a value that may be positive and one that is negative, by dense output.
    fn bracket(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        watched: Watched,
        last: (f64, f64),
        negative: (f64, f64),
    ) -> Result<Fired, Breakdown> {
        let t_s = match self.arm(motion, stepper, watched, last, negative.0)? {
            Some(positive) => self.locate(motion, stepper, watched, positive, negative)?,
            None => stepper.start_time(),
        };
        Ok(Fired { watched, t_s })
    }

    /// A contact has touched, and was not closed: it alights when it has risen once more.
    pub(super) fn tried(&mut self, contact: usize) {
        self.alighting.tried(contact);
    }

    /// Contacts that have risen count from the ground again.
    fn lower_levels(&mut self, motion: &mut Motion<'_>, stepper: &Stepper) {
        motion.place(stepper.state());
        for contact in 0..self.level.len() {
            if motion.gap(contact) > 0.0 {
                self.level[contact] = 0.0;
            }
        }
    }

    /// A time before `before` with a positive value.
    fn arm(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        watched: Watched,
        last: (f64, f64),
        before: f64,
    ) -> Result<Option<(f64, f64)>, Breakdown> {
        if last.1 > 0.0 {
            return Ok(Some(last));
        }
        let mut t = before;
        for _ in 0..HALVINGS {
            t = last.0 + 0.5 * (t - last.0);
            let value = self.value(motion, stepper, watched, t)?;
            if value > 0.0 {
                return Ok(Some((t, value)));
            }
        }
        Ok(None)
    }

    /// The crossing of the dense output between a positive and a negative value.
    fn locate(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        watched: Watched,
        positive: (f64, f64),
        negative: (f64, f64),
    ) -> Result<f64, Breakdown> {
        let ((mut a, mut fa), (mut b, mut fb)) = (positive, negative);
        // forces cost most, and are polished from there anyway
        let (t0, t1) = (stepper.start_time(), stepper.time());
        let resolution = match watched {
            Watched::Margin => RESOLUTION_S.max(FORCES_SEEN * (t1 - t0)),
            _ => RESOLUTION_S,
        };
        // Illinois: false position that halves the value of an end that stays
        for _ in 0..80 {
            if b - a <= resolution {
                break;
            }
            let guess = a + (b - a) * fa / (fa - fb);
            let t = if guess > a && guess < b { guess } else { 0.5 * (a + b) };
            let value = self.value(motion, stepper, watched, t)?;
            if value > 0.0 {
                (a, fa, fb) = (t, value, 0.5 * fb);
            } else {
                (b, fb, fa) = (t, value, 0.5 * fa);
            }
        }
        Ok(0.5 * (a + b))
    }

    /// Newton's method on steps of the very length, from a root of the dense output.
    fn polish(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        watched: Watched,
        guess: f64,
    ) -> Result<f64, Breakdown> {
        let (t0, t1) = (stepper.start_time(), stepper.time());
        let width = (1e-4 * (t1 - t0)).max(1e-12);
        let before = self.value(motion, stepper, watched, guess - width)?;
        let after = self.value(motion, stepper, watched, guess + width)?;
        let slope = (after - before) / (2.0 * width);
        let mut t = guess;
        for _ in 0..6 {
            let value = self.stepped_value(motion, stepper, watched, t)?;
            let change = value / slope;
            // a crossing without slope stays where dense output saw it, and so does one that leads
            // back towards the start, where what has just opened was zero
            let near = (t - change - guess).abs() < 0.5 * (guess - t0);
            if !near || slope >= 0.0 {
                return Ok(guess);
            }
            t = (t - change).min(t1);
            if change.abs() <= RESOLUTION_S {
                break;
            }
        }
        Ok(t)
    }

    /// A watched value at the end of a step of the very length.
    fn stepped_value(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &mut Stepper,
        watched: Watched,
        t_s: f64,
    ) -> Result<f64, Breakdown> {
        let mut y = std::mem::take(&mut self.y);
        let value = stepper
            .restep(motion, t_s, &mut y)
            .and_then(|()| self.measure(motion, watched, t_s, &y));
        self.y = y;
        value
    }

    fn value(
        &mut self,
        motion: &mut Motion<'_>,
        stepper: &Stepper,
        watched: Watched,
        t_s: f64,
    ) -> Result<f64, Breakdown> {
        let mut y = std::mem::take(&mut self.y);
        stepper.interpolate(t_s, &mut y);
        let value = self.measure(motion, watched, t_s, &y);
        self.y = y;
        value
    }

    /// A watched value at a state.
    pub(super) fn measure(
        &mut self,
        motion: &mut Motion<'_>,
        watched: Watched,
        t_s: f64,
        y: &[f64],
    ) -> Result<f64, Breakdown> {
        if watched == Watched::Margin {
            return Ok(margin(motion, t_s, y)? + self.slack);
        }
        self.look(motion, &[watched], y);
        Ok(self.seen(motion, watched, y))
    }

    /// Places the points that are listed, and lets contacts move.
    fn look(&mut self, motion: &mut Motion<'_>, list: &[Watched], y: &[f64]) {
        if list.iter().any(|watched| matches!(watched, Watched::SlipSpeed(_))) {
            let closed: Vec<usize> = motion.closed.iter().map(|closed| closed.contact).collect();
            motion.follow_points(y, &closed);
        } else if list.iter().any(|watched| matches!(watched, Watched::Gap(_))) {
            motion.place(y);
        }
        if list.iter().any(|watched| matches!(watched, Watched::FallPoint(_))) {
            let parts = motion.layout.parts(y);
            motion.plant.link_transforms(parts.q, &mut self.transforms);
            let points = &motion.plant.model().fall_points;
            point_positions(points, &self.transforms, &mut self.points);
        }
    }

    /// A watched value, forces excepted, of the points as they are placed.
    fn seen(&mut self, motion: &mut Motion<'_>, watched: Watched, y: &[f64]) -> f64 {
        let parts = motion.layout.parts(y);
        match watched {
            Watched::Gap(contact) => motion.gap(contact) - self.level[contact],
            Watched::FallPoint(point) => {
                let radius_m = motion.plant.model().fall_radii_m[point];
                motion.ground.gap(&self.points[3 * point..3 * point + 3]) - radius_m
            }
            Watched::Guard(guard) => motion.plant.guard(guard, parts.q, parts.qd),
            Watched::SlipSpeed(index) => slip_speed(motion, index),
            Watched::QuarterTurn(joint) => quarter_turn_left(parts.q[joint]),
            Watched::Margin => f64::INFINITY,
        }
    }
}

/// The earliest of some crossings.
fn first(crossings: &[Fired]) -> Option<Fired> {
    crossings.iter().copied().reduce(|first, next| if next.t_s < first.t_s { next } else { first })
}

fn sample_time(t0: f64, t1: f64, sample: usize) -> f64 {
    if sample == SAMPLES { t1 } else { t0 + (t1 - t0) * sample as f64 / SAMPLES as f64 }
}

fn slip_speed(motion: &Motion<'_>, index: usize) -> f64 {
    let (closed, rows) = (&motion.closed[index], motion.ground.rows());
    let velocity = &motion.work.velocity[index * rows..(index + 1) * rows - 1];
    motion.holding.slips.slip_left(velocity, closed)
}

/// Least force to spare, and what counts as none: adhesion of that size is rounding \[N\].
fn margin(motion: &mut Motion<'_>, t_s: f64, y: &[f64]) -> Result<f64, Breakdown> {
    let (spare, largest) = spare_force(motion, t_s, y)?;
    let tolerance = motion.holding.tolerance;
    Ok(spare.min(1e9) + 4.0 * (tolerance.force + tolerance.relative * largest))
}

/// Least force to spare, and the largest of all \[N\].
fn spare_force(motion: &mut Motion<'_>, t_s: f64, y: &[f64]) -> Result<(f64, f64), Breakdown> {
    motion.pose(t_s, y)?;
    let work = &motion.work;
    let problem = ContactProblem {
        space: motion.ground.space,
        contacts: &work.contacts,
        delassus: motion.delassus.matrix(),
        free: &work.free,
        tolerance: motion.holding.tolerance,
    };
    motion.solver.margin(&problem, &work.modes).map_err(Breakdown::Contact)
}

/// A time just after the forces have reached a limit, with the state that the modes before would
/// lead to: as near as the limit is broken there by much more than rounding, else where it is
/// broken most. Returns that time, and the force to spare there.
pub(super) fn look_ahead(
    motion: &mut Motion<'_>,
    stepper: &mut Stepper,
    t_s: f64,
    y: &mut [f64],
) -> Result<(f64, f64), Breakdown> {
    // the step was good up to its end; not much is known beyond
    let last = stepper.time().max(t_s + 64.0 * AHEAD_S);
    // steps are as long as what changes the forces takes, and may be much shorter
    let length = stepper.time() - stepper.start_time();
    let mut ahead = AHEAD_S.min((stepper.time() - t_s).max(0.1 * length)).max(SHORTEST_S);
    let mut worst = (t_s, f64::INFINITY);
    let mut trial = y.to_vec();
    loop {
        let t = (t_s + ahead).min(last);
        stepper.restep(motion, t, &mut trial)?;
        let (spare, largest) = spare_force(motion, t, &trial)?;
        if spare < worst.1 {
            worst = (t, spare);
            y.copy_from_slice(&trial);
        }
        if t >= last || spare < -1e-4 * largest {
            return Ok(worst);
        }
        ahead *= 4.0;
    }
}
