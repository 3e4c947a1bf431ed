//! What a certificate is about, in words.

use super::certificate::Certificate;
use crate::model::JointEntry;
use std::collections::BTreeSet;
use std::fmt;

/// Parameters that a certificate may be about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ParameterGroup {
    /// Mass properties of bodies.
    Bodies,
    /// Viscous and Coulomb friction.
    Friction,
    /// Reflected rotor inertias.
    Rotor,
    /// Constant torques.
    Offset,
}

impl ParameterGroup {
    /// All of them, in the order of the columns of a link.
    pub const ALL: [Self; 4] = [Self::Bodies, Self::Friction, Self::Rotor, Self::Offset];

    /// The word for it.
    pub const fn as_str(self) -> &'static str {
        match self {
            Self::Bodies => "bodies",
            Self::Friction => "friction",
            Self::Rotor => "rotor",
            Self::Offset => "offset",
        }
    }
}

impl fmt::Display for ParameterGroup {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.as_str())
    }
}

impl Certificate {
    /// What the certificate is about: the groups that have a column. Joint parameters are told by
    /// what was added and by the name of the column, `fv_link`.
    pub fn about(&self) -> Vec<ParameterGroup> {
        let group = |column: &String| {
            let is_of = |word: &str, entries: &[JointEntry]| {
                let prefix = column.split_once('_').map(|(prefix, _)| prefix);
                let is_added = self.with.iter().any(|added| added == word);
                is_added && entries.iter().any(|entry| prefix == Some(entry.prefix()))
            };
            let joints: [(ParameterGroup, &[JointEntry]); 3] = [
                (ParameterGroup::Friction, &[JointEntry::Viscous, JointEntry::Coulomb]),
                (ParameterGroup::Rotor, &[JointEntry::RotorInertia]),
                (ParameterGroup::Offset, &[JointEntry::Offset]),
            ];
            let found = joints.into_iter().find(|(group, list)| is_of(group.as_str(), list));
            found.map_or(ParameterGroup::Bodies, |(group, _)| group)
        };
        let found: BTreeSet<ParameterGroup> = self.columns.iter().map(group).collect();
        found.into_iter().collect()
    }
}
