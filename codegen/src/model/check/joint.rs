//! Springs, damping and drives of joints.

use super::Check;
use super::parameter::EntryKind;
use crate::arena::Handle;
use crate::expr::ExprId;
use crate::model::entry::Entry;
use crate::model::fault::Cause;
use crate::model::file::{DriveFile, JointFile, ModelFile};
use crate::model::parameter::{JointEntry, Role};
use crate::model::robot::{Drive, JointKind, JointSpring, LinkId, ReturnSpring, SeriesElastic};

/// The entries that the file gives to one joint, in the order of [`JointEntry::ALL`].
type Given<'f, 'a> = [Option<&'f Entry<'a>>; 12];

/// The expressions of one joint's entries, in the same order.
type Found = [Option<ExprId>; 12];

impl Check<'_> {
    /// Gives the joints their drives, springs and damping, in link order.
    pub(super) fn drives(&mut self, file: &ModelFile) {
        let generated = self.links.len() - file.links.len();
        let mut drives: Vec<Option<&DriveFile>> = vec![None; file.links.len()];
        for drive in &file.drives {
            let id = self.link_ids.get(drive.link.text.as_ref()).map(|id| id.index());
            let index = id.and_then(|id| id.checked_sub(generated));
            let name = drive.link.text.clone().into_owned();
            match index {
                None => {
                    let hint = self.nearest_link(&name);
                    self.push(drive.link.at, Cause::UnknownLink(name, hint));
                }
                Some(index) if file.links[index].joint.kind == JointKind::Fixed => {
                    self.push(drive.link.at, Cause::DriveOnFixedJoint(name));
                }
                Some(index) => drives[index] = drives[index].or(Some(drive)),
            }
        }
        for (index, link) in file.links.iter().enumerate() {
            let id = Handle::from_index(generated + index);
            self.joint(id, &link.joint, drives[index]);
        }
    }

    fn joint(&mut self, link: LinkId, joint: &JointFile, drive: Option<&DriveFile>) {
        if joint.kind == JointKind::Fixed {
            return;
        }
        let name = self.links[link].name.clone();
        if let (Some(damping), Some(_)) = (&joint.damping, drive.and_then(|d| d.viscous.as_ref())) {
            self.push(damping.at, Cause::DampingTwice(name.clone()));
        }
        let given = given(joint, drive);
        let is_geared = drive.is_some_and(|drive| drive.gear_ratio.is_some());
        let found: Found = std::array::from_fn(|index| {
            let (entry, written) = (JointEntry::ALL[index], given[index]);
            written?;
            let (what, unit) = meaning(entry, joint.kind, is_geared);
            let kind = EntryKind {
                role: Role::Joint(link, entry),
                prefix: entry.prefix(),
                link: &name,
                what,
                unit,
                known: is_known(entry),
            };
            let expr = self.entry(written, &kind);
            self.check_sign(entry, what, written);
            Some(expr)
        });
        self.assemble(link, joint, drive, &found);
    }

    fn check_sign(&mut self, entry: JointEntry, what: &'static str, written: Option<&Entry>) {
        use JointEntry::{GearRatio, LoadRadius, MotorRadius, Offset, ReturnAngle, SpringAngle};
        let Some(scalar) = written.and_then(|written| written.value.as_ref()) else { return };
        // read again: the graph shares it, and its faults were noted the first time
        let before = self.report.count();
        let expr = self.scope.expression(scalar, self.report);
        self.report.truncate(before);
        match entry {
            GearRatio => {
                if self.is_zero(expr) {
                    self.push(scalar.at, Cause::ZeroGearRatio);
                }
            }
            MotorRadius | LoadRadius => self.require_positive(expr, what, scalar.at),
            Offset | ReturnAngle | SpringAngle => {}
            _ => self.require_not_negative(expr, what, scalar.at),
        }
    }

    fn assemble(
        &mut self,
        link: LinkId,
        joint: &JointFile,
        drive: Option<&DriveFile>,
        found: &Found,
    ) {
        let [viscous, coulomb, rotor_inertia, offset, gear_ratio, rest @ ..] = *found;
        let zero = self.scope.dag.zero();
        let [k, rm, rl, kr, qr, ks, qs] = rest.map(|expr| expr.unwrap_or(zero));
        let row = &mut self.links[link];
        row.joint.spring = joint.spring.as_ref().map(|_| JointSpring { stiffness: ks, angle: qs });
        if joint.damping.is_some() {
            row.joint.damping = viscous;
        }
        row.drive = drive.map(|drive| Drive {
            gear_ratio,
            rotor_inertia,
            viscous: viscous.filter(|_| drive.viscous.is_some()),
            coulomb,
            offset,
            series_elastic: drive.series_elastic.as_ref().map(|_| SeriesElastic {
                stiffness: k,
                motor_radius: rm,
                load_radius: rl,
            }),
            return_spring: drive.return_spring.as_ref().map(|(_, side)| ReturnSpring {
                stiffness: kr,
                angle: qr,
                side: *side,
            }),
        });
    }
}

