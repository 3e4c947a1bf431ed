//! Numbers on the command line, within what can be meant.

use std::ops::RangeInclusive;

/// Reads a number of a range; `unit` is for the message.
pub(super) fn within(
    range: RangeInclusive<f64>,
    unit: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text: &str| {
        let number: f64 = text.parse().map_err(|_| "not a number".to_owned())?;
        match range.contains(&number) {
            true => Ok(number),
            false => Err(format!("not from {} to {} {unit}", range.start(), range.end())),
        }
    }
}

/// An impulse [N s].
pub(super) fn impulse(text: &str) -> Result<f64, String> {
    within(-1e6..=1e6, "N s")(text)
}
