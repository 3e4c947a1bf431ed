//! Triangles that share their corners, and no more of them than a page has room for: corners of one
//! cell become one, and what is left without an area goes (Rossignac and Borrel 1993).

use super::Triangle;
use crate::space::Vec3;
use rustc_hash::{FxHashMap, FxHashSet};

/// Corners, and triangles of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Thinned {
    pub(super) corners: Vec<Vec3>,
    pub(super) triangles: Vec<[u32; 3]>,
}

/// Cells of a first look, per size of the largest shape.
const FINE: f64 = 1e-6;
const FIRST: f64 = 1.0 / 400.0;
/// How much a cell grows at least from look to look.
const GROWS: f64 = 1.2;

/// The shapes with at most so many triangles; the size of a cell \[m\] where some had to go.
pub(super) fn thinned(
    soups: &[(i64, Vec<Triangle>)],
    most: usize,
) -> (Vec<(i64, Thinned)>, Option<f64>) {
    let corners = soups.iter().flat_map(|(_, soup)| soup.iter().flatten());
    let far = corners.flatten().fold(0.0, |far: f64, entry| far.max(entry.abs()));
    let size = far.max(1e-6);
    let all = |cell: f64| -> Vec<(i64, Thinned)> {
        soups.iter().map(|(link, soup)| (*link, welded(soup, cell))).collect()
    };
    let count =
        |all: &[(i64, Thinned)]| -> usize { all.iter().map(|(_, one)| one.triangles.len()).sum() };
    let whole = all(FINE * size);
    if count(&whole) <= most {
        return (whole, None);
    }
    let mut cell = FIRST * size;
    loop {
        let fewer = all(cell);
        let left = count(&fewer);
        if left <= most {
            return (fewer, Some(cell));
        }
        // as many triangles as cells on the surface
        cell *= (left as f64 / most as f64).sqrt().max(GROWS);
    }
}

fn welded(soup: &[Triangle], cell: f64) -> Thinned {
    let mut places: FxHashMap<[i64; 3], u32> = FxHashMap::default();
    let mut seen: FxHashSet<[u32; 3]> = FxHashSet::default();
    let mut made = Thinned::default();
    for corners in soup {
        let triangle = corners.map(|corner| {
            let key = corner.map(|entry| (entry / cell).round() as i64);
            *places.entry(key).or_insert_with(|| {
                made.corners.push(corner);
                (made.corners.len() - 1) as u32
            })
        });
        let mut sorted = triangle;
        sorted.sort_unstable();
        let is_flat = sorted[0] == sorted[1] || sorted[1] == sorted[2];
        if !is_flat && seen.insert(sorted) {
            made.triangles.push(triangle);
        }
    }
    made
}

#[cfg(test)]
mod tests {
    use super::super::solids::{block, sphere};
    use super::*;

    #[test]
    fn a_block_has_eight_corners_and_all_its_triangles() {
        let (found, cell) = thinned(&[(0, block([1.0, 2.0, 3.0]))], 100);
        assert_eq!(cell, None);
        assert_eq!((found[0].1.corners.len(), found[0].1.triangles.len()), (8, 12));
    }

    #[test]
    fn many_triangles_become_few_and_stay_where_they_were() {
        let soups: Vec<(i64, Vec<Triangle>)> = (0..3).map(|at| (at, sphere(0.2))).collect();
        let (found, cell) = thinned(&soups, 600);
        let cell = cell.expect("some had to go");
        let count: usize = found.iter().map(|(_, one)| one.triangles.len()).sum();
        assert!((100..=600).contains(&count), "{count} triangles");
        for corner in found.iter().flat_map(|(_, one)| &one.corners) {
            // corners are some that were there
            assert!((crate::space::norm(*corner) - 0.2).abs() < 1e-9 && cell < 0.2);
        }
    }
}
