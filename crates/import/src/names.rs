//! Names of a description as names of a model: letters, digits, underscores, one name for one row.

use std::collections::BTreeSet;

/// Longest name of a model.
const MAX_LENGTH: usize = 64;

/// The names that are taken, and those that had to change.
#[derive(Debug, Default)]
pub(crate) struct Names {
    taken: BTreeSet<String>,
    changed: Vec<(String, String)>,
}

impl Names {
    /// A name for a row, as near to the wanted one as it can be. `otherwise` is what a second one
    /// of this name is called besides, as `link`.
    pub(crate) fn take(&mut self, wanted: &str, otherwise: &str) -> String {
        let plain = identifier(wanted);
        let mut name = plain.clone();
        let mut count = 1;
        while self.is_taken(&name) {
            let ending =
                if count == 1 { format!("_{otherwise}") } else { format!("_{otherwise}{count}") };
            let kept: String =
                plain.chars().take(MAX_LENGTH - ending.len().min(MAX_LENGTH)).collect();
            name = format!("{kept}{ending}");
            count += 1;
        }
        self.taken.insert(name.clone());
        if name != wanted {
            self.changed.push((wanted.to_owned(), name.clone()));
        }
        name
    }

    /// A name for a row that no description names.
    pub(crate) fn make(&mut self, wanted: &str) -> String {
        let before = self.changed.len();
        let name = self.take(wanted, "row");
        self.changed.truncate(before);
        name
    }

    /// Names that are not as the file has them, with what they became.
    pub(crate) fn changed(&self) -> &[(String, String)] {
        &self.changed
    }

    fn is_taken(&self, name: &str) -> bool {
        self.taken.contains(name)
            || name == "base"
            || name.starts_with("base_") && is_generated(name)
    }
}

/// Rows that a floating base has.
fn is_generated(name: &str) -> bool {
    ["base_z", "base_x", "base_y", "base_yaw", "base_roll", "base_pitch"].contains(&name)
}

/// The nearest identifier.
pub(crate) fn identifier(text: &str) -> String {
    let part = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    let plain: String = text.chars().map(part).collect();
    let begins = plain.starts_with(|c: char| c.is_ascii_alphabetic());
    let whole = if begins { plain } else { format!("n{plain}") };
    whole.chars().take(MAX_LENGTH).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_identifiers_and_stay_apart() {
        let mut names = Names::default();
        assert_eq!(names.take("l-arm.1", "joint"), "l_arm_1");
        assert_eq!(names.take("l_arm_1", "link"), "l_arm_1_link");
        assert_eq!(names.take("l_arm_1", "link"), "l_arm_1_link2");
        assert_eq!(names.take("2nd", "joint"), "n2nd");
        assert_eq!(names.take("base", "link"), "base_link");
        assert_eq!(names.take(&"x".repeat(80), "link").len(), 64);
        assert_eq!(names.take(&"x".repeat(70), "link").len(), 64);
        assert_eq!(names.take("knee", "joint"), "knee");
        assert_eq!(names.changed().len(), 7);
    }
}
