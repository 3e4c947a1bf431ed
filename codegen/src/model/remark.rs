//! What a model may say by mistake and is no fault, because a robot may be so: each remark is about
//! a unit, a sign or a copy that went wrong often enough to ask.
//!
//! All numbers are those of the file, exact but for pi. What has no value is not asked about.

use super::bake::bake_where;
use super::check::{approximate, near_pi};
use super::fault::{Explained, Fault};
use super::json::{self, Json, Value};
use super::parameter::Role;
use super::report::Report;
use super::robot::{About, Base, Body, JointKind, Link, LinkId, Robot};
use crate::arena::Handle;
use crate::expr::{ExprId, free_symbols};
use crate::number::{Rational, decimal_text, integer};
use num_traits::{Signed, Zero};
use std::fmt;

/// The square of how many link lengths away a centre of mass is remarked on. The bodies of a robot
/// are about as long as its links, and in millimetres a thousand times as long: half way between
/// the two, on a scale of factors, is the root of a thousand.
const SQUARED_LENGTHS: i64 = 1000;

/// What is remarkable at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remark {
    /// An angle of the table beyond a full turn; holds it as text.
    LargeAngle(String),
    /// A centre of mass far from its link.
    FarCentreOfMass {
        /// Its coordinates, as text.
        com: [String; 3],
        /// The length of the link: the largest offset of its row and of the rows it carries.
        length: String,
    },
    /// Gravity points away from the ground.
    GravityUpwards,
    /// Whatever the entries are that a body leaves out, there is no such body; holds why, as an
    /// inequality that fails.
    NoSuchBody(String),
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::LargeAngle(angle) => write!(f, "the angle {angle} is more than a full turn"),
            Self::FarCentreOfMass { com, length } => write!(
                f,
                "the centre of mass ({}) is farther out than the robot reaches; its link has a \
                 length of {length}",
                com.join(", ")
            ),
            Self::GravityUpwards => write!(f, "gravity points away from the ground"),
            Self::NoSuchBody(why) => {
                write!(f, "no body has this inertia, whatever the missing entries are: {why}")
            }
        }
    }
}

impl Explained for Remark {
    fn hint(&self) -> Option<String> {
        let hint = match self {
            Self::LargeAngle(_) => "angles are in radians: 90 degrees are \"pi/2\"",
            Self::FarCentreOfMass { .. } => "lengths are in metres: are these millimetres?",
            Self::GravityUpwards => {
                "this is the acceleration of free fall: [0, 0, -9.81] where z points up"
            }
            Self::NoSuchBody(_) => "check the source, the units and \"about\"",
        };
        Some(hint.to_owned())
    }
}

/// The remarks on a robot, in the order of its file, whose bytes are `source`. A model that is in
/// order has none. Numbers that were estimated are not asked about: moments that no motion tells
/// apart may be any.
pub fn remarks(robot: &Robot, source: &[u8]) -> Vec<Fault<Remark>> {
    let root = json::parse(source).ok();
    let mut report = Report::default();
    let Ok(known) = bake_where(robot, |parameter| parameter.default.is_some()) else {
        return Vec::new();
    };
    let asked = Asked { robot, known: &known };
    for (pointer, remark) in asked.remarks(root.as_ref()) {
        let at = root.as_ref().map_or(0, |root| find(root, &pointer).0.start);
        report.push(at, remark);
    }
    report.into_error("", source, root.as_ref()).faults
}

/// The value that a pointer leads to, or as far as it leads; whether it leads there.
fn find<'v, 'a>(root: &'v Json<'a>, pointer: &str) -> (&'v Json<'a>, bool) {
    let mut json = root;
    for part in pointer.split('/').skip(1) {
        let next = match &json.value {
            Value::List(items) => part.parse().ok().and_then(|index: usize| items.get(index)),
            Value::Object(entries) => {
                entries.iter().find(|(key, _)| key == part).map(|(_, value)| value)
            }
            _ => None,
        };
        let Some(next) = next else { return (json, false) };
        json = next;
    }
    (json, true)
}

struct Asked<'r> {
    robot: &'r Robot,
    /// The same with numbers for all symbols that have one.
    known: &'r Robot,
}

