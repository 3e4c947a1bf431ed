//! What is wrong with a model's file.

use denavit_codegen::model::{Explained, FileError};
use denavit_workflow::RobotFaults;
use serde_json::{Value, json};

/// What is wrong with a file, as JSON: each fault with its place, cause and hint.
pub fn faults_json<C: Explained>(error: &FileError<C>) -> Value {
    let faults: Vec<Value> = error
        .faults
        .iter()
        .map(|fault| {
            json!({
                "pointer": fault.pointer,
                "line": fault.line,
                "column": fault.column,
                "cause": fault.cause.to_string(),
                "hint": fault.hint(),
            })
        })
        .collect();
    json!({ "file": error.file, "faults": faults, "omitted": error.omitted })
}

/// What is wrong with the file of a robot, as JSON.
pub fn robot_faults_json(faults: &RobotFaults<'_>) -> Value {
    match faults {
        RobotFaults::Model(error) => faults_json(error),
        RobotFaults::Description(error) => faults_json(error),
    }
}
