//! What is said before anybody believes an estimate, of logs made by hand.

use super::Directory;
use super::identify_told::{GOOD, Made, motions, said, write_arm, write_log};

/// Torques that no bodies make, as of a second link whose moment of inertia is below 0: however
/// well an estimate explains them, it is said and not done.
#[test]
fn an_estimate_far_from_all_bodies_is_said() {
    let directory = Directory::new("told-bodies");
    write_arm(&directory, None);
    for seed in [1, 2] {
        let both = motions(seed, 1.5);
        let made = Made { seed, ..GOOD };
        for (less, is_far) in [(0.0, false), (0.2, true)] {
            let mut rows = made.rows(&both);
            for row in &mut rows {
                let turns: f64 = both.iter().map(|one| one.at(row[0])[2]).sum();
                row[3..].iter_mut().for_each(|torque| *torque -= less * turns);
            }
            write_log(&directory, "less.csv", &rows);
            let (code, text) = said(&directory, &["--train", "less.csv"]);
            assert_eq!(code, Some(i32::from(is_far)), "{seed} {less}: {text}");
            let words = text.replace('\n', " ");
            let is_said = words.contains("The parameters are not physically consistent");
            assert_eq!(is_said, is_far, "{seed} {less}: {text}");
        }
    }
}

/// A hint is right beside a mapping that is given: its scale is that of the log's own unit.
#[test]
fn hints_go_on_from_scales_that_are_given() {
    let directory = Directory::new("doubts-scale");
    write_arm(&directory, None);
    write_log(&directory, "log.csv", &GOOD.rows(&motions(3, 0.7)));
    for given in [10.0, 0.01] {
        // the hint is what makes up for the scale
        let map = format!("{{\"tau_link1\": {{\"scale\": {given}}}}}");
        std::fs::write(directory.path.join("map.json"), map).expect("written");
        let words = ["--train", "log.csv", "--columns", "map.json"];
        let (code, text) = said(&directory, &words);
        assert_ne!(code, Some(0), "{given}: {text}");
        let words = text.replace('\n', " ");
        let hint = words.split("{\"tau_link1\": {\"scale\": ").nth(1).expect(&text);
        let number: f64 = hint.split('}').next().expect("a number").parse().expect(&text);
        assert!((number.abs() - 1.0).abs() < 1e-9, "{given}: {text}");
    }
}

/// All logs that cannot be read are named, not the first alone.
#[test]
fn faults_of_all_logs_are_said_at_once() {
    let directory = Directory::new("doubts-logs");
    write_arm(&directory, None);
    for (name, text) in [("one.csv", "a,b\n"), ("other.csv", "t,q_link1\n")] {
        std::fs::write(directory.path.join(name), text).expect("written");
    }
    let (code, text) = said(&directory, &["--train", "one.csv", "other.csv"]);
    assert_eq!(code, Some(2), "{text}");
    for fault in ["one.csv: there is no column `t`", "other.csv: there is no column `q_link2`"] {
        assert!(text.contains(fault), "{text}");
    }
}

/// A controller that is neither a file nor shipped: the hint says which are.
#[test]
fn controllers_that_are_shipped_are_said() {
    let directory = Directory::new("doubts-controller");
    write_arm(&directory, None);
    write_log(&directory, "log.csv", &GOOD.rows(&motions(3, 0.7)));
    for (name, hint) in [("emsp", "`emps` is a shipped controller"), ("x/y", "one of emps, tulip")]
    {
        let (code, text) = said(&directory, &["--train", "log.csv", "--controller", name]);
        assert_eq!(code, Some(2), "{text}");
        assert!(text.contains("no shipped controller") && text.contains(hint), "{text}");
    }
}

/// A torque that is scaled moves parameters by many of their errors and leaves little: it is said
/// that this is no noise, and by how much it is scaled; of good logs it is not.
#[test]
fn what_is_left_is_said_to_be_no_noise() {
    let directory = Directory::new("doubts-noise");
    write_arm(&directory, None);
    for seed in [1, 2, 3, 4] {
        for gain in [1.0, 1.3] {
            let mut rows = Made { seed, ..GOOD }.rows(&motions(seed, 0.7));
            rows.iter_mut().for_each(|row| row[3] *= gain);
            write_log(&directory, "log.csv", &rows);
            let (code, text) = said(&directory, &["--train", "log.csv"]);
            assert_eq!(code, Some(i32::from(gain != 1.0)), "{seed} {gain}: {text}");
            let words = text.replace('\n', " ");
            assert_eq!(words.contains("is no noise"), gain != 1.0, "{seed} {gain}: {text}");
            if gain != 1.0 {
                assert!((told_gain(&words) / gain - 1.0).abs() < 0.01, "{seed}: {text}");
            }
        }
    }
}

/// How many times too large the torque of the first joint is said to be, or those of all others too
/// small.
fn told_gain(words: &str) -> f64 {
    let (joint, told) = words.split_once(" seems to be ").expect(words);
    let factor = told.split(' ').next().expect("a number").parse::<f64>().expect(told);
    if joint.ends_with("link1") { factor } else { 1.0 / factor }
}

/// Where the answer is a document, doubts are said beside it.
#[test]
fn doubts_are_said_beside_a_document() {
    let directory = Directory::new("doubts-document");
    write_arm(&directory, None);
    let mut rows = GOOD.rows(&motions(3, 0.7));
    rows.iter_mut().for_each(|row| row[4] *= 1.2);
    write_log(&directory, "log.csv", &rows);
    for option in ["-o", "--html", "--svg"] {
        let (_, text) = said(&directory, &["--train", "log.csv", option, "-"]);
        assert!(text.replace('\n', " ").contains("is no noise"), "{option}: {text}");
    }
}

/// A log that the nominal parameters miss by far is of another robot, whatever an estimate says.
#[test]
fn values_that_are_far_off_are_said() {
    let directory = Directory::new("doubts-robot");
    write_arm(&directory, None);
    let mut rows = GOOD.rows(&motions(3, 0.7));
    rows.iter_mut().for_each(|row| row[3..].iter_mut().for_each(|torque| *torque *= 0.06));
    write_log(&directory, "log.csv", &rows);
    let (code, text) = said(&directory, &["--train", "log.csv"]);
    assert_ne!(code, Some(0), "{text}");
    assert!(text.contains("another robot"), "{text}");
}
