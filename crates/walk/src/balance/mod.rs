//! How a robot keeps its balance along a run: the criteria of thesis 4.2 at every instant.
//!
//! - [`Instant`]: zero moment point, centre of pressure, foot rotation indicator, capture point,
//!   centroidal momentum and support polygon at one time
//! - [`Course`]: these along a run or a log
//! - [`Criterion`], [`Margins`], [`Shares`]: what they come to

mod columns;
mod course;
mod energy;
mod instant;
mod summary;

pub use course::{
    Course, Grid, MOST_INSTANTS, Over, check_walker, course_of_log, course_of_run,
    course_of_scenario, course_on_grid,
};
pub use energy::Energy;
pub use instant::{Instant, Phase};
pub use summary::{Criterion, Margins, Shares};
