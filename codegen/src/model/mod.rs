//! Robot models: a file is read, checked, and becomes a [`Robot`] that cannot be wrong.

mod parameter;
mod robot;
mod tree;
mod unit;

pub use parameter::{BodyEntry, JointEntry, Parameter, ParameterId, Role};
pub use robot::{
    About, AddedEffect, Base, Body, Contact, ContactId, Convention, Drive, EffectPlace, Ground,
    Joint, JointKind, JointSpring, JointVariables, Limits, Link, LinkId, ReturnSpring, Robot,
    SeriesElastic, Side, Terms, TorqueSide,
};
pub use tree::Tree;
pub use unit::{Dimension, Unit, UnitError};
