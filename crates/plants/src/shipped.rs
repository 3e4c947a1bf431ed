//! The robots and equations that denavit ships: their files, as part of the library.

/// A model file, or a file of equations, that is part of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShippedModel {
    /// The name; the file is `models/NAME.json`, or in `equations`, `bodies`, `trajectories`,
    /// `controllers`, `scenarios` or `gaits` there.
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
    "emps",
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
    "tulip_leg_table34",
    "tulip_one_torso",
];

/// Every shipped file of equations, by name.
pub const EQUATIONS: &[ShippedModel] = &shipped!["models/equations": "double_pendulum_drives"];

/// Bodies of the shipped scenarios, by name: a ball, a rod, passive walkers.
pub const BODIES: &[ShippedModel] = &shipped!["models/bodies":
    "ball",
    "block",
    "compass",
    "rimless_wheel",
    "rod",
    "slope",
];

/// Every shipped trajectory, by name.
pub const TRAJECTORIES: &[ShippedModel] = &shipped!["models/trajectories":
    "tulip_leg_elastic_excitation",
    "tulip_leg_excitation",
];

/// Every shipped controller, by name.
pub const CONTROLLERS: &[ShippedModel] = &shipped!["models/controllers": "emps", "tulip_leg"];

/// Every shipped scenario, by name.
pub const SCENARIOS: &[ShippedModel] = &shipped!["models/scenarios":
    "bouncing_ball",
    "compass_gait",
    "cradle",
    "double_pendulum",
    "falling_rod",
    "planar_biped_capture_step",
    "planar_biped_dropped",
    "planar_biped_hopping",
    "planar_biped_landing",
    "planar_biped_limit_cycle_gait",
    "planar_biped_lunge",
    "planar_biped_pushed",
    "planar_biped_start_stop",
    "planar_biped_switched_off",
    "planar_biped_trunk_swing",
    "planar_biped_zmp_gait",
    "rocking_block",
    "sliding_block",
    "tulip_leg_elastic_identification",
    "tulip_leg_identification",
    "tulip_leg_tracking",
    "tulip_pushed",
    "tulip_standing",
    "tulip_step",
];

/// Every shipped gait that is to be designed, by name.
pub const GAITS: &[ShippedModel] = &shipped!["models/gaits":
    "planar_biped_fast_limit_cycle",
    "planar_biped_inverted_pendulum",
    "planar_biped_limit_cycle",
    "planar_biped_primitives",
    "planar_biped_start_stop",
    "tulip_turn",
    "tulip_walk",
];

/// The shipped model of that name.
pub fn find(name: &str) -> Option<&'static ShippedModel> {
    MODELS.iter().find(|model| model.name == name)
}

/// The shipped equations of that name.
pub fn find_equations(name: &str) -> Option<&'static ShippedModel> {
    EQUATIONS.iter().find(|equations| equations.name == name)
}

/// The shipped body of that name.
pub fn find_body(name: &str) -> Option<&'static ShippedModel> {
    BODIES.iter().find(|body| body.name == name)
}

/// The shipped trajectory of that name.
pub fn find_trajectory(name: &str) -> Option<&'static ShippedModel> {
    TRAJECTORIES.iter().find(|trajectory| trajectory.name == name)
}

/// The shipped controller of that name.
pub fn find_controller(name: &str) -> Option<&'static ShippedModel> {
    CONTROLLERS.iter().find(|controller| controller.name == name)
}

/// What a scenario can refer to by a name: a model, a body, a trajectory.
pub fn find_referred(name: &str) -> Option<&'static ShippedModel> {
    find(name).or_else(|| find_body(name)).or_else(|| find_trajectory(name))
}

/// The shipped scenario of that name.
pub fn find_scenario(name: &str) -> Option<&'static ShippedModel> {
    SCENARIOS.iter().find(|scenario| scenario.name == name)
}

/// The shipped gait of that name.
pub fn find_gait(name: &str) -> Option<&'static ShippedModel> {
    GAITS.iter().find(|gait| gait.name == name)
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
        assert_eq!(names(BODIES), stems("models/bodies"));
        assert_eq!(names(SCENARIOS), stems("models/scenarios"));
        assert_eq!(names(TRAJECTORIES), stems("models/trajectories"));
        assert_eq!(names(CONTROLLERS), stems("models/controllers"));
        assert_eq!(names(GAITS), stems("models/gaits"));
        assert!(names(MODELS).is_disjoint(&names(EQUATIONS)));
        assert!(names(MODELS).is_disjoint(&names(BODIES)));
        assert!(names(TRAJECTORIES).is_disjoint(&names(BODIES)));
        assert!(names(TRAJECTORIES).is_disjoint(&names(MODELS)));
    }
}
