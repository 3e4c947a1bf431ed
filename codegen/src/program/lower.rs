//! Expressions to code.

use super::interpret::run;
use super::passes::{run_on_prelude, run_on_routine};
use super::schedule::SCHEDULE;
use super::sign::ABSORB_SIGNS;
use super::verify::{expect_sound_prelude, expect_sound_routine};
use super::{
    ArgumentShape, BinaryOperation, Code, Instruction, Leaf, Operation, OutputShape, Program,
    Routine, Slot, UnaryOperation,
};
use crate::arena::Handle;
use crate::expr::{BinaryFunction, Dag, ExprId, Node, UnaryFunction, free_symbols};
use crate::function::Function;
use crate::number::to_f64;
use rustc_hash::FxHashMap;
use std::fmt;

/// Why functions cannot become code.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LowerError {
    /// A constant, or what constants alone combine to, is no finite `f64`: the model holds a
    /// number that no computer arithmetic holds, or a division by zero.
    NotFinite {
        /// The function that needs it, or `prelude`.
        function: String,
    },
}

impl fmt::Display for LowerError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { function } => {
                write!(f, "a constant in `{function}` is too large, or divides by zero")
            }
        }
    }
}

impl std::error::Error for LowerError {}

/// The functions as code, ordered, with one prelude for all of them.
pub fn lower(dag: &Dag, functions: &[Function]) -> Result<Program, LowerError> {
    let entries: Vec<ExprId> = functions.iter().flat_map(Function::entries).collect();
    let hoisted = hoisted(dag, &entries);
    let constants = symbol_free(dag, &entries);
    let not_finite = |function: &str| LowerError::NotFinite { function: function.to_owned() };

    let symbols = free_symbols(dag, &hoisted);
    let parameters = symbols.iter().map(|&id| dag.symbols()[id].name.clone()).collect();
    let mut builder = Builder::new(dag, &constants);
    let mut prelude = builder.code(&hoisted, |expr| match dag.node(expr) {
        Node::Symbol(id) => symbols.binary_search(&id).ok().map(Leaf::Parameter),
        _ => None,
    });
    expect_sound_prelude("lower", &prelude, symbols.len());
    run_on_prelude(&[SCHEDULE], &mut prelude, symbols.len());
    check_constants(&prelude).ok_or_else(|| not_finite("prelude"))?;

    let rows: FxHashMap<ExprId, usize> =
        hoisted.iter().enumerate().map(|(row, &expr)| (expr, row)).collect();
    let mut routines = Vec::with_capacity(functions.len());
    for function in functions {
        let places = argument_places(function);
        let code = builder.code(&function.entries(), |expr| {
            let prelude = rows.get(&expr).map(|&row| Leaf::Prelude(row));
            prelude.or_else(|| places.get(&expr).copied())
        });
        let mut routine = routine(function, code);
        expect_sound_routine("lower", &routine, prelude.outputs.len());
        run_on_routine(&[ABSORB_SIGNS, SCHEDULE], &mut routine, prelude.outputs.len());
        check_constants(&routine.code).ok_or_else(|| not_finite(&function.full_name()))?;
        routines.push(routine);
    }
    Ok(Program { parameters, prelude, routines })
}

/// The values of symbol-free expressions, by the arithmetic that emitted code uses: the same on
/// every platform.
pub fn constant_values(dag: &Dag, exprs: &[ExprId]) -> Vec<f64> {
    let nothing = FxHashMap::default();
    let code = Builder::new(dag, &nothing).code(exprs, |_| None);
    run::<f64>(&code, |leaf| match leaf {
        Leaf::Constant(value) => value,
        _ => unreachable!("symbol-free expressions have constant leaves"),
    })
}

fn routine(function: &Function, code: Code) -> Routine {
    let arguments = function
        .arguments
        .iter()
        .map(|argument| ArgumentShape { name: argument.name, len: argument.symbols.len() })
        .collect();
    let outputs = function
        .outputs
        .iter()
        .map(|output| OutputShape {
            name: output.name,
            shape: output.shape.clone(),
            doc: output.doc.clone(),
            details: output.details.clone(),
        })
        .collect();
    let (name, link, form) = (function.name, function.link.clone(), function.form);
    Routine { name, link, arguments, outputs, form, code }
}

fn argument_places(function: &Function) -> FxHashMap<ExprId, Leaf> {
    let mut places = FxHashMap::default();
    for (argument, row) in function.arguments.iter().enumerate() {
        for (entry, &symbol) in row.symbols.iter().enumerate() {
            places.insert(symbol, Leaf::Argument { argument, entry });
        }
    }
    places
}

fn check_constants(code: &Code) -> Option<()> {
    let finite = |leaf: &Leaf| !matches!(leaf, Leaf::Constant(value) if !value.is_finite());
    code.leaves.values().all(finite).then_some(())
}

