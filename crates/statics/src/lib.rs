//! Static identification (thesis 3.2.1): what follows from weighings and from gravity torques of
//! held postures, without any motion.
//!
//! A weighing gives the sum of the masses of the links that lie on the scale. A posture that is
//! held gives the row tau = Y(q, 0, 0) phi of every joint whose torque was measured: first moments
//! across the axes. Where links are held one after the other, differences of postures give them
//! link by link; least squares in all rows does the subtraction.

mod error;
mod policy;

pub use error::{Error, ErrorKind};

use crate::policy::{BETTER, FAR, NEAR, OF_ANGLES, OF_TORQUES, OTHER_UNIT};
use denavit_codegen::expr::text::nearest;
use denavit_numerics::Equations;
use denavit_plants::regression::{RegressionJoint, RegressionModel, RegressionRows};
use nalgebra::{DMatrix, DVector};

/// Something that was measured at rest.
#[derive(Clone, Debug, PartialEq)]
pub enum StaticMeasurement {
    /// The mass of links on a scale.
    Weighing {
        /// Their names.
        links: Vec<String>,
        /// Their mass together \[kg\].
        mass_kg: f64,
        /// Its standard deviation \[kg\].
        std_kg: f64,
    },
    /// Torques that hold a posture.
    Posture {
        /// Positions of all joints, in the order of q [rad, m].
        q: Vec<f64>,
        /// The torques that were measured.
        torques: Vec<HoldingTorque>,
    },
}

/// A torque that holds a joint.
#[derive(Clone, Debug, PartialEq)]
pub struct HoldingTorque {
    /// The joint's name.
    pub joint: String,
    /// The torque along the joint axis [N m, N].
    pub torque: f64,
    /// Its standard deviation, with half of the stiction that hides in it [N m, N].
    pub std: f64,
}

/// Whether weighings and postures seem to be in the units that the model has.
///
/// # Errors
/// Those that do not: what is known of them may still be in order.
pub fn check_units(
    model: &RegressionModel,
    measurements: &[StaticMeasurement],
) -> Result<(), Error> {
    let mass = |link: &String| {
        let name = format!("m_{link}");
        model.standard.iter().find(|one| one.name == name)?.value
    };
    let suspicious = |(at, measurement): (usize, &StaticMeasurement)| {
        let StaticMeasurement::Weighing { links, mass_kg, .. } = measurement else { return None };
        let expected: f64 = links.iter().map(mass).sum::<Option<f64>>()?;
        let is_other = expected > 0.0
            && *mass_kg > 0.0
            && (*mass_kg > OTHER_UNIT * expected || *mass_kg * OTHER_UNIT < expected);
        let unit = if *mass_kg > expected { "grams" } else { "tonnes" };
        let text = format!(
            "{mass_kg} kg, and the model says {expected} kg: is it in {unit}?\n  hint: \
             `logs.accepts_suspicious` takes it as it is"
        );
        is_other.then(|| Error::of_measurement(at, text))
    };
    let weighed = measurements.iter().enumerate().filter_map(suspicious);
    let faults: Vec<Error> = weighed.chain(misread_postures(model, measurements)).collect();
    if faults.is_empty() { Ok(()) } else { Err(faults.into()) }
}

/// The unit of torques or positions with which the nominal parameters make far more of what holds
/// the postures; none if the model lacks one, or there are no two torques.
fn misread_postures(model: &RegressionModel, measurements: &[StaticMeasurement]) -> Option<Error> {
    let phi = model.model_axes()?;
    let left = |of_angles: f64, of_torques: f64| -> Option<f64> {
        let (mut sums, mut count) = ([0.0; 2], 0);
        for measurement in measurements {
            let StaticMeasurement::Posture { q, torques } = measurement else { continue };
            if q.len() != model.joints.len() {
                return None;
            }
            let of_joint = |(q, joint): (&f64, &RegressionJoint)| {
                if joint.slides { *q } else { of_angles * q }
            };
            let q = q.iter().zip(&model.joints).map(of_joint);
            let resting: Vec<Vec<f64>> = resting(q, model).into_iter().map(|q| vec![q]).collect();
            let computed = model.torques(&resting, &phi);
            for torque in torques {
                let joint = model.joints.iter().position(|joint| joint.name == torque.joint)?;
                let measured = of_torques * torque.torque;
                sums[0] += (measured - computed[joint][0]).powi(2);
                sums[1] += measured * measured;
                count += 1;
            }
        }
        (count > 1 && sums[1] > 0.0).then(|| (sums[0] / sums[1]).sqrt())
    };
    let before = left(1.0, 1.0).filter(|before| *before > FAR)?;
    let torques = OF_TORQUES.into_iter().map(|factor| (true, factor));
    let tried = torques.chain(OF_ANGLES.into_iter().map(|factor| (false, factor)));
    let judged = tried.filter_map(|(of_torques, factor)| {
        let after = if of_torques { left(1.0, factor) } else { left(factor, 1.0) };
        Some((of_torques, factor, after.filter(|left| *left < NEAR.min(BETTER * before))?))
    });
    let (of_torques, factor, after) = judged.min_by(|a, b| a.2.total_cmp(&b.2))?;
    let what = if of_torques { "torques" } else { "positions" };
    let how = if factor == -1.0 { "have the wrong sign" } else { "be in another unit" };
    let text = format!(
        "{what} of the postures seem to {how}: with the nominal parameters the residual is {:.0} % \
         of the torques, and {:.0} % with {factor} times the {what}\n  hint: \
         `logs.accepts_suspicious` takes them as they are",
        100.0 * before,
        100.0 * after
    );
    Some(Error::of_all(text))
}

