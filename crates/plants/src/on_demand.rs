//! Functions of a plant that most of its users do not call: derived and compiled when they are
//! called first, so that the others pay nothing.

use super::native::NativeRoutine;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::Robot;
use denavit_codegen::program::{Evaluate, lower};
use std::collections::BTreeMap;

/// The functions of a robot by name, each made when it is called first.
#[derive(Clone, Debug)]
pub(crate) struct OnDemand {
    /// With numbers for all parameters, without Coulomb friction and the laws of added effects that
    /// the plant's bias leaves out.
    robot: Robot,
    /// None where the robot cannot have the function.
    made: BTreeMap<FunctionName, Option<NativeRoutine>>,
}

impl OnDemand {
    /// The functions of a robot whose parameters are numbers.
    pub(crate) fn new(robot: Robot) -> Self {
        Self { robot, made: BTreeMap::new() }
    }

    /// The outputs of a function, one array after the other. Answers whether the robot has it; if
    /// not, `outputs` are left as they are.
    pub(crate) fn call(
        &mut self,
        name: FunctionName,
        arguments: &[&[f64]],
        outputs: &mut [&mut [f64]],
    ) -> bool {
        let robot = &self.robot;
        let Some(routine) = self.made.entry(name).or_insert_with(|| make(robot, name)) else {
            return false;
        };
        let mut all = vec![0.0; routine.outputs()];
        routine.evaluate(arguments, &mut all).expect("the caller's slices have the robot's sizes");
        let mut rest = &all[..];
        for output in outputs {
            let (own, others) = rest.split_at(output.len());
            output.copy_from_slice(own);
            rest = others;
        }
        assert!(rest.is_empty(), "{name} has more entries than the caller takes");
        true
    }
}

fn make(robot: &Robot, name: FunctionName) -> Option<NativeRoutine> {
    // The plant itself has been made of the same numbers.
    let derivation = derive(robot, Flavour::Baked, &[name]).ok()?;
    let program = lower(&derivation.dag, &derivation.functions).ok()?;
    Some(NativeRoutine::new(program.find(name, None)?, &[]))
}
