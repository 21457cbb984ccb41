"""The hydrodynamic coefficients of a tank's slosh modes, as a scenario gives them or from its geometry."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

from slosh_cli.section import liquid_depth, section_of
from slosh_cli.tank.load import LoadedLiquid, LoadedTank
from slosh_cli.tank.longitudinal import LongitudinalMode, LongitudinalModes, longitudinal_modes


@dataclass(frozen=True)
class SloshMode:
    """One longitudinal slosh mode of a whole tank (theory sections 3 and 4).

    `frequency` rad/s; `lambda_1` kg couples the surface to the longitudinal displacement of the tank's bottom
    centre, `lambda_02` kg m to its pitch; `mu` kg is the modal mass; `damping_ratio` is relative to critical.
    """

    frequency: float
    lambda_1: float
    lambda_02: float
    mu: float
    damping_ratio: float = 0.0

    @property
    def slosh_mass(self) -> float:
        """Mass in kg that moves with the mode, lambda_1^2 / mu; free of the mode's scaling."""
        return self.lambda_1**2 / self.mu

    @property
    def height(self) -> float:
        """Height above the tank's lowest point at which the mode's force acts, lambda_02 / lambda_1, m."""
        return self.lambda_02 / self.lambda_1


class _ModeValues(Protocol):
    """A mode as a scenario gives it; same quantities and units as `SloshMode`."""

    @property
    def frequency(self) -> float: ...
    @property
    def lambda_1(self) -> float: ...
    @property
    def lambda_02(self) -> float: ...
    @property
    def mu(self) -> float: ...
    @property
    def damping_ratio(self) -> float: ...


class SloshLiquid(LoadedLiquid, Protocol):
    """The liquid of a scenario's tank."""

    @property
    def model(self) -> str: ...
    @property
    def damping_ratio(self) -> float: ...


class SloshTank(LoadedTank, Protocol):
    """A scenario's tank with its liquid and its coefficients."""

    @property
    def liquid(self) -> SloshLiquid: ...
    @property
    def coefficients(self) -> Literal["computed"] | Sequence[_ModeValues]: ...
    @property
    def modes(self) -> int: ...


def slosh_modes(tank: SloshTank) -> tuple[SloshMode, ...]:
    """The slosh modes of the whole tank the scenario asks for: given or computed; none for other models.

    Raises TankError where they cannot be computed.
    """
    if tank.liquid.model != "modal":
        return ()
    if tank.coefficients == "computed":
        return computed_modes(tank, tank.modes)
    return given_modes(tank)


def given_modes(tank: SloshTank) -> tuple[SloshMode, ...]:
    """The slosh modes a scenario states in figures; none where it leaves them to be computed."""
    if isinstance(tank.coefficients, str):
        return ()
    return tuple(
        SloshMode(given.frequency, given.lambda_1, given.lambda_02, given.mu, given.damping_ratio)
        for given in tank.coefficients
    )


def computed_modes(tank: SloshTank, count: int) -> tuple[SloshMode, ...]:
    """The first `count` odd longitudinal modes from the tank's geometry, with the liquid's damping ratio.

    Raises TankError where the section cannot be represented.
    """
    density, damping_ratio = tank.liquid.density, tank.liquid.damping_ratio
    return tuple(_of_density(mode, density, damping_ratio) for mode in tank_modes(tank, count).modes)


def tank_modes(tank: LoadedTank, count: int) -> LongitudinalModes:
    """The same modes for unit density, with their shapes and the accuracy reached."""
    return longitudinal_modes(section_of(tank), liquid_depth(tank), tank.length, count)


def _of_density(mode: LongitudinalMode, density: float, damping_ratio: float) -> SloshMode:
    return SloshMode(
        mode.frequency, density * mode.lambda_1, density * mode.lambda_02, density * mode.mu, damping_ratio
    )
