//! Which columns of a log are wanted for a robot, and where their values go.

use super::fault::{LogFault, Suspicion};
use super::mapping::{ColumnMapping, ColumnSource, Mapped};
use super::{LogOf, LogRemark, MeasuredLog, TORQUE_SIDE, jumps};
use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::TorqueSide;
use denavit_logs::{Column, Found, Log, Table};
use denavit_simulate::model_of_header;

/// Signals of a joint, by the beginning of their columns' names.
const SIGNALS: [&str; 7] = ["q", "qd", "qdd", "tau", "tau_cmd", "ref", "motor"];

/// A column that is read.
pub(super) struct WantedColumn {
    /// Our name.
    pub(super) name: String,
    pub(super) place: usize,
    pub(super) scale: f64,
    pub(super) offset: f64,
    pub(super) goes_to: Target,
    /// The step of its encoder, in the log's unit: what mapping and repair do hides it.
    pub(super) step: Option<f64>,
}

/// Where the values of a column go.
#[derive(Clone, Copy, Debug)]
pub(super) enum Target {
    Time,
    /// Joint, and which of [`SIGNALS`].
    Joint(usize, usize),
    /// Contact, axis.
    Contact(usize, usize),
    /// Link, of those that the log has wrenches of; force or moment about an axis.
    Link(usize, usize),
}

impl Target {
    /// Of a joint or of a motor before its spring.
    pub(super) fn is_position(self) -> bool {
        matches!(self, Self::Joint(_, 0 | 6))
    }
}

pub(super) struct Wanted {
    pub(super) columns: Vec<WantedColumn>,
    /// The links that the log has wrenches of.
    links: Vec<String>,
    /// Where its torques are measured, if the log says it.
    torque_side: Option<TorqueSide>,
}

impl Wanted {
    /// What the numbers of a column were multiplied by, and the entry of a mapping that keeps its
    /// name in the log, if that is another.
    pub(super) fn mapped(&self, name: &str, logged: &[String]) -> (f64, String) {
        let own = self.columns.iter().find(|column| column.name == name);
        own.map_or((1.0, String::new()), |own| match &logged[own.place] {
            logged if logged == name => (own.scale, String::new()),
            logged => (own.scale, format!("\"column\": {logged:?}, ")),
        })
    }
}

/// A column as the project calls it.
struct Ours {
    name: String,
    /// The same for whatever joint or contact, as `q_{joint}`.
    pattern: String,
    /// The joint or contact.
    subject: String,
    goes_to: Target,
    is_needed: bool,
}

impl Ours {
    /// All columns of a robot, the time first. `links` are those with wrenches.
    fn all(robot: LogOf<'_>, links: &[String]) -> Vec<Self> {
        let time = "t".to_owned();
        let mut all = vec![Self {
            name: time.clone(),
            pattern: time,
            subject: String::new(),
            goes_to: Target::Time,
            is_needed: true,
        }];
        let column = |[of, kind, part]: [&str; 3], subject: &str, goes_to: Target| Self {
            name: format!("{of}_{subject}{part}"),
            pattern: format!("{of}_{{{kind}}}{part}"),
            subject: subject.to_owned(),
            is_needed: matches!(goes_to, Target::Joint(_, 0)),
            goes_to,
        };
        for (joint, described) in robot.joints.iter().enumerate() {
            let signals = SIGNALS.len() - usize::from(!described.is_elastic);
            for (signal, prefix) in SIGNALS[..signals].iter().enumerate() {
                let to = Target::Joint(joint, signal);
                all.push(column([*prefix, "joint", ""], &described.name, to));
            }
        }
        for (contact, name) in robot.contacts.iter().enumerate() {
            for (axis, part) in ["_x", "_y", "_z"].into_iter().enumerate() {
                all.push(column(["f", "contact", part], name, Target::Contact(contact, axis)));
            }
        }
        for (link, name) in links.iter().enumerate() {
            for (part, letters) in WRENCH.into_iter().enumerate() {
                let part_of = format!("_{letters}");
                all.push(column(["w", "link", part_of.as_str()], name, Target::Link(link, part)));
            }
        }
        all
    }

    fn mapped(&self, mapping: &ColumnMapping) -> Mapped {
        mapping.source_of(&self.name, &self.pattern, &self.subject)
    }
}

/// The parts of a wrench, as columns have them.
const WRENCH: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// The links that a log, or a mapping, has wrenches of.
fn links(log: &Log<'_>, mapping: &ColumnMapping) -> Vec<String> {
    let names = log.columns.iter().map(|column| match &column.known {
        Some(known) => known.name.as_str(),
        None => column.name.as_str(),
    });
    let mut links: Vec<String> = Vec::new();
    for name in names.chain(mapping.names()) {
        let parts = name.strip_prefix("w_").and_then(|rest| rest.rsplit_once('_'));
        let Some((link, _)) = parts.filter(|(_, part)| WRENCH.contains(part)) else { continue };
        if !link.contains('{') && links.iter().all(|known| known != link) {
            links.push(link.to_owned());
        }
    }
    links
}

