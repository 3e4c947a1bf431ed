//! Pages, and documents of what the compiler finds.

mod effects_page;
mod page;
mod symbolic;
