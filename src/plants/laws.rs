//! Laws of added effects in a simulation: their torques, and the rates of their states.

use super::PlantError;
use super::native::NativeRoutine;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::dynamics::implicit_effects;
use denavit_codegen::expr::{Dag, ExprId, SymbolClass, UnaryFunction, derivative, substitute};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::model::{JointLaw, JointVariables, LinkId, Robot, Terms};
use denavit_codegen::number::ratio;
use denavit_codegen::program::{Evaluate, lower};
use rustc_hash::FxHashMap;

/// Below this rate a jump of a law at rate 0 is a steep line, as that of Coulomb friction is:
/// 1/100 [rad/s, m/s].
const STICTION_RATE: (i64, i64) = (1, 100);

/// What laws depend on.
#[derive(Clone, Copy, Debug)]
pub struct LawMoment<'a> {
    /// Time \[s\].
    pub t_s: f64,
    /// Joint positions [rad, m].
    pub q: &'a [f64],
    /// Joint rates [rad/s, m/s].
    pub qd: &'a [f64],
    /// Joint accelerations [rad/s^2, m/s^2].
    pub qdd: &'a [f64],
    /// The laws' states.
    pub states: &'a [f64],
}

/// What laws answer.
#[derive(Clone, Debug, Default)]
pub struct LawResponse {
    /// What each joint needs besides [N m, N]; empty if there are no laws.
    pub torque: Vec<f64>,
    /// Rates of the states.
    pub rates: Vec<f64>,
    /// Derivatives of the torques by the accelerations, row by row; empty if there are none.
    pub slopes: Vec<f64>,
}

/// The laws of a robot, as programs.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    joints: usize,
    pub(super) states: usize,
    is_accelerated: bool,
    evaluator: NativeRoutine,
    initial: NativeRoutine,
    outputs: Vec<f64>,
}

impl Laws {
    /// Takes the laws out of a robot of numbers, but for those that are inertia: these stay part of
    /// D. None if nothing is left.
    pub(super) fn take(robot: &mut Robot) -> Result<Option<Self>, PlantError> {
        let implicit = implicit_effects(robot);
        let is_inertia = |law: &JointLaw| {
            let accelerated = robot.dag.classes(law.torque).contains(SymbolClass::Acceleration);
            accelerated && law.states.is_empty() && !implicit.contains(&law.effect)
        };
        let keep: Vec<bool> = robot.laws.iter().map(is_inertia).collect();
        let (kept, own): (Vec<_>, Vec<_>) =
            std::mem::take(&mut robot.laws).into_iter().zip(keep).partition(|(_, keep)| *keep);
        robot.laws = kept.into_iter().map(|(law, _)| law).collect();
        let own: Vec<JointLaw> = own.into_iter().map(|(law, _)| law).collect();
        if own.is_empty() {
            return Ok(None);
        }
        if let (Some(law), false) =
            (own.iter().find(|law| !law.loads.is_empty()), robot.contacts.is_empty())
        {
            let what = "the load, which forces at contact points share";
            return Err(PlantError::Effect(law.effect.clone(), what));
        }
        Self::of(robot, own).map(Some)
    }

    fn of(robot: &Robot, own: Vec<JointLaw>) -> Result<Self, PlantError> {
        let rows: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
        let row = |link: LinkId| {
            let row = rows.iter().position(|known| *known == link);
            row.expect("laws are of joints that move")
        };
        let mut dag = robot.dag.clone();
        let replaced = loads(robot, &own, &mut dag, &row)?;
        let steep = steep_signs(robot, &mut dag);
        let variables: Vec<JointVariables> = robot.joints().map(|(_, joint)| *joint).collect();
        let mut torques = vec![dag.zero(); rows.len()];
        let mut states = Vec::new();
        let (mut rates, mut initial) = (Vec::new(), Vec::new());
        let followed = |dag: &mut Dag, expr: ExprId| {
            let smooth = substitute(dag, &[expr], &steep);
            substitute(dag, &smooth, &replaced)[0]
        };
        for law in &own {
            let torque = followed(&mut dag, law.torque);
            torques[row(law.joint)] = dag.add(torques[row(law.joint)], torque);
            for state in &law.states {
                states.push(state.symbol);
                rates.push(followed(&mut dag, state.rate));
                initial.push(followed(&mut dag, state.initial));
            }
        }
        let accelerated = |expr: &ExprId| dag.classes(*expr).contains(SymbolClass::Acceleration);
        let is_accelerated = torques.iter().any(accelerated);
        let mut entries = torques.clone();
        entries.extend(&rates);
        if is_accelerated {
            entries.extend(slopes(&mut dag, &torques, &variables));
        }
        let time = dag.symbol("t", SymbolClass::Time);
        let list = |symbol: fn(&JointVariables) -> ExprId| variables.iter().map(symbol).collect();
        let arguments = vec![
            Argument { name: "q", symbols: list(|joint| joint.q) },
            Argument { name: "qd", symbols: list(|joint| joint.qd) },
            Argument { name: "qdd", symbols: list(|joint| joint.qdd) },
            Argument { name: "t", symbols: vec![time] },
            Argument { name: "states", symbols: states.clone() },
        ];
        let outputs = vec![0.0; entries.len()];
        Ok(Self {
            joints: rows.len(),
            states: states.len(),
            is_accelerated,
            evaluator: evaluator(&dag, &arguments, entries)?,
            initial: evaluator(&dag, &arguments, initial)?,
            outputs,
        })
    }

