//! Where frames are: positions in decimals, and turns that stay what the file says.

mod angle;
mod quarter;
mod rows;
mod turn;

pub(crate) use angle::{Angle, Made};
pub(crate) use rows::{Row, RowSearch};
pub(crate) use turn::{Pose, Turn, about, direction, is_quarter, matrix, onto_axes, shortest};
