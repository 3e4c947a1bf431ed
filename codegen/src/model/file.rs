//! The file as it is written: one type per object of the format, nothing checked but the form.
//!
//! Reading never stops at a fault: it notes it, puts something harmless in its place and goes on,
//! so that one answer lists everything. Nobody sees what was put there: a robot is handed out only
//! if no fault was noted.

use super::entry::{Entry, Name, Scalar};
use super::fault::Cause;
use super::inertia::Violation;
use super::message::EFFECT_PLACE;
use super::place_file::{
    FallBodyFile, GroundFile, PointFile, read_fall_body, read_ground, read_point,
};
use super::reader::{Fields, Node, Word};
use super::report::Report;
use super::robot::{About, Base, Convention, JointKind, Side, SpringSide, Terms, TorqueSide};

/// A constant or an unknown.
#[derive(Clone, Debug)]
pub(super) struct Declaration<'a> {
    pub(super) name: Name<'a>,
    pub(super) value: Option<Scalar<'a>>,
    pub(super) std: Option<Scalar<'a>>,
    pub(super) unit: Option<Name<'a>>,
    pub(super) doc: String,
}

/// The base with the body that it may carry.
#[derive(Clone, Debug)]
pub(super) struct BaseFile<'a> {
    pub(super) kind: Base,
    pub(super) body: Option<BodyFile<'a>>,
}

/// A link.
#[derive(Clone, Debug)]
pub(super) struct LinkFile<'a> {
    pub(super) at: usize,
    pub(super) name: Name<'a>,
    pub(super) parent: Option<Name<'a>>,
    pub(super) joint: JointFile<'a>,
    pub(super) limits: LimitsFile<'a>,
    pub(super) body: Option<BodyFile<'a>>,
}

/// A row of the table: a, alpha, d, theta in this order.
#[derive(Clone, Debug)]
pub(super) struct JointFile<'a> {
    pub(super) kind: JointKind,
    pub(super) row: [Option<Scalar<'a>>; 4],
    /// Stiffness and angle.
    pub(super) spring: Option<[Option<Entry<'a>>; 2]>,
    pub(super) damping: Option<Entry<'a>>,
    pub(super) at: usize,
}

/// The bounds of a joint; a single number stands for both ends.
#[derive(Clone, Debug, Default)]
pub(super) struct LimitsFile<'a> {
    pub(super) position: Option<[Scalar<'a>; 2]>,
    pub(super) velocity: Option<Scalar<'a>>,
    pub(super) acceleration: Option<Scalar<'a>>,
    pub(super) torque: Option<TorqueFile<'a>>,
    /// Where they stand, if they are given.
    pub(super) at: Option<usize>,
}

/// A bound of the torque: one number for both ways, or both ends.
#[derive(Clone, Debug)]
pub(super) enum TorqueFile<'a> {
    Symmetric(Scalar<'a>),
    Range([Scalar<'a>; 2]),
}

/// Mass properties: the ten entries in column order.
#[derive(Clone, Debug)]
pub(super) struct BodyFile<'a> {
    pub(super) entries: [Option<Entry<'a>>; 10],
    pub(super) about: About,
    pub(super) violation: Violation,
    pub(super) at: usize,
}

/// Motor and gear.
#[derive(Clone, Debug)]
pub(super) struct DriveFile<'a> {
    pub(super) link: Name<'a>,
    pub(super) gear_ratio: Option<Entry<'a>>,
    pub(super) rotor_inertia: Option<Entry<'a>>,
    pub(super) viscous: Option<Entry<'a>>,
    pub(super) coulomb: Option<Entry<'a>>,
    pub(super) offset: Option<Entry<'a>>,
    /// Stiffness, motor radius, load radius.
    pub(super) series_elastic: Option<[Option<Entry<'a>>; 3]>,
    /// Stiffness and angle.
    pub(super) return_spring: Option<([Option<Entry<'a>>; 2], Side)>,
}

/// Where an effect acts.
#[derive(Clone, Debug)]
pub(super) enum PlaceFile<'a> {
    Link(Name<'a>),
    Pair(Name<'a>, Name<'a>),
    Contact(Name<'a>),
    Model,
}

/// An added effect.
#[derive(Clone, Debug)]
pub(super) struct EffectFile<'a> {
    pub(super) place: usize,
    pub(super) effect: String,
    pub(super) at: PlaceFile<'a>,
    /// Of the joint's series spring.
    pub(super) side: Option<SpringSide>,
    /// Name, value, standard deviation.
    pub(super) parameters: Vec<(String, Scalar<'a>, Option<Scalar<'a>>)>,
}

/// The whole file.
#[derive(Clone, Debug)]
pub(super) struct ModelFile<'a> {
    pub(super) name: Name<'a>,
    pub(super) description: String,
    pub(super) source: String,
    pub(super) assumptions: Vec<String>,
    pub(super) convention: Convention,
    pub(super) gravity: Option<[Scalar<'a>; 3]>,
    pub(super) terms: Terms,
    pub(super) torque_side: TorqueSide,
    pub(super) constants: Vec<Declaration<'a>>,
    pub(super) unknowns: Vec<Declaration<'a>>,
    pub(super) base: BaseFile<'a>,
    pub(super) links: Vec<LinkFile<'a>>,
    /// Where the list of links stands.
    pub(super) links_at: usize,
    pub(super) drives: Vec<DriveFile<'a>>,
    pub(super) contacts: Vec<PointFile<'a>>,
    pub(super) ground: GroundFile<'a>,
    pub(super) bodies_that_must_not_touch: Vec<FallBodyFile<'a>>,
    pub(super) effects: Vec<EffectFile<'a>>,
}

const CONVENTIONS: Word<'_, Convention> = Word {
    what: "convention",
    known: &["standard", "modified"],
    values: &[Convention::Standard, Convention::Modified],
};
const TORQUE_SIDES: Word<'_, TorqueSide> = Word {
    what: "torque side",
    known: &["joint", "motor"],
    values: &[TorqueSide::Joint, TorqueSide::Motor],
};
const BASES: Word<'_, Base> = Word {
    what: "base",
    known: &["fixed", "floating", "planar_floating"],
    values: &[Base::Fixed, Base::Floating, Base::PlanarFloating],
};
const JOINT_KINDS: Word<'_, JointKind> = Word {
    what: "joint type",
    known: &["revolute", "prismatic", "fixed"],
    values: &[JointKind::Revolute, JointKind::Prismatic, JointKind::Fixed],
};
const ABOUT: Word<'_, About> = Word {
    what: "point of reference",
    known: &["com", "origin"],
    values: &[About::Com, About::Origin],
};
/// Sides of series springs.
pub(crate) const SPRING_SIDES: Word<'_, SpringSide> = Word {
    what: "side of a series spring",
    known: &["motor", "link"],
    values: &[SpringSide::Motor, SpringSide::Link],
};

