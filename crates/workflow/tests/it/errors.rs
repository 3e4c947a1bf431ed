use super::Folder;
use denavit_workflow::{
    ErrorKind, FileKind, Files, Hint, IdentifyOptions, Logs, RobotFile, Silent, identify,
};
use std::path::Path;

#[test]
fn kinds_of_errors_are_told_apart() {
    let folder = Folder::new("kinds");
    let files = Files::new();
    let kind = |place: &Path| files.robot(place, None).unwrap_err().kind();
    assert_eq!(kind(Path::new("puma650")), ErrorKind::NotFound);
    assert_eq!(kind(&folder.path().join("none.json")), ErrorKind::NotFound);
    assert_eq!(kind(folder.path()), ErrorKind::Unreadable);
    let wrong = folder.write("wrong.json", r#"{"format": "denavit-model/1", "name": 3}"#);
    assert_eq!(kind(&wrong), ErrorKind::Wrong);
    let urdf = folder.write("arm.urdf", "<robot/>");
    assert_eq!(kind(&urdf), ErrorKind::Wrong);
    assert!(files.robot(&urdf, None).unwrap_err().robot_faults().is_some());
}

#[test]
fn a_file_for_other_work_is_named() {
    let folder = Folder::new("other_work");
    let log = folder.write("log.csv", "t,q_a\n0,1\n1,2\n");
    let error = Files::new().scenario(&log).err().unwrap();
    let [Hint::OtherWork(mistaken)] = &error.hints()[..] else { panic!("{error:?}") };
    assert_eq!((mistaken.found, mistaken.wanted), (FileKind::Log, FileKind::Scenario));
    assert!(error.to_string().ends_with("this is a log, where a scenario is simulated"), "{error}");
}

#[test]
fn all_logs_that_are_wrong_are_said_at_once() {
    let folder = Folder::new("wrong_logs");
    let logs = ["a.csv", "b.csv"].map(|name| folder.write(name, "t,q_link1\n0,x\n"));
    let robot = RobotFile::open("planar_2r").unwrap();
    let logs = Logs::new(logs, []);
    let options = IdentifyOptions::default();
    let error = identify(&robot, &logs, &options, &mut Silent).unwrap_err();
    let text = error.to_string();
    assert_eq!(error.kind(), ErrorKind::Wrong);
    assert!(text.contains("a.csv") && text.contains("b.csv"), "{text}");
}

#[test]
fn what_was_read_is_known_until_it_is_forgotten() {
    let folder = Folder::new("read");
    let file = folder.write("map.json", "{}").canonicalize().unwrap();
    let files = Files::new();
    assert!(!files.has_read(&file));
    files.columns(&file).unwrap();
    assert!(files.has_read(&file));
    files.forget();
    assert!(!files.has_read(&file));
}
