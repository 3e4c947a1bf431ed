//! Identifies a robot from one log, judges it by another, with a progress bar and a time limit:
//! `cargo run --release --example identify_with_progress -- MODEL TRAIN.csv HELD_OUT.csv`.

use denavit::workflow::{IdentifyOptions, Logs, Progress, RobotFile, identify};
use std::env::args;
use std::error::Error;
use std::time::{Duration, Instant};

fn main() -> Result<(), Box<dyn Error>> {
    let [model, train, held_out]: [String; 3] =
        args().skip(1).collect::<Vec<_>>().try_into().map_err(|_| "MODEL TRAIN HELD_OUT")?;
    let robot = RobotFile::open(model)?;
    let started = Instant::now();
    let mut watch = |at: &Progress<'_>| {
        let bar = "#".repeat((20.0 * at.share.unwrap_or(0.0)) as usize);
        eprint!("\r\x1b[2K{:<40} [{bar:<20}]", at.stage.to_string());
        started.elapsed() < Duration::from_secs(60)
    };
    let logs = Logs::new([train], [held_out]);
    let identified = identify(&robot, &logs, &IdentifyOptions::default(), &mut watch)?;
    eprintln!();
    for one in &identified.found.parameters {
        let error = one.std.map_or("not excited".to_owned(), |std| format!("+- {std:.1e}"));
        println!("{} = {:.4} {error} {}", one.name, one.value, one.unit);
    }
    let is_answer = identified.is_good(false) && !identified.is_stopped;
    if is_answer { Ok(()) } else { Err("the logs are not explained, or the time was up".into()) }
}
