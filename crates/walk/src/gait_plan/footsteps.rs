//! Footsteps in space, and the course of a walk over them: which feet stand when, and where the
//! centre of pressure is to be.

use super::biped::{AnkleRoll, SolePlace};
use super::plan::JointGains;

/// A leg.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The right one.
    Right,
    /// The left one.
    Left,
}

impl Side {
    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 2] = ["right", "left"];
    /// Both of them, in the order of the enum.
    pub const ALL: [Self; 2] = [Self::Right, Self::Left];
}

/// Who turns the ankles about their forward axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum AnkleRolls {
    /// Joint laws, as all other joints: the torso stays upright.
    #[default]
    Driven,
    /// The model's springs alone. That of the foot that stands is planned at zero, with the centre
    /// of pressure on its axis, so that it need not turn; the torso leans for that.
    Passive,
}

impl AnkleRolls {
    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 2] = ["driven", "passive"];
    /// Both of them, in the order of the enum.
    pub const ALL: [Self; 2] = [Self::Driven, Self::Passive];
}

/// How a walk ends; at rest in any case.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Ending {
    /// With one more step, which puts the feet side by side.
    #[default]
    SideBySide,
    /// With the weight over the foot that has stepped last.
    OnLastFoot,
}

impl Ending {
    /// What files call them, in the order of the enum.
    pub const WORDS: [&'static str; 2] = ["side_by_side", "on_last_foot"];
    /// Both of them, in the order of the enum.
    pub const ALL: [Self; 2] = [Self::SideBySide, Self::OnLastFoot];
}

/// A step: where the middle between the feet goes, seen from where it was, and its foot with it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Footstep {
    /// Forward \[m\].
    pub forward_m: f64,
    /// To the left \[m\].
    pub left_m: f64,
    /// Turn to the left \[rad\].
    pub turn_rad: f64,
    /// Distance of the middles of the soles after it; none: that of the whole walk \[m\].
    pub width_m: Option<f64>,
}

/// What the walk is to be.
#[derive(Clone, Debug, PartialEq)]
pub struct DivergentComponentProblem {
    /// The steps, but for one that puts the feet side by side.
    pub footsteps: Vec<Footstep>,
    /// How the walk ends.
    pub ends: Ending,
    /// From a foot's landing to the next one's, single and double support \[s\].
    pub step_s: f64,
    /// Double support in it \[s\].
    pub double_support_s: f64,
    /// Standing before the first foot leaves, and after the last one has landed \[s\].
    pub standing_s: [f64; 2],
    /// Height of the centre of mass above the ground \[m\].
    pub center_of_mass_height_m: f64,
    /// Height of the swing foot in the middle of its way \[m\].
    pub lift_m: f64,
    /// Distance of the middles of the soles; none: as where all coordinates are zero \[m\].
    pub step_width_m: Option<f64>,
    /// The leg that swings first.
    pub first_swing: Side,
    /// Pitch of the torso, positive forward \[rad\].
    pub torso_pitch_rad: f64,
    /// Where the centre of pressure is at the beginning and at the end of single support, forward
    /// from the middle of the sole \[m\].
    pub center_of_pressure_m: [f64; 2],
    /// How far it is from the middle of the sole towards the other foot; none: in the middle where
    /// ankle rolls are driven, on their axis where they are passive \[m\].
    pub pressure_inward_m: Option<f64>,
    /// Who turns the ankle rolls.
    pub ankle_rolls: AnkleRolls,
    /// How often the centre of pressure is corrected by the zero moment point of all bodies.
    pub corrections: usize,
    /// The largest distance of knots \[s\].
    pub interval_s: f64,
    /// The least margin of the planned zero moment point \[m\].
    pub margin_m: f64,
    /// Laws of the joints.
    pub gains: JointGains,
}

impl DivergentComponentProblem {
    /// How often a foot swings.
    pub fn swings(&self) -> usize {
        self.footsteps.len() + usize::from(self.ends == Ending::SideBySide)
    }

