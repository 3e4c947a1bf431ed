//! Logs of measurements: read, mapped to our columns, checked, brought to equal distances.
//!
//! - [`ColumnMapping`]: which column of a foreign log is which of ours
//! - [`read_log`], [`read_opened`]: a log of a robot; all that is wrong with it at once
//! - [`used_columns`]: which of its columns are read
//! - [`MeasuredLog`]: what was measured, joint by joint
//!
//! A log is streamed: only the columns that are used are held, 8 bytes a sample each.

mod check;
mod fault;
mod jumps;
mod mapping;
mod repair;
mod wanted;

use crate::error::Error;
use crate::policy::log::{LARGEST, LARGEST_TIME};
pub use fault::{LogFault, LogFaults, LogRemark, Suspicion};
pub use mapping::{ColumnMapping, ColumnSource};

pub use denavit_logs::{FileFault, FileRemark, Place};

use denavit_logs::{Log, Table, open_csv};
use denavit_plants::regression::RegressionJoint;
use std::io::BufRead;
use wanted::{Target, Wanted, WantedColumn};

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
    /// Wrenches on links from outside, at the origin of the link's frame, in the directions of the
    /// world: force \[N\], then moment [N m]; what a log does not have is empty.
    pub wrenches: Vec<(String, [Vec<f64>; 6])>,
    /// What was found and repaired.
    pub remarks: Vec<LogRemark>,
}

impl MeasuredLog {
    /// Number of samples.
    pub fn samples(&self) -> usize {
        self.joints.first().map_or(0, |joint| joint.q.len())
    }

    /// The first samples alone.
    pub fn head(&self, samples: usize) -> Self {
        let mut head = self.clone();
        for joint in &mut head.joints {
            let JointSignals { q, qd, qdd, tau, reference, motor, motor_torque, .. } = joint;
            q.truncate(samples);
            let others = [qd, qdd, tau, reference, motor, motor_torque].into_iter().flatten();
            others.for_each(|values| values.truncate(samples));
        }
        let forces = head.contacts.iter_mut().flat_map(|(_, axes)| axes);
        let wrenches = head.wrenches.iter_mut().flat_map(|(_, parts)| parts);
        forces.chain(wrenches).for_each(|values| values.truncate(samples));
        head
    }

