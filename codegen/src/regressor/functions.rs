//! The regressor functions, derived like all others.
//!
//! `regressor` has the columns of [`Regressor`]; `base_regressor` those of them that base
//! parameters keep, so that its product with [`base_parameters`](super::base_parameters) is the
//! torque. Both have the joint parameters that the model has. Of the shortcuts those are taken that
//! pay. What a torque has besides unknowns is a second output.

use super::base::reduce;
use super::column::{Regressor, RegressorOptions, Unknowns};
use super::link_frames::Shortcuts;
use crate::dynamics::explicit;
use crate::dynamics::portfolio::{MAX_EXPLICIT_JOINTS, arguments};
use crate::expr::{Dag, ExprId, Operations};
use crate::function::{Form, Function, FunctionName, Output};
use crate::model::{Robot, TorqueSide};

/// The regressor functions of a robot: none if its torques are no polynomials in its unknowns.
pub fn derive(dag: &mut Dag, robot: &Robot, name: FunctionName) -> Vec<Function> {
    let mut with_graph = robot.clone();
    with_graph.dag = std::mem::take(dag);
    let (options, side) = (modelled(robot), TorqueSide::Joint);
    let made = Regressor::new(&with_graph, options, side).ok().and_then(|plain| match name {
        FunctionName::Regressor => Some(((0..plain.columns.len()).collect::<Vec<_>>(), plain)),
        _ => {
            let base = reduce(plain, &[]).ok()?;
            let kept = base.parameters.iter().map(|parameter| parameter.column);
            Some((kept.collect(), base.regressor))
        }
    });
    let made = made.filter(|(kept, _)| !kept.is_empty());
    let Some((kept, mut plain)) = made else {
        *dag = with_graph.dag;
        return Vec::new();
    };
    let (shortcuts, entries) = cheapest(&mut with_graph, &mut plain, (options, side), &kept);
    *dag = std::mem::take(&mut plain.dag);
    let n = plain.joints.len();
    let form = if shortcuts.grouped { Form::Grouped } else { Form::Plain };
    let (form, entries) = match closed_form(dag, &entries, n) {
        Some(closed) if price(dag, &closed) < price(dag, &entries) => (Form::Explicit, closed),
        _ => (form, entries),
    };
    let names: Vec<&str> = kept.iter().map(|&column| plain.columns[column].name.as_str()).collect();
    let doc = format!("Row: joint. Columns: {}.", names.join(", "));
    let mut outputs =
        vec![Output { name: name.as_str(), shape: vec![n, kept.len()], entries, doc }];
    if plain.known.iter().any(|&torque| torque != dag.zero()) {
        outputs.push(Output {
            name: "known",
            shape: vec![n],
            entries: plain.known,
            doc: "What each torque has besides [N m, N]: known matter, known joint parameters, \
                  springs."
                .to_owned(),
        });
    }
    let arguments = arguments(dag, robot, name);
    vec![Function { name, link: None, arguments, outputs, form }]
}

/// Of robots of few joints, the entries multiplied out.
fn closed_form(dag: &mut Dag, entries: &[ExprId], joints: usize) -> Option<Vec<ExprId>> {
    if joints <= MAX_EXPLICIT_JOINTS { explicit(dag, entries) } else { None }
}

fn price(dag: &Dag, entries: &[ExprId]) -> usize {
    Operations::count(dag, entries).price()
}

/// The shortcuts that pay, each tried after the ones before, and the entries with them.
fn cheapest(
    robot: &mut Robot,
    regressor: &mut Regressor,
    (options, side): (RegressorOptions, TorqueSide),
    kept: &[usize],
) -> (Shortcuts, Vec<ExprId>) {
    let mut best = (Shortcuts::default(), entries(regressor, kept));
    let mut lowest = price(&regressor.dag, &best.1);
    let choices: [fn(&mut Shortcuts); 4] = [
        |shortcuts| shortcuts.second = true,
        |shortcuts| shortcuts.first = true,
        |shortcuts| shortcuts.mass = true,
        |shortcuts| shortcuts.grouped = true,
    ];
    for choose in choices {
        let mut shortcuts = best.0;
        choose(&mut shortcuts);
        robot.dag = std::mem::take(&mut regressor.dag);
        let other = Regressor::with_shortcuts(robot, options, side, shortcuts)
            .expect("shortcuts decide nothing about unknowns");
        let candidate = entries(&other, kept);
        regressor.dag = other.dag;
        let cost = price(&regressor.dag, &candidate);
        if cost < lowest {
            (lowest, best) = (cost, (shortcuts, candidate));
        }
    }
    best
}

/// Row by row.
fn entries(regressor: &Regressor, kept: &[usize]) -> Vec<ExprId> {
    let columns = &regressor.columns;
    (0..regressor.joints.len())
        .flat_map(|row| kept.iter().map(move |&column| columns[column].entries[row]))
        .collect()
}

/// The joint parameters that the model has.
pub fn modelled(robot: &Robot) -> RegressorOptions {
    RegressorOptions {
        friction: robot.terms.friction,
        rotor: robot.terms.rotor,
        offset: true,
        only_modelled: true,
        unknowns: Unknowns::Parameters,
    }
}
