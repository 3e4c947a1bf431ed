//! The mass of a body: its own, or that of its shapes.

use super::body::Scope;
use super::frame::{Snapped, pose};
use super::geom::{Lump, lump, together};
use super::settings::{Attributes, FromGeoms, Settings};
use crate::body::{BodyNotes, GivenBody, body, entries};
use crate::exact::{exactly, rounded};
use crate::fault::{Cause, Faults, clip};
use crate::tree::{Tree, TreeBody};
use crate::xml::Element;
use denavit_codegen::number::{Rational, integer};
use num_traits::Zero;

/// What was done to masses, for notes about all of them.
#[derive(Default)]
pub(crate) struct MassNotes {
    pub(crate) bodies: BodyNotes,
    /// Bodies with turns that were within rounding of quarter turns.
    pub(crate) snapped: Snapped,
    /// Bodies whose mass is that of shapes.
    pub(crate) shaped: usize,
}

/// The mass of a body, of what its element says and what its geoms weigh.
pub(crate) fn mass_of<'s>(
    name: &str,
    inertial: Option<Element<'s>>,
    geoms: &[(Element<'s>, Scope<'s>)],
    settings: &Settings<'s>,
    notes: &mut MassNotes,
    faults: &mut Faults,
) -> Option<TreeBody> {
    let shapes = match settings.from_geoms {
        FromGeoms::Always => true,
        FromGeoms::Never => false,
        FromGeoms::Auto => inertial.is_none(),
    };
    if !shapes {
        let inertial = inertial?;
        let attributes = settings.with_class(inertial, None, faults);
        let given = given(name, &attributes, settings, &mut notes.snapped, faults)?;
        return body(bounded(given, settings), &mut notes.bodies);
    }
    let lumps: Vec<Lump> = geoms
        .iter()
        .filter_map(|(geom, scope)| {
            let attributes = settings.with_class(*geom, scope.class, faults);
            lump(&attributes, settings, &scope.frame, name, &mut notes.snapped, faults)
        })
        .collect();
    let whole = together(&lumps)?;
    notes.shaped += 1;
    let at = geoms.first().map_or(0, |(geom, _)| geom.at());
    let plain = |value: &Rational| match exactly(value) {
        Some(text) if text.len() < 24 => value.clone(),
        _ => rounded(value),
    };
    let given = GivenBody {
        link: name,
        mass: plain(&whole.mass),
        com: whole.com.each_ref().map(plain),
        inertia: entries(&whole.inertia).each_ref().map(plain),
        turns: Vec::new(),
        at,
    };
    body(bounded(given, settings), &mut notes.bodies)
}

fn given<'n>(
    name: &'n str,
    inertial: &Attributes<'_>,
    settings: &Settings<'_>,
    snapped: &mut Snapped,
    faults: &mut Faults,
) -> Option<GivenBody<'n>> {
    let place = pose(inertial, settings, name, snapped, faults);
    let Some(mass) = inertial.number("mass", faults) else {
        let said = format!("the <inertial> of body `{}` has no mass", clip(name));
        faults.push(inertial.at, Cause::new(said));
        return None;
    };
    let inertia = match inertial.get("fullinertia") {
        Some(_) => inertial.numbers::<6>("fullinertia", faults)?,
        None => {
            let zero = || [integer(0), integer(0), integer(0)];
            let diagonal = match inertial.get("diaginertia") {
                Some(_) => inertial.numbers::<3>("diaginertia", faults)?,
                None => zero(),
            };
            let ([a, b, c], [d, e, f]) = (diagonal, zero());
            [a, b, c, d, e, f]
        }
    };
    Some(GivenBody {
        link: name,
        mass,
        com: place.at,
        inertia,
        turns: place.turns,
        at: inertial.at,
    })
}

/// What the compiler makes of masses: at least as much as bounds say, and balanced.
fn bounded<'n>(given: GivenBody<'n>, settings: &Settings<'_>) -> GivenBody<'n> {
    let mut given = given;
    let [least_mass, least_inertia] = &settings.bounds;
    if given.mass < *least_mass {
        given.mass = least_mass.clone();
    }
    let [a, b, c, products @ ..] = &given.inertia;
    if !products.iter().all(Zero::is_zero) {
        return given;
    }
    let mut moments = [a, b, c].map(|moment| moment.max(least_inertia).clone());
    let sum: Rational = moments.iter().sum();
    if settings.balances && moments.iter().any(|moment| moment * integer(2) > sum) {
        let mean = sum / integer(3);
        moments = std::array::from_fn(|_| mean.clone());
    }
    let [a, b, c] = moments;
    given.inertia = [a, b, c, integer(0), integer(0), integer(0)];
    given
}

/// Makes all masses together as large as the file says.
pub(crate) fn scale(tree: &mut Tree, settings: &Settings<'_>) {
    let Some(total) = &settings.total else { return };
    let sum: Rational = tree.links.iter().filter_map(|link| Some(&link.body.as_ref()?.mass)).sum();
    if sum.is_zero() {
        return;
    }
    let factor = total / sum;
    for body in tree.links.iter_mut().filter_map(|link| link.body.as_mut()) {
        body.mass = rounded(&(&body.mass * &factor));
        body.inertia = body.inertia.each_ref().map(|entry| rounded(&(entry * &factor)));
    }
    tree.notes.push(format!("masses are scaled to {} kg together", crate::exact::written(total)));
}
