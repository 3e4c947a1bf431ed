//! Typed `u32` handles and the dense tables that they index.
//!
//! A graph of handles needs no reference counting, can be copied by copying tables, and is ordered
//! as it was built: an operand always has a smaller handle than the node that uses it.

use std::marker::PhantomData;

/// A typed index into a [`PrimaryMap`].
pub trait Handle: Copy + Eq + Ord {
    /// The handle of row `index`. Panics past `u32::MAX` rows: no model comes near.
    fn from_index(index: usize) -> Self;
    /// The row that the handle names.
    fn index(self) -> usize;
}

/// Declares a handle type that prints as its prefix and index (`e42`).
#[macro_export]
macro_rules! handle {
    ($(#[$doc:meta])* $visibility:vis $name:ident, $prefix:literal) => {
        $(#[$doc])*
        #[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $visibility struct $name(u32);

        impl $crate::arena::Handle for $name {
            fn from_index(index: usize) -> Self {
                Self(u32::try_from(index).expect("more than 2^32 rows in one table"))
            }
            fn index(self) -> usize {
                self.0 as usize
            }
        }

        impl std::fmt::Debug for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                write!(f, concat!($prefix, "{}"), self.0)
            }
        }
    };
}

/// The table that owns the rows and hands out their handles.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PrimaryMap<K, V> {
    rows: Vec<V>,
    key: PhantomData<K>,
}

impl<K, V> Default for PrimaryMap<K, V> {
    fn default() -> Self {
        Self { rows: Vec::new(), key: PhantomData }
    }
}

impl<K: Handle, V> PrimaryMap<K, V> {
    /// An empty table.
    pub fn new() -> Self {
        Self::default()
    }

    /// Appends a row and returns its handle.
    pub fn push(&mut self, value: V) -> K {
        let key = K::from_index(self.rows.len());
        self.rows.push(value);
        key
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The handles, in order.
    pub fn keys(&self) -> impl DoubleEndedIterator<Item = K> + ExactSizeIterator + use<K, V> {
        (0..self.rows.len()).map(K::from_index)
    }

    /// The rows, in order.
    pub fn values(&self) -> std::slice::Iter<'_, V> {
        self.rows.iter()
    }

    /// The rows, in order, to change.
    pub fn values_mut(&mut self) -> std::slice::IterMut<'_, V> {
        self.rows.iter_mut()
    }

    /// Handles with their rows, in order.
    pub fn iter(&self) -> impl DoubleEndedIterator<Item = (K, &V)> + ExactSizeIterator {
        self.rows.iter().enumerate().map(|(index, row)| (K::from_index(index), row))
    }

    /// The row of `key`, if the table has it.
    pub fn get(&self, key: K) -> Option<&V> {
        self.rows.get(key.index())
    }
}

impl<K: Handle, V> std::ops::Index<K> for PrimaryMap<K, V> {
    type Output = V;
    fn index(&self, key: K) -> &V {
        &self.rows[key.index()]
    }
}

impl<K: Handle, V> std::ops::IndexMut<K> for PrimaryMap<K, V> {
    fn index_mut(&mut self, key: K) -> &mut V {
        &mut self.rows[key.index()]
    }
}

impl<K: Handle, V> FromIterator<V> for PrimaryMap<K, V> {
    fn from_iter<I: IntoIterator<Item = V>>(rows: I) -> Self {
        Self { rows: rows.into_iter().collect(), key: PhantomData }
    }
}

/// A dense side table: one value for each row of a primary table, a default where none was set.
#[derive(Clone, Debug)]
pub struct SecondaryMap<K, V> {
    rows: Vec<V>,
    default: V,
    key: PhantomData<K>,
}

impl<K: Handle, V: Clone> SecondaryMap<K, V> {
    /// A side table in which every row of `len` holds `default`.
    pub fn filled(default: V, len: usize) -> Self {
        Self { rows: vec![default.clone(); len], default, key: PhantomData }
    }

    /// Sets the value of `key`, growing the table if it must.
    pub fn set(&mut self, key: K, value: V) {
        if key.index() >= self.rows.len() {
            self.rows.resize(key.index() + 1, self.default.clone());
        }
        self.rows[key.index()] = value;
    }

    /// The values, row by row.
    pub fn values(&self) -> std::slice::Iter<'_, V> {
        self.rows.iter()
    }
}

impl<K: Handle, V> std::ops::Index<K> for SecondaryMap<K, V> {
    type Output = V;
    fn index(&self, key: K) -> &V {
        self.rows.get(key.index()).unwrap_or(&self.default)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    handle!(RowId, "r");

    #[test]
    fn handles_print_with_their_prefix_and_keep_their_order() {
        let mut table = PrimaryMap::<RowId, &str>::new();
        let first = table.push("a");
        let second = table.push("b");
        assert_eq!(format!("{first:?} {second:?}"), "r0 r1");
        assert!(first < second);
        assert_eq!(table[second], "b");
    }

    #[test]
    fn a_side_table_answers_its_default_beyond_its_end() {
        let mut side = SecondaryMap::<RowId, u8>::filled(7, 1);
        side.set(RowId::from_index(3), 9);
        assert_eq!([0, 2, 3, 8].map(|row| side[RowId::from_index(row)]), [7, 7, 9, 7]);
    }
}
