# %% [markdown]
# # What does a model lack?
#
# The elbow of an arm rubs, and its model does not know. The diagnosis names effect and joint.

# %%
import numpy as np

import denavit

arm = denavit.load("planar_3r")
joint = arm.joints[1]


def logged(seed: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(seed)
    t = np.arange(0.0, 20.0, 2e-3)
    q, qd, qdd = np.zeros((3, len(t), arm.dof))
    for harmonic in range(1, 6):
        w = 2 * np.pi * harmonic / 10
        a, b = random.uniform(-0.4, 0.4, (2, arm.dof))
        sine, cosine = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q += a * sine + b * cosine
        qd += w * (a * cosine - b * sine)
        qdd -= w**2 * (a * sine + b * cosine)
    tau = arm.inverse_dynamics(q, qd, qdd)
    tau[:, 1] += 0.8 * np.tanh(qd[:, 1] / 0.01)  # what the model does not have
    tau += 0.01 * random.standard_normal(tau.shape)
    columns = {"t": t}
    for at, name in enumerate(arm.joints):
        columns |= {f"q_{name}": q[:, at], f"tau_{name}": tau[:, at]}
    return columns


# %%
found = denavit.diagnose(arm, logged(1), logged(2), most=2)
print(found._title())
for effect in found.effects:
    values = {name: round(value.value, 3) for name, value in effect.values.items()}
    print(effect.effect, "at", effect.at, values, f"log odds {effect.log_odds:.0f}")

# %% [markdown]
# The torque mismatch on the other motion, before and after.

# %%
gap = found.gap.validate
for when, share in (("before", gap.before), ("after", gap.after), ("of noise", gap.floor)):
    print(f"mismatch {when}: {100 * share:.2f} %")
assert found.effects and found.effects[0].at == joint
assert gap.after < 0.3 * gap.before