/// What the prelude computes: the largest expressions of parameters, in the order of the graph.
fn hoisted(dag: &Dag, entries: &[ExprId]) -> Vec<ExprId> {
    let is_parameter = |expr: ExprId| !dag.is_run_time(expr) && !dag.classes(expr).is_empty();
    maximal(dag, entries, is_parameter)
}

/// The values of the largest expressions without symbols that are not plain numbers: pi, sqrt(2).
fn symbol_free(dag: &Dag, entries: &[ExprId]) -> FxHashMap<ExprId, f64> {
    let is_number = |expr: ExprId| dag.classes(expr).is_empty() && dag.as_constant(expr).is_none();
    let exprs = maximal(dag, entries, is_number);
    let values = constant_values(dag, &exprs);
    exprs.into_iter().zip(values).collect()
}

/// The expressions of a kind that an entry, or an expression of another kind, refers to, in the
/// order of the graph.
fn maximal(dag: &Dag, entries: &[ExprId], is_kind: impl Fn(ExprId) -> bool) -> Vec<ExprId> {
    let mut is_found = vec![false; dag.len()];
    let mut note = |expr: ExprId| is_found[expr.index()] |= is_kind(expr);
    entries.iter().for_each(|&entry| note(entry));
    for expr in dag.topological(entries) {
        if !is_kind(expr) {
            dag.node(expr).for_each_operand(&mut note);
        }
    }
    (0..dag.len()).map(ExprId::from_index).filter(|expr| is_found[expr.index()]).collect()
}

/// Lowers one set of expressions after the other; its tables are made once.
struct Builder<'a> {
    dag: &'a Dag,
    /// Values of symbol-free expressions that are computed here and now.
    constants: &'a FxHashMap<ExprId, f64>,
    /// The slot of each expression of the current code.
    slot_of: Vec<Option<Slot>>,
    /// All false between two codes.
    reached: Vec<bool>,
    /// The sine and cosine of each angle of the current code.
    sincos: FxHashMap<ExprId, [Slot; 2]>,
    /// The powers of each expression of the current code, the first one included.
    powers: FxHashMap<(ExprId, u32), Slot>,
    code: Code,
}

impl<'a> Builder<'a> {
    fn new(dag: &'a Dag, constants: &'a FxHashMap<ExprId, f64>) -> Self {
        Self {
            dag,
            constants,
            slot_of: vec![None; dag.len()],
            reached: vec![false; dag.len()],
            sincos: FxHashMap::default(),
            powers: FxHashMap::default(),
            code: Code::default(),
        }
    }

    /// The code of `outputs`. `leaf_of` names what the code does not compute itself.
    fn code(&mut self, outputs: &[ExprId], leaf_of: impl Fn(ExprId) -> Option<Leaf>) -> Code {
        let (leaves, interior) = self.reach(outputs, leaf_of);
        for (expr, leaf) in &leaves {
            self.slot_of[expr.index()] = Some(self.code.leaves.push(*leaf));
        }
        self.code.slots = leaves.len();
        for &expr in &interior {
            let slot = self.instruction(expr);
            self.slot_of[expr.index()] = Some(slot);
        }
        self.code.outputs = outputs.iter().map(|&output| self.slot(output)).collect();
        for expr in leaves.iter().map(|(expr, _)| expr).chain(&interior) {
            self.slot_of[expr.index()] = None;
        }
        self.sincos.clear();
        self.powers.clear();
        std::mem::take(&mut self.code)
    }

    /// The leaves and the expressions between leaves and outputs, each in the order of the graph.
    fn reach(
        &mut self,
        outputs: &[ExprId],
        leaf_of: impl Fn(ExprId) -> Option<Leaf>,
    ) -> (Vec<(ExprId, Leaf)>, Vec<ExprId>) {
        let (mut leaves, mut interior) = (Vec::new(), Vec::new());
        let mut pending = outputs.to_vec();
        while let Some(expr) = pending.pop() {
            if std::mem::replace(&mut self.reached[expr.index()], true) {
                continue;
            }
            match leaf_of(expr).or_else(|| self.constant_leaf(expr)) {
                Some(leaf) => leaves.push((expr, leaf)),
                None => {
                    interior.push(expr);
                    self.dag.node(expr).for_each_operand(|operand| pending.push(operand));
                }
            }
        }
        leaves.sort_unstable_by_key(|(expr, _)| *expr);
        interior.sort_unstable();
        let leaf_exprs = leaves.iter().map(|(expr, _)| expr);
        leaf_exprs.chain(&interior).for_each(|expr| self.reached[expr.index()] = false);
        (leaves, interior)
    }