/// Entries of a mapping that name no column of the robot.
fn unknown_names(all: &[Ours], mapping: &ColumnMapping) -> Vec<LogFault> {
    let known = || all.iter().flat_map(|ours| [ours.name.as_str(), ours.pattern.as_str()]);
    let unknown = mapping.names().filter(|name| known().all(|known| known != *name));
    let fault = |name: &str| LogFault::UnknownName {
        name: name.to_owned(),
        nearest: nearest(name, known()).map(str::to_owned),
    };
    unknown.map(fault).collect()
}

/// The column that is meant where none is found: by its name, or by what the project calls it. One
/// that is another of ours is not.
fn meant(log: &Log<'_>, all: &[Ours], name: &str) -> Option<String> {
    let names = log.columns.iter().flat_map(|column| {
        let known = column.known.as_ref().map(|known| known.name.as_str());
        known.into_iter().chain([column.name.as_str()])
    });
    let is_other = |name: &&str| all.iter().any(|ours| ours.name == *name);
    let near = nearest(name, names.filter(|name| !is_other(name)))?;
    let is_it = |column: &&Column| {
        column.name == near || column.known.as_ref().is_some_and(|known| known.name == near)
    };
    log.columns.iter().find(is_it).map(|column| column.name.clone())
}

impl Wanted {
    pub(super) fn new(
        log: &Log<'_>,
        robot: LogOf<'_>,
        mapping: &ColumnMapping,
    ) -> Result<Self, Vec<LogFault>> {
        let links = links(log, mapping);
        let all = Ours::all(robot, &links);
        let mut faults = unknown_names(&all, mapping);
        let mut columns = Vec::new();
        // where patterns lead, and whether there is anything
        let mut patterns: Vec<(&str, String, bool)> = Vec::new();
        for ours in &all {
            let (name, is_needed) = (ours.name.clone(), ours.is_needed);
            let (source, is_mapped) = match ours.mapped(mapping) {
                Mapped::LeftOut if is_needed => {
                    faults.push(LogFault::MissingColumn { column: name, nearest: None });
                    continue;
                }
                Mapped::LeftOut => continue,
                Mapped::ByPattern(source) => {
                    if patterns.iter().all(|(pattern, ..)| *pattern != ours.pattern) {
                        patterns.push((&ours.pattern, source.column.clone(), false));
                    }
                    (source, false)
                }
                Mapped::ByName(source) => (source, true),
                Mapped::Not => (ColumnSource::of(&name), false),
            };
            match log.find(&source.column) {
                Found::At(place) => {
                    let own = patterns.iter_mut().find(|(pattern, ..)| *pattern == ours.pattern);
                    if let Some((.., is_there)) = own {
                        *is_there = true;
                    }
                    let (scale, offset, goes_to) = (source.scale, source.offset, ours.goes_to);
                    let step = None;
                    columns.push(WantedColumn { name, place, scale, offset, goes_to, step });
                }
                Found::Several(several) => {
                    let several: Vec<String> =
                        several.iter().map(|one| format!("`{one}`")).collect();
                    faults.push(LogFault::other(format!(
                        "`{name}` may be {}\n  hint: `logs.columns` says which it is",
                        several.join(" or ")
                    )));
                }
                Found::Nowhere if is_needed || is_mapped => {
                    let nearest = meant(log, &all, &source.column);
                    faults.push(LogFault::MissingColumn { column: source.column, nearest });
                }
                Found::Nowhere => {}
            }
        }
        for (pattern, column, is_there) in patterns {
            let is_needed = all.iter().any(|ours| ours.pattern == pattern && ours.is_needed);
            if !is_there && !is_needed {
                let nearest = meant(log, &all, &column);
                faults.push(LogFault::MissingColumn { column, nearest });
            }
        }
        faults.extend(shared(log, &columns));
        faults.extend(missing_torques(log, robot, &columns, mapping));
        faults.extend(missing_forces(robot, &all, &columns, mapping));
        faults.extend(other_robot(log, robot, &columns));
        let torque_side = torque_side(log).unwrap_or_else(|fault| {
            faults.push(fault);
            None
        });
        if faults.is_empty() { Ok(Self { columns, links, torque_side }) } else { Err(faults) }
    }

    /// The places of the columns in the log.
    pub(super) fn places(&self) -> Vec<usize> {
        self.columns.iter().map(|column| column.place).collect()
    }

