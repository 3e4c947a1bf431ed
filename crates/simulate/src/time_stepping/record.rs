//! Writes a run by steps down: rows of the log, and the worst of every audit.
//!
//! A law of forces has no meaning at an instant here: a step knows impulses. Forces, moments and
//! momentum are compared over the interval between two rows, and the forces of a row are the means
//! over the interval that it ends.

use super::plant::{ControlledPlant, split};
use super::{StepLaw, StepReport, TimeStepper};
use crate::audit::{Audit, point_of_moment, worst};
use crate::control::Control;
use crate::ground::{Ground, cross, dot};
use crate::joint_record::JointObserver;
use crate::log::Log;
use crate::record::columns;
use crate::run::{Event, EventKind};
use crate::support::SupportPolygon;
use denavit_plants::PlantModel;

/// Log, audits and events of a run by steps.
pub(super) struct StepRecorder {
    pub(super) log: Log,
    pub(super) audit: Audit,
    pub(super) joints: JointObserver,
    pub(super) events: Vec<Event>,
    /// Contacts with an impulse in the last step.
    pub(super) pushing: Vec<usize>,
    model: PlantModel,
    ground: Ground,
    laws: Vec<StepLaw>,
    /// Nothing but contacts and gravity acts from outside.
    free: bool,
    start_energy: f64,
    work_in: f64,
    lost: f64,
    contact_work: f64,
    /// The same without regard to sign.
    contact_exchange: f64,
    interval: Interval,
}

/// What happened since the last row.
#[derive(Clone, Debug, Default)]
struct Interval {
    start_s: f64,
    /// At its start.
    momentum: [f64; 6],
    center: [f64; 3],
    /// On each contact point, world frame [N s].
    impulses: Vec<[f64; 3]>,
    /// Places of the contacts, each weighted by its normal impulses [m N s].
    places: Vec<[f64; 3]>,
    /// Moment of the impulses about the ground's point [N m s].
    moment: [f64; 3],
    /// Sum of normal impulse times distance from the ground.
    complementarity: f64,
    steps: usize,
}

/// One step that was made.
pub(super) struct Made<'a> {
    pub(super) t_s: f64,
    pub(super) report: StepReport,
    /// Coordinates after it, rates before and after it.
    pub(super) q: &'a [f64],
    pub(super) before: &'a [f64],
    pub(super) after: &'a [f64],
    /// Work of drives, and what their friction took \[J\].
    pub(super) work: [f64; 2],
}

impl StepRecorder {
    pub(super) fn new(
        system: &mut ControlledPlant<'_>,
        control: &Control,
        laws: Vec<StepLaw>,
        t_s: f64,
        q: &[f64],
        qd: &[f64],
    ) -> Self {
        let model = system.plant().model().clone();
        let columns = columns(&model, control, system.elastic());
        let start_energy = system.energy(q, qd);
        let mut recorder = Self {
            log: Log { columns, ..Log::default() },
            audit: Audit::new(&model),
            joints: JointObserver::new(&model, control),
            events: Vec::new(),
            pushing: Vec::new(),
            ground: Ground::new(&model),
            laws,
            free: model.joints.first().is_some_and(|joint| !joint.drivable),
            model,
            start_energy,
            work_in: 0.0,
            lost: 0.0,
            contact_work: 0.0,
            contact_exchange: 0.0,
            interval: Interval::default(),
        };
        recorder.open_interval(system, t_s, q, qd);
        recorder.joints.see(control, t_s, t_s, [q, qd]);
        recorder
    }

    fn open_interval(&mut self, system: &mut ControlledPlant<'_>, t_s: f64, q: &[f64], qd: &[f64]) {
        let parts = split(self.model.joints.len(), q, qd);
        let plant = system.plant();
        let mut lists =
            [&mut self.interval.impulses, &mut self.interval.places].map(std::mem::take);
        for list in &mut lists {
            list.clear();
            list.resize(self.model.contacts.len(), [0.0; 3]);
        }
        let [impulses, places] = lists;
        self.interval = Interval {
            start_s: t_s,
            momentum: plant.momentum(parts.q, parts.qd),
            center: plant.center_of_mass(parts.q),
            impulses,
            places,
            ..Interval::default()
        };
    }

