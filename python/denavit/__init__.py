"""Symbolic robot dynamics: functions of robots on numpy arrays, simulation, identification,
diagnosis and walking.

>>> import denavit
>>> model = denavit.load("puma560")
>>> model.gravity_vector([0.0] * 6).shape
(6,)
"""

from . import walk
from ._denavit import __version__, shipped_gaits, shipped_models, shipped_scenarios
from ._options import Progress
from ._results import Answer, Latex
from .base import BaseParameter, BaseParameters, base_parameters
from .diagnose import Diagnosis, FoundEffect, diagnose
from .errors import (
    ArgumentError,
    DiagnoseError,
    Error,
    ExciteError,
    Fault,
    FunctionMissing,
    IdentifyError,
    MissingPackage,
    ModelError,
    SimulateError,
    WalkError,
)
from .excite import Excitation, excite
from .identify import Identification, IdentifiedParameter, identify
from .model import (
    DynamicsTerms,
    ForwardDynamicsDerivatives,
    InverseDynamicsDerivatives,
    Model,
    ModelWarning,
    Momentum,
    Regressor,
    load,
)
from .simulate import Run, simulate
from .statics import Statics, identify_statics
from .two_stage import TwoStageIdentification, identify_two_stage

__all__ = [
    "Answer",
    "ArgumentError",
    "BaseParameter",
    "BaseParameters",
    "DiagnoseError",
    "Diagnosis",
    "DynamicsTerms",
    "Error",
    "Excitation",
    "ExciteError",
    "Fault",
    "ForwardDynamicsDerivatives",
    "FoundEffect",
    "FunctionMissing",
    "Identification",
    "IdentifiedParameter",
    "IdentifyError",
    "InverseDynamicsDerivatives",
    "Latex",
    "MissingPackage",
    "Model",
    "ModelError",
    "ModelWarning",
    "Momentum",
    "Progress",
    "Regressor",
    "Run",
    "SimulateError",
    "Statics",
    "TwoStageIdentification",
    "WalkError",
    "__version__",
    "base_parameters",
    "diagnose",
    "excite",
    "identify",
    "identify_statics",
    "identify_two_stage",
    "load",
    "shipped_gaits",
    "shipped_models",
    "shipped_scenarios",
    "simulate",
    "walk",
]
