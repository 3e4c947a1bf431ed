//! Mass properties: turned into the frame of their link, and whether a body can have them.

use crate::exact::{
    Matrix, Vector, exactly, power_of_ten, product, rounded, transformed, transposed,
};
use crate::fault::{Cause, Faults, clip, listed};
use crate::place::{Pose, Turn, is_quarter, matrix};
use crate::tree::{Tree, TreeBody};
use denavit_codegen::model::{Unphysical, find_fault};
use denavit_codegen::number::{Rational, integer};
use num_traits::{Signed, Zero};

/// What a file says of a body: the tensor about the centre of mass, in axes that turns lead to.
pub(crate) struct GivenBody<'n> {
    pub(crate) link: &'n str,
    pub(crate) mass: Rational,
    pub(crate) com: Vector,
    pub(crate) inertia: [Rational; 6],
    pub(crate) turns: Vec<Turn>,
    pub(crate) at: usize,
}

/// What was done to bodies, for a note about all of them.
#[derive(Debug, Default)]
pub(crate) struct BodyNotes {
    /// Links whose tensor was turned and rounded.
    pub(crate) rounded: Vec<String>,
    /// Links whose moments no body has.
    pub(crate) accepted: Vec<String>,
}

/// The body in its link's frame; nothing if it has neither mass nor inertia.
pub(crate) fn body(given: GivenBody<'_>, notes: &mut BodyNotes) -> Option<TreeBody> {
    let GivenBody { link, mass, com, inertia, turns, at } = given;
    if mass.is_zero() && inertia.iter().all(Zero::is_zero) {
        return None;
    }
    let fault = find_fault(&mass, &inertia);
    let turned = turned(&inertia, &turns);
    let inertia = if is_quarter(&turns) {
        turned
    } else {
        notes.rounded.push(link.to_owned());
        rounded_body(&mass, turned.map(|entry| rounded(&entry)), fault.is_some())
    };
    let fault = fault.and(find_fault(&mass, &inertia));
    if fault.as_ref().is_some_and(Unphysical::can_be_accepted) {
        notes.accepted.push(link.to_owned());
    }
    Some(TreeBody { mass, com, inertia, fault, at })
}

/// Refuses what no body is. What is fixed to the world moves nothing, and what is fixed to another
/// body is part of it: there, it is the whole that must be one.
pub(crate) fn settle(tree: &mut Tree, faults: &mut Faults) {
    let (mut still, mut joined) = (Vec::new(), Vec::new());
    let is_odd = |body: &Option<TreeBody>| body.as_ref().is_some_and(|body| !body.is_possible());
    for at in (0..tree.links.len()).rev() {
        let link = &tree.links[at];
        if !is_odd(&link.body) {
            continue;
        }
        let name = link.name.clone().unwrap_or_default();
        match link.parent {
            _ if is_still(tree, at) => {
                tree.links[at].body = None;
                still.push(name);
            }
            Some(parent) if link.joint.is_none() => {
                let way: Vec<Pose> = link.before.iter().chain(&link.after).cloned().collect();
                let Some(child) = tree.links[at].body.take() else { continue };
                let whole = both(tree.links[parent].body.take(), child, &way);
                tree.links[parent].body = Some(whole);
                tree.links[parent].is_joined = true;
                joined.push(name);
            }
            _ => {}
        }
    }
    for link in &tree.links {
        let Some(body) = &link.body else { continue };
        let name = link.name.as_deref().unwrap_or_default();
        if body.mass.is_negative() {
            let said = format!("the mass of link `{}` is negative", clip(name));
            faults.push(body.at, Cause::new(said));
        } else if let Some(fault) = body.fault.as_ref().filter(|fault| !fault.can_be_accepted()) {
            faults.push(body.at, refused(name, fault));
        }
    }
    if !still.is_empty() {
        let said = "masses that no body has are left out where they are fixed to the world";
        tree.notes.push(format!("{said}: {}", listed(&still)));
    }
    if !joined.is_empty() {
        let said = "masses that no body has are joined with the bodies that they are fixed to";
        tree.notes.push(format!("{said}: {}", listed(&joined)));
    }
}

/// Whether a link is fixed to a world that does not move.
fn is_still(tree: &Tree, link: usize) -> bool {
    let mut at = link;
    while let (None, Some(parent)) = (&tree.links[at].joint, tree.links[at].parent) {
        at = parent;
    }
    !tree.floats && tree.links[at].parent.is_none()
}

