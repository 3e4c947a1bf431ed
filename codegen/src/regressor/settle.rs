//! Whether amounts of parameters are felt by no torque: matter is handed from the tips to the base
//! and what is left at each body must be what the body does not feel.

use super::column::{Feature, JointFunction, Regressor};
use super::inertial::{ENTRIES, entries, from_entries};
use super::still::{Point, felt, still_without_weight};
use super::turning::{
    Turning, gravity_at_seat, is_alone, is_along_z, like_rotor, screws, seat_is_still, to_child,
    turnings,
};
use crate::expr::{Dag, ExprId, Node};
use crate::fundamental::canonical_generic;
use crate::kinematics::Placement;
use crate::spatial::{PseudoInertia, cross};
use std::collections::BTreeMap;

/// Whether the columns, in these amounts, are shown to sum to 0 for every motion.
pub(super) fn settle(regressor: &Regressor, dag: &mut Dag, amounts: &[(usize, ExprId)]) -> bool {
    let Some(amounts) = without_denominators(dag, amounts) else { return false };
    let bodies = regressor.mechanism.bodies.len();
    let turnings = turnings(dag, &regressor.mechanism);
    let screws = screws(dag, &regressor.mechanism, &turnings);
    let still = still_without_weight(dag, &regressor.mechanism, regressor.terms);
    let mut settling = Settling {
        matter: vec![PseudoInertia::zero(dag); bodies],
        functions: BTreeMap::new(),
        turnings,
        screws,
        still,
        left: Vec::new(),
        regressor,
        dag,
    };
    for &(column, amount) in &amounts {
        for &(feature, factor) in &regressor.columns[column].definition {
            let part = settling.dag.mul(amount, factor);
            settling.add(feature, part);
        }
    }
    for body in (0..bodies).rev() {
        settling.body(body);
    }
    let Settling { mut left, functions, .. } = settling;
    left.extend(functions.into_values());
    // What has no exact form is not shown to vanish.
    canonical_generic(dag, &left).is_ok_and(|forms| forms.iter().all(|form| form.is_zero()))
}

/// The amounts times their denominators, which must not vanish.
pub(super) fn without_denominators(
    dag: &mut Dag,
    amounts: &[(usize, ExprId)],
) -> Option<Vec<(usize, ExprId)>> {
    let fractions: Vec<(ExprId, Option<ExprId>)> =
        amounts.iter().map(|&(_, amount)| fraction(dag, amount)).collect();
    let mut bottoms: Vec<ExprId> = fractions.iter().filter_map(|&(_, bottom)| bottom).collect();
    bottoms.sort_unstable();
    bottoms.dedup();
    let forms = canonical_generic(dag, &bottoms).ok()?;
    if forms.iter().any(|form| form.is_zero()) {
        return None;
    }
    let mut result = Vec::new();
    for (&(column, _), &(top, own)) in amounts.iter().zip(&fractions) {
        let others = bottoms.iter().filter(|&&bottom| Some(bottom) != own);
        let value = others.fold(top, |value, &bottom| dag.mul(value, bottom));
        result.push((column, value));
    }
    Some(result)
}

/// An expression as numerator and denominator, as far as products and quotients go.
fn fraction(dag: &mut Dag, expr: ExprId) -> (ExprId, Option<ExprId>) {
    let (mut top, mut bottom) = (dag.one(), None);
    let mut pending = vec![expr];
    while let Some(expr) = pending.pop() {
        match dag.node(expr) {
            Node::Div(above, below) => {
                pending.push(above);
                bottom = Some(bottom.map_or(below, |bottom| dag.mul(bottom, below)));
            }
            Node::Mul(a, b) => pending.extend([a, b]),
            Node::Neg(a) => {
                top = dag.neg(top);
                pending.push(a);
            }
            _ => top = dag.mul(top, expr),
        }
    }
    (top, bottom)
}

struct Settling<'a> {
    regressor: &'a Regressor,
    dag: &'a mut Dag,
    matter: Vec<PseudoInertia>,
    functions: BTreeMap<(usize, JointFunction), ExprId>,
    turnings: Vec<Turning>,
    screws: Vec<bool>,
    still: Vec<Option<Point>>,
    /// What must be 0.
    left: Vec<ExprId>,
}

