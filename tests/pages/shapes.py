"""An arm whose links have shapes: a URDF, its meshes, and a scenario.

    python tests/pages/shapes.py FOLDER

FOLDER/urdf/arm.urdf has a mesh of 180 000 triangles, which is more than a page draws, one of text,
an OBJ, and solids. broken.urdf has one that is cut, one of COLLADA, and one outside of the folder.
FOLDER/leg.xml has the solids of an MJCF, FOLDER/boom.xml a boom that is much longer than all
distances between its frames.
"""

import json
import math
import struct
import sys
from pathlib import Path

ARM = """<robot name="arm">
  <link name="stand"><visual><origin xyz="0 0 0.1"/>
    <geometry><cylinder radius="0.12" length="0.2"/></geometry></visual></link>
  <link name="upper">
    <inertial><origin xyz="0.2 0 0"/><mass value="3"/>
      <inertia ixx="0.01" iyy="0.06" izz="0.06" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://arm/meshes/{upper}" scale="0.001 0.001 0.001"/>
    </geometry></visual></link>
  <link name="fore">
    <inertial><origin xyz="0.15 0 0"/><mass value="1.5"/>
      <inertia ixx="0.004" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="{fore}"/></geometry></visual></link>
  <link name="tool"><visual><geometry><mesh filename="package://arm/meshes/{tool}"/></geometry>
    </visual></link>
  <joint name="shoulder" type="revolute"><origin xyz="0 0 0.3"/><axis xyz="0 1 0"/>
    <parent link="stand"/><child link="upper"/>
    <limit lower="-2" upper="2" velocity="6" effort="80"/></joint>
  <joint name="elbow" type="revolute"><origin xyz="0.4 0 0"/><axis xyz="0 1 0"/>
    <parent link="upper"/><child link="fore"/>
    <limit lower="-2.5" upper="2.5" velocity="8" effort="40"/></joint>
  <joint name="flange" type="fixed"><origin xyz="0.3 0 0"/>
    <parent link="fore"/><child link="tool"/></joint>
</robot>
"""


BOOM = """<mujoco model="boom"><worldbody><body name="boom"><joint name="slew" axis="0 0 1"
  range="-1 1"/><geom type="box" pos="3 0 0" size="3 0.1 0.1"/></body></worldbody></mujoco>
"""


LEG = """<mujoco model="leg">
  <compiler angle="radian"/>
  <asset><mesh file="fore.stl"/></asset>
  <default><geom group="1"/><default class="hit"><geom group="3"/></default></default>
  <worldbody>
    <geom type="plane" size="5 5 1"/>
    <geom type="box" size="0.15 0.15 0.03" pos="0 0 0.83"/>
    <body name="thigh" pos="0 0 0.8">
      <joint name="hip" axis="0 1 0" range="-1 1"/>
      <geom type="capsule" size="0.05" fromto="0 0 0 0 0 -0.4"/>
      <geom type="ellipsoid" size="0.09 0.05 0.12" pos="0.03 0 -0.14" mass="0.1"/>
      <geom class="hit" type="sphere" size="0.3" mass="0"/>
      <body name="shin" pos="0 0 -0.4">
        <joint name="knee" axis="0 1 0" range="-2 0"/>
        <inertial pos="0 0 -0.15" mass="1" diaginertia="0.01 0.01 0.002"/>
        <geom type="mesh" mesh="fore" euler="0 1.5707963267948966 0"/>
        <geom type="cylinder" size="0.06 0.02" pos="0 0 -0.31"/>
      </body>
    </body>
  </worldbody>
</mujoco>
"""


def tube(length, radius, along, around):
    """Triangles of a link: thick at its joints, thin between."""
    def at(step, turn):
        share, angle = step / along, 2 * math.pi * turn / around
        wide = radius * (0.6 + 0.4 * math.cos(2 * math.pi * share) ** 2)
        return (length * share, wide * math.cos(angle), wide * math.sin(angle))

    for step in range(along):
        for turn in range(around):
            a, b = at(step, turn), at(step + 1, turn)
            c, d = at(step + 1, turn + 1), at(step, turn + 1)
            yield a, b, c
            yield a, c, d


def binary(triangles):
    body = [struct.pack("<12fH", 0, 0, 0, *a, *b, *c, 0) for a, b, c in triangles]
    return bytes(80) + struct.pack("<I", len(body)) + b"".join(body)


def text(triangles):
    lines = ["solid fore"]
    for corners in triangles:
        vertices = "".join(f"vertex {x:.6f} {y:.6f} {z:.6f}\n" for x, y, z in corners)
        lines.append(f"facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet")
    return "\n".join([*lines, "endsolid fore", ""])


def scenario():
    def reference(size):
        fourier = {"frequencies_rad_s": [1.5], "offset": 0.0, "sines": [size], "cosines": [0.0]}
        return {"kp": 200, "kd": 8, "reference": {"fourier": fourier}}

    joints = {"shoulder": reference(0.8), "elbow": reference(-1.2)}
    return {
        "format": "denavit-scenario/1", "name": "swing", "model": "urdf/arm.urdf",
        "duration_s": 4, "initial": {"on_reference": True},
        "control": {"period_s": 0.001, "compensation": "gravity", "joints": joints},
    }


def main():
    folder = Path(sys.argv[1])
    meshes, urdf = folder / "meshes", folder / "urdf"
    for one in (meshes, urdf):
        one.mkdir(parents=True, exist_ok=True)
    (meshes / "upper.stl").write_bytes(binary(tube(400, 60, 450, 200)))
    (folder / "fore.stl").write_text(text(tube(0.3, 0.045, 40, 32)))
    (meshes / "tool.obj").write_text(
        "v 0 -0.05 -0.05\nv 0 0.05 -0.05\nv 0 0.05 0.05\nv 0 -0.05 0.05\nv 0.12 0 0\n"
        "f 1 2 3 4\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n")
    whole = (meshes / "upper.stl").read_bytes()
    (meshes / "cut.stl").write_bytes(whole[: len(whole) // 2])
    (meshes / "tool.dae").write_text("<COLLADA/>")
    (folder.parent / "outside.stl").write_bytes(whole)
    (urdf / "arm.urdf").write_text(
        ARM.format(upper="upper.stl", fore="fore.stl", tool="tool.obj"))
    (urdf / "broken.urdf").write_text(
        ARM.format(upper="cut.stl", fore="../outside.stl", tool="tool.dae"))
    (folder / "leg.xml").write_text(LEG)
    (folder / "boom.xml").write_text(BOOM)
    (folder / "swing.json").write_text(json.dumps(scenario()))


if __name__ == "__main__":
    main()
