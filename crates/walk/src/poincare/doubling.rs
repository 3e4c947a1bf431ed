//! Period doubling: where a multiplier passes -1, a cycle of twice the steps branches off.

use super::multipliers::Multiplier;
use crate::error::Error;

/// Bisections of a range: more resolve nothing.
const HALVINGS: usize = 60;

/// Where a real multiplier of a family of cycles passes -1, between two values of its parameter;
/// none if it does not, or an even number of times. `multipliers` gives those of the cycle at a
/// value; it is asked at both ends first.
///
/// What changes its sign is the product of all 1 + multiplier.
///
/// # Errors
/// Values without a cycle.
pub fn doubling(
    multipliers: &mut dyn FnMut(f64) -> Result<Vec<Multiplier>, Error>,
    [low, high]: [f64; 2],
    resolution: f64,
) -> Result<Option<f64>, Error> {
    let mut test = |value: f64| -> Result<f64, Error> {
        let product = multipliers(value)?.iter().fold([1.0, 0.0], |[re, im], multiplier| {
            let [a, b] = [1.0 + multiplier.value[0], multiplier.value[1]];
            [re * a - im * b, re * b + im * a]
        });
        Ok(product[0])
    };
    let ((mut a, mut fa), (mut b, mut fb)) = ((low, test(low)?), (high, test(high)?));
    if fa * fb > 0.0 {
        return Ok(None);
    }
    // Illinois: false position that halves the value of an end that stays
    for _ in 0..HALVINGS {
        if (b - a).abs() <= resolution {
            break;
        }
        let middle = (a * fb - b * fa) / (fb - fa);
        let value = test(middle)?;
        if value == 0.0 {
            return Ok(Some(middle));
        }
        if value * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (middle, value);
    }
    Ok(Some(b))
}
