//! Baking: the values of the model in place of its parameter symbols.

use super::parameter::Parameter;
use super::robot::{Body, Drive, Joint, Robot};
use crate::expr::{ExprId, Node, SymbolClass, substitute};
use rustc_hash::FxHashMap;
use std::fmt;

/// Parameters without a value, which cannot be baked.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BakeError {
    /// The model.
    pub model: String,
    /// The parameters' names, in parameter order.
    pub parameters: Vec<String>,
}

impl fmt::Display for BakeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}: these parameters have no value to bake in: {}\n  hint: give each a value in the \
             model file, or leave the symbols as they are",
            self.model,
            self.parameters.join(", ")
        )
    }
}

impl std::error::Error for BakeError {}

/// The robot with the default value of every parameter in place of its symbol. Values are exact,
/// so a zero folds everything that it multiplies.
pub fn bake(robot: &Robot) -> Result<Robot, BakeError> {
    bake_where(robot, |_| true)
}

/// The robot without the parameters that it gives as 0: they are numbers in its expressions, and
/// nobody can set them.
pub fn bake_zeros(robot: &Robot) -> Robot {
    let zero = robot.dag.zero();
    let is_zero = |parameter: &Parameter| parameter.default == Some(zero);
    let mut baked = bake_where(robot, is_zero).expect("a zero is a value");
    let (zeros, kept): (Vec<Parameter>, Vec<Parameter>) =
        robot.parameters.values().cloned().partition(is_zero);
    baked.parameters = kept.into_iter().collect();
    if !zeros.is_empty() {
        let names: Vec<&str> = zeros.iter().map(|parameter| parameter.name.as_str()).collect();
        baked.assumptions.push(format!("always 0: {}", names.join(", ")));
    }
    baked
}

/// The robot with numbers for lengths, angles and gravity, and for what is known of its bodies;
/// what is identified stays a symbol.
pub fn bake_geometry(robot: &Robot) -> Result<Robot, BakeError> {
    let is_known = |parameter: &Parameter| match robot.dag.node(parameter.symbol) {
        Node::Symbol(id) => match robot.dag.symbols()[id].class {
            SymbolClass::Geometry => true,
            SymbolClass::Inertia => parameter.known && parameter.default.is_some(),
            _ => false,
        },
        _ => false,
    };
    bake_where(robot, is_known)
}

/// The robot with the default values of some parameters in place of their symbols.
pub fn bake_where(
    robot: &Robot,
    is_baked: impl Fn(&Parameter) -> bool,
) -> Result<Robot, BakeError> {
    let mut values: FxHashMap<ExprId, ExprId> = FxHashMap::default();
    let mut missing = Vec::new();
    for parameter in robot.parameters.values().filter(|parameter| is_baked(parameter)) {
        match parameter.default {
            Some(value) => _ = values.insert(parameter.symbol, value),
            None => missing.push(parameter.name.clone()),
        }
    }
    if !missing.is_empty() {
        return Err(BakeError { model: robot.name.clone(), parameters: missing });
    }
    let mut baked = robot.clone();
    let mut dag = std::mem::take(&mut baked.dag);
    for_each_expression(&mut baked, &mut |expr| {
        *expr = substitute(&mut dag, &[*expr], &values)[0];
    });
    baked.dag = dag;
    Ok(baked)
}

/// Every expression of the equations of motion.
fn for_each_expression(robot: &mut Robot, visit: &mut dyn FnMut(&mut ExprId)) {
    robot.gravity.iter_mut().for_each(&mut *visit);
    for link in robot.links.values_mut() {
        visit_joint(&mut link.joint, visit);
        if let Some(Body { mass, com, inertia, about: _ }) = &mut link.body {
            visit(mass);
            com.iter_mut().chain(inertia).for_each(&mut *visit);
        }
        if let Some(drive) = &mut link.drive {
            visit_drive(drive, visit);
        }
    }
    for contact in robot.contacts.values_mut() {
        contact.position.iter_mut().for_each(&mut *visit);
    }
    for body in &mut robot.bodies_that_must_not_touch {
        body.ends.iter_mut().flatten().chain([&mut body.radius]).for_each(&mut *visit);
    }
    for law in robot.laws.iter_mut().chain(robot.spring_laws.iter_mut().map(|own| &mut own.law)) {
        visit(&mut law.torque);
        law.states.iter_mut().flat_map(|s| [&mut s.rate, &mut s.initial]).for_each(&mut *visit);
    }
    let ground = &mut robot.ground;
    ground.point.iter_mut().chain(&mut ground.normal).for_each(&mut *visit);
}

fn visit_joint(joint: &mut Joint, visit: &mut dyn FnMut(&mut ExprId)) {
    let Joint { kind: _, a, alpha, d, theta, variables: _, spring, damping } = joint;
    [a, alpha, d, theta].into_iter().chain(damping).for_each(&mut *visit);
    if let Some(spring) = spring {
        visit(&mut spring.stiffness);
        visit(&mut spring.angle);
    }
}

fn visit_drive(drive: &mut Drive, visit: &mut dyn FnMut(&mut ExprId)) {
    let Drive {
        gear_ratio,
        rotor_inertia,
        viscous,
        coulomb,
        offset,
        series_elastic,
        return_spring,
    } = drive;
    [gear_ratio, rotor_inertia, viscous, coulomb, offset]
        .into_iter()
        .flatten()
        .for_each(&mut *visit);
    if let Some(elastic) = series_elastic {
        [&mut elastic.stiffness, &mut elastic.motor_radius, &mut elastic.load_radius]
            .into_iter()
            .for_each(&mut *visit);
    }
    if let Some(spring) = return_spring {
        visit(&mut spring.stiffness);
        visit(&mut spring.angle);
    }
}
