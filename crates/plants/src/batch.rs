//! Emitted functions on many samples, on all processors.
//!
//! Within a thread samples go in packs of four or eight
//! ([`denavit_runtime::map_packs`]); here the threads share out the rows. Rows do not touch each
//! other, so results do not depend on the number of threads.

use denavit_runtime::{ColumnFault, Packed, map_packs};
use rayon::prelude::*;

/// Rows that a thread takes at a time: enough to be worth it, few enough that all columns of a
/// regressor stay in a processor's cache.
const ROWS: usize = 256;

/// `output[k] = function(inputs[0][k], inputs[1][k], ..)` for every sample k: what
/// [`map_packs`] does, by all threads of rayon's pool. Inputs and outputs are columns with a number
/// for each sample.
///
/// ```
/// use denavit_plants::batch::map_packs_in_parallel;
/// use denavit_plants::emitted::puma560::{DOF, Parameters, gravity_vector};
/// use denavit_runtime::wide::f64x4;
///
/// let angles = vec![0.3; 10_000];
/// let q = [&angles[..]; DOF];
/// let mut torques = vec![vec![0.0; 10_000]; DOF];
/// let mut columns: Vec<&mut [f64]> = torques.iter_mut().map(|column| &mut column[..]).collect();
/// let parameters = Parameters::<f64x4>::default();
/// map_packs_in_parallel([&q], &mut columns, |[q]: [&[f64x4; DOF]; 1]| {
///     gravity_vector(&parameters, q)
/// })?;
/// assert_eq!(torques[1][9_999], gravity_vector(&Parameters::default(), &[0.3; DOF])[1]);
/// # Ok::<(), denavit_runtime::ColumnFault>(())
/// ```
///
/// # Errors
/// If the columns do not fit the function or each other. Some outputs may have been written then.
pub fn map_packs_in_parallel<I: Packed, O: Packed, const A: usize>(
    inputs: [&[&[f64]]; A],
    outputs: &mut [&mut [f64]],
    function: impl Fn([&I; A]) -> O + Sync,
) -> Result<(), ColumnFault> {
    let samples = outputs.first().map_or(0, |column| column.len());
    let is_whole = |column: &&[f64]| column.len() == samples;
    let fits = outputs.iter().all(|column| column.len() == samples)
        && inputs.iter().all(|columns| columns.iter().all(is_whole));
    if !fits {
        // It says what is wrong, and computes nothing.
        return map_packs(inputs, outputs, function);
    }
    let mut blocks: Vec<Vec<&mut [f64]>> = Vec::new();
    for column in outputs.iter_mut() {
        for (block, rows) in column.chunks_mut(ROWS).enumerate() {
            if blocks.len() == block {
                blocks.push(Vec::with_capacity(O::ENTRIES));
            }
            blocks[block].push(rows);
        }
    }
    blocks.into_par_iter().enumerate().try_for_each(|(block, mut outputs)| {
        let rows = block * ROWS..samples.min((block + 1) * ROWS);
        let own: [Vec<&[f64]>; A] =
            inputs.map(|columns| columns.iter().map(|column| &column[rows.clone()]).collect());
        map_packs(own.each_ref().map(|columns| &columns[..]), &mut outputs, &function)
    })
}