    /// How far the centre of pressure is from the middle of a sole, forward and to the left, at the
    /// beginning and at the end of single support \[m\].
    fn pressures_m(&self, side: usize, rolls: Option<[AnkleRoll; 2]>) -> [[f64; 2]; 2] {
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let left_m = match (self.pressure_inward_m, self.ankle_rolls, rolls) {
            (Some(inward_m), _, _) => sign * inward_m,
            (None, AnkleRolls::Passive, Some(rolls)) => rolls[side].left_m,
            _ => 0.0,
        };
        self.center_of_pressure_m.map(|forward_m| [forward_m, left_m])
    }
}

/// The swing foot rises before it goes on, and sinks after: shares of the swing.
const ONWARD: [f64; 2] = [0.15, 0.85];

/// A time in which the same feet stand.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Phase {
    pub(crate) name: String,
    pub(crate) start_s: f64,
    pub(crate) duration_s: f64,
    /// At the beginning, right and left.
    pub(crate) soles: [SolePlace; 2],
    /// The foot that swings, and where it lands.
    pub(crate) swing: Option<(usize, SolePlace)>,
    /// Direction of the torso at the beginning and at the end \[rad\].
    pub(crate) yaws_rad: [f64; 2],
    /// Share of the left foot in the load at the beginning and at the end.
    pub(crate) loads: [f64; 2],
    /// The centre of pressure at the beginning and at the end \[m\].
    pub(crate) pressures_m: [[f64; 2]; 2],
}

impl Phase {
    pub(crate) fn standing(&self) -> [bool; 2] {
        [0, 1].map(|side| self.swing.is_none_or(|(swing, _)| swing != side))
    }

    /// The foot that stands, or one of both.
    pub(crate) fn stance(&self) -> usize {
        self.swing.map_or(0, |(side, _)| 1 - side)
    }

    pub(crate) fn end_s(&self) -> f64 {
        self.start_s + self.duration_s
    }

    /// The feet at a share of the phase.
    pub(crate) fn soles_at(&self, share: f64, lift_m: f64) -> [SolePlace; 2] {
        let mut soles = self.soles;
        if let Some((side, landing)) = self.swing {
            let way = smooth((share - ONWARD[0]) / (ONWARD[1] - ONWARD[0]));
            let between = |from: f64, to: f64| from + (to - from) * way;
            let from = soles[side];
            soles[side] = SolePlace {
                middle_m: [0, 1].map(|axis| between(from.middle_m[axis], landing.middle_m[axis])),
                yaw_rad: between(from.yaw_rad, landing.yaw_rad),
                lift_m: lift_m * hump(share),
            };
        }
        soles
    }

    /// The centre of pressure at a share of the phase \[m\].
    pub(crate) fn pressure_at(&self, share: f64) -> [f64; 2] {
        let [from, to] = self.pressures_m;
        [0, 1].map(|axis| from[axis] + (to[axis] - from[axis]) * share.clamp(0.0, 1.0))
    }

    /// Direction of the torso \[rad\].
    pub(crate) fn yaw_at(&self, share: f64) -> f64 {
        self.yaws_rad[0] + (self.yaws_rad[1] - self.yaws_rad[0]) * smooth(share)
    }

    /// Share of the left foot in the load.
    pub(crate) fn load_at(&self, share: f64) -> f64 {
        self.loads[0] + (self.loads[1] - self.loads[0]) * smooth(share)
    }
}

/// From 0 to 1 without velocity and acceleration at the ends.
pub(crate) fn smooth(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    u * u * u * (10.0 - u * (15.0 - 6.0 * u))
}

/// From 0 to 1 and back to 0, without velocity and acceleration at the ends.
fn hump(share: f64) -> f64 {
    let u = share.clamp(0.0, 1.0);
    (4.0 * u * (1.0 - u)).powi(3)
}

