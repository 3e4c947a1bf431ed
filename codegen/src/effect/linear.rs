//! Which parameters a law is linear in.

use crate::expr::{Dag, ExprId, Node, derivative, free_symbols};
use rustc_hash::FxHashMap;

/// For each parameter whether all `laws` are affine in it jointly with the linear ones before it:
/// no derivative by a linear parameter depends on a linear parameter. A derivative is searched for
/// symbols, not differentiated again, because that of |p| is a sign and its own is 0.
pub(super) fn linear(dag: &mut Dag, laws: &[ExprId], parameters: &[ExprId]) -> Vec<bool> {
    let slopes: Vec<Vec<ExprId>> = parameters
        .iter()
        .map(|&parameter| {
            let seeds: FxHashMap<ExprId, ExprId> = [(parameter, dag.one())].into_iter().collect();
            derivative(dag, laws, &seeds)
        })
        .collect();
    let mut linear: Vec<usize> = Vec::new();
    for candidate in 0..parameters.len() {
        let mut set = linear.clone();
        set.push(candidate);
        let free =
            set.iter().all(|&of| set.iter().all(|&by| !depends(dag, &slopes[of], parameters[by])));
        if free {
            linear = set;
        }
    }
    (0..parameters.len()).map(|place| linear.contains(&place)).collect()
}

/// Whether one of the expressions names a symbol.
pub(super) fn depends(dag: &Dag, exprs: &[ExprId], symbol: ExprId) -> bool {
    let Node::Symbol(id) = dag.node(symbol) else { return false };
    free_symbols(dag, exprs).contains(&id)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::{SymbolClass, text};

    #[test]
    fn products_of_parameters_and_what_shapes_a_law_are_not_linear() {
        let mut dag = Dag::new();
        let names = ["a", "b", "c"];
        let parameters = names.map(|name| dag.symbol(name, SymbolClass::Drive));
        let mut of = |law: &str| {
            let law = text::parse(&mut dag, law, &mut |dag, name| {
                let known = names.iter().position(|known| *known == name);
                known.map_or_else(
                    || Some(dag.symbol(name, SymbolClass::Rate)),
                    |place| Some(parameters[place]),
                )
            });
            let law = law.expect("an expression");
            linear(&mut dag, &[law], &parameters)
        };
        assert_eq!(of("a*v + b*sign(v)"), [true, true, true]);
        assert_eq!(of("a*exp(-v/b)"), [true, false, true]);
        assert_eq!(of("a*b*v + c"), [true, false, true]);
        assert_eq!(of("abs(a)*v"), [false, true, true]);
        assert_eq!(of("max(0, v - b) + a"), [true, false, true]);
    }
}
