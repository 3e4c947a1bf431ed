//! Finds the rows of a table by their content: open addressing over row numbers, without a copy of
//! the rows.
//!
//! Graphs of long chains have tens of millions of nodes. A map from nodes to handles would store
//! each node twice; here a place has four bytes for the row and four of the hash, which tell most
//! other rows without a look at the table.

use rustc_hash::FxHasher;
use std::hash::{Hash, Hasher};

/// Places of a new table.
const FIRST: usize = 64;

/// A place without a row.
const FREE: u32 = u32::MAX;

#[derive(Clone, Debug)]
pub(super) struct RowTable {
    /// Hash and row; as many as a power of 2, at most two thirds of them taken.
    places: Vec<(u32, u32)>,
    len: usize,
}

/// Where the number of a row is to be stored that was not found.
#[derive(Clone, Copy)]
pub(super) struct Vacancy {
    hash: u32,
    place: usize,
}

impl RowTable {
    pub(super) fn new() -> Self {
        Self { places: vec![(0, FREE); FIRST], len: 0 }
    }

    /// The row of this content, told by `is_same`; or where its number is to be stored.
    pub(super) fn find(
        &self,
        content: &impl Hash,
        is_same: impl Fn(usize) -> bool,
    ) -> Result<usize, Vacancy> {
        let hash = hash_of(content);
        let mut place = self.first_place(hash);
        loop {
            let (other, row) = self.places[place];
            if row == FREE {
                return Err(Vacancy { hash, place });
            }
            if other == hash && is_same(row as usize) {
                return Ok(row as usize);
            }
            place = (place + 1) & (self.places.len() - 1);
        }
    }

    /// Stores the number of a row that was just not found.
    pub(super) fn insert(&mut self, Vacancy { hash, place }: Vacancy, row: usize) {
        let row = u32::try_from(row).expect("fewer than 2^32 rows");
        self.places[place] = (hash, row);
        self.len += 1;
        if 3 * self.len > 2 * self.places.len() {
            self.grow();
        }
    }

    fn first_place(&self, hash: u32) -> usize {
        hash as usize & (self.places.len() - 1)
    }

    fn grow(&mut self) {
        let larger = vec![(0, FREE); 2 * self.places.len()];
        for (hash, row) in std::mem::replace(&mut self.places, larger) {
            if row == FREE {
                continue;
            }
            let mut place = self.first_place(hash);
            while self.places[place].1 != FREE {
                place = (place + 1) & (self.places.len() - 1);
            }
            self.places[place] = (hash, row);
        }
    }
}

/// Both halves of the hash in one: each alone has bits that few bits of the content have come to.
fn hash_of(content: &impl Hash) -> u32 {
    let mut hasher = FxHasher::default();
    content.hash(&mut hasher);
    let hash = hasher.finish();
    (hash ^ (hash >> 32)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_found_where_they_were_stored_as_the_table_grows() {
        let (mut table, mut rows) = (RowTable::new(), Vec::new());
        let content = |index: usize| (7_u32, 16 * index);
        for index in 0..10_000 {
            let found = table.find(&content(index), |row| rows[row] == content(index));
            let Err(vacancy) = found else { panic!("{index} is new") };
            table.insert(vacancy, rows.len());
            rows.push(content(index));
            assert!(3 * table.len <= 2 * table.places.len());
        }
        for index in 0..10_000 {
            let found = table.find(&content(index), |row| rows[row] == content(index));
            assert_eq!(found.ok(), Some(index));
        }
        assert!(table.find(&(8_u32, 0_usize), |row| rows[row] == (8, 0)).is_err());
    }
}
