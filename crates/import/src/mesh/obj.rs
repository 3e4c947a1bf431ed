//! Wavefront OBJ: lines `v x y z`, whose decimals stay what they are.

use super::push;
use crate::exact::{Vector, decimal};

pub(super) fn corners(bytes: &[u8]) -> Result<Vec<Vector>, String> {
    let text = str::from_utf8(bytes).map_err(|_| "it is no text in UTF-8".to_owned())?;
    let mut found = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() != Some("v") {
            continue;
        }
        // a weight or colours may follow
        let point: Option<Vec<_>> = words.take(3).map(decimal).collect();
        let point = point.and_then(|point| Vector::try_from(point).ok());
        let Some(point) = point else {
            return Err(format!("line {}: a corner has three numbers", at + 1));
        };
        push(&mut found, point)?;
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}