fn given<'f, 'a>(joint: &'f JointFile<'a>, drive: Option<&'f DriveFile<'a>>) -> Given<'f, 'a> {
    fn of<'f, 'a>(
        drive: Option<&'f DriveFile<'a>>,
        entry: impl Fn(&'f DriveFile<'a>) -> &'f Option<Entry<'a>>,
    ) -> Option<&'f Entry<'a>> {
        drive.and_then(|drive| entry(drive).as_ref())
    }
    let series =
        |index: usize| drive?.series_elastic.as_ref().and_then(|spring| spring[index].as_ref());
    let back =
        |index: usize| drive?.return_spring.as_ref().and_then(|(spring, _)| spring[index].as_ref());
    let spring = |index: usize| joint.spring.as_ref().and_then(|spring| spring[index].as_ref());
    [
        of(drive, |drive| &drive.viscous).or(joint.damping.as_ref()),
        of(drive, |drive| &drive.coulomb),
        of(drive, |drive| &drive.rotor_inertia),
        of(drive, |drive| &drive.offset),
        of(drive, |drive| &drive.gear_ratio),
        series(0),
        series(1),
        series(2),
        back(0),
        back(1),
        spring(0),
        spring(1),
    ]
}

/// Whether a value comes from a data sheet or a ruler rather than from identification.
fn is_known(entry: JointEntry) -> bool {
    use JointEntry::{GearRatio, LoadRadius, MotorRadius, ReturnAngle, SpringAngle};
    matches!(entry, GearRatio | MotorRadius | LoadRadius | ReturnAngle | SpringAngle)
}

/// What an entry is called, and its unit: with a gear, motor quantities are those of a shaft.
fn meaning(entry: JointEntry, kind: JointKind, is_geared: bool) -> (&'static str, &'static str) {
    use JointEntry::*;
    let turns = kind == JointKind::Revolute;
    let motor_turns = turns || is_geared;
    let by = |turns: bool, turning: &'static str, sliding: &'static str| {
        if turns { turning } else { sliding }
    };
    match entry {
        Viscous => ("viscous friction", by(motor_turns, "N m s/rad", "N s/m")),
        Coulomb => ("Coulomb friction", by(motor_turns, "N m", "N")),
        RotorInertia => ("the rotor inertia", by(motor_turns, "kg m^2", "kg")),
        Offset => ("the torque offset", by(turns, "N m", "N")),
        GearRatio => ("the gear ratio", by(turns, "1", "rad/m")),
        SeriesStiffness => ("the spring stiffness", "N/m"),
        MotorRadius => ("the motor radius", "m"),
        LoadRadius => ("the load radius", by(turns, "m", "1")),
        ReturnStiffness | SpringStiffness => ("the spring stiffness", by(turns, "N m/rad", "N/m")),
        ReturnAngle | SpringAngle => ("the angle of the spring", by(turns, "rad", "m")),
    }
}