    /// Whether steps were made since the last row.
    pub(super) fn has_steps(&self) -> bool {
        self.interval.steps > 0
    }

    /// Takes a step into account.
    pub(super) fn note_step(
        &mut self,
        system: &ControlledPlant<'_>,
        stepper: &TimeStepper,
        made: &Made<'_>,
    ) {
        let (rows, step_s) = (self.ground.rows(), stepper.stepping().step_s);
        let [put_in, lost] = made.work;
        self.work_in += put_in;
        self.lost += lost;
        let contact_work = made.report.contact_work_j;
        self.contact_work += contact_work;
        self.contact_exchange += contact_work.abs();
        let audit = &mut self.audit;
        audit.impact_gain_j = worst(audit.impact_gain_j, contact_work);
        audit.penetration_m = worst(audit.penetration_m, made.report.penetration_m);
        audit.separation_m_s = worst(audit.separation_m_s, made.report.law_error_m_s);
        let angle = made.report.friction_angle_rad;
        audit.friction_angle_rad = worst(audit.friction_angle_rad, angle);
        for torque in &system.step.torque {
            audit.torque = worst(audit.torque, torque.abs());
        }
        self.interval.steps += 1;
        let origin = self.model.ground.point;
        for &contact in stepper.closed() {
            let impulse = &stepper.impulses()[contact * rows..(contact + 1) * rows];
            let normal = impulse[rows - 1];
            let tangential = impulse[..rows - 1].iter().map(|p| p * p).sum::<f64>().sqrt();
            let excess = (tangential - self.laws[contact].friction * normal) / step_s;
            self.audit.cone_n = worst(self.audit.cone_n, excess);
            self.audit.adhesion_n = worst(self.audit.adhesion_n, -normal / step_s);
            let interval = &mut self.interval;
            interval.complementarity += normal * stepper.gaps()[contact].abs();
            let world = self.ground.in_world(impulse);
            let at = &system.positions()[3 * contact..3 * contact + 3];
            let arm = std::array::from_fn(|axis| at[axis] - origin[axis]);
            add(&mut interval.impulses[contact], world);
            add(&mut interval.moment, cross(arm, world));
            add(&mut interval.places[contact], std::array::from_fn(|axis| normal * at[axis]));
        }
        self.note_event(system, stepper, made);
    }

    /// Takes the end of a step, and the commands that it was made with, into account.
    pub(super) fn see_joints(
        &mut self,
        control: &Control,
        t_s: f64,
        command: &[f64],
        q: &[f64],
        qd: &[f64],
    ) {
        self.joints.command(command);
        self.joints.commanded_until(t_s);
        self.joints.see(control, t_s, t_s, [q, qd]);
    }

    /// An event is a step in which contacts begin or cease to push.
    fn note_event(&mut self, system: &ControlledPlant<'_>, stepper: &TimeStepper, made: &Made<'_>) {
        let rows = self.ground.rows();
        let impulse = |contact: usize| &stepper.impulses()[contact * rows..(contact + 1) * rows];
        let pushes = |contact: &&usize| impulse(**contact)[rows - 1] > 0.0;
        let now = stepper.closed().iter().filter(pushes);
        if now.clone().eq(&self.pushing) {
            return;
        }
        let now: Vec<usize> = now.copied().collect();
        let new = now.iter().filter(|contact| !self.pushing.contains(contact));
        let impulses: Vec<(usize, [f64; 3])> =
            new.map(|&contact| (contact, self.ground.in_world(impulse(contact)))).collect();
        let kind = match impulses.first() {
            Some((contact, _)) => EventKind::Touch(*contact),
            None => EventKind::Limit,
        };
        let n = system.step.command.len();
        self.events.push(Event {
            t_s: made.t_s,
            kind,
            closed: now.clone(),
            impulses,
            energy_j: made.report.contact_work_j,
            q: made.q[..n].to_vec(),
            before: made.before[..n].to_vec(),
            after: made.after[..n].to_vec(),
            fell_back: made.report.fell_back,
        });
        self.pushing = now;
    }