    /// The initial values of the states.
    pub(super) fn start(&mut self, moment: &LawMoment<'_>) -> Vec<f64> {
        let mut states = vec![0.0; self.states];
        let LawMoment { t_s, q, qd, qdd, .. } = *moment;
        let unknown = states.clone();
        let arguments: [&[f64]; 5] = [q, qd, qdd, &[t_s], &unknown];
        self.initial.evaluate(&arguments, &mut states).expect("the caller's slices fit");
        states
    }

    pub(super) fn respond(&mut self, moment: &LawMoment<'_>, response: &mut LawResponse) {
        let LawMoment { t_s, q, qd, qdd, states } = *moment;
        let arguments: [&[f64]; 5] = [q, qd, qdd, &[t_s], states];
        self.evaluator.evaluate(&arguments, &mut self.outputs).expect("the caller's slices fit");
        let (torque, rest) = self.outputs.split_at(self.joints);
        let (rates, slopes) = rest.split_at(self.states);
        for (list, found) in [
            (&mut response.torque, torque),
            (&mut response.rates, rates),
            (&mut response.slopes, slopes),
        ] {
            list.clear();
            list.extend_from_slice(found);
        }
    }

    /// Whether torques depend on accelerations.
    pub(super) fn is_accelerated(&self) -> bool {
        self.is_accelerated
    }
}

/// Rigid-body torques in place of the symbols of loads; `dag` grows by them.
fn loads(
    robot: &Robot,
    own: &[JointLaw],
    dag: &mut Dag,
    row: &dyn Fn(LinkId) -> usize,
) -> Result<FxHashMap<ExprId, ExprId>, PlantError> {
    let mut replaced = FxHashMap::default();
    if own.iter().all(|law| law.loads.is_empty()) {
        return Ok(replaced);
    }
    let mut rigid = robot.clone();
    rigid.laws.clear();
    rigid.terms = Terms { friction: false, rotor: false, spring: false, ..rigid.terms };
    rigid.links.values_mut().for_each(|link| link.drive = None);
    let derivation = derive(&rigid, Flavour::Tunable, &[FunctionName::InverseDynamics])
        .map_err(PlantError::Bake)?;
    let torques = derivation.functions[0].entries();
    *dag = derivation.dag;
    for (link, symbol) in own.iter().flat_map(|law| &law.loads) {
        replaced.insert(*symbol, torques[row(*link)]);
    }
    Ok(replaced)
}

/// Steep lines in place of the signs of rates.
fn steep_signs(robot: &Robot, dag: &mut Dag) -> FxHashMap<ExprId, ExprId> {
    let (numerator, denominator) = STICTION_RATE;
    let slope = dag.constant(ratio(denominator, numerator));
    let mut steep = FxHashMap::default();
    for (_, joint) in robot.joints() {
        let share = dag.mul(slope, joint.qd);
        let line = dag.unary(UnaryFunction::Tanh, share);
        steep.insert(dag.unary(UnaryFunction::Sign, joint.qd), line);
    }
    steep
}

/// Derivatives by the accelerations, row by row.
fn slopes(dag: &mut Dag, torques: &[ExprId], variables: &[JointVariables]) -> Vec<ExprId> {
    let n = torques.len();
    let mut slopes = vec![dag.zero(); n * n];
    for (column, joint) in variables.iter().enumerate() {
        let seeds: FxHashMap<ExprId, ExprId> = [(joint.qdd, dag.one())].into_iter().collect();
        for (row, slope) in derivative(dag, torques, &seeds).into_iter().enumerate() {
            slopes[row * n + column] = slope;
        }
    }
    slopes
}

fn evaluator(
    dag: &Dag,
    arguments: &[Argument],
    entries: Vec<ExprId>,
) -> Result<NativeRoutine, PlantError> {
    let output = Output {
        name: "tau",
        shape: vec![entries.len()],
        entries,
        doc: String::new(),
        details: Vec::new(),
    };
    let function = Function {
        name: FunctionName::InverseDynamics,
        link: None,
        arguments: arguments.to_vec(),
        outputs: vec![output],
        form: Form::Plain,
    };
    let program = lower(dag, &[function]).map_err(PlantError::Lower)?;
    Ok(NativeRoutine::new(&program.routines[0], &[]))
}
