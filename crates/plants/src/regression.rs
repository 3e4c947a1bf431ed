//! Torques that are linear in what is unknown, as numbers: tau - known = Y phi.
//!
//! phi are the base parameters on the joint axes, whose columns are cheapest and best conditioned;
//! what is reported are those of kept columns, pi, with phi = T pi exactly
//! (docs/reference/base-parameters.md).
//! Rows are torques on the joint side along the joint axes, in the order of the joints; of a
//! floating base the generalized forces of its virtual joints come first.

use super::native::NativeBatch;
use super::regression_model::{described_joints, with_joint_parameters};
use super::regression_values::{not_negative_program, theta0_program, values_of};
use crate::error::{Cause, Error, ErrorKind};
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::emit::latex::{base_notation, base_sum};
use denavit_codegen::expr::{Dag, ExprId, substitute};
use denavit_codegen::function::{Form, Function, FunctionName, Output};
use denavit_codegen::model::{Robot, Role, TorqueSide, bake_geometry};
use denavit_codegen::program::{
    Program, constant_values, lower, parameter_defaults, prelude_values,
};
use denavit_codegen::regressor::functions::modelled;
use denavit_codegen::regressor::{
    BaseParameters, JointParameter, RegressorOptions, base_parameters, joint_basis,
};
use nalgebra::DMatrix;
use rustc_hash::FxHashMap;
use std::sync::OnceLock;

pub use super::regression_model::{RegressionJoint, SpringStiffness};
pub use super::regression_parameter::{ModelParameter, RegressionParameter, StandardParameter};
pub use super::regression_rows::{CoulombLaw, RegressionEvaluator, RegressionRows};

/// The base parameters of a robot with the programs that compute their columns.
#[derive(Clone, Debug)]
pub struct RegressionModel {
    /// The model's name.
    pub model: String,
    /// The joints, in the order of q and of the rows.
    pub joints: Vec<RegressionJoint>,
    /// The base parameters of kept columns, pi, as they are reported.
    pub listed: Vec<RegressionParameter>,
    /// The base parameters on the joint axes, phi, in which one computes.
    pub axes: Vec<RegressionParameter>,
    /// theta0, the columns before they are grouped.
    pub standard: Vec<StandardParameter>,
    /// The numbers of the model file that theta0 is made of.
    pub parameters: Vec<ModelParameter>,
    /// How Coulomb friction depends on the rate: its sign if nothing else is said.
    pub law: CoulombLaw,
    /// Joint and place in its pattern of each column of Coulomb friction.
    coulomb: Vec<(usize, usize)>,
    /// phi = T pi, row by row, square.
    to_axes: DMatrix<f64>,
    /// pi = T^-1 phi.
    to_listed: DMatrix<f64>,
    /// For each joint the places of phi that its row depends on, in order.
    pattern: Vec<Vec<usize>>,
    /// Rows of `known`: one for each joint that has something known.
    known: Vec<usize>,
    program: Program,
    prelude: Vec<f64>,
    /// The program, made ready when it is first asked for.
    native: OnceLock<NativeBatch>,
    theta0: Program,
    not_negative: Option<Program>,
}

impl RegressionModel {
    /// The regression model of `robot` with the joint parameters of `options`; columns of `keep`
    /// are kept before others in what is listed.
    ///
    /// Rank and formulas are exact for the constants as symbols. Where their values make more
    /// columns depend on others (a length that is 0, a centre of mass that is known to be on an
    /// axis), or the change of basis singular, those of the values are taken.
    pub fn new(robot: &Robot, options: RegressorOptions, keep: &[String]) -> Result<Self, Error> {
        let side = robot.torque_side;
        let robot = with_joint_parameters(robot, options);
        let base = reduced(&robot, keep)?;
        let special = || {
            let numeric = bake_geometry(&robot).ok()?;
            Some((reduced(&numeric, keep).ok()?, numeric))
        };
        let special = special();
        let is_less = special.as_ref().is_some_and(|(special, _)| special.rank() < base.rank());
        let general = match is_less {
            true => Err(Cause::Singular(robot.name.clone()).into()),
            false => Self::of(&robot, base, side),
        };
        // a symbol whose value is 0 may be what a column was kept for
        match (general, special) {
            (Err(error), Some((special, numeric))) if error.kind() == ErrorKind::Singular => {
                Self::of(&numeric, special, side)
            }
            (general, _) => general,
        }
    }

