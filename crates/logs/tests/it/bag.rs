//! Folders of bags.

use crate::made::{Mcap, columns, joint_state};
use denavit_logs::{FileFault, Opening, open};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

fn part(rows: std::ops::Range<u64>) -> Vec<u8> {
    let mut file = Mcap::default();
    let joints = file.joints("/joint_states");
    rows.for_each(|row| {
        file.message(joints, row, &joint_state(1 + row, &["a"], [&[row as f64], &[], &[]]));
    });
    file.plain()
}

fn metadata(folder: &Path, storage: &str, files: &[&str]) {
    let files: String = files.iter().map(|file| format!("    - {file}\n")).collect();
    let text = format!(
        "rosbag2_bagfile_information:\n  version: 8\n  storage_identifier: {storage}\n  \
         relative_file_paths:\n{files}  compression_mode: \"\"\n"
    );
    fs::write(folder.join("metadata.yaml"), text).expect("written");
}

#[test]
fn the_files_of_a_bag_are_one_log() {
    let folder = TempDir::new().expect("a folder");
    fs::write(folder.path().join("a_0.mcap"), part(0..30)).expect("written");
    fs::write(folder.path().join("a_1.mcap"), part(30..50)).expect("written");
    metadata(folder.path(), "mcap", &["a_0.mcap", "a_1.mcap"]);
    let log = open(folder.path(), None, &Opening::default()).expect("a log");
    let table = columns(log, &["t", "q_a"]).expect("rows");
    let expected: Vec<f64> = (0..50).map(f64::from).collect();
    assert_eq!(table.columns[1], expected);
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let above = TempDir::new().expect("a folder");
    let folder = above.path().join("bag");
    fs::create_dir(&folder).expect("made");
    let outside = above.path().join("secret.mcap");
    fs::write(&outside, part(0..30)).expect("written");
    let absolute = outside.display().to_string();
    let mut names = vec!["../secret.mcap".to_owned(), absolute, "./../secret.mcap".to_owned()];
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&outside, folder.join("link.mcap")).expect("a link");
        names.push("link.mcap".to_owned());
    }
    for name in names {
        metadata(&folder, "mcap", &[&name]);
        let faults = open(&folder, None, &Opening::default()).unwrap_err().into_faults();
        assert_eq!(faults, [FileFault::Outside { file: name }]);
    }
}

#[test]
fn folders_that_are_no_bags_are_told_why() {
    let folder = TempDir::new().expect("a folder");
    let told = || {
        let faults = open(folder.path(), None, &Opening::default()).unwrap_err().into_faults();
        faults.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    assert!(told().contains("without metadata.yaml"), "{}", told());
    metadata(folder.path(), "mcap", &["gone.mcap"]);
    assert!(told().contains("gone.mcap"), "{}", told());
    metadata(folder.path(), "mcap", &[]);
    assert!(told().contains("names no files"), "{}", told());
    fs::write(folder.path().join("a.mcap"), part(0..9)).expect("written");
    metadata(folder.path(), "rosbag_v2", &["a.mcap"]);
    assert!(told().contains("`rosbag_v2`"), "{}", told());
}
