"""Reading the scenario a command was given."""

import os
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TypeVar

from slosh_cli.errors import Problem, ScenarioError

_S = TypeVar("_S")


def load_given(load: Callable[[Path, Sequence[str]], _S], path: Path, overrides: Sequence[str] | None) -> _S:
    """Load the scenario of a stop, or of any kind, as `load` does.

    Raises ScenarioError, which for a missing file names the packaged scenario that may have been meant.
    """
    from slosh_cli.scenario import packaged_scenarios

    if os.path.exists(path):  # which a name too long for the system does not
        return load(path, overrides or ())
    names = {known: name for name, file in packaged_scenarios().items() for known in (name, file.stem, file.name)}
    for meant in get_close_matches(path.name, names, n=1, cutoff=0.7):
        name = names[meant]
        fix = f"`slosh init {name}` writes the packaged one to {name}.yaml, then `slosh run {name}.yaml`"
        raise ScenarioError(str(path), [Problem(None, "", "must be the path of a scenario file", "no such file", fix)])
    return load(path, overrides or ())
