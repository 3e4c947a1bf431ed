//! Which command reads what was given to another one.

use denavit::workflow::{FileKind, Mistaken};

/// Which command reads it, or how what is wanted is come by.
pub(crate) fn other_command(mistaken: &Mistaken) -> String {
    use FileKind as Kind;
    let Mistaken { name, found, wanted } = mistaken;
    match (*found, *wanted) {
        (Kind::Model | Kind::Description, Kind::Scenario) => smallest_scenario(name),
        (Kind::Model | Kind::Description, Kind::Gait) => "a gait file says how a model \
            walks: docs/reference/gait.md; `denavit list gaits` has those that are shipped"
            .to_owned(),
        (Kind::Model | Kind::Description, Kind::Certificate) => {
            format!("`denavit verify CERTIFICATE {name}`; `denavit base --certificate` writes one")
        }
        (Kind::Model | Kind::Description, _) => format!("`denavit inspect {name}` reads it"),
        (Kind::Equations, _) => format!("`denavit decompose {name}` reads it"),
        (Kind::Scenario, Kind::Log) => {
            format!("`denavit simulate {name} -o run.csv` makes one of it")
        }
        (Kind::Scenario, _) => format!("`denavit simulate {name}` runs it"),
        (Kind::Gait, _) => {
            format!("a gait is designed first: `denavit walk design {name} -o scenario.json`")
        }
        (Kind::Controller, _) => {
            format!("`denavit identify MODEL --train LOG --controller {name}` reads it")
        }
        (Kind::Trajectory, _) => {
            format!("a scenario names it, and `denavit excite MODEL --check {name}` reads it")
        }
        (Kind::Effect, _) => "a model names it; `--effects DIR` takes its folder".to_owned(),
        (Kind::Certificate, _) => format!("`denavit verify {name} MODEL` reads it"),
        (Kind::Statics, _) => format!("`denavit identify MODEL --static {name}` reads it"),
        (Kind::Log, _) => format!(
            "`denavit identify MODEL --train {name}` estimates parameters from it, `denavit \
             diagnose` says what the model lacks"
        ),
    }
}

/// What to write where a model alone was given.
fn smallest_scenario(model: &str) -> String {
    // a stream has no name by which a scenario could refer to it
    let is_stream = model == "standard input" || model.starts_with("/dev/");
    let model = serde_json::Value::from(if is_stream { "MODEL.json" } else { model });
    format!(
        "a scenario says what a model does: {{\"format\": \"{}\", \"name\": \"run\", \"model\": \
         {model}, \"duration_s\": 1}} lets it go from rest, an arm at least; \
         docs/reference/scenario.md has the rest, `denavit schema scenario` all keys",
        denavit::simulate::scenario::FORMAT
    )
}
