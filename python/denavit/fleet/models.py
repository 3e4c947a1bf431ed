"""Which model a robot has."""

from __future__ import annotations

import json
from collections.abc import Iterable
from fnmatch import fnmatchcase
from pathlib import Path

from .._denavit import shipped_models
from ..errors import Error
from ..model import load
from .sources import FleetError, fault

SHAPE = '{"arm-*": "arm.json", "*": "puma560"}'


def read_models(path: str | Path, robots: Iterable[str]) -> dict[str, str]:
    """The text of the model of each robot. The file is a model, which all robots have (or the name
    of a shipped one), or an object of patterns of robots and models: files beside it, or shipped
    names. The first pattern that fits counts.
    """
    if str(path) in shipped_models() and not Path(path).exists():
        return dict.fromkeys(robots, json.dumps(load(path).to_dict()))
    path = Path(path)
    try:
        given = json.loads(path.read_bytes())
    except OSError as error:
        cause = f"cannot be read: {error.strerror}"
        hint = "a model, a shipped model's name, or JSON of patterns of robots and models"
        raise FleetError([fault(str(path), cause, hint)]) from None
    except ValueError:
        # a URDF or an MJCF
        given = {"format": "description"}
    if not isinstance(given, dict):
        raise FleetError([fault(str(path), "is no object", SHAPE)])
    if "format" in given:
        text = json.dumps(load(path).to_dict())
        return dict.fromkeys(robots, text)
    faults, texts = [], {}
    for pattern, place in given.items():
        if not isinstance(place, str):
            faults.append(fault(str(path), f"`{pattern}`: a model is a path or a name", SHAPE))
            continue
        own = path.parent / place
        try:
            is_shipped = place in shipped_models() and not own.exists()
            texts[pattern] = json.dumps(load(place if is_shipped else own).to_dict())
        except Error as error:
            faults += error.faults
    found = {}
    for robot in robots:
        pattern = next((one for one in given if fnmatchcase(robot, one)), None)
        if pattern is None:
            faults.append(fault(str(path), f"no pattern fits the robot `{robot}`", SHAPE))
        elif pattern in texts:
            found[robot] = texts[pattern]
    if faults:
        raise FleetError(faults)
    return found


def widened(text: str, stds: dict[str, float]) -> str:
    """A model whose drives state these standard deviations, by the names of their parameters."""
    model = json.loads(text)
    kinds = {"viscous": "fv", "coulomb": "fc", "rotor_inertia": "ia"}
    for link, drive in (model.get("drives") or {}).items():
        for key, short in kinds.items():
            std = stds.get(f"{short}_{link}")
            value = drive.get(key)
            if std is not None and isinstance(value, dict) and "std" in value:
                drive[key] = value | {"std": max(std, float(value["std"]))}
    return json.dumps(model)


def kind_of(text: str) -> str:
    """The kind of robot that a model is of: its links and joints, whatever their values. Robots
    with values of their own share what is known of how values scatter.
    """
    links = json.loads(text)["links"]
    return json.dumps([[link["name"], (link.get("joint") or {}).get("type")] for link in links])
