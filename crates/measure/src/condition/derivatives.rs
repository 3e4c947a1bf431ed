//! Whether logged rates and accelerations are the derivatives of the positions.
//!
//! Both went through the same filter, which is linear: the derivatives of what it left are what it
//! leaves of the derivatives. A column is compared by its factor and its delay, on which noise of
//! its own has no influence.

use super::{Conditioned, STENCIL, acceleration, rate};
use crate::JointIndex;
use crate::error::{Error, ErrorKind};
use crate::policy::derivatives::{DELAY, FACTOR, NOISE};

impl Conditioned {
    /// Refuses logged rates and accelerations that are not derivatives of the positions.
    pub(super) fn compare_rates(&self, names: &[String]) -> Result<(), Error> {
        let Some(rates) = &self.rates else { return Ok(()) };
        let gains = self.filter_gains();
        for (joint, name) in names.iter().enumerate().filter(|(at, _)| !self.resting[*at]) {
            for (order, prefix) in [(1, "qd"), (2, "qdd")] {
                let column = &rates[order - 1][joint];
                let noise = gains[order][order] * self.position_noise[joint].powi(2);
                if let Some([factor, late_s]) =
                    self.compared(JointIndex(joint), order, column, noise)
                {
                    let text = format!(
                        "`{prefix}_{name}` is not the derivative of the position: it is \
                         {factor:.3} times that, {late_s:.4} s late\n  hint: `logs.columns` scales \
                         columns; `conditions.derivatives=differences` takes the derivatives of \
                         the positions"
                    );
                    return Err(Error::new(ErrorKind::Derivatives, text));
                }
            }
        }
        Ok(())
    }

    /// Factor and delay \[s\] of a column against the derivative of a joint's position, if they are
    /// too large, by least squares: column = a own + b own', a delay being -b / a.
    fn compared(
        &self,
        joint: JointIndex,
        order: usize,
        column: &[f64],
        noise: f64,
    ) -> Option<[f64; 2]> {
        let (q, h) = (&self.q[joint.0], self.step_s);
        let own = |k: usize| match order {
            1 => rate(q, k) / h,
            _ => acceleration(q, k) / (h * h),
        };
        let first = self.range.start.max(STENCIL + 1);
        let last = self.range.end.min(q.len().saturating_sub(STENCIL + 1));
        let mut sums = [0.0; 5];
        for k in first..last {
            let (here, next) = (own(k), (own(k + 1) - own(k - 1)) / (2.0 * h));
            let terms = [here * here, here * next, next * next, here * column[k], next * column[k]];
            sums.iter_mut().zip(terms).for_each(|(sum, term)| *sum += term);
        }
        let [xx, xy, yy, xz, yz] = sums;
        let determinant = xx * yy - xy * xy;
        if noise * (last.saturating_sub(first)) as f64 > NOISE * xx || determinant <= 0.0 {
            return None;
        }
        let factor = (yy * xz - xy * yz) / determinant;
        let slope = (xx * yz - xy * xz) / determinant;
        let delayed = slope.abs() * (yy / xx).sqrt();
        let is_off = (factor - 1.0).abs() > FACTOR || delayed > DELAY;
        let late_s = if factor == 0.0 { 0.0 } else { -slope / factor };
        is_off.then_some([factor, late_s])
    }
}
