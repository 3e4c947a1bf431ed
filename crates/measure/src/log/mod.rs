//! Logs of measurements: read, mapped to our columns, checked, brought to equal distances.
//!
//! - [`ColumnMapping`]: which column of a foreign log is which of ours
//! - [`read_log`]: a CSV log of a robot; all that is wrong with it at once
//! - [`MeasuredLog`]: what was measured, joint by joint
//!
//! A log is streamed: only the columns that are used are held, 8 bytes a sample each.

mod check;
mod fault;
mod jumps;
mod mapping;
mod reader;
mod repair;

pub use fault::{LogFault, LogFaults, LogRemark, Suspicion};
pub use mapping::{ColumnMapping, ColumnSource, MappingError};

use denavit_codegen::expr::text::nearest;
use denavit_codegen::model::TorqueSide;
use denavit_plants::regression::RegressionJoint;
use denavit_simulate::model_of_header;
use reader::{Head, Lines, Table, read_head, read_rows};
use std::io::BufRead;

/// What was measured of a joint, one entry for each sample.
///
/// Torques are those that the joint needs, positive along its axis. A log has them so; or as those
/// of the motors of stiff drives, if its header says `torque_side: motor`, or if it says nothing
/// and the model's `torque_side` is the motor's. [`read_log`] is the one place where gear ratios
/// count.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct JointSignals {
    /// Position [rad, m].
    pub q: Vec<f64>,
    /// Rate, if it was logged [rad/s, m/s].
    pub qd: Option<Vec<f64>>,
    /// Acceleration, if it was logged [rad/s^2, m/s^2].
    pub qdd: Option<Vec<f64>>,
    /// Torque [N m, N].
    pub tau: Option<Vec<f64>>,
    /// Reference position [rad, m].
    pub reference: Option<Vec<f64>>,
    /// Angle of the motor before a spring, before the gear \[rad\].
    pub motor: Option<Vec<f64>>,
    /// Torque of that motor, before the gear \[N m\].
    pub motor_torque: Option<Vec<f64>>,
    /// The step of the encoder, if the position has steps [rad, m].
    pub step: Option<f64>,
    /// The step of the motor's encoder \[rad\].
    pub motor_step: Option<f64>,
}

/// A log at equal distances of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MeasuredLog {
    /// The name of the file.
    pub file: String,
    /// What the log says of itself.
    pub header: Vec<(String, String)>,
    /// The time of the first sample \[s\].
    pub start_s: f64,
    /// The distance of samples \[s\].
    pub step_s: f64,
    /// The joints, in the order of the model.
    pub joints: Vec<JointSignals>,
    /// Forces of contacts in the world \[N\], x, y, z of each point of the model that the log has.
    pub contacts: Vec<(String, [Vec<f64>; 3])>,
    /// What was found and repaired.
    pub remarks: Vec<LogRemark>,
}

impl MeasuredLog {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.joints.first().map_or(0, |joint| joint.q.len())
    }
}

impl MeasuredLog {
    /// The first samples alone.
    pub fn head(&self, samples: usize) -> Self {
        let head = |values: &Vec<f64>| values[..values.len().min(samples)].to_vec();
        let some = |values: &Option<Vec<f64>>| values.as_ref().map(head);
        let joint = |own: &JointSignals| JointSignals {
            q: head(&own.q),
            qd: some(&own.qd),
            qdd: some(&own.qdd),
            tau: some(&own.tau),
            reference: some(&own.reference),
            motor: some(&own.motor),
            motor_torque: some(&own.motor_torque),
            step: own.step,
            motor_step: own.motor_step,
        };
        let contacts = self.contacts.iter();
        Self {
            file: self.file.clone(),
            header: self.header.clone(),
            start_s: self.start_s,
            step_s: self.step_s,
            joints: self.joints.iter().map(joint).collect(),
            contacts: contacts
                .map(|(name, axes)| (name.clone(), axes.each_ref().map(head)))
                .collect(),
            remarks: self.remarks.clone(),
        }
    }

