//! Effects become part of a robot: laws of joints, moved properties, terms.
//!
//! Their parameters become parameters of the robot, `fs_stribeck_knee`, so that everything that is
//! derived, baked, emitted or typeset has them as it has friction and masses.

use super::{Effect, EffectSite, Law, ModelTerm, Property, beyond, find};
use crate::expr::text::nearest;
use crate::expr::{Dag, ExprId, Symbol, SymbolClass, import};
use crate::model::json;
use crate::model::{
    About, AddedEffect, AddedValue, Body, Cause, EffectPlace, Joint, JointKind, JointLaw,
    JointVariables, LawState, Limits, Link, LinkId, ModelError, Parameter, Report, Robot, Role,
    SpringLaw, SpringSide, Terms, Tree, read, read_estimated,
};
use crate::number::decimal_text;

/// Reads a model file with the effects that it names: those of `own`, then the shipped ones.
/// `file` is the file's name, for messages alone.
pub fn read_model(file: &str, source: &[u8], own: &[Effect]) -> Result<Robot, ModelError> {
    with_effects(read(file, source)?, file, source, own)
}

/// The same of a model whose numbers were [estimated](read_estimated).
pub fn read_estimated_model(
    file: &str,
    source: &[u8],
    own: &[Effect],
) -> Result<Robot, ModelError> {
    with_effects(read_estimated(file, source)?, file, source, own)
}

fn with_effects(
    mut robot: Robot,
    file: &str,
    source: &[u8],
    own: &[Effect],
) -> Result<Robot, ModelError> {
    let mut report = Report::default();
    for place in 0..robot.effects.len() {
        let added = robot.effects[place].clone();
        let name = &added.effect;
        let effect = own.iter().find(|effect| effect.name == *name).or_else(|| find(name));
        let attached = match effect {
            Some(effect) => attach(&mut robot, effect, place),
            None => {
                let names = own.iter().map(|own| own.name.as_str());
                let known = names.chain(super::SHIPPED.iter().map(|(name, _)| *name));
                let hint = nearest(name, known).map(str::to_owned);
                Err(vec![Cause::UnknownEffect(name.clone(), hint)])
            }
        };
        for cause in attached.err().unwrap_or_default() {
            report.push(added.place, cause);
        }
    }
    if report.is_empty() {
        return Ok(robot);
    }
    let root = json::parse(source).ok();
    Err(report.into_error(file, source, root.as_ref()))
}

/// Adds the effect of `robot.effects[place]`, whose definition is `effect`. The robot is unchanged
/// in its equations if there is a fault.
pub fn attach(robot: &mut Robot, effect: &Effect, place: usize) -> Result<(), Vec<Cause>> {
    let added = robot.effects[place].clone();
    let links = links(robot, effect, &added).map_err(|cause| vec![cause])?;
    let side = effect.side;
    let effect = &*effect.on_side(added.side);
    // a side that is not stated is that of the law
    let own = |of: &AddedEffect| (of.effect.clone(), of.at, of.side.unwrap_or(side));
    let is_same = |other: &AddedEffect| own(other) == own(&added);
    if robot.effects[..place].iter().any(is_same) {
        return Err(vec![Cause::AddedTwice(added.effect)]);
    }
    let faults = values_at_fault(robot, effect, &added);
    if !faults.is_empty() {
        return Err(faults);
    }
    let suffix = match links.first() {
        Some(&link) => format!("_{}_{}", effect.name, robot.links[link].name),
        None => format!("_{}", effect.name),
    };
    let suffix = match added.side {
        Some(SpringSide::Link) => format!("{suffix}_link"),
        Some(SpringSide::Motor) | None => suffix,
    };
    if let Some(taken) = taken_name(robot, effect, &links, &suffix) {
        return Err(vec![Cause::DuplicateName(taken, "another quantity")]);
    }
    let attaching = Attaching { effect, links, suffix, place };
    attaching.change(robot).map_err(|cause| vec![cause])?;
    attaching.add_parameters(robot, &added);
    Ok(())
}

