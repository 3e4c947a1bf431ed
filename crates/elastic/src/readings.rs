//! Whether the columns of a motor behind a spring are what they are taken for: its angle against
//! that of the joint times the gear ratio, its torque against the spring of the model.

use super::Estimate;
use crate::policy::{OTHER, SURE, TURNS, WRONG_SPRING};
use denavit_identify::{Error, ErrorKind};
use denavit_numerics::products;
use std::f64::consts::TAU;

/// How near a mistake explains a ratio.
fn explains(ratio: f64, slack: f64) -> bool {
    (1.0 / slack..slack).contains(&ratio)
}

/// The factor, of those that mend known mistakes, that brings a ratio nearest to 1.
fn mending(
    ratio: f64,
    slack: f64,
    mistakes: &[(f64, &'static str)],
) -> Option<(f64, &'static str)> {
    let distance = |scale: f64| (ratio * scale).ln().abs();
    let all = mistakes.iter().filter(|(scale, _)| explains(ratio * scale, slack));
    all.copied().min_by(|a, b| distance(a.0).total_cmp(&distance(b.0)))
}

/// Slope and correlation of a signal over what it is expected to be, both without their means;
/// none if nothing is expected.
fn compared(found: &[f64], expected: &[f64]) -> Option<(f64, f64)> {
    let [both, of_found, of_expected] = products(found, expected);
    let size = (of_found * of_expected).sqrt().max(f64::MIN_POSITIVE);
    (of_expected > 0.0).then_some((both / of_expected, both / size))
}

/// The angle of the motor is that of the joint times the turns of the gear, nearly.
pub(super) fn check_angles(joint: &str, motor: &[f64], q: &[f64], turns: f64) -> Result<(), Error> {
    let expected: Vec<f64> = q.iter().map(|q| turns * q).collect();
    // a joint that rests is another fault
    let Some((ratio, correlation)) = compared(motor, &expected) else { return Ok(()) };
    if (TURNS[0]..TURNS[1]).contains(&ratio) && correlation > OTHER {
        return Ok(());
    }
    let radian = 1.0_f64.to_radians();
    let mistakes = [
        (-1.0, "has it the other sign"),
        (turns, "is it the angle after the gear"),
        (-turns, "is it the angle after the gear, with the other sign"),
        (radian, "is it in degrees"),
        (-radian, "is it in degrees, with the other sign"),
        (turns * radian, "is it the angle after the gear, in degrees"),
        (TAU, "does it count turns"),
    ];
    let scale = match correlation.abs() > OTHER {
        true => mending(ratio, 1.33, &mistakes),
        false => None,
    };
    let hint = match scale {
        Some((scale, why)) => format!(
            "{why}? `logs.columns` with {{\"motor_{joint}\": {{\"scale\": {scale}}}}} mends that"
        ),
        None => "it is the motor's angle before the gear [rad]; gear ratio and radii are those of \
                 the model"
            .to_owned(),
    };
    let text = format!(
        "`motor_{joint}` turns {ratio:.4} times as far as gear and `q_{joint}` say (correlation \
         {correlation:.2})\n  hint: {hint}"
    );
    let error = Error::new(ErrorKind::Contradicting, text).of_column(format!("motor_{joint}"));
    Err(error.mended_by(scale.map(|(scale, _)| scale)))
}

/// The torque of the motor is nearly what its inertia and the spring of the model need, `expected`;
/// or off by no known mistake: springs of a model may be wrong.
pub(super) fn check_torque(
    joint: &str,
    torque: &[f64],
    expected: &[f64],
    turns: f64,
) -> Result<(), Error> {
    let Some((ratio, correlation)) = compared(torque, expected) else { return Ok(()) };
    if correlation.abs() < OTHER || explains(ratio, WRONG_SPRING) {
        return Ok(());
    }
    let mistakes = [
        (-1.0, "has it the other sign"),
        (1.0 / turns, "is it the torque after the gear"),
        (-1.0 / turns, "is it the torque after the gear, with the other sign"),
        (turns, "was it divided by the gear ratio twice (# torque_side: motor)"),
        (-turns, "was it divided by the gear ratio twice, with the other sign"),
    ];
    let Some((scale, why)) = mending(ratio, WRONG_SPRING, &mistakes) else { return Ok(()) };
    let text = format!(
        "`tau_cmd_{joint}` is {ratio:.4} times what the inertia of the motor and the spring of the \
         model need\n  hint: {why}? `logs.columns` with {{\"tau_cmd_{joint}\": {{\"scale\": \
         {scale}}}}} mends that; or write a stiffness near the true one into the model"
    );
    let error = Error::new(ErrorKind::Contradicting, text).of_column(format!("tau_cmd_{joint}"));
    Err(error.mended_by(Some(scale)))
}

/// The stiffness is above 0 by more than its error.
pub(super) fn check_stiffness(joint: &str, stiffness: Estimate) -> Result<(), Error> {
    let Estimate { value, std } = stiffness;
    if value > SURE * std {
        return Ok(());
    }
    let text = format!(
        "the spring of `{joint}` comes out as {value:.5e} +- {std:.1e} N/m: no spring is seen\n  \
         hint: its elongation must be large against the steps of the encoders `motor_{joint}` and \
         `q_{joint}`"
    );
    Err(Error::new(ErrorKind::NotExcited, text))
}
