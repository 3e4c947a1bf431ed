//! The blind battery: writes the files of a case, in which an effect is hidden.
//! `cargo run --release --example blind_battery -- --case N --out DIR [--count K]` writes `DIR/N/model.json`,
//! `train.csv`, `validate.csv` and, not to be looked at before the diagnosis has answered, `answer.json`.
//! Numbers below 1000 are for tuning. See docs/blind-battery.md.

#[path = "../tests/blind/mod.rs"]
mod blind;

use blind::case::Case;
use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let (mut case, mut count, mut out) = (None, 1, None);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        let value = arguments.next().ok_or(format!("{argument}: a value is missing"))?;
        match argument.as_str() {
            "--case" => case = Some(value.parse::<u64>()?),
            "--count" => count = value.parse::<u64>()?,
            "--out" => out = Some(PathBuf::from(value)),
            _ => return Err(format!("{argument}: --case N --out DIR [--count K]").into()),
        }
    }
    let (Some(first), Some(out)) = (case, out) else {
        return Err("--case N --out DIR [--count K]".into());
    };
    for number in first..first + count {
        let folder = out.join(number.to_string());
        Case::new(number).generate().write(&folder)?;
        println!("{}", folder.display());
    }
    Ok(())
}