    fn constant_leaf(&self, expr: ExprId) -> Option<Leaf> {
        let known = self.constants.get(&expr).copied();
        let value = known.or_else(|| match self.dag.node(expr) {
            Node::Constant(id) => Some(to_f64(self.dag.constant_value(id))),
            Node::Pi => Some(std::f64::consts::PI),
            _ => None,
        });
        value.map(Leaf::Constant)
    }

    fn slot(&self, expr: ExprId) -> Slot {
        self.slot_of[expr.index()].expect("operands are lowered before their users")
    }

    fn fresh(&mut self) -> Slot {
        self.code.slots += 1;
        Slot::from_index(self.code.slots - 1)
    }

    fn value(&mut self, operation: Operation) -> Slot {
        let result = self.fresh();
        self.code.instructions.push(Instruction::Value { result, operation });
        result
    }

    fn instruction(&mut self, expr: ExprId) -> Slot {
        use BinaryOperation::{Add, Div, Mul, Sub};
        let binary = |operation, a, b| Operation::Binary(operation, self.slot(a), self.slot(b));
        let operation = match self.dag.node(expr) {
            Node::Neg(a) => Operation::Unary(UnaryOperation::Neg, self.slot(a)),
            Node::Add(a, b) => binary(Add, a, b),
            Node::Sub(a, b) => binary(Sub, a, b),
            Node::Mul(a, b) => binary(Mul, a, b),
            Node::Div(a, b) => binary(Div, a, b),
            Node::Binary(function, a, b) => binary(binary_operation(function), a, b),
            Node::Pow(a, n) => return self.power(a, n),
            Node::Unary(function, a) => match unary_operation(function) {
                Some(operation) => Operation::Unary(operation, self.slot(a)),
                None => return self.sincos(a)[usize::from(function == UnaryFunction::Cos)],
            },
            Node::Select { relation, left, right, then, otherwise } => Operation::Select {
                relation,
                sides: [self.slot(left), self.slot(right)],
                then: self.slot(then),
                otherwise: self.slot(otherwise),
            },
            Node::Constant(_) | Node::Pi => unreachable!("numbers are leaves"),
            Node::Symbol(id) => {
                let name = &self.dag.symbols()[id].name;
                panic!("`{name}` is neither an argument of the function nor a parameter")
            }
        };
        self.value(operation)
    }

    /// The slots of sine and cosine: one operation for the two of them.
    fn sincos(&mut self, angle: ExprId) -> [Slot; 2] {
        if let Some(&pair) = self.sincos.get(&angle) {
            return pair;
        }
        let operand = self.slot(angle);
        let [sine, cosine] = [self.fresh(), self.fresh()];
        self.code.instructions.push(Instruction::SinCos { sine, cosine, angle: operand });
        self.sincos.insert(angle, [sine, cosine]);
        [sine, cosine]
    }

    /// a^n through squares that all powers of a share: a^5 = (a^2)^2 a.
    fn power(&mut self, a: ExprId, n: u32) -> Slot {
        let mut power = self.slot(a);
        let mut exponent = 1;
        for bit in (0..31 - n.leading_zeros()).rev() {
            exponent *= 2;
            power = self.shared_product(a, exponent, power, power);
            if n >> bit & 1 == 1 {
                exponent += 1;
                power = self.shared_product(a, exponent, power, self.slot(a));
            }
        }
        power
    }

    fn shared_product(&mut self, base: ExprId, exponent: u32, left: Slot, right: Slot) -> Slot {
        if let Some(&slot) = self.powers.get(&(base, exponent)) {
            return slot;
        }
        let slot = self.value(Operation::Binary(BinaryOperation::Mul, left, right));
        self.powers.insert((base, exponent), slot);
        slot
    }
}

/// The operation of a function; none for sine and cosine, which are computed together.
fn unary_operation(function: UnaryFunction) -> Option<UnaryOperation> {
    Some(match function {
        UnaryFunction::Sin | UnaryFunction::Cos => return None,
        UnaryFunction::Tan => UnaryOperation::Tan,
        UnaryFunction::Sqrt => UnaryOperation::Sqrt,
        UnaryFunction::Exp => UnaryOperation::Exp,
        UnaryFunction::Log => UnaryOperation::Log,
        UnaryFunction::Tanh => UnaryOperation::Tanh,
        UnaryFunction::Abs => UnaryOperation::Abs,
        UnaryFunction::Sign => UnaryOperation::Sign,
    })
}

fn binary_operation(function: BinaryFunction) -> BinaryOperation {
    match function {
        BinaryFunction::Atan2 => BinaryOperation::Atan2,
        BinaryFunction::Min => BinaryOperation::Min,
        BinaryFunction::Max => BinaryOperation::Max,
    }
}
