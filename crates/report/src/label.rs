//! Names beside points, where they hide least.

use super::camera::Vec2;
use super::cells::Cells;

/// Height of letters, and width of one on average [px].
pub(super) const LETTER: Vec2 = [6.3, 11.0];

/// A name with its place.
#[derive(Clone, Debug)]
pub(super) struct Label {
    pub(super) text: String,
    /// The point that it names.
    pub(super) point: Vec2,
    /// The middle of its left edge.
    pub(super) place: Vec2,
    /// Whether it stands so far away that a line must lead to it.
    pub(super) is_far: bool,
}

/// A rectangle: left, top, right, bottom.
#[derive(Clone, Copy, Debug)]
struct Rectangle([f64; 4]);

impl Rectangle {
    fn holds(&self, point: Vec2) -> bool {
        let [left, top, right, bottom] = self.0;
        (left..=right).contains(&point[0]) && (top..=bottom).contains(&point[1])
    }

    /// The area that two rectangles share.
    fn shared(&self, other: &Self) -> f64 {
        let (a, b) = (self.0, other.0);
        let wide = a[2].min(b[2]) - a[0].max(b[0]);
        let tall = a[3].min(b[3]) - a[1].max(b[1]);
        wide.max(0.0) * tall.max(0.0)
    }
}

/// Directions in which a name may stand from its point, the preferred one first.
const DIRECTIONS: [Vec2; 12] = [
    [1.0, 0.0],
    [-1.0, 0.0],
    [0.9, -0.5],
    [0.9, 0.5],
    [-0.9, -0.5],
    [-0.9, 0.5],
    [0.5, -0.9],
    [0.5, 0.9],
    [-0.5, -0.9],
    [-0.5, 0.9],
    [0.0, -1.0],
    [0.0, 1.0],
];

/// Distances of a name from its point [px].
const DISTANCES: [f64; 8] = [10.0, 16.0, 22.0, 32.0, 44.0, 58.0, 74.0, 92.0];

/// Places names one after the other, within a picture of the given size [px].
#[derive(Debug)]
pub(super) struct Labels {
    size: Vec2,
    /// Points that names should not hide.
    obstacles: Cells<Vec2>,
    taken: Vec<Rectangle>,
    /// Numbers of the rectangles that are taken.
    places: Cells<usize>,
    /// The names, placed.
    pub(super) placed: Vec<Label>,
}

impl Labels {
    pub(super) fn new(size: Vec2) -> Self {
        let [_, tall] = LETTER;
        Self {
            size,
            // a name has cells within it, and a rectangle lies in few
            obstacles: Cells::new(size, tall / 3.0),
            taken: Vec::new(),
            places: Cells::new(size, 3.0 * tall),
            placed: Vec::new(),
        }
    }

    /// Keeps names away from a line.
    pub(super) fn avoid(&mut self, from: Vec2, to: Vec2) {
        const STEP: f64 = 4.0;
        let length = (to[0] - from[0]).hypot(to[1] - from[1]);
        let steps = (length / STEP).ceil().clamp(1.0, 1000.0) as usize;
        for step in 0..=steps {
            let part = step as f64 / steps as f64;
            let point = [0, 1].map(|side| from[side] + part * (to[side] - from[side]));
            self.obstacles.push(point, point);
        }
    }

    /// Keeps names out of a rectangle: left, top, right, bottom.
    pub(super) fn reserve(&mut self, rectangle: [f64; 4]) {
        self.take(Rectangle(rectangle));
    }

    fn take(&mut self, rectangle: Rectangle) {
        self.places.push_over(rectangle.0, self.taken.len());
        self.taken.push(rectangle);
    }

    /// Places a name beside its point.
    pub(super) fn place(&mut self, text: &str, point: Vec2) {
        let width = text.chars().count() as f64 * LETTER[0];
        let mut best: Option<(f64, Vec2, Rectangle, bool)> = None;
        for (ring, distance) in DISTANCES.into_iter().enumerate() {
            for (turn, way) in DIRECTIONS.into_iter().enumerate() {
                let place = beside(point, way, distance, width);
                let rectangle = outline(place, width);
                let least = best.as_ref().map_or(f64::INFINITY, |(least, ..)| *least);
                let away = ring as f64 * 11.0 + turn as f64;
                if let Some(burden) = self.burden(&rectangle, away, least) {
                    best = Some((burden, place, rectangle, ring > 1));
                }
            }
        }
        if let Some((_, place, rectangle, is_far)) = best {
            self.take(rectangle);
            if is_far {
                self.avoid(point, place);
            }
            self.placed.push(Label { text: text.to_owned(), point, place, is_far });
        }
    }

    /// How bad this place of a name is, which is so far `away`: by what it would hide; none if that
    /// is not below the `least` that another place has.
    fn burden(&self, rectangle: &Rectangle, away: f64, least: f64) -> Option<f64> {
        let [left, top, right, bottom] = rectangle.0;
        let outside =
            left < 6.0 || top < 6.0 || right > self.size[0] - 6.0 || bottom > self.size[1] - 6.0;
        let outside = if outside { 1e4 } else { 0.0 };
        let mut hidden = 0;
        for met in self.obstacles.met(rectangle.0) {
            hidden += match met.is_inside {
                true => met.things.len(),
                false => met.things.iter().filter(|&&point| rectangle.holds(point)).count(),
            };
            if away + (hidden as f64 * 9.0 + outside) >= least {
                return None;
            }
        }
        let near = self.places.met(rectangle.0).flat_map(|met| met.things);
        let mut near: Vec<usize> = near.copied().collect();
        near.sort_unstable();
        near.dedup();
        let overlap: f64 = near.iter().map(|&taken| self.taken[taken].shared(rectangle)).sum();
        let burden = away + (hidden as f64 * 9.0 + overlap * 3.0 + outside);
        // the first place is taken however bad it is
        (burden < least || least == f64::INFINITY).then_some(burden)
    }
}

/// The middle of the left edge of a name that stands in direction `way` of its point.
fn beside(point: Vec2, way: Vec2, distance: f64, width: f64) -> Vec2 {
    let x = point[0] + way[0] * distance;
    let left = if way[0] > 0.3 {
        x
    } else if way[0] < -0.3 {
        x - width
    } else {
        x - width / 2.0
    };
    [left, point[1] + way[1] * distance]
}

fn outline(place: Vec2, width: f64) -> Rectangle {
    let half = LETTER[1] / 2.0 + 2.0;
    Rectangle([place[0] - 2.0, place[1] - half, place[0] + width + 2.0, place[1] + half])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_one_point_do_not_cover_each_other() {
        let mut labels = Labels::new([400.0, 300.0]);
        for _ in 0..6 {
            labels.place("a_name", [200.0, 150.0]);
        }
        for (index, a) in labels.taken.iter().enumerate() {
            for b in &labels.taken[..index] {
                assert_eq!(a.shared(b), 0.0, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn a_name_at_the_edge_stays_in_the_picture() {
        let mut labels = Labels::new([400.0, 300.0]);
        labels.place("a_rather_long_name", [395.0, 2.0]);
        let [left, top, right, bottom] = labels.taken[0].0;
        assert!(left >= 0.0 && top >= 0.0 && right <= 400.0 && bottom <= 300.0);
    }
}