    fn of(robot: &Robot, mut base: BaseParameters, side: TorqueSide) -> Result<Self, Error> {
        let axes = joint_basis(&mut base, robot)?;
        let mut numbers = Numbers::new(&base.regressor.dag, robot);
        let derivation = derive(robot, Flavour::Tunable, &[FunctionName::BaseRegressor])?;
        let none = || Error::from(Cause::NothingUnknown(robot.name.clone()));
        let function = derivation.functions.first().ok_or_else(none)?;
        let (sparse, pattern, known) =
            without_zeros(&derivation.dag, function, axes.len(), robot.degrees_of_freedom());
        let program = lower(&derivation.dag, &[sparse])?;
        let given = parameter_defaults(&program, robot);
        let missing: Vec<String> = program
            .parameters
            .iter()
            .zip(&given)
            .filter(|(_, value)| value.is_none())
            .map(|(name, _)| name.clone())
            .collect();
        if !missing.is_empty() {
            let (model, parameters) = (robot.name.clone(), missing);
            return Err(Cause::NoValues { model, parameters }.into());
        }
        let given: Vec<f64> = given.into_iter().flatten().collect();
        let prelude = prelude_values(&program, &given).expect("one value for each parameter");
        let to_axes = change_of_basis(&mut numbers, &axes, base.rank());
        let to_listed = to_axes.clone().try_inverse().filter(|m| m.iter().all(|x| x.is_finite()));
        let to_listed = to_listed.ok_or_else(|| Cause::Singular(robot.name.clone()))?;
        let theta0 = theta0_program(&base, robot)?;
        let joints = described_joints(robot, side);
        let axes = on_axes(&mut numbers, robot, &base, &axes)?;
        let standard = standard(&mut numbers, robot, &base);
        Ok(Self {
            model: robot.name.clone(),
            listed: listed(&mut numbers, robot, &base)?,
            parameters: parameters(robot, &base, &theta0),
            law: CoulombLaw::Sign,
            coulomb: coulomb_columns(&joints, &pattern, &axes, &standard),
            joints,
            axes,
            standard,
            to_axes,
            to_listed,
            pattern,
            known,
            program,
            prelude,
            native: OnceLock::new(),
            not_negative: not_negative_program(&base, robot)?,
            theta0,
        })
    }

    /// Number of base parameters.
    pub fn rank(&self) -> usize {
        self.axes.len()
    }

    /// For each joint the places of phi that its row may depend on; the others are exactly 0.
    pub fn pattern(&self) -> &[Vec<usize>] {
        &self.pattern
    }

    /// The entries of phi that a joint's row depends on, in the order of its pattern.
    pub fn of_joint(&self, joint: usize, phi: &[f64]) -> Vec<f64> {
        self.pattern[joint].iter().map(|&place| phi[place]).collect()
    }

    /// Joint, and place in its pattern, of each column of Coulomb friction: a factor times
    /// [`RegressionModel::law`] of the joint's rate.
    pub fn coulomb(&self) -> &[(usize, usize)] {
        &self.coulomb
    }

    /// T of phi = T pi.
    pub fn to_axes(&self) -> &DMatrix<f64> {
        &self.to_axes
    }

    /// T^-1 of pi = T^-1 phi.
    pub fn to_listed(&self) -> &DMatrix<f64> {
        &self.to_listed
    }

    /// phi of the nominal parameters; none if the model lacks one.
    pub fn model_axes(&self) -> Option<Vec<f64>> {
        self.axes.iter().map(|parameter| parameter.value).collect()
    }

