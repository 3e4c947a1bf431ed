//! Where assembled constraints go: their values, their derivatives, and once what they are.

use super::sparse::Triplets;

/// What a constraint says, and where in the step.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Label {
    /// What it says: "friction cone".
    pub what: &'static str,
    /// Which joint or contact it is about; empty if none.
    pub part: String,
    /// The phase.
    pub phase: usize,
    /// Share of the phase's duration before it.
    pub fraction: f64,
    /// The unit by which residuals are divided, in the unit of `unit`.
    pub size: f64,
    /// "m", "rad", "N", ...
    pub unit: &'static str,
}

/// What does not depend on the variables: ranges and labels of the constraints.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Shape {
    pub(super) ranges: Vec<[f64; 2]>,
    pub(super) labels: Vec<Label>,
}

/// An equation.
pub(super) const EQUAL: [f64; 2] = [0.0, 0.0];
/// Something that is not negative.
pub(super) const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];

/// Takes constraints as they are assembled.
#[derive(Debug)]
pub(super) struct Sink<'a> {
    pub(super) values: &'a mut Vec<f64>,
    pub(super) jacobian: Option<&'a mut Triplets>,
    pub(super) shape: Option<&'a mut Shape>,
    /// Unit of the current row.
    size: f64,
}

impl<'a> Sink<'a> {
    pub(super) fn new(
        values: &'a mut Vec<f64>,
        jacobian: Option<&'a mut Triplets>,
        shape: Option<&'a mut Shape>,
    ) -> Self {
        values.clear();
        Self { values, jacobian, shape, size: 1.0 }
    }

    /// Whether derivatives are wanted.
    pub(super) fn differentiates(&self) -> bool {
        self.jacobian.is_some()
    }

    /// Begins a constraint; value and range in its own unit.
    pub(super) fn row(&mut self, value: f64, range: [f64; 2], label: impl FnOnce() -> Label) {
        let shape = self.shape.as_deref_mut();
        let size = match shape {
            Some(shape) => {
                let label = label();
                self.size = label.size;
                shape.ranges.push(range.map(|end| end / label.size));
                shape.labels.push(label);
                self.size
            }
            None => {
                self.size = label().size;
                self.size
            }
        };
        self.values.push(value / size);
    }

    /// A derivative of the constraint begun last.
    pub(super) fn entry(&mut self, column: usize, value: f64) {
        let row = self.values.len() - 1;
        if let Some(jacobian) = self.jacobian.as_deref_mut() {
            jacobian.add(row, column, value / self.size);
        }
    }

    /// Derivatives of the constraint begun last by variables that follow each other.
    pub(super) fn entries(&mut self, first: usize, values: &[f64]) {
        for (index, value) in values.iter().enumerate() {
            self.entry(first + index, *value);
        }
    }
}
