//! Filters where nobody asks for one.

use super::Folder;
use denavit_blind::case::Case;
use denavit_codegen::regressor::RegressorOptions;
use denavit_workflow::{IdentifyOptions, Logs, RobotFile, Silent, identify};

/// Friction that remembers where it came from, which no parameter of the model is: behind the
/// filter by default numbers of the other link are off by several of their errors. They change with
/// half its cutoff, and are near the truth, with smaller errors, behind that.
#[test]
fn filters_are_lowered_where_parameters_change_with_them() {
    let folder = Folder::new("lowered");
    let case = Case::new(11040).generate();
    case.write_files(folder.path()).unwrap();
    let robot = RobotFile::open(folder.path().join("model.json")).unwrap();
    let logs = Logs::new([folder.path().join("train.csv")], []);
    let with = RegressorOptions { friction: true, ..RegressorOptions::default() };
    let options = IdentifyOptions { with: Some(with), ..IdentifyOptions::default() };
    let found = identify(&robot, &logs, &options, &mut Silent).unwrap().found;
    let mass = found.parameters.iter().find(|one| one.name == "m_link2").unwrap();
    let (off, std) = (mass.value - mass.model_value.unwrap(), mass.std.unwrap());
    assert!(off.abs() < 2.0 * std && std < 0.015, "{off} {std}");
}