/// A name that the effect would give to a quantity of its own, and that has another one already.
fn taken_name(robot: &Robot, effect: &Effect, links: &[LinkId], suffix: &str) -> Option<String> {
    let parameters = effect.parameters.iter().map(|parameter| &parameter.name);
    let states = effect.states.iter().map(|state| &state.name);
    let mut own = parameters.chain(states).map(|name| format!("{name}{suffix}"));
    let taken = own.find(|name| robot.dag.find_symbol(name).is_some());
    // Effects share the loads of a joint.
    let loads = links.iter().flat_map(|&link| {
        ["tau_load", "tau_load_rate"].map(|stem| format!("{stem}_{}", robot.links[link].name))
    });
    let is_other = |name: &String| {
        let known = robot.dag.find_symbol(name);
        known.is_some_and(|id| robot.dag.symbols()[id].class != SymbolClass::Effort)
    };
    taken.or_else(|| loads.into_iter().find(is_other))
}

/// The joints or links of the place, if the effect can act there.
fn links(robot: &Robot, effect: &Effect, added: &AddedEffect) -> Result<Vec<LinkId>, Cause> {
    let moves = |link: LinkId| robot.links[link].joint.variables.is_some();
    let wrong = |place| Err(Cause::WrongPlace(effect.name.clone(), place));
    if added.side.is_some() {
        let has_side = effect.at == EffectSite::Joint && matches!(effect.law, Law::Torque(_));
        if !has_side {
            let what = "only laws of a joint's torque have a `side`";
            return Err(Cause::NothingToChange(effect.name.clone(), what));
        }
        let EffectPlace::Link(link) = added.at else { return wrong("a joint that moves") };
        if robot.links[link].drive.and_then(|drive| drive.series_elastic).is_none() {
            let what = "the joint has no series spring, and so no sides of one";
            return Err(Cause::NothingToChange(effect.name.clone(), what));
        }
    }
    match (effect.at, added.at) {
        (EffectSite::Joint, EffectPlace::Link(link)) if moves(link) => Ok(vec![link]),
        (EffectSite::Joint, _) => wrong("a joint that moves"),
        (EffectSite::Spring, EffectPlace::Link(link)) if moves(link) => {
            let drive = robot.links[link].drive;
            if drive.and_then(|drive| drive.series_elastic).is_none() {
                let what = "the joint has no series spring";
                return Err(Cause::NothingToChange(effect.name.clone(), what));
            }
            Ok(vec![link])
        }
        (EffectSite::Spring, _) => wrong("the series spring of a joint"),
        (EffectSite::JointPair, EffectPlace::Pair(link, second))
            if moves(link) && moves(second) && link != second =>
        {
            Ok(vec![link, second])
        }
        (EffectSite::JointPair, _) => wrong("two joints, \"link\" and \"second\""),
        (EffectSite::Link, EffectPlace::Link(link)) => Ok(vec![link]),
        (EffectSite::Link, _) => wrong("a link"),
        (EffectSite::Model, EffectPlace::Model) => Ok(Vec::new()),
        (EffectSite::Model, _) => wrong("the whole model"),
        // forces at contacts belong to the simulation, which has laws of its own for them
        (EffectSite::Contact, _) => wrong("a contact, and no equation of the robot has those"),
    }
}

fn values_at_fault(robot: &Robot, effect: &Effect, added: &AddedEffect) -> Vec<Cause> {
    let mut faults = Vec::new();
    for AddedValue { name, value, .. } in &added.parameters {
        let Some(parameter) = effect.parameter(name) else {
            let hint = nearest(name, effect.parameters.iter().map(|known| known.name.as_str()));
            let hint = hint.map(str::to_owned);
            faults.push(Cause::NotOfEffect(effect.name.clone(), name.clone(), hint));
            continue;
        };
        let Some(value) = robot.dag.as_constant(*value) else { continue };
        if let Some(beyond) = beyond(value, &parameter.bounds) {
            let of = Some([name.clone(), effect.name.clone()]);
            faults.push(Cause::OutOfBounds(of, decimal_text(value), beyond));
        }
    }
    faults
}

