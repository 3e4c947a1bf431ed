//! What the planner does at each look: leave the plan as it is, or make a new one.

use super::course::Course;
use super::law::FootPlacementLaw;
use super::measured::Measured;
use super::motion::{Motion, knots};
use super::pendulum::Pendulum;
use denavit_plants::Plant;
use denavit_simulate::{JointPlan, ReferencePlanner, Sensed};

/// The planner of a run.
pub(super) struct Stepper {
    law: FootPlacementLaw,
    course: Course,
    /// By how much the clock of the course is ahead of that of the run: feet landed early \[s\].
    ahead_s: f64,
    /// The last swing whose landing has been looked at.
    taken_in: Option<usize>,
    /// When the last plan was made \[s\].
    planned_s: f64,
    /// How the pendulum was expected to go on at the last plan; none while the walk is as planned.
    expected: Option<(Vec<f64>, Vec<Pendulum>)>,
}

/// A foot that has swung for this share of its time lands where it touches.
const SWUNG: f64 = 0.6;
/// A plan has so much time before the next one, but for landings \[s\].
const AGAIN_S: f64 = 0.045;
/// Landings are moved by no less than this \[m\].
const LEAST_MOVE_M: f64 = 1e-3;
/// Shares of a move that are tried until the robot can do it.
const TRIED: [f64; 5] = [1.0, 0.75, 0.5, 0.25, 0.0];

impl Stepper {
    pub(super) fn new(law: FootPlacementLaw) -> Self {
        let course = Course::new(law.walk.clone());
        Self {
            law,
            course,
            ahead_s: 0.0,
            taken_in: None,
            planned_s: f64::NEG_INFINITY,
            expected: None,
        }
    }

    /// Where the divergent component should be at a time of the course \[m\].
    fn expected_m(&self, course_s: f64) -> [f64; 2] {
        let Some((times_s, pendulums)) = &self.expected else {
            return self.course.planned(course_s).0.divergent_m;
        };
        let after = times_s.partition_point(|t_s| *t_s <= course_s);
        let from = after.clamp(1, times_s.len() - 1) - 1;
        let share = (course_s - times_s[from]) / (times_s[from + 1] - times_s[from]);
        pendulums[from].towards(&pendulums[from + 1], share.clamp(0.0, 1.0)).divergent_m
    }

    /// The swing that has just ended, if it has not been taken in yet, and how early \[s\].
    fn landed(&self, measured: &Measured, course_s: f64) -> Option<(usize, f64)> {
        let at = self.course.phase_at(course_s);
        let phase = &self.course.phases[at];
        let landed = match phase.swing {
            Some((side, _)) => {
                let share = (course_s - phase.start_s) / phase.duration_s;
                let has_landed = share >= SWUNG && measured.touches[side];
                has_landed.then_some((at, phase.end_s() - course_s))?
            }
            None => (at.checked_sub(1)?, 0.0),
        };
        (self.taken_in != Some(landed.0)).then_some(landed)
    }

    /// Takes a foot to be where it has landed; says if that makes another plan.
    fn take_in(&mut self, ended: usize, measured: &Measured) -> bool {
        self.taken_in = Some(ended);
        let Some((side, landing)) = self.course.phases[ended].swing else { return false };
        let place = measured.soles[side];
        let missed = [0, 1].map(|axis| place.middle_m[axis] - landing.middle_m[axis]);
        let is_elsewhere = missed[0].hypot(missed[1]) > self.law.numbers.tolerance_m;
        if is_elsewhere {
            self.course.move_landing(ended, missed);
        }
        is_elsewhere
    }

    /// A new plan from here on.
    fn anew(
        &mut self,
        plant: &mut dyn Plant,
        measured: &Measured,
        course_s: f64,
    ) -> Option<Vec<JointPlan>> {
        let at = self.course.phase_at(course_s);
        let mut course = self.course.clone();
        let standing = course.phases[at].standing();
        for side in (0..2).filter(|side| standing[*side]) {
            course.stand(at, side, measured.soles[side]);
        }
        let numbers = &self.law.numbers;
        let times_s = knots(&course, course_s, self.law.walk.problem.interval_s);
        if times_s.len() < 2 {
            return None;
        }
        let model = plant.model().clone();
        let mut way = [0.0; 2];
        if course.phases[at].swing.is_some() {
            let end_s = course.phases[at].end_s();
            let landing = times_s.partition_point(|t_s| *t_s < end_s - 1e-9);
            let until = &times_s[..=landing];
            let followed = course.followed(&model, numbers, until, measured.pendulum);
            let planned = course.planned(end_s).0.divergent_m;
            let reach = course.reach_of_landing(at);
            let missed = followed[landing].divergent_m;
            way = [0, 1].map(|axis| (missed[axis] - planned[axis]) / reach);
            way = course.allowed(at, way, numbers.farthest_m);
            if way[0].hypot(way[1]) < LEAST_MOVE_M {
                way = [0.0; 2];
            }
        }
        // both phases after which the load is on the other foot, if there are as many
        let needed_s = course.phases[(at + 1).min(course.phases.len() - 1)].end_s();
        let mut best: Option<(f64, Course, Vec<Pendulum>, Vec<JointPlan>)> = None;
        for share in TRIED {
            let mut moved = course.clone();
            moved.move_landing(at, way.map(|part| share * part));
            let pendulums = moved.followed(&model, numbers, &times_s, measured.pendulum);
            let motion = Motion {
                law: &self.law,
                course: &moved,
                measured,
                times_s: &times_s,
                pendulums: &pendulums,
            };
            let Some((plans, reached_s)) = motion.plans(plant) else { continue };
            if best.as_ref().is_none_or(|(farthest_s, ..)| reached_s > *farthest_s) {
                best = Some((reached_s, moved, pendulums, plans));
            }
            if reached_s >= needed_s || way == [0.0; 2] {
                break;
            }
        }
        let (_, moved, pendulums, plans) = best?;
        self.course = moved;
        self.expected = Some((times_s, pendulums));
        Some(plans)
    }
}

impl ReferencePlanner for Stepper {
    fn plan(&mut self, plant: &mut dyn Plant, sensed: &Sensed<'_>) -> Option<Vec<JointPlan>> {
        let course_s = sensed.t_s + self.ahead_s;
        if course_s >= self.course.end_s() {
            return None;
        }
        let (biped, omega) = (&self.law.walk.biped, self.course.omega());
        let measured = Measured::of(plant, biped, omega, sensed);
        let landed = self.landed(&measured, course_s);
        let is_elsewhere = landed.is_some_and(|(ended, _)| self.take_in(ended, &measured));
        let early_s = landed.map_or(0.0, |(_, early_s)| early_s);
        let [x, y] = measured.pendulum.divergent_m;
        let [expected_x, expected_y] = self.expected_m(course_s);
        let numbers = &self.law.numbers;
        let is_off = (x - expected_x).hypot(y - expected_y) > numbers.tolerance_m;
        let is_due = sensed.t_s - self.planned_s > AGAIN_S || landed.is_some();
        let is_early = early_s > numbers.period_s;
        if !(is_elsewhere || is_early || is_off && is_due) {
            return None;
        }
        // the clock of the course goes on to the end of the swing with the plan that begins there
        let plans = self.anew(plant, &measured, course_s + early_s)?;
        self.ahead_s += early_s;
        self.planned_s = sensed.t_s;
        Some(plans)
    }
}