const SIDES: Word<'_, Side> =
    Word { what: "side", known: &["above", "below"], values: &[Side::Above, Side::Below] };
const TERMS: Word<'_, usize> = Word {
    what: "term",
    known: &["inertia", "coriolis", "gravity", "friction", "rotor", "spring"],
    values: &[0, 1, 2, 3, 4, 5],
};
const MODEL: Word<'_, ()> = Word { what: EFFECT_PLACE, known: &["model"], values: &[()] };

const MODEL_KEYS: &[&str] = &[
    "format",
    "name",
    "description",
    "source",
    "assumptions",
    "convention",
    "gravity",
    "terms",
    "torque_side",
    "constants",
    "unknowns",
    "base",
    "links",
    "drives",
    "contacts",
    "ground",
    "bodies_that_must_not_touch",
    "effects",
];

impl<'a> ModelFile<'a> {
    /// Reads the form of a whole file; none if it is no object at all.
    pub(super) fn read(node: Node<'a>, report: &mut Report) -> Option<Self> {
        let fields = node.fields(MODEL_KEYS, report)?;
        fields.format(super::FORMAT, report);
        Some(Self {
            name: fields.required_name("name", report),
            description: fields.text_or_empty("description", report),
            source: fields.text_or_empty("source", report),
            assumptions: fields.texts("assumptions", report),
            convention: fields.required_word("convention", &CONVENTIONS, report),
            gravity: fields.required_triple("gravity", report),
            terms: read_terms(&fields, report),
            torque_side: fields
                .word("torque_side", &TORQUE_SIDES, report)
                .unwrap_or(TorqueSide::Joint),
            constants: read_declarations(&fields, "constants", &["value", "unit", "doc"], report),
            unknowns: read_declarations(
                &fields,
                "unknowns",
                &["value", "std", "unit", "doc"],
                report,
            ),
            base: read_base(&fields, report),
            links: fields.required_items("links", report, read_link),
            links_at: fields.place("links"),
            drives: fields.members("drives", report, read_drive),
            contacts: fields.items("contacts", report, read_point),
            ground: fields
                .get("ground")
                .map_or_else(GroundFile::default, |node| read_ground(node, report)),
            bodies_that_must_not_touch: fields.items(
                "bodies_that_must_not_touch",
                report,
                read_fall_body,
            ),
            effects: fields.items("effects", report, read_effect),
        })
    }
}