    /// Sees to it that no joint behind a spring has the torque of its motor alone, which is not
    /// what the joint gets: a fault, or, where suspicions are accepted, a remark, and the motor's
    /// torque is taken for the joint's.
    pub fn require_joint_torques(&mut self, robot: LogOf<'_>) -> Result<(), LogFaults> {
        let mut faults = Vec::new();
        for (own, joint) in self.joints.iter_mut().zip(robot.joints) {
            let (None, Some(command)) = (&own.tau, &own.motor_torque) else { continue };
            let suspicion = Suspicion::CommandOfSpring { joint: joint.name.clone() };
            if robot.accepts_suspicious {
                let factor = joint.gear_ratio;
                own.tau = Some(command.iter().map(|torque| factor * torque).collect());
                self.remarks.push(LogRemark::Accepted(suspicion));
            } else {
                faults.push(LogFault::Suspicion(suspicion));
            }
        }
        if faults.is_empty() { Ok(()) } else { Err(LogFaults { file: self.file.clone(), faults }) }
    }
}

/// Of which robot a log is to be.
#[derive(Clone, Copy, Debug)]
pub struct LogOf<'a> {
    /// The model's name.
    pub model: &'a str,
    /// Its joints.
    pub joints: &'a [RegressionJoint],
    /// Names of its contact points.
    pub contacts: &'a [String],
    /// Whether suspicions are remarks, not faults.
    pub accepts_suspicious: bool,
}

/// The line of a header that says where torques were measured: `joint` or `motor`.
pub const TORQUE_SIDE: &str = "torque_side";

/// Signals of a joint, by the beginning of their columns' names.
const SIGNALS: [&str; 7] = ["q", "qd", "qdd", "tau", "tau_cmd", "ref", "motor"];

/// Reads a log of a robot. `file` is its name, for messages alone.
pub fn read_log(
    file: &str,
    source: impl BufRead,
    robot: LogOf<'_>,
    mapping: &ColumnMapping,
) -> Result<MeasuredLog, LogFaults> {
    let failed = |faults| LogFaults { file: file.to_owned(), faults };
    let mut lines = Lines::new(source);
    let head = read_head(&mut lines).map_err(failed)?;
    let wanted = Wanted::new(&head, robot, mapping).map_err(failed)?;
    let places: Vec<usize> = wanted.columns.iter().map(|column| column.place).collect();
    let mut table = read_rows(&mut lines, &head, &places).map_err(failed)?;
    for (values, column) in table.columns.iter_mut().zip(&wanted.columns) {
        let Column { scale, offset, .. } = *column;
        if scale != 1.0 || offset != 0.0 {
            values.iter_mut().for_each(|value| *value = scale * *value + offset);
        }
    }
    let impossible = impossible(&table, &wanted);
    if !impossible.is_empty() {
        return Err(failed(impossible));
    }
    if table.rows() == 0 {
        return Err(failed(vec![LogFault::TooShort { rows: 0 }]));
    }
    let names: Vec<String> = wanted.columns.iter().map(|column| column.name.clone()).collect();
    let jumps = wanted.jumps(&table);
    let cut = table.cut.map(|line| LogRemark::CutLine { line });
    let even = repair::even(table, &names).map_err(failed)?;
    let mut log = MeasuredLog {
        file: file.to_owned(),
        header: head.header,
        start_s: even.start_s,
        step_s: even.step_s,
        joints: vec![JointSignals::default(); robot.joints.len()],
        contacts: Vec::new(),
        remarks: cut.into_iter().chain(even.remarks).collect(),
    };
    wanted.hand_out(&mut log, even.columns, robot);
    let mut found = check::check(&log, robot.joints);
    log.remarks.append(&mut found.remarks);
    let mut faults = found.faults;
    for suspicion in jumps.into_iter().chain(found.suspicions) {
        match robot.accepts_suspicious {
            true => log.remarks.push(LogRemark::Accepted(suspicion)),
            false => faults.push(LogFault::Suspicion(suspicion)),
        }
    }
    if faults.is_empty() { Ok(log) } else { Err(failed(faults)) }
}

/// What no position, rate, torque or force of a robot reaches, in its SI unit.
const LARGEST: f64 = 1e12;

/// The same of times \[s\], which may count from any beginning, in any unit.
const LARGEST_TIME: f64 = 1e20;

/// The first number of each column that nothing of a robot can be.
fn impossible(table: &Table, wanted: &Wanted) -> Vec<LogFault> {
    let mut faults = Vec::new();
    for (values, column) in table.columns.iter().zip(&wanted.columns) {
        let largest = match column.goes_to {
            Target::Time => LARGEST_TIME,
            _ => LARGEST,
        };
        if let Some(row) = values.iter().position(|value| value.abs() > largest) {
            let (value, line) = (values[row], table.line(row));
            faults.push(LogFault::Impossible { column: column.name.clone(), value, line });
        }
    }
    faults
}

