"""How long a study will take, from what stops took before or from a few of them tried."""

import time
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from slosh_cli.study.journal import Journal
    from slosh_cli.study.plan import Study
    from slosh_cli.study.runner import Plan

_SAMPLES: Final = 3
_PATIENCE: Final = 2.0
"""Seconds a tried stop may take; a longer one is judged by how far it came."""
_TYPICAL: Final = 0.15
"""What a stop of the paper's wagon takes, s of one thread, for want of anything better; of a train, each vehicle's."""


class _Deadline:
    """Set once its time is over; keeps what fraction of the stop was done by then."""

    def __init__(self) -> None:
        self.began = time.perf_counter()
        self.fraction = 0.0

    def is_set(self) -> bool:
        return time.perf_counter() - self.began > _PATIENCE

    def progress(self, fraction: float, _speed: float) -> None:
        self.fraction = fraction


def seconds_per_stop(study: "Study", planned: "Plan", journal: "Journal | None") -> float:
    """Seconds of one thread for one of the stops that are still open."""
    known = journal.mean_seconds() if journal is not None and planned.open else None
    if known is not None:
        return known
    from slosh_cli.compiled import solver_is_cached

    if not planned.open or not all(solver_is_cached(model) for model in study.liquids):
        return _TYPICAL * study.vehicles
    count = min(_SAMPLES, len(planned.open))
    chosen = [planned.open[(2 * k + 1) * len(planned.open) // (2 * count)] for k in range(count)]
    _try(study, chosen[0])  # loads the kernels
    return sum(_try(study, index) for index in chosen) / count


def _try(study: "Study", index: int) -> float:
    """Seconds that one stop takes, or would take."""
    from slosh_cli.errors import SloshError
    from slosh_cli.solver.run import Cancelled
    from slosh_cli.study.outcome import run_of

    deadline = _Deadline()
    try:
        run_of(study.stop(index).scenario, progress=deadline.progress, cancel=deadline)
    except Cancelled:
        return _PATIENCE / max(deadline.fraction, 1e-3)
    except SloshError:
        pass
    return time.perf_counter() - deadline.began
