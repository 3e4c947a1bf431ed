//! Total least squares: columns as noisy as what they are to give (Golub, Van Loan 1980).

use super::least_squares::Estimate;

/// Replaces phi by the total least-squares solution: of the columns of W and y scaled to length 1,
/// the direction that they span least. It stays as it is if that direction has no y.
pub(super) fn total(found: &mut Estimate) {
    let triangles = found.condensed.whole();
    let rank = found.condensed.rank;
    let mut r = found.condensed.system(&triangles, &found.weights, &[]);
    let lengths: Vec<f64> = r.column_iter().map(|column| column.norm()).collect();
    let is_excited = lengths.iter().all(|&length| length > 0.0) && found.solution.dead.is_empty();
    if !is_excited {
        return;
    }
    for (mut column, length) in r.column_iter_mut().zip(&lengths) {
        column /= *length;
    }
    let singular = r.svd(false, true);
    let least = singular.singular_values.imin();
    let directions = singular.v_t.expect("it was asked for");
    let of_target = directions[(least, rank)];
    if of_target.abs() < 1e-12 {
        return;
    }
    for place in 0..rank {
        let share = -directions[(least, place)] / of_target;
        found.solution.phi[place] = share * lengths[rank] / lengths[place];
    }
}
