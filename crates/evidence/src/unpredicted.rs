//! Rows that an effect takes away: a drive at its limit, whose demand is logged, gives the limit,
//! whatever the demand is.
//!
//! Of such a row a hypothesis says that the demand is beyond the limit, on the side where the model
//! needs it. With m what the model needs, v its variance and L the limit, that has the probability
//! P = Phi((m - L) / sqrt v). How far beyond the demand is, e, has the density of what is taken
//! away on this side alone, 2 N(e; 0, s). The row was weighed as one that is given to be L, with
//! the density N(L; m, v). So what it does not earn is
//!
//! ```text
//! 1/2 log(s / v) + e^2 / 2 s - (m - L)^2 / 2 v - log 2 - log P
//! ```
//!
//! In the mean over rows the squares are equal, and the last term is 1 where the model predicts the
//! limit: then P is as likely to have any value. Where the model says nothing, m is 0 and v is L^2:
//! it is -log Phi(-1). The share of the limit that the model leaves, v / L^2, is taken to go from
//! one to the other in proportion. So who takes nearly everything away must predict the sides of
//! what is left. Where little is taken away s counts beside v.

use crate::policy;
use crate::terms::Terms;
use std::ops::Range;

/// What an effect says nothing of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Unpredicted {
    /// The share of rows of which the effect says nothing but that they are beyond a limit.
    pub share: f64,
    /// The mean square of the data in these rows where what is beyond is taken away.
    pub left: f64,
}

/// What terms do not earn where effects take away what data are, whatever that is. Cells are
/// channels, rows and variances.
pub(crate) fn unearned(terms: &[&Terms], cells: &[(usize, Range<usize>, f64)]) -> f64 {
    let of = |one: &&Terms| -> f64 {
        let of_channel = |(channel, known): (usize, &Vec<f64>)| {
            let own = cells.iter().filter(|(of, ..)| *of == channel);
            let own: Vec<_> = own.map(|(_, rows, variance)| (rows.clone(), *variance)).collect();
            one.unpredicted.cost(known, &own)
        };
        one.known.iter().enumerate().map(of_channel).sum()
    };
    terms.iter().filter(|one| one.unpredicted.share > 0.0).map(of).sum()
}

impl Unpredicted {
    /// What the rows of a channel do not earn: `known` is taken away from them, and each of its
    /// cells has a variance.
    fn cost(&self, known: &[f64], cells: &[(Range<usize>, f64)]) -> f64 {
        let rows: usize = cells.iter().map(|(rows, _)| rows.len()).sum();
        if self.share <= 0.0 || known.is_empty() || rows == 0 {
            return 0.0;
        }
        let sum: f64 = cells.iter().map(|(rows, variance)| rows.len() as f64 * variance).sum();
        let not_predicted = (sum / rows as f64 / self.left.max(f64::MIN_POSITIVE)).min(1.0);
        let [least, most] = policy::SIDE;
        let of_side = least + not_predicted * (most - least);
        let of_cell = |(rows, variance): &(Range<usize>, f64)| {
            let (count, own) = (rows.len() as f64, &known[rows.clone()]);
            let mean = own.iter().map(|entry| entry * entry).sum::<f64>() / count;
            self.share * count * (0.5 * (mean / variance).ln_1p() + of_side)
        };
        cells.iter().map(of_cell).sum()
    }
}
