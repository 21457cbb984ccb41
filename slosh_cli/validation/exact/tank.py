"""Tanks whose slosh modes have closed forms. All values are of a whole tank; `lambda_02` is about its lowest point."""

from __future__ import annotations

from dataclasses import dataclass
from math import cosh, pi, sinh, sqrt, tanh

from slosh_cli.scenario.units import STANDARD_GRAVITY


@dataclass(frozen=True)
class ExactMode:
    """Frequency (rad/s), lambda_1 (kg), lambda_02 (kg m) and mu (kg) of mode n."""

    n: int
    frequency: float
    lambda_1: float
    lambda_02: float
    mu: float

    @property
    def slosh_mass(self) -> float:
        """Mass that moves with the mode, kg."""
        return self.lambda_1**2 / self.mu

    @property
    def height(self) -> float:
        """Height at which its force acts, m."""
        return self.lambda_02 / self.lambda_1


def rectangle(n: int, width: float, depth: float, length: float, density: float) -> ExactMode:
    """A box: `phi = cosh(k z)/(k sinh(k h))`, `omega^2 = g k tanh(k h)`, k = n pi/L."""
    k = n * pi / length
    lambda_1 = -2 * density * width / k**2
    return ExactMode(
        n,
        sqrt(STANDARD_GRAVITY * k * tanh(k * depth)),
        lambda_1,
        lambda_1 * (depth - 2 / k * tanh(k * depth / 2)),
        density * length / 2 * width / (k * tanh(k * depth)),
    )


def trough(n: int, depth: float, length: float, density: float) -> ExactMode:
    """A right-angled V, vertex down: `phi = C cosh(a y) cosh(a z)`, a = k/sqrt 2, C = h/sinh(a h)^2 for unit mean rise.

    Both factors obey the walls y = +-z, and `omega^2 = g a tanh(a h)`.
    """
    k = n * pi / length
    a = k / sqrt(2)
    c = depth / sinh(a * depth) ** 2
    kappa, along, double = a * tanh(a * depth), -2 / k**2, 2 * a * depth
    mean_square = depth + sinh(double) / (2 * a)  # integral of cosh(a y)^2 over the width
    z_phi = c / a * (depth * cosh(double) / (2 * a) - sinh(double) / (4 * a**2))
    phi_n_z = c * (sinh(double) / (2 * a) - depth)
    return ExactMode(
        n,
        sqrt(STANDARD_GRAVITY * kappa),
        density * along * 2 * depth,
        density * (-2 * z_phi - along * phi_n_z),
        density * length / 2 * kappa * c**2 * cosh(a * depth) ** 2 * mean_square,
    )
