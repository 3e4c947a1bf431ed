//! Contact problems against closed forms and against solvers of another kind.

mod decisions;
mod impacts;
mod lcp;
mod systems;
