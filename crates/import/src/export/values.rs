//! Values of a model as numbers.

use crate::error::Error;
use crate::fault::listed;
use denavit_codegen::expr::ExprId;
use denavit_codegen::model::{About, Body, LinkId, Robot, bake};
use denavit_codegen::number::Rational;
use denavit_codegen::program::constant_values;
use num_traits::Zero;

/// A model with numbers for all of its parameters.
pub(super) struct Numbers {
    pub(super) robot: Robot,
}

/// A body about its centre of mass.
pub(super) struct BodyNumbers {
    pub(super) mass: Rational,
    pub(super) com: [Rational; 3],
    /// xx, yy, zz, xy, xz, yz.
    pub(super) inertia: [Rational; 6],
}

/// What a format does not say; a URDF says neither gravity nor springs.
pub(super) fn notes(numbers: &Numbers, is_urdf: bool) -> Vec<String> {
    let robot = &numbers.robot;
    let mut notes = Vec::new();
    let gravity = robot.gravity.map(|entry| numbers.number(entry));
    if is_urdf && gravity != [0.0, 0.0, -9.81] {
        notes.push(format!("gravity is {gravity:?} here, which a URDF cannot say"));
    }
    let with = |has: &dyn Fn(LinkId) -> bool| -> Vec<String> {
        let links = robot.links.iter().filter(|(id, _)| has(*id));
        links.map(|(_, link)| link.name.clone()).collect()
    };
    let sprung = with(&|id| {
        let link = &robot.links[id];
        let drive = link.drive.unwrap_or_default();
        (is_urdf && link.joint.spring.is_some())
            || drive.series_elastic.is_some()
            || drive.return_spring.is_some()
    });
    if !sprung.is_empty() {
        notes.push(format!(
            "these have springs that the format has no place for: {}",
            listed(&sprung)
        ));
    }
    let offsets = with(&|id| robot.links[id].drive.is_some_and(|drive| drive.offset.is_some()));
    if !offsets.is_empty() {
        notes.push(format!(
            "these have constant torques that the format has no place for: {}",
            listed(&offsets)
        ));
    }
    let massless = with(&|id| {
        let body = numbers.body(id);
        body.is_some_and(|one| one.mass.is_zero() && one.inertia.iter().any(|i| !i.is_zero()))
    });
    if !massless.is_empty() {
        let links = listed(&massless);
        notes.push(format!("these have inertia and no mass, which readers may refuse: {links}"));
    }
    notes.extend(left_out(robot));
    notes
}

/// That effects have no place in a description, if there are any.
pub(super) fn left_out(robot: &Robot) -> Option<String> {
    let names: Vec<String> = robot.effects.iter().map(|effect| effect.effect.clone()).collect();
    let hint = "viscous and Coulomb friction go along as numbers of `drives`";
    (!names.is_empty()).then(|| format!("effects are left out: {}; {hint}", listed(&names)))
}

impl Numbers {
    /// The numbers of a model.
    pub(super) fn new(robot: &Robot) -> Result<Self, Error> {
        let robot = bake(robot).map_err(|error| Error::unsaid(error.to_string()))?;
        Ok(Self { robot })
    }

    /// A value: exact, or the nearest double of what is no rational.
    pub(super) fn value(&self, expr: ExprId) -> Rational {
        if let Some(value) = self.robot.dag.as_constant(expr) {
            return value.clone();
        }
        let values = constant_values(&self.robot.dag, &[expr]);
        values.first().and_then(|&value| Rational::from_float(value)).unwrap_or_else(Rational::zero)
    }

    /// The nearest double of a value.
    pub(super) fn number(&self, expr: ExprId) -> f64 {
        constant_values(&self.robot.dag, &[expr]).first().copied().unwrap_or(0.0)
    }

    /// The body of a link.
    pub(super) fn body(&self, link: LinkId) -> Option<BodyNumbers> {
        let body: &Body = self.robot.links[link].body.as_ref()?;
        let mass = self.value(body.mass);
        let com = body.com.map(|entry| self.value(entry));
        let mut inertia = body.inertia.map(|entry| self.value(entry));
        if body.about == About::Origin {
            let [x, y, z] = &com;
            let moved = [y * y + z * z, x * x + z * z, x * x + y * y, -(x * y), -(x * z), -(y * z)];
            for (entry, away) in inertia.iter_mut().zip(moved) {
                *entry -= &mass * away;
            }
        }
        Some(BodyNumbers { mass, com, inertia })
    }

    /// Viscous and Coulomb friction on the side of the joint, 0 where there is none.
    pub(super) fn friction(&self, link: LinkId) -> [Rational; 2] {
        let row = &self.robot.links[link];
        let drive = row.drive.unwrap_or_default();
        let ratio = drive.gear_ratio.map(|ratio| self.value(ratio));
        let size = ratio.map_or_else(num_traits::One::one, |ratio| num_traits::Signed::abs(&ratio));
        let value = |entry: Option<ExprId>| entry.map_or_else(Rational::zero, |e| self.value(e));
        let own = value(row.joint.damping);
        [own + value(drive.viscous) * &size * &size, value(drive.coulomb) * size]
    }
}