/// Positions of joints with rates and accelerations of 0.
fn resting(q: impl Iterator<Item = f64>, model: &RegressionModel) -> Vec<f64> {
    q.chain(std::iter::repeat_n(0.0, 2 * model.joints.len())).collect()
}

/// What measurements at rest say of the standard parameters, or all that is wrong with them.
///
/// Coulomb friction and viscous friction have no part in it: a joint at rest has no rate.
pub fn static_knowledge(
    model: &RegressionModel,
    measurements: &[StaticMeasurement],
) -> Result<Equations, Error> {
    let mut knowledge = Equations::none(model.standard.len());
    let mut faults = Vec::new();
    let mut evaluator = model.evaluator();
    for (at, measurement) in measurements.iter().enumerate() {
        match measurement {
            StaticMeasurement::Weighing { links, mass_kg, std_kg } => {
                let members = masses(model, at, links, &mut faults);
                if !(mass_kg.is_finite() && *std_kg > 0.0 && std_kg.is_finite()) {
                    faults.push(Error::of_measurement(at, BAD_NUMBER));
                } else {
                    knowledge.add(&members, *mass_kg, *std_kg);
                }
            }
            StaticMeasurement::Posture { q, torques } => {
                let n = model.joints.len();
                if q.len() != n {
                    let text = format!("a posture has {n} positions, {} are given", q.len());
                    faults.push(Error::of_measurement(at, text));
                    continue;
                }
                let numbers = torques
                    .iter()
                    .all(|t| t.torque.is_finite() && t.std > 0.0 && t.std.is_finite());
                if !numbers || q.iter().any(|position| !position.is_finite()) {
                    faults.push(Error::of_measurement(at, BAD_NUMBER));
                    continue;
                }
                let resting = resting(q.iter().copied(), model);
                let columns: Vec<&[f64]> = resting.iter().map(std::slice::from_ref).collect();
                let mut rows = RegressionRows::default();
                evaluator.evaluate(&columns, &mut rows).expect("three numbers for each joint");
                for torque in torques {
                    hold(model, &rows, at, torque, &mut knowledge, &mut faults);
                }
            }
        }
    }
    if faults.is_empty() { Ok(knowledge) } else { Err(faults.into()) }
}

/// Adds base parameters on the joint axes that were estimated, with their covariance, to what is
/// known of the standard ones. False if the covariance leaves directions open.
pub fn add_estimate(
    knowledge: &mut Equations,
    model: &RegressionModel,
    phi: &[f64],
    covariance: &DMatrix<f64>,
) -> bool {
    // C = L L^T: L^-1 (phi - estimate) has unit covariance
    let Some(factor) = covariance.clone().cholesky() else { return false };
    let identity = DMatrix::identity(phi.len(), phi.len());
    let Some(root) = factor.l().solve_lower_triangular(&identity) else { return false };
    let values = &root * DVector::from_column_slice(phi);
    knowledge.add_rows(&(root * model.of_standard()), &values);
    true
}

/// The masses of links, with factor 1.
fn masses(
    model: &RegressionModel,
    at: usize,
    links: &[String],
    faults: &mut Vec<Error>,
) -> Vec<(usize, f64)> {
    let owners = || model.standard.iter().filter_map(|one| one.owner.as_ref());
    let mut members = Vec::new();
    if links.is_empty() {
        let text = "`links` is empty\n  hint: name the links on the scale";
        faults.push(Error::of_measurement(at, text));
    }
    for (place, link) in links.iter().enumerate() {
        if links[..place].contains(link) {
            faults.push(Error::of_measurement(at, format!("`{link}` is named twice")));
            continue;
        }
        let is_mass = |owner: &Option<(String, &'static str)>| {
            owner.as_ref().is_some_and(|(name, prefix)| name == link && *prefix == "m")
        };
        if let Some(mass) = model.standard.iter().position(|one| is_mass(&one.owner)) {
            members.push((mass, 1.0));
        } else if owners().any(|(name, _)| name == link)
            || model.joints.iter().any(|joint| joint.name == *link)
        {
            let text = format!("the mass of `{link}` is not among the unknown parameters");
            faults.push(Error::of_measurement(at, text));
        } else {
            faults.push(unknown(at, link, owners().map(|(name, _)| name.as_str())));
        }
    }
    members
}

const BAD_NUMBER: &str = "numbers must be finite, and standard deviations positive";

/// The model has no link or joint of this name.
fn unknown<'a>(at: usize, name: &str, known: impl Iterator<Item = &'a str>) -> Error {
    let hint = nearest(name, known).map(|near| format!("\n  hint: `{near}` is meant, perhaps"));
    let text = format!("nothing is called `{name}`{}", hint.unwrap_or_default());
    Error::of_measurement(at, text)
}

/// One torque of a posture: a row of Y at rest, in standard parameters.
fn hold(
    model: &RegressionModel,
    rows: &RegressionRows,
    at: usize,
    torque: &HoldingTorque,
    knowledge: &mut Equations,
    faults: &mut Vec<Error>,
) {
    let names = || model.joints.iter().map(|joint| joint.name.as_str());
    let Some(joint) = names().position(|name| name == torque.joint) else {
        faults.push(unknown(at, &torque.joint, names()));
        return;
    };
    let mut members = Vec::new();
    for (place, &phi) in model.pattern()[joint].iter().enumerate() {
        let entry = rows.column(joint, place)[0];
        if entry != 0.0 {
            let own = model.axes[phi].members.iter();
            members.extend(own.map(|&(parameter, factor)| (parameter, entry * factor)));
        }
    }
    let known = rows.known(joint).map_or(0.0, |known| known[0]);
    knowledge.add(&members, torque.torque - known, torque.std);
}
