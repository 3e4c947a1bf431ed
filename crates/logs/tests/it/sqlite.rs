//! SQLite storage of bags.

use crate::made::{JOINT_STATE, Mcap, columns, joint_state, read};
use denavit_logs::{Error, FileFault, FileRemark, Log, Opening, open};
use rusqlite::Connection;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const ROWS: u64 = 200;

fn message(row: u64) -> Vec<u8> {
    let value = 0.1 * row as f64;
    joint_state(1 + row * 1_000_000, &["a", "b"], [&[value, -value], &[], &[1.0, value]])
}

/// A file as `ros2 bag` makes it.
fn make(path: &Path, has_definitions: bool) {
    let database = Connection::open(path).expect("a database");
    let tables = "create table topics(id integer primary key, name text not null, type text not \
                  null, serialization_format text not null, offered_qos_profiles text not null);
                  create table messages(id integer primary key, topic_id integer not null, \
                  timestamp integer not null, data blob not null);";
    database.execute_batch(tables).expect("tables");
    let kind = "sensor_msgs/msg/JointState";
    if has_definitions {
        let table = "create table message_definitions(id integer primary key, topic_type text, \
                     encoding text, encoded_message_definition text, type_description_hash text)";
        database.execute_batch(table).expect("a table");
        let text = "insert into message_definitions values (1, ?1, 'ros2msg', ?2, '')";
        database.execute(text, (kind, JOINT_STATE)).expect("a row");
    }
    let text = "insert into topics values (1, '/joint_states', ?1, 'cdr', '')";
    database.execute(text, [kind]).expect("a row");
    for row in 0..ROWS {
        let text = "insert into messages values (?1, 1, ?2, ?3)";
        database.execute(text, (row as i64 + 1, row as i64, message(row))).expect("a row");
    }
}

fn bag(has_definitions: bool) -> TempDir {
    let folder = TempDir::new().expect("a folder");
    make(&folder.path().join("a b_0.db3"), has_definitions);
    let metadata = "rosbag2_bagfile_information:\n  storage_identifier: sqlite3\n  \
                    relative_file_paths:\n    - a b_0.db3\n";
    fs::write(folder.path().join("metadata.yaml"), metadata).expect("written");
    folder
}

fn opened(path: &Path, accepts_cut: bool) -> Result<Log<'static>, Vec<FileFault>> {
    let how = Opening { accepts_cut, ..Opening::default() };
    open(path, None, &how).map_err(Error::into_faults)
}

#[test]
fn a_bag_has_the_numbers_of_mcap() {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    (0..ROWS).for_each(|row| file.message(joints, row, &message(row)));
    let names = ["t", "q_a", "q_b", "tau_a", "tau_b"];
    let expected = read(&file.plain(), &names);
    for has_definitions in [true, false] {
        let folder = bag(has_definitions);
        for path in [folder.path().to_owned(), folder.path().join("a b_0.db3")] {
            let table = columns(opened(&path, false).expect("a log"), &names).expect("rows");
            assert_eq!(table.columns, expected.columns);
            let is_told = matches!(&table.remarks[..], [FileRemark::OwnDefinition { .. }]);
            assert_eq!(is_told, !has_definitions);
        }
        let mut files: Vec<_> = fs::read_dir(folder.path()).expect("a folder").collect();
        assert_eq!(files.drain(..).count(), 2, "nothing was made beside it");
    }
}

/// Messages that stand in a file beside it are not passed over.
#[test]
fn a_log_of_writing_beside_the_file_is_told() {
    let folder = bag(true);
    fs::write(folder.path().join("a b_0.db3-wal"), b"something").expect("written");
    let faults = opened(folder.path(), false).unwrap_err();
    assert!(faults[0].to_string().contains("wal_checkpoint"), "{faults:?}");
}

#[test]
fn damage_is_told_and_what_is_whole_is_offered() {
    let folder = bag(true);
    let path = folder.path().join("a b_0.db3");
    let bytes = fs::read(&path).expect("a file");
    let mut outcomes = [0; 3];
    for round in 0..60 {
        let mut bytes = bytes.clone();
        let at = 100 + round * (bytes.len() - 200) / 60;
        match round % 3 {
            0 => bytes.truncate(at),
            1 => bytes[at..at + 50].fill(0xff),
            _ => bytes[at] ^= 0x55,
        }
        fs::write(&path, &bytes).expect("written");
        match opened(&path, false) {
            Ok(_) => outcomes[0] += 1,
            Err(faults) => {
                assert!(faults.iter().all(|fault| !fault.to_string().is_empty()));
                if let [FileFault::Damaged { whole: 4.., .. }] = faults[..] {
                    assert!(opened(&path, true).is_ok());
                    outcomes[1] += 1;
                } else {
                    outcomes[2] += 1;
                }
            }
        }
    }
    assert!(outcomes.iter().all(|count| *count > 0), "{outcomes:?}");
}
