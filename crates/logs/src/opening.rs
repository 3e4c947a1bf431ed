//! What is wanted of a log before it is open.

/// How a log is opened.
#[derive(Clone, Debug, Default)]
pub struct Opening {
    /// Of what is cut or corrupt the part before the damage is taken.
    pub accepts_cut: bool,
    /// Names, or beginnings of names, of columns that are asked for by name: of topics that are
    /// not about joints only those are read that one of these begins with.
    pub named: Vec<String>,
}
