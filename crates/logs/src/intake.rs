//! Messages of a file on their way to columns: which topics are read, and by which definition.

use super::fault::FileFault;
use super::message::{Decoded, Definition, Layout, Received, Streams, decode, short_kind, usual};
use super::opening::Opening;
use super::remark::FileRemark;
use super::source::Log;
use super::table::Place;

/// Kinds that are read whether they are asked for or not.
const READ: [&str; 3] = [
    "sensor_msgs/JointState",
    "control_msgs/JointTrajectoryControllerState",
    "geometry_msgs/WrenchStamped",
];

/// A topic as a file describes it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Described<'a> {
    pub(crate) topic: &'a str,
    /// As `sensor_msgs/msg/JointState`.
    pub(crate) kind: &'a str,
    /// How its messages are written, as `cdr`.
    pub(crate) encoding: &'a str,
    /// How its definition is written, as `ros2msg`, and the definition, if the file has it.
    pub(crate) definition: Option<(&'a str, &'a [u8])>,
}

/// What becomes of a topic's messages.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Channel {
    /// Nothing.
    Unread,
    /// They are columns.
    Read(usize),
    /// Which of the usual definitions they have is seen at the first; the place of its topic.
    Unclear(usize),
}

/// All messages of a file, or of files that follow each other.
pub(crate) struct Intake<'a> {
    how: &'a Opening,
    streams: Streams,
    decoded: Decoded,
    header: Vec<(String, String)>,
    /// Topics that were described, with what they are.
    topics: Vec<(String, String)>,
    unread: Vec<(String, String)>,
    /// Topics whose definition is not clear yet.
    unclear: Vec<(String, String)>,
    messages: usize,
    is_damaged: bool,
}

impl<'a> Intake<'a> {
    pub(crate) fn new(how: &'a Opening) -> Self {
        Self {
            how,
            streams: Streams::default(),
            decoded: Decoded::default(),
            header: Vec::new(),
            topics: Vec::new(),
            unread: Vec::new(),
            unclear: Vec::new(),
            messages: 0,
            is_damaged: false,
        }
    }

    /// Adds lines to the header.
    pub(crate) fn say(&mut self, lines: impl Iterator<Item = (String, String)>) {
        self.header.extend(lines);
    }

    /// Whether messages of a topic are asked for.
    fn is_wanted(&self, topic: &str, kind: &str) -> bool {
        let below = format!("{topic}/");
        let is_named = |name: &String| {
            name.starts_with(&below) || (name.starts_with('/') && topic.starts_with(name.as_str()))
        };
        READ.contains(&short_kind(kind).as_str()) || self.how.named.iter().any(is_named)
    }

    /// What becomes of a topic's messages.
    pub(crate) fn describe(&mut self, described: &Described<'_>) -> Channel {
        let Described { topic, kind, encoding, definition } = *described;
        let known = (topic.to_owned(), kind.to_owned());
        if !self.topics.contains(&known) {
            self.topics.push(known);
        }
        if !self.is_wanted(topic, kind) {
            return Channel::Unread;
        }
        match self.layout(kind, encoding, definition) {
            Ok(Some(layout)) if layout.is_empty() => {
                self.leave(topic, "no numbers of joints, and none beside".to_owned())
            }
            Ok(Some(layout)) => Channel::Read(self.streams.add_topic(topic, kind, layout)),
            Ok(None) => {
                self.unclear.push((topic.to_owned(), kind.to_owned()));
                Channel::Unclear(self.unclear.len() - 1)
            }
            Err(why) => self.leave(topic, why),
        }
    }

    fn leave(&mut self, topic: &str, why: String) -> Channel {
        let entry = (topic.to_owned(), why);
        if !self.unread.contains(&entry) {
            self.unread.push(entry);
        }
        Channel::Unread
    }

