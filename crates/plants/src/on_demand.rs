//! Functions of a plant that most of its users do not call: derived and compiled when they are
//! called first, so that the others pay nothing.

use super::native::NativeRoutine;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{Evaluate, lower};
use std::collections::BTreeMap;

/// A function, and the row of its link where there is one for each.
type Key = (FunctionName, Option<usize>);

/// The functions of a robot by name, each made when it is called first.
#[derive(Clone, Debug)]
pub(crate) struct OnDemand {
    /// With numbers for all parameters, without Coulomb friction and the laws of added effects that
    /// the plant's bias leaves out.
    robot: Robot,
    /// None where the robot cannot have the function.
    made: BTreeMap<Key, Option<NativeRoutine>>,
    /// The outputs of the last call, one array after the other.
    entries: Vec<f64>,
}

impl OnDemand {
    /// The functions of a robot whose parameters are numbers.
    pub(crate) fn new(robot: Robot) -> Self {
        Self { robot, made: BTreeMap::new(), entries: Vec::new() }
    }

    /// The outputs of a function, of a link where there is one for each. Answers whether the robot
    /// has it; if not, `outputs` are left as they are.
    pub(crate) fn call(
        &mut self,
        name: FunctionName,
        link: Option<usize>,
        arguments: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> bool {
        let (robot, key) = (&self.robot, (name, link));
        let Some(routine) = self.made.entry(key).or_insert_with(|| make(robot, key)) else {
            return false;
        };
        self.entries.resize(routine.outputs(), 0.0);
        routine
            .evaluate(arguments, &mut self.entries)
            .expect("the caller's slices have the robot's sizes");
        let mut rest = &self.entries[..];
        for output in outputs {
            let (own, others) = rest.split_at(output.len());
            output.copy_from_slice(own);
            rest = others;
        }
        assert!(rest.is_empty(), "{name} has more entries than the caller takes");
        true
    }
}

fn make(robot: &Robot, (name, link): Key) -> Option<NativeRoutine> {
    let link = link.and_then(|row| robot.links.values().nth(row));
    let link = link.map(|link| link.name.as_str());
    // The plant itself has been made of the same numbers.
    let derivation = derive(robot, Flavour::Baked, &[name]).ok()?;
    let program = lower(&derivation.dag, &derivation.functions).ok()?;
    Some(NativeRoutine::new(program.find(name, link)?, &[]))
}
