//! The outputs of the functions for walking, with one paragraph of documentation each.

use super::balance;
use super::candidate::Candidate;
use super::centroidal;
use super::contact_derivatives::contact_derivatives;
use super::energy;
use crate::expr::{Dag, ExprId};
use crate::function::{FunctionName, Output};
use crate::model::LinkId;

const CENTER_OF_MASS_BIAS: &str = "\
    (d/dt J) qd, J the Jacobian of the centre of mass: its acceleration at qdd = 0, world frame \
    [m/s^2].";

const MOMENTUM_MATRIX: &str = "\
    A(q): A qd is the momentum, world frame. Rows: linear x, y, z [kg m/s], then angular x, y, z \
    about the centre of mass [kg m^2/s]; one column for each joint. Rotors of drives do not \
    count.";

const MOMENTUM_BIAS: &str = "\
    (d/dt A) qd: the derivative of the momentum at qdd = 0, world frame. Linear x, y, z [N], \
    then angular x, y, z about the centre of mass [N m].";

const ANGULAR_MOMENTA: &str = "\
    Angular momentum of the body that each joint moves about the centre of mass of all bodies, \
    world frame [kg m^2/s]; one row for each joint. Their sum is that of `momentum`.";

const ZERO_MOMENT_POINT: &str = "\
    The point of the ground plane about which gravity and inertia have no moment but along the \
    plane's normal, world frame [m]. Rotors of drives do not count. Not finite where the ground \
    need not press: in free flight.";

const CART_TABLE_ZMP: &str = "\
    The zero-moment point of the cart-table model, world frame [m]: the centre of mass on the \
    ground plane, minus (a - g) h / gn, where a and g are acceleration of the centre of mass and \
    gravity along the plane, h its height and gn gravity across the plane. On level ground x - \
    xdd z / g.";

const FOOT_ROTATION_INDICATOR: &str = "\
    The point of the ground plane where the ground would have to act to keep the foot still \
    (Goswami 1999), world frame [m]: the rigid body of the link has its weight but no \
    acceleration, linear or angular, all others have those of the motion. It is the zero-moment \
    point while the foot is still. It is not the fictitious zero-moment point for which the \
    joints accelerate as they do with the foot held. Rotors of drives do not count. Not finite \
    where the ground need not press.";

const CAPTURE_POINT: &str = "\
    The point of the ground plane above which the linear inverted pendulum comes to rest, world \
    frame [m]: c + v sqrt(h / gn) with c the centre of mass, taken to the plane along gravity, v \
    its velocity along the plane, h its height and gn gravity across the plane. Not a number \
    where the centre of mass is below the plane.";

/// The outputs of a function for walking.
pub(super) fn outputs(dag: &mut Dag, candidate: &Candidate<'_>, name: FunctionName) -> Vec<Output> {
    use FunctionName as F;
    let frames = candidate.frames;
    let n = frames.len();
    let made = match name {
        F::ContactDerivatives => return contact_derivatives(dag, candidate),
        F::CenterOfMassBias => {
            let bias = centroidal::center_of_mass_acceleration(dag, frames, false);
            output("center_of_mass_bias", &[3], bias.to_vec(), CENTER_OF_MASS_BIAS)
        }
        F::CentroidalMomentumMatrix => {
            let matrix = centroidal::momentum_matrix(dag, frames);
            output("centroidal_momentum_matrix", &[6, n], matrix, MOMENTUM_MATRIX)
        }
        F::CentroidalMomentumBias => {
            let bias = centroidal::momentum_bias(dag, frames);
            output("centroidal_momentum_bias", &[6], bias, MOMENTUM_BIAS)
        }
        F::AngularMomenta => {
            let own = candidate.with_own_matter(dag);
            let momenta = energy::angular_momenta(dag, &own);
            output("angular_momenta", &[n, 3], momenta.concat(), ANGULAR_MOMENTA)
        }
        F::ZeroMomentPoint => {
            let point = balance::zero_moment_point(dag, candidate);
            output("zero_moment_point", &[3], point.to_vec(), ZERO_MOMENT_POINT)
        }
        F::CartTableZmp => {
            let point = balance::cart_table_zmp(dag, candidate);
            output("cart_table_zmp", &[3], point.to_vec(), CART_TABLE_ZMP)
        }
        F::CapturePoint => {
            let point = balance::capture_point(dag, candidate);
            output("capture_point", &[3], point.to_vec(), CAPTURE_POINT)
        }
        _ => unreachable!("{name} is no function for walking, or one for each foot"),
    };
    vec![made]
}

/// The foot rotation indicator of the body that carries a link.
pub(super) fn foot_rotation_indicator(
    dag: &mut Dag,
    candidate: &Candidate<'_>,
    link: LinkId,
) -> Output {
    let point = balance::foot_rotation_indicator(dag, candidate, link);
    output("foot_rotation_indicator", &[3], point.to_vec(), FOOT_ROTATION_INDICATOR)
}

fn output(name: &'static str, shape: &[usize], entries: Vec<ExprId>, doc: &str) -> Output {
    Output { name, shape: shape.to_vec(), entries, doc: doc.to_owned(), details: Vec::new() }
}
