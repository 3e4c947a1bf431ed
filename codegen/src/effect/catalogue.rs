//! The shipped effects.

use super::{Effect, read};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        [$(($name, include_str!(concat!("../../effects/", $name, ".json")))),*]
    };
}

/// Names and texts of the shipped effects, by name: the files of `models/effects`.
pub const SHIPPED: &[(&str, &str)] = &shipped![
    "arctangent_coulomb",
    "asymmetric_coulomb",
    "asymmetric_viscous",
    "backlash",
    "base_tilt",
    "bouc_wen",
    "breakaway",
    "capstan",
    "capstan_posture",
    "cogging",
    "cold_friction",
    "cold_viscous",
    "coriolis",
    "coulomb",
    "coupled_coulomb",
    "coupled_inertia",
    "coupled_viscous",
    "dahl",
    "damper",
    "drive_lag",
    "encoder_eccentricity",
    "gear_efficiency",
    "gravity",
    "hard_stop",
    "hardening_spring",
    "joint_compliance",
    "joint_elasticity",
    "joint_zero",
    "link_parameters",
    "load_dependent_friction",
    "load_friction",
    "load_viscous",
    "lugre",
    "maxwell_slip",
    "one_sided_spring",
    "one_sided_spring_below",
    "payload",
    "payload_point",
    "play",
    "position_delay",
    "posture_friction",
    "posture_viscous",
    "quadratic_drag",
    "rate_lag",
    "rotor_inertia",
    "rotors",
    "shear_thinning",
    "smoothed_coulomb",
    "spring",
    "stiction",
    "stribeck",
    "stribeck_exponential",
    "stribeck_friction",
    "torque_delay",
    "torque_drift",
    "torque_gain",
    "torque_lag",
    "torque_offset",
    "torque_ripple",
    "torque_saturation",
    "transmission_error",
    "viscous",
];

/// The shipped effects, by name.
pub fn catalogue() -> &'static [Effect] {
    static CATALOGUE: OnceLock<Vec<Effect>> = OnceLock::new();
    CATALOGUE.get_or_init(|| {
        let read = |(name, text): &(&str, &str)| {
            let effect = read(name, text.as_bytes());
            effect.unwrap_or_else(|error| panic!("a shipped effect is at fault:\n{error}"))
        };
        SHIPPED.iter().map(read).collect()
    })
}

/// The files of a folder of effects, by name: those that end in `.json`. None if there is no such
/// folder.
pub fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    if !folder.is_dir() {
        return Ok(Vec::new());
    }
    let mut files = Vec::new();
    for entry in folder.read_dir()? {
        let path = entry?.path();
        if path.is_file() && path.extension().is_some_and(|extension| extension == "json") {
            files.push(path);
        }
    }
    files.sort();
    Ok(files)
}

/// The shipped effect of that name.
pub fn find(name: &str) -> Option<&'static Effect> {
    catalogue().iter().find(|effect| effect.name == name)
}
