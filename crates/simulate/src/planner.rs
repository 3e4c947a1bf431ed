//! References that change while a robot moves: a planner looks at its state at fixed times and
//! says what joints follow from then on.
//!
//! References of a scenario are functions of time. A robot that steps where it would fall has to
//! plan during the run. Between two looks its references are functions of time again, so that
//! smooth motion, events and audits are those of any other control.

use super::control::Control;
use denavit_plants::Plant;
use denavit_plants::trajectory::Reference;
use std::any::Any;
use std::fmt;
use std::sync::Arc;

/// What a planner sees of a robot: the state as it is, without errors of measurement.
#[derive(Clone, Copy, Debug)]
pub struct Sensed<'a> {
    /// \[s\].
    pub t_s: f64,
    /// Positions of all coordinates [rad, m].
    pub q: &'a [f64],
    /// Their velocities [rad/s, m/s].
    pub qd: &'a [f64],
    /// Numbers of the contact points that are closed.
    pub closed: &'a [usize],
}

/// What a joint follows from now on.
#[derive(Clone, Debug, PartialEq)]
pub struct JointPlan {
    /// The coordinate.
    pub joint: usize,
    /// Its reference, on the clock of the run [rad, m].
    pub reference: Reference,
    /// Torque that is added [N m, N].
    pub feed_forward: Option<Reference>,
}

/// The planner of one run, with what it remembers.
pub trait ReferencePlanner {
    /// New plans of some joints; none leaves all as they are. The first look is at the start.
    fn plan(&mut self, plant: &mut dyn Plant, sensed: &Sensed<'_>) -> Option<Vec<JointPlan>>;
}

/// A law by which references are planned.
pub trait PlanningLaw: Any + fmt::Debug + Send + Sync {
    /// The distance of looks, positive \[s\].
    fn period_s(&self) -> f64;

    /// The planner of a new run.
    fn begin(&self) -> Box<dyn ReferencePlanner>;
}

/// A law that controls share; two are equal if they are the same one.
#[derive(Clone, Debug)]
pub struct Planning(Arc<dyn PlanningLaw>);

impl Planning {
    /// Of a law.
    pub fn new(law: impl PlanningLaw + 'static) -> Self {
        Self(Arc::new(law))
    }

    /// The law, if it is of this type.
    pub fn law<L: PlanningLaw>(&self) -> Option<&L> {
        let law: &dyn Any = self.0.as_ref();
        law.downcast_ref()
    }

    /// The distance of looks \[s\].
    pub fn period_s(&self) -> f64 {
        self.0.period_s()
    }
}

impl PartialEq for Planning {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The looks of a run.
pub(super) struct Looks {
    planner: Box<dyn ReferencePlanner>,
    period_s: f64,
    start_s: f64,
    /// Number of the next look.
    next: u64,
}

impl Looks {
    /// From the start of a run on; none without a planner.
    pub(super) fn of(control: &Control, start_s: f64) -> Option<Self> {
        let planning = control.planning.as_ref()?;
        let (planner, period_s) = (planning.0.begin(), planning.period_s());
        Some(Self { planner, period_s, start_s, next: 0 })
    }

    /// The time of the next look \[s\].
    pub(super) fn next_s(&self) -> f64 {
        self.start_s + self.next as f64 * self.period_s
    }

    /// Looks, if it is time to.
    pub(super) fn look(
        &mut self,
        plant: &mut dyn Plant,
        sensed: &Sensed<'_>,
    ) -> Option<Vec<JointPlan>> {
        if sensed.t_s < self.next_s() - 1e-12 {
            return None;
        }
        self.next += 1;
        self.planner.plan(plant, sensed)
    }
}

impl Control {
    /// Joints follow new plans from now on.
    pub(super) fn follow(&mut self, plans: Vec<JointPlan>) {
        for plan in plans {
            if let Some(law) = self.joints.get_mut(plan.joint) {
                law.reference = Some(plan.reference);
                law.feed_forward = plan.feed_forward;
            }
        }
    }
}