fn read_terms(fields: &Fields<'_>, report: &mut Report) -> Terms {
    if fields.get("terms").is_none() {
        return Terms::ALL;
    }
    let mut has = [false; 6];
    fields.items("terms", report, |node, report| {
        node.word(&TERMS, report).map(|index| has[index] = true)
    });
    let [inertia, coriolis, gravity, friction, rotor, spring] = has;
    Terms { inertia, coriolis, gravity, friction, rotor, spring }
}

pub(super) fn read_declarations<'a>(
    fields: &Fields<'a>,
    section: &'static str,
    known: &'static [&'static str],
    report: &mut Report,
) -> Vec<Declaration<'a>> {
    fields.members(section, report, |key, node, report| {
        let mut declaration = Declaration {
            name: Name::of_key(key, node),
            value: None,
            std: None,
            unit: None,
            doc: String::new(),
        };
        if node.is_scalar() {
            declaration.value = node.scalar(report);
            return Some(declaration);
        }
        let fields = node.fields(known, report)?;
        declaration.value = fields.scalar("value", report);
        declaration.std = fields.scalar("std", report);
        declaration.unit = fields.name("unit", report);
        declaration.doc = fields.text_or_empty("doc", report);
        Some(declaration)
    })
}

fn read_base<'a>(fields: &Fields<'a>, report: &mut Report) -> BaseFile<'a> {
    let fixed = BaseFile { kind: Base::Fixed, body: None };
    let Some(node) = fields.get("base") else { return fixed };
    if node.is_text() {
        return BaseFile { kind: node.word(&BASES, report).unwrap_or(Base::Fixed), body: None };
    }
    let Some(inner) = node.fields(&["type", "body"], report) else { return fixed };
    let kind = inner.required_word("type", &BASES, report);
    BaseFile { kind, body: inner.get("body").and_then(|node| read_body(node, report)) }
}

fn read_link<'a>(node: Node<'a>, report: &mut Report) -> Option<LinkFile<'a>> {
    let fields = node.fields(&["name", "parent", "joint", "limits", "body"], report)?;
    Some(LinkFile {
        at: fields.at(),
        name: fields.required_name("name", report),
        parent: fields.name("parent", report),
        joint: read_joint(&fields, report),
        limits: fields.get("limits").and_then(|node| read_limits(node, report)).unwrap_or_default(),
        body: fields.get("body").and_then(|node| read_body(node, report)),
    })
}

fn read_joint<'a>(link: &Fields<'a>, report: &mut Report) -> JointFile<'a> {
    const KEYS: &[&str] = &["type", "a", "alpha", "d", "theta", "spring", "damping"];
    let mut joint = JointFile {
        kind: JointKind::Revolute,
        row: [None, None, None, None],
        spring: None,
        damping: None,
        at: link.at(),
    };
    let Some(node) = link.require("joint", report) else { return joint };
    let Some(fields) = node.fields(KEYS, report) else { return joint };
    joint.at = node.at();
    joint.kind = fields.required_word("type", &JOINT_KINDS, report);
    joint.row = ["a", "alpha", "d", "theta"].map(|key| fields.scalar(key, report));
    joint.spring = fields.get("spring").and_then(|node| {
        let spring = node.fields(&["stiffness", "angle"], report)?;
        Some([spring.required_entry("stiffness", report), spring.entry("angle", report)])
    });
    joint.damping = fields.entry("damping", report);
    joint
}

fn read_limits<'a>(node: Node<'a>, report: &mut Report) -> Option<LimitsFile<'a>> {
    let fields = node.fields(&["position", "velocity", "acceleration", "torque"], report)?;
    let torque = fields.get("torque").and_then(|node| {
        if node.is_scalar() {
            node.scalar(report).map(TorqueFile::Symmetric)
        } else {
            node.scalars(report).map(TorqueFile::Range)
        }
    });
    Some(LimitsFile {
        position: fields.get("position").and_then(|node| node.scalars(report)),
        velocity: fields.scalar("velocity", report),
        acceleration: fields.scalar("acceleration", report),
        torque,
        at: Some(node.at()),
    })
}

