//! The relations among the features of a tree, exactly and for any tree, from its table alone.
//!
//! Matter on the axis of a turning joint does not feel the joint: it may as well be part of the
//! carrier. Nor does the second moment of a sliding body feel the slide. A body that turns about
//! one axis only, or about a line fixed in space, or not at all, does not feel what lies along the
//! axis, or on the line, or its second moments. Each such statement is one relation: a combination
//! of features whose torques vanish for every motion. Rank modulo p tells if any is missing.

use super::column::{Feature, JointFunction, Regressor};
use super::inertial::{ENTRIES, entries, from_entries, parameters_of, unit_entry};
use super::still::{Point, still_without_weight, unfelt};
use super::turning::{
    Turning, from_axis, gravity_at_seat, is_alone, is_along_z, like_rotor, screws, seat_is_still,
    to_child, turnings, unturned,
};
use crate::expr::{Dag, ExprId};
use crate::kinematics::{Mechanism, Placement};
use crate::model::Terms;
use crate::number::integer;
use crate::spatial::{PseudoInertia, negate};
use std::collections::BTreeMap;

/// What a relation is about: a column of the regressor, or a feature that no column is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Place {
    Column(usize),
    Feature(Feature),
}

/// A combination whose torques vanish: known coefficient by place.
pub(super) type Relation = BTreeMap<Place, ExprId>;

/// Which entry of [`entries`] is which.
const MASS: usize = 0;
const FIRST: [usize; 3] = [1, 2, 3];
const K33: usize = 6;

/// Every relation, over columns and features.
pub(super) fn relations(regressor: &Regressor, dag: &mut Dag) -> Vec<Relation> {
    let finder = Finder::new(regressor, dag);
    finder.all()
}

/// Every relation over features, and every column as the combination of features that it is.
pub(super) fn feature_relations(regressor: &Regressor, dag: &mut Dag) -> Vec<Relation> {
    let mut finder = Finder::new(regressor, dag);
    finder.hosts.fill(None);
    finder.all()
}

struct Finder<'a> {
    regressor: &'a Regressor,
    mechanism: &'a Mechanism,
    terms: Terms,
    dag: &'a mut Dag,
    /// The first of the ten columns of the link that stands for a body's matter, and its placement.
    hosts: Vec<Option<(usize, Placement)>>,
    turnings: Vec<Turning>,
    screws: Vec<bool>,
    /// Points that are fixed in space, of bodies without weight.
    still: Vec<Option<Point>>,
    relations: Vec<Relation>,
}

impl<'a> Finder<'a> {
    fn new(regressor: &'a Regressor, dag: &'a mut Dag) -> Self {
        let mechanism = &regressor.mechanism;
        let mut hosts: Vec<Option<(usize, Placement)>> = vec![None; mechanism.bodies.len()];
        for (index, column) in regressor.columns.iter().enumerate() {
            let Some((link, 0)) = column.parameter else { continue };
            let placement = mechanism.placements[link].clone();
            if let Some(host) = placement.body.map(|body| &mut hosts[body])
                && host.is_none()
            {
                *host = Some((index, placement));
            }
        }
        let turnings = turnings(dag, mechanism);
        let screws = screws(dag, mechanism, &turnings);
        let terms = regressor.terms;
        let still = still_without_weight(dag, mechanism, terms);
        let relations = Vec::new();
        Self { regressor, mechanism, terms, dag, hosts, turnings, screws, still, relations }
    }

    fn all(mut self) -> Vec<Relation> {
        self.definitions();
        for body in 0..self.mechanism.bodies.len() {
            self.transfers(body);
            self.unfelt(body);
            self.rotor(body);
        }
        self.relations
    }

    /// Each column that is no parameter of a host, as the combination of features that it is.
    fn definitions(&mut self) {
        for (index, column) in self.regressor.columns.iter().enumerate() {
            let body = column.parameter.and_then(|(link, _)| self.mechanism.placements[link].body);
            let host = body.and_then(|body| self.hosts[body].as_ref());
            if host.is_some_and(|&(first, _)| (first..first + ENTRIES).contains(&index)) {
                continue;
            }
            let mut relation = Relation::from([(Place::Column(index), self.dag.one())]);
            let mut by_body: BTreeMap<usize, [ExprId; ENTRIES]> = BTreeMap::new();
            for &(feature, factor) in &column.definition {
                let factor = self.dag.neg(factor);
                match feature {
                    Feature::Matter { body, entry } => {
                        let zero = self.dag.zero();
                        by_body.entry(body).or_insert([zero; ENTRIES])[entry] = factor;
                    }
                    Feature::Joint { .. } => self.add(&mut relation, feature, factor),
                }
            }
            for (body, list) in by_body {
                self.add_matter(&mut relation, body, &from_entries(list));
            }
            self.push(relation);
        }
    }

    fn push(&mut self, mut relation: Relation) {
        let zero = self.dag.zero();
        relation.retain(|_, factor| *factor != zero);
        if !relation.is_empty() {
            self.relations.push(relation);
        }
    }

    fn add(&mut self, relation: &mut Relation, feature: Feature, factor: ExprId) {
        self.add_place(relation, Place::Feature(feature), factor);
    }

    fn add_place(&mut self, relation: &mut Relation, place: Place, factor: ExprId) {
        let before = relation.get(&place).copied().unwrap_or_else(|| self.dag.zero());
        let after = self.dag.add(before, factor);
        relation.insert(place, after);
    }

