"""Centroidal momentum of TUlip by Pinocchio: centroidal_momentum.json.

    pip install pin casadi numpy && PYTHONPATH=benches/race python tests/oracles/centroidal_momentum.py

Joints and bodies come from the model file by the reader of the race. For each sample the matrix A, its derivative by
time times the velocities, and the momentum; rows linear, then angular about the centre of mass. And the Jacobian of
the centre of mass, times the velocities (its velocity), and its acceleration where no joint accelerates.
"""
import json
import pathlib

import numpy
import pinocchio
import rigid_body

HERE = pathlib.Path(__file__).resolve().parent
MODEL = HERE.parent.parent / "models" / "tulip.json"


def robot_of(model):
    robot = pinocchio.Model()
    for row, joint in enumerate(model.joints):
        kind = pinocchio.JointModelRZ if joint.is_revolute else pinocchio.JointModelPZ
        place = pinocchio.SE3(numpy.array(joint.turn, float), numpy.array(joint.shift, float))
        added = robot.addJoint(joint.parent + 1, kind(), place, f"{row}")
        mass, moment, inertia = joint.matter
        if mass == 0:
            continue
        center = numpy.array(moment) / mass
        square = center @ center * numpy.eye(3) - numpy.outer(center, center)
        body = pinocchio.Inertia(mass, center, numpy.array(inertia) - mass * square)
        robot.appendBodyToJoint(added, body, pinocchio.SE3.Identity())
    return robot


def samples(robot):
    random = numpy.random.default_rng(41)
    data = robot.createData()
    for _ in range(4):
        q, v = (numpy.round(random.uniform(-1, 1, robot.nv), 4) for _ in range(2))
        pinocchio.dccrba(robot, data, q, v)
        matrix, bias = data.Ag.copy(), data.dAg @ v
        jacobian = pinocchio.jacobianCenterOfMass(robot, data, q).copy()
        pinocchio.centerOfMass(robot, data, q, v, 0 * v)
        yield {"q": q, "qd": v, "matrix": matrix.ravel(), "bias": bias, "momentum": matrix @ v,
               "center_of_mass_velocity": jacobian @ v,
               "center_of_mass_bias": data.acom[0].copy()}


if __name__ == "__main__":
    found = [{key: entry.tolist() for key, entry in sample.items()}
             for sample in samples(robot_of(rigid_body.Model(MODEL)))]
    (HERE / "centroidal_momentum.json").write_text(json.dumps(found) + "\n")
