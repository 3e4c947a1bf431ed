//! Messages as columns: those of a topic with the same joints are rows of one stream.

use super::convention::known;
use super::decode::{Decoded, END};
use super::join;
use super::layout::Layout;
use crate::fault::FileFault;
use crate::remark::FileRemark;
use crate::source::{Column, Log, Rows};
use crate::table::Table;
use std::collections::BTreeMap;

/// Messages of one topic with the same joints.
#[derive(Clone, Debug, Default)]
pub(super) struct Stream {
    pub(super) topic: String,
    /// Times of measurement and of recording \[ns\], and the number of the message in its file.
    pub(super) stamps_ns: Vec<i64>,
    pub(super) recorded_ns: Vec<i64>,
    pub(super) messages: Vec<usize>,
    /// Signals of the message, then those of joints, joint by joint; empty while all are undefined.
    pub(super) columns: Vec<Vec<f64>>,
    joints: Vec<String>,
}

/// Messages of a topic.
#[derive(Clone, Debug)]
struct Topic {
    name: String,
    kind: String,
    layout: Layout,
    /// The streams by the names in messages, as these have them; the place of each name among the
    /// stream's joints.
    streams: BTreeMap<String, (usize, Vec<usize>)>,
    /// The names of the last message, its stream, and their places.
    last: Option<(String, usize, Vec<usize>)>,
}

/// All messages of a file that have columns.
#[derive(Clone, Debug, Default)]
pub(crate) struct Streams {
    topics: Vec<Topic>,
    all: Vec<Stream>,
    pub(crate) remarks: Vec<FileRemark>,
}

/// What a message lacks: a sentence about it.
pub(crate) type Problem = String;

/// A message as it stands in a file.
pub(crate) struct Received {
    /// Its number in the file, from 1.
    pub(crate) number: usize,
    /// When it was recorded \[ns\].
    pub(crate) recorded_ns: i64,
}

impl Streams {
    /// A topic whose messages have columns: one that is there already, where several publish on it,
    /// or a new one.
    pub(crate) fn add_topic(&mut self, name: &str, kind: &str, layout: Layout) -> usize {
        let is_same =
            |one: &Topic| (one.name.as_str(), &one.kind[..], &one.layout) == (name, kind, &layout);
        if let Some(known) = self.topics.iter().position(is_same) {
            return known;
        }
        let (name, kind) = (name.to_owned(), kind.to_owned());
        self.topics.push(Topic { name, kind, layout, streams: BTreeMap::new(), last: None });
        self.topics.len() - 1
    }

    /// The layout of a topic's messages.
    pub(crate) fn layout(&self, topic: usize) -> &Layout {
        &self.topics[topic].layout
    }

    /// The name of a topic.
    pub(crate) fn topic(&self, topic: usize) -> &str {
        &self.topics[topic].name
    }

    /// Whether there is no message.
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// Adds a message to a topic.
    pub(crate) fn push(
        &mut self,
        topic: usize,
        message: &Decoded,
        received: &Received,
    ) -> Result<(), Problem> {
        let own = &mut self.topics[topic];
        let is_last = own.last.as_ref().is_some_and(|(names, ..)| *names == message.names);
        if !is_last {
            let (stream, places) = match own.streams.get(&message.names) {
                Some(known) => known.clone(),
                None => own.new_names(&message.names, &mut self.all)?,
            };
            own.last = Some((message.names.clone(), stream, places));
        }
        let Some((_, stream, places)) = &own.last else { return Ok(()) };
        for (path, values) in own.layout.eachs.iter().zip(&message.eachs) {
            if !values.is_empty() && values.len() != places.len() {
                let (found, joints) = (values.len(), places.len());
                return Err(format!("has {found} numbers in `{path}`, and {joints} joints"));
            }
        }
        self.all[*stream].push(message, places, received);
        Ok(())
    }

    /// The log of these messages.
    pub(crate) fn into_log(self, header: Vec<(String, String)>) -> Log<'static> {
        let time = Column { name: "t".to_owned(), known: None };
        let (mut columns, mut places) = (vec![time], vec![(0, 0)]);
        for topic in &self.topics {
            let mut own: Vec<usize> = topic.streams.values().map(|(stream, _)| *stream).collect();
            own.sort_unstable();
            own.dedup();
            for stream in own {
                for (at, (column, values)) in topic
                    .columns(&self.all[stream].joints)
                    .zip(&self.all[stream].columns)
                    .enumerate()
                {
                    // what nobody fills in is not there
                    if values.iter().any(|value| !value.is_nan()) {
                        columns.push(column);
                        places.push((stream, at));
                    }
                }
            }
        }
        let Self { all, remarks, .. } = self;
        Log { header, columns, rows: Box::new(Messages { all, places, remarks }) }
    }
}

