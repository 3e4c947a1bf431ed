//! Base parameters with their proof, in one call.

use super::base::{BaseError, BaseParameters, base_parameters};
use super::certificate::Certificate;
use super::column::RegressorOptions;
use super::joint_basis::{JointParameter, joint_basis};
use crate::model::{BakeError, Robot, bake_geometry};
use std::fmt;
use std::time::{Duration, Instant};

/// How base parameters are found.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct BaseOptions {
    /// What the regressor has besides the rigid bodies.
    pub parameters: RegressorOptions,
    /// Whether the model's numbers for lengths, angles and gravity stand in place of their symbols.
    pub numeric: bool,
    /// Parameters to keep before others, most wanted first: names, or prefixes of those of all
    /// links.
    pub keep: Vec<String>,
    /// Whether those on the joint axes are found, too.
    pub on_joint_axes: bool,
}

/// Why base parameters are not found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ProvenBaseError {
    /// No terms are left in which bodies act by themselves; holds the model.
    NoMotionTerms(String),
    /// Values are missing.
    Bake(BakeError),
    /// The parameters are not found.
    Base(BaseError),
}

impl ProvenBaseError {
    /// Whether numbers in place of symbols ([`BaseOptions::numeric`]) are the way out.
    pub fn is_inexact(&self) -> bool {
        matches!(self, Self::Base(BaseError::Inexact { .. }))
    }
}

impl fmt::Display for ProvenBaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoMotionTerms(model) => write!(
                f,
                "{model}: base parameters need inertia or gravity among the terms\n  hint: \
                 `robot.terms=inertia,gravity`; `options.parameters=friction,rotor` adds the \
                 parameters of joints"
            ),
            Self::Bake(error) => write!(f, "{error}"),
            Self::Base(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for ProvenBaseError {}

/// Base parameters with a proof.
#[derive(Clone, Debug)]
pub struct ProvenBase {
    /// The robot, with numbers in place of symbols if that was asked for.
    pub robot: Robot,
    /// Its base parameters.
    pub base: BaseParameters,
    /// Those on the joint axes, if they were asked for.
    pub joints: Option<Vec<JointParameter>>,
    /// The proof.
    pub certificate: Certificate,
    /// Whether the proof was checked and holds.
    pub verified: bool,
    /// How long finding took, without the proof.
    pub time: Duration,
}

impl ProvenBase {
    /// Finds the base parameters of a robot, and proves them.
    pub fn find(mut robot: Robot, options: &BaseOptions) -> Result<Self, ProvenBaseError> {
        if !robot.terms.inertia && !robot.terms.gravity {
            return Err(ProvenBaseError::NoMotionTerms(robot.name));
        }
        if options.numeric {
            robot = bake_geometry(&robot).map_err(ProvenBaseError::Bake)?;
        }
        let started = Instant::now();
        let mut base = base_parameters(&robot, options.parameters, &options.keep)
            .map_err(ProvenBaseError::Base)?;
        let joints = options.on_joint_axes.then(|| joint_basis(&mut base, &robot));
        let joints = joints.transpose().map_err(ProvenBaseError::Base)?;
        let time = started.elapsed();
        let certificate = Certificate::new(&robot, options.parameters, &base, options.numeric);
        let verified = certificate.verify(&robot).is_verified();
        Ok(Self { robot, base, joints, certificate, verified, time })
    }
}
