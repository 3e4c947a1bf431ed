//! What a model lacks.

mod alias;
mod elastic;
mod held;
mod laws;
mod motion;
mod on_ground;
mod one_joint;
mod saturation;
mod search;
mod separate;
mod separate_elastic;
mod transmission;