impl Asked<'_> {
    fn remarks(&self, root: Option<&Json>) -> Vec<(String, Remark)> {
        let mut remarks = Vec::new();
        if self.is_gravity_upwards(root) {
            remarks.push(("/gravity".to_owned(), Remark::GravityUpwards));
        }
        for (id, link) in self.known.links.iter() {
            let (place, body_place) = match self.robot.pointer(id) {
                Some(pointer) => (pointer.clone(), format!("{pointer}/body")),
                // the body of a floating base is that of its last joint
                None => ("/base".to_owned(), "/base/body".to_owned()),
            };
            for (key, angle) in [("alpha", link.joint.alpha), ("theta", link.joint.theta)] {
                let remark = self.large_angle(angle);
                remarks.extend(remark.map(|remark| (format!("{place}/joint/{key}"), remark)));
            }
            if let Some(body) = &link.body {
                let far = self.far_com(id, body);
                remarks.extend(far.map(|remark| (format!("{body_place}/com"), remark)));
                let why = root.and_then(|root| self.impossible(body, find(root, &body_place).0));
                remarks.extend(why.map(|why| (body_place, Remark::NoSuchBody(why))));
            }
        }
        remarks
    }

    fn value(&self, expr: ExprId) -> Option<Rational> {
        approximate(&self.known.dag, expr)
    }

    /// Whether free fall leads away from the ground that the robot stands on, or lands on.
    fn is_gravity_upwards(&self, root: Option<&Json>) -> bool {
        let robot = self.known;
        let has_ground = root.is_some_and(|root| find(root, "/ground").1);
        if robot.base == Base::Fixed && robot.contacts.is_empty() && !has_ground {
            return false;
        }
        let mut along = Rational::zero();
        for (&gravity, &normal) in robot.gravity.iter().zip(&robot.ground.normal) {
            let (Some(gravity), Some(normal)) = (self.value(gravity), self.value(normal)) else {
                return false;
            };
            along += gravity * normal;
        }
        along.is_positive()
    }

    fn large_angle(&self, angle: ExprId) -> Option<Remark> {
        let value = self.value(angle)?;
        let is_large = value.abs() > integer(2) * near_pi();
        is_large.then(|| Remark::LargeAngle(decimal_text(&value)))
    }

    fn far_com(&self, link: LinkId, body: &Body) -> Option<Remark> {
        if self.robot.links[link].body.as_ref().is_some_and(|body| self.has_unknowns(&body.com)) {
            // such a body may stand for several, and lie where none of them does
            return None;
        }
        // what is not known is not far
        let com = body.com.map(|entry| self.value(entry).unwrap_or_else(Rational::zero));
        let length = self.length(link).filter(|length| !length.is_zero())?;
        let square = com.iter().fold(Rational::zero(), |sum, entry| sum + entry * entry);
        let is_far = square > integer(SQUARED_LENGTHS) * &length * &length && {
            let reach = self.reach()?;
            square > &reach * &reach
        };
        is_far.then(|| Remark::FarCentreOfMass {
            com: com.each_ref().map(decimal_text),
            length: decimal_text(&length),
        })
    }

    /// Whether expressions are written in unknowns that the file declares.
    fn has_unknowns(&self, exprs: &[ExprId]) -> bool {
        let symbols = free_symbols(&self.robot.dag, exprs);
        let mut names = symbols.iter().map(|&id| self.robot.dag.symbols()[id].name.as_str());
        names.any(|name| {
            let parameter = self.robot.find_parameter(name);
            parameter.is_some_and(|id| self.robot.parameters[id].role == Role::Unknown)
        })
    }

    /// The largest offset of a link's row and of the rows of the links that it carries; nothing if
    /// one is not known.
    fn length(&self, link: LinkId) -> Option<Rational> {
        let links = self.known.links.iter();
        let rows = links.filter(|(id, other)| *id == link || other.parent == Some(link));
        rows.flat_map(|(id, link)| self.offsets(id, link)).try_fold(
            Rational::zero(),
            |most, offset| {
                let offset = offset?;
                Some(if offset > most { offset } else { most })
            },
        )
    }

    /// No way from joint to joint is longer.
    fn reach(&self) -> Option<Rational> {
        let mut offsets = self.known.links.iter().flat_map(|(id, link)| self.offsets(id, link));
        offsets.try_fold(Rational::zero(), |sum, offset| Some(sum + offset?))
    }

    /// The offsets of a row, without sign; a joint that slides reaches as far as its limits, and
    /// one without limits anywhere.
    fn offsets(&self, id: LinkId, link: &Link) -> Vec<Option<Rational>> {
        let joint = &link.joint;
        let mut offsets = vec![self.value(joint.a), self.value(joint.d)];
        let is_generated = id.index() < self.known.base.generated_joints();
        if joint.kind == JointKind::Prismatic && !is_generated {
            match link.limits.position {
                Some(ends) => offsets.extend(ends.map(|end| self.value(end))),
                None => offsets.push(None),
            }
        }
        offsets.into_iter().map(|offset| offset.map(|offset| offset.abs())).collect()
    }

    /// An inequality that every body obeys and this one does not, where `file` leaves out its mass
    /// or moments; where they are given, the reader has decided.
    fn impossible(&self, body: &Body, file: &Json) -> Option<String> {
        let given = |(pointer, entry): (&str, ExprId)| {
            let is_given = match find(file, pointer) {
                (_, false) => false,
                // what is said of an entry may be that its value is not known
                (said, true) => !matches!(said.value, Value::Object(_)) || find(said, "/value").1,
            };
            self.value(entry).filter(|_| is_given)
        };
        let [x, y, z] = body.com;
        let mass = given(("/mass", body.mass));
        let com = [("/com/0", x), ("/com/1", y), ("/com/2", z)].map(given);
        let [xx, yy, zz, xy, xz, yz] = body.inertia;
        let tensor = [
            ("/inertia/xx", xx),
            ("/inertia/yy", yy),
            ("/inertia/zz", zz),
            ("/inertia/xy", xy),
            ("/inertia/xz", xz),
            ("/inertia/yz", yz),
        ]
        .map(given);
        let is_complete = mass.is_some() && tensor[..3].iter().all(Option::is_some);
        if is_complete {
            return None;
        }
        triangle(&tensor)
            .or_else(|| product(&tensor))
            .or_else(|| moved(body.about, mass.as_ref()?, &com, &tensor))
    }
}