    /// The places of those that rows may be of: positions of joints.
    pub(super) fn clocks(&self) -> Vec<usize> {
        let is_position = |column: &&WantedColumn| matches!(column.goes_to, Target::Joint(_, 0));
        self.columns.iter().filter(is_position).map(|column| column.place).collect()
    }

    /// Positions of joints and motors that jump.
    pub(super) fn jumps(&self, table: &Table) -> Vec<Suspicion> {
        let columns = self.columns.iter().enumerate();
        let columns = columns.filter(|(_, column)| column.goes_to.is_position());
        columns.filter_map(|(place, column)| jumps::jump(table, place, &column.name)).collect()
    }

    pub(super) fn hand_out(&self, log: &mut MeasuredLog, values: Vec<Vec<f64>>, robot: LogOf<'_>) {
        let mut forces: Vec<[Vec<f64>; 3]> = vec![Default::default(); robot.contacts.len()];
        let mut wrenches: Vec<[Vec<f64>; 6]> = vec![Default::default(); self.links.len()];
        let mut commanded = vec![None; robot.joints.len()];
        let mut geared = Vec::new();
        let targets = self.columns.iter().filter(|c| !matches!(c.goes_to, Target::Time));
        for (column, mut values) in targets.zip(values) {
            match column.goes_to {
                Target::Time => {}
                Target::Contact(contact, axis) => forces[contact][axis] = values,
                Target::Link(link, part) => wrenches[link][part] = values,
                Target::Joint(joint, signal) => {
                    let described = &robot.joints[joint];
                    let side = self.torque_side.unwrap_or(described.torque_side);
                    let factor = described.gear_ratio;
                    let is_geared = side == TorqueSide::Motor && factor != 1.0;
                    if described.is_elastic {
                        // A spring's torque is one of the joint, a motor's is kept as its own.
                        if signal == 4 && side == TorqueSide::Joint {
                            values.iter_mut().for_each(|value| *value /= factor);
                        }
                    } else if matches!(signal, 3 | 4) && is_geared {
                        values.iter_mut().for_each(|value| *value *= factor);
                        if !geared.contains(&described.name) {
                            geared.push(described.name.clone());
                        }
                    }
                    let own = &mut log.joints[joint];
                    let step = column.step.map(|step| step * column.scale.abs());
                    match signal {
                        0 => (own.step, own.q) = (step, values),
                        1 => own.qd = Some(values),
                        2 => own.qdd = Some(values),
                        3 => own.tau = Some(values),
                        4 => commanded[joint] = Some(values),
                        5 => own.reference = Some(values),
                        _ => (own.motor_step, own.motor) = (step, Some(values)),
                    }
                }
            }
        }
        for ((own, command), joint) in log.joints.iter_mut().zip(commanded).zip(robot.joints) {
            if joint.is_elastic {
                own.motor_torque = command;
            } else if own.tau.is_none() && command.is_some() {
                own.tau = command;
                let name = &joint.name;
                let text = format!("`{name}`: the commanded torque stands for the measured one");
                log.remarks.push(LogRemark::Other(text));
            }
        }
        if !geared.is_empty() {
            log.remarks.push(LogRemark::MotorTorques { joints: geared });
        }
        let named = self.links.iter().cloned().zip(wrenches);
        log.wrenches =
            named.filter(|(_, parts)| parts.iter().any(|part| !part.is_empty())).collect();
        let named = robot.contacts.iter().cloned().zip(forces);
        log.contacts = named.filter(|(_, axes)| axes.iter().any(|axis| !axis.is_empty())).collect();
    }
}

/// Columns of the log that more than one of ours are taken from.
fn shared(log: &Log<'_>, columns: &[WantedColumn]) -> Vec<LogFault> {
    let mut faults = Vec::new();
    for (place, column) in log.columns.iter().enumerate() {
        let users = columns.iter().filter(|one| one.place == place);
        let ours: Vec<String> = users.map(|one| one.name.clone()).collect();
        if ours.len() > 1 {
            faults.push(LogFault::SharedColumn { column: column.name.clone(), ours });
        }
    }
    faults
}

