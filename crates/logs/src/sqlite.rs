//! SQLite storage of ROS 2 bags.

use super::fault::FileFault;
use super::intake::{Channel, Described, Intake};
use super::opening::Opening;
use super::source::Log;
use rusqlite::types::ValueRef;
use rusqlite::{Connection, OpenFlags};
use std::collections::BTreeMap;
use std::path::Path;

/// The most bytes of a text or message: a file that is corrupt must not take all memory.
const LONGEST: i32 = 1 << 30;

/// Opens a file of a bag.
pub(crate) fn open(path: &Path, how: &Opening) -> Result<Log<'static>, Vec<FileFault>> {
    let mut intake = Intake::new(how);
    read(path, &mut intake).map_err(|fault| vec![fault])?;
    intake.into_log()
}

/// What SQLite says, in one line.
fn told(error: &rusqlite::Error) -> String {
    let text = error.to_string();
    format!("SQLite says: {}", text.lines().next().unwrap_or_default())
}

/// Reads the messages of a file of a bag.
pub(crate) fn read(path: &Path, intake: &mut Intake<'_>) -> Result<(), FileFault> {
    let mut log = path.as_os_str().to_owned();
    log.push("-wal");
    let log = Path::new(&log);
    if log.metadata().is_ok_and(|found| found.len() > 0) {
        return Err(FileFault::Bag {
            cause: format!("{} holds messages that are not in the file yet", log.display()),
            hint: "`sqlite3 FILE 'pragma wal_checkpoint'` puts them there",
        });
    }
    let unreadable = |error: rusqlite::Error| FileFault::Unreadable(told(&error));
    let database = connected(path).map_err(unreadable)?;
    let mut channels = described(&database, intake).map_err(unreadable)?;
    let text = "select topic_id, timestamp, data from messages order by id";
    let mut statement = database.prepare(text).map_err(unreadable)?;
    let mut rows = statement.query([]).map_err(unreadable)?;
    loop {
        let row = match rows.next() {
            Ok(None) => return Ok(()),
            Ok(Some(row)) => row,
            Err(error) => return intake.damaged(told(&error)),
        };
        let cells = (row.get::<_, i64>(0), row.get::<_, i64>(1), row.get_ref(2));
        let (Ok(topic), Ok(time), Ok(ValueRef::Blob(data))) = cells else {
            return intake.damaged("a row of `messages` is no message".to_owned());
        };
        let Some(channel) = channels.get_mut(&topic) else {
            return intake.damaged(format!("a message is of topic {topic}, which is none"));
        };
        if !intake.message(channel, u64::try_from(time).unwrap_or(0), data)? {
            return Ok(());
        }
    }
}

/// Opens the file for reading alone: nothing beside it is made or read.
fn connected(path: &Path) -> Result<Connection, rusqlite::Error> {
    let mut address = "file:".to_owned();
    for byte in path.as_os_str().as_encoded_bytes() {
        match byte {
            b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'/' | b'.' | b'_' | b'-' => {
                address.push(char::from(*byte));
            }
            byte => address.push_str(&format!("%{byte:02x}")),
        }
    }
    address.push_str("?immutable=1");
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY
        | OpenFlags::SQLITE_OPEN_URI
        | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let database = Connection::open_with_flags(address, flags)?;
    database.set_limit(rusqlite::limits::Limit::SQLITE_LIMIT_LENGTH, LONGEST)?;
    database.pragma_update(None, "trusted_schema", false)?;
    database.pragma_update(None, "cell_size_check", true)?;
    Ok(database)
}

/// The topics by their numbers.
fn described(
    database: &Connection,
    intake: &mut Intake<'_>,
) -> Result<BTreeMap<i64, Channel>, rusqlite::Error> {
    let has_definitions = database
        .prepare(
            "select 1 from sqlite_master where type = 'table' and name = 'message_definitions'",
        )?
        .exists([])?;
    let mut definitions = BTreeMap::new();
    if has_definitions {
        let text = "select topic_type, encoding, encoded_message_definition \
                    from message_definitions";
        let mut statement = database.prepare(text)?;
        let mut rows = statement.query([])?;
        while let Some(row) = rows.next()? {
            let definition = (row.get::<_, String>(1)?, row.get::<_, String>(2)?);
            definitions.insert(row.get::<_, String>(0)?, definition);
        }
    }
    let mut channels = BTreeMap::new();
    let text = "select id, name, type, serialization_format from topics order by id";
    let mut statement = database.prepare(text)?;
    let mut rows = statement.query([])?;
    while let Some(row) = rows.next()? {
        let (topic, kind) = (row.get::<_, String>(1)?, row.get::<_, String>(2)?);
        let encoding = row.get::<_, String>(3)?;
        let definition = definitions.get(&kind);
        let definition = definition.map(|(language, text)| (&language[..], text.as_bytes()));
        let described = Described { topic: &topic, kind: &kind, encoding: &encoding, definition };
        channels.insert(row.get::<_, i64>(0)?, intake.describe(&described));
    }
    Ok(channels)
}
