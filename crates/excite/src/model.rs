//! The robot of an excitation: regressor, torques and points in batches, and the limits of joints.

use super::fault::{ExciteFault, LimitKind};
use denavit_codegen::arena::Handle;
use denavit_codegen::derive::{Flavour, derive};
use denavit_codegen::expr::ExprId;
use denavit_codegen::function::FunctionName;
use denavit_codegen::model::{Contact, Robot, bake};
use denavit_codegen::program::{EvaluateBatch, constant_values, lower};
use denavit_plants::regression::{RegressionEvaluator, RegressionModel, RegressionRows};
use denavit_plants::{GroundModel, NativeBatch, PointModel, fall_points, point_positions};

/// Which parameters the columns of the regressor belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Columns {
    /// Base parameters on the joint axes: those in which estimates are computed.
    #[default]
    Axes,
    /// Base parameters of kept columns: those that are reported.
    Kept,
}

/// Bounds of a joint's motion.
#[derive(Clone, Debug, PartialEq)]
pub struct JointLimits {
    /// The joint's name.
    pub name: String,
    /// Whether it slides (m, N) or turns (rad, N m).
    pub slides: bool,
    /// Lowest and highest position, of joints that move.
    pub position: [f64; 2],
    /// Largest speed, of joints that move.
    pub velocity: f64,
    /// Largest acceleration, of joints that move.
    pub acceleration: f64,
    /// Lowest and highest torque, joint side.
    pub torque: Option<[f64; 2]>,
    /// Where the joint is held; none if it moves.
    pub held: Option<f64>,
    /// The limits among these that the model does not give: those of one sine a lap over the whole
    /// range of positions.
    pub assumed: Vec<LimitKind>,
}

impl JointLimits {
    /// Middle of the positions.
    pub fn middle(&self) -> f64 {
        self.held.unwrap_or(0.5 * (self.position[0] + self.position[1]))
    }

    /// Half the range of the positions.
    pub fn half(&self) -> f64 {
        0.5 * (self.position[1] - self.position[0])
    }
}

/// A robot whose excitation is wanted.
#[derive(Clone, Debug)]
pub struct ExcitedModel {
    /// The regressor.
    pub regression: RegressionModel,
    /// The joints, in the order of q.
    pub joints: Vec<JointLimits>,
    /// Weight of each joint's row; 0 leaves it out.
    pub weights: Vec<f64>,
    /// Which columns are excited.
    pub columns: Columns,
    /// Points that must stay clear of the ground.
    pub points: Vec<PointModel>,
    /// The radius of what must stay clear about each \[m\].
    radii_m: Vec<f64>,
    ground: GroundModel,
    links: usize,
    /// Inverse dynamics without Coulomb friction; none if no joint has a torque limit.
    torques: Option<Torques>,
    transforms: Option<NativeBatch>,
}

#[derive(Clone, Debug)]
struct Torques {
    smooth: NativeBatch,
    /// Coulomb friction of each joint, joint side [N m, N].
    coulomb: Vec<f64>,
}

/// The programs of a model, ready to be called: one for each thread.
#[derive(Clone, Debug)]
pub(super) struct Evaluators {
    /// Rows of the regressor.
    pub regressor: RegressionEvaluator,
    /// Rows that are used again.
    pub rows: RegressionRows,
    torques: Option<NativeBatch>,
    transforms: Option<NativeBatch>,
    outputs: Vec<f64>,
}

impl ExcitedModel {
    /// The programs of a robot whose joints, weights and columns have been settled.
    pub(super) fn new(
        robot: &Robot,
        regression: RegressionModel,
        joints: Vec<JointLimits>,
        weights: Vec<f64>,
        columns: Columns,
        keeps_clear: bool,
    ) -> Result<Self, ExciteFault> {
        let with_torques = joints.iter().any(|joint| joint.torque.is_some());
        let with_points = keeps_clear
            && !(robot.contacts.is_empty() && robot.bodies_that_must_not_touch.is_empty());
        let mut made = Self {
            regression,
            joints,
            weights,
            columns,
            points: Vec::new(),
            radii_m: Vec::new(),
            ground: GroundModel::default(),
            links: robot.links.len(),
            torques: None,
            transforms: None,
        };
        if !with_torques && !with_points {
            return Ok(made);
        }
        let baked = bake(robot).map_err(ExciteFault::Bake)?;
        if with_torques {
            made.torques = Some(torques(&baked, made.joints.len())?);
        }
        if with_points {
            made.transforms = Some(program(&baked, FunctionName::LinkTransforms)?);
            made.ground = ground(&baked);
            let contacts = baked.contacts.values().map(|contact| (point(&baked, contact), 0.0));
            for (point, radius_m) in contacts.chain(fall_points(&baked)) {
                made.points.push(point);
                made.radii_m.push(radius_m);
            }
        }
        Ok(made)
    }

    /// Evaluators of a thread.
    pub(super) fn evaluators(&self) -> Evaluators {
        Evaluators {
            regressor: self.regression.evaluator(),
            rows: RegressionRows::default(),
            torques: self.torques.as_ref().map(|torques| torques.smooth.clone()),
            transforms: self.transforms.clone(),
            outputs: Vec::new(),
        }
    }

    /// Joints whose torque has limits, and is known.
    pub(super) fn limited(&self) -> Vec<usize> {
        let is_limited = |joint: &usize| self.joints[*joint].torque.is_some();
        let with = self.torques.is_some();
        (0..self.joints.len()).filter(|joint| with && is_limited(joint)).collect()
    }