const MOMENTS: [&str; 3] = ["Ixx", "Iyy", "Izz"];

/// A moment is at most the sum of the other two, about whatever point.
fn triangle(tensor: &[Option<Rational>; 6]) -> Option<String> {
    let [Some(xx), Some(yy), Some(zz), ..] = tensor else { return None };
    let moments = [xx, yy, zz];
    let large = (0..3).find(|&axis| {
        let others = (0..3).filter(|&other| other != axis);
        *moments[axis] > others.fold(Rational::zero(), |sum, other| sum + moments[other])
    })?;
    let others: Vec<usize> = (0..3).filter(|&other| other != large).collect();
    let sum = moments[others[0]] + moments[others[1]];
    let [a, b] = [MOMENTS[others[0]], MOMENTS[others[1]]];
    let (large, moment) = (MOMENTS[large], decimal_text(moments[large]));
    Some(format!("{large} = {moment} > {a} + {b} = {}", decimal_text(&sum)))
}

/// Ixy^2 <= Ixx Iyy, since no moment is negative; and 2 |Ixy| <= Izz, since Izz is the sum of two
/// second moments whose product is at least Ixy^2.
fn product(tensor: &[Option<Rational>; 6]) -> Option<String> {
    let pairs = [("Ixy", 3, [0, 1], 2), ("Ixz", 4, [0, 2], 1), ("Iyz", 5, [1, 2], 0)];
    pairs.into_iter().find_map(|(name, entry, [a, b], third)| {
        let product = tensor[entry].as_ref()?;
        let twice = integer(2) * product.abs();
        if let Some(moment) = tensor[third].as_ref().filter(|&moment| twice > *moment) {
            let (third, twice) = (MOMENTS[third], decimal_text(&twice));
            return Some(format!("2 |{name}| = {twice} > {third} = {}", decimal_text(moment)));
        }
        let most = tensor[a].as_ref()? * tensor[b].as_ref()?;
        let square = product * product;
        (square > most).then(|| {
            let (square, most) = (decimal_text(&square), decimal_text(&most));
            format!("{name}^2 = {square} > {} {} = {most}", MOMENTS[a], MOMENTS[b])
        })
    })
}

/// About the origin a moment is at least that of the mass in the centre of mass.
fn moved(
    about: About,
    mass: &Rational,
    com: &[Option<Rational>; 3],
    tensor: &[Option<Rational>; 6],
) -> Option<String> {
    if about == About::Com {
        return None;
    }
    (0..3).find_map(|axis| {
        let moment = tensor[axis].as_ref()?;
        let across = (0..3).filter(|&other| other != axis).filter_map(|other| com[other].as_ref());
        let least = mass * across.fold(Rational::zero(), |sum, entry| sum + entry * entry);
        (*moment < least).then(|| {
            let (name, moment) = (MOMENTS[axis], decimal_text(moment));
            format!("{name} = {moment} about the origin < m r^2 = {}", decimal_text(&least))
        })
    })
}
