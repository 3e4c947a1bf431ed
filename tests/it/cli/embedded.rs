//! The command inside another program: answers, faults and stops are those of the command.

use denavit::cli::embedded::{Answered, GivenLog, Observer, Unanswered, answer, answer_of_logs};
use denavit::logs::MemoryLog;
use denavit::workflow::PlacedFault;
use std::ffi::OsString;
use std::sync::{Arc, Mutex};

/// Hears everything, and stops at a stage.
#[derive(Default)]
struct Heard {
    notes: Mutex<Vec<String>>,
    stages: Mutex<Vec<String>>,
    stops_at: Option<&'static str>,
}

impl Observer for Heard {
    fn note(&self, text: &str) {
        self.notes.lock().unwrap().push(text.to_owned());
    }

    fn progress(&self, stage: &str, _: Option<f64>) -> bool {
        self.stages.lock().unwrap().push(stage.to_owned());
        !self.stops_at.is_some_and(|stop| stage.contains(stop))
    }
}

fn run(line: &str, heard: Heard) -> (Result<Answered, Unanswered>, Arc<Heard>) {
    let heard = Arc::new(heard);
    let arguments: Vec<OsString> = line.split_whitespace().map(OsString::from).collect();
    (answer(&arguments, heard.clone()), heard)
}

#[test]
fn an_answer_is_that_of_the_command() {
    let (found, _) = run("base double_pendulum --json", Heard::default());
    let found = found.unwrap();
    let json: serde_json::Value = serde_json::from_slice(&found.output).unwrap();
    assert!(found.is_good);
    assert_eq!(json["model"], "double_pendulum");
}

#[test]
fn failures_have_place_and_hint() {
    let (found, _) = run("inspect puma650", Heard::default());
    let Err(Unanswered::Input("inspect", wrong)) = found else { panic!("{found:?}") };
    assert_eq!(wrong[0].file.as_deref(), Some("puma650"));
    assert!(wrong[0].hint.as_ref().unwrap().contains("puma560"));
    let (found, _) = run("inspect --no-such-flag", Heard::default());
    assert!(matches!(found, Err(Unanswered::Usage(text)) if text.contains("--no-such-flag")));
}

#[test]
fn logs_in_memory_stand_in_place_of_files() {
    let words = ["identify", "planar_2r", "--train", "train[0]"];
    let arguments = words.map(OsString::from);
    let given = |at| {
        let columns = vec![("t".to_owned(), vec![0.0, 1.0])];
        let log = MemoryLog { columns, ..MemoryLog::default() };
        GivenLog { option: "train".to_owned(), at, name: "mine[0]".to_owned(), log }
    };
    let found = answer_of_logs(&arguments, vec![given(0)], Arc::new(Heard::default()));
    let Err(Unanswered::Input("identify", wrong)) = found else { panic!("{found:?}") };
    let is_of_log = |one: &PlacedFault| one.file.as_deref() == Some("mine[0]");
    assert!(wrong.iter().all(is_of_log) && wrong[0].cause.contains("q_link1"), "{wrong:?}");
    let found = answer_of_logs(&arguments, vec![given(1)], Arc::new(Heard::default()));
    assert!(matches!(found, Err(Unanswered::Internal(_))), "{found:?}");
}

#[test]
fn an_observer_stops_a_run() {
    let heard = Heard { stops_at: Some("reading"), ..Heard::default() };
    let (found, heard) = run("identify tulip_leg --train none.csv --json", heard);
    assert_eq!(found, Err(Unanswered::Stopped));
    assert_eq!(heard.stages.lock().unwrap().len(), 1);
}