    /// What computes rows, ready to be called: one for each thread.
    pub fn evaluator(&self) -> RegressionEvaluator {
        let routine = &self.program.routines[0];
        let widths = self.pattern.iter().map(Vec::len).collect();
        let batch = self.native.get_or_init(|| NativeBatch::new(routine, &self.prelude));
        RegressionEvaluator::new(batch.clone(), widths, &self.known)
            .with_law(self.law, &self.coulomb)
    }

    /// The torque of every joint by phi and by what is known [N m, N], of motion in 3 n columns.
    ///
    /// # Panics
    /// If there are not three columns of one length for each joint.
    pub fn torques(&self, motion: &[Vec<f64>], phi: &[f64]) -> Vec<Vec<f64>> {
        let own: Vec<Vec<f64>> = (0..self.joints.len()).map(|at| self.of_joint(at, phi)).collect();
        let samples = motion.first().map_or(0, Vec::len);
        let mut torques = vec![Vec::with_capacity(samples); own.len()];
        let (mut evaluator, mut rows) = (self.evaluator(), RegressionRows::default());
        for first in (0..samples).step_by(BLOCK) {
            let range = first..(first + BLOCK).min(samples);
            let block: Vec<&[f64]> = motion.iter().map(|column| &column[range.clone()]).collect();
            evaluator.evaluate(&block, &mut rows).expect("three columns for each joint");
            let mut part = vec![0.0; range.len()];
            for (joint, own) in own.iter().enumerate() {
                rows.torque(joint, own, &mut part);
                torques[joint].extend_from_slice(&part);
            }
        }
        torques
    }

    /// theta0 of values of [`RegressionModel::parameters`].
    ///
    /// # Panics
    /// If there is not one value for each of them.
    pub fn standard_values(&self, parameters: &[f64]) -> Vec<f64> {
        assert_eq!(parameters.len(), self.parameters.len(), "one value for each parameter");
        let of_name: FxHashMap<&str, f64> = self
            .parameters
            .iter()
            .map(|p| p.name.as_str())
            .zip(parameters.iter().copied())
            .collect();
        let of_name = |name: &str| of_name.get(name).copied();
        values_of(&self.theta0, &of_name)
    }

    /// Masses and moments of inertia of bodies that are written as expressions, of values of
    /// [`RegressionModel::parameters`]: none of them may be negative.
    ///
    /// # Panics
    /// If there is not one value for each of them.
    pub fn masses_and_moments(&self, parameters: &[f64]) -> Vec<f64> {
        assert_eq!(parameters.len(), self.parameters.len(), "one value for each parameter");
        let of_name = |name: &str| {
            self.parameters.iter().position(|p| p.name == name).map(|at| parameters[at])
        };
        self.not_negative.as_ref().map_or_else(Vec::new, |program| values_of(program, &of_name))
    }

    /// M of phi = M theta0.
    pub fn of_standard(&self) -> DMatrix<f64> {
        let mut members = DMatrix::zeros(self.rank(), self.standard.len());
        for (row, parameter) in self.axes.iter().enumerate() {
            for &(column, factor) in &parameter.members {
                members[(row, column)] += factor;
            }
        }
        members
    }

    /// phi of theta0.
    pub fn axes_of_standard(&self, standard: &[f64]) -> Vec<f64> {
        let sum = |parameter: &RegressionParameter| {
            parameter.members.iter().map(|&(at, factor)| factor * standard[at]).sum()
        };
        self.axes.iter().map(sum).collect()
    }
}

/// Samples that are evaluated at once.
const BLOCK: usize = 512;

/// The base parameters with the joint parameters that the robot has.
fn reduced(robot: &Robot, keep: &[String]) -> Result<BaseParameters, Error> {
    Ok(base_parameters(robot, modelled(robot), keep)?)
}

