//! White noise of a channel at the times it was sampled at.

/// Samples that are looked at, in so many blocks; the median of blocks passes over what is rare.
const BLOCK: usize = 256;
const BLOCKS: usize = 64;

/// What white noise has of the ratio of its deviations by two orders, squared, at least:
/// differences of a smooth signal become smaller with each order.
pub const WHITE: f64 = 0.9;

/// The deviation of white noise, by what cubics through the neighbours of a sample leave of it,
/// which at equal distances is the difference of fourth order over 6; none if fifth-degree
/// polynomials leave less, as they do of motion.
pub(super) fn deviation(time: &[f64], values: &[f64]) -> Option<f64> {
    let rows = 0..time.len().min(values.len());
    let sound: Vec<[f64; 2]> = rows
        .map(|row| [time[row], values[row]])
        .filter(|both| both.iter().all(|value| value.is_finite()))
        .collect();
    let every = sound.len().div_ceil(BLOCK * BLOCKS).max(1);
    let blocks = || sound.chunks(BLOCK).step_by(every).filter(|block| block.len() == BLOCK);
    let short = sound.len() < BLOCK;
    let by = |reach: usize| {
        let all = if short { vec![&sound[..]] } else { blocks().collect() };
        let mut of_blocks: Vec<f64> =
            all.into_iter().filter_map(|block| variance(block, reach)).collect();
        of_blocks.sort_by(f64::total_cmp);
        of_blocks.get(of_blocks.len() / 2).copied()
    };
    let (cubic, fifth) = (by(2)?, by(3)?);
    // of a constant rounding is left
    let size = sound.iter().fold(0.0, |size: f64, [_, value]| size.max(value.abs()));
    (cubic.sqrt() > f64::EPSILON * size && fifth > WHITE * cubic).then(|| cubic.sqrt())
}

/// The variance of a block's noise, by polynomials through so many neighbours on either side; none
/// if the block is no longer than they reach.
fn variance(block: &[[f64; 2]], reach: usize) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0.0);
    for window in block.windows(2 * reach + 1) {
        if window.windows(2).any(|pair| pair[1][0] <= pair[0][0]) {
            continue; // repeated rows go later
        }
        let [at, value] = window[reach];
        let others = || (0..window.len()).filter(|&other| other != reach);
        let (mut left, mut gain) = (value, 1.0);
        for one in others() {
            let factors = others().filter(|&other| other != one);
            let weight: f64 = factors
                .map(|other| (at - window[other][0]) / (window[one][0] - window[other][0]))
                .product();
            left -= weight * window[one][1];
            gain += weight * weight;
        }
        sum += left * left / gain;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}
