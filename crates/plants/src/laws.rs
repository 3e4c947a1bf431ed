//! Laws of added effects in a simulation: their torques, and the rates of their states.

use super::native::NativeRoutine;
use crate::error::{Cause, Error};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::dynamics::implicit_effects;
use denavit_codegen::expr::{
    Dag, ExprId, SymbolClass, UnaryFunction, derivative, free_symbols, substitute,
};
use denavit_codegen::function::{Argument, Form, Function, FunctionName, Output};
use denavit_codegen::model::{
    JointLaw, JointVariables, LinkId, Robot, SpringLaw, SpringSide, Terms,
};
use denavit_codegen::program::{Evaluate, lower};
use rustc_hash::FxHashMap;

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
    /// What drives before series springs do: with these they are not what their joints do.
    pub drives: DriveMoment<'a>,
    /// The laws' states.
    pub states: &'a [f64],
    /// Below this rate a jump of a law at rate 0 is a steep line, as that of Coulomb friction is
    /// [rad/s, m/s].
    pub stiction_rate: f64,
}

/// What the drives before series springs do, on the side of their joints: one entry for each joint
/// that has such a spring ([`sprung_joints`](super::PlantModel::sprung_joints)).
#[derive(Clone, Copy, Debug, Default)]
pub struct DriveMoment<'a> {
    /// Rates [rad/s, m/s].
    pub qd: &'a [f64],
    /// Accelerations [rad/s^2, m/s^2].
    pub qdd: &'a [f64],
    /// How far they are ahead of their joints [rad, m].
    pub deflection: &'a [f64],
}

/// What laws answer.
#[derive(Clone, Debug, Default)]
pub struct LawResponse {
    /// What the link of each joint needs besides, and its drive if no series spring is between them
    /// [N m, N]; empty if there are no laws.
    pub torque: Vec<f64>,
    /// What the drive before each series spring needs besides, on the side of the joint [N m, N].
    pub drive: Vec<f64>,
    /// What is passed on from each of these drives to its link beside the spring [N m, N].
    pub passed: Vec<f64>,
    /// Rates of the states.
    pub rates: Vec<f64>,
    /// Derivatives of `torque` and `drive` by the accelerations of the joints and of the drives
    /// before springs, row by row; empty if there are none. What is passed on has none.
    pub slopes: Vec<f64>,
}

/// The laws of a robot, as programs.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    joints: usize,
    /// Joints with series springs.
    sprung: usize,
    pub(super) states: usize,
    is_accelerated: bool,
    evaluator: NativeRoutine,
    initial: NativeRoutine,
    outputs: Vec<f64>,
}

impl Laws {
    /// Takes the laws out of a robot of numbers, but for those that are inertia: these stay part of
    /// D, unless they are that of a drive before a spring. None if nothing is left.
    pub(super) fn take(robot: &mut Robot) -> Result<Option<Self>, Error> {
        let implicit = implicit_effects(robot);
        let is_inertia = |law: &JointLaw| {
            let accelerated = robot.dag.classes(law.torque).contains(SymbolClass::Acceleration);
            accelerated && law.states.is_empty() && !implicit.contains(&law.effect)
        };
        let before = |law: &JointLaw| is_of_drives(robot, law);
        let keep: Vec<bool> =
            robot.laws.iter().map(|law| is_inertia(law) && !before(law)).collect();
        let touches = !robot.contacts.is_empty();
        let heavy = robot.laws.iter().find(|law| is_inertia(law) && before(law));
        if let (Some(law), true) = (heavy, touches) {
            // Where drives count as stiff, it is a part of D that contacts have to know.
            let what = "the acceleration of a motor before a spring";
            return Err(Cause::NotFollowed(law.effect.clone(), what).into());
        }
        let (kept, own): (Vec<_>, Vec<_>) =
            std::mem::take(&mut robot.laws).into_iter().zip(keep).partition(|(_, keep)| *keep);
        robot.laws = kept.into_iter().map(|(law, _)| law).collect();
        let own: Vec<JointLaw> = own.into_iter().map(|(law, _)| law).collect();
        let springs = std::mem::take(&mut robot.spring_laws);
        if own.is_empty() && springs.is_empty() {
            return Ok(None);
        }
        if let (Some(law), true) = (own.iter().find(|law| !law.loads.is_empty()), touches) {
            let what = "the load, which forces at contact points share";
            return Err(Cause::NotFollowed(law.effect.clone(), what).into());
        }
        Self::of(robot, &own, &springs).map(Some)
    }

