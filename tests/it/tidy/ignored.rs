//! Tests that the suite leaves out: each with its reason, and who runs it.

use super::{all_files, assert_none, shown};
use std::collections::BTreeSet;
use std::fs;

/// A test that is left out of the suite.
struct Ignored {
    test: &'static str,
    /// As in its attribute.
    reason: &'static str,
    /// What runs it.
    runs: Runs,
}

#[derive(Clone, Copy, PartialEq)]
enum Runs {
    /// `.ci/run`, where what the test needs is installed.
    Ci,
    /// `.ci/long`.
    Long,
    /// People who have the measurements: `DENAVIT_EMPS` names their folder.
    Measurements,
    /// People who have logs of several robots: `DENAVIT_REAL_DATA` names their folder.
    RealData,
}

const fn ignored(test: &'static str, reason: &'static str, runs: Runs) -> Ignored {
    Ignored { test, reason, runs }
}

const NO_MEASUREMENTS: &str = "needs the measurements, which are not part of the repository";

const IGNORED: [Ignored; 13] = [
    ignored("what_is_left_out_of_a_real_axis_is_named", NO_MEASUREMENTS, Runs::Measurements),
    ignored("the_published_parameters_and_errors_are_reached", NO_MEASUREMENTS, Runs::Measurements),
    ignored(
        "a_real_axis_has_friction_that_differs_by_its_direction",
        NO_MEASUREMENTS,
        Runs::RealData,
    ),
    ignored("a_real_pendulum_has_coulomb_friction", NO_MEASUREMENTS, Runs::RealData),
    ignored(
        "logs_that_show_nothing_of_a_real_pendulum_are_refused",
        NO_MEASUREMENTS,
        Runs::RealData,
    ),
    ignored(
        "a_real_arm_has_viscous_and_coulomb_friction_in_all_joints",
        NO_MEASUREMENTS,
        Runs::RealData,
    ),
    ignored("documents_compile_to_at_most_forty_pages", "needs pdflatex", Runs::Ci),
    ignored("documents_of_f_and_b_compile", "needs pdflatex", Runs::Ci),
    ignored(
        "intervals_of_friction_hold_over_many_seeds",
        "takes minutes: the figures are in the docs",
        Runs::Long,
    ),
    ignored(
        "least_stiffness_of_passive_ankle_rolls",
        "takes minutes: the figures are in the docs",
        Runs::Long,
    ),
    ignored(
        "shipped_gaits_cost_less_than_the_hand_made_one_and_repeat_to_the_byte",
        "takes minutes: designs with costs of transport",
        Runs::Long,
    ),
    ignored(
        "many_mutations_of_mcap_are_read_or_refused",
        "5000 mutations take longer than the suite may",
        Runs::Long,
    ),
    ignored("six_hundred_drops_do_not_depend_on_the_log", "takes a minute", Runs::Long),
];

/// The ignored tests of a text: name and reason; none is the reason of a bare attribute.
fn found(text: &str) -> Vec<(String, Option<String>)> {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let of = |(at, line): (usize, &&str)| {
        let rest = line.strip_prefix("#[ignore")?;
        let reason = rest.strip_prefix(" = \"").and_then(|rest| rest.strip_suffix("\"]"));
        let function = lines[at..].iter().find_map(|line| line.strip_prefix("fn "))?;
        let name = function.split('(').next().unwrap_or_default();
        Some((name.to_owned(), reason.map(str::to_owned)))
    };
    lines.iter().enumerate().filter_map(of).collect()
}

#[test]
fn every_ignored_test_has_a_reason_and_somebody_who_runs_it() {
    let (mut faults, mut seen) = (Vec::new(), BTreeSet::new());
    for path in all_files() {
        for (name, reason) in found(&fs::read_to_string(&path).unwrap()) {
            let known = IGNORED.iter().find(|known| known.test == name);
            if known.is_none_or(|known| Some(known.reason) != reason.as_deref()) {
                faults
                    .push(format!("{}: {name}: not in the table, or another reason", shown(&path)));
            }
            seen.insert(name);
        }
    }
    let gone = IGNORED.iter().filter(|known| !seen.contains(known.test));
    faults.extend(gone.map(|known| format!("{}: in the table, and no test", known.test)));
    assert_none(&faults, "tests that are left out stand in a table");
}

#[test]
fn what_is_left_out_of_the_suite_is_run_by_a_script() {
    let ci = fs::read_to_string(super::root().join(".ci/run")).unwrap();
    let long = fs::read_to_string(super::root().join(".ci/long")).unwrap();
    let mut faults = Vec::new();
    for known in &IGNORED {
        let is_run = match known.runs {
            // both of them are tests of LaTeX, which run by the name of their module
            Runs::Ci => ci.contains("--ignored latex::"),
            Runs::Long => long.contains(known.test),
            // all tests of their module
            Runs::RealData => {
                long.contains("--ignored real_data::") && long.contains("DENAVIT_REAL_DATA")
            }
            Runs::Measurements => long.contains(known.test) && long.contains("DENAVIT_EMPS"),
        };
        if !is_run {
            faults.push(known.test.to_owned());
        }
    }
    assert_none(&faults, "a script runs what the suite leaves out");
}

#[test]
fn bare_attributes_and_reasons_are_told_apart() {
    let mark = "#[ignore";
    let text =
        format!("#[test]\n{mark}]\nfn one() {{}}\n{mark} = \"slow\"]\n#[test]\nfn two() {{}}");
    let expected = [("one".to_owned(), None), ("two".to_owned(), Some("slow".to_owned()))];
    assert_eq!(found(&text), expected);
}
