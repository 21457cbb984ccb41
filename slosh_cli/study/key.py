"""What makes two stops the same stop."""

from __future__ import annotations

import hashlib
import json
from functools import lru_cache
from typing import Final

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.base import Part
from slosh_cli.scenario.plain_data import plain_data

RESULT_VERSION: Final = 2
"""Raise it whenever the same scenario would give another answer: journals then compute every stop anew."""

_SAYS_NOTHING: Final = ("name", "description", "output")
"""Parts of a scenario that its answer does not depend on."""


def stop_key(scenario: Scenario) -> str:
    """sha256 (hexadecimal) of the resolved scenario, every default written out, and of RESULT_VERSION."""
    parts = vars(scenario).items()
    telling = [f'"{name}":{_text(part)}' for name, part in sorted(parts) if name not in _SAYS_NOTHING]
    return hashlib.sha256(f"[{RESULT_VERSION},{{{','.join(telling)}}}]".encode()).hexdigest()


@lru_cache(maxsize=256)
def _text(part: Part | int) -> str:
    """JSON of a part, the same for the same values; the stops of a study share most parts."""
    data = plain_data(part, as_text=True) if isinstance(part, Part) else part
    return json.dumps(data, sort_keys=True, separators=(",", ":"), allow_nan=False)
