//! STL: triangles, in binary or as text.

use super::{Triangle, push};

/// Bytes before the triangles, the number of which are the last four, and of each triangle: a
/// normal, three corners, and two bytes of its own.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;
const NORMAL: usize = 12;

pub(super) fn triangles(bytes: &[u8], room: usize) -> Result<Vec<Triangle>, String> {
    let said = bytes.get(HEAD - 4..HEAD).and_then(|count| count.try_into().ok());
    let said = said.map(u32::from_le_bytes).and_then(|count| usize::try_from(count).ok());
    let is_whole = |count: usize| count.checked_mul(TRIANGLE) == bytes.len().checked_sub(HEAD);
    if said.is_some_and(is_whole) {
        return binary(&bytes[HEAD..], room);
    }
    match str::from_utf8(bytes) {
        Ok(text) if text.trim_start().starts_with("solid") => written(text, room),
        _ => Err(match said {
            Some(count) => format!(
                "it is cut or no STL: {} bytes, where its head says {count} triangles",
                bytes.len()
            ),
            None => "it is no STL".to_owned(),
        }),
    }
}

fn binary(triangles: &[u8], room: usize) -> Result<Vec<Triangle>, String> {
    let mut found = Vec::new();
    for triangle in triangles.chunks_exact(TRIANGLE) {
        let corners = &triangle[NORMAL..TRIANGLE - 2];
        let mut numbers = corners.as_chunks::<4>().0.iter().map(|&four| f32::from_le_bytes(four));
        let mut next = || f64::from(numbers.next().unwrap_or(f32::NAN));
        let triangle = std::array::from_fn(|_| std::array::from_fn(|_| next()));
        push(&mut found, triangle, room)?;
    }
    Ok(found)
}

fn written(text: &str, room: usize) -> Result<Vec<Triangle>, String> {
    let mut found = Vec::new();
    let mut corners = Vec::with_capacity(3);
    for (at, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        if words.next() != Some("vertex") {
            continue;
        }
        let numbers: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        let corner = numbers.and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
        let Some(corner) = corner else {
            return Err(format!("line {}: a vertex has three numbers", at + 1));
        };
        corners.push(corner);
        if let [a, b, c] = corners[..] {
            push(&mut found, [a, b, c], room)?;
            corners.clear();
        }
    }
    match corners.len() {
        0 => Ok(found),
        _ => Err("it is cut: its last triangle has less than three corners".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn binary_of(corners: &[[f32; 9]], said: u32) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes.extend(said.to_le_bytes());
        for nine in corners {
            bytes.extend([0; 12]);
            bytes.extend(nine.iter().flat_map(|x| x.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn both_forms_say_the_same() {
        let nine = [0.0, 0.0, 0.0, 1.5, 0.0, 0.0, 0.0, -2.0, 0.25];
        let text = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1.5 0 0\n\
                    vertex 0 -2 0.25\nendloop\nendfacet\nendsolid a\n";
        let expected = [[[0.0; 3], [1.5, 0.0, 0.0], [0.0, -2.0, 0.25]]];
        assert_eq!(triangles(&binary_of(&[nine], 1), 10).expect("binary"), expected);
        assert_eq!(triangles(text.as_bytes(), 10).expect("text"), expected);
    }

    #[test]
    fn hostile_files_are_refused() {
        let said = |bytes: &[u8]| triangles(bytes, 2).expect_err("refused");
        assert!(said(&binary_of(&[[0.0; 9]], u32::MAX)).contains("4294967295 triangles"));
        assert!(said(&binary_of(&[[0.0; 9]; 3], 3)).contains("2000000 triangles in all"));
        let whole = binary_of(&[[0.0; 9]; 2], 2);
        assert!(said(&whole[..whole.len() - 1]).contains("cut"));
        assert!(said(b"solid x\nvertex 1 2\n").contains("line 2"));
        assert!(said(b"solid x\nvertex 1 2 3\n").contains("less than three corners"));
        for length in 0..whole.len() {
            // no length of a file is a panic
            let _ = triangles(&whole[..length], 2);
        }
    }
}
