"""slosh: tank wagons with a moving liquid, braking on a real track.

from slosh_cli import load_scenario, simulate

result = simulate(load_scenario("paper_80.yaml"))
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from slosh_cli.version import __version__

if TYPE_CHECKING:
    from slosh_cli.results.result import Result
    from slosh_cli.results.simulate import simulate
    from slosh_cli.scenario import load_scenario

__all__ = ["Result", "__version__", "load_scenario", "simulate"]

_HOMES = {
    "Result": "slosh_cli.results.result",
    "load_scenario": "slosh_cli.scenario",
    "simulate": "slosh_cli.results.simulate",
}


def __getattr__(name: str) -> Any:
    """Import what is asked for when it is asked for: the command line must not wait for the solver."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(import_module(_HOMES[name]), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted([*globals(), *_HOMES])
