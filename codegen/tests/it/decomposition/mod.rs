//! R0 = f^T B on robots: sizes against an independent count, values at random points.

mod given;
mod ranks;
mod robot;
mod sizes;
mod structure;

use super::robots::load;
use denavit_codegen::expr::{Dag, ExprId};
use denavit_codegen::fundamental::{
    Basis, DEFAULT_MEMORY_BYTES, Decomposition, Expansion, FourierError, Matrix, decompose,
};
use denavit_codegen::kinematics::{Frames, Mechanism, parallel_groups};
use denavit_codegen::model::Robot;
use denavit_codegen::regressor::{
    MatterRegressor, MotionTerms, TorsoMotion, fixed_base_regressor, torso_regressor,
};

/// Every term.
pub(crate) const FULL: MotionTerms =
    MotionTerms { rates: true, accelerations: true, gravity: true };
/// D qdd + G.
pub(crate) const WITHOUT_CORIOLIS: MotionTerms = MotionTerms { rates: false, ..FULL };

/// The regressor of a robot in the pseudo-inertias of its bodies.
pub(crate) struct Case {
    pub(crate) robot: Robot,
    pub(crate) dag: Dag,
    pub(crate) rows: Vec<Vec<ExprId>>,
    pub(crate) chains: Vec<Vec<ExprId>>,
}

impl Case {
    pub(crate) fn new(name: &str, terms: MotionTerms) -> Self {
        Self::build(name, |dag, frames| fixed_base_regressor(dag, frames, terms))
    }

    /// On the torso, body 5 of the virtual chain.
    pub(crate) fn torso(name: &str, terms: MotionTerms) -> Self {
        Self::build(name, |dag, frames| {
            torso_regressor(dag, frames, 5, TorsoMotion::Spatial, terms)
        })
    }

    fn build(name: &str, regressor: impl Fn(&mut Dag, &Frames) -> MatterRegressor) -> Self {
        let robot = load(name);
        let mut dag = robot.dag.clone();
        let mechanism = Mechanism::new(&mut dag, &robot);
        let frames = Frames::plain(&mut dag, &mechanism);
        let regressor = regressor(&mut dag, &frames);
        let rows = regressor.rows.iter().map(|row| row.concat()).collect();
        let chain = |group: Vec<usize>| {
            group.into_iter().map(|i| mechanism.bodies[i].variables.q).collect()
        };
        let chains = parallel_groups(&mechanism).into_iter().map(chain).collect();
        Self { robot, dag, rows, chains }
    }

    pub(crate) fn decompose(&mut self, bases: &[Basis]) -> Vec<Decomposition> {
        self.try_decompose(bases, DEFAULT_MEMORY_BYTES).expect("it fits")
    }

    pub(crate) fn try_decompose(
        &mut self,
        bases: &[Basis],
        memory_bytes: usize,
    ) -> Result<Vec<Decomposition>, FourierError> {
        let symbols = self.dag.symbols().clone();
        let run_time = self.robot.joints().flat_map(|(_, v)| [v.q, v.qd, v.qdd]);
        let run_time: Vec<_> =
            run_time.map(|expr| self.dag.as_symbol(expr).unwrap().name.clone()).collect();
        let is_known = |id| {
            let name = &symbols[id].name;
            !run_time.contains(name) && !name.contains("_torso_")
        };
        let matrix = Matrix { rows: &self.rows, is_known: &is_known, chains: &self.chains };
        let mut expansion = Expansion { memory_bytes, progress: &mut |_| {} };
        decompose(&mut self.dag, &matrix, bases, &mut expansion)
    }
}
