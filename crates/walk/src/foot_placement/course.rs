//! A planned walk whose footsteps are moved, and how the pendulum follows it from where it is.

use super::law::FootPlacement;
use super::pendulum::Pendulum;
use crate::gait_plan::{PendulumPath, Phase, PressureSegment, SolePlace, SpaceWalk};
use denavit_plants::PlantModel;
use std::sync::Arc;

/// The walk as it is planned now.
#[derive(Clone, Debug)]
pub(super) struct Course {
    walk: Arc<SpaceWalk>,
    /// With the soles where they are, or land.
    pub(super) phases: Vec<Phase>,
    /// How far each landing, by its phase, has been moved \[m\].
    moved_m: Vec<[f64; 2]>,
    /// What moved footsteps add to the pendulum, along x and y.
    added: [PendulumPath; 2],
}

/// The centre of pressure stays for so long at most \[s\].
const HELD_S: f64 = 5e-3;
/// The largest share of a way is found this well.
const HALVINGS: usize = 20;

impl Course {
    pub(super) fn new(walk: Arc<SpaceWalk>) -> Self {
        let phases = walk.phases.clone();
        let moved_m = vec![[0.0; 2]; phases.len()];
        let added = added(&walk, &phases);
        Self { walk, phases, moved_m, added }
    }

    /// w \[1/s\].
    pub(super) fn omega(&self) -> f64 {
        self.walk.omega()
    }

    pub(super) fn end_s(&self) -> f64 {
        self.phases.last().map_or(0.0, Phase::end_s)
    }

    /// The phase of a time.
    pub(super) fn phase_at(&self, t_s: f64) -> usize {
        let after = self.phases.partition_point(|phase| phase.start_s <= t_s);
        after.saturating_sub(1)
    }

    /// Where the pendulum is planned to be, and its centre of pressure \[m\].
    pub(super) fn planned(&self, t_s: f64) -> (Pendulum, [f64; 2]) {
        let omega = self.omega();
        let (mut pendulum, mut pressure_m) = (Pendulum::default(), [0.0; 2]);
        for axis in 0..2 {
            let [own, added] =
                [&self.walk.center[axis], &self.added[axis]].map(|path| path.at(t_s));
            let center = own.position_m + added.position_m;
            pendulum.center_m[axis] = center;
            pendulum.divergent_m[axis] = center + (own.velocity_m_s + added.velocity_m_s) / omega;
            pressure_m[axis] = own.pressure_m + added.pressure_m;
        }
        (pendulum, pressure_m)
    }

    /// A foot stands at a place from a phase on, until it swings.
    pub(super) fn stand(&mut self, from: usize, side: usize, place: SolePlace) {
        let place = SolePlace { lift_m: 0.0, ..place };
        for phase in &mut self.phases[from..] {
            phase.soles[side] = place;
            if phase.swing.is_some_and(|(swing, _)| swing == side) {
                break;
            }
        }
    }

    /// The foot that swings in a phase lands elsewhere by so much, and all feet after it do \[m\].
    pub(super) fn move_landing(&mut self, at: usize, [x, y]: [f64; 2]) {
        let moved = |place: [f64; 2], share: f64| [place[0] + share * x, place[1] + share * y];
        let mut is_moved = [false; 2];
        for (index, phase) in self.phases.iter_mut().enumerate().skip(at) {
            for side in (0..2).filter(|side| is_moved[*side]) {
                phase.soles[side].middle_m = moved(phase.soles[side].middle_m, 1.0);
            }
            // the centre of pressure is where the load is
            let [right, left] = is_moved.map(|is_moved| f64::from(u8::from(is_moved)));
            for (place, load) in phase.pressures_m.iter_mut().zip(phase.loads) {
                *place = moved(*place, (1.0 - load) * right + load * left);
            }
            if let Some((side, landing)) = &mut phase.swing {
                landing.middle_m = moved(landing.middle_m, 1.0);
                is_moved[*side] = true;
                if index == at {
                    self.moved_m[at] = moved(self.moved_m[at], 1.0);
                }
            }
        }
        self.added = added(&self.walk, &self.phases);
    }

