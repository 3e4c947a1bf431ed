//! The modules that `build.rs` made of the models.

/// Dynamics of the humanoid TUlip: floating base, 18 degrees of freedom. Made of
/// `models/tulip.json`.
pub mod tulip {
    include!(concat!(env!("OUT_DIR"), "/tulip_dynamics.rs"));
}

/// Dynamics of the arm PUMA 560. Made of `models/puma560.json`.
pub mod puma560 {
    include!(concat!(env!("OUT_DIR"), "/puma560_dynamics.rs"));
}

/// Dynamics of a biped of seven links in a plane: what a simulation needs of it. Made of
/// `models/planar_biped.json`.
pub mod planar_biped {
    include!(concat!(env!("OUT_DIR"), "/planar_biped_dynamics.rs"));
}