    fn of(robot: &Robot, own: &[JointLaw], springs: &[SpringLaw]) -> Result<Self, Error> {
        let rows: Vec<LinkId> = robot.joints().map(|(link, _)| link).collect();
        let row = |link: LinkId| {
            let row = rows.iter().position(|known| *known == link);
            row.expect("laws are of joints that move")
        };
        let mut dag = robot.dag.clone();
        let loads = loads(robot, own, &mut dag, &row)?;
        // No file can name this symbol: it is no identifier.
        let slope = dag.symbol("slope of signs", SymbolClass::Time);
        let steep = steep_signs(robot, springs, slope, &mut dag);
        let drives = Drives::new(robot, &mut dag);
        let variables: Vec<JointVariables> = robot.joints().map(|(_, joint)| *joint).collect();
        let mut parts = Parts::new(&mut dag, rows.len(), drives.links.len());
        for law in own {
            let mut followed = |dag: &mut Dag, expr: ExprId| {
                let mut found = substitute(dag, &[expr], &steep);
                if law.side == SpringSide::Motor {
                    // before loads, which are of the joints
                    found = substitute(dag, &found, &drives.replaced);
                }
                substitute(dag, &found, &loads)[0]
            };
            let torque = followed(&mut dag, law.torque);
            let at = drives.links.iter().position(|link| *link == law.joint);
            let at = at.filter(|_| law.side == SpringSide::Motor);
            let sum = at.map_or(row(law.joint), |spring| rows.len() + spring);
            parts.torques[sum] = dag.add(parts.torques[sum], torque);
            parts.add_states(&mut dag, law, &mut followed);
        }
        for SpringLaw { law, deflection, rate } in springs {
            let spring = drives.links.iter().position(|link| *link == law.joint);
            let spring = spring.expect("a law of a spring is at a joint that has one");
            let ahead = dag.sub(drives.rates[spring], variables[row(law.joint)].qd);
            let motion: FxHashMap<ExprId, ExprId> =
                [(*deflection, drives.deflections[spring]), (*rate, ahead)].into_iter().collect();
            let mut followed = |dag: &mut Dag, expr: ExprId| {
                let found = substitute(dag, &[expr], &steep);
                substitute(dag, &found, &motion)[0]
            };
            let passed = followed(&mut dag, law.torque);
            parts.passed[spring] = dag.add(parts.passed[spring], passed);
            parts.add_states(&mut dag, law, &mut followed);
        }
        Self::compiled(dag, &variables, drives, slope, parts)
    }

