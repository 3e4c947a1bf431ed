//! Who carries whom: names of links, parents, cycles, and the generated links of a floating base.

use super::Check;
use crate::expr::text::nearest;
use crate::expr::{ExprId, SymbolClass};
use crate::model::fault::Cause;
use crate::model::file::{LinkFile, ModelFile};
use crate::model::robot::{
    Base, Convention, Joint, JointKind, JointVariables, Limits, Link, LinkId,
};
use crate::model::spelling::is_identifier;
use crate::number::ratio;
use petgraph::algo::kosaraju_scc;
use petgraph::graph::{DiGraph, NodeIndex};
use rustc_hash::FxHashMap;

/// What a link of the file stands on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Carrier {
    /// Frame 0, or the moving end of a floating base.
    Base,
    /// A generated link, by its name's place in [`GENERATED`].
    Generated(usize),
    /// The link of the file with this index.
    Link(usize),
}

/// The word for what the first links stand on.
const BASE: &str = "base";

/// Names of the generated links, in the order of the thesis's virtual chain.
pub(super) const GENERATED: [&str; 6] =
    ["base_z", "base_x", "base_y", "base_yaw", "base_roll", "base_pitch"];

/// The generated links that a base has, as places in [`GENERATED`].
pub(super) fn generated(base: Base) -> &'static [usize] {
    match base {
        Base::Fixed => &[],
        Base::Floating => &[0, 1, 2, 3, 4, 5],
        Base::PlanarFloating => &[0, 1, 5],
    }
}

