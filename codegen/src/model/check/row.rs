//! Rows of the table and the bounds of their joints.

use super::Check;
use super::tree::{Carrier, GENERATED};
use crate::expr::{ExprId, SymbolClass, free_symbols};
use crate::model::entry::Scalar;
use crate::model::fault::Cause;
use crate::model::file::{LimitsFile, LinkFile, ModelFile, TorqueFile};
use crate::model::robot::{Joint, JointKind, Limits, Link, LinkId};
use crate::model::unit::Dimension;
use crate::number::decimal_text;
use num_traits::{Signed, Zero};

impl Check<'_> {
    /// Makes a link of each row; bodies and drives come later.
    pub(super) fn rows(&mut self, file: &ModelFile, carriers: &[Carrier]) {
        let generated = self.links.len();
        let tip = self.base_tip();
        let id_of = |index: usize| crate::arena::Handle::from_index(generated + index);
        for (link, carrier) in file.links.iter().zip(carriers) {
            let parent = match *carrier {
                Carrier::Base => tip,
                Carrier::Generated(place) => self.link_ids.get(GENERATED[place]).copied(),
                Carrier::Link(index) => Some(id_of(index)),
            };
            let row = Link {
                name: link.name.text.clone().into_owned(),
                parent,
                joint: self.row(link),
                limits: self.limits(&link.limits, link.joint.kind),
                body: None,
                drive: None,
            };
            let name = row.name.clone();
            let id: LinkId = self.links.push(row);
            self.link_ids.entry(name).or_insert(id);
        }
    }

    fn row(&mut self, link: &LinkFile) -> Joint {
        let names = ["a", "alpha", "d", "theta"];
        let dimensions = [Dimension::LENGTH, Dimension::NONE, Dimension::LENGTH, Dimension::NONE];
        let [a, alpha, d, theta] = std::array::from_fn(|entry| {
            let Some(scalar) = &link.joint.row[entry] else { return self.scope.dag.zero() };
            let expr = self.scope.row_entry(scalar, self.report);
            let symbols = free_symbols(&self.scope.dag, &[expr]);
            let mut symbols = symbols.into_iter().map(|id| &self.scope.dag.symbols()[id]);
            match symbols.find(|symbol| symbol.class == SymbolClass::Inertia) {
                Some(unknown) => {
                    let name = unknown.name.clone();
                    self.push(scalar.at, Cause::UnknownInRow(name));
                }
                None => {
                    let (name, dimension) = (names[entry], dimensions[entry]);
                    self.scope.expect(expr, name, dimension, scalar.at, self.report);
                    if dimension == Dimension::NONE
                        && let Some(cause) = self.scope.rounded_angle(scalar, expr)
                    {
                        self.push(scalar.at, cause);
                    }
                }
            }
            expr
        });
        let kind = link.joint.kind;
        if kind == JointKind::Fixed {
            let joint = &link.joint;
            let spring_at = joint.spring.as_ref().map(|_| joint.at);
            let damping_at = joint.damping.as_ref().map(|damping| damping.at);
            for (key, at) in [("spring", spring_at), ("damping", damping_at)] {
                if let Some(at) = at {
                    self.push(at, Cause::NotOnFixedJoint(key));
                }
            }
        }
        let variables = (kind != JointKind::Fixed).then(|| self.joint_variables(&link.name.text));
        Joint { kind, a, alpha, d, theta, variables, spring: None, damping: None }
    }

    fn limits(&mut self, limits: &LimitsFile, kind: JointKind) -> Limits {
        let (position, torque) = match kind {
            JointKind::Prismatic => (Dimension::LENGTH, Dimension::FORCE),
            JointKind::Revolute | JointKind::Fixed => (Dimension::NONE, Dimension::TORQUE),
        };
        let velocity = position.times(Dimension::RATE).unwrap_or(Dimension::RATE);
        let acceleration = velocity.times(Dimension::RATE).unwrap_or(Dimension::RATE);
        if kind == JointKind::Fixed
            && let Some(at) = limits.at
        {
            self.push(at, Cause::NotOnFixedJoint("limits"));
        }
        let position_range = limits.position.as_ref();
        Limits {
            position: position_range.and_then(|ends| self.range(ends, "a position", position)),
            velocity: limits.velocity.as_ref().and_then(|v| self.speed(v, "a speed", velocity)),
            acceleration: limits
                .acceleration
                .as_ref()
                .and_then(|a| self.speed(a, "an acceleration", acceleration)),
            torque: match &limits.torque {
                None => None,
                Some(TorqueFile::Range(ends)) => self.range(ends, "a torque", torque),
                Some(TorqueFile::Symmetric(bound)) => {
                    let high = self.speed(bound, "a torque", torque);
                    high.map(|high| [self.scope.dag.neg(high), high])
                }
            },
        }
    }

    fn range(
        &mut self,
        ends: &[Scalar; 2],
        what: &'static str,
        dimension: Dimension,
    ) -> Option<[ExprId; 2]> {
        let [low, high] = ends.each_ref().map(|end| self.bound(end, what, dimension));
        let (low, high) = (low?, high?);
        let values = (self.scope.approximate(low)?, self.scope.approximate(high)?);
        if values.0 > values.1 {
            let texts = [values.0, values.1].map(|value| decimal_text(&value));
            let [low_text, high_text] = [0, 1].map(|end| {
                let written = ends[end].text.clone().into_owned();
                if written.contains(|c: char| c.is_alphabetic()) {
                    written
                } else {
                    texts[end].clone()
                }
            });
            self.push(ends[0].at, Cause::ReversedRange(low_text, high_text));
        }
        Some([low, high])
    }

    fn speed(
        &mut self,
        scalar: &Scalar,
        what: &'static str,
        dimension: Dimension,
    ) -> Option<ExprId> {
        let bound = self.bound(scalar, what, dimension)?;
        self.require_positive(bound, what, scalar.at);
        Some(bound)
    }

    fn bound(
        &mut self,
        scalar: &Scalar,
        what: &'static str,
        dimension: Dimension,
    ) -> Option<ExprId> {
        self.scope.value(scalar, Some((what, dimension)), self.report)
    }

    /// Notes a value that is 0 or less.
    pub(super) fn require_positive(&mut self, value: ExprId, what: &'static str, at: usize) {
        if let Some(number) = self.scope.approximate(value)
            && !number.is_positive()
        {
            self.push(at, Cause::NotPositive(what, decimal_text(&number)));
        }
    }

    /// Notes a value less than 0.
    pub(super) fn require_not_negative(&mut self, value: ExprId, what: &'static str, at: usize) {
        if let Some(number) = self.scope.approximate(value)
            && number.is_negative()
        {
            self.push(at, Cause::Negative(what, decimal_text(&number)));
        }
    }

    /// Whether a value is known to be 0.
    pub(super) fn is_zero(&mut self, value: ExprId) -> bool {
        self.scope.approximate(value).is_some_and(|number| number.is_zero())
    }
}