/// A column that is read.
struct Column {
    /// Our name.
    name: String,
    place: usize,
    scale: f64,
    offset: f64,
    goes_to: Target,
}

/// Where the values of a column go.
enum Target {
    Time,
    /// Joint, and which of [`SIGNALS`].
    Joint(usize, usize),
    /// Contact, axis.
    Contact(usize, usize),
}

struct Wanted {
    columns: Vec<Column>,
    /// Where its torques are measured, if the log says it.
    torque_side: Option<TorqueSide>,
}

impl Wanted {
    fn new(head: &Head, robot: LogOf<'_>, mapping: &ColumnMapping) -> Result<Self, Vec<LogFault>> {
        let mut all = vec![("t".to_owned(), Target::Time, true)];
        for (joint, described) in robot.joints.iter().enumerate() {
            let signals = SIGNALS.len() - usize::from(!described.is_elastic);
            for (signal, prefix) in SIGNALS[..signals].iter().enumerate() {
                let name = format!("{prefix}_{}", described.name);
                all.push((name, Target::Joint(joint, signal), signal == 0));
            }
        }
        for (contact, name) in robot.contacts.iter().enumerate() {
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                all.push((format!("f_{name}_{letter}"), Target::Contact(contact, axis), false));
            }
        }
        let mut faults = Vec::new();
        let known = || all.iter().map(|(name, ..)| name.as_str());
        for name in mapping.names().filter(|name| known().all(|known| known != *name)) {
            let nearest = nearest(name, known()).map(str::to_owned);
            faults.push(LogFault::UnknownName { name: name.to_owned(), nearest });
        }
        let is_mapped = |name: &str| mapping.names().any(|mapped| mapped == name);
        let mut columns = Vec::new();
        for (name, goes_to, is_needed) in all {
            let Some(source) = mapping.source(&name) else {
                if is_needed {
                    faults.push(LogFault::MissingColumn { column: name, nearest: None });
                }
                continue;
            };
            match head.columns.iter().position(|column| *column == source.column) {
                Some(place) => {
                    let (scale, offset) = (source.scale, source.offset);
                    columns.push(Column { name, place, scale, offset, goes_to });
                }
                None if is_needed || is_mapped(&name) => {
                    let names = head.columns.iter().map(String::as_str);
                    let nearest = nearest(&source.column, names).map(str::to_owned);
                    faults.push(LogFault::MissingColumn { column: source.column, nearest });
                }
                None => {}
            }
        }
        faults.extend(shared(head, &columns));
        faults.extend(missing_torques(head, robot, &columns, mapping));
        faults.extend(missing_forces(robot, &columns, mapping));
        faults.extend(other_robot(head, robot));
        let torque_side = torque_side(head).unwrap_or_else(|fault| {
            faults.push(fault);
            None
        });
        if faults.is_empty() { Ok(Self { columns, torque_side }) } else { Err(faults) }
    }

    /// Positions of joints and motors that jump.
    fn jumps(&self, table: &Table) -> Vec<Suspicion> {
        let is_position = |column: &Column| matches!(column.goes_to, Target::Joint(_, 0 | 6));
        let columns = self.columns.iter().enumerate().filter(|(_, column)| is_position(column));
        columns.filter_map(|(place, column)| jumps::jump(table, place, &column.name)).collect()
    }

    fn hand_out(&self, log: &mut MeasuredLog, values: Vec<Vec<f64>>, robot: LogOf<'_>) {
        let mut forces: Vec<[Vec<f64>; 3]> = vec![Default::default(); robot.contacts.len()];
        let mut commanded = vec![None; robot.joints.len()];
        let mut geared = Vec::new();
        let targets = self.columns.iter().filter(|c| !matches!(c.goes_to, Target::Time));
        for (column, mut values) in targets.zip(values) {
            match column.goes_to {
                Target::Time => {}
                Target::Contact(contact, axis) => forces[contact][axis] = values,
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
                    match signal {
                        0 => {
                            own.step = check::encoder_step(&values);
                            own.q = values;
                        }
                        1 => own.qd = Some(values),
                        2 => own.qdd = Some(values),
                        3 => own.tau = Some(values),
                        4 => commanded[joint] = Some(values),
                        5 => own.reference = Some(values),
                        _ => {
                            own.motor_step = check::encoder_step(&values);
                            own.motor = Some(values);
                        }
                    }
                }
            }
        }
        for ((own, command), joint) in log.joints.iter_mut().zip(commanded).zip(robot.joints) {
            if joint.is_elastic {
                own.motor_torque = command;
            } else if own.tau.is_none() && command.is_some() {
                own.tau = command;
                let joint = joint.name.clone();
                log.remarks.push(LogRemark::CommandedTorque { joint });
            }
        }
        if !geared.is_empty() {
            log.remarks.push(LogRemark::MotorTorques { joints: geared });
        }
        let named = robot.contacts.iter().cloned().zip(forces);
        log.contacts = named.filter(|(_, axes)| axes.iter().any(|axis| !axis.is_empty())).collect();
    }
}

