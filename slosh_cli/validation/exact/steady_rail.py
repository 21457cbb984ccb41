"""Steady deflection of an endless beam on a Pasternak foundation under a load that moves at constant speed."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from slosh_cli.arrays import Array


@dataclass(frozen=True)
class Beam:
    """Beam and foundation, SI units: bending stiffness, mass per length, foundation, shear layer, their damping."""

    bending: float
    mass: float
    stiffness: float
    shear: float
    damping: float = 0.0
    shear_damping: float = 0.0

    def tension(self, speed: float) -> float:
        """What stands before -y'' in the frame of the load, N."""
        return self.shear - self.mass * speed**2

    @property
    def critical_speed(self) -> float:
        """Least phase speed of a free wave without damping, by minimising it over the wave number, m/s.

        A wave `e^(i xi (x - c t))` needs `m c^2 xi^2 = EI xi^4 + k_sm xi^2 + k`.
        """
        from scipy.optimize import minimize_scalar

        def squared(logarithm: float) -> float:
            xi = np.exp(logarithm)
            return float((self.bending * xi**2 + self.shear + self.stiffness / xi**2) / self.mass)

        return float(np.sqrt(minimize_scalar(squared, bracket=(-3.0, 0.0, 3.0), tol=1e-14).fun))


def closed_form(beam: Beam, r: float | Array, speed: float) -> Array:
    """Deflection (m, down) per newton at distance `r` (m) from the load, without damping and below critical speed.

    The roots of `EI p^4 - T p^2 + k = 0` are `+-a +- i b`; the decaying pair, even about the load, with a jump of
    the shear force of 1 N gives `y0 e^(-a|r|) (cos b r + (a/b) sin b|r|)`.
    """
    tension, root = beam.tension(speed), 2 * np.sqrt(beam.stiffness * beam.bending)
    under = 1 / (2 * np.sqrt(beam.stiffness) * np.sqrt(tension + root))
    a, b = np.sqrt((root + tension) / (4 * beam.bending)), np.sqrt((root - tension) / (4 * beam.bending))
    r = np.abs(np.asarray(r, dtype=np.float64))
    return np.asarray(under * np.exp(-a * r) * (np.cos(b * r) + a / b * np.sin(b * r)))


def fourier_integral(beam: Beam, r: float, speed: float) -> float:
    """Deflection (m, down) per newton at `r` (m) ahead of the load, damping included, by quadrature.

    Seen from the load d/dt is `-V d/dr`, so the transform of the deflection is the reciprocal of
    `D(xi) = EI xi^4 + (k_sm - m V^2) xi^2 + k - i V xi (alpha + lam xi^2)`; y is `1/pi INT Re[e^(i xi r)/D] dxi`.
    """
    from scipy.integrate import quad

    def integrand(xi: float) -> float:
        symbol = beam.bending * xi**4 + beam.tension(speed) * xi**2 + beam.stiffness
        lossy = symbol - 1j * speed * xi * (beam.damping + beam.shear_damping * xi**2)
        return float((np.exp(1j * xi * r) / lossy).real)

    pieces = np.concatenate([np.linspace(0.0, 20.0, 41), np.geomspace(20.0, 2e3, 120)[1:]])
    return float(
        sum(quad(integrand, *piece, epsabs=1e-16, epsrel=1e-12, limit=400)[0] for piece in pairwise(pieces)) / np.pi
    )
