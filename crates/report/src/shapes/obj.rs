//! Wavefront OBJ: lines `v x y z` and `f a b c ..`, whose polygons become fans.

use super::{MOST_READ, Triangle, push};
use crate::space::Vec3;

pub(super) fn triangles(bytes: &[u8], room: usize) -> Result<Vec<Triangle>, String> {
    let text = str::from_utf8(bytes).map_err(|_| "it is no text in UTF-8".to_owned())?;
    let (mut corners, mut found): (Vec<Vec3>, _) = (Vec::new(), Vec::new());
    for (at, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                // a weight or colours may follow
                let numbers: Option<Vec<f64>> =
                    words.take(3).map(|word| word.parse().ok()).collect();
                let corner = numbers.and_then(|numbers| Vec3::try_from(numbers).ok());
                let Some(corner) = corner else {
                    return Err(format!("line {}: a corner has three numbers", at + 1));
                };
                if corners.len() == MOST_READ {
                    return Err(format!("it has more than {MOST_READ} corners"));
                }
                corners.push(corner);
            }
            Some("f") => {
                let seen: Option<Vec<Vec3>> = words.map(|word| corner_of(word, &corners)).collect();
                let Some(seen) = seen.filter(|seen| seen.len() > 2) else {
                    return Err(format!("line {}: a face has three corners of the file", at + 1));
                };
                for pair in seen[1..].windows(2) {
                    push(&mut found, [seen[0], pair[0], pair[1]], room)?;
                }
            }
            _ => {}
        }
    }
    Ok(found)
}

/// The corner of a word `7`, `7/1/3`, or `-1` for the last one so far.
fn corner_of(word: &str, corners: &[Vec3]) -> Option<Vec3> {
    let number: i64 = word.split('/').next()?.parse().ok()?;
    let place = match number {
        0 => None,
        1.. => usize::try_from(number - 1).ok(),
        _ => corners.len().checked_sub(usize::try_from(number.unsigned_abs()).ok()?),
    };
    corners.get(place?).copied()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polygons_become_fans() {
        let text = "# a square\nv 0 0 0\nv 1 0 0 1\nv 1 1 0\nv 0 1 0\nf 1/1/1 2 3//2 -1\n";
        let found = triangles(text.as_bytes(), 10).expect("a square");
        let [a, b, c, d] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
        assert_eq!(found, [[a, b, c], [a, c, d]]);
    }

    #[test]
    fn hostile_files_are_refused() {
        let said = |text: &str| triangles(text.as_bytes(), 2).expect_err("refused");
        assert!(said("v 1 2\n").contains("line 1"));
        assert!(said("v 0 0 0\nf 1 2 3\n").contains("line 2"));
        assert!(said("v 0 0 0\nf -9223372036854775808 1 1\n").contains("line 2"));
        assert!(said("v 0 0 0\nf 1 1\n").contains("three corners"));
        assert!(said("v 0 0 0\nf 1 1 1 1 1\n").contains("triangles in all"));
        assert!(triangles(&[0xff, 0xfe], 2).is_err());
    }
}
