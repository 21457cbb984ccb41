"""One stop, by a two-stage diagonally implicit Runge-Kutta method of order 2 with fixed steps.

Alexander's SDIRK2 (SIAM J. Numer. Anal. 14, 1977), gamma = 1 - 1/sqrt(2): L-stable and stiffly accurate, so
contact and creep modes far faster than the step are damped out. Both stages are implicit: a step never asks
for the acceleration at its start, and a jump of torque only needs a step to begin there. Onset, lock,
release and the stop itself are stepped to exactly: the length of the step is the unknown of a root search.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from .plain_ledger import POWERS, energy, powers, taken
from .plain_motion import (
    PHI_DOFS,
    Brake,
    Motion,
    NotConvergedError,
    Stage,
    System,
    equilibrium,
    solve_stage,
    system_of,
)
from .plain_wagon import FIRST_MODE, THETA_BOGIE, THETA_CAR, S

GAMMA = 1.0 - np.sqrt(0.5)
STOPPED = 4  # index of the event that ends the run; smaller ones are wheels
SHORTEST = 1e-9  # s; an event nearer than this happens now
PITCH_LIMIT = 0.1  # rad
TIME_LIMIT = 600.0  # s


@dataclass(frozen=True)
class PlainStop:
    """Result of a stop; forces of one wheel in N, wheel 1 leads.

    ``distance`` and ``time`` count from the brake's onset, loads are extremes from onset to stop (both ends
    included), ``locked_time`` is how long each wheel stood still. ``energy_residual`` is the largest gap in
    the energy ledger relative to the initial kinetic energy, ``work`` what each of its terms came to (J).
    ``events`` lists (time since the start, text); ``history`` maps names to arrays with one row per step.
    """

    distance: float
    time: float
    min_loads: np.ndarray
    max_loads: np.ndarray
    locked_time: np.ndarray
    energy_residual: float
    work: dict[str, float]
    events: list[tuple[float, str]]
    history: dict[str, np.ndarray]


@dataclass(frozen=True)
class State:
    """Where a step begins: time, motion, the last accelerations and forces, brakes, work so far."""

    t: float
    motion: Motion
    a: np.ndarray
    N: np.ndarray
    f: np.ndarray
    brake: Brake
    work: np.ndarray


def _ahead(motion: Motion, h: float, stage: Stage) -> Motion:
    """Motion advanced by ``h`` times the slopes of a stage."""
    new = stage.motion
    return Motion(motion.q + h * new.u, motion.u + h * stage.a, motion.y + h * new.v, motion.v + h * stage.rail_a)


def step_of(system: System, state: State, h: float) -> State:
    """Advance by ``h``: in one step, or in two of half the length where its stages cannot be solved."""
    try:
        return _single_step(system, state, h)
    except NotConvergedError:
        if h < SHORTEST:
            raise
    return step_of(system, step_of(system, state, 0.5 * h), 0.5 * h)


def _single_step(system: System, state: State, h: float) -> State:
    """One step of the method; its end is its second stage."""
    tau = GAMMA * h
    first = solve_stage(system, state.brake, state.motion, tau, state)
    base = _ahead(state.motion, (1.0 - GAMMA) * h, first)
    last = solve_stage(system, state.brake, base, tau, first)
    work = (1.0 - GAMMA) * powers(system, state.brake, first) + GAMMA * powers(system, state.brake, last)
    return State(state.t + h, last.motion, last.a, last.N, last.f, state.brake, state.work + h * work)


def indicators(system: System, state: State, stop_speed: float) -> np.ndarray:
    """Five numbers whose fall through zero is an event.

    Per wheel its rotation while it turns (it then locks) or the torque in reserve while it is locked (then it
    is released); last the speed above the stop speed.
    """
    reserve = system.torque - system.wagon.wheel_radius * state.f
    turning = state.motion.u[PHI_DOFS]
    return np.append(np.where(state.brake.locked, reserve, turning), state.motion.u[S] - stop_speed)


def _time_of_event(system: System, state: State, h: float, stop_speed: float, index: int) -> float:
    """Length of the step that ends where indicator ``index``, negative after ``h``, vanishes."""

    def value(length):
        return indicators(system, step_of(system, state, length), stop_speed)[index]

    start = h
    while True:  # a wheel just released starts at exactly zero: look for a positive value on the way
        start *= 0.5
        if start < SHORTEST:
            return 0.0
        if value(start) > 0.0:
            break
        h = start
    return brentq(value, start, h, xtol=1e-13, rtol=1e-12)


def advance(system: System, state: State, h: float, stop_speed: float) -> tuple[State, int | None]:
    """Step by ``h``, or to the first event before that; returns the new state and the event, if any."""
    trial, index = step_of(system, state, h), None
    for candidate in np.flatnonzero(indicators(system, trial, stop_speed) < 0.0):
        if index is not None and indicators(system, trial, stop_speed)[candidate] >= 0.0:
            continue
        length = _time_of_event(system, state, trial.t - state.t, stop_speed, candidate)
        trial = step_of(system, state, length) if length > 0.0 else state
        index = int(candidate)
    if index is not None and index < STOPPED:  # at lock and at release the wheel stands: make the zero exact
        u = trial.motion.u.copy()
        u[PHI_DOFS[index]] = 0.0
        trial = replace(trial, motion=replace(trial.motion, u=u))
    return trial, index


def switch(state: State, wheel: int) -> State:
    """Lock a standing wheel, or release a locked one."""
    locked, a = state.brake.locked.copy(), state.a.copy()
    locked[wheel], a[PHI_DOFS[wheel]] = not locked[wheel], 0.0
    return replace(state, a=a, brake=replace(state.brake, locked=locked))


class _Record:
    """Histories, extremes and the energy ledger while a stop runs."""

    def __init__(self, system: System, state: State):
        self.system = system
        self.rows: list[tuple] = []
        self.start = energy(system, state.motion, state.N)
        u = state.motion.u
        self.kinetic = 0.5 * u @ system.wagon.mass @ u
        self.residual = 0.0

    def add(self, state: State) -> None:
        motion = state.motion
        pitch = motion.q[[THETA_CAR, *THETA_BOGIE]]
        if not np.all(np.isfinite(motion.u)) or np.max(np.abs(pitch)) > PITCH_LIMIT:
            raise ArithmeticError(f"run left the range of the model at {state.t:.3f} s")
        self.rows.append(
            (
                state.t,
                motion.q[S],
                motion.u[S],
                state.N,
                motion.u[PHI_DOFS] * self.system.wagon.wheel_radius,
                state.brake.locked,
                motion.q[FIRST_MODE:],
                pitch,
            )
        )

    def audit(self, state: State) -> None:
        now = energy(self.system, state.motion, state.N)
        self.residual = max(self.residual, abs(now + taken(state.work) - self.start) / self.kinetic)

    def history(self) -> dict[str, np.ndarray]:
        names = ("time", "distance", "speed", "loads", "wheel_speed", "locked", "slosh", "pitch")
        columns = zip(*self.rows, strict=True)
        return {name: np.array(column) for name, column in zip(names, columns, strict=True)}


def _initial(system: System, speed: float) -> State:
    motion, N = equilibrium(system, speed)
    brake, work = Brake(False, np.zeros(4, dtype=bool)), np.zeros(len(POWERS))
    return State(0.0, motion, np.zeros(system.wagon.size), N, system.creep(motion, N), brake, work)


def stop(scenario, step: float = 5e-4, element_length: float | None = None) -> PlainStop:
    """Brake a wagon from its initial speed to its stop speed with steps of ``step`` seconds.

    Raises ArithmeticError when a stage is not solved, the wagon reaches the pitch limit or it does not stop in time.
    """
    system, braking = system_of(scenario, element_length), scenario.braking
    state = _initial(system, braking.initial_speed)
    record, events = _Record(system, state), []
    record.add(state)
    steps_before = max(1, round(braking.onset / step)) if braking.onset > 0.0 else 0
    for _ in range(steps_before):
        state = step_of(system, state, braking.onset / steps_before)
        record.add(state)
    onset_row = len(record.rows) - 1
    state = replace(state, t=braking.onset, brake=replace(state.brake, on=True))
    switches = 0
    while state.t < TIME_LIMIT:
        state, event = advance(system, state, step, braking.stop_speed)
        record.add(state)
        if event == STOPPED:
            record.audit(state)
            return _result(record, events, onset_row, state)
        if event is None:
            switches = 0
            if len(record.rows) % 20 == 0:
                record.audit(state)
        else:
            done = "released" if state.brake.locked[event] else "locked"
            events.append((state.t, f"wheel {event + 1} {done}"))
            state = switch(state, event)
            switches += 1
            if switches > 50:
                raise ArithmeticError(f"wheels lock and release without end at {state.t:.6f} s")
    raise ArithmeticError(f"wagon did not stop within {TIME_LIMIT} s")


def _result(record: _Record, events, onset_row: int, state: State) -> PlainStop:
    history = record.history()
    time, distance, loads = history["time"], history["distance"], history["loads"][onset_row:]
    # a row's flag tells how the wheel stood during the step that ended there
    locked_time = np.diff(time) @ history["locked"][1:].astype(float)
    return PlainStop(
        float(distance[-1] - distance[onset_row]),
        float(time[-1] - time[onset_row]),
        loads.min(axis=0),
        loads.max(axis=0),
        locked_time,
        record.residual,
        dict(zip(POWERS, state.work.tolist(), strict=True)),
        events,
        history,
    )
