//! Of which robot a log is, by its header.

use super::error::Error;
use super::log::Log;
use super::log_fault::{LogFault, LogFaults};
use super::log_file::LogFile;
use denavit_plants::Override;
use std::fmt::Write;

/// The header's lines of the model's name, of its hash, and of values in place of its own.
const MODEL: &str = "model";
pub(super) const MODEL_HASH: &str = "model_hash";
pub(super) const PARAMETERS: &str = "parameters";

fn said<'a>(header: &'a [(String, String)], name: &str) -> Option<&'a str> {
    let (_, value) = header.iter().find(|(known, _)| known == name)?;
    Some(value.trim()).filter(|value| !value.is_empty())
}

/// The model that a log's header names, if it does.
pub fn model_of_header(header: &[(String, String)]) -> Option<&str> {
    said(header, MODEL)?.split_whitespace().next()
}

/// The content hash of a model, as headers have it.
pub(super) fn hash_text(hash: u64) -> String {
    format!("{hash:016x}")
}

/// Values in place of a model's own, as headers have them: `g=3.7;slope=0.07`.
pub(super) fn parameters_text(parameters: &[Override]) -> String {
    let mut text = String::new();
    for Override { parameter, value } in parameters {
        let between = if text.is_empty() { "" } else { ";" };
        // writing to a string cannot fail
        let _ = write!(text, "{between}{parameter}={value:?}");
    }
    text
}

impl Log {
    /// The scheme of the run that it was made of, where its header says so.
    pub fn scheme(&self) -> Option<&str> {
        said(&self.header, "scheme")
    }
}

impl LogFile {
    /// The values that the log's robot had in place of those of its model, of this name and
    /// content hash; nothing where the header does not say.
    ///
    /// # Errors
    /// The header says that the log is of another model, or has no values where they should be.
    pub fn parameters(&self, model: &str, hash: u64) -> Result<Vec<Override>, Error> {
        let header = &self.log.header;
        if let Some(log) = model_of_header(header).filter(|log| *log != model) {
            let cause = LogFault::OtherModel(log.to_owned(), model.to_owned());
            return Err(LogFaults::from(self.fault_of_header(MODEL, cause)).into());
        }
        let own = hash_text(hash);
        if let Some(log) = said(header, MODEL_HASH).filter(|log| *log != own) {
            let cause = LogFault::OtherHash(log.to_owned(), own, model.to_owned());
            return Err(LogFaults::from(self.fault_of_header(MODEL_HASH, cause)).into());
        }
        let (mut faults, mut parameters) = (LogFaults::default(), Vec::new());
        for entry in said(header, PARAMETERS).into_iter().flat_map(|text| text.split(';')) {
            let parts = entry.split_once('=').map(|(name, value)| (name.trim(), value.trim()));
            let value = parts.and_then(|(name, value)| {
                let value = value.parse::<f64>().ok().filter(|value| value.is_finite())?;
                Some(Override { parameter: name.to_owned(), value })
            });
            match value {
                Some(value) => parameters.push(value),
                None => {
                    let cause = LogFault::Parameter(entry.trim().to_owned());
                    faults.push(self.fault_of_header(PARAMETERS, cause));
                }
            }
        }
        Ok(faults.or(parameters)?)
    }

    /// The fault of a parameter that the header names, and the model does not have.
    pub fn unknown_parameter(&self, name: &str) -> Error {
        let cause = LogFault::UnknownParameter(name.to_owned());
        LogFaults::from(self.fault_of_header(PARAMETERS, cause)).into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(header: &str) -> LogFile {
        LogFile::from_csv("a.csv", format!("{header}t\n0\n").as_bytes()).expect("a log")
    }

    #[test]
    fn values_in_a_header_are_those_that_were_written() {
        let set = |parameter: &str, value| Override { parameter: parameter.to_owned(), value };
        let all = vec![set("g", 3.7), set("slope", -1e-30), set("m", 0.1 + 0.2)];
        let text = parameters_text(&all);
        assert_eq!(text, "g=3.7;slope=-1e-30;m=0.30000000000000004");
        let log =
            file(&format!("# model: a\n# model_hash: 00000000000000ff\n# parameters: {text}\n"));
        assert_eq!(log.parameters("a", 255), Ok(all));
        assert_eq!(file("").parameters("a", 255), Ok(Vec::new()));
    }

    #[test]
    fn a_log_of_another_model_says_so() {
        let place = |header: &str| {
            let faults = file(header).parameters("a", 255).unwrap_err();
            let places = faults
                .log_faults()
                .expect("faults")
                .told()
                .iter()
                .map(|one| (one.line, one.cause.clone()));
            places.collect::<Vec<_>>()
        };
        let [a, b, ff, fe] = ["a", "b", "00000000000000ff", "00000000000000fe"].map(str::to_owned);
        assert_eq!(place("# x: y\n# model: b\n"), [(2, LogFault::OtherModel(b, a.clone()))]);
        let hash = format!("# model: a\n# model_hash: {fe}\n# parameters: g=1\n");
        assert_eq!(place(&hash), [(2, LogFault::OtherHash(fe, ff, a))]);
        let found = ["g", "m=x"].map(|entry| (1, LogFault::Parameter(entry.to_owned())));
        assert_eq!(place("# parameters: g; k=2; m=x\n"), found);
    }
}
