//! Arrays as text, laid out as rustfmt does.

/// Widest content of an array on one line.
const ONE_LINE: usize = 60;
/// Widest item that shares its line with others.
const SHORT: usize = 10;
/// Widest line.
const LINE: usize = 100;

/// Where an array stands.
#[derive(Clone, Copy)]
pub(super) struct Place {
    /// Columns before its lines; they are written without them.
    pub(super) indent: usize,
    /// Whether a comma follows. rustfmt then keeps a column free, in all lines.
    pub(super) followed: bool,
}

/// An array of entries, row-major.
pub(super) fn array(shape: &[usize], entries: &[&str], place: Place) -> Vec<String> {
    let Some((&rows, inner)) = shape.split_first() else {
        return vec![entries[0].to_owned()];
    };
    let stride: usize = inner.iter().product();
    let inside = Place { indent: place.indent + 4, followed: true };
    let row = |row: usize| array(inner, &entries[row * stride..(row + 1) * stride], inside);
    list((0..rows).map(row).collect(), place)
}

/// A list of items, each of one or more lines.
pub(super) fn list(items: Vec<Vec<String>>, place: Place) -> Vec<String> {
    let mut lines = vec!["[".to_owned()];
    if items.iter().all(|item| item.len() == 1) {
        let items = items.concat();
        let line = items.join(", ");
        if line.len() <= ONE_LINE {
            return vec![format!("[{line}]")];
        }
        let may_share = items.iter().all(|item| item.len() <= SHORT);
        let width = LINE - place.indent - usize::from(place.followed);
        let width = if may_share { width } else { 0 };
        for item in items {
            match lines[1..].last_mut() {
                Some(line) if line.len() + item.len() + 2 <= width => {
                    line.extend([" ", &item, ","]);
                }
                _ => lines.push(format!("    {item},")),
            }
        }
    } else {
        for mut item in items {
            item.last_mut().expect("an item has a line").push(',');
            lines.extend(item.iter().map(|line| format!("    {line}")));
        }
    }
    lines.push("]".to_owned());
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLACE: Place = Place { indent: 0, followed: false };

    #[test]
    fn short_arrays_stand_on_one_line() {
        assert_eq!(array(&[2, 2], &["a", "b", "c", "d"], PLACE), ["[[a, b], [c, d]]"]);
        assert_eq!(array(&[], &["a"], PLACE), ["a"]);
        assert_eq!(array(&[0], &[], PLACE), ["[]"]);
    }

    #[test]
    fn long_rows_stand_on_their_own_lines_and_short_items_share_theirs() {
        let entries = ["0123456789"; 10];
        let lines = array(&[2, 5], &entries, PLACE);
        let row = "    [0123456789, 0123456789, 0123456789, 0123456789, 0123456789],";
        assert_eq!(lines, ["[", row, row, "]"]);
        // Eight items and their commas are 99 columns wide with the indentation.
        let lengths = |place| array(&[10], &entries, place).iter().map(String::len).collect();
        let free: Vec<usize> = lengths(PLACE);
        assert_eq!(free, [1, 99, 27, 1]);
        let followed: Vec<usize> = lengths(Place { indent: 1, followed: true });
        assert_eq!(followed, [1, 87, 39, 1]);
        let long = ["01234567890"; 6];
        assert_eq!(array(&[6], &long, PLACE).len(), 8);
    }
}