    /// Ends the interval at this state: audits it, and writes a row.
    pub(super) fn write_row(
        &mut self,
        system: &mut ControlledPlant<'_>,
        stepper: &TimeStepper,
        control: &Control,
        t_s: f64,
        [q, qd]: [&[f64]; 2],
    ) {
        let parts = split(self.model.joints.len(), q, qd);
        let energy = system.energy(q, qd);
        let expected = self.start_energy + self.work_in - self.lost + self.contact_work;
        let audit = &mut self.audit;
        audit.energy_j = worst(audit.energy_j, (energy - expected).abs());
        let exchanged = self.work_in.abs() + self.lost.abs() + self.contact_exchange;
        audit.exchanged_j = audit.exchanged_j.max(exchanged);
        let motion = system.plant().kinetic_energy(parts.q, parts.qd);
        audit.motion_j = audit.motion_j.max(motion);
        let length_s = t_s - self.interval.start_s;
        let zmp = self.audit_interval(system, length_s, q, qd);
        let values = &mut self.log.values;
        values.push(t_s);
        values.extend(parts.q);
        values.extend(parts.qd);
        for joint in 0..parts.q.len() {
            values.extend(control.setpoint(joint, t_s).map(|setpoint| setpoint.position));
        }
        values.extend(system.required_torque());
        values.extend(&system.step.command);
        values.extend(parts.motor);
        let undefined = self.interval.steps == 0;
        for impulse in &self.interval.impulses {
            values.extend(impulse.map(|p| if undefined { f64::NAN } else { p / length_s }));
        }
        if !self.model.contacts.is_empty() {
            values.push(modes(&self.laws, &self.pushing, stepper, self.ground.rows()));
        }
        if self.free {
            values.extend(zmp.into_iter().flatten());
        }
        values.extend([energy, energy - expected]);
        self.open_interval(system, t_s, q, qd);
    }

    /// Compares impulses with momentum; the zero moment point of both, in the mean of the interval.
    fn audit_interval(
        &mut self,
        system: &mut ControlledPlant<'_>,
        length_s: f64,
        q: &[f64],
        qd: &[f64],
    ) -> [[f64; 3]; 2] {
        let interval = &self.interval;
        let undefined = [[f64::NAN; 3]; 2];
        if interval.steps == 0 {
            return undefined;
        }
        let held = interval.complementarity / length_s;
        self.audit.complementarity_nm = worst(self.audit.complementarity_nm, held);
        self.audit_friction(length_s);
        if !self.free {
            return undefined;
        }
        let (mass, gravity) = (self.model.mass_kg, self.model.gravity);
        let parts = split(self.model.joints.len(), q, qd);
        let after = system.plant().momentum(parts.q, parts.qd);
        let center = system.plant().center_of_mass(parts.q);
        let (mut impulse, mut missing) = ([0.0; 3], [0.0; 3]);
        for p in &self.interval.impulses {
            add(&mut impulse, *p);
        }
        for axis in 0..3 {
            let change = after[axis] - self.interval.momentum[axis];
            missing[axis] = change - mass * gravity[axis] * length_s;
        }
        let error = (0..3).map(|axis| (impulse[axis] - missing[axis]).powi(2)).sum::<f64>().sqrt();
        self.audit.momentum_ns = worst(self.audit.momentum_ns, error);
        self.audit.force_n = worst(self.audit.force_n, error / length_s);
        let normal = self.ground.normal();
        let weight = mass * dot(gravity, &gravity).sqrt();
        if dot(normal, &impulse) < LOADED * weight * length_s {
            return undefined;
        }
        let moment = self.moment_of_momentum(&after, center, length_s);
        let origin = self.model.ground.point;
        let zmp = point_of_moment(origin, normal, impulse, self.interval.moment);
        let of_momentum = point_of_moment(origin, normal, missing, moment);
        let apart = (0..3).map(|axis| (zmp[axis] - of_momentum[axis]).powi(2)).sum::<f64>().sqrt();
        // what it says of the motion is a moment: as much as the weight has on its arm
        let share = (dot(normal, &impulse) / (weight * length_s)).min(1.0);
        self.audit.zmp_m = worst(self.audit.zmp_m, share * apart);
        // in the mean of the interval, a contact is where its impulses are
        let corners: Vec<[f64; 3]> = self
            .interval
            .impulses
            .iter()
            .zip(&self.interval.places)
            .filter(|(p, _)| dot(normal, *p) > 0.0)
            .map(|(p, place)| place.map(|entry| entry / dot(normal, p)))
            .collect();
        let corners = corners.iter().map(|corner| &corner[..]);
        let margin = SupportPolygon::of(&self.model, corners).margin(zmp);
        self.audit.zmp_margin_m = self.audit.zmp_margin_m.min(margin);
        [zmp, of_momentum]
    }