/// Where the columns of Coulomb friction stand: each is a parameter of its joint alone.
fn coulomb_columns(
    joints: &[RegressionJoint],
    pattern: &[Vec<usize>],
    axes: &[RegressionParameter],
    standard: &[StandardParameter],
) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    for (joint, (described, places)) in joints.iter().zip(pattern).enumerate() {
        let is_coulomb = |phi: &usize| match &axes[*phi].members[..] {
            [(at, _)] => standard[*at]
                .owner
                .as_ref()
                .is_some_and(|(link, prefix)| *link == described.name && *prefix == "fc"),
            _ => false,
        };
        found.extend(places.iter().position(is_coulomb).map(|place| (joint, place)));
    }
    found
}

/// The base regressor without the entries that are exactly 0, what is known after them.
fn without_zeros(
    dag: &Dag,
    function: &Function,
    rank: usize,
    joints: usize,
) -> (Function, Vec<Vec<usize>>, Vec<usize>) {
    let zero = dag.zero();
    let entries = &function.outputs[0].entries;
    let mut pattern = Vec::new();
    let mut kept: Vec<ExprId> = Vec::new();
    for joint in 0..joints {
        let row = &entries[joint * rank..(joint + 1) * rank];
        let places: Vec<usize> = (0..rank).filter(|&place| row[place] != zero).collect();
        kept.extend(places.iter().map(|&place| row[place]));
        pattern.push(places);
    }
    let all_known = function.outputs.get(1).map_or(&[][..], |output| &output.entries);
    let known: Vec<usize> = (0..all_known.len()).filter(|&j| all_known[j] != zero).collect();
    kept.extend(known.iter().map(|&joint| all_known[joint]));
    let output = Output {
        name: FunctionName::BaseRegressor.as_str(),
        shape: vec![kept.len()],
        entries: kept,
        doc: String::new(),
        details: Vec::new(),
    };
    let sparse = Function {
        name: FunctionName::BaseRegressor,
        link: None,
        arguments: function.arguments.clone(),
        outputs: vec![output],
        form: Form::Plain,
    };
    (sparse, pattern, known)
}

/// Expressions as numbers, with the model's values for its parameters.
struct Numbers {
    dag: Dag,
    defaults: FxHashMap<ExprId, ExprId>,
}

impl Numbers {
    fn new(dag: &Dag, robot: &Robot) -> Self {
        let parameters = robot.parameters.values();
        let defaults = parameters.filter_map(|p| Some((p.symbol, p.default?))).collect();
        Self { dag: dag.clone(), defaults }
    }

    fn number(&mut self, expr: ExprId) -> Option<f64> {
        let known = substitute(&mut self.dag, &[expr], &self.defaults)[0];
        let is_number = self.dag.classes(known).is_empty();
        let value = is_number.then(|| constant_values(&self.dag, &[known])[0]);
        value.filter(|value| value.is_finite())
    }

    /// Factors of constants. Those have values, since the regressor was evaluated with them.
    fn factors(&mut self, members: &[(usize, ExprId)]) -> Vec<(usize, f64)> {
        members.iter().map(|&(at, factor)| (at, self.number(factor).unwrap_or(f64::NAN))).collect()
    }
}

fn change_of_basis(numbers: &mut Numbers, axes: &[JointParameter], rank: usize) -> DMatrix<f64> {
    let mut to_axes = DMatrix::zeros(axes.len(), rank);
    for (row, parameter) in axes.iter().enumerate() {
        for (column, factor) in numbers.factors(&parameter.of_kept) {
            to_axes[(row, column)] = factor;
        }
    }
    to_axes
}

/// Factors that must be numbers.
fn finite(robot: &Robot, members: Vec<(usize, f64)>) -> Result<Vec<(usize, f64)>, Error> {
    match members.iter().all(|(_, factor)| factor.is_finite()) {
        true => Ok(members),
        false => Err(Cause::Singular(robot.name.clone()).into()),
    }
}

