//! Where everything of a robot is, for given joint positions.

use super::space::{Transform, Vec3, add, dot, norm, scale, sub};
use super::values::Values;
use denavit_codegen::arena::Handle;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::ExprId;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{Base, Body, Contact, LinkId, Robot};
use denavit_codegen::program::{
    Evaluator, LowerError, Routine, lower, parameter_defaults, prelude_values,
};

/// A length or an angle that the model leaves open has this value in pictures [m, rad].
const OPEN_VALUE: f64 = 0.5;

/// The frames, points and the centre of mass of a robot at one configuration.
#[derive(Clone, Debug)]
pub struct Pose {
    /// Positions of the joints [rad, m].
    pub(super) q: Vec<f64>,
    /// Frame of each link, in link order.
    pub(super) frames: Vec<Transform>,
    /// Contact points, in file order \[m\].
    pub(super) contacts: Vec<Vec3>,
    /// Centre of mass of the robot \[m\], if the file gives the values that it needs.
    pub(super) center_of_mass: Option<Vec3>,
    /// A point of the ground and the direction away from it.
    pub(super) ground: [Vec3; 2],
    /// The direction away from free fall, or else from the ground.
    pub(super) up: Vec3,
    /// Parameters without a value that the picture needed, by name.
    pub(super) open: Vec<String>,
    /// Whether a floating base does not stand at 0.
    pub(super) is_lifted: bool,
}

impl Pose {
    /// The robot with all joint positions zero. A floating base is lifted until the lowest contact
    /// point touches the ground.
    pub fn zero(robot: &Robot) -> Result<Self, LowerError> {
        let mut q = vec![0.0; robot.degrees_of_freedom()];
        let pose = Self::at(robot, &q)?;
        let [point, normal] = pose.ground;
        let height = |contact: &Vec3| dot(sub(*contact, point), normal);
        let lowest = pose.contacts.iter().map(height).fold(f64::INFINITY, f64::min);
        if robot.base == Base::Fixed || !lowest.is_finite() {
            return Ok(pose);
        }
        // the first joint of a floating base slides along z of frame 0
        if let Some(lift) = q.first_mut().filter(|_| normal[2] > 1e-6) {
            *lift = -lowest / normal[2];
        }
        Ok(Self { is_lifted: lowest != 0.0, ..Self::at(robot, &q)? })
    }

    /// The robot at the joint positions `q` [rad, m], one for each degree of freedom.
    fn at(robot: &Robot, q: &[f64]) -> Result<Self, LowerError> {
        let mut values = Values::new(robot);
        let (frames, open) = frames(robot, q)?;
        let place = |values: &mut Values, point: &Contact| {
            let position = point.position.map(|c| values.number(c).unwrap_or(OPEN_VALUE));
            frames[point.link.index()].point(position)
        };
        let contacts = robot.contacts.values().map(|c| place(&mut values, c)).collect();
        let unit = |v: Vec3| super::space::direction(v);
        let mut triple = |v: [ExprId; 3]| v.map(|c| values.number(c).unwrap_or(0.0));
        let point = triple(robot.ground.point);
        let normal = unit(triple(robot.ground.normal)).unwrap_or([0.0, 0.0, 1.0]);
        let fall = robot.gravity.map(|c| values.number(c).unwrap_or(f64::NAN));
        let up = match norm(fall) {
            // a gravity of unknown strength still has a direction if it has one component
            length if length.is_nan() => direction_of_open(robot, fall).unwrap_or(normal),
            _ => unit(scale(fall, -1.0)).unwrap_or(normal),
        };
        let center_of_mass = center_of_mass(robot, &mut values, &frames);
        let ground = [point, normal];
        Ok(Self {
            q: q.to_vec(),
            frames,
            contacts,
            center_of_mass,
            ground,
            up,
            open,
            is_lifted: false,
        })
    }
}

/// The direction against a gravity of which one component is no number.
fn direction_of_open(robot: &Robot, fall: Vec3) -> Option<Vec3> {
    let open = fall.iter().position(|component| component.is_nan())?;
    let is_alone = (0..3).all(|i| i == open || fall[i] == 0.0);
    let mut up = [0.0; 3];
    let negated =
        matches!(robot.dag.node(robot.gravity[open]), denavit_codegen::expr::Node::Neg(_));
    up[open] = if negated { 1.0 } else { -1.0 };
    is_alone.then_some(up)
}