impl Settling<'_> {
    fn add(&mut self, feature: Feature, amount: ExprId) {
        match feature {
            Feature::Matter { body, entry } => {
                let mut list = [self.dag.zero(); ENTRIES];
                list[entry] = amount;
                self.matter[body] = self.matter[body].add(self.dag, &from_entries(list));
            }
            Feature::Joint { joint, function } => self.add_function(joint, function, amount),
        }
    }

    fn add_function(&mut self, joint: usize, function: JointFunction, amount: ExprId) {
        let zero = self.dag.zero();
        let sum = self.functions.entry((joint, function)).or_insert(zero);
        *sum = self.dag.add(*sum, amount);
    }

    /// Takes the matter of a body: hands it on, or leaves it, or forgets what is not felt.
    fn body(&mut self, body: usize) {
        let moving = self.regressor.mechanism.bodies[body].clone();
        let terms = self.regressor.terms;
        let zero = self.dag.zero();
        if moving.is_revolute {
            let rotor = self.functions.get(&(body, JointFunction::Acceleration)).copied();
            let mechanism = &self.regressor.mechanism;
            if let Some(rotor) = rotor
                && is_alone(self.dag, mechanism, &self.turnings, body)
            {
                let matter = like_rotor(self.dag, rotor);
                self.matter[body] = self.matter[body].add(self.dag, &matter);
                self.functions.insert((body, JointFunction::Acceleration), zero);
            }
        }
        let list = entries(&self.matter[body]);
        let mut handed = [zero; ENTRIES];
        let mut kept = list;
        let hands_on = if moving.is_revolute {
            vec![0, 3, 6]
        } else {
            let carried = moving.parent.map_or(Turning::Never, |parent| self.turnings[parent]);
            let slides_along = match carried {
                Turning::About(axis) => {
                    let axis = to_child(self.dag, &moving.turns, axis);
                    is_along_z(self.dag, axis)
                }
                Turning::Never => true,
                Turning::Freely => false,
            };
            let mut places: Vec<usize> = (4..ENTRIES).collect();
            if slides_along || !(terms.inertia || terms.coriolis) {
                places.extend([1, 2, 3]);
            }
            if seat_is_still(self.dag, &self.regressor.mechanism, body) {
                self.weigh(body, list[0]);
                places.push(0);
            }
            places
        };
        for place in hands_on {
            handed[place] = list[place];
            kept[place] = zero;
        }
        if let Some(parent) = moving.parent {
            let seat = Placement { body: Some(parent), turns: moving.turns, offset: moving.offset };
            let carried = seat.carry(self.dag, &from_entries(handed));
            self.matter[parent] = self.matter[parent].add(self.dag, &carried);
        }
        self.leave(body, kept);
    }

    /// Mass on a slide, handed to its still carrier, leaves what a rotor and an offset would.
    fn weigh(&mut self, body: usize, mass: ExprId) {
        if self.regressor.terms.inertia {
            self.add_function(body, JointFunction::Acceleration, mass);
        }
        if self.regressor.terms.gravity {
            let weight = gravity_at_seat(self.dag, &self.regressor.mechanism, body);
            let force = self.dag.mul(mass, weight[2]);
            let force = self.dag.neg(force);
            self.add_function(body, JointFunction::One, force);
        }
    }

    /// What a body keeps must not be felt.
    fn leave(&mut self, body: usize, kept: [ExprId; ENTRIES]) {
        let terms = self.regressor.terms;
        let is_moving = terms.inertia || terms.coriolis;
        let [mass, x, y, z, k11, k22, k33, k12, k13, k23] = kept;
        match (self.still[body], self.turnings[body]) {
            (Some(_), Turning::Freely) => {}
            _ => self.left.push(mass),
        }
        match self.turnings[body] {
            Turning::Never => {}
            Turning::About(axis) => {
                if is_moving {
                    // tr K - u.K u, which is K11 + K22 about z; slides have handed on their K.
                    let sum = self.dag.add(k11, k22);
                    self.left.push(sum);
                }
                let weight = gravity_at_seat(self.dag, &self.regressor.mechanism, body);
                let on_line = self.screws[body] || !is_moving;
                let is_still = on_line && (!terms.gravity || is_along_z(self.dag, weight));
                if !is_still {
                    let across = cross(self.dag, axis, [x, y, z]);
                    self.left.extend(across);
                }
            }
            Turning::Freely => match self.still[body] {
                Some(_) if !is_moving => {}
                Some(point) => {
                    let about = felt(self.dag, point, &from_entries(kept));
                    self.left.extend(about);
                }
                None => {
                    self.left.extend([x, y, z]);
                    if is_moving {
                        self.left.extend([k11, k22, k33, k12, k13, k23]);
                    }
                }
            },
        }
    }
}
