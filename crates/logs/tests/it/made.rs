//! Files for tests: MCAP record by record as the format's specification has it, CDR as that of OMG
//! has it, both by hand.

use denavit_logs::{Error, FileFault, Found, Log, Opening, Table, open};
use std::io::Write;
use tempfile::NamedTempFile;

const MAGIC: &[u8] = b"\x89MCAP0\r\n";

pub(crate) const JOINT_STATE: &str = "std_msgs/Header header\n\nstring[] name\nfloat64[] position\n\
    float64[] velocity\nfloat64[] effort\n\
    ================================================================================\n\
    MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n\
    ================================================================================\n\
    MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";

/// Bytes of CDR, each value at a multiple of its size.
#[derive(Default)]
pub(crate) struct Cdr {
    bytes: Vec<u8>,
    is_big: bool,
}

impl Cdr {
    pub(crate) fn new(is_big: bool) -> Self {
        Self { bytes: Vec::new(), is_big }
    }

    fn put<const N: usize>(mut self, little: [u8; N]) -> Self {
        while !self.bytes.len().is_multiple_of(N) {
            self.bytes.push(0);
        }
        let mut value = little;
        if self.is_big {
            value.reverse();
        }
        self.bytes.extend(value);
        self
    }

    pub(crate) fn word(self, value: u32) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn text(self, text: &str) -> Self {
        let mut with = self.word(text.len() as u32 + 1);
        with.bytes.extend(text.as_bytes());
        with.bytes.push(0);
        with
    }

    pub(crate) fn names(self, names: &[&str]) -> Self {
        names.iter().fold(self.word(names.len() as u32), |cdr, name| cdr.text(name))
    }

    pub(crate) fn number(self, value: f64) -> Self {
        self.put(value.to_le_bytes())
    }

    pub(crate) fn numbers(self, values: &[f64]) -> Self {
        values.iter().fold(self.word(values.len() as u32), |cdr, value| cdr.number(*value))
    }

    pub(crate) fn header(self, time_ns: u64) -> Self {
        let (seconds, rest) = (time_ns / 1_000_000_000, time_ns % 1_000_000_000);
        self.word(seconds as u32).word(rest as u32).text("")
    }

    pub(crate) fn bytes(self) -> Vec<u8> {
        let head = [0, u8::from(!self.is_big), 0, 0];
        [&head[..], &self.bytes].concat()
    }
}

/// A message of joints.
pub(crate) fn joint_state(time_ns: u64, names: &[&str], signals: [&[f64]; 3]) -> Vec<u8> {
    let start = Cdr::new(false).header(time_ns).names(names);
    signals.iter().fold(start, |cdr, values| cdr.numbers(values)).bytes()
}

fn text(text: &str) -> Vec<u8> {
    [&(text.len() as u32).to_le_bytes()[..], text.as_bytes()].concat()
}

pub(crate) fn record(opcode: u8, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &(body.len() as u64).to_le_bytes(), body].concat()
}

/// An MCAP file.
#[derive(Clone, Default)]
pub(crate) struct Mcap {
    /// Schemas and channels.
    pub(crate) described: Vec<u8>,
    pub(crate) messages: Vec<u8>,
    topics: u16,
}

impl Mcap {
    pub(crate) fn topic(&mut self, topic: &str, kind: &str, definition: &str) -> u16 {
        self.topic_as(topic, kind, "ros2msg", definition, "cdr")
    }

    pub(crate) fn topic_as(
        &mut self,
        topic: &str,
        kind: &str,
        language: &str,
        definition: &str,
        encoding: &str,
    ) -> u16 {
        self.topics += 1;
        let id = self.topics.to_le_bytes();
        let schema = [&id[..], &text(kind), &text(language), &text(definition)].concat();
        self.described.extend(record(3, &schema));
        let no_metadata = [0; 4];
        let channel = [&id[..], &id, &text(topic), &text(encoding), &no_metadata].concat();
        self.described.extend(record(4, &channel));
        self.topics
    }

    pub(crate) fn joints(&mut self, topic: &str) -> u16 {
        self.topic(topic, "sensor_msgs/msg/JointState", JOINT_STATE)
    }

    pub(crate) fn message(&mut self, channel: u16, recorded_ns: u64, data: &[u8]) {
        let time = recorded_ns.to_le_bytes();
        let body = [&channel.to_le_bytes()[..], &[0; 4], &time, &time, data].concat();
        self.messages.extend(record(5, &body));
    }

    /// The file without chunks.
    pub(crate) fn plain(&self) -> Vec<u8> {
        Self::around(&[&self.described[..], &self.messages].concat())
    }

    /// The file with one chunk.
    pub(crate) fn chunked(&self, compression: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
        let records = [&self.described[..], &self.messages].concat();
        Self::around(&chunk(&records, compression, pack))
    }

    pub(crate) fn around(records: &[u8]) -> Vec<u8> {
        let head = record(1, &[text("ros2"), text("by hand")].concat());
        let end = [record(15, &[0; 4]), record(2, &[0; 20])].concat();
        [MAGIC, &head, records, &end, MAGIC].concat()
    }
}

pub(crate) fn chunk(records: &[u8], compression: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let packed = pack(records);
    let length = (records.len() as u64).to_le_bytes();
    let sum = crc32fast::hash(records).to_le_bytes();
    let body = [
        &[0; 16][..],
        &length,
        &sum,
        &text(compression),
        &(packed.len() as u64).to_le_bytes(),
        &packed,
    ];
    record(6, &body.concat())
}

/// Opens what is in a file.
pub(crate) fn opened(bytes: &[u8], how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    let mut file = NamedTempFile::new().expect("a file");
    file.write_all(bytes).expect("written");
    open(file.path(), None, how).map_err(Error::into_faults)
}

/// Columns by the names that the project has for them; the rows are those of the second.
pub(crate) fn columns(log: Log<'_>, names: &[&str]) -> Result<Table, Vec<FileFault>> {
    let place = |name: &&str| match log.find(name) {
        Found::At(place) => place,
        other => panic!("{name}: {other:?} in {:?}", log.columns),
    };
    let places: Vec<usize> = names.iter().map(place).collect();
    let clocks = [places[1]];
    log.read(&places, &clocks).map_err(Error::into_faults)
}

pub(crate) fn read(bytes: &[u8], names: &[&str]) -> Table {
    let log = opened(bytes, &Opening::default()).expect("a log");
    columns(log, names).expect("rows")
}
