# %% [markdown]
# # Identify a PUMA 560 from simulated logs
#
# A motion that moves all joints, torques with noise, base parameters with standard errors.

# %%
import numpy as np

import denavit

robot = denavit.load("puma560")
base = denavit.base_parameters(robot, joint_parameters=["modelled"])
print(base._title())

# %% [markdown]
# Two motions within the limits of the joints: one to estimate from, one to judge with. A Fourier
# series has exact derivatives.

# %%
limits = np.array([link["limits"]["position"] for link in robot.inspect()["links"]])
middle, reach = limits.mean(axis=1), np.minimum(np.ptp(limits, axis=1) / 2, 1.5)


def logged(seed: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 20.0, 2e-3)
    q, qd, qdd = np.zeros((3, len(t), robot.dof))
    q += middle
    for harmonic in range(1, 6):
        w = 2 * np.pi * harmonic / 10
        a, b = random.uniform(-0.1, 0.1, (2, robot.dof)) * reach
        sine, cosine = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q += a * sine + b * cosine
        qd += w * (a * cosine - b * sine)
        qdd -= w**2 * (a * sine + b * cosine)
    tau = robot.inverse_dynamics(q, qd, qdd)
    tau += 0.02 * random.standard_normal(tau.shape)
    columns = {"t": t}
    for at, joint in enumerate(robot.joints):
        columns |= {f"q_{joint}": q[:, at], f"tau_{joint}": tau[:, at]}
    return columns


found = denavit.identify(robot, logged(1), logged(2), update=False)
print(found._title())

# %%
table = found.to_pandas()
print(table[["name", "value", "std", "unit"]].head(10).to_string())

# %% [markdown]
# The values are those that the torques were made with, within a few standard errors.

# %%
shown = [one for one in found.parameters if one.std is not None and one.model_value is not None]
distance = [abs(one.value - one.model_value) / one.std for one in shown]
print(f"{len(shown)} parameters, the median is {np.median(distance):.2f} standard errors away")
assert found.residual.validate is not None and found.residual.validate < 0.02
assert np.median(distance) < 3
