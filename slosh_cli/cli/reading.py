"""Reading the scenario a command was given."""

from collections.abc import Sequence
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING

from slosh_cli.errors import Problem, ScenarioError

if TYPE_CHECKING:
    from slosh_cli.scenario import Scenario, TankScenario


def read_scenario(path: Path, overrides: Sequence[str] | None) -> "Scenario":
    """Load the scenario of a stop.

    Raises ScenarioError, which for a missing file names the packaged scenario that may have been meant.
    """
    from slosh_cli.scenario import load_scenario

    return load_scenario(_existing(path), overrides or ())


def read_any_scenario(path: Path, overrides: Sequence[str] | None) -> "Scenario | TankScenario":
    """Load the scenario of a stop, or of a tank alone. Raises ScenarioError as `read_scenario` does."""
    from slosh_cli.scenario import load_any_scenario

    return load_any_scenario(_existing(path), overrides or ())


def _existing(path: Path) -> Path:
    """The path, unless no file is there and a packaged scenario may have been meant, which is named then."""
    from slosh_cli.scenario import packaged_scenarios

    if path.exists():
        return path
    names = {known: name for name, file in packaged_scenarios().items() for known in (name, file.stem, file.name)}
    for meant in get_close_matches(path.name, names, n=1, cutoff=0.7):
        name = names[meant]
        fix = f"`slosh init {name}` writes the packaged one to {name}.yaml, then `slosh run {name}.yaml`"
        raise ScenarioError(str(path), [Problem(None, "", "must be the path of a scenario file", "no such file", fix)])
    return path
