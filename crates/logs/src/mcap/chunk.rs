//! Chunks: many records packed as one. The decompressors are in Rust alone.

use lz4_flex::frame::FrameDecoder;
use mcap::parse_record;
use mcap::records::{Record, op};
use ruzstd::decoding::StreamingDecoder;
use std::borrow::Cow;
use std::io::Read;

/// The records of a chunk; `buffer` holds them where they were packed. The error is a sentence.
pub(super) fn unpacked<'a>(
    chunk: &'a [u8],
    longest: usize,
    buffer: &'a mut Vec<u8>,
) -> Result<&'a [u8], String> {
    let Ok(Record::Chunk { header, data: Cow::Borrowed(packed) }) = parse_record(op::CHUNK, chunk)
    else {
        return Err("a chunk cannot be read".to_owned());
    };
    let length = usize::try_from(header.uncompressed_size).ok().filter(|length| *length <= longest);
    let length = length.ok_or("a chunk is longer than any")?;
    buffer.clear();
    let bad = |error: &dyn std::fmt::Display| format!("a chunk cannot be unpacked: {error}");
    let records = match header.compression.as_str() {
        "" => packed,
        "zstd" => {
            let source = StreamingDecoder::new(packed).map_err(|error| bad(&error))?;
            read(source, length, buffer).map_err(|error| bad(&error))?;
            &buffer[..]
        }
        "lz4" => {
            let source = FrameDecoder::new(packed);
            read(source, length, buffer).map_err(|error| bad(&error))?;
            &buffer[..]
        }
        other => return Err(format!("a chunk is packed with `{other}`, which is not known")),
    };
    if records.len() != length {
        return Err(format!("a chunk has {} bytes in place of {length}", records.len()));
    }
    let sum = header.uncompressed_crc;
    if sum != 0 && crc32fast::hash(records) != sum {
        return Err("a chunk is corrupt: its sum is another one".to_owned());
    }
    Ok(records)
}

/// Reads one byte more than there should be at most.
fn read(source: impl Read, length: usize, into: &mut Vec<u8>) -> std::io::Result<()> {
    source.take(length as u64 + 1).read_to_end(into).map(|_| ())
}
