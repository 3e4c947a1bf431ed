//! What emitted functions are called in words: their equations, arguments and results.

use crate::function::FunctionName;
use crate::model::{About, BodyEntry, JointEntry, Parameter, Robot, Role};
use crate::program::{ArgumentShape, Counts};

/// The first sentence of a function's documentation.
pub(super) fn summary(name: FunctionName) -> &'static str {
    match name {
        FunctionName::InverseDynamics => {
            "Joint torques of a motion: tau = D(q) qdd + C(q, qd) qd + G(q) + drive torques."
        }
        FunctionName::MassMatrix => "Mass matrix D(q), symmetric.",
        FunctionName::CoriolisMatrix => {
            "Coriolis matrix C(q, qd), made of Christoffel symbols: dD/dt - 2 C is skew."
        }
        FunctionName::GravityVector => {
            "Gravity torques G(q), the gradient of the potential energy."
        }
        FunctionName::Bias => "Torques without accelerations: C(q, qd) qd + G(q) + drive torques.",
        FunctionName::DynamicsTerms => {
            "D(q), C(q, qd) and G(q) at once; they share most of their work."
        }
        FunctionName::ForwardDynamics => "Joint accelerations qdd that given torques cause.",
        FunctionName::MassMatrixSolve => "The product D(q)^-1 b.",
        FunctionName::InverseDynamicsDerivatives => {
            "Derivatives of inverse dynamics by q and by qd (that by qdd is the mass matrix)."
        }
        FunctionName::ForwardDynamicsDerivatives => {
            "Derivatives of forward dynamics by q, by qd and by tau: the linearised model."
        }
        FunctionName::LinkTransforms => "Homogeneous transforms of the link frames.",
        FunctionName::LinkJacobian => "Geometric Jacobian of a link's frame.",
        FunctionName::ContactPositions => "Positions h(q) of the contact points.",
        FunctionName::ContactJacobian => "Jacobian of the contact points: W^T = dh/dq.",
        FunctionName::ContactBias => {
            "Accelerations of the contact points without qdd: (d/dt W^T) qd."
        }
        FunctionName::ContactDerivatives => {
            "Derivatives of the contact points' velocities and accelerations by q and qd, and of \
             the torques W f of forces on them by q."
        }
        FunctionName::CenterOfMassBias => {
            "Acceleration of the centre of mass without qdd: (d/dt J) qd."
        }
        FunctionName::CentroidalMomentumMatrix => {
            "Centroidal momentum matrix A(q): the momentum about the centre of mass is A qd."
        }
        FunctionName::CentroidalMomentumBias => {
            "Derivative of the momentum about the centre of mass without qdd: (d/dt A) qd."
        }
        FunctionName::AngularMomenta => {
            "Angular momentum of the body on each joint about the centre of mass of all that moves."
        }
        FunctionName::ZeroMomentPoint => "Zero-moment point (ZMP) of a motion.",
        FunctionName::CartTableZmp => "Zero-moment point of the cart-table model.",
        FunctionName::FootRotationIndicator => "Foot rotation indicator (FRI) of a motion.",
        FunctionName::CapturePoint => "Capture point of the linear inverted pendulum.",
        FunctionName::CenterOfMass => "Position of the centre of mass of all that moves.",
        FunctionName::CenterOfMassJacobian => "Jacobian of the centre of mass of all that moves.",
        FunctionName::Momentum => {
            "Linear momentum, and angular momentum about the centre of mass of all that moves."
        }
        FunctionName::KineticEnergy => "Kinetic energy.",
        FunctionName::PotentialEnergy => "Potential energy.",
        FunctionName::StateRates => {
            "Derivatives of the states of the added effects, each per second."
        }
        FunctionName::Regressor => "Regressor R0: torques per unit of each unknown parameter.",
        FunctionName::BaseRegressor => "Regressor R: torques per unit of each base parameter.",
        FunctionName::BaseParameters => {
            "Base parameters: what `base_regressor` is multiplied with, for torques."
        }
    }
}

