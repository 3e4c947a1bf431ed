use super::Folder;
use denavit_workflow::{Files, IdentifyOptions, Logs, RobotFile, Silent, identify};

/// A pendulum whose moment of inertia is about its axis (0.12 kg m^2), or about the centre of mass.
fn pendulum(about: &str, zz: f64) -> String {
    format!(
        r#"{{"format": "denavit-model/1", "name": "pendulum", "convention": "standard",
 "gravity": [0, "-g", 0], "constants": {{"g": {{"value": 9.81, "unit": "m/s^2"}}}},
 "links": [{{"name": "arm", "joint": {{"type": "revolute"}},
  "body": {{"mass": 2, "com": [-0.2, 0, 0], "inertia": {{"xx": 0.01, "yy": {zz}, "zz": {zz}}},
           "about": "{about}"}}}}]}}"#
    )
}

/// The numbers of the pendulum that have an error of their own.
fn with_errors(about: &str, zz: f64) -> Vec<String> {
    let folder = Folder::new(&format!("errors_about_{about}"));
    let model = folder.write("pendulum.json", &pendulum(about, zz));
    let scenario = r#"{"format": "denavit-scenario/1", "model": "pendulum.json", "duration_s": 4,
 "control": {"period_s": 0.002, "joints": {"arm": {"kp": 300, "kd": 30, "reference":
  {"fourier": {"frequency_rad_s": 4, "sines": [0.5, 0.2], "cosines": [0.1, 0.2]}}}}},
 "measurement": {"logged": true, "torque_noise": 0.01}, "seed": 1, "log_period_s": 0.002}"#;
    let scenario = folder.write("run.json", scenario);
    let run = Files::new().scenario(&scenario).unwrap().run().unwrap();
    let log = folder.write("run.csv", &run.log.to_csv());
    let robot = RobotFile::open(&model).unwrap();
    let logs = Logs::new([log], []);
    let found = identify(&robot, &logs, &IdentifyOptions::default(), &mut Silent).unwrap();
    let updated = found.updated.unwrap();
    let inertia = found.found.parameters.iter().find(|one| one.expression == "Izz_arm").unwrap();
    let std = inertia.std.unwrap();
    // what logs tell is about the axis, whatever the file says
    assert!((inertia.value - 0.12).abs() < 4.0 * std, "{} +- {std}", inertia.value);
    updated.errors.into_keys().collect()
}

#[test]
fn numbers_about_another_point_than_the_estimate_have_no_error_of_their_own() {
    assert!(with_errors("origin", 0.12).contains(&"Izz_arm".to_owned()));
    assert!(!with_errors("com", 0.04).contains(&"Izz_arm".to_owned()));
}
