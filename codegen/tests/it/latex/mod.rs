//! Documents of equations, read back by a reader that knows nothing of the printer.

mod decompositions;
mod documents;
mod reader;
mod walking;