    /// The layout of messages; none where the file does not define them and others do.
    fn layout(
        &self,
        kind: &str,
        encoding: &str,
        definition: Option<(&str, &[u8])>,
    ) -> Result<Option<Layout>, String> {
        if encoding != "cdr" {
            return Err(format!("its messages are written as `{encoding}`, not as `cdr`"));
        }
        match definition {
            Some(("ros2msg", text)) if !text.is_empty() => {
                Definition::read(kind, text).map(|read| Some(Layout::new(&read)))
            }
            _ if !usual(kind).is_empty() => Ok(None),
            Some((language, text)) if !text.is_empty() => {
                Err(format!("its definition is written in `{language}`, not in `ros2msg`"))
            }
            _ => Err(format!("the file does not say what a {kind} is")),
        }
    }

    /// Takes a message. The answer is whether others are to follow.
    ///
    /// # Errors
    /// It is no message of its kind, and damage is not accepted.
    pub(crate) fn message(
        &mut self,
        channel: &mut Channel,
        recorded_ns: u64,
        bytes: &[u8],
    ) -> Result<bool, FileFault> {
        self.messages += 1;
        let taken = self.take(channel, recorded_ns, bytes);
        match taken {
            Ok(()) => Ok(true),
            Err(why) => {
                self.messages -= 1;
                self.damaged(why).map(|()| false)
            }
        }
    }

    fn take(
        &mut self,
        channel: &mut Channel,
        recorded_ns: u64,
        bytes: &[u8],
    ) -> Result<(), String> {
        if let Channel::Unclear(unclear) = *channel {
            let (topic, kind) = self.unclear[unclear].clone();
            let layout = self.fitting(&kind, bytes);
            let layout = layout.map_err(|why| format!("a message of `{topic}` {why}"))?;
            *channel = Channel::Read(self.streams.add_topic(&topic, &kind, layout));
            self.streams.remarks.push(FileRemark::OwnDefinition { topic, kind });
        }
        let Channel::Read(topic) = *channel else { return Ok(()) };
        let received = Received {
            number: self.messages,
            recorded_ns: i64::try_from(recorded_ns).unwrap_or(i64::MAX),
        };
        let decoded = decode(self.streams.layout(topic), bytes, &mut self.decoded);
        let pushed = decoded.and_then(|()| self.streams.push(topic, &self.decoded, &received));
        pushed.map_err(|why| format!("a message of `{}` {why}", self.streams.topic(topic)))
    }

    /// The first of the usual definitions of a kind that a message fits.
    fn fitting(&mut self, kind: &str, bytes: &[u8]) -> Result<Layout, String> {
        let mut why = String::new();
        for text in usual(kind) {
            let layout = Layout::new(&Definition::read(kind, text.as_bytes())?);
            match decode(&layout, bytes, &mut self.decoded) {
                Ok(()) => return Ok(layout),
                Err(other) => why = other,
            }
        }
        Err(why)
    }

    /// Takes note that a file is damaged behind its last message.
    ///
    /// # Errors
    /// This is not accepted, or nothing is whole.
    pub(crate) fn damaged(&mut self, cause: String) -> Result<(), FileFault> {
        let (at, whole) = (Place::Message(self.messages + 1), self.messages);
        if !self.how.accepts_cut || self.streams.is_empty() {
            return Err(FileFault::Damaged { at, whole, cause });
        }
        self.is_damaged = true;
        self.streams.remarks.push(FileRemark::Damaged { at, whole, cause });
        Ok(())
    }

    /// Whether damage was found, and what is behind it is left out.
    pub(crate) fn is_damaged(&self) -> bool {
        self.is_damaged
    }

    /// The log of all messages.
    pub(crate) fn into_log(mut self) -> Result<Log<'static>, Vec<FileFault>> {
        if !self.unread.is_empty() {
            let topics = std::mem::take(&mut self.unread);
            self.topics.retain(|(topic, _)| topics.iter().all(|(unread, _)| unread != topic));
            self.topics.extend(topics.clone());
            self.streams.remarks.push(FileRemark::Unread { topics });
        }
        if self.streams.is_empty() {
            return Err(vec![FileFault::NoMessages { topics: self.topics }]);
        }
        Ok(self.streams.into_log(self.header))
    }
}