    /// Sees to it that no joint behind a spring has the torque of its motor alone, which is not
    /// what the joint gets: a fault, or, where suspicions are accepted, a remark, and the motor's
    /// torque is taken for the joint's.
    pub fn require_joint_torques(
        &mut self,
        joints: &[RegressionJoint],
        accepts_suspicious: bool,
    ) -> Result<(), Error> {
        let mut faults = Vec::new();
        for (own, joint) in self.joints.iter_mut().zip(joints) {
            let (None, Some(command)) = (&own.tau, &own.motor_torque) else { continue };
            let suspicion = Suspicion::CommandOfSpring { joint: joint.name.clone() };
            if accepts_suspicious {
                let factor = joint.gear_ratio;
                own.tau = Some(command.iter().map(|torque| factor * torque).collect());
                self.remarks.push(LogRemark::Accepted(suspicion));
            } else {
                faults.push(LogFault::Suspicion(suspicion));
            }
        }
        match faults.is_empty() {
            true => Ok(()),
            false => Err(LogFaults { file: self.file.clone(), faults }.into()),
        }
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

/// Reads a log of a robot from text. `file` is its name, for messages alone.
///
/// # Errors
/// All that is wrong with it.
pub fn read_log(
    file: &str,
    source: impl BufRead,
    robot: LogOf<'_>,
    mapping: &ColumnMapping,
) -> Result<MeasuredLog, Error> {
    let log = open_csv(source).map_err(|error| of_file(file, error))?;
    read_opened(file, log, robot, mapping)
}

/// What is wrong with a file itself.
pub fn of_file(file: &str, error: denavit_logs::Error) -> Error {
    let faults = error.into_faults().into_iter().map(LogFault::File).collect();
    LogFaults { file: file.to_owned(), faults }.into()
}

/// Reads a log of a robot that is open, of whatever format. `file` is its name, for messages alone.
///
/// # Errors
/// All that is wrong with it.
pub fn read_opened(
    file: &str,
    mut log: Log<'_>,
    robot: LogOf<'_>,
    mapping: &ColumnMapping,
) -> Result<MeasuredLog, Error> {
    let failed = |faults| Error::from(LogFaults { file: file.to_owned(), faults });
    let mut wanted = Wanted::new(&log, robot, mapping).map_err(failed)?;
    let header = std::mem::take(&mut log.header);
    let logged: Vec<String> = log.columns.iter().map(|one| one.name.clone()).collect();
    let read = log.read(&wanted.places(), &wanted.clocks());
    let mut table = read.map_err(|error| of_file(file, error))?;
    for (values, column) in table.columns.iter_mut().zip(&mut wanted.columns) {
        let WantedColumn { scale, offset, .. } = *column;
        column.step = column.goes_to.is_position().then(|| check::encoder_step(values)).flatten();
        if scale != 1.0 || offset != 0.0 {
            values.iter_mut().for_each(|value| *value = scale * *value + offset);
        }
    }
    let impossible = impossible(&table, &wanted);
    if !impossible.is_empty() {
        return Err(failed(impossible));
    }
    if table.rows() == 0 {
        return Err(failed(vec![repair::too_short(0)]));
    }
    let names: Vec<String> = wanted.columns.iter().map(|column| column.name.clone()).collect();
    let jumps = wanted.jumps(&table);
    let found = std::mem::take(&mut table.remarks).into_iter().map(LogRemark::File);
    let even = repair::even(table, &names).map_err(failed)?;
    let mut log = MeasuredLog {
        file: file.to_owned(),
        header,
        start_s: even.start_s,
        step_s: even.step_s,
        joints: vec![JointSignals::default(); robot.joints.len()],
        contacts: Vec::new(),
        wrenches: Vec::new(),
        remarks: found.chain(even.remarks).collect(),
    };
    wanted.hand_out(&mut log, even.columns, robot);
    let mut found = check::check(&log, robot.joints);
    log.remarks.append(&mut found.remarks);
    let mut faults = found.faults;
    for suspicion in jumps.into_iter().chain(found.suspicions) {
        let suspicion = suspicion.of_log(|column| wanted.mapped(column, &logged));
        match robot.accepts_suspicious {
            true => log.remarks.push(LogRemark::Accepted(suspicion)),
            false => faults.push(LogFault::Suspicion(suspicion)),
        }
    }
    if faults.is_empty() { Ok(log) } else { Err(failed(faults)) }
}

/// The places of the columns of a log that are read for a robot. `file` is its name, for messages
/// alone.
///
/// # Errors
/// All that its columns lack.
pub fn used_columns(
    file: &str,
    log: &Log<'_>,
    robot: LogOf<'_>,
    mapping: &ColumnMapping,
) -> Result<UsedColumns, Error> {
    let failed = |faults| Error::from(LogFaults { file: file.to_owned(), faults });
    let wanted = Wanted::new(log, robot, mapping).map_err(failed)?;
    let is_time = |column: &&WantedColumn| matches!(column.goes_to, Target::Time);
    let time = wanted.columns.iter().find(is_time).expect("it is always needed");
    Ok(UsedColumns {
        places: wanted.places(),
        time: time.place,
        to_seconds: [time.scale, time.offset],
    })
}

/// Columns that are read of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct UsedColumns {
    /// Their places in the log.
    pub places: Vec<usize>,
    /// That of the time.
    pub time: usize,
    /// What it is multiplied by, and what is added, to be in seconds.
    pub to_seconds: [f64; 2],
}

/// The first number of each column that nothing of a robot can be.
fn impossible(table: &Table, wanted: &Wanted) -> Vec<LogFault> {
    let mut faults = Vec::new();
    for (values, column) in table.columns.iter().zip(&wanted.columns) {
        let largest = match column.goes_to {
            Target::Time => LARGEST_TIME,
            _ => LARGEST,
        };
        if let Some(row) = values.iter().position(|value| value.abs() > largest) {
            let (value, at) = (values[row], table.place(row));
            faults.push(LogFault::Impossible { column: column.name.clone(), value, at });
        }
    }
    faults
}
