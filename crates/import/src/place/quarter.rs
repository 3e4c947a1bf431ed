//! The 24 turns that bring axes onto axes.

/// A turn whose columns are signed unit vectors: `e_k` becomes `sign e_axis`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Quarter {
    columns: [(u8, bool); 3],
}

impl Quarter {
    /// No turn.
    pub(crate) const IDENTITY: Self = Self { columns: [(0, false), (1, false), (2, false)] };

    /// Quarter turns about an axis.
    pub(crate) fn about(axis: usize, quarters: i64) -> Self {
        let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
        let mut columns = Self::IDENTITY.columns;
        let (n, l) = (next as u8, last as u8);
        let (to_next, to_last) = match quarters.rem_euclid(4) {
            0 => ((n, false), (l, false)),
            1 => ((l, false), (n, true)),
            2 => ((n, true), (l, true)),
            _ => ((l, true), (n, false)),
        };
        columns[next] = to_next;
        columns[last] = to_last;
        Self { columns }
    }

    /// Where an axis goes, and whether it points the other way there.
    pub(crate) fn of_axis(self, axis: usize) -> (usize, bool) {
        let (to, minus) = self.columns[axis];
        (usize::from(to), minus)
    }

    /// First `other`, then this one.
    pub(crate) fn times(self, other: Self) -> Self {
        let columns = other.columns.map(|(axis, minus)| {
            let (to, flips) = self.columns[usize::from(axis)];
            (to, minus != flips)
        });
        Self { columns }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_a_group() {
        let z = Quarter::about(2, 1);
        assert_eq!(z.of_axis(0), (1, false));
        assert_eq!(z.of_axis(1), (0, true));
        for axis in 0..3 {
            for quarters in 0..4 {
                let turn = Quarter::about(axis, quarters);
                assert_eq!(turn.times(Quarter::about(axis, -quarters)), Quarter::IDENTITY);
                assert_eq!(turn.times(Quarter::about(axis, 1)), Quarter::about(axis, quarters + 1));
            }
        }
        // about y it is z x z^-1
        let about_y = z.times(Quarter::about(0, 1)).times(Quarter::about(2, 3));
        assert_eq!(about_y, Quarter::about(1, 1));
    }
}
