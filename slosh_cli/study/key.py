"""What makes two stops the same stop."""

from __future__ import annotations

import hashlib
import json
from typing import Final

from slosh_cli.scenario import Scenario
from slosh_cli.scenario.plain_data import plain_data

RESULT_VERSION: Final = 2
"""Raise it whenever the same scenario would give another answer: journals then compute every stop anew."""

_SAYS_NOTHING: Final = ("name", "description", "output")
"""Parts of a scenario that its answer does not depend on."""


def stop_key(scenario: Scenario) -> str:
    """sha256 (hexadecimal) of the resolved scenario, every default written out, and of RESULT_VERSION."""
    values = plain_data(scenario, as_text=True)
    telling = {name: value for name, value in values.items() if name not in _SAYS_NOTHING}
    text = json.dumps([RESULT_VERSION, telling], sort_keys=True, separators=(",", ":"), allow_nan=False)
    return hashlib.sha256(text.encode()).hexdigest()