    /// By how much the divergent component moves at the end of a swing if its landing moves by 1.
    pub(super) fn reach_of_landing(&self, at: usize) -> f64 {
        let mut other = self.clone();
        other.move_landing(at, [1.0, 0.0]);
        let end_s = self.phases[at].end_s();
        let [own, moved] = [self, &other].map(|course| course.planned(end_s).0.divergent_m[0]);
        moved - own
    }

    /// How far a landing may still be moved of a way: not too far, and not onto the other foot.
    pub(super) fn allowed(&self, at: usize, way_m: [f64; 2], farthest_m: f64) -> [f64; 2] {
        let Some((side, landing)) = self.phases[at].swing else { return [0.0; 2] };
        let stance = self.phases[at].soles[1 - side];
        let (sine, cosine) = stance.yaw_rad.sin_cos();
        let [x, y] = way_m;
        let [forward, left] = [cosine * x + sine * y, cosine * y - sine * x];
        let turned = |left: f64| [cosine * forward - sine * left, sine * forward + cosine * left];
        let is_apart = |share: f64| {
            let [x, y] = turned(share * left);
            let mut soles = [stance; 2];
            let [a, b] = landing.middle_m;
            soles[side] = SolePlace { middle_m: [a + x, b + y], ..landing };
            self.walk.biped.are_apart(&soles)
        };
        let [x, y] = turned(largest_share(is_apart) * left);
        let moved = self.moved_m[at];
        let is_near = |share: f64| {
            (moved[0] + share * x).hypot(moved[1] + share * y)
                <= farthest_m.max(moved[0].hypot(moved[1]))
        };
        let share = largest_share(is_near);
        [share * x, share * y]
    }

    /// The pendulum after each of these times, the first of which is now: the centre of pressure
    /// goes beyond the divergent component, inside the soles that stand.
    pub(super) fn followed(
        &self,
        model: &PlantModel,
        law: &FootPlacement,
        times_s: &[f64],
        now: Pendulum,
    ) -> Vec<Pendulum> {
        let omega = self.omega();
        let mut followed = Vec::with_capacity(times_s.len());
        followed.push(now);
        let mut pendulum = now;
        for pair in times_s.windows(2) {
            let count = ((pair[1] - pair[0]) / HELD_S).ceil().max(1.0);
            let held_s = (pair[1] - pair[0]) / count;
            for index in 0..count as usize {
                let t_s = pair[0] + held_s * (index as f64 + 0.5);
                let pressure_m = self.pressure_m(model, law, t_s, &pendulum);
                pendulum = pendulum.after(omega, held_s, pressure_m);
            }
            followed.push(pendulum);
        }
        followed
    }

    fn pressure_m(
        &self,
        model: &PlantModel,
        law: &FootPlacement,
        t_s: f64,
        pendulum: &Pendulum,
    ) -> [f64; 2] {
        let (planned, place) = self.planned(t_s);
        let beyond = |axis: usize| {
            (1.0 + law.gain) * (pendulum.divergent_m[axis] - planned.divergent_m[axis])
        };
        let way = [beyond(0), beyond(1)];
        let phase = &self.phases[self.phase_at(t_s)];
        let standing = phase.standing();
        let margin = |share: f64| {
            let at = [0, 1].map(|axis| place[axis] + share * way[axis]);
            self.walk.biped.margin_m(model, &phase.soles, standing, at)
        };
        let least_m = law.margin_m.min(margin(0.0));
        let share = largest_share(|share| margin(share) >= least_m);
        [0, 1].map(|axis| place[axis] + share * way[axis])
    }
}

