//! Pages, and documents of what the compiler finds.

mod effects_page;
mod page;
mod run_page;
mod shapes;
mod symbolic;
