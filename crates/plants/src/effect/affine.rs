//! Steps of states whose rates are affine in them: all that depends on the motion is evaluated for
//! many samples at once, and what is left from sample to sample is a product and a sum.
//!
//! With f = f0 + a x, f0 and a of the motion alone, a step (`states.rs`) is
//!
//! ```text
//! x' = x + h phi f,   S' = (1 + h phi a) S + h (phi df/dp + h phi' f da/dp),   phi = phi_1(h a)
//! ```

use super::states::{StateLaw, phi_1};
use denavit_codegen::expr::{Dag, ExprId, Node};
use rustc_hash::FxHashMap;
use std::ops::Range;

/// Whether rates are affine in states: by how they are written, for what is piecewise in a state
/// may have no second derivative as well.
pub(super) fn is_affine(dag: &Dag, rates: &[ExprId], states: &[ExprId]) -> bool {
    // 0 of what has no state in it, 1 of what is affine, 2 of all else
    let mut degrees: FxHashMap<ExprId, u32> = FxHashMap::default();
    for expr in dag.topological(rates) {
        let of = |operand: &ExprId| degrees[operand];
        let node = dag.node(expr);
        let mut largest = 0;
        node.for_each_operand(|operand| largest = largest.max(of(&operand)));
        let bent = if largest == 0 { 0 } else { 2 };
        let degree = match node {
            Node::Symbol(_) => u32::from(states.contains(&expr)),
            Node::Neg(a) => of(&a),
            Node::Add(a, b) | Node::Sub(a, b) => of(&a).max(of(&b)),
            Node::Mul(a, b) => of(&a) + of(&b),
            Node::Div(a, b) if of(&b) == 0 => of(&a),
            _ => bent,
        };
        degrees.insert(expr, degree.min(2));
    }
    rates.iter().all(|rate| degrees[rate] < 2)
}

/// Samples of which rates are evaluated at once.
const BLOCK: usize = 256;

impl StateLaw {
    /// Steps of separate states with affine rates. `paths` of states and, behind them, of their
    /// sensitivities have the first sample, and get the others.
    pub(super) fn affine_steps(
        &self,
        t: &[f64],
        columns: &[&[f64]],
        values: &[f64],
        paths: &mut [Vec<f64>],
    ) {
        let nothing = [0.0; BLOCK];
        let mut rates = self.rates.batch(values);
        let mut entries = vec![vec![0.0; BLOCK]; rates.outputs()];
        for first in (1..t.len()).step_by(BLOCK) {
            let samples = first..(first + BLOCK).min(t.len());
            let middle = |column: &&[f64]| -> Vec<f64> {
                samples.clone().map(|k| 0.5 * (column[k - 1] + column[k])).collect()
            };
            let middles: Vec<Vec<f64>> = columns.iter().map(middle).collect();
            let mut inputs: Vec<&[f64]> = middles.iter().map(Vec::as_slice).collect();
            // f0 is the rate where states are 0
            inputs.resize(columns.len() + self.states, &nothing[..samples.len()]);
            let mut outputs: Vec<&mut [f64]> =
                entries.iter_mut().map(|column| &mut column[..samples.len()]).collect();
            rates.evaluate(&inputs, &mut outputs).expect("the shapes are those of the law");
            (0..self.states)
                .for_each(|i| self.affine_block(i, t, samples.clone(), &entries, paths));
        }
    }

    /// The steps of one state to some samples, given the entries of the rates before them.
    fn affine_block(
        &self,
        i: usize,
        t: &[f64],
        samples: Range<usize>,
        entries: &[Vec<f64>],
        paths: &mut [Vec<f64>],
    ) {
        let (s, p) = (self.states, self.parameters);
        let (rate, slope) = (&entries[i], &entries[s + i * s + i]);
        let by_parameter = &entries[s + s * s + i * p..][..p];
        let slope_by_parameter = &entries[s + s * (s + p) + (i * s + i) * (s + p) + s..][..p];
        let mut x = paths[i][samples.start - 1];
        // of each step: where it begins, and what sensitivities are multiplied by and get
        let mut steps = Vec::with_capacity(samples.len());
        for (row, k) in samples.enumerate() {
            let (h, a) = (t[k] - t[k - 1], slope[row]);
            let (phi, turned) = phi_1(h * a);
            let f = rate[row] + a * x;
            steps.push([x, 1.0 + h * phi * a, h * phi, h * h * turned * f]);
            x += h * phi * f;
            paths[i].push(x);
        }
        for parameter in 0..p {
            let path = &mut paths[s + i * p + parameter];
            let mut moved = path[path.len() - 1];
            let both = by_parameter[parameter].iter().zip(&slope_by_parameter[parameter]);
            for ([x, kept, of_rate, of_slope], (rate, slope)) in steps.iter().zip(both) {
                moved = kept * moved + of_rate * (rate + slope * x) + of_slope * slope;
                path.push(moved);
            }
        }
    }
}
