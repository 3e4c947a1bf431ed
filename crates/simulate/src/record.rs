//! Writes a run down: rows of the log, and the worst of every audit.

use super::audit::{Audit, balance, friction_angle, worst};
use super::breakdown::Breakdown;
use super::contact::{Friction, Mode};
use super::control::Control;
use super::joint_record::JointObserver;
use super::log::Log;
use super::motion::Motion;
use super::push::{LinkWrench, forced_links};
use super::simulation::Simulation;
use super::support::SupportPolygon;
use denavit_plants::PlantModel;

/// Log and audit of a run.
#[derive(Clone, Debug)]
pub(super) struct Recorder {
    pub(super) log: Log,
    pub(super) audit: Audit,
    pub(super) joints: JointObserver,
    /// Contacts that pass through the ground by a rule, until they rise again.
    pub(super) passing: Vec<bool>,
    /// The links whose rows have what forces push them with.
    pushed: Vec<usize>,
    /// Whether rows have accelerations.
    accelerations: bool,
    /// Nothing but contacts and gravity acts from outside.
    free: bool,
    start_energy: f64,
    /// Energy that events have changed so far.
    pub(super) impact_energy: f64,
    lost_in_impacts: f64,
}

impl Recorder {
    pub(super) fn new(motion: &mut Motion<'_>, simulation: &Simulation, y: &[f64]) -> Self {
        let start_energy = motion.energy(y);
        let model = motion.plant.model();
        let mut columns = columns(model, &motion.control, &motion.drives.elastic);
        let pushed = forced_links(&simulation.pushes);
        for link in &pushed {
            let of_link = |part| format!("w_{}_{part}", model.links[*link]);
            columns.extend(["fx", "fy", "fz", "mx", "my", "mz"].map(of_link));
        }
        if simulation.logs_accelerations {
            columns.extend(model.joints.iter().map(|joint| format!("qdd_{}", joint.name)));
        }
        Self {
            log: Log { columns, ..Log::default() },
            pushed,
            accelerations: simulation.logs_accelerations,
            audit: Audit::new(model),
            joints: JointObserver::new(model, &motion.control),
            passing: vec![false; model.contacts.len()],
            free: model.joints.first().is_some_and(|joint| !joint.drivable),
            start_energy,
            impact_energy: 0.0,
            lost_in_impacts: 0.0,
        }
    }

    /// An event changed the energy by this much \[J\].
    pub(super) fn add_impact(&mut self, energy_j: f64) {
        self.impact_energy += energy_j;
        self.lost_in_impacts += energy_j.abs();
        self.audit.impact_gain_j = self.audit.impact_gain_j.max(energy_j);
    }

    /// A push changed the energy by this much \[J\].
    pub(super) fn add_push(&mut self, energy_j: f64) {
        self.impact_energy += energy_j;
        self.lost_in_impacts += energy_j.abs();
    }

    /// Writes the row of the end. Where a run stops because nothing goes on from there, the row has
    /// no forces.
    pub(super) fn note_end(&mut self, motion: &mut Motion<'_>, t_s: f64, y: &[f64]) {
        if self.note(motion, t_s, y, true).is_ok() {
            return;
        }
        self.see(motion, t_s, y);
        motion.place(y);
        let rows = motion.ground.rows() * motion.closed.len();
        motion.work.force.clear();
        motion.work.force.resize(rows, f64::NAN);
        motion.work.acceleration.fill(f64::NAN);
        let energy = motion.energy(y);
        let undefined = self.free.then_some([[f64::NAN; 3]; 2]);
        self.write(motion, t_s, y, undefined, [energy, energy - self.expected_energy(motion, y)]);
    }

    /// The energy that the books say.
    fn expected_energy(&self, motion: &Motion<'_>, y: &[f64]) -> f64 {
        let parts = motion.layout.parts(y);
        self.start_energy + parts.work_in - parts.lost + self.impact_energy
    }