fn read_body<'a>(node: Node<'a>, report: &mut Report) -> Option<BodyFile<'a>> {
    const KEYS: &[&str] = &["mass", "com", "inertia", "about", "accept_triangle_violation"];
    const TENSOR: &[&str] = &["xx", "yy", "zz", "xy", "xz", "yz"];
    let fields = node.fields(KEYS, report)?;
    let mass = fields.entry("mass", report);
    let [x, y, z] = match fields.get("com") {
        Some(node) => node.entries(report).map_or([None, None, None], |c| c.map(Some)),
        None => [None, None, None],
    };
    let about = fields.word("about", &ABOUT, report);
    let mut tensor: [Option<Entry<'a>>; 6] = Default::default();
    if let Some(node) = fields.get("inertia") {
        fields.require("about", report);
        if let Some(inertia) = node.fields(TENSOR, report) {
            tensor = std::array::from_fn(|entry| inertia.entry(TENSOR[entry], report));
        }
    }
    let [xx, yy, zz, xy, xz, yz] = tensor;
    let accepted = fields.name("accept_triangle_violation", report);
    Some(BodyFile {
        entries: [mass, x, y, z, xx, yy, zz, xy, xz, yz],
        about: about.unwrap_or(About::Com),
        violation: accepted.map_or(Violation::Refused, |reason| Violation::Accepted(reason.at)),
        at: node.at(),
    })
}

fn read_drive<'a>(link: &'a str, node: Node<'a>, report: &mut Report) -> Option<DriveFile<'a>> {
    const KEYS: &[&str] = &[
        "gear_ratio",
        "rotor_inertia",
        "viscous",
        "coulomb",
        "offset",
        "series_elastic",
        "return_spring",
    ];
    let fields = node.fields(KEYS, report)?;
    let series_elastic = fields.get("series_elastic").and_then(|node| {
        const KEYS: &[&str] = &["stiffness", "motor_radius", "load_radius"];
        let spring = node.fields(KEYS, report)?;
        Some(std::array::from_fn(|entry| spring.required_entry(KEYS[entry], report)))
    });
    let return_spring = fields.get("return_spring").and_then(|node| {
        let spring = node.fields(&["stiffness", "angle", "side"], report)?;
        let side = spring.word("side", &SIDES, report).unwrap_or(Side::Above);
        let stiffness = spring.required_entry("stiffness", report);
        Some(([stiffness, spring.entry("angle", report)], side))
    });
    Some(DriveFile {
        link: Name::of_key(link, node),
        gear_ratio: fields.entry("gear_ratio", report),
        rotor_inertia: fields.entry("rotor_inertia", report),
        viscous: fields.entry("viscous", report),
        coulomb: fields.entry("coulomb", report),
        offset: fields.entry("offset", report),
        series_elastic,
        return_spring,
    })
}

/// A value, or an object of a value and its standard deviation.
fn value_with_std<'a>(
    node: Node<'a>,
    report: &mut Report,
) -> Option<(Scalar<'a>, Option<Scalar<'a>>)> {
    if !node.is_object() {
        return Some((node.scalar(report)?, None));
    }
    let fields = node.fields(&["value", "std"], report)?;
    let value = fields.require("value", report)?;
    Some((value.scalar(report)?, fields.scalar("std", report)))
}

fn read_effect<'a>(node: Node<'a>, report: &mut Report) -> Option<EffectFile<'a>> {
    let fields = node.fields(&["effect", "at", "parameters"], report)?;
    let (place, mut side) = (node.at(), None);
    let at = fields.require("at", report).map_or(PlaceFile::Model, |node| {
        if node.is_text() {
            let _ = node.word(&MODEL, report);
            return PlaceFile::Model;
        }
        let place = node.fields(&["link", "second", "contact", "side"], report);
        let Some(place) = place else { return PlaceFile::Model };
        side = place.word("side", &SPRING_SIDES, report);
        if place.get("link").is_some() && place.get("contact").is_some() {
            report.push(node.at(), Cause::TwoPlaces);
        }
        match place.name("contact", report) {
            Some(contact) => PlaceFile::Contact(contact),
            None => {
                let link = place.required_name("link", report);
                match place.name("second", report) {
                    Some(second) => PlaceFile::Pair(link, second),
                    None => PlaceFile::Link(link),
                }
            }
        }
    });
    Some(EffectFile {
        place,
        effect: fields.required_name("effect", report).text.into_owned(),
        at,
        side,
        parameters: fields.members("parameters", report, |key, node, report| {
            let (value, std) = value_with_std(node, report)?;
            Some((key.to_owned(), value, std))
        }),
    })
}
