//! STL: triangles, in binary or as text. Single numbers of the binary form are read as the
//! shortest decimals that say them: the author wrote 0.095, and not the nearest power of two.

use super::push;
use crate::exact::{Vector, decimal};

/// Bytes before the triangles, the number of which are the last four, and of each triangle: a
/// normal, three corners, and two bytes of its own.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;
const NORMAL: usize = 12;

pub(super) fn corners(bytes: &[u8]) -> Result<Vec<Vector>, String> {
    let said = bytes.get(HEAD - 4..HEAD).and_then(|count| count.try_into().ok());
    let said = said.map(u32::from_le_bytes).and_then(|count| usize::try_from(count).ok());
    let is_whole = |count: usize| count.checked_mul(TRIANGLE) == bytes.len().checked_sub(HEAD);
    if said.is_some_and(is_whole) {
        return binary(&bytes[HEAD..]);
    }
    match str::from_utf8(bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => written(text),
        _ => Err(match said {
            Some(count) => format!(
                "it is cut or no STL: {} bytes, where its head says {count} triangles",
                bytes.len()
            ),
            None => "it is no STL".to_owned(),
        }),
    }
}

fn binary(triangles: &[u8]) -> Result<Vec<Vector>, String> {
    let mut found: Vec<[f32; 3]> = Vec::new();
    for (at, triangle) in triangles.chunks_exact(TRIANGLE).enumerate() {
        let corners = &triangle[NORMAL..TRIANGLE - 2];
        let mut numbers = corners.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes));
        for _ in 0..3 {
            // 0 has one sign
            let corner = std::array::from_fn(|_| numbers.next().unwrap_or(f32::NAN) + 0.0);
            if corner.iter().any(|x| !x.is_finite()) {
                return Err(format!("a corner of triangle {} is not finite", at + 1));
            }
            push(&mut found, corner)?;
        }
    }
    found.sort_unstable_by(|a, b| {
        let mut axes = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
        axes.find(|order| order.is_ne()).unwrap_or(std::cmp::Ordering::Equal)
    });
    found.dedup();
    let exact = |corner: [f32; 3]| {
        let numbers: Option<Vec<_>> = corner.iter().map(|x| decimal(&format!("{x:e}"))).collect();
        numbers.and_then(|numbers| Vector::try_from(numbers).ok())
    };
    let exact: Option<Vec<Vector>> = found.into_iter().map(exact).collect();
    exact.ok_or_else(|| "a corner is no number".to_owned())
}

fn written(text: &str) -> Result<Vec<Vector>, String> {
    let mut found = Vec::new();
    for (at, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let point: Option<Vec<_>> = words.map(decimal).collect();
        let point = point.and_then(|point| Vector::try_from(point).ok());
        let Some(point) = point else {
            return Err(format!("line {}: a vertex has three numbers", at + 1));
        };
        push(&mut found, point)?;
    }
    found.sort_unstable();
    found.dedup();
    Ok(found)
}