/// The frames of all links, by interpreting `link_transforms`, and the parameters left open.
fn frames(robot: &Robot, q: &[f64]) -> Result<(Vec<Transform>, Vec<String>), LowerError> {
    let derivation = derive(robot, Flavour::Tunable, &[FunctionName::LinkTransforms])
        .expect("only baking asks for values");
    let program = lower(&derivation.dag, &derivation.functions)?;
    let defaults = parameter_defaults(&program, robot);
    let named = program.parameters.iter().zip(&defaults);
    let open = named.filter(|(_, value)| value.is_none()).map(|(name, _)| name.clone()).collect();
    let parameters: Vec<f64> = defaults.iter().map(|value| value.unwrap_or(OPEN_VALUE)).collect();
    let prelude = prelude_values(&program, &parameters).expect("one value for each parameter");
    let rows = program.routines.first().map(|routine| evaluate(routine, &prelude, q));
    let frames = rows.unwrap_or_default().chunks_exact(12).map(Transform::from_rows).collect();
    Ok((frames, open))
}

fn evaluate(routine: &Routine, prelude: &[f64], q: &[f64]) -> Vec<f64> {
    let mut outputs: Vec<f64> = vec![0.0; routine.outputs.iter().map(|output| output.len()).sum()];
    Evaluator::<f64>::new(routine, prelude)
        .evaluate(&[q], &mut outputs)
        .expect("the function takes q alone");
    outputs
}

fn center_of_mass(robot: &Robot, values: &mut Values, frames: &[Transform]) -> Option<Vec3> {
    let bodies = robot.links.iter().filter_map(|(id, link)| Some((id, link.body.as_ref()?)));
    let (mut total, mut first) = (0.0, [0.0; 3]);
    for (id, body) in bodies {
        let (mass, com) = mass_and_com(values, frames, id, body)?;
        total += mass;
        first = add(first, scale(com, mass));
    }
    (total > 0.0).then(|| scale(first, 1.0 / total))
}

fn mass_and_com(
    values: &mut Values,
    frames: &[Transform],
    link: LinkId,
    body: &Body,
) -> Option<(f64, Vec3)> {
    let mass = values.number(body.mass)?;
    let [x, y, z] = body.com.map(|component| values.number(component));
    Some((mass, frames[link.index()].point([x?, y?, z?])))
}

#[cfg(test)]
mod tests {
    use super::*;
    use denavit_plants::shipped;

    fn pose(name: &str) -> (Robot, Pose) {
        let text = shipped::find(name).expect("a shipped model").text;
        let robot = denavit_codegen::model::read(name, text.as_bytes()).expect("a model");
        let pose = Pose::zero(&robot).expect("numbers");
        (robot, pose)
    }

    fn assert_near(found: f64, expected: f64, what: &str) {
        assert!((found - expected).abs() < 1e-12, "{what}: {found}, expected {expected}");
    }

    /// Table 3.2 of the thesis: the lengths from the torso's top down, the hips' distance.
    #[test]
    fn tulip_stands_on_its_soles_as_tall_as_its_links_add_up_to() {
        let (robot, pose) = pose("tulip");
        let [l6z, l8z, l9, l10, l11] = [0.34, 0.035, 0.275, 0.275, 0.01];
        let base = robot.find_link("base_pitch").expect("the base");
        assert_near(pose.frames[base.index()].origin[2], l6z + l8z + l9 + l10 + l11, "height");
        for contact in &pose.contacts {
            assert_near(contact[2], 0.0, "sole");
        }
        let [l6y, l8y, inner, outer] = [0.145, 0.065, 0.065, 0.085];
        let sides: Vec<f64> = pose.contacts.iter().map(|contact| contact[1]).collect();
        for (contact, side) in robot.contacts.values().zip(sides) {
            let reach = if contact.name.ends_with("inner") { -inner } else { outer };
            let sign = if contact.name.starts_with("left") { 1.0 } else { -1.0 };
            assert_near(side, sign * (l6y - l8y + reach), &contact.name);
        }
    }

    /// Equal legs: the centre of mass lies in the plane of symmetry.
    #[test]
    fn the_centre_of_mass_of_tulip_is_in_its_middle() {
        let (_, pose) = pose("tulip");
        assert_near(pose.center_of_mass.expect("all masses are given")[1], 0.0, "sideways");
    }

    #[test]
    fn the_pendulum_hangs_from_gravity_along_y() {
        let (_, pose) = pose("double_pendulum");
        assert_eq!(pose.up, [0.0, 1.0, 0.0]);
        assert_near(pose.frames[1].origin[0], 0.9, "both links along x");
    }
}
