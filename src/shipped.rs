//! The robots that denavit ships: their model files, as part of the library.

/// A model file that is part of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedModel {
    /// The model's name; the file is `models/NAME.json`.
    pub name: &'static str,
    /// The content of the file.
    pub text: &'static str,
}

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        [$(ShippedModel {
            name: $name,
            text: include_str!(concat!("../models/", $name, ".json")),
        }),*]
    };
}

/// Every shipped model, by name.
pub const MODELS: &[ShippedModel] = &shipped![
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

/// The shipped model of that name.
pub fn find(name: &str) -> Option<&'static ShippedModel> {
    MODELS.iter().find(|model| model.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::path::Path;

    #[test]
    fn every_file_of_the_directory_is_shipped() {
        let directory = Path::new(env!("CARGO_MANIFEST_DIR")).join("models");
        let files: BTreeSet<String> = directory
            .read_dir()
            .expect("the directory of the models")
            .map(|entry| entry.expect("an entry").path())
            .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
            .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
            .collect();
        let shipped: BTreeSet<String> = MODELS.iter().map(|model| model.name.to_owned()).collect();
        assert_eq!(shipped, files);
    }
}
