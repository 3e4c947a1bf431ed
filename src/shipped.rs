//! The robots and equations that denavit ships: their files, as part of the library.

/// A model file, or a file of equations, that is part of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedModel {
    /// The model's name; the file is `models/NAME.json`, or `models/equations/NAME.json`.
    pub name: &'static str,
    /// The content of the file.
    pub text: &'static str,
}

macro_rules! shipped {
    ($folder:literal: $($name:literal),* $(,)?) => {
        [$(ShippedModel {
            name: $name,
            text: include_str!(concat!("../", $folder, "/", $name, ".json")),
        }),*]
    };
}

/// Every shipped model, by name.
pub const MODELS: &[ShippedModel] = &shipped!["models":
    "double_pendulum",
    "iiwa",
    "panda",
    "planar_2r",
    "planar_3r",
    "planar_biped",
    "puma560",
    "rx90",
    "scara",
    "stanford",
    "tulip",
    "tulip_leg",
    "tulip_leg5",
    "tulip_leg6",
    "tulip_one_torso",
];

/// Every shipped file of equations, by name.
pub const EQUATIONS: &[ShippedModel] = &shipped!["models/equations": "double_pendulum_drives"];

/// The shipped model of that name.
pub fn find(name: &str) -> Option<&'static ShippedModel> {
    MODELS.iter().find(|model| model.name == name)
}

/// The shipped equations of that name.
pub fn find_equations(name: &str) -> Option<&'static ShippedModel> {
    EQUATIONS.iter().find(|equations| equations.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    fn stems(folder: &str) -> BTreeSet<String> {
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join(folder)
            .read_dir()
            .expect("the directory is there")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
            .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
            .collect()
    }

    #[test]
    fn every_file_of_the_directories_is_shipped_under_one_name() {
        let names = |list: &[ShippedModel]| -> BTreeSet<String> {
            list.iter().map(|model| model.name.to_owned()).collect()
        };
        assert_eq!(names(MODELS), stems("models"));
        assert_eq!(names(EQUATIONS), stems("models/equations"));
        assert!(names(MODELS).is_disjoint(&names(EQUATIONS)));
    }
}
