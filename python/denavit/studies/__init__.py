"""Studies: a function from an index to a row, on one machine, on Ray, or by parts under Slurm.

A study is the same wherever it runs: a row depends on the study and on its index alone. Needs
pyarrow; ``on_ray`` needs ray.

>>> from denavit import studies
>>> @studies.rows(angle=float)
... def angles(case):
...     return {"angle": case.random().uniform(0.0, 1.0)}
>>> study = studies.Study("angles", angles, count=3, seed=7)
>>> [row["index"] for row in studies.computed(study)]
[0, 1, 2]
"""

from . import ready
from .cases import Case, PassingError, Row, rows
from .here import computed, run
from .parts import StudyError, again, extent, merge, missing, read_part
from .study import Study, read_study

__all__ = [
    "Case",
    "PassingError",
    "Row",
    "Study",
    "StudyError",
    "again",
    "computed",
    "extent",
    "merge",
    "missing",
    "read_part",
    "read_study",
    "ready",
    "rows",
    "run",
]