impl Check<'_> {
    /// Checks the links' names and finds what each link of the file stands on.
    pub(super) fn resolve_parents(&mut self, file: &ModelFile) -> Vec<Carrier> {
        if file.links.is_empty() && self.report.is_empty() {
            self.push(file.links_at, Cause::NoLinks);
        }
        let indices = self.link_names(&file.links);
        let carriers: Vec<Carrier> =
            (0..file.links.len()).map(|index| self.carrier(file, index, &indices)).collect();
        self.find_cycles(&file.links, &carriers);
        carriers
    }

    fn link_names(&mut self, links: &[LinkFile]) -> FxHashMap<String, usize> {
        let mut indices = FxHashMap::default();
        for (index, link) in links.iter().enumerate() {
            let name = link.name.text.clone().into_owned();
            if name.is_empty() && link.name.at != link.at {
                self.push(link.name.at, Cause::NotIdentifier(name));
                continue;
            }
            if name.is_empty() {
                continue; // the missing key was noted with the form
            }
            if !is_identifier(&name) {
                self.push(link.name.at, Cause::NotIdentifier(name.clone()));
            } else if name == BASE || GENERATED.contains(&name.as_str()) {
                self.push(link.name.at, Cause::ReservedName(name.clone(), "the base"));
            } else if indices.contains_key(&name) {
                self.push(link.name.at, Cause::DuplicateName(name, "another link"));
                continue;
            }
            indices.insert(name, index);
        }
        indices
    }

    fn carrier(
        &mut self,
        file: &ModelFile,
        index: usize,
        indices: &FxHashMap<String, usize>,
    ) -> Carrier {
        let before = if index == 0 { Carrier::Base } else { Carrier::Link(index - 1) };
        let Some(parent) = &file.links[index].parent else { return before };
        if parent.text == BASE {
            return Carrier::Base;
        }
        let place = GENERATED.iter().position(|name| *name == parent.text);
        if let Some(place) = place.filter(|place| generated(file.base.kind).contains(place)) {
            return Carrier::Generated(place);
        }
        match indices.get(parent.text.as_ref()) {
            Some(&carrier) => Carrier::Link(carrier),
            None => {
                let names = file.links.iter().map(|link| link.name.text.as_ref());
                let hint = if self.report.wants_hints() {
                    nearest(&parent.text, names.chain([BASE]))
                } else {
                    None
                };
                let name = parent.text.clone().into_owned();
                self.push(parent.at, Cause::UnknownLink(name, hint.map(str::to_owned)));
                Carrier::Base
            }
        }
    }

    /// Notes links that carry each other, each circle once, and parents that come too late.
    fn find_cycles(&mut self, links: &[LinkFile], carriers: &[Carrier]) {
        let mut graph = DiGraph::<(), ()>::with_capacity(links.len(), links.len());
        links.iter().for_each(|_| {
            graph.add_node(());
        });
        for (index, carrier) in carriers.iter().enumerate() {
            if let Carrier::Link(carrier) = carrier {
                graph.add_edge(NodeIndex::new(*carrier), NodeIndex::new(index), ());
            }
        }
        let mut in_cycle = vec![false; links.len()];
        for component in kosaraju_scc(&graph) {
            let carries_itself =
                carriers[component[0].index()] == Carrier::Link(component[0].index());
            if component.len() == 1 && !carries_itself {
                continue;
            }
            let first = component.iter().map(|node| node.index()).min().unwrap_or_default();
            component.iter().for_each(|node| in_cycle[node.index()] = true);
            let mut circle = vec![links[first].name.text.clone().into_owned()];
            let mut at = first;
            while let Carrier::Link(carrier) = carriers[at] {
                at = carrier;
                circle.push(links[at].name.text.clone().into_owned());
                if at == first {
                    break;
                }
            }
            circle.reverse();
            let place = links[first].parent.as_ref().map_or(links[first].at, |parent| parent.at);
            self.push(place, Cause::Cycle(circle));
        }
        for (index, link) in links.iter().enumerate() {
            let (Carrier::Link(carrier), Some(parent)) = (carriers[index], &link.parent) else {
                continue;
            };
            if carrier > index && !in_cycle[index] {
                self.push(parent.at, Cause::LateParent(parent.text.clone().into_owned()));
            }
        }
    }

    /// Makes the massless links of a floating base (thesis figure 2.3; math: world x forward, y
    /// left, z up). In standard convention every row turns by a quarter about x after its joint; in
    /// modified convention the same turn comes before the next joint, so the frame of base_pitch is
    /// that of its axis.
    pub(super) fn generate_base(&mut self, base: Base, convention: Convention) {
        let mut parent = None;
        let names = generated(base);
        for (row, &place) in names.iter().enumerate() {
            let kind = if place < 3 { JointKind::Prismatic } else { JointKind::Revolute };
            // the planar pitch joint is the last: its axis is z_2 already, and it needs no turn
            let is_planar_pitch = base == Base::PlanarFloating && place == 5;
            let turns_after = !is_planar_pitch;
            let turns = match convention {
                Convention::Standard => turns_after,
                Convention::Modified => row > 0,
            };
            let alpha = self.quarter_turn(turns);
            let theta = self.quarter_turn(!is_planar_pitch);
            let name = GENERATED[place];
            let zero = self.scope.dag.zero();
            let joint = Joint {
                kind,
                a: zero,
                alpha,
                d: zero,
                theta,
                variables: Some(self.joint_variables(name)),
                spring: None,
                damping: None,
            };
            let link = Link {
                name: name.to_owned(),
                parent,
                joint,
                limits: Limits::default(),
                body: None,
                drive: None,
            };
            let id = self.links.push(link);
            self.link_ids.insert(name.to_owned(), id);
            parent = Some(id);
        }
    }

    /// The link that the word `base` stands for; none for a fixed base.
    pub(super) fn base_tip(&self) -> Option<LinkId> {
        self.link_ids.get(GENERATED[5]).copied()
    }

    /// The symbols of a moving joint.
    pub(super) fn joint_variables(&mut self, link: &str) -> JointVariables {
        let mut symbol =
            |prefix: &str, class| self.scope.generate(&format!("{prefix}_{link}"), class);
        JointVariables {
            q: symbol("q", SymbolClass::Configuration),
            qd: symbol("qd", SymbolClass::Rate),
            qdd: symbol("qdd", SymbolClass::Acceleration),
            tau: symbol("tau", SymbolClass::Effort),
        }
    }

    fn quarter_turn(&mut self, turns: bool) -> ExprId {
        if !turns {
            return self.scope.dag.zero();
        }
        let half = self.scope.dag.constant(ratio(1, 2));
        let pi = self.scope.dag.pi();
        self.scope.dag.mul(half, pi)
    }
}