impl Topic {
    /// The columns of a stream of these joints, in the order of its own.
    fn columns<'a>(&'a self, joints: &'a [String]) -> impl Iterator<Item = Column> + 'a {
        let of = |path: &str, joint: Option<&str>| {
            let joint_path = joint.map_or(String::new(), |joint| format!("{joint}/"));
            let name = format!("{}/{joint_path}{path}", self.name);
            Column { name, known: known(&self.kind, &self.name, path, joint) }
        };
        let ones = self.layout.ones.iter().map(move |path| of(path, None));
        let each = move |path: &'a String| joints.iter().map(move |joint| of(path, Some(joint)));
        ones.chain(self.layout.eachs.iter().flat_map(each))
    }

    /// The stream of names that this topic did not have before: a new one, unless they are those of
    /// another one in another order.
    fn new_names(
        &mut self,
        text: &str,
        all: &mut Vec<Stream>,
    ) -> Result<(usize, Vec<usize>), Problem> {
        let names: Vec<&str> = text.split_terminator(END).collect();
        let mut order: Vec<usize> = (0..names.len()).collect();
        order.sort_by_key(|&place| names[place]);
        if let Some(pair) = order.windows(2).find(|pair| names[pair[0]] == names[pair[1]]) {
            return Err(format!("has two joints `{}`", names[pair[0]]));
        }
        let sorted = |names: &[String]| {
            let mut sorted = names.to_vec();
            sorted.sort_unstable();
            sorted
        };
        let own: Vec<&str> = order.iter().map(|&place| names[place]).collect();
        let mut known = self.streams.values();
        let same = known.find(|(stream, _)| sorted(&all[*stream].joints) == own);
        let entry = match same {
            Some(&(stream, _)) => {
                let joints = &all[stream].joints;
                let place = |name: &&str| joints.iter().position(|joint| joint == name);
                (stream, names.iter().filter_map(place).collect())
            }
            None => {
                all.push(Stream {
                    topic: self.name.clone(),
                    columns: vec![
                        Vec::new();
                        self.layout.ones.len() + self.layout.eachs.len() * names.len()
                    ],
                    joints: names.iter().map(|name| (*name).to_owned()).collect(),
                    ..Stream::default()
                });
                (all.len() - 1, (0..names.len()).collect())
            }
        };
        self.streams.insert(text.to_owned(), entry.clone());
        Ok(entry)
    }
}

impl Stream {
    fn push(&mut self, message: &Decoded, places: &[usize], received: &Received) {
        let row = self.messages.len();
        self.stamps_ns.push(message.stamp_ns());
        self.recorded_ns.push(received.recorded_ns);
        self.messages.push(received.number);
        let (ones, eachs) = self.columns.split_at_mut(message.ones.len());
        let put = |column: &mut Vec<f64>, value: f64| {
            if value.is_nan() && column.is_empty() {
                return;
            }
            column.resize(row, f64::NAN);
            column.push(value);
        };
        for (column, value) in ones.iter_mut().zip(&message.ones) {
            put(column, *value);
        }
        for (signal, values) in message.eachs.iter().enumerate() {
            let own = &mut eachs[signal * places.len()..(signal + 1) * places.len()];
            for (place, value) in places.iter().zip(values) {
                put(&mut own[*place], *value);
            }
        }
    }

    /// The value of a column in a row.
    pub(super) fn value(&self, column: usize, row: usize) -> f64 {
        self.columns[column].get(row).copied().unwrap_or(f64::NAN)
    }
}

/// Messages that wait to be read as rows.
struct Messages {
    all: Vec<Stream>,
    /// Stream and column of each column of the log; those of the time mean nothing.
    places: Vec<(usize, usize)>,
    remarks: Vec<FileRemark>,
}

impl Rows for Messages {
    fn read(self: Box<Self>, places: &[usize], clocks: &[usize]) -> Result<Table, Vec<FileFault>> {
        let of = |place: &usize| (*place != 0).then(|| self.places[*place]);
        let wanted: Vec<Option<(usize, usize)>> = places.iter().map(of).collect();
        let clocks: Vec<usize> = clocks.iter().filter_map(of).map(|(stream, _)| stream).collect();
        let mut table = join::joined(&self.all, &wanted, &clocks)?;
        table.remarks.splice(0..0, self.remarks);
        Ok(table)
    }
}
