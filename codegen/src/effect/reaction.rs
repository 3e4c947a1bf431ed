//! The second joint of a pair: what it feels of a law, as a law of its own.

use super::{Effect, EffectSite, Law};
use crate::expr::{Dag, ExprId, Symbol, import};

impl Effect {
    /// The effect as its second joint has it, with the two joints exchanged; none of effects that
    /// only the first one feels.
    pub fn on_second(&self) -> Option<Effect> {
        let (Law::Torque(torque), Some(second)) = (&self.law, self.torque_2) else { return None };
        let mut dag = self.dag.clone();
        let swapped = exchange(&mut dag, &[second, *torque]);
        let (law, torque_2) = (Law::Torque(swapped[0]), Some(swapped[1]));
        Some(Effect { law, torque_2, dag, ..self.clone() })
    }

    /// Whether a pair is the same with its joints exchanged: what couples them has no order.
    pub fn has_no_order(&self) -> bool {
        self.at == EffectSite::JointPair
            && self.on_second().is_some_and(|other| other.law == self.law)
    }
}

/// Expressions with the symbols of one joint in place of those of the other. Their DAG grows.
fn exchange(dag: &mut Dag, exprs: &[ExprId]) -> Vec<ExprId> {
    let source = dag.clone();
    import(dag, &source, exprs, |dag: &mut Dag, symbol: &Symbol| {
        let name = symbol.name.as_str();
        let is_motion = |stem: &str| super::MOTION.contains(&stem);
        let other = match name.strip_suffix("_2").filter(|stem| is_motion(stem)) {
            Some(stem) => stem.to_owned(),
            None if is_motion(name) => format!("{name}_2"),
            None => name.to_owned(),
        };
        dag.symbol(&other, symbol.class)
    })
}

#[cfg(test)]
mod tests {
    use super::super::{find, read};
    use super::*;

    #[test]
    fn what_couples_joints_has_no_order_and_what_one_joint_feels_has() {
        for name in ["coupled_inertia", "coupled_viscous", "coupled_coulomb"] {
            assert!(find(name).is_some_and(Effect::has_no_order), "{name}");
        }
        let text = |second: &str| {
            format!(
                r#"{{"format": "denavit-effect/1", "name": "belt", "title": "t", "description": "d",
                "source": "s", "kind": "torque", "at": "joint_pair",
                "parameters": {{"k": {{"unit": "1", "description": "share", "nominal": 0,
                "bounds": [0, 1]}}}}, "torque": "k*tau_load_2"{second}}}"#
            )
        };
        let one = read("belt.json", text("").as_bytes()).expect("an effect");
        assert!(one.on_second().is_none() && !one.has_no_order());
        let both = text(r#", "torque_2": "-k*tau_load_rate""#);
        // a torque per second is no torque
        assert!(read("belt.json", both.as_bytes()).is_err());
        let both = read("belt.json", text(r#", "torque_2": "-k*tau_load_2""#).as_bytes());
        let both = both.expect("an effect");
        assert!(!both.has_no_order());
        let mut second = both.on_second().expect("both feel it");
        let k = second.symbol("k").expect("its share");
        let load = second.symbol("tau_load").expect("the load of its own joint");
        let product = second.dag.mul(k, load);
        assert_eq!(second.law, Law::Torque(second.dag.neg(product)));
    }
}
