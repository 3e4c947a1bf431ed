//! Contacts that come down so slowly that they never cross the ground.
//!
//! A sole that lands tilted by less than what counts as touching is laid flat by the control of
//! drift: the heights of its open points go to zero and stay there. What has been above the ground
//! and touches it at hardly any speed is an event, too.

use super::ground::TOUCH_M;
use super::integrate::Stepper;
use super::motion::Motion;

/// What sinks slower than this hardly does [m/s].
const ALIGHTING_SPEED: f64 = 1e-6;

/// Looks for contacts that alight.
#[derive(Clone, Debug)]
pub(super) struct Alighting {
    /// Whether each contact has been above the ground since it was closed, or tried.
    risen: Vec<bool>,
    y: Vec<f64>,
}

impl Alighting {
    pub(super) fn new(contacts: usize, len: usize) -> Self {
        Self { risen: vec![false; contacts], y: vec![0.0; len] }
    }

    /// A contact has been tried: what it was above the ground before says nothing.
    pub(super) fn tried(&mut self, contact: usize) {
        self.risen[contact] = false;
    }

    /// A contact that has alighted at the end of the last step.
    pub(super) fn find(&mut self, motion: &mut Motion<'_>, stepper: &Stepper) -> Option<usize> {
        for closed in &motion.closed {
            self.risen[closed.contact] = false;
        }
        motion.place(stepper.state());
        let is_closed =
            |contact: usize| motion.closed.iter().any(|closed| closed.contact == contact);
        for contact in 0..self.risen.len() {
            self.risen[contact] |= motion.gap(contact) > TOUCH_M && !is_closed(contact);
        }
        let touches = |contact: &usize| self.risen[*contact] && motion.gap(*contact) <= TOUCH_M;
        let low: Vec<(usize, f64)> = (0..self.risen.len())
            .filter(touches)
            .map(|contact| (contact, motion.gap(contact)))
            .collect();
        if low.is_empty() {
            return None;
        }
        stepper.interpolate(stepper.start_time(), &mut self.y);
        motion.place(&self.y);
        let sinks = ALIGHTING_SPEED * (stepper.time() - stepper.start_time());
        let alights = |(contact, gap): &&(usize, f64)| motion.gap(*contact) - gap < sinks;
        let found = low.iter().find(alights).map(|(contact, _)| *contact);
        motion.place(stepper.state());
        if let Some(contact) = found {
            self.risen[contact] = false;
        }
        found
    }
}
