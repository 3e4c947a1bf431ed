"""Options of the library by what they are called here: its texts name them as ``options.seed``, or
with a value as ``options.method=iv``.
"""

from __future__ import annotations

import re

OTHERWISE = {
    "accepts_cut": "accept_cut",
    "accepts_suspicious": "accept_suspicious",
    "decimation": "decimate",
    "filter": "filter_hz",
    "parameters": "joint_parameters",
    "slow": "skip_slow",
    "uses_prior": "prior",
    "window": "window_s",
}
"""Options whose keywords are called otherwise."""

OPTION = re.compile(r"`(?:options|logs|conditions|scenario|robot)\.([a-z_]+)(?:=([^`\s]*))?`")
"""An option as the library names it, whoever has it."""


def by_keyword(text: str) -> str:
    """A text with keywords in place of options of the library."""
    return OPTION.sub(_keyword, text)


def _keyword(found: re.Match[str]) -> str:
    name, value = found.group(1), found.group(2)
    own = OTHERWISE.get(name, name)
    if value is None:
        return f"`{own}`"
    is_number = re.fullmatch(r"[-+.0-9e]+", value) is not None
    return f"`{own}={value}`" if is_number else f'`{own}="{value}"`'
