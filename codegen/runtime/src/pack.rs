//! Many samples at once: packs of numbers, read from columns of samples.

use core::fmt;

/// A number of several lanes, or an array or a tuple of such: what a function computes for several
/// samples at once. Its entries stand in columns: one number for each sample.
pub trait Packed: Copy {
    /// How many samples it holds.
    const LANES: usize;
    /// How many numbers a sample has.
    const ENTRIES: usize;
    /// Zeros: where samples are read to.
    const ZEROS: Self;

    /// Reads the samples from row `first` on; lanes beyond the last sample repeat it. There are
    /// [`ENTRIES`](Self::ENTRIES) columns.
    fn read(&mut self, columns: &[&[f64]], first: usize);

    /// Writes the samples that there are from row `first` on.
    fn write(&self, columns: &mut [&mut [f64]], first: usize);
}

impl<T: Packed, const N: usize> Packed for [T; N] {
    const LANES: usize = {
        assert!(T::ENTRIES > 0, "nothing has no samples");
        T::LANES
    };
    const ENTRIES: usize = N * T::ENTRIES;
    const ZEROS: Self = [T::ZEROS; N];

    #[inline]
    fn read(&mut self, columns: &[&[f64]], first: usize) {
        for (pack, columns) in self.iter_mut().zip(columns.chunks_exact(T::ENTRIES)) {
            pack.read(columns, first);
        }
    }

    #[inline]
    fn write(&self, columns: &mut [&mut [f64]], first: usize) {
        for (pack, columns) in self.iter().zip(columns.chunks_exact_mut(T::ENTRIES)) {
            pack.write(columns, first);
        }
    }
}

/// Tuples of two and three: what functions with several results are made into.
macro_rules! packed_tuple {
    ($($name:ident $row:tt),+) => {
        impl<First: Packed, $($name: Packed),+> Packed for (First, $($name),+) {
            const LANES: usize = {
                assert!(true $(&& $name::LANES == First::LANES)+, "members are packed alike");
                First::LANES
            };
            const ENTRIES: usize = First::ENTRIES $(+ $name::ENTRIES)+;
            const ZEROS: Self = (First::ZEROS, $($name::ZEROS),+);

            #[inline]
            fn read(&mut self, columns: &[&[f64]], first: usize) {
                let (own, rest) = columns.split_at(First::ENTRIES);
                self.0.read(own, first);
                $(
                    let (own, rest) = rest.split_at($name::ENTRIES);
                    self.$row.read(own, first);
                )+
                debug_assert!(rest.is_empty());
            }

            #[inline]
            fn write(&self, columns: &mut [&mut [f64]], first: usize) {
                let (own, rest) = columns.split_at_mut(First::ENTRIES);
                self.0.write(own, first);
                $(
                    let (own, rest) = rest.split_at_mut($name::ENTRIES);
                    self.$row.write(own, first);
                )+
                debug_assert!(rest.is_empty());
            }
        }
    };
}

packed_tuple!(Second 1);
packed_tuple!(Second 1, Third 2);

/// Columns that do not fit a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColumnFault {
    /// An input, or the outputs, has another number of columns than a sample has numbers.
    Columns {
        /// The input by its number, or the outputs.
        input: Option<usize>,
        /// The number of columns that it must have.
        expected: usize,
        /// The number that it has.
        found: usize,
    },
    /// A column has another number of samples than there are.
    Samples {
        /// The input by its number, or the outputs.
        input: Option<usize>,
        /// The column.
        column: usize,
        /// The number of samples that there are.
        expected: usize,
        /// The number that it has.
        found: usize,
    },
}

impl fmt::Display for ColumnFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (Self::Columns { input, .. } | Self::Samples { input, .. }) = self;
        match input {
            Some(input) => write!(f, "input {input}: ")?,
            None => write!(f, "outputs: ")?,
        }
        match self {
            Self::Columns { expected, found, .. } => {
                write!(f, "{found} columns instead of {expected}")
            }
            Self::Samples { column, expected, found, .. } => {
                write!(f, "column {column} has {found} samples instead of {expected}")
            }
        }
    }
}

impl core::error::Error for ColumnFault {}

fn check<C: AsRef<[f64]>>(
    input: Option<usize>,
    columns: &[C],
    entries: usize,
    samples: usize,
) -> Result<(), ColumnFault> {
    if columns.len() != entries {
        let (expected, found) = (entries, columns.len());
        return Err(ColumnFault::Columns { input, expected, found });
    }
    for (column, values) in columns.iter().enumerate() {
        let (expected, found) = (samples, values.as_ref().len());
        if expected != found {
            return Err(ColumnFault::Samples { input, column, expected, found });
        }
    }
    Ok(())
}

/// Calls `consume` with the packs of one sample after the other: with the row of the first, and
/// with what each of `inputs` holds of them.
///
/// Every input is a column for each of its entries, with a number for each of `samples` samples.
/// (Samples that lie side by side would take longer to read than to compute.) The lanes of the last
/// pack that are beyond the last sample repeat it.
///
/// # Errors
/// If an input does not hold that many samples; nothing is called then.
#[inline]
pub fn for_each_pack<I: Packed, const A: usize>(
    inputs: [&[&[f64]]; A],
    samples: usize,
    mut consume: impl FnMut(usize, [&I; A]),
) -> Result<(), ColumnFault> {
    const { assert!(I::LANES > 0 && I::ENTRIES > 0, "nothing has no samples") };
    for (input, columns) in inputs.iter().enumerate() {
        check(Some(input), columns, I::ENTRIES, samples)?;
    }
    let mut packs = [I::ZEROS; A];
    for first in (0..samples).step_by(I::LANES) {
        for (pack, columns) in packs.iter_mut().zip(inputs) {
            pack.read(columns, first);
        }
        consume(first, packs.each_ref());
    }
    Ok(())
}

/// `output[k] = function(inputs[0][k], inputs[1][k], ..)` for every sample k, in packs; inputs and
/// outputs in columns as for [`for_each_pack`]. Each sample gets the bits that the function gives
/// on single numbers: lanes do not touch each other.
///
/// ```
/// use denavit_runtime::{Scalar, map_packs, wide::f64x4};
///
/// fn torque<S: Scalar>(q: &[S; 1], qd: &[S; 1]) -> [S; 1] {
///     [q[0].sincos().0 + qd[0] * qd[0]]
/// }
///
/// let (q, qd) = ([0.1, 0.2, 0.3, 0.4, 0.5], [1.0; 5]);
/// let mut torques = [0.0; 5];
/// map_packs([&[&q], &[&qd]], &mut [&mut torques], |[q, qd]: [&[f64x4; 1]; 2]| torque(q, qd))
///     .unwrap();
/// assert_eq!(torques[4], torque(&[0.5], &[1.0])[0]);
/// ```
///
/// # Errors
/// If the columns do not hold the same number of samples; nothing is computed then.
#[inline]
pub fn map_packs<I: Packed, O: Packed, const A: usize>(
    inputs: [&[&[f64]]; A],
    outputs: &mut [&mut [f64]],
    function: impl Fn([&I; A]) -> O,
) -> Result<(), ColumnFault> {
    const {
        assert!(I::LANES == O::LANES, "inputs and outputs are packed alike");
        assert!(O::ENTRIES > 0, "nothing has no samples");
    };
    let samples = outputs.first().map_or(0, |column| column.len());
    check(None, outputs, O::ENTRIES, samples)?;
    for_each_pack(inputs, samples, |first, packs| function(packs).write(outputs, first))
}
