//! Points in links, the ground, and the places of effects.

use super::{Check, level_ground};
use crate::arena::Handle;
use crate::expr::text::nearest;
use crate::model::entry::{Name, Scalar};
use crate::model::fault::Cause;
use crate::model::file::{ModelFile, PlaceFile};
use crate::model::place_file::{FallBodyFile, GroundFile, PointFile};
use crate::model::robot::{
    AddedEffect, AddedValue, Contact, ContactId, EffectPlace, FallBody, Ground, LinkId,
};
use crate::model::spelling::is_identifier;
use crate::model::unit::Dimension;
use num_traits::Zero;
use rustc_hash::{FxHashMap, FxHashSet};

impl Check<'_> {
    /// Points fixed in links; one whose link is not known stands nowhere and is left out.
    pub(super) fn points(&mut self, points: &[PointFile]) -> Vec<Contact> {
        points
            .iter()
            .filter_map(|point| {
                let position = self.triple(&point.position, "a position", Dimension::LENGTH);
                let link = self.find_link(&point.link)?;
                Some(Contact { name: point.name.text.clone().into_owned(), link, position })
            })
            .collect()
    }

    /// Bodies that must not touch the ground; one whose link is not known is left out.
    pub(super) fn fall_bodies(&mut self, bodies: &[FallBodyFile]) -> Vec<FallBody> {
        let mut checked = Vec::new();
        for body in bodies {
            let triple =
                |end: &Option<[Scalar; 3]>| self.triple(end, "a position", Dimension::LENGTH);
            let ends = body.ends.iter().map(triple).collect();
            let mut radius = self.scope.dag.zero();
            if let Some(scalar) = &body.radius {
                radius = self.scope.expression(scalar, self.report);
                let at = scalar.at;
                self.scope.expect(radius, "a radius", Dimension::LENGTH, at, self.report);
                self.require_not_negative(radius, "a radius", at);
            }
            let Some(link) = self.find_link(&body.link) else { continue };
            let name = body.name.text.clone().into_owned();
            checked.push(FallBody { name, link, ends, radius });
        }
        checked
    }

    /// Checks that the names of all points are names and differ.
    pub(super) fn point_names(&mut self, file: &ModelFile) {
        let mut seen = FxHashSet::default();
        let contacts = file.contacts.iter().map(|point| &point.name);
        let bodies = file.bodies_that_must_not_touch.iter().map(|body| &body.name);
        for name in contacts.chain(bodies) {
            let text = name.text.clone().into_owned();
            if !is_identifier(&text) {
                // an empty name stands for a missing key, which was noted with the form
                if !text.is_empty() {
                    self.push(name.at, Cause::NotIdentifier(text));
                }
            } else if !seen.insert(text.clone()) {
                self.push(name.at, Cause::DuplicateName(text, "another point"));
            }
        }
    }

    /// The ground's plane; level through the origin where the file says nothing.
    pub(super) fn ground(&mut self, file: &GroundFile) -> Ground {
        let mut ground = level_ground(&self.scope);
        if file.point.is_some() {
            ground.point = self.triple(&file.point, "a position", Dimension::LENGTH);
        }
        if file.normal.is_some() {
            ground.normal = self.triple(&file.normal, "a direction", Dimension::NONE);
            let is_zero = |entry| self.scope.dag.as_constant(entry).is_some_and(Zero::is_zero);
            if ground.normal.into_iter().all(is_zero) {
                self.push(file.at, Cause::ZeroNormal);
            }
        }
        ground
    }

    /// Added effects.
    pub(super) fn effects(&mut self, file: &ModelFile) -> Vec<AddedEffect> {
        let contacts: FxHashMap<&str, usize> = file
            .contacts
            .iter()
            .enumerate()
            .map(|(index, contact)| (contact.name.text.as_ref(), index))
            .collect();
        let mut effects = Vec::new();
        for effect in &file.effects {
            let mut parameters = Vec::new();
            for (name, scalar, std) in &effect.parameters {
                let value = self.scope.number(scalar, self.report);
                let std = std.as_ref().and_then(|std| {
                    let value = self.scope.number(std, self.report)?;
                    self.require_not_negative(value, "a standard deviation", std.at);
                    Some(value)
                });
                let name = name.clone();
                parameters.extend(value.map(|value| AddedValue { name, value, std }));
            }
            if let Some(at) = self.effect_place(&effect.at, &contacts) {
                let (name, place, side) = (effect.effect.clone(), effect.place, effect.side);
                effects.push(AddedEffect { effect: name, at, side, parameters, place });
            }
        }
        effects
    }

    fn effect_place(
        &mut self,
        at: &PlaceFile,
        contacts: &FxHashMap<&str, usize>,
    ) -> Option<EffectPlace> {
        match at {
            PlaceFile::Model => Some(EffectPlace::Model),
            PlaceFile::Link(name) => Some(EffectPlace::Link(self.find_link(name)?)),
            PlaceFile::Pair(name, second) => {
                let (first, second) = (self.find_link(name), self.find_link(second));
                Some(EffectPlace::Pair(first?, second?))
            }
            PlaceFile::Contact(name) => {
                if let Some(&index) = contacts.get(name.text.as_ref()) {
                    return Some(EffectPlace::Contact(ContactId::from_index(index)));
                }
                let mut names: Vec<&str> = Vec::new();
                if self.report.wants_hints() {
                    names.extend(contacts.keys());
                    names.sort_unstable();
                }
                let hint = nearest(&name.text, names).map(str::to_owned);
                self.push(name.at, Cause::UnknownContact(name.text.clone().into_owned(), hint));
                None
            }
        }
    }

    /// The link of that name; `base` is the moving end of a floating base.
    fn find_link(&mut self, name: &Name) -> Option<LinkId> {
        let id = match name.text.as_ref() {
            "base" => self.base_tip(),
            text => self.link_ids.get(text).copied(),
        };
        if id.is_none() && !name.text.is_empty() {
            let hint = self.nearest_link(&name.text);
            self.push(name.at, Cause::UnknownLink(name.text.clone().into_owned(), hint));
        }
        id
    }
}