/// Two bodies as one, in the frame of the first; a way leads to that of the second.
fn both(first: Option<TreeBody>, second: TreeBody, way: &[Pose]) -> TreeBody {
    let (mut turns, mut place) = (Vec::new(), second.com.clone());
    for pose in way.iter().rev() {
        let moved = transformed(&matrix(&pose.turns), &place);
        place = std::array::from_fn(|k| &pose.at[k] + &moved[k]);
        turns = [pose.turns.clone(), turns].concat();
    }
    let second_inertia = turned(&second.inertia, &turns);
    let Some(first) = first else {
        let [com, inertia] = [place.to_vec(), second_inertia.to_vec()].map(rounded_all);
        let mass = second.mass.clone();
        return made(mass, com, inertia, second.at);
    };
    let mass = &first.mass + &second.mass;
    let com: Vector = std::array::from_fn(|k| {
        let sum = &first.com[k] * &first.mass + &place[k] * &second.mass;
        if mass.is_zero() { first.com[k].clone() } else { rounded(&(sum / &mass)) }
    });
    let away = |mass: &Rational, from: &Vector| {
        let off: Vector = std::array::from_fn(|k| &from[k] - &com[k]);
        let square: Rational = off.iter().map(|x| x * x).sum();
        entries(&std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                let own = if row == column { square.clone() } else { Rational::zero() };
                mass * (own - &off[row] * &off[column])
            })
        }))
    };
    let moved = [away(&first.mass, &first.com), away(&second.mass, &place)];
    let sum = (0..6).map(|k| &first.inertia[k] + &second_inertia[k] + &moved[0][k] + &moved[1][k]);
    made(mass, com.to_vec(), rounded_all(sum.collect()), first.at)
}

fn rounded_all(values: Vec<Rational>) -> Vec<Rational> {
    values
        .iter()
        .map(|value| if exactly(value).is_some() { value.clone() } else { rounded(value) })
        .collect()
}

fn made(mass: Rational, com: Vec<Rational>, inertia: Vec<Rational>, at: usize) -> TreeBody {
    let com = std::array::from_fn(|k| com[k].clone());
    let inertia: [Rational; 6] = std::array::from_fn(|k| inertia[k].clone());
    let fault = find_fault(&mass, &inertia);
    TreeBody { mass, com, inertia, fault, at }
}

fn refused(link: &str, fault: &Unphysical) -> Cause {
    let said = format!("link `{}`: {fault}", clip(link));
    match fault {
        Unphysical::InertiaWithoutMass => {
            Cause::with_hint(said, "give the mass, or leave out the inertia")
        }
        _ => Cause::with_hint(said, "the tensor of a description is about the centre of mass"),
    }
}

/// A tensor that is on the border of what bodies have may be rounded over it: it is rounded up.
fn rounded_body(mass: &Rational, inertia: [Rational; 6], violates: bool) -> [Rational; 6] {
    let mut inertia = inertia;
    let size: Rational = inertia[..3].iter().sum();
    let mut step = rounded(&size) * power_of_ten(-17);
    let mut tries = 0;
    while !violates && tries < 8 && find_fault(mass, &inertia).is_some() {
        for moment in &mut inertia[..3] {
            *moment = rounded(&(&*moment + &step));
        }
        step *= integer(4);
        tries += 1;
    }
    inertia
}

/// `R I R^T`
fn turned(inertia: &[Rational; 6], turns: &[Turn]) -> [Rational; 6] {
    if turns.is_empty() {
        return inertia.clone();
    }
    let turn = matrix(turns);
    entries(&product(&product(&turn, &tensor(inertia)), &transposed(&turn)))
}

/// The matrix of xx, yy, zz, xy, xz, yz.
pub(crate) fn tensor([xx, yy, zz, xy, xz, yz]: &[Rational; 6]) -> Matrix {
    [
        [xx.clone(), xy.clone(), xz.clone()],
        [xy.clone(), yy.clone(), yz.clone()],
        [xz.clone(), yz.clone(), zz.clone()],
    ]
}

/// xx, yy, zz, xy, xz, yz of a matrix.
pub(crate) fn entries(matrix: &Matrix) -> [Rational; 6] {
    [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
        .map(|(row, column)| matrix[row][column].clone())
}
