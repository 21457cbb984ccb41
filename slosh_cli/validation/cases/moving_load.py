"""A constant load on an undamped rail: closed form, fourth order, and the compiled kernel that runs in a stop."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from slosh_cli.scenario import Track
from slosh_cli.validation import kernels
from slosh_cli.validation.case import Findings, Outcome
from slosh_cli.validation.chart import Chart, Panel, curve
from slosh_cli.validation.data_file import CaseData
from slosh_cli.validation.exact.paper_track import LOADED, WHEEL_PLACES, at, beam, paper_track, steady_deflections
from slosh_cli.validation.exact.steady_rail import closed_form

LENGTHS = (1.0, 0.5, 0.25)


def compute(data: CaseData) -> Outcome:
    """Deflection under the load and everywhere, at several speeds, with and without a shear layer."""
    found, errors_at = Findings(data), {}
    for shear in data.reference["shear_stiffness"]:
        layer = f"{shear:g} N shear layer"
        for speed in data.reference["speeds"]:
            errors = [_error(paper_track(length, shear_stiffness=shear), speed) for length in LENGTHS]
            errors_at[layer, speed] = errors
            track = paper_track(LENGTHS[-1], shear_stiffness=shear)
            nodes, shape = steady_deflections(track, speed)
            exact = closed_form(beam(track), nodes, speed)
            name = f"{speed:g} m/s, {layer}"
            under, exact_under = at(nodes, shape, 0.0), float(closed_form(beam(track), 0.0, speed))
            found.compare(f"deflection under 1 N, {name} / nm", 1e9 * under, 1e9 * exact_under, "deflection")
            for (h, coarse), (half, fine) in pairwise(zip(LENGTHS, errors, strict=True)):
                order = float(np.log2(coarse / fine))
                found.compare(f"order of convergence, {h:g} to {half:g} m, {name}", order, 4.0, "order")
            found.limit(f"largest error of the shape over its peak, {name}", _worst(shape, exact), "shape")
            found.limit(
                f"force missing in the kernel's balance per newton, {name}", _kernel_gap(track, speed), "kernel"
            )
    return found.outcome(_chart(data, errors_at))


def _error(track: Track, speed: float) -> float:
    nodes, shape = steady_deflections(track, speed)
    return abs(at(nodes, shape, 0.0) / float(closed_form(beam(track), 0.0, speed)) - 1)


def _worst(shape: np.ndarray, exact: np.ndarray) -> float:
    return float(np.abs(shape - exact).max() / exact.max())


def _kernel_gap(track: Track, speed: float) -> float:
    """Largest nodal force (N) that the time loop's residual leaves beside the load of 1 N."""
    from slosh_cli.track import mem

    rail = mem.rail_model(track, WHEEL_PLACES)
    steady = np.ascontiguousarray(mem.steady_shapes(rail, speed)[:, LOADED])
    residual = kernels.residual_forces(rail, steady, speed)
    residual[rail.contact[LOADED]] += 1.0
    return float(np.abs(residual).max())


def _chart(data: CaseData, errors: dict[tuple[str, float], list[float]]) -> Chart:
    track = paper_track(LENGTHS[0])
    speed = data.reference["speeds"][-1]
    nodes, shape = steady_deflections(track, speed)
    r = np.linspace(-8, 8, 400)
    near = np.abs(nodes) <= 8
    shapes = Panel(
        "distance from the load / m",
        "deflection under 1 N / nm",
        (
            curve(f"closed form, {speed:g} m/s", r, -1e9 * closed_form(beam(track), r, speed), exact=True),
            curve(f"moving elements of {LENGTHS[0]:g} m", nodes[near], -1e9 * shape[near], marks=True),
        ),
    )
    lines = [curve(f"{speed:g} m/s, {layer}", LENGTHS, error) for (layer, speed), error in list(errors.items())[:3]]
    fourth = [next(iter(errors.values()))[0] * (length / LENGTHS[0]) ** 4 for length in LENGTHS]
    orders = Panel(
        "element length / m",
        "relative error under the load",
        (curve("fourth power", LENGTHS, fourth, exact=True), *lines),
        log_x=True,
        log_y=True,
    )
    return Chart((shapes, orders))