fn listed(
    numbers: &mut Numbers,
    robot: &Robot,
    base: &BaseParameters,
) -> Result<Vec<RegressionParameter>, Error> {
    let notation = base_notation(robot, base);
    let one = |parameter: &denavit_codegen::regressor::BaseParameter| {
        let column = &base.regressor.columns[parameter.column];
        Ok(RegressionParameter {
            name: column.name.clone(),
            expression: base.sum_text(&parameter.parts),
            latex: base_sum(base, &parameter.parts, &notation),
            unit: column.unit.clone(),
            members: finite(robot, numbers.factors(&parameter.members))?,
            value: numbers.number(parameter.value),
            is_alone: parameter.is_alone(),
        })
    };
    base.parameters.iter().map(one).collect()
}

fn on_axes(
    numbers: &mut Numbers,
    robot: &Robot,
    base: &BaseParameters,
    axes: &[JointParameter],
) -> Result<Vec<RegressionParameter>, Error> {
    let notation = base_notation(robot, base);
    let one = |parameter: &JointParameter| {
        Ok(RegressionParameter {
            name: parameter.name.clone(),
            expression: base.sum_text(&parameter.parts),
            latex: base_sum(base, &parameter.parts, &notation),
            unit: parameter.unit.clone(),
            members: finite(robot, numbers.factors(&parameter.members))?,
            value: numbers.number(parameter.value),
            is_alone: parameter.members.len() == 1,
        })
    };
    axes.iter().map(one).collect()
}

fn standard(numbers: &mut Numbers, robot: &Robot, base: &BaseParameters) -> Vec<StandardParameter> {
    let columns = base.regressor.columns.iter();
    let one = |column: &denavit_codegen::regressor::Column| StandardParameter {
        name: column.name.clone(),
        unit: column.unit.clone(),
        value: numbers.number(column.value),
        owner: column.owner.map(|(link, prefix)| (robot.links[link].name.clone(), prefix)),
    };
    columns.map(one).collect()
}

/// The numbers that theta0 depends on, in the order of the model.
fn parameters(robot: &Robot, base: &BaseParameters, theta0: &Program) -> Vec<ModelParameter> {
    let mut numbers = Numbers::new(&base.regressor.dag, robot);
    let mut found = Vec::new();
    for (_, parameter) in robot.parameters.iter() {
        if !theta0.parameters.contains(&parameter.name) {
            continue;
        }
        let link = match parameter.role {
            Role::Body(link, _) | Role::Joint(link, _) => Some(robot.links[link].name.clone()),
            Role::Constant | Role::Unknown | Role::Effect(_) => None,
        };
        found.push(ModelParameter {
            name: parameter.name.clone(),
            role: Some(parameter.role),
            link,
            value: parameter.default.and_then(|value| numbers.number(value)).unwrap_or(0.0),
            std: parameter.std.and_then(|std| numbers.number(std)),
            is_positive: is_positive(robot, parameter.symbol),
        });
    }
    for name in &theta0.parameters {
        if found.iter().all(|known| known.name != *name) {
            let links = robot.joints().map(|(link, _)| robot.links[link].name.as_str());
            let link =
                links.filter(|link| name.ends_with(&format!("_{link}"))).max_by_key(|l| l.len());
            let link = link.map(str::to_owned);
            found.push(ModelParameter {
                name: name.clone(),
                role: None,
                link,
                value: 0.0,
                std: None,
                is_positive: !name.starts_with("off_"),
            });
        }
    }
    found
}

/// Whether a symbol is a mass, a moment of inertia, friction or the inertia of a rotor.
fn is_positive(robot: &Robot, symbol: ExprId) -> bool {
    robot.links.values().any(|link| {
        let of_body =
            link.body.iter().any(|body| body.mass == symbol || body.inertia[..3].contains(&symbol));
        let drive = link.drive.unwrap_or_default();
        let of_joint = [drive.viscous, drive.coulomb, drive.rotor_inertia, link.joint.damping];
        of_body || of_joint.contains(&Some(symbol))
    })
}