    /// Evaluates the motion at a state, audits it, and writes a row if wanted.
    pub(super) fn note(
        &mut self,
        motion: &mut Motion<'_>,
        t_s: f64,
        y: &[f64],
        writes: bool,
    ) -> Result<(), Breakdown> {
        motion.constrained_motion(t_s, y)?;
        self.see(motion, t_s, y);
        self.joints.command(&motion.work.command);
        if motion.closed.is_empty() {
            motion.place(y);
        }
        let energy = motion.energy(y);
        let parts = motion.layout.parts(y);
        let energy_error = energy - self.expected_energy(motion, y);
        let audit = &mut self.audit;
        audit.energy_j = worst(audit.energy_j, energy_error.abs());
        let exchanged = parts.work_in.abs() + parts.lost.abs() + self.lost_in_impacts;
        audit.exchanged_j = audit.exchanged_j.max(exchanged);
        audit.motion_j = audit.motion_j.max(motion.plant.kinetic_energy(parts.q, parts.qd));
        for torque in &motion.work.drive.torque {
            audit.torque = worst(audit.torque, torque.abs());
        }
        self.audit_contacts(motion);
        // a balance has a meaning where contacts are all that holds the plant
        let balance = self.free.then(|| balance(motion, t_s, y));
        if let Some(balance) = balance {
            let audit = &mut self.audit;
            audit.force_n = worst(audit.force_n, balance.force_error);
            if balance.zmp[0].is_finite() {
                let apart = |axis: usize| balance.zmp[axis] - balance.zmp_of_momentum[axis];
                let distance = (0..3).map(|axis| apart(axis).powi(2)).sum::<f64>().sqrt();
                audit.zmp_m = worst(audit.zmp_m, distance);
                let points = &motion.work.positions;
                let corners =
                    motion.closed.iter().map(|c| &points[3 * c.contact..3 * c.contact + 3]);
                let support = SupportPolygon::of(motion.plant.model(), corners);
                let margin = support.margin(balance.zmp);
                audit.zmp_margin_m = audit.zmp_margin_m.min(margin);
            }
        }
        if writes {
            let zmp = balance.map(|balance| [balance.zmp, balance.zmp_of_momentum]);
            self.write(motion, t_s, y, zmp, [energy, energy_error]);
        }
        Ok(())
    }

    fn see(&mut self, motion: &Motion<'_>, t_s: f64, y: &[f64]) {
        let parts = motion.layout.parts(y);
        self.joints.commanded_until(t_s);
        let reference_s = motion.reference_time(t_s);
        self.joints.see(&motion.control, t_s, reference_s, [parts.q, parts.qd]);
    }

    fn audit_contacts(&mut self, motion: &Motion<'_>) {
        let (rows, work, audit) = (motion.ground.rows(), &motion.work, &mut self.audit);
        let model = motion.plant.model();
        for (contact, passes) in self.passing.iter_mut().enumerate() {
            *passes = *passes && motion.gap(contact) < 0.0;
            if !*passes {
                audit.penetration_m = worst(audit.penetration_m, -motion.gap(contact));
            }
        }
        for (index, closed) in motion.closed.iter().enumerate() {
            let normal = index * rows + rows - 1;
            let force = work.force[normal];
            audit.adhesion_n = worst(audit.adhesion_n, -force);
            audit.separation_m_s = worst(audit.separation_m_s, work.velocity[normal].abs());
            let product = (force * motion.gap(closed.contact)).abs();
            audit.complementarity_nm = worst(audit.complementarity_nm, product);
            if let Friction::Coulomb(mu) = motion.friction[closed.contact] {
                let along = work.force[index * rows..normal].iter().map(|f| f * f).sum::<f64>();
                audit.cone_n = worst(audit.cone_n, along.sqrt() - mu * force);
            }
            let tangents = index * rows..normal;
            let velocity = &work.velocity[tangents.clone()];
            if closed.mode != Mode::Stick && motion.holding.slips.is_left_by(velocity) {
                let angle = friction_angle(&work.force[tangents], velocity);
                audit.friction_angle_rad = worst(audit.friction_angle_rad, angle);
            }
        }
        // of the forces on one link together: redundant ones are shared out arbitrarily
        let weight = model.mass_kg * model.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        for link in (0..model.links.len()).map(Some).chain([None]) {
            let mut sum = [0.0; 3];
            for (index, closed) in motion.closed.iter().enumerate() {
                if link.is_none_or(|link| model.contacts[closed.contact].link == link) {
                    let force = &work.force[index * rows..(index + 1) * rows];
                    sum.iter_mut().zip(force).for_each(|(sum, force)| *sum += force);
                }
            }
            let normal = sum[rows - 1];
            if normal > 0.05 * weight {
                let tangential = sum[..rows - 1].iter().map(|f| f * f).sum::<f64>().sqrt();
                let demand = match link {
                    Some(_) => &mut audit.friction_demand,
                    None => &mut audit.friction_total,
                };
                *demand = demand.max(tangential / normal);
            }
        }
    }

