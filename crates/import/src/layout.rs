//! From a tree to rows: which frames the model has, and by how many rows they are reached.
//!
//! A joint's row ends in a frame whose z is the joint's axis. Where that is also the frame of the
//! link, the link has no other; else a `fixed` row named after the link leads there, and the body
//! stands in it, in the numbers of the description. A child stands on whichever of the two frames
//! it is reached from by fewer rows.

use crate::names::Names;
use crate::place::{Angle, Pose, Row, RowSearch, Turn};
use crate::tree::{Tree, TreeJoint, TreeLink};

/// A row of the model.
#[derive(Debug)]
pub(crate) struct PlacedRow {
    pub(crate) name: String,
    /// The row that it stands on; none for the base.
    pub(crate) parent: Option<String>,
    pub(crate) row: Row,
    /// The link whose joint it is.
    pub(crate) joint_of: Option<usize>,
    /// The link whose body it carries.
    pub(crate) body_of: Option<usize>,
}

/// The rows of a tree, and the names of frames.
#[derive(Debug)]
pub(crate) struct Layout {
    pub(crate) rows: Vec<PlacedRow>,
    /// The row whose frame is that of a link; none for the base.
    pub(crate) frames: Vec<Option<String>>,
    /// The row of a link's joint.
    pub(crate) joints: Vec<Option<String>>,
    /// Names that are not as the file has them, with what they became.
    pub(crate) changed: Vec<(String, String)>,
}

/// A frame from which others can be reached.
struct Start {
    row: Option<String>,
    way: Vec<Pose>,
}

/// A way to a link: rows to its joint, with the turn about the axis, then to its frame.
struct Way {
    start: usize,
    to_joint: Vec<Row>,
    to_link: Vec<Row>,
    back: Vec<Pose>,
}

/// The rows of a tree.
pub(crate) fn layout(tree: &Tree) -> Layout {
    let mut names = Names::default();
    let joint_name = |link: &TreeLink, names: &mut Names| {
        link.joint.as_ref().map(|joint| names.take(&joint.name, "joint"))
    };
    let joints: Vec<Option<String>> =
        tree.links.iter().map(|link| joint_name(link, &mut names)).collect();
    let mut placer = Placer {
        tree,
        names,
        search: RowSearch::default(),
        rows: Vec::new(),
        starts: Vec::new(),
        frames: Vec::new(),
        joints,
    };
    (0..tree.links.len()).for_each(|link| placer.place(link));
    let changed = placer.names.changed().to_vec();
    Layout { rows: placer.rows, frames: placer.frames, joints: placer.joints, changed }
}

struct Placer<'t> {
    tree: &'t Tree,
    names: Names,
    search: RowSearch,
    rows: Vec<PlacedRow>,
    /// For each link the frames from which its children are reached.
    starts: Vec<Vec<Start>>,
    frames: Vec<Option<String>>,
    joints: Vec<Option<String>>,
}

