"""What a run tells of its line: gradient, height and unevenness along the stop, and what a steep line means."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from slosh_cli.arrays import Array, Vector
from slosh_cli.errors import PhysicsError
from slosh_cli.results.recommendation import stop_deceleration
from slosh_cli.results.validity import Check
from slosh_cli.scenario import Scenario
from slosh_cli.scenario.schema_line import measured_points
from slosh_cli.scenario.units import STANDARD_GRAVITY
from slosh_cli.wagon.model import wheel_positions

if TYPE_CHECKING:
    from slosh_cli.solver.vehicle import Vehicle


def gradient_at(scenario: Scenario, place: float) -> float:
    """Gradient where a wagon stands that has come to `place` (m)."""
    places, gradients = np.array(scenario.track.gradient_points).T
    return float(np.interp(place, places, gradients))


def line_channels(scenario: Scenario, vehicle: Vehicle, position: Vector) -> dict[str, Array]:
    """Histories of gradient and height where the line is not level, of the rail's height where that is uneven.

    `position` (n,) m is that of the vehicle.
    """
    channels: dict[str, Array] = {}
    places, gradients = np.array(scenario.track.gradient_points).T
    on_line = position - vehicle.line.behind
    if gradients.any():
        along = np.unique(np.concatenate([places, on_line, [0.0]]))
        gradient = np.interp(along, places, gradients)
        climbed = np.concatenate([[0.0], np.cumsum(0.5 * (gradient[1:] + gradient[:-1]) * np.diff(along))])
        climbed -= np.interp(0.0, along, climbed)
        channels["line_gradient"] = np.interp(on_line, places, gradients)
        channels["line_height"] = np.interp(on_line, along, climbed)
    if scenario.track.unevenness is not None:
        channels["rail_level"] = vehicle.contact.surface.levels(position)
    return channels


def descent_checks(scenario: Scenario) -> tuple[Check, ...]:
    """Whether brakes and resistance slow the wagon down on the steepest downhill; nothing where there is none."""
    steepest = max(-gradient for _, gradient in scenario.track.gradient_points)
    if steepest <= 0.0:
        return ()
    pull, slowing = STANDARD_GRAVITY * steepest, stop_deceleration(scenario)
    return (
        Check(
            "pull of the steepest downhill over what brakes and resistance take",
            "operation",
            pull,
            slowing,
            f"Where the line falls by {1e3 * steepest:.3g} permille gravity pulls the wagon by {pull:.3g} m/s^2, but "
            f"brakes and resistance take only {slowing:.3g} m/s^2: it does not slow down there.",
        ),
    )


def check_covered(scenario: Scenario, position: float) -> None:
    """Refuse a run that left its measured rail behind when it had come to `position` (m) of the line.

    Raises PhysicsError.
    """
    unevenness = scenario.track.unevenness
    if unevenness is None or unevenness.file is None:
        return
    reached = position + float(wheel_positions(scenario.wagon).max())
    end = float(measured_points(unevenness.file)[-1, 0])
    if reached > end:
        raise PhysicsError(
            f"The measured rail must cover the stop, but it ends at {end:.1f} m and the leading wheel came to "
            f"{reached:.1f} m. Give a longer file, or brake harder.",
            "track.unevenness.file",
        )