/// A line that says what an argument is.
pub(super) fn argument(argument: &ArgumentShape) -> &'static str {
    match argument.name {
        "q" => "joint positions (rad, m)",
        "qd" => "joint velocities (rad/s, m/s)",
        "qdd" => "joint accelerations (rad/s^2, m/s^2)",
        "tau" => "joint torques (N m, N)",
        "t" => "time (s)",
        "f" => "forces on the contact points, world frame: x, y, z of each in turn (N)",
        "states" => "states of the added effects",
        "b" => "a right-hand side, one entry for each joint",
        _ => "one entry for each joint",
    }
}

/// The documentation of a field that holds a parameter: its meaning, unit and default.
pub(super) fn parameter_field(
    robot: &Robot,
    parameter: &Parameter,
    value: Option<f64>,
    text: fn(&str) -> String,
) -> String {
    let mut doc = meaning(robot, parameter, text);
    if let Some(unit) = &parameter.unit {
        doc += &format!("; unit `{}`", unit.text());
    }
    if let Some(value) = value {
        doc += &format!("; {value:?} in the model");
    }
    wrapped("/// ", &(doc + "."))
}

/// What a parameter is: in the words of the model's file, or by what it belongs to.
fn meaning(robot: &Robot, parameter: &Parameter, text: fn(&str) -> String) -> String {
    if !parameter.doc.trim().is_empty() {
        return text(&parameter.doc).trim_end_matches('.').to_owned();
    }
    match parameter.role {
        Role::Constant => format!("Constant `{}`", parameter.name),
        Role::Unknown => format!("Unknown `{}`", parameter.name),
        Role::Effect(place) => {
            format!("`{}` of the effect `{}`", parameter.name, robot.effects[place].effect)
        }
        Role::Body(link, entry) => {
            let about = robot.links[link].body.map(|body| body.about);
            format!("{} of `{}`{}", body_entry(entry), robot.links[link].name, place(entry, about))
        }
        Role::Joint(link, entry) => {
            format!("{} of `{}`", joint_entry(entry), robot.links[link].name)
        }
    }
}

fn body_entry(entry: BodyEntry) -> &'static str {
    match entry {
        BodyEntry::Mass => "Mass",
        BodyEntry::ComX => "Centre of mass x",
        BodyEntry::ComY => "Centre of mass y",
        BodyEntry::ComZ => "Centre of mass z",
        BodyEntry::InertiaXx => "Inertia xx",
        BodyEntry::InertiaYy => "Inertia yy",
        BodyEntry::InertiaZz => "Inertia zz",
        BodyEntry::InertiaXy => "Inertia xy",
        BodyEntry::InertiaXz => "Inertia xz",
        BodyEntry::InertiaYz => "Inertia yz",
    }
}

/// In which frame, and about which point, an entry of a body is given.
fn place(entry: BodyEntry, about: Option<About>) -> &'static str {
    match (entry, about) {
        (BodyEntry::Mass, _) => "",
        (BodyEntry::ComX | BodyEntry::ComY | BodyEntry::ComZ, _) => ", in its frame",
        (_, Some(About::Origin)) => ", in its frame, about the origin",
        _ => ", in its frame, about the centre of mass",
    }
}

fn joint_entry(entry: JointEntry) -> &'static str {
    match entry {
        JointEntry::Viscous => "Viscous friction",
        JointEntry::Coulomb => "Coulomb friction",
        JointEntry::RotorInertia => "Rotor inertia",
        JointEntry::Offset => "Constant torque",
        JointEntry::GearRatio => "Gear ratio",
        JointEntry::SeriesStiffness => "Stiffness of the series spring",
        JointEntry::MotorRadius => "Pulley radius, gear side,",
        JointEntry::LoadRadius => "Pulley radius, joint side,",
        JointEntry::ReturnStiffness => "Stiffness of the one-sided spring",
        JointEntry::ReturnAngle => "Angle where the one-sided spring begins to act",
        JointEntry::SpringStiffness => "Stiffness of the joint spring",
        JointEntry::SpringAngle => "Rest position of the joint spring",
    }
}

