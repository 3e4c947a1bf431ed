//! Logs in two sets: those that an answer is from, and those that judge it.

/// Something of both sets of logs: none can be taken for the other one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Split<T> {
    /// Of the logs that are searched or fitted.
    pub train: T,
    /// Of the logs that judge: another motion.
    pub held_out: T,
}

impl<T> Split<T> {
    /// Something else of both sets, of the searched one first.
    pub fn map<U>(self, mut of: impl FnMut(T) -> U) -> Split<U> {
        Split { train: of(self.train), held_out: of(self.held_out) }
    }

    /// The same by reference.
    pub fn each_ref(&self) -> Split<&T> {
        Split { train: &self.train, held_out: &self.held_out }
    }

    /// The searched set, then the judging one, as a list of sets.
    pub fn into_array(self) -> [T; 2] {
        [self.train, self.held_out]
    }
}
