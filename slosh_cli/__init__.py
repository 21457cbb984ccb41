"""slosh: tank wagons with a moving liquid, braking on a real track.

from slosh_cli import load_scenario, simulate

result = simulate(load_scenario("paper_80.yaml"))

docs/python.md shows everything that is offered here.
"""

from slosh_cli.version import __version__

TYPE_CHECKING: bool = False  # the module typing takes longer to load than all that stands here
if TYPE_CHECKING:
    from typing import Any

    from slosh_cli.application.excitation import excite
    from slosh_cli.application.finding import find, optimum
    from slosh_cli.application.plotting import plot
    from slosh_cli.application.stop import simulate
    from slosh_cli.application.studies import sweep
    from slosh_cli.application.tank import coefficients
    from slosh_cli.application.train import simulate_train
    from slosh_cli.application.validation import validate
    from slosh_cli.results.result import Result
    from slosh_cli.results.train_result import TrainResult
    from slosh_cli.scenario import Scenario, load_scenario
    from slosh_cli.scenario.train_file import load_train

__all__ = [
    "Result", "Scenario", "TrainResult", "__version__", "coefficients", "excite", "find", "load_scenario", "load_train",
    "optimum", "plot", "simulate", "simulate_train", "sweep", "validate",
]  # fmt: skip

_HOMES = {
    "Result": "slosh_cli.results.result",
    "Scenario": "slosh_cli.scenario",
    "TrainResult": "slosh_cli.results.train_result",
    "coefficients": "slosh_cli.application.tank",
    "excite": "slosh_cli.application.excitation",
    "find": "slosh_cli.application.finding",
    "load_scenario": "slosh_cli.scenario",
    "load_train": "slosh_cli.scenario.train_file",
    "optimum": "slosh_cli.application.finding",
    "plot": "slosh_cli.application.plotting",
    "simulate": "slosh_cli.application.stop",
    "simulate_train": "slosh_cli.application.train",
    "sweep": "slosh_cli.application.studies",
    "validate": "slosh_cli.application.validation",
}


def __getattr__(name: str) -> "Any":
    """Import what is asked for when it is asked for: the command line must not wait for the solver."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    from importlib import import_module

    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
