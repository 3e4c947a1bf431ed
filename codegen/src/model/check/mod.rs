//! From the file to the robot: every rule of the format that is not about its form.
//!
//! The order is that of the file, so that names are known before they are used: names, constants
//! and unknowns, base, tree, rows and bodies, drives, points, effects.

mod angle;
mod body;
mod declare;
mod joint;
mod measure;
mod parameter;
mod place;
mod row;
mod scope;
mod tree;

use super::entry::Scalar;
use super::fault::Cause;
use super::file::ModelFile;
use super::parameter::{Parameter, ParameterId};
use super::report::Report;
use super::robot::{Ground, Link, LinkId, Robot};
use super::spelling::is_identifier;
use super::unit::Dimension;
use crate::arena::PrimaryMap;
use crate::expr::ExprId;
use crate::expr::text::nearest;
pub use angle::meant_quarter_turns;
pub(super) use measure::{approximate, near_pi};
use rustc_hash::FxHashMap;
pub(crate) use scope::Scope;

/// What is built up while a file is checked.
struct Check<'r> {
    report: &'r mut Report,
    scope: Scope,
    parameters: PrimaryMap<ParameterId, Parameter>,
    links: PrimaryMap<LinkId, Link>,
    /// The links of the file and the generated ones, by name; the first of two with one name.
    link_ids: FxHashMap<String, LinkId>,
}

/// Checks a file whose form was read. The robot may be handed out only if `report` stayed empty.
pub(super) fn check(file: &ModelFile, hash: u64, report: &mut Report) -> Robot {
    let mut check = Check {
        report,
        scope: Scope::new(declare::declared_names(file), "constants"),
        parameters: PrimaryMap::new(),
        links: PrimaryMap::new(),
        link_ids: FxHashMap::default(),
    };
    check.model_name(file);
    check.declare(file);
    let gravity = check.triple(&file.gravity, "gravity", Dimension::ACCELERATION);
    let parents = check.resolve_parents(file);
    check.generate_base(file.base.kind, file.convention);
    check.rows(file, &parents);
    check.bodies(file);
    check.drives(file);
    let contacts = check.points(&file.contacts);
    let bodies_that_must_not_touch = check.fall_bodies(&file.bodies_that_must_not_touch);
    check.point_names(file);
    let ground = check.ground(&file.ground);
    let effects = check.effects(file);
    let carriers: Vec<Option<LinkId>> = check.links.values().map(|link| link.parent).collect();
    Robot {
        name: file.name.text.clone().into_owned(),
        description: file.description.clone(),
        source: file.source.clone(),
        assumptions: file.assumptions.clone(),
        convention: file.convention,
        base: file.base.kind,
        gravity,
        terms: file.terms,
        torque_side: file.torque_side,
        dag: check.scope.dag,
        parameters: check.parameters,
        links: check.links,
        tree: super::Tree::new(&carriers),
        contacts: contacts.into_iter().collect(),
        ground,
        bodies_that_must_not_touch,
        effects,
        laws: Vec::new(),
        spring_laws: Vec::new(),
        hash,
    }
}

impl Check<'_> {
    fn push(&mut self, at: usize, cause: Cause) {
        self.report.push(at, cause);
    }

    fn model_name(&mut self, file: &ModelFile) {
        let name = &file.name;
        if !name.text.is_empty() && !is_identifier(&name.text) {
            self.push(name.at, Cause::NotIdentifier(name.text.clone().into_owned()));
        }
    }

    /// Three expressions of one dimension; zeros where the file has none.
    fn triple(
        &mut self,
        scalars: &Option<[Scalar; 3]>,
        what: &str,
        dimension: Dimension,
    ) -> [ExprId; 3] {
        let zero = self.scope.dag.zero();
        let Some(scalars) = scalars else { return [zero; 3] };
        std::array::from_fn(|axis| {
            let scalar = &scalars[axis];
            let expr = self.scope.expression(scalar, self.report);
            self.scope.expect(expr, what, dimension, scalar.at, self.report);
            expr
        })
    }

    /// The nearest name of a link, for a hint.
    fn nearest_link(&self, name: &str) -> Option<String> {
        if !self.report.wants_hints() {
            return None;
        }
        nearest(name, self.links.values().map(|link| link.name.as_str())).map(str::to_owned)
    }
}

/// Level ground through the origin of frame 0.
fn level_ground(scope: &Scope) -> Ground {
    let (zero, one) = (scope.dag.zero(), scope.dag.one());
    Ground { point: [zero; 3], normal: [zero, zero, one] }
}