/// Which dimensions of a function's results are the number of degrees of freedom: rows, columns.
pub(super) fn of_joints(name: FunctionName) -> (bool, bool) {
    match name {
        FunctionName::InverseDynamics
        | FunctionName::MassMatrix
        | FunctionName::CoriolisMatrix
        | FunctionName::GravityVector
        | FunctionName::Bias
        | FunctionName::DynamicsTerms
        | FunctionName::ForwardDynamics
        | FunctionName::MassMatrixSolve
        | FunctionName::InverseDynamicsDerivatives
        | FunctionName::ForwardDynamicsDerivatives => (true, true),
        FunctionName::LinkJacobian
        | FunctionName::ContactJacobian
        | FunctionName::ContactDerivatives
        | FunctionName::CentroidalMomentumMatrix
        | FunctionName::AngularMomenta
        | FunctionName::CenterOfMassJacobian => (false, true),
        FunctionName::Regressor | FunctionName::BaseRegressor => (true, false),
        FunctionName::BaseParameters
        | FunctionName::LinkTransforms
        | FunctionName::StateRates
        | FunctionName::ContactPositions
        | FunctionName::ContactBias
        | FunctionName::CenterOfMass
        | FunctionName::CenterOfMassBias
        | FunctionName::CentroidalMomentumBias
        | FunctionName::ZeroMomentPoint
        | FunctionName::CartTableZmp
        | FunctionName::FootRotationIndicator
        | FunctionName::CapturePoint
        | FunctionName::Momentum
        | FunctionName::KineticEnergy
        | FunctionName::PotentialEnergy => (false, false),
    }
}

/// `252 mul, 224 add, 6 sincos`: the kinds that occur, the prelude not among them.
pub(super) fn operations(counts: &Counts) -> String {
    let kinds = columns(counts);
    let some = kinds.iter().filter(|(name, count)| *count > 0 && *name != "prelude");
    let text: Vec<String> = some.map(|(name, count)| format!("{count} {name}")).collect();
    if text.is_empty() { "no operation".to_owned() } else { text.join(", ") }
}

/// The counts with their names, in the order of tables.
pub(super) fn columns(counts: &Counts) -> [(&'static str, usize); 9] {
    [
        ("mul", counts.mul),
        ("add", counts.add),
        ("neg", counts.neg),
        ("div", counts.div),
        ("sqrt", counts.sqrt),
        ("sincos", counts.sincos),
        ("select", counts.select),
        ("function", counts.function),
        ("prelude", counts.prelude),
    ]
}

/// Text of a model on one line, without characters that could end a comment, hide text, or be
/// taken for a link.
pub(super) fn one_line(text: &str) -> String {
    let visible = |c: char| {
        let hides = matches!(
            c,
            '\u{200b}'..='\u{200f}'
                | '\u{2028}'..='\u{202e}'
                | '\u{2060}'..='\u{2069}'
                | '\u{feff}'
        );
        if c.is_control() || hides { ' ' } else { c }
    };
    let plain: String = text.chars().map(visible).collect();
    plain.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The same, as markdown of a documentation comment.
pub(super) fn documentation(text: &str) -> String {
    let word = |word: &str| match word.starts_with("http://") || word.starts_with("https://") {
        true => format!("<{word}>"),
        false => word.replace('[', "\\[").replace(']', "\\]").replace('<', "\\<"),
    };
    one_line(text).split(' ').map(word).collect::<Vec<_>>().join(" ")
}

/// Words in lines of at most 100 columns, each after `prefix`.
pub(super) fn wrapped(prefix: &str, text: &str) -> String {
    let mut lines = String::new();
    let mut line = String::new();
    for word in text.split(' ').filter(|word| !word.is_empty()) {
        if !line.is_empty() && prefix.len() + line.chars().count() + 1 + word.chars().count() > 96 {
            lines.extend([prefix, &line, "\n"]);
            line.clear();
        }
        if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.extend([prefix, &line, "\n"]);
    lines
}
