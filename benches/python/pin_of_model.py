"""A shipped model without drives, springs and dampers, for denavit and for Pinocchio."""
import pathlib
import tempfile

import numpy
import pinocchio

import denavit
from denavit import _denavit


def rigid(name):
    """The model, and Pinocchio's of the URDF that it becomes."""
    document = denavit.load(name).to_dict()
    document.pop("drives", None)
    for link in document["links"]:
        link.pop("drive", None)
        link["joint"].pop("spring", None)
        link["joint"].pop("damping", None)
    model = denavit.load(document)
    with tempfile.TemporaryDirectory() as folder:
        path, urdf = pathlib.Path(folder) / f"{name}.json", pathlib.Path(folder) / f"{name}.urdf"
        model.save(path)
        _denavit.run(["export", str(path), "-o", str(urdf)])
        robot = pinocchio.buildModelFromUrdf(str(urdf))
    # a URDF says nothing of gravity
    robot.gravity.linear = numpy.array([0.0, 0.0, -9.81])
    return model, robot
