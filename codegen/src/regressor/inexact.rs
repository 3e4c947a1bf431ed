//! Which entry of a model has no exact form, where the relations of its columns need one.

use crate::expr::{Dag, ExprId, text};
use crate::fundamental::{CanonicalError, canonical_generic};
use crate::model::Robot;
use std::fmt;

/// An entry of a model that is known, and has no exact form.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct InexactEntry {
    /// JSON pointer of the entry in the model's file, as `/links/1/joint/a`.
    pub pointer: String,
    /// The link that has it; none for gravity.
    pub link: Option<String>,
    /// What it is called there: `a`, `alpha`, ..
    pub name: String,
    /// What it says.
    pub text: String,
}

impl fmt::Display for InexactEntry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {} = {}", self.pointer, self.name, self.text)?;
        match &self.link {
            Some(link) => write!(f, " of link `{link}`"),
            None => Ok(()),
        }
    }
}

/// The first entry of the geometry that has no exact form, for this reason.
pub(super) fn find(robot: &Robot, reason: CanonicalError) -> Option<InexactEntry> {
    let mut dag = robot.dag.clone();
    let mut is_culprit =
        |expr: ExprId| canonical_generic(&mut dag, &[expr]).is_err_and(|error| error == reason);
    for (axis, &component) in robot.gravity.iter().enumerate() {
        if is_culprit(component) {
            let name = format!("g_{}", ["x", "y", "z"][axis]);
            let (pointer, link) = (format!("/gravity/{axis}"), None);
            return Some(InexactEntry { pointer, link, name, text: shown(&robot.dag, component) });
        }
    }
    for (id, link) in robot.links.iter() {
        let Some(pointer) = robot.pointer(id) else { continue };
        let joint = &link.joint;
        let row = [("a", joint.a), ("alpha", joint.alpha), ("d", joint.d), ("theta", joint.theta)];
        if let Some(&(key, expr)) = row.iter().find(|&&(_, expr)| is_culprit(expr)) {
            return Some(InexactEntry {
                pointer: format!("{pointer}/joint/{key}"),
                link: Some(link.name.clone()),
                name: key.to_owned(),
                text: shown(&robot.dag, expr),
            });
        }
    }
    None
}

/// The beginning of what the model says: a message must stay readable.
fn shown(dag: &Dag, expr: ExprId) -> String {
    const MOST: usize = 60;
    let text = text::print(dag, expr);
    match text.char_indices().nth(MOST) {
        Some((end, _)) => format!("{}...", &text[..end]),
        None => text,
    }
}
