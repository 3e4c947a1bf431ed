"""Writes scenarios of pages that are made from shipped ones: soft.json, chatter.json.

    python tests/pages/derived.py FOLDER

soft is the experiment of TUlip's leg under gains that let it fall behind; chatter has encoders so
coarse that its torque goes up and down from sample to sample.
"""

import json
import sys
from pathlib import Path

SHIPPED = Path(__file__).parents[2] / "models" / "scenarios" / "tulip_leg_identification.json"


def main():
    folder = Path(sys.argv[1])
    given = json.loads(SHIPPED.read_text(encoding="utf-8"))
    soft = json.loads(json.dumps(given)) | {"name": "soft", "duration_s": 6}
    for joint in soft["control"]["joints"].values():
        joint |= {"kp": 120, "kd": 12}
    coarse = {"resolution": 0.0005, "differentiates": True}
    chatter = given | {"name": "chatter", "duration_s": 4, "measurement": coarse}
    for made in (soft, chatter):
        text = json.dumps(made, indent=1)
        (folder / f"{made['name']}.json").write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
