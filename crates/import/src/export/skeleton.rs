//! What stands on what, with frames as other formats have them: on the joint.
//!
//! In the modified convention that is the frame of the row; in the standard one the row's frame is
//! further on, by a and alpha, so bodies and children are moved there.

use super::frame::Frame;
use super::values::Numbers;
use denavit_codegen::model::{Convention, Joint, JointKind, LinkId};

/// A row as a link on its joint.
pub(super) struct Part {
    pub(super) id: LinkId,
    /// The row that it stands on; none for the root.
    pub(super) parent: Option<LinkId>,
    /// Its joint in the frame of the parent's joint.
    pub(super) own: Frame,
    /// The frame of the row in that of its joint.
    pub(super) beyond: Frame,
}

/// A robot as links on joints.
pub(super) struct Skeleton {
    /// The link that everything stands on: a row that floats, or the world.
    pub(super) root: Option<LinkId>,
    pub(super) root_name: String,
    /// The others, parents first.
    pub(super) parts: Vec<Part>,
}

impl Skeleton {
    /// The links of a model.
    pub(super) fn new(numbers: &Numbers) -> Self {
        let robot = &numbers.robot;
        let skipped = robot.base.generated_joints();
        let ids: Vec<LinkId> = robot.links.iter().map(|(id, _)| id).collect();
        let tip = skipped.checked_sub(1).and_then(|last| ids.get(last).copied());
        let own = &ids[skipped.min(ids.len())..];
        let on_base: Vec<LinkId> =
            own.iter().copied().filter(|&id| robot.links[id].parent == tip).collect();
        // what floats is the only row on the base, if it is fixed there
        let root = match on_base[..] {
            [one] if tip.is_some() && robot.links[one].joint.kind == JointKind::Fixed => Some(one),
            _ => tip,
        };
        let root_name = match root.filter(|&root| Some(root) != tip) {
            Some(root) => robot.links[root].name.clone(),
            None => "base".to_owned(),
        };
        let part = |&id: &LinkId| {
            let link = &robot.links[id];
            let (joint, beyond) = frames(numbers, &link.joint);
            let parent = link.parent.filter(|parent| Some(*parent) != tip);
            let before = match parent.filter(|parent| Some(*parent) != root) {
                None => Frame::identity(),
                Some(parent) => frames(numbers, &robot.links[parent].joint).1,
            };
            Part { id, parent: parent.or(root), own: before.times(&joint), beyond }
        };
        let parts = own.iter().filter(|&&id| Some(id) != root).map(part).collect();
        Self { root, root_name, parts }
    }
}

/// The frame of a joint in that of its row's parent, and the frame of the row in the joint's.
fn frames(numbers: &Numbers, joint: &Joint) -> (Frame, Frame) {
    let number = |expr| numbers.number(expr);
    let (a, alpha) = (number(joint.a), number(joint.alpha));
    let (d, theta) = (number(joint.d), number(joint.theta));
    let across = Frame::along(0, a).times(&Frame::about(0, alpha));
    let up = Frame::about(2, theta).times(&Frame::along(2, d));
    match numbers.robot.convention {
        Convention::Modified => {
            (Frame::about(0, alpha).times(&Frame::along(0, a)).times(&up), Frame::identity())
        }
        Convention::Standard => (up, across),
    }
}
