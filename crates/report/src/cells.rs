//! A picture in square cells: what lies in a small rectangle is found without a look at all.

use super::camera::Vec2;

/// Things of a picture by the cells in which they lie. What lies outside the picture is in the
/// cells at its edge.
#[derive(Debug)]
pub(super) struct Cells<T> {
    /// Side of a cell [px].
    side: f64,
    columns: usize,
    cells: Vec<Vec<T>>,
}

/// A cell that a rectangle meets.
pub(super) struct Met<'a, T> {
    pub(super) things: &'a [T],
    /// Whether the rectangle holds all of it.
    pub(super) is_inside: bool,
}

impl<T: Copy> Cells<T> {
    /// Empty cells of a picture of this size [px].
    pub(super) fn new(size: Vec2, side: f64) -> Self {
        let [columns, rows] = size.map(|length| (length / side).ceil().clamp(1.0, 1e4) as usize);
        Self { side, columns, cells: vec![Vec::new(); columns * rows] }
    }

    /// Column and row of a place; what is no number is in the first.
    fn at(&self, place: Vec2) -> [usize; 2] {
        let rows = self.cells.len() / self.columns;
        let index = |at: f64, count: usize| ((at / self.side) as usize).min(count - 1);
        [index(place[0], self.columns), index(place[1], rows)]
    }

    pub(super) fn push(&mut self, place: Vec2, thing: T) {
        let [column, row] = self.at(place);
        self.cells[row * self.columns + column].push(thing);
    }

    /// Puts a thing into every cell that a rectangle (left, top, right, bottom) meets.
    pub(super) fn push_over(&mut self, rectangle: [f64; 4], thing: T) {
        let [left, top, right, bottom] = rectangle;
        let ([first, upper], [last, lower]) = (self.at([left, top]), self.at([right, bottom]));
        for row in upper..=lower {
            for column in first..=last {
                self.cells[row * self.columns + column].push(thing);
            }
        }
    }

    /// The cells that a rectangle meets. Those at its border may hold more than it.
    pub(super) fn met(&self, rectangle: [f64; 4]) -> impl Iterator<Item = Met<'_, T>> {
        let [left, top, right, bottom] = rectangle;
        let ([first, upper], [last, lower]) = (self.at([left, top]), self.at([right, bottom]));
        (upper..=lower).flat_map(move |row| {
            (first..=last).map(move |column| Met {
                things: &self.cells[row * self.columns + column],
                is_inside: first < column && column < last && upper < row && row < lower,
            })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rectangle_meets_what_lies_in_it() {
        let mut cells = Cells::new([100.0, 60.0], 7.0);
        let places =
            (0..400).map(|k| [f64::from(k % 23) * 6.1 - 20.0, f64::from(k % 17) * 5.3 - 10.0]);
        let places: Vec<Vec2> = places.collect();
        places.iter().for_each(|&place| cells.push(place, place));
        for rectangle in [[-5.0, -3.0, 40.0, 33.0], [50.0, 20.0, 130.0, 90.0], [3.0, 3.0, 4.0, 4.0]]
        {
            let [left, top, right, bottom] = rectangle;
            let holds = |place: &&Vec2| {
                (left..=right).contains(&place[0]) && (top..=bottom).contains(&place[1])
            };
            let found: usize = cells
                .met(rectangle)
                .map(|met| match met.is_inside {
                    true => met.things.len(),
                    false => met.things.iter().filter(holds).count(),
                })
                .sum();
            assert_eq!(found, places.iter().filter(holds).count(), "{rectangle:?}");
        }
    }
}