impl Placer<'_> {
    fn place(&mut self, index: usize) {
        let tree = self.tree;
        let link = &tree.links[index];
        match (link.parent, &link.joint) {
            (None, _) => self.root(index, link),
            (Some(parent), None) => self.fixed(index, link, parent),
            (Some(parent), Some(joint)) => self.moving(index, link, joint, parent),
        }
    }

    fn root(&mut self, index: usize, link: &TreeLink) {
        if !self.tree.floats {
            self.starts.push(vec![Start { row: None, way: Vec::new() }]);
            self.frames.push(None);
            return;
        }
        // the end of the generated chain has y down and z to the left
        let row = Row { alpha: Angle::quarter(1), ..Row::nothing() };
        let name = self.names.take(link.name.as_deref().unwrap_or("trunk"), "link");
        self.rows.push(PlacedRow {
            name: name.clone(),
            parent: None,
            row,
            joint_of: None,
            body_of: link.body.as_ref().map(|_| index),
        });
        self.starts.push(vec![Start { row: Some(name.clone()), way: Vec::new() }]);
        self.frames.push(Some(name));
    }

    /// The rows from the frames of a parent along a way: the fewest, and from which frame.
    fn reach(&mut self, parent: usize, way: &[Pose]) -> (usize, Vec<Row>) {
        let mut best: Option<(usize, Vec<Row>)> = None;
        for (at, start) in self.starts[parent].iter().enumerate() {
            let whole: Vec<Pose> = start.way.iter().chain(way).cloned().collect();
            let rows = self.search.rows_along(&whole);
            if best.as_ref().is_none_or(|(_, known)| rows.len() < known.len()) {
                best = Some((at, rows));
            }
        }
        best.unwrap_or_default()
    }

    fn fixed(&mut self, index: usize, link: &TreeLink, parent: usize) {
        let way: Vec<Pose> = link.before.iter().chain(&link.after).cloned().collect();
        let (at, mut rows) = self.reach(parent, &way);
        if rows.is_empty() {
            rows.push(Row::nothing());
        }
        let from = self.starts[parent][at].row.clone();
        let name = self.names.take(link.name.as_deref().unwrap_or("frame"), "link");
        let body_of = link.body.as_ref().map(|_| index);
        self.push_rows(from, rows, &name, None, body_of);
        self.starts.push(vec![Start { row: Some(name.clone()), way: Vec::new() }]);
        self.frames.push(Some(name));
    }

    fn moving(&mut self, index: usize, link: &TreeLink, joint: &TreeJoint, parent: usize) {
        let way = self.way(link, joint, parent);
        let from = self.starts[parent][way.start].row.clone();
        let joint_name = self.joints[index].clone().unwrap_or_default();
        let has_frame = way.to_link.is_empty() || link.name.is_none();
        let body_of = link.body.as_ref().map(|_| index);
        let own = body_of.filter(|_| has_frame);
        self.push_rows(from, way.to_joint, &joint_name, Some(index), own);
        let mut starts = Vec::new();
        if has_frame {
            self.frames.push(Some(joint_name.clone()));
        } else {
            let name = self.names.take(link.name.as_deref().unwrap_or_default(), "link");
            self.push_rows(Some(joint_name.clone()), way.to_link, &name, None, body_of);
            starts.push(Start { row: Some(name.clone()), way: Vec::new() });
            self.frames.push(Some(name));
        }
        starts.push(Start { row: Some(joint_name), way: way.back });
        self.starts.push(starts);
    }

    /// The way to a link with the fewest rows: the frame of a joint may be turned about its axis.
    fn way(&mut self, link: &TreeLink, joint: &TreeJoint, parent: usize) -> Way {
        let mut best: Option<Way> = None;
        for quarters in 0..4 {
            let mut axis = joint.axis.clone();
            if quarters != 0 {
                axis.push(Turn::new(2, Angle::quarter(quarters)));
            }
            let turned = Pose::turned(axis);
            let to_joint: Vec<Pose> = link.before.iter().chain([&turned]).cloned().collect();
            let back: Vec<Pose> = turned.inverse().iter().chain(&link.after).cloned().collect();
            let (start, mut rows) = self.reach(parent, &to_joint);
            if rows.is_empty() {
                rows.push(Row::nothing());
            }
            let to_link = match link.name {
                Some(_) => self.search.rows_along(&back),
                None => Vec::new(),
            };
            let count = |way: &Way| way.to_joint.len() + way.to_link.len();
            let way = Way { start, to_joint: rows, to_link, back };
            if best.as_ref().is_none_or(|known| count(&way) < count(known)) {
                best = Some(way);
            }
        }
        // four were tried
        best.unwrap_or(Way {
            start: 0,
            to_joint: vec![Row::nothing()],
            to_link: Vec::new(),
            back: Vec::new(),
        })
    }

    fn push_rows(
        &mut self,
        from: Option<String>,
        rows: Vec<Row>,
        name: &str,
        joint_of: Option<usize>,
        body_of: Option<usize>,
    ) {
        let last = rows.len().saturating_sub(1);
        let mut parent = from;
        for (at, mut row) in rows.into_iter().enumerate() {
            let own = if at == last {
                name.to_owned()
            } else {
                self.names.make(&format!("{name}_{}", at + 1))
            };
            let moves = joint_of.filter(|_| at == last);
            if let Some(joint) = moves.and_then(|link| self.tree.links[link].joint.as_ref()) {
                row.theta = row.theta.plus(&joint.zero.0);
                row.d += &joint.zero.1;
            }
            let body_of = body_of.filter(|_| at == last);
            self.rows.push(PlacedRow { name: own.clone(), parent, row, joint_of: moves, body_of });
            parent = Some(own);
        }
    }
}