    fn compiled(
        mut dag: Dag,
        variables: &[JointVariables],
        drives: Drives,
        slope: ExprId,
        parts: Parts,
    ) -> Result<Self, Error> {
        let Parts { torques, passed, states, rates, initial } = parts;
        let accelerated = |expr: &ExprId| dag.classes(*expr).contains(SymbolClass::Acceleration);
        let is_accelerated = torques.iter().any(accelerated);
        let mut entries = torques.clone();
        entries.extend(&passed);
        entries.extend(&rates);
        if is_accelerated {
            let by = variables.iter().map(|joint| joint.qdd).chain(drives.accelerations.clone());
            entries.extend(slopes(&mut dag, &torques, by.collect()));
        }
        let time = dag.symbol("t", SymbolClass::Time);
        let list = |symbol: fn(&JointVariables) -> ExprId| variables.iter().map(symbol).collect();
        let sprung = drives.links.len();
        let arguments = vec![
            Argument { name: "q", symbols: list(|joint| joint.q) },
            Argument { name: "qd", symbols: list(|joint| joint.qd) },
            Argument { name: "qdd", symbols: list(|joint| joint.qdd) },
            Argument { name: "drive_qd", symbols: drives.rates },
            Argument { name: "drive_qdd", symbols: drives.accelerations },
            Argument { name: "deflection", symbols: drives.deflections },
            // one argument: compiled functions have few
            Argument { name: "t_and_slope", symbols: vec![time, slope] },
            Argument { name: "states", symbols: states.clone() },
        ];
        let outputs = vec![0.0; entries.len()];
        Ok(Self {
            joints: variables.len(),
            sprung,
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
        let unknown = states.clone();
        let moment = LawMoment { states: &unknown, ..*moment };
        let time = time_and_slope(&moment);
        let arguments = arguments(&moment, &time);
        self.initial.evaluate(&arguments, &mut states).expect("the caller's slices fit");
        states
    }

    pub(super) fn respond(&mut self, moment: &LawMoment<'_>, response: &mut LawResponse) {
        let time = time_and_slope(moment);
        let arguments = arguments(moment, &time);
        self.evaluator.evaluate(&arguments, &mut self.outputs).expect("the caller's slices fit");
        let (torque, rest) = self.outputs.split_at(self.joints);
        let (drive, rest) = rest.split_at(self.sprung);
        let (passed, rest) = rest.split_at(self.sprung);
        let (rates, slopes) = rest.split_at(self.states);
        for (list, found) in [
            (&mut response.torque, torque),
            (&mut response.drive, drive),
            (&mut response.passed, passed),
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

fn time_and_slope(moment: &LawMoment<'_>) -> [f64; 2] {
    [moment.t_s, moment.stiction_rate.recip()]
}

/// What the programs are evaluated on.
fn arguments<'a>(moment: &LawMoment<'a>, time: &'a [f64]) -> [&'a [f64]; 8] {
    let LawMoment { q, qd, qdd, drives, states, .. } = *moment;
    [q, qd, qdd, drives.qd, drives.qdd, drives.deflection, time, states]
}

/// Whether a law moves with drives before springs, its own or that of the other joint of a pair.
fn is_of_drives(robot: &Robot, law: &JointLaw) -> bool {
    if law.side == SpringSide::Link {
        return false;
    }
    let used = free_symbols(&robot.dag, &[law.torque]);
    sprung(robot).any(|(link, joint)| {
        let symbols = [joint.qd, joint.qdd].map(|symbol| free_symbols(&robot.dag, &[symbol]));
        link == law.joint || symbols.iter().flatten().any(|symbol| used.contains(symbol))
    })
}

/// The joints with series springs.
fn sprung(robot: &Robot) -> impl Iterator<Item = (LinkId, &JointVariables)> {
    let has_spring =
        |link: LinkId| robot.links[link].drive.is_some_and(|drive| drive.series_elastic.is_some());
    robot.joints().filter(move |(link, _)| has_spring(*link))
}

/// The symbols of the drives before series springs, joint by joint.
struct Drives {
    links: Vec<LinkId>,
    rates: Vec<ExprId>,
    accelerations: Vec<ExprId>,
    deflections: Vec<ExprId>,
    /// They in place of those of their joints.
    replaced: FxHashMap<ExprId, ExprId>,
}

impl Drives {
    fn new(robot: &Robot, dag: &mut Dag) -> Self {
        let [rates, accelerations, deflections] = [const { Vec::new() }; 3];
        let (links, replaced) = (Vec::new(), FxHashMap::default());
        let mut found = Self { links, rates, accelerations, deflections, replaced };
        for (link, joint) in sprung(robot) {
            let name = &robot.links[link].name;
            // No file can name these symbols: they are no identifiers.
            let mut symbol = |of: &str, class| dag.symbol(&format!("{of} of drive {name}"), class);
            let rate = symbol("rate", SymbolClass::Rate);
            let acceleration = symbol("acceleration", SymbolClass::Acceleration);
            found.links.push(link);
            found.rates.push(rate);
            found.accelerations.push(acceleration);
            found.deflections.push(symbol("deflection", SymbolClass::Configuration));
            found.replaced.extend([(joint.qd, rate), (joint.qdd, acceleration)]);
        }
        found
    }
}

/// What the programs say.
struct Parts {
    /// Of the joints, then of the drives before springs.
    torques: Vec<ExprId>,
    passed: Vec<ExprId>,
    states: Vec<ExprId>,
    rates: Vec<ExprId>,
    initial: Vec<ExprId>,
}

impl Parts {
    fn new(dag: &mut Dag, joints: usize, sprung: usize) -> Self {
        let zero = dag.zero();
        let [states, rates, initial] = [const { Vec::new() }; 3];
        let (torques, passed) = (vec![zero; joints + sprung], vec![zero; sprung]);
        Self { torques, passed, states, rates, initial }
    }

    fn add_states(
        &mut self,
        dag: &mut Dag,
        law: &JointLaw,
        followed: &mut dyn FnMut(&mut Dag, ExprId) -> ExprId,
    ) {
        for state in &law.states {
            self.states.push(state.symbol);
            self.rates.push(followed(dag, state.rate));
            self.initial.push(followed(dag, state.initial));
        }
    }
}

/// Rigid-body torques in place of the symbols of loads; `dag` grows by them.
fn loads(
    robot: &Robot,
    own: &[JointLaw],
    dag: &mut Dag,
    row: &dyn Fn(LinkId) -> usize,
) -> Result<FxHashMap<ExprId, ExprId>, Error> {
    let mut replaced = FxHashMap::default();
    if own.iter().all(|law| law.loads.is_empty()) {
        return Ok(replaced);
    }
    let mut rigid = robot.clone();
    rigid.laws.clear();
    rigid.terms = Terms { friction: false, rotor: false, spring: false, ..rigid.terms };
    rigid.links.values_mut().for_each(|link| link.drive = None);
    let derivation = derive(&rigid, Flavour::Tunable, &[FunctionName::InverseDynamics])?;
    let torques = derivation.functions[0].entries();
    *dag = derivation.dag;
    for (link, symbol) in own.iter().flat_map(|law| &law.loads) {
        replaced.insert(*symbol, torques[row(*link)]);
    }
    Ok(replaced)
}

/// Lines of a slope in place of the signs of rates.
fn steep_signs(
    robot: &Robot,
    springs: &[SpringLaw],
    slope: ExprId,
    dag: &mut Dag,
) -> FxHashMap<ExprId, ExprId> {
    let mut steep = FxHashMap::default();
    let rates = robot.joints().map(|(_, joint)| joint.qd);
    for rate in rates.chain(springs.iter().map(|own| own.rate)) {
        let share = dag.mul(slope, rate);
        let line = dag.unary(UnaryFunction::Tanh, share);
        steep.insert(dag.unary(UnaryFunction::Sign, rate), line);
    }
    steep
}

/// Derivatives by the accelerations, row by row.
fn slopes(dag: &mut Dag, torques: &[ExprId], by: Vec<ExprId>) -> Vec<ExprId> {
    let n = torques.len();
    let mut slopes = vec![dag.zero(); n * n];
    for (column, acceleration) in by.into_iter().enumerate() {
        let seeds: FxHashMap<ExprId, ExprId> = [(acceleration, dag.one())].into_iter().collect();
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
) -> Result<NativeRoutine, Error> {
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
    let program = lower(dag, &[function])?;
    Ok(NativeRoutine::new(&program.routines[0], &[]))
}
