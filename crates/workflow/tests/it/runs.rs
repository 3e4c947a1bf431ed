use denavit_excite::ExciteOptions;
use denavit_simulate::Stop;
use denavit_simulate::scenario::RunScheme;
use denavit_workflow::{ErrorKind, Files, Progress, RobotFile, Silent, Stage, excite, simulate};
use std::path::Path;

#[test]
fn a_run_that_is_stopped_is_the_beginning_of_the_whole() {
    for scheme in [RunScheme::Event, RunScheme::TimeStepping] {
        let read = || {
            let mut scenario =
                Files::new().scenario(Path::new("double_pendulum")).expect("shipped");
            scenario.scheme = scheme;
            scenario
        };
        let whole = simulate(&mut read(), &mut Silent).expect("it runs");
        let mut shares = Vec::new();
        let mut watch = |at: &Progress<'_>| {
            assert_eq!(at.stage, Stage::Simulating);
            shares.extend(at.share);
            at.share.is_none_or(|share| share < 0.4)
        };
        let run = simulate(&mut read(), &mut watch).expect("it begins");
        assert_eq!((&whole.stop, &run.stop), (&Stop::End, &Stop::Watcher), "{scheme:?}");
        assert!(shares.is_sorted() && shares.len() > 2, "{scheme:?}: {shares:?}");
        let share = run.end.t_s / whole.end.t_s;
        assert!((0.4..0.9).contains(&share), "{scheme:?}: {share}");
        // the rows of both are the same, but for the last of the run that was stopped
        let common = run.log.rows().count() - 1;
        assert!(common > 2);
        assert!(
            run.log.rows().zip(whole.log.rows()).take(common).all(|(a, b)| a == b),
            "{scheme:?}"
        );
    }
}

#[test]
fn a_search_that_is_stopped_answers_with_the_best_so_far() {
    let robot = RobotFile::open("tulip_leg_table34").expect("shipped").apart.robot;
    let options = ExciteOptions {
        starts: 3,
        evaluations: 2000,
        threads: Some(2),
        ..ExciteOptions::default()
    };
    let mut heard = 0;
    let mut conditions = Vec::new();
    let mut watch = |at: &Progress<'_>| {
        assert_eq!(at.stage, Stage::Exciting(3));
        conditions.extend(at.condition);
        heard += 1;
        heard < 12
    };
    let found = excite(&robot, &options, &mut watch).expect("it is looked for");
    let evaluations: usize = found.starts.iter().map(|start| start.evaluations).sum();
    assert!(evaluations < 1000, "{evaluations}");
    assert!(conditions.is_sorted_by(|a, b| a >= b), "the best gets no worse: {conditions:?}");
    let ended = &found.found().ended;
    assert!(ended.is_feasible() && ended.excitation.condition.is_finite());

    let bad = ExciteOptions { duration_s: -1.0, ..options };
    let error = excite(&robot, &bad, &mut Silent).expect_err("no time");
    assert_eq!(error.kind(), ErrorKind::Unsuitable);
    assert!(std::error::Error::source(&error).is_some());
}
