//! Units as people write them: kg·m², where files have `kg m^2`.

/// What units are made of.
const UNITS: [&str; 13] = ["kg", "m", "s", "rad", "N", "J", "W", "A", "V", "Hz", "mm", "K", "1"];

/// A unit.
pub(crate) fn unit(text: &str) -> String {
    // of a pure number nothing is written
    if text == "1" {
        return String::new();
    }
    if !is_unit(text) {
        return text.to_owned();
    }
    // nor where a unit begins with one: the gain of a speed is in s/rad
    let text = text.strip_prefix("1 ").unwrap_or(text);
    let dotted = text.replace(' ', "\u{b7}");
    [("^2", "\u{b2}"), ("^3", "\u{b3}"), ("^-1", "\u{207b}\u{b9}")]
        .into_iter()
        .fold(dotted, |text, (from, to)| text.replace(from, to))
}

/// A text in which units stand in brackets.
pub(crate) fn with_units(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut rest = text;
    while let Some((before, inside)) = rest.split_once('[') {
        let Some((inside, after)) = inside.split_once(']') else { break };
        let units: Vec<String> = inside.split(", ").map(unit).collect();
        out.push_str(&format!("{before}[{}]", units.join(", ")));
        rest = after;
    }
    out + rest
}

fn is_unit(text: &str) -> bool {
    let mut words = text.split([' ', '/', '(', ')']).filter(|word| !word.is_empty());
    let is_known = |word: &str| {
        let (symbol, power) = word.split_once('^').unwrap_or((word, "1"));
        UNITS.contains(&symbol) && power.parse::<i8>().is_ok()
    };
    !text.is_empty() && words.all(is_known)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_have_dots_and_powers_and_words_stay() {
        assert_eq!(unit("kg m^2"), "kg·m²");
        assert_eq!(unit("N m s/rad"), "N·m·s/rad");
        assert_eq!(unit("of the motor"), "of the motor");
        assert_eq!(unit("1"), "");
        assert_eq!(unit("1 s/rad"), "s/rad");
        assert_eq!(unit("1/s"), "1/s");
        assert_eq!(with_units("torque [N m, N] of [a b]"), "torque [N·m, N] of [a b]");
        assert_eq!(with_units("open [N m"), "open [N m");
    }
}