/// Joints without a torque where others have one, if nobody said so: a name with a mistake in it
/// would silently take the joint's equation away. Joints of a floating base have no motor, nor have
/// those without a drive in a model with drives. A log without any torque is another matter: the
/// wrench on a base shows parameters too.
fn missing_torques(
    log: &Log<'_>,
    robot: LogOf<'_>,
    columns: &[WantedColumn],
    mapping: &ColumnMapping,
) -> Vec<LogFault> {
    let has_torque = |joint: usize| {
        columns.iter().any(|one| matches!(one.goes_to, Target::Joint(of, 3 | 4) if of == joint))
    };
    let has_drives = robot.joints.iter().any(|joint| joint.is_driven);
    let all = robot.joints.iter().enumerate();
    let motors: Vec<usize> = all
        .filter(|(_, joint)| !joint.is_base && (joint.is_driven || !has_drives))
        .map(|(joint, _)| joint)
        .collect();
    if !motors.iter().any(|&joint| has_torque(joint)) {
        return Vec::new();
    }
    let is_free = |place: &usize| columns.iter().all(|one| one.place != *place);
    let mut faults = Vec::new();
    for &joint in motors.iter().filter(|&&joint| !has_torque(joint)) {
        let name = &robot.joints[joint].name;
        let column = format!("tau_{name}");
        let mapped = mapping.source_of(&column, "tau_{joint}", name);
        if matches!(mapped, Mapped::LeftOut | Mapped::ByName(_)) {
            continue; // left out on purpose, or a fault already
        }
        let free = (0..log.columns.len()).filter(is_free);
        let free = free.map(|place| log.columns[place].name.as_str());
        let nearest = nearest(&column, free).map(str::to_owned);
        faults.push(LogFault::MissingTorque { column, nearest });
    }
    faults
}

/// Forces on a floating base that the log does not have: without them its weight rests on nothing.
fn missing_forces(
    robot: LogOf<'_>,
    all: &[Ours],
    columns: &[WantedColumn],
    mapping: &ColumnMapping,
) -> Option<LogFault> {
    if !robot.joints.iter().any(|joint| joint.is_base) {
        return None;
    }
    let is_there = |ours: &&Ours| columns.iter().any(|column| column.name == ours.name);
    let forces = || all.iter().filter(|ours| matches!(ours.goes_to, Target::Contact(..)));
    // Null in the mapping leaves a column out on purpose, but not all of them.
    let carries = forces().any(|ours| is_there(&ours));
    let is_left_out = |ours: &&Ours| carries && ours.mapped(mapping) == Mapped::LeftOut;
    let missing = forces().filter(|ours| !is_there(ours) && !is_left_out(ours));
    let columns: Vec<String> = missing.map(|ours| ours.name.clone()).collect();
    (!columns.is_empty()).then_some(LogFault::MissingForces { columns })
}

/// Where the log says that its torques were measured.
fn torque_side(log: &Log<'_>) -> Result<Option<TorqueSide>, LogFault> {
    let said = log.header.iter().find(|(name, _)| name == TORQUE_SIDE);
    match said.map(|(_, value)| value.as_str()) {
        None => Ok(None),
        Some("joint") => Ok(Some(TorqueSide::Joint)),
        Some("motor") => Ok(Some(TorqueSide::Motor)),
        Some(found) => Err(LogFault::other(format!(
            "`# torque_side: {found}`: there are `joint` and `motor`\n  hint: write where the \
             torques were measured"
        ))),
    }
}

/// Whether the log says that it is of another robot, or has joints that this one lacks. Messages
/// are of whatever moves: other joints mean something only where those of the robot are missing.
fn other_robot(log: &Log<'_>, robot: LogOf<'_>, columns: &[WantedColumn]) -> Vec<LogFault> {
    let mut faults = Vec::new();
    if let Some(log) = model_of_header(&log.header).filter(|log| *log != robot.model) {
        let (log, model) = (log.to_owned(), robot.model.to_owned());
        faults.push(LogFault::OtherModel { log, model });
    }
    let is_ours = |name: &str| robot.joints.iter().any(|joint| joint.name == name);
    let has_position = |joint: usize| {
        columns.iter().any(|one| matches!(one.goes_to, Target::Joint(of, 0) if of == joint))
    };
    let has_all = (0..robot.joints.len()).all(has_position);
    let mut others: Vec<String> = Vec::new();
    let mut are_messages = false;
    for (place, column) in log.columns.iter().enumerate() {
        let name = column.known.as_ref().map_or(&column.name, |known| &known.name);
        let is_used = columns.iter().any(|one| one.place == place);
        let is_passed_over = is_used || column.known.is_some() && has_all;
        let joint = name.strip_prefix("q_").filter(|joint| !is_passed_over && !is_ours(joint));
        if let Some(joint) = joint.filter(|joint| others.iter().all(|known| known != joint)) {
            others.push(joint.to_owned());
            are_messages |= column.known.is_some();
        }
    }
    if !others.is_empty() && (are_messages || others.len() * 2 > robot.joints.len()) {
        faults.push(LogFault::other(format!(
            "has joints that the model does not have: {}\n  hint: is it a log of this robot?",
            others.join(", ")
        )));
    }
    faults
}
