# %% [markdown]
# # From a URDF to inverse dynamics and control
#
# A two-link arm as URDF, its torques for a motion, and a controller by computed torque.

# %%
import numpy as np

import denavit

LINK = """<link name="{name}"><inertial><origin xyz="0.2 0 0"/><mass value="{mass}"/>
  <inertia ixx="0.001" iyy="0.02" izz="0.02" ixy="0" ixz="0" iyz="0"/></inertial></link>"""
JOINT = """<joint name="{name}" type="revolute"><parent link="{parent}"/><child link="{child}"/>
  <origin xyz="{x} 0 0"/><axis xyz="0 1 0"/>
  <limit lower="-3" upper="3" effort="60" velocity="8"/></joint>"""
urdf = f"""<robot name="arm"><link name="world"/>
{LINK.format(name="upper", mass=3.0)}{LINK.format(name="lower", mass=2.0)}
{JOINT.format(name="shoulder", parent="world", child="upper", x=0.0)}
{JOINT.format(name="elbow", parent="upper", child="lower", x=0.4)}</robot>"""
arm = denavit.Model.from_urdf(urdf)
print(arm, arm.joints)
print(arm.latex("mass_matrix"))

# %% [markdown]
# The torques of a whole motion are one call, on all cores.

# %%
t = np.arange(0.0, 4.0, 1e-3)
w = 2 * np.pi / 4
wanted = 0.6 * np.stack([np.sin(w * t), np.cos(w * t) - 1], axis=1)
wanted_qd = 0.6 * w * np.stack([np.cos(w * t), -np.sin(w * t)], axis=1)
wanted_qdd = -0.6 * w**2 * np.stack([np.sin(w * t), np.cos(w * t)], axis=1)
tau = arm.inverse_dynamics(wanted, wanted_qd, wanted_qdd)
print("largest torques [N m]:", np.abs(tau).max(axis=0).round(2))

# %% [markdown]
# Computed torque: the model linearises the robot, gains do the rest. It starts off its reference.

# %%
q, qd, h = wanted[0] + [0.2, -0.1], wanted_qd[0].copy(), t[1]
errors = np.empty((len(t), 2))
for k in range(len(t)):
    errors[k] = wanted[k] - q
    acceleration = wanted_qdd[k] + 100 * errors[k] + 20 * (wanted_qd[k] - qd)
    torque = arm.inverse_dynamics(q, qd, acceleration)
    qdd = arm.forward_dynamics(q, qd, torque)
    qd = qd + h * qdd
    q = q + h * qd
print("error at first and at the end [rad]:", errors[0], errors[-1].round(5))
assert np.abs(errors[-1]).max() < 1e-2

# %% [markdown]
# The same arm falls when nobody drives it; its energy says whether the simulation is right.

# %%
scenario = {"format": "denavit-scenario/1", "name": "fall", "model": arm, "duration_s": 1}
run = denavit.simulate(scenario)
energy = arm.kinetic_energy(run.q, run.qd) + arm.potential_energy(run.q)
print("energy changes by", np.ptp(energy), "J")
assert np.ptp(energy) < 1e-6
