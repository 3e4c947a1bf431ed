//! Back into descriptions: values into a user's own file, or a whole file from a model.

mod frame;
mod into;
mod skeleton;
mod values;
mod whole_mjcf;
mod whole_urdf;

pub use into::export_into;

use crate::error::Error;
use denavit_codegen::model::{Base, Robot};
use values::Numbers;

/// A description made of a model.
#[derive(Clone, Debug)]
pub struct Exported {
    /// The text of the description.
    pub text: String,
    /// What the description does not say as the model does.
    pub notes: Vec<String>,
}

/// A format of descriptions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// That of ROS.
    Urdf,
    /// That of MuJoCo.
    Mjcf,
}

/// The description of a model.
pub fn export(robot: &Robot, format: Format) -> Result<Exported, Error> {
    if robot.base == Base::PlanarFloating {
        let said = "a description floats in space or not at all: this model floats in a plane";
        return Err(Error::unsaid(said.to_owned()));
    }
    let numbers = Numbers::new(robot)?;
    let (text, notes) = match format {
        Format::Urdf => whole_urdf::urdf(numbers),
        Format::Mjcf => whole_mjcf::mjcf(&numbers),
    };
    Ok(Exported { text, notes })
}
