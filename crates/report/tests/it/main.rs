//! Pages.

mod effects_page;
mod page;
