//! The regressor functions, derived like all others.
//!
//! Both run in frames on the joint axes. `regressor` has the columns of [`Regressor`]. The columns
//! of `base_regressor` are those of the regrouped bodies: the entries of each body's
//! pseudo-inertia that its carrier does not feel as well, which takes the fewest operations.

use super::column::{Column, Feature, JointFunction, Regressor, RegressorOptions, Unknowns};
use super::matter::{entries, shares};
use super::turning::{is_alone, like_rotor, turnings};
use crate::dynamics::motion::{self, motion};
use crate::dynamics::portfolio::arguments;
use crate::expr::{Dag, ExprId};
use crate::function::{Form, Function, FunctionName, Output};
use crate::kinematics::{Frames, Mechanism};
use crate::model::{Robot, TorqueSide};
use crate::regroup::regroup;

/// One column of the base regressor with its parameter.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RegroupedColumn {
    /// `m`, `s1`.., `K11`.. of the regrouped body, with its link's name; or a joint's parameter.
    pub name: String,
    /// The parameter in the symbols of the model.
    pub value: ExprId,
    /// The torque of each joint per unit of it.
    pub entries: Vec<ExprId>,
}

const ENTRY_NAMES: [&str; 10] = ["m", "s1", "s2", "s3", "K11", "K22", "K33", "K12", "K13", "K23"];

/// The regressor functions of a robot: none if its torques are no polynomials in its unknowns.
pub fn derive(dag: &mut Dag, robot: &Robot, name: FunctionName) -> Vec<Function> {
    let columns = match name {
        FunctionName::Regressor => regressor_columns(dag, robot),
        _ => regrouped_columns(dag, robot),
    };
    let Some(columns) = columns.filter(|columns| !columns.is_empty()) else { return Vec::new() };
    let n = robot.degrees_of_freedom();
    let entries =
        (0..n).flat_map(|row| columns.iter().map(move |column| column.entries[row])).collect();
    let doc = match name {
        FunctionName::Regressor => {
            "Row: joint; columns: ten parameters a link about the origin of its frame, or the \
             products of the model's unknowns; then those of joints."
        }
        _ => {
            "Row: joint; columns: body by body, the entries m, s, K of the regrouped \
             pseudo-inertia in the frame on its joint axis, as far as its carrier does not feel \
             them too; then those of joints."
        }
    };
    let output =
        Output { name: name.as_str(), shape: vec![n, columns.len()], entries, doc: doc.to_owned() };
    let arguments = arguments(dag, robot, name);
    vec![Function { name, link: None, arguments, outputs: vec![output], form: Form::Plain }]
}

/// The joint parameters that the model has.
fn modelled(robot: &Robot) -> RegressorOptions {
    RegressorOptions {
        friction: robot.terms.friction,
        rotor: robot.terms.rotor,
        offset: true,
        only_modelled: true,
        unknowns: Unknowns::Parameters,
    }
}

fn regressor_columns(dag: &mut Dag, robot: &Robot) -> Option<Vec<RegroupedColumn>> {
    let mut with_graph = robot.clone();
    with_graph.dag = std::mem::take(dag);
    let regressor = Regressor::new(&with_graph, modelled(robot), TorqueSide::Joint);
    *dag = with_graph.dag;
    let regressor = regressor.ok()?;
    *dag = regressor.dag;
    let column =
        |Column { name, value, entries, .. }: Column| RegroupedColumn { name, value, entries };
    Some(regressor.columns.into_iter().map(column).collect())
}

/// The columns of the regrouped bodies, then those of the joints; columns that are 0 left out.
/// None if the torques are no polynomials in the unknowns.
pub fn regrouped_columns(dag: &mut Dag, robot: &Robot) -> Option<Vec<RegroupedColumn>> {
    let (mut mechanism, joints) = joint_columns(dag, robot)?;
    let turnings = turnings(dag, &mechanism);
    let mut of_joints = Vec::new();
    for (column, joint, function, factor) in joints {
        let moving = &mechanism.bodies[joint];
        let rotor = function == JointFunction::Acceleration && moving.is_revolute;
        if rotor && is_alone(dag, &mechanism, &turnings, joint) {
            let inertia = dag.mul(factor, column.value);
            let matter = like_rotor(dag, inertia);
            let total = mechanism.bodies[joint].inertia.add(dag, &matter);
            mechanism.bodies[joint].inertia = total;
        } else {
            of_joints.push(column);
        }
    }
    let regrouped = regroup(dag, &mechanism);
    let frames = Frames::plain(dag, &regrouped);
    let terms = motion::Terms {
        rates: robot.terms.coriolis,
        accelerations: robot.terms.inertia,
        gravity: robot.terms.gravity,
    };
    let motion = motion(dag, &frames, terms, None);
    let shares = shares(dag, &frames, &motion);
    let zero = dag.zero();
    let n = frames.len();
    let links: Vec<String> =
        robot.joints().map(|(link, _)| robot.links[link].name.clone()).collect();
    let mut columns = Vec::new();
    for (body, frame) in frames.frames.iter().enumerate() {
        for (entry, value) in entries(&frame.inertia).into_iter().enumerate() {
            let mut rows = vec![zero; n];
            for share in &shares[body] {
                rows[share.joint] = share.torques[entry];
            }
            if value == zero || rows.iter().all(|&row| row == zero) {
                continue;
            }
            // A body that turns about one axis alone feels the sum of K11 and K22.
            let same =
                columns.iter_mut().find(|column: &&mut RegroupedColumn| column.entries == rows);
            if let Some(column) = same {
                column.value = dag.add(column.value, value);
                continue;
            }
            let name = format!("{}_{}", ENTRY_NAMES[entry], links[body]);
            columns.push(RegroupedColumn { name, value, entries: rows });
        }
    }
    columns.extend(of_joints);
    Some(columns)
}

type JointColumn = (RegroupedColumn, usize, JointFunction, ExprId);

/// The mechanism, and the columns of joint parameters with what they are.
fn joint_columns(dag: &mut Dag, robot: &Robot) -> Option<(Mechanism, Vec<JointColumn>)> {
    let mut with_graph = robot.clone();
    with_graph.dag = std::mem::take(dag);
    let regressor = Regressor::new(&with_graph, modelled(robot), TorqueSide::Joint);
    *dag = with_graph.dag;
    let regressor = regressor.ok()?;
    *dag = regressor.dag;
    let columns = regressor.columns.into_iter().filter_map(|column| {
        let Column { name, value, entries, definition, .. } = column;
        match definition[..] {
            [(Feature::Joint { joint, function }, factor)] => {
                Some((RegroupedColumn { name, value, entries }, joint, function, factor))
            }
            _ => None,
        }
    });
    Some((regressor.mechanism, columns.collect()))
}
