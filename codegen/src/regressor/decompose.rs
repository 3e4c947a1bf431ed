//! R0_ij = f^T b_ij of a robot, ten parameters a link; a floating base in torso coordinates.

use super::pull::{Equation, MotionTerms, TorsoMotion, fixed_base_regressor, torso_regressor};
use crate::arena::Handle;
use crate::expr::{ClassSet, Dag, ExprId, Symbol, SymbolId};
use crate::fundamental::{Basis, Decomposition, Expansion, FourierError, Matrix, decompose};
use crate::kinematics::{Frames, Mechanism, parallel_groups};
use crate::model::{Base, Robot};
use crate::spatial::PseudoInertia;

/// f and B of a robot.
#[derive(Clone, Debug)]
pub struct RobotDecomposition {
    /// Holds all expressions.
    pub dag: Dag,
    /// The columns: m, mx, my, mz, Ixx .. Iyz of every link with a body, about the origin of its
    /// frame, as `mx_LINK`.
    pub columns: Vec<String>,
    /// What each equation balances.
    pub equations: Vec<String>,
    /// R0, by equations.
    pub rows: Vec<Vec<ExprId>>,
    /// f and B, in each of the bases that the robot has.
    pub decompositions: Vec<Decomposition>,
}

/// The prefixes of the ten parameters of a link.
const PARAMETERS: [&str; 10] = ["m", "mx", "my", "mz", "Ixx", "Iyy", "Izz", "Ixy", "Ixz", "Iyz"];

/// Decomposes the rigid-body regressor of `robot` with the given terms of the motion.
pub fn decompose_robot(
    robot: &Robot,
    terms: MotionTerms,
    bases: &[Basis],
    expansion: &mut Expansion<'_>,
) -> Result<RobotDecomposition, FourierError> {
    let mut dag = robot.dag.clone();
    let mechanism = Mechanism::new(&mut dag, robot);
    let frames = Frames::plain(&mut dag, &mechanism);
    let matter = match robot.base {
        Base::Fixed => fixed_base_regressor(&mut dag, &frames, terms),
        Base::Floating => torso_regressor(&mut dag, &frames, (5, TorsoMotion::Spatial), terms),
        Base::PlanarFloating => torso_regressor(&mut dag, &frames, (2, TorsoMotion::Planar), terms),
    };
    let mut columns = Vec::new();
    let mut rows = vec![Vec::new(); matter.rows.len()];
    for (id, link) in robot.links.iter() {
        let placement = mechanism.placements[id].clone();
        let (Some(body), true) = (placement.body, link.body.is_some()) else { continue };
        for (place, prefix) in PARAMETERS.into_iter().enumerate() {
            columns.push(format!("{prefix}_{}", link.name));
            let unit = unit_matter(&mut dag, place);
            let carried = entries(&placement.carry(&mut dag, &unit));
            for (row, of_bodies) in rows.iter_mut().zip(&matter.rows) {
                let mut sum = dag.zero();
                for (factor, power) in carried.into_iter().zip(of_bodies[body]) {
                    let product = dag.mul(factor, power);
                    sum = dag.add(sum, product);
                }
                row.push(sum);
            }
        }
    }
    let joints: Vec<&str> =
        robot.joints().map(|(link, _)| robot.links[link].name.as_str()).collect();
    let name = |equation: &Equation| match *equation {
        Equation::TorsoMoment(axis) => format!("torso moment {}", ["x", "y", "z"][axis]),
        Equation::TorsoForce(axis) => format!("torso force {}", ["x", "y", "z"][axis]),
        Equation::Joint(joint) => joints[joint].to_owned(),
    };
    let equations = matter.equations.iter().map(name).collect();
    let chains: Vec<Vec<ExprId>> = parallel_groups(&mechanism)
        .into_iter()
        .map(|group| group.into_iter().map(|i| mechanism.bodies[i].variables.q).collect())
        .collect();
    let run_time = |symbol: &Symbol| ClassSet::of(symbol.class).is_run_time();
    let known: Vec<bool> = dag.symbols().values().map(|symbol| !run_time(symbol)).collect();
    let is_known = |id: SymbolId| known[id.index()];
    let matrix = Matrix { rows: &rows, is_known: &is_known, chains: &chains };
    let decompositions = decompose(&mut dag, &matrix, bases, expansion)?;
    Ok(RobotDecomposition { dag, columns, equations, rows, decompositions })
}

/// Matter of one unit of one of the ten parameters.
fn unit_matter(dag: &mut Dag, place: usize) -> PseudoInertia {
    let (zero, one) = (dag.zero(), dag.one());
    let unit = |at: usize| if at == place { one } else { zero };
    let tensor = [4, 5, 6, 7, 8, 9].map(unit);
    let matter = PseudoInertia::from_body(dag, zero, [zero; 3], tensor, false);
    PseudoInertia { mass: unit(0), first: [1, 2, 3].map(unit), ..matter }
}

/// The entries of a pseudo-inertia, in the order of the columns of the matter's regressor.
fn entries(matter: &PseudoInertia) -> [ExprId; 10] {
    let (k, s) = (&matter.second, matter.first);
    let [k11, k22, k33] = [0, 1, 2].map(|i| k[i][i]);
    [matter.mass, s[0], s[1], s[2], k11, k22, k33, k[0][1], k[0][2], k[1][2]]
}
