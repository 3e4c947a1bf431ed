//! Points in links and the ground, as a model file says them.

use super::entry::{Name, Scalar};
use super::fault::Cause;
use super::reader::Node;
use super::report::Report;

/// A point fixed in a link.
#[derive(Clone, Debug)]
pub(super) struct PointFile<'a> {
    pub(super) name: Name<'a>,
    pub(super) link: Name<'a>,
    pub(super) position: Option<[Scalar<'a>; 3]>,
}

/// A body that must not touch the ground: a point at its `position`, or a capsule.
#[derive(Clone, Debug)]
pub(super) struct FallBodyFile<'a> {
    pub(super) name: Name<'a>,
    pub(super) link: Name<'a>,
    pub(super) ends: Vec<Option<[Scalar<'a>; 3]>>,
    pub(super) radius: Option<Scalar<'a>>,
}

/// The ground's plane.
#[derive(Clone, Debug, Default)]
pub(super) struct GroundFile<'a> {
    pub(super) point: Option<[Scalar<'a>; 3]>,
    pub(super) normal: Option<[Scalar<'a>; 3]>,
    pub(super) at: usize,
}

pub(super) fn read_point<'a>(node: Node<'a>, report: &mut Report) -> Option<PointFile<'a>> {
    let fields = node.fields(&["name", "link", "position"], report)?;
    Some(PointFile {
        name: fields.required_name("name", report),
        link: fields.required_name("link", report),
        position: fields.required_triple("position", report),
    })
}

pub(super) fn read_fall_body<'a>(node: Node<'a>, report: &mut Report) -> Option<FallBodyFile<'a>> {
    let known = &["name", "link", "position", "from", "to", "radius_m"];
    let fields = node.fields(known, report)?;
    let is_capsule = ["from", "to", "radius_m"].iter().any(|key| fields.get(key).is_some());
    let mut body = FallBodyFile {
        name: fields.required_name("name", report),
        link: fields.required_name("link", report),
        ends: Vec::new(),
        radius: None,
    };
    if is_capsule {
        if let Some(position) = fields.get("position") {
            report.push(position.at(), Cause::PointOrCapsule);
        }
        body.ends = ["from", "to"].map(|key| fields.required_triple(key, report)).into();
        body.radius = fields.require("radius_m", report).and_then(|node| node.scalar(report));
    } else {
        body.ends = vec![fields.required_triple("position", report)];
    }
    Some(body)
}

pub(super) fn read_ground<'a>(node: Node<'a>, report: &mut Report) -> GroundFile<'a> {
    let Some(fields) = node.fields(&["point", "normal"], report) else {
        return GroundFile::default();
    };
    GroundFile {
        point: fields.get("point").and_then(|node| node.scalars(report)),
        normal: fields.get("normal").and_then(|node| node.scalars(report)),
        at: node.at(),
    }
}
