//! An open log: what it says of itself and which columns it has. Values are read when it is known
//! which of them are wanted.

use super::error::Error;
use super::fault::FileFault;
use super::table::Table;
use std::fmt;

/// A column of a log.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Column {
    /// Its name: in a table that of the file, of a message `TOPIC/JOINT/FIELD`.
    pub name: String,
    /// What the project calls such a column, if it is one that it knows.
    pub known: Option<Known>,
}

/// The project's name of a column, as `q_knee`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// The name.
    pub name: String,
    /// Of columns with one name that of the lowest rank is taken.
    pub rank: u8,
}

/// Where a name is found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Found {
    /// In one column.
    At(usize),
    /// In several columns; holds their names.
    Several(Vec<String>),
    /// Nowhere.
    Nowhere,
}

/// What has rows that can be read once.
pub(crate) trait Rows {
    /// Reads the columns of `places`. Where columns have clocks of their own, rows are those of
    /// one of the columns `clocks`, which are places too.
    fn read(self: Box<Self>, places: &[usize], clocks: &[usize]) -> Result<Table, Vec<FileFault>>;

    /// Reads the columns of `places`, some rows at a time.
    fn batches<'a>(self: Box<Self>, _: &[usize]) -> Result<Tables<'a>, Vec<FileFault>>
    where
        Self: 'a,
    {
        Err(vec![FileFault::NotInBatches])
    }
}

/// Rows of a log, some at a time, in their order.
pub type Batches<'a> = Box<dyn Iterator<Item = Result<Table, Error>> + 'a>;

/// The same, as formats have them.
pub(crate) type Tables<'a> = Box<dyn Iterator<Item = Result<Table, Vec<FileFault>>> + 'a>;

/// A log that is open.
pub struct Log<'a> {
    /// Name and value of what the log says of itself.
    pub header: Vec<(String, String)>,
    /// The columns.
    pub columns: Vec<Column>,
    /// What was found when the log was opened.
    pub(crate) rows: Box<dyn Rows + 'a>,
}

impl fmt::Debug for Log<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Log").field("header", &self.header).field("columns", &self.columns).finish()
    }
}

impl<'a> Log<'a> {
    /// Reads the columns of `places`, in this order, some rows at a time, so that a log may be
    /// larger than the memory. Places of rows are those in their batch.
    ///
    /// # Errors
    /// The format has no order of rows in its file, as messages have not, or a column no numbers.
    pub fn batches(self, places: &[usize]) -> Result<Batches<'a>, Error> {
        let tables = self.rows.batches(places)?;
        Ok(Box::new(tables.map(|table| Ok(table?))))
    }

    /// Reads the columns of `places`, in this order. Where columns have clocks of their own, as
    /// topics do, rows are those of the topic of one of `clocks`, places too: of the topic with the
    /// most of them.
    ///
    /// # Errors
    /// All that is wrong with the file.
    pub fn read(self, places: &[usize], clocks: &[usize]) -> Result<Table, Error> {
        Ok(self.rows.read(places, clocks)?)
    }

    /// The column of a name: of that very name; one that the project calls so; or one whose name
    /// differs in characters alone that models' names cannot have.
    pub fn find(&self, name: &str) -> Found {
        let named = |is: &dyn Fn(&Column) -> bool| -> Vec<usize> {
            (0..self.columns.len()).filter(|&place| is(&self.columns[place])).collect()
        };
        let known = |is: &dyn Fn(&str) -> bool| {
            let mut all = named(&|column| column.known.as_ref().is_some_and(|one| is(&one.name)));
            let rank = |place: usize| self.columns[place].known.as_ref().map_or(0, |one| one.rank);
            let least = all.iter().map(|place| rank(*place)).min();
            all.retain(|place| Some(rank(*place)) == least);
            all
        };
        let found = [
            named(&|column| column.name == name),
            known(&|one| one == name),
            known(&|one| is_alike(one, name)),
            named(&|column| is_address(&column.name) && is_alike(&column.name, name)),
        ];
        match found.into_iter().find(|places| !places.is_empty()).as_deref() {
            None => Found::Nowhere,
            Some([place]) => Found::At(*place),
            Some(places) => Found::Several(
                places.iter().map(|&place| self.columns[place].name.clone()).collect(),
            ),
        }
    }
}

/// Whether a name is that of a message's field, not one of a table.
fn is_address(name: &str) -> bool {
    name.starts_with('/')
}

/// Whether two names differ in characters alone that models' names cannot have.
fn is_alike(one: &str, other: &str) -> bool {
    let plain = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
    one.chars().map(plain).eq(other.chars().map(plain))
}