/// Phases from standing to standing.
pub(super) fn phases(
    problem: &DivergentComponentProblem,
    width_m: f64,
    rolls: Option<[AnkleRoll; 2]>,
) -> Vec<Phase> {
    let first = usize::from(problem.first_swing == Side::Left);
    let mut frame = SolePlace { middle_m: [0.0; 2], yaw_rad: 0.0, lift_m: 0.0 };
    let mut width = problem.step_width_m.unwrap_or(width_m);
    let soles = [0, 1].map(|side| beside(&frame, side, width));
    let mut course = Course { problem, rolls, soles, load: 0.5, phases: Vec::new() };
    let pressures_m = [course.middle_m(), course.pressures_m(1 - first)[0]];
    let [begin_s, end_s] = problem.standing_s;
    course.push("start".to_owned(), begin_s, None, pressures_m, stance_load(1 - first));
    for step in 0..problem.swings() {
        let side = (first + step) % 2;
        if let Some(footstep) = problem.footsteps.get(step) {
            width = footstep.width_m.or(problem.step_width_m).unwrap_or(width_m);
            frame.middle_m = frame.point_m([footstep.forward_m, footstep.left_m]);
            frame.yaw_rad += footstep.turn_rad;
        }
        let pressures_m = course.pressures_m(1 - side);
        let [_, to] = pressures_m;
        let swing_s = problem.step_s - problem.double_support_s;
        let swing = Some((side, beside(&frame, side, width)));
        let name = format!("step {}, swing", step + 1);
        course.push(name, swing_s, swing, pressures_m, stance_load(1 - side));
        if step + 1 == problem.swings() {
            let (last_m, load) = match problem.ends {
                Ending::SideBySide => (course.middle_m(), 0.5),
                Ending::OnLastFoot => (course.pressures_m(side)[1], stance_load(side)),
            };
            course.push("stop".to_owned(), end_s, None, [to, last_m], load);
        } else {
            let pressures_m = [to, course.pressures_m(side)[0]];
            let name = format!("step {}, double support", step + 1);
            let both_s = problem.double_support_s;
            course.push(name, both_s, None, pressures_m, stance_load(side));
        }
    }
    course.phases
}

/// The share of the left foot in the load where one foot stands.
fn stance_load(side: usize) -> f64 {
    side as f64
}

/// The place of a foot beside the middle between both.
fn beside(frame: &SolePlace, side: usize, width_m: f64) -> SolePlace {
    let left_m = if side == 0 { -0.5 * width_m } else { 0.5 * width_m };
    SolePlace { middle_m: frame.point_m([0.0, left_m]), ..*frame }
}

/// Phases that are put one after the other.
struct Course<'a> {
    problem: &'a DivergentComponentProblem,
    rolls: Option<[AnkleRoll; 2]>,
    /// Where the feet are now, and the share of the left one in the load.
    soles: [SolePlace; 2],
    load: f64,
    phases: Vec<Phase>,
}

impl Course<'_> {
    /// The centre of pressure at the beginning and at the end of a foot's single support \[m\].
    fn pressures_m(&self, side: usize) -> [[f64; 2]; 2] {
        self.problem.pressures_m(side, self.rolls).map(|place| self.soles[side].point_m(place))
    }

    /// In the middle between feet that stand side by side.
    fn middle_m(&self) -> [f64; 2] {
        let [right, left] = [0, 1].map(|side| self.pressures_m(side)[0]);
        [0, 1].map(|axis| 0.5 * (right[axis] + left[axis]))
    }

    fn push(
        &mut self,
        name: String,
        duration_s: f64,
        swing: Option<(usize, SolePlace)>,
        pressures_m: [[f64; 2]; 2],
        load: f64,
    ) {
        let yaw = |soles: &[SolePlace; 2]| 0.5 * (soles[0].yaw_rad + soles[1].yaw_rad);
        let before = self.soles;
        if let Some((side, landing)) = swing {
            self.soles[side] = landing;
        }
        self.phases.push(Phase {
            name,
            start_s: self.phases.last().map_or(0.0, Phase::end_s),
            duration_s,
            soles: before,
            swing,
            yaws_rad: [yaw(&before), yaw(&self.soles)],
            loads: [self.load, load],
            pressures_m,
        });
        self.load = load;
    }
}
