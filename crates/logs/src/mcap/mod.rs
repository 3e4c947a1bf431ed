//! MCAP files: records, chunks, messages.

mod chunk;
mod write;

pub use write::{Rows, write_mcap};

use super::fault::{FileFault, of_io};
use super::intake::{Channel, Described, Intake};
use super::opening::Opening;
use super::source::Log;
use chunk::unpacked;
use mcap::records::{self, Record, op};
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};
use mcap::{McapError, parse_record};
use std::collections::BTreeMap;
use std::io::Read;

/// The record of metadata that holds what our logs say of themselves.
pub(crate) const METADATA: &str = "denavit";

/// Bytes that are asked for at once: a length that is corrupt must not fill the memory.
const AT_ONCE: usize = 1 << 20;

/// The longest record, and the longest chunk when unpacked \[bytes\].
const LONGEST: usize = 1 << 30;

/// Opens an MCAP file.
pub(crate) fn open(source: impl Read, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    let mut intake = Intake::new(how);
    read(source, &mut intake).map_err(|fault| vec![fault])?;
    intake.into_log()
}

/// Reads the messages of a file.
pub(crate) fn read(mut source: impl Read, intake: &mut Intake<'_>) -> Result<(), FileFault> {
    let options =
        LinearReaderOptions::default().with_emit_chunks(true).with_record_length_limit(LONGEST);
    let mut reader = LinearReader::new_with_options(options);
    let (mut file, mut buffer) = (Reading::default(), Vec::new());
    while let Some(event) = reader.next_event() {
        let goes_on = match event {
            Ok(LinearReadEvent::ReadRequest(need)) => {
                let space = reader.insert(need.clamp(1, AT_ONCE));
                let read = source.read(space).map_err(|error| of_io(&error))?;
                reader.notify_read(read);
                true
            }
            Ok(LinearReadEvent::Record { opcode: op::CHUNK, data }) => {
                match unpacked(data, LONGEST, &mut buffer) {
                    Ok(records) => file.chunk(records, intake)?,
                    Err(why) => intake.damaged(why).map(|()| false)?,
                }
            }
            Ok(LinearReadEvent::Record { opcode, data }) => file.record(opcode, data, intake)?,
            Err(error) => intake.damaged(sentence(&error)).map(|()| false)?,
        };
        if !goes_on || file.is_over {
            break;
        }
    }
    Ok(())
}

/// What is wrong, as a sentence about the file.
fn sentence(error: &McapError) -> String {
    match error {
        McapError::UnexpectedEof => "the file ends here, without its last records".to_owned(),
        McapError::UnexpectedEoc => "a chunk ends within a record".to_owned(),
        McapError::Parse(_) => "a record cannot be read".to_owned(),
        error => format!("a record cannot be read: {error}"),
    }
}

/// What a file has described so far.
#[derive(Default)]
struct Reading {
    schemas: BTreeMap<u16, (String, String, Vec<u8>)>,
    channels: BTreeMap<u16, (records::Channel, Channel)>,
    is_over: bool,
}

/// The opcode and the length of a record.
const RECORD_HEAD: usize = 9;

impl Reading {
    /// The records of a chunk, one after the other.
    fn chunk(&mut self, mut bytes: &[u8], intake: &mut Intake<'_>) -> Result<bool, FileFault> {
        while !bytes.is_empty() {
            let record = bytes.split_at_checked(RECORD_HEAD).and_then(|(head, rest)| {
                let (opcode, length) = head.split_first()?;
                let length = u64::from_le_bytes(length.try_into().ok()?);
                let (data, rest) = rest.split_at_checked(usize::try_from(length).ok()?)?;
                Some((*opcode, data, rest))
            });
            let Some((opcode, data, rest)) = record else {
                return intake.damaged("a chunk ends within a record".to_owned()).map(|()| false);
            };
            if !self.record(opcode, data, intake)? {
                return Ok(false);
            }
            bytes = rest;
        }
        Ok(true)
    }

    /// A record. The answer is whether others are to follow.
    fn record(
        &mut self,
        opcode: u8,
        data: &[u8],
        intake: &mut Intake<'_>,
    ) -> Result<bool, FileFault> {
        match opcode {
            op::SCHEMA | op::CHANNEL | op::MESSAGE | op::METADATA => {}
            // what follows repeats what was read
            op::DATA_END | op::FOOTER => {
                self.is_over = true;
                return Ok(true);
            }
            _ => return Ok(true),
        }
        let record = match parse_record(opcode, data) {
            Ok(record) => record,
            Err(error) => return intake.damaged(sentence(&error)).map(|()| false),
        };
        match record {
            Record::Schema { header, data } => {
                let schema = (header.name, header.encoding, data.into_owned());
                self.schemas.insert(header.id, schema);
            }
            Record::Channel(channel) => self.describe(channel, intake),
            Record::Message { header, data } => {
                let Some((_, channel)) = self.channels.get_mut(&header.channel_id) else {
                    let why =
                        format!("a message is of channel {}, which is none", header.channel_id);
                    return intake.damaged(why).map(|()| false);
                };
                return intake.message(channel, header.log_time, &data);
            }
            Record::Metadata(metadata) if metadata.name == METADATA => {
                intake.say(metadata.metadata.into_iter());
            }
            _ => {}
        }
        Ok(true)
    }

    fn describe(&mut self, channel: records::Channel, intake: &mut Intake<'_>) {
        // chunks repeat what they need
        if self.channels.get(&channel.id).is_some_and(|(known, _)| *known == channel) {
            return;
        }
        let schema = self.schemas.get(&channel.schema_id);
        let described = Described {
            topic: &channel.topic,
            kind: schema.map_or("", |(kind, ..)| kind),
            encoding: &channel.message_encoding,
            definition: schema.map(|(_, language, text)| (language.as_str(), &text[..])),
        };
        let becomes = intake.describe(&described);
        self.channels.insert(channel.id, (channel, becomes));
    }
}