    /// Moment about the ground's point that the change of momentum asks for, of gravity relieved.
    fn moment_of_momentum(&self, after: &[f64; 6], center: [f64; 3], length_s: f64) -> [f64; 3] {
        let (mass, gravity) = (self.model.mass_kg, self.model.gravity);
        let (before, start) = (&self.interval.momentum, self.interval.center);
        let origin = self.model.ground.point;
        let arm = |center: [f64; 3]| std::array::from_fn(|axis| center[axis] - origin[axis]);
        let linear = |momentum: &[f64; 6]| [momentum[0], momentum[1], momentum[2]];
        let mut moment = cross(arm(center), linear(after));
        let old = cross(arm(start), linear(before));
        // the mean place of the weight, with the speed of both ends
        let mean: [f64; 3] = std::array::from_fn(|axis| {
            let turn = (before[axis] - after[axis]) / mass * length_s / 12.0;
            0.5 * (start[axis] + center[axis]) + turn - origin[axis]
        });
        let weight = cross(mean, gravity.map(|g| mass * g * length_s));
        for axis in 0..3 {
            moment[axis] += after[3 + axis] - before[3 + axis] - old[axis] - weight[axis];
        }
        moment
    }

    /// Tangential over normal impulses of the contacts of each link, and of all.
    fn audit_friction(&mut self, length_s: f64) {
        let model = &self.model;
        let weight = model.mass_kg * dot(model.gravity, &model.gravity).sqrt();
        for link in (0..model.links.len()).map(Some).chain([None]) {
            let mut sum = [0.0; 3];
            for (contact, impulse) in self.interval.impulses.iter().enumerate() {
                if link.is_none_or(|link| model.contacts[contact].link == link) {
                    add(&mut sum, *impulse);
                }
            }
            let normal = dot(self.ground.normal(), &sum);
            if normal > LOADED * weight * length_s && normal > 0.0 {
                let tangential = (dot(sum, &sum) - normal * normal).max(0.0).sqrt();
                let demand = match link {
                    Some(_) => &mut self.audit.friction_demand,
                    None => &mut self.audit.friction_total,
                };
                *demand = demand.max(tangential / normal);
            }
        }
    }
}

/// With less than this part of the weight on the ground ratios of forces mean nothing.
const LOADED: f64 = 0.05;

/// One decimal digit a contact: 0 open, 1 sticks, 2 slips.
fn modes(laws: &[StepLaw], pushing: &[usize], stepper: &TimeStepper, rows: usize) -> f64 {
    let mut modes = 0.0;
    for &contact in pushing {
        let impulse = &stepper.impulses()[contact * rows..(contact + 1) * rows];
        let tangential = impulse[..rows - 1].iter().map(|p| p * p).sum::<f64>().sqrt();
        let slips = tangential >= laws[contact].friction * impulse[rows - 1] * (1.0 - 1e-9);
        modes += if slips { 2.0 } else { 1.0 } * 10.0_f64.powi(contact as i32);
    }
    modes
}

fn add(sum: &mut [f64; 3], term: [f64; 3]) {
    sum.iter_mut().zip(term).for_each(|(entry, term)| *entry += term);
}