    /// Coulomb friction of a joint, joint side [N m, N].
    pub(super) fn coulomb(&self, joint: usize) -> f64 {
        self.torques.as_ref().map_or(0.0, |torques| torques.coulomb[joint])
    }

    /// Torques without Coulomb friction, a column for each joint, of 3 n columns of motion.
    pub(super) fn torque_columns(
        &self,
        evaluators: &mut Evaluators,
        motion: &[&[f64]],
    ) -> Vec<Vec<f64>> {
        let samples = motion.first().map_or(0, |column| column.len());
        let mut columns = vec![vec![0.0; samples]; self.joints.len()];
        if let Some(batch) = &mut evaluators.torques {
            let mut outputs: Vec<&mut [f64]> = columns.iter_mut().map(Vec::as_mut_slice).collect();
            batch.evaluate(motion, &mut outputs).expect("one column for each joint");
        }
        columns
    }

    /// Heights of the points above the ground \[m\], a column for each point, of n columns of
    /// positions.
    pub(super) fn gap_columns(&self, evaluators: &mut Evaluators, q: &[&[f64]]) -> Vec<Vec<f64>> {
        let samples = q.first().map_or(0, |column| column.len());
        let mut gaps = vec![vec![0.0; samples]; self.points.len()];
        let Some(batch) = &mut evaluators.transforms else { return gaps };
        let width = 12 * self.links;
        evaluators.outputs.resize(width * samples, 0.0);
        if samples > 0 {
            let mut columns: Vec<&mut [f64]> =
                evaluators.outputs.chunks_exact_mut(samples).collect();
            batch.evaluate(q, &mut columns).expect("twelve columns for each link");
        }
        let mut transforms = vec![0.0; width];
        let mut places = vec![0.0; 3 * self.points.len()];
        for sample in 0..samples {
            for (entry, place) in transforms.iter_mut().enumerate() {
                *place = evaluators.outputs[entry * samples + sample];
            }
            point_positions(&self.points, &transforms, &mut places);
            let radii = places.chunks_exact(3).zip(&self.radii_m);
            for (gap, (place, radius_m)) in gaps.iter_mut().zip(radii) {
                gap[sample] = self.ground.height(place) - radius_m;
            }
        }
        gaps
    }

    /// The joints that move.
    pub fn moving(&self) -> Vec<usize> {
        (0..self.joints.len()).filter(|&joint| self.joints[joint].held.is_none()).collect()
    }

    /// The places in a joint's pattern of columns with the sign of its rate.
    pub(super) fn sign_columns(&self, joint: usize) -> Vec<usize> {
        let name = format!("fc_{}", self.joints[joint].name);
        let pattern = self.regression.pattern()[joint].iter().enumerate();
        pattern
            .filter(|(_, phi)| self.regression.axes[**phi].name == name)
            .map(|(place, _)| place)
            .collect()
    }
}

fn program(robot: &Robot, name: FunctionName) -> Result<NativeBatch, ExciteFault> {
    let derivation = derive(robot, Flavour::Baked, &[name]).map_err(ExciteFault::Bake)?;
    let program = lower(&derivation.dag, &derivation.functions).map_err(ExciteFault::Lower)?;
    Ok(NativeBatch::new(&program.routines[0], &[]))
}

/// What Coulomb friction takes is the difference of two inverse dynamics at a positive rate.
fn torques(robot: &Robot, joints: usize) -> Result<Torques, ExciteFault> {
    let mut without = robot.clone();
    for link in without.links.values_mut() {
        if let Some(drive) = &mut link.drive {
            drive.coulomb = None;
        }
    }
    let smooth = program(&without, FunctionName::InverseDynamics)?;
    let full = program(robot, FunctionName::InverseDynamics)?;
    let motion: Vec<f64> = (0..3 * joints).map(|at| f64::from(at / joints == 1)).collect();
    let motion: Vec<&[f64]> = motion.iter().map(std::slice::from_ref).collect();
    let torque = |program: &NativeBatch| -> Vec<f64> {
        let mut values = vec![0.0; joints];
        let mut columns: Vec<&mut [f64]> = values.iter_mut().map(std::slice::from_mut).collect();
        program.clone().evaluate(&motion, &mut columns).expect("one column for each joint");
        values
    };
    let (full, plain) = (torque(&full), torque(&smooth));
    let coulomb = full.iter().zip(&plain).map(|(with, without)| with - without);
    // what is below rounding is no friction
    let coulomb = coulomb.zip(&full).map(|(c, all)| if c > 1e-12 * all.abs() { c } else { 0.0 });
    Ok(Torques { smooth, coulomb: coulomb.collect() })
}

fn values(robot: &Robot, entries: [ExprId; 3]) -> [f64; 3] {
    let values = constant_values(&robot.dag, &entries);
    std::array::from_fn(|entry| values[entry])
}

fn point(robot: &Robot, contact: &Contact) -> PointModel {
    PointModel {
        name: contact.name.clone(),
        link: contact.link.index(),
        position: values(robot, contact.position),
    }
}

fn ground(robot: &Robot) -> GroundModel {
    let normal = values(robot, robot.ground.normal);
    let length = normal.iter().map(|entry| entry * entry).sum::<f64>().sqrt();
    GroundModel {
        point: values(robot, robot.ground.point),
        normal: normal.map(|entry| entry / length),
    }
}