/// The terms with one of them switched on or off.
pub fn with_term(terms: Terms, term: ModelTerm, present: bool) -> Terms {
    let mut terms = terms;
    *match term {
        ModelTerm::Coriolis => &mut terms.coriolis,
        ModelTerm::Gravity => &mut terms.gravity,
        ModelTerm::Rotor => &mut terms.rotor,
        ModelTerm::Friction => &mut terms.friction,
        ModelTerm::Spring => &mut terms.spring,
        ModelTerm::Inertia => &mut terms.inertia,
    } = present;
    terms
}

struct Attaching<'e> {
    effect: &'e Effect,
    /// The joint or link, then the second joint of a pair; none for the whole model.
    links: Vec<LinkId>,
    suffix: String,
    place: usize,
}

impl Attaching<'_> {
    fn change(&self, robot: &mut Robot) -> Result<(), Cause> {
        match &self.effect.law {
            Law::Torque(torque) if self.effect.at == EffectSite::Spring => {
                self.add_spring_law(robot, *torque)
            }
            Law::Torque(torque) => {
                let law = self.law(robot, *torque, &self.motions(robot))?;
                robot.laws.push(law);
                let Some(second) = self.effect.on_second() else { return Ok(()) };
                let Law::Torque(torque) = second.law else { return Ok(()) };
                let links = self.links.iter().rev().copied().collect();
                let suffix = self.suffix.clone();
                let other = Attaching { effect: &second, links, suffix, place: self.place };
                let law = other.law(robot, torque, &other.motions(robot))?;
                robot.laws.push(law);
                Ok(())
            }
            // what is logged is no matter of equations
            Law::Measured(_) => Ok(()),
            Law::Moves(moves) => self.move_properties(robot, moves),
            Law::Term(term) => {
                let terms = with_term(robot.terms, *term, true);
                if terms == robot.terms {
                    let what = "the model has the term already";
                    return Err(Cause::NothingToChange(self.effect.name.clone(), what));
                }
                robot.terms = terms;
                Ok(())
            }
        }
    }

    /// The symbols of the motion of its joints; none of a joint that does not move.
    fn motions(&self, robot: &Robot) -> Vec<Option<JointVariables>> {
        self.links.iter().map(|&link| robot.links[link].joint.variables).collect()
    }

    /// Expressions of the effect in the symbols of the robot and of `motions`, with the loads that
    /// they name.
    fn import(
        &self,
        robot: &mut Robot,
        exprs: &[ExprId],
        motions: &[Option<JointVariables>],
    ) -> (Vec<ExprId>, Vec<(LinkId, ExprId)>) {
        let names: Vec<String> =
            self.links.iter().map(|&link| robot.links[link].name.clone()).collect();
        let mut loads = Vec::new();
        let (gravity, links) = (robot.gravity, &self.links);
        let symbol_of = |dag: &mut Dag, symbol: &Symbol| {
            let (stem, joint) = match symbol.name.strip_suffix("_2") {
                Some(stem) => (stem, 1),
                None => (symbol.name.as_str(), 0),
            };
            let motion = motions.get(joint).copied().flatten();
            match (stem, motion) {
                ("q", Some(motion)) => motion.q,
                // What logs do not show of a drive at rest, functions of a state have.
                ("qd" | "creep", Some(motion)) => motion.qd,
                ("qdd", Some(motion)) => motion.qdd,
                ("tau_load" | "tau_load_rate", Some(_)) => {
                    let name = format!("{stem}_{}", names[joint]);
                    let load = dag.symbol(&name, SymbolClass::Effort);
                    if !loads.contains(&(links[joint], load)) {
                        loads.push((links[joint], load));
                    }
                    load
                }
                ("t", _) => dag.symbol("t", SymbolClass::Time),
                ("g_x", _) => gravity[0],
                ("g_y", _) => gravity[1],
                ("g_z", _) => gravity[2],
                _ => dag.symbol(&format!("{}{}", symbol.name, self.suffix), symbol.class),
            }
        };
        let imported = import(&mut robot.dag, &self.effect.dag, exprs, symbol_of);
        (imported, loads)
    }

    /// A law between a motor and its joint: its motion is the deflection of the spring there.
    fn add_spring_law(&self, robot: &mut Robot, torque: ExprId) -> Result<(), Cause> {
        // No file can name these symbols: they are no identifiers.
        let name = &robot.links[self.links[0]].name;
        let names = ["", "velocity of the "].map(|what| format!("{what}deflection of {name}"));
        let deflection = robot.dag.symbol(&names[0], SymbolClass::Configuration);
        let rate = robot.dag.symbol(&names[1], SymbolClass::Rate);
        // No law of a spring has an acceleration or a torque.
        let none = robot.dag.zero();
        let motion = JointVariables { q: deflection, qd: rate, qdd: none, tau: none };
        let law = self.law(robot, torque, &[Some(motion)])?;
        robot.spring_laws.push(SpringLaw { law, deflection, rate });
        Ok(())
    }

    fn law(
        &self,
        robot: &mut Robot,
        torque: ExprId,
        motions: &[Option<JointVariables>],
    ) -> Result<JointLaw, Cause> {
        let effect = self.effect;
        let mut exprs = vec![torque];
        exprs.extend(effect.states.iter().flat_map(|state| [state.rate, state.initial]));
        let used = crate::expr::free_symbols(&effect.dag, &exprs);
        let is_used = |name| effect.dag.find_symbol(name).is_some_and(|id| used.contains(&id));
        if ["tau_load_rate", "tau_load_rate_2"].into_iter().any(is_used) {
            let what = "no function of a moment has the derivative of its torque";
            return Err(Cause::NothingToChange(effect.name.clone(), what));
        }
        let symbols: Vec<ExprId> = effect.states.iter().map(|state| state.symbol).collect();
        exprs.extend(&symbols);
        let (imported, loads) = self.import(robot, &exprs, motions);
        let (rates, symbols) = imported[1..].split_at(2 * symbols.len());
        let states = effect.states.iter().zip(rates.chunks_exact(2)).zip(symbols);
        let states = states
            .map(|((state, rates), &symbol)| LawState {
                name: format!("{}{}", state.name, self.suffix),
                symbol,
                rate: rates[0],
                initial: rates[1],
            })
            .collect();
        let all: Vec<ExprId> = imported[..1 + rates.len()].to_vec();
        let time = robot
            .dag
            .find_symbol("t")
            .filter(|id| crate::expr::free_symbols(&robot.dag, &all).contains(id));
        let time = time.map(|id| robot.dag.symbol_expr(id));
        Ok(JointLaw {
            effect: effect.name.clone(),
            title: effect.title.clone(),
            joint: self.links[0],
            side: effect.side,
            torque: imported[0],
            states,
            loads,
            time,
        })
    }

    fn move_properties(
        &self,
        robot: &mut Robot,
        moves: &[(Property, ExprId)],
    ) -> Result<(), Cause> {
        let exprs: Vec<ExprId> = moves.iter().map(|(_, by)| *by).collect();
        let (by, _) = self.import(robot, &exprs, &self.motions(robot));
        let zero = robot.dag.zero();
        let (mut matter, mut has_matter) = ([zero; 10], false);
        for (&(property, _), &by) in moves.iter().zip(&by) {
            let entry = match property {
                Property::Mass => 0,
                Property::FirstMoment(axis) => 1 + axis,
                Property::Inertia(entry) => 4 + entry,
                Property::Gravity(axis) => {
                    robot.gravity[axis] = robot.dag.add(robot.gravity[axis], by);
                    continue;
                }
                Property::Zero => {
                    self.move_zero(robot, by);
                    continue;
                }
                Property::SeriesStiffness => {
                    self.stiffen(robot, by)?;
                    continue;
                }
            };
            matter[entry] = by;
            has_matter = true;
        }
        if has_matter {
            self.carry(robot, matter);
        }
        Ok(())
    }

    /// The joint stands at q + `by`; springs across it know the joint's own zero.
    fn move_zero(&self, robot: &mut Robot, by: ExprId) {
        let dag = &mut robot.dag;
        let link = &mut robot.links[self.links[0]];
        let joint = &mut link.joint;
        match joint.kind {
            JointKind::Prismatic => joint.d = dag.add(joint.d, by),
            _ => joint.theta = dag.add(joint.theta, by),
        }
        let drive = link.drive.as_mut().and_then(|drive| drive.return_spring.as_mut());
        let angles = joint.spring.as_mut().map(|spring| &mut spring.angle);
        for angle in angles.into_iter().chain(drive.map(|spring| &mut spring.angle)) {
            *angle = dag.sub(*angle, by);
        }
    }

    fn stiffen(&self, robot: &mut Robot, by: ExprId) -> Result<(), Cause> {
        let link = &mut robot.links[self.links[0]];
        let Some(spring) = link.drive.as_mut().and_then(|drive| drive.series_elastic.as_mut())
        else {
            let what = "the joint has no series spring";
            return Err(Cause::NothingToChange(self.effect.name.clone(), what));
        };
        spring.stiffness = robot.dag.add(spring.stiffness, by);
        Ok(())
    }

    /// A body of its own, fixed in the link: mass, first moment and inertia about the origin of the
    /// link's frame.
    fn carry(&self, robot: &mut Robot, matter: [ExprId; 10]) {
        let [mass, x, y, z, xx, yy, zz, xy, xz, yz] = matter;
        let zero = robot.dag.zero();
        let com =
            [x, y, z].map(|moment| if moment == zero { zero } else { robot.dag.div(moment, mass) });
        let inertia = [xx, yy, zz, xy, xz, yz];
        let name = self.suffix.trim_start_matches('_').to_owned();
        let joint = Joint {
            kind: JointKind::Fixed,
            a: zero,
            alpha: zero,
            d: zero,
            theta: zero,
            variables: None,
            spring: None,
            damping: None,
        };
        robot.links.push(Link {
            name,
            parent: Some(self.links[0]),
            joint,
            limits: Limits::default(),
            body: Some(Body { mass, com, inertia, about: About::Origin }),
            drive: None,
        });
        let parents: Vec<Option<LinkId>> = robot.links.values().map(|link| link.parent).collect();
        robot.tree = Tree::new(&parents);
    }

    fn add_parameters(&self, robot: &mut Robot, added: &AddedEffect) {
        let kind =
            self.links.first().map_or(JointKind::Revolute, |&link| robot.links[link].joint.kind);
        for parameter in &self.effect.parameters {
            let name = format!("{}{}", parameter.name, self.suffix);
            let symbol = robot.dag.symbol(&name, SymbolClass::Drive);
            let given = added.parameters.iter().find(|given| given.name == parameter.name);
            let doc = format!("{} ({})", parameter.description, self.effect.title);
            robot.parameters.push(Parameter {
                name,
                symbol,
                role: Role::Effect(self.place),
                known: true,
                default: given.map(|given| given.value),
                std: given.and_then(|given| given.std),
                unit: Some(parameter.unit.of(kind).clone()),
                doc,
            });
        }
    }
}

/// The link that an effect acts on, for messages: the name of the link, or `model`.
pub fn place_name(robot: &Robot, at: EffectPlace) -> String {
    match at {
        EffectPlace::Link(link) => robot.links[link].name.clone(),
        EffectPlace::Pair(link, second) => {
            format!("{} with {}", robot.links[link].name, robot.links[second].name)
        }
        EffectPlace::Contact(contact) => robot.contacts[contact].name.clone(),
        EffectPlace::Model => "model".to_owned(),
    }
}
