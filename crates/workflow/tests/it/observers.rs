use super::Folder;
use denavit_diagnose::Verdict;
use denavit_workflow::{
    DiagnoseOptions, ErrorKind, Files, IdentifyOptions, Logs, Progress, RobotFile, Silent, Stage,
    diagnose, identify,
};

/// An arm that follows two references, as a scenario; the second motion is another one.
fn scenario(sines: [f64; 2]) -> String {
    let [a, b] = sines;
    format!(
        r#"{{"format": "denavit-scenario/1", "model": "planar_2r", "duration_s": 4,
 "control": {{"joints": {{
  "link1": {{"kp": 300, "kd": 30, "reference":
   {{"fourier": {{"frequency_rad_s": 2, "sines": [{a}, 0.2], "cosines": [0.1, 0.2]}}}}}},
  "link2": {{"kp": 300, "kd": 30, "reference":
   {{"fourier": {{"frequency_rad_s": 3, "sines": [{b}, 0.2], "cosines": [0.1, 0.3]}}}}}}}}}},
 "log_period_s": 0.002}}"#
    )
}

/// Two logs of the arm, of which the second judges.
fn logs(folder: &Folder) -> Logs {
    let logs = [("train", [0.4, 0.5]), ("held_out", [0.3, -0.6])].map(|(name, sines)| {
        let file = folder.write(&format!("{name}.json"), &scenario(sines));
        let run = Files::new().scenario(&file).unwrap().run().unwrap();
        folder.write(&format!("{name}.csv"), &run.log.to_csv())
    });
    let [train, held_out] = logs;
    Logs::new([train], [held_out])
}

#[test]
fn an_identification_that_is_stopped_has_what_was_estimated() {
    let folder = Folder::new("stopped_identification");
    let (robot, logs) = (RobotFile::open("planar_2r").unwrap(), logs(&folder));
    let options = IdentifyOptions::default();
    let (mut stages, mut shares) = (Vec::new(), Vec::new());
    let mut heard = |at: &Progress<'_>| {
        stages.push(at.stage);
        shares.extend(at.share.map(|share| (at.stage, share)));
        true
    };
    let whole = identify(&robot, &logs, &options, &mut heard).unwrap();
    assert!(!whole.is_stopped && whole.simulated.is_some() && whole.is_good(false));
    stages.dedup();
    assert_eq!(stages[..2], [Stage::ReadingLogs, Stage::Estimating]);
    assert_eq!(stages.last(), Some(&Stage::SimulatingLogs));
    // two logs; one of them moves with two sets of values
    let told = [Stage::ReadingLogs, Stage::SimulatingLogs].map(|of| {
        let all = shares.iter().filter(|(stage, _)| *stage == of);
        all.map(|(_, share)| *share).collect::<Vec<_>>()
    });
    assert_eq!(told, [vec![0.0, 0.5], vec![0.0, 0.5]]);

    let mut one_log = |at: &Progress<'_>| at.share != Some(0.5);
    let none = identify(&robot, &logs, &options, &mut one_log).unwrap_err();
    assert_eq!(none.kind(), ErrorKind::Stopped);

    let until =
        |last: Stage| identify(&robot, &logs, &options, &mut |at: &Progress<'_>| at.stage != last);
    for nothing in [Stage::ReadingLogs, Stage::Estimating] {
        assert_eq!(until(nothing).unwrap_err().kind(), ErrorKind::Stopped);
    }
    let stopped = until(Stage::SimulatingLogs).unwrap();
    assert!(stopped.is_stopped && stopped.simulated.is_none());
    // the log is of the shipped model, whose values are the truth
    for one in &stopped.found.parameters {
        let truth = one.model_value.unwrap();
        assert!(
            (one.value - truth).abs() < 1e-2 * truth.abs().max(0.1),
            "{}: {}",
            one.name,
            one.value
        );
    }
}

#[test]
fn a_diagnosis_that_is_stopped_says_that_it_cannot_tell() {
    let folder = Folder::new("stopped_diagnosis");
    let (robot, logs) = (RobotFile::open("planar_2r").unwrap(), logs(&folder));
    let options = DiagnoseOptions::default();
    let mut at_once = |_: &Progress<'_>| false;
    let nothing = diagnose(&robot, &logs, &options, &mut at_once).err().unwrap();
    assert_eq!(nothing.kind(), ErrorKind::Stopped);
    let mut reads = |at: &Progress<'_>| at.stage == Stage::ReadingLogs;
    let stopped = diagnose(&robot, &logs, &options, &mut reads).unwrap();
    assert_eq!(stopped.found.verdict, Verdict::CannotTell);
    assert!(!stopped.is_good() && stopped.named().is_empty());
    let whole = diagnose(&robot, &logs, &options, &mut Silent).unwrap();
    assert_eq!(whole.found.verdict, Verdict::NothingMissing);
    assert!(whole.is_good());
}