/// The largest share of a way, at most all of it, up to which something holds that holds at its
/// beginning.
fn largest_share(holds: impl Fn(f64) -> bool) -> f64 {
    if holds(1.0) {
        return 1.0;
    }
    let [mut low, mut high] = [0.0, 1.0];
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// What moved footsteps add to the pendulum. It is linear: what is added follows from what is added
/// to the centre of pressure.
fn added(walk: &SpaceWalk, phases: &[Phase]) -> [PendulumPath; 2] {
    [0, 1].map(|axis| {
        let segment = |(moved, own): (&Phase, &Phase)| PressureSegment {
            duration_s: own.duration_s,
            places_m: [0, 1].map(|end| moved.pressures_m[end][axis] - own.pressures_m[end][axis]),
        };
        let segments: Vec<PressureSegment> = phases.iter().zip(&walk.phases).map(segment).collect();
        PendulumPath::new(walk.omega(), &segments, 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gait_file::{GaitKind, read_gait};
    use crate::gait_plan::plan_space_walk;
    use denavit_codegen::model;
    use denavit_plants::{plant_of, shipped};

    fn course() -> Course {
        let text = shipped::find("tulip").unwrap().text;
        let mut plant = plant_of(&model::read("tulip", text.as_bytes()).unwrap(), &[]).unwrap();
        let gait = shipped::find_gait("tulip_walk").unwrap().text;
        match read_gait("tulip_walk", gait.as_bytes()).unwrap().kind {
            GaitKind::DivergentComponent(problem) => {
                let (_, walk) = plan_space_walk(plant.as_mut(), &problem).unwrap();
                Course::new(Arc::new(walk))
            }
            other => panic!("{other:?}"),
        }
    }

    /// Where the centre of pressure goes from place to place in double support T, a landing that is
    /// moved by 1 moves the divergent component at its time by (1 - e^(-wT)) / (wT).
    #[test]
    fn a_moved_landing_reaches_back_by_its_closed_form() {
        let course = course();
        let swing = (0..course.phases.len()).find(|at| course.phases[*at].swing.is_some()).unwrap();
        let time = course.omega() * course.phases[swing + 1].duration_s;
        let expected = (1.0 - (-time).exp()) / time;
        assert!((course.reach_of_landing(swing) - expected).abs() < 1e-9);
    }

    /// All that follows is beside what was planned, at rest at the end; what went before is not.
    #[test]
    fn all_footsteps_after_a_moved_landing_move_with_it() {
        let (own, mut moved) = (course(), course());
        let swings: Vec<usize> =
            (0..own.phases.len()).filter(|at| own.phases[*at].swing.is_some()).collect();
        let way = [0.03, -0.05];
        moved.move_landing(swings[3], way);
        let beside = |at: usize| {
            let place = |course: &Course| course.phases[at].swing.unwrap().1.middle_m;
            let (from, to) = (place(&own), place(&moved));
            [to[0] - from[0], to[1] - from[1]]
        };
        for (number, swing) in swings.iter().enumerate() {
            let expected = if number < 3 { [0.0; 2] } else { way };
            (0..2).for_each(|k| assert!((beside(*swing)[k] - expected[k]).abs() < 1e-12));
        }
        let [(before, _), (after, place)] =
            [&own, &moved].map(|course| course.planned(course.end_s()));
        for axis in 0..2 {
            let apart = after.center_m[axis] - before.center_m[axis];
            assert!((apart - way[axis]).abs() < 1e-3, "{apart}");
            assert!((after.divergent_m[axis] - place[axis]).abs() < 1e-3);
        }
        let [early, planned] = [&moved, &own].map(|course| course.planned(0.5).0);
        assert!((early.divergent_m[1] - planned.divergent_m[1]).abs() < 1e-3);
    }

    #[test]
    fn the_largest_share_is_found() {
        assert_eq!(largest_share(|_| true), 1.0);
        assert!((largest_share(|share| share <= 0.3) - 0.3).abs() < 1e-5);
    }
}