    fn write(
        &mut self,
        motion: &mut Motion<'_>,
        t_s: f64,
        y: &[f64],
        zmp: Option<[[f64; 3]; 2]>,
        energies: [f64; 2],
    ) {
        let (parts, rows) = (motion.layout.parts(y), motion.ground.rows());
        let values = &mut self.log.values;
        values.push(t_s);
        values.extend(parts.q);
        values.extend(parts.qd);
        let time = motion.reference_time(t_s);
        for joint in 0..parts.q.len() {
            values.extend(motion.control.setpoint(joint, time).map(|setpoint| setpoint.position));
        }
        values.extend(motion.drives.required(&motion.work.command, &motion.work.drive.torque));
        values.extend(&motion.work.command);
        values.extend(parts.motor);
        let points = motion.plant.model().contacts.len();
        let mut modes = 0.0;
        for contact in 0..points {
            let index = motion.closed.iter().position(|closed| closed.contact == contact);
            let force = index.map_or([0.0; 3], |index| {
                motion.ground.in_world(&motion.work.force[index * rows..(index + 1) * rows])
            });
            values.extend(force);
        }
        if points > 0 {
            for closed in &motion.closed {
                // one decimal digit a contact: 0 open, 1 sticks, 2 slips
                let digit = if closed.mode == Mode::Stick { 1.0 } else { 2.0 };
                modes += digit * 10.0_f64.powi(closed.contact as i32);
            }
            values.push(modes);
        }
        for point in zmp.into_iter().flatten() {
            values.extend(point);
        }
        values.extend(energies);
        for link in &self.pushed {
            let wrench = LinkWrench::of(motion.pushes, *link, motion.plant, time, parts.q);
            values.extend(wrench.force);
            values.extend(wrench.moment);
        }
        if self.accelerations {
            values.extend(&motion.work.acceleration);
        }
    }
}

/// The columns of a log; `elastic` lists the joints with a motor of their own.
pub(super) fn columns(model: &PlantModel, control: &Control, elastic: &[usize]) -> Vec<String> {
    let names = |prefix: &str| {
        model.joints.iter().map(move |joint| format!("{prefix}_{}", joint.name)).collect::<Vec<_>>()
    };
    let mut columns = vec!["t".to_owned()];
    columns.extend(names("q"));
    columns.extend(names("qd"));
    for (joint, name) in names("ref").into_iter().enumerate() {
        if control.joints[joint].reference.is_some() {
            columns.push(name);
        }
    }
    columns.extend(names("tau"));
    columns.extend(names("tau_cmd"));
    columns.extend(elastic.iter().map(|joint| format!("motor_{}", model.joints[*joint].name)));
    for contact in &model.contacts {
        columns.extend(["x", "y", "z"].map(|axis| format!("f_{}_{axis}", contact.name)));
    }
    if !model.contacts.is_empty() {
        columns.push("contact_modes".to_owned());
    }
    if model.joints.first().is_some_and(|joint| !joint.drivable) {
        for prefix in ["zmp", "zmp_momentum"] {
            columns.extend(["x", "y", "z"].map(|axis| format!("{prefix}_{axis}")));
        }
    }
    columns.extend(["energy", "energy_error"].map(str::to_owned));
    columns
}
