//! How long a million messages of seven joints take to be read: `cargo run --release -p
//! denavit-logs --example reading_speed`.

use denavit_logs::{Found, McapRows, Opening, open, write_mcap};
use std::error::Error;
use std::fs;
use std::time::Instant;

const MESSAGES: usize = 1_000_000;
const JOINTS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let mut columns = vec!["t".to_owned()];
    for prefix in ["q", "qd", "tau"] {
        columns.extend((0..JOINTS).map(|joint| format!("{prefix}_arm_joint_{joint}")));
    }
    let width = columns.len();
    let value = |at: usize| match at % width {
        0 => 1e-3 * (at / width) as f64,
        column => (1e-3 * (at / width) as f64 * column as f64).sin(),
    };
    let values: Vec<f64> = (0..MESSAGES * width).map(value).collect();
    let bytes = write_mcap(&McapRows { header: &[], columns: &columns, values: &values })?;
    let file = tempfile::NamedTempFile::new()?;
    fs::write(file.path(), &bytes)?;
    println!("{MESSAGES} messages of {JOINTS} joints, {} MB", bytes.len() / 1_000_000);
    drop(bytes);
    for _ in 0..3 {
        let started = Instant::now();
        let log = open(file.path(), None, &Opening::default()).map_err(|all| format!("{all:?}"))?;
        let places: Option<Vec<usize>> = columns
            .iter()
            .map(|name| match log.find(name) {
                Found::At(place) => Some(place),
                _ => None,
            })
            .collect();
        let places = places.ok_or("a column is missing")?;
        let table = log.read(&places, &places[1..2]).map_err(|all| format!("{all:?}"))?;
        println!("{} rows in {:.3} s", table.rows(), started.elapsed().as_secs_f64());
    }
    Ok(())
}