/// Columns of the log that more than one of ours are taken from.
fn shared(head: &Head, columns: &[Column]) -> Vec<LogFault> {
    let mut faults = Vec::new();
    for (place, column) in head.columns.iter().enumerate() {
        let users = columns.iter().filter(|one| one.place == place);
        let ours: Vec<String> = users.map(|one| one.name.clone()).collect();
        if ours.len() > 1 {
            faults.push(LogFault::SharedColumn { column: column.clone(), ours });
        }
    }
    faults
}

/// Joints without a torque where others have one, if nobody said so: a name with a mistake in it
/// would silently take the joint's equation away. Joints of a floating base have no motor, nor have
/// those without a drive in a model with drives. A log without any torque is another matter: the
/// wrench on a base shows parameters too.
fn missing_torques(
    head: &Head,
    robot: LogOf<'_>,
    columns: &[Column],
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
    let is_ours = |name: &&str| columns.iter().all(|one| head.columns[one.place] != **name);
    let mut faults = Vec::new();
    for &joint in motors.iter().filter(|&&joint| !has_torque(joint)) {
        let column = format!("tau_{}", robot.joints[joint].name);
        if mapping.names().any(|name| name == column) {
            continue; // left out on purpose, or a fault already
        }
        let free = head.columns.iter().map(String::as_str).filter(is_ours);
        let nearest = nearest(&column, free).map(str::to_owned);
        faults.push(LogFault::MissingTorque { column, nearest });
    }
    faults
}

/// Forces on a floating base that the log does not have: without them its weight rests on nothing.
fn missing_forces(
    robot: LogOf<'_>,
    columns: &[Column],
    mapping: &ColumnMapping,
) -> Option<LogFault> {
    if !robot.joints.iter().any(|joint| joint.is_base) {
        return None;
    }
    let is_there = |name: &String| columns.iter().any(|column| column.name == *name);
    let of_contact = |name: &String| ["x", "y", "z"].map(|axis| format!("f_{name}_{axis}"));
    let all: Vec<String> = robot.contacts.iter().flat_map(of_contact).collect();
    // Null in the mapping leaves a column out on purpose, but not all of them.
    let carries = all.iter().any(is_there);
    let is_left_out = |name: &String| carries && mapping.source(name).is_none();
    let missing: Vec<String> =
        all.into_iter().filter(|name| !is_there(name) && !is_left_out(name)).collect();
    (!missing.is_empty()).then_some(LogFault::MissingForces { columns: missing })
}

/// Where the log says that its torques were measured.
fn torque_side(head: &Head) -> Result<Option<TorqueSide>, LogFault> {
    let said = head.header.iter().find(|(name, _)| name == TORQUE_SIDE);
    match said.map(|(_, value)| value.as_str()) {
        None => Ok(None),
        Some("joint") => Ok(Some(TorqueSide::Joint)),
        Some("motor") => Ok(Some(TorqueSide::Motor)),
        Some(found) => Err(LogFault::TorqueSide { found: found.to_owned() }),
    }
}

/// Whether the log says that it is of another robot, or has joints that this one lacks.
fn other_robot(head: &Head, robot: LogOf<'_>) -> Vec<LogFault> {
    let mut faults = Vec::new();
    if let Some(log) = model_of_header(&head.header).filter(|log| *log != robot.model) {
        let (log, model) = (log.to_owned(), robot.model.to_owned());
        faults.push(LogFault::OtherModel { log, model });
    }
    let is_ours = |name: &str| robot.joints.iter().any(|joint| joint.name == name);
    let named = head.columns.iter().filter_map(|column| column.strip_prefix("q_"));
    let others: Vec<String> = named.filter(|name| !is_ours(name)).map(str::to_owned).collect();
    if !others.is_empty() && others.len() * 2 > robot.joints.len() {
        faults.push(LogFault::OtherJoints { joints: others });
    }
    faults
}