    /// Adds matter given in a body's frame, as the parameters of the link that hosts it.
    fn add_matter(&mut self, relation: &mut Relation, body: usize, matter: &PseudoInertia) {
        match self.hosts[body].clone() {
            Some((first, placement)) => {
                let back = negate(self.dag, placement.offset);
                let shifted = matter.shifted(self.dag, back);
                let own = unturned(self.dag, &placement.turns, shifted);
                for (place, factor) in parameters_of(self.dag, &own).into_iter().enumerate() {
                    self.add_place(relation, Place::Column(first + place), factor);
                }
            }
            None => {
                for (entry, factor) in entries(matter).into_iter().enumerate() {
                    self.add(relation, Feature::Matter { body, entry }, factor);
                }
            }
        }
    }

    /// The relation that matter of a body is felt like the same matter of its carrier (or of the
    /// ground, which feels nothing).
    fn transfer(&mut self, body: usize, matter: &PseudoInertia) {
        let relation = self.difference(body, matter);
        self.push(relation);
    }

    fn difference(&mut self, body: usize, matter: &PseudoInertia) -> Relation {
        let mut relation = Relation::new();
        self.add_matter(&mut relation, body, matter);
        let moving = &self.mechanism.bodies[body];
        if let Some(parent) = moving.parent {
            let (turns, offset) = (moving.turns.clone(), moving.offset);
            let seat = Placement { body: Some(parent), turns, offset };
            let carried = seat.carry(self.dag, matter);
            let minus = self.dag.integer(-1);
            let carried = carried.scaled(self.dag, minus);
            self.add_matter(&mut relation, parent, &carried);
        }
        relation
    }

    /// What the carrier feels alike.
    fn transfers(&mut self, body: usize) {
        let moving = &self.mechanism.bodies[body];
        let mut felt_alike = Vec::new();
        if moving.is_revolute {
            felt_alike.extend([K33, FIRST[2], MASS]);
        } else {
            felt_alike.extend(4..ENTRIES);
            let turns = moving.turns.clone();
            let carried = moving.parent.map_or(Turning::Never, |parent| self.turnings[parent]);
            let slides_along = match carried {
                Turning::About(axis) => {
                    let axis = to_child(self.dag, &turns, axis);
                    is_along_z(self.dag, axis)
                }
                Turning::Never => true,
                Turning::Freely => false,
            };
            // At rest the slide does no more to a first moment than move the body.
            if slides_along || !self.is_moving() {
                felt_alike.extend(FIRST);
            }
        }
        for entry in felt_alike {
            let matter = unit_entry(self.dag, entry);
            self.transfer(body, &matter);
        }
    }

    fn is_moving(&self) -> bool {
        self.terms.inertia || self.terms.coriolis
    }

    /// What nothing feels.
    fn unfelt(&mut self, body: usize) {
        let mut lists: Vec<[ExprId; ENTRIES]> = Vec::new();
        let zero = [self.dag.zero(); ENTRIES];
        let one = self.dag.one();
        let unit = |entry: usize| {
            let mut list = zero;
            list[entry] = one;
            list
        };
        let turning = self.turnings[body];
        if turning == Turning::Never {
            lists.extend((1..ENTRIES).map(unit));
        } else if !self.is_moving() {
            lists.extend((4..ENTRIES).map(unit));
        }
        if turning != Turning::Never && turning != Turning::Freely {
            // About z: all second moments but K11 + K22, and the first moment along the axis.
            lists.extend([FIRST[2], K33, 7, 8, 9].map(unit));
            let mut difference = unit(4);
            difference[5] = self.dag.integer(-1);
            lists.push(difference);
            // Where the line stays in place, and at rest anywhere, only weight could be felt.
            if self.screws[body] || !self.is_moving() {
                let weight = gravity_at_seat(self.dag, self.mechanism, body);
                if !self.terms.gravity || is_along_z(self.dag, weight) {
                    lists.extend([FIRST[0], FIRST[1]].map(unit));
                }
            }
        }
        for list in lists {
            let about_axis = from_entries(list);
            let matter = match turning {
                Turning::About(_) => from_axis(self.dag, self.mechanism, body, about_axis),
                _ => about_axis,
            };
            self.vanish(body, &matter);
        }
        for matter in self.still[body].map(|point| unfelt(self.dag, point)).unwrap_or_default() {
            self.vanish(body, &matter);
        }
    }

    /// The relation that matter of a body is not felt.
    fn vanish(&mut self, body: usize, matter: &PseudoInertia) {
        let mut relation = Relation::new();
        self.add_matter(&mut relation, body, matter);
        self.push(relation);
    }

    /// A rotor whose joint is alone with its motion is felt like matter.
    fn rotor(&mut self, joint: usize) {
        let mut relation;
        if self.mechanism.bodies[joint].is_revolute {
            let alone = is_alone(self.dag, self.mechanism, &self.turnings, joint);
            if !alone || !self.terms.inertia {
                return;
            }
            let one = self.dag.one();
            let matter = like_rotor(self.dag, one);
            relation = Relation::new();
            self.add_matter(&mut relation, joint, &matter);
        } else {
            if !seat_is_still(self.dag, self.mechanism, joint) {
                return;
            }
            let mass = unit_entry(self.dag, MASS);
            relation = self.difference(joint, &mass);
            if self.terms.gravity {
                let weight = gravity_at_seat(self.dag, self.mechanism, joint);
                let function = JointFunction::One;
                self.add(&mut relation, Feature::Joint { joint, function }, weight[2]);
            }
        }
        if self.terms.inertia {
            let minus = self.dag.constant(integer(-1));
            let function = JointFunction::Acceleration;
            self.add(&mut relation, Feature::Joint { joint, function }, minus);
        }
        self.push(relation);
    }
}
