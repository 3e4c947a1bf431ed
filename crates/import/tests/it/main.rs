//! The importer as its users see it: descriptions in, model files out, values back.

mod chains;
mod contacts;
mod evaluated;
mod export;
mod faults;
mod meshes;
mod mjcf;
mod mutated;
mod urdf;
